"""Which frames of a performance are wanted."""

from __future__ import annotations

import math
from fractions import Fraction

import msgspec

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
        """Whether the first frame at or after an onset is one of these."""
        frame = math.ceil((onset_s - self.first_frame_s) * self.fps.numerator / self.fps.denominator)
        return 0 <= frame < self.count


def whole_span(frame: TimeFrame, fps: Fraction) -> FrameSpan:
    """All frames of a performance."""
    return cut_span(frame, fps, frame.first_frame_s, frame.end_s)


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
