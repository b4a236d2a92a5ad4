"""Mouse and keyboard actions for tests of the inspector."""

from __future__ import annotations

from typing import TypeVar

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QLineEdit, QTabWidget, QWidget

from widgets.common.number_slider import NumberSlider
from widgets.inspector.rows import LineList

W = TypeVar("W", bound=QWidget)


def child(parent: QWidget, kind: type[W], name: str) -> W:
    # Widgets put into a layout show themselves from the event loop.
    QApplication.processEvents()
    found = [one for one in parent.findChildren(kind, name) if not one.isHidden()]
    assert found, name
    return found[-1]


def number(parent: QWidget, name: str) -> NumberSlider:
    return child(parent, NumberSlider, name)


def type_into(control: NumberSlider, text: str) -> None:
    assert control.isVisible()
    control.type_value()
    # A field closed a moment ago may still exist.
    field = control.findChildren(QLineEdit, "number_field")[-1]
    if text.isascii():
        QTest.keyClicks(field, text)
    else:
        # QTest knows keys of ASCII only.
        field.insert(text)
    QTest.keyClick(field, Qt.Key.Key_Return)


def click(parent: QWidget, name: str) -> None:
    QTest.mouseClick(child(parent, QAbstractButton, name), Qt.MouseButton.LeftButton)


def click_line(view: LineList, row: int) -> None:
    assert view.isVisible()
    box = view.visualRect(view.lines.index(row))
    QTest.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=box.center())


def show_tab(parent: QWidget, number: int) -> None:
    tabs = child(parent, QTabWidget, "inspector_tabs")
    QTest.mouseClick(tabs.tabBar(), Qt.MouseButton.LeftButton, pos=tabs.tabBar().tabRect(number).center())
    assert tabs.currentIndex() == number


def drag(control: NumberSlider, pixels: int) -> None:
    start = QPoint(20, control.height() // 2)
    QTest.mousePress(control, Qt.MouseButton.LeftButton, pos=start)
    for share in (0.2, 0.6, 1.0):
        QTest.mouseMove(control, start + QPoint(round(pixels * share), 0))
    QTest.mouseRelease(control, Qt.MouseButton.LeftButton, pos=start + QPoint(pixels, 0))
