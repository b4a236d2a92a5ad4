"""Camera bookmarks by keys, menus and mouse."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QMenu, QWidget
from pytestqt.qtbot import QtBot

from app.project.storage import load
from app.shell.app import Program
from tests.gui.shell.conftest import Answers
from tests.support.windows import child, wait_until
from widgets.common.actions import actions
from widgets.viewport.camera import Camera

pytestmark = pytest.mark.drawn
CONTROL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


def _canvas(program: Program) -> QWidget:
    widget = program.window.viewport.canvas_widget()
    assert widget is not None
    widget.setFocus()
    return widget


def _press(program: Program, key: Qt.Key, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    QTest.keyClick(_canvas(program), key, modifier)
    QApplication.processEvents()


def _near(one: Camera, other: Camera) -> bool:
    """Return whether two cameras have nearly the same view; a close-up's target moves with the player."""
    directions = one.yaw_rad, one.pitch_rad, one.distance_m
    return directions == pytest.approx((other.yaw_rad, other.pitch_rad, other.distance_m), abs=1e-6)


def _kept(program: Program) -> tuple[Camera, Camera]:
    """Store a rotated close-up of the third player's hands, then a wide view."""
    session, panel = program.session, program.window.viewport
    wait_until(lambda: panel.scene.stage is not None and bool(panel.scene.stage.shown.all()))
    session.set_players((session.project.players[2].id,))
    _press(program, Qt.Key.Key_5)
    panel._eye.jump(panel.camera)
    panel._eye.orbit(40.0, -20.0)
    panel._eye.pan(12.0, 5.0, 400.0)
    hands = panel.camera
    _press(program, Qt.Key.Key_B, CONTROL)
    session.set_players((session.project.players[0].id,))
    _press(program, Qt.Key.Key_1)
    panel._eye.jump(panel.camera)
    panel._eye.dolly(-3.0)
    wide = panel.camera
    _press(program, Qt.Key.Key_B, CONTROL)
    return hands, wide


def test_keys_keep_and_recall_a_camera_with_its_player(program: Program) -> None:
    session, panel = program.session, program.window.viewport
    hands, wide = _kept(program)
    assert [camera.name for camera in session.project.cameras] == ["Camera 1", "Camera 2"]
    _press(program, Qt.Key.Key_4)
    _press(program, Qt.Key.Key_1, SHIFT)
    assert session.player is session.project.players[2]
    assert session.viewport.view == "hands"
    assert _near(panel.camera, hands)
    assert panel.camera.target_m == pytest.approx(hands.target_m, abs=0.01)
    _press(program, Qt.Key.Key_2, SHIFT)
    assert (panel.camera.target_m, _near(panel.camera, wide)) == (pytest.approx(wide.target_m), True)
    session.document.undo()
    assert [camera.name for camera in session.project.cameras] == ["Camera 1"]


def test_a_camera_is_saved_with_the_project(program: Program, answers: Answers, tmp_path: Path) -> None:
    _kept(program)
    answers.path = tmp_path / "piece.suisou"
    program.editor.files.save()
    assert load(answers.path).cameras == program.session.project.cameras


def test_it_is_overwritten_renamed_and_deleted(qtbot: QtBot, program: Program) -> None:
    session = program.session
    _kept(program)
    _press(program, Qt.Key.Key_1, SHIFT)
    _press(program, Qt.Key.Key_6)
    _press(program, Qt.Key.Key_B, CONTROL | SHIFT)
    assert [camera.view for camera in session.project.cameras] == ["mouth", "ensemble"]
    actions(session)["cameras.rename"].trigger()
    field = child(program.window, QLineEdit, "camera_name")
    QTest.keyClicks(field, "Trio, mouth")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert [camera.name for camera in session.project.cameras] == ["Trio, mouth", "Camera 2"]
    QApplication.processEvents()
    assert actions(session)["cameras.recall_1"].text().endswith("Trio, mouth")
    actions(session)["cameras.rename"].trigger()
    field = next(one for one in program.window.findChildren(QLineEdit, "camera_name") if one.isVisible())
    QTest.keyClicks(field, "Camera 2")
    QTest.keyClick(field, Qt.Key.Key_Escape)
    actions(session)["cameras.remove"].trigger()
    assert [camera.name for camera in session.project.cameras] == ["Camera 2"]


def test_where_saving_is_undone_the_camera_before_is_in_hand_again(program: Program) -> None:
    session = program.session
    _kept(program)
    session.document.undo()
    program.editor.table.refresh()
    actions(session)["cameras.remove"].trigger()
    assert session.project.cameras == ()
    program.editor.table.refresh()
    assert not actions(session)["cameras.update"].isEnabled()


def test_menus_list_the_cameras(program: Program) -> None:
    _kept(program)
    menus = child(program.window, QMenu, "menu_view_cameras"), child(program.window, QMenu, "viewport_camera_menu")
    for menu in menus:
        menu.aboutToShow.emit()
        listed = [row.text() for row in menu.actions() if row.isVisible() and row.objectName().startswith("cameras.r")]
        assert [text.rpartition(": ")[2] for text in listed[:2]] == ["Camera 1", "Camera 2"]
    row = next(row for row in menus[1].actions() if isinstance(row, QAction) and row.objectName() == "cameras.recall_1")
    row.trigger()
    assert program.session.viewport.view == "hands"


def test_a_film_is_seen_by_a_saved_camera(program: Program) -> None:
    session, panel = program.session, program.window.viewport
    _kept(program)
    by_camera = panel.film(160, 90, (4.0, 4.2), session.project.cameras[0])(4.0)
    _press(program, Qt.Key.Key_1, SHIFT)
    session.set_playhead(4.0)
    panel._eye.jump(panel.camera)
    panel._eye._last_s -= 100.0
    panel.refresh()
    as_shown = panel.film(160, 90, (4.0, 4.2))(4.0)
    other = panel.film(160, 90, (4.0, 4.2), "ensemble")(4.0)
    assert np.abs(by_camera.astype(int) - as_shown).mean() < 0.5 < np.abs(by_camera.astype(int) - other).mean()
