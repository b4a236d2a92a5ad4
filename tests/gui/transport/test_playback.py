"""Playback: position, speed, loops, without a device, and with a device that is removed."""

from __future__ import annotations

import numpy as np
import pytest

from app.audio.playback import Playback
from app.audio.sink import BUFFER_S
from app.audio.track import RATE_HZ, Mix
from tests.gui.transport.conftest import Elapse
from tests.gui.transport.devices import FakeDevices, Time
from tests.unit.audio.pieces import ramp_track, times_s


@pytest.fixture(autouse=True)
def _mix(playback: Playback) -> None:
    playback.set_mix(Mix([ramp_track(25.0)]))


def test_the_position_is_what_the_device_plays(playback: Playback, devices: FakeDevices, elapse: Elapse) -> None:
    playback.play(2.0)
    assert playback.is_playing
    assert playback.position_s() == pytest.approx(2.0, abs=0.001)
    for _ in range(30):
        elapse(0.1)
        played = round(devices.sink.processed_s() * RATE_HZ)
        assert playback.position_s() == pytest.approx(times_s(devices.sink.sound)[played - 1], abs=0.003)
    assert playback.position_s() == pytest.approx(5.0, abs=0.003)
    playback.stop()
    assert playback.position_s() == pytest.approx(5.0, abs=0.003)
    assert devices.sink.stopped


@pytest.mark.parametrize("speed", [0.25, 0.5, 1.5, 2.0])
def test_at_other_speeds(playback: Playback, elapse: Elapse, speed: float) -> None:
    playback.set_speed(speed)
    playback.play(1.0)
    before = playback.position_s()
    for _ in range(40):
        elapse(0.05)
        assert playback.position_s() >= before
        before = playback.position_s()
    assert playback.position_s() == pytest.approx(1.0 + 2.0 * speed, abs=0.035)


def test_changing_the_speed_while_it_plays(playback: Playback, elapse: Elapse) -> None:
    playback.play(1.0)
    elapse(1.0)
    playback.set_speed(0.5)
    elapse(1.0 + BUFFER_S)
    # Sound queued in the device still has the former speed.
    assert playback.position_s() == pytest.approx(2.0 + BUFFER_S + 0.5, abs=0.035)


def test_a_loop(playback: Playback, elapse: Elapse) -> None:
    playback.set_loop((3.0, 4.0))
    playback.play(3.2)
    seen = []
    for _ in range(60):
        elapse(0.05)
        seen.append(playback.position_s())
    assert 3.0 <= min(seen) < 3.06
    assert 3.94 < max(seen) <= 4.0
    assert seen[-1] == pytest.approx(3.2, abs=0.003)
    assert playback.is_playing


def test_playing_from_behind_a_loop_begins_at_its_start(playback: Playback, elapse: Elapse) -> None:
    playback.set_loop((3.0, 4.0))
    playback.play(4.0)
    elapse(0.1)
    assert playback.position_s() == pytest.approx(3.1, abs=0.003)


def test_it_stops_at_the_end_and_begins_anew(playback: Playback, elapse: Elapse) -> None:
    reported: list[bool] = []
    playback.playing_changed.connect(reported.append)
    playback.play(19.5)
    elapse(0.6)
    assert not playback.is_playing
    assert playback.position_s() == 20.0
    assert reported == [True, False]
    playback.play()
    elapse(0.1)
    assert playback.position_s() == pytest.approx(-0.9, abs=0.003)


def test_seeking_while_it_plays_is_seen_at_once(playback: Playback, devices: FakeDevices, elapse: Elapse) -> None:
    playback.play(2.0)
    elapse(0.5)
    playback.seek(10.0)
    assert playback.position_s() == 10.0
    elapse(BUFFER_S / 2)
    assert playback.position_s() == 10.0
    elapse(BUFFER_S / 2 + 0.5)
    assert playback.position_s() == pytest.approx(10.5, abs=0.003)
    assert len(devices.sinks) == 1


def test_seeking_while_it_stands(playback: Playback, devices: FakeDevices) -> None:
    playback.seek(7.0)
    assert playback.position_s() == 7.0
    assert not devices.sinks
    playback.play()
    assert playback.position_s() == pytest.approx(7.0, abs=0.001)


def test_the_volume_is_as_the_ear_judges_it(playback: Playback, devices: FakeDevices) -> None:
    playback.set_volume(0.5)
    playback.play(0.0)
    assert devices.sink.gain == 0.25
    playback.set_volume(1.0)
    assert devices.sink.gain == 1.0


def test_scrubbing_plays_a_grain(playback: Playback, devices: FakeDevices, time: Time) -> None:
    playback.scrub(5.0)
    assert playback.position_s() == 5.0
    assert not playback.is_playing
    grain = times_s(devices.sink.sound)
    assert 0.05 * RATE_HZ < len(grain) < 0.2 * RATE_HZ
    assert grain.max() == pytest.approx(5.0, abs=0.05)
    assert abs(grain[0]) < 0.01
    # Faster than grains are long: they do not pile up.
    for at_s in np.linspace(5.0, 6.0, 50):
        playback.scrub(float(at_s))
        time.now_s += 0.005
    assert len(devices.sinks) == 1
    assert devices.sink.written < (0.25 + 0.15 + BUFFER_S) * RATE_HZ
    playback.play(5.0)
    assert len(devices.sinks) == 2
    assert devices.sinks[0].stopped


def test_scrubbing_without_a_device_says_nothing(playback: Playback, devices: FakeDevices) -> None:
    devices.there = False
    reported: list[bool] = []
    playback.silent_changed.connect(reported.append)
    playback.scrub(3.0)
    assert playback.position_s() == 3.0
    assert not reported


def test_scrubbing_goes_on_with_another_device(playback: Playback, devices: FakeDevices, time: Time) -> None:
    playback.scrub(3.0)
    devices.sink.broken, devices.there = True, False
    playback.scrub(4.0)
    assert devices.sinks[0].stopped
    devices.there = True
    # A missing one is not looked for at every step of the hand.
    playback.scrub(5.0)
    assert len(devices.sinks) == 1
    time.now_s += 3.0
    playback.scrub(6.0)
    assert len(devices.sinks) == 2
    assert devices.sink.written


def test_without_a_device_it_plays_silently_in_time(playback: Playback, devices: FakeDevices, elapse: Elapse) -> None:
    reported: list[bool] = []
    playback.silent_changed.connect(reported.append)
    devices.there = False
    playback.play(1.0)
    elapse(2.0)
    assert playback.position_s() == pytest.approx(3.0, abs=0.002)
    playback.stop()
    playback.play(1.0)
    assert reported == [True]
    devices.there = True
    playback.stop()
    playback.play(1.0)
    assert reported == [True, False]


def test_silent_loops_and_speeds(playback: Playback, devices: FakeDevices, elapse: Elapse) -> None:
    devices.there = False
    playback.set_speed(0.5)
    playback.set_loop((2.0, 3.0))
    playback.play(2.0)
    elapse(2.6)
    assert playback.position_s() == pytest.approx(2.3, abs=0.02)


def test_a_device_that_is_pulled_out_is_replaced(playback: Playback, devices: FakeDevices, elapse: Elapse) -> None:
    playback.play(1.0)
    elapse(1.5)
    devices.there = False
    devices.sink.broken = True
    elapse(0.5)
    assert playback.is_playing
    assert playback.is_silent
    assert playback.position_s() == pytest.approx(3.0, abs=0.01)
    devices.there = True
    elapse(2.0)
    assert not playback.is_silent
    elapse(0.5)
    assert playback.position_s() == pytest.approx(5.5, abs=0.02)


def test_a_device_that_breaks_is_opened_again_but_not_for_ever(
    playback: Playback, devices: FakeDevices, elapse: Elapse
) -> None:
    playback.play(1.0)
    elapse(2.0)
    devices.sink.broken = True
    elapse(0.05)
    assert len(devices.sinks) == 2
    assert not playback.is_silent
    devices.sink.broken = True
    elapse(0.05)
    assert len(devices.sinks) == 2
    assert playback.is_silent
    elapse(3.0)
    assert len(devices.sinks) == 2
    assert playback.position_s() == pytest.approx(6.1, abs=0.05)


def test_a_busy_window_only_makes_it_wait(playback: Playback, time: Time, elapse: Elapse) -> None:
    playback.play(1.0)
    elapse(1.0)
    time.now_s += 0.7
    # The device ran out of data after playing its buffer.
    assert playback.position_s() == pytest.approx(2.0 + BUFFER_S, abs=0.035)
    playback.feed()
    before = playback.position_s()
    elapse(0.5)
    assert playback.position_s() >= before
    elapse(0.5)
