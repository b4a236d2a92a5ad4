"""From where a player's fingers are seen past the instrument."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from app.arrays import FloatArray
from app.rig.grip.instrument_proxy import InstrumentNodes, bodies, inside
from widgets.viewport.cast import Stage

Direction = tuple[float, float]
"""Turn from the player's front towards their left, height of the eye, both in degrees."""

_SIDES_DEG = (0.0, -24.0, 24.0, -48.0, 48.0, -72.0, 72.0)
_HEIGHTS_DEG = (14.0, 34.0)
_EYE_M = 0.7
"""From the middle of the hands to where the eye is taken to be."""
_SKIN_M, _STEP_M = 0.02, 0.02
"""A line of sight starts this far from a joint, so that what a finger touches does not hide it; and its steps."""
_WIRE_M = 0.003
"""Half of the least thickness that still hides."""
_ENOUGH = 0.6
"""Least share of the fingers that must be seen from the usual direction to look from there."""
_UNUSUAL = 0.3
"""Share of the fingers that must be gained for a turn by 90 degrees from the usual direction."""


def directions(usual: Direction) -> list[Direction]:
    """The directions to choose from, the usual one first; in degrees."""
    return [usual, *((side, height) for side in _SIDES_DEG for height in _HEIGHTS_DEG)]


def clearest(gained: FloatArray, usual: Direction) -> Direction:
    """The direction near the usual one from which most of the fingers are not hidden by the instrument.

    Parameters
    ----------
    gained : (D,) float64
        Which share of the fingers is seen from each of `directions`.
    usual : tuple of float
        Where to look from unless too much is hidden, in degrees.
    """
    if gained[0] >= _ENOUGH:
        return usual
    found = directions(usual)
    turned = [math.hypot(side - usual[0], height - usual[1]) / 90.0 for side, height in found]
    return found[int(np.argmax(gained - _UNUSUAL * np.array(turned)))]


def visible_finger_shares(stage: Stage, row: int, towards_deg: Sequence[Direction], turn_rad: float) -> FloatArray:
    """Share (D,) of the player's fingers that is seen from each direction past the instrument; ``turn_rad`` is the
    direction the player faces, from +Z towards +X."""
    kit = stage.members[row].assets
    held = stage.node_matrix(row)
    places_m = _fingers(stage, row)
    towards = np.array([_unit(math.radians(side) + turn_rad, math.radians(height)) for side, height in towards_deg])
    lines = places_m.mean(axis=0) + _EYE_M * towards[:, None] - places_m
    lengths = np.linalg.norm(lines, axis=2)
    steps = np.arange(_SKIN_M, _EYE_M, _STEP_M)
    on_line = places_m[:, None] + lines[:, :, None] / lengths[:, :, None, None] * steps[:, None]
    local = ((on_line - held[:, 3]) @ held[:, :3]).reshape(-1, 3)
    names = kit.instrument.node_names
    nodes = InstrumentNodes(kit.instrument.node_positions_m, np.tile(np.eye(3), (len(names), 1, 1)))
    depth_m, _ = inside(bodies(kit.map.proxy, names), nodes, local, np.full(len(local), _WIRE_M))
    hidden = (depth_m.reshape(on_line.shape[:3]) > 0.0).any(axis=2)
    share: FloatArray = 1.0 - hidden.mean(axis=1)
    return share


def _fingers(stage: Stage, row: int) -> FloatArray:
    names: Sequence[str] = [
        f"{side}{finger}{joint}"
        for side in ("left", "right")
        for finger in ("Index", "Middle", "Ring", "Little")
        for joint in ("Intermediate", "Distal")
    ]
    return np.array([stage.joint_m(row, name) for name in names])


def _unit(yaw_rad: float, pitch_rad: float) -> FloatArray:
    """The direction in which a camera's eye is."""
    flat = math.cos(pitch_rad)
    return np.array([flat * math.sin(yaw_rad), math.sin(pitch_rad), flat * math.cos(yaw_rad)])
