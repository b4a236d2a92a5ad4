"""Hips, trunk and instrument at some frames, as base for solving arms and legs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.motion.by_hand.pose_corrections import within
from app.motion.contacts.carried_instrument import (
    Z_AXIS,
    InstrumentTransform,
    attitude,
    bell_pitch,
    going_along,
    held_angles,
)
from app.motion.contacts.still_player import ContactCurves, StillPlayer
from app.motion.contacts.trunk_and_legs import Trunk, hips_path, trunk
from app.rig import quaternion

CLEAR_M = 0.035
"""Distance in metres by which the instrument swings forward while it is lowered or raised, to pass the chin."""
CHIN_M = 0.06
"""Height in metres from the lips to below the chin; an instrument that is lowered by less swings forward by
proportionally less.
"""


@dataclass(frozen=True)
class UpperBody:
    """Hips (position (F, 3) and rotation (F, 4)), trunk, and instrument."""

    hips_m: FloatArray
    hips: FloatArray
    trunk: Trunk
    carried: InstrumentTransform

    def __getitem__(self, frames: slice | IndexArray) -> UpperBody:
        trunk, carried = self.trunk, self.carried
        parts = (trunk.chest, trunk.chest_m, trunk.head, trunk.head_m)
        return UpperBody(
            self.hips_m[frames],
            self.hips[frames],
            Trunk({joint: turn[frames] for joint, turn in trunk.local.items()}, *(part[frames] for part in parts)),
            InstrumentTransform(carried.position_m[frames], carried.rotation[frames]),
        )


def joined(parts: Sequence[UpperBody]) -> UpperBody:
    """Concatenate poses of the upper body that belong to consecutive ranges of frames."""
    if len(parts) == 1:
        return parts[0]

    def whole(member: Callable[[UpperBody], FloatArray]) -> FloatArray:
        return np.concatenate([member(part) for part in parts])

    joints = parts[0].trunk.local
    return UpperBody(
        whole(lambda part: part.hips_m),
        whole(lambda part: part.hips),
        Trunk(
            {joint: np.concatenate([part.trunk.local[joint] for part in parts]) for joint in joints},
            whole(lambda part: part.trunk.chest),
            whole(lambda part: part.trunk.chest_m),
            whole(lambda part: part.trunk.head),
            whole(lambda part: part.trunk.head_m),
        ),
        InstrumentTransform(whole(lambda part: part.carried.position_m), whole(lambda part: part.carried.rotation)),
    )


def upper_body(player: StillPlayer, curves: ContactCurves) -> UpperBody:
    """Compute hips, trunk and instrument, from which arms and legs are solved."""
    hips_m, hips = hips_path(player.place, player.skeleton, curves.body)
    upper = trunk(player.skeleton, hips_m, hips, curves.body)
    carried = _carry(player, curves, upper)
    if player.stand is not None:
        carried = player.stand.stood(carried, curves.body)
    return UpperBody(hips_m, hips, upper, carried)


def _carry(player: StillPlayer, curves: ContactCurves, body: Trunk) -> InstrumentTransform:
    """Placement of the instrument: at the lips, or lowered in front of the body.

    Tilt from head and melody beyond the bell's range is compensated by tilting the instrument at the lips; the
    animator's tilt is not.
    """
    played = _played(player, curves, body)
    lowering = curves.body.lowered
    return _lowered(player, played, body, lowering) if np.any(lowering) else played


def _at_lips(player: StillPlayer, curves: ContactCurves, body: Trunk) -> FloatArray:
    """Return the mouthpiece position (F, 3) at the lips; during a breath only one lip holds it."""
    lips, frames = player.grip.lips, len(curves)
    lips_m = lips.contact_m(curves.morphs, frames)
    # The jaw leaves the rim long before the mouth is fully open.
    on_one = 1.0 - (1.0 - curves.mouth_open) ** 4
    breathing = np.flatnonzero(on_one)
    if len(breathing):
        contact_m = lips_m[breathing]
        morphs = {name: weight[breathing] for name, weight in curves.morphs.items()}
        one_m = lips.carried_m(morphs, len(breathing)) + player.grip_of_lips_m
        lips_m[breathing] = contact_m + (one_m - contact_m) * on_one[breathing, None]
    return body.head_m + quaternion.rotate(body.head, lips_m)


def _played(player: StillPlayer, curves: ContactCurves, body: Trunk) -> InstrumentTransform:
    """Return position and rotation of the instrument while it is played, as carried by head, chest and motion of the
    bell."""
    carriage, base, motion = player.carriage, player.base, curves.body
    pitch, yaw, roll = held_angles(carriage, motion)
    with_head = quaternion.multiply(body.head, quaternion.conjugate(base.head))
    with_chest = quaternion.multiply(body.chest, quaternion.conjugate(base.chest))
    low_rad, _, high_rad = np.deg2rad(carriage.pitch_down_deg)
    going = going_along(with_head, carriage)
    cued = within(-motion.bell_cue_rad, high_rad - pitch, pitch - low_rad)
    bowed = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(with_chest), going))[:, 0]
    played = bell_pitch(carriage, motion.bell_rad) + cued
    back = within(player.bell_room.back_rad(played + bowed), high_rad - played, played - low_rad)
    pitch = pitch + cued + back + motion.bell_down_rad
    turned = attitude(pitch, yaw - motion.bell_right_rad, roll)
    rotation = quaternion.multiply(going, turned)
    return InstrumentTransform(_at_lips(player, curves, body), rotation)


def _lowered(
    player: StillPlayer, played: InstrumentTransform, body: Trunk, lowering: FloatArray
) -> InstrumentTransform:
    """Placement of the instrument between the lips and its lowered position, carried by the chest."""
    base, lowered = player.base, player.lowered
    with_chest = quaternion.multiply(body.chest, quaternion.conjugate(base.chest))
    base_lips_m = base.head_m + quaternion.rotate(base.head, player.grip.lips.usual_m)
    low_m = body.chest_m + quaternion.rotate(with_chest, base_lips_m + np.array(lowered.offset_m) - base.chest_m)
    low = quaternion.multiply(
        with_chest,
        attitude(
            np.array([np.deg2rad(lowered.pitch_down_deg)]),
            np.array([np.deg2rad(lowered.yaw_left_deg)]),
            float(np.deg2rad(lowered.roll_left_deg)),
        ),
    )
    share = lowering[:, None]
    clear_m = CLEAR_M * min(1.0, max(0.0, -lowered.offset_m[1]) / CHIN_M)
    swing = 4.0 * share * (1.0 - share) * clear_m * Z_AXIS
    position_m = played.position_m + (low_m - played.position_m) * share + swing
    return InstrumentTransform(position_m, quaternion.slerp(played.rotation, low, lowering))
