"""Fixes that resolve all problems of one kind at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

from app.plan.model import Problem
from app.project.edit import notes as edit
from app.project.edit.corrections import take_back
from app.project.model import Project
from app.project.performers import Player
from app.score.model import Note
from instrument_maps.library import library

OCTAVE: Final = 12


class ProblemFix(NamedTuple):
    """An edit that resolves problems of one kind.

    Attributes
    ----------
    text_id : str
        Id of the text of the button for the fix; the text may contain ``{count}``.
    edit : callable
        Function from a project, a player and problems of the kind to the edited project, or the same project if none is
        resolved.
    """

    text_id: str
    edit: Callable[[Project, Player, Sequence[Problem]], Project]


def fixes_of(project: Project, player_id: str, problems: Sequence[Problem]) -> tuple[ProblemFix, ...]:
    """Return the fixes that would change something about a player's problems, all of one kind; the best first."""
    player = next((player for player in project.players if player.id == player_id), None)
    if player is None or not problems:
        return ()
    return tuple(
        fix for fix in _FIXES.get(problems[0].message.id, ()) if fix.edit(project, player, problems) is not project
    )


def fixed(project: Project, fix: ProblemFix, by_player: Sequence[tuple[str, Sequence[Problem]]]) -> Project:
    """Return the project with a fix applied to each player's problems (player id and problems)."""
    for player_id, problems in by_player:
        project = fix.edit(project, project.player(player_id), problems)
    return project


def _named(project: Project, player: Player, problems: Sequence[Problem]) -> list[Note]:
    ids = {problem.note_id for problem in problems}
    return [note for note in project.part(player).notes if note.id in ids]


def _from_written(project: Project, player: Player, problems: Sequence[Problem]) -> Project:
    """Transpose the whole part as if its notes had been written pitches, if all are then in range."""
    instrument = library().maps.get(player.instrument_id)
    if instrument is None or not instrument.transposition_semitones or not _named(project, player, problems):
        return project
    notes, down = project.part(player).notes, instrument.transposition_semitones
    if not all(instrument.range.low <= note.pitch - down <= instrument.range.high for note in notes):
        return project
    return edit.move(project, [note.id for note in notes], 0, -down)


def _by_octaves(project: Project, player: Player, problems: Sequence[Problem]) -> Project:
    """Move notes by the fewest whole octaves into the range; notes that do not fit stay."""
    instrument = library().maps.get(player.instrument_id)
    if instrument is None:
        return project
    low, high = instrument.range.low, instrument.range.high
    by: dict[int, list[str]] = {}
    for note in _named(project, player, problems):
        octaves = -(-(low - note.pitch) // OCTAVE) if note.pitch < low else -(-(note.pitch - high) // OCTAVE)
        way = octaves * OCTAVE if note.pitch < low else -octaves * OCTAVE
        if way and low <= note.pitch + way <= high:
            by.setdefault(way, []).append(note.id)
    for way, ids in by.items():
        project = edit.move(project, ids, 0, way)
    return project


def _shorten(project: Project, player: Player, problems: Sequence[Problem]) -> Project:
    """End the notes of a problem where the next note begins, so that they no longer overlap."""
    onsets = {note.id: note.onset_tick for note in project.part(player).notes}
    following = {problem.note_id: onsets.get(str(problem.message.arguments["other"])) for problem in problems}
    for note in _named(project, player, problems):
        end_tick = following[note.id]
        if end_tick is not None and note.onset_tick < end_tick < note.end_tick:
            project = edit.resize(project, [note.id], end_tick - note.end_tick)
    return project


def _erase(project: Project, player: Player, problems: Sequence[Problem]) -> Project:
    """Delete the notes of a problem that a player cannot play together with other notes."""
    return edit.erase(project, [note.id for note in _named(project, player, problems)])


def _revert(project: Project, player: Player, problems: Sequence[Problem]) -> Project:
    """Delete the corrections to which the problems refer because the notes they belong to are gone."""
    lost = {(problem.message.arguments["kind"], problem.message.arguments["anchor"]) for problem in problems}
    items = project.corrections.get(player.id, ())
    return take_back(project, player.id, [item for item in items if (item.tag, item.subject) in lost])


_FIXES: Final[dict[str, tuple[ProblemFix, ...]]] = {
    "fingering.out_of_range": (
        ProblemFix("problem_list.fix_from_written", _from_written),
        ProblemFix("problem_list.fix_by_octaves", _by_octaves),
    ),
    "note.overlaps": (ProblemFix("problem_list.fix_shorten", _shorten),),
    "note.struck_together": (ProblemFix("problem_list.fix_erase", _erase),),
    "correction.orphaned": (ProblemFix("problem_list.fix_revert", _revert),),
}
"""Fixes by the id of a problem's message."""
