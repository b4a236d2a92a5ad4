"""The oboe of the conservatoire system with plates, and the English horn.

Sizes of the oboe are those of common instruments: 590 mm without the reed (upper joint 233, lower 247, bell 110), which
shows 46 mm between the lips and the body; 21 mm thick under the top's bulge, 27 at the lower joint's end; the bell
58 mm wide with a small flare; plates of the first to third finger 65 mm apart in the left hand and 72 in the right.
The English horn, a fifth lower, is 750 mm long without the bocal: distances along its body are 1.2 to 1.33 times the
oboe's, the plates 1.12 times as far apart as the hand reaches; its bell is a pear 68 mm thick and 110 mm long; its
bocal, 4.5 mm at the reed, is 85 mm long and bent by about 35 degrees towards the player.

The model's frame: +Z along the reed away from the player, +Y the front with the plates, -Y the thumbs' side. Distances
``along`` are counted from the top of the wood.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from resources.build.instrument_keys import (
    Cup,
    Keywork,
    Pieces,
    Rod,
    Touch,
    Wall,
    entry,
    oval,
    slab,
    teardrop,
    with_tail,
)
from resources.build.instrument_mesh import bend, lengths, solid, tube, turned, unit
from resources.build.instrument_reeds import DoubleReed, thumb_rest

X, Y, Z = np.eye(3)


@dataclass(frozen=True)
class Sizes:
    """Differences of the oboe and the English horn.

    Attributes
    ----------
    reed : the reed; the wood or the bocal begins where it ends
    places : what the drawing's distances along the body, those of the oboe, become: (drawing, real) in ascending order
    girth : thickness over the oboe's
    bocal : its centre line from the reed's end, empty where the reed goes into the wood itself
    bell : (distance, radius) of the bell's outer profile, from the lower joint's end
    mouth_radius : the dark opening of the bell
    rest_along : the thumb rest, a real distance
    little : how far from the third finger's plate the right little finger's keys are, over the oboe's
    lowest : the keys of the left little finger for the notes below C, each of which closes those before it as well
    """

    reed: DoubleReed
    places: Sequence[tuple[float, float]]
    girth: float = 1.0
    bocal: Sequence[tuple[float, float, float]] = ()
    bell: Sequence[tuple[float, float]] = field(default_factory=tuple)
    mouth_radius: float = 0.021
    rest_along: float = 0.278
    little: float = 1.0
    lowest: tuple[str, ...] = ("key_B", "key_B_flat")


UPPER, LOWER = 0.233, 0.480
"""Place where the upper and the lower joint of the drawing end."""

PROFILE = (
    (0.0, 0.0128), (0.004, 0.0142), (0.013, 0.0150), (0.024, 0.0140), (0.036, 0.0112), (0.048, 0.0103), (0.120, 0.0107),
    (0.205, 0.0113), (0.222, 0.0122), (0.2335, 0.0128), (0.2505, 0.0128), (0.262, 0.0120), (0.340, 0.0123),
    (0.440, 0.0132), (0.462, 0.0142), (0.480, 0.0150),
)  # fmt: skip
"""Outer radius of the oboe's upper and lower joint: the bulge (baluster) at the top, sockets where the joints meet."""


class Oboe:
    """Builds an oboe or an English horn; the drawing is the oboe's."""

    def __init__(self, sizes: Sizes) -> None:
        self.sizes = sizes
        self.work = Keywork()
        end = sizes.reed.end_z
        if sizes.bocal:
            self.bocal = bend([np.array([0.0, 0.0, end - 0.004]), *(np.array(p, float) for p in sizes.bocal)], 0.060)
            start, axis = self.bocal[-1], unit(self.bocal[-1] - self.bocal[-2])
        else:
            self.bocal, start, axis = np.zeros((0, 3)), np.array([0.0, 0.0, end]), Z
        front = unit(Y - axis * (Y @ axis))
        profile = [(self.at(along), radius * sizes.girth) for along, radius in PROFILE]
        self.body = Wall(start, axis, front, profile)

    def at(self, along: float) -> float:
        """A distance of the drawing as it is on this instrument."""
        drawn, real = zip(*self.sizes.places, strict=True)
        return float(np.interp(along, drawn, real))

    def rod(self, start: float, end: float, angle: float, height: float = 0.0042) -> Rod:
        return self.body.rod(self.at(start), self.at(end), angle, height)

    def near(self, along: float, half: float, angle: float, height: float = 0.0042) -> Rod:
        """A short rod about a place; its length does not stretch."""
        middle = self.at(along)
        return self.body.rod(middle - half, middle + half, angle, height)

    def cup(self, along: float, angle: float, radius: float, hole: float = 0.0) -> Cup:
        return Cup(self.body, self.at(along), angle, radius * self.sizes.girth, rim_m=0.0012, open_hole=hole)

    def blade(
        self, along: float, angle: float, height: float, length: float, width: float, *, narrow: float | None = None,
        foot: float = -0.42, off: float = 0.0,
    ) -> Touch:  # fmt: skip
        """A spatula over the body; ``off`` is how much further than the drawing's place, and does not stretch."""
        outline = oval(length, width) if narrow is None else teardrop(length, width, narrow)
        return self.body.spatula(self.at(along) + off, angle, height, outline, foot=foot)

    def lever(self, touch: Touch, rod: Rod, along: float, angle: float) -> Touch:
        """A lever's other end beyond its axle, where it meets another key."""
        end = self.body.point(self.at(along), angle, 0.0045)
        return with_tail(touch, rod, end, self.body.normal(angle), 0.0015)

    def plate(self, label: str, part: str, along: float, radius: float) -> None:
        """A plate without a hole, on a short rod of its own."""
        rod, cup = self.near(along, 0.013, -52.0), self.cup(along, 0.0, radius)
        self.work.plateau(f"plate_{label}", label, part, rod, cup, opening_m=0.0030)

    def make(self) -> Keywork:
        """The whole instrument."""
        self.joints()
        self.left_hand()
        self.left_keys()
        self.right_hand()
        self.right_keys()
        self.long_keys()
        return self.work

    def joints(self) -> None:
        """Reed, bocal, both joints, bell, and the thumb rest."""
        work, body, sizes = self.work, self.body, self.sizes
        work.add(sizes.reed.pieces())
        if len(self.bocal):
            share = lengths(self.bocal) / lengths(self.bocal)[-1]
            work.model.add("silver", tube(self.bocal, 0.0024 + 0.0026 * share, sides=18))
            cork = [(-0.012, 0.0062), (0.002, 0.0068)]
            work.model.add("cork", solid(body.start, body.axis, cork, sides=20))
        work.model.add("grenadilla", body.skin())
        top = [(-0.0008, 0.0), (-0.0008, 0.0112), (0.0006, 0.0128), (0.0016, 0.0128), (0.0016, 0.0)]
        g = sizes.girth
        work.model.add("silver", turned(body.start, body.axis, [(a, r * g) for a, r in top], sides=36, proxy=False))
        for along, length in ((UPPER - 0.0045, 0.0040), (UPPER + 0.0012, 0.0040), (LOWER - 0.0045, 0.0045)):
            work.model.add("silver", body.collar(self.at(along), length, 0.0008))
        work.add(self.bell())
        rest = thumb_rest(body, sizes.rest_along, 180.0, reach=0.019)
        work.add(rest.pieces)
        work.contact("right.thumb.side", rest.point, rest.normal)

    def bell(self) -> Pieces:
        """The bell: wood with a ring at its socket and one at the rim, dark inside."""
        body, sizes = self.body, self.sizes
        start = np.asarray(body.start, float) + self.at(LOWER) * unit(body.axis)
        first = body.radius(self.at(LOWER))
        outline = [(along, radius) for along, radius in sizes.bell]
        length, edge = outline[-1]
        wood = [(0.0, first * 0.6), *outline, (length, sizes.mouth_radius)]
        inside = [(length, sizes.mouth_radius), (length - 0.012, sizes.mouth_radius - 0.003), (length - 0.040, 0.011),
                  (length - 0.042, 0.0)]  # fmt: skip
        ring = [(0.0004, first), (0.0004, outline[0][1] + 0.0009), (0.0052, outline[0][1] + 0.0010), (0.0052, first)]
        rim = [(length - 0.0036, edge - 0.002), (length - 0.0036, edge + 0.0004), (length + 0.0008, edge + 0.0003),
               (length + 0.0008, edge - 0.0022)]  # fmt: skip
        return [
            ("grenadilla", turned(start, body.axis, wood, sides=44)),
            ("dark_plastic", turned(start, body.axis, inside, sides=36, proxy=False)),
            ("silver", turned(start, body.axis, ring, sides=40, proxy=False)),
            ("silver", turned(start, body.axis, rim, sides=44, proxy=False)),
        ]

    def left_hand(self) -> None:
        """Plates of the left hand: the first with the small hole that a finger rolled aside leaves open."""
        work = self.work
        # The half-hole plate has a wing below its middle: rolled down there, the finger opens the hole in the middle.
        rod = self.near(0.1515, 0.016, -52.0)
        work.plateau("plate_L1", "L1", "left.index.pad", rod, self.cup(0.1490, 0.0, 0.0078, 0.0013),
                     opening_m=0.0030, half_value=0.85)  # fmt: skip
        self.plate("L2", "left.middle.pad", 0.1830, 0.0080)
        self.plate("L3", "left.ring.pad", 0.2140, 0.0080)
        # Small cups of C and B flat between the plates, which the plates also close.
        work.linked("cup_C", ("plate_L1",), self.rod(0.112, 0.132, -52.0), cups=[self.cup(0.1260, -4.0, 0.0058)],
                    drop_m=0.0025)  # fmt: skip
        work.linked("cup_B_flat", ("plate_L2", "plate_R1"), self.rod(0.198, 0.206, -58.0, 0.0050),
                    cups=[self.cup(0.1985, -14.0, 0.0056)], drop_m=0.0025)  # fmt: skip

    def left_keys(self) -> None:
        """Octave keys of the thumb and of the index finger's side, and the levers of the left little finger."""
        work, body = self.work, self.body
        first = self.blade(0.1540, 180.0, 0.0075, 0.0180, 0.0100, narrow=0.0060)
        work.key("octave_1", "oct1", "left.thumb.pad", body.cross_rod(self.at(0.1540) - 0.024, 180.0, 0.010, 0.0045),
                 first, [self.cup(0.0860, 180.0, 0.0048)], travel_m=0.0040)  # fmt: skip
        # Its touch leans towards the first finger, whose side rolls up against it.
        along = self.at(0.1490) - 0.0020
        lean = unit(body.normal(62.0) + 0.35 * unit(body.axis))
        second = slab(body.point(along, 63.0, 0.0200), lean, body.around(62.0), oval(0.0120, 0.0080), foot=0.0)
        work.key("octave_2", "oct2", "left.index.side_middle", self.rod(0.062, 0.150, 115.0, 0.0045), second,
                 [self.cup(0.0680, 70.0, 0.0046)], travel_m=0.0025)  # fmt: skip
        # The first finger does not leave its plate: it rolls, and its side presses the lever.
        plate = next(row for row in work.contacts if row["control"] == "plate_L1")
        work.contacts[-1] |= {key: plate[key] for key in ("part", "node", "point", "normal")} | {
            "together": ["plate_L1"]
        }
        for name, label, off, angle, wide, length in (
            ("key_G_sharp", "gis", 0.0153, 22.0, 0.0095, 0.0120),
            ("key_B", "b", 0.0270, 23.0, 0.0085, 0.0105),
            ("key_B_flat", "bes", 0.0253, 50.0, 0.0085, 0.0110),
            ("key_E_flat_left", "ees", 0.0135, 58.0, 0.0085, 0.0115),
            ("key_F_left", "f", 0.0020, 62.0, 0.0075, 0.0130),
        ):
            lowest = label in ("b", "bes")
            if lowest and name not in self.sizes.lowest:
                continue
            middle = self.at(0.2140) + off
            foot = -0.42 if lowest else 0.0
            touch = body.spatula(middle, angle, 0.0092, oval(length, wide), ahead=-1.0, foot=foot)
            if lowest:
                rod = body.cross_rod(middle + length / 2 + 0.0035, angle, 0.0080, 0.0062)
                touch = self.lever(touch, rod, 0.2660, 52.0)
            else:
                rod = body.rod(middle - 0.008, middle + 0.010, 43.0 if label == "gis" else 92.0, 0.0052)
            work.key(name, f"Lp_{label}", "left.little.pad", rod, touch, travel_m=0.0038)
        # The trill key for C to D lies towards the palm beside the ring finger's plate.
        trill = self.blade(0.2140, 31.0, 0.0110, 0.0150, 0.0054)
        work.key("key_D_trill", "Lr_d", "left.ring.pad", self.near(0.2060, 0.008, 72.0, 0.0052), trill,
                 travel_m=0.0032)  # fmt: skip
        work.linked("cup_D_trill", ("key_D_trill",), self.rod(0.1080, 0.1290, 72.0, 0.0048),
                    cups=[self.cup(0.1180, 106.0, 0.0050)], drop_m=-0.0025)  # fmt: skip
        work.linked("cup_G_sharp", ("key_G_sharp",), self.rod(0.2430, 0.2640, 76.0, 0.0050),
                    cups=[self.cup(0.2480, 112.0, 0.0058)], drop_m=-0.0026)  # fmt: skip

    def right_hand(self) -> None:
        """Plates of the right hand."""
        work = self.work
        self.plate("R1", "right.index.pad", 0.2680, 0.0082)
        self.plate("R2", "right.middle.pad", 0.3040, 0.0084)
        self.plate("R3", "right.ring.pad", 0.3400, 0.0084)
        work.linked("cup_F_sharp", ("plate_R2", "plate_R3"), self.rod(0.282, 0.2895, -58.0, 0.0050),
                    cups=[self.cup(0.2850, -14.0, 0.0056)], drop_m=0.0025)  # fmt: skip

    def right_keys(self) -> None:
        """The C sharp trill key of the middle finger, the F key of the ring finger, the three of the little finger."""
        work, body = self.work, self.body
        trill = self.blade(0.3040, -31.0, 0.0110, 0.0150, 0.0054)
        work.key("key_C_sharp_trill", "Rm_cis", "right.middle.pad", self.near(0.3040, 0.011, -84.0, 0.0052), trill,
                 travel_m=0.0032)  # fmt: skip
        work.linked("cup_C_sharp_trill", ("key_C_sharp_trill",), self.rod(0.1560, 0.1760, -84.0, 0.0048),
                    cups=[self.cup(0.1660, -118.0, 0.0050)], drop_m=-0.0025)  # fmt: skip
        fork = self.blade(0.3400, -34.0, 0.0110, 0.0150, 0.0056, off=0.0020)
        work.key("key_F", "Rr_f", "right.ring.pad", self.near(0.3400, 0.011, -84.0, 0.0052), fork,
                 travel_m=0.0032)  # fmt: skip
        work.linked("cup_F", ("key_F", "key_F_left"), self.rod(0.296, 0.3260, 70.0, 0.0048),
                    cups=[self.cup(0.3200, 104.0, 0.0060)], drop_m=-0.0028)  # fmt: skip
        for name, label, off, angle, wide, rod_angle in (
            ("key_E_flat", "ees", 0.0182, -22.0, 0.0110, 8.0),
            ("key_C_sharp", "cis", 0.0200, -56.0, 0.0095, -96.0),
            ("key_C", "c", 0.0312, -43.0, 0.0110, -88.0),
        ):
            middle = self.at(0.3400) + off * self.sizes.little
            rod = body.rod(middle - 0.008, middle + 0.010, rod_angle, 0.0050)
            touch = body.spatula(middle, angle, 0.0098, oval(0.0122 * self.sizes.little, wide), foot=0.0)
            work.key(name, f"Rp_{label}", "right.little.pad", rod, touch, travel_m=0.0038)

    def long_keys(self) -> None:
        """The cups down the lower joint and the bell that the little fingers open or close."""
        work = self.work
        low = ("key_C", *self.sizes.lowest)
        work.linked("cup_E_flat", ("key_E_flat", "key_E_flat_left"), self.rod(0.3520, 0.3880, 26.0, 0.0050),
                    cups=[self.cup(0.3800, -8.0, 0.0076)], drop_m=-0.0030)  # fmt: skip
        work.linked("cup_C_sharp", ("key_C_sharp", *low), self.rod(0.3860, 0.4140, -60.0, 0.0046),
                    cups=[self.cup(0.4050, -12.0, 0.0082)], drop_m=0.0030)  # fmt: skip
        work.linked("cup_C_low", low, self.rod(0.3800, 0.4420, -76.0, 0.0046), cups=[self.cup(0.4330, -30.0, 0.0086)],
                    drop_m=0.0032)  # fmt: skip
        work.linked("cup_B", self.sizes.lowest, self.rod(0.2660, 0.4660, 52.0, 0.0050),
                    cups=[self.cup(0.4590, 14.0, 0.0084)], drop_m=0.0032)  # fmt: skip


BELL = (
    (0.0, 0.0176), (0.012, 0.0180), (0.016, 0.0170), (0.050, 0.0190), (0.080, 0.0222), (0.098, 0.0262), (0.106, 0.0290),
    (0.110, 0.0296),
)  # fmt: skip

PEAR = (
    (0.0, 0.0200), (0.012, 0.0205), (0.017, 0.0196), (0.034, 0.0232), (0.052, 0.0300), (0.070, 0.0338), (0.084, 0.0338),
    (0.098, 0.0300), (0.108, 0.0246), (0.111, 0.0240),
)  # fmt: skip

OBOE = Sizes(
    reed=DoubleReed(staple=0.015), places=((0.0, 0.0), (0.6, 0.6)), bell=BELL, mouth_radius=0.0235, rest_along=0.2755
)
ENGLISH_HORN = Sizes(
    reed=DoubleReed(tip_m=0.007, blade=0.028, width=0.0082, throat=0.0034, thread=0.012, staple=0.004,
                    staple_radius=0.0034),
    places=((0.0, 0.0), (0.149, 0.189), (0.214, 0.256), (0.268, 0.314), (0.340, 0.386), (0.380, 0.450), (0.480, 0.640),
            (0.6, 0.76)),
    girth=1.10,
    bocal=((0.0, 0.0, 0.068), (0.0, -0.0365, 0.118)),
    bell=PEAR,
    mouth_radius=0.0165,
    rest_along=0.3215,
    little=0.86,
    lowest=("key_B",),
)  # fmt: skip

INSTRUMENTS = {"oboe": entry(lambda: Oboe(OBOE).make()), "english_horn": entry(lambda: Oboe(ENGLISH_HORN).make())}
