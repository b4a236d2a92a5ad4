"""The piano roll by mouse and keys, judged by the document."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.editor.selection import Selection
from app.editor.timeline_view import Ghosts, Tool
from app.errors import Message
from app.performance.ensemble import Performance
from app.plan.model import Problem
from app.project.edit import notes
from tests.gui.timeline.conftest import SCALE, TPQ, Stage
from tests.gui.timeline.hand import ALT, CTRL, MIDDLE, SHIFT, Hand

STEP = TPQ // 4


def press_key(stage: Stage, key: Qt.Key, keys: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    """Press a key through the shortcut system."""
    stage.roll.plot.setFocus()
    stage.table.refresh()
    QTest.keyClick(stage.roll.plot, key, keys)
    QApplication.processEvents()


# Selecting


def test_a_click_selects_one_note_ctrl_toggles_shift_adds(stage: Stage) -> None:
    stage.hand.click(stage.middle("1:2"))
    assert stage.selected == {"1:2"}
    stage.hand.click(stage.middle("1:3"), CTRL)
    assert stage.selected == {"1:2", "1:3"}
    stage.hand.click(stage.middle("1:5"), SHIFT)
    assert stage.selected == {"1:2", "1:3", "1:5"}
    stage.hand.click(stage.middle("1:3"), CTRL)
    assert stage.selected == {"1:2", "1:5"}
    stage.hand.click(stage.middle("1:5"))
    assert stage.selected == {"1:5"}
    stage.hand.click(stage.place(0.5 * TPQ, 50))
    assert stage.selected == set()
    assert stage.steps == []


def test_a_lasso_selects_what_it_touches(stage: Stage) -> None:
    stage.hand.drag(stage.place(1.5 * TPQ, 67.9), stage.place(3.5 * TPQ, 61))
    assert stage.selected == {"1:1", "1:2", "1:3"}
    stage.hand.drag(stage.place(5.2 * TPQ, 74), stage.place(5.8 * TPQ, 68), SHIFT)
    assert stage.selected == {"1:1", "1:2", "1:3", "1:5"}


def test_ghosts_are_not_caught_but_seen_together_all_notes_are(stage: Stage) -> None:
    around = stage.place(0.2 * TPQ, 62.9), stage.place(0.8 * TPQ, 55)
    stage.hand.drag(*around)
    assert stage.selected == {"1:0"}
    stage.panel.set_ghosts(Ghosts.ALL)
    stage.hand.drag(*around)
    assert stage.selected == {"1:0", "2:0"}


def test_a_click_on_another_players_note_brings_that_player_forward(stage: Stage) -> None:
    stage.panel.set_ghosts(Ghosts.ALL)
    stage.hand.click(stage.middle("2:4"))
    assert stage.selected == {"2:4"}
    assert stage.session.players == ("p2.1.1",)


def test_a_key_of_the_keyboard_selects_its_pitch(stage: Stage) -> None:
    keyboard = stage.roll.keyboard
    Hand(keyboard).click((10.0, stage.roll.y_px(64.5)))
    assert stage.selected == {"1:2"}
    Hand(keyboard).click((10.0, stage.roll.y_px(72.5)), SHIFT)
    assert stage.selected == {"1:2", "1:7"}


def test_selecting_by_command(stage: Stage) -> None:
    stage.do("notes.select_all")
    assert stage.selected == {f"1:{i}" for i in range(8)}
    stage.do("notes.select_all")
    assert len(stage.selected) == 16
    stage.do("notes.select_none")
    assert stage.selected == set()
    stage.session.set_playhead(2.5)
    stage.do("notes.select_bar")
    assert stage.selected == {"1:4", "1:5", "1:6", "1:7"}
    stage.session.select(Selection(frozenset({"2:0"})))
    stage.do("notes.select_bar")
    assert stage.selected == {"2:0", "2:1", "2:2", "2:3"}
    stage.session.select(Selection(span=(TPQ, 3 * TPQ)))
    stage.do("notes.select_span")
    assert stage.selected == {"1:1", "1:2"}
    stage.do("notes.select_pitch")
    assert stage.selected == {"1:1", "1:2"}


# Moving


def test_a_drag_moves_by_the_grid_and_by_pitch_in_one_step(stage: Stage) -> None:
    before = stage.session.project
    start = stage.middle("1:2")
    x, y = stage.place(2.5 * TPQ + 1.1 * STEP - 20, 66)
    stage.hand.drag(start, (x, y))
    note = stage.note("1:2")
    assert (note.onset_tick, note.pitch, note.duration_tick) == (2 * TPQ + STEP, 66, TPQ - 40)
    assert stage.steps == ["edit.move_notes"]
    stage.session.document.undo()
    assert stage.session.project is before


def test_alt_suspends_the_grid_and_shift_keeps_to_one_direction(stage: Stage) -> None:
    x, y = stage.middle("1:2")
    per_tick = stage.roll.axis.px_per_s / 960
    stage.hand.drag((x, y), (x + 50 * per_tick, y), ALT)
    assert abs(stage.note("1:2").onset_tick - (2 * TPQ + 50)) <= 3
    x, y = stage.middle("1:4")
    stage.hand.drag((x, y), (x + 100 * per_tick, y - 2 * stage.roll.row_px), SHIFT)
    moved = stage.note("1:4")
    assert (moved.onset_tick, moved.pitch) in ((4 * TPQ + STEP, 67), (4 * TPQ, 69))


def test_a_drag_back_to_its_beginning_is_no_step(stage: Stage) -> None:
    before = stage.session.project
    hand, start = stage.hand, stage.middle("1:2")
    hand.press(start)
    hand.move((start[0] + 80, start[1] - 30))
    assert stage.session.project is not before
    hand.move(start)
    hand.release(start)
    assert stage.session.project is before
    assert stage.steps == []


def test_escape_takes_a_drag_back(stage: Stage) -> None:
    before = stage.session.project
    hand, start = stage.hand, stage.middle("1:2")
    hand.press(start)
    hand.move((start[0] + 80, start[1] - 30))
    QTest.keyClick(stage.roll.plot, Qt.Key.Key_Escape)
    assert stage.session.project is before
    hand.move((start[0] + 120, start[1] - 60))
    hand.release((start[0] + 120, start[1] - 60))
    assert stage.session.project is before
    assert stage.steps == []


def test_undo_in_mid_drag_ends_what_the_drag_can_do(stage: Stage) -> None:
    before = stage.session.project
    hand, start = stage.hand, stage.middle("1:2")
    hand.press(start)
    hand.move((start[0] + 80, start[1]))
    stage.session.document.undo()
    hand.move((start[0] + 160, start[1]))
    hand.release((start[0] + 160, start[1]))
    assert stage.session.project is before


def test_nothing_moves_before_the_piece_or_out_of_the_pitches(stage: Stage) -> None:
    stage.do("notes.select_all")
    x, y = stage.middle("1:1")
    stage.hand.drag((x, y), (x - 300, y))
    assert [note.onset_tick for note in stage.session.project.score.parts[0].notes] == [TPQ * i for i in range(8)]


def test_a_chosen_group_moves_together(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:1", "1:2", "2:5"})))
    stage.hand.drag(stage.middle("1:1"), stage.place(1.5 * TPQ - 20, 64))
    assert [stage.note(id).pitch for id in ("1:1", "1:2", "2:5")] == [64, 66, 68]
    assert stage.selected == {"1:1", "1:2", "2:5"}


def test_arrows_transpose_and_nudge(stage: Stage) -> None:
    stage.hand.click(stage.middle("1:3"))
    press_key(stage, Qt.Key.Key_Up)
    press_key(stage, Qt.Key.Key_Up, SHIFT)
    assert stage.note("1:3").pitch == SCALE[3] + 13
    press_key(stage, Qt.Key.Key_Down)
    press_key(stage, Qt.Key.Key_Down, SHIFT)
    assert stage.note("1:3").pitch == SCALE[3]
    press_key(stage, Qt.Key.Key_Right)
    assert stage.note("1:3").onset_tick == 3 * TPQ + STEP
    press_key(stage, Qt.Key.Key_Left)
    press_key(stage, Qt.Key.Key_Left)
    assert stage.note("1:3").onset_tick == 3 * TPQ - STEP
    press_key(stage, Qt.Key.Key_Right, CTRL)
    # A frame at 60 fps and 120 quarters a minute: 16 ticks.
    assert stage.note("1:3").onset_tick == 3 * TPQ - STEP + 16
    press_key(stage, Qt.Key.Key_Left, CTRL)
    assert stage.note("1:3").onset_tick == 3 * TPQ - STEP
    assert len(stage.steps) == 9


# Resizing


def test_an_end_is_dragged(stage: Stage) -> None:
    start = stage.end("1:6")
    stage.hand.drag(start, (stage.place(8.26 * TPQ, 71)[0], start[1]))
    assert stage.note("1:6").end_tick == 8 * TPQ + STEP
    assert stage.steps == ["edit.resize_notes"]


def test_a_beginning_is_dragged(stage: Stage) -> None:
    x, y = stage.place(5 * TPQ, 69)
    stage.hand.drag((x + 2, y), (stage.place(4.74 * TPQ, 69)[0], y))
    note = stage.note("1:5")
    assert (note.onset_tick, note.end_tick) == (5 * TPQ - STEP, 6 * TPQ - 40)


def test_no_note_vanishes_by_its_end(stage: Stage) -> None:
    start = stage.end("1:6")
    stage.hand.drag(start, (start[0] - 600, start[1]))
    assert stage.note("1:6").duration_tick == 1


# Drawing, erasing, splitting


def test_the_pencil_draws_a_note_as_long_as_the_drag(stage: Stage) -> None:
    press_key(stage, Qt.Key.Key_D)
    assert stage.panel.tool is Tool.DRAW
    stage.hand.drag(stage.place(8.1 * TPQ, 74), stage.place(9.03 * TPQ, 74))
    note = stage.note("n:1")
    assert (note.onset_tick, note.end_tick, note.pitch) == (8 * TPQ, 9 * TPQ, 74)
    assert stage.selected == {"n:1"}
    assert stage.steps == ["edit.add_note"]
    done = stage.session.document.done[-1].name
    assert str(done.arguments["of"]).endswith(f" · {stage.session.project.metre_map.label(8 * TPQ)}")
    stage.hand.click(stage.place(10.2 * TPQ, 60))
    assert stage.note("n:2").duration_tick == STEP
    assert stage.note("n:2").onset_tick == 10 * TPQ
    stage.session.document.undo()
    assert stage.steps == ["edit.add_note"]


def test_a_double_click_on_empty_ground_makes_a_note(stage: Stage) -> None:
    stage.hand.double_click(stage.place(9.1 * TPQ, 65))
    assert (stage.note("n:1").onset_tick, stage.note("n:1").pitch) == (9 * TPQ, 65)


def test_the_eraser_takes_what_it_passes_in_one_step(stage: Stage) -> None:
    stage.table.actions["notes.tool_erase"].trigger()
    hand = stage.hand
    places = [stage.middle(id) for id in ("1:2", "1:3", "1:4")]
    hand.press(places[0])
    hand.move(places[1])
    hand.move(places[2])
    hand.release(places[2])
    left = {note.id for note in stage.session.project.score.parts[0].notes}
    assert left == {"1:0", "1:1", "1:5", "1:6", "1:7"}
    assert stage.steps == ["edit.erase_notes"]


def test_the_knife_cuts_where_it_is_clicked(stage: Stage) -> None:
    stage.panel.set_tool(Tool.SPLIT)
    stage.hand.click(stage.place(2.52 * TPQ, 64))
    assert stage.note("1:2").end_tick == 2.5 * TPQ
    assert stage.note("n:1").onset_tick == 2.5 * TPQ


def test_split_at_the_playhead_and_join_again(stage: Stage) -> None:
    before = stage.session.project
    stage.session.set_playhead(1.25)
    stage.do("notes.split")
    assert stage.note("n:1").onset_tick == 2.5 * TPQ
    stage.session.select(Selection(frozenset({"1:2", "n:1"})))
    stage.do("notes.join")
    assert stage.session.project.score == before.score
    assert stage.selected == {"1:2"}


def test_escape_lets_go_of_the_selection(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:0"})))
    press_key(stage, Qt.Key.Key_Escape)
    assert not stage.session.selection


def test_delete_removes_the_notes(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:0", "2:7"})))
    press_key(stage, Qt.Key.Key_Delete)
    assert [len(part.notes) for part in stage.session.project.score.parts] == [7, 7]


# Velocity, quantising, copying


def test_velocity_by_drag_and_by_key(stage: Stage) -> None:
    x, y = stage.middle("1:2")
    stage.hand.drag((x, y), (x, y - 20), CTRL | ALT)
    assert stage.note("1:2").velocity == 90
    assert stage.steps == ["edit.change_velocity"]
    press_key(stage, Qt.Key.Key_Minus)
    assert stage.note("1:2").velocity == 82
    press_key(stage, Qt.Key.Key_Plus)
    assert stage.note("1:2").velocity == 90


def test_duplicates_come_on_the_next_line_of_the_grid(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:0", "1:1"})))
    press_key(stage, Qt.Key.Key_D, CTRL)
    assert stage.selected == {"n:1", "n:2"}
    assert [stage.note(id).onset_tick for id in ("n:1", "n:2")] == [2 * TPQ, 3 * TPQ]


def test_copy_and_paste_across_players(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:0", "1:1"})))
    press_key(stage, Qt.Key.Key_C, CTRL)
    stage.session.set_players(("p2.1.1",))
    stage.session.set_playhead(5.0)
    press_key(stage, Qt.Key.Key_V, CTRL)
    pasted = [note for note in stage.session.project.score.parts[1].notes if note.id in stage.selected]
    assert [(note.onset_tick, note.pitch) for note in pasted] == [(10 * TPQ, 60), (11 * TPQ, 62)]
    stage.session.select(Selection(frozenset({"1:0"})))
    press_key(stage, Qt.Key.Key_X, CTRL)
    assert len(stage.session.project.score.parts[0].notes) == 7
    assert stage.steps == ["edit.paste_notes", "edit.cut_notes"]


def test_what_others_put_on_the_clipboard_is_refused_in_words(stage: Stage) -> None:
    said: list[str] = []
    stage.session.noticed.connect(lambda message, severity: said.append(message.id))
    QGuiApplication.clipboard().setText("hello")
    stage.do("notes.paste")
    assert said == ["note.nothing_to_paste"]


def uneven(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:1", "1:2"})))
    for _ in range(2):
        stage.do("notes.frame_later")


def test_quantising_is_seen_as_it_is_set_and_one_step(stage: Stage) -> None:
    uneven(stage)
    before = stage.session.project
    steps = len(stage.steps)
    stage.do("notes.quantise")
    popover = stage.panel.quantise
    assert popover.isVisible()
    assert stage.note("1:1").onset_tick == TPQ
    for _ in range(10):
        QTest.keyClick(popover.strength, Qt.Key.Key_Left)
    assert stage.note("1:1").onset_tick == TPQ + 16
    popover.ends.setChecked(True)
    QTest.mouseClick(popover.keep_button, Qt.MouseButton.LeftButton)
    assert not popover.isVisible()
    assert len(stage.steps) == steps + 1
    assert stage.session.document.done[-1].before is before


def test_quantising_is_taken_back_by_escape(stage: Stage) -> None:
    uneven(stage)
    before = stage.session.project
    stage.do("notes.quantise")
    QTest.keyClick(stage.panel.quantise, Qt.Key.Key_Escape)
    assert not stage.panel.quantise.isVisible()
    assert stage.session.project is before


# Seeing


def test_wheels(stage: Stage) -> None:
    roll, axis = stage.roll, stage.roll.axis
    bottom, top = roll.y_range
    stage.hand.wheel((300, 80), 1)
    assert roll.y_range[0] > bottom
    assert roll.y_range[1] - roll.y_range[0] == pytest.approx(top - bottom)
    at = axis.seconds(300)
    stage.hand.wheel((300, 80), 3, CTRL)
    assert axis.span_s < 6.0
    assert axis.seconds(300) == pytest.approx(at)
    start = axis.start_s
    stage.hand.wheel((300, 80), -1, SHIFT)
    assert axis.start_s > start
    pitch = roll.value_at(80)
    rows = roll.y_range[1] - roll.y_range[0]
    stage.hand.wheel((300, 80), 2, ALT)
    assert roll.y_range[1] - roll.y_range[0] < rows
    assert roll.value_at(80) == pytest.approx(pitch)


def test_the_middle_button_pans_both_ways(stage: Stage) -> None:
    roll, axis = stage.roll, stage.roll.axis
    start, bottom = axis.start_s, roll.y_range[0]
    stage.hand.drag((400, 60), (360, 90), button=MIDDLE)
    assert axis.start_s == pytest.approx(start + 40 / axis.px_per_s)
    assert roll.y_range[0] == pytest.approx(bottom + 30 / roll.row_px)
    assert stage.steps == []


def test_zoom_to_selection_and_fit(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:2", "1:3"})))
    press_key(stage, Qt.Key.Key_Z)
    axis = stage.panel.axis
    assert 0.6 < axis.start_s < 1.0
    assert 1.9 < axis.end_s < 2.4
    stage.do("timeline.fit")
    assert axis.start_s == axis.limits_s[0]
    assert 8.0 <= axis.end_s <= 16.0


def test_the_page_turns_while_playing(stage: Stage) -> None:
    axis = stage.panel.axis
    axis.show(0.0, 2.0)
    stage.session.set_playing(True)
    stage.session.set_playhead(1.0)
    assert axis.start_s == 0.0
    stage.session.set_playhead(1.95)
    assert axis.start_s > 1.5
    stage.session.set_follow(False)
    start = axis.start_s
    stage.session.set_playhead(20.0)
    assert axis.start_s == start
    assert not stage.panel.playhead.isVisible()


def test_layout_is_remembered(stage: Stage) -> None:
    panel = stage.panel
    first, second = list(panel.lanes.values())[:2]
    second.set_folded(True)
    panel.stack.shift(second, -1)
    panel.stack.set_height(panel.roll, 300)
    panel.set_ghosts(Ghosts.ALONE)
    state = panel.save_state()
    second.set_folded(False)
    panel.stack.shift(first, -1)
    panel.stack.set_height(panel.roll, None)
    panel.set_ghosts(Ghosts.ALL)
    panel.restore_state(state)
    assert panel.save_state() == state
    panel.restore_state("nonsense")
    assert panel.save_state() == state


# Copying by drag


def test_ctrl_and_a_drag_copy_what_is_selected_in_one_step(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:0", "1:1"})))
    before = stage.session.project
    x, y = stage.middle("1:1")
    to = stage.middle("1:5")[0], stage.place(0, 64)[1]
    hand = stage.hand
    hand.press((x, y), keys=CTRL)
    hand.move(((x + to[0]) / 2, y), CTRL)
    assert stage.roll.plot.cursor().shape() is Qt.CursorShape.DragCopyCursor
    hand.move(to, CTRL)
    hand.release(to, CTRL)
    assert stage.roll.plot.cursor().shape() is Qt.CursorShape.ArrowCursor
    assert stage.steps == ["edit.duplicate_notes"]
    assert stage.selected == {"n:1", "n:2"}
    assert [(stage.note(id).onset_tick, stage.note(id).pitch) for id in ("n:1", "n:2")] == [
        (4 * TPQ, 62),
        (5 * TPQ, 64),
    ]
    assert (stage.note("1:0").onset_tick, stage.note("1:1").onset_tick) == (0, TPQ)
    stage.session.document.undo()
    assert stage.session.project is before


def test_a_copy_is_of_the_note_under_the_hand_where_that_is_not_selected(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:0"})))
    stage.hand.drag(stage.middle("1:2"), (stage.middle("1:3")[0], stage.middle("1:2")[1]), CTRL)
    assert stage.selected == {"n:1"}
    assert (stage.note("n:1").onset_tick, stage.note("n:1").pitch) == (3 * TPQ, 64)


def test_escape_takes_copies_back_and_a_copy_on_its_original_is_none(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:0"})))
    before = stage.session.project
    x, y = stage.middle("1:0")
    hand = stage.hand
    hand.press((x, y), keys=CTRL)
    hand.move(stage.middle("1:4"), CTRL)
    assert stage.session.project is not before
    press_key(stage, Qt.Key.Key_Escape, CTRL)
    assert stage.session.project is before
    assert stage.selected == {"1:0"}
    hand.release(stage.middle("1:4"), CTRL)
    hand.press((x, y), keys=CTRL)
    hand.move(stage.middle("1:4"), CTRL)
    hand.move((x, y), CTRL)
    hand.release((x, y), CTRL)
    assert stage.session.project == before
    assert stage.steps == []


def test_on_macos_option_copies_and_keeps_to_the_grid(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.platform", "darwin")
    x, y = stage.middle("1:2")
    stage.hand.drag((x, y), (stage.middle("1:3")[0] + 2, y), ALT)
    assert stage.note("n:1").onset_tick == 3 * TPQ
    stage.hand.click(stage.middle("1:4"), ALT)
    assert stage.selected == {"1:4"}
    stage.hand.click(stage.middle("1:5"), CTRL)
    assert stage.selected == {"1:4", "1:5"}


def test_a_contact_that_the_motion_breaks_is_said_at_its_note(stage: Stage) -> None:
    performance = Performance(stage.session.project)
    performance.prepare()
    stage.session.set_performance(performance)
    broken = Problem(Message("contact.hand_off", {"side": "left", "gap_mm": 9}), "1:3", 1.5, 2.0)
    stage.session.set_broken({"p1.1.1": (broken,)})
    stage.hand.move(stage.middle("1:3"))
    assert "9 mm" in stage.roll.plot.toolTip()
    stage.roll.plot.repaint()
    front = stage.roll.model.front()
    assert front is not None
    assert stage.roll.model.warned(front[0]) >= {3}
    stage.session.set_broken({})
    stage.hand.move(stage.middle("1:2"))
    stage.hand.move(stage.middle("1:3"))
    assert "9 mm" not in stage.roll.plot.toolTip()


# The notes behind


def test_the_notes_behind_are_drawn_once_until_they_or_what_is_shown_change(stage: Stage) -> None:
    """Selecting and playing redraw no other players' notes, and every change of them is drawn."""
    session, roll = stage.session, stage.roll

    def colour(note_id: str) -> str:
        QApplication.processEvents()
        x, y = stage.middle(note_id)
        picture = roll.plot.grab().toImage()
        ratio = picture.devicePixelRatio()
        return picture.pixelColor(round(x * ratio), round(y * ratio)).name()

    seen = colour("2:5")
    drawn = roll.notes._behind
    session.select(Selection(frozenset({"1:1"})))
    session.set_playhead(2.0)
    assert colour("2:5") == seen
    assert roll.notes._behind is drawn
    old = stage.middle("2:5")
    assert session.attempt(
        Message("edit.move_notes", {"count": 1, "of": ""}), lambda it: notes.move(it, {"2:5"}, 0, -3)
    )
    assert stage.middle("2:5") != old
    assert colour("2:5") == seen
    session.document.undo()
    assert colour("2:5") == seen
    stage.panel.set_ghosts(Ghosts.ALONE)
    assert colour("2:5") != seen


@pytest.mark.parametrize(("dx", "dy"), [(0, 1), (0, -1), (1, 0)])
def test_a_click_just_off_a_note_takes_it(stage: Stage, dx: int, dy: int) -> None:
    """A click 5 px beside a thin row selects the note, so that fingerings can be typed."""
    note, half = stage.note("1:3"), stage.roll.row_px / 2
    x, y = stage.place(note.end_tick, note.pitch) if dx else stage.middle("1:3")
    stage.hand.click((x + 5 * dx, y + dy * (half + 5)))
    assert stage.selected == {"1:3"}
    stage.hand.click((x + 40 * dx, y + dy * (half + 40)))
    assert stage.selected == set()
