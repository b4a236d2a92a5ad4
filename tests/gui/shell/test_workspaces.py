"""Workspaces and lanes store their layout in the whole window, by mouse and keys."""

from __future__ import annotations

import base64
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QTabWidget, QToolButton, QWidget
from pytestqt.qtbot import QtBot

from app.editor.settings import Settings
from app.errors import Message
from app.project.edit.takes import add_takes
from app.shell.app import Program
from app.shell.commands.timeline import LANES, NUMBERED
from app.shell.workspaces import WORKSPACES
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Start, trigger
from tests.support.takes import take_of
from widgets.players.parameter_rows import ParameterChoice, ParameterSlider
from widgets.timeline.model.roll.shown_notes import LEGIBLE_ROW_PX

SHOWN = {
    "animate": {"players", "inspector", "timeline"},
    "record": {"recording", "players", "timeline"},
    "check": {"inspector", "timeline"},
}
"""Visible panels of each workspace by default."""
LEFT, NONE = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
ALT, CTRL_ALT = Qt.KeyboardModifier.AltModifier, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier


def settle() -> None:
    for _ in range(3):
        QApplication.processEvents()


def shown(program: Program) -> set[str]:
    return {name for name, dock in program.window.docks.items() if not dock.isHidden()}


def at_size(start: Start, width: int, height: int) -> Program:
    program = start()
    program.window.resize(width, height)
    settle()
    program.editor.files.open(QUARTET, ask=False)
    settle()
    return program


def switch_to(program: Program, workspace: str) -> None:
    """Click the workspace switch in the menu bar."""
    button = program.window.findChild(QToolButton, f"workspace_{workspace}")
    assert isinstance(button, QToolButton)
    QTest.mouseClick(button, LEFT)
    settle()


def seen_wholly(widget: QWidget, area: QWidget) -> bool:
    return area.rect().contains(widget.rect().translated(widget.mapTo(area, QPoint())))


def test_in_a_new_window_players_are_large_and_parameters_many(start: Start) -> None:
    program = at_size(start, 1600, 1000)
    window = program.window
    for language in ("en", "ja"):
        program.editor.speak(language)
        trigger(program, "workspace.reset")
        settle()
        assert window.viewport.height() >= 0.45 * window.height()
        scroll = window.players._scroll.viewport()
        rows = [*window.players.findChildren(ParameterSlider), *window.players.findChildren(ParameterChoice)]
        assert sum(seen_wholly(row, scroll) for row in rows if row.isVisible()) >= 8
        timeline, roll = window.timeline, window.timeline.roll
        for id in ("roll", "fingering"):
            assert seen_wholly(timeline.lanes[id].header, timeline.stack.viewport()), id
        assert roll.height() >= 220
        assert seen_wholly(timeline.lanes["breath"], timeline.stack.viewport())
        for player in program.session.project.players:
            program.session.set_players((player.id,))
            settle()
            front = roll.model.front()
            assert front is not None
            _, _, _, height = roll.boxes(front[0], np.arange(len(front[0])))
            assert height.min() >= 8
            bottom, top = roll.y_range
            assert top - bottom >= 24
        # Lanes below are scrolled to.
        trigger(program, "lanes.problems")
        trigger(program, "lanes.problems")
        settle()
        assert seen_wholly(timeline.lanes["problems"].header, timeline.stack.viewport())


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (1600, 1000)])
def test_what_each_workspace_shows(start: Start, width: int, height: int) -> None:
    program = at_size(start, width, height)
    window, timeline = program.window, program.window.timeline
    sizes = {}
    for workspace in WORKSPACES:
        switch_to(program, workspace.id)
        assert window.workspaces.current == workspace.id
        assert shown(program) == SHOWN[workspace.id]
        assert (window.width(), window.height()) == (width, height)
        sizes[workspace.id] = (window.viewport.height(), timeline.height())
    # To record the timeline is largest, to check the picture.
    assert sizes["record"][1] > 1.25 * sizes["animate"][1]
    assert sizes["check"][0] > 1.25 * sizes["animate"][0] > 1.2 * sizes["record"][0]
    # The problems are the larger part of the inspector, and their lane is the uppermost.
    problems = window.findChild(QTabWidget, "inspector_tabs")
    assert isinstance(problems, QTabWidget)
    assert problems.currentIndex() == 0
    assert problems.height() > 0.5 * window.docks["inspector"].height()
    assert timeline.stack.lanes[0].id == "problems"
    switch_to(program, "record")
    takes = timeline.lanes["takes"]
    assert not takes.isHidden()
    assert not takes.folded


def test_a_workspace_is_switched_by_key_and_each_remembers_its_changes(start: Start, settings: Settings) -> None:
    first = at_size(start, 1600, 1000)
    window = first.window
    trigger(first, "panel.inspector")
    QTest.keyClick(window, Qt.Key.Key_3, ALT)
    settle()
    assert window.workspaces.current == "check"
    trigger(first, "panel.players")
    window.resizeDocks([window.docks["timeline"]], [500], Qt.Orientation.Vertical)
    settle()
    height = window.docks["timeline"].height()
    QTest.keyClick(window, Qt.Key.Key_2, ALT)
    settle()
    assert shown(first) == SHOWN["record"]
    QTest.keyClick(window, Qt.Key.Key_1, ALT)
    settle()
    assert shown(first) == SHOWN["animate"] - {"inspector"}
    QTest.keyClick(window, Qt.Key.Key_3, ALT)
    settle()
    assert shown(first) == SHOWN["check"] | {"players"}
    window.close()
    again = start()
    assert Settings(settings.path).workspace == "check"
    again.editor.files.open(QUARTET, ask=False)
    settle()
    assert again.window.workspaces.current == "check"
    assert shown(again) == SHOWN["check"] | {"players"}
    assert abs(again.window.docks["timeline"].height() - height) <= 4
    trigger(again, "workspace.reset")
    settle()
    assert shown(again) == SHOWN["check"]
    QTest.keyClick(again.window, Qt.Key.Key_1, ALT)
    settle()
    # The others are as they were.
    assert shown(again) == SHOWN["animate"] - {"inspector"}


def test_reset_workspace_brings_everything_back(start: Start) -> None:
    program = at_size(start, 1600, 1000)
    window = program.window
    for workspace in WORKSPACES:
        switch_to(program, workspace.id)
        lanes = window.timeline.save_state()
        places = {name: dock.geometry() for name, dock in window.docks.items() if not dock.isHidden()}
        window.docks["timeline"].setFloating(True)
        trigger(program, "panel.players")
        window.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, window.docks["inspector"])
        window.timeline.fold_lanes(True)
        window.timeline.stack.shift(window.timeline.roll, 1)
        trigger(program, "workspace.reset")
        settle()
        assert window.timeline.save_state() == lanes
        assert {name: dock.geometry() for name, dock in window.docks.items() if not dock.isHidden()} == places


def test_the_switch_shows_the_workspace_and_goes_with_the_start_page(program: Program) -> None:
    window = program.window
    switch_to(program, "record")
    down = [id for id in SHOWN if window.findChild(QToolButton, f"workspace_{id}").isChecked()]
    assert down == ["record"]
    # A click on the current workspace leaves its button pressed.
    switch_to(program, "record")
    assert window.findChild(QToolButton, "workspace_record").isChecked()
    trigger(program, "file.close")
    settle()
    assert not window.workspace_switch.isVisible()
    assert not shown(program)
    trigger(program, "file.open_example")
    settle()
    assert window.workspace_switch.isVisible()
    assert shown(program) == SHOWN["record"]


def test_lanes_fold_and_unfold_by_key(program: Program) -> None:
    timeline = program.window.timeline
    assert set(LANES) == set(timeline.lanes)
    assert set(LANES) - set(NUMBERED) == {"dynamics"}
    assert len(NUMBERED) == 10
    for number, id in enumerate(NUMBERED, 1):
        for _ in range(2):
            before = timeline.is_lane_open(id)
            QTest.keyClick(program.window, Qt.Key(Qt.Key.Key_0.value + number % 10), CTRL_ALT)
            settle()
            assert timeline.is_lane_open(id) != before, id
            assert timeline.lanes[id].plot.isVisible() != before


def test_folds_are_remembered_at_once(program: Program, start: Start, settings: Settings) -> None:
    lane = program.window.timeline.lanes["breath"]
    QTest.mouseDClick(lane.header, LEFT, NONE, QPoint(lane.header.width() - 8, 12))
    settle()
    assert lane.folded
    # The program is killed: only written settings count.
    settings.sync()
    stored = Settings(settings.path).workspace_state("animate")
    second = start()
    assert second.window.timeline.lane_layout.state.folded != program.window.timeline.lane_layout.state.folded
    second.editor.files.open(QUARTET, ask=False)
    assert second.window.timeline.save_state() == stored["timeline"] == program.window.timeline.save_state()


def test_lanes_with_nothing_in_them_come_when_there_is_something(program: Program, qtbot: QtBot) -> None:
    session, timeline = program.session, program.window.timeline
    takes, dance = timeline.lanes["takes"], timeline.lanes["dance"]
    assert takes.isHidden()
    assert dance.isHidden()
    player = session.project.players[0].id
    takes_of_it = [take_of([(1.0, 1.4, 60, 0.7)])]
    session.attempt(Message("edit.comp_before"), lambda project: add_takes(project, player, takes_of_it)[0])
    assert takes.isVisible()
    trigger(program, "dancers.add")
    assert dance.isVisible()
    for _ in range(2):
        session.document.undo()
    assert takes.isHidden()
    assert dance.isHidden()


def test_states_that_are_none_are_passed_over(start: Start, settings: Settings, tmp_path: Path) -> None:
    settings.set_workspace_state(
        "animate",
        layout=base64.b64encode(b"nonsense").decode() + "!",
        timeline="[1]",
        players="9" * 4000,
        inspector='{"lists_share": 1e999, "tab": 99}',
    )
    settings.workspace = "of another program"
    program = start()
    program.editor.files.open(QUARTET, ask=False)
    settle()
    assert program.window.workspaces.current == "animate"
    assert shown(program) == SHOWN["animate"]


def test_lanes_of_two_players_are_in_sight_when_they_are_stacked(start: Start) -> None:
    program = at_size(start, 1600, 1000)
    timeline, session = program.window.timeline, program.session
    session.set_players(tuple(player.id for player in session.project.players[:2]))
    trigger(program, "lanes.stacked")
    settle()
    assert timeline.stacking
    room = timeline.stack.viewport()
    first, second = timeline.players.shown
    for place in (first, second):
        for id, lane in place.lanes.items():
            assert seen_wholly(lane, room), (place.session.player_id, id)
        assert place.roll.row_px >= LEGIBLE_ROW_PX - 0.01
    assert first.caption.mapTo(room, QPoint()).y() == 0
