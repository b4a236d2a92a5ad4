"""Motion of a project's dancers, generated from their choreographies to its music, on their characters.

A dance is generated for the whole performance at once, since a dancer's path depends on everything before. It is cached
for each frame rate while its inputs are unchanged.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from threading import Lock
from typing import Final, NamedTuple

import msgspec
import numpy as np

from app.arrays import BoolArray, FloatArray
from app.chance import chance, performed_seed
from app.choreography.accent_grid import AccentGrid, grid_of
from app.choreography.dance import Dance, Manner, SegmentStep
from app.choreography.dance_flaws import jerking_seams, jolts, sliding_stands
from app.choreography.derived_rhythm import audible_rhythm
from app.choreography.generate import Choreographer
from app.choreography.performed.choreographers import choreographer_of, too_long_to_dance
from app.choreography.retarget import retarget
from app.choreography.rhythm import Rhythm, are_alike, delayed
from app.choreography.sequence import Constraints
from app.errors import AppError, Message
from app.identity_cache import IdentityCache, LargeResults
from app.motion.curves.curve import Envelopes
from app.motion.model import Motion, frame_count
from app.performance.ensemble import Performance
from app.plan.model import Problem, TimeFrame
from app.project.casting import StagePosition
from app.project.dance_corrections import DanceCorrection, ForbidState, PinState, UseSegment
from app.project.performers import Dancer
from app.project.storage import choreography_missing
from app.rig.characters.character_library import character_library, character_named
from app.rig.model import Character
from app.score.model import Score
from app.score.tempo import TempoMap

BLINK_S: Final = (0.08, 0.05, 0.16)
"""Durations in seconds of a blink: closing, shut, opening."""
BLINKS_EVERY_S: Final = (1.8, 6.0)

_DANCING: IdentityCache[GeneratedDance] = IdentityCache(64)
_REMEMBERED: Final = LargeResults(2**30)
"""Cache of generated dances, limited in memory: two hundred dances of a minute take as much as a dozen of a quarter of
an hour.
"""
_RHYTHMS: IdentityCache[Rhythm] = IdentityCache(8)
_recent_rhythms: deque[Rhythm] = deque(maxlen=4)
_recent_rhythms_lock = Lock()


class GeneratedDance:
    """The dance of a dancer to a piece, shared by dancers with equal dances; names and places are those in the project.

    Parameters
    ----------
    dancer : Dancer
        The dancer, with a seed combined of the dancer's and the project's.
    rhythm : Rhythm
        Rhythm for the dancer.
    tempo_map : TempoMap
        Tempo map of the piece, which gives the times of the corrections.
    """

    def __init__(
        self,
        dancer: Dancer,
        choreographer: Choreographer,
        rhythm: Rhythm,
        corrections: Sequence[DanceCorrection],
        tempo_map: TempoMap,
        character: Character,
        time_frame: TimeFrame,
    ) -> None:
        self.dancer, self.choreographer, self.character = dancer, choreographer, character
        self.rhythm = choreographer.felt(rhythm)
        self.time_frame = time_frame
        self._corrections, self._tempo_map = corrections, tempo_map
        self._problems: tuple[Problem, ...] = ()
        self._made: _Made | None = None
        self._steps: tuple[SegmentStep, ...] | None = None
        self._lock = Lock()

    def steps(self) -> tuple[SegmentStep, ...]:
        """Return the danced segments with their times, independent of the frame rate."""
        with self._lock:
            if self._steps is None:
                made = self._made
                self._steps = made.dance.steps if made is not None else self._chosen()
            return self._steps

    def _chosen(self) -> tuple[SegmentStep, ...]:
        constraints = self._constraints(grid_of(self.rhythm))
        return self.choreographer.steps(self.rhythm, self._manner, constraints=constraints)

    def _constraints(self, grid: AccentGrid) -> Constraints:
        return assignments_of(self._corrections, grid, self._tempo_map, self.choreographer.model.states)

    @property
    def _manner(self) -> Manner:
        return manner_of(self.dancer, len(self.choreographer.model.sources))

    def dance(self, fps: Fraction) -> Dance:
        """Return the dance for the whole performance at a frame rate, generated on first use."""
        return self._whole(fps).dance

    def motion(self, fps: Fraction, first: int, count: int) -> Motion:
        """Return the motion of some frames of the performance; a frame is bitwise the same whatever span is
        requested.
        """
        whole = self._whole(fps).motion
        here = slice(first, first + count)
        return replace(
            whole,
            first_frame_s=whole.first_frame_s + first * fps.denominator / fps.numerator,
            rotations=whole.rotations[here],
            hips_m=whole.hips_m[here],
            morphs={name: weights[here] for name, weights in whole.morphs.items()},
            instrument_position_m=whole.instrument_position_m[here],
            instrument_rotation=whole.instrument_rotation[here],
        )

    def changed_s(self, before: object) -> FloatArray:
        """Return the spans (1, 2) in seconds in which the motion differs from another dance's: everything, since one
        change may alter all that follows; none for the same object."""
        frame = self.time_frame
        return np.zeros((0, 2)) if self is before else np.array([[frame.first_frame_s, frame.end_s]])

    @property
    def choreography_name(self) -> str:
        """Name of the choreography, as stored in it."""
        return self.choreographer.model.name

    def standing(self, fps: Fraction, first: int, count: int) -> BoolArray:
        """Mask (count, 2) of the frames in which the left and the right foot stand."""
        result = np.zeros((first + count, 2), bool)
        for stand in self.dance(fps).standing:
            result[stand.start : stand.stop, stand.foot] = True
        return result[first:]

    def starts_s(self, fps: Fraction) -> tuple[float, ...]:
        """Return the seconds at which each basic motion of the dance begins."""
        return tuple(step.start_s for step in self.dance(fps).steps)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Return the problems of the dance: corrections that could not be met, visible joins and sliding feet; empty
        before it is generated.
        """
        return self._problems

    def forget(self) -> None:
        """Free the memory of the generated dance, which is generated again when needed."""
        self._made = None

    def _whole(self, fps: Fraction) -> _Made:
        with self._lock:
            made = self._made
            if made is None or made.fps != fps:
                made = self._made = self._generated(fps)
        _REMEMBERED.use(self.forget, made.size_bytes)
        return made

    def _generated(self, fps: Fraction) -> _Made:
        frame = self.time_frame
        count = frame_count(frame, fps)
        grid = grid_of(self.rhythm)
        dance = self.choreographer.dance(
            self.rhythm,
            self._manner,
            fps,
            constraints=self._constraints(grid),
            first_s=frame.first_frame_s,
            # Half a frame less, so that rounding does not add a frame.
            end_s=frame.first_frame_s + (count - 0.5) * fps.denominator / fps.numerator,
        )
        held = not_held(self._corrections, dance.steps, grid, self._tempo_map)
        seen = visible_faults(dance, self.choreographer.usual_change_rad_s(fps))
        self._problems = tuple(sorted(held + seen, key=lambda problem: problem.start_s))
        motion = retarget(dance.clip, self.character, frame.first_frame_s)
        times_s = frame.first_frame_s + np.arange(count) * fps.denominator / fps.numerator
        shut = _blinks(self.dancer, frame).sample(times_s).astype(np.float32)
        return _Made(fps, dance, replace(motion, morphs={"eyeBlinkLeft": shut, "eyeBlinkRight": shut}))


class _Made(NamedTuple):
    """A dance generated at one frame rate, with the resulting motion of the dancer's character."""

    fps: Fraction
    dance: Dance
    motion: Motion

    @property
    def size_bytes(self) -> int:
        """Memory of the motion in bytes."""
        clip, motion = self.dance.clip, self.motion
        held = (clip.rotations, clip.hips_m, motion.rotations, motion.hips_m)
        instrument = (motion.instrument_position_m, motion.instrument_rotation)
        morphs = sum(one.nbytes for one in motion.morphs.values())
        return sum(one.nbytes for one in held) + sum(one.nbytes for one in instrument) + morphs


def manner_of(dancer: Dancer, sources: int) -> Manner:
    """Return the style of a dancer for generating; a preferred source that the choreography lacks is ignored."""
    source = dancer.source if 0 <= dancer.source < sources else None
    return Manner(dancer.seed, source, dancer.size, dancer.weight, dancer.mirrored, dancer.melody)


def dancing_of(performance: Performance, dancer: Dancer) -> GeneratedDance:
    """Prepare the dance of a dancer, without generating it yet.

    Raises
    ------
    AppError
        The choreography or the character is missing or damaged, or the performance is too long for a dance.
    """
    if dancer.character_id not in character_library().sources:
        raise AppError("project.character_missing", player=dancer.name, id=dancer.character_id)
    for message in choreography_missing(dancer.name, dancer.choreography):
        raise AppError(message.id, **message.arguments)
    choreographer, character = choreographer_of(dancer.choreography), character_named(dancer.character_id)
    project = performance.project
    # Another seed of the piece changes the performance of every player and dancer.
    dancer = msgspec.structs.replace(dancer, seed=performed_seed(dancer.seed, project.seed))
    rhythm = delayed(rhythm_of(performance), dancer.delay_beats) if dancer.delay_beats else rhythm_of(performance)
    # The dance of a dancer that ignores the melody does not change when the melody is edited.
    rhythm = _same_rhythm(rhythm if dancer.melody else replace(rhythm, melody=None))
    corrections = project.dance_corrections.get(dancer.id, ())
    tempo_map, frame = project.score.tempo_map, dance_frame(performance)
    return _DANCING.step(
        GeneratedDance, _same_dancer(dancer), choreographer, rhythm, corrections, tempo_map, character, frame
    )


def rhythm_of(performance: Performance) -> Rhythm:
    """Return the rhythm of the piece for all dancers."""
    return _RHYTHMS.step(_audible_rhythm, performance.project.score)


def _audible_rhythm(score: Score) -> Rhythm:
    return _same_rhythm(audible_rhythm(score))


def dance_frame(performance: Performance) -> TimeFrame:
    """Return the time span of all dances; equal spans are the same object. Raises AppError if it is too long for
    dances.
    """
    long = too_long_to_dance(performance.time_frame)
    if long is not None:
        raise AppError(long.id, **long.arguments)
    return _same_frame(performance.time_frame.first_frame_s, performance.time_frame.end_s)


def assignments_of(
    corrections: Sequence[DanceCorrection], grid: AccentGrid, tempo_map: TempoMap, states: int | None = None
) -> Constraints:
    """Return corrections as constraints at the nearest places of a grid; of several for a place the last applies.

    ``states`` is the number of basic motions, if known: bans of any other motion are ignored.
    """
    if not len(grid.times_s):
        return Constraints()
    pinned, segments, forbidden = dict[int, int](), dict[int, int](), dict[int, set[int]]()
    for item in corrections:
        match item:
            case PinState():
                pinned[place_of(item.tick, grid, tempo_map)] = item.state
            case UseSegment():
                segments[place_of(item.tick, grid, tempo_map)] = item.segment
            case ForbidState() if states is None or item.state < states:
                forbidden.setdefault(item.state, set()).update(_places(item, grid, tempo_map))
    return Constraints(pinned, segments, frozenset((at, state) for state, places in forbidden.items() for at in places))


def not_held(
    corrections: Sequence[DanceCorrection], steps: Sequence[SegmentStep], grid: AccentGrid, tempo_map: TempoMap
) -> tuple[Problem, ...]:
    """Return a problem for every correction by the user that the planned steps do not follow, because it refers to a
    missing motion or segment, or contradicts another correction. The corrections are kept.
    """
    there = {step.place: step for step in steps}
    pins = [item for item in corrections if not isinstance(item, ForbidState)]
    pinned = {place_of(item.tick, grid, tempo_map) for item in pins} if len(grid.times_s) else set[int]()
    found = []
    for item in corrections:
        if isinstance(item, ForbidState):
            places = _places(item, grid, tempo_map)
            # Steps with a pinned state are exempt.
            danced = [
                step for step in steps if step.place in places and step.state == item.state and step.place not in pinned
            ]
            if danced:
                message = Message("dance.state_not_avoided", {"number": item.state + 1})
                found.append(Problem(message, None, danced[0].start_s, danced[-1].end_s))
            continue
        step = there.get(place_of(item.tick, grid, tempo_map)) if len(grid.times_s) else None
        if isinstance(item, PinState):
            held = step is not None and step.state == item.state
            message = Message("dance.state_not_held", {"number": item.state + 1})
        else:
            held = step is not None and step.segment == item.segment
            message = Message("dance.segment_not_held", {"number": item.segment + 1})
        if not held:
            time_s = tempo_map.seconds(float(item.tick))
            found.append(Problem(message, None, time_s, time_s))
    return tuple(found)


def visible_faults(dance: Dance, usual_rad_s: float) -> tuple[Problem, ...]:
    """Return the visible problems of a dance (`app.choreography.dance_flaws`): joins, jolts, and sliding feet."""
    fps = float(dance.clip.fps)
    found = []
    for seam in jerking_seams(dance.clip, dance.seams, usual_rad_s):
        time_s = dance.first_s + seam / fps
        before, after = (
            next((step.state + 1 for step in dance.steps if step.end_s > at_s), dance.steps[-1].state + 1)
            for at_s in (time_s - 1.5 / fps, time_s + 0.5 / fps)
        )
        message = Message("dance.seam_shows", {"before": before, "after": after})
        found.append(Problem(message, None, time_s, time_s))
    for jolt in jolts(dance.clip, dance.seams):
        start_s, end_s = (dance.first_s + frame / fps for frame in (jolt.start, jolt.stop))
        state = next((step.state for step in dance.steps if step.end_s > start_s), dance.steps[-1].state)
        found.append(Problem(Message("dance.jolts", {"number": state + 1}), None, start_s, end_s))
    for stand in sliding_stands(dance.clip, dance.standing):
        side = ("left", "right")[stand.foot]
        start_s, end_s = (dance.first_s + frame / fps for frame in (stand.start, stand.stop))
        found.append(Problem(Message("dance.foot_slides", {"side": side}), None, start_s, end_s))
    return tuple(found)


def place_of(tick: int, grid: AccentGrid, tempo_map: TempoMap) -> int:
    """Index of the grid time that is nearest to a tick."""
    return int(np.abs(grid.times_s - tempo_map.seconds(float(tick))).argmin())


def _places(item: ForbidState, grid: AccentGrid, tempo_map: TempoMap) -> range:
    """Indices of the places of a grid within the span of ticks of a correction."""
    start_s, end_s = (tempo_map.seconds(float(tick)) for tick in (item.start_tick, item.end_tick))
    first, stop = np.searchsorted(grid.times_s, (start_s - 1e-6, end_s - 1e-6))
    return range(int(first), int(stop))


def _blinks(dancer: Dancer, frame: TimeFrame) -> Envelopes:
    rows, number = list[tuple[float, float, float, float, float]](), 0
    least_s, most_s = BLINKS_EVERY_S
    time_s = frame.first_frame_s
    while True:
        time_s += least_s + (most_s - least_s) * chance("blink", dancer.seed, dancer.id, number) ** 1.5
        number += 1
        if time_s >= frame.end_s:
            return Envelopes.of(rows)
        shut_s = time_s + BLINK_S[0]
        rows.append((time_s, shut_s, shut_s + BLINK_S[1], shut_s + BLINK_S[1] + BLINK_S[2], 1.0))


@lru_cache(maxsize=64)
def _same_frame(first_frame_s: float, end_s: float) -> TimeFrame:
    return TimeFrame(first_frame_s, end_s)


def _same_dancer(dancer: Dancer) -> Dancer:
    """Return one shared object for dancers whose dances are equal, regardless of stage position and name."""
    return _interned(msgspec.structs.replace(dancer, name="", colour="", stage=StagePosition(0.0, 0.0, 0.0)))


@lru_cache(maxsize=256)
def _interned(dancer: Dancer) -> Dancer:
    return dancer


def _same_rhythm(rhythm: Rhythm) -> Rhythm:
    """Return one shared object for equal rhythms, so that caches hit; edits of notes seldom change the rhythm."""
    with _recent_rhythms_lock:
        for known in _recent_rhythms:
            if are_alike(known, rhythm):
                return known
        _recent_rhythms.append(rhythm)
        return rhythm
