"""Breaths, cues, gestures and expressions by mouse and keys, compared with the project."""

from __future__ import annotations

from itertools import pairwise

import pytest
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPixmap
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu

from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.by_hand.corrections import (
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    PoseCorrection,
    RemoveEvent,
    SetBreath,
    SetCue,
)
from app.project.edit import events as edit
from app.project.edit.corrections import with_corrections
from tests.gui.timeline.lane_hands import (
    ALT,
    CTRL,
    LEFT,
    click,
    double_click,
    drag,
    front_plan,
    middle,
    move_to,
    region_of,
    viewport,
)
from tests.support.windows import child
from widgets.timeline.lanes.acting.acting_lane import ActingLane
from widgets.timeline.lanes.breath import BreathLane
from widgets.timeline.model.regions.shown_regions import LEAST_REGION_PX
from widgets.timeline.panel import TimelinePanel
from widgets.timeline.roll.piano_roll import PianoRoll


def breath_lane(panel: TimelinePanel) -> BreathLane:
    return child(panel, BreathLane)


def acting_lane(panel: TimelinePanel) -> ActingLane:
    return child(panel, ActingLane)


def corrections(session: Session) -> tuple[object, ...]:
    return session.project.corrections.get(session.player.id, ())


def second_breath(session: Session) -> str:
    """The second visible breath in a rest."""
    return [event.id for event in front_plan(session).breaths if event.kind == "breath"][2]


def test_a_click_selects_and_ctrl_adds(panel: TimelinePanel, session: Session) -> None:
    lane = breath_lane(panel)
    first, second = [event.id for event in front_plan(session).breaths if event.kind == "breath"][1:3]
    player = front_plan(session).player_id
    click(lane, middle(lane, first))
    assert session.selection.events == {EventKey(player, first)}
    click(lane, middle(lane, second), CTRL)
    assert session.selection.events == {EventKey(player, first), EventKey(player, second)}
    click(lane, QPointF(lane.axis.x_px(8.0), 4.0))
    assert not session.selection.events


def test_a_breath_is_dragged_in_one_step_and_its_key_follows(panel: TimelinePanel, session: Session) -> None:
    lane, breath = breath_lane(panel), second_breath(session)
    before = region_of(lane, breath)
    drag(lane, middle(lane, breath), dx=-30, modifiers=ALT)
    (correction,) = corrections(session)
    assert isinstance(correction, SetBreath)
    assert len(session.document.done) == 1
    (key,) = session.selection.events
    after = region_of(lane, key.event_id)
    assert after.start_s == pytest.approx(before.start_s - 30 / lane.axis.px_per_s, abs=0.02)
    assert after.end_tick - after.start_tick == before.end_tick - before.start_tick
    assert after.by_hand
    session.document.undo()
    assert region_of(lane, breath) == before


def test_a_drag_back_to_its_start_is_no_step(panel: TimelinePanel, session: Session) -> None:
    lane, breath = breath_lane(panel), second_breath(session)
    project = session.project
    place = middle(lane, breath)
    drag(lane, place, dx=40, modifiers=ALT, release=False)
    assert session.project is not project
    move_to(viewport(lane), place, ALT)
    QTest.mouseRelease(viewport(lane), LEFT, ALT, place)
    assert session.project is project
    assert not session.document.done


def test_escape_takes_a_drag_back(panel: TimelinePanel, session: Session) -> None:
    lane, breath = breath_lane(panel), second_breath(session)
    project = session.project
    drag(lane, middle(lane, breath), dx=50, release=False)
    assert session.project is not project
    QTest.keyClick(viewport(lane), Qt.Key.Key_Escape)
    assert session.project is project
    assert not session.document.done
    assert session.selection.events == {EventKey(front_plan(session).player_id, breath)}


def test_dragging_up_and_down_changes_the_depth(panel: TimelinePanel, session: Session) -> None:
    lane, breath = breath_lane(panel), second_breath(session)
    before = region_of(lane, breath).amount
    drag(lane, middle(lane, breath), dy=lane.box(region_of(lane, breath)).height() * 0.2)
    (correction,) = corrections(session)
    assert isinstance(correction, SetBreath)
    assert correction.depth == pytest.approx(before - 0.2, abs=0.05)
    assert len(session.document.done) == 1


def test_an_edge_resizes_and_snaps(panel: TimelinePanel, session: Session) -> None:
    panel.axis.show(20.0, 26.0)
    lane = breath_lane(panel)
    breath = next(
        region.event_id
        for region in lane.regions
        if region.kind == "breath" and region.start_s > 21.0 and lane.box(region).width() > 40
    )
    before = region_of(lane, breath)
    box = lane.box(before)
    drag(lane, QPointF(box.left() + 2, box.center().y()), dx=-60)
    after = region_of(lane, breath)
    assert after.end_tick == before.end_tick
    assert after.start_tick < before.start_tick
    assert after.start_tick == session.grid.snap(session.project.score.metre_map, after.start_tick)


def test_a_double_click_adds_a_breath_and_delete_forgets_it(panel: TimelinePanel, session: Session) -> None:
    lane = breath_lane(panel)
    notes = session.project.part(session.player).notes if session.player else ()
    taken = {event.id for event in front_plan(session).breaths}
    note = next(note for note in notes[2:] if f"breath:{note.id}" not in taken)
    at_s = session.project.score.tempo_map.seconds(float(note.onset_tick)) - 0.05
    double_click(lane, QPointF(lane.axis.x_px(at_s), 3.0))
    (correction,) = corrections(session)
    assert isinstance(correction, SetBreath)
    assert (correction.note_id, correction.added) == (note.id, True)
    assert session.selection.events == {EventKey(front_plan(session).player_id, f"breath:{note.id}")}


def test_a_removed_breath_leaves_a_mark_that_brings_it_back(panel: TimelinePanel, session: Session) -> None:
    lane, breath = breath_lane(panel), second_breath(session)
    plan = front_plan(session)
    session.attempt(Message("edit.remove_events", {"count": 1}), lambda p: edit.remove(p, plan, (breath,)))
    mark = region_of(lane, breath)
    assert mark.removed
    assert isinstance(corrections(session)[0], RemoveEvent)
    click(lane, lane.box(mark).center())
    assert session.selection.events == {mark.key}


def test_several_selected_move_together(panel: TimelinePanel, session: Session) -> None:
    lane = acting_lane(panel)
    sways = [event for event in front_plan(session).gestures if event.kind == "sway"][3:6]
    player = front_plan(session).player_id
    session.select(Selection(events=frozenset(EventKey(player, event.id) for event in sways)))
    drag(lane, middle(lane, sways[1].id), dx=25, modifiers=ALT)
    changed = {item.event_id: item for item in corrections(session) if isinstance(item, ChangeGesture)}
    assert set(changed) == {event.id for event in sways}
    moved = {changed[event.id].start_tick - event.start_tick for event in sways}
    assert len(moved) == 1
    assert moved.pop() > 0
    assert len(session.document.done) == 1


def test_a_gestures_amount_is_signed(panel: TimelinePanel, session: Session) -> None:
    lane = acting_lane(panel)
    shift = next(event for event in front_plan(session).gestures if event.kind == "weight_shift" and event.start_s > 0)
    # Two pixels of a row's height are its margin.
    height = lane.row_box(region_of(lane, shift.id).row)[1] - 2.0
    drag(lane, middle(lane, shift.id), dy=-height * 0.5 if shift.amount < 0 else height * 0.5)
    (change,) = corrections(session)
    assert isinstance(change, ChangeGesture)
    assert change.amount == pytest.approx(shift.amount + (1.0 if shift.amount < 0 else -1.0), abs=0.12)


def test_an_expression_is_added_faded_and_made_weaker(panel: TimelinePanel, session: Session) -> None:
    lane = acting_lane(panel)
    player = front_plan(session).player_id
    session.attempt(
        Message("edit.add_expression", {"expression": "smile", "of": "1"}),
        lambda p: edit.add_expression(p, player, "smile", 4 * 960, 10 * 960, fade_in_s=0.3, fade_out_s=0.3).project,
    )
    name = "expression:own-1"
    click(lane, middle(lane, name))
    region = region_of(lane, name)
    _, (_, fade_out) = lane.fade_handles(region, lane.box(region))
    drag(lane, fade_out, dx=-30)
    (added,) = corrections(session)
    assert isinstance(added, AddExpression)
    assert added.fade_out_s == pytest.approx(0.3 + 30 / lane.axis.px_per_s, abs=0.03)
    drag(lane, middle(lane, name), dy=lane.row_box(region.row)[1] * 0.5)
    (added,) = corrections(session)
    assert isinstance(added, AddExpression)
    assert 0.3 < added.strength < 0.7


def test_another_expression_from_the_menu(panel: TimelinePanel, session: Session) -> None:
    lane = acting_lane(panel)
    brows = next(region for region in lane.regions if region.event_id.startswith("expression:brows_up"))
    panel.axis.show(brows.start_s - 2.0, brows.end_s + 2.0)
    menu = lane.context_menu(lane.mouse_at(lane.box(brows).center()))
    assert menu is not None
    other = next(action.menu() for action in menu.actions() if action.menu() is not None)
    assert {action.text() for action in other.actions()} >= {"Smile", "Strained", "Brows up"}  # type: ignore[attr-defined]
    next(action for action in other.actions() if action.text() == "Smile").trigger()  # type: ignore[attr-defined]
    (change,) = corrections(session)
    assert isinstance(change, ChangeExpression)
    assert change.expression == "smile"


def test_a_cue_snaps_to_an_entry(panel: TimelinePanel, session: Session) -> None:
    lane = acting_lane(panel)
    cue = front_plan(session).cues[0]
    notes = session.project.part(session.player).notes if session.player else ()
    target = notes[2]
    seconds = session.project.score.tempo_map.seconds
    dx = (seconds(float(target.onset_tick)) - cue.end_s) * lane.axis.px_per_s + 4
    box = lane.box(region_of(lane, cue.id))
    drag(lane, QPointF(box.center().x(), box.bottom() - 3), dx=dx)
    (correction,) = corrections(session)
    assert isinstance(correction, SetCue)
    assert correction.note_id == target.id
    assert session.selection.events == {EventKey(front_plan(session).player_id, f"cue:{target.id}")}


def test_another_player_gives_the_entry_from_the_menu_of_a_cue(panel: TimelinePanel, session: Session) -> None:
    lane = acting_lane(panel)
    giver = front_plan(session).player_id
    cue = front_plan(session).cues[0]
    other = next(player for player in session.project.players if player.id != giver)
    roll = child(panel, PianoRoll)
    arrows = roll.entries.arrows
    assert {arrow.giver_id for arrow in arrows if arrow.from_s == cue.peak_s} == {giver}
    assert len(arrows) >= len(cue.takers) > 0
    box = lane.box(region_of(lane, cue.id))
    menu = lane.context_menu(lane.mouse_at(QPointF(box.center().x(), box.bottom() - 3)))
    assert menu is not None
    givers = child(menu, QMenu, "givers")
    entries = {action.text(): action for action in givers.actions()}
    assert len(entries) == len(session.project.players)
    assert [action.isChecked() for action in givers.actions()].count(True) == 1
    givers.actions()[session.project.players.index(other)].trigger()
    menu.close()
    made = session.project.corrections
    assert made[giver] == (RemoveEvent(cue.id, cue.id.split(":", 1)[1]),)
    (given,) = made[other.id]
    assert isinstance(given, SetCue)
    session.document.undo()
    assert not session.project.corrections


def test_a_double_click_in_a_gestures_row_adds_one(panel: TimelinePanel, session: Session) -> None:
    lane = acting_lane(panel)
    row = next(first + count - 1 for kind, first, count in lane.groups if kind == "lower_instrument")
    top, height = lane.row_box(row)
    double_click(lane, QPointF(lane.axis.x_px(5.0), top + height / 2))
    (added,) = corrections(session)
    assert isinstance(added, AddGesture)
    assert (added.kind, added.amount) == ("lower_instrument", 1.0)


def test_regions_of_one_kind_never_lie_over_one_another(panel: TimelinePanel, session: Session) -> None:
    lane = acting_lane(panel)
    player = front_plan(session).player_id
    for start in (0, 480, 960, 2400):
        session.attempt(
            Message("edit.add_gesture", {"gesture": "sway", "of": "1"}),
            lambda p, start=start: edit.add_gesture(p, player, "bell_height", start, start + 1500, 0.5).project,
        )
    by_row: dict[int, list[tuple[int, int]]] = {}
    for region in lane.regions:
        if not region.removed and region.event_id != "expression:neutral":
            by_row.setdefault(region.row, []).append((region.start_tick, region.end_tick))
    for spans in by_row.values():
        spans.sort()
        assert all(before[1] <= after[0] for before, after in pairwise(spans))


def test_a_lasso_selects_what_it_meets(panel: TimelinePanel, session: Session) -> None:
    lane = breath_lane(panel)
    boxes = {region.event_id: lane.box(region) for region in lane.regions if region.start_s > 0 and region.end_s < 20}
    left = min(box.left() for box in boxes.values()) - 12
    right = max(box.right() for box in boxes.values()) + 4
    drag(lane, QPointF(left, 3.0), dx=right - left, dy=lane.plot.height() - 6)
    assert {key.event_id for key in session.selection.events} == set(boxes)
    assert not session.document.done


def test_a_number_is_typed_for_all_selected(panel: TimelinePanel, session: Session) -> None:
    lane = breath_lane(panel)
    plan = front_plan(session)
    first, second = [event.id for event in plan.breaths if event.kind == "breath"][1:3]
    session.select(Selection(events=frozenset({EventKey(plan.player_id, first), EventKey(plan.player_id, second)})))
    lane.plot.setFocus()
    QTest.keyClick(lane.plot, Qt.Key.Key_Return)
    assert lane.number.isVisible()
    QTest.keyClicks(lane.number, "0.4")
    QTest.keyClick(lane.number, Qt.Key.Key_Return)
    assert not lane.number.isVisible()
    assert [item.depth for item in corrections(session) if isinstance(item, SetBreath)] == [0.4, 0.4]
    assert len(session.document.done) == 1


def test_a_double_click_on_a_region_types_its_amount(panel: TimelinePanel, session: Session) -> None:
    lane = acting_lane(panel)
    shift = next(event for event in front_plan(session).gestures if event.kind == "weight_shift" and event.start_s > 0)
    double_click(lane, middle(lane, shift.id))
    QTest.keyClicks(lane.number, "-0.33")
    QTest.keyClick(lane.number, Qt.Key.Key_Return)
    (change,) = corrections(session)
    assert isinstance(change, ChangeGesture)
    assert change.amount == -0.33
    double_click(lane, middle(lane, shift.id))
    QTest.keyClicks(lane.number, "0.9")
    QTest.keyClick(lane.number, Qt.Key.Key_Escape)
    assert corrections(session) == (change,)


def test_the_keyboard_reaches_every_region_and_its_amount(panel: TimelinePanel, session: Session) -> None:
    lane = breath_lane(panel)
    session.set_playhead(front_plan(session).breaths[1].start_s)
    QTest.keyClick(lane.plot, Qt.Key.Key_Right, ALT)
    (key,) = session.selection.events
    assert key.event_id == front_plan(session).breaths[1].id
    QTest.keyClick(lane.plot, Qt.Key.Key_Right, ALT)
    (key,) = session.selection.events
    assert key.event_id == front_plan(session).breaths[2].id
    before = region_of(lane, key.event_id).amount
    QTest.keyClick(lane.plot, Qt.Key.Key_Down)
    assert region_of(lane, key.event_id).amount == pytest.approx(before - 0.05)
    QTest.keyClick(lane.plot, Qt.Key.Key_Up, Qt.KeyboardModifier.ShiftModifier)
    assert region_of(lane, key.event_id).amount == pytest.approx(before - 0.04)


def test_a_pose_is_moved_and_its_fades_lie_beside_it(panel: TimelinePanel, session: Session) -> None:
    lane = acting_lane(panel)
    player = front_plan(session).player_id
    pose = PoseCorrection("lift", "bell", 8 * 480, 12 * 480, up_deg=6.0, fade_in_ticks=240, fade_out_ticks=240)
    session.attempt(
        Message("edit.add_gesture", {"gesture": "sway", "of": "1"}), lambda p: with_corrections(p, player, (pose,))
    )
    region = region_of(lane, "pose:lift")
    assert region.label == "Bell"
    drag(lane, middle(lane, "pose:lift"), dx=lane.axis.px_per_s, modifiers=ALT)
    (moved,) = corrections(session)
    assert isinstance(moved, PoseCorrection)
    assert moved.start_tick > pose.start_tick
    assert moved.end_tick - moved.start_tick == pose.end_tick - pose.start_tick
    region = region_of(lane, "pose:lift")
    (_, into), _ = lane.fade_handles(region, lane.box(region))
    assert into.x() < lane.box(region).left()
    drag(lane, into, dx=-lane.axis.px_per_s * 0.5)
    (faded,) = corrections(session)
    assert isinstance(faded, PoseCorrection)
    seconds = session.project.score.tempo_map.seconds
    length_s = seconds(float(faded.start_tick)) - seconds(float(faded.start_tick - faded.fade_in_ticks))
    assert length_s == pytest.approx(region.fade_in_s + 0.5, abs=0.05)


def test_from_far_away_the_strongest_of_each_column_is_drawn(panel: TimelinePanel, session: Session) -> None:
    lane = breath_lane(panel)
    plan = front_plan(session)
    corrected = [event.id for event in plan.breaths if event.kind == "breath"][1]
    session.attempt(
        Message("edit.set_event_amount", {"count": 1}), lambda one: edit.set_amounts(one, plan, {corrected: 0.1})
    )
    # A smaller breath may need others after it.
    selected = [event.id for event in front_plan(session).breaths if event.kind == "breath"][2]
    everything = {region.event_id for region in lane.regions}
    lane.axis.show(-3.0, 27.0)
    near = {region.event_id for region in lane.visible(0.0, 1e4)}
    lane.axis.set_limits(-500.0, 6000.0, (-500.0, 6000.0))
    lane.axis.show(-500.0, 6000.0)
    session.select(Selection(events=frozenset({EventKey(plan.player_id, selected)})))
    drawn = list(lane.visible(-1e4, 1e4))
    shown = {region.event_id for region in drawn}
    assert near == everything
    assert {corrected, selected} < shown < everything
    for region in lane.regions:
        if region.event_id not in shown:
            assert any(
                other.row == region.row
                and abs(other.start_s - region.start_s) * lane.axis.px_per_s < LEAST_REGION_PX
                and other.amount >= region.amount
                for other in drawn
            ), region


@pytest.mark.parametrize("px_per_s", [3.0, 12.0, 40.0])
def test_names_of_neighbouring_cues_do_not_overlap(
    panel: TimelinePanel, session: Session, monkeypatch: pytest.MonkeyPatch, px_per_s: float
) -> None:
    lane = child(panel, ActingLane)
    rooms: list[QRectF] = []

    def drawn(painter: QPainter, box: QRectF, text: str) -> None:
        rooms.append(box)

    monkeypatch.setattr("widgets.timeline.lanes.acting.acting_drawing.draw_text", drawn)
    cues = sorted((one for one in lane.regions if one.kind == "cue"), key=lambda one: (one.row, one.start_s))
    assert len(cues) > 2
    start_s = panel.axis.start_s
    panel.axis.show(start_s, start_s + panel.axis.width_px / px_per_s)
    picture = QPixmap(100, 100)
    with QPainter(picture) as painter:
        for cue, following in pairwise(cues):
            rooms.clear()
            box = QRectF(lane.box(cue))
            box.setWidth(max(box.width(), 10.0))
            lane._painter.paint_cue(painter, cue, box, "#ffffff", lane._name_room_px(cue))
            if following.row == cue.row and rooms:
                assert lane.box(cue).right() + 4.0 + max(rooms[0].width(), 0.0) <= lane.box(following).left()


def test_the_wheel_and_the_middle_button_show_the_rows_that_do_not_fit(panel: TimelinePanel) -> None:
    lane = acting_lane(panel)
    panel.stack.set_height(lane, lane.least_height_px)
    QApplication.processEvents()
    assert lane.row_box(lane.rows - 1)[0] > lane.plot_rect.height(), "there are more rows than fit"
    mouse = lane.mouse_at(QPointF(100.0, 30.0))
    start_s = lane.axis.start_s
    assert lane.wheel(mouse, -1.0)
    assert lane.row_box(0)[0] == -lane.row_box(0)[1]
    for _ in range(30):
        lane.wheel(mouse, -1.0)
    top, height = lane.row_box(lane.rows - 1)
    assert top + height == pytest.approx(lane.plot_rect.height())
    lane.pan_y(1e4)
    assert lane.row_box(0)[0] == 0.0
    assert lane.axis.start_s == start_s
