"""Where the lines of bars, beats and the grid lie in the visible range, no denser than the eye can use."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import msgspec
import numpy as np
import numpy.typing as npt

from app.project.grid import Grid
from app.score.model import Score

Floats = npt.NDArray[np.float64]

LEAST_BAR_PX = 56.0
"""Labelled bars stand at least so far apart."""
LEAST_BEAT_PX = 14.0
LEAST_STEP_PX = 9.0


class Lines(msgspec.Struct, frozen=True):
    """Lines of a visible range.

    Attributes
    ----------
    bars : tuple of int
        Numbers of the bars that get a line and a label.
    bar_s, beat_s, step_s : float64 array
        Times of the lines of bars, of beats between them, and of the grid's steps between those.
    """

    bars: tuple[int, ...]
    bar_s: Floats
    beat_s: Floats
    step_s: Floats


def visible_lines(score: Score, grid: Grid, start_s: float, end_s: float, px_per_s: float) -> Lines:
    """The lines between two times at a zoom.

    Parameters
    ----------
    score : Score
    grid : Grid
        Its steps show where there is room for them and it is on.
    start_s, end_s : float
    px_per_s : float
    """
    tempo = score.tempo_map
    first = score.bar_of_tick(int(np.floor(tempo.ticks(start_s))))
    last = score.bar_of_tick(int(np.ceil(tempo.ticks(end_s)))) + 1
    every = _bar_step(score, first, last, px_per_s)
    # Counted from bar 1: 1, 5, 9 ...
    bars = list(range(first - (first - 1) % every, last + 1, every))
    bar_ticks = [score.tick_of_bar(bar) for bar in bars]
    beats: list[Fraction] = []
    steps: list[Fraction] = []
    if every == 1:
        for start, end in pairwise(bar_ticks):
            seconds = tempo.seconds(float(end)) - tempo.seconds(float(start))
            px_per_tick = seconds * px_per_s / max(end - start, 1)
            beat = Fraction(4 * score.ticks_per_quarter, _denominator(score, start))
            if beat * px_per_tick >= LEAST_BEAT_PX:
                beats.extend(_between(start, end, beat))
            step = grid.quarters * score.ticks_per_quarter
            if grid.enabled and step < beat and step * px_per_tick >= LEAST_STEP_PX:
                steps.extend(_between(start, end, step))
    return Lines(
        tuple(bars),
        tempo.seconds(np.array(bar_ticks, np.float64)),
        tempo.seconds(np.array(beats, np.float64)),
        tempo.seconds(np.array(sorted(set(steps) - set(beats)), np.float64)),
    )


def _bar_step(score: Score, first: int, last: int, px_per_s: float) -> int:
    """Every which bar is labelled: 1, 2, 4 ... by the usual length of the visible bars."""
    tempo = score.tempo_map
    seconds = tempo.seconds(float(score.tick_of_bar(last))) - tempo.seconds(float(score.tick_of_bar(first)))
    px = seconds / max(last - first, 1) * px_per_s
    every = 1
    while px * every < LEAST_BAR_PX and every < 4096:
        every *= 2
    return every


def _denominator(score: Score, tick: int) -> int:
    metre = score.metres[0]
    for candidate in score.metres:
        if candidate.tick > tick:
            break
        metre = candidate
    return metre.denominator


def _between(start: int, end: int, step: Fraction) -> list[Fraction]:
    """The lines strictly inside a bar."""
    count = -((start - end) // step)
    return [start + index * step for index in range(1, int(count))]
