"""The sole of a foot in the T-pose, determined from the skeleton only, and toes that do not bend."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.identity_cache import IdentityCache
from app.rig.ik import Side
from app.rig.model import Character, Skeleton
from app.rig.skeleton import rest_positions

SIDES: Final[tuple[Side, Side]] = ("left", "right")
STIFF_TOES: Final = "StiffToes"
"""End of the name of a joint of toes that do not bend."""
_WITHOUT_STIFF_TOES: IdentityCache[Character] = IdentityCache(64)
TIP_PART: Final = 0.4
"""Distance of the foot's tip beyond the toes' joint relative to the distance from ankle to toes."""
FOOT_PART: Final = 1.6
"""Distance of the toes' joint in front of the ankle relative to the ankle's height, for skeletons without it."""


def foot_tip_m(skeleton: Skeleton, side: Side) -> FloatArray:
    """Return the tip (3,) of a foot's sole relative to the ankle in the T-pose, in metres."""
    way, ankle_m = sole_way_m(skeleton, side)
    return np.array([(1.0 + TIP_PART) * way[0], -ankle_m, (1.0 + TIP_PART) * way[2]])


def sole_way_m(skeleton: Skeleton, side: Side) -> tuple[FloatArray, float]:
    """Return the vector (3,) from the ankle to the joint of the toes in the T-pose, and the height of the ankle, in
    metres.
    """
    rest = rest_positions(skeleton)
    ankle = rest[skeleton.index(f"{side}Foot")]
    toes = [name for name in (f"{side}Toes", f"{side}{STIFF_TOES}") if name in skeleton.names]
    way = rest[skeleton.index(toes[0])] - ankle if toes else np.array([0.0, 0.0, FOOT_PART * ankle[1]])
    return way, float(ankle[1])


def roll_point_m(skeleton: Skeleton, side: Side) -> FloatArray:
    """Return the point (3,) about which a foot with a raised heel rolls over the floor, relative to the ankle in the
    T-pose, in metres: the joint of the toes, or the tip of the sole if the skeleton has no such joint.
    """
    if f"{side}Toes" in skeleton.names:
        return sole_way_m(skeleton, side)[0]
    return foot_tip_m(skeleton, side)


def foot_joints(skeleton: Skeleton, side: Side) -> list[int]:
    """Return the joints of a foot, the ankle first."""
    return [skeleton.names.index(name) for name in (f"{side}Foot", f"{side}Toes") if name in skeleton.names]


def without_stiff_toes(character: Character) -> Character:
    """Return the character with the name `STIFF_TOES` for joints of toes that move no skin although the foot has some,
    as those that are supplied to figures without them: such feet roll over the tip.
    """
    return _WITHOUT_STIFF_TOES.step(_without_stiff_toes, character)


def _without_stiff_toes(character: Character) -> Character:
    skeleton, names = character.skeleton, list(character.skeleton.names)
    for side in SIDES:
        joints = foot_joints(skeleton, side)
        moves = [any(np.any(mesh.weights[mesh.joints == joint] > 0.0) for mesh in character.meshes) for joint in joints]
        if moves == [True, False]:
            names[joints[1]] = f"{side}{STIFF_TOES}"
    if tuple(names) == skeleton.names:
        return character
    return replace(character, skeleton=replace(skeleton, names=tuple(names)))
