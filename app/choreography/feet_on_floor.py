"""Keeps soles above the floor, and feet turned about their ankles no farther than those of people."""

from __future__ import annotations

from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import BoolArray, FloatArray, IntArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.body_speeds import angle
from app.choreography.clip import MotionClip
from app.choreography.limbs import bend, smooth_share, softly_within
from app.rig import quaternion
from app.rig.skeleton import JointTransforms
from app.rig.sole import SIDES

LEG: Final = ("UpperLeg", "LowerLeg", "Foot")
AHEAD: Final = (0.0, 0.0, 1.0)
"""Direction of a knee, in the frame of the thigh."""
SINKS_M: Final = 0.008
"""Depth in metres that a tip or heel approaches but never exceeds under the floor."""
LIFTS_S: Final = 0.05
"""Standard deviation in seconds over which a foot is lifted before and after it would be under the floor."""
FREE_S: Final = 0.12
"""Time in seconds beside a stand within which such a lift begins and ends."""
ANKLE_RAD: Final = ((-1.3, 1.45), (-1.0, 1.0), (-0.75, 0.75))
"""Least and greatest rotation in radians of a left foot relative to its lower leg, from the T-pose, about +X (toes
down), +Y (toes out) and +Z (sole out): the extremes of 70 clean captures from six sources."""
LEAST_RAD: Final = 1e-4
"""Angle in radians by which a foot must be turned to be placed again."""
_UP: Final = np.array([0.0, 1.0, 0.0])
_MIRRORED: Final = (1.0, -1.0, -1.0)


def legs_to(
    clip: MotionClip,
    world: JointTransforms,
    tips: FloatArray,
    planted: BoolArray,
    *,
    turned_back: bool = True,
) -> MotionClip:
    """Bend the legs of a motion so that the tips of its feet are at given positions, as far as the length of legs, the
    range of ankles and the floor allow.

    Parameters
    ----------
    world : JointTransforms
        World transforms of the clip, with the desired rotations of the feet.
    tips : (F, 2, 3) float64
        World positions in metres of the left and the right tip.
    planted : (F, 2) bool
        Frames in which the foot stands, so that its tip is not lifted from the floor.
    turned_back : bool
        Turn feet that are beyond the range of their ankles back into it; softly, so that those turned back before
        would be turned again.
    """
    return legs_along(clip, world, foot_paths(clip, tips, planted), turned_back=turned_back)


class FootPaths(NamedTuple):
    """Paths of the tips of both feet over the floor.

    Attributes
    ----------
    tips : (F, 2, 3) float64
        World positions in metres of the left and the right tip.
    planted : (F, 2) bool
        Frames in which the foot stands.
    free : (F, 2) float64
        See `free`.
    """

    tips: FloatArray
    planted: BoolArray
    free: FloatArray

    def at(self, frames: IntArray) -> FootPaths:
        """Return the paths in some frames (N,)."""
        return FootPaths(self.tips[frames], self.planted[frames], self.free[frames])


def foot_paths(clip: MotionClip, tips: FloatArray, planted: BoolArray) -> FootPaths:
    """Return the paths of tips (F, 2, 3), lifted smoothly where they are under the floor and do not stand."""
    fps, lifted, shares = float(clip.fps), tips.copy(order="K"), np.empty(planted.shape, order="F")
    for foot in range(2):
        lifted[:, foot] = _over_floor(tips[:, foot], rest_tip_m(clip, foot), planted[:, foot], fps)
        shares[:, foot] = free(planted[:, foot], fps)
    return FootPaths(lifted, planted, shares)


def legs_along(clip: MotionClip, world: JointTransforms, paths: FootPaths, *, turned_back: bool = True) -> MotionClip:
    """Bend the legs of a motion so that the tips of its feet follow paths (see `legs_to`). Every frame is bent alone,
    so that frames need not be consecutive.
    """
    rotations = clip.rotations.copy(order="K")
    for foot, side in enumerate(SIDES):
        limb = ("hips", *(f"{side}{part}" for part in LEG))
        at, end = 1 + SEGMENTS.index(FEET[foot]), clip.shape.ends_m[ENDS.index(FEET[foot])]
        own = world.only([1 + SEGMENTS.index(name) for name in limb])
        tip, planted = paths.tips[:, foot].copy(order="K"), paths.planted[:, foot]
        bend(clip, own, limb, tip - quaternion.rotate(own.of(at)[1], end), AHEAD, rotations)
        _move(clip, own, limb, rotations)
        was = own.of(at)[1]
        turned = quaternion.multiply(was, _into_range(rotations[:, at - 1], foot)) if turned_back else was
        # In the air a foot is turned about its ankle, on the floor about its tip.
        way = quaternion.rotate(turned, end) - quaternion.rotate(was, end)
        tip += paths.free[:, foot, None] * way
        tip[:, 1] = _above(tip[:, 1], rest_tip_m(clip, foot), planted)
        turned = _heel_up(turned, tip[:, 1], end)
        some = np.flatnonzero(angle(was, turned) > LEAST_RAD)
        if len(some):
            part = own.at(some)
            part.of(at)[1][:] = turned[some]
            solved = rotations[some]
            bend(clip, part, limb, tip[some] - quaternion.rotate(turned[some], end), AHEAD, solved)
            rotations[some] = solved
    return replace(clip, rotations=quaternion.continuous(rotations))


def _move(clip: MotionClip, world: JointTransforms, limb: tuple[str, ...], rotations: FloatArray) -> None:
    """Update the world transforms ``world`` in place for a leg: from ``rotations`` (F, 16, 4), the local ones of the
    clip, follow positions of its joints and rotations of thigh and shank.
    """
    above_m, above = world.of(1 + SEGMENTS.index(limb[0]))
    for name in limb[1:]:
        at = 1 + SEGMENTS.index(name)
        place_m, turned = world.of(at)
        np.add(above_m, quaternion.rotate(above, clip.shape.offsets_m[at - 1]), out=place_m)
        turned[:] = quaternion.multiply(above, rotations[:, at - 1])
        above_m, above = place_m, turned


def rest_tip_m(clip: MotionClip, foot: int) -> float:
    """Return the height in metres above the floor of a foot's tip in the T-pose; ``foot`` is 0 for the left foot."""
    side = SIDES[foot]
    names = ("hips", *(f"{side}{part}" for part in LEG))
    height = sum(clip.shape.offsets_m[SEGMENTS.index(name), 1] for name in names)
    return float(height + clip.shape.ends_m[ENDS.index(FEET[foot]), 1])


def soles_m(clip: MotionClip, world: JointTransforms) -> FloatArray:
    """Return the heights (F, 2, 2) in metres of tip and heel, the point of the sole under the ankle, of each foot."""
    found = []
    for name in FEET:
        at, end = 1 + SEGMENTS.index(name), clip.shape.ends_m[ENDS.index(name)]
        ankle, turned = world.of(at)
        found.append([(ankle + quaternion.rotate(turned, way))[:, 1] for way in (end, end * _UP)])
    return np.moveaxis(np.array(found), -1, 0)


def grounded(clip: MotionClip, planted: BoolArray) -> MotionClip:
    """Return the motion with soles on or above the floor; the same object if none is below it."""
    if soles_m(clip, clip.world([1 + SEGMENTS.index(name) for name in FEET])).min(initial=0.0) >= -SINKS_M:
        return clip
    world = clip.world()
    ends = [(1 + SEGMENTS.index(name), clip.shape.ends_m[ENDS.index(name)]) for name in FEET]
    tips = [world.positions_m[:, at] + quaternion.rotate(world.rotations[:, at], end) for at, end in ends]
    return legs_to(clip, world, np.stack(tips, axis=1), planted, turned_back=False)


def _over_floor(tip: FloatArray, rest_m: float, planted: BoolArray, fps: float) -> FloatArray:
    """Lift the path (F, 3) of a foot's tip where it is under the floor, smoothly before and after; not while the foot
    is ``planted``. ``rest_m`` is the tip's height in the T-pose.
    """
    floor_m = min(rest_m, 0.0)
    depth = np.where(planted, 0.0, np.maximum(floor_m - tip[:, 1], 0.0))
    tip = tip.copy(order="K")
    if depth.any():
        wide = 2 * round(2.0 * LIFTS_S * fps) + 1
        lift = gaussian_filter1d(maximum_filter1d(depth, wide, mode="nearest"), LIFTS_S * fps, mode="nearest")
        tip[:, 1] += lift * free(planted, fps)
        tip[:, 1] = _above(tip[:, 1], rest_m, planted)
    return tip


def _above(heights_m: FloatArray, rest_m: float, planted: BoolArray) -> FloatArray:
    """Limit heights (F,) of a foot's tip softly to at most `SINKS_M` under the floor; those of planted feet are
    unchanged.
    """
    under = np.where(planted, 0.0, np.minimum(heights_m - min(rest_m, 0.0), 0.0))
    return np.asarray(heights_m + SINKS_M * np.expm1(under / SINKS_M) - under)


def free(planted: BoolArray, fps: float, from_s: float = FREE_S) -> FloatArray:
    """Return a factor (F,) that rises smoothly from 0 in frames in which a foot stands to 1 at a distance of ``from_s``
    seconds from them.
    """
    if not planted.any():
        return np.ones(len(planted))
    frames, stands = np.arange(len(planted)), np.flatnonzero(planted)
    after = np.searchsorted(stands, frames)
    next_at = stands[np.minimum(after, len(stands) - 1)]
    last_at = stands[np.maximum(after - 1, 0)]
    away = np.minimum(np.abs(next_at - frames), np.abs(frames - last_at))
    return smooth_share(away, (0.0, max(from_s * fps, 1.0)))


def _into_range(turned: FloatArray, foot: int) -> FloatArray:
    """Return the rotations (F, 4), in the foot's own axes, that bring a foot, rotated by ``turned`` (F, 4) relative to
    its lower leg, back within `ANKLE_RAD`."""
    sign = np.array(_MIRRORED) if foot else np.ones(3)
    angles = quaternion.to_rotation_vector(turned) * sign
    inside = [softly_within(angles[:, axis], *bounds) for axis, bounds in enumerate(ANKLE_RAD)]
    held = quaternion.from_rotation_vector(quaternion.columns(*inside) * sign)
    return quaternion.multiply(quaternion.conjugate(turned), held)


def _heel_up(turned: FloatArray, tip_m: FloatArray, end: FloatArray) -> FloatArray:
    """Return world rotations (F, 4) of a foot with the heel raised about the tip wherever it would be under the floor.

    Parameters
    ----------
    tip_m : (F,) float64
        Height of the tip.
    end : (3,) float64
        Vector from ankle to tip.
    """
    way = quaternion.rotate(turned, end * (1.0, 0.0, 1.0))
    across = quaternion.rotate(turned, np.array([1.0, 0.0, 0.0])) * (1.0, 0.0, 1.0)
    size = np.linalg.norm(across, axis=1, keepdims=True)
    across = across / np.maximum(size, 1e-9)
    high, ahead = way[:, 1], np.einsum("fi,fi->f", way, np.cross(across, _UP))
    reach = np.maximum(np.hypot(high, ahead), 1e-9)
    # A sole that leans back beyond upright is pitched as one that is upright.
    high = np.where((ahead < 0.0) & (high > 0.0), reach, high)
    # The heel lies under the tip by as much as the sole rises to the tip.
    under = np.maximum(high - np.maximum(tip_m, 0.0), 0.0)
    allowed = high - under - SINKS_M * np.expm1(-under / SINKS_M)
    pitch = np.where(under > 0.0, np.arctan2(way[:, 1], ahead) - np.arcsin(np.clip(allowed / reach, -1.0, 1.0)), 0.0)
    # A foot that lies on its side has no heel under its toes.
    share = np.clip(2.0 * size[:, 0] - 0.5, 0.0, 1.0)
    return quaternion.multiply(quaternion.from_rotation_vector(across * (share * pitch)[:, None]), turned)
