"""Keeps standing feet in place: the legs of a motion are solved again for foot tips that do not slide."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import BoolArray, FloatArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.feet_on_floor import free, legs_to, rest_tip_m
from app.choreography.hovering_feet import hover_m, supporting
from app.rig import quaternion
from app.rig.ik import leg
from app.rig.skeleton import JointTransforms
from app.rig.sole import SIDES

BRIDGED_S: Final = 0.06
"""Longest absence from the floor in seconds that is ignored."""
LEAST_S: Final = 0.05
"""Shortest stand in seconds; shorter ones are ignored."""
REACHED_M: Final = 0.08
"""Height in metres above the floor up to which a foot has landed; a higher one, lifted by a join, is still
descending.
"""
DRIFTS_M: Final = 0.18
"""Distance in metres of a tip's drift during a stand above which the foot takes a step instead."""
STEP_S: Final = 0.30
STEP_HIGH_M: Final = 0.03
"""Height in metres of such a step over `STEP_FAR_M` or more; less for shorter ones."""
STEP_FAR_M: Final = 0.10
CLEARS_M: Final = 0.012
"""Least height in metres of a foot's tip that is far from where it stood and will stand, so that it does not skid."""
CLEARS_WITHIN_M: Final = 0.028
"""Distance in metres from such a place within which most of that height is gained."""
SAME_M: Final = 0.04
"""Distance in metres below which places are equal if the foot hardly leaves the floor between them."""
LIFTED_M: Final = 0.03
"""Least height in metres to which a foot rises in a step that the motion itself takes."""
PULLED_M: Final = 0.04
"""Greatest distance in metres between a foot and its own path for a step that is as short as captured."""
SETTLE_S: Final = 0.30
"""Time in seconds after leaving and before reaching the floor within which a foot blends with its own path."""
REACH_SHARE: Final = 0.985
"""Largest reach of a standing foot relative to the leg's length; for a farther one the hips are lowered."""
LOWEST_SHARE: Final = 0.5
"""Height of a hip joint over a standing ankle relative to the leg's length below which the hips are not lowered for the
leg's reach; they move towards the foot instead.
"""
DEEPER: Final = 0.07
HIGHER: Final = 0.02
"""Difference in the height of the hips, as a share of the leg's length: lower for the heaviest and higher for the
lightest dancer."""
SINK_S: Final = 0.12
"""Standard deviation in seconds of the hips' lowering and of their way towards a foot."""

_UP: Final = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class FootPlant:
    """A span of frames, ``start`` to before ``stop``, in which a foot (0: left) is planted with its tip at one
    point."""

    foot: int
    start: int
    stop: int
    place_m: tuple[float, float, float]


def stands(clip: MotionClip, contacts: BoolArray, moved_m: FloatArray | None = None) -> tuple[FootPlant, ...]:
    """Find the spans in which feet stand still.

    Parameters
    ----------
    contacts : (F, 2) bool
        Captured contacts of the left and the right foot. A foot that a join or turn moves away while it should stand
        takes a step instead.
    moved_m : (F, 3) float64, optional
        Displacement of the whole body in each frame for staying near its place, which shortens steps.
    """
    fps, tips = float(clip.fps), tips_m(clip)
    unmoved = tips if moved_m is None else tips - moved_m[:, None]
    found = []
    for foot in range(2):
        on_floor_m = rest_tip_m(clip, foot)
        low = tips[:, foot, 1] < on_floor_m + REACHED_M
        for start, stop in _spans(contacts[:, foot] & low, fps):
            for first, last in _still(unmoved[start:stop, foot], fps):
                middle = _middle(tips[start + first : start + last, foot])
                place = (float(middle[0]), on_floor_m, float(middle[2]))
                found.append(FootPlant(foot, start + first, start + last, place))
    own = [_apart([stand for stand in found if stand.foot == foot], tips[:, foot], fps) for foot in range(2)]
    return tuple(sorted(own[0] + own[1], key=lambda stand: (stand.start, stand.foot)))


def foot_speeds_m_s(clip: MotionClip) -> FloatArray:
    """Speeds (F, 2) in m/s of the tips of the left and the right foot."""
    return np.asarray(np.linalg.norm(np.gradient(tips_m(clip), axis=0), axis=-1) * float(clip.fps))


def steps_s(standing: Sequence[FootPlant], fps: float) -> list[float]:
    """Durations in seconds for which feet are in the air between plants at two different positions."""
    found = []
    for foot in range(2):
        for before, after in pairwise(stand for stand in standing if stand.foot == foot):
            if np.linalg.norm(np.subtract(after.place_m, before.place_m)) > SAME_M:
                found.append((after.start - before.stop) / fps)
    return found


def _apart(standing: list[FootPlant], tip_m: FloatArray, fps: float) -> list[FootPlant]:
    """Shorten consecutive plants of a foot so that there is time between them for moving.

    A foot that lands at the same place and hardly rose continues to stand there. A step that the motion itself takes,
    lifting the foot, keeps its time however short it is; one made by a join takes `STEP_S`.
    """
    found: list[FootPlant] = []
    for stand in standing:
        if found:
            before = found[-1]
            way_m = float(np.linalg.norm(np.subtract(stand.place_m, before.place_m)))
            short = STEP_S * fps - (stand.start - before.stop)
            lifted_m = float(np.ptp(tip_m[before.stop - 1 : stand.start + 1, 1]))
            if short > 0.0 and way_m <= SAME_M and lifted_m < LIFTED_M:
                found[-1] = replace(before, stop=stand.stop)
                continue
            pulled = stand.place_m - tip_m[stand.start] - (before.place_m - tip_m[before.stop - 1])
            by_itself = lifted_m >= LIFTED_M and float(np.linalg.norm(pulled[[0, 2]])) <= PULLED_M
            if short > 0.0 and not by_itself:
                give = math.ceil(0.5 * short)
                found[-1] = replace(before, stop=before.stop - give)
                stand = replace(stand, start=stand.start + give)
                if found[-1].stop - found[-1].start < LEAST_S * fps:
                    found.pop()
        if stand.stop - stand.start >= LEAST_S * fps:
            found.append(stand)
    return found


def planted(
    clip: MotionClip,
    standing: tuple[FootPlant, ...],
    weight: float = 0.0,
    shown: FloatArray | None = None,
    aside_m: FloatArray | None = None,
) -> MotionClip:
    """Solve the legs again so that feet do not move while they are planted; between two plants the corrections are
    blended.

    Parameters
    ----------
    weight : float
        Weight of the dancer, -1 to 1: heavy dancers have lower hips with the same steps, light ones higher.
    shown : (F, 2) float64, optional
        Frame of the motion used for each foot in each frame; by default the same.
    aside_m : (F, 2, 3) float64, optional
        Displacements in metres of feet that do not stand.
    """
    if not standing and not weight:
        return clip
    world = clip.world()
    tips = tips_m(clip, world)
    if shown is not None:
        tips, world = _feet_at(tips, world, shown, planted_frames(standing, len(clip)), float(clip.fps))
    targets = tips.copy() if aside_m is None else tips + aside_m
    own = [[stand for stand in standing if stand.foot == foot] for foot in range(2)]
    for foot in range(2):
        targets[:, foot] += _correction(tips[:, foot], own[foot], float(clip.fps))
    hover = hover_m(clip, world, targets)
    targets[..., 1] -= hover[:, None]
    for foot in range(2):
        targets[:, foot, 1] = _cleared(targets[:, foot], own[foot], rest_tip_m(clip, foot))
    carried = [FootPlant(*span, (0.0, 0.0, 0.0)) for span in supporting(hover, targets)]
    length_m = leg(clip.shape.skeleton, "left").length_m
    lower_m = weight * length_m * (DEEPER if weight > 0.0 else HIGHER)
    towards = _towards_m(clip, world, targets, standing, lower_m)
    world = replace(world, positions_m=world.positions_m + towards[:, None])
    lower = lower_m + _sink_m(clip, world, targets, (*standing, *carried), lower_m)
    lower = lower[:, None] * np.array((0.0, 1.0, 0.0))
    clip = replace(clip, hips_m=clip.hips_m + towards - lower)
    world = replace(world, positions_m=world.positions_m - lower[:, None])
    return legs_to(clip, world, targets, planted_frames(standing, len(clip)))


def planted_frames(standing: Sequence[FootPlant], frames: int) -> BoolArray:
    """Return whether the left and the right foot stand in each frame (F, 2)."""
    found = np.zeros((frames, 2), bool)
    for stand in standing:
        found[stand.start : stand.stop, stand.foot] = True
    return found


def _feet_at(
    tips: FloatArray, world: JointTransforms, shown: FloatArray, on_floor: BoolArray, fps: float
) -> tuple[FloatArray, JointTransforms]:
    """World positions of foot tips (F, feet, 3) and world transforms of the feet, taken for each foot from the frame
    ``shown`` (F, feet), which may be fractional; a foot in the air turns along with the hips, as it does in a spin.
    """
    frames = np.arange(len(tips))
    tips, rotations = tips.copy(), world.rotations.copy()
    facing = np.unwrap(quaternion.twist_angle(rotations[:, 1 + SEGMENTS.index("hips")], _UP))
    for foot, name in enumerate(FEET):
        tips[:, foot] = CubicSpline(frames, tips[:, foot])(shown[:, foot])
        at = 1 + SEGMENTS.index(name)
        turned = quaternion.normalize(
            CubicSpline(frames, quaternion.continuous(rotations[:, at, None])[:, 0])(shown[:, foot])
        )
        along = free(on_floor[:, foot], fps) * (facing - np.interp(shown[:, foot], frames, facing))
        rotations[:, at] = quaternion.multiply(quaternion.from_axis_angle(_UP, along), turned)
    return tips, replace(world, rotations=rotations)


def _spans(contact: BoolArray, fps: float) -> list[tuple[int, int]]:
    """Convert a mask of contact frames to spans (start, stop); short interruptions are ignored, and short spans
    dropped.
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[0], contact.astype(np.int8), [0]])))
    spans: list[tuple[int, int]] = []
    for start, stop in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if spans and start - spans[-1][1] < BRIDGED_S * fps:
            spans[-1] = spans[-1][0], stop
        else:
            spans.append((start, stop))
    return [(start, stop) for start, stop in spans if stop - start >= LEAST_S * fps]


def _still(tip_m: FloatArray, fps: float) -> list[tuple[int, int]]:
    """Split a span (N, 3) of a foot tip's positions into parts in which it stays within `DRIFTS_M` of its middle; cuts
    are where the tip is fastest, with room for a step.
    """
    frames = len(tip_m)
    if frames < LEAST_S * fps:
        return []
    off = np.linalg.norm((tip_m - _middle(tip_m))[:, [0, 2]], axis=1)
    if off.max() <= DRIFTS_M:
        return [(0, frames)]
    speed = np.linalg.norm(np.gradient(tip_m, axis=0)[:, [0, 2]], axis=1) if frames > 1 else np.zeros(frames)
    middle = int(gaussian_filter1d(speed, 0.05 * fps, mode="nearest").argmax())
    half = max(1, round(0.5 * STEP_S * fps))
    first = _still(tip_m[: max(0, middle - half)], fps)
    later = min(frames, middle + half)
    return first + [(start + later, stop + later) for start, stop in _still(tip_m[later:], fps)]


def _middle(places_m: FloatArray) -> FloatArray:
    """Median (3,) of positions (N, 3), by coordinate."""
    ordered = np.sort(places_m, axis=0)
    return np.asarray(0.5 * (ordered[(len(ordered) - 1) // 2] + ordered[len(ordered) // 2]))


def _correction(tip_m: FloatArray, standing: list[FootPlant], fps: float) -> FloatArray:
    """Displacement (F, 3) that moves a foot's tip to the position where it must stand, blended between plants."""
    result = np.zeros_like(tip_m)
    for stand in standing:
        result[stand.start : stand.stop] = stand.place_m - tip_m[stand.start : stand.stop]
    ends = [None, *standing], [*standing, None]
    for before, after in zip(*ends, strict=True):
        start = 0 if before is None else before.stop
        stop = len(tip_m) if after is None else after.start
        if stop <= start:
            continue
        times = np.arange(start, stop)
        if before is not None:
            value, slope = _edge(result, start - 1, -1)
            fade = min(SETTLE_S * fps, 0.5 * (stop - start + 1))
            result[start:stop] += _eased(value, slope, (times - (start - 1)) / fade, fade)
        if after is not None:
            value, slope = _edge(result, stop, 1)
            fade = min(SETTLE_S * fps, 0.5 * (stop - start + 1))
            result[start:stop] += _eased(value, -slope, (stop - times) / fade, fade)
        # A foot that stood all the time in the capture is lifted for its step.
        if before is not None and after is not None and stop - start <= 1.5 * STEP_S * fps:
            way = np.linalg.norm(np.subtract(after.place_m, before.place_m))
            low = np.maximum(0.0, STEP_HIGH_M - np.ptp(tip_m[start:stop, 1])) * min(1.0, way / STEP_FAR_M)
            result[start:stop, 1] += low * np.sin(np.pi * (times - start + 1) / (stop - start + 1)) ** 2
    return result


def _cleared(tip_m: FloatArray, standing: list[FootPlant], rest_m: float) -> FloatArray:
    """Return the heights (F,) of the path (F, 3) of a foot's tip, raised where it would move low over the floor from
    one plant to the next; ``rest_m`` is the height of a standing tip.
    """
    height = tip_m[:, 1] - rest_m
    for before, after in pairwise([None, *standing, None]):
        start, stop = 0 if before is None else before.stop, len(tip_m) if after is None else after.start
        places = [stand.place_m for stand in (before, after) if stand is not None]
        if stop <= start or not places:
            continue
        away = (tip_m[start:stop, None] - np.array(places))[..., [0, 2]]
        near = np.square(away).sum(axis=-1).min(axis=1) / CLEARS_WITHIN_M**2
        least, own = -CLEARS_M * np.expm1(-near), height[start:stop]
        # Smooth maximum of both, the least height itself where that is 0.
        height[start:stop] = 0.5 * (own + least + np.hypot(own - least, 0.5 * least))
    return height + rest_m


def _edge(correction: FloatArray, frame: int, inwards: int) -> tuple[FloatArray, FloatArray]:
    """Value and slope per frame (3,) of a correction (F, 3) at the edge of a foot plant; ``inwards`` is the direction
    away from the plant.
    """
    inside = frame + (1 if inwards > 0 else -1)
    inside = min(max(inside, 0), len(correction) - 1)
    slope = (correction[inside] - correction[frame]) * (1 if inwards > 0 else -1)
    return correction[frame], slope


def _eased(value: FloatArray, slope: FloatArray, u: FloatArray, fade: float) -> FloatArray:
    """Cubic (N, 3) with the given initial value and slope per frame that ends at 0 and at rest at ``u`` = 1."""
    u = np.minimum(u, 1.0)[:, None]
    return np.asarray((1.0 - u) ** 2 * (1.0 + 2.0 * u) * value + (1.0 - u) ** 2 * u * fade * slope)


def _towards_m(
    clip: MotionClip, world: JointTransforms, targets: FloatArray, standing: tuple[FootPlant, ...], lower_m: float
) -> FloatArray:
    """Horizontal displacement (F, 3) of the hips in metres that brings planted feet within reach which are too far even
    with the hips at `LOWEST_SHARE`.
    """
    towards = np.zeros((len(clip), 3))
    for foot in range(2):
        way, length_m = _ankle_to_hip_m(clip, world, targets, foot)
        across = np.linalg.norm(way[:, [0, 2]], axis=1)
        height = np.minimum(way[:, 1] - lower_m, LOWEST_SHARE * length_m)
        reach = np.sqrt(np.maximum((REACH_SHARE * length_m) ** 2 - np.square(height), 0.0))
        far = np.zeros(len(clip))
        for stand in standing:
            if stand.foot == foot:
                here = slice(stand.start, stand.stop)
                far[here] = np.maximum(1.0 - reach[here] / np.maximum(across[here], 1e-9), 0.0)
        if far.any():
            towards -= _spread(far, float(clip.fps))[:, None] * way * (1.0, 0.0, 1.0)
    return towards


def _sink_m(
    clip: MotionClip, world: JointTransforms, targets: FloatArray, standing: tuple[FootPlant, ...], lower_m: float
) -> FloatArray:
    """Distance (F,) in metres by which the hips are lowered, in addition to ``lower_m``, where a planted foot would be
    out of reach.
    """
    sink = np.zeros(len(clip))
    ways = [_ankle_to_hip_m(clip, world, targets, foot) for foot in range(2)]
    for stand in standing:
        here, (way, length_m) = slice(stand.start, stand.stop), ways[stand.foot]
        across2 = np.square(way[here][:, [0, 2]]).sum(axis=1)
        lowest2 = (LOWEST_SHARE * length_m) ** 2
        allowed = np.sqrt(np.maximum((REACH_SHARE * length_m) ** 2 - across2, lowest2))
        sink[here] = np.maximum(sink[here], way[here, 1] - lower_m - allowed)
    return _spread(sink, float(clip.fps)) if sink.any() else sink


def _ankle_to_hip_m(
    clip: MotionClip, world: JointTransforms, targets: FloatArray, foot: int
) -> tuple[FloatArray, float]:
    """Vector (F, 3) in metres from a foot's ankle, with the foot's tip at its target, to the hip joint; and the length
    of the leg.
    """
    limb = leg(clip.shape.skeleton, SIDES[foot])
    end = clip.shape.ends_m[ENDS.index(FEET[foot])]
    ankle = targets[:, foot] - quaternion.rotate(world.rotations[:, limb.end], end)
    return world.positions_m[:, limb.upper] - ankle, limb.length_m


def _spread(values: FloatArray, fps: float) -> FloatArray:
    """Smooth upper envelope (F,) of values (F,): it rises and falls slowly and is never below them."""
    wide = 2 * round(2.5 * SINK_S * fps) + 1
    return np.asarray(gaussian_filter1d(maximum_filter1d(values, wide, mode="nearest"), SINK_S * fps, mode="nearest"))
