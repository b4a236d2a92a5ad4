"""Marks of the selected notes in the inspector, and in the list of corrections, by mouse."""

from __future__ import annotations

from app.editor.additions import toggle_mark
from app.editor.selection import Selection
from app.editor.session import Session
from app.errors import Message
from app.messages import text
from app.project.edit.marks import player_marks, set_marks
from app.score.marks import Mark
from tests.gui.inspector.hands import child, click, click_line, show_tab
from widgets.common.chip import Chip
from widgets.inspector.by_hand import ByHandLine
from widgets.inspector.panel import InspectorPanel
from widgets.inspector.rows import LineList

NAME = Message("edit.add_mark", {"mark": "mark.slur"})


def _select(session: Session, first: int, last: int) -> list[str]:
    notes = session.project.part(session.project.players[0]).notes[first : last + 1]
    session.select(Selection(frozenset(note.id for note in notes)))
    return [note.id for note in notes]


def test_marks_some_notes_have_are_given_to_all_and_then_taken_away(panel: InspectorPanel, planned: Session) -> None:
    player = planned.project.players[0]
    ids = _select(planned, 2, 5)
    before = planned.project
    toggle_mark(planned, {player.id: list(before.part(player).notes[3:5])}, "staccato")
    assert not child(panel, Chip, "mark_staccato").isChecked()
    click(panel, "mark_staccato")
    assert {mark.note_id for mark in player_marks(planned.project, player.id)} == set(ids)
    assert child(panel, Chip, "mark_staccato").isChecked()
    click(panel, "mark_staccato")
    assert planned.project == before
    assert len(planned.document.done) == 3


def test_the_status_line_says_why_no_mark_fits_and_several_players_are_one_step(planned: Session) -> None:
    first, second = planned.project.players[:2]
    before, told = planned.project, []
    planned.noticed.connect(lambda message, severity: told.append(text(message)))
    one = before.part(first).notes[3:4]
    toggle_mark(planned, {first.id: one, second.id: before.part(second).notes[:1]}, "slur")
    assert told == ["Select at least two notes of one player for this mark."]
    assert planned.project is before
    toggle_mark(planned, {first.id: before.part(first).notes[3:6], second.id: before.part(second).notes[:2]}, "slur")
    assert [len(player_marks(planned.project, player.id)) for player in (first, second)] == [1, 1]
    assert planned.document.undo() is not None
    assert planned.project is before


def test_a_mark_by_hand_is_reverted_from_its_line(panel: InspectorPanel, planned: Session) -> None:
    player = planned.project.players[0]
    ids = _select(planned, 2, 5)
    planned.apply(NAME, set_marks(planned.project, player.id, [Mark("slur", ids[0], ids[-1])]))
    chip = child(panel, Chip, "mark_slur")
    assert (chip.isChecked(), chip.by_hand) == (True, True)
    click(child(panel, ByHandLine, "marks_by_hand"), "revert")
    assert not player_marks(planned.project, player.id)


def test_the_list_names_marks_and_reverts_them(panel: InspectorPanel, planned: Session) -> None:
    player = planned.project.players[0]
    ids = _select(planned, 2, 5)
    notes = planned.project.part(player).notes
    tick = notes[2].onset_tick
    marks = [Mark("slur", ids[0], ids[-1]), Mark("dynamic", tick=tick, end_tick=tick + 1920, text="mf")]
    before = planned.project
    planned.apply(NAME, set_marks(before, player.id, marks))
    show_tab(panel, 1)
    view = child(panel, LineList, "correction_list")
    label = before.score.metre_map.label
    until = label(notes[5].onset_tick), label(tick + 1920)
    assert [(row.title, row.place, row.detail) for row in view.lines.lines] == [
        ("Slur", label(tick), f"added manually: to {until[0]}"),
        ("Dynamic", label(tick), f"added manually: mf to {until[1]}"),
    ]
    click_line(view, 1)
    click(panel, "revert_selected")
    assert player_marks(planned.project, player.id) == {marks[0]: "hand"}
