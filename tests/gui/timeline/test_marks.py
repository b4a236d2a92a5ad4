"""Marks on the timeline by mouse and keys, compared with the document and with the drawing."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QImage, QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu, QWidget

from app.editor.additions import toggle_mark
from app.editor.design_tokens import LIGHT
from app.editor.selection import EventKey
from app.errors import Message
from app.messages import text
from app.plan.music.written_dynamics import DYNAMIC_TEXTS
from app.project.edit.marks import player_marks, set_marks
from app.score.marks import Mark
from tests.gui.timeline.conftest import SCALE, TPQ, Stage
from tests.gui.timeline.hand import ALT, CTRL, NONE, Hand, Place
from widgets.timeline.lane_layout import LaneState
from widgets.timeline.marks.dynamics_lane import OFFERED, DynamicsLane
from widgets.timeline.marks.glyphs import glyph_path
from widgets.timeline.marks.letters import ASCENT, DESCENT, are_letters, letters_path
from widgets.timeline.model.marks.mark_looks import LOOKS

FRONT = "p1.1.1"
SLUR = Mark("slur", "1:1", "1:3")
ACCENT = Mark("accent", "1:5")
FORTE = Mark("dynamic", tick=2 * TPQ, text="f")
SWELL = Mark("crescendo", tick=3 * TPQ, end_tick=6 * TPQ)


@pytest.fixture
def marked(stage: Stage) -> Stage:
    """The timeline with marks in the first player's score."""
    project = stage.session.project
    first, *others = project.score.parts
    part = msgspec.structs.replace(first, marks=(SLUR, ACCENT, FORTE, SWELL))
    stage.session.document.open(replace(project, score=msgspec.structs.replace(project.score, parts=(part, *others))))
    stage.panel.axis.show(-0.5, 6.0)
    QApplication.processEvents()
    return stage


def marks(stage: Stage, player: str = FRONT) -> dict[Mark, str]:
    return dict(player_marks(stage.session.project, player))


def chosen(stage: Stage) -> set[EventKey]:
    return set(stage.session.selection.events)


def where(stage: Stage, mark: Mark) -> Place:
    """Point of the roll at which a mark is grabbed."""
    placed, item = stage.roll.marks.placed, stage.roll.marks
    assert placed is not None
    place = placed.place_of(item.marks.of_player.by_id[mark.id])
    assert place is not None
    return place


def ends(stage: Stage, mark: Mark) -> tuple[Place, Place]:
    placed = stage.roll.marks.placed
    assert placed is not None
    at = placed.arcs.mark.tolist().index(stage.roll.marks.marks.of_player.by_id[mark.id])
    x0, y0, x1, y1 = (float(column[at]) for column in placed.arcs[1:5])
    return (x0, y0), (x1, y1)


def lane(stage: Stage) -> DynamicsLane:
    return stage.panel.dynamics


def in_lane(stage: Stage, tick: float) -> Place:
    seconds = stage.session.project.score.tempo_map.seconds(float(tick))
    return lane(stage).axis.x_px(seconds), lane(stage).plot_rect.height() / 2


def on_letters(stage: Stage, mark: Mark) -> Place:
    x, y = in_lane(stage, mark.tick)
    return x + 4.0, y


def press_key(stage: Stage, key: Qt.Key) -> None:
    stage.table.refresh()
    QTest.keyClick(stage.roll.plot, key)
    QApplication.processEvents()


def test_a_click_selects_a_mark_and_delete_removes_it(marked: Stage) -> None:
    before = marked.session.project
    for mark in (SLUR, ACCENT):
        marked.hand.click(where(marked, mark))
        assert chosen(marked) == {EventKey(FRONT, mark.id)}
        assert marked.selected == set()
        press_key(marked, Qt.Key.Key_Delete)
        assert mark not in marks(marked)
        assert len(marks(marked)) == 3
        marked.session.document.undo()
        assert marked.session.project is before
    # A note below a slur is a note.
    marked.hand.click(marked.middle("1:2"))
    assert marked.selected == {"1:2"}
    assert not chosen(marked)


def test_ctrl_toggles_marks_and_all_chosen_go_in_one_step(marked: Stage) -> None:
    marked.hand.click(where(marked, SLUR))
    marked.hand.click(where(marked, ACCENT), CTRL)
    Hand(lane(marked).plot).click(on_letters(marked, FORTE), CTRL)
    assert len(chosen(marked)) == 3
    marked.hand.click(where(marked, ACCENT), CTRL)
    assert chosen(marked) == {EventKey(FRONT, SLUR.id), EventKey(FRONT, FORTE.id)}
    marked.do("edit.delete")
    assert set(marks(marked)) == {ACCENT, SWELL}
    assert len(marked.steps) == 1


@pytest.mark.parametrize(
    ("end", "to_note", "first", "last"),
    [
        (1, "1:5", "1:1", "1:5"),
        (1, "1:2", "1:1", "1:2"),
        (0, "1:0", "1:0", "1:3"),
        # An end stays on its side of the other.
        (1, "1:0", "1:1", "1:2"),
        (0, "1:6", "1:2", "1:3"),
    ],
)
def test_the_end_of_a_slur_is_dragged_to_a_note(marked: Stage, end: int, to_note: str, first: str, last: str) -> None:
    before = marked.session.project
    marked.hand.drag(ends(marked, SLUR)[end], marked.middle(to_note))
    moved = Mark("slur", first, last)
    assert marks(marked)[moved] == "hand"
    assert SLUR not in marks(marked)
    assert chosen(marked) == {EventKey(FRONT, moved.id)}
    assert marked.steps == ["edit.move_mark"]
    marked.session.document.undo()
    assert marked.session.project is before


def test_an_articulation_is_dragged_to_another_note(marked: Stage) -> None:
    x, y = where(marked, ACCENT)
    marked.hand.drag((x, y), (marked.middle("1:6")[0], y))
    assert Mark("accent", "1:6") in marks(marked)
    assert ACCENT not in marks(marked)


def test_a_drag_that_is_cancelled_or_ends_where_it_began_changes_nothing(marked: Stage) -> None:
    before = marked.session.project
    start = ends(marked, SLUR)[1]
    marked.hand.press(start)
    marked.hand.move(marked.middle("1:6"))
    shown = marked.roll.marks.marks.preview
    assert shown is not None
    assert shown[1] == Mark("slur", "1:1", "1:6")
    press_key(marked, Qt.Key.Key_Escape)
    marked.hand.release(marked.middle("1:6"))
    assert marked.roll.marks.marks.preview is None
    marked.hand.drag(start, (start[0] + 8.0, start[1]))
    assert marked.session.project is before
    assert marked.steps == []


def test_a_dynamic_is_dragged_on_the_grid(marked: Stage) -> None:
    hand, step = Hand(lane(marked).plot), TPQ // 4
    start = on_letters(marked, FORTE)
    by = in_lane(marked, 2.3 * step)[0] - in_lane(marked, 0)[0]
    hand.drag(start, (start[0] + by, start[1]))
    moved = msgspec.structs.replace(FORTE, tick=FORTE.tick + 2 * step)
    assert marks(marked)[moved] == "hand"
    assert FORTE not in marks(marked)
    start = on_letters(marked, moved)
    hand.drag(start, (start[0] - by, start[1]), ALT)
    [free] = [mark for mark in marks(marked) if mark.kind == "dynamic"]
    assert abs(free.tick - (moved.tick - 2.3 * step)) <= 12
    assert free.tick % step


def test_a_hairpin_is_dragged_by_its_ends_and_whole(marked: Stage) -> None:
    hand, (end_x, y) = Hand(lane(marked).plot), in_lane(marked, SWELL.end_tick)
    hand.drag((end_x - 2.0, y), (in_lane(marked, 8 * TPQ)[0] - 2.0, y))
    longer = Mark("crescendo", tick=SWELL.tick, end_tick=8 * TPQ)
    assert longer in marks(marked)
    middle, later = in_lane(marked, 5 * TPQ), in_lane(marked, 6 * TPQ)
    hand.drag(middle, later)
    moved = Mark("crescendo", tick=4 * TPQ, end_tick=9 * TPQ)
    assert moved in marks(marked)
    # The beginning goes no further than the end.
    hand.drag((in_lane(marked, moved.tick)[0] + 2.0, y), in_lane(marked, 10 * TPQ))
    [last] = [mark for mark in marks(marked) if mark.kind == "crescendo"]
    assert (last.tick, last.end_tick) == (9 * TPQ - TPQ // 4, 9 * TPQ)
    assert len(marks(marked)) == 4


def choose(text: str) -> None:
    """Choose a dynamic in the open list."""
    [menu] = [widget for widget in QApplication.topLevelWidgets() if isinstance(widget, QMenu) and widget.isVisible()]
    [entry] = [action for action in menu.actions() if action.objectName() == f"dynamic_{text}"]
    entry.trigger()
    menu.close()
    QApplication.processEvents()


def double_click(stage: Stage, place: Place) -> None:
    Hand(lane(stage).plot).double_click(place)
    QApplication.processEvents()


def test_a_double_click_changes_a_dynamic_or_adds_one(marked: Stage) -> None:
    double_click(marked, on_letters(marked, FORTE))
    choose("pp")
    quiet = msgspec.structs.replace(FORTE, text="pp")
    assert marks(marked)[quiet] == "hand"
    assert FORTE not in marks(marked)
    assert chosen(marked) == {EventKey(FRONT, quiet.id)}
    double_click(marked, in_lane(marked, TPQ + 5))
    choose("sfz")
    assert marks(marked)[Mark("dynamic", tick=TPQ, text="sfz")] == "hand"
    assert marked.steps == ["edit.set_dynamic", "edit.add_dynamic"]
    place = marked.session.project.metre_map.label(TPQ)
    assert str(marked.session.document.done[-1].name.arguments["of"]).endswith(f" · {place}")
    # By the keyboard, too.
    QTest.keyClick(lane(marked).plot, Qt.Key.Key_Return)
    choose("mf")
    assert Mark("dynamic", tick=TPQ, text="mf") in marks(marked)


def test_a_dynamic_at_one_midi_note_says_how_far_it_holds_and_shows_it(stage: Stage) -> None:
    noted: list[Message] = []
    stage.session.noticed.connect(lambda message, _: noted.append(message))
    first, later = stage.note("1:1"), stage.note("1:5")
    stage.hand.click(stage.middle("1:1"))
    toggle_mark(stage.session, {FRONT: [first]}, "dynamic", "f")
    assert [(message.id, text(message)) for message in noted] == [
        ("mark.holds_to_the_end", "f holds to the end of the piece: no dynamic follows.")
    ]
    QApplication.processEvents()
    [placed] = lane(stage).placed()
    last = stage.session.project.score.parts[0].notes[-1]
    assert placed.holds_px == pytest.approx(in_lane(stage, last.end_tick)[0], abs=1.0)
    # The line of this mark has no end that could be dragged.
    assert lane(stage).placed()[0].end_px is None
    noted.clear()
    toggle_mark(stage.session, {FRONT: [later]}, "dynamic", "p")
    stage.session.document.undo()
    stage.session.attempt(
        Message("edit.add_dynamic", {"of": "1"}),
        lambda p: set_marks(p, FRONT, [Mark("dynamic", tick=later.onset_tick, text="p")]),
    )
    noted.clear()
    double_click(stage, on_letters(stage, Mark("dynamic", tick=first.onset_tick, text="f")))
    choose("mf")
    label = stage.session.project.metre_map.label(later.onset_tick)
    assert [text(message) for message in noted] == [f"mf holds up to {label}."]
    assert lane(stage).placed()[0].holds_px == pytest.approx(in_lane(stage, later.onset_tick)[0], abs=1.0)
    # Over several notes, the text names the end of the last one.
    noted.clear()
    toggle_mark(stage.session, {FRONT: [stage.note("1:2"), stage.note("1:3")]}, "dynamic", "pp")
    assert [message.arguments["place"] for message in noted] == [
        stage.session.project.metre_map.label(stage.note("1:3").end_tick)
    ]
    # A sforzando is of one note.
    noted.clear()
    toggle_mark(stage.session, {FRONT: [later]}, "dynamic", "sfz")
    assert not noted


def test_two_dynamics_at_one_tick_stand_side_by_side_and_go_one_by_one(marked: Stage) -> None:
    struck = msgspec.structs.replace(FORTE, text="sfz")
    marked.session.attempt(Message("edit.add_dynamic", {"of": "1"}), lambda p: set_marks(p, FRONT, [struck]))
    QApplication.processEvents()
    placed = {marks_of(marked)[one.mark]: one.box for one in lane(marked).placed()}
    assert placed[FORTE].right < placed[struck].left
    Hand(lane(marked).plot).click((placed[struck].left + 3.0, in_lane(marked, 0)[1]))
    assert chosen(marked) == {EventKey(FRONT, struck.id)}
    marked.do("edit.delete")
    assert set(marks(marked)) == {SLUR, ACCENT, FORTE, SWELL}


def marks_of(stage: Stage) -> list[Mark]:
    return lane(stage).marks.of_player.marks


def right_click(widget: QWidget, place: Place) -> None:
    point, button = QPointF(*place), Qt.MouseButton.RightButton
    for kind in (QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonRelease):
        QApplication.sendEvent(widget, QMouseEvent(kind, point, point, button, button, NONE))
    QApplication.processEvents()


def test_the_menu_of_a_mark_deletes_and_gives_back(marked: Stage) -> None:
    marked.session.attempt(Message("edit.move_mark"), lambda p: set_marks(p, FRONT, [Mark("fermata", "1:7")]))
    QApplication.processEvents()
    for place in (where(marked, ACCENT), where(marked, Mark("fermata", "1:7"))):
        count = len(marks(marked))
        marked.table.refresh()
        right_click(marked.roll.plot, place)
        [menu] = [w for w in QApplication.topLevelWidgets() if isinstance(w, QMenu) and w.isVisible()]
        wanted = "edit.delete" if count == 5 else "events.give_back"
        action = marked.table.actions[wanted]
        assert action in menu.actions()
        assert action.isEnabled(), wanted
        action.trigger()
        menu.close()
        QApplication.processEvents()
        assert len(marks(marked)) == count - 1


def test_a_mark_under_the_mouse_says_what_it_is_and_where_it_is_from(marked: Stage) -> None:
    marked.session.attempt(Message("edit.move_mark"), lambda p: set_marks(p, FRONT, [Mark("tenuto", "1:0")]))
    QApplication.processEvents()
    marked.hand.move(where(marked, SLUR))
    from_score = marked.roll.plot.toolTip().split("\n")
    marked.hand.move(where(marked, Mark("tenuto", "1:0")))
    by_hand = marked.roll.plot.toolTip().split("\n")
    assert len(from_score) == len(by_hand) == 2
    assert from_score[0] != by_hand[0]
    assert from_score[1] != by_hand[1]
    Hand(lane(marked).plot).move(on_letters(marked, FORTE))
    assert lane(marked).plot.toolTip().split("\n")[0].endswith(" f")
    marked.hand.move(marked.place(0.5 * TPQ, 50))
    assert marked.roll.plot.toolTip() == ""


# Pixels


def pixels(stage: Stage) -> np.ndarray:
    """Pixels of the roll without overlays."""
    image: QImage = stage.roll.plot.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    rows = np.frombuffer(image.constBits(), np.uint32).reshape(image.height(), image.bytesPerLine() // 4)
    return rows[:, : image.width()].copy()


def drawn(stage: Stage) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of the pixels drawn for marks."""
    with_marks = pixels(stage)
    # The lane of dynamics stays: the roll keeps its size.
    stage.roll.marks.set_shown(False)
    without = pixels(stage)
    stage.roll.marks.set_shown(True)
    found = np.nonzero(with_marks != without)
    return found[0], found[1]


@pytest.mark.parametrize("light", [False, True])
def test_a_slur_goes_over_its_notes_from_the_first_to_the_last(stage: Stage, light: bool) -> None:
    if light:
        stage.session.set_tokens(LIGHT)
    stage.session.attempt(Message("edit.move_mark"), lambda p: set_marks(p, FRONT, [SLUR]))
    rows, columns = drawn(stage)
    first, last = stage.note("1:1"), stage.note("1:3")
    left = stage.place(first.onset_tick, first.pitch)[0]
    right = stage.place(last.end_tick, last.pitch)[0]
    assert left <= columns.min() <= left + 12
    assert right - 12 <= columns.max() <= right
    # Without a gap, and above the notes below it.
    assert set(range(columns.min(), columns.max())) <= set(columns.tolist())
    for note_id in ("1:1", "1:2", "1:3"):
        note = stage.note(note_id)
        start, end = stage.place(note.onset_tick, 0)[0], stage.place(note.end_tick, 0)[0]
        over = rows[(columns >= start) & (columns < end)]
        top = stage.roll.y_px(note.pitch + 1)
        assert over.max() <= top
        assert over.min() >= top - 60


def test_marks_are_drawn_again_where_a_scroll_brings_them(marked: Stage) -> None:
    axis = marked.panel.axis
    before_rows, before = drawn(marked)
    for _ in range(3):
        axis.pan_px(-40)
        _, now = drawn(marked)
        assert abs((before.min() - 40) - now.min()) <= 1
        before = now
    assert len(before_rows)


def test_hidden_marks_are_neither_drawn_nor_caught_and_that_is_remembered(marked: Stage) -> None:
    place = where(marked, SLUR)
    assert lane(marked).isVisible()
    marked.do("timeline.marks")
    assert not marked.panel.marks_shown
    assert lane(marked).isHidden()
    marked.hand.click(place)
    assert not chosen(marked)
    state = marked.panel.save_state()
    marked.do("timeline.marks")
    assert lane(marked).isVisible()
    assert where(marked, SLUR) == place
    marked.panel.restore_state(state)
    assert not marked.panel.marks_shown
    # A layout of an older version has no marks.
    marked.panel.restore_state('{"order": ["audio", "roll"]}')
    assert marked.panel.marks_shown


def test_the_lane_of_dynamics_comes_with_the_first_one(stage: Stage) -> None:
    assert lane(stage).isHidden()
    stage.session.attempt(Message("edit.add_dynamic", {"of": "1"}), lambda p: set_marks(p, FRONT, [FORTE]))
    assert lane(stage).isVisible()
    stage.session.document.undo()
    assert lane(stage).isHidden()


def test_a_saved_order_without_the_lane_has_it_below_the_notes(marked: Stage) -> None:
    known = [id for id in marked.panel.lane_layout.state.order if id != "dynamics"]
    moved = (*known[1:], known[0])
    marked.panel.lane_layout.set_state(LaneState(order=moved))
    order = marked.panel.lane_layout.state.order
    assert [id for id in order if id != "dynamics"] == list(moved)
    assert order.index("dynamics") == order.index("roll") + 1


def test_others_have_no_marks(marked: Stage) -> None:
    marked.session.set_players(("p2.1.1",))
    rows, _ = drawn(marked)
    assert not len(rows)
    assert lane(marked).placed() == ()


def test_notes_too_small_have_no_marks(marked: Stage) -> None:
    assert len(drawn(marked)[0])
    marked.roll.choose_pitches(0.0, 128.0)
    assert not len(drawn(marked)[0])


def test_a_note_that_is_dragged_takes_its_marks_along(marked: Stage) -> None:
    x, y = where(marked, ACCENT)
    start = marked.middle("1:5")
    up = marked.place(0, SCALE[5])[1] - marked.place(0, SCALE[5] + 4)[1]
    marked.hand.drag(start, (start[0], start[1] - up))
    now = where(marked, ACCENT)
    assert abs(now[0] - x) <= 1
    assert abs(now[1] - (y - up)) <= 1.5


@pytest.mark.parametrize("kind", sorted(LOOKS))
def test_a_glyph_fills_the_room_that_it_is_given(kind: str) -> None:
    look, unit = LOOKS[kind], 6.0
    box = glyph_path(kind, unit).boundingRect()
    if look.is_text or look.place == "next":
        assert box.isEmpty()
        return
    assert 0.6 * look.width * unit <= box.width() <= 1.25 * look.width * unit
    assert 0.6 * look.height * unit <= box.height() <= 1.35 * look.height * unit
    if look.place == "stack":
        assert box.bottom() <= 0.35 * unit
        assert abs(box.center().x()) <= 0.35 * unit


@pytest.mark.parametrize("text", OFFERED)
def test_the_dynamics_offered_have_letters_and_a_meaning(text: str) -> None:
    assert are_letters(text)
    assert text in DYNAMIC_TEXTS
    path, width = letters_path(text, 10.0)
    box = path.boundingRect()
    assert abs(box.width() - width) <= 10.0
    assert -ASCENT * 10.0 - 2.0 <= box.top() < box.bottom() <= DESCENT * 10.0 + 2.0
