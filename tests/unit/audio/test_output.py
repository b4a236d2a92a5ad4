"""Output to the system's audio device: samples fetched, times reported, and ending."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from miniaudio import Backend, MiniaudioError, PlaybackDevice

from app.audio import output
from app.audio.output import OutputSink, Queue, open_output
from app.audio.sink import BUFFER_S
from app.audio.track import RATE_HZ, Block

ROOT = Path(__file__).parents[3]


class Clock:
    """A clock controlled by the test."""

    now_s = 50.0

    def __call__(self) -> float:
        return self.now_s


def ramp(first: int, count: int) -> Block:
    return np.repeat(np.arange(first, first + count, dtype=np.float32)[:, None], 2, axis=1)


def test_what_was_put_is_fetched_in_order_with_silence_after_it() -> None:
    queue = Queue(1000, 0.0)
    assert not queue.fetch(5).any()
    queue.put(ramp(1, 7))
    queue.put(ramp(8, 2))
    assert queue.fetch(3)[:, 0].tolist() == [1, 2, 3]
    assert queue.fetch(5)[:, 1].tolist() == [4, 5, 6, 7, 8]
    queue.gain = 0.5
    assert queue.fetch(3)[:, 0].tolist() == [4.5, 0, 0]


def test_the_generator_gives_as_many_samples_as_are_asked_for() -> None:
    queue = Queue(1000, 0.0)
    queue.put(ramp(1, 4))
    frames = queue.frames()
    assert np.asarray(frames.send(3)).shape == (3, 2)
    assert np.asarray(frames.send(3))[:, 0].tolist() == [4, 0, 0]


def test_sound_is_played_after_the_device_s_delay_and_no_faster_than_time() -> None:
    clock = Clock()
    queue = Queue(1000, 0.04, clock)
    queue.put(ramp(0, 200))
    assert (queue.played_s(), queue.waiting_s()) == (0.0, 0.2)
    queue.fetch(100)
    clock.now_s += 0.04
    assert queue.played_s() == pytest.approx(0.0)
    clock.now_s += 0.06
    assert queue.played_s() == pytest.approx(0.06)
    queue.fetch(100)
    clock.now_s += 0.04
    assert queue.played_s() == pytest.approx(0.1)
    clock.now_s += 0.05
    assert queue.played_s() == pytest.approx(0.15)
    clock.now_s += 1.0
    # Silence is not played sound.
    queue.fetch(100)
    clock.now_s += 1.0
    assert (queue.played_s(), queue.waiting_s()) == (0.2, 0.0)
    assert queue.unfetched_s() == pytest.approx(1.0)


def test_a_device_plays_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    sink = OutputSink((Backend.NULL,))
    start_s, written = time.perf_counter(), 0
    while (elapsed_s := time.perf_counter() - start_s) < 0.4:
        count = sink.free()
        assert count <= BUFFER_S * RATE_HZ
        sink.write(np.zeros((count, 2), np.float32))
        written += count
        time.sleep(0.01)
    assert 0.1 < sink.processed_s() <= elapsed_s
    assert written / RATE_HZ - sink.processed_s() <= BUFFER_S + 0.001
    assert not sink.failed()
    monkeypatch.setattr(output, "_STALLED_S", -1.0)
    assert sink.failed()
    monkeypatch.undo()
    sink.stop()
    assert sink.failed()


def test_a_device_that_cannot_be_opened_or_started_is_given_back(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(MiniaudioError):
        OutputSink((Backend.AAUDIO,))

    def refuse(device: PlaybackDevice, generator: object) -> None:
        refused.append(device)
        raise MiniaudioError("busy")

    refused: list[PlaybackDevice] = []
    monkeypatch.setattr(PlaybackDevice, "start", refuse)
    with pytest.raises(MiniaudioError):
        OutputSink((Backend.NULL,))
    assert [device._device for device in refused] == [None]


def test_the_program_ends_though_sound_plays() -> None:
    script = (
        "import time; from miniaudio import Backend; from app.audio.output import OutputSink;"
        "sink = OutputSink((Backend.NULL,)); time.sleep(0.1)"
    )
    subprocess.run([sys.executable, "-c", script], cwd=ROOT, check=True, timeout=900)


def test_this_machine_s_own_output_or_none(capfd: pytest.CaptureFixture[str]) -> None:
    sink = open_output()
    if sink is not None:
        assert sink.free() > 0
        sink.write(np.zeros((480, 2), np.float32))
        sink.stop()
    assert capfd.readouterr().err == ""
