"""The list of problems stays short, and says so."""

from __future__ import annotations

from dataclasses import replace

import msgspec
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from app.errors import Message
from app.performance.ensemble import Performance
from app.project.edit import notes
from tests.gui.conftest import quartet_project
from tests.support.tasks import ImmediateTasks
from widgets.common.session import Session
from widgets.inspector.problem_list import MOST_LINES, ProblemList


def test_very_many_problems_are_counted_and_not_all_listed(qt_app: object, qtbot: QtBot) -> None:
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
    count = sum(len(plan.problems) for plan in performance.plans.values())
    assert count > MOST_LINES
    shown = ProblemList(session)
    qtbot.addWidget(shown)
    shown.show()
    with qtbot.waitSignal(shown.counted, check_params_cb=lambda told: told == count):
        session.set_performance(performance)
    assert shown.list.lines.rowCount() == MOST_LINES
    assert any(str(count - MOST_LINES) in label.text() for label in shown.findChildren(QLabel))


def test_lines_are_those_of_a_list_made_anew(qt_app: object, qtbot: QtBot) -> None:
    """Lines of problems that stay are kept; notes, names and the naming of pitches are not missed."""
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
    session.apply(Message("edit.move_notes", {"count": 1}), notes.move(session.project, {high[0].id}, 0, -30))
    plan()
    assert shown.list.lines.lines == fresh() != first
    session.pitch_display.set(written=True)
    assert shown.list.lines.lines == fresh()
    session.deleteLater()
