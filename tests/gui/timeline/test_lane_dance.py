"""The lane of dances by mouse and keys, compared with the project and the resulting dance."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QAction
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu
from pytestqt.qtbot import QtBot

from app.choreography.model_file import write_model
from app.choreography.performed.dancers import dancing_of
from app.editor.session import Session
from app.errors import Message
from app.project.casting import StagePosition
from app.project.dance_corrections import ForbidState, PinState, UseSegment
from app.project.edit.dancers import set_choreography
from app.project.model import Project
from app.project.performers import Dancer
from app.project.snap_grid import Grid
from app.score.model import Note
from tests.gui.timeline.conftest import TPQ, scale_project
from tests.gui.timeline.lane_hands import LEFT, SHIFT, click, double_click, planned
from tests.support.dances import model
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child, show_in_front
from widgets.timeline.lanes.choreography.dance_lane import DanceLane
from widgets.timeline.panel import TimelinePanel

MARY, NINA = "dancer:1", "dancer:2"


def danced_project(folder: Path) -> Project:
    """Eight bars of quarters, and two dancers."""
    path = folder / "steps.choreography"
    write_model(path, model())
    project = scale_project()
    notes = tuple(Note(f"1:{number}", TPQ * number, TPQ - 40, 60, 80) for number in range(32))
    parts = (msgspec.structs.replace(project.score.parts[0], notes=notes), *project.score.parts[1:])
    dancers = tuple(
        Dancer(id, name, str(path), "woman_adult", StagePosition(0.0, 2.0, 0.0), seed=seed)
        for id, name, seed in ((MARY, "Mary", 3), (NINA, "Nina", 8))
    )
    return replace(project, score=msgspec.structs.replace(project.score, parts=parts), dancers=dancers)


@pytest.fixture
def lane(qt_app: QApplication, qtbot: QtBot, tmp_path: Path) -> Iterator[DanceLane]:
    session = Session(danced_project(tmp_path), ImmediateTasks())
    planned(session)
    panel = TimelinePanel(session)
    qtbot.addWidget(panel)
    panel.resize(1200, 900)
    lane = child(panel, DanceLane)
    lane.set_folded(False)
    show_in_front(panel)
    panel.axis.show(0.0, 12.0)
    session.set_grid(Grid(Fraction(1)))
    yield lane
    session.timeline_view = None
    session.deleteLater()


def place(lane: DanceLane, number: int, row: int = 0) -> QPointF:
    """Centre of a dancer's step."""
    step = lane.dances[lane.dancers[row].id].steps[number]
    return QPointF(lane.axis.x_px((step.start_s + step.end_s) / 2), lane.row_rect(row).center().y())


def states(lane: DanceLane, dancer_id: str = MARY) -> list[int]:
    """States of a dancer's steps in the project, computed again."""
    performance = lane.session.performance
    return [step.state for step in dancing_of(performance, lane.session.project.dancer(dancer_id)).steps()]


def state_at(lane: DanceLane, tick: int, dancer_id: str = MARY) -> int:
    dance = lane.dances[dancer_id]
    return dance.steps[dance.ticks.index(tick)].state


def corrections(lane: DanceLane, dancer_id: str = MARY) -> tuple[object, ...]:
    return lane.session.project.dance_corrections.get(dancer_id, ())


def entries(menu: QMenu) -> dict[str, QAction]:
    return {action.text(): action for action in menu.actions() if action.text()}


def menu_at(lane: DanceLane, at: QPointF) -> QMenu:
    QTest.mouseClick(lane.plot, Qt.MouseButton.RightButton, Qt.KeyboardModifier.NoModifier, at.toPoint())
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu)
    return menu


def test_each_dancer_has_a_row_of_steps_that_is_what_is_danced(lane: DanceLane) -> None:
    assert [step.state for step in lane.dances[MARY].steps] == states(lane)
    assert [step.state for step in lane.dances[NINA].steps] == states(lane, NINA) != states(lane)
    click(lane, place(lane, 2, row=1))
    assert lane.selected_step == (NINA, 2)
    QTest.keyClick(lane.plot, Qt.Key.Key_Right)
    assert lane.selected_step == (NINA, 3)


def test_down_dances_another_basic_motion_there_and_backspace_returns_it(lane: DanceLane) -> None:
    before = states(lane)
    tick = lane.dances[MARY].ticks[5]
    click(lane, place(lane, 5))
    QTest.keyClick(lane.plot, Qt.Key.Key_Down)
    requested = (before[5] + 1) % 4
    assert corrections(lane) == (PinState(tick, requested),)
    assert state_at(lane, tick) == requested
    QTest.keyClick(lane.plot, Qt.Key.Key_Down)
    assert corrections(lane) == (PinState(tick, (requested + 1) % 4),)
    assert not corrections(lane, NINA)
    QTest.keyClick(lane.plot, Qt.Key.Key_Backspace)
    assert corrections(lane) == ()
    assert [step.state for step in lane.dances[MARY].steps] == before
    lane.session.document.undo()
    assert corrections(lane) == (PinState(tick, (requested + 1) % 4),)
    assert state_at(lane, tick) == (requested + 1) % 4


def test_a_segment_is_chosen_from_the_menu(lane: DanceLane) -> None:
    dance = lane.dances[MARY]
    tick, before = dance.ticks[6], dance.steps[6]
    menu = menu_at(lane, place(lane, 6))
    child(menu, QMenu, "dance_segments").actions()[0].trigger()
    [used] = corrections(lane)
    assert isinstance(used, UseSegment)
    assert used.tick == tick
    assert used.segment != before.segment
    after = lane.dances[MARY]
    step = after.steps[after.ticks.index(tick)]
    assert (step.segment, step.state) == (used.segment, before.state)
    menu.close()


def test_a_double_click_opens_the_menu_of_a_step(lane: DanceLane) -> None:
    double_click(lane, place(lane, 6))
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu)
    menu.close()
    assert not lane.session.document.done


def test_a_motion_is_dragged_to_other_beats_and_stays_itself(lane: DanceLane) -> None:
    dance = lane.dances[MARY]
    before, tick = dance.steps[6], dance.ticks[6]
    target = dance.places[before.place + 2]
    at = place(lane, 6)
    by_px = lane.axis.x_px(lane.session.project.score.tempo_map.seconds(float(target))) - lane.axis.x_px(
        before.accent_s
    )
    QTest.mousePress(lane.plot, LEFT, pos=at.toPoint())
    QTest.mouseMove(lane.plot, (at + QPointF(0.4 * by_px, 0.0)).toPoint())
    QTest.mouseMove(lane.plot, (at + QPointF(by_px, 0.0)).toPoint())
    assert lane.moving.tick == target
    assert corrections(lane) == ()
    QTest.mouseRelease(lane.plot, LEFT, pos=(at + QPointF(by_px, 0.0)).toPoint())
    assert corrections(lane) == (UseSegment(target, before.segment),)
    after = lane.dances[MARY]
    assert after.steps[after.ticks.index(target)].segment == before.segment
    assert lane.selected_step == (MARY, after.ticks.index(target))
    QTest.keyClick(lane.plot, Qt.Key.Key_Left, SHIFT)
    assert corrections(lane) == (UseSegment(dance.places[before.place + 1], before.segment),)
    lane.session.document.undo()
    lane.session.document.undo()
    assert corrections(lane) == ()
    assert lane.dances[MARY].ticks[6] == tick


def test_escape_ends_a_drag_without_an_edit(lane: DanceLane) -> None:
    at = place(lane, 6)
    QTest.mousePress(lane.plot, LEFT, pos=at.toPoint())
    QTest.mouseMove(lane.plot, (at + QPointF(150.0, 0.0)).toPoint())
    QTest.keyClick(lane.plot, Qt.Key.Key_Escape)
    QTest.mouseRelease(lane.plot, LEFT, pos=(at + QPointF(150.0, 0.0)).toPoint())
    assert lane.moving is None
    assert corrections(lane) == ()


def test_what_is_forbidden_is_not_danced_until_it_is_allowed_again(lane: DanceLane) -> None:
    state = states(lane)[4]
    menu = menu_at(lane, place(lane, 4))
    entries(menu)[f"Disable Basic Motion {state + 1} in This Piece"].trigger()
    menu.close()
    assert [type(item) for item in corrections(lane)] == [ForbidState]
    assert state not in {step.state for step in lane.dances[MARY].steps}
    menu = menu_at(lane, place(lane, 4))
    entries(menu)[f"Allow Basic Motion {state + 1}"].trigger()
    menu.close()
    assert corrections(lane) == ()
    menu = menu_at(lane, place(lane, 4))
    entries(menu)[f"Disable Basic Motion {state + 1} Here"].trigger()
    menu.close()
    [item] = corrections(lane)
    assert isinstance(item, ForbidState)
    assert item.end_tick - item.start_tick < 4 * TPQ
    dance = lane.dances[MARY]
    there = [step.state for step, tick in zip(dance.steps, dance.ticks, strict=True)
             if item.start_tick <= tick < item.end_tick]  # fmt: skip
    assert state not in there


def test_an_unreadable_choreography_is_said_in_its_row_alone(lane: DanceLane, tmp_path: Path) -> None:
    path = tmp_path / "broken.choreography"
    path.write_text("{")
    broken = set_choreography(lane.session.project, (NINA,), path)
    lane.session.document.apply(Message("edit.add_breath", {"of": "1"}), broken)
    assert lane.dances[NINA].error is not None
    assert lane.dances[MARY].steps
    lane.hover(lane.mouse_at(lane.row_rect(1).center()))
    assert "broken.choreography" in lane.plot.toolTip()
    reported: list[str] = []
    lane.session.noticed.connect(lambda message, _: reported.append(message.id))
    double_click(lane, lane.row_rect(1).center())
    assert reported == ["dance.no_step_here"]
