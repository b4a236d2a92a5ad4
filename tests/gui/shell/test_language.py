"""Both languages: all visible texts change with a switch, and every character can be drawn."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QFont, QFontDatabase, QRawFont
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QDockWidget,
    QGroupBox,
    QLabel,
    QLineEdit,
    QMenu,
    QTabBar,
    QTreeWidget,
    QWidget,
)
from pytestqt.qtbot import QtBot

from app.editor.settings import Settings
from app.project.choreography_files import bundled_choreographies
from app.shell.app import Program
from app.shell.language import TEXTS
from app.shell.preferences import show_preferences
from tests.gui.shell.conftest import trigger
from widgets.common.actions import actions
from widgets.common.font import JAPANESE_FAMILIES

KEPT = (
    ".toml",
    ".glb",
    *(
        "MIDI",
        "MusicXML",
        "FBX",
        "BVH",
        "VMC",
        "Suisou",
        "Qt",
        "Python",
        "PySide6",
        "English",
        "Apache License",
        "OpenGL",
        "Esc",
    ),
    *("ppp", "fff", "sfz"),
    *("Ctrl", "Shift", "Alt", "Home", "End", "Space", "Enter", "Return", "Backspace", "Del", "Delete", "Tab", "Ins"),
    *("Left", "Right", "Up", "Down", "PgUp", "PgDown", "fps", "CPU", "GL", "ms"),
)
"""Words that are the same in Japanese: names, file formats, dynamics, keys, units."""
WORD = re.compile(r"[A-Za-z]{3,}")


def texts(root: QWidget) -> Iterator[tuple[str, str]]:
    """Every text of a widget and its children with its place."""
    for widget in (root, *root.findChildren(QWidget)):
        where = f"{type(widget).__name__} {widget.objectName()}"
        yield where, widget.toolTip()
        if isinstance(widget, QLabel | QAbstractButton):
            yield where, widget.text()
        elif isinstance(widget, QLineEdit):
            yield where, widget.placeholderText()
        elif isinstance(widget, QComboBox):
            yield from ((where, widget.itemText(index)) for index in range(widget.count()))
        elif isinstance(widget, QDockWidget | QMenu | QGroupBox):
            yield where, widget.windowTitle() if isinstance(widget, QDockWidget) else widget.title()
        elif isinstance(widget, QTabBar):
            yield from ((where, widget.tabText(index)) for index in range(widget.count()))
        elif isinstance(widget, QTreeWidget):
            header = widget.headerItem()
            yield from ((where, header.text(column)) for column in range(widget.columnCount()))
        for action in widget.actions():
            yield f"{where}, action {action.objectName()}", action.text()


def english(text: str, names: tuple[str, ...]) -> list[str]:
    """English words of a text that are no names."""
    if "<" in text:
        text = re.sub(r"<[^>]*>", " ", text)
    for name in sorted((*KEPT, *names), key=len, reverse=True):
        text = text.replace(name, " ")
    return WORD.findall(text)


def left_overs(program: Program) -> list[str]:
    names = [player.name for player in program.session.project.players]
    names += [part.name for part in program.session.project.score.parts]
    names += [program.editor.files.name, program.session.project.score.title, program.session.project.source]
    names += bundled_choreographies()
    found = []
    for where, text in texts(program.window):
        words = english(text, tuple(filter(None, names)))
        if words:
            found.append(f"{where}: {text!r}")
    for action in actions(program.session).values():
        for text in (action.text(), action.toolTip()):
            if english(text, tuple(names)):
                found.append(f"action {action.objectName()}: {text!r}")
    return found


@pytest.mark.drawn
def test_a_switch_leaves_no_english(program: Program, qtbot: QtBot) -> None:
    assert len(left_overs(program)) > 100, "the search finds English while the editor speaks it"
    program.editor.speak("ja")
    qtbot.wait(20)
    assert left_overs(program) == []
    assert program.window.menus.menu("file").title() == "ファイル(&F)"
    program.editor.speak("en")
    qtbot.wait(20)
    assert program.window.menus.menu("file").title() == "&File"


def test_all_menus_stay_in_a_small_window(program: Program) -> None:
    program.window.resize(1280, 800)
    bar = program.window.menuBar()
    for language in ("ja", "en", "ja"):
        program.editor.speak(language)
        QApplication.processEvents()
        corner = bar.cornerWidget(Qt.Corner.TopRightCorner)
        assert corner is not None
        for menu in bar.actions():
            place = bar.actionGeometry(menu)
            assert place.width() > 0, (language, menu.text())
            assert place.right() < corner.x(), (language, menu.text())


@pytest.mark.drawn
def test_the_start_page_and_preferences_speak_both(empty: Program, qtbot: QtBot) -> None:
    dialog = show_preferences(empty.editor, "general")
    empty.editor.speak("ja")
    qtbot.wait(20)
    assert left_overs(empty) == []
    seen = [text for _, text in texts(dialog) if text]
    assert dialog.windowTitle() == "環境設定"
    assert [text for text in seen if english(text, ("C D E",))] == []
    dialog.close()


def test_the_language_is_remembered(program: Program, settings: Settings) -> None:
    trigger(program, "language.ja")
    settings.sync()
    assert Settings(settings.path).language == "ja"
    assert actions(program.session)["language.ja"].text() == "日本語"


def test_every_japanese_sign_can_be_drawn(program: Program) -> None:
    family = next((name for name in JAPANESE_FAMILIES if name in QFontDatabase.families()), None)
    assert family is not None, "no Japanese font is installed"
    font = QRawFont.fromFont(QFont(family))
    signs: dict[str, str] = {}
    for _, text in TEXTS.values():
        signs |= {sign: text for sign in text if ord(sign) > 0x7F}
    own = QRawFont.fromFont(program.window.font())
    undrawn = {
        s: text for s, text in signs.items() if not font.supportsCharacter(ord(s)) and not own.supportsCharacter(ord(s))
    }
    assert undrawn == {}
    assert len(signs) > 300


def test_actions_have_texts_in_japanese(program: Program) -> None:
    program.editor.speak("ja")
    missing = [row.id for row in program.editor.table.rows.values() if english(row.text, ())]
    assert missing == []
    assert isinstance(actions(program.session)["file.save"], QAction)
