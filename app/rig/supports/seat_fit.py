"""Size of a chair, from the skin of the player who sits on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.arrays import AnyIntArray, BoolArray, FloatArray, IndexArray, SingleArray
from app.identity_cache import IdentityCache
from app.rig.grip.body_size import leg_size
from app.rig.model import Character
from app.rig.skinning import patch
from app.rig.supports.chair import ChairFit

_SITTING = ("hips", "leftUpperLeg", "rightUpperLeg")
_LEANING = ("hips", "spine", "chest", "upperChest")
_LEAST_SHARE = 0.6
_CLEAR_M = 0.045
"""Distance in metres between a player's back and the chair's, since players do not lean back."""
_SIZES = (0.55, 1.15)
_SEAT_SHARE, _STEEP_SHARE = 0.75, 0.3
"""Share of the thigh, from behind, that rests on the seat: of a level thigh, and of one that descends steeply."""
_LEVEL, _STEEP = 0.1, 0.4
"""Descents of thighs, as shares of their length, that count as level and as steep."""


def chair_fit(character: Character, joints: FloatArray) -> ChairFit:
    """Return the chair that fits a seated player.

    Parameters
    ----------
    joints : (J, 3, 4) float64
        ``world_from_joint`` of the seated character.
    """
    sitting, leaning = _skin(character, joints, _SITTING), _skin(character, joints, _LEANING)
    size = float(np.clip(leg_size(character.skeleton), *_SIZES))
    hips_m = joints[character.skeleton.index("hips"), :, 3]
    knee_m = joints[character.skeleton.index("leftLowerLeg"), :, 3]
    if not len(sitting):
        sitting = hips_m[None] - [0.0, 0.1, 0.0]
    if not len(leaning):
        leaning = hips_m[None] - [0.0, 0.0, 0.1]
    upper_m = joints[character.skeleton.index("leftUpperLeg"), :, 3]
    descent = float((upper_m[1] - knee_m[1]) / np.linalg.norm(upper_m - knee_m))
    share = float(np.interp(descent, (_LEVEL, _STEEP), (_SEAT_SHARE, _STEEP_SHARE)))
    borne = sitting[:, 2] < hips_m[2] + share * (knee_m[2] - hips_m[2])
    top_m = float(sitting[borne, 1].min()) if borne.any() else float(sitting[:, 1].min())
    over = leaning[leaning[:, 1] > top_m + 0.02]
    rear_m = float(over[:, 2].min()) if len(over) else float(leaning[:, 2].min())
    return ChairFit(max(top_m, 0.12), rear_m - size * _CLEAR_M, size)


def _carried(
    names: tuple[str, ...], all_names: tuple[str, ...], joints: AnyIntArray, weights: SingleArray
) -> IndexArray:
    """Return the vertices, given by joints and weights (N, K), that the named joints move."""
    carrying: BoolArray = np.isin(all_names, names)
    return np.flatnonzero((weights * carrying[joints]).sum(axis=1) >= _LEAST_SHARE)


# People made from one body share joints and weights.
_CARRIED: IdentityCache[IndexArray] = IdentityCache(256)


def _skin(character: Character, joints: FloatArray, names: tuple[str, ...]) -> FloatArray:
    """Return the posed vertices (N, 3) of the skin that the named joints move."""
    skeleton = character.skeleton
    world = np.zeros((1, len(skeleton.names), 4, 4))
    world[0, :, :3], world[0, :, 3, 3] = joints, 1.0
    found = [np.zeros((0, 3))]
    for mesh in character.meshes:
        rows = _CARRIED.step(_carried, names, skeleton.names, mesh.joints, mesh.weights)
        if len(rows):
            found.append(patch(character, replace(mesh, morphs=()), rows).deformed(world)[0])
    return np.concatenate(found)
