"""Sets of time spans that can be queried quickly."""

from __future__ import annotations

import itertools
from bisect import bisect_left, bisect_right
from collections.abc import Iterable


class Spans:
    """Ordered spans of time, prepared for fast queries."""

    def __init__(self, spans: Iterable[tuple[float, float]]) -> None:
        ordered = sorted(spans)
        self._starts_s = [start_s for start_s, _ in ordered]
        self._latest_ends_s = list(itertools.accumulate((end_s for _, end_s in ordered), max))

    def hold(self, start_s: float, end_s: float) -> bool:
        """Return whether a single one of the spans contains all of ``start_s``..``end_s``."""
        begun = bisect_right(self._starts_s, start_s)
        return begun > 0 and self._latest_ends_s[begun - 1] >= end_s

    def meet(self, start_s: float, end_s: float) -> bool:
        """Return whether any of the spans overlaps ``start_s``..``end_s``."""
        begun = bisect_left(self._starts_s, end_s)
        return begun > 0 and self._latest_ends_s[begun - 1] > start_s
