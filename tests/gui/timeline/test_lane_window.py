"""Lanes in the whole editor, where plans arrive later from the background."""

from __future__ import annotations

import re

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from app.editor.selection import Selection
from app.plan.by_hand.corrections import PinFingering, SetBreath
from app.plan.model import PlayerPlan
from app.shell.app import Program
from tests.gui.shell.conftest import answers, program, settings, start  # noqa: F401  (fixtures)
from tests.gui.timeline.lane_hands import ALT, drag, middle, region_of
from tests.support.windows import child
from widgets.common.actions import actions
from widgets.timeline.lanes.breath import BreathLane
from widgets.timeline.panel import TimelinePanel


@pytest.fixture
def panel(program: Program, qtbot: QtBot) -> TimelinePanel:  # noqa: F811
    result = program.window.findChild(TimelinePanel)
    assert isinstance(result, TimelinePanel)
    qtbot.waitUntil(lambda: program.session.performance.planned)
    result.axis.show(0.0, 20.0)
    return result


def plan(program: Program) -> PlayerPlan:  # noqa: F811
    assert program.session.player is not None
    return program.session.performance.plan(program.session.player)


def up_to_date(program: Program, qtbot: QtBot) -> None:  # noqa: F811
    session = program.session
    qtbot.waitUntil(lambda: session.performance.planned and session.performance.project is session.project)


def test_a_breath_is_dragged_while_plans_are_made_elsewhere(
    program: Program,  # noqa: F811
    panel: TimelinePanel,
    qtbot: QtBot,
) -> None:
    lane = child(panel, BreathLane)
    breath = next(event.id for event in plan(program).breaths if event.kind == "breath" and event.start_s > 1.0)
    before = region_of(lane, breath)
    drag(lane, middle(lane, breath), dx=-40, modifiers=ALT)
    items = program.session.project.corrections[plan(program).player_id]
    assert {item.kind for item in items if isinstance(item, SetBreath)} == {"breath", "preparation"}
    up_to_date(program, qtbot)
    (key,) = program.session.selection.events
    after = region_of(lane, key.event_id)
    assert after.by_hand
    assert after.end_tick - after.start_tick == before.end_tick - before.start_tick
    assert list(lane.visible(0.0, 1e6)).count(after) == 1
    qtbot.waitUntil(actions(program.session)["edit.undo"].isEnabled)
    undo = actions(program.session)["edit.undo"]
    assert re.fullmatch(r"Undo: Move Breath \(Trumpet 1 · \d+\.\d+\.\d+\)", undo.text())
    actions(program.session)["edit.undo"].trigger()
    assert not program.session.project.corrections
    up_to_date(program, qtbot)
    assert region_of(lane, breath).start_tick == before.start_tick


def test_keys_reach_the_lanes_in_the_window(
    program: Program,  # noqa: F811
    panel: TimelinePanel,
    qtbot: QtBot,
) -> None:
    session = program.session
    assert session.player is not None
    instrument = session.performance.instrument(session.player)
    note = next(
        note
        for note in session.project.part(session.player).notes
        if {"0", "13"} <= {fingering.label for fingering in instrument.fingerings_for(note.pitch)}
    )
    plot = panel.lanes["fingering"].plot
    plot.setFocus()
    session.select(Selection(notes=frozenset({note.id})))
    qtbot.waitUntil(actions(session)["fingering.cycle"].isEnabled)
    QTest.keyClick(plot, Qt.Key.Key_1)
    QTest.keyClick(plot, Qt.Key.Key_3)
    assert session.project.corrections[session.player.id] == (PinFingering(note.id, "13"),)
    up_to_date(program, qtbot)
    qtbot.waitUntil(actions(session)["events.give_back"].isEnabled)
    QTest.keyClick(plot, Qt.Key.Key_Backspace)
    assert not session.project.corrections


def test_what_is_dropped_on_a_lane_reaches_the_window(
    program: Program,  # noqa: F811
    panel: TimelinePanel,
) -> None:
    assert program.window.acceptDrops()
    for lane in panel.lanes.values():
        widget: QWidget | None = lane.plot
        while widget is not None and not widget.acceptDrops():
            widget = widget.parentWidget()
        assert widget is program.window, lane.id
