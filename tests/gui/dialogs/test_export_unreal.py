"""The export dialog into an Unreal project, by mouse and keys."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QCheckBox, QComboBox, QLabel, QLineEdit, QPushButton

from app.editor.session import Session
from app.errors import Message
from app.export.unreal.project import find_project
from tests.gui.dialogs.conftest import ShowExport, one_player_of_bars
from tests.support.windows import child
from tests.unit.export.unreal.conftest import with_dancers
from widgets.dialogs.export_files import ExportDialog


@pytest.fixture
def game(tmp_path: Path) -> Path:
    folder = tmp_path / "Game"
    folder.mkdir()
    (folder / "Game.uproject").write_text(json.dumps({"FileVersion": 3, "EngineAssociation": "5.6"}))
    return folder


def outcome(dialog: ExportDialog) -> str:
    return child(dialog, QLabel, "export_outcome").text()


def start_button(dialog: ExportDialog) -> QPushButton:
    return child(dialog, QPushButton, "export_start")


def place(dialog: ExportDialog, text: str) -> None:
    line = child(dialog, QLineEdit, "export_folder")
    line.setFocus()
    line.selectAll()
    QTest.keyClick(line, Qt.Key.Key_Delete)
    QTest.keyClicks(line, text)


def into_unreal(dialog: ExportDialog) -> None:
    box = child(dialog, QComboBox, "export_destination")
    QTest.keyClick(box, Qt.Key.Key_Down)
    assert box.currentData() == "unreal"


def test_it_exports_into_a_project_and_again(dialog: ExportDialog, game: Path) -> None:
    reported: list[tuple[str, Path]] = []
    dialog.exported.connect(lambda destination, path: reported.append((destination, path)))
    one_player_of_bars(dialog, 1)
    into_unreal(dialog)
    assert not start_button(dialog).isEnabled()
    assert ".uproject" in outcome(dialog)
    place(dialog, str(game / "Game.uproject"))
    assert "Game (Unreal Engine 5.6)" in outcome(dialog)
    assert "replaced" not in outcome(dialog)
    assert find_project(game).name == "Game"
    assert sorted(path.name for path in game.iterdir()) == ["Game.uproject"]
    QTest.mouseClick(start_button(dialog), Qt.MouseButton.LeftButton)
    assert "Import Performance" in outcome(dialog)
    sources = game / "SuisouSource" / "quartet"
    description = json.loads((sources / "performance.json").read_text(encoding="utf-8"))
    assert [player["name"] for player in description["players"]] == [dialog._project.players[0].name]
    assert description["rate"] == {"numerator": 24, "denominator": 1}
    assert reported == [("unreal", game / "Game.uproject")]
    assert dialog._shown_folder == sources
    # A second export lists what it replaces; one of another player, what it removes.
    dialog._players.item(1).setCheckState(Qt.CheckState.Checked)
    assert "will be replaced: " in outcome(dialog)
    assert "S_quartet.wav" in outcome(dialog)
    dialog._players.item(0).setCheckState(Qt.CheckState.Unchecked)
    assert "2 files that are no longer needed will be removed: " in outcome(dialog)


def test_a_dancer_goes_into_the_project_alone(
    show_export: ShowExport, session: Session, game: Path, tmp_path: Path
) -> None:
    session.apply(Message("edit.add_dancer"), with_dancers(session.project, tmp_path, "Ana"))
    dialog = show_export(session)
    one_player_of_bars(dialog, 1)
    dialog._players.item(0).setCheckState(Qt.CheckState.Unchecked)
    last = dialog._players.item(dialog._players.count() - 1)
    assert last.text() == "Ana"
    last.setCheckState(Qt.CheckState.Checked)
    into_unreal(dialog)
    place(dialog, str(game))
    assert "replaced" not in outcome(dialog)
    QTest.mouseClick(start_button(dialog), Qt.MouseButton.LeftButton)
    assert "Import Performance" in outcome(dialog)
    assert "⚠" not in outcome(dialog)
    sources = game / "SuisouSource" / "quartet"
    assert [path.name for path in sources.glob("*/*.fbx")] == ["SK_Ana.fbx"]
    description = json.loads((sources / "performance.json").read_text(encoding="utf-8"))
    assert [dancer["name"] for dancer in description["dancers"]] == ["Ana"]
    # A second export reports that the file is replaced.
    last.setCheckState(Qt.CheckState.Unchecked)
    last.setCheckState(Qt.CheckState.Checked)
    assert "SK_Ana.fbx" in outcome(dialog)


def test_a_project_without_a_version_is_named_without_one(dialog: ExportDialog, game: Path) -> None:
    (game / "Game.uproject").write_text(json.dumps({"FileVersion": 3}))
    into_unreal(dialog)
    place(dialog, str(game))
    assert "Game (Unreal Engine)" in outcome(dialog)


def test_formats_are_for_folders(dialog: ExportDialog, game: Path) -> None:
    box = child(dialog, QCheckBox, "export_fbx")
    assert box.isVisible()
    into_unreal(dialog)
    assert not box.isVisible()
    assert child(dialog, QComboBox, "export_textures").isVisible()
    assert child(dialog, QComboBox, "export_levels").isVisible()
    assert dialog._request().levels == 3
    for name, format_box in dialog._formats._boxes.items():
        format_box.setChecked(False)
        assert name not in dialog._formats.formats
    place(dialog, str(game))
    assert start_button(dialog).isEnabled()


def test_each_destination_keeps_its_place(dialog: ExportDialog, game: Path, tmp_path: Path) -> None:
    into_unreal(dialog)
    place(dialog, str(game))
    box = child(dialog, QComboBox, "export_destination")
    line = child(dialog, QLineEdit, "export_folder")
    QTest.keyClick(box, Qt.Key.Key_Up)
    assert line.text() == str(tmp_path / "out")
    into_unreal(dialog)
    assert line.text() == str(game)


def test_what_is_wrong_is_reported_before_anything_is_written(dialog: ExportDialog, game: Path, tmp_path: Path) -> None:
    into_unreal(dialog)
    place(dialog, str(tmp_path))
    assert "is not an Unreal project" in outcome(dialog)
    assert not start_button(dialog).isEnabled()
    mine = game / "SuisouSource" / "quartet" / "Audio" / "S_quartet.wav"
    mine.parent.mkdir(parents=True)
    mine.write_bytes(b"mine")
    place(dialog, str(game))
    assert "S_quartet.wav was not created by Suisou" in outcome(dialog)
    assert not start_button(dialog).isEnabled()


def test_the_project_is_remembered(show_export: ShowExport, session: Session, game: Path) -> None:
    dialog = show_export(session, unreal=game / "Game.uproject", destination="unreal")
    assert dialog._place.destination == "unreal"
    assert "Game (Unreal Engine 5.6)" in outcome(dialog)
    assert start_button(dialog).isEnabled()
