"""Adding and removing corrections of dances. KeyError for an unknown dancer."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from app.project import limits
from app.project.dance_corrections import DanceCorrection, ForbidState, PinState, UseSegment
from app.project.model import Project


def pin_state(project: Project, dancer_id: str, tick: int, state: int) -> Project:
    """Require a basic motion at a tick of a dance, replacing any requirement there."""
    return _put(project, dancer_id, PinState(_tick(tick), state))


def use_segment(project: Project, dancer_id: str, tick: int, segment: int) -> Project:
    """Require a segment of the motion capture at a tick of a dance, replacing any requirement there."""
    return _put(project, dancer_id, UseSegment(_tick(tick), segment))


def forbid_state(project: Project, dancer_id: str, start_tick: int, end_tick: int, state: int) -> Project:
    """Exclude a basic motion from one tick to another; an empty span has no effect. Pinned motions within the span stay
    and have priority.
    """
    start, end = _tick(start_tick), _tick(end_tick)
    return _put(project, dancer_id, ForbidState(start, end, state)) if start < end else project


def take_back(project: Project, dancer_id: str, corrections: Iterable[DanceCorrection]) -> Project:
    """Remove the given corrections of a dance, so that the generated motion returns."""
    return _without(project, dancer_id, corrections)


def clear(project: Project, dancer_id: str) -> Project:
    """Remove every correction of a dancer's dance."""
    return _without(project, dancer_id, project.dance_corrections.get(dancer_id, ()))


def _tick(tick: int) -> int:
    return min(max(tick, -limits.LAST_TICK), limits.LAST_TICK)


def _place(item: DanceCorrection) -> tuple[int, ...]:
    """Return the key of a dance correction; corrections with equal keys replace each other, such as requirements at one
    tick.
    """
    return (item.start_tick, item.end_tick, item.state) if isinstance(item, ForbidState) else (item.tick,)


def _put(project: Project, dancer_id: str, correction: DanceCorrection) -> Project:
    before = project.dance_corrections.get(project.dancer(dancer_id).id, ())
    if correction in before:
        return project
    others = (item for item in before if _place(item) != _place(correction))
    return _with(project, dancer_id, tuple(sorted((*others, correction), key=_place)))


def _without(project: Project, dancer_id: str, corrections: Iterable[DanceCorrection]) -> Project:
    gone = set(corrections)
    before = project.dance_corrections.get(project.dancer(dancer_id).id, ())
    kept = tuple(item for item in before if item not in gone)
    return project if len(kept) == len(before) else _with(project, dancer_id, kept)


def _with(project: Project, dancer_id: str, corrections: tuple[DanceCorrection, ...]) -> Project:
    others = {id: items for id, items in project.dance_corrections.items() if id != dancer_id}
    return replace(project, dance_corrections={**others, dancer_id: corrections} if corrections else others)
