"""The bassoon of the Heckel system.

Sizes are those of common instruments: 1.34 m from the boot's cap to the bell's rim; boot 0.44 m, wing joint 0.46 m
above it, long joint and bell 0.90 m, of which the bell is 0.33; the bores 40 mm apart in an oval boot 98 mm wide and
58 mm deep; the bocal 0.32 m along its bend, 4 mm at the reed and 9 mm at the cork; the reed 54 mm long and 15 mm wide
at its tip. Finger holes are 37 mm apart in the left hand, 40 in the right.

The model's frame: origin between the lips, +Z along the reed away from the player, +Y up, +X the player's left, turned
as it is held: the boot at the right hip, the bell up to the left. The body has axes of its own: ``UP`` from boot to
bell, ``FRONT`` away from the player, where the fingers are (the thumbs' keys are at the back), ``LEFT`` across, from
the wing joint to the long joint. Distances ``along`` are counted down from the top of the wing joint.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from resources.build.instrument_joints import Joints
from resources.build.instrument_keys import Cup, Keywork, Touch, Wall, bodied, cylinder, entry, oval
from resources.build.instrument_mesh import Shape, bend, lengths, solid, tube, turned, unit
from resources.build.instrument_reeds import DoubleReed, loft

X, Y, Z = np.eye(3)

UP = unit([0.52, 0.82, 0.27])
FRONT = unit(Z + 0.10 * X - UP * ((Z + 0.10 * X) @ UP))
LEFT = np.cross(UP, FRONT)
SOCKET = np.array([0.070, -0.060, 0.200])
"""Top of the wing joint, where the bocal goes in."""

APART = 0.040
"""From bore to bore."""
BOOT_TOP, BOOT_END, BELL_START, BELL_END = 0.460, 0.900, -0.110, -0.440

REED = DoubleReed(
    tip_m=0.010, blade=0.028, width=0.0150, gap=0.0018, throat=0.0044, thread=0.014, staple=0.004, staple_radius=0.0034,
    thread_material="leather", staple_material="cork",
)  # fmt: skip


FLICKS = ("Lt_a", "Lt_c2", "Lt_d2")
FLICK_S = 0.15
"""Time a flick key is held for an attack (estimated: long enough for the note to speak, then let go at once)."""
JOINTS = Joints(SOCKET, UP, FRONT)
place, wall, touch = JOINTS.place, JOINTS.wall, JOINTS.touch


class Bassoon:
    """Builds the bassoon."""

    def __init__(self) -> None:
        self.work = Keywork()
        self.wing = wall(0.0, 0.0, [(0.0, 0.0175), (0.012, 0.0175), (0.016, 0.0160), (0.12, 0.0185), (0.28, 0.0200),
                                    (0.440, 0.0190), (0.444, 0.0205), (0.4605, 0.0205)])  # fmt: skip
        # The thick part the finger holes go through, slantwise, towards the long joint.
        self.flange = wall(0.008, 0.012, [(0.118, 0.004), (0.135, 0.0150), (0.150, 0.0175), (0.255, 0.0175),
                                          (0.270, 0.0150), (0.285, 0.004)])  # fmt: skip
        self.long = wall(APART, 0.0, [(BELL_START - 0.002, 0.0215), (BELL_START + 0.016, 0.0215), (-0.090, 0.0180),
                                      (0.20, 0.0185), (0.440, 0.0195), (0.444, 0.0215), (0.4605, 0.0215)])  # fmt: skip
        self.small = wall(0.0, 0.0, [(BOOT_TOP, 0.0290), (BOOT_END, 0.0290)])
        self.large = wall(APART, 0.0, [(BOOT_TOP, 0.0290), (BOOT_END, 0.0290)])
        self.bell = wall(APART, 0.0, [(BELL_END, 0.0270), (BELL_START, 0.0240)])

    def make(self) -> Keywork:
        """The whole instrument."""
        self.bodies()
        self.left_hand()
        self.left_thumb()
        self.right_hand()
        self.right_thumb()
        return self.work

    def bodies(self) -> None:
        """Reed, bocal, joints, boot and bell."""
        work = self.work
        work.add(REED.pieces())
        end = REED.end_z
        bocal = bend(
            [(0, 0, end - 0.006), (0.0, 0.004, 0.105), SOCKET + 0.105 * UP, SOCKET - 0.004 * UP], [0.080, 0.034]
        )
        share = lengths(bocal) / lengths(bocal)[-1]
        work.model.add("lacquered_brass", tube(bocal, 0.0024 + 0.0026 * share, sides=18))
        cork = [(-0.016, 0.0066), (0.001, 0.0072)]
        work.model.add("cork", solid(SOCKET, -UP, cork, sides=20))
        for piece in (self.wing, self.flange, self.long):
            work.model.add("maple", piece.skin(36))
        for piece, along, length in (
            (self.wing, 0.0, 0.010), (self.wing, 0.4450, 0.014), (self.long, 0.4450, 0.014),
            (self.long, BELL_START, 0.014),
        ):  # fmt: skip
            work.model.add("silver", piece.collar(along, length, 0.0008))
        work.model.add("maple", boot(BOOT_TOP + 0.001, BOOT_END - 0.024, 0.0))
        work.model.add("silver", boot(BOOT_TOP - 0.001, BOOT_TOP + 0.012, 0.0010, bodies=False))
        work.model.add("silver", boot(BOOT_END - 0.026, BOOT_END, 0.0012))
        start = place(APART, 0.0, BELL_START)
        bell = [
            (0.0, 0.0), (0.0, 0.0205), (0.006, 0.0225), (0.030, 0.0225), (0.036, 0.0205), (0.110, 0.0215),
            (0.190, 0.0250), (0.235, 0.0285), (0.262, 0.0270), (0.290, 0.0250), (0.312, 0.0250), (0.312, 0.016),
        ]  # fmt: skip
        work.model.add("maple", turned(start, UP, bell, sides=40))
        rim = [(0.312, 0.0170), (0.312, 0.0262), (0.320, 0.0275), (0.328, 0.0262), (0.330, 0.0240), (0.330, 0.0195)]
        inside = [(0.330, 0.0195), (0.300, 0.0180), (0.250, 0.0170), (0.250, 0.0)]
        work.model.add("ivory_plastic", turned(start, UP, rim, sides=40))
        work.model.add("dark_plastic", turned(start, UP, inside, sides=32, proxy=False))
        work.model.add(
            "silver",
            turned(start, UP, [(0.004, 0.02), (0.004, 0.0235), (0.012, 0.0237), (0.012, 0.02)], sides=40, proxy=False),
        )

    def left_hand(self) -> None:
        """Holes of the left fingers and the two keys of the little finger."""
        work = self.work
        for name, label, finger, along, half in (
            ("hole_L1", "L1", "index", 0.165, 0.5), ("hole_L2", "L2", "middle", 0.202, None),
            ("hole_L3", "L3", "ring", 0.238, None),
        ):  # fmt: skip
            work.hole(name, label, f"left.{finger}.pad", self.flange, along=along, angle_deg=18.0, radius=0.0040,
                      rim_m=0.0016, half_value=half, material="silver")  # fmt: skip
        normal = unit(np.cos(np.radians(18.0)) * FRONT + np.sin(np.radians(18.0)) * LEFT)
        for name, label, left, front, along, rod, cup in (
            ("key_E_flat", "Lp_es", 0.0199, 0.0350, 0.2540, self.wing.rod(0.246, 0.420, -40.0, 0.0140),
             Cup(self.wing, 0.4080, -20.0, 0.0100)),
            ("key_D_flat_low", "Lp_des", 0.0320, 0.0325, 0.2525, self.long.rod(0.258, 0.400, 40.0, 0.0060),
             Cup(self.long, 0.3860, 70.0, 0.0125)),
        ):  # fmt: skip
            work.key(name, label, "left.little.pad", rod, touch(left, front, along, normal, 0.0115, 0.0100), [cup],
                     travel_m=0.0040)  # fmt: skip

    def left_thumb(self) -> None:
        """Two rows of keys at the back: the upper on the wing joint, the lower on the long joint."""
        work = self.work
        back = -FRONT
        wing_row = (
            ("whisper", "Lt_w", 0.1900, Cup(self.wing, 0.0300, 186.0, 0.0056), 204.0),
            ("key_C_sharp", "Lt_cis", 0.1800, Cup(self.wing, 0.3100, 196.0, 0.0070), 216.0),
            ("key_A_high", "Lt_a", 0.1716, Cup(self.wing, 0.1050, 196.0, 0.0056), 228.0),
            ("key_C_high", "Lt_c2", 0.1642, Cup(self.wing, 0.0850, 206.0, 0.0056), 240.0),
            ("key_D_high", "Lt_d2", 0.1576, Cup(self.wing, 0.0620, 212.0, 0.0054), 252.0),
        )
        lefts = {"Lt_a": 0.0126, "Lt_c2": 0.0166, "Lt_d2": 0.0206, "Lt_bes": 0.0345}
        long_row = (
            ("key_D", "Lt_d", 0.1722, Cup(self.long, 0.3300, 168.0, 0.0135), 140.0),
            ("key_C", "Lt_c", 0.1632, Cup(self.long, 0.2500, 160.0, 0.0140), 126.0),
            ("key_B", "Lt_b", 0.1546, Cup(self.long, 0.0350, 176.0, 0.0140), 112.0),
            ("key_B_flat_low", "Lt_bes", 0.1470, Cup(self.bell, -0.1900, 176.0, 0.0150), 98.0),
        )
        for joint, row, left, front, size, travel_m in (
            (self.wing, wing_row, 0.0100, -0.0325, (0.0064, 0.0090), 0.0035),
            (self.long, long_row, 0.0320, -0.0265, (0.0074, 0.0105), 0.0038),
        ):
            for name, label, along, cup, angle in row:
                spatula = touch(lefts.get(label, left), front, along, back, *size)
                attack_s = FLICK_S if label in FLICKS else None
                JOINTS.thumb_key(work, name, label, joint, cup, spatula, along, angle, travel_m, attack_s)
        JOINTS.thumb_over_low_keys(work, "whisper")

    def key(
        self, name: str, label: str, part: str, joint: Wall, rod: Sequence[float], spatula: Touch,
        cups: Sequence[tuple[float, float, float]], travel_m: float,
    ) -> None:  # fmt: skip
        """A key of the right hand, its rod and its cups on one joint."""
        hung = [Cup(joint, *cup) for cup in cups]
        self.work.key(name, label, part, joint.rod(*rod), spatula, hung, travel_m=travel_m)

    def right_hand(self) -> None:
        """Two holes, the plate of the third finger, and three keys of the little finger."""
        work = self.work
        for name, label, finger, along in (("hole_R1", "R1", "index", 0.515), ("hole_R2", "R2", "middle", 0.553)):
            work.hole(name, label, f"right.{finger}.pad", self.small, along=along, angle_deg=-10.0, radius=0.0044,
                      rim_m=0.0020, material="silver")  # fmt: skip
        plate, vent = Cup(self.small, 0.592, -10.0, 0.0095), Cup(self.small, 0.626, 4.0, 0.0110)
        work.plateau("key_G", "R3", "right.ring.pad", self.small.rod(0.575, 0.640, 30.0, 0.0050), plate, [vent])
        for name, label, angle, along, wide, rod, cups in (
            ("key_F", "Rp_f", -28.0, 0.6088, 0.0120, (0.600, 0.735, 12.0, 0.0050), [(0.7200, -14.0, 0.0150)]),
            ("key_A_flat", "Rp_gis", -52.0, 0.6125, 0.0110, (0.604, 0.668, -86.0, 0.0050), [(0.6580, -50.0, 0.0110)]),
            ("key_F_sharp_little", "Rp_fis", -36.0, 0.6168, 0.0110, (0.6150, 0.690, -72.0, 0.0060), []),
        ):
            touch = self.small.spatula(along, angle, 0.0105, oval(0.0076, wide), foot=0.0)
            self.key(name, label, "right.little.pad", self.small, rod, touch, cups, 0.0040)

    def right_thumb(self) -> None:
        """Four keys at the back of the boot."""
        work = self.work
        back = -FRONT
        small, large, even, wide = self.small, self.large, (0.0115, 0.0125), (0.0115, 0.0130)
        for name, label, left, along, size, joint, rod, cups in (
            ("key_E", "Rt_e", 0.0115, 0.5352, even, large, (0.530, 0.840, 196.0), [(0.8200, 172.0, 0.0150)]),
            ("key_B_flat", "Rt_bes", -0.0020, 0.5270, even, small, (0.488, 0.532, 206.0), [(0.4980, 186.0, 0.0085)]),
            ("key_F_sharp", "Rt_fis", 0.0010, 0.5535, wide, small, (0.548, 0.760, 206.0), []),
            ("key_A_flat_thumb", "Rt_gis", 0.0135, 0.5506, (0.0095, 0.0090), large, (0.545, 0.680, 176.0), []),
        ):
            spatula = touch(left, -0.0412, along, back, *size)
            self.key(name, label, "right.thumb.pad", joint, (*rod, 0.0050), spatula, cups, 0.0038)
        work.linked("cup_F_sharp", ("key_F_sharp", "key_F_sharp_little"), self.small.rod(0.700, 0.775, 226.0, 0.0045),
                    cups=[Cup(self.small, 0.7620, 196.0, 0.0120)], drop_m=-0.0030)  # fmt: skip


def boot(start: float, end: float, over: float, *, bodies: bool = True) -> Shape:
    """The oval of the boot between two distances, ``over`` thicker; ends are a little rounded."""
    t = np.linspace(0, 2 * np.pi, 44, endpoint=False)
    r = 0.0290 + over
    rings = []
    for along, less in ((start, 0.0016), (start + 0.0012, 0.0), (end - 0.0020, 0.0), (end, 0.0024)):
        half = APART / 2
        across = half + np.where(np.cos(t) >= 0, half, -half) + (r - less) * np.cos(t)
        deep = (r - less) * np.sin(t)
        rings.append(np.array([place(a, f, along) for a, f in zip(across, deep, strict=True)])[::-1])
    if not bodies:
        return loft(rings)
    round_sides = [cylinder(place(left, 0, start), place(left, 0, end), r) for left in (0.0, APART)]
    middle = {
        "shape": "box", "centre_m": place(APART / 2, 0.0, (start + end) / 2),
        "half_m": np.array([APART / 2, r, (end - start) / 2]), "x_axis": LEFT, "y_axis": FRONT,
    }  # fmt: skip
    return bodied(loft(rings), *round_sides, middle)


INSTRUMENTS = {"bassoon": entry(lambda: Bassoon().make())}
