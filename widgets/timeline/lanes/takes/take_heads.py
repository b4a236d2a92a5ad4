"""Headings of the takes with colour, name and time: a click selects, a double click uses the whole take, a drag
reorders.
"""

from __future__ import annotations

from typing import Final, Protocol

from PySide6.QtCore import QEvent, QLineF, QObject, QRectF, Qt
from PySide6.QtGui import (
    QColor,
    QContextMenuEvent,
    QFontMetricsF,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QWheelEvent,
)
from PySide6.QtWidgets import QLineEdit, QMenu, QToolTip, QWidget

from app.project.edit.placed_takes import BEFORE
from widgets.common.actions import actions
from widgets.common.controls import Retranslated, named
from widgets.common.icons import icon
from widgets.common.take_times import clock_text, when_text
from widgets.timeline.lanes.takes.take_drawing import STRIP_PX, TakesView
from widgets.timeline.model.takes.take_rows import TakeRow
from widgets.timeline.plot.drawing import draw_text, shade, small_font

BAR_PX: Final = 5.0
BUTTON_PX: Final = 24.0
DRAG_PX: Final = 6.0


class Headed(TakesView, Protocol):
    """Part of the lane needed by the headings; a protocol, since the lane imports this module."""

    @property
    def header(self) -> QWidget: ...
    @property
    def folded(self) -> bool: ...
    @property
    def row_px(self) -> float: ...
    def row_at(self, y_px: float) -> TakeRow | None: ...
    def choose(self, take_id: str) -> None: ...
    def pan_y(self, by_px: float) -> None: ...
    def menu(self) -> QMenu: ...
    def wheeled(self, event: QWheelEvent) -> None: ...


class TakeHeads(Retranslated, QWidget):
    """Names of the rows in the lane's header.

    Attributes
    ----------
    dropped_before : int or None
        During a drag, the index of the row before which the take would be placed.
    """

    def __init__(self, lane: Headed) -> None:
        super().__init__(lane.header)
        self.setObjectName("take_heads")
        self._lane = lane
        self._hovered: str | None = None
        self.dropped_before: int | None = None
        self._pressed: tuple[str, float] | None = None
        self._field: QLineEdit | None = None
        self._typed_id = BEFORE
        self.setMouseTracking(True)
        self.texted(self, name="take_heads.takes")
        lane.header.installEventFilter(self)
        self._place()

    def retranslate(self) -> None:
        self.update()

    def name_of(self, row: TakeRow) -> str:
        """Return the name of a row: that of its take, or a text for the notes before the first take."""
        return self.tr("take_heads.before") if row.take is None else row.take.name

    def tip(self, row: TakeRow) -> str:
        """Return the time and device of a take, and the possible actions."""
        if row.take is None:
            return self.tr("take_heads.original_part_tip")
        take = row.take
        when = when_text(take.recorded)
        seconds = (take.end_us - take.start_us) / 1e6
        about = self.tr("take_heads.s_notes").format(seconds=seconds, count=len(row.pitches))
        lines = (take.name, " · ".join(text for text in (when, take.device) if text), about)
        return "\n".join((*(text for text in lines if text), self.tr("take_heads.double_click_takes_all_of")))

    # Renaming

    def type_name(self, take_id: str) -> None:
        """Open a field for a take's name."""
        number, take = self._lane.model.number_of(take_id), self._lane.model.take_of(take_id)
        if number is None or take is None:
            return
        self._end_typing(False)
        box = self._row_box(number)
        field = named(QLineEdit(take.name, self), "take_name_field")
        field.setAccessibleName(self.tr("take_heads.name_of_take"))
        field.setGeometry(QRectF(BAR_PX + 1.0, box.center().y() - 13.0, self.width() - BAR_PX - 3.0, 26.0).toRect())
        field.selectAll()
        field.editingFinished.connect(lambda: self._end_typing(True))
        field.installEventFilter(self)
        field.show()
        field.setFocus(Qt.FocusReason.OtherFocusReason)
        self._field, self._typed_id = field, take_id

    def _end_typing(self, keep: bool) -> None:
        field, self._field = self._field, None
        if field is None:
            return
        field.removeEventFilter(self)
        held = field.hasFocus()
        text = field.text()
        field.hide()
        field.deleteLater()
        if held:
            self._lane.plot.setFocus(Qt.FocusReason.OtherFocusReason)
        take = self._lane.model.take_of(self._typed_id)
        if keep and take is not None and text != take.name:
            self._lane.model.rename(self._typed_id, text)

    # Position

    def _place(self) -> None:
        header = self._lane.header
        self.setGeometry(0, round(STRIP_PX), header.width(), max(header.height() - round(STRIP_PX), 0))

    def _row_box(self, number: int) -> QRectF:
        return self._lane.row_rect(number).translated(0.0, -STRIP_PX)

    def _row_at(self, y: float) -> TakeRow | None:
        return self._lane.row_at(y + STRIP_PX)

    def _button(self, box: QRectF) -> QRectF:
        return QRectF(self.width() - BUTTON_PX - 2.0, box.center().y() - BUTTON_PX / 2, BUTTON_PX, BUTTON_PX)

    def _over_button(self, row: TakeRow, event: QMouseEvent) -> bool:
        number = self._lane.model.number_of(row.take_id)
        return number is not None and self._button(self._row_box(number)).contains(event.position())

    # Qt overrides

    def paintEvent(self, event: QPaintEvent) -> None:
        lane = self._lane
        if lane.folded:
            return
        tokens, painter = lane.session.tokens, QPainter(self)
        audition = lane.session.listening.take
        for number, row in enumerate(lane.model.rows):
            box = self._row_box(number)
            box.setWidth(float(self.width()))
            if box.bottom() < 0.0 or box.top() > self.height():
                continue
            chosen = lane.session.selection.take == row.take_id
            hovered = self._hovered == row.take_id
            if chosen or hovered:
                painter.fillRect(box, shade(tokens.accent, 56) if chosen else QColor(tokens.raised))
            painter.fillRect(
                QRectF(0.0, box.top() + 1.0, BAR_PX, box.height() - 2.0), QColor(lane.model.colour_of(row.take_id))
            )
            is_audible = audition is not None and audition.take_id == row.take_id
            shows_button = hovered or chosen or is_audible
            right = self.width() - (BUTTON_PX + 4.0 if shows_button else 4.0)
            self._paint_words(painter, row, QRectF(BAR_PX + 5.0, box.top(), right - BAR_PX - 5.0, box.height()))
            if shows_button:
                pixels = self._button(box).toRect().adjusted(3, 3, -3, -3)
                icon("stop" if is_audible else "play", tokens, tokens.accent if is_audible else tokens.text).paint(
                    painter, pixels
                )
            painter.setPen(QPen(QColor(tokens.line), 1.0))
            bottom = round(box.bottom()) - 0.5
            painter.drawLine(QLineF(0.0, bottom, self.width(), bottom))
        if self.dropped_before is not None:
            top = self._row_box(self.dropped_before).top()
            painter.setPen(QPen(QColor(tokens.accent), 2.0))
            painter.drawLine(QLineF(0.0, top, self.width(), top))

    def _paint_words(self, painter: QPainter, row: TakeRow, room: QRectF) -> None:
        tokens = self._lane.session.tokens
        small = small_font(self.font())
        first, second = QFontMetricsF(self.font()).height(), QFontMetricsF(small).height()
        about = clock_text(row.take.recorded) if row.take is not None else ""
        two = bool(about) and room.height() >= first + second
        top = room.center().y() - (first + second if two else first) / 2
        painter.setFont(self.font())
        painter.setPen(QColor(tokens.text if row.take is not None else tokens.text_dim))
        draw_text(painter, QRectF(room.left(), top, room.width(), first), self.name_of(row))
        if two:
            painter.setFont(small)
            painter.setPen(QColor(tokens.text_dim))
            draw_text(painter, QRectF(room.left(), top + first, room.width(), second), about)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self._lane.header and event.type() == QEvent.Type.Resize:
            self._place()
        elif watched is self._field and event.type() == QEvent.Type.KeyPress:
            assert isinstance(event, QKeyEvent)
            if event.key() == Qt.Key.Key_Escape:
                self._end_typing(False)
                return True
        elif watched is self._field and event.type() == QEvent.Type.ShortcutOverride:
            # Letters are typed here, which are shortcuts in the timeline.
            event.accept()
            return True
        return super().eventFilter(watched, event)

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            row = self._row_at(float(event.pos().y()))
            if row is None:
                QToolTip.hideText()
            else:
                QToolTip.showText(event.globalPos(), self.tip(row), self)
            return True
        return super().event(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._pressed is not None:
            self._drag(event.position().y())
            return
        row = self._row_at(event.position().y())
        hovered = row.take_id if row is not None else None
        if hovered != self._hovered:
            self._hovered = hovered
            self.update()

    def leaveEvent(self, event: QEvent) -> None:
        self._hovered = None
        self.update()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        row = self._row_at(event.position().y())
        if row is None:
            return
        lane = self._lane
        lane.plot.setFocus(Qt.FocusReason.MouseFocusReason)
        over = event.button() == Qt.MouseButton.LeftButton and self._over_button(row, event)
        lane.choose(row.take_id)
        if over:
            actions(lane.session)["takes.listen"].trigger()
        elif event.button() == Qt.MouseButton.LeftButton and row.take is not None:
            self._pressed = row.take_id, event.position().y()

    def _drag(self, y: float) -> None:
        assert self._pressed is not None
        if self.dropped_before is None and abs(y - self._pressed[1]) < DRAG_PX:
            return
        lane = self._lane
        # Scrolls to rows outside the view.
        lane.pan_y(-(min(y, 0.0) + max(y - self.height(), 0.0)))
        nearest = round((y - self._row_box(0).top()) / lane.row_px)
        # The row of the performance before the first take stays on top.
        before = min(max(nearest, 1), len(lane.model.rows))
        if before != self.dropped_before:
            self.dropped_before = before
            self.setCursor(Qt.CursorShape.ClosedHandCursor)
            self.update()

    def cancel_drag(self) -> None:
        """End a drag without a change."""
        self._pressed = self.dropped_before = None
        self.unsetCursor()
        self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        pressed, before = self._pressed, self.dropped_before
        self.cancel_drag()
        if pressed is not None and before is not None:
            self._lane.model.move_lane(pressed[0], before)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        row = self._row_at(event.position().y())
        if row is not None and event.button() == Qt.MouseButton.LeftButton and not self._over_button(row, event):
            self._lane.model.take_whole(row.take_id)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        row = self._row_at(float(event.pos().y()))
        event.accept()
        if row is not None:
            self._lane.choose(row.take_id)
            menu = self._lane.menu()
            menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
            menu.popup(event.globalPos())

    def wheelEvent(self, event: QWheelEvent) -> None:
        self._lane.wheeled(event)
