"""Lines of bars, beats and the grid in the visible range, with a limited density."""

from __future__ import annotations

from itertools import pairwise

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.project.snap_grid import Grid
from app.score.model import Score

LEAST_BAR_PX = 56.0
"""Least distance between labelled bars."""
LEAST_BEAT_PX = 14.0
LEAST_STEP_PX = 9.0


class Lines(msgspec.Struct, frozen=True):
    """Lines in a visible time range.

    Attributes
    ----------
    bars : tuple of int
        Numbers of the bars that have a line and a label.
    bar_s, beat_s, step_s : float64 array
        Times in seconds of the bar lines, of the beats between them, and of the grid lines between beats.
    """

    bars: tuple[int, ...]
    bar_s: FloatArray
    beat_s: FloatArray
    step_s: FloatArray


class LineCache:
    """Cache of the lines in the visible range, shared by the ruler and all lanes."""

    def __init__(self) -> None:
        self._score: Score | None = None
        self._rest: tuple[Grid, float, float, float] | None = None
        self._lines: Lines | None = None

    def get(self, score: Score, grid: Grid, start_s: float, end_s: float, px_per_s: float) -> Lines:
        """Return the grid lines from `visible_lines`; cached as long as the inputs are the same."""
        rest = (grid, start_s, end_s, px_per_s)
        if self._lines is None or self._score is not score or self._rest != rest:
            self._score, self._rest = score, rest
            self._lines = visible_lines(score, grid, start_s, end_s, px_per_s)
        return self._lines


def visible_lines(score: Score, grid: Grid, start_s: float, end_s: float, px_per_s: float) -> Lines:
    """Return the lines between two times at a zoom.

    Parameters
    ----------
    grid : Grid
        Grid, shown if it is on and there is space for its steps.
    """
    tempo, metre_map = score.tempo_map, score.metre_map
    first = metre_map.bar_of_tick(int(np.floor(tempo.ticks(start_s))))
    last = metre_map.bar_of_tick(int(np.ceil(tempo.ticks(end_s)))) + 1
    every = _bar_step(score, first, last, px_per_s)
    # Counted from bar 1: 1, 5, 9 ...
    bars = np.arange(first - (first - 1) % every, last + 1, every, dtype=np.int64)
    bar_ticks = metre_map.tick_of_bar(bars)
    bar_s = tempo.seconds(bar_ticks)
    beats: list[FloatArray] = []
    steps: list[FloatArray] = []
    if every == 1:
        step = float(grid.quarters * score.ticks_per_quarter)
        spans = zip(bars.tolist(), pairwise(bar_ticks.tolist()), pairwise(bar_s.tolist()), strict=False)
        for bar, (start, end), (from_s, after_s) in spans:
            px_per_tick = (after_s - from_s) * px_per_s / max(end - start, 1)
            beat = metre_map.beat_length(start)
            on_beats = metre_map.beats_of_bar(bar)
            if beat * px_per_tick >= LEAST_BEAT_PX:
                beats.append(on_beats[1:].astype(np.float64))
            if grid.enabled and step < beat and step * px_per_tick >= LEAST_STEP_PX:
                lines = _between(start, end, step)
                steps.append(lines[~np.isin(np.floor(lines + 1e-6), on_beats)])
    return Lines(
        tuple(bars.tolist()),
        bar_s,
        tempo.seconds(np.concatenate(beats or [np.empty(0)])),
        tempo.seconds(np.concatenate(steps or [np.empty(0)])),
    )


def _bar_step(score: Score, first: int, last: int, px_per_s: float) -> int:
    """Return the spacing of labelled bars (1, 2, 4 and so on bars), chosen by the length of visible bars in pixels."""
    start_s, end_s = (score.tempo_map.seconds(float(score.metre_map.tick_of_bar(bar))) for bar in (first, last))
    px = (end_s - start_s) / max(last - first, 1) * px_per_s
    every = 1
    while px * every < LEAST_BAR_PX and every < 4096:
        every *= 2
    return every


def _between(start: int, end: int, step: float) -> FloatArray:
    """Return the ticks (N,) of grid lines between two bar lines, ``step`` ticks apart, without the bar lines."""
    count = int(np.ceil((end - start) / step - 1e-9))
    return start + step * np.arange(1, count, dtype=np.float64)
