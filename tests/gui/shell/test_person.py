"""A person made with sliders: displayed, saved, changed and assigned like any other character."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QCheckBox, QComboBox, QLabel, QLineEdit, QListWidget, QPushButton
from pytestqt.qtbot import QtBot

from app.rig.characters.character_library import FOLDER_VARIABLE, character_library, reload_characters
from app.rig.model import Character
from app.rig.people.body_shapes import years_of
from app.rig.people.bundled_people import bundled_person, our_years
from app.rig.people.person import Person
from app.rig.skinning import mesh_named
from app.shell.app import Program
from tests.gui.shell.conftest import trigger
from tests.support.windows import PATIENCE_MS, child
from widgets.common.character_picture import seen
from widgets.common.number_slider import NumberSlider
from widgets.dialogs.characters import CharactersDialog
from widgets.dialogs.person import PersonDialog


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    own = tmp_path / "characters"
    monkeypatch.setenv(FOLDER_VARIABLE, str(own))
    reload_characters()
    yield own
    monkeypatch.undo()
    reload_characters()


def slide(dialog: PersonDialog, name: str, text: str) -> None:
    """Type a number into a slider."""
    slider = child(dialog, NumberSlider, f"person_{name}")
    slider.type_value(text)
    QTest.keyClick(child(slider, QLineEdit, "number_field"), Qt.Key.Key_Return)


def test_a_person_is_made_and_changed(program: Program, qtbot: QtBot) -> None:
    trigger(program, "application.characters")
    listed = child(program.window, CharactersDialog, "characters")
    child(listed, QPushButton, "characters_make").click()
    dialog = child(program.window, PersonDialog, "person")
    assert not dialog._buttons.ok.isEnabled()
    like = child(dialog, QComboBox, "person_like")
    like.setCurrentIndex(like.findData("cast_thomas"))
    like.activated.emit(like.currentIndex())
    assert dialog.person.phenotype == bundled_person("cast_thomas").phenotype
    slide(dialog, "height_m", "1.71")
    slide(dialog, "age", "40")
    child(dialog, QLineEdit, "person_title").setText("Tom")
    qtbot.waitUntil(lambda: not dialog._pictures["head"].pixmap().isNull(), timeout=PATIENCE_MS)
    dialog._buttons.ok.click()
    (entry,) = character_library().own.values()
    assert entry.title == "Tom"
    assert entry.person is not None
    assert entry.person.phenotype.height_m == 1.71
    assert round(years_of(entry.person.phenotype.age)) == 40
    assert entry.person.colors == bundled_person("cast_thomas").colors
    assert child(listed, QListWidget, "character_list").item(0).text() == "Tom"
    child(listed, QPushButton, "characters_edit").click()
    (again,) = (one for one in program.window.findChildren(PersonDialog) if one.isVisible())
    assert child(again, NumberSlider, "person_height_m").value == 1.71
    slide(again, "height_m", "1.8")
    again._buttons.ok.click()
    (entry,) = character_library().own.values()
    assert entry.person is not None
    assert entry.person.phenotype.height_m == 1.8


def test_age_shows_while_the_slider_is_dragged(program: Program, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = []
    monkeypatch.setattr("widgets.dialogs.person.seen", lambda character: drawn.append(character) or seen(character))
    trigger(program, "application.characters")
    child(child(program.window, CharactersDialog, "characters"), QPushButton, "characters_make").click()
    dialog = child(program.window, PersonDialog, "person")
    qtbot.waitUntil(lambda: bool(drawn) and not dialog._drawing, timeout=PATIENCE_MS)
    young, count = hair_of(drawn[-1]), len(drawn)
    age = child(dialog, NumberSlider, "person_age")
    years = itertools.cycle([*range(40, 80), *range(80, 40, -1)])

    def drawn_meanwhile() -> bool:
        age.changed.emit(float(next(years)), object())
        return len(drawn) > count

    qtbot.waitUntil(drawn_meanwhile, timeout=PATIENCE_MS)
    slide(dialog, "age", "88")
    qtbot.waitUntil(lambda: hair_of(drawn[-1]) > 10.0 * young, timeout=PATIENCE_MS)
    keep = child(dialog, QCheckBox, "person_looks_age")
    assert keep.isChecked()
    keep.click()
    qtbot.waitUntil(lambda: hair_of(drawn[-1]) == young, timeout=PATIENCE_MS)
    assert dialog.person.looks_years == 0.0
    keep.click()
    assert dialog.person.looks_years == pytest.approx(our_years("cast_aiko"))
    keep.click()
    child(dialog, QLineEdit, "person_title").setText("Dyed")
    dialog._buttons.ok.click()
    (entry,) = character_library().own.values()
    assert entry.person is not None
    assert entry.person.looks_years == 0.0
    child(child(program.window, CharactersDialog, "characters"), QPushButton, "characters_edit").click()
    (again,) = (one for one in program.window.findChildren(PersonDialog) if one.isVisible())
    assert not child(again, QCheckBox, "person_looks_age").isChecked()
    again.reject()


def hair_of(character: Character) -> float:
    """Return the mean of the linear colour factors of a character's hair."""
    return sum(mesh_named(character, "hair").materials[0].base_color[:3]) / 3.0


def test_what_a_person_is_too_small_for_is_said(
    program: Program, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def strained_on(character: Character, person: Person) -> tuple[str, ...]:
        asked.append(person)
        return ("flute", "oboe") if person.phenotype.height_m < 1.5 else ()

    monkeypatch.setattr("widgets.dialogs.person.strained_on", strained_on)
    trigger(program, "application.characters")
    child(child(program.window, CharactersDialog, "characters"), QPushButton, "characters_make").click()
    dialog = child(program.window, PersonDialog, "person")
    said = child(dialog, QLabel, "person_strained")
    qtbot.waitUntil(lambda: "every instrument" in said.text(), timeout=PATIENCE_MS)
    slide(dialog, "height_m", "1.45")
    assert "Trying" in said.text()
    qtbot.waitUntil(lambda: said.text().endswith("Flute, Oboe"), timeout=PATIENCE_MS)
    assert asked[-1].phenotype.height_m == 1.45
    like = child(dialog, QComboBox, "person_like")
    like.setCurrentIndex(like.findData("child_hina"))
    like.activated.emit(like.currentIndex())
    slide(dialog, "age", "40")
    assert years_of(dialog.person.phenotype.age) == pytest.approx(15.0)
    dialog.reject()
