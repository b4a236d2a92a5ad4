"""Playhead, selection and camera move to problems; the playhead also moves to a selected note."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.editor.problems import go_to_problem, view_of
from app.editor.selection import Selection
from app.errors import Message
from app.plan.model import Problem
from app.project.edit.notes import move
from app.shell.app import Program
from tests.support.windows import child
from widgets.inspector.problem_list import ProblemList


def _spoil(program: Program) -> tuple[str, tuple[str, str]]:
    """Make two notes of the second player too high; return the player and the notes."""
    session = program.session
    player = session.project.players[1]
    notes = session.project.part(player).notes
    chosen = notes[6].id, notes[12].id
    session.apply(Message("edit.move_notes", {"count": 2, "of": ""}), move(session.project, chosen, 0, 36))
    session.set_players((session.project.players[0].id,))
    session.set_playhead(0.0)
    return player.id, chosen


def _onset_s(program: Program, note_id: str) -> float:
    project = program.session.project
    note = next(note for part in project.score.parts for note in part.notes if note.id == note_id)
    return project.score.tempo_map.seconds(float(note.onset_tick))


def test_f8_moves_playhead_player_and_camera(program: Program) -> None:
    player_id, chosen = _spoil(program)
    session = program.session
    reached = []
    for _ in range(2):
        QTest.keyClick(program.window, Qt.Key.Key_F8)
        assert session.player is not None
        reached.append((session.player.id, *session.selection.notes, session.viewport.view))
        assert session.playhead_s == pytest.approx(_onset_s(program, *session.selection.notes), abs=0.05)
    assert reached == [(player_id, note_id, "hands") for note_id in chosen]


def test_a_click_on_a_line_of_the_list_does_too(program: Program) -> None:
    player_id, chosen = _spoil(program)
    session = program.session
    shown = child(program.window, ProblemList)
    shown.show_problems()
    view = shown.list
    row = next(i for i, line in enumerate(view.lines.lines) if line.key[0] == player_id)
    QTest.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=view.visualRect(view.lines.index(row)).center())
    assert session.player is not None
    assert session.player.id == player_id
    assert session.selection.notes == {chosen[0]}
    assert session.viewport.view == "hands"
    assert session.playhead_s == pytest.approx(_onset_s(program, chosen[0]), abs=0.05)


@pytest.mark.parametrize(
    ("message_id", "view"),
    [
        ("fingering.out_of_range", "hands"),
        ("breath.too_long", "mouth"),
        ("contact.lips_off", "mouth"),
        ("contact.foot_off", "feet"),
        ("contact.finger_off", "hands"),
        ("pose.beyond_reach", "front"),
    ],
)
def test_the_camera_is_chosen_by_kind(message_id: str, view: str) -> None:
    assert view_of(Problem(Message(message_id), None, 0.0, 1.0)) == view


def test_a_selected_note_takes_the_playhead_along_while_the_setting_is_on(program: Program) -> None:
    session = program.session
    assert session.player is not None
    first, second, *_, last = session.project.part(session.player).notes
    session.set_playhead(0.0)
    session.select(Selection(frozenset({last.id})))
    assert session.playhead_s == pytest.approx(_onset_s(program, last.id))
    inside_s = session.playhead_s + 0.01
    session.select(Selection())
    session.set_playhead(inside_s)
    session.select(Selection(frozenset({last.id})))
    assert session.playhead_s == inside_s
    session.select(Selection(frozenset({first.id, second.id})))
    assert session.playhead_s == inside_s
    program.editor.table.refresh()
    session.viewport.set(follows_selection=False)
    session.select(Selection(frozenset({second.id})))
    assert session.playhead_s == inside_s


def test_a_problem_of_the_whole_piece_keeps_the_playhead(program: Program) -> None:
    session = program.session
    frame = session.performance.time_frame
    session.set_playhead(5.0)
    missing = Problem(
        Message("project.character_missing", {"id": "no_one", "player": "Ann"}), None, frame.first_frame_s, frame.end_s
    )
    go_to_problem(session, session.project.players[2].id, missing)
    assert session.playhead_s == 5.0
    assert session.players[0] == session.project.players[2].id
