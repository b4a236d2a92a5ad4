"""Times of the beats of a score in a recording of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.errors import Argument, Message
from app.score.metre_map import MetreMap

SURE: Final = 0.5
"""Bars with less confidence are to be checked by ear."""


@dataclass(frozen=True)
class UnmatchedSpan:
    """A span that only one of the two has: ticks of the score, or seconds of the recording."""

    start: float
    end: float


def bars_named(*runs: tuple[int, int]) -> dict[str, Argument]:
    """Runs of bars, first and last one, as arguments of a message: ``bars`` ("3-5, 8"), and how many (``count``)."""
    named = [f"{first}" if first == last else f"{first}-{last}" for first, last in runs]
    return {"bars": ", ".join(named), "count": sum(last - first + 1 for first, last in runs)}


@dataclass(frozen=True)
class RunnerUp:
    """The second likeliest place of a piece in a recording.

    Attributes
    ----------
    later_s : float
        How much later it lies than the likeliest one, in seconds of the recording; negative if earlier.
    confidence : float
        0..1.
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
"""Messages with the second likeliest place; offsets are the less the later the music is in the recording."""


def message_of_place(id: str, arguments: dict[str, Argument], runner_up: RunnerUp | None) -> Message:
    """The message of where a recording lies, with the second likeliest place where there is one.

    Parameters
    ----------
    id : str
        Of the message without it, a key of `_WITH_NEXT`. The other has the arguments ``next_s``, what is added to the
        place to get the other, and ``next_percent``.
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
        The beats, in order.
    recording_s : (N,) float64
        When each sounds in the recording, rising; before 0 or behind the end where it is not in it.
    confidence : (N,) float64
        0..1.
    missing : tuple of UnmatchedSpan
        Ticks of the score that the recording does not have.
    added : tuple of UnmatchedSpan
        Seconds of the recording, between its first and its last note, that the score does not have.
    runner_up : RunnerUp or None
        None where no other place is alike at all.
    """

    ticks: IntArray
    recording_s: FloatArray
    confidence: FloatArray
    missing: tuple[UnmatchedSpan, ...] = ()
    added: tuple[UnmatchedSpan, ...] = ()
    runner_up: RunnerUp | None = None

    @property
    def mean_confidence(self) -> float:
        """Over all beats that the recording has."""
        there = self._there()
        return float(self.confidence[there].mean()) if there.any() else 0.0

    @property
    def share(self) -> float:
        """Share of the beats that the recording has, 0..1."""
        return float(self._there().mean()) if len(self.ticks) else 0.0

    def later(self, seconds: float) -> Following:
        """The result in a recording that begins earlier by an offset."""
        added = tuple(UnmatchedSpan(span.start + seconds, span.end + seconds) for span in self.added)
        return replace(self, recording_s=self.recording_s + seconds, added=added)

    def bars(self, metre_map: MetreMap) -> list[tuple[int, float]]:
        """The bars that the recording has at least in part: number, and mean confidence."""
        there = self._there()
        bars = metre_map.bar_of_tick(self.ticks)
        if len(bars) > 1 and bars[-1] != bars[-2]:
            there[-1] = False  # The bar line after the last bar: no bar begins there.
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
        """Return which beats the recording has."""
        there = np.ones(len(self.ticks), np.bool_)
        for span in self.missing:
            there &= (self.ticks < span.start) | (self.ticks >= span.end)
        return there
