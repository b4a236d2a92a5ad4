"""The lane of curves shows the recorded values within notes."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.errors import Message
from app.project.edit.dynamics import set_dynamics
from app.project.model import project_from_score
from app.score.model import ControllerCurve, Score
from instrument_maps.load import bundled_maps
from tests.gui.timeline.lane_hands import ALT, drag, shown_panel
from tests.support.blown import TEMPO, Blow, breath_curve, take, vibrato_curve
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child
from widgets.timeline.lanes.curves import CurvesLane
from widgets.timeline.zoom_and_scroll import TimeAxis

SWELL = Blow(0.99, 5.0, lambda s: 0.25 + 0.7 * np.minimum(s / 4.0, 1.0))


def test_what_was_blown_is_drawn_within_the_notes(qt_app: QApplication, tasks: ImmediateTasks, qtbot: QtBot) -> None:
    curves = (breath_curve([SWELL, Blow(6.0, 8.0)]), vibrato_curve(6.0, 8.0, 0.1, 5.0, "bite", 0.5))
    part = take([(1.0, 5.0, 65), (6.0, 8.0, 67)], *curves)
    session = Session(project_from_score(Score("Take", 480, TEMPO, parts=(part,)), bundled_maps()), tasks)
    session.performance.prepare()
    lane = CurvesLane(session, TimeAxis())
    qtbot.addWidget(lane)
    lane.refresh()
    choices = [lane.choice.itemData(index) for index in range(lane.choice.count())]
    assert choices == ["tension", "effort", "air", "breath", "bite"]
    assert all(lane.choice.itemText(index) for index in range(lane.choice.count()))
    air = lane.lips.traces["air"]
    assert air.at(1.5) is not None
    assert air.at(4.5) > 2.0 * air.at(1.5)
    assert np.isnan(air.at(5.5)), "nothing between the notes"


def test_a_controller_is_corrected_at_chosen_notes_and_at_one_place(session: Session, qtbot: QtBot) -> None:
    panel = shown_panel(session)
    qtbot.addWidget(panel)
    assert session.player is not None
    part = session.project.part(session.player)
    ticks = tuple(range(0, part.notes[-1].end_tick, 120))
    curve = ControllerCurve("breath", ticks, tuple(0.5 + 0.1 * (number % 2) for number in range(len(ticks))))
    session.apply(Message("edit.follow_recording"), set_dynamics(session.project, {part.id: curve}))
    session.document.end_gesture()
    lane = child(panel, CurvesLane)
    lane.set_curve("breath")
    note = next(note for note in part.notes if note.duration_tick >= 480 and note.onset_tick > 960)

    def value(tick: int) -> float:
        assert session.player is not None
        steps = next(one for one in session.project.part(session.player).curves if one.kind == "breath")
        return steps.values[int(np.searchsorted(steps.ticks, tick, side="right")) - 1]

    clock, height = session.project.score.tempo_map, lane.plot.height() - 8
    middle = (note.onset_tick + note.end_tick) // 2
    lane.axis.reveal(clock.seconds(float(middle)))
    place = QPointF(lane.axis.x_px(clock.seconds(float(middle))), 30.0)
    before, steps = value(middle), len(session.document.done)
    drag(lane, place, dy=-height * 0.2)
    assert value(middle) == pytest.approx(before + 0.2, abs=0.05)
    assert value(note.onset_tick - 1920) == pytest.approx(0.5, abs=0.11), "far away it stays"
    assert len(session.document.done) == steps + 1
    session.document.undo()
    drag(lane, place, dy=height * 0.2, modifiers=ALT)
    assert value(middle) == pytest.approx(before - 0.2, abs=0.05)
    assert session.document.done[-1].name.id == "edit.change_level"
