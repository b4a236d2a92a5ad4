"""The clarinets of the Boehm system with 17 keys and 6 rings: in B flat, A and E flat, and the bass.

Sizes of the B flat clarinet are those of common instruments: 665 mm long with the mouthpiece, of which the mouthpiece
shows 74, the barrel 66, the upper joint 198, the lower 219 and the bell 108; bore 14.6 mm, 28 to 34 mm thick, bell
79 mm outside and 60 mm inside; holes of the first to third finger 68 mm apart in either hand, 71 mm between the hands,
the first 98 mm below the barrel. The clarinet in A is 5.9 percent longer (a semitone) and as thick, its keys
as near to the fingers; the one in E flat,
505 mm long, has its holes at 0.765 of the distances.

The model's frame: +Z along the bore away from the player, +Y the front with the finger holes, -Y the side of the reed
and of the thumb. Distances ``along`` are counted from the lower edge of the barrel.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from resources.build.instrument_endpin import Pin, stand
from resources.build.instrument_keys import (
    Cup,
    Keywork,
    Pieces,
    RingOn,
    Rod,
    Touch,
    Wall,
    entry,
    oval,
    teardrop,
    with_tail,
)
from resources.build.instrument_mesh import bend, lengths, solid, tube, turned, unit
from resources.build.instrument_reeds import SingleReed, thumb_rest

X, Y, Z = np.eye(3)


@dataclass(frozen=True)
class Sizes:
    """Differences of the straight clarinets: distances along the body, its thickness, and the size of the keys."""

    reed: SingleReed = field(default_factory=SingleReed)
    barrel: float = 0.066
    stretch: float = 1.0
    girth: float = 1.0
    keys: float = 1.0
    bell: float = 0.108
    bell_radius: float = 0.0395
    rest_along: float = 0.249
    hands_as_drawn: bool = False
    side_height: float = 0.0108


F_SHARP, F, E = (tuple(f"key_{note}_{hand}" for hand in ("left", "right")) for note in ("F_sharp", "F", "E"))
"""The levers of the two little fingers for a note."""
UPPER, LOWER = 0.198, 0.417
"""Place where the upper and the lower joint end, before stretching."""
HANDS = ((0.056, 0.2115), (0.2135, 0.354))
"""Spans under either hand."""


class Clarinet:
    """A body under work: parts in the measures of its drawing, which a smaller or longer instrument stretches."""

    def __init__(self, sizes: Sizes, body: Wall) -> None:
        self.sizes, self.body = sizes, body
        self.work = Keywork()

    def at(self, along: float) -> float:
        """A place of the drawing on this instrument; what lies under one hand may keep its distances."""
        stretch = self.sizes.stretch
        if not self.sizes.hands_as_drawn:
            return along * stretch
        (upper, lower), end = HANDS, LOWER
        drawn = (0.0, *upper, *lower, end)
        shifts = [np.mean(hand) * (stretch - 1.0) for hand in HANDS]
        placed = (0.0, *(place + shifts[0] for place in upper), *(place + shifts[1] for place in lower), end * stretch)
        return float(np.interp(along, drawn, placed))

    def rod(self, start: float, end: float, angle: float, height: float = 0.0040) -> Rod:
        return self.body.rod(self.at(start), self.at(end), angle, height)

    def cross(self, along: float, angle: float, width: float = 0.010, height: float = 0.0050) -> Rod:
        return self.body.cross_rod(self.at(along), angle, width * self.sizes.keys, height)

    def cup(self, along: float, angle: float, radius: float, rim: float = 0.0014) -> Cup:
        return Cup(self.body, self.at(along), angle, radius * self.sizes.girth, rim_m=rim)

    def ring(self, along: float, angle: float = 0.0, radius: float = 0.0076) -> RingOn:
        return RingOn(self.body, self.at(along), angle, radius * self.sizes.girth)

    def blade(
        self, along: float, angle: float, height: float, length: float, width: float, *, narrow: float | None = None,
        ahead: float = 1.0, turn_deg: float = 0.0, foot: float = -0.42, rim: tuple[float, float] = (0.0, 0.0),
    ) -> Touch:  # fmt: skip
        """A spatula over the body; ``turn_deg`` swings its length from the body's axis towards growing angles.

        ``rim`` is what it has more than ``length`` and ``width`` where it is touched near its edge.
        """
        k = self.sizes.keys
        x, y = rim
        core, outline = (
            oval((length + a) * k, (width + b) * k)
            if narrow is None
            else teardrop((length + a) * k, (width + b) * k, (narrow + b) * k)
            for a, b in ((0.0, 0.0), (x, y))
        )
        return self.body.spatula(
            self.at(along), angle, height, outline, ahead=ahead, turn_deg=turn_deg, foot=foot, core=core
        )

    def at_end(self, touch: Touch, along: float, across: float = 0.0) -> Touch:
        """A spatula that is touched off its middle, so far along the body and to the player's left."""
        axis = unit(self.body.axis)
        off = along * axis + across * unit(np.cross(touch.normal, axis))
        return replace(touch, point=touch.point + self.sizes.keys * off)

    def tail(self, touch: Touch, rod: Rod, along: float, angle: float) -> Touch:
        """A lever's other end beyond its axle, where it meets another key."""
        end = self.body.point(self.at(along), angle, 0.0045)
        return with_tail(touch, rod, end, self.body.normal(angle), 0.0016)

    def levers(
        self, rows: tuple[tuple[str, str, float, float, float], ...], blade: tuple[float, float, float],
        axle: tuple[float, float, float], beyond: float, travel_m: float,
    ) -> None:  # fmt: skip
        """The left little finger's levers side by side, which turn about one axle and reach ``beyond`` it.

        A row is name, label, place and angle, and where its other end is; ``blade`` is height, length and width,
        ``axle`` place, width and height.
        """
        for name, label, along, angle, end in rows:
            rod = self.cross(axle[0], angle + 1.0, *axle[1:])
            touch = self.blade(along, angle, *blade, ahead=-1.0, foot=-0.42)
            self.work.key(
                name, label, "left.little.pad", rod, self.tail(touch, rod, end, angle + beyond), travel_m=travel_m
            )

    def side_keys(self, keys: list[tuple[Rod, Touch, Cup]]) -> None:
        """The right index finger's trill keys from the fourth to the first; both of a pair go down together."""
        work, middle, end = self.work, "right.index.side_middle", "right.index.side"
        for number, part, key in zip((4, 3, 2, 1), (middle, middle, end, end), keys, strict=True):
            rod, touch, cup = key
            work.key(f"key_side_{number}", f"S{number}", part, rod, touch, [cup], travel_m=0.0035)
        work.also(middle, "key_side_3", ("key_side_4",))
        work.also(end, "key_side_1", ("key_side_2",))


class Straight(Clarinet):
    """Builds one straight clarinet."""

    def __init__(self, sizes: Sizes) -> None:
        s, g = sizes.stretch, sizes.girth
        start = (0.0, sizes.reed.axis_y, sizes.reed.end_z + sizes.barrel)
        profile = [
            (0.0, 0.0144), (0.012, 0.0141), (0.150, 0.0141), (0.186, 0.0146), (0.1985, 0.0150), (0.2145, 0.0150),
            (0.225, 0.0144), (0.330, 0.0147), (0.385, 0.0160), (0.417, 0.0172),
        ]  # fmt: skip
        super().__init__(sizes, Wall(start, Z, Y, [(along * s, radius * g) for along, radius in profile]))

    def make(self) -> Keywork:
        """The whole instrument."""
        self.joints()
        self.left_hand()
        self.left_keys()
        self.right_hand()
        self.right_keys()
        return self.work

    def joints(self) -> None:
        """Mouthpiece, barrel, both joints, bell, and the thumb rest."""
        work, body, sizes = self.work, self.body, self.sizes
        reed, g = sizes.reed, sizes.girth
        work.add(reed.pieces())
        barrel = Wall(
            (0.0, reed.axis_y, reed.end_z), Z, Y,
            [(0.0, 0.0158 * g), (0.010, 0.0163 * g), (0.018, 0.0164 * g), (sizes.barrel * 0.6, 0.0156 * g),
             (sizes.barrel - 0.010, 0.0157 * g), (sizes.barrel, 0.0152 * g)],
        )  # fmt: skip
        work.model.add("grenadilla", barrel.skin(), body.skin())
        work.model.add("silver", barrel.collar(0.0, 0.006), barrel.collar(sizes.barrel - 0.006, 0.006))
        lower = self.at(UPPER)
        work.model.add("silver", body.collar(lower + 0.0005, 0.006), body.collar(self.at(LOWER) - 0.005, 0.005, 0.0008))
        work.add(bell(body, self.at(LOWER), sizes.bell, sizes.bell_radius))
        rest = thumb_rest(body, self.at(sizes.rest_along), 180.0)
        work.add(rest.pieces)
        work.contact("right.thumb.side", rest.point, rest.normal)

    def left_hand(self) -> None:
        """Holes and rings of the left hand."""
        work, body = self.work, self.body
        for name, label, finger, along, angle, radius, rim in (
            ("hole_T", "T", "thumb", 0.0880, 180.0, 0.0040, 0.0026),
            ("hole_L1", "L1", "index", 0.0980, 0.0, 0.0036, 0.0024),
            ("hole_L2", "L2", "middle", 0.1330, 0.0, 0.0040, 0.0024),
            ("hole_L3", "L3", "ring", 0.1660, 0.0, 0.0038, 0.0020),
        ):
            work.hole(name, label, f"left.{finger}.pad", body, along=self.at(along), angle_deg=angle,
                      radius=radius * self.sizes.girth, rim_m=rim)  # fmt: skip
        work.linked(
            "ring_thumb", ("hole_T",), self.rod(0.074, 0.106, 228.0),
            rings=[self.ring(0.0880, 180.0, 0.0080)], cups=[self.cup(0.1045, 262.0, 0.0050)],
        )  # fmt: skip
        work.linked(
            "ring_first", ("hole_L1",), self.rod(0.090, 0.121, -44.0),
            rings=[self.ring(0.0980)], cups=[self.cup(0.1160, -8.0, 0.0048)],
        )  # fmt: skip
        # The bridge: any ring of the right hand closes this one's pad as well.
        work.linked(
            "ring_second", ("hole_L2", "hole_R1", "hole_R2", "hole_R3"), self.rod(0.124, 0.194, -44.0),
            rings=[self.ring(0.1330)], cups=[self.cup(0.1500, -10.0, 0.0050)],
        )  # fmt: skip

    def left_keys(self) -> None:
        """Register key, throat keys, and the levers of the left little finger."""
        work, body = self.work, self.body
        register = self.at_end(
            self.blade(0.0685, 173.0, 0.0066, 0.0200, 0.0110, narrow=0.0055, rim=(0.0006, 0.0020)), 0.0070
        )
        work.key("key_R", "R", "left.thumb.pad", self.cross(0.0440, 180.0), register, [self.cup(0.0190, 180.0, 0.0046)],
                 travel_m=0.0045)  # fmt: skip
        # The thumb rolls onto the register key without leaving its hole.
        thumb = body.point(self.at(0.0880) - 0.0048 * self.sizes.girth, 180.0, 0.0026)
        work.also("left.thumb.pad", "hole_T", ("key_R",), point=thumb, normal=body.normal(180.0))

        throat_a = self.at_end(
            self.blade(0.0784, 7.5, 0.0096, 0.0210, 0.0068, narrow=0.0050, rim=(0.0024, 0.0014)), 0.0092, 0.0016
        )
        work.key("key_A", "A", "left.index.side", self.cross(0.0570, 4.0, height=0.0056), throat_a,
                 [self.cup(0.0340, 0.0, 0.0058)], travel_m=0.0040)  # fmt: skip
        throat_g = self.at_end(
            self.blade(0.0830, 26.0, 0.0096, 0.0180, 0.0066, narrow=0.0050, turn_deg=-3.0), 0.0060, -0.0010
        )
        work.key("key_G_sharp", "G#", "left.index.side", self.cross(0.0640, 32.0, height=0.0056), throat_g,
                 [self.cup(0.0460, 44.0, 0.0056)], travel_m=0.0040)  # fmt: skip
        sliver = self.blade(0.1505, 24.5, 0.0070, 0.0150, 0.0044)
        work.key("key_E_flat_left", "LEb", "left.ring.pad", self.rod(0.142, 0.160, 52.0, 0.0050), sliver,
                 [self.cup(0.1540, 84.0, 0.0056)], travel_m=0.0035)  # fmt: skip

        c_sharp = self.blade(0.1845, 24.0, 0.0085, 0.0125, 0.0090)
        work.key("key_C_sharp", "LC#", "left.little.pad", self.rod(0.168, 0.190, 58.0, 0.0055), c_sharp,
                 [self.cup(0.1760, 92.0, 0.0064)], travel_m=0.0035)  # fmt: skip
        rows = (
            ("key_F_sharp_left", "LF#", 0.2005, 26.0, 0.247),
            ("key_E_left", "LE", 0.1988, 44.0, 0.253),
            ("key_F_left", "LF", 0.1958, 62.0, 0.260),
        )
        self.levers(rows, (0.0100, 0.0175, 0.0060), (0.2260, 0.0085, 0.0060), 3.0, 0.0030)

    def right_hand(self) -> None:
        """Holes and rings of the right hand, and what the left little finger's levers close."""
        work, body = self.work, self.body
        for name, label, finger, along, radius in (
            ("hole_R1", "R1", "index", 0.2400, 0.0042),
            ("hole_R2", "R2", "middle", 0.2710, 0.0044),
            ("hole_R3", "R3", "ring", 0.3010, 0.0046),
        ):
            work.hole(name, label, f"right.{finger}.pad", body, along=self.at(along), angle_deg=0.0,
                      radius=radius * self.sizes.girth, rim_m=0.0024)  # fmt: skip
        work.linked(
            "rings_right", ("hole_R1", "hole_R2", "hole_R3"), self.rod(0.206, 0.309, -44.0),
            rings=[self.ring(0.2400, 0.0, 0.0080), self.ring(0.2710, 0.0, 0.0082), self.ring(0.3010, 0.0, 0.0084)],
            cups=[self.cup(0.2230, -10.0, 0.0060)],
        )  # fmt: skip
        work.linked("pad_F_sharp", F_SHARP, self.rod(0.250, 0.322, 78.0, 0.0046),
                    cups=[self.cup(0.3140, 50.0, 0.0076)], drop_m=0.0030)  # fmt: skip
        work.linked("pad_F", (*F, *E), self.rod(0.264, 0.378, 96.0, 0.0046),
                    cups=[self.cup(0.3690, 50.0, 0.0088)], drop_m=0.0032)  # fmt: skip
        work.linked("pad_E", E, self.rod(0.382, 0.406, 96.0, 0.0046),
                    cups=[self.cup(0.3960, 50.0, 0.0092)], drop_m=0.0034)  # fmt: skip

    def right_keys(self) -> None:
        """Trill keys at the side, the sliver key, and the cluster of the right little finger."""
        work = self.work
        sliver = self.blade(0.2860, -25.0, 0.0072, 0.0140, 0.0048)
        work.key("key_B", "RB", "right.ring.pad", self.rod(0.277, 0.295, -56.0, 0.0078), sliver,
                 [self.cup(0.2860, -88.0, 0.0056)], travel_m=0.0035)  # fmt: skip

        self.side_keys(
            [
                (
                    self.cross(axle, angle, 0.0080, 0.0060),
                    self.at_end(
                        self.blade(along, angle, self.sizes.side_height, 0.0105, 0.0047, rim=(0.0030, rim)), *end
                    ),
                    self.cup(hole, hole_angle, 0.0052),
                )
                for along, angle, axle, rim, end, hole, hole_angle in (
                    (0.2314, -72.5, 0.1920, 0.0, (0.0005, 0.0), 0.1620, -72.0),
                    (0.2316, -83.0, 0.1660, 0.0012, (0.0005, 0.0014), 0.1380, -96.0),
                    (0.2210, -68.5, 0.1440, 0.0, (0.0047, 0.0), 0.0740, -72.0),
                    (0.2208, -84.0, 0.1160, 0.0, (0.0047, 0.0), 0.0560, -96.0),
                )
            ]
        )

        front, outer = (2.0, 0.0050), (-104.0, 0.0050)
        cluster = {
            "RG#": ("key_A_flat", 0.3172, -42.0, self.rod(0.3125, 0.3340, *front), [self.cup(0.3320, 28.0, 0.0060)]),
            "RF#": ("key_F_sharp_right", 0.3185, -66.0, self.rod(0.314, 0.3265, *outer), []),
            "RF": ("key_F_right", 0.3286, -52.5, self.rod(0.3365, 0.350, *front), []),
            "RE": ("key_E_right", 0.3296, -71.0, self.rod(0.3290, 0.345, *outer), []),
        }
        for label, (name, along, angle, rod, cups) in cluster.items():
            touch = self.blade(along, angle, 0.0092, 0.0118, 0.0080, foot=0.0)
            work.key(name, label, "right.little.pad", rod, touch, cups, travel_m=0.0034)


def bell(body: Wall, along: float, length: float, radius: float) -> Pieces:
    """The bell: a flare of wood with a ring at its socket and one at its rim, dark inside."""
    start = np.asarray(body.start, float) + along * np.asarray(body.axis)
    r = body.radius(along)
    share = np.linspace(0, 1, 22)
    flare = r + 0.0022 + (radius - r - 0.0022) * (0.32 * share + 0.68 * share**3.4)
    socket = [(0, 0.6 * r), (0, r + 0.0022), (0.012, r + 0.0028), (0.020, r + 0.0026)]
    outer = [*socket, *((0.022 + (length - 0.022) * a, b) for a, b in zip(share, flare, strict=True))]
    rim = [(length, radius), (length + 0.0008, radius - 0.0012), (length + 0.0008, radius - 0.0095)]
    inside = [(length + 0.0008 - (length - 0.01) * a, (radius - 0.0095) * (1 - a) ** 1.2 + 0.0085 * a) for a in share]
    return [
        ("grenadilla", turned(start, Z, outer, sides=48)),
        ("grenadilla", turned(start, Z, rim, sides=48, proxy=False)),
        ("dark_plastic", turned(start, Z, inside, sides=40, proxy=False)),
        ("silver", turned(start, Z, [(0.0008, r), (0.0008, r + 0.0038), (0.0075, r + 0.0040), (0.0075, r)], sides=40,
                          proxy=False)),
        ("silver", turned(start, Z, [(length - 0.004, radius - 0.003), (length - 0.004, radius + 0.0004),
                                     (length + 0.0012, radius + 0.0006), (length + 0.0012, radius - 0.0030)], sides=48,
                          proxy=False)),
    ]  # fmt: skip


PEG = Pin(
    tube=(0.000, 0.074), tip=0.088, most_m=0.250, tip_profile=((0.016, 0.0062), (0.004, 0.0076), (0.0, 0.0060)),
    tip_material="rubber",
)  # fmt: skip


class Bass(Clarinet):
    """Builds the bass clarinet to low E flat: plates over all holes, a curved neck, the bell turned up, a peg.

    Real ones: bore 23.5 mm, body 40 mm thick and 0.8 m long, the mouthpiece about 68 degrees off the body, the bell
    150 mm wide, about 1.05 m from the neck to the bow. ``along`` counts from the upper end of the body.
    """

    BEND_DEG = 68.0
    LENGTH = 0.775

    def __init__(self) -> None:
        reed = SingleReed(
            tip_m=0.013, length=0.086, radius=0.0158, end_radius=0.0140, beak_length=0.037, tip_width=0.0155,
            table=0.0102, bite=0.0090, reed_length=0.0760, reed_width=0.0155, reed_thick=0.0034,
            ligature=(0.041, 0.066),
        )  # fmt: skip
        turn = np.radians(self.BEND_DEG)
        self.down = np.array([0.0, -np.sin(turn), np.cos(turn)])
        self.ahead = np.array([0.0, np.cos(turn), np.sin(turn)])
        self.corner = np.array([0.0, reed.axis_y, 0.1420])
        profile = [(0.0, 0.0205), (0.020, 0.0205), (0.030, 0.0196), (0.30, 0.0198), (self.LENGTH, 0.0212)]
        super().__init__(
            Sizes(reed=reed, keys=1.15), Wall(self.corner + 0.098 * self.down, self.down, self.ahead, profile)
        )

    def make(self) -> Keywork:
        """The whole instrument."""
        self.tubes()
        self.left_hand()
        self.right_hand()
        self.long_keys()
        return self.work

    def tubes(self) -> None:
        """Mouthpiece, neck, body, bow, bell and peg."""
        work, body, reed = self.work, self.body, self.sizes.reed
        work.add(reed.pieces())
        start = np.array([0.0, reed.axis_y, reed.end_z])
        work.model.add("cork", solid(start - 0.002 * Z, Z, [(0, 0.0118), (0.012, 0.0118)], sides=28))
        top = np.asarray(body.start)
        neck = bend([start + 0.006 * Z, self.corner, top + 0.012 * self.down], 0.046)
        run = lengths(neck) / lengths(neck)[-1]
        work.model.add("silver", tube(neck, 0.0108 + 0.0030 * run, sides=28))
        socket = [(-0.010, 0.0150), (-0.008, 0.0168), (0.0005, 0.0205)]
        work.model.add("silver", solid(top, self.down, socket, sides=36))
        work.model.add("grenadilla", body.skin(44))
        for along in (0.0005, 0.3000, 0.3060, self.LENGTH - 0.014):
            work.model.add("silver", body.collar(along, 0.006 if along < 0.5 else 0.0135))
        end = top + self.LENGTH * self.down
        out = unit(-0.94 * self.down + 0.34 * self.ahead)
        bow = bend([end - 0.004 * self.down, end + 0.082 * self.down, end + 0.082 * self.down + 0.112 * self.ahead,
                    end + 0.082 * self.down + 0.112 * self.ahead + 0.085 * out], [0.050, 0.050])  # fmt: skip
        share = lengths(bow) / lengths(bow)[-1]
        work.model.add("silver", tube(bow, 0.0205 + 0.0085 * share, sides=36))
        flare = np.linspace(0, 1, 26)
        radii = 0.0290 + 0.0470 * (0.30 * flare + 0.70 * flare**3.2)
        line = bow[-1] + np.outer(flare * 0.125, out)
        work.model.add("silver", tube(line, radii, sides=48, closed=False))
        inside = [(float(0.125 * a), float(r - 0.0008)) for a, r in zip(flare[::-1], radii[::-1], strict=True)]
        work.model.add("silver", turned(bow[-1], out, [*inside, (0.0, 0.0)], sides=48, proxy=False))
        rim = [(-0.0010, 0.0745), (0.0, 0.0768), (0.0012, 0.0760), (0.0012, 0.0745)]
        work.model.add("silver", turned(line[-1], out, rim, sides=48, proxy=False))
        foot = end + 0.082 * self.down + 0.012 * self.ahead
        flange = [(-0.004, 0.0140), (0.022, 0.0120), (0.026, 0.0090)]
        work.model.add("silver", solid(foot, self.down, flange, sides=24))
        stand(work, foot, self.down, PEG, -X)
        rest = thumb_rest(body, 0.3615, 180.0, reach=0.020, width=0.020)
        work.add(rest.pieces)
        work.contact("right.thumb.side", rest.point, rest.normal)

    def plate(self, label: str, part: str, along: float, radius: float) -> None:
        """A plate over a finger hole."""
        rod = self.body.rod(along - 0.0145, along + 0.0145, -46.0, 0.0050)
        self.work.plateau(f"hole_{label}", label, part, rod, self.cup(along, 0.0, radius))

    def left_hand(self) -> None:
        """Plates of the left hand, register and throat keys."""
        work, body = self.work, self.body
        thumb = self.cup(0.1600, 180.0, 0.0080)
        work.plateau("hole_T", "T", "left.thumb.pad", body.rod(0.142, 0.178, 228.0, 0.0050), thumb)
        plate = replace(self.cup(0.1720, 0.0, 0.0090), open_hole=0.0024)
        work.plateau("hole_L1", "L1", "left.index.pad", body.rod(0.158, 0.187, -46.0, 0.0050), plate, half_value=0.5)
        self.plate("L2", "left.middle.pad", 0.2040, 0.0095)
        self.plate("L3", "left.ring.pad", 0.2360, 0.0098)
        register = self.at_end(self.blade(0.1410, 166.0, 0.0092, 0.0160, 0.0100, narrow=0.0060), 0.0068)
        work.key("key_R", "R", "left.thumb.pad", self.cross(0.1170, 173.0), register, [self.cup(0.0600, 180.0, 0.0050)],
                 travel_m=0.0045)  # fmt: skip
        high = np.asarray(work.contacts[1]["point"]) - 0.0060 * self.down
        work.also("left.thumb.pad", "hole_T", ("key_R",), point=high)
        throat_a = self.at_end(self.blade(0.1520, 9.0, 0.0120, 0.0180, 0.0056, narrow=0.0050), 0.0080, 0.0010)
        work.key("key_A", "A", "left.index.side", self.cross(0.1280, 6.0, height=0.0062), throat_a,
                 [self.cup(0.0900, 4.0, 0.0076)])  # fmt: skip
        throat_g = self.at_end(self.blade(0.1576, 26.0, 0.0124, 0.0140, 0.0056, narrow=0.0050), 0.0058, -0.0016)
        work.key("key_G_sharp", "G#", "left.index.side", self.cross(0.1360, 29.0, height=0.0062), throat_g,
                 [self.cup(0.1040, 46.0, 0.0076)])  # fmt: skip
        sliver = self.blade(0.2200, 25.0, 0.0095, 0.0120, 0.0048)
        work.key("key_E_flat_left", "LEb", "left.ring.pad", body.rod(0.211, 0.231, 50.0, 0.0060), sliver,
                 [self.cup(0.2240, 80.0, 0.0080)], travel_m=0.0035)  # fmt: skip
        c_sharp = self.blade(0.2545, 21.0, 0.0110, 0.0118, 0.0086)
        work.key("key_C_sharp", "LC#", "left.little.pad", body.rod(0.242, 0.264, 54.0, 0.0060), c_sharp,
                 [self.cup(0.2500, 84.0, 0.0090)])  # fmt: skip
        rows = (
            ("key_F_sharp_left", "LF#", 0.2685, 22.0, 0.350),
            ("key_E_left", "LE", 0.2677, 33.5, 0.362),
            ("key_F_left", "LF", 0.2661, 47.0, 0.374),
        )
        self.levers(rows, (0.0115, 0.0135, 0.0056), (0.3180, 0.0070, 0.0065), 2.0, 0.0032)

    def right_hand(self) -> None:
        """Plates of the right hand, trill keys, sliver key and the five keys of the little finger."""
        work, body = self.work, self.body
        self.plate("R1", "right.index.pad", 0.3560, 0.0100)
        self.plate("R2", "right.middle.pad", 0.3880, 0.0105)
        self.plate("R3", "right.ring.pad", 0.4190, 0.0105)
        sliver = self.blade(0.4030, -25.0, 0.0105, 0.0105, 0.0048)
        work.key("key_B", "RB", "right.ring.pad", body.rod(0.3955, 0.4105, -58.0, 0.0095), sliver,
                 [self.cup(0.4030, -90.0, 0.0080)], travel_m=0.0035)  # fmt: skip
        self.side_keys(
            [
                (
                    self.cross(axle, angle, 0.0090, 0.0066),
                    self.at_end(self.blade(along, angle, 0.0120, 0.0092, 0.0042), end),
                    self.cup(hole, hole_angle, 0.0068),
                )
                for along, angle, axle, end, hole, hole_angle in (
                    (0.3505, -66.0, 0.2880, 0.0, 0.2560, -66.0),
                    (0.3505, -76.0, 0.2560, 0.0, 0.2240, -88.0),
                    (0.3476, -47.0, 0.2240, 0.0020, 0.1260, -66.0),
                    (0.3476, -56.5, 0.1880, 0.0020, 0.0960, -88.0),
                )
            ]
        )
        front, outer = (4.0, 0.0060), (-98.0, 0.0060)
        for name, label, along, angle, rod, cups in (
            ("key_A_flat", "RG#", 0.4372, -34.0, body.rod(0.4325, 0.490, *front), [self.cup(0.4820, 36.0, 0.0105)]),
            ("key_F_sharp_right", "RF#", 0.4378, -53.0, body.rod(0.431, 0.4415, *outer), []),
            ("key_F_right", "RF", 0.4463, -44.0, self.cross(0.4780, -34.0, 0.0100, 0.0066), []),
            ("key_E_right", "RE", 0.4468, -58.5, body.rod(0.4435, 0.4505, *outer), []),
            ("key_E_flat_low", "REb", 0.4426, -72.8, body.rod(0.4525, 0.4700, *outer), []),
        ):
            lever = label == "RF"
            touch = self.blade(along, angle, 0.0115, 0.0078, 0.0059, ahead=-1.0 if lever else 1.0, foot=-0.4 * lever)
            touch = self.tail(touch, rod, 0.5250, -26.0) if lever else touch
            work.key(name, label, "right.little.pad", rod, touch, cups, travel_m=0.0036)

    def long_keys(self) -> None:
        """The pads far down the body, which the little fingers close."""
        work, body = self.work, self.body
        low = ("key_E_flat_low",)
        for node, controls, rod, cup in (
            ("pad_F_sharp", F_SHARP, body.rod(0.352, 0.580, 52.0, 0.0055), self.cup(0.5620, 14.0, 0.0120)),
            ("pad_F", (*F, *E, *low), body.rod(0.376, 0.640, 72.0, 0.0055), self.cup(0.6230, 30.0, 0.0130)),
            ("pad_E", (*E, *low), body.rod(0.500, 0.700, -78.0, 0.0055), self.cup(0.6820, -34.0, 0.0135)),
            ("pad_E_flat", low, body.rod(0.710, 0.765, -78.0, 0.0055), self.cup(0.7400, -34.0, 0.0140)),
        ):
            work.linked(node, controls, rod, cups=[cup], drop_m=0.0045)


A_SIZES = Sizes(stretch=1.059, bell=0.110, hands_as_drawn=True)
E_FLAT_SIZES = Sizes(
    reed=SingleReed(tip_m=0.011, length=0.066, radius=0.0124, end_radius=0.0118, beak_length=0.030, tip_width=0.0118,
                    table=0.0080, bite=0.0072, reed_length=0.058, reed_width=0.0118, ligature=(0.032, 0.052)),
    barrel=0.042, stretch=0.765, girth=0.88, keys=0.84, bell=0.088, bell_radius=0.0330, rest_along=0.250,
    side_height=0.0126,
)  # fmt: skip

INSTRUMENTS = {
    "clarinet_Bb": entry(lambda: Straight(Sizes()).make()),
    "clarinet_A": entry(lambda: Straight(A_SIZES).make()),
    "clarinet_Eb": entry(lambda: Straight(E_FLAT_SIZES).make()),
    "clarinet_bass_Bb": entry(lambda: Bass().make()),
}
