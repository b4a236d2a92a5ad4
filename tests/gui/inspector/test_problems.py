"""The list of problems stays short, and says so."""

from __future__ import annotations

from dataclasses import replace

import msgspec
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from app.performance.ensemble import Performance
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
