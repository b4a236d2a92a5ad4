"""Dialog that measures the latency of a device: clicks sound, and the user blows on each of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QDialog, QDoubleSpinBox, QPushButton, QWidget

from app.audio.click import steady_clicks
from app.audio.playback import Playback
from app.audio.track import Mix
from app.capture.latency import LATEST_S, LEAST_HITS, LatencyMeasurement, events_on_time_line, hits, measured_latency
from app.capture.protocol import Events
from app.editor.session import Session
from widgets.common.clicks import on_click
from widgets.common.controls import Button, Caption, Retranslated, named
from widgets.common.help import HelpButton
from widgets.common.layouts import STRETCH, in_column, in_row
from widgets.common.plain import Label

LEAD: Final = 4
"""Number of clicks at the beginning that are not evaluated."""
COUNTED: Final = 12
PERIOD_S: Final = 0.6
_AFTER_S: Final = 0.5
"""Seconds to wait for a hit after the last click."""
_LOOK_MS: Final = 15
_FLASH_S: Final = 0.12
_SHOWN_S: Final = (-0.1, 0.3)

CLICKS_S: Final = tuple(PERIOD_S * (1 + index) for index in range(LEAD + COUNTED))


class LatencyDialog(Retranslated, QDialog):
    """Dialog that measures the latency of a device, or in which it is typed; a button applies it. Not modal.

    Parameters
    ----------
    playback : Playback
        Playback of the clicks, on the same audio device and clock as for takes; becomes a child of the dialog.
    now_ns : callable
        Returns the time of the clock by which MIDI events are stamped, in nanoseconds.

    Signals
    -------
    latency_chosen(float)
        Latency in seconds, to be subtracted from every event's time.
    """

    latency_chosen = Signal(float)

    def __init__(
        self, session: Session, playback: Playback, now_ns: Callable[[], int], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("latency")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session, self._playback, self._now_ns = session, playback, now_ns
        playback.setParent(self)
        self._running = False
        self._events: list[tuple[int, bytes]] = []
        self._positions: list[tuple[int, float]] = []
        self._found: LatencyMeasurement | None = None
        self._stopped_why = ""
        self._explained, self._reported, self._value_name = (
            Caption("latency_dialog.blow_short_note_on_every_click_what_is"),
            Label(),
            Caption("latency_dialog.latency"),
        )
        self._reported.setObjectName("latency_status")
        self.chart = HitChart(session)
        self.value = self.texted(
            named(QDoubleSpinBox(), "latency_value"),
            name="latency_dialog.latency",
            tip="latency_dialog.compensation_tip",
        )
        self.value.setRange(-500.0, 1000.0)
        self.value.setDecimals(0)
        self.value.setSingleStep(1.0)
        self._start = QPushButton()
        self._close = Button("latency_dialog.close", self.close, "latency_close")
        self._take = Button("latency_dialog.use", self._choose, "latency_take")
        self._start.setObjectName("latency_start")
        self._timer = QTimer(self, interval=_LOOK_MS, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._look)
        self._build()
        on_click(self._start, self.toggle)
        self.value.valueChanged.connect(self._show)
        self.finished.connect(self._stop)
        session.recording.received.connect(self._on_received)
        session.recording.changed.connect(self._changed)
        session.theme_changed.connect(self._show)
        self._port = ""
        self._changed()
        self.texted(self, title="latency_dialog.latency")
        self.retranslate()
        self.resize(600, 400)

    def _build(self) -> None:
        for label in (self._explained, self._reported):
            label.setWordWrap(True)
        self._reported.setMinimumHeight(3 * self._reported.fontMetrics().lineSpacing())
        self._reported.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._start.setDefault(True)
        bottom = in_row(HelpButton(), self._start, STRETCH, self._value_name, self.value, self._take, self._close)
        in_column(self._explained, (self.chart, 1), self._reported, bottom, of=self)

    # Measuring

    @property
    def is_measuring(self) -> bool:
        """True while the clicks of a measurement sound."""
        return self._running

    def sounding_s(self) -> float:
        """Return the position in seconds of the sound that is audible now, within the clicks."""
        return self._playback.position_s()

    def toggle(self) -> None:
        """Start or stop the clicks."""
        if self._running:
            self._stop()
        else:
            self._begin()

    def _begin(self) -> None:
        session, playback = self._session, self._playback
        if session.playback is not None:
            session.playback.stop()
        self._events.clear()
        self._positions.clear()
        self._found, self._stopped_why = None, ""
        self.chart.show_measured(None)
        playback.set_volume(session.listening.volume)
        playback.set_mix(Mix([steady_clicks(CLICKS_S, LEAD)]))
        playback.set_span(0.0, float("inf"))
        playback.play(0.0)
        self._running = True
        self._timer.start()
        self._show()

    def _stop(self) -> None:
        self._running = False
        self._timer.stop()
        self._playback.stop()
        self.chart.show_click(-1, False)
        self._show()

    def _on_received(self, events: Events) -> None:
        if self._running:
            channel = self._session.recording.mapping.channel
            self._events += [
                (ns, raw)
                for ns, raw in zip(events.times_ns, events.messages, strict=True)
                if not channel or (raw[0] & 0x0F) + 1 == channel
            ]

    def _look(self) -> None:
        """Store the position of the audible sound for comparison with notes, and show the input."""
        ns, position_s = self._now_ns(), self._playback.position_s()
        # A device just opened is silent at first: the clock has not started.
        if not self._positions or position_s > self._positions[-1][1]:
            self._positions.append((ns, position_s))
        last = sum(click_s <= position_s for click_s in CLICKS_S) - 1
        self.chart.show_click(last - LEAD, last >= 0 and position_s - CLICKS_S[last] < _FLASH_S)
        found = hits(events_on_time_line(self._events, self._positions), self._session.recording.mapping.breath)
        # A click that can still be hit does not count as missed.
        over = sum(click_s + LATEST_S <= position_s for click_s in CLICKS_S)
        self.chart.show_measured(measured_latency(CLICKS_S[LEAD : max(over, LEAD)], found))
        if position_s > CLICKS_S[-1] + _AFTER_S:
            self._found = measured_latency(CLICKS_S[LEAD:], found)
            self.chart.show_measured(self._found)
            if not self._found.fault:
                self.value.setValue(round(1000.0 * self._found.latency_s))
            self._stop()
            return
        self._show()

    def _changed(self) -> None:
        recording = self._session.recording
        if self._running and (recording.connection != "open" or recording.running):
            self._stopped_why = self.tr("latency_dialog.interrupted")
            self._stop()
        if recording.port != self._port:
            self._port, self._found = recording.port, None
            self.chart.show_measured(None)
        if not self._running and self._found is None and not self.value.hasFocus():
            self.value.setValue(round(1000.0 * recording.latency_s))
        self._show()

    def _choose(self) -> None:
        self.latency_chosen.emit(self.value.value() / 1000.0)

    # Display

    def _show(self) -> None:
        recording, tokens = self._session.recording, self._session.tokens
        is_open = recording.connection == "open" and not recording.running
        self._start.setEnabled(is_open)
        self._start.setText(self.tr("latency_dialog.stop") if self._running else self.tr("latency_dialog.start"))
        is_new = round(self.value.value()) != round(1000.0 * recording.latency_s)
        self._take.setEnabled(bool(recording.port) and is_new and not self._running)
        text, colour = self._words()
        style = f"color: {getattr(tokens, colour)};"
        if (text, style) != (self._reported.text(), self._reported.styleSheet()):
            self._reported.setText(text)
            self._reported.setStyleSheet(style)

    def _words(self) -> tuple[str, str]:
        recording = self._session.recording
        if self._running:
            beat = sum(click_s <= self._playback.position_s() for click_s in CLICKS_S)
            if self._playback.is_silent:
                text = self.tr("latency_dialog.there_is_no_audio_device")
                return text, "warning"
            if beat <= LEAD:
                return self.tr("latency_dialog.instruction").format(count=LEAD), "text"
            text = self.tr("latency_dialog.blow_short_note_on_every")
            return text.format(count=beat - LEAD, all=COUNTED), "text"
        if self._stopped_why:
            return self._stopped_why, "warning"
        found = self._found
        if found is None:
            if not recording.port or recording.connection != "open":
                return self.tr("latency_dialog.no_device_is_connected_choose"), "warning"
            text = self.tr("latency_dialog.active_compensation")
            return text.format(device=recording.port, count=f"{1000 * recording.latency_s:.0f}"), "text_dim"
        used = sum(found.used)
        if found.fault == "too_few":
            text = self.tr("latency_dialog.only_of_clicks_were_hit")
            return text.format(count=used, all=COUNTED, least=LEAST_HITS), "warning"
        spread = f"{1000 * found.spread_s:.0f}"
        if found.fault == "too_uneven":
            text = self.tr("latency_dialog.hits_differ_by_ms_too")
            return text.format(spread=spread), "warning"
        text = self.tr("latency_dialog.comes_ms_late_of_hits")
        reported = text.format(
            device=recording.port, count=f"{1000 * found.latency_s:.0f}", used=used, all=COUNTED, spread=spread
        )
        if round(self.value.value()) == round(1000.0 * recording.latency_s):
            reported += " " + self.tr("latency_dialog.compensated_from_now")
        return reported, "good"

    def retranslate(self) -> None:
        self.value.setSuffix(" " + self.tr("latency_dialog.ms"))
        self._show()

    # Qt overrides

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self._running:
            self._stop()
            return
        super().keyPressEvent(event)


class HitChart(Retranslated, QWidget):
    """Chart of the delay of each played note after its click, with a light that flashes."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("latency_hits")
        self._session = session
        self.found: LatencyMeasurement | None = None
        self._click, self._flashes = -1, False
        self.texted(self, name="hit_chart.title")

    def show_click(self, number: int, flashes: bool) -> None:
        """Show the number of the last click, and whether the light is on."""
        if (number, flashes) != (self._click, self._flashes):
            self._click, self._flashes = number, flashes
            self.update()

    def show_measured(self, found: LatencyMeasurement | None) -> None:
        """Display a measurement of the MIDI latency; None clears the chart."""
        if found != self.found:
            self.found = found
            self.update()

    def retranslate(self) -> None:
        self.update()

    def sizeHint(self) -> QSize:
        return QSize(560, 180)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = self._session.tokens
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), QColor(tokens.sunken))
        light = 22.0
        painter.setPen(QPen(QColor(tokens.line_strong), 1.0))
        painter.setBrush(QColor(tokens.accent if self._flashes else tokens.sunken))
        painter.drawEllipse(QPointF(30.0, self.height() / 2), light / 2, light / 2)
        room = QRectF(self.rect()).adjusted(110.0, 10.0, -10.0, -10.0)
        self._paint_scale(painter, room)
        if self.found is not None:
            self._paint_hits(painter, room, self.found)

    def _y(self, room: QRectF, offset_s: float) -> float:
        low, high = _SHOWN_S
        share = (min(max(offset_s, low), high) - low) / (high - low)
        return room.bottom() - share * room.height()

    def _paint_scale(self, painter: QPainter, room: QRectF) -> None:
        tokens = self._session.tokens
        for ms in (-100, 0, 100, 200, 300):
            y = round(self._y(room, ms / 1000.0)) + 0.5
            painter.setPen(QPen(QColor(tokens.line_strong if ms == 0 else tokens.line), 1.0))
            painter.drawLine(QPointF(room.left(), y), QPointF(room.right(), y))
            painter.setPen(QColor(tokens.text_dim))
            label = QRectF(room.left() - 66.0, y - 9.0, 60.0, 18.0)
            text = self.tr("hit_chart.ms").format(count=str(ms).replace("-", "−"))
            painter.drawText(label, int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter), text)

    def _paint_hits(self, painter: QPainter, room: QRectF, found: LatencyMeasurement) -> None:
        tokens = self._session.tokens
        step = room.width() / COUNTED
        if any(found.used):
            y = self._y(room, found.latency_s)
            band = QColor(tokens.good)
            band.setAlpha(50)
            top = self._y(room, found.latency_s + found.spread_s)
            bottom = self._y(room, found.latency_s - found.spread_s)
            painter.fillRect(QRectF(room.left(), top, room.width(), bottom - top), band)
            painter.setPen(QPen(QColor(tokens.good), 1.5))
            painter.drawLine(QPointF(room.left(), y), QPointF(room.right(), y))
        for number, (offset_s, counts) in enumerate(zip(found.offsets_s, found.used, strict=True)):
            x = room.left() + (number + 0.5) * step
            if offset_s is None:
                # Not finished, or missed.
                painter.setPen(QColor(tokens.text_dim))
                painter.drawText(QRectF(x - 10, self._y(room, 0.0) - 10, 20, 20), _MIDDLE, "×")
                continue
            painter.setPen(QPen(QColor(tokens.good if counts else tokens.warning), 2.0))
            painter.setBrush(QColor(tokens.good) if counts else QColor(tokens.sunken))
            painter.drawEllipse(QPointF(x, self._y(room, offset_s)), 4.5, 4.5)


_MIDDLE: Final = int(Qt.AlignmentFlag.AlignCenter)
