"""Steps of each dancer, as shown in the timeline: basic motions in order, with the user's corrections.

A correction belongs to the beat place nearest to its tick, as in `assignments_of`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.accent_grid import grid_of
from app.choreography.body import ENDS, PARENT_OF, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.dance import SegmentStep
from app.choreography.features import facing, height_m, points_m
from app.choreography.generate import Choreographer
from app.choreography.model import ChoreographyModel
from app.choreography.performed.dancers import dancing_of, place_of
from app.errors import AppError, Message, Progress, StopRequested, raise_if_stopped
from app.identity_cache import IdentityCache
from app.performance.ensemble import Performance
from app.project.dance_corrections import DanceCorrection, ForbidState, PinState, UseSegment
from app.project.performers import Dancer
from app.rig import quaternion

BONES: Final = tuple(
    [(SEGMENTS.index(parent), SEGMENTS.index(name)) for name, parent in PARENT_OF.items() if parent != "root"]
    + [(SEGMENTS.index(name), len(SEGMENTS) + number) for number, name in enumerate(ENDS) if name != "head"]
)
"""Pairs of points of a figure that are connected by lines; the head is a disc between the two points of `HEAD`."""
HEAD: Final = (SEGMENTS.index("head"), len(SEGMENTS) + ENDS.index("head"))
_FIGURES: IdentityCache[FloatArray] = IdentityCache(8)


@dataclass(frozen=True, eq=False)
class DanceSteps:
    """The dance of one dancer.

    Attributes
    ----------
    steps : tuple of SegmentStep
        Steps in order; empty if the music has no beats or there is an error.
    ticks : tuple of int
        Tick of each step in the music at which its corrections are stored.
    spans : tuple of (int, int)
        Start and end tick of each step; the span contains the step's tick.
    places : tuple of int
        Ticks of all possible places of an accent, ascending.
    pinned : tuple of tuple of DanceCorrection
        Corrections that pin each step.
    choreographer : Choreographer or None
        Choreography; None if there is an error.
    error : Message or None
        Reason why the dancer cannot dance.
    """

    dancer: Dancer
    steps: tuple[SegmentStep, ...] = ()
    ticks: tuple[int, ...] = ()
    spans: tuple[tuple[int, int], ...] = ()
    places: tuple[int, ...] = ()
    pinned: tuple[tuple[DanceCorrection, ...], ...] = ()
    forbidden: tuple[ForbidState, ...] = ()
    choreographer: Choreographer | None = None
    error: Message | None = None

    @cached_property
    def start_s(self) -> FloatArray:
        """Start (N,) in seconds of each of N steps."""
        return np.array([step.start_s for step in self.steps])

    @cached_property
    def end_s(self) -> FloatArray:
        """End time (N,) of each step, which is the start of the next."""
        return np.array([step.end_s for step in self.steps])

    @property
    def model(self) -> ChoreographyModel:
        """The learned choreography of the dance; not available if the dance has an error."""
        assert self.choreographer is not None
        return self.choreographer.model

    def step_at(self, time_s: float) -> int | None:
        """Return the index of the step at a time."""
        number = int(np.searchsorted(self.start_s, time_s, side="right")) - 1
        return number if number >= 0 and time_s < self.end_s[number] else None

    def barred(self, number: int) -> tuple[ForbidState, ...]:
        """Return the user's bans of basic motions that apply to the step with an index."""
        tick = self.ticks[number]
        return tuple(item for item in self.forbidden if item.start_tick <= tick < item.end_tick)


def dances_of(performance: Performance, stop_requested: StopRequested, progress: Progress) -> dict[str, DanceSteps]:
    """Return the dances of all dancers by id. Raises Cancelled."""
    made = {}
    dancers = performance.project.dancers
    for number, dancer in enumerate(dancers):
        raise_if_stopped(stop_requested)
        made[dancer.id] = dance_of(performance, dancer)
        progress((number + 1) / len(dancers))
    return made


def dance_of(performance: Performance, dancer: Dancer) -> DanceSteps:
    """Return the steps of a dancer's dance; an error that the user can correct is stored in the result instead of
    raised.
    """
    try:
        dancing = dancing_of(performance, dancer)
    except AppError as error:
        return DanceSteps(dancer, error=error.message)
    project = performance.project
    clock, steps, grid = project.score.tempo_map, dancing.steps(), grid_of(dancing.rhythm)
    places = [round(clock.ticks(time_s)) for time_s in grid.times_s.tolist()]
    ticks = [places[step.place] for step in steps]
    spans = [
        (min(round(clock.ticks(step.start_s)), tick), max(round(clock.ticks(step.end_s)), tick + 1))
        for step, tick in zip(steps, ticks, strict=True)
    ]
    corrections = project.dance_corrections.get(dancer.id, ())
    pinned: dict[int, list[DanceCorrection]] = {}
    for item in corrections:
        if isinstance(item, PinState | UseSegment) and len(grid.times_s):
            pinned.setdefault(place_of(item.tick, grid, clock), []).append(item)
    return DanceSteps(
        dancer,
        steps,
        tuple(ticks),
        tuple(spans),
        tuple(places),
        tuple(tuple(pinned.get(step.place, ())) for step in steps),
        tuple(item for item in corrections if isinstance(item, ForbidState)),
        dancing.choreographer,
    )


def figures(choreographer: Choreographer) -> FloatArray:
    """Pose (S, 21, 2) of each of S segments at its accent, seen from the front: X to the right and Y up from the floor
    below the hips, relative to the body's height.
    """
    return _FIGURES.step(_figures, choreographer)


def _figures(choreographer: Choreographer) -> FloatArray:
    model = choreographer.model
    made = np.zeros((len(model.segments), len(SEGMENTS) + len(ENDS), 2))
    for number, clip in enumerate(model.clips):
        own = [at for at, one in enumerate(model.segments) if one.clip == number]
        frames = [min(model.segments[at].accent, len(clip) - 1) for at in own]
        poses = MotionClip(clip.shape, clip.fps, clip.hips_m[frames], clip.rotations[frames])
        points = points_m(poses) - (poses.hips_m * (1.0, 0.0, 1.0))[:, None]
        made[own] = quaternion.rotate(quaternion.conjugate(facing(poses))[:, None], points)[..., :2] / height_m(clip)
    return made


def examples(model: ChoreographyModel, drawn: FloatArray) -> tuple[int | None, ...]:
    """Return for each basic motion the index of its most typical segment, whose pose in ``drawn`` is nearest to the
    mean of all its segments; None for a motion without segments.
    """
    found: list[int | None] = []
    for state in range(model.states):
        own = segments_of(model, state)
        if not own:
            found.append(None)
            continue
        poses = drawn[list(own)]
        off = np.linalg.norm(poses - poses.mean(axis=0), axis=-1).sum(axis=-1)
        found.append(own[int(off.argmin())])
    return tuple(found)


def segments_of(model: ChoreographyModel, state: int) -> Sequence[int]:
    """Return the indices of the segments whose basic motion is ``state``."""
    return [at for at, one in enumerate(model.segments) if one.state == state]
