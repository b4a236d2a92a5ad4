"""A synthetic score for fifty players with a hundred thousand notes, and the machine's present speed."""

from __future__ import annotations

import time
from functools import cache

import numpy as np

from app.project.model import Project, project_from_score
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap
from instrument_maps.load import bundled_maps

PLAYERS, NOTES = 50, 2000
QUARTER = 480


def calibration_s() -> float:
    """Return the time (s) that this machine needs at present for a fixed piece of interpreted work."""
    times_s = []
    for _ in range(3):
        start_s = time.perf_counter()
        total = 0
        for number in range(300_000):
            total += number * number % 7
        times_s.append(time.perf_counter() - start_s)
    return min(times_s)


def reported(what: str, seconds: float, unit_s: float) -> None:
    """Print a figure with its ratio to the calibration loop of the same run."""
    print(f"\n{what}: {1000.0 * seconds:.1f} ms, {seconds / unit_s:.2f} x the calibration loop", end="")


@cache
def large_project(players: int = PLAYERS, notes: int = NOTES) -> Project:
    """Runs and rests within the easy range of every instrument in turn; the same in every run."""
    maps = bundled_maps()
    instruments = list(maps.values())
    random = np.random.default_rng(1)
    parts = []
    for number in range(players):
        instrument = instruments[number % len(instruments)]
        low, high = instrument.range.easy_low, instrument.range.easy_high
        tick, pitch, row = 4 * QUARTER, (low + high) // 2, []
        for index in range(notes):
            length = int(random.choice([120, 240, 240, 480, 480, 960]))
            pitch = int(np.clip(pitch + random.integers(-4, 5), low, high))
            row.append(Note(f"{number + 1}:{index + 1}", tick, length, pitch, int(random.integers(50, 110))))
            tick += length + (QUARTER * int(random.integers(1, 16)) if random.random() < 0.05 else 0)
        name = f"Player {number + 1}"
        parts.append(Part(f"{number + 1}.1.1", name, number, 0, number % 16, None, None, instrument.id, tuple(row)))
    return project_from_score(Score("large", QUARTER, TempoMap(QUARTER), parts=tuple(parts)), maps)
