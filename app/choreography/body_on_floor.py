"""Lift of a character whose knees, thighs, hips, hands or head would be below the floor."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import FloatArray
from app.choreography.skin_around import skin_around
from app.identity_cache import IdentityCache
from app.rig.ik import Side
from app.rig.model import Character
from app.rig.skeleton import forward, rest_positions
from app.rig.skinning import Skin
from app.rig.sole import SIDES

TOUCHING: Final = ("LowerLeg", "UpperLeg", "Hand", "LowerArm", "hips", "spine", "chest", "head")
"""Ends of the names of joints whose skin touches the floor in kneeling, sitting and lying."""
NEAR_M: Final = 0.3
"""Height in metres of the lowest of these joints above which none of their skin is near the floor."""
LIFTS_S: Final = 0.08
"""Standard deviation in seconds over which a body is lifted before and after it would be below the floor."""
MOST_M: Final = 0.15
"""Longest lift in metres at once; damage deeper than that is not a body on the floor."""
_SKINS: IdentityCache[tuple[tuple[Skin, ...], ...]] = IdentityCache(64)


class Lifts(NamedTuple):
    """Heights (F,) in metres by which hips and ankles must be lifted."""

    hips_m: FloatArray
    ankles_m: dict[Side, FloatArray]


def needed_lifts(character: Character, rotations: FloatArray, hips_m: FloatArray, fps: float) -> Lifts | None:
    """Return the lifts, smooth before and after, with which the skin around the joints of `TOUCHING` is not below the
    floor; None if none of it is.

    Parameters
    ----------
    rotations : (F, J, 4) float64
        Local rotations of the character's joints.
    hips_m : (F, 3) float64
        Positions of the hips.
    """
    touching = _touching(character)
    joints = forward(character.skeleton, rotations, hips_m, touching)
    places = [joints.place(joint) for joint in touching]
    near = np.flatnonzero(joints.positions_m[:, places, 1].min(axis=1) < NEAR_M)
    if not len(near):
        return None
    world = np.tile(np.eye(4), (len(near), len(character.skeleton.names), 1, 1))
    world[:, :, :3] = forward(character.skeleton, rotations[near], hips_m[near]).matrices()[:, :, :3]
    lifts = []
    for skins in _SKINS.step(_touching_skins, character):
        lowest_m = np.min([skin.deformed(world)[..., 1].min(axis=1) for skin in skins], axis=0, initial=np.inf)
        depth_m = np.zeros(len(rotations))
        depth_m[near] = np.clip(-lowest_m, 0.0, MOST_M)
        lifts.append(_smoothed(depth_m, fps))
    if not any(lift.any() for lift in lifts):
        return None
    body, *ankles = lifts
    return Lifts(body, dict(zip(SIDES, ankles, strict=True)))


def _smoothed(depth_m: FloatArray, fps: float) -> FloatArray:
    if not depth_m.any():
        return depth_m
    wide = 2 * round(2.0 * LIFTS_S * fps) + 1
    early = maximum_filter1d(depth_m, wide, mode="nearest")
    return np.asarray(gaussian_filter1d(early, LIFTS_S * fps, mode="nearest"))


def _touching(character: Character) -> list[int]:
    return [joint for joint, name in enumerate(character.skeleton.names) if name.endswith(TOUCHING)]


def _touching_skins(character: Character) -> tuple[tuple[Skin, ...], ...]:
    """Return the outermost vertices around each joint of `TOUCHING` of the body in its own clothes, since the cloth of
    skirts lies on the floor: those that rise with the hips, and those at the left and the right shin's lower half,
    which rise with the ankles.
    """
    body = character.undressed or character
    rest_m, middles_m = rest_positions(body.skeleton), dict[int, float]()
    for side in SIDES:
        knee, ankle = (body.skeleton.index(f"{side}{name}") for name in ("LowerLeg", "Foot"))
        middles_m[knee] = 0.5 * float(rest_m[knee, 1] + rest_m[ankle, 1])
    upper, lower = list[Skin](), {joint: list[Skin]() for joint in middles_m}
    for joint in _touching(body):
        middle_m = middles_m.get(joint, -np.inf)
        for own in skin_around(body, (joint,)):
            above = own.rest_m[:, 1] > middle_m
            if above.any():
                upper.append(own.skin(own.outermost(above)))
            if not above.all():
                lower[joint].append(own.skin(own.outermost(~above)))
    return tuple(upper), *(tuple(skins) for skins in lower.values())
