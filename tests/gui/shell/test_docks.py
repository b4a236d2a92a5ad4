"""Docks and splitters by mouse: panels do not float by accident, and stay on the screen."""

from __future__ import annotations

from functools import partial
from itertools import product

import pytest
from PySide6.QtCore import QPoint, QRect, QSize, Qt
from PySide6.QtGui import QColor, QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QSplitter, QTabBar, QWidget
from pytestqt.qtbot import QtBot

from app.editor.design_tokens import THEMES
from app.shell.app import Program
from app.shell.docks import Dock, on_screen
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Start, trigger

LEFT, NONE, CTRL = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ControlModifier
NAMES = ("timeline", "players", "inspector")


def drag(widget: QWidget, start: QPoint, by: QPoint, keys: Qt.KeyboardModifier = NONE) -> None:
    """Press, move in steps, and release; the widget's own pixels."""
    QTest.mousePress(widget, LEFT, keys, start)
    screen = widget.mapToGlobal(start)
    for step in range(1, 11):
        # A panel torn off has moved along under the mouse.
        place = widget.mapFromGlobal(screen + by * (step / 10))
        QTest.mouseMove(widget, place)
        QApplication.processEvents()
    QTest.mouseRelease(widget, LEFT, keys, widget.mapFromGlobal(screen + by))
    QApplication.processEvents()


def centre_of(program: Program) -> QRect:
    centre = program.window.centralWidget()
    return centre.geometry()


def title_of(dock: Dock) -> QWidget:
    title = dock.titleBarWidget()
    assert title is not None
    return title


def screen_of(widget: QWidget) -> QRect:
    return widget.screen().availableGeometry()


def below_separator(dock: Dock) -> QPoint:
    """Point two pixels inside the title bar, just below the splitter."""
    return QPoint(title_of(dock).width() // 2, 2)


def test_a_drag_of_the_title_leaves_a_dock_where_it_is(program: Program) -> None:
    for name in NAMES:
        dock = program.window.docks[name]
        before = dock.geometry()
        drag(title_of(dock), below_separator(dock), QPoint(60, 120))
        QTest.mouseDClick(title_of(dock), LEFT, NONE, below_separator(dock))
        QApplication.processEvents()
        assert not dock.isFloating(), name
        assert dock.geometry() == before


def test_ctrl_and_a_drag_tear_a_dock_off(program: Program, qtbot: QtBot) -> None:
    for name in NAMES:
        dock = program.window.docks[name]
        drag(title_of(dock), QPoint(20, 10), QPoint(180, -90), CTRL)
        qtbot.waitUntil(partial(has_frame, dock))
        assert screen_of(dock).contains(dock.frameGeometry())


def has_frame(dock: Dock) -> bool:
    """Return whether a dock floats with a frame drawn by the system."""
    flags = dock.windowFlags()
    framed = bool(flags & Qt.WindowType.WindowTitleHint) and not flags & Qt.WindowType.FramelessWindowHint
    return dock.isFloating() and dock.isVisible() and framed


def is_docked(dock: Dock, size: QSize) -> bool:
    return not dock.isFloating() and dock.size() == size


def test_the_float_button_gives_a_window_with_a_frame_that_looks_like_one(program: Program, qtbot: QtBot) -> None:
    window = program.window
    for name in NAMES:
        dock = window.docks[name]
        docked = dock.size()
        button = dock.findChild(QWidget, "float_panel")
        assert isinstance(button, QWidget)
        QTest.mouseClick(button, LEFT)
        qtbot.waitUntil(partial(has_frame, dock))
        assert screen_of(dock).contains(dock.frameGeometry())
        assert dock.width() <= 0.85 * window.width()
        assert dock.height() <= 0.85 * window.height()
        # The title inside moves nothing on its own, and brings it back with a double click.
        place = dock.pos()
        drag(title_of(dock), QPoint(20, 10), QPoint(40, 40))
        assert dock.pos() == place
        QTest.mouseDClick(title_of(dock), LEFT, NONE, QPoint(20, 10))
        qtbot.waitUntil(partial(is_docked, dock, docked))


def test_a_floating_dock_of_a_larger_screen_comes_back_on_this_one(start: Start, qtbot: QtBot) -> None:
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    dock = first.window.docks["timeline"]
    dock.setFloating(True)
    qtbot.waitUntil(lambda: has_frame(dock))
    # Simulates a second screen at the right.
    dock.setGeometry(5200, 1700, 1900, 700)
    QApplication.processEvents()
    first.window.close()
    second = start()
    second.editor.files.open(QUARTET, ask=False)
    again = second.window.docks["timeline"]
    qtbot.waitUntil(lambda: has_frame(again))
    assert again.isFloating()
    qtbot.waitUntil(lambda: screen_of(second.window).contains(again.frameGeometry()))


def test_a_tab_is_not_torn_off(program: Program, qtbot: QtBot) -> None:
    window = program.window
    players, inspector = window.docks["players"], window.docks["inspector"]
    window.tabifyDockWidget(players, inspector)

    def bars() -> list[QTabBar]:
        return [bar for bar in window.findChildren(QTabBar) if bar.parent() is window and bar.isVisible()]

    qtbot.waitUntil(lambda: bool(bars()))
    (bar,) = bars()
    drag(bar, bar.tabRect(0).center(), QPoint(300, -260))
    assert not players.isFloating()
    assert not inspector.isFloating()
    assert bar.count() == 2


def test_lines_between_panels_are_broad_and_reach_to_the_title(program: Program) -> None:
    window, dock = program.window, program.window.docks["timeline"]
    centre = centre_of(program)
    assert dock.geometry().top() - centre.bottom() - 1 == 8
    players = window.docks["players"]
    assert centre.left() - players.geometry().right() - 1 == 8
    for splitter in window.findChildren(QSplitter):
        assert splitter.handleWidth() == 8
    height = dock.height()
    # The lowest pixel of the line, just over the title.
    drag(window, QPoint(window.width() // 2, dock.geometry().top() - 1), QPoint(0, -40))
    assert not dock.isFloating()
    assert abs(dock.height() - height - 40) <= 2


def test_lines_between_panels_show_a_grip(program: Program) -> None:
    window = program.window
    for theme in ("dark", "light"):
        trigger(program, f"theme.{theme}")
        QApplication.processEvents()
        picture, central = window.grab().toImage(), centre_of(program)
        ground, grip = QColor(THEMES[theme].sunken), QColor(THEMES[theme].text_dim)
        level = QRect(central.left(), central.bottom() + 1, central.width(), 8)
        upright = QRect(window.docks["players"].geometry().right() + 1, central.top(), 8, central.height())
        for line in (level, upright):
            shades = colours(picture, line)
            assert ground.name() in shades
            assert any(_near(QColor(shade), grip) for shade in shades), (line, shades)
        # In the middle, where it is looked for.
        ends = QRect(level.topLeft(), QSize(level.width() // 2 - 40, 8))
        assert colours(picture, ends) == {ground.name()}


def colours(picture: QImage, box: QRect) -> set[str]:
    assert picture.devicePixelRatio() == 1.0
    places = product(range(box.left(), box.right() + 1), range(box.top(), box.bottom() + 1))
    return {picture.pixelColor(x, y).name() for x, y in places}


def _near(one: QColor, other: QColor) -> bool:
    return max(abs(one.red() - other.red()), abs(one.green() - other.green()), abs(one.blue() - other.blue())) <= 40


SCREEN, RIGHT = QRect(0, 0, 1920, 1080), QRect(1920, 0, 1280, 1024)


@pytest.mark.parametrize(
    ("frame", "screens", "expected"),
    [
        (QRect(100, 100, 400, 300), [SCREEN], QRect(100, 100, 400, 300)),
        (QRect(1800, 900, 400, 300), [SCREEN], QRect(1520, 780, 400, 300)),
        (QRect(-50, -20, 400, 300), [SCREEN], QRect(0, 0, 400, 300)),
        (QRect(5000, 3000, 400, 300), [SCREEN], QRect(1520, 780, 400, 300)),
        (QRect(100, 100, 2500, 1400), [SCREEN], QRect(0, 0, 1920, 1080)),
        (QRect(2000, 800, 400, 300), [SCREEN, RIGHT], QRect(2000, 724, 400, 300)),
        (QRect(1700, 10, 400, 300), [SCREEN, RIGHT], QRect(1520, 10, 400, 300)),
    ],
)
def test_a_window_is_put_where_all_of_it_is_seen(frame: QRect, screens: list[QRect], expected: QRect) -> None:
    assert on_screen(frame, screens) == expected
