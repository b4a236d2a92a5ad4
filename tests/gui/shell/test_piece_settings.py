"""File > Piece Settings: all entries change the document in one step, and nothing else changes."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TypeVar

import msgspec
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QLabel,
    QLineEdit,
    QPushButton,
    QWidget,
)

from app.project.casting import ConductorPlace
from app.project.edit.piece import PieceSettings, piece_settings
from app.project.storage import load
from app.shell.app import Program
from tests.gui.shell.conftest import Answers, trigger
from widgets.dialogs.piece_settings import PieceSettingsDialog

OTHER = PieceSettings(
    "Fanfare & Co.", Fraction(24000, 1001), 2.5, 1.5, 7, 0.8, ConductorPlace(-0.5, 1.75, on_stage=True)
)


@pytest.fixture
def dialog(program: Program) -> PieceSettingsDialog:
    """Dialog opened by its shortcut with the focus in the timeline."""
    program.editor.table.refresh()
    QTest.keyClick(program.window.timeline.roll.plot, Qt.Key.Key_Return, Qt.KeyboardModifier.AltModifier)
    return visible(program)


def opened(program: Program) -> PieceSettingsDialog:
    trigger(program, "file.piece_settings")
    return visible(program)


def visible(program: Program) -> PieceSettingsDialog:
    (found,) = [one for one in program.window.findChildren(PieceSettingsDialog) if one.isVisible()]
    return found


Kind = TypeVar("Kind", bound=QWidget)


def part(dialog: PieceSettingsDialog, kind: type[Kind], name: str) -> Kind:
    found = dialog.findChild(kind, f"piece_{name}")
    assert isinstance(found, kind)
    return found


def type_into(field: QWidget, text: str) -> None:
    field.setFocus()
    QTest.keyClick(field, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    QTest.keyClicks(field, text)


def click(dialog: PieceSettingsDialog, name: str) -> None:
    QTest.mouseClick(part(dialog, QPushButton, name), Qt.MouseButton.LeftButton)


def fill_in(dialog: PieceSettingsDialog) -> None:
    """Enter the settings of `OTHER` by keyboard only."""
    type_into(part(dialog, QLineEdit, "title"), OTHER.title)
    type_into(part(dialog, QComboBox, "rate"), "23.976")
    type_into(part(dialog, QDoubleSpinBox, "preroll"), "2.5")
    beats = part(dialog, QComboBox, "felt_beat")
    for _ in range(beats.findData(OTHER.felt_beat_quarters)):
        QTest.keyClick(beats, Qt.Key.Key_Down)
    type_into(part(dialog, QDoubleSpinBox, "section_intensity"), "0.8")
    part(dialog, QCheckBox, "conducted").setFocus()
    QTest.keyClick(part(dialog, QCheckBox, "conducted"), Qt.Key.Key_Space)
    type_into(part(dialog, QDoubleSpinBox, "conductor_x"), "-0.5")
    type_into(part(dialog, QDoubleSpinBox, "conductor_z"), "1.75")
    type_into(part(dialog, QLineEdit, "seed"), "7")


def test_all_is_one_step_that_is_undone_saved_and_read_again(
    program: Program, dialog: PieceSettingsDialog, answers: Answers, tmp_path: Path
) -> None:
    session, before = program.session, program.session.project
    fill_in(dialog)
    QTest.keyClick(part(dialog, QLineEdit, "seed"), Qt.Key.Key_Return)
    assert not dialog.isVisible()
    after = session.project
    assert piece_settings(after) == OTHER
    score = msgspec.structs.replace(before.score, title=OTHER.title)
    changed = {field: getattr(OTHER, field) for field in OTHER.__struct_fields__ if field != "title"}
    assert after == replace(before, score=score, **changed), "nothing else changed"
    assert [step.name.id for step in session.document.done] == ["edit.piece_settings"]
    trigger(program, "edit.undo")
    assert session.project is before
    trigger(program, "edit.redo")
    assert session.project is after

    answers.path = tmp_path / "piece.suisou"
    program.editor.files.save()
    written = json.loads(answers.path.read_text())
    assert (written["fps"], written["preroll_beats"], written["felt_beat_quarters"], written["seed"]) == (
        *("24000/1001", 2.5, 1.5, 7),
    )
    assert piece_settings(load(answers.path)) == OTHER
    program.editor.files.open(answers.path, ask=False)
    assert piece_settings(session.project) == OTHER


@pytest.mark.parametrize("leave", ["ok", "cancel"])
def test_no_change_is_no_step(program: Program, dialog: PieceSettingsDialog, leave: str) -> None:
    before = program.session.project
    if leave == "cancel":
        fill_in(dialog)
    click(dialog, leave)
    assert not dialog.isVisible()
    assert program.session.project is before
    assert not program.session.document.done


def test_what_the_fields_cannot_show_stays_if_it_is_left_alone(program: Program) -> None:
    session = program.session
    score = msgspec.structs.replace(session.project.score, title="two\nlines " + "x" * 300)
    odd = replace(session.project, score=score, fps=Fraction(1000, 7), preroll_beats=10 / 3, felt_beat_quarters=1.25)
    session.document.open(odd)
    dialog = opened(program)
    assert part(dialog, QComboBox, "rate").currentText() == "1000/7"
    click(dialog, "ok")
    assert session.project is odd


@pytest.mark.parametrize(
    ("field", "kind", "wrong", "right"),
    [
        ("rate", QComboBox, ["", "0", "241", "fast", "30/", "1/0", "1e3", "nan", "-24"], "30000/1001"),
        ("seed", QLineEdit, ["", "-1", "1.5", "x", "9223372036854775808", "9" * 5000], "9223372036854775807"),
    ],
)
def test_what_is_impossible_is_said_in_place(
    program: Program, dialog: PieceSettingsDialog, field: str, kind: type[QWidget], wrong: list[str], right: str
) -> None:
    before, named = program.session.project, {"rate": "Frame rate", "seed": "Seed"}[field]
    problem, ok = part(dialog, QLabel, "problem"), part(dialog, QPushButton, "ok")
    widget = part(dialog, kind, field)
    for text in wrong:
        set_text = widget.setEditText if isinstance(widget, QComboBox) else widget.setText  # type: ignore[attr-defined]
        set_text(text)
        assert problem.text().startswith(named), text
        assert not ok.isEnabled()
        QTest.keyClick(part(dialog, QLineEdit, "title"), Qt.Key.Key_Return)
        assert dialog.isVisible()
    type_into(widget, right)
    assert problem.text() == ""
    click(dialog, "ok")
    assert program.session.project is not before


def test_rates_are_chosen_and_typed_as_they_are_usually_written(program: Program, dialog: PieceSettingsDialog) -> None:
    rate = part(dialog, QComboBox, "rate")
    offered = [rate.itemText(row) for row in range(rate.count())]
    assert offered == ["23.976", "24", "25", "29.97", "30", "48", "50", "59.94", "60", "120"]
    QTest.keyClick(rate, Qt.Key.Key_Up)
    QTest.keyClick(rate, Qt.Key.Key_Return)
    assert program.session.project.fps == Fraction(60000, 1001)
    for typed, fps in (("12", Fraction(12)), ("３０", Fraction(30)), ("48000/1001", Fraction(48000, 1001))):
        again = opened(program)
        part(again, QComboBox, "rate").setEditText(typed)  # QTest has no keys for full-width digits
        QTest.keyClick(part(again, QLineEdit, "title"), Qt.Key.Key_Return)
        assert program.session.project.fps == fps


def test_defaults_are_those_of_a_new_piece_under_the_same_title(program: Program, dialog: PieceSettingsDialog) -> None:
    fill_in(dialog)
    click(dialog, "ok")
    again = opened(program)
    click(again, "reset")
    assert program.session.project.seed == OTHER.seed, "nothing is done before OK"
    click(again, "ok")
    kept = piece_settings(program.session.project)
    program.editor.files.begin()
    assert kept == msgspec.structs.replace(piece_settings(program.session.project), title=OTHER.title)


def test_seeds_are_thrown_like_another_performance_by_everyone(program: Program, dialog: PieceSettingsDialog) -> None:
    seed = part(dialog, QLineEdit, "seed")
    seen = [int(seed.text())]
    for _ in range(3):
        click(dialog, "randomise")
        seen.append(int(seed.text()))
    assert len(set(seen)) == 4
    click(dialog, "ok")
    assert program.session.project.seed == seen[-1]
    trigger(program, "edit.undo")
    trigger(program, "generate.everyone")
    assert program.session.project.seed == seen[1]


def test_the_window_is_called_by_the_new_title(program: Program) -> None:
    program.editor.files.begin()
    dialog = opened(program)
    type_into(part(dialog, QLineEdit, "title"), "Fanfare")
    click(dialog, "ok")
    assert program.window.windowTitle().startswith("Fanfare")


def test_in_japanese_everything_is_japanese(program: Program, dialog: PieceSettingsDialog) -> None:
    program.editor.speak("ja")
    QApplication.processEvents()
    assert dialog.windowTitle() == "曲の設定"
    part(dialog, QLineEdit, "seed").setText("x")
    texts = [label.text() for label in dialog.findChildren(QLabel)]
    texts += [button.text() for button in dialog.findChildren(QPushButton) if button.text() != "OK"]
    beats = part(dialog, QComboBox, "felt_beat")
    texts += [beats.itemText(row) for row in range(beats.count())]
    assert len(texts) >= 16
    assert [text for text in texts if text and text.isascii()] == []
