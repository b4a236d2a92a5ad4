"""Places of the old score in one that was read again, by the notes that were found again."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable
from fractions import Fraction

import numpy as np

from app.project.limits import LAST_TICK


def place_map(pairs: Iterable[tuple[int, int]], scale: Fraction) -> Callable[[int], int]:
    """Return where a tick of the old score is in the new one: as far from the last note before it that was found again
    as it was, but not beyond the next; before the first one it moves with that."""
    by_tick: dict[int, int] = {}
    for before, after in sorted(pairs):
        by_tick[before] = max(by_tick.get(before, after), after)
    olds = list(by_tick)
    # What one player's notes say may contradict another's by a little: time does not run backwards.
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
