"""Conversion of ticks of the old score to those of a re-read one by matched notes."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable
from fractions import Fraction

import numpy as np

from app.project.limits import LAST_TICK


def place_map(pairs: Iterable[tuple[int, int]], scale: Fraction) -> Callable[[int], int]:
    """Return a function from old to new ticks, by pairs of old and new tick of matched notes.

    The distance from the previous matched note is kept, but not beyond the next one; ticks before the first matched
    note move with it.
    """
    by_tick: dict[int, int] = {}
    for before, after in sorted(pairs):
        by_tick[before] = max(by_tick.get(before, after), after)
    olds = list(by_tick)
    # Notes of different players may contradict each other slightly, but time must not run backwards.
    news = np.maximum.accumulate(np.array(list(by_tick.values()), np.int64)).tolist() if olds else []

    def place(tick: int) -> int:
        if not olds:
            return _held(round(tick * scale))
        index = max(bisect_right(olds, tick) - 1, 0)
        to = news[index] + round((tick - olds[index]) * scale)
        if index + 1 < len(news) and tick >= olds[index]:
            to = min(to, news[index + 1])
        return _held(to)

    return place


def _held(tick: int) -> int:
    return min(max(tick, -LAST_TICK), LAST_TICK)
