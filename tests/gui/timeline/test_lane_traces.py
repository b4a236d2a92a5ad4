"""The lane of curves shows what was recorded within the notes."""

from __future__ import annotations

import numpy as np
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.project.model import project_from_score
from app.score.model import Score
from instrument_maps.load import bundled_maps
from tests.support.blown import TEMPO, Blow, breath_curve, take, vibrato_curve
from tests.support.tasks import ImmediateTasks
from widgets.timeline.axis import TimeAxis
from widgets.timeline.lanes.curves import CurvesLane

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
    assert lane.lips is not None
    air = lane.lips.traces["air"]
    assert air.at(1.5) is not None
    assert air.at(4.5) > 2.0 * air.at(1.5)  # type: ignore[operator]
    assert np.isnan(air.at(5.5)), "nothing between the notes"  # type: ignore[arg-type]
