"""Keys handled by fields and buttons before the window's shortcuts."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QMainWindow
from pytestqt.qtbot import QtBot

from app.shell.keyboard_buttons import KeyboardButtons
from tests.support.windows import show_in_front


@pytest.mark.parametrize("key", [Qt.Key.Key_Return, Qt.Key.Key_Enter])
def test_enter_in_a_field_is_the_fields_and_elsewhere_a_shortcut(
    qtbot: QtBot, qt_app: QApplication, key: Qt.Key
) -> None:
    window = QMainWindow()
    qtbot.addWidget(window)
    KeyboardButtons(qt_app, window)
    field = QLineEdit()
    window.setCentralWidget(field)
    entered, played = list[str](), list[str]()
    field.returnPressed.connect(lambda: entered.append(field.text()))
    play = QAction("Play", window)
    play.setShortcuts([QKeySequence("Return"), QKeySequence("Enter")])
    play.triggered.connect(lambda: played.append("bar"))
    window.addAction(play)
    show_in_front(window)
    field.setFocus()
    qtbot.waitUntil(field.hasFocus)
    QTest.keyClicks(field, "Horn")
    QTest.keyClick(field, key)
    assert (entered, played) == (["Horn"], [])
    field.clearFocus()
    QTest.keyClick(window, key)
    assert (entered, played) == (["Horn"], ["bar"])
