"""Time from a live player's action to the pose that shows it. Printed, never asserted."""

from __future__ import annotations

import gc
import sys
import time
from collections.abc import Iterator, Sequence

import numpy as np
import pytest

from app.performance.play_along import PlayAlong
from app.score.take import ControllerMapping
from instrument_maps.load import bundled_maps
from tests.bench.performance.large import calibration_s
from tests.support.live import QUARTER, playing_alone

EVENTS = 120
FRAMES_AFTER = 6
"""Number of frames between two onsets at 60 per second: notes of a tenth of a second."""


LONG_S, MINUTE_S = 1200, 60
BREATH_HZ, BEND_HZ, NOTES_HZ = 50, 10, 4


def reported(what: str, spent_s: Sequence[float], unit_s: float) -> None:
    """Print median and 95th percentile with their ratios to the calibration loop."""
    median, most = np.percentile(spent_s, [50, 95])
    print(
        f"\n{what}: {1000 * median:.1f} ms, 95th percentile {1000 * most:.1f} ms;"
        f" {median / unit_s:.2f} and {most / unit_s:.2f} x the calibration loop ({1000 * unit_s:.1f} ms)",
        end="",
    )


@pytest.mark.bench
@pytest.mark.parametrize(
    "instrument_id", ["trumpet_Bb", "trombone_tenor_F_attachment", "flute", "clarinet_Bb", "sax_alto_Eb"]
)
def test_from_event_to_pose(instrument_id: str) -> None:
    limits = bundled_maps()[instrument_id].range
    player = PlayAlong(playing_alone(instrument_id, [(4 * QUARTER, QUARTER, limits.low)]))
    random = np.random.default_rng(1)
    pitch, before, now_s = limits.easy_low, None, 0.0
    durations_s: list[float] = []
    shown: list[float] = []
    unit_s = calibration_s()
    for number in range(EVENTS):
        pitch = int(np.clip(pitch + random.integers(-5, 6), limits.low, limits.high))
        start_s = time.thread_time()
        player.breath(now_s, 0.3 + 0.6 * float(random.random()))
        player.note_on(now_s, pitch)
        if before not in (None, pitch):
            player.note_off(now_s, before)
        player.pose(now_s + 0.004)
        if number > 10:
            durations_s.append(time.thread_time() - start_s)
        before = pitch
        for frame in range(1, FRAMES_AFTER):
            start_s = time.thread_time()
            player.pose(now_s + 0.004 + frame / 60.0)
            if number > 10:
                shown.append(time.thread_time() - start_s)
        now_s += FRAMES_AFTER / 60.0
    reported(f"{instrument_id}, from event to pose", durations_s, unit_s)
    reported(f"{instrument_id}, a pose on the way", shown, unit_s)


def second(number: int, low: int, high: int) -> Iterator[tuple[float, str]]:
    """Yield the messages that a controller sends in one second, each with its time (s) and its bytes in hexadecimal:
    breath, bend, and legato notes."""
    random = np.random.default_rng(number)
    events = [(step / BREATH_HZ, f"b002{value:02x}") for step, value in enumerate(random.integers(0, 128, BREATH_HZ))]
    bends = random.integers(0, 128, (BEND_HZ, 2)).tolist()
    events += [(step / BEND_HZ, f"e0{low_bits:02x}{high_bits:02x}") for step, (low_bits, high_bits) in enumerate(bends)]
    for step, pitch in enumerate(random.integers(low, high + 1, NOTES_HZ).tolist()):
        events += [(step / NOTES_HZ, f"90{pitch:02x}50"), ((step + 0.9) / NOTES_HZ, f"80{pitch:02x}00")]
    yield from sorted(events)


@pytest.mark.bench
@pytest.mark.parametrize("instrument_id", ["clarinet_Bb", "trombone_tenor_F_attachment"])
def test_twenty_minutes(instrument_id: str) -> None:
    """Twenty minutes of playing at full speed: all messages, and the pose after a note every second."""
    limits = bundled_maps()[instrument_id].range
    player = PlayAlong(playing_alone(instrument_id, [(4 * QUARTER, QUARTER, limits.low)]))
    mapping, spent_s, blocks = ControllerMapping(0, "cc2", "pitch_bend"), np.zeros(LONG_S), list[int]()
    for number in range(LONG_S):
        for at_s, raw in second(number, limits.low, limits.high):
            player.receive(number + at_s, raw, mapping)
        start_s = time.thread_time()
        player.note_on(number + 0.99, limits.easy_low + number % 7)
        player.pose(number + 0.994)
        spent_s[number] = time.thread_time() - start_s
        player.all_off(number + 0.995)
        if (number + 1) % (LONG_S // 6) == 0:
            gc.collect()
            blocks.append(sys.getallocatedblocks())
    unit_s = calibration_s()
    reported(
        f"{instrument_id}, from event to pose in the second minute", spent_s[MINUTE_S : 2 * MINUTE_S].tolist(), unit_s
    )
    reported(f"{instrument_id}, from event to pose in the last minute", spent_s[-MINUTE_S:].tolist(), unit_s)
    print(f"\n{instrument_id}: blocks of memory every 200 s: {blocks}", end="")
