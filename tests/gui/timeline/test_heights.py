"""Heights of lanes and rows: legible by default, changed by wheel and keys, and scrolled into view when opened."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.editor.selection import Selection
from app.errors import Message
from tests.gui.timeline.conftest import TPQ, Stage
from tests.gui.timeline.hand import CTRL, SHIFT, Hand
from widgets.timeline.lane import Lane
from widgets.timeline.lanes.acting.acting_lane import ActingLane
from widgets.timeline.model.roll.shown_notes import AIR_ROWS, LEAST_ROWS, LEGIBLE_ROW_PX, legible_pitches
from widgets.timeline.panel import TimelinePanel

CTRL_SHIFT = CTRL | SHIFT


def settle() -> None:
    for _ in range(3):
        QApplication.processEvents()


def is_seen(panel: TimelinePanel, lane: Lane) -> bool:
    """Return whether a lane is visible from top to bottom, or fills the visible area."""
    room = panel.stack.viewport()
    top = lane.mapTo(room, lane.rect().topLeft()).y()
    return top >= 0 and (top + lane.height() <= room.height() or top == 0)


@given(
    st.lists(st.integers(20, 108), min_size=1, max_size=40), st.floats(60.0, 900.0), st.sampled_from((0.0, AIR_ROWS))
)
def test_as_many_notes_as_possible_are_shown_8_px_high(pitches: list[int], room_px: float, air: float) -> None:
    bottom, top = legible_pitches(np.array(pitches), air, room_px)
    rows = room_px / LEGIBLE_ROW_PX
    assert top - bottom <= max(rows, LEAST_ROWS) + 1e-9

    def seen(low: float) -> int:
        return sum(low <= pitch and pitch + 1 <= low + (top - bottom) + 1e-9 for pitch in pitches)

    if max(pitches) + 1 + air - min(pitches) <= rows:
        assert seen(bottom) == len(pitches)
    # No window of whole rows would show more.
    assert seen(bottom) == max(seen(low) for low in range(128))


def test_ctrl_shift_wheel_zooms_pitches_about_the_mouse_and_changes_heights_of_lanes(stage: Stage) -> None:
    roll, span_s = stage.roll, stage.panel.axis.span_s
    row_px, place = roll.row_px, stage.place(TPQ, 64)
    stage.hand.wheel(place, 2, CTRL_SHIFT)
    assert roll.row_px > 1.3 * row_px
    assert roll.y_px(64.5) == pytest.approx(place[1], abs=0.5)
    stage.hand.wheel(place, -2, CTRL_SHIFT)
    assert roll.row_px == pytest.approx(row_px)
    breath = stage.panel.lanes["breath"]
    height = breath.height()
    Hand(breath.plot).wheel((200.0, 10.0), 3, CTRL_SHIFT)
    settle()
    assert breath.height() == height + 24
    assert stage.panel.stack.heights_px == {"breath": height + 24}
    Hand(breath.plot).wheel((200.0, 10.0), -20, CTRL_SHIFT)
    settle()
    assert breath.height() == breath.least_height_px
    assert stage.panel.axis.span_s == span_s


def test_keys_zoom_pitches_about_what_is_selected(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:0"})))
    row_px, y = stage.roll.row_px, stage.roll.y_px(60.5)
    stage.table.attach("window", stage.panel)
    stage.table.refresh()
    QTest.keyClick(stage.roll.plot, Qt.Key.Key_Up, CTRL_SHIFT)
    assert stage.roll.row_px == pytest.approx(1.4 * row_px)
    assert stage.roll.y_px(60.5) == pytest.approx(y, abs=0.5)
    QTest.keyClick(stage.roll.plot, Qt.Key.Key_Down, CTRL_SHIFT)
    assert stage.roll.row_px == pytest.approx(row_px)
    # The whole piece, and all pitches in it.
    stage.do("timeline.fit")
    bottom, top = stage.roll.y_range
    assert bottom <= 57
    assert top >= 73


def test_pitches_that_someone_chose_stay_when_lanes_get_other_heights(stage: Stage) -> None:
    roll = stage.roll
    stage.panel.resize(1200, 560)
    settle()
    assert roll.row_px >= LEGIBLE_ROW_PX - 0.1
    stage.hand.wheel(stage.place(TPQ, 64), -2, CTRL_SHIFT)
    chosen = roll.y_range
    stage.panel.resize(1200, 700)
    settle()
    assert roll.y_range == chosen


@pytest.mark.parametrize("lane_id", ["curves", "additive", "problems"])
def test_a_lane_that_is_opened_is_scrolled_to(stage: Stage, lane_id: str) -> None:
    panel = stage.panel
    panel.resize(1200, 330)
    panel.fold_lanes(False)
    lane = panel.lanes[lane_id]
    panel.stack.verticalScrollBar().setValue(0)
    settle()
    panel.open_lane(lane_id, False)
    panel.stack.verticalScrollBar().setValue(0)
    settle()
    assert not is_seen(panel, lane)
    stage.do(f"lanes.{lane_id}")
    settle()
    assert is_seen(panel, lane)
    # By its button too: only its title is in sight before.
    lane.set_folded(True)
    panel.resize(1200, 330)
    settle()
    panel.stack.ensureWidgetVisible(lane)
    QTest.mouseClick(lane.fold_button, Qt.MouseButton.LeftButton)
    settle()
    assert is_seen(panel, lane)


def test_the_acting_lane_shows_every_row(panel: TimelinePanel) -> None:
    lane = panel.lanes["acting"]
    assert isinstance(lane, ActingLane)
    panel.resize(1200, 420)
    for player in panel.session.project.players:
        panel.session.set_players((player.id,))
        settle()
        assert lane.rows > 5
        top, height = lane.row_box(lane.rows - 1)
        assert lane.row_box(0)[0] == 0.0
        assert height >= lane.least_row_px
        assert top + height <= lane.plot_rect.height() + 0.5


def test_notes_elsewhere_are_brought_into_view(stage: Stage) -> None:
    roll = stage.roll
    roll.choose_pitches(100.0, 120.0)
    stage.session.select(Selection(frozenset({"1:3"})))
    stage.session.revealed.emit(1.5)
    bottom, top = roll.y_range
    assert bottom <= 65 < top - 1
    assert top - bottom == 20.0
    roll.choose_pitches(100.0, 120.0)
    roll.follow()
    assert roll.y_range[0] < 66


def test_ghosts_have_one_faint_colour_whoever_plays_them(stage: Stage) -> None:
    session, roll = stage.session, stage.roll

    def ghost() -> str:
        # The second player's first note, a third below.
        x, y = stage.place(TPQ / 2, 57)
        return roll.plot.grab().toImage().pixelColor(round(x), round(y)).name()

    before = ghost()
    front, behind = session.project.players
    red = (front, msgspec.structs.replace(behind, colour="#ff0000"))
    session.apply(Message("edit.player_colour", {"of": "Trumpet 1"}), replace(session.project, players=red))
    settle()
    assert ghost() == before
    stage.do("timeline.all")
    assert ghost() == "#ff0000"
    stage.do("timeline.selected")
    assert ghost() not in (before, "#ff0000")
    session.set_players((front.id, behind.id))
    assert ghost() == before
    stage.do("timeline.alone")
    assert ghost() not in (before, "#ff0000")


def test_notes_above_and_below_are_marked_at_the_edges(stage: Stage) -> None:
    roll = stage.roll

    def edges() -> list[str]:
        picture = roll.plot.grab().toImage()
        x = int(stage.middle("1:2")[0]) + 2
        return [picture.pixelColor(x, y).name() for y in (1, picture.height() - 2)]

    colour = stage.session.colour(stage.session.project.players[0])
    roll.choose_pitches(58.0, 74.0)
    assert colour not in edges()
    roll.choose_pitches(100.0, 120.0)
    assert [one == colour for one in edges()] == [False, True]
    roll.choose_pitches(20.0, 40.0)
    assert [one == colour for one in edges()] == [True, False]
