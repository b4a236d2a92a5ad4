"""Carriage of an instrument at rest: from the angles in the map's `Carriage`, and the upright posture."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.grip.grip_pose import Lips
from app.rig.model import Character, Skeleton
from app.rig.skeleton import forward
from instrument_maps import map_table as maps
from instrument_maps.hold import Carriage
from instrument_maps.model import InstrumentMap
from metadata.model import Body, Posture


@dataclass(frozen=True, eq=False)
class Upright:
    """A player standing still with the instrument at the lips, in the player's frame (+Z ahead, +X left).

    Attributes
    ----------
    joints_m : (J, 3) float64
        World positions of all joints, with the arms in T-pose.
    instrument_m, instrument_rotation : (3,) and (4,) float64
        Position and rotation of the instrument, ``world_from_instrument``.
    """

    joints_m: FloatArray
    instrument_m: FloatArray
    instrument_rotation: FloatArray


def carriage_rotation(pitch_down_deg: float, yaw_left_deg: float, roll_left_deg: float) -> FloatArray:
    """Return the rotation (4,) of an instrument in the player's frame for the angles of a `Carriage`."""
    # Left is +X: the bell (+Z) turns left about +Y and down about +X; the top (+Y) leans left about -Z.
    yaw = quaternion.from_axis_angle([0.0, 1.0, 0.0], np.radians(yaw_left_deg))
    pitch = quaternion.from_axis_angle([1.0, 0.0, 0.0], np.radians(pitch_down_deg))
    roll = quaternion.from_axis_angle([0.0, 0.0, -1.0], np.radians(roll_left_deg))
    return quaternion.multiply(quaternion.multiply(yaw, pitch), roll)


def carrying(body: Body, posture: maps.Posture, carriage: Carriage) -> Posture:
    """Return the posture of a body whose head and trunk turn towards the instrument as far as its carriage requires."""
    return body.turned_to(
        posture,
        pitch_down_deg=carriage.pitch_down_deg[1],
        head_left_deg=carriage.head_left_deg,
        head_lean_left_deg=carriage.head_lean_left_deg,
        trunk_left_deg=carriage.trunk_left_deg,
    )


def joint_rotations(skeleton: Skeleton, posture: Posture) -> FloatArray:
    """Return the local rotations (1, J, 4) of J joints in a posture of spine and neck; the arms are in T-pose."""
    rotations = np.tile(quaternion.IDENTITY, (1, len(skeleton.names), 1))
    bent: dict[str, FloatArray] = {}
    angles = (posture.spine_deg, posture.spine_turn_deg, posture.spine_left_deg)
    for axis, (degrees, sign) in enumerate(zip(angles, (1.0, 1.0, -1.0), strict=True)):
        for name, angle in degrees.items():
            bent.setdefault(name, np.zeros(3))[axis] = sign * np.radians(angle)
    for name, vector in bent.items():
        if name in skeleton.names:
            rotations[0, skeleton.index(name)] = quaternion.from_rotation_vector(vector)
    return rotations


def carried_by(instrument_map: InstrumentMap, shares: tuple[float, float, float]) -> InstrumentMap:
    """Return the instrument's map with another usual carriage within its ranges.

    Parameters
    ----------
    shares : (float, float, float)
        Pitch, yaw and roll: from -1 (lower end of the range) over 0 (as in the map) to 1 (upper end).
    """

    def moved(carriage: Carriage | None) -> Carriage | None:
        if carriage is None:
            return None
        ranges = (carriage.pitch_down_deg, carriage.yaw_left_deg, carriage.roll_left_deg)
        pitch, yaw, roll = (_shifted(*one) for one in zip(ranges, shares, strict=True))
        return msgspec.structs.replace(carriage, pitch_down_deg=pitch, yaw_left_deg=yaw, roll_left_deg=roll)

    hold = instrument_map.hold
    hold = msgspec.structs.replace(hold, standing=moved(hold.standing), seated=moved(hold.seated))
    return msgspec.structs.replace(instrument_map, hold=hold)


def _shifted(range_deg: maps.Vector, share: float) -> maps.Vector:
    low, usual, high = range_deg
    return (low, usual + share * (high - usual if share > 0.0 else usual - low), high)


def usual_posture(instrument_map: InstrumentMap) -> maps.Posture:
    """Return the posture for which a grip is fitted: standing, or the instrument's only posture."""
    return instrument_map.hold.postures[0]


def upright(character: Character, instrument_map: InstrumentMap, body: Body, lips: Lips) -> Upright:
    """Return a character that stands or sits still with its instrument, in the usual posture and carriage."""
    usual = usual_posture(instrument_map)
    skeleton, carriage = character.skeleton, instrument_map.hold.carriage(usual)
    posed = forward(skeleton, joint_rotations(skeleton, carrying(body, usual, carriage)))
    head_m, head = posed.of(skeleton.index("head"))
    mouth_m = head_m[0] + quaternion.rotate(head[0], lips.usual_m)
    turn = carriage_rotation(carriage.pitch_down_deg[1], carriage.yaw_left_deg[1], carriage.roll_left_deg[1])
    rim_m = quaternion.rotate(turn, np.asarray(instrument_map.mouthpiece.position_m))
    return Upright(posed.positions_m[0], mouth_m - rim_m, turn)
