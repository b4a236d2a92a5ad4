"""Panels that can be moved, floated, tabbed and closed, protected against accidental drags."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from PySide6.QtCore import QEvent, QMargins, QObject, QPoint, QRect, Qt, QTimer
from PySide6.QtGui import QGuiApplication, QMouseEvent, QShowEvent
from PySide6.QtWidgets import QDockWidget, QMainWindow, QTabBar, QWidget

from app.editor.session import Session
from widgets.common.controls import IconButton, named, small
from widgets.common.layouts import in_row
from widgets.common.plain import Label

MODIFIER: Final = Qt.KeyboardModifier.ControlModifier
"""Key that must be held for a drag of the title to move a panel."""
FRAME: Final = (
    Qt.WindowType.Tool
    | Qt.WindowType.CustomizeWindowHint
    | Qt.WindowType.WindowTitleHint
    | Qt.WindowType.WindowSystemMenuHint
    | Qt.WindowType.WindowCloseButtonHint
)
FRAME_PX: Final = QMargins(6, 34, 6, 6)
"""Margins in pixels for a window frame that the system has not drawn yet."""
FLOAT_SHARE: Final = 0.8
"""Largest share of the main window's width and height that a floating panel takes, so that it does not look docked."""
_PRESSES: Final = (QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonDblClick)


def on_screen(frame: QRect, screens: Sequence[QRect]) -> QRect:
    """Return a window's rectangle moved and shrunk to lie within one screen: the one with the largest part of it, or
    the nearest.

    Parameters
    ----------
    frame : QRect
        Rectangle of the window including its frame.
    screens : sequence of QRect
        Available rectangle of each screen; at least one.
    """

    def closeness(screen: QRect) -> tuple[int, int]:
        shared, between = screen.intersected(frame), screen.center() - frame.center()
        return max(shared.width(), 0) * max(shared.height(), 0), -(between.x() ** 2 + between.y() ** 2)

    screen = max(screens, key=closeness)
    size = frame.size().boundedTo(screen.size())
    x = min(max(frame.x(), screen.x()), screen.x() + screen.width() - size.width())
    y = min(max(frame.y(), screen.y()), screen.y() + screen.height() - size.height())
    return QRect(QPoint(x, y), size)


class Dock(QDockWidget):
    """A dock widget with a plain title bar that moves only by its button or by a drag with Ctrl.

    A floating dock is a window with the system's frame that lies within one screen.

    Parameters
    ----------
    name : str
        Object name, under which the layout is stored.
    panel : QWidget
        Content of the dock.
    session : Session
        Session whose theme and language the title bar follows.
    parent : QMainWindow
        Window that has the dock.
    tools : QWidget, optional
        Widget in the title bar after the title.
    """

    def __init__(
        self, name: str, panel: QWidget, session: Session, parent: QMainWindow, tools: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName(f"dock_{name}")
        self.setWidget(panel)
        self._window = parent
        self._has_floated = False
        self._held = False
        """Qt drags it."""
        self._session, self._title, self._bar = session, Label(), named(QWidget(), "dock_title")
        self._bar.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        float_tip, close_tip = "dock.float_or_dock_this_panel", "dock.close_tip"
        buttons = (
            small(IconButton(session, "float", float_tip, self._toggle_floating, "float_panel", dim=True)),
            small(IconButton(session, "close", close_tip, self.close, "close_panel", dim=True)),
        )
        middle = (self._title, 1) if tools is None else self._title
        rest = () if tools is None else ((tools, 1),)
        if tools is not None:
            # The background of the bar shows through.
            tools.setAutoFillBackground(False)
        in_row(middle, *rest, *buttons, of=self._bar, margins=(10, 1, 3, 1), spacing=1)
        self.setTitleBarWidget(self._bar)
        session.theme_changed.connect(self._apply_theme)
        self.windowTitleChanged.connect(self._title.setText)
        self.topLevelChanged.connect(lambda floating: self._frame_soon())
        application = QGuiApplication.instance()
        if isinstance(application, QGuiApplication):
            application.screenRemoved.connect(self._frame_soon)
        self._apply_theme()

    # Float and dock

    def _toggle_floating(self) -> None:
        if self.isFloating():
            self.setFloating(False)
            return
        size, known = self.size(), self._has_floated
        self.setFloating(True)
        if not known:
            window = self._window.frameGeometry()
            frame = QRect(QPoint(), size.boundedTo(window.size() * FLOAT_SHARE))
            frame.moveCenter(window.center())
            self.setGeometry(frame)

    def _frame_soon(self) -> None:
        """Call `_frame` after Qt has finished the current event, which may be a drag."""
        QTimer.singleShot(0, self, self._frame)

    def _frame(self) -> None:
        """Give a floating panel the system's frame, and move it within the screen."""
        if not self.isFloating() or self.isHidden() or self._held:
            return
        self._has_floated = True
        if self.windowFlags() & Qt.WindowType.FramelessWindowHint:
            # Qt draws no frame around a panel with a custom title bar.
            place = self.geometry()
            self.setWindowFlags(FRAME)
            self.setGeometry(place)
            self.show()
        inner = self.geometry()
        frame = inner.marginsAdded(FRAME_PX).united(self.frameGeometry())
        seen = on_screen(frame, [screen.availableGeometry() for screen in QGuiApplication.screens()])
        if seen != frame:
            left, top = inner.topLeft().x() - frame.x(), inner.topLeft().y() - frame.y()
            right, bottom = frame.right() - inner.right(), frame.bottom() - inner.bottom()
            self.setGeometry(seen.marginsRemoved(QMargins(left, top, right, bottom)))

    # Appearance

    def set_tip(self, tip: str) -> None:
        """Set the tool tip of the title."""
        self._title.setToolTip(tip)

    def _apply_theme(self) -> None:
        tokens = self._session.tokens
        self._bar.setStyleSheet(
            f"#dock_title {{ background: {tokens.surface}; border-bottom: 1px solid {tokens.line}; }}"
        )
        self._title.setStyleSheet(f"color: {tokens.text_dim}; font-weight: 600;")

    # Qt overrides

    def event(self, event: QEvent) -> bool:
        kind = event.type()
        if isinstance(event, QMouseEvent) and kind in _PRESSES and self._is_on_title(event):
            docks_again = kind == QEvent.Type.MouseButtonDblClick and self.isFloating()
            if not docks_again and not event.modifiers() & MODIFIER:
                event.accept()
                return True
            self._held = kind == QEvent.Type.MouseButtonPress
            # While Ctrl is held Qt would not dock the panel anywhere.
            return super().event(_without_modifiers(event))
        done = super().event(event)
        if kind == QEvent.Type.MouseButtonRelease:
            self._held = False
            self._frame_soon()
        return done

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self.isFloating():
            self._frame_soon()

    def _is_on_title(self, event: QMouseEvent) -> bool:
        # The right button opens a menu.
        return event.button() == Qt.MouseButton.LeftButton and self._bar.geometry().contains(event.position().toPoint())


def _without_modifiers(event: QMouseEvent) -> QMouseEvent:
    return QMouseEvent(
        event.type(),
        event.position(),
        event.globalPosition(),
        event.button(),
        event.buttons(),
        Qt.KeyboardModifier.NoModifier,
    )


class TabsStay(QObject):
    """Event filter that keeps Qt from tearing tabs of docks out of their bar when they are dragged.

    Parameters
    ----------
    window : QMainWindow
        Window whose tab bars are filtered.
    """

    def __init__(self, window: QMainWindow) -> None:
        super().__init__(window)
        window.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kind = event.type()
        if kind == QEvent.Type.ChildPolished:
            child = event.child()  # type: ignore[attr-defined]
            if isinstance(child, QTabBar):
                child.installEventFilter(self)
        elif kind == QEvent.Type.MouseMove and isinstance(watched, QTabBar) and isinstance(event, QMouseEvent):
            outside = not watched.rect().contains(event.position().toPoint())
            return outside and not event.modifiers() & MODIFIER
        return False
