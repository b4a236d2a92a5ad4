"""The instrument: its rim on the lips while it is played, before the body in long rests.

The head carries it while it is played and the chest while it is lowered; hands follow it (`app.motion.contacts.arms`).
Body motion moves all of it together, so it never breaks a contact.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.by_hand.pose_corrections import within
from app.motion.contacts.trunk_and_legs import Trunk
from app.motion.curves.soft_bounds import softly_over
from app.rig import quaternion
from app.rig.grip.grip_pose import GripPose
from instrument_maps.model import Carriage, Lowered

X_AXIS, Y_AXIS, Z_AXIS = np.eye(3)

CLEAR_M = 0.035
"""On its way down and up the instrument swings ahead by this much, clear of the chin ..."""
CHIN_M = 0.06
"""... and by less where it goes less far down than from the lips to below the chin: one that stays has nothing to
pass."""


FREE_DEG = 10.0
"""An instrument whose carriage has this much room from end to end goes along with the head."""


@dataclass(frozen=True)
class BellRoom:
    """How far an instrument tips from the chest while both wrists stay within their range: down is positive."""

    low_rad: float = -np.inf
    high_rad: float = np.inf

    @classmethod
    def within(cls, down_rad: FloatArray, fits: BoolArray) -> BellRoom:
        """From ascending angles (T,), the middle one of which is where it is played, and whether the wrists follow."""
        usual, misses = len(down_rad) // 2, np.flatnonzero(~fits)
        low, high = misses[misses < usual], misses[misses > usual]
        return cls(
            low_rad=float(down_rad[low[-1] + 1]) if len(low) else -np.inf,
            high_rad=float(down_rad[high[0] - 1]) if len(high) else np.inf,
        )

    def back_rad(self, down_rad: FloatArray) -> FloatArray:
        """What brings angles (F,) back into it; 0 where they are well within."""
        back: FloatArray = softly_over(self.low_rad - down_rad, ROOM_EASE_RAD)
        return back - softly_over(down_rad - self.high_rad, ROOM_EASE_RAD)


ROOM_EASE_RAD = float(np.deg2rad(2.0))
"""The ends of that room are approached so softly."""

ANYWHERE = BellRoom()


@dataclass(frozen=True)
class Carried:
    """World transform of the instrument: (F, 3) and (F, 4) float64."""

    position_m: FloatArray
    rotation: FloatArray


def attitude(pitch_down_rad: FloatArray, yaw_left_rad: FloatArray, roll_left_rad: FloatArray | float) -> FloatArray:
    """Rotation (F, 4) of an instrument from its angles, in the order yaw, pitch, roll."""
    yaw = quaternion.from_axis_angle(Y_AXIS, yaw_left_rad)
    roll = quaternion.from_axis_angle(Z_AXIS, -roll_left_rad)
    return quaternion.multiply(quaternion.multiply(yaw, quaternion.from_axis_angle(X_AXIS, pitch_down_rad)), roll)


def bell_pitch(carriage: Carriage, bell_rad: FloatArray) -> FloatArray:
    """Pitch of the bell (down positive) within the carriage's range; its ends are approached softly."""
    low, usual, high = np.deg2rad(carriage.pitch_down_deg)
    down = -bell_rad
    room = np.where(down >= 0.0, max(high - usual, 1e-3), max(usual - low, 1e-3))
    pitch: FloatArray = usual + room * np.tanh(down / room)
    return pitch


def held_angles(carriage: Carriage, motion: BodyMotion) -> tuple[FloatArray, FloatArray | float, FloatArray | float]:
    """Pitch (down), yaw and roll (left) of the instrument as the melody and the animator have it, within the carriage's
    ranges."""
    pitch = bell_pitch(carriage, motion.bell_rad)
    yaw, roll = float(np.deg2rad(carriage.yaw_left_deg[1])), float(np.deg2rad(carriage.roll_left_deg[1]))
    held = motion.bell_held_rad
    if not held:
        return pitch, yaw, roll
    low, _, high = np.deg2rad(carriage.pitch_down_deg)
    pitch = pitch - within(held["pitch"], pitch - low, high - pitch)
    low, usual, high = np.deg2rad(carriage.yaw_left_deg)
    turned = usual + within(held["yaw"], high - usual, usual - low)
    low, usual, high = np.deg2rad(carriage.roll_left_deg)
    return pitch, turned, usual + within(held["roll"], high - usual, usual - low)


def freedom(carriage: Carriage) -> float:
    """How free an instrument is to move with the body: 1 where it hangs free, 0 where it lies and has no room."""
    ranges = (carriage.pitch_down_deg, carriage.yaw_left_deg, carriage.roll_left_deg)
    return min(1.0, min(high - low for low, _, high in ranges) / FREE_DEG)


def tips_freely(carriage: Carriage) -> bool:
    """Whether an instrument tips up and down with the head: one that lies or stands keeps its place."""
    low_deg, _, high_deg = carriage.pitch_down_deg
    return high_deg - low_deg >= FREE_DEG


def _going_along(with_head: FloatArray, carriage: Carriage) -> FloatArray:
    """The head's turn (F, 4), as far as the instrument goes along with it.

    One that hangs free goes along wholly. One that lies on the lap or stands on the floor, whose carriage leaves no
    room, stays as it is, and the lips turn on it.
    """
    if freedom(carriage) == 1.0:
        return with_head
    ranges = (carriage.pitch_down_deg, carriage.yaw_left_deg, carriage.roll_left_deg)
    rooms_deg = [high - low for low, _, high in ranges]
    turn = quaternion.to_rotation_vector(with_head)
    for axis, room_deg in enumerate(rooms_deg):
        if room_deg < FREE_DEG:
            half_rad = float(np.deg2rad(room_deg / 2.0))
            turn[:, axis] = within(turn[:, axis] * room_deg / FREE_DEG, half_rad, half_rad)
    return quaternion.from_rotation_vector(turn)


def carry(
    hold: GripPose,
    carriage: Carriage,
    lowered: Lowered,
    body: Trunk,
    base: Trunk,
    motion: BodyMotion,
    morphs: Mapping[str, FloatArray],
    mouth_open: FloatArray,
    grip_of_lips_m: FloatArray,
    room: BellRoom,
) -> Carried:
    """Place the instrument: at the lips, or lowered before the body.

    Parameters
    ----------
    hold, carriage, lowered
    body, base : Trunk
        The trunk as it moves, (F,), and in the posture before any motion, (1,).
    morphs : mapping of str to (F,)
    mouth_open : (F,) float64
        How far the mouth is open for a breath, 0..1: then one lip alone carries the mouthpiece.
    grip_of_lips_m : (3,) float64
        Added to where that lip carries it, so that it keeps its playing place there.
    room : BellRoom
        What head and melody tip beyond it, the instrument tips back in the lips; not what the animator does.
    """
    lowering = motion.lowered
    frames = len(lowering)
    lips_m = hold.lips.contact_m(morphs, frames)
    # The jaw is far enough down to have left the rim long before the mouth is fully open.
    on_one = 1.0 - (1.0 - mouth_open) ** 4
    breathing = np.flatnonzero(on_one)
    if len(breathing):
        contact_m = lips_m[breathing]
        carried_m = hold.lips.carried_m({name: weight[breathing] for name, weight in morphs.items()}, len(breathing))
        lips_m[breathing] = contact_m + (carried_m + grip_of_lips_m - contact_m) * on_one[breathing, None]
    pitch, yaw, roll = held_angles(carriage, motion)
    with_head = quaternion.multiply(body.head, quaternion.conjugate(base.head))
    with_chest = quaternion.multiply(body.chest, quaternion.conjugate(base.chest))
    low_rad, _, high_rad = np.deg2rad(carriage.pitch_down_deg)
    going = _going_along(with_head, carriage)
    cued = within(-motion.bell_cue_rad, high_rad - pitch, pitch - low_rad)
    bowed = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(with_chest), going))[:, 0]
    played = bell_pitch(carriage, motion.bell_rad) + cued
    back = within(room.back_rad(played + bowed), high_rad - played, played - low_rad)
    pitch = pitch + cued + back + motion.bell_down_rad
    turned = attitude(pitch, yaw - motion.bell_right_rad, roll)
    rotation = quaternion.multiply(going, turned)
    position_m = body.head_m + quaternion.rotate(body.head, lips_m)
    if not np.any(lowering):
        return Carried(position_m, rotation)
    base_lips_m = base.head_m + quaternion.rotate(base.head, hold.lips.usual_m)
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
    return Carried(position_m + (low_m - position_m) * share + swing, quaternion.slerp(rotation, low, lowering))
