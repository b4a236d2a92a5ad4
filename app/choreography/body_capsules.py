"""Capsules of a character's trunk, head, arms and thighs, with radii measured on its skin."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray
from app.choreography.skin_around import skin_around
from app.identity_cache import IdentityCache
from app.rig import quaternion
from app.rig.ik import Side
from app.rig.model import Character
from app.rig.skeleton import rest_positions
from app.rig.sole import SIDES

TRUNK: Final = ("hips", "spine", "chest", "upperChest")
ARM: Final = ("UpperArm", "LowerArm", "Hand")
PERCENT: Final = (3.0, 97.0)
"""Percentiles of the positions of vertices that are the surface of a part of the body."""
SOFT: Final = 0.8
"""Radius of trunk and arms relative to that of their skin, since soft parts and clothes give way."""
MOST_RADIUS: Final = 0.075
"""Greatest radius relative to the body's height, for wide skirts and hair."""
USUAL: Final = {"trunk": 0.064, "head": 0.052, "UpperArm": 0.026, "LowerArm": 0.019, "Hand": 0.008, "UpperLeg": 0.04}
"""Radii relative to the body's height, of hands and of parts without skin of their own; hands are flat."""
THIGH_FROM: Final = 0.4
"""Share of the thigh from the hip joint from which arms are kept away from it; hanging hands are beside the rest."""
HAND: Final = 0.1
"""Length of a hand relative to the body's height, with loosely bent fingers."""


class BodyBone(NamedTuple):
    """A capsule between two points that move with joints: for each a joint and the way (3,) from it in the T-pose."""

    start: int
    start_way_m: FloatArray
    end: int
    end_way_m: FloatArray
    radius_m: float


@dataclass(frozen=True, eq=False)
class BodyCapsules:
    """Capsules of a character.

    Attributes
    ----------
    body : tuple of BodyBone
        Trunk and head.
    thighs : tuple of BodyBone
        Left and right thigh.
    radii_m : (3,) float64
        Radii of upper arm, forearm and hand.
    hand_m : float
        Length of a hand.
    """

    body: tuple[BodyBone, ...]
    thighs: tuple[BodyBone, ...]
    radii_m: FloatArray
    hand_m: float


_CAPSULES: IdentityCache[BodyCapsules] = IdentityCache(64)


def body_capsules(character: Character) -> BodyCapsules:
    """Return the capsules of a character in its own clothes, cached."""
    return _CAPSULES.step(_measured, character.undressed or character)


def positions_m(character: Character, world: Mapping[int, FloatArray], hips_m: FloatArray) -> dict[int, FloatArray]:
    """Return the positions (F, 3) in metres of the joints of ``world``, their world rotations (F, 4) by joint in an
    order from the root, with the hips at ``hips_m`` (F, 3)."""
    skeleton = character.skeleton
    found = {skeleton.index("hips"): hips_m}
    for joint in sorted(world):
        parent = skeleton.parents[joint]
        if joint not in found and parent in found:
            found[joint] = found[parent] + quaternion.rotate(world[parent], skeleton.offsets_m[joint])
    return found


def _measured(character: Character) -> BodyCapsules:
    skeleton = character.skeleton
    rest_m = rest_positions(skeleton)
    height = float(rest_m[:, 1].max())
    joints = [skeleton.index(name) for name in TRUNK if name in skeleton.names]
    shoulders = np.mean([rest_m[skeleton.index(f"{side}UpperArm")] for side in SIDES], axis=0)
    hips_m = rest_m[joints[0]]
    middle = 0.5 * (hips_m[1] + shoulders[1])
    skin = _skin_m(character, joints)
    widest = 0.9 * abs(float(rest_m[skeleton.index("leftUpperArm"), 0]))
    # Both ends of a part of the trunk, each with the joint that it follows.
    at_middle = min(joints, key=lambda joint: abs(float(rest_m[joint, 1]) - middle))
    ends = ((joints[0], float(hips_m[1])), (at_middle, float(middle)), (joints[-1], float(shoulders[1])))
    body = []
    for (start, low), (end, high) in pairwise(ends):
        here = skin[(skin[:, 1] > low) & (skin[:, 1] < high)]
        radius, ahead, wide = USUAL["trunk"] * height, float(hips_m[2]), widest
        if len(here):
            back, front = np.percentile(here[:, 2], PERCENT)
            radius = min(0.5 * SOFT * float(front - back), MOST_RADIUS * height)
            ahead, wide = 0.5 * float(front + back), min(widest, SOFT * float(np.percentile(here[:, 0], 97.0)))
        high = min(high, float(shoulders[1]) - radius)
        for sign in (1.0, -1.0):
            bottom, top = (np.array([sign * max(wide - radius, 0.0), y, ahead]) for y in (low, high))
            body.append(BodyBone(start, bottom - rest_m[start], end, top - rest_m[end], radius))
    body.append(_head(character, rest_m, height))
    radii = [_limb_radius_m(character, pair, rest_m, height) for pair in pairwise(ARM)]
    thighs = tuple(_thigh(character, side, rest_m, height) for side in SIDES)
    return BodyCapsules(tuple(body), thighs, np.array([*radii, USUAL["Hand"] * height]), HAND * height)


def _head(character: Character, rest_m: FloatArray, height: float) -> BodyBone:
    head = character.skeleton.index("head")
    skin = _skin_m(character, [head])
    skin = skin[skin[:, 1] > rest_m[head, 1]]
    radius, middle, top = USUAL["head"] * height, rest_m[head], float(rest_m[head, 1]) + 0.12 * height
    if len(skin):
        low, high = np.percentile(skin, PERCENT, axis=0)
        radius = min(radius, 0.5 * float((high - low)[[0, 2]].min()))
        middle, top = 0.5 * (low + high), float(high[1])
    bottom = np.array([middle[0], rest_m[head, 1] + 0.5 * radius, middle[2]])
    above = np.array([middle[0], max(top - radius, bottom[1]), middle[2]])
    return BodyBone(head, bottom - rest_m[head], head, above - rest_m[head], radius)


def _thigh(character: Character, side: Side, rest_m: FloatArray, height: float) -> BodyBone:
    hip, knee = (character.skeleton.index(f"{side}{name}") for name in ("UpperLeg", "LowerLeg"))
    radius = _limb_radius_m(character, ("UpperLeg", "LowerLeg"), rest_m, height)
    return BodyBone(hip, THIGH_FROM * (rest_m[knee] - rest_m[hip]), knee, np.zeros(3), radius)


def _limb_radius_m(character: Character, bone: tuple[str, str], rest_m: FloatArray, height: float) -> float:
    """Median distance in metres of the skin of the left bone between two joints from that bone."""
    side: Side = "left"
    start, end = (character.skeleton.index(f"{side}{name}") for name in bone)
    skin, usual = _skin_m(character, [start]), USUAL[bone[0]] * height
    way = rest_m[end] - rest_m[start]
    along = (skin - rest_m[start]) @ way / max(float(way @ way), 1e-9)
    beside = (along > 0.3) & (along < 0.9)
    if not beside.any():
        return SOFT * usual
    off = (skin - rest_m[start] - along[:, None] * way)[beside]
    return SOFT * float(np.clip(np.median(np.linalg.norm(off, axis=1)), 0.6 * usual, 1.4 * usual))


def _skin_m(character: Character, joints: Sequence[int]) -> FloatArray:
    """Positions (V, 3) in metres in the T-pose of the skin around joints."""
    return np.concatenate([np.zeros((0, 3)), *(skin.rest_m for skin in skin_around(character, joints))])
