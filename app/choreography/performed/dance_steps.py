"""Steps of each dancer of a project for its lane: basic motions in order, with their corrections.

A correction belongs to the place of the beats that is nearest to its tick, as `assignments_of` of the dances here
has it.
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
"""Pairs of points of a figure that a line joins; the head is a disc between the two points of `HEAD`."""
HEAD: Final = (SEGMENTS.index("head"), len(SEGMENTS) + ENDS.index("head"))
_FIGURES: IdentityCache[FloatArray] = IdentityCache(8)


@dataclass(frozen=True, eq=False)
class DanceSteps:
    """One dancer's dance.

    Attributes
    ----------
    steps : tuple of SegmentStep
        In order; empty where the music has no beats, and with an error.
    ticks : tuple of int
        Of each step, the place in the music at which a correction of it is kept.
    spans : tuple of (int, int)
        Ticks from each step's start to its end, its place included.
    places : tuple of int
        Ticks of all places that an accent can have, ascending.
    pinned : tuple of tuple of DanceCorrection
        Of each step, what is pinned at its place.
    choreographer : Choreographer or None
        None with an error.
    error : Message or None
        Why this dancer cannot dance.
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
        """(N,) starts of the steps."""
        return np.array([step.start_s for step in self.steps])

    @cached_property
    def end_s(self) -> FloatArray:
        """(N,) ends of the steps; a step ends where the next one starts."""
        return np.array([step.end_s for step in self.steps])

    @property
    def model(self) -> ChoreographyModel:
        """The choreography; only without an error."""
        assert self.choreographer is not None
        return self.choreographer.model

    def step_at(self, time_s: float) -> int | None:
        """Number of the step that is danced at a time."""
        number = int(np.searchsorted(self.start_s, time_s, side="right")) - 1
        return number if number >= 0 and time_s < self.end_s[number] else None

    def barred(self, number: int) -> tuple[ForbidState, ...]:
        """States that are forbidden at the place of a step."""
        tick = self.ticks[number]
        return tuple(item for item in self.forbidden if item.start_tick <= tick < item.end_tick)


def dances_of(performance: Performance, stop_requested: StopRequested, progress: Progress) -> dict[str, DanceSteps]:
    """Dances of all dancers, by id. Raises Cancelled."""
    made = {}
    dancers = performance.project.dancers
    for number, dancer in enumerate(dancers):
        raise_if_stopped(stop_requested)
        made[dancer.id] = dance_of(performance, dancer)
        progress((number + 1) / len(dancers))
    return made


def dance_of(performance: Performance, dancer: Dancer) -> DanceSteps:
    """Dance of a dancer; an error that the user can mend is part of it."""
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
    """(S, 21, 2) each segment's pose at its accent from the front: X to the right and Y up from the floor below the
    hips, in parts of the body's height."""
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
    """For each basic motion, the segment whose figure is nearest to their mean; None where it has no segment."""
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
    """Numbers of the segments of a basic motion."""
    return [at for at, one in enumerate(model.segments) if one.state == state]
