"""The export dialog by mouse and keys writes the same files as the command line."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QCheckBox, QComboBox, QDoubleSpinBox, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.editor.tasks import ThreadTasks
from app.errors import Message
from app.export.face_curves import DEFAULT_FACE, FaceOptions
from app.export.request import ExportRequest
from app.export.run import export
from app.formats import usd_package
from app.formats.bvh.read import read_bvh
from app.messages import text
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from tests.gui.conftest import quartet_project
from tests.gui.dialogs.conftest import ShowExport, one_player_of_bars
from tests.gui.japanese import speaking
from tests.support.bad_players import own_folders, with_character, with_instrument
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child
from widgets.dialogs.export_destination import Written
from widgets.dialogs.export_files import ExportDialog

KEY_WIDGETS = ((QComboBox, "export_keys"), (QCheckBox, "export_fbx"), (QCheckBox, "export_bvh"))


def one_player_two_bars(dialog: ExportDialog) -> None:
    one_player_of_bars(dialog, 2)
    bvh_only(dialog)


def bvh_only(dialog: ExportDialog) -> None:
    QTest.mouseClick(child(dialog, QCheckBox, "export_fbx"), Qt.MouseButton.LeftButton)


def start(dialog: ExportDialog) -> None:
    QTest.mouseClick(dialog.findChild(QPushButton, "export_start"), Qt.MouseButton.LeftButton)


def test_it_writes_what_the_command_line_writes(dialog: ExportDialog, session: Session, tmp_path: Path) -> None:
    one_player_two_bars(dialog)
    start(dialog)
    performance = Performance(session.project)
    fps = Fraction(24)
    request = ExportRequest(
        performance=performance,
        players=session.project.players[:1],
        folder=tmp_path / "expected",
        formats=frozenset(("bvh",)),
        span=bars_span(performance, fps, (1, 2)),
        bars=(1, 2),
        source="quartet.mid",
        creator="Suisou test",
    )
    export(request, text)
    expected = {path.name: path.read_bytes() for path in (tmp_path / "expected").iterdir()}
    assert {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()} == expected
    show = child(dialog, QPushButton, "export_show_folder")
    assert show.isVisible()


def test_bars_have_a_lead_in_and_the_whole_piece_a_preroll(dialog: ExportDialog, session: Session) -> None:
    lead_in, preroll = (child(dialog, QDoubleSpinBox, name) for name in ("export_lead_in", "export_preroll"))
    assert (lead_in.isVisible(), preroll.isVisible(), lead_in.value()) == (False, True, 0.0)
    one_player_of_bars(dialog, 2)
    assert (lead_in.isVisible(), preroll.isVisible()) == (True, False)
    bars = dialog._request().span
    assert bars == bars_span(session.performance, bars.fps, (1, 2))
    QTest.keyClick(lead_in, Qt.Key.Key_Up)
    led = dialog._request().span
    assert (led.end_s, led) == (bars.end_s, bars_span(session.performance, bars.fps, (1, 2), 1.0))
    assert led.first < bars.first


def test_reduced_keys_are_written_where_a_format_can_have_them(
    show_export: ShowExport, session: Session, tmp_path: Path
) -> None:
    dialog = show_export(session, keys="reduced")
    one_player_two_bars(dialog)
    keys, fbx, bvh = (dialog.findChild(kind, name) for kind, name in KEY_WIDGETS)
    assert isinstance(keys, QComboBox)
    assert dialog.keys == "reduced"
    assert not keys.isVisible(), "BVH has every frame"
    QTest.mouseClick(fbx, Qt.MouseButton.LeftButton)
    QTest.mouseClick(bvh, Qt.MouseButton.LeftButton)
    assert keys.isVisible()
    outcome = child(dialog, QLabel, "export_outcome")
    assert "⚠ Reduced keys of FBX have tangents, which Blender does not read" in outcome.text()
    QTest.keyClick(keys, Qt.Key.Key_Up)
    assert dialog.keys == "every"
    assert "Blender" not in outcome.text()
    QTest.keyClick(keys, Qt.Key.Key_Down)
    start(dialog)
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["keys"] == "reduced"
    assert report["players"][0]["keys"]["written"] < 0.3 * report["players"][0]["keys"]["every"]


def test_it_says_what_will_be_replaced_and_what_is_missing(dialog: ExportDialog, tmp_path: Path) -> None:
    outcome = child(dialog, QLabel, "export_outcome")
    button = child(dialog, QPushButton, "export_start")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "report.json").write_text("{}")
    bvh_only(dialog)
    assert "report.json" in outcome.text()
    assert "⚠" not in outcome.text(), "nothing is known of what a foreign report is about"
    (tmp_path / "out" / "report.json").write_text('{"bars": [1, 4]}')
    bvh_only(dialog)
    bvh_only(dialog)
    assert "bars 1 to 4 only; this one has the whole piece" in outcome.text()
    box = child(dialog, QCheckBox, "export_bvh")
    QTest.mouseClick(box, Qt.MouseButton.LeftButton)
    assert not button.isEnabled()
    QTest.mouseClick(box, Qt.MouseButton.LeftButton)
    assert button.isEnabled()
    QTest.mouseClick(dialog.findChild(QPushButton, "export_everyone"), Qt.MouseButton.LeftButton)
    assert dialog.player_ids == ()
    assert not button.isEnabled()


def test_a_folder_that_cannot_be_is_reported_and_nothing_is_written(dialog: ExportDialog, tmp_path: Path) -> None:
    one_player_two_bars(dialog)
    (tmp_path / "out").write_text("a file")
    start(dialog)
    outcome = child(dialog, QLabel, "export_outcome")
    assert "out" in outcome.text()
    assert (tmp_path / "out").read_text() == "a file"


@pytest.mark.parametrize("by", ["button", "status line"])
def test_cancelled_it_leaves_nothing_and_says_so(
    show_export: ShowExport, qt_app: object, qtbot: QtBot, tmp_path: Path, by: str
) -> None:
    tasks = ThreadTasks()
    session = Session(quartet_project(), tasks)
    dialog = show_export(session)
    start(dialog)
    button = child(dialog, QPushButton, "export_start")
    assert not button.isEnabled()
    under_way = child(dialog, QLabel, "export_under_way")
    # A player is done when its files are: the sound and the stage are none.
    qtbot.waitUntil(lambda: ", player 1 of 4 · " in under_way.text())
    assert any(player.name in under_way.text() for player in session.project.players)
    assert "left" in under_way.text()
    # The window asks before it closes meanwhile.
    assert tasks.writing == (Message("work.export"),)
    reported: list[str] = []
    tasks.cancelled.connect(lambda name: reported.append(name.id))
    if by == "button":
        QTest.mouseClick(dialog.findChild(QPushButton, "export_close"), Qt.MouseButton.LeftButton)
    else:
        tasks.cancel(tasks.running[0])
    qtbot.waitUntil(button.isEnabled)
    assert dialog.isVisible()
    assert under_way.isVisible()
    assert under_way.text() == "Cancelled; nothing was written"
    with speaking():
        QApplication.processEvents()
        assert under_way.text() == text(Message("work.stopped"), "ja")
    qtbot.waitUntil(lambda: reported == ["work.export"])
    qtbot.waitUntil(lambda: not (tmp_path / "out").exists())
    tasks.cancel_all(5.0)
    session.deleteLater()


def test_what_is_written_is_counted_where_it_is_a_player() -> None:
    written = Written({"Horn", "Flute"})
    said = []
    for label in ("", "Horn", "Flute", "Horn", "song.wav", "song stage.fbx"):
        written.report(0.5, label)
        said.append((written.label, written.number))
    assert said == [("", None), ("Horn", 1), ("Flute", 2), ("Horn", 1), ("song.wav", None), ("song stage.fbx", None)]


def test_usd_is_greyed_where_it_cannot_be_written(
    show_export: ShowExport, session: Session, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(usd_package, "usd_installed", lambda: False)
    dialog = show_export(session)
    box = child(dialog, QCheckBox, "export_usd")
    assert not box.isEnabled()
    assert "usd-core" in box.text()
    assert "pip install" in box.toolTip()
    QTest.mouseClick(box, Qt.MouseButton.LeftButton)
    assert "usd" not in dialog._formats.formats
    one_player_two_bars(dialog)
    start(dialog)
    assert (tmp_path / "out" / "report.json").exists()
    assert not box.isEnabled()


def test_all_kinds_of_file_at_once(dialog: ExportDialog, session: Session, tmp_path: Path) -> None:
    one_player_two_bars(dialog)
    for name in ("export_sound", "export_glb", *(["export_usd"] if usd_package.usd_installed() else [])):
        QTest.mouseClick(child(dialog, QCheckBox, name), Qt.MouseButton.LeftButton)
    assert dialog._formats.formats >= {"bvh", "glb"}
    outcome = child(dialog, QLabel, "export_outcome")
    promised = outcome.text()
    start(dialog)
    written = [path for path in (tmp_path / "out").iterdir() if path.is_file()]
    assert str(len(written)) in promised
    suffixes = sorted(path.suffix for path in written)
    usdc = [".usdc"] * 3 if usd_package.usd_installed() else []
    assert suffixes == sorted([".bvh", ".glb", ".glb", ".glb", ".json", ".wav", *usdc])
    assert (tmp_path / "out" / "quartet_stage.glb").exists()


def test_a_stage_that_no_ticked_format_can_hold_is_not_written(dialog: ExportDialog, tmp_path: Path) -> None:
    one_player_two_bars(dialog)
    box = child(dialog, QCheckBox, "export_stage")
    assert dialog._formats.formats == {"bvh"}
    assert not box.isEnabled()
    assert not dialog._formats.stage
    for ticked in (True, False):
        QTest.mouseClick(dialog.findChild(QCheckBox, "export_glb"), Qt.MouseButton.LeftButton)
        assert (box.isEnabled(), dialog._formats.stage) == (ticked, ticked)
    start(dialog)
    assert not list((tmp_path / "out").glob("*_stage*"))


def test_bvh_files_get_the_bone_names_of_another_program(dialog: ExportDialog, tmp_path: Path) -> None:
    one_player_two_bars(dialog)
    names = child(dialog, QComboBox, "export_bvh_names")
    assert names.isVisible()
    names.setFocus()
    QTest.keyClicks(names, "Mixamo")
    assert names.currentData() == "mixamo"
    start(dialog)
    (path,) = (tmp_path / "out").glob("*.bvh")
    assert {"Hips", "LeftForeArm", "RightHandIndex1"} <= set(read_bvh(path).names)
    QTest.mouseClick(child(dialog, QCheckBox, "export_bvh"), Qt.MouseButton.LeftButton)
    assert not names.isVisible()


def test_who_is_left_out_is_named_with_the_reason(
    show_export: ShowExport, qt_app: object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = own_folders(tmp_path, monkeypatch)
    project = with_character(quartet_project(), 0, own.add_character(b"damaged"))
    session = Session(with_instrument(project, 1, "ophicleide"), ImmediateTasks())
    noticed: list[str] = []
    session.noticed.connect(lambda message, severity: noticed.append(f"{severity.value}: {text(message)}"))
    dialog = show_export(session)
    one_player_two_bars(dialog)
    outcome = child(dialog, QLabel, "export_outcome")
    # The bad one alone is an error, and nothing is written.
    start(dialog)
    assert "Trumpet 1" in outcome.text()
    assert "mori.glb" in outcome.text()
    assert not (tmp_path / "out").exists()
    for row in (1, 2):
        dialog._players.item(row).setCheckState(Qt.CheckState.Checked)
    start(dialog)
    reported = outcome.text()
    assert "Trumpet 1 is excluded: " in reported
    assert "mori.glb" in reported
    assert "Trumpet 2 is excluded: " in reported
    assert "the instrument 'ophicleide' of Trumpet 2 is not installed" in reported
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"Trombone 1.bvh", "report.json"}
    assert any(line.startswith("warning: Trumpet 1 is excluded: ") for line in noticed)
    session.deleteLater()


@pytest.mark.usefixtures("japanese")
def test_the_report_is_english_and_the_window_japanese(show_export: ShowExport, tmp_path: Path) -> None:
    session = Session(with_instrument(quartet_project(), 1, "ophicleide"), ImmediateTasks())
    dialog = show_export(session)
    one_player_two_bars(dialog)
    dialog._players.item(1).setCheckState(Qt.CheckState.Checked)
    start(dialog)
    excluded = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))["left_out"]
    assert [one["player"] for one in excluded] == ["Trumpet 2"]
    assert excluded[0]["reason"].startswith("the instrument 'ophicleide' of Trumpet 2 is not installed")
    shown = child(dialog, QLabel, "export_outcome").text()
    assert "Trumpet 2 は除外されました" in shown
    assert excluded[0]["reason"] not in shown
    session.deleteLater()


def test_meshes_can_be_left_out_where_a_format_can_do_without(dialog: ExportDialog, tmp_path: Path) -> None:
    box = child(dialog, QCheckBox, "export_motion_only")
    bvh_only(dialog)
    assert not box.isEnabled()
    child(dialog, QCheckBox, "export_fbx").setChecked(True)
    assert box.isEnabled()
    box.setChecked(True)
    assert dialog._request().motion_only
    bvh_only(dialog)
    assert not dialog._request().motion_only, "a box that is off does nothing"


def test_straps_and_chairs_can_be_left_out(dialog: ExportDialog) -> None:
    box = child(dialog, QCheckBox, "export_props")
    assert dialog._request().props
    box.setChecked(False)
    assert not dialog._request().props
    box.setChecked(True)
    bvh_only(dialog)
    assert not box.isEnabled(), "BVH has no meshes"


def test_the_size_of_textures_is_chosen(dialog: ExportDialog) -> None:
    assert dialog._request().texture_px == 2048
    sizes = child(dialog, QComboBox, "export_textures")
    assert [sizes.itemText(row) for row in range(3)] == ["None, mean colours", "Up to 512 px", "Up to 1024 px"]
    for row, px in enumerate((0, 512)):
        sizes.setCurrentIndex(row)
        assert dialog._request().texture_px == dialog.texture_px == px
    bvh_only(dialog)
    assert sizes.isHidden()


def test_levels_of_detail_are_chosen(dialog: ExportDialog) -> None:
    assert dialog._request().levels == 1
    levels = child(dialog, QComboBox, "export_levels")
    assert [levels.itemText(row) for row in range(4)] == ["3 in Unreal projects, otherwise 1", "1", "2", "3"]
    levels.setCurrentIndex(2)
    assert dialog._request().levels == dialog.levels == 2
    bvh_only(dialog)
    assert levels.isHidden()


def test_curves_of_faces_are_chosen_by_name_and_part(dialog: ExportDialog) -> None:
    assert dialog._request().face == DEFAULT_FACE
    names = child(dialog, QComboBox, "export_face_names")
    names.setCurrentIndex(names.findData("metahuman"))
    child(dialog, QCheckBox, "export_face_brows").setChecked(False)
    assert dialog._request().face == FaceOptions("metahuman", ("eyes", "gaze", "cheeks", "nose", "mouth"))
