"""Dialogs of recording by mouse and keys, with a wind controller whose messages the test provides."""

from __future__ import annotations

import random
import re
from typing import TypeVar

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QComboBox,
    QDoubleSpinBox,
    QLabel,
    QListWidget,
    QProgressBar,
    QPushButton,
    QTreeWidget,
    QWidget,
)

from app.capture.protocol import Back, Lost, Opened, Ports, RequestRefused
from app.editor.design_tokens import LEAST_TARGET_PX
from app.errors import Message
from app.messages.pitches import pitch_name
from app.score.take import ControllerMapping
from instrument_maps.library import all_maps
from metadata.load import load_controllers
from tests.gui.japanese import english_in, texts_of
from tests.support.recorder import EWI
from tests.support.studio import Studio
from tests.support.windows import child
from widgets.common.actions import actions
from widgets.dialogs.latency import CLICKS_S, LEAD, LatencyDialog
from widgets.dialogs.midi_devices import MidiDevicesDialog

W = TypeVar("W", bound=QWidget)
USB = "EWI-USB"


def devices(studio: Studio) -> MidiDevicesDialog:
    actions(studio.session)["record.devices"].trigger()
    dialog = child(studio.program.window, MidiDevicesDialog)
    assert QTest.qWaitForWindowActive(dialog, 10_000)
    return dialog


def part(dialog: QWidget, kind: type[W], name: str) -> W:
    return child(dialog, kind, name)


def click(button: QPushButton) -> None:
    assert button.isEnabled()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def rows(dialog: QWidget) -> list[tuple[str, str]]:
    tree = part(dialog, QTreeWidget, "midi_device_list")
    items = [tree.topLevelItem(place) for place in range(tree.topLevelItemCount())]
    return [(item.text(0), item.text(1)) for item in items if item is not None]


def reported(dialog: QWidget, name: str) -> str:
    return part(dialog, QLabel, name).text()


def swell(studio: Studio, channel: int = 1, controller: int = 2) -> None:
    for value in [*range(0, 120, 4), *range(120, -1, -4)]:
        studio.link.play(bytes((0xAF + channel, controller, value)))


def test_devices_come_and_go_while_one_looks(studio: Studio) -> None:
    dialog = devices(studio)
    assert rows(dialog) == [("No device", ""), (EWI, "connected")]
    studio.link.say(Ports((EWI, USB), (), "test"))
    studio.wait(lambda: len(rows(dialog)) == 3)
    assert rows(dialog)[2] == (USB, "")
    studio.link.say(Lost(EWI, 0), Ports((USB,), (), "test"))
    studio.wait(lambda: (EWI, "disconnected") in rows(dialog))
    studio.link.say(Back(EWI, 0))
    studio.wait(lambda: (EWI, "connected") in rows(dialog))
    studio.link.say(Lost(EWI, 0), RequestRefused(Message("capture.port_refused", {"port": EWI, "detail": "busy"})))
    studio.wait(lambda: (EWI, "cannot open") in rows(dialog))
    assert "another program" in reported(dialog, "midi_hint")
    studio.link.say(Opened(EWI, 0))
    studio.wait(lambda: (EWI, "connected") in rows(dialog))
    assert reported(dialog, "midi_hint") == ""


def test_another_device_is_chosen_by_a_click_and_by_enter_and_remembered(studio: Studio) -> None:
    dialog = devices(studio)
    studio.link.say(Ports((EWI, USB), (), "test"))
    studio.wait(lambda: len(rows(dialog)) == 3)
    tree = part(dialog, QTreeWidget, "midi_device_list")
    item = tree.topLevelItem(2)
    assert item is not None
    QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=tree.visualItemRect(item).center())
    assert studio.link.requested[-1] == USB
    assert studio.session.recording.controller == "ewi_usb"
    assert rows(dialog)[2] == (USB, "waiting…")
    assert studio.program.editor.settings.midi_port == USB
    tree.setFocus()
    QTest.keyClick(tree, Qt.Key.Key_Up)
    QTest.keyClick(tree, Qt.Key.Key_Return)
    assert studio.link.requested[-1] == EWI
    studio.wait(lambda: studio.session.recording.connection == "open")
    # The same once more is no other choice.
    QTest.keyClick(tree, Qt.Key.Key_Return)
    assert studio.session.recording.connection == "open"


def test_without_a_device_it_is_taught_what_to_do(studio: Studio) -> None:
    recorder = studio.program.recorder
    recorder.choose("")
    said: list[str] = []
    studio.session.noticed.connect(lambda message, severity: said.append(message.id))
    studio.link.say(Ports((), (), "test"))
    dialog = devices(studio)
    studio.wait(lambda: not studio.session.recording.ports)
    assert reported(dialog, "midi_hint").startswith("Connect a wind controller")
    studio.link.say(Ports((), (), ""), RequestRefused(Message("capture.no_system")))
    studio.wait(lambda: "modprobe" in reported(dialog, "midi_hint"))
    studio.link.say(Ports((EWI,), (), "alsa"))
    studio.wait(lambda: reported(dialog, "midi_hint").startswith("Select your device"))
    assert not said


def test_a_device_can_be_hit_as_soon_as_it_is_shown(studio: Studio) -> None:
    listed = part(devices(studio), QTreeWidget, "midi_device_list")
    assert listed.visualItemRect(listed.topLevelItem(0)).height() >= LEAST_TARGET_PX


def test_a_remembered_device_that_is_not_there_is_waited_for_without_a_warning(studio: Studio) -> None:
    said: list[str] = []
    studio.session.noticed.connect(lambda message, severity: said.append(message.id))
    dialog = devices(studio)
    studio.link.say(Ports((), (), "test"), RequestRefused(Message("capture.port_not_here", {"port": EWI})))
    studio.wait(lambda: (EWI, "waiting…") in rows(dialog))
    assert not said


@pytest.mark.parametrize("now", [f"{EWI} MIDI 1", f"{EWI} MIDI 1 (2)"])
def test_a_device_is_found_again_by_another_number(studio: Studio, now: str) -> None:
    recorder, settings = studio.program.recorder, studio.program.editor.settings
    before = f"{EWI}:{EWI} MIDI 1 20:0"
    recorder.choose(before)
    recorder.set_latency(0.03)
    studio.link.say(Ports((USB, now), (), "test"))
    studio.wait(lambda: studio.link.requested[-1] == now)
    assert (settings.midi_port, studio.session.recording.port) == (now, now)
    assert studio.session.recording.latency_s == 0.03, "what is known of it too"
    # The user chooses between two devices of one kind.
    recorder.choose(before)
    studio.link.say(Ports((f"{EWI} MIDI 1", f"{EWI} MIDI 1 (2)"), (), "test"))
    studio.wait(lambda: len(studio.session.recording.ports) == 2)
    assert studio.session.recording.port == before


def test_what_the_disk_or_an_output_refuses_says_nothing_of_the_device(studio: Studio) -> None:
    studio.link.say(Lost(EWI, 0), RequestRefused(Message("capture.not_written", {"file": "x", "reason": "full"})))
    studio.wait(lambda: studio.session.recording.connection == "lost")
    assert studio.session.recording.connection == "lost"
    studio.link.say(Back(EWI, 0), RequestRefused(Message("capture.port_refused", {"port": "Synth", "detail": "busy"})))
    studio.wait(lambda: studio.session.recording.connection == "open")
    assert studio.session.recording.connection == "open"


def test_what_comes_in_is_seen(studio: Studio) -> None:
    dialog = devices(studio)
    studio.link.play(bytes((0xB0, 2, 127)))
    for value in range(40):
        studio.link.play(bytes((0xE0, 0, 64 + value)))
    studio.link.play(bytes((0x90, 60, 90)))
    studio.wait(lambda: reported(dialog, "midi_note") == "C4")
    player = studio.session.player
    semitones = all_maps()[player.instrument_id].transposition_semitones
    assert semitones
    studio.session.pitch_display.set(written=True)
    assert reported(dialog, "midi_note") == pitch_name(60 + semitones)
    studio.session.pitch_display.set(written=False)
    assert part(dialog, QProgressBar, "midi_breath").value() == 1000
    assert part(dialog, QProgressBar, "midi_bite").value() == pytest.approx(609, abs=2)
    lines = part(dialog, QListWidget, "midi_messages")
    texts = [lines.item(row).text() for row in range(lines.count())]
    assert len(texts) == 3
    assert texts[0].startswith("C4 on, velocity 90")
    assert "×40" in texts[1]
    assert reported(dialog, "midi_channel") == "Channel 1"
    studio.link.play(bytes((0x93, 72, 90)))
    studio.wait(lambda: "channel 4" in reported(dialog, "midi_channel"))
    assert "only channel 1" in reported(dialog, "midi_channel")


def test_where_the_breath_is_is_learned_by_blowing(studio: Studio) -> None:
    dialog = devices(studio)
    learn = part(dialog, QPushButton, "midi_learn")
    click(learn)
    assert reported(dialog, "midi_learned").startswith("Blow now")
    swell(studio, channel=3, controller=11)
    studio.wait(lambda: reported(dialog, "midi_learned").startswith("Blow evenly"))
    assert studio.session.recording.mapping == ControllerMapping(3, "cc11", "pitch_bend")
    for value in [*range(0, 100, 10), *range(100, 0, -10)]:
        studio.link.play(bytes((0xB2, 11, 60 + value % 3)))
        studio.link.play(bytes((0xB2, 1, value)))
    studio.wait(lambda: reported(dialog, "midi_learned").startswith("Detected"))
    assert reported(dialog, "midi_learned") == "Detected: breath CC 11 (expression), bite CC 1 (modulation), channel 3."
    assert studio.session.recording.mapping == ControllerMapping(3, "cc11", "cc1")
    assert part(dialog, QComboBox, "midi_breath_source").currentText() == "CC 11 (expression)"
    # The value is stored for this device.
    recorder = studio.program.recorder
    recorder.choose("")
    recorder.choose(EWI)
    assert studio.session.recording.mapping.breath == "cc11"
    # Another kind of controller uses its factory settings.
    recorder.set_controller("generic")
    assert studio.session.recording.mapping == ControllerMapping(0, "cc2", "none")


def test_escape_cancels_learning_and_leaves_the_dialog(studio: Studio) -> None:
    dialog = devices(studio)
    before = studio.session.recording.mapping
    click(part(dialog, QPushButton, "midi_learn"))
    swell(studio, controller=11)
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    assert dialog.isVisible()
    assert reported(dialog, "midi_learned") == ""
    assert studio.session.recording.mapping == before
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    assert not dialog.isVisible()


def test_who_does_not_bite_keeps_what_was_known_of_the_bite(studio: Studio) -> None:
    dialog = devices(studio)
    click(part(dialog, QPushButton, "midi_learn"))
    swell(studio)
    studio.wait(lambda: reported(dialog, "midi_learned").startswith("Blow evenly"))
    swell(studio)
    studio.wait(lambda: reported(dialog, "midi_learned").startswith("Detected"))
    assert reported(dialog, "midi_learned").endswith("No bite was received.")
    assert studio.session.recording.mapping == ControllerMapping(1, "cc2", "pitch_bend")


def test_nothing_blown_is_nothing_learned(studio: Studio) -> None:
    dialog = devices(studio)
    click(part(dialog, QPushButton, "midi_learn"))
    studio.wait(lambda: "Nothing was received" in reported(dialog, "midi_learned"))
    assert studio.session.recording.mapping.breath == "cc2"


def test_breath_and_bite_are_never_the_same(studio: Studio) -> None:
    dialog = devices(studio)
    bite = part(dialog, QComboBox, "midi_bite_source")
    bite.setFocus()
    QTest.keyClick(bite, Qt.Key.Key_End)
    assert studio.session.recording.mapping.bite == "channel_pressure"
    breath = part(dialog, QComboBox, "midi_breath_source")
    breath.setFocus()
    QTest.keyClick(breath, Qt.Key.Key_End)
    assert studio.session.recording.mapping == ControllerMapping(1, "channel_pressure", "none")


def test_a_bite_that_is_sent_otherwise_now_is_not_shown_as_it_was(studio: Studio) -> None:
    dialog = devices(studio)
    bite, meter = part(dialog, QComboBox, "midi_bite_source"), part(dialog, QProgressBar, "midi_bite")
    studio.link.play(bytes((0xE0, 0, 100)))
    studio.wait(lambda: meter.value() > 0)
    bite.setFocus()
    QTest.keyClick(bite, Qt.Key.Key_Home)
    assert studio.session.recording.mapping.bite == "none"
    assert meter.value() == 0


def test_a_beep_without_an_audio_device_says_so(studio: Studio) -> None:
    dialog = devices(studio)
    click(part(dialog, QPushButton, "midi_beep"))
    assert "No audio output device" in reported(dialog, "midi_beep_status")


def test_the_status_line_says_how_the_device_stands_and_opens_the_dialog(studio: Studio) -> None:
    button = part(studio.program.window, QPushButton, "midi_device")
    assert button.text().strip() == f"{EWI} connected"
    click(button)
    dialog = child(studio.program.window, MidiDevicesDialog)
    assert dialog.isVisible()
    studio.link.say(Lost(EWI, 0))
    studio.wait(lambda: "disconnected" in button.text())


def test_the_dialogs_speak_japanese(studio: Studio) -> None:
    dialog = devices(studio)
    studio.program.editor.speak("ja")

    def judge(shown: QWidget, state: str) -> None:
        QApplication.processEvents()
        texts = texts_of(shown)
        assert not english_in(texts), state
        # Names, units and notes aside nothing is written in Latin letters alone.
        titles = {found.title.ja for found in load_controllers().values()}
        plain = {text for text in texts if text.isascii() and re.search("[A-Za-z]{2}", text)}
        plain = {text for text in plain if not re.fullmatch("CC .*|-?[0-9]* ?ms", text)}
        assert plain <= {EWI, USB, "C4", *titles}, state

    try:
        studio.link.play(bytes((0xB0, 2, 100)))
        studio.link.play(bytes((0x90, 60, 90)))
        studio.link.play(bytes((0xE0, 0, 70)))
        studio.wait(lambda: reported(dialog, "midi_note") == "C4")
        judge(dialog, "played")
        click(part(dialog, QPushButton, "midi_beep"))
        judge(dialog, "beep")
        click(part(dialog, QPushButton, "midi_learn"))
        judge(dialog, "blow")
        swell(studio)
        studio.wait(lambda: dialog._blown is not None)
        judge(dialog, "bite")
        studio.wait(lambda: dialog._learning is None)
        judge(dialog, "learned")
        for news in (
            [Lost(EWI, 0), Ports((USB,), (), "test")],
            [Ports((), (), ""), RequestRefused(Message("capture.no_system"))],
            [
                Ports((EWI,), (), "test"),
                RequestRefused(Message("capture.port_refused", {"port": EWI, "detail": "使用中"})),
            ],
        ):
            studio.link.say(*news)
            studio.wait(lambda: not studio.link.reported)
            judge(dialog, str(news))
        dialog.close()
        late = latency(studio)
        judge(late, "no device")
        studio.link.say(Back(EWI, 0))
        studio.wait(lambda: studio.session.recording.connection == "open")
        judge(late, "latency")
        click(part(late, QPushButton, "latency_start"))
        judge(late, "clicks")
        QTest.keyClick(late, Qt.Key.Key_Escape)
        judge(late, "stopped")
    finally:
        studio.program.editor.speak("en")


# The latency


def latency(studio: Studio) -> LatencyDialog:
    actions(studio.session)["record.latency"].trigger()
    dialog = child(studio.program.window, LatencyDialog)
    assert QTest.qWaitForWindowActive(dialog, 10_000)
    return dialog


def blow_on_clicks(studio: Studio, dialog: LatencyDialog, late_s: float, jitter_s: float, every: int = 1) -> None:
    """Play on the clicks by the test's clock; the first sample is audible at the start of playback."""
    chance = random.Random(3)
    begin_ns = studio.clock.ns
    for number, click_s in enumerate(CLICKS_S):
        if number < LEAD or number % every:
            continue
        at_ns = begin_ns + round((click_s + late_s + chance.gauss(0.0, jitter_s)) * 1e9)
        studio.wait(lambda at_ns=at_ns: studio.clock.ns >= at_ns)
        studio.link.play_at(at_ns, bytes((0x90, 60, 90)))
        studio.link.play_at(at_ns + 50_000_000, bytes((0x80, 60, 0)))
    studio.wait(lambda: part(dialog, QPushButton, "latency_start").text() == "Start")


def test_the_latency_is_measured_and_taken_off_from_then_on(studio: Studio) -> None:
    dialog = latency(studio)
    click(part(dialog, QPushButton, "latency_start"))
    blow_on_clicks(studio, dialog, 0.08, 0.004)
    value = part(dialog, QDoubleSpinBox, "latency_value")
    assert value.value() == pytest.approx(80.0, abs=6.0)
    assert studio.session.recording.latency_s == 0.0
    click(part(dialog, QPushButton, "latency_take"))
    assert studio.session.recording.latency_s == pytest.approx(value.value() / 1000.0)
    assert studio.program.editor.settings.midi_device(EWI, "latency_s")
    assert "compensated from now on" in reported(dialog, "latency_status")
    assert "your own timing" in " ".join(label.text() for label in dialog.findChildren(QLabel))


def test_too_few_hits_are_refused(studio: Studio) -> None:
    dialog = latency(studio)
    click(part(dialog, QPushButton, "latency_start"))
    blow_on_clicks(studio, dialog, 0.08, 0.004, every=4)
    assert "Only 3 of 12" in reported(dialog, "latency_status")
    assert not part(dialog, QPushButton, "latency_take").isEnabled()


def test_a_number_is_typed_instead(studio: Studio) -> None:
    dialog = latency(studio)
    value = part(dialog, QDoubleSpinBox, "latency_value")
    value.setFocus()
    value.selectAll()
    QTest.keyClicks(value, "35")
    click(part(dialog, QPushButton, "latency_take"))
    assert studio.session.recording.latency_s == 0.035


def test_escape_ends_measuring_first(studio: Studio) -> None:
    dialog = latency(studio)
    click(part(dialog, QPushButton, "latency_start"))
    studio.wait(lambda: "light" in reported(dialog, "latency_status"))
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    assert dialog.isVisible()
    assert part(dialog, QPushButton, "latency_start").text() == "Start"
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    assert not dialog.isVisible()


def test_a_device_that_goes_ends_measuring(studio: Studio) -> None:
    dialog = latency(studio)
    click(part(dialog, QPushButton, "latency_start"))
    studio.link.say(Lost(EWI, 0))
    studio.wait(lambda: "Measurement stopped" in reported(dialog, "latency_status"))
    assert not part(dialog, QPushButton, "latency_start").isEnabled()
