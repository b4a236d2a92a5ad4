"""Making expressions by mouse and keys."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QCheckBox, QComboBox, QLineEdit, QToolButton, QWidget
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.project import presets
from metadata.load import load_expression
from metadata.model import ARKIT_MORPHS
from tests.gui.inspector.hands import child, click, drag, number, type_into
from widgets.common.number_slider import NumberSlider
from widgets.common.section import Section
from widgets.inspector.expression_maker import GROUPS, mirrored
from widgets.inspector.face_picture import FacePicture
from widgets.inspector.panel import InspectorPanel


def unfold(panel: QWidget) -> None:
    header = child(panel, Section, "inspector_expressions").header
    QTest.mouseClick(header, Qt.MouseButton.LeftButton)


def choose(panel: InspectorPanel, name: str) -> None:
    combo = child(panel, QComboBox, "expression_choice")
    combo.setCurrentIndex(combo.findData(name))
    combo.activated.emit(combo.currentIndex())


def test_every_morph_has_a_place() -> None:
    for morph in ARKIT_MORPHS:
        assert sum(morph.startswith(beginnings) for _, beginnings in GROUPS) == 1
        assert mirrored(mirrored(morph)) == morph
        assert mirrored(morph) in ARKIT_MORPHS


def test_the_face_is_live_only_while_it_is_looked_at(panel: InspectorPanel, planned: Session) -> None:
    assert planned.preview_morphs is None
    assert not panel.findChildren(NumberSlider, "morph_jawOpen")
    unfold(panel)
    assert len([one for one in panel.findChildren(NumberSlider) if one.objectName().startswith("morph_")]) == 52
    choose(panel, "strained")
    assert planned.preview_morphs == load_expression("strained").weights
    click(panel, "expression_preview")
    assert planned.preview_morphs is None
    click(panel, "expression_preview")
    assert planned.preview_morphs is not None
    unfold(panel)
    assert planned.preview_morphs is None


def test_its_face_is_drawn_beside_the_sliders(panel: InspectorPanel, planned: Session, qtbot: QtBot) -> None:
    unfold(panel)
    choose(panel, "fierce")
    drawn = child(panel, FacePicture, "expression_picture")
    qtbot.waitUntil(lambda: not drawn.pixmap().isNull())
    fierce = drawn.pixmap().toImage()
    choose(panel, "smile")
    qtbot.waitUntil(lambda: drawn.pixmap().toImage() != fierce)
    unfold(panel)
    assert drawn.weights is None


def test_a_bundled_one_is_duplicated_then_changed(panel: InspectorPanel, planned: Session) -> None:
    unfold(panel)
    choose(panel, "smile")
    assert not number(panel, "morph_browInnerUp").isEnabled()
    click(panel, "expression_duplicate")
    [own] = planned.project.expressions
    assert own.weights == load_expression("smile").weights
    assert own.name != "smile"
    drag(number(panel, "morph_browOuterUpLeft"), 90)
    [own] = planned.project.expressions
    assert own.weights["browOuterUpLeft"] > 0.1
    assert own.weights["browOuterUpRight"] == own.weights["browOuterUpLeft"]
    assert planned.preview_morphs == own.weights
    assert len(planned.document.done) == 2
    click(panel, "expression_both")
    type_into(number(panel, "morph_browOuterUpRight"), "0")
    [own] = planned.project.expressions
    assert "browOuterUpRight" not in own.weights
    assert own.weights["browOuterUpLeft"] > 0.1


def test_name_playing_and_fades(panel: InspectorPanel, planned: Session) -> None:
    unfold(panel)
    choose(panel, "strained")
    click(panel, "expression_duplicate")
    title = child(panel, QLineEdit, "expression_name")
    title.selectAll()
    QTest.keyClicks(title, "Furious")
    QTest.keyClick(title, Qt.Key.Key_Return)
    assert [item.name for item in planned.project.expressions] == ["Furious"]
    playing = child(panel, QCheckBox, "expression_while_playing")
    before = planned.project.expressions[0].while_playing
    QTest.keyClick(playing, Qt.Key.Key_Space)
    assert planned.project.expressions[0].while_playing is not before
    type_into(number(panel, "expression_fade_in_s"), "0.75")
    assert planned.project.expressions[0].fade_in_s == 0.75
    assert "Furious" in planned.performance.expressions
    planned.document.undo()
    planned.document.undo()
    planned.document.undo()
    assert [item.name for item in planned.project.expressions] != ["Furious"]


def test_kept_for_other_projects_and_removed_here(panel: InspectorPanel, planned: Session) -> None:
    unfold(panel)
    choose(panel, "puffed")
    click(panel, "expression_duplicate")
    name = planned.project.expressions[0].name
    click(panel, "expression_keep")
    assert set(presets.expressions(presets.expression_folder()).items) == {name}
    click(panel, "expression_remove")
    assert planned.project.expressions == ()
    choose(panel, name)
    click(panel, "expression_duplicate")
    assert [item.name for item in planned.project.expressions] == [name]
    assert planned.project.expressions[0].weights == pytest.approx(load_expression("puffed").weights)


def test_what_was_kept_is_deleted_from_the_folder_alone(panel: InspectorPanel, planned: Session) -> None:
    unfold(panel)
    choose(panel, "puffed")
    click(panel, "expression_duplicate")
    name = planned.project.expressions[0].name
    click(panel, "expression_keep")
    click(panel, "expression_remove")
    choose(panel, name)
    before, steps = planned.project, planned.document.done
    click(panel, "expression_remove")
    assert presets.expressions(presets.expression_folder()).items == {}
    assert (planned.project, planned.document.done) == (before, steps)
    remove = child(panel, QToolButton, "expression_remove")
    assert not remove.isEnabled(), "what comes with the program stays"
