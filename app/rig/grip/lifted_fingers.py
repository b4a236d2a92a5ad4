"""Lifted fingers that stay curved: a finger rises from its key at the knuckle, as bent as when pressing.

A grip is solved for the positions of the pads (`app.rig.grip.fitting.solved_fingers`), which may raise a finger by
stretching its middle joint. People keep it bent and lift the whole finger. This module changes the poses of waiting
fingers: the height above the key stays, and the two outer joints are bent as in a relaxed hand. Pressed poses, and with
them all contacts, are unchanged.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.grip.grip_pose import FingerTable, GripPose, HandHold, StationTable
from app.rig.model import Skeleton
from metadata.skeleton_profile import SkeletonProfile

CURVED_RAD = (float(np.deg2rad(26.0)), float(np.deg2rad(62.0)))
"""Range of the bend of a waiting finger's middle joint."""
OUTER_SHARE = 0.55
"""Bend of a waiting finger's outer joint, as a share of the middle joint's."""
BEYOND_RAD = (float(np.deg2rad(28.0)), float(np.deg2rad(22.0)))
"""Least bend of the middle and the outer joint beyond the touching part, in radians."""
MOST_RAD = (float(np.deg2rad(20.0)), float(np.deg2rad(25.0)))
"""Greatest additional bend of the two joints compared with the pressed pose, in radians."""
KNUCKLE_RAD = (float(np.deg2rad(-30.0)), float(np.deg2rad(90.0)))
AMOUNTS = (1.0, 0.5)
"""Shares of that bend that are tried."""
ROUNDS, LEAST_SLOPE_M, MOST_STEP_RAD = 8, 0.001, 0.3
SPREAD_RAD = float(np.deg2rad(0.1))
"""Greatest additional sideways rotation of the knuckle in radians."""
EXACT_M, ASIDE_M = 0.0003, 0.012
"""Tolerances in metres of a lifted finger's height and sideways deviation; beyond them it keeps the solved pose."""


@dataclass(frozen=True)
class _Finger:
    """Geometry of a finger's three joints: offsets (3, 3), flexion and twist axes (3, 3), and the touching point (3,)
    in the frame of the last joint.
    """

    offsets_m: FloatArray
    flexion: FloatArray
    twist: FloatArray
    tip_m: FloatArray

    def tips_m(self, rotations: FloatArray) -> FloatArray:
        """Return the position (S, 3) of the touching point in the wrist's frame in S samples."""
        return self.carried_m(rotations, 0, self.beyond_m(rotations))

    def beyond_m(self, rotations: FloatArray) -> FloatArray:
        """Return the touching point (S, 3) in the frame of the finger's first joint in S samples."""
        point = np.broadcast_to(self.tip_m, (len(rotations), 3))
        return self.carried_m(rotations, 1, self.carried_m(rotations, 2, point))

    def carried_m(self, rotations: FloatArray, joint: int, points_m: FloatArray) -> FloatArray:
        """Convert points (S, 3) of S samples from a joint's frame to the frame of the preceding joint."""
        carried: FloatArray = self.offsets_m[joint] + quaternion.rotate(rotations[:, joint], points_m)
        return carried

    def flexed(self, rotations: FloatArray, joint: int, angles_rad: FloatArray) -> FloatArray:
        """Return the rotations (S, 3, 4) of three joints in S samples with one joint bent by an additional angle."""
        result = rotations.copy()
        turn = quaternion.from_axis_angle(self.flexion[joint], angles_rad)
        result[:, joint] = quaternion.multiply(turn, rotations[:, joint])
        return result

    def bent_rad(self, rotation: FloatArray, joint: int) -> float:
        """Return the bend of a joint with rotation (4,) in radians."""
        swing, _ = quaternion.swing_twist(rotation, self.twist[joint])
        return float(quaternion.to_rotation_vector(swing) @ self.flexion[joint])

    def knuckle_rad(self, rotations: FloatArray) -> FloatArray:
        """Return the bend (S,) of the knuckle in radians in S samples, from its rotations (S, 4)."""
        swing, _ = quaternion.swing_twist(rotations, self.twist[0])
        return np.asarray(quaternion.to_rotation_vector(swing) @ self.flexion[0])

    def spread_rad(self, rotations: FloatArray) -> float:
        """Return the greatest sideways rotation of the knuckle in radians, over rotations (S, 4) in S samples."""
        swing, _ = quaternion.swing_twist(rotations, self.twist[0])
        sideways = np.cross(self.flexion[0], self.twist[0])
        return float(np.abs(quaternion.to_rotation_vector(swing) @ sideways).max())


def with_curved_fingers(grip: GripPose, skeleton: Skeleton, profile: SkeletonProfile) -> GripPose:
    """Return the grip with curved waiting fingers, except for those that support the instrument."""
    return replace(grip, hands=tuple(_of_hand(hand, skeleton, profile) for hand in grip.hands))


def _of_hand(hand: HandHold, skeleton: Skeleton, profile: SkeletonProfile) -> HandHold:
    bearing = {fit.part.rpartition(".")[0] for fit in hand.contacts if fit.control is None}
    fingers = tuple(table if table.finger in bearing else _curved(table, skeleton, profile) for table in hand.fingers)
    return replace(hand, fingers=fingers)


def _curved(table: FingerTable, skeleton: Skeleton, profile: SkeletonProfile) -> FingerTable:
    if table.finger.endswith("thumb") or len(table.joints) != 3:
        return table
    axes = [profile.joint_axes(skeleton.names[joint]) for joint in table.joints]
    flexion, twist = np.array([one.flexion for one in axes]), np.array([one.twist for one in axes])
    offsets_m = np.array([skeleton.offsets_m[joint] for joint in table.joints])
    stations = []
    for station in table.stations:
        finger = _Finger(offsets_m, flexion, twist, station.tip_m)
        if station.hovers and station.tip_joint == 2 and len(station.values) > 1:
            station = _lifted(station, finger)
        elif station.controls and station.tip_joint in (0, 1):
            station = replace(station, rotations=_eased_beyond(station, finger))
        stations.append(station)
    return replace(table, stations=tuple(stations))


def _eased_beyond(station: StationTable, finger: _Finger) -> FloatArray:
    """Return the rotations (S, 3, 4) of a station with the joints beyond the touching one bent at least as in a relaxed
    hand.
    """
    rotations = station.rotations
    for joint in range(station.tip_joint + 1, 3):
        bent_rad = np.array([finger.bent_rad(one[joint], joint) for one in rotations])
        rotations = finger.flexed(rotations, joint, np.maximum(BEYOND_RAD[joint - 1] - bent_rad, 0.0))
    return rotations


def _lifted(station: StationTable, finger: _Finger) -> StationTable:
    """Return a station whose waiting finger is lifted from the knuckle: as curved as intended if possible, else half as
    much, else unchanged.
    """
    for amount in AMOUNTS:
        rotations = _from_knuckle(station, finger, amount)
        if rotations is not None:
            return replace(station, rotations=rotations)
    return station


def _from_knuckle(station: StationTable, finger: _Finger, amount: float) -> FloatArray | None:
    """Return the rotations (S, 3, 4) with which the finger keeps its heights by rotating at the knuckle; None if
    impossible.

    ``amount`` 0..1 is how far the outer joints are bent towards a relaxed hand.
    """
    tips_m, pressed, waiting = finger.tips_m(station.rotations), station.rotations[-1], station.rotations[0]
    way_m = tips_m[0] - tips_m[-1]
    way = way_m / max(float(np.linalg.norm(way_m)), 1e-9)
    height_m = (tips_m - tips_m[-1]) @ way
    middle, outer = (finger.bent_rad(pressed[joint], joint) for joint in (1, 2))
    middle_rad = middle + np.clip(np.clip(middle, *CURVED_RAD) - middle, -MOST_RAD[0], MOST_RAD[0])
    outer_rad = outer + np.clip(OUTER_SHARE * middle_rad - outer, -MOST_RAD[1], MOST_RAD[1])
    rotations = station.rotations
    # A half hole is covered by the pose solved for it; above that height the finger relaxes as it rises.
    share = np.square(np.clip(1.0 - 2.0 * station.values, 0.0, 1.0))
    for joint, eased_rad in ((1, middle_rad), (2, outer_rad)):
        solved_rad = finger.bent_rad(waiting[joint], joint)
        rotations = finger.flexed(rotations, joint, share * amount * (eased_rad - solved_rad))
    bare, turn, beyond_m = rotations, np.zeros(len(share)), finger.beyond_m(rotations)
    for _ in range(ROUNDS):
        now_m = finger.carried_m(finger.flexed(bare, 0, turn), 0, beyond_m)
        slope = quaternion.cross(np.broadcast_to(finger.flexion[0], now_m.shape), now_m - finger.offsets_m[0]) @ way
        slope = np.where(np.abs(slope) < LEAST_SLOPE_M, -LEAST_SLOPE_M, slope)
        turn = turn + np.clip((height_m - (now_m - tips_m[-1]) @ way) / slope, -MOST_STEP_RAD, MOST_STEP_RAD)
    rotations = finger.flexed(bare, 0, turn)
    off_m = finger.tips_m(rotations) - tips_m[-1]
    aside_m = np.linalg.norm(off_m - np.multiply.outer(off_m @ way, way), axis=1)
    knuckle_rad = finger.knuckle_rad(station.rotations[:, 0]) + turn
    if knuckle_rad.min() < KNUCKLE_RAD[0] or knuckle_rad.max() > KNUCKLE_RAD[1]:
        return None
    if finger.spread_rad(rotations[:, 0]) > finger.spread_rad(station.rotations[:, 0]) + SPREAD_RAD:
        return None
    if np.abs(off_m @ way - height_m).max() > EXACT_M or aside_m.max() > ASIDE_M:
        return None
    rotations = np.where((share > 0.0)[:, None, None], rotations, station.rotations)
    same_side = np.einsum("sjc,sjc->sj", rotations, station.rotations) >= 0.0
    return np.where(same_side[..., None], rotations, -rotations)
