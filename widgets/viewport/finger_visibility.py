"""Direction in which a player's moving fingers are best visible past the instrument and the hands."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.rig.grip.instrument_proxy import InstrumentNodes, bodies, inside
from instrument_maps.model import InstrumentMap
from widgets.viewport.cast import Stage

Direction = tuple[float, float]
"""Direction of the eye in degrees: rotation from the player's front towards their left, and elevation."""

_SIDES_DEG = (-12.0, 12.0, -24.0, 24.0, -48.0, 48.0, -72.0, 72.0)
_HEIGHTS_DEG = (14.0, 34.0)
"""Heights of the directions in degrees; none is from the front, whose other side would be the back."""
_EYE_M = 0.7
"""Distance in metres of the assumed eye from the middle of the hands."""
_SKIN_M, _STEP_M = 0.02, 0.02
"""Distance in metres at which a line of sight starts from a finger, so that touching parts do not hide it; and its
step.
"""
_WIRE_M = 0.003
"""Half of the least thickness in metres that hides."""
_UNUSUAL = 0.1
"""Share of the fingers that must be gained for a turn by 90 degrees from the usual direction."""

_HANDS: Final = ("left", "right")
_FINGERS: Final = ("Index", "Middle", "Ring", "Little")
_BONES: Final = ("Proximal", "Intermediate", "Distal")
_TIP_M = 0.022
"""Distance in metres from a finger's last joint to its tip."""


def directions(usual: Direction) -> list[Direction]:
    """Return the possible directions of view (yaw, pitch) in degrees, the usual one first."""
    return [usual, *((side, height) for side in _SIDES_DEG for height in _HEIGHTS_DEG)]


def clearest(gained: FloatArray, usual: Direction) -> Direction:
    """Return the direction with the best visibility, preferring directions near the usual one.

    Parameters
    ----------
    gained : (D,) float64
        Visibility from each of `directions`, 0..1.
    usual : tuple of float
        The usual direction in degrees.
    """
    found = directions(usual)
    turned = [math.hypot(side - usual[0], height - usual[1]) / 90.0 for side, height in found]
    return found[int(np.argmax(gained - _UNUSUAL * np.array(turned)))]


def fingers_seen(stage: Stage, row: int, towards_deg: Sequence[Direction], turn_rad: float) -> FloatArray:
    """Return the visibility of a player's moving fingers from each direction.

    A finger is best visible from the direction of its tip and above its back, and least from behind the hand. Parts
    hidden by the instrument are not visible.

    Parameters
    ----------
    turn_rad : float
        Direction in which the player faces, from +Z towards +X.

    Returns
    -------
    (D,) float64
        Visibility from each direction, 0..1.
    """
    wrists_m, joints_m = _moving_fingers(stage, row)
    tips_m = joints_m[:, 2] + _TIP_M * _unit(joints_m[:, 2] - joints_m[:, 1])
    hinges = np.cross(joints_m[:, 1] - joints_m[:, 0], tips_m - joints_m[:, 1])
    backs = -_unit(np.cross(hinges, tips_m - joints_m[:, 0]))
    sides = _unit(backs + _unit(tips_m - wrists_m))
    towards = _towards(towards_deg, turn_rad)
    seen = _past_instrument(stage, row, np.concatenate([joints_m[:, 2], tips_m]), towards)
    worth = 0.5 + 0.5 * (towards @ sides.T)
    result: FloatArray = (seen.reshape(len(towards), 2, -1).mean(axis=1) * worth).mean(axis=1)
    return result


def _moving(instrument: InstrumentMap) -> list[str]:
    """Return the prefixes of the joint names of fingers that play; of thumbs, which are behind, only if no other finger
    plays.
    """
    movers = {control.finger for control in instrument.controls if control.role == "pitch"}
    named = sorted(f"{hand}{finger.capitalize()}" for hand, finger in (mover.split(".") for mover in movers))
    fingers = [name for name in named if name.endswith(_FINGERS)]
    # A hand on a slide moves as a whole.
    fingers += [
        f"{name.removesuffix('Hand')}{finger}" for name in named if name.endswith("Hand") for finger in _FINGERS
    ]
    return fingers or [hand + finger for hand in _HANDS for finger in _FINGERS]


def _moving_fingers(stage: Stage, row: int) -> tuple[FloatArray, FloatArray]:
    """Return for the playing fingers of a player the wrists (fingers, 3) and the joints (fingers, 3, 3) in the world,
    metres."""
    names = _moving(stage.members[row].assets.map)
    wrists = [f"{hand}Hand" for name in names for hand in _HANDS if name.startswith(hand)]
    joints_m = np.array([[stage.joint_m(row, f"{name}{bone}") for bone in _BONES] for name in names])
    return np.array([stage.joint_m(row, name) for name in wrists]), joints_m


def _past_instrument(stage: Stage, row: int, points_m: FloatArray, towards: FloatArray) -> FloatArray:
    """Return for D directions and P points (P, 3) whether each point is visible past the instrument from there: (D, P),
    0 or 1."""
    lines = points_m.mean(axis=0) + _EYE_M * towards[:, None] - points_m
    steps = np.arange(_SKIN_M, _EYE_M, _STEP_M)
    on_line = points_m[:, None] + _unit(lines)[:, :, None] * steps[:, None]
    instrument, held = stage.members[row].assets.instrument, stage.node_matrix(row)
    names = instrument.node_names
    nodes = InstrumentNodes(instrument.node_positions_m, np.tile(np.eye(3), (len(names), 1, 1)))
    local = ((on_line - held[:, 3]) @ held[:, :3]).reshape(-1, 3)
    proxy = bodies(stage.members[row].assets.map.proxy, names)
    depth_m, _ = inside(proxy, nodes, local, np.full(len(local), _WIRE_M))
    hidden = (depth_m.reshape(on_line.shape[:3]) > 0.0).any(axis=2)
    return np.where(hidden, 0.0, 1.0)


def _unit(vectors: FloatArray) -> FloatArray:
    lengths: FloatArray = np.linalg.norm(vectors, axis=-1, keepdims=True)
    unit: FloatArray = vectors / np.maximum(lengths, 1e-9)
    return unit


def _towards(towards_deg: Sequence[Direction], turn_rad: float) -> FloatArray:
    """Return unit vectors (D, 3) towards the viewer for D directions (yaw, pitch) in degrees, turned with the
    player."""
    yaw, pitch = np.radians(np.array(towards_deg, np.float64)).T
    yaw = yaw + turn_rad
    return np.stack([np.cos(pitch) * np.sin(yaw), np.sin(pitch), np.cos(pitch) * np.cos(yaw)], axis=1)
