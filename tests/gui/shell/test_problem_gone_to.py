"""The problem that the user navigates to: its row in the list, its notice, and the notes moved by its fix."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox, QPushButton

from app.errors import Message
from app.plan.by_hand.corrections import PinFingering
from app.project.edit.corrections import with_corrections
from app.project.edit.notes import move
from app.project.model import Project
from app.shell.app import Program
from app.shell.status import StatusLine
from tests.support import mouse
from tests.support.windows import child
from widgets.inspector.problem_list import ProblemList
from widgets.timeline.panel import TimelinePanel

OUTSIDE = "fingering.out_of_range"


def _lower(program: Program, number: int, octaves: int = 4, first: int = 4, count: int = 8) -> tuple[str, list[str]]:
    """Move notes of a player far below its range; return the player and the notes."""
    session = program.session
    player = session.project.players[number]
    ids = [note.id for note in session.project.part(player).notes[first : first + count]]
    session.apply(Message("edit.move_notes", {"count": count, "of": ""}), move(session.project, ids, 0, -12 * octaves))
    return player.id, ids


def _press(program: Program, key: Qt.Key, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    QTest.keyClick(program.window, key, modifier)


def _chosen(program: Program) -> list[tuple[str, str]]:
    """Performers and kinds of the selected rows."""
    shown = child(program.window, ProblemList)
    return [(id, problems[0].message.id) for id, problems in shown._chosen()]


def _pitches(project: Project, ids: list[str]) -> list[int]:
    return [note.pitch for part in project.score.parts for note in part.notes if note.id in ids]


def _in_sight(program: Program, ids: list[str]) -> bool:
    """Return whether most of the notes are in the visible part of the roll."""
    bottom, top = child(program.window, TimelinePanel)._front.roll.y_range
    seen = [bottom <= pitch < top for pitch in _pitches(program.session.project, ids)]
    return sum(seen) > len(seen) / 2


def test_f8_selects_the_row_that_fix_and_ignore_act_on(program: Program) -> None:
    session = program.session
    id, ids = _lower(program, 1)
    session.set_playhead(0.0)
    fix, ignore = (child(program.window, QPushButton, name) for name in ("fix_problems", "ignore_problems"))
    assert not fix.isEnabled()
    assert fix.toolTip().startswith("Select a row")
    rows = set()
    for _ in range(len(ids) + 4):
        _press(program, Qt.Key.Key_F8)
        assert session.problem is not None
        assert _chosen(program) == [(session.problem[0], session.problem[1].message.id)]
        assert ignore.isEnabled()
        assert fix.isEnabled() or fix.toolTip().startswith("No automatic fix")
        rows.add(_chosen(program)[0])
    assert (id, OUTSIDE) in rows
    while session.problem is None or session.problem[1].message.id != OUTSIDE:
        _press(program, Qt.Key.Key_F8, Qt.KeyboardModifier.ShiftModifier)
    assert _chosen(program) == [(id, OUTSIDE)]
    shown = child(program.window, ProblemList)
    assert shown.list.viewport().rect().intersects(shown.list.visualRect(shown.list.currentIndex()))
    mouse.press(fix)
    assert not [one for one in session.problems(id) if one.message.id == OUTSIDE]


def test_the_keys_step_through_the_problems_that_are_listed(program: Program) -> None:
    session = program.session
    other = session.project.players[0]
    for note in (session.project.part(other).notes[20], session.project.part(other).notes[2]):
        pinned = with_corrections(session.project, other.id, (PinFingering(note.id, "none such"),))
        session.apply(Message("edit.pin"), pinned)
    _lower(program, 1)
    kinds = child(program.window, QComboBox, "problems_kind")
    for kind, prefix in (("Corrections", "correction."), ("Fingerings", "fingering.")):
        kinds.setCurrentIndex(kinds.findText(kind))
        kinds.activated.emit(kinds.currentIndex())
        for _ in range(5):
            _press(program, Qt.Key.Key_F8)
            assert session.problem is not None
            assert session.problem[1].message.id.startswith(prefix)
            assert _chosen(program) == [(session.problem[0], session.problem[1].message.id)]
    # No problem of this kind is left: the next one is of another kind, and its row is shown.
    kinds.setCurrentIndex(kinds.findText("Contacts"))
    kinds.activated.emit(kinds.currentIndex())
    _press(program, Qt.Key.Key_F8)
    assert session.problem is not None
    assert _chosen(program) == [(session.problem[0], session.problem[1].message.id)]
    assert kinds.currentText() == "All kinds"


def test_a_row_stays_selected_while_its_problems_become_others(program: Program) -> None:
    id, ids = _lower(program, 1)
    while program.session.problem is None or program.session.problem[1].message.id != OUTSIDE:
        _press(program, Qt.Key.Key_F8)
    session = program.session
    session.apply(Message("edit.move_notes", {"count": 1, "of": ""}), move(session.project, ids[-1:], 0, 48))
    assert _chosen(program) == [(id, OUTSIDE)]
    assert child(program.window, QPushButton, "fix_problems").isEnabled()


def test_the_roll_shows_what_a_fix_and_its_undo_move(program: Program) -> None:
    session = program.session
    _, ids = _lower(program, 0)
    low = _pitches(session.project, ids)
    while session.problem is None or session.problem[1].message.id != OUTSIDE:
        _press(program, Qt.Key.Key_F8)
    status = child(program.window, StatusLine)
    assert "range" in status.notice_text
    assert _in_sight(program, ids)
    mouse.press(child(program.window, QPushButton, "fix_problems"))
    assert min(_pitches(session.project, ids)) > max(low) - 12
    assert _in_sight(program, ids)
    assert session.selection.notes == set(ids)
    assert status.notice_text == ""
    control, shift = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
    for keys, pitches in ((control, low), (control | shift, _pitches(session.project, ids))):
        # The menu lets redo through a moment after the undo.
        QApplication.processEvents()
        _press(program, Qt.Key.Key_Z, keys)
        assert _pitches(session.project, ids) == pitches
        assert _in_sight(program, ids)


@pytest.mark.parametrize("leave", ["player", "note", "mended", "ignored"])
def test_a_notice_goes_with_its_problem(program: Program, leave: str) -> None:
    session = program.session
    _, ids = _lower(program, 1, count=1)
    while session.problem is None or session.problem[1].message.id != OUTSIDE:
        _press(program, Qt.Key.Key_F8)
    status = child(program.window, StatusLine)
    assert "range" in status.notice_text
    if leave == "player":
        session.set_players((session.project.players[0].id,))
    elif leave == "note":
        roll = child(program.window, TimelinePanel)._front.roll.plot
        QTest.mouseClick(roll, Qt.MouseButton.LeftButton, pos=QPoint(roll.width() - 4, 4))
    elif leave == "mended":
        session.apply(Message("edit.move_notes", {"count": 1, "of": ""}), move(session.project, ids, 0, 48))
    else:
        mouse.press(child(program.window, QPushButton, "ignore_problems"))
    assert status.notice_text == ""
    assert session.problem is None


def test_another_notice_stays_when_the_problem_goes(program: Program) -> None:
    session = program.session
    _lower(program, 1)
    _press(program, Qt.Key.Key_F8)
    session.notice(Message("problems.none_here"))
    session.set_players((session.project.players[0].id,))
    assert child(program.window, StatusLine).notice_text
