"""Placement of the instrument: rim on the lips while it is played, in front of the body in long rests.

The head carries it while it is played, the chest while it is lowered; hands follow (`app.motion.contacts.arms`). Body
motion moves everything together, so contacts hold.
"""

from __future__ import annotations

from dataclasses import dataclass

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.by_hand.pose_corrections import within
from app.plan.acting import Acting
from app.plan.parameters import PlayerParameters
from app.rig import quaternion
from instrument_maps.hold import Carriage

X_AXIS, Y_AXIS, Z_AXIS = np.eye(3)

SETTLED = 0.6
"""Factor for the amplitude of players whose instrument lies on the lap; applied twice to their sway."""
FREE_DEG = 10.0
"""Least total range in degrees of a carriage from which the instrument follows the head."""
TIPS_DEG = 5.0
"""Least range in degrees of its pitch from which it is seen how far an instrument tips before thick clothes."""


@dataclass(frozen=True)
class InstrumentTransform:
    """World transform of the instrument: position (F, 3) and rotation (F, 4), float64."""

    position_m: FloatArray
    rotation: FloatArray


def attitude(pitch_down_rad: FloatArray, yaw_left_rad: FloatArray, roll_left_rad: FloatArray | float) -> FloatArray:
    """Rotation (F, 4) of an instrument from its angles, in the order yaw, pitch, roll."""
    yaw = quaternion.from_axis_angle(Y_AXIS, yaw_left_rad)
    roll = quaternion.from_axis_angle(Z_AXIS, -roll_left_rad)
    return quaternion.multiply(quaternion.multiply(yaw, quaternion.from_axis_angle(X_AXIS, pitch_down_rad)), roll)


def bell_pitch(carriage: Carriage, bell_rad: FloatArray) -> FloatArray:
    """Pitch (F,) of the bell in radians (down positive) after it rises by ``bell_rad``, softly limited to the
    carriage's range.
    """
    low, usual, high = np.deg2rad(carriage.pitch_down_deg)
    down = -bell_rad
    room = np.where(down >= 0.0, max(high - usual, 1e-3), max(usual - low, 1e-3))
    pitch: FloatArray = usual + room * np.tanh(down / room)
    return pitch


def held_angles(carriage: Carriage, motion: BodyMotion) -> tuple[FloatArray, FloatArray | float, FloatArray | float]:
    """Pitch (down), yaw and roll (left) of the instrument in radians, due to the melody and to the animator's poses,
    within the carriage's ranges.
    """
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
    """Return the freedom of an instrument to move with the body: 1 if it is carried, 0 if it rests on something without
    play.
    """
    ranges = (carriage.pitch_down_deg, carriage.yaw_left_deg, carriage.roll_left_deg)
    return min(1.0, min(high - low for low, _, high in ranges) / FREE_DEG)


def tips_freely(carriage: Carriage, *, thickly_dressed: bool = False) -> bool:
    """Return whether an instrument can tilt up and down with the head; False if it lies on the lap or stands on the
    floor. Before thick clothes it matters from a smaller range on.
    """
    low_deg, _, high_deg = carriage.pitch_down_deg
    return high_deg - low_deg >= (TIPS_DEG if thickly_dressed else FREE_DEG)


def going_along(with_head: FloatArray, carriage: Carriage) -> FloatArray:
    """Reduce the head's rotation (F, 4) to the part that the instrument follows.

    A carried instrument follows completely. One on the lap or the floor, without range in its carriage, stays while the
    lips turn on it.
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


def limited_to_carriage(parameters: PlayerParameters, carriage: Carriage) -> PlayerParameters:
    """Reduce the motion that parameters give the instrument to what its carriage allows, so that the lips stay in
    contact.
    """
    share = _settling(carriage)
    if share == 1.0:
        return parameters
    return msgspec.structs.replace(
        parameters,
        amplitude=share * parameters.amplitude,
        dance_amount=share * share * parameters.dance_amount,
    )


def _settling(carriage: Carriage) -> float:
    """Factor of the amplitude for players of an instrument with this carriage: below 1 if it rests on the body or the
    floor.
    """
    return SETTLED + (1.0 - SETTLED) * freedom(carriage)


def shown_by(parameters: PlayerParameters, carriage: Carriage, acting: Acting, *, dancing: bool) -> Acting:
    """Reduce amounts of acting: less trunk motion with an instrument that rests on body or floor, and less body motion
    while a dance replaces it.
    """
    share = _settling(carriage)
    left = 1.0 - share * share * parameters.dance_amount if dancing else 1.0
    return msgspec.structs.replace(
        acting,
        sway=left * share * acting.sway,
        weight_shift=left * share * acting.weight_shift,
        phrase=left * share * acting.phrase,
    )
