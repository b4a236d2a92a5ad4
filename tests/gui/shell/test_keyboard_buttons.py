"""Space plays, or presses the button that the keyboard came to."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QToolButton, QWidget
from pytestqt.qtbot import QtBot

from app.shell.app import Program
from tests.support.windows import show_in_front
from widgets.timeline.panel import TimelinePanel

Buttons = tuple[QToolButton, QToolButton]


@pytest.fixture
def buttons(program: Program, qtbot: QtBot) -> Buttons:
    """Two neighbours."""
    panel = program.window.findChild(TimelinePanel)
    assert isinstance(panel, TimelinePanel)
    show_in_front(program.window)
    found = panel.zoom_buttons["zoom_out"], panel.zoom_buttons["zoom_in"]
    for button in found:
        button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    QWidget.setTabOrder(*found)
    return found


def keeps_space(button: QToolButton) -> bool:
    """Return whether Space is the button's, and not the window's, where it plays."""
    assert QApplication.focusWidget() is button
    asked = QKeyEvent(QEvent.Type.ShortcutOverride, Qt.Key.Key_Space, Qt.KeyboardModifier.NoModifier, " ")
    asked.ignore()
    QApplication.sendEvent(button, asked)
    return asked.isAccepted()


@pytest.mark.parametrize(("key", "to"), [(Qt.Key.Key_Tab, 1), (Qt.Key.Key_Backtab, 0)])
def test_space_presses_the_button_that_tab_came_to(buttons: Buttons, key: Qt.Key, to: int) -> None:
    reached, pressed = buttons[to], list[bool]()
    buttons[1 - to].setFocus(Qt.FocusReason.MouseFocusReason)
    QTest.keyClick(buttons[1 - to], key)
    assert keeps_space(reached)
    reached.clicked.connect(lambda: pressed.append(True))
    for _ in range(2):
        QTest.keyClick(reached, Qt.Key.Key_Space)
    assert pressed == [True, True]
    assert keeps_space(reached)


def test_tab_finds_the_first_button_where_nothing_had_the_keyboard(program: Program, buttons: Buttons) -> None:
    focused = QApplication.focusWidget()
    if focused is not None:
        focused.clearFocus()
    buttons[0].setFocus(Qt.FocusReason.OtherFocusReason)
    buttons[0].clearFocus()
    assert QApplication.focusWidget() is None
    QTest.keyClick(program.window, Qt.Key.Key_Tab)
    reached = QApplication.focusWidget()
    assert isinstance(reached, QToolButton)
    assert keeps_space(reached)


def test_space_plays_where_a_button_was_clicked(buttons: Buttons) -> None:
    QTest.mouseClick(buttons[1], Qt.MouseButton.LeftButton)
    assert not keeps_space(buttons[1])


def test_a_click_after_tab_gives_space_back(buttons: Buttons) -> None:
    buttons[0].setFocus(Qt.FocusReason.MouseFocusReason)
    QTest.keyClick(buttons[0], Qt.Key.Key_Tab)
    assert keeps_space(buttons[1])
    QTest.mouseClick(buttons[0], Qt.MouseButton.LeftButton)
    assert not keeps_space(buttons[0])
