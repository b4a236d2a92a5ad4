"""Times and instruments for which gestures of tables are possible."""

from __future__ import annotations

from bisect import bisect_right
from functools import cache
from itertools import accumulate

import numpy as np

from app.errors import Message
from app.plan.gestures.lowered_instrument import LOWER_S, RAISE_S
from app.plan.music.piece import LineTimes
from app.plan.music.spans import Spans
from instrument_maps.model import InstrumentMap
from metadata.gestures import Gesture


class LoweredSpans:
    """Spans in seconds in which the instrument is off the lips, searchable by time."""

    def __init__(self, spans_s: tuple[tuple[float, float], ...]) -> None:
        self._ordered = sorted(spans_s)
        self._starts_s = [start_s for start_s, _ in self._ordered]
        self._latest_ends_s = list(accumulate((end_s for _, end_s in self._ordered), max))
        self._narrowed = cache(self._less)

    def _less(self, down_s: float, up_s: float) -> Spans:
        return Spans((first_s + down_s, last_s - up_s) for first_s, last_s in self._ordered)

    def hold(self, start_s: float, end_s: float, down_s: float, up_s: float) -> bool:
        """Return whether a span lies within a lowered span, with margins after its start and before its end."""
        return self._narrowed(down_s, up_s).hold(start_s, end_s)

    def end_between(self, start_s: float, end_s: float) -> bool:
        """Return whether the lowered span at ``start_s`` ends before ``end_s``."""
        index = bisect_right(self._starts_s, start_s) - 1
        while index >= 0 and self._latest_ends_s[index] > start_s:
            if start_s < self._ordered[index][1] < end_s:
                return True
            index -= 1
        return False


def may_start(gesture: Gesture, start_s: float, end_s: float, times: LineTimes, lowered: LoweredSpans) -> bool:
    """Return whether a gesture's own condition allows it from ``start_s`` to ``end_s``, for example only while the
    player rests.
    """
    if gesture.may_start == "resting":
        first = int(np.searchsorted(times.played_end_s, start_s, side="right"))
        return first == len(times.onset_s) or float(times.onset_s[first]) >= end_s
    if gesture.may_start == "lowered":
        down_s, up_s = (LOWER_S, RAISE_S) if gesture.needs_lowered else (0.0, 0.0)
        return lowered.hold(start_s, end_s, down_s, up_s)
    return True


def comes_up(start_s: float, end_s: float, lowered: LoweredSpans) -> bool:
    """Return whether the raising of the instrument, which is lowered at ``start_s``, begins before ``end_s``."""
    return lowered.end_between(start_s, end_s + RAISE_S)


def impossible(gesture: Gesture, instrument: InstrumentMap) -> Message | None:
    """Reason why no hand can make a gesture with this instrument; None if it is possible."""
    track, water = gesture.hand, instrument.water
    if track is None:
        return None
    free = instrument.hold.leaving_hand
    if free is None or track.which not in ("free", free):
        return Message("gesture.hand_holds", {"name": gesture.name})
    if any(key.place == "key" for key in track.keys) and (water is None or water.position_m is None):
        return Message("gesture.no_water_key", {"name": gesture.name})
    return None


def belongs(gesture: Gesture, instrument: InstrumentMap) -> bool:
    """Return whether rules may use a gesture for an instrument: it must be possible and, if it drains water, be the one
    named in the instrument's map.
    """
    if gesture.lets_out_water and (instrument.water is None or instrument.water.gesture != gesture.name):
        return False
    return impossible(gesture, instrument) is None
