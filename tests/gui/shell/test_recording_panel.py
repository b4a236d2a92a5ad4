"""The recording panel in its workspace, with a wind controller whose messages the test provides."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QProgressBar, QToolButton

from app.capture.protocol import Lost
from app.editor.settings import Settings
from tests.support.recorder import EWI
from tests.support.studio import Studio
from widgets.common.combo import Combo

LEFT = Qt.MouseButton.LeftButton


def text(studio: Studio, name: str) -> str:
    label = studio.program.window.findChild(QLabel, f"recording_{name}")
    assert isinstance(label, QLabel)
    return label.text()


def click(studio: Studio, action_id: str) -> None:
    button = studio.program.window.findChild(QToolButton, f"recording_{action_id.replace('.', '_')}")
    assert isinstance(button, QToolButton)
    studio.wait(button.isEnabled)
    QTest.mouseClick(button, LEFT)


def test_everything_that_a_take_begins_with_is_at_hand(studio: Studio, settings: Settings) -> None:
    window, session = studio.program.window, studio.session
    window.activateWindow()
    assert QTest.qWaitForWindowActive(window, 10_000)
    QTest.keyClick(window, Qt.Key.Key_2, Qt.KeyboardModifier.AltModifier)
    assert window.docks["recording"].isVisible()
    assert (text(studio, "device"), text(studio, "state")) == (EWI, "Connected")
    meter = window.findChild(QProgressBar, "recording_breath")
    assert isinstance(meter, QProgressBar)
    studio.link.play(bytes((0xB0, 2, 127)))
    studio.link.play(bytes((0x90, 60, 90)))
    studio.wait(lambda: meter.value() == meter.maximum())
    assert text(studio, "note") == "C4"
    studio.link.play(bytes((0x80, 60, 0)))
    studio.link.play(bytes((0xB0, 2, 0)))
    studio.wait(lambda: meter.value() == 0 and not text(studio, "note"))

    name = session.project.players[0].name
    assert text(studio, "player") == name
    click(studio, "record.arm")
    assert session.recording.armed == session.project.players[0].id
    studio.wait(lambda: text(studio, "player") != name)
    bars = window.findChild(Combo, "recording_count_in")
    assert isinstance(bars, Combo)
    assert bars.shown == "record.count_in_0"
    QTest.keyClick(bars, Qt.Key.Key_Down)
    assert session.recording.count_in_bars == settings.count_in_bars == 1
    QTest.keyClick(bars, Qt.Key.Key_Up)

    click(studio, "record.toggle")
    assert session.recording.running
    studio.blow(62, 0.3)
    click(studio, "record.toggle")
    studio.wait(lambda: bool(session.project.takes))
    assert text(studio, "takes") == "Takes: 1"
    studio.program.editor.speak("ja")
    studio.wait(lambda: text(studio, "takes") == "テイク: 1")
    studio.program.editor.speak("en")
    studio.link.say(Lost(EWI, 0))
    studio.wait(lambda: text(studio, "state") == "Disconnected")
