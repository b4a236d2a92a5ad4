"""Reading a mix: in order, in loops, stretched, with the performance times reported with the samples."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.audio.reader import Mark, Reader
from app.audio.track import RATE_HZ, AudioSegment, Mix, MixTrack
from tests.unit.audio.pieces import ramp_track, times_s

MIX = Mix([ramp_track()])


def read_all(reader: Reader, seconds: float, chunk: int = 1000) -> tuple[np.ndarray, list[Mark]]:
    blocks, marks = [], []
    for _ in range(round(seconds * RATE_HZ / chunk)):
        block, more = reader.read(chunk)
        blocks.append(block)
        marks += more
    return np.concatenate(blocks), marks


def said_s(marks: list[Mark], sample: int) -> float:
    """Performance time of a sample according to the marks."""
    at, position_s, speed = [mark for mark in marks if mark[0] <= sample][-1]
    return position_s + (sample - at) / RATE_HZ * speed


def test_straight_on() -> None:
    block, marks = read_all(Reader(MIX, 1.5), 2.0)
    assert marks == [(0, 1.5, 1.0)]
    assert times_s(block)[200:] == pytest.approx(1.5 + np.arange(200, 2 * RATE_HZ) / RATE_HZ, abs=1e-3)


def test_before_the_beginning_it_is_silent() -> None:
    block, _ = read_all(Reader(MIX, -1.0), 1.5)
    assert (block[:RATE_HZ] == 0).all()
    assert times_s(block)[-1] == pytest.approx(0.5, abs=2e-3)


def test_a_loop_goes_round_and_its_marks_say_so() -> None:
    block, marks = read_all(Reader(MIX, 3.5, loop_s=(3.0, 4.0)), 3.0, chunk=777)
    found_s = times_s(block)
    for at_s, expected_s in ((0.25, 3.75), (0.6, 3.1), (1.3, 3.8), (1.6, 3.1), (2.9, 3.4)):
        sample = round(at_s * RATE_HZ)
        assert found_s[sample] == pytest.approx(expected_s, abs=2e-3)
        assert said_s(marks, sample) == pytest.approx(expected_s, abs=1e-6)
    assert [mark[0] / RATE_HZ for mark in marks[1:]] == pytest.approx([0.5, 1.5, 2.5], abs=1e-6)


def test_beyond_a_loop_it_goes_on_to_the_end() -> None:
    block, marks = read_all(Reader(MIX, 5.0, loop_s=(3.0, 4.0)), 1.0)
    assert len(marks) == 1
    assert times_s(block)[-1] == pytest.approx(6.0, abs=2e-3)


@pytest.mark.parametrize("loop_s", [(1.0, 1.0), (2.0, 1.0), (1.0, 1.001)])
def test_a_loop_of_no_length_is_none(loop_s: tuple[float, float]) -> None:
    block, _ = read_all(Reader(MIX, 0.9, loop_s=loop_s), 1.0)
    assert times_s(block)[-1] == pytest.approx(1.9, abs=2e-3)


@settings(deadline=None, max_examples=15)
@given(speed=st.floats(0.25, 2.0), chunk=st.integers(64, 9000), loops=st.booleans())
def test_at_any_speed_the_marks_give_the_sounding_position(speed: float, chunk: int, loops: bool) -> None:
    reader = Reader(MIX, 2.0, speed, loop_s=(2.0, 3.0) if loops else None)
    block, marks = read_all(reader, 3.0, chunk)
    found_s = times_s(block)
    for sample in range(RATE_HZ // 2, len(block) - 1, RATE_HZ // 7):
        said = said_s(marks, sample)
        if loops and min(abs(said - 2.0), abs(said - 3.0)) < 0.15:
            continue
        assert found_s[sample] == pytest.approx(said, abs=0.045)
    if not loops and speed != 1.0:
        assert said_s(marks, 2 * RATE_HZ) == pytest.approx(2.0 + 2.0 * speed, abs=0.035 * max(speed, 1.0))


@pytest.mark.parametrize("speed", [0.25, 0.5, 0.75, 0.9, 1.1, 1.5, 2.0])
def test_the_pitch_and_the_loudness_stay(speed: float) -> None:
    times = np.arange(8 * RATE_HZ) / RATE_HZ
    tone = np.round(12000 * (np.sin(2 * np.pi * 233.0 * times) + 0.4 * np.sin(2 * np.pi * 699.0 * times)))
    reader = Reader(Mix([MixTrack([AudioSegment(0, tone.astype(np.int16))])]), 0.5, speed)
    block = read_all(reader, 3.0)[0][RATE_HZ // 2 :, 0]
    spectrum = np.abs(np.fft.rfft(block * np.hanning(len(block)))) ** 2
    frequencies = np.fft.rfftfreq(len(block), 1 / RATE_HZ)
    assert frequencies[spectrum.argmax()] == pytest.approx(233.0, abs=1.0)
    near = (np.abs(frequencies - 233.0) < 6) | (np.abs(frequencies - 699.0) < 6)
    purity_db = 10 * np.log10(spectrum[near].sum() / spectrum[~near].sum())
    assert purity_db > 30.0
    assert np.sqrt((block**2).mean()) == pytest.approx(np.sqrt((tone**2).mean()) / 32768, rel=0.05)


@pytest.mark.parametrize("speed", [0.25, 0.5, 0.8, 1.25, 2.0])
def test_a_click_sounds_at_the_reported_moment(speed: float) -> None:
    click = np.zeros(6 * RATE_HZ, np.int16)
    times = np.arange(2400) / RATE_HZ
    click[2 * RATE_HZ : 2 * RATE_HZ + 2400] = 20000 * np.sin(2 * np.pi * 880 * times) * np.exp(-times / 0.01)
    block, marks = read_all(Reader(Mix([MixTrack([AudioSegment(0, click)])]), 1.0, speed), 1.5 / speed)
    loudest = int(np.abs(block[:, 0]).argmax())
    print(f"speed {speed}: {1000 * (said_s(marks, loudest) - 2.0):+.1f} ms")
    assert said_s(marks, loudest) == pytest.approx(2.0, abs=0.02)


def test_another_speed_and_another_place_in_mid_play() -> None:
    reader = Reader(MIX, 1.0)
    _, marks = reader.read(RATE_HZ)
    reader.set_speed(0.5)
    block, more = read_all(reader, 1.0)
    marks += more
    assert said_s(marks, RATE_HZ) == pytest.approx(2.0, abs=1e-3)
    assert said_s(marks, 2 * RATE_HZ - 1) == pytest.approx(2.5, abs=0.03)
    reader.seek(7.0)
    block, more = reader.read(4000)
    marks += more
    assert said_s(marks, 2 * RATE_HZ) == pytest.approx(7.0, abs=1e-3)
    reader.set_speed(1.0)
    block, more = reader.read(4000)
    assert times_s(block)[-1] == pytest.approx(7.0 + (2000 + 4000) / RATE_HZ, abs=0.04)


def test_silence_walks_the_same_way() -> None:
    for speed in (1.0, 0.5, 2.0):
        silent = Reader(MIX, 2.5, speed, loop_s=(2.0, 3.0), silent=True)
        block, marks = read_all(silent, 2.0)
        assert not block.any()
        expected = 2.0 + (0.5 + 1.7 * speed) % 1.0
        assert said_s(marks, round(1.7 * RATE_HZ)) == pytest.approx(expected, abs=0.035 * speed)


def test_a_new_mix_sounds_from_the_next_sample_on() -> None:
    reader = Reader(Mix(), 0.0)
    assert not reader.read(1000)[0].any()
    reader.mix = MIX
    assert times_s(reader.read(48000)[0])[-1] == pytest.approx(49000 / RATE_HZ, abs=2e-3)
