"""Dialog of the MIDI devices: the recorded one, its kind, and a monitor of its input.

The dialog emits requests as signals; the present state is in `session.recording`.
"""

from __future__ import annotations

import msgspec
from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QColor, QKeyEvent
from PySide6.QtWidgets import QDialog, QGroupBox, QPushButton, QTreeWidgetItem, QWidget

from app.audio.click import BEEP_S, beep_track
from app.audio.playback import Playback
from app.audio.track import Mix
from app.capture.controller_recognition import Learned, learned_bite, recognised_controller
from app.capture.protocol import Events
from app.editor.session import Session
from metadata.load import load_controllers
from metadata.model import BiteSource
from widgets.common.clicks import on_click
from widgets.common.combo import Combo, Option
from widgets.common.controls import Button, Caption, ColumnList, Retranslated, named, wrapped
from widgets.common.help import HelpButton
from widgets.common.instrument_name import language
from widgets.common.layouts import in_column, in_form, in_row
from widgets.common.plain import Label
from widgets.common.text import sentence
from widgets.dialogs.midi_monitor import MidiMonitor, source_name

LEARN_S = 3
_BREATHS = ("cc2", "cc11", "cc7", "channel_pressure")
_BITES = ("none", "pitch_bend", "cc1", "channel_pressure")
_CHANNELS = 16
_SIDE_PX = 300


class MidiDevicesDialog(Retranslated, QDialog):
    """Dialog with the devices, the kind of the chosen one, and a monitor; not modal, so that the user can play
    meanwhile.

    Parameters
    ----------
    playback : Playback
        Playback of a beep; becomes a child of the dialog.

    Signals
    -------
    chosen(str)
        The user chose the device of this name; empty for none.
    controller_chosen(str)
        The user chose the kind of the device.
    mapping_chosen(object)
        The messages for breath and bite were recognised: an `app.score.take.ControllerMapping`.
    latency_asked()
        The user wants to measure the latency.
    """

    chosen = Signal(str)
    controller_chosen = Signal(str)
    mapping_chosen = Signal(object)
    latency_asked = Signal()

    def __init__(self, session: Session, playback: Playback, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("midi_devices")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session, self._playback = session, playback
        playback.setParent(self)
        self._learning: list[tuple[int, bytes]] | None = None
        self._blown: tuple[Learned, list[tuple[int, bytes]]] | None = None
        """The breath that was found, and from what, while the bite is looked for."""
        self._left_s = 0
        self._listed: tuple[object, ...] = ()
        self._list = self.texted(
            ColumnList("midi_device_list", "midi_devices_dialog.device", "midi_devices_dialog.state"),
            name="midi_devices_dialog.devices",
        )
        self._hint = named(wrapped(Label()), "midi_hint")
        self._reported = named(wrapped(Label()), "midi_learned")
        self._audio_status = named(wrapped(Label()), "midi_beep_status")
        self._late = named(Label(), "midi_latency")
        self._kind, self._channel = named(Combo(), "midi_kind"), named(Combo(), "midi_wired_channel")
        self._breath, self._bite = named(Combo(), "midi_breath_source"), named(Combo(), "midi_bite_source")
        self._learn = named(QPushButton(), "midi_learn")
        # Enter in the list must not press the button.
        self._learn.setAutoDefault(False)
        self._close = Button("midi_devices_dialog.close", self.close, "midi_close")
        beep_tip = "midi_devices_dialog.test_tone_tip"
        self._beep = Button("midi_devices_dialog.test_beep", self.beep, "midi_beep", beep_tip)
        self._measure = Button("midi_devices_dialog.measure", self.latency_asked.emit, "midi_measure")
        self._device, self._incoming = QGroupBox(), QGroupBox()
        self._monitor = MidiMonitor(session)
        self._second = QTimer(self, interval=1000)
        self._second.timeout.connect(self._count_down)
        self._build()
        self._connect()
        self.texted(self, title="midi_devices_dialog.midi_devices")
        self.texted(self._device, heading="midi_devices_dialog.chosen_device")
        self.texted(self._incoming, heading="midi_devices_dialog.input_monitor")
        self.retranslate()
        self.resize(820, 560)

    # Construction

    def _build(self) -> None:
        form = in_form(
            {
                "midi_devices_dialog.kind": self._kind,
                "midi_devices_dialog.channel": self._channel,
                "midi_devices_dialog.breath": self._breath,
                "midi_devices_dialog.bite": self._bite,
            },
            of=self._device,
        )
        form.addRow(self._learn)
        form.addRow(self._reported)
        form.addRow(Caption("midi_devices_dialog.latency"), in_row((self._late, 1), self._measure))
        left = in_column((self._list, 1), self._hint, self._device)
        in_column(self._monitor, of=self._incoming)
        columns = in_row((left, 1), (self._incoming, 1))
        self._device.setMinimumWidth(_SIDE_PX)
        self._incoming.setMinimumWidth(_SIDE_PX)
        bottom = in_row(HelpButton(), self._beep, (self._audio_status, 1), self._close)
        in_column((columns, 1), bottom, of=self)

    def _connect(self) -> None:
        session, recording = self._session, self._session.recording
        self._list.itemClicked.connect(self._choose)
        self._list.itemActivated.connect(self._choose)
        self._kind.chosen.connect(self._choose_kind)
        self._channel.chosen.connect(lambda id: self._wire(channel=int(id)))
        self._breath.chosen.connect(lambda id: self._wire(breath=id))
        self._bite.chosen.connect(lambda id: self._wire(bite=id))
        on_click(self._learn, self._toggle_learning)
        # Stops however the dialog is closed.
        self.finished.connect(self._playback.stop)
        recording.changed.connect(self._show)
        recording.received.connect(self._on_received)
        session.theme_changed.connect(self._show)

    # User actions

    def _choose(self, item: QTreeWidgetItem, column: int = 0) -> None:
        self.chosen.emit(item.data(0, Qt.ItemDataRole.UserRole))

    def _choose_kind(self, controller: str) -> None:
        self._reported.clear()
        self.controller_chosen.emit(controller)

    def _wire(self, **values: object) -> None:
        mapping = msgspec.structs.replace(self._session.recording.mapping, **values)
        if mapping.bite == mapping.breath:
            # One message cannot control both breath and bite.
            mapping = msgspec.structs.replace(mapping, bite="none")
        self._reported.clear()
        self.mapping_chosen.emit(mapping)

    def beep(self) -> None:
        """Play a short tone, or show the reason if there is no sound."""
        volume, playback = self._session.listening.volume, self._playback
        playback.stop()
        playback.set_volume(volume)
        playback.set_mix(Mix([beep_track()]))
        playback.set_span(0.0, BEEP_S)
        playback.play(0.0)
        if playback.is_silent:
            self._report(self._audio_status, self.tr("midi_devices_dialog.there_is_no_audio_device"), wrong=True)
        elif volume == 0.0:
            self._report(self._audio_status, self.tr("midi_devices_dialog.volume_of_transport_is_0"), wrong=True)
        else:
            self._report(self._audio_status, self.tr("midi_devices_dialog.you_should_hear_short_tone"))

    # Learning

    def _toggle_learning(self) -> None:
        if self._learning is not None:
            self._stop_learning()
            self._reported.clear()
        else:
            self._start_learning()

    def _start_learning(self) -> None:
        self._learning, self._left_s = [], LEARN_S
        self._second.start()
        self._show()

    def _stop_learning(self) -> None:
        self._learning = self._blown = None
        self._second.stop()
        self._show()

    def _on_received(self, events: Events) -> None:
        if self._learning is not None:
            self._learning += zip(events.times_ns, events.messages, strict=True)

    def _count_down(self) -> None:
        self._left_s -= 1
        if self._left_s > 0:
            self._show()
            return
        recording, events, blown = self._session.recording, self._learning or [], self._blown
        self._stop_learning()
        if blown is not None:
            self._learn_bite(blown[0], learned_bite(events, blown[1], blown[0]))
            return
        found = recognised_controller(events, load_controllers()[recording.controller].breath)
        if found is None:
            why = self.tr("midi_devices_dialog.no_breath_came_in_blow")
            if not events:
                why = self.tr("midi_devices_dialog.nothing_came_in_from_device")
            self._report(self._reported, why, wrong=True)
            return
        self._wire(breath=found.source, channel=found.channel)
        self._blown = found, events
        self._start_learning()

    def _learn_bite(self, breath: Learned, bite: BiteSource | None) -> None:
        """Store the recognised controllers for breath and bite; without a recognised bite, its known
        calibration stays.
        """
        if bite is not None:
            self._wire(bite=bite)
            text = self.tr("midi_devices_dialog.found_breath_bite_channel")
        else:
            text = self.tr("midi_devices_dialog.found_breath_channel_no_bite")
        names = {"source": source_name(breath.source), "bite": source_name(bite or "none")}
        self._report(self._reported, text.format(**names, number=breath.channel))

    # Display

    def _report(self, label: Label, text: str, wrong: bool = False) -> None:
        tokens = self._session.tokens
        style = f"color: {tokens.warning if wrong else tokens.good};"
        if (text, style) != (label.text(), label.styleSheet()):
            label.setStyleSheet(style)
            label.setText(text)

    def _show(self) -> None:
        recording = self._session.recording
        if self._learning is not None and recording.connection != "open":
            self._learning = self._blown = None
            self._second.stop()
            self._reported.clear()
        self._show_devices()
        self._show_kind()
        is_open, is_learning = recording.connection == "open", self._learning is not None
        self._learn.setEnabled(is_open)
        self._learn.setText(
            self.tr("midi_devices_dialog.cancel")
            if is_learning
            else self.tr("midi_devices_dialog.detect_breath_and_bite")
        )
        if is_learning:
            text = self.tr("midi_devices_dialog.blow_now_soft_loud_and")
            if self._blown is not None:
                text = self.tr("midi_devices_dialog.now_blow_evenly_bite_and")
            self._report(self._reported, text.format(count=self._left_s))
        self._late.setText(self.tr("midi_devices_dialog.ms").format(count=f"{1000 * recording.latency_s:.0f}"))

    def _show_devices(self) -> None:
        recording, tokens = self._session.recording, self._session.tokens
        names = list(recording.ports)
        if recording.port and recording.port not in names:
            names.append(recording.port)
        current = self._list.currentItem()
        at = recording.port if current is None else current.data(0, Qt.ItemDataRole.UserRole)
        requested = [("", self.tr("midi_devices_dialog.no_device"), "")]
        requested += [(name, name, self._state(name)) for name in names]
        shown = (requested, recording.port, tokens.name)
        if shown != self._listed:
            # Rebuilding the list under the mouse would lose the click.
            self._listed = shown
            self._fill(requested, at)
        self._hint.setText(self._advice())
        self._hint.setVisible(bool(self._hint.text()))
        is_wrong = recording.refusal is not None
        self._hint.setStyleSheet(f"color: {tokens.warning if is_wrong else tokens.text_dim};")

    def _fill(self, requested: list[tuple[str, str, str]], at: str) -> None:
        recording, tokens = self._session.recording, self._session.tokens
        self._list.clear()
        for id, text, state in requested:
            item = QTreeWidgetItem([text, state])
            item.setData(0, Qt.ItemDataRole.UserRole, id)
            if id == recording.port:
                font = item.font(0)
                font.setBold(True)
                item.setFont(0, font)
                good = recording.connection == "open"
                item.setForeground(1, QColor(tokens.good if good else tokens.warning))
            self._list.addTopLevelItem(item)
            if id == at:
                self._list.setCurrentItem(item)

    def _state(self, name: str) -> str:
        recording = self._session.recording
        if name != recording.port:
            return ""
        return {
            "none": "",
            "waiting": self.tr("midi_devices_dialog.waiting"),
            "open": self.tr("midi_devices_dialog.connected"),
            "lost": self.tr("midi_devices_dialog.unplugged"),
            "refused": self.tr("midi_devices_dialog.cannot_be_opened"),
        }[recording.connection]

    def _advice(self) -> str:
        """Return advice if recording is not possible yet."""
        recording = self._session.recording
        if recording.refusal is not None:
            return sentence(recording.refusal, self._session)
        if not recording.ports:
            return self.tr("midi_devices_dialog.no_device_hint")
        return "" if recording.port else self.tr("midi_devices_dialog.select_device")

    def _show_kind(self) -> None:
        recording = self._session.recording
        mapping, speaks_ja = recording.mapping, language() == "ja"
        controllers = load_controllers()
        self._kind.set_options(
            [Option(id, found.title.ja if speaks_ja else found.title.en) for id, found in controllers.items()]
        )
        self._kind.show_option(recording.controller)
        self._channel.set_options(
            [
                Option("0", self.tr("midi_devices_dialog.any")),
                *(Option(str(n), str(n)) for n in range(1, _CHANNELS + 1)),
            ]
        )
        self._channel.show_option(str(mapping.channel))
        self._breath.set_options([Option(source, source_name(source)) for source in _BREATHS])
        self._breath.show_option(mapping.breath)
        bites = [source for source in dict.fromkeys((*_BITES, mapping.bite)) if source != mapping.breath]
        self._bite.set_options([Option(source, source_name(source)) for source in bites])
        self._bite.show_option(mapping.bite)
        self._device.setEnabled(bool(recording.port))

    def retranslate(self) -> None:
        self._learn.setToolTip(self.tr("midi_devices_dialog.detect_tip").format(count=LEARN_S))
        self._show()

    # Qt overrides

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self._learning is not None:
            self._toggle_learning()
            return
        super().keyPressEvent(event)
