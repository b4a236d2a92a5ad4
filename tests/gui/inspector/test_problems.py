"""The list of problems stays short and states when it is cut."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QCheckBox, QLabel, QMenu, QPushButton
from pytestqt.qtbot import QtBot

from app.editor.problem_fixes import fixed, fixes_of
from app.editor.session import Session
from app.errors import Message
from app.performance.ensemble import Performance
from app.plan.model import Problem
from app.project.edit import notes
from app.project.edit.dancers import add_dancer
from app.project.storage import load, save
from app.shell.commands.problems import problems
from app.shell.status import problem_count
from instrument_maps.library import library
from tests.gui.conftest import quartet_project
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child
from widgets.inspector.problem_list import ProblemList


def test_very_many_problems_are_counted_and_not_all_listed(
    qt_app: object, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    project = quartet_project()
    parts = tuple(
        msgspec.structs.replace(
            part, notes=tuple(msgspec.structs.replace(note, pitch=min(note.pitch + 40, 127)) for note in part.notes)
        )
        for part in project.score.parts
    )
    high = replace(project, score=msgspec.structs.replace(project.score, parts=parts))
    session = Session(high, ImmediateTasks())
    performance = Performance(high)
    count = sum(len(performance.problems(player.id)) for player in high.players)
    assert count > 300
    shown = ProblemList(session)
    qtbot.addWidget(shown)
    shown.show()
    with qtbot.waitSignal(shown.counted, check_params_cb=lambda reported: reported == count):
        session.set_performance(performance)
    rows = shown.list.lines.lines
    assert sum(len(row.key[1]) for row in rows) == count
    assert len(rows) <= 4 * len(high.players)
    monkeypatch.setattr("widgets.inspector.problem_list.MOST_LINES", 2)
    shown.show_problems()
    assert shown.list.lines.rowCount() == 2
    assert any(str(len(rows) - 2) in label.text() for label in shown.findChildren(QLabel))


def test_lines_are_those_of_a_list_made_anew(qt_app: object, qtbot: QtBot) -> None:
    """Unchanged lines are kept; changes of notes, names and the notation of pitches are included."""
    project = quartet_project()
    part = project.score.parts[0]
    high = tuple(msgspec.structs.replace(note, pitch=min(note.pitch + 30, 127)) for note in part.notes[:20])
    part = msgspec.structs.replace(part, notes=high + part.notes[20:])
    score = msgspec.structs.replace(project.score, parts=(part, *project.score.parts[1:]))
    session = Session(replace(project, score=score), ImmediateTasks())
    shown = ProblemList(session)
    qtbot.addWidget(shown)
    shown.show()

    def fresh() -> object:
        other = ProblemList(session)
        qtbot.addWidget(other)
        other.show()
        return other.list.lines.lines

    def plan() -> None:
        performance = Performance(session.project, session.performance)
        performance.prepare()
        session.set_performance(performance)

    plan()
    first = shown.list.lines.lines
    assert first
    assert first == fresh()
    session.apply(Message("edit.move_notes", {"count": 1, "of": ""}), notes.move(session.project, {high[0].id}, 0, -30))
    plan()
    assert shown.list.lines.lines == fresh() != first
    session.pitch_display.set(written=True)
    assert shown.list.lines.lines == fresh()
    session.deleteLater()


def test_problems_of_dancers_are_listed_counted_and_gone_to(qt_app: object, qtbot: QtBot) -> None:
    project, dancer_id = add_dancer(quartet_project(), "no_such_dance", "Dana")
    project, other_id = add_dancer(project, "no_such_dance", "Otto")
    session = Session(project, ImmediateTasks())
    performance = Performance(project)
    assert performance.plans
    session.set_performance(performance)
    shown = ProblemList(session)
    qtbot.addWidget(shown)
    shown.resize(300, 300)
    shown.show()
    known = shown.list.lines.rowCount()
    problem = Problem(Message("dance.state_not_held", {"number": 3}), None, 2.0, 2.0)
    session.set_broken({dancer_id: (problem,)})
    lines = [line for line in shown.list.lines.lines if line.title == "Dana"]
    assert shown.list.lines.rowCount() == known + 1
    assert "3" in lines[0].detail
    assert problem_count(session) == known + 1
    assert (dancer_id, problem) in problems(session)
    players = session.players
    assert session.dancer.id == other_id
    with qtbot.waitSignal(session.revealed):
        shown.list.opened.emit((dancer_id, (problem,)))
    assert session.dancer.id == dancer_id
    assert session.players == players


def _too_high(session: Session, by: int) -> tuple[str, ...]:
    """Make every fourth note of the first player too high; return the notes."""
    ids = tuple(note.id for note in session.project.score.parts[0].notes[::4])
    session.apply(Message("edit.move_notes", {"count": len(ids), "of": ""}), notes.move(session.project, ids, 0, by))
    return ids


def _planned(session: Session) -> None:
    performance = Performance(session.project, session.performance)
    performance.prepare()
    session.set_performance(performance)


@pytest.fixture
def shown(qt_app: object, qtbot: QtBot) -> Iterator[ProblemList]:
    """Visible list of a quartet whose first player has notes two octaves too high."""
    session = Session(quartet_project(), ImmediateTasks())
    _too_high(session, 24)
    _planned(session)
    result = ProblemList(session)
    qtbot.addWidget(result)
    result.resize(340, 420)
    result.show()
    yield result
    session.deleteLater()


def _row_of(shown: ProblemList, message_id: str) -> int:
    return next(i for i, line in enumerate(shown.list.lines.lines) if line.key[1][0].message.id == message_id)


def _click(shown: ProblemList, row: int) -> None:
    view = shown.list
    QTest.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=view.visualRect(view.lines.index(row)).center())


def test_problems_of_one_cause_are_one_row_that_one_button_mends(shown: ProblemList) -> None:
    session = shown._session
    player = session.project.players[0]
    out = [p for p in session.problems(player.id) if p.message.id == "fingering.out_of_range"]
    assert len(out) > 20
    row = _row_of(shown, "fingering.out_of_range")
    assert shown.list.lines.lines[row].key[1] == tuple(out)
    assert f"×{len(out)}" in shown.list.lines.lines[row].place
    before = session.project
    _click(shown, row)
    assert session.selection.notes == {out[0].note_id}
    _click(shown, row)
    assert session.selection.notes == {out[1].note_id}
    button = child(shown, QPushButton, "fix_problems")
    assert button.isEnabled()
    assert str(len(out)) in button.text()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    _planned(session)
    assert not [p for p in session.problems(player.id) if p.message.id == "fingering.out_of_range"]
    session.document.undo()
    assert session.project == before


def test_a_part_that_is_in_written_pitch_is_read_so(qt_app: object) -> None:
    """Written notes of an E flat saxophone exceed its range at the top if read as sounding ones."""
    project = quartet_project()
    player = msgspec.structs.replace(project.players[0], instrument_id="sax_alto_Eb")
    instrument = library().maps["sax_alto_Eb"]
    down = instrument.transposition_semitones
    part = project.part(player)
    low = min(note.pitch for note in part.notes)
    sounding = [min(instrument.range.low + (note.pitch - low), instrument.range.high) for note in part.notes]
    sounding[3] = instrument.range.high
    written = tuple(
        msgspec.structs.replace(note, pitch=pitch + down) for note, pitch in zip(part.notes, sounding, strict=True)
    )
    parts = tuple(msgspec.structs.replace(p, notes=written) if p.id == part.id else p for p in project.score.parts)
    score = msgspec.structs.replace(project.score, parts=parts)
    project = replace(project, players=(player, *project.players[1:]), score=score)
    found = [p for p in Performance(project).problems(player.id) if p.message.id == "fingering.out_of_range"]
    assert found
    fix = fixes_of(project, player.id, found)[0]
    assert fix.text_id == "problem_list.fix_from_written"
    mended = fixed(project, fix, [(player.id, found)])
    assert [note.pitch for note in mended.part(player).notes] == sounding


def test_what_is_ignored_is_kept_undone_and_not_counted(shown: ProblemList, tmp_path: Path) -> None:
    session = shown._session
    player = session.project.players[0]
    every = session.problems(player.id)
    row = _row_of(shown, "fingering.out_of_range")
    count = len(shown.list.lines.lines[row].key[1])
    _click(shown, row)
    QTest.mouseClick(child(shown, QPushButton, "ignore_problems"), Qt.MouseButton.LeftButton)
    assert len(session.problems(player.id)) == len(every) - count
    assert len(session.ignored_problems(player.id)) == count
    save(session.project, tmp_path / "kept.suisou")
    again = Session(load(tmp_path / "kept.suisou"), ImmediateTasks())
    _planned(again)
    assert len(again.problems(player.id)) == len(every) - count
    again.deleteLater()
    box = child(shown, QCheckBox, "show_ignored_problems")
    assert box.isVisible()
    box.click()
    _click(shown, _row_of(shown, "fingering.out_of_range"))
    QTest.mouseClick(child(shown, QPushButton, "ignore_problems"), Qt.MouseButton.LeftButton)
    assert session.problems(player.id) == every
    session.document.undo()
    session.document.undo()
    assert session.problems(player.id) == every


def test_the_right_button_offers_what_can_be_done(shown: ProblemList) -> None:
    row = _row_of(shown, "fingering.out_of_range")
    shown.list.customContextMenuRequested.emit(shown.list.visualRect(shown.list.lines.index(row)).center())
    menu = child(shown, QMenu, "problem_menu")
    texts = [action.text() for action in menu.actions() if action.text()]
    assert texts[0] == "Go to Problem"
    assert texts[-1] == "Ignore"
    assert any("Octaves" in text for text in texts)
    menu.close()
