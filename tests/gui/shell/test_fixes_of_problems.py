"""Context menu of the list of problems: its fixes solve the problems of one player or of all."""

from __future__ import annotations

from collections.abc import Callable, Collection

import msgspec
import pytest
from PySide6.QtWidgets import QTabWidget

from app.errors import Message
from app.project.edit import notes as edit
from app.project.edit.events import pin_fingerings
from app.project.edit.length import with_score
from app.project.model import Project
from app.project.performers import Player
from app.shell.app import Program
from tests.support import mouse
from tests.support.windows import child
from widgets.inspector.problem_list import ProblemList

Spoil = Callable[[Project, Player], Project]


def _overlapping(project: Project, player: Player) -> Project:
    """Make two notes overlap the next one by half."""
    notes = project.part(player).notes
    for note, following in ((notes[2], notes[3]), (notes[8], notes[9])):
        end_tick = following.onset_tick + following.duration_tick // 2
        project = edit.resize(project, [note.id], end_tick - note.end_tick)
    return project


def _struck_together(project: Project, player: Player) -> Project:
    """Add a third below two notes, to one of them two."""
    notes = project.part(player).notes
    for note, down in ((notes[2], 3), (notes[8], 4), (notes[8], 7)):
        project, _ = edit.add_note(project, player.part_id, note.onset_tick, note.duration_tick, note.pitch - down, 80)
    return project


def _orphaned(project: Project, player: Player) -> Project:
    """Pin fingerings of two notes that a re-import removes."""
    part = project.part(player)
    ids = [part.notes[index].id for index in (2, 8)]
    pinned = pin_fingerings(project, player.id, dict.fromkeys(ids, "0"))
    kept = tuple(note for note in part.notes if note.id not in ids)
    parts = tuple(msgspec.structs.replace(one, notes=kept) if one.id == part.id else one for one in pinned.score.parts)
    return with_score(pinned, msgspec.structs.replace(pinned.score, parts=parts))


def _found(program: Program, message_id: str) -> dict[str, int]:
    """Numbers of problems of a kind by player, if any."""
    session = program.session
    counts = {
        one.id: sum(problem.message.id == message_id for problem in session.problems(one.id))
        for one in session.project.players
    }
    return {id: count for id, count in counts.items() if count}


def _choose(program: Program, player_id: str, message_id: str, starts: str, ends: str = "") -> None:
    """Choose an entry of the context menu of a player's row."""
    shown = child(program.window, ProblemList)
    program.window.findChild(QTabWidget, "inspector_tabs").setCurrentWidget(shown)
    shown.show_problems()
    view = shown.list
    row = next(
        index
        for index, line in enumerate(view.lines.lines)
        if line.key[0] == player_id and line.key[1][0].message.id == message_id
    )
    index = view.lines.index(row)
    view.scrollTo(index)
    menu = mouse.menu_at(view.viewport(), view.visualRect(index).center())
    assert menu is not None
    entries = [one for one in menu.actions() if one.text().startswith(starts) and one.text().endswith(ends)]
    assert entries, [one.text() for one in menu.actions()]
    mouse.choose(menu, entries[0])


@pytest.mark.parametrize(
    ("message_id", "spoil", "label", "count"),
    [
        ("note.overlaps", _overlapping, "Shorten {} Overlapping Notes", 2),
        ("note.struck_together", _struck_together, "Delete {} Lower Notes", 3),
        ("correction.orphaned", _orphaned, "Revert {} Inactive Corrections", 2),
    ],
)
def test_an_entry_mends_the_problems_of_a_player_or_of_all(
    program: Program, message_id: str, spoil: Spoil, label: str, count: int
) -> None:
    session = program.session
    first, second = session.project.players[:2]
    assert not _found(program, message_id)
    session.apply(Message("edit.move_notes", {"count": 2, "of": ""}), spoil(spoil(session.project, first), second))
    spoiled, problems = session.project, _of_others(program, message_id)
    assert _found(program, message_id) == {first.id: count, second.id: count}
    _choose(program, second.id, message_id, label.format(count), ends="s")
    assert _found(program, message_id) == {first.id: count}
    assert _kept(session.project, first) == _kept(spoiled, first)
    session.document.undo()
    assert session.project == spoiled
    assert _found(program, message_id) == {first.id: count, second.id: count}
    _choose(program, first.id, message_id, label.format(2 * count), ends="(All Players)")
    assert not _found(program, message_id)
    assert _of_others(program, message_id) <= problems
    session.document.undo()
    assert session.project == spoiled


def _kept(project: Project, player: Player) -> object:
    return project.part(player), project.corrections.get(player.id)


def _of_others(program: Program, message_id: str) -> Collection[tuple[str, str]]:
    """Problems of other kinds with their players, since a fix must not cause any."""
    session = program.session
    return {
        (one.id, problem.message.id)
        for one in session.project.players
        for problem in session.problems(one.id)
        if problem.message.id != message_id
    }
