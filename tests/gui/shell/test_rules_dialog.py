"""File > Acting Metadata > Acting Rules by mouse and keys, compared with the performance and the user's files."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TypeVar

import msgspec
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractSpinBox, QCheckBox, QDoubleSpinBox, QLabel, QListWidget, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from app.errors import Message
from app.shell.app import Program
from metadata.library import FOLDERS, RULES
from metadata.rule_draft import OWN
from metadata.rules import Rule, read_rules
from tests.gui.shell.conftest import trigger
from widgets.dialogs.rule_fields import Several
from widgets.dialogs.rules import RulesDialog


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for folder in FOLDERS:
        monkeypatch.setenv(folder.variable, str(tmp_path / folder.name))
        monkeypatch.setattr(folder, "last", None)
    return tmp_path


@pytest.fixture
def dialog(folders: Path, program: Program) -> RulesDialog:
    # As loud as possible, so that faces are strained.
    session = program.session
    parts = tuple(
        msgspec.structs.replace(part, notes=tuple(msgspec.structs.replace(note, velocity=120) for note in part.notes))
        for part in session.project.score.parts
    )
    score = msgspec.structs.replace(session.project.score, parts=parts)
    session.apply(Message("edit.piece_settings"), dataclasses.replace(session.project, score=score))
    return opened(program)


def opened(program: Program) -> RulesDialog:
    trigger(program, "file.rules")
    (found,) = [one for one in program.window.findChildren(RulesDialog) if one.isVisible()]
    return found


Kind = TypeVar("Kind", bound=QWidget)


def part(dialog: RulesDialog, kind: type[Kind], name: str) -> Kind:
    found = dialog.findChild(kind, name)
    assert isinstance(found, kind), name
    return found


def click(dialog: RulesDialog, name: str) -> None:
    QTest.mouseClick(part(dialog, QPushButton, f"rules_{name}"), Qt.MouseButton.LeftButton)


def tick(box: QCheckBox) -> None:
    QTest.mouseClick(box, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, QPoint(8, box.height() // 2))


def type_into(field: QAbstractSpinBox, text: str) -> None:
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Qt.Key.Key_Return)


def names(dialog: RulesDialog) -> list[str]:
    return [one.rule.name for one in dialog.draft]


def select(dialog: RulesDialog, name: str) -> int:
    row = names(dialog).index(name)
    part(dialog, QListWidget, "rules_list").setCurrentRow(row)
    return row


def rule(dialog: RulesDialog, name: str) -> Rule:
    return dialog.draft[names(dialog).index(name)].rule


def said(dialog: RulesDialog) -> str:
    return part(dialog, QLabel, "rules_problem").text()


def own_file(folders: Path) -> Path:
    return folders / "rules" / f"{OWN}.toml"


def strained(program: Program) -> list[float]:
    plans = program.session.performance.plans
    return [e.strength for plan in plans.values() for e in plan.expressions if e.id.startswith("expression:strained:")]


def test_a_number_is_changed_previewed_and_saved_in_the_users_folder(
    dialog: RulesDialog, program: Program, folders: Path, qtbot: QtBot
) -> None:
    qtbot.waitUntil(lambda: program.session.performance.planned)
    before = strained(program)
    assert before
    select(dialog, "strained")
    tick(part(dialog, QCheckBox, "rules_preview"))
    type_into(part(dialog, QDoubleSpinBox, "rule_strength"), "0.5")
    assert rule(dialog, "strained").do.strength == 0.5
    assert part(dialog, QListWidget, "rules_list").currentItem().text().endswith(" *")
    qtbot.waitUntil(lambda: program.session.performance.planned and strained(program) != before)
    assert max(strained(program)) == pytest.approx(0.5 * max(before), abs=1e-3)
    assert not own_file(folders).exists()
    click(dialog, "save")
    assert not dialog.isVisible()
    assert read_rules(own_file(folders)).rules[0].do.strength == 0.5
    qtbot.waitUntil(lambda: program.generator.up_to_date)
    assert max(strained(program)) == pytest.approx(0.5 * max(before), abs=1e-3)
    again = opened(program)
    assert rule(again, "strained").do.strength == 0.5
    select(again, "strained")
    click(again, "remove")
    click(again, "save")
    assert not own_file(folders).exists()
    qtbot.waitUntil(lambda: strained(program) == before)


def test_what_was_previewed_is_gone_after_cancel(dialog: RulesDialog, program: Program, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: program.session.performance.planned)
    before = strained(program)
    tick(part(dialog, QCheckBox, "rules_preview"))
    row = select(dialog, "strained")
    rules = part(dialog, QListWidget, "rules_list")
    rules.setFocus()
    QTest.keyClick(rules, Qt.Key.Key_Space)
    assert not dialog.draft[row].rule.enabled
    qtbot.waitUntil(lambda: program.session.performance.planned and not strained(program))
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: program.session.performance.planned and strained(program) == before)
    assert not RULES.now().files


def test_a_rule_is_added_by_keys_and_told_from_what_is_missing(dialog: RulesDialog, folders: Path) -> None:
    rules = part(dialog, QListWidget, "rules_list")
    rules.setFocus()
    QTest.keyClick(rules, Qt.Key.Key_Insert)
    assert names(dialog)[-1] == "rule_1"
    assert part(dialog, QPushButton, "rules_save").isEnabled()
    tick(part(dialog, QCheckBox, "rule_loudness_above_asked"))
    assert "turn on a condition" in said(dialog)
    assert not part(dialog, QPushButton, "rules_save").isEnabled()
    tick(part(dialog, QCheckBox, "rule_longer_s_asked"))
    assert said(dialog) == ""
    type_into(part(dialog, QDoubleSpinBox, "rule_longer_s"), "2.5")
    growth = part(dialog, Several, "rule_grows_with")
    next(entry for entry in growth.menu().actions() if entry.objectName() == "loudness").trigger()
    assert "Loudness at least" in said(dialog)
    assert "loudness" in said(dialog)
    next(entry for entry in growth.menu().actions() if entry.objectName() == "loudness").trigger()
    next(entry for entry in growth.menu().actions() if entry.objectName() == "length").trigger()
    assert said(dialog) == ""
    click(dialog, "save")
    (made,) = read_rules(own_file(folders)).rules
    assert (made.when.longer_s, made.do.grows_with, made.when.loudness_above) == (2.5, "length", None)


def test_a_rule_is_duplicated_and_removed_by_keys(dialog: RulesDialog) -> None:
    row = select(dialog, "puffed")
    rules = part(dialog, QListWidget, "rules_list")
    rules.setFocus()
    QTest.keyClick(rules, Qt.Key.Key_D, Qt.KeyboardModifier.ControlModifier)
    assert names(dialog)[row + 1] == "puffed_1"
    assert rules.currentRow() == row + 1
    QTest.keyClick(rules, Qt.Key.Key_Delete)
    assert "puffed_1" not in names(dialog)
    rules.setCurrentRow(row)
    QTest.keyClick(rules, Qt.Key.Key_Delete)
    assert not dialog.draft[row].rule.enabled, "one of ours is switched off"


def test_a_number_stays_within_its_bounds(dialog: RulesDialog) -> None:
    select(dialog, "strained")
    type_into(part(dialog, QDoubleSpinBox, "rule_strength"), "7")
    assert rule(dialog, "strained").do.strength <= 1.0
    assert part(dialog, QDoubleSpinBox, "rule_stays_s").suffix() == " s"


def test_looking_at_every_rule_changes_none(dialog: RulesDialog) -> None:
    before = dialog.draft
    for row in range(len(before)):
        part(dialog, QListWidget, "rules_list").setCurrentRow(row)
    assert dialog.draft is before


def test_return_in_a_number_takes_it_and_leaves_the_dialog_open(dialog: RulesDialog) -> None:
    select(dialog, "strained")
    type_into(part(dialog, QDoubleSpinBox, "rule_strength"), "0.25")
    assert rule(dialog, "strained").do.strength == 0.25
    assert dialog.isVisible()
    QTest.keyClick(dialog, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)
    assert not dialog.isVisible()


def test_excluded_styles_and_the_spread_of_starts_are_changed(dialog: RulesDialog) -> None:
    select(dialog, "page")
    excluded = part(dialog, Several, "rule_not_styles")
    assert excluded.chosen == ("marching_band",)
    (reserved,) = [entry for entry in excluded.menu().actions() if entry.objectName() == "reserved"]
    reserved.trigger()
    spread = part(dialog, QDoubleSpinBox, "rule_spread_s")
    assert spread.isEnabled()
    type_into(spread, "3.5")
    changed = rule(dialog, "page")
    assert set(changed.when.not_styles) == {"marching_band", "reserved"}
    assert changed.do.spread_s == 3.5
    select(dialog, "strained")
    assert not spread.isEnabled(), "expressions begin where they are asked for"
    assert rule(dialog, "strained").do.spread_s == 0.0
