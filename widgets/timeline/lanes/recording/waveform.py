"""The recording lane: waveform and position relative to the score."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt, QTimer
from PySide6.QtGui import QColor, QFontMetricsF, QKeyEvent, QPainter, QPen
from PySide6.QtWidgets import QMenu, QWidget

from app.arrays import FloatArray
from app.audio.waveform_peaks import Peaks
from app.editor.session import Session, Severity
from app.errors import Message
from app.project.edit.piece import set_offset
from app.project.model import Project
from app.project.undoable_document import Change
from widgets.common.actions import actions
from widgets.common.clicks import on_click
from widgets.common.menus import add_actions
from widgets.common.numbers import number_text
from widgets.timeline.lane import Lane, LaneItem, LaneMouse
from widgets.timeline.lanes.number_field import NumberField
from widgets.timeline.lanes.recording.beat_anchors import Anchors, paint_doubts
from widgets.timeline.plot.drawing import draw_lines, draw_text, shade, small_font
from widgets.timeline.zoom_and_scroll import TimeAxis

DRAG_PX = 3.0
FINE = 0.1
"""Factor with Shift from the mouse's way to the offset's."""
EMPTY_PX, LEAST_PX, PREFERRED_PX = 26, 32, 48
DECIMALS = 3


@dataclass
class _Drag:
    at: LaneMouse
    project: Project
    offset_s: float
    token: object
    moved: bool = False


class _Waveform(LaneItem["WaveformLane"]):
    """Draws the waveform and the offset, or advice if there is no recording."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane, tokens = self.lane, self.lane.session.tokens
        audio, peaks = lane.session.project.audio, lane.session.listening.waveform
        painter.setFont(small_font(lane.font()))
        if audio is None:
            painter.setPen(QColor(tokens.text_dim))
            draw_text(painter, lane.plot_rect, lane.empty_text(), Qt.AlignmentFlag.AlignCenter)
            return
        middle = lane.plot_rect.height() / 2
        painter.setPen(QPen(QColor(tokens.line_strong), 1.0))
        painter.drawLine(QPointF(exposed.left(), middle), QPointF(exposed.right(), middle))
        paint_doubts(lane, painter, exposed)
        if peaks is not None:
            self._paint_peaks(painter, exposed, peaks, audio.offset_s)
        lane.anchors.paint(painter, exposed)
        text = lane.offset_text()
        box = lane.text_box()
        painter.fillRect(box.adjusted(-4.0, 0.0, 4.0, 0.0), shade(tokens.sunken, 215))
        painter.setPen(QColor(tokens.text if peaks is not None else tokens.text_dim))
        draw_text(painter, box.adjusted(0.0, 0.0, 4.0, 0.0), text)

    def _paint_peaks(self, painter: QPainter, exposed: QRectF, peaks: Peaks, offset_s: float) -> None:
        lane, tokens = self.lane, self.lane.session.tokens
        left, right = int(exposed.left()), int(np.ceil(exposed.right()))
        low, high = peaks.levels(lane.axis.seconds(left) - offset_s, lane.axis.seconds(right) - offset_s, right - left)
        half = lane.plot_rect.height() / 2 - 2.0
        x: FloatArray = np.arange(left, right, dtype=np.float64) + 0.5
        inside = (x >= lane.axis.x_px(offset_s)) & (x <= lane.axis.x_px(offset_s + peaks.duration_s))
        x, low, high = x[inside], low[inside], high[inside]
        top: FloatArray = half + 2.0 - high.astype(np.float64) * half
        bottom: FloatArray = np.maximum(half + 2.0 - low.astype(np.float64) * half, top + 1.0)
        colour = tokens.accent if lane.dragging_offset else tokens.text_dim
        draw_lines(painter, x, top, x, bottom, QPen(shade(colour, 200), 1.0))


class WaveformLane(Lane):
    """The recording. A drag moves it against the score; a double click opens a field for the offset. Bar lines and
    beats have handles at the lower edge; a dragged handle is pinned.
    """

    id = "audio"
    preferred_height_px, least_height_px = EMPTY_PX, EMPTY_PX
    hides_empty = True

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self._drag: _Drag | None = None
        self.anchors = Anchors(self)
        self.waveform = _Waveform(self)
        self.editor = NumberField(self)
        session.listening.waveform_changed.connect(self.update_items)
        self._ask_room()
        self.texted(self.title, text="waveform_lane.recording", tip="waveform_lane.drag_to_move_it_against")
        self.retranslate()

    def _ask_room(self) -> None:
        """Request a small height while there is no recording."""
        empty = self.session.project.audio is None
        self.ask_height(EMPTY_PX if empty else PREFERRED_PX, EMPTY_PX if empty else LEAST_PX)

    @property
    def is_empty(self) -> bool:
        return self.session.project.audio is None

    def retranslate(self) -> None:
        self.update_items()

    def empty_text(self) -> str:
        """Return the advice for a lane without a recording."""
        return self.tr("waveform_lane.empty")

    def offset_text(self) -> str:
        """Return the offset and its origin as text."""
        audio = self.session.project.audio
        if audio is None:
            return ""
        number = number_text(audio.offset_s, DECIMALS)
        if self.session.listening.waveform is None:
            return self.tr("waveform_lane.loading").format(offset=number)
        if audio.confidence is None:
            return self.tr("waveform_lane.offset_s").format(offset=number)
        return self.tr("waveform_lane.offset_s_estimated").format(offset=number, confidence=audio.confidence)

    def text_box(self) -> QRectF:
        """Rectangle in pixels in which the recording's offset is written."""
        metrics = QFontMetricsF(small_font(self.font()))
        return QRectF(8.0, 2.0, metrics.horizontalAdvance(self.offset_text()) + 2.0, metrics.height())

    @property
    def dragging_offset(self) -> bool:
        """True while the recording is being moved."""
        return self._drag is not None and self._drag.moved

    def project_changed(self, change: Change) -> None:
        if change.opened or change.before.audio is not change.after.audio:
            self.editor.close_field()
            self._ask_room()
            self.update_items()
        if change.opened:
            self.anchors.choose(None)

    # Mouse

    def press(self, mouse: LaneMouse) -> None:
        audio = self.session.project.audio
        self._drag = None
        if audio is not None and not self.anchors.press(mouse):
            self._drag = _Drag(mouse, self.session.project, audio.offset_s, object())

    def drag(self, mouse: LaneMouse) -> None:
        if self.anchors.drag(mouse):
            return
        drag = self._drag
        if drag is None or (not drag.moved and abs(mouse.x_px - drag.at.x_px) < DRAG_PX):
            return
        drag.moved = True
        self.plot.setCursor(Qt.CursorShape.ClosedHandCursor)
        by_s = (mouse.time_s - drag.at.time_s) * (FINE if mouse.shift else 1.0)
        offset_s = round(drag.offset_s + by_s, DECIMALS)
        before = round(drag.offset_s, DECIMALS)
        self.session.attempt(
            Message("edit.set_offset"),
            lambda _: drag.project if offset_s == before else set_offset(drag.project, offset_s),
            drag.token,
            self,
        )

    def release(self, mouse: LaneMouse) -> None:
        self.anchors.release(mouse)
        drag, self._drag = self._drag, None
        self.hover(mouse)
        if drag is not None and drag.moved:
            self.session.document.end_gesture()
            self.update_items()

    def cancel(self) -> None:
        self.anchors.cancel()
        drag, self._drag = self._drag, None
        if drag is not None and drag.moved:
            self.session.apply(Message("edit.set_offset"), drag.project, drag.token, self)
            self.session.document.end_gesture()
        self.update_items()

    def double_click(self, mouse: LaneMouse) -> None:
        audio = self.session.project.audio
        self._drag = None
        if audio is None:
            choose = actions(self.session).get("file.add_audio")
            if choose is None:
                self.session.notice(Message("audio.none_here"), Severity.WARNING)
            else:
                # Deferred, since the dialog would keep the press from ending.
                QTimer.singleShot(0, choose.trigger)
        elif not self.anchors.double_click(mouse):
            self._type_offset()

    def _type_offset(self) -> None:
        audio = self.session.project.audio
        if audio is None:
            return
        self.editor.open(
            self.text_box(), audio.offset_s, DECIMALS, self._typed, self.tr("waveform_lane.offset_in_seconds"), "s"
        )

    def hover(self, mouse: LaneMouse | None) -> None:
        if mouse is None or self.session.project.audio is None:
            self.plot.unsetCursor()
            self.plot.setToolTip("")
            return
        over = self.anchors.at(mouse) is not None
        self.plot.setCursor(Qt.CursorShape.SizeHorCursor if over else Qt.CursorShape.OpenHandCursor)
        self.plot.setToolTip(self.anchors.tip(mouse))

    def claims(self, event: QKeyEvent) -> bool:
        return self.anchors.claims(event)

    def key(self, event: QKeyEvent) -> bool:
        """Handle a key press for the selected pinned beat (see `Anchors.key`); return whether it was handled."""
        return self.anchors.key(event)

    def context_menu(self, mouse: LaneMouse) -> QMenu | None:
        menu = QMenu(self)
        if self.session.project.audio is not None:
            self.anchors.fill_menu(menu, mouse)
            on_click(menu.addAction(self.tr("waveform_lane.type_offset")), self._type_offset)
        add_actions(
            menu,
            self.session,
            ("file.add_audio", "play.estimate_offset", "play.follow_recording", "play.remove_recording"),
        )
        return menu

    def _typed(self, offset_s: float) -> None:
        audio = self.session.project.audio
        if audio is not None and round(offset_s, DECIMALS) != round(audio.offset_s, DECIMALS):
            self.session.attempt(Message("edit.set_offset"), lambda project: set_offset(project, offset_s))
