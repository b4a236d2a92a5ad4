"""The contrabassoon of the Heckel system: five and a half metres of tube folded to a body of 1.2 m on an endpin.

Sizes are those of common instruments: about 135 cm high; the bocal 0.4 m along its bend, the reed 70 mm long and 18 mm
wide at its tip. The tube goes down the narrow joint under the bocal, up the second and down the third, which a metal
bow joins at the top, and through a wide bow below up the bell joint at the player's left, whose brass bell turns over
and points down. All finger holes are closed by padded keys, whose touches lie a hand's width together: the left hand
takes hold of the second joint from the left, its fingers over the narrow one; the right hand of the third joint from
the right. 30 mm from finger to finger in the left hand, 31 in the right.

The model's frame: origin between the lips, +Z along the reed away from the player, +Y up, +X the player's left. The
body stands before the player, its lower end a little to the right and ahead. Its own axes are ``UP``, ``FRONT`` (away
from the player, where the fingers are; the thumbs' keys are at the back) and ``LEFT``; distances ``along`` are counted
down from where the bocal goes in.
"""

from __future__ import annotations

import numpy as np

from resources.build.instrument_endpin import Pin, stand
from resources.build.instrument_joints import Joints
from resources.build.instrument_keys import Cup, Keywork, Wall, bodied, cylinder, entry, oval
from resources.build.instrument_mesh import Array, bend, half_circle, joined, lengths, solid, tube, turned, unit
from resources.build.instrument_reeds import DoubleReed

X, Y, Z = np.eye(3)

UP = unit([0.055, 0.995, -0.040])
FRONT = unit(Z - UP * (Z @ UP))
LEFT = np.cross(UP, FRONT)
SOCKET = np.array([0.004, -0.055, 0.235])
"""Top of the narrow joint, where the bocal goes in."""

NARROW, SECOND, THIRD, BELL = 0.0, 0.040, -0.052, 0.156
"""Place where the joints' bores lie from right to left."""
BEHIND = -0.004
"""Measure of how far the second joint stands behind the others, out of the little finger's way."""
TOP, END, BOW = 0.050, 0.912, 0.997
"""Place where second and third joint begin, where all end, and the lowest point of the wide bow."""
PIN = Pin(tube=(-0.156, 0.032), tip=0.036, most_m=0.170, tip_profile=((0.012, 0.0048), (0.0, 0.0016)), kept_m=0.014)
"""Places of the endpin, whose tube goes through the wide bow and up between second joint and bell joint."""

REED = DoubleReed(
    tip_m=0.011, blade=0.036, width=0.0180, gap=0.0020, throat=0.0050, thread=0.016, staple=0.004, staple_radius=0.0040,
    thread_material="leather", staple_material="cork",
)  # fmt: skip


JOINTS = Joints(SOCKET, UP, FRONT)
place, wall, touch = JOINTS.place, JOINTS.wall, JOINTS.touch


def pad(on: Wall, along: float, angle_deg: float, radius: float, rim_m: float = 0.0015) -> Cup:
    """A padded cup over a hole with a rim of wood."""
    return Cup(on, along, angle_deg, radius, rim_m=rim_m, rim_material="maple")


def around(start: Array, end: Array, outward: Array, radius: float) -> dict[str, object]:
    """The collision body of a half circle of tube: the whole ring, whose other half lies where no one reaches."""
    across = (end - start) / 2
    return {"shape": "ring", "centre_m": (start + end) / 2, "axis": unit(np.cross(across, outward)),
            "radius_m": float(np.linalg.norm(across)), "tube_radius_m": radius}  # fmt: skip


class Contrabassoon:
    """Builds the contrabassoon."""

    def __init__(self) -> None:
        self.work = Keywork()
        self.narrow = wall(NARROW, 0.0, [(0.0, 0.0168), (0.30, 0.0178), (END, 0.0178)])
        self.second = wall(SECOND, BEHIND, [(TOP, 0.0174), (END, 0.0174)])
        self.third = wall(THIRD, 0.0, [(TOP, 0.0243), (TOP + 0.024, 0.0243), (TOP + 0.028, 0.0233), (0.38, 0.0236),
                                       (0.52, 0.0240), (0.60, 0.0250), (END - 0.030, 0.02714), (END - 0.026, 0.0285),
                                       (END, 0.0285)])  # fmt: skip
        self.bell = wall(BELL, 0.0, [(-0.130, 0.0384), (-0.104, 0.0384), (-0.100, 0.0374), (0.40, 0.0350),
                                     (END - 0.030, 0.03373), (END - 0.026, 0.0345), (END, 0.0345)])  # fmt: skip

    def make(self) -> Keywork:
        """The whole instrument."""
        self.bocal()
        self.joints()
        self.bows()
        self.left_hand()
        self.left_thumb()
        self.right_hand()
        self.right_thumb()
        self.large_pads()
        return self.work

    def bocal(self) -> None:
        """Reed and the curved bocal with its slide."""
        work = self.work
        work.add(REED.pieces())
        line = bend(
            [(0, 0, REED.end_z - 0.006), (0.0, 0.020, 0.135), SOCKET + 0.105 * UP, SOCKET + 0.020 * UP],
            [0.080, 0.040],
            0.007,
        )
        share = lengths(line) / lengths(line)[-1]
        work.model.add("silver", tube(line, 0.0028 + 0.0036 * share, sides=16))
        slide = [(-0.032, 0.0080), (-0.028, 0.0092), (-0.022, 0.0080), (-0.004, 0.0086), (0.002, 0.0110)]
        work.model.add("silver", solid(SOCKET, -UP, slide, sides=24))

    def joints(self) -> None:
        """The four wooden joints with their rings, and the struts between them."""
        add = self.work.model.add
        for piece in (self.narrow, self.second, self.third, self.bell):
            add("maple", piece.skin(36))
            first, last = piece.profile[0][0], piece.profile[-1][0]
            add("silver", piece.collar(first, 0.012, 0.0009), piece.collar(last - 0.014, 0.014, 0.0009))
        for along in (0.355, 0.800):
            ends = [place(THIRD, -0.006, along), place(BELL, -0.006, along)]
            add("silver", tube(ends, 0.0045, sides=12))
        for piece in (self.narrow, self.second, self.third, self.bell):
            add("silver", piece.collar(0.790, 0.020, 0.0010))

    def bows(self) -> None:
        """Bows of metal at the top and below, the brass bell and the endpin."""
        add = self.work.model.add
        bulge = 0.55 * UP + 0.85 * FRONT
        top = (place(SECOND, BEHIND, TOP), place(THIRD, 0.0, TOP))
        low = (place(NARROW, 0.0, END), place(SECOND, BEHIND, END))
        for (start, end), outward, radius in ((top, bulge, 0.0150), (low, -UP, 0.0150)):
            line = joined([start - 0.004 * outward], half_circle(start, end, outward, 14), [end - 0.004 * outward])
            add("silver", bodied(tube(line, radius, sides=20, proxy=False), around(start, end, outward, radius)))
        corners = [place(THIRD, 0.0, END - 0.004), place(THIRD, 0.0, BOW), place(BELL, 0.0, BOW),
                   place(BELL, 0.0, END - 0.004)]  # fmt: skip
        wide, turning = bend(corners, [0.046, 0.046], 0.007), 0.046
        bodies = [
            around(place(left, 0.0, BOW - turning), place(left + 2 * inward, 0.0, BOW - turning), -UP, 0.0235)
            for left, inward in ((THIRD, turning), (BELL, -turning))
        ]
        bodies += [cylinder(corners[0], place(THIRD, 0.0, BOW - turning), 0.0235),
                   cylinder(place(THIRD + turning, 0.0, BOW), place(BELL - turning, 0.0, BOW), 0.0235),
                   cylinder(place(BELL, 0.0, BOW - turning), corners[3], 0.0235)]  # fmt: skip
        add("silver", bodied(tube(wide, 0.0235, sides=24, proxy=False), *bodies))
        start = place(BELL, 0.0, -0.122)
        begin, end = start + 0.020 * UP, start + 0.020 * UP + 0.112 * LEFT
        line = joined([start], half_circle(begin, end, UP, 20), [end - 0.065 * UP, end - 0.140 * UP])
        share = np.clip((lengths(line) / lengths(line)[-1] - 0.55) / 0.45, 0, 1)
        flare = 0.0345 + 0.0060 * share + 0.0100 * share**4
        cone: dict[str, object] = {"shape": "cone", "a_m": end, "b_m": line[-1], "radius_a_m": 0.0350,
                                   "radius_b_m": 0.0495}  # fmt: skip
        curve = (cylinder(start, begin, 0.0345), around(begin, end, UP, 0.0350), cone)
        add("lacquered_brass", bodied(tube(line, flare, sides=36, proxy=False), *curve))
        end, r = line[-1], float(flare[-1])
        rim = [(-0.006, r - 0.002), (-0.004, r + 0.0022), (0.000, r + 0.0034), (0.003, r + 0.0020), (0.004, r - 0.002)]
        add("lacquered_brass", turned(end, -UP, rim, sides=44))
        inside = [(0.0035, r - 0.001), (0.0038, 0.90 * r), (0.0038, 0.0)]
        add("inner_brass", turned(end, -UP, inside, sides=36, proxy=False))
        stand(self.work, place(0.085, 0.0, BOW), -UP, PIN, -LEFT)

    def left_hand(self) -> None:
        """Three plates on the narrow joint, between the last two the E flat key, and two keys of the little finger."""
        work = self.work
        for name, label, finger, along, angle, far in (
            ("key_L1", "L1", "index", 0.188, -40.0, 0.3200), ("key_L2", "L2", "middle", 0.218, -54.0, 0.3520),
            ("key_L3", "L3", "ring", 0.248, -68.0, 0.3840),
        ):  # fmt: skip
            rod = self.narrow.rod(along - 0.008, far + 0.008, angle, 0.0050)
            work.plateau(name, label, f"left.{finger}.pad", rod, pad(self.narrow, along, 25.0, 0.0078, rim_m=0.0075),
                         [pad(self.narrow, far, -8.0, 0.0105)], opening_m=0.0035)  # fmt: skip
        third = self.narrow.spatula(0.233, 25.0, 0.0142, oval(0.0078, 0.0120), foot=0.0)
        work.key("key_E_flat_third", "Lr_es", "left.ring.pad", self.narrow.rod(0.227, 0.302, 62.0, 0.0060), third,
                 [pad(self.narrow, 0.2960, 34.0, 0.0070)], travel_m=0.0035)  # fmt: skip
        normal = unit(np.cos(np.radians(18.0)) * FRONT + np.sin(np.radians(18.0)) * LEFT)
        for name, label, left, front, along, rod, cup in (
            ("key_E_flat", "Lp_es", 0.0205, 0.0410, 0.2720, self.narrow.rod(0.312, 0.436, 70.0, 0.0120),
             pad(self.narrow, 0.4250, 24.0, 0.0105)),
            ("key_D_flat_low", "Lp_des", 0.0335, 0.0390, 0.2730, self.second.rod(0.277, 0.420, 40.0, 0.0060),
             pad(self.second, 0.4060, 70.0, 0.0125)),
        ):  # fmt: skip
            work.key(name, label, "left.little.pad", rod, touch(left, front, along, normal, 0.0115, 0.0100), [cup],
                     travel_m=0.0040)  # fmt: skip

    def left_thumb(self) -> None:
        """Three keys at the back of the narrow joint, above them two vents; four low keys on the second joint."""
        work, back = self.work, -FRONT
        for name, label, left, along, cup, angle in (
            ("key_C_sharp", "Lt_cis", 0.0085, 0.2060, pad(self.narrow, 0.3300, 192.0, 0.0080), 204.0),
            ("vent_B", "Lt_c2", 0.0095, 0.1984, pad(self.narrow, 0.1150, 190.0, 0.0056), 215.0),
            ("vent_D", "Lt_d2", 0.0110, 0.1912, pad(self.narrow, 0.0750, 200.0, 0.0056), 227.0),
        ):
            spatula = touch(left, -0.0315, along, back, 0.0072, 0.0092)
            JOINTS.thumb_key(work, name, label, self.narrow, cup, spatula, along, angle, 0.0035)
        for name, label, left, along, cup, angle in (
            ("key_D", "Lt_d", 0.0330, 0.1902, pad(self.second, 0.3300, 168.0, 0.0135), 140.0),
            ("key_C", "Lt_c", 0.0330, 0.1812, pad(self.second, 0.2700, 160.0, 0.0140), 126.0),
            ("key_B", "Lt_b", 0.0330, 0.1726, pad(self.second, 0.1150, 176.0, 0.0130), 112.0),
            ("key_B_flat_low", "Lt_bes", 0.0355, 0.1650, pad(self.second, 0.0850, 150.0, 0.0130), 98.0),
        ):
            spatula = touch(left, -0.0300, along, back, 0.0074, 0.0105)
            JOINTS.thumb_key(work, name, label, self.second, cup, spatula, along, angle, 0.0038)
        # Same as on the bassoon; for A 4 the thumb is on C sharp and the vent above it.
        JOINTS.thumb_over_low_keys(work, "vent_B")

    def right_hand(self) -> None:
        """Three plates on the third joint, between the last two the B flat key, and three keys of the little finger."""
        work = self.work
        for name, label, finger, along, angle, far in (
            ("key_R1", "R1", "index", 0.414, 42.0, 0.5500), ("key_R2", "R2", "middle", 0.445, 56.0, 0.5900),
            ("key_G", "R3", "ring", 0.476, 70.0, 0.6320),
        ):  # fmt: skip
            rod = self.third.rod(along - 0.008, far + 0.008, angle, 0.0050)
            work.plateau(name, label, f"right.{finger}.pad", rod, pad(self.third, along, -10.0, 0.0080),
                         [pad(self.third, far, 2.0, 0.0150)], opening_m=0.0035)  # fmt: skip
        touch = self.third.spatula(0.4605, -10.0, 0.0085, oval(0.0078, 0.0120), foot=0.0)
        work.key("key_B_flat_third", "Rr_bes", "right.ring.pad", self.third.rod(0.455, 0.530, -52.0, 0.0060),
                 touch, [pad(self.third, 0.5230, -34.0, 0.0070)], travel_m=0.0035)  # fmt: skip
        for name, label, angle, along, wide, rod, cups in (
            ("key_F", "Rp_f", -28.0, 0.4930, 0.0120, (0.488, 0.706, 12.0, 0.0110), [(0.6900, -14.0, 0.0170)]),
            ("key_A_flat", "Rp_gis", -54.0, 0.4970, 0.0110, (0.490, 0.600, -86.0, 0.0050), [(0.5880, -52.0, 0.0115)]),
            ("key_F_sharp_little", "Rp_fis", -40.0, 0.5010, 0.0110, (0.500, 0.660, -72.0, 0.0060), []),
        ):
            touch = self.third.spatula(along, angle, 0.0085, oval(0.0076, wide), foot=0.0)
            hung = [pad(self.third, *cup) for cup in cups]
            work.key(name, label, "right.little.pad", self.third.rod(*rod), touch, hung, travel_m=0.0040)

    def right_thumb(self) -> None:
        """Three keys at the back of the third joint."""
        work, back = self.work, -FRONT
        for name, label, left, along, wide, rod, cups in (
            ("key_E", "Rt_e", -0.0075, 0.4185, 0.0125, (0.413, 0.790, 130.0, 0.0045), [(0.7700, 176.0, 0.0170)]),
            ("key_B_flat", "Rt_bes", -0.0040, 0.4055, 0.0125, (0.370, 0.411, 146.0, 0.0045), [(0.3830, 112.0, 0.0090)]),
            ("key_F_sharp", "Rt_fis", 0.0050, 0.4310, 0.0130, (0.426, 0.680, 148.0, 0.0045), []),
        ):
            spatula = touch(THIRD + left, -0.0395, along, back, 0.0115, wide)
            hung = [pad(self.third, *cup) for cup in cups]
            work.key(name, label, "right.thumb.pad", self.third.rod(*rod), spatula, hung, travel_m=0.0030)
        work.linked("cup_F_sharp", ("key_F_sharp", "key_F_sharp_little"), self.third.rod(0.650, 0.745, 226.0, 0.0045),
                    cups=[pad(self.third, 0.7300, 198.0, 0.0130)], drop_m=-0.0030, proxy_rod=False)  # fmt: skip

    def large_pads(self) -> None:
        """The large cups of the low notes on the bell joint, which the left thumb's keys close by long rods."""
        for node, controls, along in (
            ("pad_C", ("key_C",), 0.700), ("pad_B", ("key_B",), 0.480), ("pad_B_flat", ("key_B_flat_low",), 0.200),
        ):  # fmt: skip
            rod = self.bell.rod(along - 0.060, along + 0.060, -42.0, 0.0060)
            self.work.linked(node, controls, rod, cups=[pad(self.bell, along, 0.0, 0.0200)], drop_m=0.0060,
                             proxy_rod=False)  # fmt: skip


INSTRUMENTS = {"contrabassoon": entry(lambda: Contrabassoon().make())}
