"""Feet of a character on the floor: no toes, heel or edge of a sole below it, and flat toes under a raised heel."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import FloatArray
from app.choreography.bent_toes import toe_bend_rad
from app.choreography.skin_around import skin_around
from app.choreography.sole_skin import lowest_m_of, lowest_vertices_m
from app.identity_cache import IdentityCache
from app.rig import quaternion
from app.rig.ik import Side
from app.rig.model import Character, Skeleton
from app.rig.skeleton import rest_positions
from app.rig.sole import foot_joints, foot_tip_m, roll_point_m, sole_way_m

HEEL_PART: Final = 0.3
"""Distance of the heel behind the ankle relative to that from ankle to toes."""
FLOOR_SOFT_M: Final = 0.002
"""Height in metres within which the floor stops a foot softly."""
SOLE_M: Final = 0.02
"""Height in metres at rest up to which the skin of a foot belongs to its sole."""
OUTLINE: Final = 16
"""Number of directions in which the outermost point of a sole is found."""
HALF_WIDTH_PART: Final = 0.35
"""Half width of a sole without skin, relative to the distance from ankle to toes."""
EDGE_M: Final = 0.005
"""Distance in metres from a foot's axis from which a point can be on an edge."""
SINKS_M: Final = 0.005
"""Depth in metres up to which the skin of a foot may be in the floor while the foot rolls over it."""
FLATTENS_S: Final = 0.03
"""Standard deviation in seconds over which a foot is flattened before and after its edge would be below the floor."""
_OUTLINES: IdentityCache[FloatArray] = IdentityCache(64)
_SKINS: IdentityCache[FloatArray] = IdentityCache(64)
_UP: Final = np.array([0.0, 1.0, 0.0])


class PlacedFoot(NamedTuple):
    """A foot on or above the floor.

    Attributes
    ----------
    ankle_m : (F, 3) float64
        World position of the ankle in metres.
    rotations : (F, 4) float64
        World rotation of the foot.
    toes : (F, 4) float64
        Rotation of the toes relative to the foot; none without a joint of the toes.
    """

    ankle_m: FloatArray
    rotations: FloatArray
    toes: FloatArray


def over_the_floor(character: Character, side: Side, foot: FloatArray, ankle_m: FloatArray, fps: float) -> PlacedFoot:
    """Keep a foot above the floor: the ball is lifted to it, a heel or an edge below it is raised about the ball, and
    toes are bent flat. Without a joint of the toes the foot's tip takes the place of its ball.

    Parameters
    ----------
    foot : (F, 4) float64
        World rotation of the foot.
    ankle_m : (F, 3) float64
        World position of the ankle in metres.
    """
    skeleton = character.skeleton
    outline_m, axes = _OUTLINES.step(_outline_m, character, side), _axes(skeleton, side)
    roll, sole_m = roll_point_m(skeleton, side), sole_way_m(skeleton, side)[1]
    rest_m = float(sole_m + roll[1])
    under = rest_m * _UP
    heel = outline_m[:, 0].min() * axes[0] - under
    ball_m = ankle_m + quaternion.rotate(foot, roll)
    ball_m[:, 1] += _lift_m(ball_m[:, 1] - rest_m)
    along = quaternion.rotate(foot, heel)[:, 1]
    length_m = float(np.linalg.norm(heel))
    raised = np.minimum(along + _lift_m(ball_m[:, 1] + along), 0.999 * length_m)
    tilt = np.arcsin(raised / length_m) - np.arcsin(np.clip(along / length_m, -0.999, 0.999))
    foot = quaternion.multiply(foot, quaternion.from_axis_angle(np.array([1.0, 0.0, 0.0]), np.maximum(tilt, 0.0)))
    foot = _flattened(outline_m, axes, foot, ball_m[:, 1], rest_m, fps)
    bend = np.zeros(len(foot))
    if rest_m:
        tip_m = float(np.hypot(*(foot_tip_m(skeleton, side) - roll)[[0, 2]]))
        reach_m = max(tip_m, float(outline_m[:, 0].max()))
        bend = toe_bend_rad(foot, axes[0], ball_m[:, 1], rest_m, reach_m, fps)
    toes = quaternion.from_axis_angle(axes[1], -bend)
    # What is left: skin that bulges where toes bend, heels raised while the foot was rolled, and the backs of feet
    # whose soles face up.
    lowest_m = ball_m[:, 1] + lowest_m_of(_SKINS.step(_skin_m, character, side), foot, toes)
    ball_m[:, 1] += np.maximum(-lowest_m - SINKS_M, 0.0)
    return PlacedFoot(ball_m - quaternion.rotate(foot, roll), foot, toes)


def _lift_m(height_m: FloatArray) -> FloatArray:
    """Distance (F,) by which a point at a height must be lifted so that it stays above the floor, with a soft stop."""
    soft = FLOOR_SOFT_M * np.logaddexp(0.0, -height_m / FLOOR_SOFT_M)
    return np.asarray(np.where(height_m < 4.0 * FLOOR_SOFT_M, soft, 0.0))


def _axes(skeleton: Skeleton, side: Side) -> FloatArray:
    """Return the unit vectors (3, 3) of a foot's sole at rest: ahead, to the left, up."""
    way, _ = sole_way_m(skeleton, side)
    ahead = way * (1.0, 0.0, 1.0) / max(float(np.hypot(way[0], way[2])), 1e-9)
    return np.stack([ahead, np.cross(_UP, ahead), _UP])


def _outline_m(character: Character, side: Side) -> FloatArray:
    """Return the outermost points (K, 2) of a sole: metres ahead and to the left of the foot's ball, or of its tip
    without a joint of the toes.
    """
    skeleton = character.skeleton
    ahead, aside, _ = _axes(skeleton, side)
    joints = foot_joints(skeleton, side)
    roll_m = roll_point_m(skeleton, side)
    ball = rest_positions(skeleton)[joints[0]] + roll_m
    points = np.concatenate([own.rest_m for own in skin_around(character, joints)] or [np.zeros((0, 3))])
    points = points[points[:, 1] < SOLE_M] - ball
    sole = np.stack([points @ ahead, points @ aside], axis=1)
    if len(sole) < OUTLINE:
        length_m = float(np.linalg.norm(sole_way_m(skeleton, side)[0]))
        half_m = HALF_WIDTH_PART * length_m
        tip_m, ball_m = (
            float(np.linalg.norm(m[[0, 2]])) for m in (foot_tip_m(skeleton, side), roll_point_m(skeleton, side))
        )
        back_m = -tip_m - HEEL_PART * length_m
        return np.array([[x + tip_m - ball_m, y] for x in (0.25 * back_m, back_m) for y in (half_m, -half_m)])
    turns = 2.0 * np.pi * np.arange(OUTLINE) / OUTLINE
    outermost = np.unique((sole @ np.stack([np.cos(turns), np.sin(turns)])).argmax(axis=0))
    return np.asarray(sole[outermost])


def _skin_m(character: Character, side: Side) -> FloatArray:
    """Return the vertices (K, 6) of a foot that can be the lowest, as `lowest_vertices_m` does; the outline of the sole
    for a foot without skin.
    """
    found, skeleton = lowest_vertices_m(character, side), character.skeleton
    if len(found):
        return found
    height_m = float(sole_way_m(skeleton, side)[1] + roll_point_m(skeleton, side)[1])
    outline = _outline_m(character, side) @ _axes(skeleton, side)[:2] - height_m * _UP
    return np.concatenate([outline, np.zeros_like(outline)], axis=1)


def _flattened(
    outline_m: FloatArray, axes: FloatArray, foot: FloatArray, ball_m: FloatArray, rest_m: float, fps: float
) -> FloatArray:
    """Return the world rotations (F, 4) of a foot, rolled about its axis through the ball until no edge is below the
    floor.

    Parameters
    ----------
    outline_m : (K, 2) float64
        Outline of the sole, see `_outline_m`.
    axes : (3, 3) float64
        Axes of the sole, see `_axes`.
    ball_m : (F,) float64
        Height of the ball.
    rest_m : float
        Height of the ball at rest.
    """
    ahead, aside, up = (quaternion.rotate(foot, axis) for axis in axes)
    level = np.maximum(np.hypot(aside[:, 1], up[:, 1]), 1e-3)
    roll = np.arctan2(aside[:, 1], up[:, 1])
    # Toes in front of the ball are level while the heel is raised.
    rise = np.where(outline_m[:, 0] > 0.0, np.maximum(ahead[:, 1:2], 0.0), ahead[:, 1:2])
    room = np.maximum((ball_m - rest_m * level)[:, None] + outline_m[:, 0] * rise, 0.0) / level[:, None]
    bounds = []
    for sign in (1.0, -1.0):
        on = sign * outline_m[:, 1] > EDGE_M
        share = (room[:, on] / np.abs(outline_m[on, 1])).min(axis=1, initial=1.0)
        bounds.append(np.arcsin(np.clip(share, 0.0, 1.0)))
    # A sole that faces up is not turned over.
    upright = np.abs(roll) < 0.5 * np.pi
    least, most = np.where(upright, -bounds[0], -np.pi), np.where(upright, bounds[1], np.pi)
    needed = np.clip(roll, least, most) - roll
    if not needed.any():
        return foot
    wide = 2 * round(2.0 * FLATTENS_S * fps) + 1
    turned = np.zeros(len(roll))
    for sign in (1.0, -1.0):
        part = maximum_filter1d(np.maximum(sign * needed, 0.0), wide, mode="nearest")
        early = gaussian_filter1d(part, FLATTENS_S * fps, mode="nearest")
        # No foot is rolled beyond level before it lands.
        turned += sign * np.minimum(early, np.maximum(-sign * roll, 0.0))
    turned = np.where(upright, np.clip(roll + turned, least, most) - roll, 0.0)
    return quaternion.multiply(quaternion.from_rotation_vector(ahead * turned[:, None]), foot)
