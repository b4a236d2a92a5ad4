"""Choice of the skeleton in the export dialog by mouse and keys, with comparison to an asset's file."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QCheckBox, QComboBox, QLabel, QLineEdit, QPushButton
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.export.character import character_scene
from app.export.rig_options import RigOptions
from app.export.targets import target_skeleton
from app.formats.fbx.write import write_scene
from app.performance.bodies import character_of
from app.performance.ensemble import Performance
from app.performance.span import cut_span
from tests.gui.conftest import quartet_project
from tests.gui.dialogs.conftest import ShowExport
from tests.gui.japanese import speaking
from tests.support.bad_players import with_character
from tests.support.performed import player_motion
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child
from widgets.dialogs.export_files import ExportDialog


@pytest.fixture
def dialog(dialog: ExportDialog) -> ExportDialog:
    for row in range(1, dialog._players.count()):
        dialog._players.item(row).setCheckState(Qt.CheckState.Unchecked)
    return dialog


@pytest.fixture
def mannequin(session: Session, tmp_path: Path) -> Path:
    """File of a mannequin that fits one of the players."""
    player = session.project.players[0]
    performance = Performance(session.project)
    motion = player_motion(performance, player, cut_span(performance.time_frame, session.project.fps, 0.0, 0.1))
    character = character_of(player)
    target = target_skeleton(character, "ue5")
    write_scene(tmp_path / "mannequin.fbx", character_scene(character, motion, "x", "test", target))
    return tmp_path / "mannequin.fbx"


def choose(dialog: ExportDialog, key: Qt.Key) -> None:
    QTest.keyClick(child(dialog, QComboBox, "export_skeleton"), key)


def name(dialog: ExportDialog, path: Path) -> None:
    field = child(dialog, QLineEdit, "export_asset")
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, str(path))


def reported(dialog: ExportDialog) -> str:
    return child(dialog, QLabel, "export_differences").text()


def can_start(dialog: ExportDialog) -> bool:
    return child(dialog, QPushButton, "export_start").isEnabled()


def test_a_request_has_what_is_chosen(dialog: ExportDialog, mannequin: Path) -> None:
    assert dialog._request().skeleton == "own"
    choose(dialog, Qt.Key.Key_Down)
    assert "IK Retargeter" in reported(dialog)
    name(dialog, mannequin)
    request = dialog._request()
    assert (request.skeleton, request.asset) == ("ue5", mannequin)


def test_an_asset_that_fits_is_said_to_fit(dialog: ExportDialog, mannequin: Path, qtbot: QtBot) -> None:
    choose(dialog, Qt.Key.Key_Down)
    name(dialog, mannequin)
    qtbot.waitUntil(lambda: "✓" in reported(dialog))
    assert can_start(dialog)


def test_one_without_a_character_does_not_keep_the_others_from_an_asset(
    show_export: ShowExport, qt_app: QApplication, qtbot: QtBot, tmp_path: Path, mannequin: Path
) -> None:
    session = Session(with_character(quartet_project(), 0, "unknown"), ImmediateTasks())
    dialog = show_export(session)
    choose(dialog, Qt.Key.Key_Down)
    name(dialog, mannequin)
    qtbot.waitUntil(lambda: "bones" in reported(dialog) or "✓" in reported(dialog))
    assert can_start(dialog)
    session.deleteLater()


def test_an_asset_that_would_lose_the_animation_is_refused(dialog: ExportDialog, mannequin: Path, qtbot: QtBot) -> None:
    name(dialog, mannequin)
    qtbot.waitUntil(lambda: "⚠" in reported(dialog))
    assert "53 animated bones are not in the asset" in reported(dialog)
    assert "hips, spine, chest" in reported(dialog)
    assert not can_start(dialog)
    child(dialog, QLineEdit, "export_asset").clear()
    assert can_start(dialog)
    assert reported(dialog) == ""


def test_a_file_that_is_none_is_named(dialog: ExportDialog, tmp_path: Path, qtbot: QtBot) -> None:
    name(dialog, tmp_path / "absent.fbx")
    outcome = child(dialog, QLabel, "export_outcome")
    assert "The file to compare with was not found." in outcome.text()
    assert not can_start(dialog)
    (tmp_path / "broken.fbx").write_bytes(b"Kaydara FBX Binary  \x00\x1a\x00 and nothing more")
    name(dialog, tmp_path / "broken.fbx")
    qtbot.waitUntil(lambda: "broken.fbx" in outcome.text())
    assert not can_start(dialog)


def test_what_was_chosen_meanwhile_counts(dialog: ExportDialog, mannequin: Path) -> None:
    """The result of an outdated comparison is ignored."""
    name(dialog, mannequin)
    chooser = dialog._skeleton
    assert chooser._requested is not None
    old = chooser._requested
    choose(dialog, Qt.Key.Key_Down)
    before = dict(chooser._checked)
    chooser._found((old, {}, None))
    assert chooser._checked == before


def test_both_languages(dialog: ExportDialog, qt_app: QApplication) -> None:
    box = child(dialog, QComboBox, "export_skeleton")
    assert box.itemText(1) == "Unreal Engine 5 mannequin"
    with speaking():
        qt_app.sendEvent(dialog._skeleton, QEvent(QEvent.Type.LanguageChange))
        assert box.itemText(1) == "Unreal Engine 5 マネキン"


def test_our_own_file_is_an_asset_that_fits_ours(
    dialog: ExportDialog, session: Session, tmp_path: Path, qtbot: QtBot
) -> None:
    """The file is bound in an A-pose, as Unreal reads it, although its bones are in a T-pose."""
    player = session.project.players[0]
    performance = Performance(session.project)
    motion = player_motion(performance, player, cut_span(performance.time_frame, session.project.fps, 0.0, 0.1))
    write_scene(tmp_path / "ours.fbx", character_scene(character_of(player), motion, "x", "test"))
    name(dialog, tmp_path / "ours.fbx")
    qtbot.waitUntil(lambda: "✓" in reported(dialog))


def test_a_request_has_the_rig_that_is_chosen(dialog: ExportDialog) -> None:
    assert dialog._request().rig == RigOptions()
    for name, keys in (("export_instrument", 1), ("export_root_bone", 2), ("export_rest_pose", 2)):
        box = child(dialog, QComboBox, name)
        for _ in range(keys):
            QTest.keyClick(box, Qt.Key.Key_Down)
    QTest.mouseClick(child(dialog, QCheckBox, "export_twist_bones"), Qt.MouseButton.LeftButton)
    assert dialog._request().rig == RigOptions("socket", "motion", "a", True)


def test_the_mannequin_is_for_unreal_unless_another_skeleton_was_chosen(dialog: ExportDialog) -> None:
    skeleton, destination = (dialog.findChild(QComboBox, f"export_{name}") for name in ("skeleton", "destination"))
    assert skeleton is not None
    assert destination is not None
    assert dialog._request().skeleton == "own"
    QTest.keyClick(destination, Qt.Key.Key_Down)
    assert dialog._request().skeleton == "ue5"
    QTest.keyClick(destination, Qt.Key.Key_Up)
    assert dialog._request().skeleton == "own"
    QTest.keyClick(skeleton, Qt.Key.Key_End)
    QTest.keyClick(destination, Qt.Key.Key_Down)
    assert dialog._request().skeleton == "suisou"
