"""Fingerings of a woodwind: a chart at each note, names under the mouse, and alternates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby

import msgspec
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.plan.by_hand.corrections import PinFingering
from app.plan.model import FingeringEvent
from app.score.model import Note
from tests.gui.japanese import speaking
from tests.gui.timeline.conftest import TPQ, scale_project
from tests.gui.timeline.lane_hands import front_plan, planned
from tests.support.mouse import move
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child, show_in_front
from widgets.common.fingering_chip import FingeringChip
from widgets.timeline.lanes.fingering.charts import FingeringCharts
from widgets.timeline.lanes.fingering.fingering_lane import FingeringLane
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.panel import TimelinePanel

LOW_E, D_4, C_5, B_FLAT_5 = 50, 60, 70, 80
"""Sounding pitches: the clarinet in B flat reads them a whole tone higher."""


@pytest.fixture
def panel(qt_app: QApplication, qtbot: QtBot) -> Iterator[TimelinePanel]:
    project = scale_project()
    part, other = project.score.parts
    pitches = (LOW_E, D_4, C_5, B_FLAT_5) * 2
    notes = tuple(Note(f"1:{i}", 2 * TPQ * i, 2 * TPQ - 40, pitch, 80) for i, pitch in enumerate(pitches))
    score = msgspec.structs.replace(project.score, parts=(msgspec.structs.replace(part, notes=notes), other))
    first, second = project.players
    players = (msgspec.structs.replace(first, instrument_id="clarinet_Bb"), second)
    session = Session(replace(project, score=score, players=players), ImmediateTasks())
    planned(session)
    made = TimelinePanel(session)
    qtbot.addWidget(made)
    made.resize(1400, 900)
    show_in_front(made)
    made.axis.show(0.0, 8.0)
    yield made
    session.timeline_view = None
    session.deleteLater()


@pytest.fixture
def lane(panel: TimelinePanel) -> FingeringLane:
    return child(panel, FingeringLane)


def charts_of(lane: FingeringLane) -> FingeringCharts:
    assert lane.charts is not None
    return lane.charts


def event_of(lane: FingeringLane, pitch: int, number: int = 0) -> FingeringEvent:
    notes = [note for note in lane.session.project.score.parts[0].notes if note.pitch == pitch]
    return next(one for one in front_plan(lane.session).fingerings if one.note_id == notes[number].id)


def middle(lane: FingeringLane, event: FingeringEvent) -> QPoint:
    return QPoint(round(float(lane.axis.x_px((event.start_s + event.end_s) / 2))), 20)


def closed(lane: FingeringLane, event: FingeringEvent, colour: str) -> str:
    """Column of the chart as text: "x" where enough pixels for a hole's width have the colour."""
    charts, picture, wanted = charts_of(lane), lane.plot.grab().toImage(), QColor(colour).rgb()
    left, right = (round(float(lane.axis.x_px(time_s))) for time_s in (event.start_s, event.end_s))
    seen = ""
    for key in charts.chart.column:
        row = round(charts.y_px(key.y))
        runs = groupby(picture.pixel(x, row) == wanted for x in range(left, min(right, lane.plot.width())))
        longest = max((len(list(run)) for is_filled, run in runs if is_filled), default=0)
        seen += "x" if longest >= 0.7 * charts.hole_px else "o"
    return seen


def names_under_mouse(lane: FingeringLane, event: FingeringEvent) -> str:
    move(lane.plot, QPoint(2, 2))
    move(lane.plot, middle(lane, event))
    return lane.plot.toolTip().splitlines()[0]


def test_every_note_has_its_chart_in_the_players_colour(lane: FingeringLane) -> None:
    assert lane.session.player is not None
    colour = lane.session.colour(lane.session.player)
    assert closed(lane, event_of(lane, LOW_E), colour) == "xxxxxx"
    assert closed(lane, event_of(lane, D_4), colour) == "xxoooo"
    # The holes are large enough to be read, and all of them are in sight.
    charts = charts_of(lane)
    assert charts.hole_px >= 14.0
    assert charts.y_px(charts.chart.bottom) <= lane.plot.height()
    assert [sign for sign, _ in lane.row_names()] == ["1", "2", "3", "1", "2", "3"]


def test_a_selected_note_has_another_colour(lane: FingeringLane) -> None:
    event = event_of(lane, D_4)
    QTest.mouseClick(lane.plot, Qt.MouseButton.LeftButton, pos=middle(lane, event))
    lane.alternates.hide()
    assert closed(lane, event, lane.session.tokens.accent) == "xxoooo"


def test_short_notes_have_bars_for_the_column(lane: FingeringLane, panel: TimelinePanel) -> None:
    panel.axis.show(0.0, 80.0)
    charts, picture = charts_of(lane), lane.plot.grab().toImage()
    event = event_of(lane, D_4)
    x = middle(lane, event).x()
    rows = [picture.pixel(x, round(charts.y_px(key.y))) for key in charts.chart.column]
    assert rows[0] == rows[1]
    assert rows[2:] == [rows[2]] * 4
    assert rows[0] != rows[2]


def test_the_names_of_the_keys_are_under_the_mouse_in_both_languages(lane: FingeringLane) -> None:
    event = event_of(lane, LOW_E)
    assert names_under_mouse(lane, event).startswith("thumb hole + L1·2·3 + left E/B key + R1·2·3: ")
    with speaking():
        assert "thumb" not in lane.plot.toolTip()
        assert names_under_mouse(lane, event).startswith("親指の穴 + 左1·2·3 + 左の E/B キー + 右1·2·3: ")
    assert names_under_mouse(lane, event).startswith("thumb hole")


def test_alternates_are_charts_and_one_is_pinned_by_a_click(lane: FingeringLane) -> None:
    event = event_of(lane, LOW_E)
    QTest.mouseClick(lane.plot, Qt.MouseButton.LeftButton, pos=middle(lane, event))
    chips = {chip.objectName(): chip for chip in lane.alternates.findChildren(FingeringChip) if chip.isVisible()}
    right = chips["chip_L1 L2 L3 R1 R2 R3 RE T"]
    assert right.accessibleName() == "thumb hole + L1·2·3 + R1·2·3 + right E/B key alternate"
    assert right.toolTip().startswith(right.text())
    assert right.height() > 60
    assert right.grab().toImage() != chips["chip_L1 L2 L3 LE R1 R2 R3 T"].grab().toImage()
    QTest.mouseClick(right, Qt.MouseButton.LeftButton)
    pin = PinFingering(event.note_id, "L1 L2 L3 R1 R2 R3 RE T")
    assert lane.session.project.corrections[front_plan(lane.session).player_id] == (pin,)
    # Anything but the first choice is emphasised.
    assert closed(lane, event_of(lane, LOW_E), lane.session.tokens.accent) == "xxxxxx"


def test_the_menu_offers_fingerings_in_words(lane: FingeringLane) -> None:
    event, x = event_of(lane, LOW_E), float(middle(lane, event_of(lane, LOW_E)).x())
    menu = lane.context_menu(LaneMouse(x, 20.0, (event.start_s + event.end_s) / 2, 0.5, 0.0, 0))
    assert menu is not None
    assert menu.actions()[1].text() == "thumb hole + L1·2·3 + R1·2·3 + right E/B key   alternate"


def test_each_picture_is_drawn_once(lane: FingeringLane, panel: TimelinePanel) -> None:
    lane.plot.grab()
    charts = charts_of(lane)
    known = dict(charts._pictures)
    assert 0 < len(known) <= 4
    panel.axis.show(1.0, 9.0)
    lane.plot.grab()
    assert {key: charts._pictures[key] for key in known} == known
    assert len(charts._pictures) <= 4


def test_the_lane_is_as_tall_as_its_player_needs(lane: FingeringLane, panel: TimelinePanel) -> None:
    session = lane.session
    clarinet, trumpet = (player.id for player in session.project.players)
    tall = lane.height()
    session.set_players((trumpet,))
    assert lane.charts is None
    assert lane.height() < tall
    assert [sign for sign, _ in lane.row_names()] == ["1", "2", "3"]
    session.set_players((clarinet,))
    assert lane.height() == tall
