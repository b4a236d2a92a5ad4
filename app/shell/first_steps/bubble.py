"""The text bubble of the tour, and the frame around the control that it explains."""

from __future__ import annotations

from typing import Final

from PySide6.QtCore import QPoint, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QPushButton, QWidget

from app.editor.session import Session
from widgets.common.clicks import on_click
from widgets.common.controls import Button, IconButton, Retranslated, named, sized, small, wrapped
from widgets.common.layouts import STRETCH, in_column, in_row
from widgets.common.plain import Label

WIDTH_PX: Final = 330
GAP_PX: Final = 10
MARGINS_PX: Final = (14, 8, 8, 12)
FRAME_PX: Final = 2


def place_beside(avoided: QRect, target: QRect, size: QSize, room: QRect) -> QPoint:
    """Return the top left corner of a bubble that does not cover a rectangle.

    Of the places below, above, right and left of it the first one that fits is used, as near to the target as possible.

    Parameters
    ----------
    avoided : QRect
        Rectangle that the bubble must not cover: the part of the window with the target control.
    target : QRect
        Rectangle of the target control.
    size : QSize
        Size of the bubble.
    room : QRect
        Rectangle within which the bubble must lie.
    """
    x = min(max(target.center().x() - size.width() // 2, room.left()), room.right() + 1 - size.width())
    y = min(max(target.center().y() - size.height() // 2, room.top()), room.bottom() + 1 - size.height())
    places = (
        QPoint(x, avoided.bottom() + 1 + GAP_PX),
        QPoint(x, avoided.top() - GAP_PX - size.height()),
        QPoint(avoided.right() + 1 + GAP_PX, y),
        QPoint(avoided.left() - GAP_PX - size.width(), y),
    )
    return next((place for place in places if room.contains(QRect(place, size))), QPoint(x, y))


class Spotlight(QWidget):
    """A frame in the accent colour around the control that a stop of the tour is about; it lets mouse events
    through.
    """

    def __init__(self, session: Session, window: QWidget) -> None:
        super().__init__(window)
        self.setObjectName("first_steps_frame")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._session = session
        session.theme_changed.connect(self.update)
        self.hide()

    # Qt overrides

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(self._session.tokens.accent), FRAME_PX))
        half = FRAME_PX / 2
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(half, half, -half, -half), 5, 5)


class Bubble(Retranslated, QFrame):
    """A bubble with the task and number of one stop of the tour, and the buttons next, back and close.

    Signals
    -------
    back_requested(), next_requested(), closed()
        The button of that name was pressed.
    left()
        Escape was pressed; the bubble gives up the keyboard focus.
    """

    back_requested = Signal()
    next_requested = Signal()
    closed = Signal()
    left = Signal()

    def __init__(self, session: Session, window: QWidget) -> None:
        super().__init__(window)
        self.setObjectName("first_steps")
        self._session = session
        self.setFixedWidth(WIDTH_PX)
        self._step = named(Label(), "first_steps_step")
        self._title = sized(wrapped(named(Label(), "first_steps_title")), 12.0)
        self._text = wrapped(named(Label(), "first_steps_text"))
        self._state = wrapped(named(Label(), "first_steps_state"))
        close = small(IconButton(session, "close", "first_steps.close", self.closed.emit, "first_steps_close"))
        self.back = Button("first_steps.back", self.back_requested.emit, "first_steps_back")
        self.next = named(QPushButton(), "first_steps_next")
        on_click(self.next, self.next_requested.emit)
        head = in_row((self._step, 1), close, margins=0)
        foot = in_row(self.back, STRETCH, self.next, margins=0)
        in_column(head, self._title, self._text, self._state, 4, foot, of=self, margins=MARGINS_PX, spacing=6)
        session.theme_changed.connect(self.apply_theme)
        self._is_done = False
        self.apply_theme()
        self.hide()

    def say(self, step: str, title: str, text: str, state: str, forward: str, is_done: bool, is_first: bool) -> None:
        """Show the texts of a stop, and fit the height to them.

        Parameters
        ----------
        state : str
            Text about the progress of the task.
        forward : str
            Text of the button that leads to the next stop.
        is_done : bool
            True if the task of the stop is done.
        """
        for label, words in ((self._step, step), (self._title, title), (self._text, text), (self._state, state)):
            label.setText(words)
        self.next.setText(forward)
        self.next.setDefault(is_done)
        self.back.setEnabled(not is_first)
        self._is_done = is_done
        self.apply_theme()
        for label in (self._title, self._text, self._state):
            label.setFixedHeight(label.heightForWidth(WIDTH_PX - MARGINS_PX[0] - MARGINS_PX[2]))
        self.adjustSize()

    def apply_theme(self) -> None:
        """Colour the bubble by the theme."""
        tokens = self._session.tokens
        self.setStyleSheet(
            f"#first_steps {{ background: {tokens.raised}; border: 1px solid {tokens.accent}; border-radius: 7px; }}"
        )
        self._title.setStyleSheet("font-weight: 600;")
        self._step.setStyleSheet(f"color: {tokens.text_dim};")
        self._state.setStyleSheet(f"color: {tokens.good if self._is_done else tokens.text_dim};")

    # Qt overrides

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self.left.emit()
        else:
            super().keyPressEvent(event)
