"""Lanes of several players below each other, by mouse and keys: each shows and edits its own player."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel, QToolButton
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.editor.settings import Settings
from app.editor.timeline_view import Tool
from app.project.edit.players import duplicate_players
from app.shell.actions import ActionTable
from app.shell.commands import edit, events, fingerings, notes, timeline
from tests.gui.timeline.hand import CTRL, Hand
from tests.gui.timeline.lane_hands import middle
from tests.support.windows import child, show_in_front
from widgets.timeline.lane_layout import lane_state
from widgets.timeline.lanes.breath import BreathLane
from widgets.timeline.lanes.fingering.fingering_lane import FingeringLane
from widgets.timeline.model.roll.shown_notes import LEGIBLE_ROW_PX
from widgets.timeline.panel import TimelinePanel
from widgets.timeline.stacked_players import HEIGHTS_PX, MOST_STACKED, PlayerLanes, StackedPlayers


@pytest.fixture
def table(session: Session, tmp_path: Path) -> ActionTable:
    rows = [*edit.ACTIONS, *events.ACTIONS, *notes.ACTIONS, *fingerings.ACTIONS, *timeline.ACTIONS]
    return ActionTable(session, Settings(tmp_path / "editor.toml"), rows)


@pytest.fixture
def stacked(panel: TimelinePanel, session: Session, table: ActionTable) -> TimelinePanel:
    """Lanes of the second, third and fourth player, the third selected first."""
    table.attach("timeline", panel)
    ids = player_ids(session)
    session.set_players((ids[2], ids[1], ids[3]))
    do(table, "lanes.stacked")
    QApplication.processEvents()
    return panel


def do(table: ActionTable, action_id: str) -> None:
    table.refresh()
    assert table.actions[action_id].isEnabled(), action_id
    table.actions[action_id].trigger()
    QApplication.processEvents()


def player_ids(session: Session) -> tuple[str, ...]:
    return tuple(player.id for player in session.project.players)


def of(panel: TimelinePanel, player_id: str) -> PlayerLanes:
    return next(place for place in panel.players.shown if place.session.player_id == player_id)


def note_place(place: PlayerLanes, number: int = 0) -> tuple[str, tuple[float, float]]:
    """A visible note of a player's roll, and the centre of its box."""
    front = place.roll.model.front()
    assert front is not None
    table, _ = front
    bottom, top = place.roll.y_range
    inside = [
        at
        for at in range(len(table))
        if 0.0 < table.onset_s[at] < 20.0
        and bottom + 1 < table.pitch[at] < top - 2
        and table.end_s[at] > table.onset_s[at] + 0.15
    ]
    at = inside[number]
    time_s = (table.onset_s[at] + table.end_s[at]) / 2
    return table.part.notes[at].id, (place.roll.axis.x_px(float(time_s)), place.roll.y_px(table.pitch[at] + 0.5))


def pitch_of(session: Session, note_id: str) -> int:
    return next(note.pitch for part in session.project.score.parts for note in part.notes if note.id == note_id)


def test_the_lanes_of_the_selected_players_stand_in_the_order_of_the_project(
    stacked: TimelinePanel, session: Session
) -> None:
    ids = player_ids(session)
    assert [place.session.player_id for place in stacked.players.shown] == [ids[1], ids[2], ids[3]]
    assert not stacked.roll.isVisible(), "its place is taken"
    tops = []
    for place in stacked.players.shown:
        assert place.caption.accessibleName() == session.project.player(place.session.player_id).name
        front = place.roll.model.front()
        assert front is not None
        assert front[0].part.id == session.project.player(place.session.player_id).part_id
        rows = [place.caption, *place.lanes.values()]
        assert all(widget.isVisible() for widget in rows)
        tops += [widget.y() for widget in rows]
        assert all(lane.height() >= lane.least_height_px for lane in place.lanes.values())
    assert tops == sorted(tops)
    breath = of(stacked, ids[3]).lanes[BreathLane.id]
    assert isinstance(breath, BreathLane)
    assert {region.player_id for region in breath.regions} == {ids[3]}


def test_a_note_is_selected_dragged_and_undone_in_the_roll_of_a_player_behind(
    stacked: TimelinePanel, session: Session, table: ActionTable
) -> None:
    ids, before = player_ids(session), session.project
    place = of(stacked, ids[3])
    heights = [one.roll.height() for one in stacked.players.shown]
    note_id, (x, y) = note_place(place)
    pitch = pitch_of(session, note_id)
    Hand(place.roll.plot).drag((x, y), (x, y - 2 * place.roll.row_px))
    assert pitch_of(session, note_id) == pitch + 2
    assert session.selection.notes == {note_id}
    assert session.players[0] == ids[3], "commands are about this player now"
    assert {*session.players} == {*ids[1:]}
    assert [one.roll.height() for one in stacked.players.shown] == heights, "nothing moves away under the mouse"
    do(table, "edit.undo")
    assert session.project == before
    do(table, "edit.delete")
    assert (
        len(session.project.part(session.project.player(ids[3])).notes)
        == len(before.part(before.player(ids[3])).notes) - 1
    )


def test_a_breath_and_a_fingering_are_edited_in_lanes_of_a_player_behind(
    stacked: TimelinePanel, session: Session, table: ActionTable
) -> None:
    ids = player_ids(session)
    place = of(stacked, ids[1])
    breath = place.lanes[BreathLane.id]
    assert isinstance(breath, BreathLane)
    event = next(
        event for event in session.plans[ids[1]].breaths if 1.0 < event.start_s < 20.0 and event.kind == "breath"
    )
    at = middle(breath, event.id)
    Hand(breath.plot).drag((at.x(), at.y()), (at.x() + 12.0, at.y()))
    assert session.document.done[-1].name.id == "edit.move_event"
    assert {key.player_id for key in session.selection.events} == {ids[1]}
    assert session.project.corrections.keys() == {ids[1]}
    fingering = place.lanes[FingeringLane.id]
    assert isinstance(fingering, FingeringLane)
    first = session.plans[ids[1]].fingerings[0]
    Hand(fingering.plot).click((fingering.axis.x_px(first.start_s) + 3.0, 8.0))
    assert session.selection.notes == {first.note_id}
    assert fingering.alternates.isVisible()
    fingering.alternates.hide()
    do(table, "fingering.cycle")
    assert len(session.project.corrections[ids[1]]) >= 2


def test_the_menu_of_a_lane_is_about_its_player(stacked: TimelinePanel, session: Session) -> None:
    place = of(stacked, player_ids(session)[3])
    note_id, (x, y) = note_place(place)
    Hand(place.roll.plot).press((x, y), Qt.MouseButton.RightButton)
    menu = QApplication.activePopupWidget()
    assert menu is not None
    assert "notes.split" in {action.objectName() for action in menu.actions()}
    menu.close()
    assert session.selection.notes == {note_id}
    assert session.players[0] == player_ids(session)[3]


def test_a_player_is_muted_and_put_in_front_at_the_caption(stacked: TimelinePanel, session: Session) -> None:
    ids = player_ids(session)
    place = of(stacked, ids[3])
    QTest.mouseClick(child(place.caption, QToolButton, "stacked_muted"), Qt.MouseButton.LeftButton)
    assert [player.muted for player in session.project.players] == [False, False, False, True]
    session.document.undo()
    assert not child(place.caption, QToolButton, "stacked_muted").isChecked()
    assert session.players[0] == ids[2]
    QTest.mouseClick(place.caption, Qt.MouseButton.LeftButton, pos=QPoint(40, 10))
    assert session.players == (ids[3], ids[2], ids[1])


def test_the_stack_follows_who_is_selected(stacked: TimelinePanel, session: Session, table: ActionTable) -> None:
    ids = player_ids(session)

    def shown() -> tuple[str, ...]:
        return tuple(place.session.player_id for place in stacked.players.shown)

    session.set_players((ids[1],))
    assert shown() == ids[1:], "one of them: only in front"
    session.set_players((ids[0],))
    assert shown() == ()
    assert stacked.roll.isVisible()
    session.set_players((ids[0], ids[3]))
    assert shown() == (ids[0], ids[3])
    do(table, "lanes.stacked")
    assert shown() == ()
    session.set_players((ids[0], ids[2]))
    assert shown() == ()
    do(table, "lanes.stacked")
    session.document.open(session.project.__class__(session.project.score, session.project.players[:1]))
    assert shown() == ()


def test_of_many_players_the_first_and_the_one_in_front_are_stacked(stacked: TimelinePanel, session: Session) -> None:
    for _ in range(2):
        session.document.open(duplicate_players(session.project, player_ids(session))[0])
    ids = player_ids(session)
    assert len(ids) == 16
    session.set_players((ids[-1], *ids[:-1]))
    assert [place.session.player_id for place in stacked.players.shown] == [*ids[: MOST_STACKED - 1], ids[-1]]
    left_out = child(stacked, QLabel, "stacked_players_left_out")
    assert left_out.isVisible()
    assert left_out.text().startswith("8 more players are selected")
    stacked.stack.verticalScrollBar().setValue(stacked.stack.verticalScrollBar().maximum())
    assert left_out.geometry().bottom() <= stacked.players.height()
    session.set_players(ids[:8])
    assert not left_out.isVisible()


def test_open_lanes_tools_and_zoom_are_those_of_the_timeline(
    stacked: TimelinePanel, session: Session, table: ActionTable
) -> None:
    do(table, "lanes.fingering")
    for place in stacked.players.shown:
        assert not place.lanes[FingeringLane.id].isVisible()
        assert place.roll.isVisible()
    do(table, "lanes.fingering")
    assert all(place.lanes[FingeringLane.id].isVisible() for place in stacked.players.shown)
    do(table, "notes.tool_erase")
    assert {place.roll.tool for place in stacked.players.shown} == {Tool.ERASE} == {stacked.roll.tool}
    rows = [place.roll.y_range[1] - place.roll.y_range[0] for place in stacked.players.shown]
    stacked.zoom_in_pitch()
    assert all(
        place.roll.y_range[1] - place.roll.y_range[0] <= before
        for place, before in zip(stacked.players.shown, rows, strict=True)
    )


def test_who_comes_to_the_front_is_brought_into_view(
    stacked: TimelinePanel, session: Session, table: ActionTable
) -> None:
    stacked.resize(stacked.width(), 420)
    QApplication.processEvents()
    last = stacked.players.shown[-1].roll
    window = stacked.stack.viewport()

    def in_view() -> bool:
        top = last.mapTo(window, QPoint(0, 0)).y()
        return top >= 0 and top + last.height() <= window.height()

    assert not in_view()
    session.set_players((player_ids(session)[3],))
    assert in_view()
    table.refresh()
    assert not table.actions["timeline.ghosts"].isEnabled(), "each roll shows one player"


def test_the_keyboard_goes_with_the_player_in_front(
    stacked: TimelinePanel, session: Session, table: ActionTable
) -> None:
    ids = player_ids(session)
    show_in_front(stacked)
    lane = of(stacked, ids[1]).lanes[FingeringLane.id]
    lane.plot.setFocus()
    assert session.players[0] == ids[1]
    session.set_players((ids[3],))
    assert of(stacked, ids[3]).lanes[FingeringLane.id].plot.hasFocus(), "the same lane of that player"
    assert session.players == (ids[3],)
    do(table, "lanes.stacked")
    assert stacked.lanes[FingeringLane.id].plot.hasFocus()
    session.set_players((ids[3], ids[2]))
    do(table, "lanes.stacked")
    assert of(stacked, ids[3]).lanes[FingeringLane.id].plot.hasFocus()
    session.set_players((ids[0],))
    assert stacked.lanes[FingeringLane.id].plot.hasFocus()


def test_stacking_is_kept_with_the_lanes(stacked: TimelinePanel, session: Session, qtbot: QtBot) -> None:
    ids = player_ids(session)
    breaths = of(stacked, ids[2]).lanes[BreathLane.id]
    before = breaths.height()
    breaths.resized_by_hand.emit(30)
    of(stacked, ids[3]).lanes[FingeringLane.id].set_folded(True)
    QApplication.processEvents()
    assert breaths.height() == before + 30
    state = lane_state(stacked.save_state())
    assert state is not None
    assert state.stacked

    # Others have lanes of their own.
    session.set_players((ids[0], ids[1]))
    assert not any(place.lanes[FingeringLane.id].folded for place in stacked.players.shown)
    of(stacked, ids[0]).lanes[BreathLane.id].resized_by_hand.emit(-30)
    stacked.set_stacked(False)
    assert not stacked.players.active
    stacked.restore_state(state)
    session.set_players((ids[2], ids[1], ids[3]))
    QApplication.processEvents()
    assert child(stacked, StackedPlayers).isVisible()
    assert of(stacked, ids[1]).lanes[BreathLane.id].height() == before + 30
    folded = {place.session.player_id: place.lanes[FingeringLane.id].folded for place in stacked.players.shown}
    assert folded == {ids[1]: False, ids[2]: False, ids[3]: True}


def test_notes_of_two_players_are_legible_and_their_breaths_in_sight(
    panel: TimelinePanel, session: Session, table: ActionTable
) -> None:
    panel.resize(1290, 444)
    table.attach("window", panel)
    session.set_players(player_ids(session)[:2])
    table.refresh()
    panel.activateWindow()
    QTest.qWaitForWindowActive(panel)
    QTest.keyClick(panel.roll.plot, Qt.Key.Key_S, CTRL | Qt.KeyboardModifier.AltModifier)
    QApplication.processEvents()
    assert len(panel.players.shown) == 2
    room = panel.stack.viewport()
    for place in panel.players.shown:
        assert place.roll.row_px >= LEGIBLE_ROW_PX - 0.01, "a note is 8 pixels high"
        breath = place.lanes[BreathLane.id]
        top = breath.mapTo(room, QPoint(0, 0)).y()
        assert 0 <= top < top + breath.height() <= room.height()
        assert breath.height() >= breath.least_height_px
    # The lanes stay visible, whichever player is selected first.
    QTest.mouseClick(panel.players.shown[1].caption, Qt.MouseButton.LeftButton, pos=QPoint(40, 10))
    QApplication.processEvents()
    assert session.players[0] == player_ids(session)[1]
    assert panel.stack.verticalScrollBar().value() == panel.players.y()
    # Lanes of three have their usual heights, and are scrolled to.
    session.set_players(player_ids(session)[:3])
    QApplication.processEvents()
    assert all(place.roll.row_px >= LEGIBLE_ROW_PX - 0.01 for place in panel.players.shown)
    assert panel.players.shown[0].lanes[FingeringLane.id].height() == HEIGHTS_PX[FingeringLane.id]
    assert panel.stack.verticalScrollBar().maximum() > 0
