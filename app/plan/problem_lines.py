"""Problems as lines of a report: notes by position, fingerings in words, one line for repeated problems."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Final, TypeAlias

from app.errors import Argument, Message
from app.messages import PITCHES, TRANSPOSITION
from app.plan.model import Problem
from app.score.model import Note, Score
from instrument_maps.fingering_words import in_words
from instrument_maps.model import InstrumentMap

Wording: TypeAlias = Callable[[Message], str]
"""Function that returns a message's text in the reader's language."""

NOTES: Final = frozenset({"note", "other", "first_note", "after_note", "anchor"})
"""Message arguments that are ids of notes; an anchor may also be the id of an event or a name."""
PARTS: Final = ("side", "touch")
"""Message arguments that name a part of the body; problems of different parts are different kinds of problems."""
MOST_PLACES: Final = 40
"""Greatest number of listed places; the others are counted."""


def problem_lines(
    problems: Iterable[Problem],
    score: Score,
    wording: Wording,
    part_id: str | None = None,
    instrument: InstrumentMap | None = None,
) -> list[str]:
    """One line for each kind of problem of a player, ordered by the first occurrence.

    Parameters
    ----------
    problems : iterable of Problem
        Problems of one player.
    score : Score
        Score with the notes.
    wording : callable
        Turns a message into text in the user's language.
    part_id : str or None
        The player's part, whose notes are searched first.
    instrument : InstrumentMap or None
        The player's instrument, with the names of its keys.
    """
    return [_line(found, score, wording, part_id, instrument) for found in problems_by_kind(problems)]


def problems_by_kind(problems: Iterable[Problem]) -> list[list[Problem]]:
    """Problems of a player grouped by kind, ordered by the first of each kind."""
    kinds: dict[tuple[object, ...], list[Problem]] = {}
    for problem in problems:
        kinds.setdefault(problem_kind(problem), []).append(problem)
    return list(kinds.values())


def problem_kind(problem: Problem) -> tuple[object, ...]:
    """Key of a problem's kind; problems with equal keys share one line of the report."""
    return (problem.message.id, *(problem.message.arguments.get(name) for name in PARTS))


def problems_in_bars(
    problems: Iterable[Problem], score: Score, part_id: str | None, bars: tuple[int, int]
) -> tuple[Problem, ...]:
    """Select the problems within some bars (first and last): those whose note sounds there or, without a note, whose
    span overlaps them.

    Parameters
    ----------
    part_id : str or None
        As of `problem_lines`.
    """
    first_tick, stop_tick = score.metre_map.tick_of_bar(bars[0]), score.metre_map.tick_of_bar(bars[1] + 1)
    # A problem that lasts beyond the music ends in the last bar.
    last_tick = math.inf if stop_tick >= score.end_tick else stop_tick
    clock, found = score.tempo_map, list[Problem]()
    for problem in problems:
        note = note_of(score, problem.note_id, part_id) if problem.note_id is not None else None
        if note is not None:
            start, end = float(note.onset_tick), float(note.end_tick)
        else:
            start, end = clock.ticks(problem.start_s), clock.ticks(problem.end_s)
        if start < last_tick and (end > first_tick or start >= first_tick):
            found.append(problem)
    return tuple(found)


def note_place(score: Score, note: Note) -> Message:
    """Return a message that names a note by its pitch and its place (bar and beat)."""
    return Message("note.place", {"pitch": note.pitch, "place": score.metre_map.label(note.onset_tick)})


def note_of(score: Score, note_id: str, part_id: str | None = None) -> Note | None:
    """Find the note with an id; None if there is none. The given part is searched first."""
    for part in sorted(score.parts, key=lambda part: part.id != part_id):
        known = _indexed.get(part.id)
        if known is None or known[0] is not part.notes:
            known = _indexed[part.id] = (part.notes, {note.id: note for note in part.notes})
        if note_id in known[1]:
            return known[1][note_id]
    return None


def with_names(
    message: Message, score: Score, wording: Wording, part_id: str | None, instrument: InstrumentMap | None
) -> Message:
    """Replace note ids in a message by pitch, bar and beat, and fingerings by the names of their keys; unknown ids
    stay.
    """
    message = in_words(message, instrument, wording(Message("language.tag")))
    named: dict[str, Argument] = {}
    transposed = {} if instrument is None else {TRANSPOSITION: instrument.transposition_semitones}
    for name in NOTES & message.arguments.keys():
        note = note_of(score, str(message.arguments[name]), part_id)
        if note is not None:
            place = note_place(score, note)
            named[name] = wording(Message(place.id, {**place.arguments, **transposed}))
    if message.id in PITCHES:
        named |= transposed
    return Message(message.id, {**message.arguments, **named}) if named else message


_indexed: dict[str, tuple[tuple[Note, ...], dict[str, Note]]] = {}
"""Notes of each searched part by id; replaced when the part's notes change."""


def _line(
    found: list[Problem], score: Score, wording: Wording, part_id: str | None, instrument: InstrumentMap | None
) -> str:
    """Return the line of text about problems of one kind: the message of the first, and the positions of the others."""
    message, first = found[0].message, _place(found[0], score, part_id)
    line = wording(with_names(message, score, wording, part_id, instrument))
    if not NOTES & message.arguments.keys() and first:
        line = wording(Message("problem.at", {"problem": line, "place": first}))
    others: list[str] = []
    for problem in found[1:]:
        place = _place(problem, score, part_id)
        if place not in ("", first, *others):
            others.append(place)
        # Further places are counted only.
        if len(others) > MOST_PLACES:
            break
    if not others:
        return line
    listed = ", ".join(others[:MOST_PLACES]) + (", ..." if len(others) > MOST_PLACES else "")
    return wording(Message("problem.repeated", {"problem": line, "count": len(found) - 1, "places": listed}))


def _place(problem: Problem, score: Score, part_id: str | None) -> str:
    """Bar and beat of a problem's note, else of its start; empty if it starts before the music."""
    note = note_of(score, problem.note_id, part_id) if problem.note_id is not None else None
    if note is None and problem.start_s < 0.0:
        return ""
    tick = round(score.tempo_map.ticks(problem.start_s)) if note is None else note.onset_tick
    return score.metre_map.label(tick)
