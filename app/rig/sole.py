"""The sole of a foot in the T-pose, determined from the skeleton only."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.rig.ik import Side
from app.rig.model import Skeleton
from app.rig.skeleton import rest_positions

SIDES: Final[tuple[Side, Side]] = ("left", "right")
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
    ankle, toes = rest[skeleton.index(f"{side}Foot")], f"{side}Toes"
    way = rest[skeleton.index(toes)] - ankle if toes in skeleton.names else np.array([0.0, 0.0, FOOT_PART * ankle[1]])
    return way, float(ankle[1])


def roll_point_m(skeleton: Skeleton, side: Side) -> FloatArray:
    """Return the point (3,) about which a foot with a raised heel rolls over the floor, relative to the ankle in the
    T-pose, in metres: the joint of the toes, or the tip of the sole if the skeleton has no such joint.
    """
    if f"{side}Toes" in skeleton.names:
        return sole_way_m(skeleton, side)[0]
    return foot_tip_m(skeleton, side)
