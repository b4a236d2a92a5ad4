"""Alignment of a score with a recording by dynamic time warping of their chroma.

Uses dtaidistance, which is far smaller than librosa with numba and LLVM (208 MB).

Frames of silence are inserted every few seconds in both, at the cost of half a wrong chord: material in only one of
them (applause, a cut, a repeat) is matched to these frames instead of being stretched over the other. Pins split both
into sections that are warped separately.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from dtaidistance import dtw

from app.arrays import BoolArray, FloatArray, IntArray
from app.audio.passages import Passage, passages
from app.audio.score_sound import CHROMA_S
from app.score.beat_following import UnmatchedSpan

_MOST_CELLS: Final = 60_000_000
"""Largest matrix of the warping in cells of 8 bytes; longer pieces use coarser frames."""
_EVEN: Final = 0.7
"""Cost of standing still in either sequence in addition to the distance, so that the tempo changes only for a
reason.
"""
_FILLER_S: Final = 2.2
"""Distance in seconds of inserted frames of silence."""
_LEAST_LIKENESS: Final = 0.25
"""Least similarity of matching frames."""
_AROUND_S: Final = 1.5
"""Half the width in seconds over which the warping is smoothed."""
_BREAK_S: Final = 0.5
"""Breaks shorter than this number of seconds are ignored within unmatched sections."""
MISSING_S: Final = 2.0
"""Unmatched sections shorter than this number of seconds are no cut and no repeat."""
_SILENT, _LOUD = 0.15, 0.4
"""Norms of a frame (1 at the typical level): below the first it is silent, above the second it is sounding."""


_NEAR: Final = 80
"""Number of frames at either end whose tempo is continued beyond it."""


@dataclass(frozen=True)
class Pins:
    """Corresponding times in score and recording, in seconds, that the user set; both strictly ascend."""

    score_s: FloatArray
    recording_s: FloatArray

    def inside(self, recording_s: float) -> Pins:
        """Return only those pins that are within a recording of this length in seconds."""
        there = (self.recording_s >= 0.0) & (self.recording_s <= recording_s)
        return Pins(self.score_s[there], self.recording_s[there])

    def within(self, start_s: float, end_s: float) -> Pins:
        """Return only those pins that are in a section of the score, with times relative to the section's start."""
        there = (self.score_s >= start_s) & (self.score_s < end_s)
        return Pins(self.score_s[there] - start_s, self.recording_s[there])


NO_PINS: Final = Pins(np.empty(0), np.empty(0))


@dataclass(frozen=True)
class Jump:
    """A jump of a recording relative to the score, such as an omitted repeat: score and recording seconds at which it
    leaves the score (``from``), and at which it continues (``to``)."""

    from_s: float
    to_s: float
    recording_from_s: float
    recording_to_s: float

    def later(self, score_s: float) -> Jump:
        """Return the jump for a score that has ``score_s`` additional seconds at its beginning."""
        return replace(self, from_s=self.from_s + score_s, to_s=self.to_s + score_s)

    def agrees_with(self, pins: Pins) -> bool:
        """Return whether every pin is before the jump in both score and recording, or after it in both."""
        before = (pins.score_s <= self.from_s) & (pins.recording_s <= self.recording_from_s)
        behind = (pins.score_s >= self.to_s) & (pins.recording_s >= self.recording_to_s)
        return bool((before | behind).all())


@dataclass(frozen=True)
class Warped:
    """An alignment: corresponding seconds (N,) of score and recording, both ascending, and the spans found in only the
    score (``missing``) or only the recording (``added``)."""

    score_s: FloatArray
    recording_s: FloatArray
    missing: tuple[UnmatchedSpan, ...]
    added: tuple[UnmatchedSpan, ...]
    length_s: float
    """Duration of the score in seconds."""

    def later(self, score_s: float, end_s: float) -> Warped:
        """Convert the alignment of a section of the score to one of the whole score. The section begins at ``score_s``,
        the whole score ends at ``end_s``, and everything outside the section counts as missing.
        """
        last_s = score_s + self.length_s
        missing = tuple(UnmatchedSpan(span.start + score_s, span.end + score_s) for span in self.missing)
        outside = [UnmatchedSpan(*span) for span in ((0.0, score_s), (last_s, end_s)) if span[1] - span[0] >= MISSING_S]
        return replace(self, score_s=self.score_s + score_s, missing=(*missing, *outside), length_s=end_s)

    def at(self, score_s: FloatArray) -> FloatArray:
        """Convert seconds of the score to seconds of the recording; outside the alignment the tempo near its ends is
        assumed.
        """
        x, y = self.score_s, self.recording_s
        near = min(_NEAR, len(x) - 1)
        first = (y[near] - y[0]) / (x[near] - x[0])
        last = (y[-1] - y[-1 - near]) / (x[-1] - x[-1 - near])
        inner = np.interp(score_s, x, y)
        before = np.where(score_s < x[0], y[0] + (score_s - x[0]) * first, inner)
        result: FloatArray = np.where(score_s > x[-1], y[-1] + (score_s - x[-1]) * last, before)
        return result


def dynamic_time_warping(
    score: FloatArray, recording: FloatArray, pins: Pins = NO_PINS, jumps: Sequence[Jump] = ()
) -> Warped:
    """Align a score with a recording by dynamic time warping.

    Parameters
    ----------
    score, recording : (12, n) float64
        Chroma of both, normalised by `app.audio.score_sound.shape`, a frame every `CHROMA_S`.
    jumps : sequence of Jump
        Jumps in order, in agreement with the pins.
    """
    pool = int(np.ceil(np.sqrt(max(score.shape[1] * recording.shape[1] / _MOST_CELLS, 1.0))))
    frame_s, length_s = pool * CHROMA_S, score.shape[1] * CHROMA_S
    ours, theirs = _pooled(score, pool), _pooled(recording, pool)
    one, other = _path(ours, theirs, max(round(_FILLER_S / frame_s), 1), _stretches(ours, theirs, pins, jumps, frame_s))
    missing = _runs(_alone(ours, one[_sounding(theirs, _SILENT)[other]]), frame_s)
    added = _runs(_alone(theirs, other[_sounding(ours, _SILENT)[one]]), frame_s)
    alike = (ours[one] * theirs[other]).sum(axis=1) > _LEAST_LIKENESS
    one, other = one[alike], other[alike]
    frames, places = np.unique(one, return_inverse=True)
    middle = np.bincount(places, other) / np.maximum(np.bincount(places), 1)
    # An isolated match among frames that do not match is chance.
    reach = round(2.0 / frame_s)
    kept = np.searchsorted(frames, frames + reach) - np.searchsorted(frames, frames - reach) > reach
    score_s, recording_s = (frames[kept] + 0.5) * frame_s, (middle[kept] + 0.5) * frame_s
    if len(score_s) < 2:
        return Warped(score_s, recording_s, (), (), length_s)
    inside = tuple(span for span in added if recording_s[0] < span.start and span.end < recording_s[-1])
    # Smoothing never crosses a jump, nor a pin, where the warping may be discontinuous.
    ends_s = np.sort(np.concatenate((pins.score_s, [jump.from_s for jump in jumps])))
    stretches = np.split(np.arange(len(score_s)), np.searchsorted(score_s, ends_s))
    recording_s = np.concatenate([_smoothed(score_s[stretch], recording_s[stretch]) for stretch in stretches])
    return Warped(*_through(pins, score_s, recording_s), missing, inside, length_s)


def played_passages(score: FloatArray, recording: FloatArray) -> tuple[Passage, ...]:
    """Find the passages of a score that a recording plays; arguments as of `dynamic_time_warping`."""
    pool = int(np.ceil(np.sqrt(max(score.shape[1] * recording.shape[1] / _MOST_CELLS, 1.0))))
    return passages(_pooled(score, pool), _pooled(recording, pool), pool * CHROMA_S)


def _stretches(
    ours: FloatArray, theirs: FloatArray, pins: Pins, jumps: Sequence[Jump], frame_s: float
) -> list[tuple[int, int, int, int]]:
    """Divide both chroma sequences at pins and jumps: for each section the first and last frame of ``ours`` and of
    ``theirs``.
    """
    cuts = [(at, at, there, there) for at, there in zip(pins.score_s, pins.recording_s, strict=True)]
    cuts += [(jump.from_s, jump.to_s, jump.recording_from_s, jump.recording_to_s) for jump in jumps]
    found, begin, begin_theirs = list[tuple[int, int, int, int]](), 0, 0
    for cut in sorted(cuts):
        end, following, end_theirs, following_theirs = (round(second / frame_s) for second in cut)
        if begin < end and following < len(ours) and begin_theirs < end_theirs and following_theirs < len(theirs):
            found.append((begin, end, begin_theirs, end_theirs))
            begin, begin_theirs = following, following_theirs
    return [*found, (begin, len(ours), begin_theirs, len(theirs))]


def _path(
    ours: FloatArray, theirs: FloatArray, step: int, stretches: Sequence[tuple[int, int, int, int]]
) -> tuple[IntArray, IntArray]:
    """Return the corresponding frames (N,) of both chroma sequences by dynamic time warping, separately for each
    stretch (first and last frame of ours, first and last of theirs)."""
    found = []
    for first, last, first_theirs, last_theirs in stretches:
        filled, our_frame = _with_fillers(ours[first:last], step)
        filled_theirs, their_frame = _with_fillers(theirs[first_theirs:last_theirs], step)
        path = np.array(dtw.warping_path_fast(filled, filled_theirs, use_ndim=True, penalty=_EVEN))
        one, other = our_frame[path[:, 0]], their_frame[path[:, 1]]
        both = (one >= 0) & (other >= 0)
        found.append((one[both] + first, other[both] + first_theirs))
    one, other = zip(*found, strict=True)
    return np.concatenate(one), np.concatenate(other)


def _through(pins: Pins, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Bend the alignment ``x`` (score seconds), ``y`` (recorded seconds) so that it passes exactly through the user's
    pins and still ascends; both (N,).
    """
    if not len(pins.score_s):
        return x, y
    apart = np.abs(x[:, None] - pins.score_s).min(axis=1) > CHROMA_S
    x, y = np.append(x[apart], pins.score_s), np.append(y[apart], pins.recording_s)
    order = np.argsort(x)
    x, y = x[order], y[order]
    low = np.concatenate(([-np.inf], pins.recording_s))[np.searchsorted(pins.score_s, x, side="right")]
    high = np.concatenate((pins.recording_s, [np.inf]))[np.searchsorted(pins.score_s, x, side="left")]
    return x, np.maximum.accumulate(np.clip(y, low, high))


def _sounding(frames: FloatArray, least: float) -> BoolArray:
    """Mask (F,) of the frames of chroma (F, 12) that are louder than ``least``."""
    result: BoolArray = np.linalg.norm(frames, axis=1) > least
    return result


def _alone(frames: FloatArray, matched: IntArray) -> BoolArray:
    """Mask (F,) of the frames of chroma (F, 12) that sound but are not among the ``matched`` frames."""
    alone = _sounding(frames, _LOUD)
    alone[matched] = False
    return alone


def _runs(there: BoolArray, frame_s: float) -> tuple[UnmatchedSpan, ...]:
    """Convert a mask of frames to spans of at least `MISSING_S` seconds, ignoring short interruptions; a frame lasts
    ``frame_s``.
    """
    places = np.flatnonzero(there)
    if not len(places):
        return ()
    breaks = np.flatnonzero(np.diff(places) > _BREAK_S / frame_s)
    starts = places[np.concatenate(([0], breaks + 1))]
    ends = places[np.concatenate((breaks, [len(places) - 1]))] + 1
    return tuple(
        UnmatchedSpan(start * frame_s, end * frame_s)
        for start, end in zip(starts.tolist(), ends.tolist(), strict=True)
        if (end - start) * frame_s >= MISSING_S
    )


def _pooled(shapes: FloatArray, count: int) -> FloatArray:
    """Return the means (n, 12) of chroma (12, F) over groups of ``count`` frames."""
    whole = shapes.shape[1] // count * count
    result: FloatArray = np.ascontiguousarray(shapes[:, :whole].reshape(12, -1, count).mean(axis=2).T)
    return result


def _with_fillers(frames: FloatArray, step: int) -> tuple[FloatArray, IntArray]:
    """Insert a frame of silence before every ``step`` frames and at the end; returns the frames, and the original index
    of each (-1 for inserted ones).
    """
    places = np.append(np.arange(0, len(frames), step), len(frames))
    filled = np.insert(frames, places, 0.0, axis=0)
    return np.ascontiguousarray(filled), np.insert(np.arange(len(frames)), places, -1)


def _smoothed(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return smoothed values (N,) of an ascending curve: at each point the height of a line fitted to the points within
    `_AROUND_S`."""
    result = np.empty_like(y)
    first = np.searchsorted(x, x - _AROUND_S)
    last = np.searchsorted(x, x + _AROUND_S)
    for place in range(len(x)):
        inside = slice(first[place], last[place])
        result[place] = _line_at(x[inside] - x[place], y[inside], 1.0 - ((x[inside] - x[place]) / _AROUND_S) ** 2)
    rising: FloatArray = np.maximum.accumulate(result)
    return rising


def _line_at(x: FloatArray, y: FloatArray, weights: FloatArray) -> float:
    """Fit a straight line to weighted points, and return its value at ``x`` = 0."""
    total = float(weights.sum())
    mean_x, mean_y = float((weights * x).sum()) / total, float((weights * y).sum()) / total
    spread = float((weights * (x - mean_x) ** 2).sum())
    slope = float((weights * (x - mean_x) * (y - mean_y)).sum()) / spread if spread > 1e-9 else 0.0
    return mean_y - slope * mean_x


def along(x: FloatArray, at: FloatArray, by: FloatArray, reach: float) -> FloatArray:
    """Interpolate corrections for the positions ``x`` from the corrections ``by`` given at the ascending positions
    ``at``; they decrease with distance and are 0 beyond ``reach`` or the next given position.
    """
    if not len(at):
        return np.zeros(len(x))
    places, amounts = [float(at[0]) - reach], [0.0]
    for place, amount, following in zip(at.tolist(), by.tolist(), [*at[1:].tolist(), np.inf], strict=True):
        places.append(place)
        amounts.append(amount)
        if following - place > 2 * reach:
            ends = (place + reach, following - reach) if np.isfinite(following) else (place + reach,)
            places += ends
            amounts += [0.0] * len(ends)
    result: FloatArray = np.interp(x, places, amounts)
    return result
