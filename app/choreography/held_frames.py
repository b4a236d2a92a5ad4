"""Repeated frames of a clip, as written by converters to a higher frame rate, evenly (240 for 60) or not (100 for 60).

At an uneven ratio such as 5 : 3, frames last 1 or 2 frames of the file in a pattern that recurs every 5 frames.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final, NamedTuple

import numpy as np

from app.arrays import BoolArray, IntArray

HELD_PART: Final = 0.95
"""Share of all changes that occur only at certain frames if frames are repeated."""
LONGEST_PATTERN: Final = 12
"""Greatest number of frames after which an uneven pattern recurs (25 frames as 60); rarer repetitions may be pauses."""
RARE: Final = 0.2
"""Number of changes at a place of a pattern, relative to that at the most usual one, below which none belongs there."""
TIMES: Final = 4
"""Least number of recurrences of an uneven pattern."""
MOST_PAUSES: Final = 0.4
"""Greatest share of a pattern's frames without a change: pauses. A longer pattern fills half of one it is folded to."""


class HeldFrames(NamedTuple):
    """Mean number of frames for which each frame is held (1 if none is), and the first of each such frame, ascending.

    The last number of `kept` is less than the number of frames.
    """

    length: Fraction
    kept: IntArray


def held_frames(changes: BoolArray) -> HeldFrames:
    """Find the repeated frames of a clip.

    Parameters
    ----------
    changes : (F - 1,) bool
        Whether each frame from the second on differs from the previous one.
    """
    at, frames = np.flatnonzero(changes) + 1, len(changes) + 1
    if len(at) >= 3:
        count = int(np.median(np.diff(at)))
        if count > 1 and (np.diff(at) % count == 0).mean() >= HELD_PART:
            return _kept(frames, count, np.array([np.bincount(at % count).argmax()]))
        for period in range(3, LONGEST_PATTERN + 1):
            places = _pattern(at, period)
            if places is not None:
                return _kept(frames, period, places)
    return HeldFrames(Fraction(1), np.arange(frames))


def _kept(frames: int, period: int, places: IntArray) -> HeldFrames:
    kept = np.flatnonzero(np.isin(np.arange(frames) % period, places))
    # The first frame of a file may have been held before its start.
    kept = kept if len(kept) and kept[0] == 0 else np.concatenate([[0], kept])
    return HeldFrames(Fraction(period, len(places)), kept)


def _pattern(at: IntArray, period: int) -> IntArray | None:
    """Return the places within a period, ascending, at which frames ``at`` of changes occur, if they are as even as
    whole frames allow; None if they are not, or if changes occur everywhere.
    """
    counts = np.bincount(at % period, minlength=period)
    places = np.flatnonzero(counts > RARE * counts.max())
    number = len(places)
    if not 1 < number < period or counts.max() < TIMES or counts[places].sum() < HELD_PART * len(at):
        return None
    if np.ptp(number * places - period * np.arange(number)) >= number:
        return None
    possible = (at[-1] - at[0]) * number / period
    return places if len(at) >= (1.0 - MOST_PAUSES) * possible else None
