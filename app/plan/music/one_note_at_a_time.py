"""Reduces a part to one note at a time, as a wind player sounds it, and reports what was left out."""

from __future__ import annotations

from typing import NamedTuple

import msgspec

from app.errors import Message
from app.plan.model import Problem
from app.plan.music.piece import MonophonicPart
from app.score.model import Note
from app.score.tempo import TempoMap

LEGATO_OVERLAP_S = 0.030
"""Overlap in seconds of two notes that is legato on keyboards and wind controllers, and no error."""


class Single(NamedTuple):
    """A part reduced to one note at a time, with a problem for every note that was left out or overlaps the next."""

    part: MonophonicPart
    problems: tuple[Problem, ...]


def one_at_a_time(part: MonophonicPart, clock: TempoMap) -> Single:
    """Remove notes that cannot sound together with others; of notes struck at one tick the highest stays.

    Returns the same object if nothing was removed.
    """
    notes = part.notes
    left_out: set[int] = set()
    problems: list[Problem] = []
    held: int | None = None
    for index, note in enumerate(notes):
        if held is not None:
            other = notes[held]
            if other.onset_tick == note.onset_tick:
                lower, higher = (held, index) if note.pitch >= other.pitch else (index, held)
                left_out.add(lower)
                problems.append(_together(notes[lower], notes[higher], clock))
                held = higher
                continue
            _note_overlap(other, note, clock, problems)
        held = index
    if not left_out:
        return Single(part, tuple(problems))
    kept = [index for index in range(len(notes)) if index not in left_out]
    loudness, levels = (
        tuple(values[index] for index in kept) if values else () for values in (part.loudness, part.levels)
    )
    kept_notes = tuple(notes[index] for index in kept)
    playable = msgspec.structs.replace(part, notes=kept_notes, loudness=loudness, levels=levels)
    return Single(playable, tuple(problems))


def _together(lower: Note, higher: Note, clock: TempoMap) -> Problem:
    message = Message("note.struck_together", {"note": lower.id, "other": higher.id})
    start_s = clock.seconds(float(lower.onset_tick))
    return Problem(message, lower.id, start_s, clock.seconds(float(lower.onset_tick + lower.duration_tick)))


def _note_overlap(note: Note, following: Note, clock: TempoMap, problems: list[Problem]) -> None:
    end_tick = note.onset_tick + note.duration_tick
    if end_tick <= following.onset_tick:
        return
    start_s, end_s = clock.seconds(float(following.onset_tick)), clock.seconds(float(end_tick))
    if end_s - start_s > LEGATO_OVERLAP_S:
        overlap_ms = round(1000.0 * (end_s - start_s))
        arguments: dict[str, str | int | float | bool] = {
            "note": note.id,
            "other": following.id,
            "overlap_ms": overlap_ms,
        }
        problems.append(Problem(Message("note.overlaps", arguments), note.id, start_s, end_s))
