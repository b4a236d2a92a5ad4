"""The list of problems stays short, and says so."""

from __future__ import annotations

from dataclasses import replace

import msgspec
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.errors import Message
from app.performance.ensemble import Performance
from app.plan.model import Problem
from app.project.edit import notes
from app.project.edit.dancers import add_dancer
from app.shell.commands.problems import problems
from app.shell.status import problem_count
from tests.gui.conftest import quartet_project
from tests.support.tasks import ImmediateTasks
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
    count = sum(len(performance.problems(player.id)) for player in high.players)
    assert count > MOST_LINES
    shown = ProblemList(session)
    qtbot.addWidget(shown)
    shown.show()
    with qtbot.waitSignal(shown.counted, check_params_cb=lambda reported: reported == count):
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
        shown.list.opened.emit((dancer_id, problem))
    assert session.dancer.id == dancer_id
    assert session.players == players
