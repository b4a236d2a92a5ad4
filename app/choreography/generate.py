"""A dance to a piece: segments of a model in the order that suits the music, on its beats, joined without a seam."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import foot_contacts
from app.choreography.features import facing, height_m
from app.choreography.feet import Stand, planted, stands
from app.choreography.hands import out_of_body
from app.choreography.joins import FADE_S, STATURE_M, Clouds, best_turn_rad, distances_m, faded
from app.choreography.model import ChoreographyModel
from app.choreography.music_offset import speed_minima, summed_speed_m_s
from app.choreography.rhythm import Rhythm
from app.choreography.sequence import Candidates, Grid, Weights, Wishes, choose, grid_of, symbol_scores
from app.choreography.warp import REST_S, TimeMap, arriving
from app.rig import quaternion

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

ARRIVAL_SMOOTHING_S: Final = 5.0 / 60.0
"""Standard deviation of the Gaussian over which speed is averaged to find where the body arrives (Li et al., "AI
Choreographer: Music Conditioned 3D Dance Generation with AIST++", ICCV 2021)."""
_ARRIVALS_FPS: Final = 60.0
_LEAST_S: Final = 0.01
"""Beyond the first start and the last end; a segment may meet its beat at either."""
STANDING: Final = 4.0
"""Log odds of a first and a last segment between feet that both stand, against one that hangs in the air."""
PREFERRED: Final = 2.0
"""Log odds of a segment of the source that is preferred."""
STAGE_M: Final = 1.5
"""A dancer keeps about this near to the place: ways that lead farther are made shorter."""
WANDERS_S: Final = 1.2
"""Standard deviation in time of what of a path is a way, and not sway and steps."""
FACES_RAD: Final = math.radians(25.0)
"""And turned no farther from the audience, in the mean; spins and turns of the capture stay whole."""
TURN_BACK: Final = 0.3
MOST_TURN_RAD: Final = math.radians(12.0)
STEP_BACK: Final = 0.2
MOST_STEP_M: Final = 0.08
"""Part of an excess over these that each join takes back, and how much at most."""
ARM: Final = ("UpperArm", "LowerArm", "Hand")
UPPER_BODY: Final = ("spine", "chest", "head", *(f"left{part}" for part in ARM), *(f"right{part}" for part in ARM))
"""What `Manner.size` makes larger or smaller: steps stay steps."""


@dataclass(frozen=True)
class Manner:
    """How one dancer dances.

    Attributes
    ----------
    seed : int
        Another seed is another dance to the same music.
    source : int or None
        Number of the model's source whose motion is preferred.
    size : float
        Of trunk and arms about their usual pose, 1 as captured.
    mirrored : bool
    """

    seed: int = 0
    source: int | None = None
    size: float = 1.0
    mirrored: bool = False


@dataclass(frozen=True)
class Step:
    """A segment that is danced.

    Attributes
    ----------
    segment : int
        In the model.
    state : int
    place : int
        Of its accent in the grid of beats and half beats.
    start_s, accent_s, end_s : float
        In the piece.
    """

    segment: int
    state: int
    place: int
    start_s: float
    accent_s: float
    end_s: float


@dataclass(frozen=True, eq=False)
class Dance:
    """What was generated.

    Attributes
    ----------
    clip : MotionClip
        Its frame 0 is at ``first_s``.
    first_s : float
    steps : tuple of Step
    speeds : (T,) float64
        Of the source's time, by frame: 1 as captured, 0 at rest.
    seams : tuple of int
        Frames at which motion begins that does not follow in the capture on what was before.
    standing : tuple of Stand
        Where feet stand.
    """

    clip: MotionClip
    first_s: float
    steps: tuple[Step, ...]
    speeds: FloatArray
    seams: tuple[int, ...]
    standing: tuple[Stand, ...]


@dataclass(frozen=True, eq=False)
class _Plan:
    """What is danced when.

    Attributes
    ----------
    steps : tuple of Step
    times : TimeMap or None
        None without steps.
    hits_s : (N,) float64
        Of each step, how far along all motions it meets its place.
    """

    steps: tuple[Step, ...]
    times: TimeMap | None
    hits_s: FloatArray


class Choreographer:
    """A model prepared for generating: what depends on no piece is worked out once.

    Parameters
    ----------
    model : ChoreographyModel
        With at least one segment.
    """

    def __init__(self, model: ChoreographyModel) -> None:
        self.model = model
        self._contacts = [foot_contacts(clip) for clip in model.clips]
        self._starts = Clouds(model.clips, [(one.clip, one.start) for one in model.segments])
        self._ends = Clouds(model.clips, [(one.clip, one.end) for one in model.segments])
        self._clips = [_Source(clip) for clip in model.clips]
        self._speeds = [summed_speed_m_s(clip) for clip in model.clips]
        self._hits_s = self._slowest_s()

    @cached_property
    def candidates(self) -> Candidates:
        """The model's segments, compared with one another."""
        model, segments = self.model, self.model.segments
        fps = [float(clip.fps) for clip in model.clips]
        states = np.array([one.state for one in segments], np.int64)
        joins = distances_m(self._ends, self._starts)
        for at, (one, following) in enumerate(pairwise(segments)):
            if one.clip == following.clip and one.end == following.start:
                joins[at, at + 1] = 0.0
        log_a = np.log(model.transition * model.states)
        # Of a symbol, against how often it is struck at all.
        often = np.array([np.mean(states == state) for state in range(model.states)])
        usual = often @ model.emission
        return Candidates(
            states=states,
            before_s=self._hits_s - np.array([one.start / fps[one.clip] for one in segments]),
            after_s=np.array([one.end / fps[one.clip] for one in segments]) - self._hits_s,
            joins_m=joins,
            log_transition=log_a[states[:, None], states[None, :]],
            log_emission=np.log(model.emission / usual)[states],
        )

    def dance(
        self,
        rhythm: Rhythm,
        manner: Manner,
        fps: Fraction,
        *,
        wishes: Wishes | None = None,
        weights: Weights | None = None,
        first_s: float = 0.0,
        end_s: float | None = None,
    ) -> Dance:
        """Dance to a piece. The same arguments give the same motion to the bit.

        Parameters
        ----------
        rhythm : Rhythm
        manner : Manner
        fps : Fraction
        wishes : Wishes, optional
        weights : Weights, optional
        first_s, end_s : float
            The motion's first frame and its end; by default from the first tick to `REST_S` after the last step.
        """
        plan = self._planned(rhythm, manner, wishes, weights)
        if end_s is None:
            end_s = max(first_s, (plan.steps[-1].end_s if plan.steps else 0.0) + 2.0 * REST_S)
        count = max(1, math.ceil((end_s - first_s) * float(fps)))
        return self._motion(plan, manner, fps, first_s + np.arange(count) / float(fps))

    def steps(
        self, rhythm: Rhythm, manner: Manner, *, wishes: Wishes | None = None, weights: Weights | None = None
    ) -> tuple[Step, ...]:
        """Which segments are danced when."""
        return self._planned(rhythm, manner, wishes, weights).steps

    def _planned(self, rhythm: Rhythm, manner: Manner, wishes: Wishes | None, weights: Weights | None) -> _Plan:
        """Which segments are danced when, and how time goes meanwhile."""
        candidates, grid, segments = self.candidates, grid_of(rhythm), self.model.segments
        initial = np.log(self.model.initial * self.model.states)[candidates.states]
        preferred = np.zeros(len(segments))
        if manner.source is not None:
            preferred = PREFERRED * np.array([one.clip == manner.source for one in segments], np.float64)
        scores = symbol_scores(grid, rhythm, candidates) + preferred
        chosen = choose(
            grid,
            scores,
            candidates,
            seed=manner.seed,
            weights=weights,
            wishes=wishes,
            initial=initial + self._standing([one.start for one in segments]),
            final=self._standing([one.end for one in segments]),
        )
        return self._timed(chosen, grid)

    def _standing(self, frames: Sequence[int]) -> FloatArray:
        """Log odds of beginning or ending at frames of the segments' clips: both feet stand, one does, none does."""
        feet = [
            self._contacts[one.clip][min(frame, len(self._contacts[one.clip]) - 1)].sum()
            for one, frame in zip(self.model.segments, frames, strict=True)
        ]
        return 0.5 * STANDING * (np.array(feet, np.float64) - 2.0)

    def _timed(self, chosen: Sequence[tuple[int, int]], grid: Grid) -> _Plan:
        """Segments, each first put at its place, then all arrivals of the body on beats."""
        if not chosen:
            return _Plan((), None, np.zeros(0))
        candidates, segments = self.candidates, np.array([segment for _, segment in chosen])
        before, after = candidates.before_s[segments], candidates.after_s[segments]
        hits = np.concatenate([[0.0], np.cumsum(after[:-1] + before[1:])])
        places_s = grid.times_s[[place for place, _ in chosen]]
        plain = TimeMap(
            np.array([places_s[0] - before[0] - _LEAST_S, *places_s, places_s[-1] + after[-1] + _LEAST_S]),
            np.array([-before[0] - _LEAST_S, *hits, hits[-1] + after[-1] + _LEAST_S]),
        )
        times = arriving(plain, self._arrivals_s(segments, hits), grid)
        starts_s, hits_s, ends_s = (times.when(along).tolist() for along in (hits - before, hits, hits + after))
        steps = (
            Step(int(segment), int(candidates.states[segment]), place, *at)
            for (place, segment), *at in zip(chosen, starts_s, hits_s, ends_s, strict=True)
        )
        return _Plan(tuple(steps), times, hits)

    def _slowest_s(self) -> FloatArray:
        """(S,) time in its clip at which each segment arrives: where the body is slowest from the accent to the end."""
        found = []
        for one in self.model.segments:
            fps = float(self.model.clips[one.clip].fps)
            smooth = gaussian_filter1d(self._speeds[one.clip], ARRIVAL_SMOOTHING_S * fps, mode="nearest")
            found.append((one.accent + int(smooth[one.accent : one.end + 1].argmin())) / fps)
        return np.array(found)

    def _arrivals_s(self, segments: IntArray, hits: FloatArray) -> FloatArray:
        """How far along all motions the body arrives: minima of the speed of segments laid end to end."""
        ends = hits + self.candidates.after_s[segments]
        first = hits[0] - float(self.candidates.before_s[segments[0]])
        along = np.arange(first, ends[-1], 1.0 / _ARRIVALS_FPS)
        which = np.minimum(np.searchsorted(ends, along, side="right"), len(segments) - 1)
        speed = np.zeros(len(along))
        for number, clip in enumerate(self.model.clips):
            here = np.array([self.model.segments[segment].clip for segment in segments])[which] == number
            at_s = (self._hits_s[segments] - hits)[which[here]] + along[here]
            speed[here] = np.interp(at_s * float(clip.fps), np.arange(len(clip)), self._speeds[number])
        frames, _ = speed_minima(speed, _ARRIVALS_FPS, ARRIVAL_SMOOTHING_S)
        return np.asarray(along[frames])

    def _motion(self, plan: _Plan, manner: Manner, fps: Fraction, times_s: FloatArray) -> Dance:
        """The frames of a plan."""
        steps = plan.steps
        shape = self.model.clips[manner.source or 0].shape
        height = height_m(self.model.clips[manner.source or 0])
        if not steps:
            first = self.model.segments[0]
            still = np.full(len(times_s), first.start)
            hips, rotations = self._clips[first.clip].at(still.astype(np.float64))
            hips = hips * (0.0, 1.0, 0.0) * height / height_m(self.model.clips[first.clip])
            clip = MotionClip(shape, fps, hips, rotations)
            return Dance(clip, float(times_s[0]), (), np.zeros(len(times_s)), (), ())
        which, source_s, speeds = self._source_times(plan, times_s)
        out = _Output(fps, len(times_s))
        contacts = np.zeros((len(times_s), 2), bool)
        seams: list[int] = []
        turn, moved = 0.0, 0.0 + 0.0j
        bounds = np.flatnonzero(np.diff(which, prepend=-1, append=len(steps)))
        before: int | None = None
        for start, stop in zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True):
            step = int(which[start])
            segment = self.model.segments[steps[step].segment]
            source, scale = self._clips[segment.clip], height / height_m(self.model.clips[segment.clip])
            rate = float(source.clip.fps)
            follows = False
            if before is not None:
                earlier = steps[before].segment
                follows = steps[step].segment == earlier + 1 and self._follow(earlier)
                turn, moved = self._aligned(
                    earlier, steps[step].segment, turn, moved, height, follows, before + 1 != step
                )
                turn, moved = self._steered(turn, moved, out, start)
            else:
                turn, moved = self._home(segment.clip, segment.start, scale)
            # One frame more: by the first two it is known how fast the old and the new motion go apart.
            frames = np.append(source_s[start:stop], source_s[stop - 1] + speeds[stop - 1] / float(fps))
            hips, rotations = source.at(frames * rate)
            hips, rotations = _placed(hips * scale, rotations, turn, moved)
            out.append(start, hips, rotations, joined=before is not None)
            nearest = np.clip(np.rint(source_s[start:stop] * rate).astype(int), 0, len(source.clip) - 1)
            contacts[start:stop] = self._contacts[segment.clip][nearest]
            if before is not None and not follows:
                seams.append(start)
            before = step
        clip = MotionClip(shape, fps, out.hips, _local_continuous(out.rotations))
        clip = _sized(clip, manner.size)
        if manner.mirrored:
            clip, contacts = mirrored(clip), contacts[:, ::-1]
        clip = out_of_body(replace(clip, hips_m=_on_stage(clip.hips_m, float(fps))))
        standing = stands(clip, contacts)
        return Dance(planted(clip, standing), float(times_s[0]), plan.steps, speeds, tuple(seams), standing)

    def _source_times(self, plan: _Plan, times_s: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """Of each frame the step, the time in its clip, and how fast that goes."""
        assert plan.times is not None
        along, speeds = plan.times.at(times_s)
        segments = np.array([step.segment for step in plan.steps])
        which = np.searchsorted((plan.hits_s + self.candidates.after_s[segments])[:-1], along, side="right")
        return which, self._hits_s[segments[which]] + along - plan.hits_s[which], speeds

    def _follow(self, segment: int) -> bool:
        """Whether the next segment of the model begins where this one ends."""
        one, following = self.model.segments[segment], self.model.segments[segment + 1]
        return one.clip == following.clip and one.end == following.start

    def _home(self, clip: int, frame: int, scale: float) -> tuple[float, complex]:
        """Turn and move that put a frame at the dancer's place, facing the audience."""
        source = self.model.clips[clip]
        turn = -_yaw(facing(source.span(frame, frame + 1)))
        hips = source.hips_m[frame] * scale
        return turn, -complex(np.exp(1j * turn)) * complex(hips[2], hips[0])

    def _aligned(
        self, before: int, after: int, turn: float, moved: complex, height: float, follows: bool, apart: bool
    ) -> tuple[float, complex]:
        """Turn and move of a segment that lay it over the end of the one before."""
        if follows and not apart:
            return turn, moved
        own = float(best_turn_rad(_one(self._ends, before), _one(self._starts, after))[0])
        scale = height / STATURE_M
        reached = complex(np.exp(1j * turn)) * self._ends.middle[before] * scale + moved
        turn += own
        return turn, reached - complex(np.exp(1j * turn)) * self._starts.middle[after] * scale

    def _steered(self, turn: float, moved: complex, out: _Output, frame: int) -> tuple[float, complex]:
        """A little back towards the place and the audience."""
        lately = out.lately(frame)
        if lately is None:
            return turn, moved
        hips, faces = lately
        off = _wrapped(faces)
        nudge = -np.sign(off) * min(TURN_BACK * max(0.0, abs(off) - FACES_RAD), MOST_TURN_RAD)
        # About where the body is, so that it does not swing round the middle of the stage.
        here = out.place(frame)
        moved = here + complex(np.exp(1j * nudge)) * (moved - here)
        away = abs(hips)
        if away > 0.0:
            moved -= hips / away * min(STEP_BACK * max(0.0, away - 0.5 * STAGE_M), MOST_STEP_M)
        return turn + nudge, moved


class _Source:
    """A clip as smooth functions of the frame."""

    def __init__(self, clip: MotionClip) -> None:
        self.clip = clip
        frames = np.arange(len(clip))
        self._hips = CubicSpline(frames, clip.hips_m)
        self._rotations = CubicSpline(frames, clip.rotations.reshape(len(clip), -1))

    def at(self, frames: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Hips (N, 3) and local rotations (N, 16, 4) at frames, which need not be whole; within the clip."""
        frames = np.clip(frames, 0.0, len(self.clip) - 1.0)
        turns = self._rotations(frames).reshape(len(frames), len(SEGMENTS), 4)
        return self._hips(frames), quaternion.normalize(turns)


class _Output:
    """Frames as they are made; each new motion is carried over from the one before."""

    def __init__(self, fps: Fraction, count: int) -> None:
        self._rate = float(fps)
        self.hips = np.zeros((count, 3))
        self.rotations = np.tile(quaternion.IDENTITY, (count, len(SEGMENTS), 1))
        self._faces = np.zeros(count)

    def append(self, start: int, hips: FloatArray, rotations: FloatArray, *, joined: bool) -> None:
        """Add frames; the last of what is given is what would come next, and is not added."""
        count = len(hips) - 1
        if joined and start >= 2:
            (hips_before, hips_last), (turns_before, turns_last) = (
                each[start - 2 : start] for each in (self.hips, self.rotations)
            )
            # Where the old motion would go on to: this frame and the next.
            step, turn = hips_last - hips_before, quaternion.multiply(turns_last, quaternion.conjugate(turns_before))
            off = hips_last + step * np.array([[1.0], [2.0]]) - hips[:2]
            goes_on = np.stack([once := quaternion.multiply(turn, turns_last), quaternion.multiply(turn, once)])
            turned = quaternion.to_rotation_vector(quaternion.multiply(goes_on, quaternion.conjugate(rotations[:2])))
            spin = turned[1] - turned[0]
            # A difference about half a turn has two ways round; no join as bad as that is chosen.
            spin = np.where(np.linalg.norm(spin, axis=-1, keepdims=True) > 1.0, 0.0, spin)
            fading = slice(0, min(count, math.ceil(FADE_S * self._rate)))
            times_s = np.arange(fading.stop) / self._rate
            hips[fading] += faded(off[0], (off[1] - off[0]) * self._rate, times_s)
            carried = quaternion.from_rotation_vector(faded(turned[0], spin * self._rate, times_s))
            rotations[fading] = quaternion.multiply(carried, rotations[fading])
        here = slice(start, start + count)
        self.hips[here], self.rotations[here] = hips[:-1], rotations[:-1]
        self._faces[here] = np.unwrap(_yaws(rotations[:-1, 0]))

    def place(self, frame: int) -> complex:
        """Where the hips are just before a frame."""
        return complex(self.hips[frame - 1, 2], self.hips[frame - 1, 0])

    def lately(self, frame: int) -> tuple[complex, float] | None:
        """Where the hips were and where they faced, in the mean of the last two seconds."""
        first = max(0, frame - round(2.0 * self._rate))
        if frame - first < 2:
            return None
        middle = self.hips[first:frame].mean(axis=0)
        ways = np.exp(1j * self._faces[first:frame]).mean()
        return complex(middle[2], middle[0]), float(np.angle(ways))


def mirrored(clip: MotionClip) -> MotionClip:
    """The motion as a mirror shows it."""
    swapped = [
        SEGMENTS.index(name.replace("left", "right") if name.startswith("left") else name.replace("right", "left"))
        for name in SEGMENTS
    ]
    rotations = clip.rotations[:, swapped] * (1.0, -1.0, -1.0, 1.0)
    return replace(clip, hips_m=clip.hips_m * (-1.0, 1.0, 1.0), rotations=rotations)


def _placed(hips: FloatArray, rotations: FloatArray, turn: float, moved: complex) -> tuple[FloatArray, FloatArray]:
    """Turned about +Y and moved over the floor."""
    flat = np.exp(1j * turn) * (hips[:, 2] + 1j * hips[:, 0]) + moved
    rotations = rotations.copy()
    rotations[:, 0] = quaternion.multiply(quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), turn), rotations[:, 0])
    return np.stack([flat.imag, hips[:, 1], flat.real], axis=1), rotations


def _on_stage(hips_m: FloatArray, fps: float) -> FloatArray:
    """The path with its ways within `STAGE_M` of the place; sway, steps and heights as they were."""
    way = gaussian_filter1d(hips_m, WANDERS_S * fps, axis=0, mode="nearest") * (1.0, 0.0, 1.0)
    far = np.linalg.norm(way, axis=1, keepdims=True)
    return np.asarray(hips_m - way * (1.0 - np.tanh(far / STAGE_M) * STAGE_M / np.maximum(far, 1e-9)))


def _one(clouds: Clouds, at: int) -> Clouds:
    one = object.__new__(Clouds)
    one.flat, one.middle, one.height = clouds.flat[at : at + 1], clouds.middle[at : at + 1], clouds.height[at : at + 1]
    return one


def _yaws(turns: FloatArray) -> FloatArray:
    """(F,) turn about +Y of rotations (F, 4)."""
    _, twist = quaternion.swing_twist(turns, np.array([0.0, 1.0, 0.0]))
    return np.asarray(2.0 * np.arctan2(twist[..., 1], twist[..., 3]))


def _yaw(turns: FloatArray) -> float:
    return float(2.0 * np.arctan2(turns[0, 1], turns[0, 3]))


def _wrapped(angle_rad: float) -> float:
    return (angle_rad + math.pi) % (2.0 * math.pi) - math.pi


def _sized(clip: MotionClip, size: float) -> MotionClip:
    """Trunk and arms turned more or less far from their mean pose."""
    if size == 1.0:
        return clip
    rotations = clip.rotations.copy()
    for name in UPPER_BODY:
        at = SEGMENTS.index(name)
        middle = quaternion.normalize(rotations[:, at].mean(axis=0))
        rotations[:, at] = quaternion.slerp(
            np.broadcast_to(middle, rotations[:, at].shape), rotations[:, at], np.full(len(rotations), size)
        )
    return replace(clip, rotations=_local_continuous(rotations))


def _local_continuous(rotations: FloatArray) -> FloatArray:
    """Each frame on the side of the one before."""
    turned = np.einsum("fji,fji->fj", rotations[1:], rotations[:-1]) < 0.0
    sides = np.concatenate([np.ones((1, rotations.shape[1])), np.where(turned, -1.0, 1.0)]).cumprod(axis=0)
    continuous: FloatArray = rotations * sides[..., None]
    return continuous
