"""How long it takes from what a player does to the pose that shows it. Printed, never asserted."""

from __future__ import annotations

import time

import numpy as np
import pytest

from app.performance.play_along import PlayAlong
from instrument_maps.load import bundled_maps
from tests.bench.performance.large import calibration_s
from tests.support.live import QUARTER, playing_alone

EVENTS = 250
FRAMES_AFTER = 6
"""Frames between two onsets, at 60 a second: notes of a tenth of a second."""


def told(what: str, spent_s: list[float], unit_s: float) -> None:
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
    heard: list[float] = []
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
            heard.append(time.thread_time() - start_s)
        before = pitch
        for frame in range(1, FRAMES_AFTER):
            start_s = time.thread_time()
            player.pose(now_s + 0.004 + frame / 60.0)
            if number > 10:
                shown.append(time.thread_time() - start_s)
        now_s += FRAMES_AFTER / 60.0
    told(f"{instrument_id}, from event to pose", heard, unit_s)
    told(f"{instrument_id}, a pose on the way", shown, unit_s)
