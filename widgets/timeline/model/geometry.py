"""Layout of lanes: rows for overlapping spans, visible spans, curves by column; without drawing."""

from __future__ import annotations

from heapq import heappop, heappush

import numpy as np

from app.arrays import FloatArray, IntArray


def packed_rows(start: FloatArray, end: FloatArray) -> IntArray:
    """Return the lowest free row for every span, without overlaps; spans may touch.

    Parameters
    ----------
    start, end : array (N,)
        Start and end of each span; starts ascend.
    """
    rows = np.zeros(len(start), np.int64)
    busy: list[tuple[float, int]] = []
    free: list[int] = []
    count = 0
    for index, (begin, finish) in enumerate(zip(start.tolist(), end.tolist(), strict=True)):
        while busy and busy[0][0] <= begin:
            heappush(free, heappop(busy)[1])
        if free:
            row = heappop(free)
        else:
            row, count = count, count + 1
        rows[index] = row
        heappush(busy, (finish, row))
    return rows


class TimeSpans:
    """Time spans, searchable by visible range.

    Parameters
    ----------
    start_s, end_s : array (N,)
        Start and end of each span; starts ascend, ends are in any order.
    """

    def __init__(self, start_s: FloatArray, end_s: FloatArray) -> None:
        self.start_s, self.end_s = start_s, end_s
        self._furthest_s = np.maximum.accumulate(end_s) if len(end_s) else end_s

    def between(self, start_s: float, end_s: float) -> IntArray:
        """Return the ascending indices (K,) of the spans that overlap the range from ``start_s`` to ``end_s``."""
        first = int(np.searchsorted(self._furthest_s, start_s, side="left"))
        last = int(np.searchsorted(self.start_s, end_s, side="right"))
        return first + np.flatnonzero(self.end_s[first:last] >= start_s)


class StepCurve:
    """A step function: every value holds until the next time; no value before the first.

    Parameters
    ----------
    time_s : array (N,)
        Ascending times at which the value changes.
    value : array (N,)
        Value from each time on.
    """

    def __init__(self, time_s: FloatArray, value: FloatArray) -> None:
        self.time_s, self.value = time_s, value

    def columns(self, start_s: float, end_s: float, width_px: int) -> tuple[FloatArray, FloatArray]:
        """Return the least and the greatest value (width_px,) in every column of pixels; NaN if there is none.

        At most two values per column remain to be drawn.
        """
        low = np.full(width_px, np.nan)
        high = np.full(width_px, np.nan)
        if not len(self.time_s) or width_px <= 0:
            return low, high
        edges = np.linspace(start_s, end_s, width_px + 1)
        first = np.searchsorted(self.time_s, edges[:-1], side="right") - 1
        last = np.searchsorted(self.time_s, edges[1:], side="left")
        inside = last > 0
        first, last = np.maximum(first[inside], 0), last[inside]
        last = np.maximum(last, first + 1)
        if not len(first):
            return low, high
        begin = int(first[0])
        # reduceat takes pairs of indices and accepts no end equal to the length of the array, hence the padding.
        part = np.append(self.value[begin : int(last[-1])], self.value[int(last[-1]) - 1])
        pairs = np.empty(2 * len(first), np.int64)
        pairs[0::2], pairs[1::2] = first - begin, last - begin
        low[inside] = np.minimum.reduceat(part, pairs)[0::2]
        high[inside] = np.maximum.reduceat(part, pairs)[0::2]
        return low, high

    def at(self, time_s: float) -> float | None:
        """Return the value in effect at a time."""
        index = int(np.searchsorted(self.time_s, time_s, side="right")) - 1
        return float(self.value[index]) if index >= 0 else None


def step_path(low: FloatArray, high: FloatArray) -> FloatArray:
    """Return points (M, 2) of column and value to connect as the outline of a step curve: each column continues from
    the nearer end of the previous one. NaN interrupts the line at columns without values.
    """
    count = len(low)
    points = np.empty((2 * count, 2))
    points[0::2, 0] = points[1::2, 0] = np.arange(count)
    middle = (low + high) / 2.0
    before = np.concatenate((middle[:1], middle[:-1]))
    rising = ~(np.abs(before - high) < np.abs(before - low))
    points[0::2, 1] = np.where(rising, low, high)
    points[1::2, 1] = np.where(rising, high, low)
    return points
