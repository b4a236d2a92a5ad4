"""Keeps standing feet in place: the legs of a motion are solved again for foot tips that do not slide."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import FloatArray, IntArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.feet_on_floor import FREE_S, free, legs_to, rest_tip_m
from app.choreography.foot_plants import STEP_S, FootPlant, InAir, planted_frames
from app.choreography.hovering_feet import hover_m, supporting
from app.choreography.limbs import smooth_share
from app.choreography.low_feet import cleared_m
from app.rig import quaternion
from app.rig.ik import leg
from app.rig.skeleton import JointTransforms
from app.rig.sole import SIDES

STEP_HIGH_M: Final = 0.03
"""Height in metres of a step made by a join over `STEP_FAR_M` or more; less for shorter ones."""
STEP_FAR_M: Final = 0.10
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
HASTE: Final = 1.5
"""Speed relative to the motion's own above which a stand is not shown faster, but shortened: what lies between its
beginning and its end is left out."""

_UP: Final = np.array([0.0, 1.0, 0.0])
_LEGS: Final = tuple(
    1 + at for at, name in enumerate(SEGMENTS) if name == "hips" or name.endswith(("UpperLeg", "LowerLeg", "Foot"))
)


@dataclass(frozen=True, eq=False)
class MovingBody:
    """A motion's world transforms, with its feet at any moment.

    Attributes
    ----------
    world : JointTransforms
        Transforms of all joints.
    tips : (F, 2, 3) float64
        World positions of the tips of the left and the right foot.
    """

    world: JointTransforms
    tips: FloatArray

    @classmethod
    def of(cls, clip: MotionClip) -> MovingBody:
        """Return the body of a clip."""
        world = clip.world()
        return cls(world, tips_m(clip, world))

    @cached_property
    def facing_rad(self) -> FloatArray:
        """Direction (F,) of the hips about the vertical without jumps of a whole turn."""
        return np.unwrap(quaternion.twist_angle(self.world.of(1 + SEGMENTS.index("hips"))[1], _UP))

    @cached_property
    def _splines(self) -> list[tuple[CubicSpline, CubicSpline]]:
        """For each foot its tip's position and its rotation, by frame."""
        frames, turns = np.arange(len(self.tips)), [self.world.of(1 + SEGMENTS.index(name))[1] for name in FEET]
        return [
            (CubicSpline(frames, self.tips[:, foot]), CubicSpline(frames, quaternion.continuous(turned[:, None])[:, 0]))
            for foot, turned in enumerate(turns)
        ]

    def foot_at(self, foot: int, frames: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the positions (N, 3) of a foot's tip and the rotations (N, 4) of the foot at possibly fractional
        frames.
        """
        tip, turned = (spline(frames) for spline in self._splines[foot])
        return tip, quaternion.normalize(np.asfortranarray(turned))


def planted(
    clip: MotionClip,
    standing: tuple[FootPlant, ...],
    weight: float = 0.0,
    shown: FloatArray | None = None,
    aside_m: FloatArray | None = None,
    body: MovingBody | None = None,
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
    body : MovingBody, optional
        The clip's body, if known.
    """
    if not standing and not weight:
        return clip
    body = MovingBody.of(clip) if body is None else body
    tips, legs = body.tips, body.world.only(_LEGS)
    if shown is not None:
        tips = _feet_at(body, legs, shown, standing, float(clip.fps))
    targets = tips.copy(order="K") if aside_m is None else tips + aside_m
    own = [[stand for stand in standing if stand.foot == foot] for foot in range(2)]
    for foot in range(2):
        targets[:, foot] += _correction(tips[:, foot], own[foot], float(clip.fps))
    hover = hover_m(clip, body.world, legs, targets)
    targets[..., 1] -= hover[:, None]
    for foot in range(2):
        targets[:, foot, 1] = cleared_m(targets[:, foot], own[foot], rest_tip_m(clip, foot))
    carried = [FootPlant(*span, (0.0, 0.0, 0.0)) for span in supporting(hover, targets)]
    length_m = leg(clip.shape.skeleton, "left").length_m
    lower_m = weight * length_m * (DEEPER if weight > 0.0 else HIGHER)
    towards = _towards_m(clip, legs, targets, standing, lower_m)
    legs = replace(legs, positions_m=legs.positions_m + towards[:, None])
    lower = lower_m + _sink_m(clip, legs, targets, (*standing, *carried), lower_m)
    lower = quaternion.columns(0.0, lower, 0.0)
    clip = replace(clip, hips_m=clip.hips_m + towards - lower)
    legs = replace(legs, positions_m=legs.positions_m - lower[:, None])
    return legs_to(clip, legs, targets, planted_frames(standing, len(clip)))


def _feet_at(
    body: MovingBody, legs: JointTransforms, shown: FloatArray, standing: Sequence[FootPlant], fps: float
) -> FloatArray:
    """World positions of foot tips (F, feet, 3), taken for each foot from the frame ``shown`` (F, feet), which may be
    fractional. The feet are turned likewise, in place in ``legs``; a foot in the air turns along with the hips, as it
    does in a spin. Stands much shorter than in the motion are shortened, see `HASTE`.
    """
    frames, tips, facing = np.arange(len(shown)), np.empty_like(body.tips), body.facing_rad
    on_floor = planted_frames(standing, len(shown))
    for foot, name in enumerate(FEET):
        tips[:, foot], turned = body.foot_at(foot, shown[:, foot])
        faced, along = np.interp(shown[:, foot], frames, facing), free(on_floor[:, foot], fps)
        short = _Shortened.of(shown[:, foot], [stand for stand in standing if stand.foot == foot])
        if len(here := short.frames):
            (begun_m, begun), (ended_m, ended) = (body.foot_at(foot, at) for at in (short.since_start, short.till_end))
            left = facing[short.ends] - faced[short.ends]
            kept = _turned_rad(turned[short.ends], turned[short.starts]) * np.sign(left)
            kept = np.clip(kept / np.maximum(np.abs(left), 1e-9), 0.0, 1.0)
            tips[here, foot] = begun_m + short.shares[:, None] * (ended_m - begun_m)
            turned[here] = quaternion.slerp(begun, ended, short.shares)
            faced[here], along[here] = np.interp(short.till_end, frames, facing), short.shares * kept[short.which]
            _carry_on(along, short, kept, max(FREE_S * fps, 1.0))
        along *= facing - faced
        legs.of(1 + SEGMENTS.index(name))[1][:] = quaternion.multiply(quaternion.from_axis_angle(_UP, along), turned)
    return tips


def _turned_rad(one: FloatArray, other: FloatArray) -> FloatArray:
    """Angle (N,) about the vertical from rotations (N, 4) to others, the shorter way."""
    return quaternion.twist_angle(quaternion.multiply(other, quaternion.conjugate(one)), _UP)


class _Shortened(NamedTuple):
    """Stands of a foot that are much shorter than in the motion.

    Attributes
    ----------
    starts, ends, follow : (S,) int64
        First and last frame of each stand, and the first one of the foot's next stand.
    frames : (N,) int64
        Frames of all stands, ascending.
    which : (N,) int64
        Index of the stand of each frame.
    since_start, till_end : (N,) float64
        For each the frame of the motion that is as far from the beginning and from the end of its stand.
    shares : (N,) float64
        Share of the latter, 0 at the beginning and 1 at the end.
    """

    starts: IntArray
    ends: IntArray
    follow: IntArray
    frames: IntArray
    which: IntArray
    since_start: FloatArray
    till_end: FloatArray
    shares: FloatArray

    @classmethod
    def of(cls, shown: FloatArray, standing: Sequence[FootPlant]) -> _Shortened:
        """Return those stands of a foot that ``shown`` (F,) hastens by more than `HASTE`."""
        starts = np.array([stand.start for stand in standing], np.int64)
        ends = np.array([stand.stop - 1 for stand in standing], np.int64)
        (hasty,) = np.nonzero(shown[ends] - shown[starts] > HASTE * (ends - starts))
        follow = np.append(starts, 2 * len(shown))[hasty + 1]
        starts, ends = starts[hasty], ends[hasty]
        spans = [np.arange(start, end + 1) for start, end in zip(starts.tolist(), ends.tolist(), strict=True)]
        frames = np.concatenate([np.zeros(0, np.int64), *spans])
        which = np.repeat(np.arange(len(starts)), ends - starts + 1)
        since, left = frames - starts[which], ends[which] - frames
        shares = smooth_share(since / (since + left), (0.0, 1.0))
        return cls(starts, ends, follow, frames, which, shown[starts][which] + since, shown[ends][which] - left, shares)


def _carry_on(along: FloatArray, short: _Shortened, kept: FloatArray, over: float) -> None:
    """Let the shares (F,) in which a foot turns along with the hips rise, in place, from those ``kept`` (S,) at the end
    of shortened stands, within ``over`` frames.
    """
    since = np.arange(1, round(over) + 1)
    after, begun = short.ends[:, None] + since, kept[:, None]
    risen = begun + (1.0 - begun) * smooth_share(since.astype(np.float64), (0.0, over))
    shares = np.minimum(risen, smooth_share((short.follow[:, None] - after).astype(np.float64), (0.0, over)))
    some = after < np.minimum(short.follow, len(along))[:, None]
    along[after[some]] = shares[some]


def _correction(tip_m: FloatArray, standing: list[FootPlant], fps: float) -> FloatArray:
    """Displacement (F, 3) that moves a foot's tip to the position where it must stand, blended between plants."""
    result = np.zeros_like(tip_m)
    if not standing:
        return result
    for stand in standing:
        here = slice(stand.start, stand.stop)
        result[here] = stand.place_m - tip_m[here]
    air = InAir.between(standing, len(tip_m))
    if not len(air.frames):
        return result
    lengths = air.stops - air.starts
    fades = np.minimum(SETTLE_S * fps, 0.5 * (lengths + 1))
    ends = (
        ((air.frames - (air.starts - 1)[air.spans]), _edges(result, standing, air.before, -1)),
        ((air.stops[air.spans] - air.frames), _edges(result, standing, air.after, 1)),
    )
    fade = fades[air.spans]
    for away, (values, slopes) in ends:
        # A cubic with the value and slope of the stand there that ends at 0 and at rest.
        u = np.minimum(away / fade, 1.0)
        by_value, by_slope = (1.0 - u) ** 2 * (1.0 + 2.0 * u), (1.0 - u) ** 2 * u * fade
        for axis in range(3):
            result[air.frames, axis] += by_value * values[air.spans, axis] + by_slope * slopes[air.spans, axis]
    # A foot that stood all the time in the capture is lifted for its step.
    places = np.array([stand.place_m for stand in standing])
    steps = (air.before >= 0) & (air.after >= 0) & (lengths <= 1.5 * STEP_S * fps)
    way = np.where(steps, np.linalg.norm(places[air.after] - places[air.before], axis=1), 0.0)
    heights, firsts = tip_m[air.frames, 1], np.cumsum(lengths) - lengths
    rises = np.maximum.reduceat(heights, firsts) - np.minimum.reduceat(heights, firsts)
    low = np.maximum(0.0, STEP_HIGH_M - rises) * np.minimum(1.0, way / STEP_FAR_M)
    swung = np.sin(np.pi * (air.frames - air.starts[air.spans] + 1) / (lengths + 1)[air.spans]) ** 2
    result[air.frames, 1] += low[air.spans] * swung
    return result


def _edges(
    correction: FloatArray, standing: Sequence[FootPlant], stands: IntArray, inwards: int
) -> tuple[FloatArray, FloatArray]:
    """Values and slopes per frame, away from the stand, (N, 3) of a correction (F, 3) at the last frame (``inwards``
    -1) or the first one (1) of stands given as indices (N,) in ``standing``; 0 for those of -1.
    """
    edge = np.array([stand.start if inwards > 0 else stand.stop - 1 for stand in standing])[stands]
    some = np.array([stand.stop - stand.start > 1 for stand in standing])[stands]
    values = correction[edge]
    slopes = np.where(some[:, None], values - correction[edge + np.where(some, inwards, 0)], 0.0)
    exists = (stands >= 0)[:, None]
    return np.where(exists, values, 0.0), np.where(exists, slopes, 0.0)


def _towards_m(
    clip: MotionClip, legs: JointTransforms, targets: FloatArray, standing: tuple[FootPlant, ...], lower_m: float
) -> FloatArray:
    """Horizontal displacement (F, 3) of the hips in metres that brings planted feet within reach which are too far even
    with the hips at `LOWEST_SHARE`.
    """
    towards, on_floor = np.zeros((3, len(clip))).T, planted_frames(standing, len(clip))
    for foot in range(2):
        way, length_m = _ankle_to_hip_m(clip, legs, targets, foot)
        across = np.hypot(way[:, 0], way[:, 2])
        height = np.minimum(way[:, 1] - lower_m, LOWEST_SHARE * length_m)
        reach = np.sqrt(np.maximum((REACH_SHARE * length_m) ** 2 - np.square(height), 0.0))
        far = np.where(on_floor[:, foot], np.maximum(1.0 - reach / np.maximum(across, 1e-9), 0.0), 0.0)
        if far.any():
            share = _spread(far, float(clip.fps))
            towards[:, 0] -= share * way[:, 0]
            towards[:, 2] -= share * way[:, 2]
    return towards


def _sink_m(
    clip: MotionClip, legs: JointTransforms, targets: FloatArray, standing: tuple[FootPlant, ...], lower_m: float
) -> FloatArray:
    """Distance (F,) in metres by which the hips are lowered, in addition to ``lower_m``, where a planted foot would be
    out of reach.
    """
    sink, on_floor = np.zeros(len(clip)), planted_frames(standing, len(clip))
    for foot in range(2):
        way, length_m = _ankle_to_hip_m(clip, legs, targets, foot)
        across2 = np.square(way[:, 0]) + np.square(way[:, 2])
        allowed = np.sqrt(np.maximum((REACH_SHARE * length_m) ** 2 - across2, (LOWEST_SHARE * length_m) ** 2))
        sink = np.where(on_floor[:, foot], np.maximum(sink, way[:, 1] - lower_m - allowed), sink)
    return _spread(sink, float(clip.fps)) if sink.any() else sink


def _ankle_to_hip_m(
    clip: MotionClip, legs: JointTransforms, targets: FloatArray, foot: int
) -> tuple[FloatArray, float]:
    """Vector (F, 3) in metres from a foot's ankle, with the foot's tip at its target, to the hip joint; and the length
    of the leg.
    """
    limb = leg(clip.shape.skeleton, SIDES[foot])
    end = clip.shape.ends_m[ENDS.index(FEET[foot])]
    ankle = targets[:, foot] - quaternion.rotate(legs.of(limb.end)[1], end)
    return legs.of(limb.upper)[0] - ankle, limb.length_m


def _spread(values: FloatArray, fps: float) -> FloatArray:
    """Smooth upper envelope (F,) of values (F,): it rises and falls slowly and is never below them."""
    wide = 2 * round(2.5 * SINK_S * fps) + 1
    return np.asarray(gaussian_filter1d(maximum_filter1d(values, wide, mode="nearest"), SINK_S * fps, mode="nearest"))
