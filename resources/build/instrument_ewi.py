"""The wind controller of the Akai EWI's kind (EWI4000s, EWI5000): a straight electronic tube with keys to be touched.

Sizes are those of such an instrument: 0.62 m long with its mouthpiece of soft rubber, a rectangular body that grows
from 30 mm by 26 at the left thumb to 45 mm by 34 at the lower end. On the front thirteen plates of metal: three round
keys for either hand, a crescent (bis) between the first two, two tabs of the left little finger, three of the right one
and one beside the right index finger. On the back eight rollers 9.4 mm apart, the third and the fourth from below
knurled, between a ground strip (left) and a portamento strip; below them the loop for the neck strap and the right
thumb's ground plate between two bumps that bend the pitch.

Nothing moves: a key is worked by the finger on it. So its controls are of the kind of holes, which a finger covers.

The model's frame: the origin in the middle of the mouthpiece where the lips close around it, +Z along the body away
from the player, +Y the front. Distances ``along`` are counted from there; the tip lies at ``-TIP_M``.
"""

from __future__ import annotations

import itertools

import numpy as np

from resources.build.instrument_keys import Keywork, bodied, cylinder, entry, oval, slab
from resources.build.instrument_mesh import Array, Shape, plate, solid, torus, tube, turned, unit
from resources.build.instrument_reeds import loft

X, Y, Z = np.eye(3)
TIP_M = 0.013
"""Distance in metres of the mouthpiece's tip from the lips, inside the mouth."""
LIPS_APART_M, HALF_WIDTH_M = 0.0086, 0.0083
"""Height of the mouthpiece and half its width where the lips close."""

SECTIONS = (
    (0.040, 0.0112, 0.0104), (0.080, 0.0122, 0.0114), (0.135, 0.0150, 0.0128), (0.240, 0.0160, 0.0132),
    (0.440, 0.0182, 0.0145), (0.540, 0.0205, 0.0158), (0.594, 0.0225, 0.0170), (0.604, 0.0222, 0.0168),
)  # fmt: skip
"""Along the body: its half width and half depth."""
CORNER_M = 0.0052

KEYS = (("key_L1", "L1", "left.index", 0.1810), ("key_L2", "L2", "left.middle", 0.2080),
        ("key_L3", "L3", "left.ring", 0.2330), ("key_R1", "R1", "right.index", 0.3340),
        ("key_R2", "R2", "right.middle", 0.3590), ("key_R3", "R3", "right.ring", 0.3840))  # fmt: skip
KEY_R, KEY_HIGH = 0.0072, 0.0026
TABS = (("key_G_sharp", "Lp1", "left.little", 0.2530, 1.0), ("key_B_low", "Lp2", "left.little", 0.2630, 1.0),
        ("key_E_flat", "Rp1", "right.little", 0.4030, -1.0), ("key_C_sharp_low", "Rp2", "right.little", 0.4130, -1.0),
        ("key_C_low", "Rp3", "right.little", 0.4230, -1.0))  # fmt: skip
"""Tabs of the little fingers: where along, and on which side."""

ROLLERS, ROLLER_R, ROLLER_APART, ROLLERS_AT = 8, 0.0044, 0.0094, 0.2040
ROLLER_HIGH = 0.0040
"""Height in metres of a roller above the back; the bar between two rollers is lower by ``VALLEY_M``."""
VALLEY_M = 0.0011
HOME_OCTAVE = 4
"""Octave at which the left thumb is at home, between the fourth and fifth rollers: from middle C."""
KNURLED = (3, 4)
"""Indices of the knurled rollers from the lower end, by which the thumb finds its place."""
PLATE_AT = 0.3440
"""Distance in metres along the body of the right thumb's plate."""


def half_sizes(along: float) -> tuple[float, float]:
    """Half width and half depth of the body."""
    places, wide, deep = zip(*SECTIONS, strict=True)
    return float(np.interp(along, places, wide)), float(np.interp(along, places, deep))


def rounded(along: float, half: float, deep: float, corner: float) -> Array:
    """A rectangle with round corners across the body."""
    points = []
    for start, x, y in ((0, 1, 1), (90, -1, 1), (180, -1, -1), (270, 1, -1)):
        for angle in np.radians(start + np.linspace(0, 90, 6)):
            points.append((x * (half - corner) + corner * np.cos(angle), y * (deep - corner) + corner * np.sin(angle)))
    return np.column_stack([np.array(points), np.full(len(points), along)])


class Ewi:
    """Builds the wind controller."""

    def __init__(self) -> None:
        self.work = Keywork(hover_m=0.006)

    def make(self) -> Keywork:
        """The whole instrument."""
        self.mouthpiece()
        self.body()
        self.keys()
        self.side_tab()
        self.tabs()
        self.rollers()
        self.back()
        return self.work

    def front(self, along: float, x: float = 0.0, height: float = 0.0) -> Array:
        """A place over the front."""
        return np.array([x, half_sizes(along)[1] + height, along])

    def rear(self, along: float, x: float = 0.0, height: float = 0.0) -> Array:
        """A place over the back."""
        return np.array([x, -half_sizes(along)[1] - height, along])

    def mouthpiece(self) -> None:
        """A flattened beak of rubber on a round stem."""
        high = LIPS_APART_M / 2
        outline = ((-TIP_M, 0.0066, 0.0020), (-TIP_M + 0.0012, 0.0076, 0.0028), (-0.0060, 0.0082, 0.0039),
                   (-0.0022, HALF_WIDTH_M, high), (0.0022, HALF_WIDTH_M, high), (0.0080, 0.0085, 0.0050),
                   (0.0180, 0.0088, 0.0072), (0.0270, 0.0092, 0.0092), (0.0330, 0.0094, 0.0094))  # fmt: skip
        t = np.linspace(0, 2 * np.pi, 36, endpoint=False)
        rings = []
        for along, half, deep in outline:
            power = 0.62 + 0.38 * float(np.clip(along / 0.027, 0, 1))
            x = half * np.sign(np.cos(t)) * np.abs(np.cos(t)) ** power
            y = deep * np.sign(np.sin(t)) * np.abs(np.sin(t)) ** power
            rings.append(np.column_stack([x, y, np.full_like(t, along)]))
        bodies: list[dict[str, object]] = [
            {"shape": "box", "centre_m": np.array([0, 0, (a + b) / 2]), "half_m": np.array([0.0080, h, (b - a) / 2]),
             "x_axis": X, "y_axis": Y}
            for a, b, h in ((-TIP_M, -0.0060, 0.0036), (-0.0060, 0.0060, high), (0.0060, 0.0180, 0.0062))
        ]  # fmt: skip
        bodies.append(cylinder(0.0180 * Z, 0.0330 * Z, 0.0094))
        add = self.work.model.add
        add("rubber", loft(rings, hard_deg=45.0, proxies=bodies))
        slit = plate((0, 0, -TIP_M - 0.0001), (0.0034, 0.0007, 0.0003), X, Y)
        add("leather", bodied(slit))
        stem = [(0.0320, 0.0086), (0.0324, 0.0100), (0.0350, 0.0104), (0.0385, 0.0104), (0.0410, 0.0100)]
        add("silver", solid((0, 0, 0), Z, stem, sides=36))

    def body(self) -> None:
        """The casing from the neck to the lower end with its sockets."""
        cuts = sorted({*(along for along, *_ in SECTIONS), *np.linspace(0.135, 0.540, 10).tolist()})
        rings = [rounded(0.0395, 0.0096, 0.0092, CORNER_M - 0.0006)]
        rings += [rounded(along, *half_sizes(along), CORNER_M) for along in cuts]
        rings.append(rounded(0.6070, 0.0200, 0.0146, CORNER_M))
        bodies: list[dict[str, object]] = []
        steps = np.linspace(0.0400, 0.6060, 19)
        for start, end in itertools.pairwise(steps):
            half, deep = half_sizes((start + end) / 2)
            bodies.append({
                "shape": "box", "centre_m": np.array([0, 0, (start + end) / 2]),
                "half_m": np.array([half - 0.0004, deep, (end - start) / 2]), "x_axis": X, "y_axis": Y,
            })  # fmt: skip
        add = self.work.model.add
        add("dark_plastic", loft(rings, hard_deg=30.0, proxies=bodies))
        # The lower end: a dark cavity with the sockets of cable and USB.
        add("leather", bodied(plate((0, 0, 0.6069), (0.0165, 0.0108, 0.0006), X, Y)))
        add("silver", bodied(tube([(0.006, 0, 0.6065), (0.006, 0, 0.6085)], 0.0052, sides=20, proxy=False)))
        add("felt", bodied(tube([(0.006, 0, 0.6070), (0.006, 0, 0.6087)], 0.0032, sides=16, proxy=False)))
        add("silver", bodied(plate((-0.0085, 0, 0.6075), (0.0042, 0.0038, 0.0006), X, Y)))
        # A bright line along either side, and a light on the front.
        for side in (1.0, -1.0):
            line = [np.array([side * (half_sizes(a)[0] + 0.0001), 0.0, a]) for a in np.linspace(0.10, 0.59, 14)]
            add("nickel_silver", bodied(tube(line, 0.0007, sides=8, proxy=False)))
        light = self.front(0.1300)
        add("pearl", bodied(turned(light - 0.0006 * Y, Y, [(0, 0.0018), (0.0010, 0.0015), (0.0012, 0)], sides=14,
                                   proxy=False)))  # fmt: skip
        badge = self.front(0.4900, 0.0, 0.0001)
        add("silver", bodied(plate(badge, (0.0100, 0.0003, 0.0022), X, Y)))

    def round_key(self, along: float) -> Shape:
        """A round plate of metal, a little domed."""
        r, h = KEY_R, KEY_HIGH
        profile = [(-0.0004, r + 0.0002), (h - 0.0012, r), (h - 0.0004, r - 0.0005), (h, r - 0.0020)]
        foot = self.front(along)
        shape = solid(foot, Y, profile, sides=32, proxy=False)
        return bodied(shape, cylinder(foot - 0.0004 * Y, foot + h * Y, r))

    def keys(self) -> None:
        """The round keys, and the crescent that the index finger touches together with the first."""
        for name, label, finger, along in KEYS:
            self.work.model.add("silver", self.round_key(along))
            self.work.covered(name, label, f"{finger}.pad", self.front(along, 0.0, KEY_HIGH), Y)
        first = KEYS[0][3]
        # A crescent around the lower edge of the first key.
        t = np.radians(np.linspace(28.0, 152.0, 13))
        r = KEY_R + 0.0026
        line = [self.front(first, -r * np.cos(a), 0.0) + r * np.sin(a) * Z for a in t]
        line = [np.array([p[0], half_sizes(float(p[2]))[1] + KEY_HIGH - 0.0016, p[2]]) for p in line]
        thick = 0.0016 * np.sin(t) ** 0.5
        self.work.model.add("silver", tube(line, np.maximum(thick, 0.0006), sides=12))
        self.work.control("key_bis", "hole", "bis", "left.index.pad")
        self.work.contact("left.index.pad", self.front(first + KEY_R - 0.0012, 0.0, KEY_HIGH - 0.0002), Y,
                          control="key_bis", together=("key_L1",))  # fmt: skip

    def side_tab(self) -> None:
        """The tab for B flat beside the right index finger, which the side of the finger touches."""
        along = KEYS[3][3] - 0.0150
        half, deep = half_sizes(along)
        normal = unit([-0.30, 0.45, 0.85])
        middle = np.array([-half - 0.0030, deep - 0.0010, along])
        tab = slab(middle, normal, unit(np.cross(normal, X)), oval(0.0100, 0.0110), 0.0030, hollow_m=0.0002)
        self.work.add(tab.pieces)
        into = np.array([-half + 0.002, deep - 0.006, along - 0.003])
        self.work.model.add("dark_plastic", tube([tab.point - 0.0024 * tab.normal, into], 0.0024, sides=10))
        self.work.covered("key_B_flat", "Rs", "right.index.side_middle", tab.point, tab.normal)

    def tabs(self) -> None:
        """The straight tabs of the little fingers, which stand out of the sides."""
        for name, label, finger, along, side in TABS:
            half, deep = half_sizes(along)
            normal = unit([0.30 * side, 1.0, 0.0])
            middle = np.array([side * (half + 0.0010), deep + 0.0010, along])
            tab = slab(middle, normal, X * side, oval(0.0170, 0.0078), 0.0030, hollow_m=0.0002)
            self.work.add(tab.pieces)
            self.work.covered(name, label, f"{finger}.pad", tab.point, tab.normal)
        # For low B flat the finger is on two tabs, at the rim between them.
        low = next(row for row in self.work.contacts if row["control"] == "key_C_low")
        point, normal = np.asarray(low["point"]), np.asarray(low["normal"])
        self.work.contact("right.little.pad", point - 0.0032 * Z, normal, control="key_C_low",
                          together=("key_C_sharp_low",))  # fmt: skip

    def rollers(self) -> None:
        """Eight rollers; the thumb between two of them chooses the octave."""
        add = self.work.model.add
        high = -half_sizes(ROLLERS_AT)[1] - ROLLER_HIGH
        places = [ROLLERS_AT + (4.5 - number) * ROLLER_APART for number in range(1, ROLLERS + 1)]
        for number, along in enumerate(places, start=1):
            axle, r = np.array([-0.0070, high + ROLLER_R, along]), ROLLER_R
            profile = [(0, 0.0), (0, r - 0.0006), (0.0006, r)]
            if number in KNURLED:
                for place in np.arange(0.0012, 0.0130, 0.0012):
                    profile += [(place, r), (place + 0.0003, r - 0.0003), (place + 0.0006, r)]
            profile += [(0.0134, r), (0.0140, r - 0.0006), (0.0140, 0.0)]
            shape = turned(axle, X, profile, sides=28, proxy=False)
            add("silver", bodied(shape, cylinder(axle, axle + 0.0140 * X, r)))
        for below, above in itertools.pairwise(places):
            middle = np.array([0.0, high + VALLEY_M, (below + above) / 2])
            add("dark_plastic", plate(middle + 0.0020 * Y, (0.0070, 0.0020, 0.0014), X, Y))
        for number in range(1, ROLLERS):
            self.work.control(f"octave_{number}", "hole", f"o{number}", "left.thumb.pad", hover_m=0.0)
        # Home is in the middle and comes first among the thumb's places.
        for number in sorted(range(1, ROLLERS), key=lambda number: abs(number - HOME_OCTAVE)):
            middle = np.array([0.0, high + VALLEY_M, (places[number - 1] + places[number]) / 2])
            self.work.contact("left.thumb.pad", middle, -Y, control=f"octave_{number}")
        span = (places[-1] - 0.0060, places[0] + 0.0060)
        for x, material in ((0.0106, "silver"), (-0.0106, "silver")):
            middle = self.rear(ROLLERS_AT, x)
            add("dark_plastic", plate(middle, (0.0030, 0.0012, (span[1] - span[0]) / 2), X, Y))
            add(material, plate(middle - 0.0011 * Y, (0.0020, 0.0004, (span[1] - span[0]) / 2 - 0.001), X, Y))
        for along in (places[0] + 0.0160, places[-1] - 0.0150):
            self.bump(along, 0.0050, 0.0115)

    def bump(self, along: float, radius: float, half: float, metal: bool = False) -> None:
        """A rounded ridge across the back."""
        middle = self.rear(along, 0.0, -0.0010)
        profile = [
            (0, radius - 0.0020), (0.0006, radius - 0.0006), (0.0020, radius), (2 * half - 0.0020, radius),
            (2 * half - 0.0006, radius - 0.0006), (2 * half, radius - 0.0020),
        ]  # fmt: skip
        self.work.model.add("dark_plastic", solid(middle - half * X, X, profile, sides=32))
        if metal:
            band = [(0, radius - 0.001), (0.0002, radius + 0.0002), (0.0138, radius + 0.0002), (0.0140, radius - 0.001)]
            self.work.model.add("silver", turned(middle - 0.0070 * X, X, band, sides=32, proxy=False))

    def back(self) -> None:
        """The right thumb's ground plate between its bumps, loop, buttons, display and sockets."""
        add = self.work.model.add
        thumb = self.rear(PLATE_AT)
        add("silver", plate(thumb - 0.0002 * Y, (0.0110, 0.0006, 0.0115), X, Y))
        self.work.contact("right.thumb.pad", thumb - 0.0008 * Y, -Y)
        for place in (PLATE_AT - 0.0190, PLATE_AT + 0.0190):
            self.bump(place, 0.0062, 0.0120, metal=True)
        add("silver", torus(self.rear(0.2960, 0.0, 0.0040), X, 0.0052, 0.0011, sides=10, around=28))
        add("silver", plate(self.rear(0.2960), (0.0035, 0.0010, 0.0050), X, Y))
        add("ebonite", bodied(plate(self.rear(0.1180), (0.0080, 0.0003, 0.0070), X, Y)))
        for x in (-0.0050, 0.0050):
            self.button(0.1360, x)
        for along in (0.3850, 0.3950):
            for x in (-0.0060, 0.0060):
                self.button(along, x)
        add("ebonite", bodied(plate(self.rear(0.0880), (0.0090, 0.0004, 0.0170), X, Y)))
        for along, radius in ((0.4420, 0.0062), (0.4650, 0.0035)):
            for material, r, high in (("silver", radius, 0.0006), ("felt", 0.78 * radius, 0.0008)):
                ends = [self.rear(along, 0, -0.0010), self.rear(along, 0, high)]
                add(material, bodied(tube(ends, r, sides=22, proxy=False)))

    def button(self, along: float, x: float) -> None:
        """An oval button of plastic."""
        middle = self.rear(along, x, 0.0010)
        cap = slab(middle, -Y, X, oval(0.0072, 0.0042), 0.0016, material="ebonite", hollow_m=0.0)
        self.work.add(cap.pieces)


INSTRUMENTS = {"ewi": entry(lambda: Ewi().make())}
