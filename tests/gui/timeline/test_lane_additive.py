"""Additive curves by mouse and keys, compared with the project."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QAction, QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu

from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.editor.timeline_view import Tool
from app.errors import Message
from app.plan.by_hand.additive_curve import AdditiveCurve, CurveKey, Tangent
from app.project.edit import additive as edit
from app.project.edit.corrections import with_corrections
from app.project.edit.generation import vary_everyone
from tests.gui.timeline.conftest import Stage
from tests.gui.timeline.lane_hands import (
    ALT,
    CTRL,
    LEFT,
    NONE,
    SHIFT,
    click,
    double_click,
    drag,
    move_to,
)
from tests.support.windows import child
from widgets.timeline.lanes.additive.additive_lane import AdditiveLane
from widgets.timeline.model.additive.additive_curves import KeyRef
from widgets.timeline.panel import TimelinePanel

QUARTER = 480


@pytest.fixture
def panel(panel: TimelinePanel) -> TimelinePanel:
    panel.lane_layout.fold_all(True)
    panel.open_lane("additive", True)
    panel.axis.show(-1.0, 14.0)
    return panel


@pytest.fixture
def lane(panel: TimelinePanel) -> AdditiveLane:
    return child(panel, AdditiveLane)


def player_of(lane: AdditiveLane) -> str:
    assert lane.player_id is not None
    return lane.player_id


def curves(lane: AdditiveLane) -> tuple[AdditiveCurve, ...]:
    return edit.curves_of(lane.session.project, player_of(lane))


def one(lane: AdditiveLane) -> AdditiveCurve:
    (curve,) = curves(lane)
    return curve


def values(curve: AdditiveCurve) -> list[tuple[int, float]]:
    return [(key.tick, key.value) for key in curve.keys]


def place(lane: AdditiveLane, tick: float, value: float) -> QPointF:
    time_s = lane.session.project.score.tempo_map.seconds(float(tick))
    return QPointF(lane.axis.x_px(time_s), lane.y_px(value))


def given(lane: AdditiveLane, *keys: CurveKey, name: str = "own-1", channel: str = "head.up", **more: object) -> None:
    """Add a curve of the first selected player without the mouse."""
    curve = AdditiveCurve(name, channel, keys, QUARTER, QUARTER, **more)
    lane.session.attempt(
        Message("edit.change_curve"), lambda project: with_corrections(project, player_of(lane), (curve,))
    )


def key(tick: int, value: float, **more: object) -> CurveKey:
    return CurveKey(tick, value, **more)


def menu_at(lane: AdditiveLane, at: QPointF) -> QMenu:
    QTest.mouseClick(lane.plot, Qt.MouseButton.RightButton, NONE, at.toPoint())
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu)
    return menu


def entry(menu: QMenu, name: str) -> QAction:
    found = menu.findChild(QAction, name)
    assert found is not None, name
    return found


def test_a_double_click_adds_a_key_and_another_one_joins_its_curve(lane: AdditiveLane) -> None:
    double_click(lane, place(lane, 8 * QUARTER + 20, 6.0))
    [(tick, value)] = values(one(lane))
    assert tick == 8 * QUARTER
    assert value == pytest.approx(6.0, abs=0.3)
    assert one(lane).channel == "head.up"
    assert lane.selected == {KeyRef(one(lane).name, tick)}
    double_click(lane, place(lane, 10 * QUARTER, -4.0))
    assert [tick for tick, _ in values(one(lane))] == [8 * QUARTER, 10 * QUARTER]
    double_click(lane, place(lane, 20 * QUARTER, 3.0))
    assert len(curves(lane)) == 2
    document = lane.session.document
    assert [step.name.id for step in document.done] == ["edit.add_curve_key"] * 3
    label = lane.session.project.metre_map.label
    assert [str(step.name.arguments["of"]).partition(" · ")[2] for step in document.done] == [
        label(at) for at in (tick, 10 * QUARTER, 20 * QUARTER)
    ]
    for left in (1, 1, 0):
        document.undo()
        assert len(curves(lane)) == left
    document.redo()
    assert len(curves(lane)) == 1


def test_what_is_seen_is_what_is_planned(lane: AdditiveLane) -> None:
    double_click(lane, place(lane, 8 * QUARTER, 6.0))
    plan = lane.session.plan
    (event,) = plan.additive
    assert event.channel == "head.up"
    assert event.segments == lane.curves[0].shape


def test_a_key_is_dragged_to_the_grid_in_one_step(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 2.0), key(10 * QUARTER, 4.0))
    step_px = place(lane, QUARTER, 0).x() - place(lane, 0, 0).x()
    steps = len(lane.session.document.done)
    up_px = lane.y_px(0.0) - lane.y_px(3.0)
    drag(lane, place(lane, 8 * QUARTER, 2.0), dx=step_px + 3.0, dy=-up_px)
    tick, value = values(one(lane))[0]
    assert tick == 9 * QUARTER
    assert value == pytest.approx(5.0, abs=0.3)
    assert values(one(lane))[1] == (10 * QUARTER, 4.0)
    assert len(lane.session.document.done) == steps + 1
    lane.session.document.undo()
    assert values(one(lane)) == [(8 * QUARTER, 2.0), (10 * QUARTER, 4.0)]


def test_shift_is_fine_and_alt_is_free_of_the_grid(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 2.0), key(12 * QUARTER, 4.0))
    px = (place(lane, QUARTER, 0).x() - place(lane, 0, 0).x()) / QUARTER
    drag(lane, place(lane, 8 * QUARTER, 2.0), dx=53 * px + 5.0, modifiers=ALT)
    moved = values(one(lane))[0][0]
    assert moved % (QUARTER // 4)
    assert moved > 8 * QUARTER
    lane.session.document.undo()
    up_px = lane.y_px(0.0) - lane.y_px(5.0)
    drag(lane, place(lane, 8 * QUARTER, 2.0), dy=-up_px, modifiers=SHIFT)
    assert values(one(lane))[0][1] == pytest.approx(3.0, abs=0.3)


def test_ctrl_keeps_to_one_direction(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 2.0), key(12 * QUARTER, 4.0))
    click(lane, place(lane, 8 * QUARTER, 2.0))
    at = place(lane, 8 * QUARTER, 2.0)
    QTest.mousePress(lane.plot, LEFT, NONE, at.toPoint())
    for share in (0.5, 1.0):
        move_to(lane.plot, (at + QPointF(5.0 * share, -30.0 * share)).toPoint(), CTRL)
    QTest.mouseRelease(lane.plot, LEFT, CTRL, (at + QPointF(5.0, -30.0)).toPoint())
    tick, value = values(one(lane))[0]
    assert tick == 8 * QUARTER
    assert value > 4.0


def test_escape_in_mid_drag_leaves_everything(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 2.0))
    steps = len(lane.session.document.done)
    drag(lane, place(lane, 8 * QUARTER, 2.0), dx=60, dy=-20, release=False)
    assert values(one(lane)) != [(8 * QUARTER, 2.0)]
    QTest.keyClick(lane.plot, Qt.Key.Key_Escape)
    assert values(one(lane)) == [(8 * QUARTER, 2.0)]
    assert len(lane.session.document.done) == steps


def test_several_keys_are_selected_and_moved_together(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 2.0), key(10 * QUARTER, 4.0), key(12 * QUARTER, 1.0))
    start, end = place(lane, 7 * QUARTER, 8.0), place(lane, 11 * QUARTER, -8.0)
    drag(lane, start, dx=end.x() - start.x(), dy=end.y() - start.y())
    assert {ref.tick for ref in lane.selected} == {8 * QUARTER, 10 * QUARTER}
    px = place(lane, QUARTER, 0).x() - place(lane, 0, 0).x()
    drag(lane, place(lane, 10 * QUARTER, 4.0), dx=-px)
    assert [tick for tick, _ in values(one(lane))] == [7 * QUARTER, 9 * QUARTER, 12 * QUARTER]
    assert {ref.tick for ref in lane.selected} == {7 * QUARTER, 9 * QUARTER}
    click(lane, place(lane, 12 * QUARTER, 1.0), CTRL)
    assert len(lane.selected) == 3
    QTest.keyClick(lane.plot, Qt.Key.Key_Delete)
    assert not curves(lane)


def test_a_handle_turns_the_other_one_with_it_unless_ctrl_is_held(lane: AdditiveLane) -> None:
    given(lane, key(6 * QUARTER, 0.0), key(10 * QUARTER, 2.0), key(14 * QUARTER, 5.0))
    click(lane, place(lane, 10 * QUARTER, 2.0))
    shown = lane.curves[0]
    (leave,) = [(time_s, value) for side, time_s, value in shown.handles(1) if side == "leave"]
    at = QPointF(lane.axis.x_px(leave[0]), lane.y_px(leave[1]))
    up_px = lane.y_px(0.0) - lane.y_px(4.0)
    drag(lane, at, dy=-up_px)
    changed = one(lane).keys[1]
    assert changed.arrive is not None
    assert changed.leave.value == pytest.approx(leave[1] + 4.0 - 2.0, abs=0.4)
    slopes = changed.leave.value / changed.leave.ticks, -changed.arrive.value / changed.arrive.ticks
    assert slopes[0] == pytest.approx(slopes[1], rel=1e-3)
    assert values(one(lane))[1] == (10 * QUARTER, 2.0)
    lane.session.document.undo()
    assert one(lane).keys[1] == key(10 * QUARTER, 2.0)
    click(lane, place(lane, 10 * QUARTER, 2.0))
    drag(lane, at, dy=-up_px, modifiers=CTRL)
    broken = one(lane).keys[1]
    assert broken.leave is not None
    assert broken.arrive is None


def test_the_ends_of_the_blends_are_dragged(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 5.0), key(10 * QUARTER, 5.0))
    px = place(lane, QUARTER, 0).x() - place(lane, 0, 0).x()
    drag(lane, place(lane, 7 * QUARTER, 0.0), dx=-px)
    assert one(lane).blend_in_ticks == 2 * QUARTER
    drag(lane, place(lane, 11 * QUARTER, 0.0), dx=2 * px)
    assert one(lane).blend_out_ticks == 3 * QUARTER
    assert lane.session.document.done[-1].name.id == "edit.set_curve_blend"


def test_the_menu_changes_interpolation_and_tangents(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 5.0), key(10 * QUARTER, 1.0, arrive=Tangent(100, 3.0)))
    entry(menu_at(lane, place(lane, 8 * QUARTER, 5.0)), "interpolation_linear").trigger()
    assert [item.interpolation for item in one(lane).keys] == ["linear", "bezier"]
    menu = menu_at(lane, place(lane, 8 * QUARTER, 5.0))
    assert entry(menu, "interpolation_linear").isChecked()
    entry(menu, "interpolation_constant").trigger()
    assert one(lane).keys[0].interpolation == "constant"
    entry(menu_at(lane, place(lane, 10 * QUARTER, 1.0)), "tangents_automatic").trigger()
    assert one(lane).keys[1].arrive is None
    entry(menu_at(lane, place(lane, 10 * QUARTER, 1.0)), "tangents_flat").trigger()
    assert one(lane).keys[1].arrive is not None
    assert one(lane).keys[1].arrive.value == 0.0


def test_a_curve_is_switched_off_weighted_named_and_deleted(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 5.0), key(12 * QUARTER, 5.0))
    on_line = place(lane, 10 * QUARTER, 5.0)
    entry(menu_at(lane, on_line), "curve_enabled").trigger()
    assert not one(lane).enabled
    assert lane.session.plan.additive == ()
    entry(menu_at(lane, on_line), "curve_enabled").trigger()
    assert one(lane).enabled
    entry(menu_at(lane, on_line), "curve_weight").trigger()
    lane.number.setText("0,4")
    QTest.keyClick(lane.number, Qt.Key.Key_Return)
    assert one(lane).weight == pytest.approx(0.4)
    entry(menu_at(lane, on_line), "curve_title").trigger()
    lane.text.setText(" 見上げる ")
    QTest.keyClick(lane.text, Qt.Key.Key_Return)
    assert one(lane).title == "見上げる"
    entry(menu_at(lane, on_line), "delete_curve").trigger()
    assert not curves(lane)


def test_a_double_click_on_a_key_types_its_value(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 5.0), key(12 * QUARTER, 5.0))
    double_click(lane, place(lane, 8 * QUARTER, 5.0))
    assert lane.number.isVisible()
    lane.number.setText("−7.5°")
    QTest.keyClick(lane.number, Qt.Key.Key_Return)
    assert values(one(lane))[0] == (8 * QUARTER, -7.5)


def test_hips_are_typed_in_centimetres(lane: AdditiveLane) -> None:
    lane.set_channel("hips.ahead")
    given(lane, key(8 * QUARTER, 0.02), channel="hips.ahead")
    double_click(lane, place(lane, 8 * QUARTER, 0.02))
    assert lane.number.text() == "2.0"
    lane.number.setText("3.5 cm")
    QTest.keyClick(lane.number, Qt.Key.Key_Return)
    assert values(one(lane)) == [(8 * QUARTER, 0.035)]


def test_arrows_move_keys(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 5.0), key(12 * QUARTER, 5.0))
    click(lane, place(lane, 8 * QUARTER, 5.0))
    QTest.keyClick(lane.plot, Qt.Key.Key_Up)
    QTest.keyClick(lane.plot, Qt.Key.Key_Down, SHIFT)
    assert values(one(lane))[0] == (8 * QUARTER, 5.9)
    QTest.keyClick(lane.plot, Qt.Key.Key_Right)
    step = int(lane.session.grid.step_ticks(lane.session.project.score.metre_map))
    assert values(one(lane))[0] == (8 * QUARTER + step, 5.9)
    QTest.keyClick(lane.plot, Qt.Key.Key_Left, SHIFT)
    assert values(one(lane))[0] == (8 * QUARTER + step - 1, 5.9)
    assert len(lane.selected) == 1


def test_keys_are_copied_to_the_playhead_and_to_another_channel(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 5.0, leave=Tangent(90, 2.0)), key(9 * QUARTER, 1.0, interpolation="linear"))
    lane.select_all()
    QTest.keyClick(lane.plot, Qt.Key.Key_C, CTRL)
    assert lane.session.document.done[-1].name.id == "edit.change_curve"
    clock = lane.session.project.score.tempo_map
    lane.session.set_playhead(clock.seconds(16.0 * QUARTER))
    lane.set_channel("head.left")
    lane.plot.setFocus()
    QTest.keyClick(lane.plot, Qt.Key.Key_V, CTRL)
    pasted = next(curve for curve in curves(lane) if curve.channel == "head.left")
    assert pasted.keys == (
        key(16 * QUARTER, 5.0, leave=Tangent(90, 2.0)),
        key(17 * QUARTER, 1.0, interpolation="linear"),
    )
    lane.set_channel("hips.left")
    steps = len(lane.session.document.done)
    QTest.keyClick(lane.plot, Qt.Key.Key_V, CTRL)
    assert len(lane.session.document.done) == steps
    QGuiApplication.clipboard().clear()


def test_the_channel_is_chosen_from_the_menu_which_marks_those_with_curves(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 0.5), channel="face.browInnerUp")
    lane.channels.aboutToShow.emit()
    chosen = entry(lane.channels, "channel_face.browInnerUp")
    assert chosen.text().startswith("•")
    assert not entry(lane.channels, "channel_bell.up").text().startswith("•")
    chosen.trigger()
    assert lane.channel == "face.browInnerUp"
    assert len(lane.curves) == 1
    assert "brow" in lane.choice.text().lower()


def test_a_curve_that_is_selected_is_shown_and_deleted_as_an_event(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 5.0), channel="torso.up")
    added = EventKey(player_of(lane), "additive:own-1")
    lane.set_folded(True)
    lane.session.select(Selection(events=frozenset({added})))
    assert lane.channel == "torso.up"
    assert lane.chosen_curves == {"own-1"}
    assert not lane.folded
    click(lane, place(lane, 2 * QUARTER, 6.0))
    assert not lane.session.selection.events
    x = place(lane, 7.6 * QUARTER, 0.0).x()
    value = float(lane.curves[0].values(np.array([lane.axis.seconds(x)]))[0])
    click(lane, QPointF(x, lane.y_px(value)))
    assert lane.session.selection.events == {added}


def test_curves_are_kept_when_everyone_is_regenerated(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 5.0))
    before = one(lane)
    lane.session.attempt(Message("edit.vary_everyone"), vary_everyone)
    assert one(lane) is before
    assert len(lane.session.plan.additive) == 1


def test_the_generated_value_is_shown_and_stays_while_keys_move(lane: AdditiveLane) -> None:
    assert lane.generated is not None
    times_s, generated = lane.generated
    assert len(times_s) == len(generated)
    assert np.ptp(generated) > 0.5
    before = lane.generated
    double_click(lane, place(lane, 8 * QUARTER, 6.0))
    assert lane.generated is before
    lane.set_channel("hips.left")
    assert lane.generated is not before


def test_a_key_may_come_upon_another_one(lane: AdditiveLane) -> None:
    given(lane, key(8 * QUARTER, 2.0), key(10 * QUARTER, 4.0))
    px = place(lane, QUARTER, 0).x() - place(lane, 0, 0).x()
    drag(lane, place(lane, 8 * QUARTER, 2.0), dx=2 * px)
    assert [tick for tick, _ in values(one(lane))] == [10 * QUARTER]


def test_the_lane_s_keys_come_before_the_program_s_while_it_has_them(stage: Stage) -> None:
    stage.panel.open_lane("additive", True)
    lane = child(stage.panel, AdditiveLane)
    given(lane, key(QUARTER, 5.0), key(2 * QUARTER, 1.0))
    lane.plot.setFocus()
    lane.select_all()
    stage.table.refresh()
    notes = stage.session.project.score.parts[0].notes
    QTest.keyClick(lane.plot, Qt.Key.Key_C, CTRL)
    stage.session.set_playhead(2.0)
    stage.table.refresh()
    QTest.keyClick(lane.plot, Qt.Key.Key_V, CTRL)
    assert [tick for tick, _ in values(one(lane))] == [QUARTER, 2 * QUARTER, 4 * QUARTER, 5 * QUARTER]
    QTest.keyClick(lane.plot, Qt.Key.Key_Delete)
    assert [tick for tick, _ in values(one(lane))] == [QUARTER, 2 * QUARTER]
    assert stage.session.project.score.parts[0].notes is notes
    QGuiApplication.clipboard().clear()


def test_what_a_body_cannot_do_is_marked_where_it_is(lane: AdditiveLane, session: Session) -> None:
    player = player_of(lane)
    _, high = lane.limits
    keys = (CurveKey(0, 0.0), CurveKey(4 * QUARTER, high + 20.0), CurveKey(8 * QUARTER, 0.0))
    session.attempt(
        Message("edit.add_curve_key", {"of": "1"}),
        lambda project: with_corrections(project, player, (AdditiveCurve("own-1", lane.channel, keys),)),
    )
    clock = session.project.score.tempo_map
    ((start_s, end_s),) = lane.curves[0].beyond_s(lane.limits)
    assert clock.seconds(0.0) < start_s < clock.seconds(4.0 * QUARTER) < end_s < clock.seconds(8.0 * QUARTER)
    (problem,) = [one for one in session.plans[player].problems if one.message.id == "additive.beyond_reach"]
    assert (problem.start_s, problem.end_s) == pytest.approx((start_s, end_s), abs=0.2)
    lane.fit()
    warning = lane.session.tokens.warning
    at_s = start_s + 0.3 * (end_s - start_s)
    x_px = lane.axis.x_px(at_s)
    y_px = lane.y_px(float(lane.curves[0].values(np.array([at_s]))[0]))
    image = lane.plot.grab().toImage()
    near = {image.pixelColor(round(x_px), round(y_px) + dy).name() for dy in (-1, 0, 1)}
    assert warning in near
    lane.hover(lane.mouse_at(QPointF(x_px, y_px)))
    assert len(lane.plot.toolTip().splitlines()) == 3
    lane.hover(lane.mouse_at(QPointF(lane.axis.x_px(clock.seconds(0.0)) + 1.0, lane.y_px(0.0))))
    assert len(lane.plot.toolTip().splitlines()) == 2
    quiet = AdditiveCurve("own-1", lane.channel, keys, weight=0.5 * high / (high + 20.0))
    session.attempt(Message("edit.change_curve"), lambda project: with_corrections(project, player, (quiet,)))
    assert lane.curves[0].beyond_s(lane.limits) == []


def test_the_pencil_makes_a_key_at_each_click(panel: TimelinePanel, lane: AdditiveLane) -> None:
    panel.set_tool(Tool.DRAW)
    click(lane, place(lane, 4 * QUARTER, 5.0))
    click(lane, place(lane, 8 * QUARTER, -5.0))
    assert [tick for tick, _ in values(one(lane))] == [4 * QUARTER, 8 * QUARTER]
    assert [step.name.id for step in lane.session.document.done] == ["edit.add_curve_key"] * 2
    # An existing key is dragged, as with the arrow tool.
    key = one(lane).keys[0]
    drag(lane, place(lane, key.tick, key.value), dy=-10.0)
    assert len(one(lane).keys) == 2
    assert one(lane).keys[0].value > key.value
