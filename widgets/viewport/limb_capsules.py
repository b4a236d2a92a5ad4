"""Limbs as capsules, for shadows on the floor and hit testing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.rig.model import InstrumentModel, Skeleton
from app.rig.skeleton import rest_positions
from widgets.viewport.cast import Stage

SOLE_RADIUS_M = 0.046
FAR_AWAY_M = (0.0, -50.0, 0.0)

_BONES = (
    ("hips", "upperChest", 0.13),
    ("head", "head", 0.10),
    *(
        (side + upper, side + lower, radius)
        for side in ("left", "right")
        for upper, lower, radius in (
            ("UpperArm", "LowerArm", 0.048),
            ("LowerArm", "Hand", 0.04),
            ("UpperLeg", "LowerLeg", 0.078),
            ("LowerLeg", "Foot", 0.052),
        )
    ),
)
_HEAD_UP_M = (0.0, 0.09, 0.02)
LIMBS = len(_BONES) + 4
"""Number of limbs: bones, two feet, the instrument and the seat."""
SHADING, HELD = len(_BONES), len(_BONES) + 2
"""Number of limbs that shade the player as well as the floor, and index of the instrument."""


@dataclass(frozen=True, eq=False)
class _Anatomy:
    """The L capsules that stand for a character's limbs: their joints (L, 2), the ends' positions in the joints' frames
    (L, 2, 3), and radii (L,)."""

    joints: IndexArray
    offsets_m: FloatArray
    radii_m: FloatArray


@lru_cache(maxsize=16)
def _anatomy(skeleton: Skeleton) -> _Anatomy:
    rest = rest_positions(skeleton)
    names = skeleton.names
    joints, offsets, radii = [], [], []
    for start, end, radius in _BONES:
        end = end if end in names else "spine"
        joints.append((names.index(start), names.index(end)))
        offsets.append((_HEAD_UP_M, _HEAD_UP_M) if start == "head" else ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
        radii.append(radius)
    for side in ("left", "right"):
        ankle = names.index(side + "Foot")
        toes = names.index(side + "Toes") if side + "Toes" in names else ankle
        # A shoe is lower than a capsule of its width, so the capsule sinks into the floor.
        low_m = 0.6 * SOLE_RADIUS_M
        heel = (0.0, low_m - rest[ankle][1], -0.02)
        # Without toe joints the foot gets a usual length.
        tip = (0.0, low_m - rest[toes][1], 0.03 if toes != ankle else 0.15)
        joints.append((ankle, toes))
        offsets.append((heel, tip))
        radii.append(SOLE_RADIUS_M)
    return _Anatomy(np.array(joints, np.intp), np.array(offsets, np.float64), np.array(radii, np.float64))


@lru_cache(maxsize=64)
def model_bounds(model: InstrumentModel) -> tuple[FloatArray, FloatArray]:
    """Return least and greatest corner (3,) of the bounding box of a model at rest, in its frame."""
    low = np.min([mesh.positions_m.min(axis=0) for mesh in model.meshes], axis=0).astype(np.float64)
    high = np.max([mesh.positions_m.max(axis=0) for mesh in model.meshes], axis=0).astype(np.float64)
    return low, high


@lru_cache(maxsize=64)
def instrument_capsule(model: InstrumentModel) -> tuple[FloatArray, FloatArray, float]:
    """Return the capsule along the longest side of a model's bounds: both ends in its frame, and the radius."""
    low, high = model_bounds(model)
    size, middle = high - low, (low + high) / 2.0
    longest = int(np.argmax(size))
    across = np.delete(size, longest)
    radius = float(np.clip(across.min() / 2.0, 0.02, 0.09))
    first, last = middle.copy(), middle.copy()
    first[longest], last[longest] = low[longest] + radius, max(high[longest] - radius, low[longest] + radius)
    return first, last, radius


class LimbCapsules:
    """Capsules around the limbs of all performers on a stage.

    Parameters
    ----------
    stage : Stage
        The stage.
    """

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        anatomies = [_anatomy(member.assets.character.skeleton) for member in stage.members]
        self._joints = np.array([anatomy.joints for anatomy in anatomies], np.intp)
        self._offsets = np.array([anatomy.offsets_m for anatomy in anatomies])
        self._radii = np.array([anatomy.radii_m for anatomy in anatomies])
        nothing = (np.zeros(3), np.zeros(3), 0.0)
        capsules = [
            nothing if member.assets.held is None else instrument_capsule(member.assets.instrument)
            for member in stage.members
        ]
        self._held = np.array([(first, last) for first, last, _ in capsules])
        self._held_radii = np.array([radius for _, _, radius in capsules])
        self._seated = np.array([member.seat_m is not None for member in stage.members], dtype=bool)
        self._without = np.array([not member.has_body for member in stage.members], dtype=bool)

    def capsules(self) -> FloatArray:
        """Return the capsules (N, LIMBS, 2, 4) of N performers in the world: position and radius at both ends."""
        stage = self._stage
        count = len(stage.members)
        result = np.empty((count, LIMBS, 2, 4))
        rows = np.arange(count)[:, None, None]
        matrices = stage.joints[rows, self._joints]
        bones = self._joints.shape[1]
        result[:, :bones, :, :3] = (matrices[..., :3] @ self._offsets[..., None])[..., 0] + matrices[..., 3]
        result[:, :bones, :, 3] = self._radii[..., None]
        held = stage.bones[:, stage.first_node].astype(np.float64)[:, None]
        result[:, bones, :, :3] = (held[..., :3] @ self._held[..., None])[..., 0] + held[..., 3]
        result[:, bones, :, 3] = self._held_radii[:, None]
        seats = stage.bones[:, stage.seat_bone].astype(np.float64)
        across = 0.08 * seats[:, :, 0]
        down = np.array([0.0, 0.07, 0.0])
        result[:, -1, 0, :3] = seats[:, :, 3] - across - down
        result[:, -1, 1, :3] = seats[:, :, 3] + across - down
        result[:, -1, :, 3] = 0.1
        result[self._without, :bones] = (*FAR_AWAY_M, 0.0)
        result[~self._seated, -1] = (*FAR_AWAY_M, 0.0)
        result[~stage.shown] = (*FAR_AWAY_M, 0.0)
        return result


def hit(capsules: FloatArray, origin: FloatArray, direction: FloatArray) -> tuple[int, float] | None:
    """Return the index of the first of N bodies of L capsules (N, L, 2, 4: ends with radius) that a ray hits, and the
    distance in metres; None if there is none.
    """
    if not capsules.size:
        return None
    a, b = capsules[..., 0, :3], capsules[..., 1, :3]
    radius = 0.5 * (capsules[..., 0, 3] + capsules[..., 1, 3])
    ab, ap = b - a, origin - a
    length2 = np.maximum(np.einsum("nli,nli->nl", ab, ab), 1e-9)
    along = ab @ direction
    # Point of the segment nearest to the ray's line, then point of the ray nearest to it.
    det = np.maximum(length2 - along * along, 1e-9)
    share = (np.einsum("nli,nli->nl", ab, ap) - along * (ap @ direction)) / det
    on = a + np.clip(share, 0.0, 1.0)[..., None] * ab
    reach = (on - origin) @ direction
    miss = np.linalg.norm(origin + reach[..., None] * direction - on, axis=-1)
    depth = np.where((miss <= radius) & (reach > 0.0), reach, np.inf)
    row = int(np.argmin(depth.min(axis=1)))
    nearest = float(depth[row].min())
    return (row, nearest) if np.isfinite(nearest) else None
