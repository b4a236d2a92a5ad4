"""The ruler: bars, seconds or frames, marks of tempo and metre, loop, selected span, and recorded range."""

from __future__ import annotations

from functools import partial

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import (
    QColor,
    QContextMenuEvent,
    QFocusEvent,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
    QResizeEvent,
)
from PySide6.QtWidgets import QApplication, QMenu, QWidget

from app.arrays import FloatArray
from app.editor.selection import Selection
from app.editor.session import Session, Severity, TimeDisplay
from app.errors import Message
from widgets.common.actions import actions
from widgets.common.clicks import on_click
from widgets.common.controls import Retranslated
from widgets.common.menus import add_actions
from widgets.timeline.lane import GUTTER_PX
from widgets.timeline.model.gestures import MouseGesture, along, snapped
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.lines import Lines
from widgets.timeline.model.ruler.ruler_gestures import HoldEdge, HoldMark, Scrub, SelectSpan
from widgets.timeline.model.ruler.ruler_marks import (
    Labels,
    RulerMark,
    bar_labels,
    clock_labels,
    frame_labels,
    lay_marks,
    mark_text,
    removal,
    typed,
)
from widgets.timeline.plot.drawing import draw_lines, rect
from widgets.timeline.plot.mouse import mouse_at
from widgets.timeline.ruler.mark_editor import MarkEditor
from widgets.timeline.ruler.ruler_unit import UnitButton
from widgets.timeline.ruler.strip import Strip
from widgets.timeline.zoom_and_scroll import TimeAxis

MARKS_PX = 20
SCALE_PX = 24
LOOP_PX, PUNCH_PX = 4.0, 4.0
HEAD_PX = 6.0
HEAD_HEIGHT_PX = 9.0
GRIP_PX = 5.0
"""Distance in pixels within which an edge of the loop or the playhead is grabbed."""


class Ruler(Retranslated, Strip):
    """Ruler above the lanes with bars, seconds, tempo, metres, markers and the loop."""

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, MARKS_PX + SCALE_PX, parent)
        self.setObjectName("ruler")
        self._marks: list[RulerMark] = []
        self._gesture: MouseGesture | None = None
        self._chosen: tuple[str, int] | None = None
        """The mark that was clicked: Delete removes it."""
        self._panned_px: float | None = None
        self._span = session.selection.span
        self._recorded: tuple[object, ...] = ()
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)

        self.texted(self, tip="ruler.drag_to_scrub")
        self.unit_button = UnitButton(session, self)
        self._editor = MarkEditor(self)
        self._editor.typed.connect(self._type)

        axis.changed.connect(self._axis_changed)
        session.changed.connect(self.redraw)
        session.performance_changed.connect(self.redraw)
        session.players_changed.connect(self.redraw)
        session.theme_changed.connect(self.redraw)
        session.selection_changed.connect(self._selection_set)
        session.loop_changed.connect(self.redraw)
        session.time_display_changed.connect(self.redraw)
        session.recording.changed.connect(self._recording_set)
        session.playhead_changed.connect(self._playhead_set)
        self._head_x = 0.0
        self.redraw()

    def retranslate(self) -> None:
        self.redraw()

    # Positions

    def _x(self, seconds: float) -> float:
        return GUTTER_PX + self.axis.x_px(seconds)

    def _mouse(self, event: QMouseEvent) -> LaneMouse:
        place = event.position() - QPointF(GUTTER_PX, 0.0)
        return mouse_at(self.session, self.axis, place, 0.0, event.modifiers(), event.globalPosition().toPoint())

    def _tick_at(self, mouse: LaneMouse, free: bool) -> int:
        return max(snapped(self.session.grid, self.session.project.score, mouse.tick, free), 0)

    def _mark_at(self, place: QPointF) -> RulerMark | None:
        return next((mark for mark in reversed(self._marks) if mark.box.contains(place.x(), place.y())), None)

    def _place_of(self, tick: int) -> float:
        return self.seconds_of(max(tick, 0))

    # Drawing

    def _paint_marks(self, painter: QPainter) -> None:
        tokens = self.session.tokens
        score = self.session.project.score
        metrics = QFontMetricsF(self.font())
        self._marks = lay_marks(score, self.axis, metrics, GUTTER_PX, float(self.width()), MARKS_PX)
        for mark in self._marks:
            held = (mark.kind, mark.tick) == self._chosen
            x = self.x_px(mark.tick)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.accent if held else tokens.raised))
            painter.drawRoundedRect(rect(mark.box), 3.0, 3.0)
            # A mark that began before the left edge is dimmed.
            quiet = tokens.text_dim if x < GUTTER_PX else tokens.text
            painter.setPen(QColor(tokens.accent_text if held else quiet))
            painter.drawText(rect(mark.box), int(Qt.AlignmentFlag.AlignCenter), mark.text)
            if x >= GUTTER_PX:
                painter.setPen(QPen(QColor(tokens.text_dim), 1.0))
                painter.drawLine(QPointF(int(x) + 0.5, MARKS_PX - 3), QPointF(int(x) + 0.5, MARKS_PX + 3))

    def _paint_scale(self, painter: QPainter) -> None:
        tokens = self.session.tokens
        bottom = float(self.height())
        lines = self.axis.lines(self.session.project.score, self.session.grid)
        display = self.session.time_display
        labels = self._labels(display, lines)
        pen = QPen(QColor(tokens.line_strong), 1.0)
        if display == "bars":
            self._upright(painter, lines.beat_s, bottom - 6, pen)
        self._upright(painter, np.array([seconds for seconds, _ in labels], np.float64), MARKS_PX + 4.0, pen)
        painter.setPen(QColor(tokens.text_dim))
        for seconds, text in labels:
            x = int(self._x(seconds)) + 0.5
            if -120 <= x <= self.width() + 4:
                painter.drawText(QRectF(x + 4, MARKS_PX, 120.0, SCALE_PX - 3.0), _MIDDLE, text)

    def _upright(self, painter: QPainter, seconds: FloatArray, top: float, pen: QPen) -> None:
        """Draw vertical lines at times in seconds, from the height ``top`` to the ruler's lower edge."""
        x = np.trunc(GUTTER_PX + self.axis.x_px(seconds)) + 0.5
        draw_lines(painter, x, np.full(len(x), top), x, np.full(len(x), float(self.height())), pen)

    def _labels(self, display: TimeDisplay, lines: Lines) -> Labels:
        project = self.session.project
        if display == "bars":
            return bar_labels(project.score, lines)
        return frame_labels(self.axis, project.fps) if display == "frames" else clock_labels(self.axis)

    def _paint_bands(self, painter: QPainter) -> None:
        tokens = self.session.tokens
        span = self.session.selection.span
        if span is not None:
            self._band(painter, self.seconds_of(span[0]), self.seconds_of(span[1]), tokens.accent, 0.0)
        if self.session.loop_s is not None:
            self._band(painter, *self.session.loop_s, tokens.good, LOOP_PX)
        punch = self._punch_s()
        if punch is not None:
            self._band(painter, *punch, tokens.error, PUNCH_PX, LOOP_PX + 1.0)

    def _punch_s(self) -> tuple[float, float] | None:
        """Return the start and end in seconds of the punch range, to which recording is limited; None if it is not
        limited.
        """
        recording = self.session.recording
        if not recording.punch or recording.punch_ticks is None:
            return None
        return self.seconds_of(recording.punch_ticks[0]), self.seconds_of(recording.punch_ticks[1])

    def _paint_take(self, painter: QPainter) -> None:
        """Paint the range that the current recording has covered so far."""
        recording, loop_s, head_s = self.session.recording, self.session.loop_s, self.session.playhead_s
        start_s = loop_s[0] if recording.passes > 1 and loop_s is not None else recording.start_s
        if recording.running and head_s > start_s:
            shade = QColor(self.session.tokens.error)
            shade.setAlpha(90)
            left = self._x(start_s)
            painter.fillRect(QRectF(left, MARKS_PX, self._x(head_s) - left, SCALE_PX), shade)

    def _band(
        self, painter: QPainter, start_s: float, end_s: float, colour: str, height: float, below: float = 0.0
    ) -> None:
        left, right = self._x(start_s), self._x(end_s)
        shade = QColor(colour)
        shade.setAlpha(60)
        painter.fillRect(QRectF(left, MARKS_PX, right - left, SCALE_PX), shade)
        if height:
            painter.fillRect(QRectF(left, MARKS_PX + below, right - left, height), QColor(colour))
            for x in (left, right - 2):
                painter.fillRect(QRectF(x, MARKS_PX, 2.0, SCALE_PX), QColor(colour))

    # Changes of the session

    def _axis_changed(self) -> None:
        self._editor.leave(False)
        self._head_x = self._x(self.session.playhead_s)
        self.redraw()

    def _selection_set(self) -> None:
        if self.session.selection.span != self._span:
            self._span = self.session.selection.span
            self.redraw()

    def _recording_set(self) -> None:
        recording = self.session.recording
        shown = (recording.punch, recording.punch_ticks, recording.running, recording.passes)
        if shown != self._recorded:
            self._recorded = shown
            self.redraw()

    def _playhead_set(self, playhead_s: float) -> None:
        before, self._head_x = self._head_x, self._x(playhead_s)
        if self.session.recording.running:
            self.update()
            return
        for x in (before, self._head_x):
            self.update(int(x - HEAD_PX) - 1, 0, int(2 * HEAD_PX) + 4, self.height())

    # Editing tempo and metre

    def edit_mark(self, kind: str, tick: int) -> None:
        """Open a field for the tempo or metre at a tick, adding one if necessary."""
        mark = next((mark for mark in self._marks if (mark.kind, mark.tick) == (kind, tick)), None)
        # The start of the bar may be left of the view.
        left = mark.box.left if mark is not None else max(self.x_px(tick), GUTTER_PX)
        self._editor.open(kind, tick, mark_text(self.session.project.score, kind, tick), left, MARKS_PX + 2)

    def _type(self, kind: str, tick: int, text: str) -> None:
        self.session.attempt(*typed(kind, tick, text), origin=self)

    def context_menu(self, place: QPointF) -> QMenu:
        """Return the context menu for a place of the ruler: for the mark there, or for adding one."""
        menu = QMenu(self)
        mark = self._mark_at(place)
        if mark is not None:
            change = menu.addAction(
                self.tr("ruler.change_tempo") if mark.kind == "tempo" else self.tr("ruler.change_metre")
            )
            on_click(change, lambda: self.edit_mark(mark.kind, mark.tick))
            remove = menu.addAction(
                self.tr("ruler.remove_tempo") if mark.kind == "tempo" else self.tr("ruler.remove_metre")
            )
            remove.setEnabled(mark.tick > 0)
            on_click(remove, lambda: self._remove(mark.kind, mark.tick))
            menu.addSeparator()
        score = self.session.project.score
        tick = max(
            self.session.grid.snap(score.metre_map, score.tempo_map.ticks(self.axis.seconds(place.x() - GUTTER_PX))), 0
        )
        bar_tick = max(score.metre_map.tick_of_bar(score.metre_map.bar_of_tick(tick)), 0)
        on_click(menu.addAction(self.tr("ruler.add_tempo_here")), lambda: self.edit_mark("tempo", tick))
        on_click(menu.addAction(self.tr("ruler.add_metre_at_this_bar")), lambda: self.edit_mark("metre", bar_tick))
        felt = [action for id, action in actions(self.session).items() if id.startswith("beat.")]
        if felt:
            menu.addMenu(self.tr("ruler.felt_beat")).addActions(felt)
        menu.addSeparator()
        on_click(menu.addAction(self.tr("ruler.select_this_bar")), lambda: self._select_bar(tick))
        add_actions(menu, self.session, ("play.loop", "notes.select_span", "timeline.zoom_selection", "timeline.fit"))
        return menu

    def _remove(self, kind: str, tick: int) -> None:
        self._chosen = None
        self.redraw()
        self.session.attempt(*removal(kind, tick), origin=self)

    def _select_bar(self, tick: int) -> None:
        metre_map = self.session.project.score.metre_map
        start, end = metre_map.span_of_bar(metre_map.bar_of_tick(tick))
        self.session.select(Selection(span=(max(start, 0), end)))

    # Mouse

    def _held_at(self, place: QPointF) -> str:
        """Return the name of the part of the ruler that a press at a position grabs, such as ``playhead`` or
        ``loop_start``.
        """
        if place.x() < GUTTER_PX:
            return ""
        if self._mark_at(place) is not None:
            return "mark"
        if place.y() < MARKS_PX:
            return "seek"
        on_head = place.y() >= self.height() - HEAD_HEIGHT_PX
        if on_head and abs(place.x() - self._x(self.session.playhead_s)) <= GRIP_PX:
            return "playhead"
        loop, punch = ("loop", self.session.loop_s), ("punch", self._punch_s())
        # If both ranges have an edge here, the one whose bar is pressed.
        for kind, span in (punch, loop) if place.y() > MARKS_PX + LOOP_PX else (loop, punch):
            for name, seconds in zip((f"{kind}_start", f"{kind}_end"), span or (), strict=span is not None):
                if abs(place.x() - self._x(seconds)) <= GRIP_PX:
                    return name
        return "seek"

    def _take_hold(self, held: str, mouse: LaneMouse, mark: RulerMark | None) -> MouseGesture | None:
        """Return the gesture that a press at the part ``held`` of the ruler starts, such as moving a mark or the
        loop."""
        session, far, at_start = self.session, along(QApplication.startDragDistance() / 2), held.endswith("_start")
        if mark is not None:
            stays = partial(session.notice, Message("tempo.first_stays"), Severity.WARNING)
            return HoldMark(session, mouse, far, (mark.kind, mark.tick), self, stays)
        if held == "span":
            return SelectSpan(session, mouse, far, self._tick_at)
        if held in ("loop_start", "loop_end"):
            return HoldEdge(mouse, far, at_start, lambda: session.loop_s, session.set_loop, self._place_of)
        if held in ("punch_start", "punch_end"):
            recording = session.recording
            return HoldEdge(
                mouse,
                far,
                at_start,
                lambda: recording.punch_ticks,
                lambda span: recording.set(punch_ticks=span),
                lambda tick: max(tick, 0),
            )
        return Scrub(session, mouse, far, self._scrub, session.playhead_s) if held else None

    def _scrub(self, seconds: float) -> None:
        low, high = self.axis.limits_s
        self.sought.emit(min(max(seconds, low), high))

    def _drag(self, gesture: MouseGesture, mouse: LaneMouse) -> None:
        gesture.drag(mouse)
        if isinstance(gesture, HoldMark) and gesture.began:
            self._chosen = gesture.chosen
        elif isinstance(gesture, Scrub | SelectSpan) and gesture.began:
            self.axis.reveal(mouse.time_s)

    def _cancel(self) -> None:
        gesture, self._gesture = self._gesture, None
        if gesture is not None:
            gesture.cancel()
        if isinstance(gesture, HoldMark):
            self._chosen = gesture.chosen
        self.redraw()

    # Qt overrides

    def draw(self, painter: QPainter, room: QRectF) -> None:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(self.font())
        painter.setClipRect(room.adjusted(GUTTER_PX, 0.0, 0.0, 0.0))
        self._paint_bands(painter)
        self._paint_scale(painter)
        self._paint_marks(painter)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        tokens, bottom, x = self.session.tokens, float(self.height()), self._x(self.session.playhead_s)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setClipRect(QRectF(GUTTER_PX, 0, self.width() - GUTTER_PX, self.height()))
        self._paint_take(painter)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.accent))
        shoulder = bottom - HEAD_HEIGHT_PX
        painter.drawPolygon(
            QPolygonF([QPointF(x - HEAD_PX, shoulder), QPointF(x + HEAD_PX, shoulder), QPointF(x, bottom)])
        )
        painter.setClipping(False)
        painter.setPen(QPen(QColor(tokens.line_strong), 1.0))
        painter.drawLine(QPointF(0, bottom - 0.5), QPointF(self.width(), bottom - 0.5))

    def resizeEvent(self, event: QResizeEvent) -> None:
        self.unit_button.setGeometry(2, self.height() - 28, GUTTER_PX - 6, 26)
        super().resizeEvent(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.MiddleButton:
            self._panned_px = event.position().x()
        elif event.button() == Qt.MouseButton.LeftButton:
            held, mark = self._held_at(event.position()), self._mark_at(event.position())
            if held == "seek" and event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
                held = "span"
            self._chosen = (mark.kind, mark.tick) if mark is not None else None
            self._gesture = self._take_hold(held, self._mouse(event), mark)
            if held == "seek":
                self.sought.emit(self.axis.seconds(event.position().x() - GUTTER_PX))
            self.redraw()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._panned_px is not None:
            self.axis.pan_px(event.position().x() - self._panned_px)
            self._panned_px = event.position().x()
        elif self._gesture is not None:
            self._drag(self._gesture, self._mouse(event))
        elif not event.buttons():
            held = self._held_at(event.position())
            edges = ("loop_start", "loop_end", "punch_start", "punch_end")
            shapes = dict.fromkeys(edges, Qt.CursorShape.SizeHorCursor)
            shapes |= {"playhead": Qt.CursorShape.SplitHCursor, "mark": Qt.CursorShape.PointingHandCursor}
            self.setCursor(shapes.get(held, Qt.CursorShape.ArrowCursor))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.MiddleButton:
            self._panned_px = None
        elif event.button() == Qt.MouseButton.LeftButton and self._gesture is not None:
            gesture, self._gesture = self._gesture, None
            gesture.release(self._mouse(event))
            self.redraw()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton or event.position().x() < GUTTER_PX:
            return
        mark = self._mark_at(event.position())
        if mark is not None:
            self.edit_mark(mark.kind, mark.tick)
        else:
            self.axis.fit()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        if event.pos().x() >= GUTTER_PX:
            menu = self.context_menu(QPointF(event.pos()))
            menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
            menu.popup(event.globalPos())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self._gesture is not None:
            self._cancel()
        elif event.key() == Qt.Key.Key_Escape and self._chosen is not None:
            self._chosen = None
            self.redraw()
        elif event.key() in _REMOVING and self._chosen is not None:
            self._remove(*self._chosen)
        elif event.key() in _EDITING and self._chosen is not None:
            self.edit_mark(*self._chosen)
        else:
            super().keyPressEvent(event)

    def event(self, event: QEvent) -> bool:
        """Handle keys that move or delete the selected mark before they are treated as the window's shortcuts."""
        if event.type() == QEvent.Type.ShortcutOverride and self._chosen is not None:
            assert isinstance(event, QKeyEvent)
            if event.key() in (*_REMOVING, *_EDITING, Qt.Key.Key_Escape):
                event.accept()
                return True
        return super().event(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        if event.reason() != Qt.FocusReason.PopupFocusReason and self._gesture is None:
            self._chosen = None
            self.redraw()
        super().focusOutEvent(event)


_REMOVING = (Qt.Key.Key_Delete, Qt.Key.Key_Backspace)
_EDITING = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_F2)
_MIDDLE = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
