"""Handles of bar lines and beats in the recording lane, and marks of uncertain bars."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QMenu

from app.errors import Message
from app.project.edit.pins import pin_beat, recording_second, remove_pins
from app.project.model import Project
from widgets.common.clicks import on_click
from widgets.common.numbers import number_text
from widgets.timeline.lane import Lane, LaneMouse
from widgets.timeline.model.ruler.beat_pins import (
    HANDLE_PX,
    Anchor,
    DragAnchor,
    anchor_at,
    anchor_beside,
    anchors,
    doubt_at,
)
from widgets.timeline.plot.drawing import shade

_DECIMALS = 3
_STEP_S, _FINE_STEP_S = 0.01, 0.001
"""Seconds by which an arrow key moves the selected beat, without and with Shift."""
_HALF_PX = {True: 5.0, False: 3.5}
"""Half the width of a handle: of a bar line, of a beat."""
_CLAIMED = frozenset(
    {
        Qt.Key.Key_Delete, Qt.Key.Key_Backspace, Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Escape,
        Qt.Key.Key_Left, Qt.Key.Key_Right,
    }
)  # fmt: skip


def paint_doubts(lane: Lane, painter: QPainter, exposed: QRectF) -> None:
    """Shade bars whose alignment with the recording is uncertain, and differently bars that the recording lacks."""
    audio, clock = lane.session.project.audio, lane.session.project.score.tempo_map
    if audio is None or not audio.doubts:
        return
    tokens, height = lane.session.tokens, lane.plot_rect.height()
    starts = lane.axis.x_px(clock.seconds(np.array([doubt.start_tick for doubt in audio.doubts], np.float64)))
    ends = lane.axis.x_px(clock.seconds(np.array([doubt.end_tick for doubt in audio.doubts], np.float64)))
    for doubt, left, right in zip(audio.doubts, starts.tolist(), ends.tolist(), strict=True):
        box = QRectF(left, 0.0, right - left, height) & exposed
        if box.isEmpty():
            continue
        if doubt.confidence > 0.0:
            painter.fillRect(box, shade(tokens.warning, round(40 + 70 * (1.0 - doubt.confidence))))
        else:
            painter.fillRect(box, shade(tokens.line_strong, 90))
            painter.save()
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(shade(tokens.text_dim, 110))
            brush = painter.brush()
            brush.setStyle(Qt.BrushStyle.BDiagPattern)
            painter.setBrush(brush)
            painter.drawRect(box)
            painter.restore()


class Anchors:
    """Handles of bar lines and beats in the recording's lane, which are dragged or moved by keys.

    Attributes
    ----------
    chosen : int or None
        Tick of the beat that keys move.
    """

    def __init__(self, lane: Lane) -> None:
        self._lane = lane
        self._drag: DragAnchor | None = None
        self.chosen: int | None = None

    def visible(self) -> list[Anchor]:
        """Visible anchors from left to right."""
        lane = self._lane
        if lane.session.listening.waveform is None:
            return []
        return anchors(lane.session.project, lane.axis, lane.lines())

    def at(self, mouse: LaneMouse) -> Anchor | None:
        """Return the handle of a beat under the mouse; None if there is none."""
        return anchor_at(self.visible(), mouse, self._lane.plot_rect.height())

    def paint(self, painter: QPainter, exposed: QRectF) -> None:
        """Draw triangles at the lower edge; pinned ones are filled with a line through the waveform."""
        lane, tokens = self._lane, self._lane.session.tokens
        bottom = lane.plot_rect.height()
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for anchor in self.visible():
            if not exposed.left() - 8.0 <= anchor.x_px <= exposed.right() + 8.0:
                continue
            half, x = _HALF_PX[anchor.is_bar], anchor.x_px
            chosen = anchor.tick == self.chosen
            colour = tokens.accent if chosen else tokens.by_hand if anchor.pin is not None else tokens.text
            triangle = QPolygonF(
                [
                    QPointF(x, bottom - 2.0 * half - 1.0),
                    QPointF(x - half, bottom - 1.0),
                    QPointF(x + half, bottom - 1.0),
                ]
            )
            if anchor.pin is not None:
                painter.setPen(QPen(shade(tokens.by_hand, 220), 1.4))
                painter.drawLine(QPointF(x, 0.0), QPointF(x, bottom))
                self._paint_away(painter, anchor, x, bottom)
            painter.setPen(QPen(QColor(colour), 1.6 if chosen else 1.2))
            painter.setBrush(QColor(colour) if anchor.pin is not None else QColor(tokens.sunken))
            painter.drawPolygon(triangle)
        painter.restore()

    def _paint_away(self, painter: QPainter, anchor: Anchor, x: float, bottom: float) -> None:
        """Draw a dashed line from the handle of a pinned beat to the time of its pin, if these differ because tempo or
        offset have changed.
        """
        audio = self._lane.session.project.audio
        if audio is None or anchor.pin is None:
            return
        there = self._lane.axis.x_px(audio.offset_s + anchor.pin.recording_s)
        if abs(there - x) > 1.0:
            painter.setPen(QPen(shade(self._lane.session.tokens.by_hand, 160), 1.2, Qt.PenStyle.DashLine))
            painter.drawLine(QPointF(x, bottom - HANDLE_PX), QPointF(there, 0.0))

    def tip(self, mouse: LaneMouse) -> str:
        """Return a description: use of the handle, and confidence of the bar."""
        lane = self._lane
        project, lines = lane.session.project, list[str]()
        anchor = self.at(mouse)
        if anchor is not None and anchor.pin is not None:
            place = number_text(anchor.pin.recording_s, _DECIMALS)
            lines.append(lane.tr("waveform_lane.pinned_at").format(seconds=place))
        elif anchor is not None:
            lines.append(lane.tr("waveform_lane.drag_to_where_it_sounds"))
        doubt = doubt_at(project, mouse.tick)
        if doubt is not None:
            bar = project.metre_map.bar_of_tick(doubt.start_tick)
            text = "waveform_lane.bar_doubtful" if doubt.confidence > 0.0 else "waveform_lane.bar_not_recorded"
            lines.append(lane.tr(text).format(bar=bar, percent=round(100 * doubt.confidence)))
        return "\n".join(lines)

    # Mouse

    def press(self, mouse: LaneMouse) -> bool:
        """Select the handle under the mouse, and return whether there is one."""
        anchor = self.at(mouse)
        self.choose(None if anchor is None else anchor.tick)
        if anchor is None:
            return False
        self._drag = DragAnchor(self._lane.session, self._lane, mouse, self._lane.session.project, anchor.tick)
        return True

    def drag(self, mouse: LaneMouse) -> bool:
        """Drag a handle; return False if none is grabbed."""
        if self._drag is None:
            return False
        self._drag.drag(mouse)
        return True

    def release(self, mouse: LaneMouse) -> None:
        drag, self._drag = self._drag, None
        if drag is not None:
            drag.release(mouse)

    def cancel(self) -> None:
        drag, self._drag = self._drag, None
        if drag is not None:
            drag.cancel()

    def double_click(self, mouse: LaneMouse) -> bool:
        """Pin or unpin the beat under the mouse, and return whether there is one."""
        self._drag = None
        anchor = self.at(mouse)
        if anchor is not None:
            self._toggle(anchor.tick)
        return anchor is not None

    def choose(self, tick: int | None) -> None:
        """Set the beat that keys move, or none."""
        if tick != self.chosen:
            self.chosen = tick
            self._lane.update_items()

    def fill_menu(self, menu: QMenu, mouse: LaneMouse) -> None:
        """Fill a menu with commands that pin or unpin the selected beat or the one under the mouse, or unpin all."""
        lane, audio = self._lane, self._lane.session.project.audio
        pins = {pin.tick for pin in audio.pins} if audio is not None else set[int]()
        anchor = self.at(mouse)
        tick = self.chosen if anchor is None else anchor.tick
        if tick is not None:
            name = "waveform_lane.remove_pin" if tick in pins else "waveform_lane.pin_here"
            on_click(menu.addAction(lane.tr(name)), lambda: self._toggle(tick))
        if pins:
            on_click(
                menu.addAction(lane.tr("waveform_lane.remove_all_pins")),
                lambda: lane.session.attempt(Message("edit.remove_pins"), remove_pins),
            )
        if not menu.isEmpty():
            menu.addSeparator()

    # Keys

    def claims(self, event: QKeyEvent) -> bool:
        """Return whether a key is handled here instead of being a shortcut: keys that move the chosen beat, or Alt with
        Left or Right.
        """
        alt = bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
        if self._lane.session.project.audio is None:
            return False
        if alt:
            return event.key() in (Qt.Key.Key_Left, Qt.Key.Key_Right)
        return self.chosen is not None and event.key() in _CLAIMED

    def key(self, event: QKeyEvent) -> bool:
        """Handle keys: Alt and an arrow select the next bar line or pin; arrows move the selected beat (with Shift
        finely), Enter pins it, Delete unpins it, Escape deselects.
        """
        if not self.claims(event):
            return False
        session, key = self._lane.session, event.key()
        if event.modifiers() & Qt.KeyboardModifier.AltModifier:
            self._go_on(1 if key == Qt.Key.Key_Right else -1)
            return True
        tick, audio = self.chosen, session.project.audio
        if tick is None or audio is None:
            return False
        pinned = any(pin.tick == tick for pin in audio.pins)
        if key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            step_s = _FINE_STEP_S if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else _STEP_S
            self._move(tick, step_s if key == Qt.Key.Key_Right else -step_s)
        elif key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            if pinned:
                self._toggle(tick)
        elif key == Qt.Key.Key_Escape:
            self.choose(None)
        elif not pinned:
            self._toggle(tick)
        return True

    def _go_on(self, step: int) -> None:
        project = self._lane.session.project
        clock = project.score.tempo_map
        here = self.chosen if self.chosen is not None else round(clock.ticks(self._lane.session.playhead_s))
        tick = anchor_beside(project, max(here, 0), step)
        self.choose(tick)
        self._lane.axis.reveal(clock.seconds(float(tick)))

    def _move(self, tick: int, by_s: float) -> None:
        def edit(project: Project) -> Project:
            return pin_beat(project, tick, round(recording_second(project, tick) + by_s, 4))

        self._lane.session.attempt(Message("edit.pin_beat"), edit, ("beat", tick), self._lane)

    def _toggle(self, tick: int) -> None:
        audio = self._lane.session.project.audio
        if audio is not None and any(pin.tick == tick for pin in audio.pins):
            self._lane.session.attempt(Message("edit.remove_pin"), lambda project: remove_pins(project, {tick}))
        else:
            self._lane.session.attempt(Message("edit.pin_beat"), lambda project: pin_beat(project, tick))
