"""Merging of tempo and metres when a file is read again: edits stay where the file is unchanged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

import msgspec

from app.project.import_decisions import ReadTiming
from app.project.model import Project
from app.score.metre_map import Metre
from app.score.model import Score
from app.score.tempo import TempoChange, TempoMap

Placing: TypeAlias = Callable[[int], int]
TimingKind: TypeAlias = Literal["tempo", "metres"]


@dataclass(frozen=True)
class MergedTiming:
    """Merged timing of the new score.

    Attributes
    ----------
    replaced : tuple of {"tempo", "metres"}
        Items edited both in the project and in the file; the file's are used.
    """

    timing: ReadTiming
    replaced: tuple[TimingKind, ...] = ()


def timing_of(score: Score) -> ReadTiming:
    """Return tempo, metres and pickup of a score as they are stored for a later reading of its file."""
    return ReadTiming(score.tempo_map, score.metres, score.pickup_ticks)


def with_timing(score: Score, timing: ReadTiming) -> Score:
    """Return a score with tempo, metres and pickup replaced."""
    return msgspec.structs.replace(
        score, tempo_map=timing.tempo_map, metres=timing.metres, pickup_ticks=timing.pickup_ticks
    )


def merged_timing(project: Project, file: Score, place: Placing, scale: Fraction, unchanged: bool) -> MergedTiming:
    """Merge tempo and metres of three versions: the project's are used if the file did not change them, else the
    file's.

    Parameters
    ----------
    place : callable
        Function from ticks of the project's score to ticks of the file's.
    scale : Fraction
        Ticks of the file per tick of the project.
    unchanged : bool
        Whether the notes of the file are unchanged.
    """
    ours, new = timing_of(project.score), timing_of(file)
    read = project.read_timing
    if read is None:
        # An older version did not store it. If the notes are unchanged, tempo and metres are assumed unchanged too.
        return MergedTiming(ours if unchanged else new)
    result = new
    replaced: list[TimingKind] = []
    placings = (lambda tick: round(tick * scale), place)
    if ours.tempo_map != read.tempo_map:
        if any(_moved_tempo(read.tempo_map, placing, scale) == new.tempo_map for placing in placings):
            moved = _moved_tempo(ours.tempo_map, place, scale)
            result = msgspec.structs.replace(result, tempo_map=moved)
        else:
            replaced.append("tempo")
    if (ours.metres, ours.pickup_ticks) != (read.metres, read.pickup_ticks):
        here = (new.metres, new.pickup_ticks)
        if any(_moved_metres(read.metres, read.pickup_ticks, placing) == here for placing in placings):
            metres, pickup = _moved_metres(ours.metres, ours.pickup_ticks, place)
            result = msgspec.structs.replace(result, metres=metres, pickup_ticks=pickup)
        else:
            replaced.append("metres")
    return MergedTiming(result, tuple(replaced))


def _moved_tempo(tempo_map: TempoMap, place: Placing, scale: Fraction) -> TempoMap:
    changes = {}
    for change in tempo_map.changes:
        changes[max(place(change.tick), 0) if change.tick else 0] = change.microseconds_per_quarter
    quarter = round(tempo_map.ticks_per_quarter * scale)
    return TempoMap(quarter, tuple(TempoChange(tick, tempo) for tick, tempo in sorted(changes.items())))


def _moved_metres(metres: tuple[Metre, ...], pickup_ticks: int, place: Placing) -> tuple[tuple[Metre, ...], int]:
    """Return the metres and the length of the pickup after ticks are converted by ``place``. The pickup is kept if the
    metre after it still begins at its end.
    """
    moved = {}
    for metre in metres:
        tick = max(place(metre.tick), 0) if metre.tick else 0
        moved[tick] = msgspec.structs.replace(metre, tick=tick)
    result = tuple(moved[tick] for tick in sorted(moved))
    pickup = max(place(pickup_ticks), 0) if pickup_ticks else 0
    return result, pickup if len(result) > 1 and result[1].tick == pickup else 0
