"""Detects flutter tonguing requested by a sign at a note or by words over the staff."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Sequence
from typing import Final

from app.score.limits import MOST_NAME

_FLUTTER: Final = re.compile(r"flutter|flatter|\bflt?z|frull", re.IGNORECASE)
_ENDS: Final = re.compile(r"\b(?:ord|nat|norm|modo\s+ord)|ohne|senza|普通", re.IGNORECASE)
"""Words that end flutter tonguing."""


def is_flutter(text: str) -> bool:
    """Return whether words over a staff request flutter tonguing."""
    return _FLUTTER.search(text[:MOST_NAME]) is not None and _ENDS.search(text[:MOST_NAME]) is None


def fluttered(words: Sequence[tuple[int, str]], onsets: Sequence[int]) -> list[bool]:
    """Return for each of the ascending onsets whether words request flutter tonguing for it: from the words until other
    words end it, or for the next note alone if none do.

    Parameters
    ----------
    words : sequence of (tick, str)
        Words over the staff, ordered by tick.
    """
    spans: list[tuple[int, int]] = []
    end: int | None = None
    for tick, text in reversed(words):
        if is_flutter(text):
            place = bisect_left(onsets, tick)
            alone = onsets[place] + 1 if place < len(onsets) else tick
            spans.append((tick, alone if end is None else end))
        elif _ENDS.search(text[:MOST_NAME]):
            end = tick
    spans.reverse()
    found, place, until = [], 0, 0
    for onset in onsets:
        while place < len(spans) and spans[place][0] <= onset:
            until = max(until, spans[place][1])
            place += 1
        found.append(onset < until)
    return found
