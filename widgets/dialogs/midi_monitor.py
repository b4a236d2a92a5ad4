"""Monitor of a device's input: note, breath, bite, channel, and the last messages."""

from __future__ import annotations

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QFont
from PySide6.QtWidgets import QGridLayout, QListWidget, QProgressBar, QWidget

from app.capture.message_log import MessageLog, MessageRow
from app.capture.protocol import Events
from app.editor.session import Session
from app.editor.translated import tr
from app.score.take import curve_values, decoded, is_wired
from instrument_maps.library import all_maps
from widgets.common.controls import Retranslated, named
from widgets.common.layouts import in_column, in_row
from widgets.common.pitch import pitch_text
from widgets.common.plain import Label

SHOW_MS = 40
"""Least time between two updates of the list in milliseconds."""
_FULL = 1000


class MidiMonitor(Retranslated, QWidget):
    """Shows the input received by `session.recording`."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("midi_monitor")
        self._session = session
        self._log = MessageLog()
        self._channel = 0
        self._bite_now = 0.0
        self._note, self._from = Label(), Label()
        self._note.setObjectName("midi_note")
        self._from.setObjectName("midi_channel")
        self._from.setWordWrap(True)
        font = QFont(self.font())
        font.setPointSizeF(max(2.0 * font.pointSizeF(), 20.0))
        self._note.setFont(font)
        self._note.setMinimumWidth(96)
        self._note.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._breath, self._bite = _meter("midi_breath"), _meter("midi_bite")
        self._names = {meter: Label() for meter in (self._breath, self._bite)}
        self._list = self.texted(named(QListWidget(), "midi_messages"), name="midi_monitor.last_messages")
        self._list.setUniformItemSizes(True)
        self._list.setSelectionMode(QListWidget.SelectionMode.NoSelection)
        meters = QGridLayout()
        meters.setColumnStretch(1, 1)
        for meter, text_id in ((self._breath, "midi_monitor.breath"), (self._bite, "midi_monitor.bite")):
            self.texted(self._names[meter], text=text_id)
            self.texted(meter, name=text_id)
        for row, (meter, name) in enumerate(self._names.items()):
            meters.addWidget(name, row, 0)
            meters.addWidget(meter, row, 1, Qt.AlignmentFlag.AlignVCenter)
        meters.addWidget(self._from, 2, 0, 1, 2)
        line = in_row(self._note, (meters, 1))
        in_column(line, (self._list, 1), of=self, margins=0)
        self._soon = QTimer(self, singleShot=True, interval=SHOW_MS)
        self._soon.timeout.connect(self._show)
        recording = session.recording
        recording.received.connect(self._on_received)
        recording.played.connect(self._show_soon)
        recording.changed.connect(self._changed)
        session.pitch_display.changed.connect(self._show)
        session.theme_changed.connect(self._show)
        self._port, self._bite_source = recording.port, recording.mapping.bite
        self.retranslate()

    def _on_received(self, events: Events) -> None:
        for raw in events.messages:
            self._log.add(raw)
            self._channel = (raw[0] & 0x0F) + 1
        mapping = self._session.recording.mapping
        for raw in events.messages:
            message = decoded(raw.hex())
            if message is not None and is_wired(message, mapping):
                self._bite_now = next(
                    (value for kind, value in curve_values(message, mapping) if kind == "bite"), self._bite_now
                )
        self._show_soon()

    def _changed(self) -> None:
        recording = self._session.recording
        if recording.port != self._port or recording.connection != "open":
            self._port = recording.port
            self._log.clear()
            self._channel, self._bite_now = 0, 0.0
        if recording.mapping.bite != self._bite_source:
            # The bite value belongs to another message.
            self._bite_source, self._bite_now = recording.mapping.bite, 0.0
        self._show()

    def _show_soon(self) -> None:
        if not self._soon.isActive():
            self._soon.start()

    def _show(self) -> None:
        recording, tokens = self._session.recording, self._session.tokens
        self._note.setText("–" if recording.pitch is None else self._pitch(recording.pitch))
        _fill(self._breath, recording.breath)
        _fill(self._bite, self._bite_now)
        self._bite.setEnabled(recording.mapping.bite != "none")
        requested = recording.mapping.channel
        is_other = bool(self._channel and requested and self._channel != requested)
        if is_other:
            text = self.tr("midi_monitor.plays_on_channel_but_only")
        else:
            text = self.tr("midi_monitor.channel") if self._channel else self.tr("midi_monitor.empty")
        self._from.setText(text.format(number=self._channel, requested=requested))
        style = f"color: {tokens.warning if is_other else tokens.text_dim};"
        if style != self._from.styleSheet():
            self._from.setStyleSheet(style)
        lines = self._log.lines
        while self._list.count() > len(lines):
            self._list.takeItem(self._list.count() - 1)
        for row, line in enumerate(lines):
            text = self._text(line)
            item = self._list.item(row)
            if item is None:
                self._list.addItem(text)
            elif item.text() != text:
                item.setText(text)

    def _pitch(self, pitch: int) -> str:
        """Return the name of a pitch; written for the recorded player's instrument if pitches are shown as written."""
        recording, players = self._session.recording, self._session.project.players
        player = next((player for player in players if player.id == recording.armed), self._session.player)
        instrument = all_maps().get(player.instrument_id) if player is not None else None
        semitones = instrument.transposition_semitones if instrument is not None else 0
        return pitch_text(self._session.pitch_display, pitch, semitones)

    def _text(self, line: MessageRow) -> str:
        match line.kind:
            case "note_on":
                text = self.tr("midi_monitor.begins_velocity").format(pitch=self._pitch(line.number), value=line.value)
            case "note_off":
                text = self.tr("midi_monitor.ends").format(pitch=self._pitch(line.number))
            case "key_pressure":
                text = self.tr("midi_monitor.pressure_on").format(pitch=self._pitch(line.number), value=line.value)
            case "program":
                text = self.tr("midi_monitor.program").format(value=line.value + 1)
            case "control":
                text = f"{source_name(f'cc{line.number}')}: {line.value}"
            case kind:
                text = f"{source_name(kind)}: {line.value}"
        if line.count > 1:
            text += f"  ×{line.count}"
        return self.tr("midi_monitor.channel_2").format(text=text, number=line.channel)

    def retranslate(self) -> None:
        self._show()


def source_name(source: str) -> str:
    """Return the translated name of a kind of MIDI message that controls breath or bite."""
    named = {
        "none": tr("midi_source.nothing"),
        "cc1": tr("midi_source.cc_1_modulation"),
        "cc2": tr("midi_source.cc_2_breath"),
        "cc7": tr("midi_source.cc_7_volume"),
        "cc11": tr("midi_source.cc_11_expression"),
        "channel_pressure": tr("midi_source.aftertouch"),
        "pitch_bend": tr("midi_source.pitch_bend"),
    }
    return named.get(source) or f"CC {source.removeprefix('cc')}"


def _meter(name: str) -> QProgressBar:
    meter = named(QProgressBar(), name)
    meter.setRange(0, _FULL)
    meter.setTextVisible(False)
    meter.setStyleSheet("min-height: 10px; max-height: 10px;")
    return meter


def _fill(meter: QProgressBar, share: float) -> None:
    value = round(_FULL * share)
    if value != meter.value():
        meter.setValue(value)
