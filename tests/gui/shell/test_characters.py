"""Importing a character by mouse and keys: bones, faces, undo, saving, assigning and removing."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialogButtonBox,
    QDoubleSpinBox,
    QLabel,
    QLineEdit,
    QListWidget,
    QPushButton,
    QWidget,
)
from pytestqt.qtbot import QtBot

from app.editor.generator import Generator
from app.errors import Message
from app.project.edit.players import change
from app.rig.characters.character_library import FOLDER_VARIABLE, character_library, character_named, reload_characters
from app.rig.characters.figure_build import figure_height
from app.rig.characters.load_character import load_character, read_character
from app.shell.app import Program
from app.shell.characters import bring_character
from tests.gui.shell.conftest import Answers, trigger
from tests.support.anime_figure import anime_body, block
from tests.support.estranged import foreign, write_glb
from tests.support.windows import child
from widgets.common.character_picture import picture, seen
from widgets.common.number_slider import NumberSlider
from widgets.dialogs.body_map import joints, places
from widgets.dialogs.character import CharacterDialog
from widgets.dialogs.character_draft import CharacterDraft, DraftHistory
from widgets.dialogs.characters import CharactersDialog

DATA = Path(__file__).parents[2] / "data" / "characters"
TODDLER, MITTENS = DATA / "toddler_vrm1.vrm", DATA / "man_cmu.fbx"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Empty folder of the user's own characters."""
    own = tmp_path / "characters"
    monkeypatch.setenv(FOLDER_VARIABLE, str(own))
    reload_characters()
    yield own
    monkeypatch.undo()
    reload_characters()


@pytest.fixture(autouse=True)
def _nothing_is_planned(monkeypatch: pytest.MonkeyPatch) -> None:
    """Disable planning, since fitting a new body's grip takes long and is tested elsewhere."""
    monkeypatch.setattr(Generator, "_plan", lambda self, project: None)


def opened(program: Program, path: Path = TODDLER) -> CharacterDialog:
    bring_character(program.editor, path)
    (dialog,) = program.window.findChildren(CharacterDialog)
    return dialog


def button(dialog: QWidget, name: str) -> QPushButton:
    return child(dialog, QPushButton, name)


def ok(dialog: CharacterDialog) -> QPushButton:
    return child(dialog, QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok)


def bone_of(dialog: CharacterDialog, joint: str) -> str:
    return next(
        dialog.rows.topLevelItem(row).text(1)
        for row in range(dialog.rows.topLevelItemCount())
        if dialog.rows.topLevelItem(row).data(0, Qt.ItemDataRole.UserRole) == joint
    )


def click_dot(dialog: CharacterDialog, joint: str) -> None:
    QTest.mouseClick(dialog.body, Qt.MouseButton.LeftButton, pos=dialog.body.place(joint).toPoint())


def test_every_joint_has_a_dot_of_its_own_and_left_is_at_the_right() -> None:
    assert set(places()) == set(joints())
    spots = list(places().values())
    least = min(abs(complex(*one) - complex(*other)) for number, one in enumerate(spots) for other in spots[:number])
    assert least > 0.02
    assert places()["leftHand"][0] > 0 > places()["rightHand"][0]


def test_a_dot_and_a_search_give_a_joint_another_bone(program: Program, qtbot: QtBot) -> None:
    dialog = opened(program)
    assert bone_of(dialog, "leftToes") == "—"
    click_dot(dialog, "leftToes")
    assert dialog.joint == "leftToes"
    search = child(dialog, QLineEdit, "bone_search")
    QTest.mouseDClick(dialog.body, Qt.MouseButton.LeftButton, pos=dialog.body.place("leftToes").toPoint())
    qtbot.waitUntil(search.hasFocus)
    QTest.keyClicks(search, "toe2-1.L")
    QTest.keyClick(search, Qt.Key.Key_Return)
    assert bone_of(dialog, "leftToes") == "toe2-1.L"
    assert dialog.draft.joints == {"leftToes": "toe2-1.L"}
    assert search.text() == ""
    # None at all, then as it was found.
    QTest.mouseClick(button(dialog, "joint_none"), Qt.MouseButton.LeftButton)
    assert bone_of(dialog, "leftToes") == "—"
    assert dialog.draft.joints == {"leftToes": ""}
    QTest.mouseClick(button(dialog, "joint_automatic"), Qt.MouseButton.LeftButton)
    assert dialog.draft.joints == {}


def test_it_goes_by_keys_alone(program: Program, qtbot: QtBot) -> None:
    dialog = opened(program)
    dialog.body.setFocus()
    assert dialog.joint == "hips"
    QTest.keyClick(dialog.body, Qt.Key.Key_Up)
    assert dialog.joint == "spine"
    seen_joints = {dialog.joint}
    for key in (Qt.Key.Key_Right, Qt.Key.Key_Down, Qt.Key.Key_Down, Qt.Key.Key_Left, Qt.Key.Key_Up):
        QTest.keyClick(dialog.body, key)
        seen_joints.add(dialog.joint)
    assert len(seen_joints) > 4
    before = bone_of(dialog, dialog.joint)
    QTest.keyClick(dialog.body, Qt.Key.Key_Return)
    qtbot.waitUntil(dialog.bones.search.hasFocus)
    QTest.keyClicks(dialog.bones.search, "jaw")
    QTest.keyClick(dialog.bones.search, Qt.Key.Key_Return)
    assert bone_of(dialog, dialog.joint) == "jaw" != before
    assert bone_of(dialog, "jaw") == "—"
    QTest.keyClick(dialog, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert bone_of(dialog, "jaw") == "jaw"
    QTest.keyClick(dialog, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    assert bone_of(dialog, "jaw") == "—"


def test_without_what_playing_needs_it_cannot_be_kept(program: Program) -> None:
    dialog = opened(program)
    assert ok(dialog).isEnabled()
    dialog.choose("leftHand")
    QTest.mouseClick(button(dialog, "joint_none"), Qt.MouseButton.LeftButton)
    reported = child(dialog, QLabel, "character_status")
    assert "Hand L" in reported.text()
    assert not ok(dialog).isEnabled()
    QTest.mouseClick(button(dialog, "character_reset"), Qt.MouseButton.LeftButton)
    assert ok(dialog).isEnabled()
    QTest.mouseClick(button(dialog, "character_undo"), Qt.MouseButton.LeftButton)
    assert not ok(dialog).isEnabled()


def of_size(path: Path, source: Path, factor: float) -> Path:
    """Copy of a character's GLB with a scaled scene."""

    def change(document: dict[str, Any]) -> None:
        (scene,) = document["scenes"]
        document["nodes"].append({"name": "size", "scale": [factor] * 3, "children": scene["nodes"]})
        scene["nodes"] = [len(document["nodes"]) - 1]

    return changed(path, source, change)


def with_a_shield(path: Path, source: Path) -> Path:
    """Copy of a character's GLB with its mesh duplicated as Shield."""

    def change(document: dict[str, Any]) -> None:
        node = next(node for node in document["nodes"] if "mesh" in node)
        document["meshes"].append({**document["meshes"][node["mesh"]], "name": "Shield"})
        document["nodes"].append({**node, "name": "Shield", "mesh": len(document["meshes"]) - 1})
        document["scenes"][0]["nodes"].append(len(document["nodes"]) - 1)

    return changed(path, source, change)


def changed(path: Path, source: Path, change: Callable[[dict[str, Any]], None]) -> Path:
    """Copy of a GLB with another document."""
    data = source.read_bytes()
    length = int.from_bytes(data[12:16], "little")
    document, rest = json.loads(data[20 : 20 + length]), data[20 + length :]
    change(document)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunk = len(text).to_bytes(4, "little") + b"JSON" + text
    path.write_bytes(data[:8] + (12 + len(chunk) + len(rest)).to_bytes(4, "little") + chunk + rest)
    return path


def test_a_giant_is_offered_at_the_height_of_a_person(program: Program, tmp_path: Path, qtbot: QtBot) -> None:
    own_m = figure_height(read_character(TODDLER).figure)
    assert own_m is not None
    dialog = opened(program, of_size(tmp_path / "giant.vrm", TODDLER, 4.84 / own_m))
    number = child(dialog, QDoubleSpinBox, "character_height")
    automatic = child(dialog, QCheckBox, "character_height_automatic")
    reported = child(dialog, QLabel, "character_status")
    assert number.value() == pytest.approx(1.7)
    assert "4.84" not in reported.text()
    automatic.click()
    assert number.value() == pytest.approx(4.84)
    assert not number.isEnabled()
    assert "4.84 m" in reported.text()
    QTest.mouseClick(button(dialog, "character_undo"), Qt.MouseButton.LeftButton)
    assert not automatic.isChecked()
    number.setValue(1.55)
    assert dialog.draft.height_m == pytest.approx(1.55)
    QTest.mouseClick(ok(dialog), Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(character_library().own))
    (id,) = character_library().own
    assert character_library().own[id].height_m == pytest.approx(1.55)
    tops = [skin.positions_m[:, 1].max() for skin in character_named(id).meshes]
    assert max(tops) == pytest.approx(1.55, abs=0.02)


def test_a_corrected_unit_is_said_in_the_dialog(program: Program, tmp_path: Path) -> None:
    dialog = opened(program, of_size(tmp_path / "inches.vrm", TODDLER, 100.0))
    assert "sizes were multiplied by 0.01" in child(dialog, QLabel, "character_status").text()


def test_a_mesh_is_switched_off_and_stays_so(program: Program, tmp_path: Path, qtbot: QtBot) -> None:
    """A disabled mesh is in no picture, player and export; at least one mesh stays enabled."""
    dialog = opened(program, with_a_shield(tmp_path / "knight.vrm", TODDLER))
    dialog.tabs.setCurrentIndex(2)
    names = ["Toddler", "Shield"]
    rows = dialog.meshes.list
    assert [rows.topLevelItem(row).text(0) for row in range(rows.topLevelItemCount())] == names
    body, shield = (rows.topLevelItem(row) for row in range(2))
    shield.setCheckState(0, Qt.CheckState.Unchecked)
    assert dialog.draft.hidden == ("Shield",)
    dialog.undo()
    assert shield.checkState(0) is Qt.CheckState.Checked
    for row in (body, shield):
        row.setCheckState(0, Qt.CheckState.Unchecked)
    assert not ok(dialog).isEnabled()
    body.setCheckState(0, Qt.CheckState.Checked)
    QTest.mouseClick(ok(dialog), Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(character_library().own))
    (id,) = character_library().own
    assert character_library().own[id].hidden == ["Shield"]
    character = character_named(id)
    assert character.own is not None
    assert [mesh.name for mesh in character.meshes] == [mesh.name for mesh in character.own.figure.meshes] == names[:1]


def test_a_sword_is_left_out_from_the_start_and_said(program: Program, tmp_path: Path) -> None:
    body = foreign(anime_body(), extra=False)
    body.meshes[1:] = [block(body.meshes[0], "Sword", body.joints["rightHand"], 0.9)]
    dialog = opened(program, write_glb(tmp_path / "knight.vrm", body, vrm=1))
    reported = child(dialog, QLabel, "character_status")
    assert dialog.draft.hidden == ("Sword",)
    assert "Left out" in reported.text()
    assert not child(dialog, QPushButton, "character_reset").isEnabled()
    sword = dialog.meshes.list.topLevelItem(1)
    assert sword.checkState(0) is Qt.CheckState.Unchecked
    sword.setCheckState(0, Qt.CheckState.Checked)
    assert "may hide the instrument" in reported.text()
    QTest.mouseClick(button(dialog, "character_reset"), Qt.MouseButton.LeftButton)
    assert dialog.draft.hidden == ("Sword",)


def test_the_size_of_the_instrument_is_said_beside_the_picture(program: Program, qtbot: QtBot) -> None:
    """A toddler's trumpet is smaller than an adult's."""
    reported = child(opened(program), QLabel, "character_status")
    qtbot.waitUntil(lambda: "The instrument is scaled to" in reported.text())


def test_a_character_of_usual_size_keeps_the_height_of_its_file(program: Program) -> None:
    dialog = opened(program)
    assert child(dialog, QCheckBox, "character_height_automatic").isChecked()
    assert dialog.draft.height_m == 0.0


def test_a_mitten_is_reported(program: Program) -> None:
    reported = child(opened(program, MITTENS), QLabel, "character_status")
    assert "Fingers that do not move" in reported.text()
    assert "Blinking is not available" in reported.text()


def test_a_face_is_made_of_other_morphs_in_one_step_each(program: Program, qtbot: QtBot) -> None:
    dialog = opened(program)
    dialog.tabs.setCurrentIndex(1)
    dialog.faces.choose("cheekPuff")
    add = child(dialog.faces, QComboBox, "face_add")
    place = add.findData("Fcl_MTH_U")
    add.setCurrentIndex(place)
    add.activated.emit(place)
    assert dialog.draft.morphs == {"cheekPuff": {"Fcl_MTH_U": 1.0}}
    slider = child(dialog.faces, NumberSlider, "face_part_Fcl_MTH_U")
    y, width = slider.height() // 2, slider.width()
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, pos=QPoint(width // 2, y))
    for x in range(width // 2, width // 4, -15):
        QTest.mouseMove(slider, QPoint(x, y))
    QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, pos=QPoint(width // 4, y))
    factor = dialog.draft.morphs["cheekPuff"]["Fcl_MTH_U"]
    assert factor < 0.9
    dialog.undo()
    assert dialog.draft.morphs == {"cheekPuff": {"Fcl_MTH_U": 1.0}}, "a drag is one step"
    dialog.redo()
    assert dialog.draft.morphs["cheekPuff"]["Fcl_MTH_U"] == factor
    reset = button(dialog, "face_reset")
    QTest.mouseClick(reset, Qt.MouseButton.LeftButton)
    assert dialog.draft.morphs == {}
    assert not reset.isEnabled()


def test_the_picture_follows_the_face() -> None:
    shown = seen(character_named("woman_adult"))
    still, open_ = picture(shown, 96, 96, "head"), picture(shown, 96, 96, "head", {"jawOpen": 1.0})
    differing = sum(still.pixel(x, y) != open_.pixel(x, y) for x in range(96) for y in range(96))
    above = sum(still.pixel(x, y) != open_.pixel(x, y) for x in range(96) for y in range(30))
    assert differing > 100
    assert above < 10, "only the jaw"
    body = picture(shown, 60, 120)
    assert body.pixelColor(30, 60).alpha() > 200
    assert body.pixelColor(2, 2).alpha() == 0


def test_the_picture_is_as_smooth_as_the_files_normals() -> None:
    shown = seen(load_character(TODDLER))
    image = picture(shown, 200, 200, "head")
    forehead = [[image.pixelColor(x, y).lightness() for x in range(75, 125)] for y in range(25, 70)]
    steps = [abs(a - b) for row in forehead for a, b in pairwise(row)]
    assert max(steps) <= 3, "no edges between triangles"
    assert max(map(max, forehead)) - min(map(min, forehead)) > 10, "but light and shade"


def test_what_is_kept_can_be_cast_and_the_casting_undone(program: Program, folder: Path) -> None:
    before = program.session.project
    first, second = (player.id for player in before.players[:2])
    program.session.set_players((first, second))
    dialog = opened(program)
    QTest.keyClicks(dialog.title, "")
    dialog.title.selectAll()
    QTest.keyClicks(dialog.title, "Little One")
    dialog.choose("leftToes")
    dialog.bones.chosen.emit("toe2-1.L")
    QTest.mouseClick(dialog.give, Qt.MouseButton.LeftButton, pos=QPoint(8, dialog.give.height() // 2))
    assert dialog.give.isChecked()
    QTest.mouseClick(ok(dialog), Qt.MouseButton.LeftButton)
    (entry,) = character_library().own.values()
    (id,) = character_library().own
    assert (entry.title, entry.joints) == ("Little One", {"leftToes": "toe2-1.L"})
    assert (folder / entry.file).read_bytes() == TODDLER.read_bytes()
    project = program.session.project
    assert [project.player(one).character_id for one in (first, second)] == [id, id]
    chooser = child(program.window, QComboBox, "player_character")
    assert "Little One" in [chooser.itemText(row) for row in range(chooser.count())]
    program.session.document.undo()
    assert program.session.project.players == before.players


def test_a_character_is_changed_again_and_removed_if_no_one_objects(
    program: Program, answers: Answers, qtbot: QtBot, folder: Path
) -> None:
    QTest.mouseClick(ok(opened(program)), Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not program.window.findChildren(CharacterDialog))
    (id,) = character_library().own
    trigger(program, "application.characters")
    (shelf,) = program.window.findChildren(CharactersDialog)
    shown = child(shelf, QListWidget, "character_list")
    assert shown.item(0).text() == "toddler vrm1"
    QTest.mouseClick(button(shelf, "characters_edit"), Qt.MouseButton.LeftButton)
    (dialog,) = program.window.findChildren(CharacterDialog)
    dialog.choose("leftToes")
    dialog.bones.chosen.emit("toe3-1.L")
    QTest.mouseClick(ok(dialog), Qt.MouseButton.LeftButton)
    assert character_library().own[id].joints == {"leftToes": "toe3-1.L"}
    player = program.session.project.players[0]
    program.session.apply(
        Message("edit.player_character", {"of": "Trumpet 1"}),
        change(program.session.project, [player.id], character_id=id),
    )
    answers.removes = False
    QTest.mouseClick(button(shelf, "characters_remove"), Qt.MouseButton.LeftButton)
    assert answers.reported_players == (player.name,)
    assert id in character_library().own
    answers.removes = True
    QTest.mouseClick(button(shelf, "characters_remove"), Qt.MouseButton.LeftButton)
    assert not character_library().own
    assert not list(folder.glob("*.vrm"))
    assert shown.count() == 0
    shelf.close()


def test_a_file_is_dropped_on_the_window(program: Program, qtbot: QtBot) -> None:
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(MITTENS))])
    for target in (program.window, program.window.panels["players"]):
        over = target.mapTo(program.window, QPoint(30, 30))
        actions, buttons, keys = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
        enter = QDragEnterEvent(over, actions, mime, buttons, keys)
        program.window.dragEnterEvent(enter)
        assert enter.isAccepted()
        program.window.dropEvent(QDropEvent(QPointF(over), actions, mime, buttons, keys))
        (dialog,) = program.window.findChildren(CharacterDialog)
        assert "man_cmu.fbx" in dialog.windowTitle()
        dialog.reject()
        qtbot.waitUntil(lambda: not program.window.findChildren(CharacterDialog))


def test_what_cannot_be_read_is_said(program: Program, tmp_path: Path) -> None:
    reported = list[str]()
    program.session.noticed.connect(lambda message, severity: reported.append(message.id))
    wrong = tmp_path / "wrong.vrm"
    wrong.write_bytes(b"glTF but not really")
    bring_character(program.editor, wrong)
    assert not program.window.findChildren(CharacterDialog)
    assert len(reported) == 1


def test_a_file_put_into_the_folder_is_there_by_itself(program: Program, qtbot: QtBot, folder: Path) -> None:
    folder.mkdir(parents=True)
    shutil.copy(TODDLER, folder / "tot.vrm")
    (folder / "tot.toml").write_text('file = "tot.vrm"\ntitle = "Tot"\n')
    chooser = child(program.window, QComboBox, "player_character")
    qtbot.waitUntil(lambda: "Tot" in [chooser.itemText(row) for row in range(chooser.count())])


def test_steps() -> None:
    steps, gesture = DraftHistory(CharacterDraft("a")), object()
    assert not steps.apply(CharacterDraft("a"))
    for title in ("b", "c", "d"):
        assert steps.apply(CharacterDraft(title), gesture)
    steps.undo()
    assert steps.now == CharacterDraft("a")
    assert steps.can_redo
    steps.redo()
    assert steps.now == CharacterDraft("d")
    # A drag back to where it began is none.
    other = object()
    assert steps.apply(CharacterDraft("e"), other)
    assert steps.apply(CharacterDraft("d"), other), "what is shown has to follow"
    assert steps.apply(CharacterDraft("f"), other)
    assert steps.apply(CharacterDraft("d"), other)
    steps.undo()
    assert steps.now == CharacterDraft("a")
