"""Requested frames of a performance."""

from __future__ import annotations

import math
from fractions import Fraction

import msgspec

from app.performance.ensemble import Performance
from app.plan.generate import PREROLL_LEAST_S
from app.plan.model import TimeFrame

_WHOLE = 1e-6
"""A time this near to a frame, in frames, is on it."""


class FrameSpan(msgspec.Struct, frozen=True):
    """Frames ``first`` .. ``first + count - 1`` of the whole performance, whose frame 0 is the time frame's start."""

    fps: Fraction
    first: int
    count: int
    first_frame_s: float

    @property
    def end_s(self) -> float:
        """Time after the last frame."""
        return self.first_frame_s + self.count * self.fps.denominator / self.fps.numerator

    def shows_onset(self, onset_s: float) -> bool:
        """Return whether the first frame at or after an onset is one of these."""
        frame = math.ceil((onset_s - self.first_frame_s) * self.fps.numerator / self.fps.denominator)
        return 0 <= frame < self.count


def whole_span(frame: TimeFrame, fps: Fraction) -> FrameSpan:
    """All frames of a performance."""
    return cut_span(frame, fps, frame.first_frame_s, frame.end_s)


def bars_span(performance: Performance, fps: Fraction, bars: tuple[int, int], preroll_beats: float) -> FrameSpan:
    """The frames of some bars with the pre-roll before them.

    The plan is that of the whole piece, so that a cut shows what the whole would show. With the last bar the
    performance's end belongs to it.

    Parameters
    ----------
    bars : (int, int)
        First and last bar, both included.
    preroll_beats : float
        In felt beats; at least the seconds that every performance starts before its first note.
    """
    frame = performance.time_frame
    score, clock = performance.project.score, performance.piece.clock
    first_tick, end_tick = score.metre_map.tick_of_bar(bars[0]), score.metre_map.tick_of_bar(bars[1] + 1)
    preroll_ticks = preroll_beats * performance.project.metre_map.felt_ticks_at(first_tick)
    first_s = clock.seconds(float(first_tick))
    start_s = min(clock.seconds(first_tick - preroll_ticks), first_s - PREROLL_LEAST_S)
    end_s = frame.end_s if end_tick >= performance.span_ticks[1] else clock.seconds(float(end_tick))
    return cut_span(frame, fps, start_s, end_s)


def cut_span(frame: TimeFrame, fps: Fraction, start_s: float, end_s: float) -> FrameSpan:
    """The frames that show the times from ``start_s`` to before ``end_s``, on the whole performance's own grid.

    Frames of a cut are thus the same frames that a whole export has.
    """
    rate = fps.numerator / fps.denominator
    last = max(1, math.ceil((frame.end_s - frame.first_frame_s) * rate - _WHOLE))
    first = max(0, math.floor((max(start_s, frame.first_frame_s) - frame.first_frame_s) * rate + _WHOLE))
    end = math.ceil((min(end_s, frame.end_s) - frame.first_frame_s) * rate - _WHOLE)
    first = min(first, last - 1)
    count = max(1, min(end, last) - first)
    return FrameSpan(fps, first, count, frame.first_frame_s + first * fps.denominator / fps.numerator)
