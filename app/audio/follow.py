"""When every beat of a score sounds in a recording of it that keeps its own time.

Three steps, each finer: dynamic time warping of the chroma of both (dtaidistance, which is far smaller than librosa:
that needs numba and LLVM, 208 MB); then the onsets of the score, chord by chord, are put on those of the recording so
that the tempo between them stays as even as the onsets allow; then beats are read off, smoothed over their neighbours,
as musicians play.

Every few seconds of both stands a frame of silence, which costs as much as half a wrong chord: what only one of the two
has (applause, a cut, a repeat) is put there instead of being stretched over the other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from dtaidistance import dtw

from app.audio.score_sound import (
    CHROMA_S,
    EARLY_S,
    ONSET_S,
    ExpectedSound,
    Floats,
    RecordedSound,
    confidence_of,
    expected_sound,
    onset_edges,
    recorded_sound,
    score_chroma,
)
from app.audio.track import Samples
from app.errors import AppError, Cancelled
from app.score.following import Following, Span
from app.score.metre_map import MetreMap
from app.score.model import Score

Integers: TypeAlias = npt.NDArray[np.int64]

_MOST_CELLS: Final = 60_000_000
"""Of the matrix of the warping, 8 bytes each: longer ones are warped with coarser frames."""
_EVEN: Final = 0.7
"""What it costs to stand still in one of the two, beside the distance: the tempo changes where something says so."""
_FILLER_S: Final = 2.2
"""From one frame of silence to the next."""
_LEAST_LIKENESS: Final = 0.25
"""Frames less alike than this are no match."""
_AROUND_S: Final = 1.5
"""Half the width over which the warping is smoothed."""
_ROUNDS: Final = ((0.1, 0.4, 0.01, 100.0), (0.03, 0.12, 0.004, 60.0))
"""Of the onsets: width of an onset's edge, reach and step of their shifts in seconds, cost of an uneven tempo."""
_LEAST_GAP_S: Final = 0.02
"""Beats lie so far apart at least."""
_NEIGHBOURS_BEATS: Final = 1.0
"""A beat is read off the onsets this far on both sides."""
_MISSING_S: Final = 2.0
"""Shorter stretches that only one of the two has are no cut and no repeat."""
_BREAK_S: Final = 0.5
"""Shorter breaks within such a stretch are part of it."""
_SILENT, _LOUD = 0.15, 0.4
"""Size of a frame's shape, 1 at the typical level: below the one nothing sounds, above the other something does."""
_LOCAL_S: Final = 2.5
"""Half the width over which a beat's confidence is measured."""
_EVEN_BEATS: Final = 4
_USUAL_UNEVEN: Final = 0.4
"""Natural logarithm of the tempo against that of the whole, over so many beats: 1.5 times as fast or slow."""
_SQUEEZED: Final = -0.6
"""The same where beats have little more than half their time: the recording leaves them out."""
RECOGNISED: Final = 0.3
"""Mean confidence below which it is rather a recording of another piece."""


def beats_of(metre_map: MetreMap, end_tick: int) -> Integers:
    """The felt beats of a piece, the first at tick 0."""
    ticks = metre_map.felt_between(0, max(end_tick, 1))
    return np.concatenate(([0], ticks[ticks > 0]))


def follow(
    samples: Samples,
    rate_hz: int,
    score: Score,
    beat_ticks: Integers,
    progress: Callable[[float], None] = lambda share: None,
    stop_requested: Callable[[], bool] = lambda: False,
) -> Following:
    """Find when every beat of a score sounds in a recording.

    Parameters
    ----------
    samples : int16 array, shape (n, channels)
    beat_ticks : (N,) int64
        Rising; the beats to be found, N at least 2.
    progress : callable
        Called with the share 0..1 that is done.
    stop_requested : callable
        Asked now and then; true ends the work.

    Raises
    ------
    AppError
        ``audio.nothing_to_compare``: the recording is silent, or the score has no notes;
        ``audio.not_followed`` (percent): it is rather a recording of another piece.
    Cancelled
    """

    def reached(share: float) -> None:
        if stop_requested():
            raise Cancelled("work.stopped")
        progress(share)

    expected = expected_sound(score)
    if not len(samples) or not samples.any() or not len(expected.onset_s):
        raise AppError("audio.nothing_to_compare")
    reached(0.0)
    recorded = recorded_sound(samples, rate_hz, lambda share: reached(0.6 * share))
    shapes = score_chroma(expected, 1.0)
    warped = _warped(shapes, recorded.chroma)
    if len(warped.score_s) < 2:
        raise AppError("audio.not_followed", percent=0)
    reached(0.8)
    times, found = _on_onsets(expected, recorded, warped, lambda share: reached(0.8 + 0.15 * share))
    beat_s = score.tempo_map.seconds(beat_ticks.astype(np.float64))
    recording_s = _beats(beat_s, times, found, warped)
    likely = _confidence(beat_s, recording_s, shapes, recorded, times, found)
    squeezed = _squeezed(beat_s, _lengths(beat_s, recording_s))
    missing = tuple(_ticks(score, span) for span in _joined((*warped.missing, *squeezed)))
    result = Following(beat_ticks, recording_s + EARLY_S, likely, missing, warped.added)
    if result.mean_confidence < RECOGNISED:
        raise AppError("audio.not_followed", percent=round(100 * result.mean_confidence))
    reached(1.0)
    return result


@dataclass(frozen=True)
class _Warped:
    """Seconds of the score and of the recording that belong together, both rising; what only one has, in seconds."""

    score_s: Floats
    recording_s: Floats
    missing: tuple[Span, ...]
    added: tuple[Span, ...]

    def at(self, score_s: Floats) -> Floats:
        """Seconds of the recording at seconds of the score; beyond the ends at the tempo found near them."""
        x, y = self.score_s, self.recording_s
        near = min(80, len(x) - 1)
        first = (y[near] - y[0]) / (x[near] - x[0])
        last = (y[-1] - y[-1 - near]) / (x[-1] - x[-1 - near])
        inner = np.interp(score_s, x, y)
        before = np.where(score_s < x[0], y[0] + (score_s - x[0]) * first, inner)
        result: Floats = np.where(score_s > x[-1], y[-1] + (score_s - x[-1]) * last, before)
        return result


def _warped(score: Floats, recording: Floats) -> _Warped:
    """Which frames belong together, by dynamic time warping.

    Parameters
    ----------
    score, recording : (12, n) float64
        Chroma as shapes, a frame every `CHROMA_S`.
    """
    pool = int(np.ceil(np.sqrt(max(score.shape[1] * recording.shape[1] / _MOST_CELLS, 1.0))))
    frame_s = pool * CHROMA_S
    ours, theirs = _pooled(score, pool), _pooled(recording, pool)
    step = max(round(_FILLER_S / frame_s), 1)
    filled, our_frame = _with_fillers(ours, step)
    filled_theirs, their_frame = _with_fillers(theirs, step)
    path = np.array(dtw.warping_path_fast(filled, filled_theirs, use_ndim=True, penalty=_EVEN))
    one, other = our_frame[path[:, 0]], their_frame[path[:, 1]]
    both = (one >= 0) & (other >= 0)
    one, other = one[both], other[both]
    missing = _runs(_alone(ours, one[_sounding(theirs, _SILENT)[other]]), frame_s)
    added = _runs(_alone(theirs, other[_sounding(ours, _SILENT)[one]]), frame_s)
    alike = (ours[one] * theirs[other]).sum(axis=1) > _LEAST_LIKENESS
    one, other = one[alike], other[alike]
    frames, places = np.unique(one, return_inverse=True)
    middle = np.bincount(places, other) / np.maximum(np.bincount(places), 1)
    # A match alone among others that are none is chance.
    reach = round(2.0 / frame_s)
    kept = np.searchsorted(frames, frames + reach) - np.searchsorted(frames, frames - reach) > reach
    score_s, recording_s = (frames[kept] + 0.5) * frame_s, (middle[kept] + 0.5) * frame_s
    if len(score_s) < 2:
        return _Warped(score_s, recording_s, (), ())
    inside = tuple(span for span in added if recording_s[0] < span.start and span.end < recording_s[-1])
    return _Warped(score_s, _smoothed(score_s, recording_s), missing, inside)


def _sounding(frames: Floats, least: float) -> npt.NDArray[np.bool_]:
    """Which frames are more than near silence."""
    result: npt.NDArray[np.bool_] = np.linalg.norm(frames, axis=1) > least
    return result


def _alone(frames: Floats, matched: Integers) -> npt.NDArray[np.bool_]:
    """Which frames sound without one of the other."""
    alone = _sounding(frames, _LOUD)
    alone[matched] = False
    return alone


def _runs(there: npt.NDArray[np.bool_], frame_s: float) -> tuple[Span, ...]:
    """Where they are for `_MISSING_S` at least; short breaks between them are none."""
    places = np.flatnonzero(there)
    if not len(places):
        return ()
    breaks = np.flatnonzero(np.diff(places) > _BREAK_S / frame_s)
    starts = places[np.concatenate(([0], breaks + 1))]
    ends = places[np.concatenate((breaks, [len(places) - 1]))] + 1
    return tuple(
        Span(start * frame_s, end * frame_s)
        for start, end in zip(starts.tolist(), ends.tolist(), strict=True)
        if (end - start) * frame_s >= _MISSING_S
    )


def _pooled(shapes: Floats, count: int) -> Floats:
    """(n, 12): the mean of every so many frames."""
    whole = shapes.shape[1] // count * count
    result: Floats = np.ascontiguousarray(shapes[:, :whole].reshape(12, -1, count).mean(axis=2).T)
    return result


def _with_fillers(frames: Floats, step: int) -> tuple[Floats, Integers]:
    """Frames with one of silence before every so many and at the end, and the place of each before, -1 of those."""
    places = np.append(np.arange(0, len(frames), step), len(frames))
    filled = np.insert(frames, places, 0.0, axis=0)
    return np.ascontiguousarray(filled), np.insert(np.arange(len(frames)), places, -1)


def _smoothed(x: Floats, y: Floats) -> Floats:
    """Local lines through what was found, rising."""
    result = np.empty_like(y)
    first = np.searchsorted(x, x - _AROUND_S)
    last = np.searchsorted(x, x + _AROUND_S)
    for place in range(len(x)):
        inside = slice(first[place], last[place])
        result[place] = _line_at(x[inside] - x[place], y[inside], 1.0 - ((x[inside] - x[place]) / _AROUND_S) ** 2)
    rising: Floats = np.maximum.accumulate(result)
    return rising


def _line_at(x: Floats, y: Floats, weights: Floats) -> float:
    """At 0, the value of the line through weighted points."""
    total = float(weights.sum())
    mean_x, mean_y = float((weights * x).sum()) / total, float((weights * y).sum()) / total
    spread = float((weights * (x - mean_x) ** 2).sum())
    slope = float((weights * (x - mean_x) * (y - mean_y)).sum()) / spread if spread > 1e-9 else 0.0
    return mean_y - slope * mean_x


def _on_onsets(
    expected: ExpectedSound, recorded: RecordedSound, warped: _Warped, progress: Callable[[float], None]
) -> tuple[Floats, Floats]:
    """Seconds of the score at which notes begin, and when each begins in the recording, both rising."""
    times, counts = np.unique(np.round(expected.onset_s, 3), return_counts=True)
    weights = np.sqrt(counts.astype(np.float64))
    gaps_s = np.maximum(np.diff(times), _LEAST_GAP_S)
    found = warped.at(times)
    for number, (width_s, reach_s, step_s, uneven) in enumerate(_ROUNDS):
        edges = onset_edges(recorded.onsets, width_s)
        shifts = np.arange(-reach_s, reach_s + 1e-9, step_s)
        at = (found[:, None] + shifts) / ONSET_S
        strength = np.interp(at.ravel(), np.arange(len(edges)), edges, left=0.0, right=0.0).reshape(at.shape)
        chosen = _even_path(strength * weights[:, None], shifts, gaps_s, uneven)
        found = np.maximum.accumulate(found + shifts[chosen])
        progress((number + 1) / len(_ROUNDS))
    return times, found


def _even_path(strength: Floats, shifts: Floats, gaps_s: Floats, uneven: float) -> Integers:
    """Of each onset the shift, so that strong places are chosen and neighbours shift alike: Viterbi's algorithm.

    Parameters
    ----------
    strength : (N, S) float64
    shifts : (S,) float64
        Seconds.
    gaps_s : (N - 1,) float64
        From each onset to the next: the shorter, the more it costs to shift them differently.

    Returns
    -------
    (N,) int64
        Places in ``shifts``.
    """
    apart = uneven * (shifts[:, None] - shifts[None, :]) ** 2
    best = strength[0]
    came_from = np.zeros(strength.shape, np.int64)
    rows = np.arange(len(shifts))
    for place in range(1, len(strength)):
        totals = best[None, :] - apart / gaps_s[place - 1]
        came_from[place] = totals.argmax(axis=1)
        best = totals[rows, came_from[place]] + strength[place]
    path = np.empty(len(strength), np.int64)
    path[-1] = int(best.argmax())
    for place in range(len(strength) - 1, 0, -1):
        path[place - 1] = came_from[place][path[place]]
    return path


def _beats(beat_s: Floats, times: Floats, found: Floats, warped: _Warped) -> Floats:
    """When the beats sound: by the onsets around each, else by the warping; at least `_LEAST_GAP_S` apart."""
    result = warped.at(beat_s)
    # What the onsets say beside the warping, so that between them its tempo goes on.
    aside = found - warped.at(times)
    for place, at_s in enumerate(beat_s.tolist()):
        before = beat_s[max(place - 1, 0)] - 1e-6
        after = beat_s[min(place + 1, len(beat_s) - 1)] + 1e-6
        width_s = _NEIGHBOURS_BEATS * max(after - at_s, at_s - before)
        inside = slice(np.searchsorted(times, at_s - width_s), np.searchsorted(times, at_s + width_s))
        if inside.stop > inside.start:
            weights = 1.001 - np.abs(times[inside] - at_s) / width_s
            result[place] += float((weights**2 * aside[inside]).sum() / (weights**2).sum())
        else:
            result[place] += float(np.interp(at_s, times, aside))
    from sklearn.isotonic import isotonic_regression  # heavy, and only here

    gaps_s = _LEAST_GAP_S * np.arange(len(result))
    rising: Floats = isotonic_regression(result - gaps_s) + gaps_s
    return rising


def _confidence(
    beat_s: Floats, recording_s: Floats, shapes: Floats, recorded: RecordedSound, times: Floats, found: Floats
) -> Floats:
    """How sure each beat is, 0..1: whether what sounds around it is what the score has there, rather than the score
    transposed, and whether notes begin where they should."""
    frames = np.arange(shapes.shape[1])
    at = np.interp((frames + 0.5) * CHROMA_S, beat_s, recording_s, left=-1.0, right=-1.0) / CHROMA_S
    inside = (at >= 0) & (at < recorded.chroma.shape[1])
    theirs = np.where(inside, recorded.chroma[:, np.clip(at, 0, recorded.chroma.shape[1] - 1).astype(np.int64)], 0.0)
    width = round(2 * _LOCAL_S / CHROMA_S)
    window = np.ones(width)
    size = np.convolve(np.sqrt((theirs**2).sum(axis=0) * (shapes**2).sum(axis=0)), window, "same") + 1e-9
    turned = np.array(
        [np.convolve((theirs * np.roll(shapes, turn, axis=0)).sum(axis=0), window, "same") for turn in range(12)]
    )
    alike = np.where(turned[0] >= turned[1:].max(axis=0), turned[0] / size, 0.0)
    edges = onset_edges(recorded.onsets, _ROUNDS[-1][0])
    strength = np.interp(found / ONSET_S, np.arange(len(edges)), edges, left=0.0, right=0.0)
    result = np.empty(len(beat_s))
    for place, at_s in enumerate(beat_s.tolist()):
        first, last = np.searchsorted(times, at_s - _LOCAL_S), np.searchsorted(times, at_s + _LOCAL_S)
        onset = float(strength[first:last].mean()) if last > first else 0.0
        frame = min(max(int(at_s / CHROMA_S), 0), len(alike) - 1)
        result[place] = confidence_of(float(alike[frame]), onset)
    uneven = np.maximum(np.abs(_lengths(beat_s, recording_s)) - _USUAL_UNEVEN, 0.0)
    return result * np.exp(-((uneven / _USUAL_UNEVEN) ** 2))


def _lengths(beat_s: Floats, recording_s: Floats) -> Floats:
    """Around each beat the natural logarithm of how long beats last, against the score and the whole recording."""
    wide = min(_EVEN_BEATS, len(beat_s) - 1)
    lengths = (recording_s[wide:] - recording_s[:-wide]) / np.maximum(beat_s[wide:] - beat_s[:-wide], 1e-6)
    places = np.clip(np.arange(len(beat_s)) - wide // 2, 0, len(lengths) - 1)
    result: Floats = np.log(lengths / np.median(lengths))[places]
    return result


def _squeezed(beat_s: Floats, lengths: Floats) -> tuple[Span, ...]:
    """Seconds of the score that the recording hardly has time for: it leaves them out, whatever sounds there."""
    places = np.flatnonzero(lengths < _SQUEEZED)
    if not len(places):
        return ()
    breaks = np.flatnonzero(np.diff(places) > _EVEN_BEATS)
    starts, ends = np.concatenate(([0], breaks + 1)), np.concatenate((breaks, [len(places) - 1]))
    spans = [Span(float(beat_s[places[a]]), float(beat_s[places[b]])) for a, b in zip(starts, ends, strict=True)]
    return tuple(span for span in spans if span.end - span.start >= _MISSING_S)


def _joined(spans: Iterable[Span]) -> tuple[Span, ...]:
    """In order, those that touch as one."""
    result: list[Span] = []
    for span in sorted(spans, key=lambda one: one.start):
        if result and span.start <= result[-1].end + _MISSING_S:
            result[-1] = Span(result[-1].start, max(result[-1].end, span.end))
        else:
            result.append(span)
    return tuple(result)


def _ticks(score: Score, span: Span) -> Span:
    return Span(score.tempo_map.ticks(span.start), score.tempo_map.ticks(span.end))
