"""Cuts of a motion moved, added and deleted by mouse and keys, compared with the resulting choreography."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QCheckBox, QLabel, QPushButton, QToolButton
from pytestqt.qtbot import QtBot

from app.choreography.body import SEGMENTS
from app.choreography.body_pose import body_pose
from app.choreography.cuts import Cut, segment
from app.choreography.cuts_by_hand import bounds, extrema
from app.choreography.model_file import read_model
from app.choreography.read_motion import read_motion
from app.editor.session import Session
from tests.gui.choreography.test_learn_dialog import drop, press, row_texts, select, shown, type_number
from tests.support.damaged import damaged
from tests.support.dances import stepping
from tests.support.windows import child
from tests.unit.choreography.test_command import write_clip, write_drums
from tests.unit.choreography.test_cuts import arm_swings
from widgets.dialogs.choreography.cut_plot import CutLine, CutPlot
from widgets.dialogs.choreography.learn import LearnDialog

FOUND = segment(arm_swings(60)).cuts


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_clip(tmp_path / "swings.bvh", arm_swings(60))
    write_clip(tmp_path / "steps.bvh", stepping(12))
    write_drums(tmp_path / "drums.mid")
    return tmp_path


@pytest.fixture
def dialog(session: Session, qtbot: QtBot, folder: Path) -> LearnDialog:
    made = shown(session, qtbot, folder)
    drop(made, folder / "swings.bvh", folder / "drums.mid")
    type_number(made, "learn_offset", "1")
    assert plot(made).cuts == FOUND
    return made


def plot(dialog: LearnDialog) -> CutPlot:
    return dialog.cuts.plot


def at(dialog: LearnDialog, frame: float, part: float = 0.3) -> QPoint:
    """Point of a frame in the plot at a share of the plot's height from the top."""
    view = plot(dialog).plot.viewport()
    return QPoint(round(plot(dialog).x_px(frame)), round(part * view.height()))


def drag(dialog: LearnDialog, start: QPoint, end: QPoint, keys: Qt.KeyboardModifier | None = None) -> None:
    view = plot(dialog).plot.viewport()
    modifiers = Qt.KeyboardModifier.NoModifier if keys is None else keys
    QTest.mousePress(view, Qt.MouseButton.LeftButton, modifiers, start)
    for step in (1, 2, 3, 4):
        QTest.mouseMove(view, start + (end - start) * (step / 4))
        QApplication.processEvents()
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, modifiers, end)


def snap(dialog: LearnDialog, on: bool) -> None:
    box = child(dialog, QCheckBox, "cut_snap")
    assert isinstance(box, QCheckBox)
    if box.isChecked() is not on:
        QTest.mouseClick(box, Qt.MouseButton.LeftButton, pos=QPoint(8, box.height() // 2))
    assert plot(dialog).snaps is on


def key(dialog: LearnDialog, key: Qt.Key, modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    QTest.keyClick(plot(dialog).plot, key, modifiers)
    QApplication.processEvents()


CTRL = Qt.KeyboardModifier.ControlModifier


def test_a_cut_that_is_dragged_is_in_the_choreography(dialog: LearnDialog, folder: Path) -> None:
    snap(dialog, on=False)
    moved = FOUND[2].end
    target = at(dialog, moved + 5)
    expected = plot(dialog).frame_at(target.x())
    assert expected != moved
    drag(dialog, at(dialog, moved), target)
    press(dialog, "learn_start")
    model = read_model(folder / "choreography.choreography")
    cuts = [Cut(one.start, one.accent, one.end) for one in model.segments]
    requested = [Cut(cut.start, cut.accent, expected if cut.end == moved else cut.end) for cut in FOUND]
    requested = [Cut(expected if cut.start == moved else cut.start, cut.accent, cut.end) for cut in requested]
    assert cuts == requested
    assert model.sources[0].cuts_given
    assert not child(dialog, QToolButton, "cut_redo").isEnabled()
    # A drag is one step.
    QTest.mouseClick(child(dialog, QToolButton, "cut_undo"), Qt.MouseButton.LeftButton)
    assert plot(dialog).cuts == FOUND
    assert dialog.drafts[0].cuts is None
    assert not child(dialog, QToolButton, "cut_undo").isEnabled()


def test_the_mouse_shows_where_a_line_can_be_dragged(dialog: LearnDialog) -> None:
    view = plot(dialog).plot.viewport()
    lines = sorted({frame for cut in FOUND for frame in (cut.start, cut.accent, cut.end)})
    # Two lines that have room between them for a place that is near neither.
    first, second = max(pairwise(lines), key=lambda pair: pair[1] - pair[0])
    on_line, beside = at(dialog, first), at(dialog, (first + second) / 2)
    for place, shape in ((on_line, Qt.CursorShape.SplitHCursor), (beside, Qt.CursorShape.ArrowCursor)) * 2:
        none, keys = Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier
        local, screen = QPointF(place), QPointF(view.mapToGlobal(place))
        QApplication.sendEvent(view, QMouseEvent(QEvent.Type.MouseMove, local, screen, none, none, keys))
        assert view.cursor().shape() == shape


def test_a_dragged_line_stops_at_what_is_near(dialog: LearnDialog) -> None:
    curve = segment(arm_swings(60)).curve_rad_s2
    minima, maxima = extrema(curve)
    plot(dialog).zoom(4.0, FOUND[3].accent / 60.0)
    for frame, accent in ((FOUND[3].accent, True), (FOUND[3].end, False)):
        away = at(dialog, frame + 5)
        drag(dialog, at(dialog, frame), away)
        changed = plot(dialog).cuts[3]
        key(dialog, Qt.Key.Key_Z, CTRL)
        places = maxima if accent else minima
        dropped = plot(dialog).frame_at(away.x())
        near = int(places[np.abs(places - dropped).argmin()])
        reach = abs(plot(dialog).x_px(near) - away.x())
        assert (changed.accent if accent else changed.end) == (near if reach <= 12.0 else dropped)


def test_cuts_are_added_and_deleted_and_all_is_undone_and_redone(dialog: LearnDialog) -> None:
    view = plot(dialog).plot.viewport()
    middle = (FOUND[4].start + FOUND[4].accent) // 2
    place = at(dialog, middle)
    frame = plot(dialog).frame_at(place.x())
    QTest.mouseDClick(view, Qt.MouseButton.LeftButton, pos=place)
    added = plot(dialog).cuts
    assert set(bounds(added)) == {*bounds(FOUND), frame}
    assert plot(dialog).selected == CutLine("bound", bounds(added).index(frame))
    assert row_texts(dialog, 0)[3] == "11"
    key(dialog, Qt.Key.Key_Right)
    assert frame + 1 in bounds(plot(dialog).cuts)
    key(dialog, Qt.Key.Key_Delete)
    deleted = plot(dialog).cuts
    assert bounds(deleted) == bounds(FOUND)
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=at(dialog, FOUND[0].end))
    key(dialog, Qt.Key.Key_Delete)
    joined = plot(dialog).cuts
    assert (joined[0].start, joined[0].end) == (FOUND[0].start, FOUND[1].end)
    for _ in range(4):
        key(dialog, Qt.Key.Key_Z, CTRL)
    assert plot(dialog).cuts == FOUND
    for _ in range(4):
        key(dialog, Qt.Key.Key_Z, CTRL | Qt.KeyboardModifier.ShiftModifier)
    assert plot(dialog).cuts == joined
    press(dialog, "cut_reset")
    assert plot(dialog).cuts == FOUND
    key(dialog, Qt.Key.Key_Z, CTRL)
    assert plot(dialog).cuts == joined


def test_each_pair_has_its_own_cuts(dialog: LearnDialog, folder: Path) -> None:
    QTest.mouseClick(plot(dialog).plot.viewport(), Qt.MouseButton.LeftButton, pos=at(dialog, FOUND[0].end))
    key(dialog, Qt.Key.Key_Delete)
    first = plot(dialog).cuts
    drop(dialog, folder / "steps.bvh", folder / "drums.mid")
    assert plot(dialog).cuts == segment(read_motion(folder / "steps.bvh").clip).cuts
    assert not child(dialog, QToolButton, "cut_undo").isEnabled()
    key(dialog, Qt.Key.Key_Z, CTRL)
    select(dialog, 0)
    assert plot(dialog).cuts == first
    # Other music leaves the cuts; a true frame rate is another motion.
    type_number(dialog, "learn_offset", "1.5")
    assert plot(dialog).cuts == first
    type_number(dialog, "learn_fps", "30")
    assert dialog.drafts[0].cuts is None
    assert child(dialog, QPushButton, "learn_start").isEnabled()


def test_lines_are_reached_by_keys(dialog: LearnDialog) -> None:
    plot(dialog).plot.setFocus()
    key(dialog, Qt.Key.Key_Right, CTRL)
    assert plot(dialog).selected == CutLine("bound", 0)
    key(dialog, Qt.Key.Key_Right, CTRL)
    assert plot(dialog).selected == CutLine("accent", 0)
    key(dialog, Qt.Key.Key_Left)
    assert plot(dialog).cuts[0].accent == FOUND[0].accent - 1
    # Deleting an accent puts it back to its maximum.
    key(dialog, Qt.Key.Key_Delete)
    assert plot(dialog).cuts[0].accent == FOUND[0].accent


def test_the_plot_zooms_at_the_mouse_scrolls_and_pans(dialog: LearnDialog) -> None:
    view = plot(dialog).plot.viewport()
    pointer = at(dialog, 200)

    def wheel(turned: int, keys: Qt.KeyboardModifier) -> None:
        where = QPointF(pointer)
        event = QWheelEvent(
            where, QPointF(view.mapToGlobal(pointer)), QPoint(), QPoint(0, turned), Qt.MouseButton.NoButton, keys,
            Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(view, event)

    whole = plot(dialog).view.viewRange()[0]
    for _ in range(6):
        wheel(120, CTRL)
    left, right = plot(dialog).view.viewRange()[0]
    assert right - left == pytest.approx((whole[1] - whole[0]) / 1.2**6)
    assert abs(plot(dialog).frame_at(pointer.x()) - 200) <= 1
    wheel(-120, Qt.KeyboardModifier.NoModifier)
    scrolled = plot(dialog).view.viewRange()[0]
    assert scrolled[0] == pytest.approx(left + 0.1 * (right - left))
    under = plot(dialog).frame_at(at(dialog, 225).x())
    empty = at(dialog, 225)
    drag(dialog, empty, empty + QPoint(40, 0))
    assert plot(dialog).cuts == FOUND
    assert abs(plot(dialog).frame_at(empty.x() + 40) - under) <= 1
    key(dialog, Qt.Key.Key_F)
    assert plot(dialog).view.viewRange()[0] == pytest.approx(whole)


def test_the_pose_under_the_mouse_is_drawn(dialog: LearnDialog, qtbot: QtBot) -> None:
    view = plot(dialog).plot.viewport()
    unseen = dialog.cuts.figure.pose
    QTest.mouseMove(view, at(dialog, 60))
    qtbot.waitUntil(lambda: dialog.cuts.figure.pose is not unseen)
    # The arms are up after the first swing, and level before it.
    before = dialog.cuts.figure.pose
    place = at(dialog, 120)
    QTest.mouseMove(view, place)
    qtbot.waitUntil(lambda: dialog.cuts.figure.pose is not before)
    after = dialog.cuts.figure.pose
    assert before is not None
    assert after is not None
    hand = SEGMENTS.index("leftHand")
    assert after.points[hand, 1] > before.points[hand, 1] + 0.2
    clip = read_motion(dialog.drafts[0].motion).clip
    drawn = body_pose(clip, plot(dialog).frame_at(place.x()))
    assert after.points == pytest.approx(drawn.points, abs=1e-4)


def test_sections_that_are_left_out_are_shaded(session: Session, qtbot: QtBot, folder: Path) -> None:
    clip = arm_swings(60)
    spoilt = damaged(clip, "flip", "rightUpperLeg", 300, 40, np.array((1.0, 0.0, 0.0)))
    write_clip(folder / "spoilt.bvh", spoilt)
    dialog = shown(session, qtbot, folder)
    drop(dialog, folder / "spoilt.bvh", folder / "drums.mid")
    ((start, stop),) = plot(dialog).unfit
    assert 294 <= start < 300 < 340 <= stop < 346
    assert 0 < len(plot(dialog).cuts) < len(FOUND)
    assert not any(cut.start < stop and start < cut.end for cut in plot(dialog).cuts)
    notes = child(dialog, QLabel, "learn_pair_notes").text()
    assert "left out: 4.9" in notes
    assert "rightUpperLeg" in notes
