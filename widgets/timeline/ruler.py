"""The ruler: bars, seconds or frames, tempo and metre marks, the loop, the selected span, and what is recorded."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QAction,
    QActionGroup,
    QColor,
    QContextMenuEvent,
    QFocusEvent,
    QFont,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QApplication, QMenu, QToolButton, QWidget

from app.errors import Message
from app.project.edit import tempo as tempo_edit
from app.project.model import Project
from widgets.common.icons import icon
from widgets.common.selection import Selection
from widgets.common.session import Session, Severity, TimeDisplay
from widgets.common.tokens import LEAST_TEXT_PT
from widgets.timeline.axis import TimeAxis
from widgets.timeline.drawing import draw_lines
from widgets.timeline.lane import GUTTER_PX
from widgets.timeline.model.lines import Lines
from widgets.timeline.model.view import Floats
from widgets.timeline.pictured import Pictured
from widgets.timeline.ruler_labels import Labels, Mark, MarkEditor, bar_labels, clock_labels, frame_labels, lay_marks

MARKS_PX = 22
SCALE_PX = 24
LOOP_PX, PUNCH_PX = 4.0, 4.0
HEAD_PX = 6.0
HEAD_HEIGHT_PX = 9.0
GRIP_PX = 5.0
"""So near to an edge of the loop, or to the playhead, a press takes hold of it."""


class Ruler(Pictured):
    """The ruler over the lanes.

    Signals
    -------
    sought(float)
        The playhead is wanted at this time (seconds).
    """

    sought = Signal(float)

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("ruler")
        self.session = session
        self.axis = axis
        self._marks: list[Mark] = []
        self._held: str = ""
        self._pressed: QMouseEvent | None = None
        self._dragged = False
        self._mark: Mark | None = None
        self._chosen: tuple[str, int] | None = None
        """The mark that was clicked: Delete removes it."""
        self._base: Project = session.project
        self._token: object = object()
        self._panned_px: float | None = None
        self._span = session.selection.span
        self._before: tuple[Selection, tuple[float, float] | None] = (session.selection, session.loop_s)
        self._punch_before = session.recording.punch_ticks
        self._recorded: tuple[object, ...] = ()
        self._editing: tuple[str, int] | None = None
        self.setMouseTracking(True)
        self.setFixedHeight(MARKS_PX + SCALE_PX)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)

        self.unit_button = QToolButton(self)
        self.unit_button.setObjectName("time_display")
        self.unit_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.unit_button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.unit_button.setAutoRaise(True)
        self._units: dict[TimeDisplay, QAction] = {}
        menu = QMenu(self.unit_button)
        group = QActionGroup(menu)
        displays: tuple[TimeDisplay, ...] = ("bars", "seconds", "frames")
        for display in displays:
            action = menu.addAction("")
            action.setCheckable(True)
            action.setData(display)
            group.addAction(action)
            self._units[display] = action
        group.triggered.connect(self._choose_unit)
        self.unit_button.setMenu(menu)
        self._editor = MarkEditor(self)
        self._editor.setObjectName("mark_editor")
        self._editor.hide()
        self._editor.left.connect(self._leave_editor)
        self._editor.editingFinished.connect(self._editing_finished)

        axis.changed.connect(self._axis_changed)
        session.changed.connect(self.redraw)
        session.performance_changed.connect(self.redraw)
        session.players_changed.connect(self.redraw)
        session.theme_changed.connect(self._theme_set)
        session.selection_changed.connect(self._selection_set)
        session.loop_changed.connect(self.redraw)
        session.time_display_changed.connect(self._unit_set)
        session.recording.changed.connect(self._recording_set)
        session.playhead_changed.connect(self._playhead_set)
        self._head_x = 0.0
        font = QFont(self.font())
        if 0 < font.pointSizeF() < LEAST_TEXT_PT:
            font.setPointSizeF(LEAST_TEXT_PT)
            self.setFont(font)
        self.retranslate()
        self._theme_set()

    def retranslate(self) -> None:
        """Set every text anew."""
        texts: dict[TimeDisplay, str] = {
            "bars": self.tr("Bars"),
            "seconds": self.tr("Seconds"),
            "frames": self.tr("Frames"),
        }
        for display, action in self._units.items():
            action.setText(texts[display])
        self.unit_button.setToolTip(self.tr("What the ruler counts"))
        self._unit_set()
        self.redraw()

    # Places

    def _x(self, seconds: float) -> float:
        return GUTTER_PX + self.axis.x_px(seconds)

    def _tick_at(self, x: float, free: bool) -> int:
        tick = self.session.project.score.tempo_map.ticks(self.axis.seconds(x - GUTTER_PX))
        return max(round(tick) if free else self.session.grid.snap(self.session.project.score, tick), 0)

    def _seconds_of(self, tick: int) -> float:
        return self.session.project.score.tempo_map.seconds(float(tick))

    def _mark_at(self, place: QPointF) -> Mark | None:
        return next((mark for mark in reversed(self._marks) if mark.rect.contains(place)), None)

    # Drawing

    def _paint_marks(self, painter: QPainter) -> None:
        tokens = self.session.tokens
        score = self.session.project.score
        metrics = QFontMetricsF(self.font())
        self._marks = lay_marks(score, self.axis, metrics, GUTTER_PX, float(self.width()), MARKS_PX)
        for mark in self._marks:
            held = (mark.kind, mark.tick) == self._chosen
            x = self._x(self._seconds_of(mark.tick))
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.accent if held else tokens.raised))
            painter.drawRoundedRect(mark.rect, 3.0, 3.0)
            # What began before the left edge is said more quietly.
            quiet = tokens.text_dim if x < GUTTER_PX else tokens.text
            painter.setPen(QColor(tokens.accent_text if held else quiet))
            painter.drawText(mark.rect, int(Qt.AlignmentFlag.AlignCenter), mark.text)
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

    def _upright(self, painter: QPainter, seconds: Floats, top: float, pen: QPen) -> None:
        """Lines down to the lower edge."""
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
            self._band(painter, self._seconds_of(span[0]), self._seconds_of(span[1]), tokens.accent, 0.0)
        if self.session.loop_s is not None:
            self._band(painter, *self.session.loop_s, tokens.good, LOOP_PX)
        punch = self._punch_s()
        if punch is not None:
            self._band(painter, *punch, tokens.error, PUNCH_PX, LOOP_PX + 1.0)

    def _punch_s(self) -> tuple[float, float] | None:
        """The range that the part takes from a take; None: all of it."""
        recording = self.session.recording
        if not recording.punch or recording.punch_ticks is None:
            return None
        return self._seconds_of(recording.punch_ticks[0]), self._seconds_of(recording.punch_ticks[1])

    def _paint_take(self, painter: QPainter) -> None:
        """What is recorded already of the running take, or of its pass."""
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

    # Answers to the session

    def _axis_changed(self) -> None:
        self._leave_editor(False)
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

    def _unit_set(self) -> None:
        display = self.session.time_display
        self._units[display].setChecked(True)
        self.unit_button.setText(self._units[display].text())
        self.redraw()

    def _choose_unit(self, action: QAction) -> None:
        self.session.set_time_display(action.data())

    def _theme_set(self) -> None:
        self.unit_button.setIcon(icon("clock", self.session.tokens))
        self.redraw()

    # Editing tempo and metre

    def edit_mark(self, kind: str, tick: int) -> None:
        """Type the tempo or the metre at a tick; where there is none, add one."""
        score = self.session.project.score
        x = self._x(self._seconds_of(tick))
        mark = next((mark for mark in self._marks if (mark.kind, mark.tick) == (kind, tick)), None)
        if kind == "tempo":
            bpm = next(bpm for at, bpm in reversed(score.tempo_map.bpm) if at <= tick)
            text = f"{bpm:.6g}"
        else:
            metre = score.metre_map.metre_at(tick)
            text = f"{metre.numerator}/{metre.denominator}"
        self._editing = (kind, tick)
        self._editor.setText(text)
        self._editor.setToolTip(
            self.tr("Tempo in quarters per minute; Enter takes it, Escape leaves it")
            if kind == "tempo"
            else self.tr("Metre, e.g. 6/8; Enter takes it, Escape leaves it")
        )
        left = mark.rect.left() if mark is not None else x
        self._editor.setGeometry(int(min(left, self.width() - 84)), 0, 80, MARKS_PX + 2)
        self._editor.show()
        self._editor.raise_()
        self._editor.selectAll()
        self._editor.setFocus(Qt.FocusReason.OtherFocusReason)

    def _editing_finished(self) -> None:
        """The focus went elsewhere: what was typed is meant."""
        if self._editor.isVisible() and not self._editor.hasFocus():
            self._leave_editor(True)

    def _leave_editor(self, meant: bool) -> None:
        if self._editing is None:
            return
        (kind, tick), self._editing = self._editing, None
        text = self._editor.text().strip()
        self._editor.hide()
        self.setFocus(Qt.FocusReason.OtherFocusReason)
        if meant:
            self._type(kind, tick, text)

    def _type(self, kind: str, tick: int, text: str) -> None:
        if kind == "tempo":
            try:
                bpm = float(text.replace(",", "."))
            except ValueError:
                bpm = 0.0
            self.session.attempt(
                Message("edit.set_tempo"), lambda project: tempo_edit.set_tempo(project, tick, bpm), origin=self
            )
            return
        above, _, below = text.partition("/")
        numbers = (int(above), int(below)) if above.strip().isdecimal() and below.strip().isdecimal() else (0, 0)
        self.session.attempt(
            Message("edit.set_metre"), lambda project: tempo_edit.set_metre(project, tick, *numbers), origin=self
        )

    def context_menu(self, place: QPointF) -> QMenu:
        """The menu at a place."""
        menu = QMenu(self)
        mark = self._mark_at(place)
        if mark is not None:
            change = menu.addAction(self.tr("Change Tempo") if mark.kind == "tempo" else self.tr("Change Metre"))
            change.triggered.connect(lambda: self.edit_mark(mark.kind, mark.tick))
            remove = menu.addAction(self.tr("Remove Tempo") if mark.kind == "tempo" else self.tr("Remove Metre"))
            remove.setEnabled(mark.tick > 0)
            remove.triggered.connect(lambda: self._remove(mark.kind, mark.tick))
            menu.addSeparator()
        metre_map = self.session.project.score.metre_map
        tick = self._tick_at(place.x(), False)
        bar_tick = max(metre_map.tick_of_bar(metre_map.bar_of_tick(tick)), 0)
        menu.addAction(self.tr("Add Tempo Here")).triggered.connect(lambda: self.edit_mark("tempo", tick))
        menu.addAction(self.tr("Add Metre at This Bar")).triggered.connect(lambda: self.edit_mark("metre", bar_tick))
        felt = [action for id, action in self.session.actions.items() if id.startswith("beat.")]
        if felt:
            menu.addMenu(self.tr("Felt Beat")).addActions(felt)
        menu.addSeparator()
        menu.addAction(self.tr("Select This Bar")).triggered.connect(lambda: self._select_bar(tick))
        for id in ("play.loop", "notes.select_span", "timeline.zoom_selection", "timeline.fit"):
            action = self.session.actions.get(id)
            if action is not None:
                menu.addAction(action)
        return menu

    def _remove(self, kind: str, tick: int) -> None:
        self._chosen = None
        self.redraw()
        if kind == "tempo":
            self.session.attempt(
                Message("edit.remove_tempo"), lambda project: tempo_edit.remove_tempo(project, tick), origin=self
            )
        else:
            self.session.attempt(
                Message("edit.remove_metre"), lambda project: tempo_edit.remove_metre(project, tick), origin=self
            )

    def _select_bar(self, tick: int) -> None:
        metre_map = self.session.project.score.metre_map
        start, end = metre_map.span_of_bar(metre_map.bar_of_tick(tick))
        self.session.select(Selection(span=(max(start, 0), end)))

    # The mouse

    def _take_hold(self, place: QPointF) -> str:
        """What a press takes hold of."""
        if place.x() < GUTTER_PX:
            return ""
        self._mark = self._mark_at(place)
        if self._mark is not None:
            return "mark"
        if place.y() < MARKS_PX:
            return "seek"
        on_head = place.y() >= self.height() - HEAD_HEIGHT_PX
        if on_head and abs(place.x() - self._x(self.session.playhead_s)) <= GRIP_PX:
            return "playhead"
        loop, punch = ("loop", self.session.loop_s), ("punch", self._punch_s())
        # Where both have an edge, the one whose bar is pressed.
        for kind, span in (punch, loop) if place.y() > MARKS_PX + LOOP_PX else (loop, punch):
            for name, seconds in zip((f"{kind}_start", f"{kind}_end"), span or (), strict=span is not None):
                if abs(place.x() - self._x(seconds)) <= GRIP_PX:
                    return name
        return "seek"

    def _drag(self, event: QMouseEvent) -> None:
        assert self._pressed is not None
        free = bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
        x = event.position().x()
        tick = self._tick_at(x, free)
        if self._held == "playhead":
            self.sought.emit(self.axis.seconds(x - GUTTER_PX))
        elif self._held == "mark" and self._mark is not None:
            self._drag_mark(self._mark, x, free)
        elif self._held in ("loop_start", "loop_end") and self.session.loop_s is not None:
            start_s, end_s = self.session.loop_s
            moved_s = self._seconds_of(tick)
            loop = (moved_s, end_s) if self._held == "loop_start" else (start_s, moved_s)
            if loop[1] > loop[0]:
                self.session.set_loop(loop)
        elif self._held in ("punch_start", "punch_end") and self.session.recording.punch_ticks is not None:
            start, end = self.session.recording.punch_ticks
            punch = (tick, end) if self._held == "punch_start" else (start, tick)
            if punch[1] > punch[0]:
                self.session.recording.set(punch_ticks=punch)
        elif self._held == "seek":
            start, end = sorted((self._tick_at(self._pressed.position().x(), free), tick))
            span = (start, end) if end > start else None
            self.session.select(Selection(span=span))
            self.axis.reveal(self.axis.seconds(x - GUTTER_PX))

    def _drag_mark(self, mark: Mark, x: float, free: bool) -> None:
        """A tempo goes to the grid, a metre to the bars that there are without it; what began the piece stays."""
        base, start = self._base, mark.tick
        if start <= (base.score.pickup_ticks if mark.kind == "metre" else 0):
            self.session.notice(Message("tempo.first_stays"), Severity.WARNING)
            return
        without = tempo_edit.remove_metre(base, start) if mark.kind == "metre" else base
        # The place under the mouse is that of the piece before the drag: moved, a tempo would carry it along.
        tick = without.score.tempo_map.ticks(self.axis.seconds(x - GUTTER_PX))
        if mark.kind == "metre" and not free:
            metre_map = without.score.metre_map
            bar = metre_map.bar_of_tick(max(round(tick), 0))
            to = min(metre_map.span_of_bar(bar), key=lambda place: abs(place - tick))
        else:
            to = round(tick) if free else self.session.grid.snap(base.score, tick)
        move = tempo_edit.move_metre if mark.kind == "metre" else tempo_edit.move_tempo
        to = max(to, 1 if mark.kind == "tempo" else base.score.pickup_ticks)
        if mark.kind == "metre" and to <= base.score.pickup_ticks:
            return
        if self.session.attempt(_moving(mark), lambda _: move(base, start, to), self._token, self):
            self._chosen = (mark.kind, to)

    def _cancel(self) -> None:
        if self._held == "mark" and self._mark is not None:
            self.session.apply(_moving(self._mark), self._base, self._token, self)
            self.session.document.end_gesture()
            self._chosen = (self._mark.kind, self._mark.tick)
        elif self._held != "playhead":
            self.session.select(self._before[0])
            self.session.set_loop(self._before[1])
            self.session.recording.set(punch_ticks=self._punch_before)
        self._held, self._pressed, self._mark = "", None, None
        self.redraw()

    # Qt overrides

    def sizeHint(self) -> QSize:
        return QSize(800, MARKS_PX + SCALE_PX)

    def ground(self) -> QColor:
        return QColor(self.session.tokens.surface)

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

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.MiddleButton:
            self._panned_px = event.position().x()
        elif event.button() == Qt.MouseButton.LeftButton:
            self._held = self._take_hold(event.position())
            self._chosen = (self._mark.kind, self._mark.tick) if self._mark is not None else None
            self._pressed, self._dragged = event.clone(), False
            self._base, self._token = self.session.project, object()
            self._before = (self.session.selection, self.session.loop_s)
            self._punch_before = self.session.recording.punch_ticks
            if self._held == "seek":
                self.sought.emit(self.axis.seconds(event.position().x() - GUTTER_PX))
            self.redraw()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._panned_px is not None:
            self.axis.pan_px(event.position().x() - self._panned_px)
            self._panned_px = event.position().x()
        elif self._pressed is not None and self._held:
            far = abs(event.position().x() - self._pressed.position().x()) >= QApplication.startDragDistance() / 2
            self._dragged = self._dragged or far
            if self._dragged:
                self._drag(event)
        elif not event.buttons():
            mark = self._mark
            held = self._take_hold(event.position())
            self._mark = mark
            edges = ("loop_start", "loop_end", "punch_start", "punch_end")
            shapes = dict.fromkeys(edges, Qt.CursorShape.SizeHorCursor)
            shapes |= {"playhead": Qt.CursorShape.SplitHCursor, "mark": Qt.CursorShape.PointingHandCursor}
            self.setCursor(shapes.get(held, Qt.CursorShape.ArrowCursor))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.MiddleButton:
            self._panned_px = None
        elif event.button() == Qt.MouseButton.LeftButton and self._held:
            if self._held == "mark":
                self.session.document.end_gesture()
            elif not self._dragged and self._held in ("seek", "playhead") and self.session.selection.span is not None:
                self.session.select(Selection(self.session.selection.notes, self.session.selection.events))
            self._held, self._pressed, self._mark = "", None, None
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

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.accept()
        notches = (event.angleDelta().y() or event.angleDelta().x()) / 120.0
        zooms = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        self.axis.turn_wheel(notches, event.position().x() - GUTTER_PX, zooms)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self._held:
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
        """Keys that mean the chosen mark come here first, before the window's actions."""
        if event.type() == QEvent.Type.ShortcutOverride and self._chosen is not None:
            assert isinstance(event, QKeyEvent)
            if event.key() in (*_REMOVING, *_EDITING, Qt.Key.Key_Escape):
                event.accept()
                return True
        return super().event(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        if event.reason() != Qt.FocusReason.PopupFocusReason and not self._held:
            self._chosen = None
            self.redraw()
        super().focusOutEvent(event)


def _moving(mark: Mark) -> Message:
    return Message("edit.move_tempo") if mark.kind == "tempo" else Message("edit.move_metre")


_REMOVING = (Qt.Key.Key_Delete, Qt.Key.Key_Backspace)
_EDITING = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_F2)
_MIDDLE = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
