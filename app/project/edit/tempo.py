"""Edits of tempo, metre and pickup. Notes keep their ticks; their times and the bar lines change."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec
import numpy as np

from app.arrays import FloatArray, IntArray
from app.errors import UsageError
from app.project import limits
from app.project.edit.length import with_score
from app.project.model import Project
from app.score.metre_map import Metre
from app.score.model import Score
from app.score.tempo import TempoChange, TempoMap


def set_tempo(project: Project, tick: int, bpm: float) -> Project:
    """Set the tempo from a tick on, in quarters per minute, replacing a change at that tick."""
    if not limits.BPM[0] <= bpm <= limits.BPM[1]:
        raise UsageError("tempo.outside", low=limits.BPM[0], high=limits.BPM[1])
    _check_place(tick)
    changes = {change.tick: change for change in project.score.tempo_map.changes}
    changes[tick] = TempoChange(tick, 60e6 / bpm)
    return replace_tempi(project, changes.values())


def move_tempo(project: Project, tick: int, to_tick: int) -> Project:
    """Move a tempo change to another tick, replacing one there."""
    changes = {change.tick: change for change in project.score.tempo_map.changes}
    moved = changes.get(tick)
    if moved is None:
        raise UsageError("tempo.none_here", tick=tick)
    if tick == to_tick:
        return project
    if tick == 0 or to_tick == 0:
        raise UsageError("tempo.first_stays")
    _check_place(to_tick)
    del changes[tick]
    changes[to_tick] = msgspec.structs.replace(moved, tick=to_tick)
    return replace_tempi(project, changes.values())


def remove_tempo(project: Project, tick: int) -> Project:
    """Remove a tempo change, so that the previous tempo continues."""
    if tick == 0:
        raise UsageError("tempo.first_stays")
    changes = project.score.tempo_map.changes
    kept = tuple(change for change in changes if change.tick != tick)
    if len(kept) == len(changes):
        raise UsageError("tempo.none_here", tick=tick)
    return replace_tempi(project, kept)


def scale_tempo(project: Project, ratio: float) -> Project:
    """Multiply all tempi by a ratio (1.02 is two per cent faster), to match a recording.

    The recording's offset is not changed.
    """
    low, high = limits.TEMPO_RATIO
    changes = tuple(
        msgspec.structs.replace(change, microseconds_per_quarter=change.microseconds_per_quarter / ratio)
        for change in project.score.tempo_map.changes
        if low <= ratio <= high
    )
    slowest, fastest = limits.MICROSECONDS_PER_QUARTER[::-1]
    if not changes or not all(fastest <= change.microseconds_per_quarter <= slowest for change in changes):
        raise UsageError("tempo.outside", low=limits.BPM[0], high=limits.BPM[1])
    return replace_tempi(project, changes)


def set_beats(project: Project, ticks: IntArray, seconds: FloatArray) -> Project:
    """Set the times of beats: the tempo is constant between them, and the last one continues.

    Parameters
    ----------
    ticks : (N,) int64
        Ticks of N beats, ascending from 0; N is at least 2.
    seconds : (N,) float64
        Times of the beats, ascending; only their differences matter.

    Raises
    ------
    UsageError
        A beat would be impossibly long or short.
    """
    quarters = np.diff(ticks) / project.score.ticks_per_quarter
    lengths_us = 1e6 * np.diff(seconds) / quarters
    low, high = limits.MICROSECONDS_PER_QUARTER
    if ticks[0] != 0 or not np.all((lengths_us >= low) & (lengths_us <= high)):
        raise UsageError("tempo.outside", low=limits.BPM[0], high=limits.BPM[1])
    tempi = zip(ticks[:-1].tolist(), lengths_us.tolist(), strict=True)
    return replace_tempi(project, [TempoChange(tick, length_us) for tick, length_us in tempi])


def set_metre(project: Project, tick: int, numerator: int, denominator: int) -> Project:
    """Set the metre from a tick on, where a bar begins; the bar before may be cut short. A pickup and the bar after it
    change together if they have the same metre.
    """
    _check_metre(numerator, denominator)
    _check_place(tick)
    score = project.score
    places: tuple[int, ...] = (tick,)
    if 0 < tick < score.pickup_ticks:
        raise UsageError("metre.inside_pickup")
    if score.pickup_ticks and tick <= score.pickup_ticks:
        if _is_same(score.metres[0], score.metres[1]):
            places = (0, score.pickup_ticks)
        _check_pickup(score, score.pickup_ticks, numerator, denominator)
    metres = {metre.tick: metre for metre in score.metres}
    metres |= {place: Metre(place, numerator, denominator) for place in places}
    return _with_metres(project, metres.values(), score.pickup_ticks)


def move_metre(project: Project, tick: int, to_tick: int) -> Project:
    """Move a metre to another tick, replacing one there. The first metre and the one after a pickup cannot be moved."""
    score = project.score
    metre = next((metre for metre in score.metres if metre.tick == tick), None)
    if metre is None:
        raise UsageError("metre.none_here", tick=tick)
    if to_tick == tick:
        return project
    if min(tick, to_tick) <= score.pickup_ticks:
        raise UsageError("tempo.first_stays")
    return set_metre(remove_metre(project, tick), to_tick, metre.numerator, metre.denominator)


def remove_metre(project: Project, tick: int) -> Project:
    """Remove a metre, so that the previous one continues. The one after a pickup is removed with the pickup: see
    `set_pickup`.
    """
    if tick == 0:
        raise UsageError("tempo.first_stays")
    score = project.score
    if tick == score.pickup_ticks:
        return set_pickup(project, 0)
    kept = tuple(metre for metre in score.metres if metre.tick != tick)
    if len(kept) == len(score.metres):
        raise UsageError("metre.none_here", tick=tick)
    return _with_metres(project, kept, score.pickup_ticks)


def set_pickup(project: Project, ticks: int) -> Project:
    """Set the length in ticks of an incomplete first bar; 0 for none."""
    score = project.score
    if ticks == score.pickup_ticks:
        return project
    # The metre of the first complete bar is the metre of the piece; a pickup may have one of its own.
    whole = score.metres[1] if score.pickup_ticks else score.metres[0]
    _check_pickup(score, ticks, whole.numerator, whole.denominator)
    later = [metre for metre in score.metres if metre.tick > max(ticks, score.pickup_ticks)]
    first = msgspec.structs.replace(whole, tick=0)
    after = [msgspec.structs.replace(whole, tick=ticks)] if ticks else []
    return _with_metres(project, [first, *after, *later], ticks)


def _check_place(tick: int) -> None:
    if not 0 <= tick <= limits.LAST_TICK:
        raise UsageError("tempo.place_outside", tick=tick)


def _check_metre(numerator: int, denominator: int) -> None:
    low, high = limits.METRE_NUMERATOR
    if not low <= numerator <= high or denominator not in limits.METRE_DENOMINATORS:
        raise UsageError("metre.impossible", numerator=numerator, denominator=denominator)


def _check_pickup(score: Score, ticks: int, numerator: int, denominator: int) -> None:
    """Raise UsageError if a pickup of ``ticks`` is not shorter than a whole bar of the metre."""
    most = 4 * score.ticks_per_quarter * numerator // denominator - 1
    if not 0 <= ticks <= most:
        raise UsageError("metre.pickup_too_long", most=most)


def _is_same(one: Metre, other: Metre) -> bool:
    return (one.numerator, one.denominator) == (other.numerator, other.denominator)


def replace_tempi(project: Project, changes: Iterable[TempoChange]) -> Project:
    """Set all tempi of the piece, in any order, one of them at tick 0; returns the same project if nothing changes."""
    before = project.score.tempo_map
    ordered = tuple(sorted(changes, key=lambda change: change.tick))
    if ordered == before.changes:
        return project
    tempo_map = TempoMap(before.ticks_per_quarter, ordered)
    return with_score(project, msgspec.structs.replace(project.score, tempo_map=tempo_map))


def _with_metres(project: Project, metres: Iterable[Metre], pickup_ticks: int) -> Project:
    before = project.score
    ordered = tuple(sorted(metres, key=lambda metre: metre.tick))
    if ordered == before.metres and pickup_ticks == before.pickup_ticks:
        return project
    score: Score = msgspec.structs.replace(before, metres=ordered, pickup_ticks=pickup_ticks)
    return with_score(project, score)
