"""A user's mouse: presses what can be seen, and goes through menus as far as an entry."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

from PySide6.QtCore import QPoint, QRect, Qt, QTimer
from PySide6.QtGui import QAction, QContextMenuEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu, QMenuBar, QScrollArea, QToolButton, QWidget

LEFT = Qt.MouseButton.LeftButton
NONE = Qt.KeyboardModifier.NoModifier


def bring_into_view(widget: QWidget) -> None:
    """Scroll every area that holds the widget."""
    above = widget.parentWidget()
    while above is not None:
        if isinstance(above, QScrollArea) and above.widget() is not None and above.widget().isAncestorOf(widget):
            above.ensureWidgetVisible(widget)
        above = above.parentWidget()


def press(widget: QWidget, place: QPoint | None = None) -> None:
    """Click a widget where the display shows it.

    Raises
    ------
    AssertionError
        It is hidden, greyed out or covered by another.
    """
    bring_into_view(widget)
    QApplication.processEvents()
    assert widget.isVisible(), "hidden"
    assert widget.isEnabled(), "greyed out"
    seen: QRect = widget.visibleRegion().boundingRect()
    assert not seen.isEmpty(), "out of sight"
    place = seen.center() if place is None else place
    window = widget.window()
    hit = window.childAt(widget.mapTo(window, place)) if window is not widget else widget
    assert hit is widget or (hit is not None and widget.isAncestorOf(hit)), f"covered by {hit}"
    QTest.mouseMove(widget, place)
    QTest.mouseClick(widget, LEFT, NONE, place)


def choose(menu: QMenu, entry: QAction) -> None:
    """Click an entry of a menu that is open."""
    assert menu.isVisible(), "the menu is closed"
    place = menu.actionGeometry(entry).center()
    QTest.mouseMove(menu, place)
    QTest.mouseClick(menu, LEFT, NONE, place)


def in_menu_of(button: QToolButton, do: Callable[[QMenu], None]) -> None:
    """Open the menu of a button by a click, do something in it, and close it.

    Raises
    ------
    AssertionError
        No menu comes.
    """
    faults: list[BaseException] = []
    done: list[QMenu] = []

    def look() -> None:
        menu = QApplication.activePopupWidget()
        if not isinstance(menu, QMenu):
            return
        watch.stop()
        done.append(menu)
        try:
            do(menu)
        except BaseException as fault:  # noqa: BLE001 - raised again outside of Qt's loop
            faults.append(fault)
        menu.close()

    # A button with a menu runs a loop of its own until the menu is closed.
    watch = QTimer()
    watch.timeout.connect(look)
    watch.start()
    press(button)
    look()
    watch.stop()
    if faults:
        raise faults[0]
    assert done, "no menu came"


def menu_at(widget: QWidget, place: QPoint) -> QMenu | None:
    """Ask for the context menu of a place; None: there is none."""
    event = QContextMenuEvent(QContextMenuEvent.Reason.Mouse, place, widget.mapToGlobal(place))
    QApplication.sendEvent(widget, event)
    QApplication.processEvents()
    popup = QApplication.activePopupWidget()
    return popup if isinstance(popup, QMenu) else None


def open_in_bar(bar: QMenuBar, path: list[QMenu]) -> QMenu:
    """Open a menu of a menu bar and those in it, each by a click."""
    title = path[0].menuAction()
    QTest.mouseClick(bar, LEFT, NONE, bar.actionGeometry(title).center())
    for outer, inner in pairwise(path):
        choose(outer, inner.menuAction())
    QApplication.processEvents()
    assert path[-1].isVisible(), f"{path[-1].objectName()} did not open"
    return path[-1]
