"""Times of the beats of a score in a recording of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.errors import Argument, Message
from app.score.metre_map import MetreMap

SURE: Final = 0.5
"""Confidence below which bars must be checked by ear."""


@dataclass(frozen=True)
class UnmatchedSpan:
    """A span that exists only in the score (in ticks) or only in the recording (in seconds)."""

    start: float
    end: float


def bars_named(*runs: tuple[int, int]) -> dict[str, Argument]:
    """Convert ranges of bars (first, last) to arguments of a message: ``bars``, such as "3-5, 8", and ``count``, the
    total number of bars.
    """
    named = [f"{first}" if first == last else f"{first}-{last}" for first, last in runs]
    return {"bars": ", ".join(named), "count": sum(last - first + 1 for first, last in runs)}


@dataclass(frozen=True)
class RunnerUp:
    """The second likeliest place of a piece in a recording.

    Attributes
    ----------
    later_s : float
        Seconds of the recording by which it is later than the likeliest place; negative if earlier.
    confidence : float
        Confidence that the piece is there, 0..1.
    """

    later_s: float
    confidence: float


_WITH_NEXT: Final = {
    "audio.followed": ("audio.followed_with_next", 1.0),
    "audio.followed_but": ("audio.followed_but_with_next", 1.0),
    "audio.offset_found": ("audio.offset_found_with_next", -1.0),
    "audio.other_tempo": ("audio.other_tempo_with_next", -1.0),
    "audio.tempo_fitted": ("audio.tempo_fitted_with_next", -1.0),
    "video.offset_found": ("video.offset_found_with_next", -1.0),
}
"""Messages that also name the second most likely position, with the weight of its confidence; offsets count less the
later the music begins in the recording.
"""


def message_of_place(id: str, arguments: dict[str, Argument], runner_up: RunnerUp | None) -> Message:
    """Create the message about the position found for a recording in the piece, with the second likeliest position if
    there is one.

    Parameters
    ----------
    id : str
        Message id without a second position, a key of `_WITH_NEXT`. The message with one also has the arguments
        ``next_s``, the distance to the second position, and ``next_percent``.
    """
    if runner_up is None:
        return Message(id, arguments)
    with_next, sign = _WITH_NEXT[id]
    more: dict[str, Argument] = {"next_s": sign * runner_up.later_s, "next_percent": round(100 * runner_up.confidence)}
    return Message(with_next, {**arguments, **more})


@dataclass(frozen=True)
class Following:
    """Alignment of a recording with a score.

    Attributes
    ----------
    ticks : (N,) int64
        Ticks of the score's beats, in order.
    recording_s : (N,) float64
        Time at which each beat sounds in the recording, rising; below 0 or past the end where the recording lacks it.
    confidence : (N,) float64
        Confidence in the time of each beat, 0..1.
    missing : tuple of UnmatchedSpan
        Ticks of the score that are missing in the recording.
    added : tuple of UnmatchedSpan
        Seconds of the recording, between its first and last note, that are not in the score.
    runner_up : RunnerUp or None
        Second likeliest place; None if no other place is similar.
    """

    ticks: IntArray
    recording_s: FloatArray
    confidence: FloatArray
    missing: tuple[UnmatchedSpan, ...] = ()
    added: tuple[UnmatchedSpan, ...] = ()
    runner_up: RunnerUp | None = None

    @property
    def mean_confidence(self) -> float:
        """Mean confidence over all beats that the recording contains; 0 if it contains none."""
        there = self._there()
        return float(self.confidence[there].mean()) if there.any() else 0.0

    @property
    def share(self) -> float:
        """Share of the score's beats that the recording contains, 0..1."""
        return float(self._there().mean()) if len(self.ticks) else 0.0

    def later(self, seconds: float) -> Following:
        """Return the alignment for the same recording with additional seconds before its start."""
        added = tuple(UnmatchedSpan(span.start + seconds, span.end + seconds) for span in self.added)
        return replace(self, recording_s=self.recording_s + seconds, added=added)

    def bars(self, metre_map: MetreMap) -> list[tuple[int, float]]:
        """The bars that the recording contains at least in part: bar number and mean confidence."""
        there = self._there()
        bars = metre_map.bar_of_tick(self.ticks)
        if len(bars) > 1 and bars[-1] != bars[-2]:
            there[-1] = False  # the bar line after the last bar begins no bar
        bars = bars[there]
        numbers, places = np.unique(bars, return_inverse=True)
        means = np.bincount(places, self.confidence[there]) / np.maximum(np.bincount(places), 1)
        return list(zip(numbers.tolist(), means.tolist(), strict=True))

    def doubtful_bars(self, metre_map: MetreMap) -> list[tuple[int, int, int]]:
        """Runs of bars whose confidence is below `SURE`: first and last bar, and the mean confidence in per cent."""
        runs: list[list[tuple[int, float]]] = []
        before = None
        for place, (number, mean) in enumerate(self.bars(metre_map)):
            if mean < SURE:
                if before != place - 1:
                    runs.append([])
                runs[-1].append((number, mean))
                before = place
        return [(run[0][0], run[-1][0], round(100 * sum(mean for _, mean in run) / len(run))) for run in runs]

    def _there(self) -> BoolArray:
        """Return a mask (N,) of the beats that the recording contains."""
        there = np.ones(len(self.ticks), np.bool_)
        for span in self.missing:
            there &= (self.ticks < span.start) | (self.ticks >= span.end)
        return there
