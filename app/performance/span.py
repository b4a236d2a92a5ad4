"""Spans of a performance in frames, such as the bars that an export writes."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TypeAlias

import msgspec

from app.performance.ensemble import Performance
from app.plan.model import TimeFrame

BarRange: TypeAlias = tuple[int | None, int | None]
"""First and last bar, both included; None: from the performance's start, to its end."""

_WHOLE = 1e-6
"""Distance in frames within which a time counts as being on a frame."""


class FrameSpan(msgspec.Struct, frozen=True):
    """A span of frames, ``first`` .. ``first + count - 1`` of the whole performance, whose frame 0 is the start of its
    time frame."""

    fps: Fraction
    first: int
    count: int
    first_frame_s: float

    @property
    def end_s(self) -> float:
        """Time in seconds at which the last frame of the span ends."""
        return self.first_frame_s + self.count * self.fps.denominator / self.fps.numerator

    def shows_onset(self, onset_s: float) -> bool:
        """Return whether the first frame at or after an onset is within the span."""
        frame = math.ceil((onset_s - self.first_frame_s) * self.fps.numerator / self.fps.denominator)
        return 0 <= frame < self.count


def whole_span(frame: TimeFrame, fps: Fraction) -> FrameSpan:
    """Return the span of all frames of a performance at a frame rate."""
    return cut_span(frame, fps, frame.first_frame_s, frame.end_s)


def bars_span(performance: Performance, fps: Fraction, bars: BarRange, lead_in_beats: float = 0.0) -> FrameSpan:
    """Return the frames of some bars.

    Planning always covers the whole piece, so a cut has equal motion. A bar begins at the nearest frame of the whole
    performance, so consecutive cuts join without missing or repeated frames.

    Parameters
    ----------
    bars : (int or None, int or None)
        First and last bar; see `BarRange`.
    lead_in_beats : float
        Felt beats to include before the first bar, at most to the performance's start.
    """
    first_bar, last_bar = bars
    frame, clock, metres = performance.time_frame, performance.piece.clock, performance.project.score.metre_map
    start_s, end_s = frame.first_frame_s, frame.end_s
    if first_bar is not None:
        start_s = led_into_s(performance, metres.tick_of_bar(first_bar), lead_in_beats)
    if last_bar is not None:
        end_s = clock.seconds(float(metres.tick_of_bar(last_bar + 1)))
    rate = fps.numerator / fps.denominator
    last = whole_span(frame, fps).count
    first, end = (min(max(round((at_s - frame.first_frame_s) * rate), 0), last) for at_s in (start_s, end_s))
    return _frames_from(frame, fps, min(first, last - 1), last if last_bar is None else end)


def led_into_s(performance: Performance, tick: float, beats: float) -> float:
    """Time in seconds at which a lead-in of ``beats`` felt beats before a tick begins."""
    return performance.piece.clock.seconds(tick - beats * performance.project.metre_map.felt_ticks_at(tick))


def cut_span(frame: TimeFrame, fps: Fraction, start_s: float, end_s: float) -> FrameSpan:
    """The frames of the whole performance from ``start_s`` to before ``end_s``.

    They are equal to the frames of a whole export.
    """
    rate = fps.numerator / fps.denominator
    last = max(1, math.ceil((frame.end_s - frame.first_frame_s) * rate - _WHOLE))
    first = max(0, math.floor((max(start_s, frame.first_frame_s) - frame.first_frame_s) * rate + _WHOLE))
    end = math.ceil((min(end_s, frame.end_s) - frame.first_frame_s) * rate - _WHOLE)
    return _frames_from(frame, fps, min(first, last - 1), min(end, last))


def _frames_from(frame: TimeFrame, fps: Fraction, first: int, end: int) -> FrameSpan:
    """Return the span of the frames ``first`` .. ``end - 1``, extended to at least one frame."""
    return FrameSpan(fps, first, max(1, end - first), frame.first_frame_s + first * fps.denominator / fps.numerator)
