"""A user's mouse: presses what can be seen, and goes through menus as far as an entry.

It moves by events of its own. `QTest.mouseMove` of a widget asks the display to move its pointer and does not wait for
it: on a busy machine Qt then believes the mouse to be where it was before. A menu that comes up in the meantime closes
at a click there, since Qt takes that for the end of the click that opened it.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

from PySide6.QtCore import QPoint, QRect, Qt, QTimer
from PySide6.QtGui import QAction, QContextMenuEvent, QCursor
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QCheckBox, QMenu, QMenuBar, QRadioButton, QScrollArea, QToolButton, QWidget

from tests.support.windows import PATIENCE_MS, wait_until

LEFT = Qt.MouseButton.LeftButton
NONE = Qt.KeyboardModifier.NoModifier

_place = QPoint()
"""Position of the mouse on the screen according to Qt."""


def park_pointer() -> None:
    """Move the display's own pointer to a corner where no menu opens under it."""
    QCursor.setPos(QApplication.primaryScreen().geometry().topRight())
    # The answer comes after the display has moved it.
    QCursor.pos()
    QApplication.processEvents()


def move(widget: QWidget, place: QPoint) -> None:
    """Move the mouse to a position of a widget."""
    global _place
    window = widget.window()
    _place = widget.mapToGlobal(place)
    QTest.mouseMove(window.windowHandle(), widget.mapTo(window, place))


def bring_into_view(widget: QWidget) -> None:
    """Scroll every area that contains the widget."""
    above = widget.parentWidget()
    while above is not None:
        if isinstance(above, QScrollArea) and above.widget() is not None and above.widget().isAncestorOf(widget):
            above.ensureWidgetVisible(widget)
        above = above.parentWidget()


def press(widget: QWidget, place: QPoint | None = None) -> None:
    """Click a widget at its position on the screen.

    Raises
    ------
    AssertionError
        It is hidden, greyed out or out of sight.
    """

    def is_seen() -> bool:
        bring_into_view(widget)
        return not widget.isVisible() or not widget.visibleRegion().isEmpty()

    # Panels that a click before has resized, or put back into the window, are laid out again after a moment.
    QApplication.processEvents()
    wait_until(is_seen)
    assert widget.isVisible(), "hidden"
    assert widget.isEnabled(), "greyed out"
    seen: QRect = widget.visibleRegion().boundingRect()
    assert not seen.isEmpty(), "out of sight"
    if place is None:
        # A box with a text is hit at its mark, however wide it is.
        place = seen.center() if not isinstance(widget, QCheckBox | QRadioButton) else QPoint(10, seen.center().y())
    move(widget, place)
    QTest.mouseClick(widget, LEFT, NONE, place)


def choose(menu: QMenu, entry: QAction) -> None:
    """Click an entry of an open menu."""
    assert menu.isVisible(), "the menu is closed"
    # When the display first shows it, Qt takes it for the menu in front, also if a submenu has come up meanwhile.
    assert QTest.qWaitForWindowExposed(menu, PATIENCE_MS), "the display does not show the menu"
    # Qt leaves a click alone where the mouse was when the menu came.
    bounds, mouse = menu.actionGeometry(entry), menu.mapFromGlobal(_place)
    sides = (QPoint(bounds.left() + 14, bounds.center().y()), QPoint(bounds.right() - 14, bounds.center().y()))
    place = max(sides, key=lambda side: (side - mouse).manhattanLength())
    move(menu, place)
    QTest.mouseClick(menu, LEFT, NONE, place)


def open_submenu(menu: QMenu, entry: QAction, inner: QMenu) -> None:
    """Open a submenu by clicking its entry.

    Raises
    ------
    AssertionError
        It does not open.
    """
    choose(menu, entry)
    # The submenu appears after a moment.
    wait_until(lambda: inner.isVisible() or not menu.isVisible())
    assert inner.isVisible(), f"{entry.text()} does not open"


def in_menu_of(button: QToolButton, do: Callable[[QMenu], None]) -> None:
    """Open the menu of a button by a click, call a function, and close the menu.

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
    """Open the context menu at a position; None if there is none."""
    event = QContextMenuEvent(QContextMenuEvent.Reason.Mouse, place, widget.mapToGlobal(place))
    QApplication.sendEvent(widget, event)
    QApplication.processEvents()
    popup = QApplication.activePopupWidget()
    return popup if isinstance(popup, QMenu) else None


def open_in_bar(bar: QMenuBar, path: list[QMenu]) -> QMenu:
    """Open a menu of a menu bar, and submenus in it, by clicks."""
    title = path[0].menuAction()
    QTest.mouseClick(bar, LEFT, NONE, bar.actionGeometry(title).center())
    for outer, inner in pairwise(path):
        open_submenu(outer, inner.menuAction(), inner)
    return path[-1]
