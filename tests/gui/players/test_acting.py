"""Style, habits and amounts of the selected players by mouse and keys, compared with the project."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QCheckBox, QWidget
from pytestqt.qtbot import QtBot

from app.editor.library_watch import watch_metadata
from app.editor.session import Session
from app.plan.parameters import PARAMETERS
from metadata.acting import AMOUNTS
from metadata.library import FOLDERS, HABITS, STYLES
from tests.gui.japanese import speaking
from tests.gui.players.conftest import ShowPlayers
from tests.support.windows import child
from widgets.common.chip import Chip
from widgets.common.combo import Combo
from widgets.common.section import Section
from widgets.players.panel import PlayersPanel


@pytest.fixture
def panel(session: Session, show_players: ShowPlayers) -> PlayersPanel:
    made = show_players(session, 1900)
    section = child(made, Section, "players_acting")
    assert not section.is_open, "folded away until it is opened"
    QTest.mouseClick(section.header, Qt.MouseButton.LeftButton)
    QApplication.processEvents()
    return made


def chip(panel: PlayersPanel, habit: str) -> Chip:
    found = panel.findChild(Chip, f"habit_{habit}")
    assert found is not None, habit
    return found


def click(widget: QWidget) -> None:
    assert widget.isVisible()
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton)


def habits(session: Session) -> list[str]:
    return [player.parameters.habits for player in session.project.players]


def test_a_style_is_chosen_with_the_keys_and_taken_back(panel: PlayersPanel, session: Session) -> None:
    combo = child(panel, Combo, "parameter_style")
    assert combo.shown == "section_player"
    assert combo.count() == len(STYLES.now().items)
    first, second = session.project.players[:2]
    combo.setFocus()
    QTest.keyClick(combo, Qt.Key.Key_Down)
    chosen = session.project.player(first.id).parameters.style
    assert chosen != "section_player"
    assert session.project.player(second.id).parameters.style == "section_player"
    assert combo.shown == chosen
    session.set_players((first.id, second.id))
    assert combo.shown is None, "two styles are a dash"
    session.document.undo()
    assert session.project.player(first.id).parameters.style == "section_player"
    assert combo.shown == "section_player"


def test_habits_are_switched_one_by_one_for_all_who_are_selected(panel: PlayersPanel, session: Session) -> None:
    first, second = session.project.players[:2]
    click(chip(panel, "tapper"))
    assert habits(session) == ["tapper", "", "", ""]
    session.set_players((first.id, second.id))
    assert not chip(panel, "tapper").isChecked(), "only one of both has it"
    assert "1" in chip(panel, "tapper").toolTip()
    click(chip(panel, "nodder"))
    assert habits(session) == ["nodder,tapper", "nodder", "", ""], "the other habits stay"
    click(chip(panel, "tapper"))
    assert habits(session) == ["nodder,tapper", "nodder,tapper", "", ""]
    assert chip(panel, "tapper").isChecked()
    QTest.keyClick(chip(panel, "tapper"), Qt.Key.Key_Space)
    assert habits(session) == ["nodder", "nodder", "", ""]
    assert len(session.document.done) == 4
    for _ in range(4):
        session.document.undo()
    assert habits(session) == ["", "", "", ""]
    assert not chip(panel, "nodder").isChecked()


def test_layers_are_shown_and_hidden_whatever_their_amounts(panel: PlayersPanel, session: Session) -> None:
    first, second = session.project.players[:2]
    box, slider = panel.findChild(QCheckBox, "layer_gaze"), panel.findChild(QWidget, "parameter_gaze")
    assert slider is not None
    assert box.checkState() == Qt.CheckState.Checked
    click(box)
    assert [player.parameters.layers_off for player in session.project.players] == ["gaze", "", "", ""]
    assert not slider.isEnabled()
    assert session.project.player(first.id).parameters.gaze == 1.0, "the amount is kept"
    session.set_players((first.id, second.id))
    assert box.checkState() == Qt.CheckState.PartiallyChecked
    assert slider.isEnabled()
    QTest.keyClick(box, Qt.Key.Key_Space)
    assert box.checkState() == Qt.CheckState.Checked, "shown by all"
    click(box)
    sway = child(panel, QCheckBox, "layer_sway")
    click(sway)
    assert [player.parameters.layers_off for player in session.project.players] == ["gaze,sway", "gaze,sway", "", ""]
    for _ in range(4):
        session.document.undo()
    assert [player.parameters.layers_off for player in session.project.players] == [""] * 4
    assert box.checkState() == Qt.CheckState.Checked


def test_everything_is_within_the_panel_and_nothing_overlaps(panel: PlayersPanel) -> None:
    section = child(panel, Section, "players_acting")
    amounts = [name for name in AMOUNTS if PARAMETERS[name].section == "acting"]
    controls = [panel.findChild(QWidget, f"parameter_{name}") for name in ("style", *amounts)]
    controls += [chip(panel, name) for name in HABITS.now().items]
    boxes = []
    for control in controls:
        box = control.rect().translated(control.mapTo(section, QPoint()))
        assert section.rect().contains(box), control.objectName()
        boxes.append(box)
    for number, box in enumerate(boxes):
        assert not any(box.intersects(other) for other in boxes[:number])


def test_the_folded_section_says_what_the_player_is(session: Session, show_players: ShowPlayers) -> None:
    panel = show_players(session, 1900)
    section = child(panel, Section, "players_acting")
    assert section.header.accessibleName() == "Acting Section player"
    QTest.mouseClick(section.header, Qt.MouseButton.LeftButton)
    QApplication.processEvents()
    click(chip(panel, "tapper"))
    assert section.header.accessibleName() == "Acting Section player +1"


def test_names_are_in_the_language_of_the_editor(panel: PlayersPanel) -> None:
    with speaking():
        combo = child(panel, Combo, "parameter_style")
        assert combo.currentText() == STYLES.now().items["section_player"].title.ja
        assert chip(panel, "tapper").text() == HABITS.now().items["tapper"].title.ja


def test_the_users_own_style_is_there_as_soon_as_its_file_is_and_a_fault_is_shown(
    session: Session, show_players: ShowPlayers, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder in FOLDERS:
        (tmp_path / folder.name).mkdir()
        monkeypatch.setenv(folder.variable, str(tmp_path / folder.name))
        monkeypatch.setattr(folder, "last", None)
    watch_metadata(session)
    panel = show_players(session, 1900)
    combo = child(panel, Combo, "parameter_style")
    noticed: list[str] = []
    session.noticed.connect(lambda message, _: noticed.append(message.id))
    text = 'name = "mine"\ntitle = { en = "My own" }\n[factors]\nsway = 2.0\n'
    (tmp_path / "styles" / "mine.toml").write_text(text, encoding="utf-8")
    qtbot.waitUntil(lambda: combo.findText("My own") >= 0)
    first = session.project.players[0]
    combo.chosen.emit("mine")
    assert session.project.player(first.id).parameters.style == "mine"
    (tmp_path / "styles" / "mine.toml").write_text(text.replace("2.0", '"much"'), encoding="utf-8")
    qtbot.waitUntil(lambda: "table.invalid" in noticed)
    assert combo.findText("My own") >= 0, "the last good version stays"
