"""How a body carries an instrument before any motion: the angles of a map's `Carriage` and the upright posture."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec
import numpy as np
import numpy.typing as npt

from app.rig import quaternion
from app.rig.hold import Lips
from app.rig.model import Character
from app.rig.skeleton import forward
from instrument_maps.model import Carriage, InstrumentMap
from metadata.model import Body, Posture

FloatArray = npt.NDArray[np.float64]

HEAD_FOLLOWS = 0.4
"""Share of the instrument's pitch the head goes along with, up to the posture's limit."""


@dataclass(frozen=True, eq=False)
class Upright:
    """A player standing still with the instrument at the lips, in the player's frame (+Z ahead, +X left).

    Attributes
    ----------
    joints_m : (J, 3) float64
        World positions of all joints, arms as in the T-pose.
    instrument_m, instrument_rotation : (3,) and (4,) float64
        ``world_from_instrument``.
    """

    joints_m: FloatArray
    instrument_m: FloatArray
    instrument_rotation: FloatArray


def carriage_rotation(pitch_down_deg: float, yaw_left_deg: float, roll_left_deg: float) -> FloatArray:
    """Rotation (4,) of an instrument in the player's frame for the angles of a `Carriage`."""
    # Left is +X: the bell (+Z) goes left about +Y, down about +X, and up (+Y) leans left about -Z.
    yaw = quaternion.from_axis_angle([0.0, 1.0, 0.0], np.radians(yaw_left_deg))
    pitch = quaternion.from_axis_angle([1.0, 0.0, 0.0], np.radians(pitch_down_deg))
    roll = quaternion.from_axis_angle([0.0, 0.0, -1.0], np.radians(roll_left_deg))
    return quaternion.multiply(quaternion.multiply(yaw, pitch), roll)


def with_head(posture: Posture, carriage: Carriage) -> Posture:
    """The posture with the head bent after the instrument's pitch, as far as the posture allows."""
    down_deg = min(posture.head_down_deg, HEAD_FOLLOWS * max(carriage.pitch_down_deg[1], 0.0))
    spine_deg = dict(posture.spine_deg)
    spine_deg["head"] = spine_deg.get("head", 0.0) + down_deg
    return msgspec.structs.replace(posture, spine_deg=spine_deg)


def upright(character: Character, instrument_map: InstrumentMap, body: Body, lips: Lips) -> Upright:
    """Stand a character up with its instrument, as its posture and the instrument's usual carriage say."""
    skeleton, carriage = character.skeleton, instrument_map.hold.carriage("standing")
    posture = with_head(body.postures["standing"], carriage)
    rotations = np.tile(quaternion.IDENTITY, (1, len(skeleton.names), 1))
    for name, degrees in posture.spine_deg.items():
        if name in skeleton.names:
            rotations[0, skeleton.index(name)] = quaternion.from_axis_angle([1.0, 0.0, 0.0], np.radians(degrees))
    posed = forward(skeleton, rotations)
    head_m, head = posed.of(skeleton.index("head"))
    mouth_m = head_m[0] + quaternion.rotate(head[0], lips.contact_rest_m)
    turn = carriage_rotation(carriage.pitch_down_deg[1], carriage.yaw_left_deg[1], carriage.roll_left_deg[1])
    rim_m = quaternion.rotate(turn, np.asarray(instrument_map.mouthpiece.position_m))
    return Upright(posed.positions_m[0], mouth_m - rim_m, turn)
