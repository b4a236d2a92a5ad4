"""Playback of a pair's motion and music by mouse and keys, compared with the sound sent to the device."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDoubleSpinBox, QLabel, QPushButton, QSlider, QToolButton
from pytestqt.qtbot import QtBot

from app.audio.playback import Playback
from app.audio.track import RATE_HZ
from app.choreography.body_pose import body_pose
from app.editor.session import Session
from tests.gui.choreography.test_learn_dialog import drop, press, state, type_number
from tests.gui.transport.devices import FakeDevices, Time
from tests.support.phrases import know_phrases
from tests.support.windows import child, show_in_front
from tests.unit.choreography.test_command import write_clip, write_drums
from tests.unit.choreography.test_cuts import arm_swings
from widgets.dialogs.choreography.learn import LearnDialog

STEP_S = 0.01
FIRST_HIT_S = 0.1
"""Time in seconds of the first hit in `write_drums`."""
Elapse = Callable[[float], None]


@pytest.fixture
def time(monkeypatch: pytest.MonkeyPatch) -> Time:
    know_phrases(monkeypatch)
    return Time()


@pytest.fixture
def devices(time: Time) -> FakeDevices:
    return FakeDevices(time)


@pytest.fixture
def playback(devices: FakeDevices, time: Time, qt_app: QApplication) -> Playback:
    return Playback(devices.open, time)


@pytest.fixture
def dialog(session: Session, qtbot: QtBot, tmp_path: Path, playback: Playback) -> LearnDialog:
    made = LearnDialog(session, tmp_path, playback=playback)
    made.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, on=False)
    qtbot.addWidget(made)
    show_in_front(made)
    drop(made, write_clip(tmp_path / "swings.bvh", arm_swings(60)), write_drums(tmp_path / "drums.mid"))
    type_number(made, "learn_offset", "1")
    return made


@pytest.fixture
def elapse(dialog: LearnDialog, playback: Playback, time: Time) -> Elapse:
    """Advance the clock, feeding the device and drawing the figure like their timers."""

    def run(seconds: float) -> None:
        for _ in range(round(seconds / STEP_S)):
            time.now_s += STEP_S
            playback.feed()
        dialog.cuts.player._follow()

    return run


def play(dialog: LearnDialog, qtbot: QtBot) -> None:
    """Press the button; the music is rendered when this returns."""
    QTest.mouseClick(child(dialog, QToolButton, "pair_play"), Qt.MouseButton.LeftButton)
    ready(dialog, qtbot)


def ready(dialog: LearnDialog, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: not dialog.cuts.player._stems.is_busy)


def hits_s(devices: FakeDevices) -> list[float]:
    """Times in seconds from the start at which sounds begin in the device's data."""
    loud = np.abs(devices.sink.sound).max(axis=1)
    # In blocks of 10 ms: a drum begins where it is many times as loud as before.
    blocks = loud[: len(loud) // 480 * 480].reshape(-1, 480).max(axis=1)
    begins = np.flatnonzero((blocks[1:] > 0.02) & (blocks[1:] > 5.0 * np.maximum(blocks[:-1], 1e-4))) + 1
    return [480.0 * float(block) / RATE_HZ for block in begins]


def place(dialog: LearnDialog) -> float:
    """Time of the motion at the slider."""
    return child(dialog, QSlider, "pair_place").value() / 1000.0


def drawn_at(dialog: LearnDialog, time_s: float) -> bool:
    """Return whether the drawn figure is that of a time."""
    analysis = dialog._rows[0].found.analysis
    assert analysis is not None
    frame = round(time_s * float(analysis.clip.fps))
    pose = dialog.cuts.figure.pose
    assert pose is not None
    poses = [body_pose(analysis.clip, near).points for near in (frame - 1, frame, frame + 1)]
    return any(np.array_equal(pose.points, near) for near in poses)


def test_motion_and_music_play_together_from_the_offset_on(
    dialog: LearnDialog, qtbot: QtBot, devices: FakeDevices, elapse: Elapse
) -> None:
    QTest.mouseClick(child(dialog, QToolButton, "pair_play"), Qt.MouseButton.LeftButton)
    ready(dialog, qtbot)
    elapse(2.0)
    assert hits_s(devices)[0] == pytest.approx(1.0 + FIRST_HIT_S, abs=0.03)
    assert place(dialog) == pytest.approx(2.0, abs=0.1)
    assert drawn_at(dialog, place(dialog))
    # A changed offset is heard at once, without interrupting the sound.
    type_number(dialog, "learn_offset", "1.25")
    elapse(1.5)
    late = [at for at in hits_s(devices) if at > 2.4]
    assert late[0] == pytest.approx(1.25 + 1.5 + FIRST_HIT_S, abs=0.03)
    QTest.mouseClick(child(dialog, QToolButton, "pair_play"), Qt.MouseButton.LeftButton)
    assert devices.sink.stopped
    stands = place(dialog)
    elapse(0.5)
    assert place(dialog) == stands


def test_it_is_played_by_keys_and_stops_at_the_end(
    dialog: LearnDialog, qtbot: QtBot, playback: Playback, elapse: Elapse
) -> None:
    plot = dialog.cuts.plot.plot
    plot.setFocus()
    QTest.keyClick(plot, Qt.Key.Key_Space)
    assert playback.is_playing
    QTest.keyClick(plot, Qt.Key.Key_Space)
    assert not playback.is_playing
    QTest.keyClick(plot, Qt.Key.Key_Space)
    ready(dialog, qtbot)
    elapse(9.0)
    assert not playback.is_playing
    assert place(dialog) == pytest.approx(8.5, abs=0.01)
    assert "8.50 / 8.50 s" in child(dialog, QLabel, "pair_said").text()


def test_the_slider_and_the_axis_scrub(dialog: LearnDialog, qtbot: QtBot, devices: FakeDevices, time: Time) -> None:
    slider = child(dialog, QSlider, "pair_place")
    slider.setFocus()
    QTest.keyClick(slider, Qt.Key.Key_PageUp)
    assert dialog.cuts.player.position_s == pytest.approx(1.0)
    assert drawn_at(dialog, 1.0)
    ready(dialog, qtbot)
    view, plot = dialog.cuts.plot.plot.viewport(), dialog.cuts.plot
    below = view.height() - 8
    cuts = plot.cuts
    QTest.mousePress(view, Qt.MouseButton.LeftButton, pos=QPoint(round(plot.x_px(60.0)), below))
    for frame in (70.0, 66.0):
        time.now_s += 0.5
        QTest.mouseMove(view, QPoint(round(plot.x_px(frame)), below))
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=QPoint(round(plot.x_px(66.0)), below))
    assert dialog.cuts.player.position_s == pytest.approx(1.1, abs=0.02)
    assert np.abs(devices.sink.sound).max() > 0.02, "the drum at 1.1 s sounds"
    assert plot.cuts == cuts


def test_one_thing_is_heard_at_a_time(
    dialog: LearnDialog, session: Session, qtbot: QtBot, playback: Playback, devices: FakeDevices, time: Time
) -> None:
    piece = session.playback = Playback(devices.open, time)
    piece.playing_changed.connect(session.set_playing)
    piece.set_span(0.0, 10.0)
    piece.play()
    play(dialog, qtbot)
    assert (piece.is_playing, playback.is_playing) == (False, True)
    piece.play()
    assert (piece.is_playing, playback.is_playing) == (True, False)
    piece.stop()
    play(dialog, qtbot)
    QTest.mouseClick(child(dialog, QPushButton, "learn_close"), Qt.MouseButton.LeftButton)
    assert not playback.is_playing


def test_without_a_device_it_says_so_and_the_motion_plays(
    dialog: LearnDialog, qtbot: QtBot, devices: FakeDevices, elapse: Elapse
) -> None:
    devices.there = False
    play(dialog, qtbot)
    elapse(1.0)
    assert "no audio device" in child(dialog, QLabel, "pair_said").text()
    assert place(dialog) == pytest.approx(1.0, abs=0.1)


def test_no_offset_beyond_the_clip_is_offered(dialog: LearnDialog, tmp_path: Path) -> None:
    number = child(dialog, QDoubleSpinBox, "learn_offset")
    # The motion lasts 8.5 s; the first drum sounds at 0.1 s, the last one at 7.9 s of the music.
    assert (number.minimum(), number.maximum()) == pytest.approx((-7.9, 8.4), abs=0.002)
    number.setFocus()
    for _ in range(20):
        QTest.keyClick(number, Qt.Key.Key_PageUp)
    number.setValue(1000.0)
    assert number.value() <= 8.5
    # A cut that was set stays, is displayed unchanged and is reported when the motion becomes shorter.
    type_number(dialog, "learn_fps", "160")
    assert dialog.drafts[0].offset_s == pytest.approx(8.4)
    assert number.value() == pytest.approx(8.4)
    # No quicker: faster arms would be taken for damage of the capture, and nothing would be left to learn from.
    assert "from -7.900 to 3.083 s" in child(dialog, QLabel, "learn_pair_notes").text()
    assert "Pair 1: no music sounds during the motion" in state(dialog)
    assert not child(dialog, QPushButton, "learn_start").isEnabled()
    type_number(dialog, "learn_offset", "1")
    assert (number.minimum(), number.maximum()) == pytest.approx((-7.9, 3.083), abs=0.002)
    press(dialog, "learn_start")
    assert (tmp_path / "choreography.choreography").exists()
