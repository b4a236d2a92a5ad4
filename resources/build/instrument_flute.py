"""The Boehm flutes: the concert flute with open holes and C foot, and the piccolo.

Sizes of the flute are those of common instruments: tube of 19 mm bore, 20 mm outside, 670 mm from crown to foot,
embouchure hole 12 x 10.5 mm in a plate 42 mm long; cups 16 mm wide, those of the ring finger offset to it. The tone
holes stand where Boehm's schema has them (A 442): from the middle of the embouchure ``663 mm x 2**(-n/12) - 52 mm``, n
semitones above C. The piccolo is half as long, without a foot, its body of wood 15 mm thick under a head of silver.

The model's frame: the origin where the lower lip lies on the plate, +Z ahead of the player across the hole, +Y up, the
tube along X with its foot at the player's right (-X). Distances ``along`` are counted from the embouchure hole's middle
to the foot; angles are from the top, positive on the side away from the player.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from resources.build.instrument_keys import (
    Cup,
    Keywork,
    Pieces,
    Rod,
    Touch,
    Wall,
    bodied,
    cylinder,
    entry,
    oval,
    post,
    roller,
    teardrop,
    with_pieces,
)
from resources.build.instrument_mesh import Array, Shape, tube, turned
from resources.build.instrument_reeds import creased

X, Y, Z = np.eye(3)
HINGE = -50.0
"""Angle of the common hinge of the cups, on the player's side."""
FIRST = 12.05
"""Place where the left index presses, in semitones above C: its cup stands between its own hole and the next."""
OFFSET = 16.0
"""Angle of the ring finger's cups, which stand nearer to it than the others in line ("offset G")."""
FOOT = 56.0
"""Angle of the foot's hinge, on the other side."""


@dataclass(frozen=True)
class Sizes:
    """Differences of flute and piccolo, in metres."""

    column: float = 0.6633
    """Acoustic length of the lowest C."""
    correction: float = 0.052
    """Length that the embouchure adds to it."""
    radius: float = 0.0100
    cup: float = 0.0080
    opening: float = 0.0032
    rise: float = 0.0022
    """Height of the tone holes' rims."""
    keys: float = 1.0
    head: float = 0.172
    """Distance in metres at which the head joint enters the body."""
    crown: float = 0.052
    plate: tuple[float, float, float] = (0.0210, 0.0165, 0.0125)
    """Half its length, and how far it reaches around the tube to the player and away."""
    plate_high: float = 0.0027
    axis: tuple[float, float, float] = (0.0, -0.0152, 0.0072)
    hole: tuple[float, float] = (0.0061, 0.0053)
    bearing: tuple[float, float] = (0.0014, 93.0)
    """Place where the tube lies on the left index finger: how far past its key, and at which angle."""
    g_sharp: float = 0.0212
    """Distance in metres of the G sharp key's touch before the gap between its neighbours."""
    trill_touch: tuple[float, float] = (-24.0, 0.0085)
    """Angle and height of the touches of the trill keys."""
    foot: bool = True
    open_hole: float = 0.0030
    head_material: str = "silver"
    body_material: str = "silver"

    def hole_along(self, semitones: float) -> float:
        """Return the place along the tube (m) of the hole that gives a note ``semitones`` above C when it is the first
        open hole."""
        return self.column * 2 ** (-semitones / 12) - self.correction


PICCOLO = Sizes(
    column=0.3317, correction=0.0285, radius=0.0073, cup=0.0058, opening=0.0024, rise=0.0016, keys=0.66, head=0.082,
    crown=0.036, plate=(0.0165, 0.0135, 0.0105), plate_high=0.0023, axis=(0.0, -0.0126, 0.0059), hole=(0.0052, 0.0045),
    bearing=(-0.0050, 118.0), g_sharp=0.0080, trill_touch=(-28.0, 0.0085), foot=False, open_hole=0.0,
    body_material="grenadilla",
)  # fmt: skip


class Flute:
    """Builds one flute."""

    def __init__(self, sizes: Sizes) -> None:
        self.sizes = sizes
        self.work = Keywork(hover_m=0.006)
        end = sizes.hole_along(0 if sizes.foot else 2)
        r = sizes.radius
        self.end = end
        self.body = Wall(np.array(sizes.axis), -X, Y, [(-sizes.crown, 0.90 * r), (sizes.head, r), (end, r)])

    def make(self) -> Keywork:
        """The whole instrument."""
        self.joints()
        self.plate()
        self.left_hand()
        self.right_hand()
        self.trills()
        if self.sizes.foot:
            self.foot()
        else:
            self.short_end()
        return self.work

    # -- parts

    def rod(self, start: float, end: float, angle: float, height: float = 0.0036, *, posts: bool = False) -> Rod:
        return replace(self.body.rod(start, end, angle, height * self.sizes.keys), posts=posts)

    def cup(self, along: float, angle: float = 0.0, *, share: float = 1.0, open_hole: bool = False) -> Cup:
        s = self.sizes
        inner = s.open_hole if open_hole else 0.0
        rim = s.rise if abs(angle) < 1e-6 else 0.7 * s.rise
        return Cup(self.body, along, angle, s.cup * share, rim_m=rim, open_hole=inner, rim_material=s.body_material)

    def blade(self, along: float, angle: float, height: float, outline: Array, *, foot: float, **turns: float) -> Touch:
        """A touch piece over the tube, of the size of this flute's keys."""
        return self.body.spatula(along, angle, height, outline * self.sizes.keys, foot=foot, **turns)

    def post(self, top: Array) -> Pieces:
        """A post at the end of a common hinge, with a body of its own: no rod goes through it."""
        foot = top - 0.0044 * self.body.normal(self.body.place(top)[1])
        up = self.body.normal(self.body.place(top)[1])
        (material, shape), *_ = post(self.body, top)
        return [(material, bodied(shape, cylinder(foot, top + 0.0016 * up, 0.0019)))]

    def joints(self) -> None:
        """Head joint with its crown, body and foot with their rings."""
        s, body, work = self.sizes, self.body, self.work
        r = s.radius
        skins = Wall(body.start, -X, Y, [(-s.crown, 0.90 * r), (0.0, 0.955 * r), (s.head - 0.017, 0.985 * r)])
        work.model.add(s.head_material, skins.skin(44))
        trunk = Wall(body.start, -X, Y, [(s.head - 0.018, r), (self.end, r)])
        work.model.add(s.body_material, trunk.skin(44))
        crown = [(-0.0105, 0.0), (-0.0105, 0.40 * r), (-0.0098, 0.72 * r), (-0.0085, 0.88 * r), (-0.0060, 0.97 * r),
                 (-0.0035, 0.99 * r), (-0.0028, 0.92 * r), (-0.0012, 0.92 * r), (-0.0006, 1.00 * r), (0.0012, 1.00 * r),
                 (0.0018, 0.90 * r)]  # fmt: skip
        work.model.add("silver", turned(body.point(-s.crown, 0) - 0.90 * r * Y, -X, crown, sides=40))
        barrel = [(0.0, 0.95 * r), (0.0, 1.06 * r), (0.0010, 1.11 * r), (0.0024, 1.11 * r), (0.0032, 1.05 * r),
                  (0.030, 1.05 * r), (0.0308, 1.11 * r), (0.0322, 1.11 * r), (0.0330, 0.98 * r)]  # fmt: skip
        size = 0.033 if s.foot else 0.020
        profile = [(place * size / 0.033, radius) for place, radius in barrel]
        work.model.add("silver", turned(self.axis(s.head - 0.018), -X, profile, sides=44))
        end_ring = [
            (-0.0032, 0.98 * r), (-0.0030, 1.07 * r), (-0.0006, 1.07 * r), (0.0002, 1.02 * r), (0.0002, 0.93 * r),
        ]  # fmt: skip
        work.model.add("silver", turned(self.axis(self.end), -X, end_ring, sides=44, proxy=False))
        inside = [(0.0006, 0.93 * r), (0.0001, 0.92 * r), (0.0001, 0.0)]
        work.model.add("dark_plastic", turned(self.axis(self.end), -X, inside[1:], sides=36, proxy=False))
        if s.foot:
            socket = 0.5 * (s.hole_along(4) + s.hole_along(3)) + 0.0005
            ring = [(-0.009, 0.98 * r), (-0.0088, 1.06 * r), (-0.0080, 1.10 * r), (-0.0068, 1.10 * r),
                    (-0.0060, 1.05 * r), (0.0040, 1.05 * r), (0.0046, 1.10 * r), (0.0058, 1.10 * r),
                    (0.0064, 0.98 * r)]  # fmt: skip
            work.model.add("silver", turned(self.axis(socket), -X, ring, sides=44, proxy=False))

    def axis(self, along: float) -> Array:
        """A point of the tube's axis."""
        return np.asarray(self.sizes.axis) - along * X

    def plate(self) -> None:
        """The lip plate with the embouchure hole, as a polar net about the hole."""
        s = self.sizes
        half, near, far = s.plate
        t = np.linspace(0, 2 * np.pi, 56, endpoint=False)
        side = np.where(np.sin(t) < 0, near, far)
        outline = np.column_stack([half * np.sign(np.cos(t)) * np.abs(np.cos(t)) ** 0.82, side * np.sin(t)])
        hole = np.column_stack([s.hole[0] * np.cos(t), s.hole[1] * np.sin(t)])
        base = 0.955 * s.radius

        def ring(share: float, height: float) -> Array:
            place = (1 - share) * hole + share * outline
            angle = place[:, 1] / (base + s.plate_high)
            out = np.cos(angle)[:, None] * Y + np.sin(angle)[:, None] * Z
            return np.asarray(s.axis) - place[:, :1] * X + (base + height) * out

        high = s.plate_high
        rings = [ring(0.0, -0.002), ring(0.0, high - 0.0004), ring(0.012, high), ring(0.15, high + 0.0001)]
        rings += [ring(share, high - (high - 0.0007) * share**2.2) for share in (0.3, 0.45, 0.6, 0.75, 0.88, 0.97)]
        rings += [ring(1.0, 0.0004), ring(1.0, -0.0006)]
        self.work.model.add("silver", net(rings))
        floor = [ring(0.0, -0.0016)]
        self.work.model.add("dark_plastic", net([floor[0], np.tile(floor[0].mean(axis=0), (len(t), 1))], inward=True))

    # -- keys

    def left_hand(self) -> None:
        """Fingers of the left hand over the upper body, thumb keys under it, the G sharp key."""
        s, work, body = self.sizes, self.work, self.body
        at, k = s.hole_along, s.keys
        vent = self.cup(at(13) - 0.018 * k, 0.0, share=0.55)
        first = self.cup(at(FIRST), 0.0, share=0.82)
        self.finger("L1", "left.index", first, [vent], at(13) - at(FIRST) - 0.0240 * k, 0.0080 * k)
        # The finger that bears the tube curls around it: its pad comes to lie behind the middle of its cup.
        work.contacts[-1]["point"] -= 0.0020 * k * Z
        bearing = at(FIRST) + s.bearing[0], s.bearing[1]
        work.contact("left.index.pad_proximal", body.point(*bearing), body.normal(bearing[1]))
        self.linked("cup_A_sharp", ("key_L2", "key_R1"), at(11))
        self.finger("L2", "left.middle", self.cup(at(10), open_hole=True), [], -0.0095 * k, 0.0095 * k)
        both = [self.cup(at(8), OFFSET)]
        third = self.cup(at(9), OFFSET, open_hole=True)
        self.finger("L3", "left.ring", third, both, -0.0095 * k, at(8) - at(9) + 0.0095 * k)
        for along in (at(13) - 0.026 * k, at(FIRST) + 0.0100 * k, at(8) + 0.0120 * k):
            work.add(self.post(body.point(along, HINGE, 0.0036 * k)))

        gap = 0.5 * (at(8) + at(7))
        touch = self.blade(gap - s.g_sharp, 75.0, 0.0110 * k, teardrop(0.0240, 0.0095, 0.0070), lean_deg=-10.0,
                           turn_deg=-8.0, foot=0.35)  # fmt: skip
        work.key("key_G_sharp", "G#", "left.little.pad", self.rod(gap - 0.003 * k, gap + 0.003 * k, HINGE), touch,
                 travel_m=0.0036, clear_m=0.0045 * k)  # fmt: skip
        far = self.rod(at(8) - 0.004 * k, at(8) + 0.012 * k, 98.0, posts=True)
        work.linked("cup_G_sharp", ("key_G_sharp",), far, cups=[self.cup(at(8) + 0.004 * k, 142.0, share=0.85)],
                    drop_m=-s.opening)  # fmt: skip

        edge = 0.92 * s.cup
        for name, label, along, length in (
            ("key_T", "T", at(12) + edge + 0.0024 * k, 0.0180),
            ("key_T_B_flat", "TBb", at(12) - edge - 0.0052 * k, 0.0140),
        ):
            touch = self.blade(along, -120.0, 0.0085 * k, oval(length, 0.0125), foot=0.0)
            rod = self.rod(along - 0.003 * k, along + 0.003 * k, 168.0, 0.0028)
            work.key(name, label, "left.thumb.pad", rod, touch, travel_m=0.0034)
        thumb = ("key_T", "key_T_B_flat")
        for node, controls, semitones in (("cup_thumb_B", thumb, 12), ("cup_thumb_B_flat", thumb[1:], 11)):
            rod = self.rod(at(semitones) - 0.007 * k, at(semitones) + 0.007 * k, 152.0, 0.0022, posts=True)
            flat = replace(self.cup(at(semitones), -166.0, share=0.92), thick_m=0.0024)
            work.linked(node, controls, rod, cups=[flat], drop_m=0.7 * s.opening)

    def finger(self, label: str, finger: str, cup: Cup, others: list[Cup], before: float, after: float) -> None:
        """A cup that a finger presses, on the common hinge of its hand."""
        rod = self.rod(cup.along + before, cup.along + after, HINGE)
        self.work.plateau(f"key_{label}", label, f"{finger}.pad", rod, cup, others, opening_m=self.sizes.opening)

    def linked(self, node: str, controls: tuple[str, ...], along: float) -> None:
        """A cup without a finger on the common hinge."""
        rod = self.rod(along - 0.0095 * self.sizes.keys, along + 0.0095 * self.sizes.keys, HINGE)
        self.work.linked(node, controls, rod, cups=[self.cup(along)], drop_m=self.sizes.opening)

    def right_hand(self) -> None:
        """Fingers of the right hand, and its thumb under the tube."""
        s, work, body = self.sizes, self.work, self.body
        at, k = s.hole_along, s.keys
        self.linked("cup_F_sharp", ("key_R1", "key_R2", "key_R3"), at(7))
        for sign, finger, semitones in (("R1", "index", 6), ("R2", "middle", 5), ("R3", "ring", 4)):
            cup = self.cup(at(semitones), open_hole=True)
            self.finger(sign, f"right.{finger}", cup, [], -0.0095 * k, 0.0095 * k)
        work.contact("right.thumb.pad", body.point(at(6), -146.0), body.normal(-146.0))
        for along in (at(7) - 0.0115 * k, at(4) + 0.0110 * k):
            work.add(self.post(body.point(along, HINGE, 0.0036 * k)))

    def trills(self) -> None:
        """The two trill keys between the right hand's cups, and the lever for B flat."""
        s, work = self.sizes, self.work
        at, k = s.hole_along, s.keys
        middle = [0.4 * at(a) + 0.6 * at(b) for a, b in ((6, 5), (5, 4), (7, 6))]
        long = [self.rod(at(13) - 0.052 * k, middle[0] + 0.004 * k, -66.0, 0.0022, posts=True),
                self.rod(at(13) - 0.068 * k, middle[1] + 0.004 * k, -80.0, 0.0020, posts=True),
                self.rod(at(10), middle[2] + 0.001 * k, -94.0, 0.0020, posts=True)]  # fmt: skip
        holes = [self.cup(at(13) - 0.042 * k, 0.0, share=0.50), self.cup(at(13) - 0.058 * k, 0.0, share=0.50),
                 self.cup(at(10) + 0.006 * k, -168.0, share=0.6)]  # fmt: skip
        for index, (name, sign, finger) in enumerate((
            ("key_trill_1", "tr1", "middle"), ("key_trill_2", "tr2", "ring"), ("key_trill_B_flat", "trA#", "index"),
        )):  # fmt: skip
            touch = self.blade(middle[index], *s.trill_touch, oval(0.0068, 0.0120), foot=0.0)
            work.key(name, sign, f"right.{finger}.pad", long[index], touch, [holes[index]], travel_m=0.0025,
                     clear_m=0.0065 * k)  # fmt: skip

    def foot(self) -> None:
        """The foot joint down to C with the keys of the right little finger."""
        s, work, body = self.sizes, self.work, self.body
        at = s.hole_along
        # All hang on a hinge on the far side; their arms reach over the tube between the cups to the player's side.
        eb = self.blade(at(3) - 0.0055, -46.0, 0.0095, teardrop(0.0230, 0.0105, 0.0075), ahead=-1.0, lean_deg=22.0,
                        turn_deg=14.0, foot=0.30)  # fmt: skip
        work.key("key_E_flat", "Eb", "right.little.pad", self.rod(at(3) - 0.0145, at(3) - 0.0105, FOOT), eb,
                 travel_m=0.0036)  # fmt: skip
        work.linked("cup_E_flat", ("key_E_flat",), self.rod(at(3) - 0.0085, at(3) + 0.0085, FOOT),
                    cups=[self.cup(at(3))], drop_m=-s.opening)  # fmt: skip
        lows = (("key_C_sharp", "C#", 0.0079, 0.0038, -47.0, 0.0100), ("key_C", "C", 0.0113, 0.0036, -47.0, 0.0102))
        for name, sign, off, wide, angle, high in lows:
            along = at(3) + off
            touch = self.blade(along, angle, high, oval(wide, 0.0140), lean_deg=22.0, foot=0.0)
            if sign == "C":
                ends = [body.point(along, angle + swing, high - 0.0012) for swing in (-18.0, 18.0)]
                touch = with_pieces(touch, roller(*ends, radius=0.0018))
            axle = self.rod(along - 0.0022, along + 0.0022, FOOT)
            work.key(name, sign, "right.little.pad", axle, touch, travel_m=0.0030)
        # Each lower key closes the cups of the higher ones as well.
        names = tuple(name for name, *_ in lows)
        for number, (node, semitones) in enumerate((("cup_C_sharp", 2), ("cup_C", 1))):
            part = self.rod(at(semitones) - 0.0100, at(semitones) + 0.0100, FOOT)
            work.linked(node, names[number:], part, cups=[self.cup(at(semitones))], drop_m=s.opening)
        long = self.rod(at(3) - 0.0150, at(1) + 0.0105, FOOT)
        work.model.add("silver", tube([self.rod(at(2), at(1), FOOT).a, long.b], 0.0014, sides=8))
        for end in (long.a, long.b):
            work.add(self.post(end))

    def short_end(self) -> None:
        """The piccolo's only key of the right little finger."""
        s, work = self.sizes, self.work
        at, k = s.hole_along, s.keys
        eb = self.blade(at(3) - 0.0005, -44.0, 0.0090 * k, teardrop(0.0230, 0.0120, 0.0085), ahead=-1.0, lean_deg=20.0,
                        turn_deg=12.0, foot=0.0)  # fmt: skip
        work.key("key_E_flat", "Eb", "right.little.pad", self.rod(at(3) - 0.0085 * k, at(3) - 0.0055 * k, FOOT), eb,
                 travel_m=0.0030)  # fmt: skip
        work.linked("cup_E_flat", ("key_E_flat",), self.rod(at(3) - 0.0050 * k, at(3) + 0.0060 * k, FOOT),
                    cups=[self.cup(at(3))], drop_m=-s.opening)  # fmt: skip


def net(rings: list[Array], *, inward: bool = False) -> Shape:
    """A skin over rings of points about the top of the tube, seen from outside."""
    count = len(rings[0])
    faces = []
    for layer in range(len(rings) - 1):
        for index in range(count):
            a, b = layer * count + index, layer * count + (index + 1) % count
            faces += [(a, a + count, b + count), (a, b + count, b)]
    corners = np.array(faces)
    points = np.vstack(rings)
    return creased(points, corners[:, ::-1] if inward else corners, 40.0)


INSTRUMENTS = {"flute": entry(lambda: Flute(Sizes()).make()), "piccolo": entry(lambda: Flute(PICCOLO).make())}
