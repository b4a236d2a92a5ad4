"""Times of every beat of a score in a recording with varying tempo.

There are three steps, each finer: dynamic time warping of the chroma of both (`app.audio.warping`); alignment of the
score's onsets with the recording's so that the tempo between them is as even as the onsets allow; and interpolation of
the beats, smoothed over their neighbours. All steps respect the beats pinned by the user.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.audio.constant_tempo_offsets import LEAST_APART_S, RecordingPlace, places, usual_ratios
from app.audio.onset_path import FINAL_WIDTH_S, LEAST_GAP_S, on_onsets
from app.audio.passages import Passage
from app.audio.score_sound import (
    CHROMA_S,
    EARLY_S,
    ODD_HARMONICS,
    ONSET_S,
    ExpectedSound,
    RecordedSound,
    confidence_of,
    onset_edges,
    score_chroma,
    sounds_to_compare,
)
from app.audio.steady_tempo import steady_line
from app.audio.track import Samples
from app.audio.warping import MISSING_S, NO_PINS, Jump, Pins, Warped, along, dynamic_time_warping, played_passages
from app.errors import AppError, Progress, StopRequested, stoppable
from app.score.beat_following import Following, RunnerUp, UnmatchedSpan
from app.score.metre_map import MetreMap
from app.score.model import Score

_NEIGHBOURS_BEATS: Final = 1.0
"""Distance in beats on both sides of a beat within which onsets determine its time."""
_ALONG_BEATS: Final = 4
"""Number of beats around a pinned beat to which its correction is extended."""
_OF_PINS: Final = 1e6
"""Weight of a pinned beat among beats that exclude each other."""
_LOCAL_S: Final = 2.5
"""Half the width in seconds of the window in which a beat's confidence is measured."""
_EVEN_BEATS: Final = 4
_USUAL_UNEVEN: Final = 0.4
"""Greatest usual deviation of the tempo over `_EVEN_BEATS` beats from the average, as a natural logarithm: a factor of
1.5.
"""
_SQUEEZED: Final = -0.6
"""Deviation of the tempo (natural logarithm, over `_EVEN_BEATS` beats) below which these beats are considered missing
in the recording, since little more than half their time is there.
"""
RECOGNISED: Final = 0.4
"""Mean confidence below which the recording is considered to be of another piece."""
_SOME_RECOGNISED: Final = 0.75
"""Same limit if the recording contains only few of the beats; it is higher because few beats match similar music
anywhere.
"""
_SHARES: Final = (0.3, 0.7)
"""Shares of the beats that count as few and as most."""
_WHOLE: Final = 0.8
"""Mean confidence below which the recording is examined for containing only a part of the piece."""
_SURE: Final = 0.6
"""Mean confidence below which other timbres are tried."""
_PARTIAL: Final = 0.97
"""Largest share of the piece that counts as a part of it."""
_PART_RECOGNISED: Final = 0.6
"""The limit `RECOGNISED` for a recording of a part of the piece; higher, since the most similar part is chosen."""
_SHORT_S: Final = (10.0, 20.0)
_SHORT_RECOGNISED: Final = 0.2
"""Addition to `_PART_RECOGNISED` for parts not longer than the first value of `_SHORT_S`, decreasing up to the second.
Among eight pieces, 8 s of another piece reached 0.76.
"""
_ALONE_RECOGNISED: Final = 0.2
"""Addition to `_PART_RECOGNISED`, multiplied by the share of the recording that is not the piece."""
_SURER: Final = 0.05
"""Advantage in confidence at which a position at a constant tempo is preferred to the result of the warping."""
_AS_SURE: Final = 0.01
"""Disadvantage in confidence up to which a part is preferred to the whole, since its ends are found more exactly."""


def beats_of(metre_map: MetreMap, end_tick: int, pinned: Iterable[int] = ()) -> IntArray:
    """Return the ticks (N,) of a piece's felt beats, the first at tick 0, together with the pinned ticks."""
    ticks = metre_map.felt_between(0, max(end_tick, 1))
    return np.unique(np.concatenate(([0], ticks[ticks > 0], np.array([*pinned], np.int64))))


def follow(
    samples: Samples,
    rate_hz: int,
    score: Score,
    beat_ticks: IntArray,
    progress: Progress = lambda share: None,
    stop_requested: StopRequested = lambda: False,
    pinned: Mapping[int, float] | None = None,
) -> Following:
    """Find the time of every beat of a score in a recording.

    Parameters
    ----------
    samples : int16 array, shape (n, channels)
        Samples of the recording.
    beat_ticks : (N,) int64
        Ascending ticks of the beats to find; at least 2.
    progress : callable
        Called with the share 0..1 that is done.
    stop_requested : callable
        Called regularly; true cancels the work.
    pinned : mapping of int to float, optional
        Seconds of the recording by tick for beats placed by the user; both ascend.

    Raises
    ------
    AppError
        The recording is silent, the score has no notes, or the recording seems to be of another piece.
    Cancelled
        ``stop_requested`` returned true.
    """
    reached = stoppable(progress, stop_requested)
    reached(0.0)
    expected, recorded = sounds_to_compare(score, samples, rate_hz, lambda share: reached(0.6 * share))
    pins = _pins(score, pinned or {}).inside(len(samples) / rate_hz)
    piece = _Prepared(score, expected, recorded, score_chroma(expected, 1.0), beat_ticks, pins)
    result, runner_up = _found(piece, lambda share: reached(0.6 + 0.2 * share))
    if result is None or result.mean_confidence < _SURE:
        odd = replace(expected, harmonics=ODD_HARMONICS)
        piece = replace(piece, expected=odd, shapes=score_chroma(odd, 1.0))
        other, its_runner_up = _found(piece, lambda share: reached(0.8 + 0.2 * share))
        if other is not None and (result is None or _margin(other) > _margin(result)):
            result, runner_up = other, its_runner_up
    if result is None or _margin(result) < 0.0:
        raise AppError("audio.not_followed", percent=0 if result is None else round(100 * result.mean_confidence))
    reached(1.0)
    return replace(result, runner_up=runner_up)


@dataclass(frozen=True)
class _Prepared:
    """A score and a recording prepared for comparison: the expected sound, the recorded sound, and chroma shapes (12,
    F) of the score."""

    score: Score
    expected: ExpectedSound
    recorded: RecordedSound
    shapes: FloatArray
    beat_ticks: IntArray
    pins: Pins


def _found(prepared: _Prepared, reached: Callable[[float], None]) -> tuple[Following | None, RunnerUp | None]:
    """Find the likeliest alignment, whatever its confidence, and the second likeliest place for comparison; each is
    None if there is none.
    """
    shapes, recorded = prepared.shapes, prepared.recorded
    result = _followed(prepared, slice(0, shapes.shape[1]))
    reached(0.4)
    if result is None or result.mean_confidence < _WHOLE or result.missing or result.added:
        there = played_passages(shapes, recorded.chroma)
        part, jumps = _parts(there, shapes.shape[1], prepared.pins)
        if jumps or part.stop - part.start < _PARTIAL * shapes.shape[1]:
            reached(0.6)
            other = _followed(prepared, part, jumps)
            if other is not None and other.mean_confidence >= max(_part_limit(there, recorded), _as_sure_as(result)):
                result = other
    reached(0.8)
    return _with_lines(prepared, result)


def _with_lines(prepared: _Prepared, chosen: Following | None) -> tuple[Following | None, RunnerUp | None]:
    """Choose the most confident among the warping's result and the likeliest places at a constant tempo; also return
    the second likeliest place.

    A warping may slip by a note among equal notes; a constant tempo cannot.
    """
    if len(prepared.pins.score_s):
        return chosen, None
    ratios = usual_ratios(prepared.expected)
    if chosen is not None and chosen.mean_confidence >= _WHOLE:
        ratios = [_ratio_of(prepared, chosen)]
    found = [chosen] if chosen is not None else []
    for place in places(prepared.recorded, prepared.expected, ratios):
        following = _refined(prepared, _line(prepared, place), NO_PINS)
        if all(abs(_later_s(following, other)) > LEAST_APART_S for other in found):
            found.append(following)
        elif chosen is not None and _margin(following) > _margin(chosen) + _SURER and not chosen.added:
            found[0] = chosen = following
    if not found:
        return None, None
    best = max(found, key=_margin)
    if chosen is not None and _margin(best) <= _margin(chosen) + _SURER:
        best = chosen
    second = max((one for one in found if one is not best), key=_margin, default=None)
    return best, None if second is None else RunnerUp(_later_s(second, best), second.mean_confidence)


def _margin(following: Following) -> float:
    """Mean confidence minus the limit above which a recording is considered to be of this piece; negative below it."""
    return following.mean_confidence - float(np.interp(following.share, _SHARES, (_SOME_RECOGNISED, RECOGNISED)))


def _line(prepared: _Prepared, place: RecordingPlace) -> Warped:
    """Alignment of a recording with the score at one constant tempo, from a known place."""
    length_s = prepared.shapes.shape[1] * CHROMA_S
    ends_s = np.array([0.0, length_s])
    there_s = place.start_s + ends_s / place.ratio
    first_s, last_s = np.clip(np.interp([0.0, prepared.recorded.length_s], there_s, ends_s), 0.0, length_s)
    outside = (UnmatchedSpan(0.0, float(first_s)), UnmatchedSpan(float(last_s), length_s))
    missing = tuple(span for span in outside if span.end - span.start >= MISSING_S)
    return Warped(ends_s, there_s, missing, (), length_s)


def _ratio_of(prepared: _Prepared, following: Following) -> float:
    """Return the median tempo of the recording divided by the score's."""
    beat_s = prepared.score.tempo_map.seconds(following.ticks.astype(np.float64))
    return float(np.median(np.diff(beat_s) / np.diff(following.recording_s)))


def _later_s(one: Following, other: Following) -> float:
    """Return the median delay of the beats in seconds between two alignments."""
    return float(np.median(one.recording_s - other.recording_s))


def _as_sure_as(whole: Following | None) -> float:
    return 0.0 if whole is None else whole.mean_confidence - _AS_SURE


def _part_limit(played: Sequence[Passage], recorded: RecordedSound) -> float:
    """Mean confidence below which a recording that has only passages of the score is considered to be of
    another piece.
    """
    lengths_s = [one.recording_end_s - one.recording_start_s for one in played]
    short = float(np.interp(max(lengths_s, default=0.0), _SHORT_S, (_SHORT_RECOGNISED, 0.0)))
    sounding = np.linalg.norm(recorded.chroma, axis=0)
    frames = [(round(one.recording_start_s / CHROMA_S), round(one.recording_end_s / CHROMA_S)) for one in played]
    there = sum(float(sounding[first:last].sum()) for first, last in frames)
    alone = 1.0 - min(there / max(float(sounding.sum()), 1e-9), 1.0)
    return _PART_RECOGNISED + short + _ALONE_RECOGNISED * alone


def _parts(played: Sequence[Passage], frames: int, pins: Pins) -> tuple[slice, tuple[Jump, ...]]:
    """Return the range of the score's chroma frames that a recording contains, and the jumps between its passages;
    ``frames`` is the score's length."""
    if not played:
        return slice(0, frames), ()
    first, last = round(played[0].start_s / CHROMA_S), round(played[-1].end_s / CHROMA_S)
    jumps = (
        Jump(one.end_s, max(other.start_s, one.end_s), one.recording_end_s, other.recording_start_s)
        for one, other in pairwise(played)
    )
    return slice(max(first, 0), min(last, frames)), tuple(jump for jump in jumps if jump.agrees_with(pins))


def _followed(prepared: _Prepared, part: slice, jumps: Sequence[Jump] = ()) -> Following | None:
    """Align a recording that contains only a ``part`` of the score (range of frames), with jumps; None if nothing is
    similar.
    """
    recorded = prepared.recorded
    start_s, end_s = part.start * CHROMA_S, part.stop * CHROMA_S
    pins = prepared.pins.within(start_s, end_s)
    rough = dynamic_time_warping(
        prepared.shapes[:, part], recorded.chroma, pins, [jump.later(-start_s) for jump in jumps]
    )
    if len(rough.score_s) < 2:
        return None
    rough, pins = (
        rough.later(start_s, prepared.shapes.shape[1] * CHROMA_S),
        replace(pins, score_s=pins.score_s + start_s),
    )
    return _refined(prepared, rough, pins)


def _refined(prepared: _Prepared, rough: Warped, pins: Pins) -> Following:
    """Find the times of the beats near a rough alignment, from the recording's onsets."""
    score, recorded, expected = prepared.score, prepared.recorded, prepared.expected
    times, found = on_onsets(expected, recorded, prepared.shapes, rough, pins)
    beat_s = score.tempo_map.seconds(prepared.beat_ticks.astype(np.float64))
    recording_s = _beats(beat_s, times, found, rough, pins)
    line = (
        None
        if len(pins.score_s) or rough.added
        else steady_line(*_present(times, found, rough, recorded), recorded.onsets)
    )
    if line is not None:
        recording_s = line[0] + line[1] * beat_s
    likely = _confidence(beat_s, recording_s, prepared.shapes, recorded, times, found)
    squeezed = _squeezed(beat_s, _lengths(beat_s, recording_s))
    missing = tuple(_ticks(score, span) for span in _joined((*rough.missing, *squeezed)))
    likely[np.searchsorted(beat_s, pins.score_s - 1e-6)] = 1.0
    return Following(prepared.beat_ticks, recording_s + EARLY_S, likely, missing, rough.added)


def _present(
    times: FloatArray, found: FloatArray, rough: Warped, recorded: RecordedSound
) -> tuple[FloatArray, FloatArray]:
    """Select the onsets that the recording really contains: their times (N,) in score and recording, from the
    candidates ``times`` and ``found``.
    """
    there = (found >= 0.0) & (found < recorded.length_s)
    for span in rough.missing:
        there &= (times < span.start) | (times >= span.end)
    return times[there], found[there]


def _pins(score: Score, pinned: Mapping[int, float]) -> Pins:
    """Convert the user's pins from ticks of the score to seconds of score and recording."""
    return Pins(
        score.tempo_map.seconds(np.array([*pinned], np.float64)), np.array([*pinned.values()], np.float64) - EARLY_S
    )


def _beats(beat_s: FloatArray, times: FloatArray, found: FloatArray, warped: Warped, pins: Pins) -> FloatArray:
    """Compute the times of the beats in the recording, at least `LEAST_GAP_S` apart: those pinned by the user, else
    from the onsets around each beat, else from the warping.
    """
    result = warped.at(beat_s)
    # Differences between onsets and warping are averaged, so that the tempo of the warping continues between the
    # onsets.
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
    from sklearn.isotonic import isotonic_regression  # slow to import and used only here

    gaps_s = LEAST_GAP_S * np.arange(len(result))
    fixed = np.searchsorted(beat_s, pins.score_s - 1e-6)
    numbers = np.arange(len(result), dtype=np.float64)
    result += along(numbers, numbers[fixed], pins.recording_s - result[fixed], _ALONG_BEATS)
    weights = np.ones(len(result))
    weights[fixed] = _OF_PINS
    rising: FloatArray = isotonic_regression(result - gaps_s, sample_weight=weights) + gaps_s
    return rising


def _confidence(
    beat_s: FloatArray,
    recording_s: FloatArray,
    shapes: FloatArray,
    recorded: RecordedSound,
    times: FloatArray,
    found: FloatArray,
) -> FloatArray:
    """Return the confidence of each beat, 0..1: higher if the sound around it is more similar to the score than to the
    transposed score, and if onsets are at the expected times.
    """
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
    edges = onset_edges(recorded.onsets, FINAL_WIDTH_S)
    strength = np.interp(found / ONSET_S, np.arange(len(edges)), edges, left=0.0, right=0.0)
    result = np.empty(len(beat_s))
    for place, at_s in enumerate(beat_s.tolist()):
        first, last = np.searchsorted(times, at_s - _LOCAL_S), np.searchsorted(times, at_s + _LOCAL_S)
        onset = float(strength[first:last].mean()) if last > first else 0.0
        frame = min(max(int(at_s / CHROMA_S), 0), len(alike) - 1)
        result[place] = confidence_of(float(alike[frame]), onset)
    uneven = np.maximum(np.abs(_lengths(beat_s, recording_s)) - _USUAL_UNEVEN, 0.0)
    return result * np.exp(-((uneven / _USUAL_UNEVEN) ** 2))


def _lengths(beat_s: FloatArray, recording_s: FloatArray) -> FloatArray:
    """For each beat the natural logarithm (N,) of the length of the recorded beats around it, relative to the score and
    to the average of the recording.
    """
    wide = min(_EVEN_BEATS, len(beat_s) - 1)
    lengths = (recording_s[wide:] - recording_s[:-wide]) / np.maximum(beat_s[wide:] - beat_s[:-wide], 1e-6)
    places = np.clip(np.arange(len(beat_s)) - wide // 2, 0, len(lengths) - 1)
    result: FloatArray = np.log(lengths / np.median(lengths))[places]
    return result


def _squeezed(beat_s: FloatArray, lengths: FloatArray) -> tuple[UnmatchedSpan, ...]:
    """Find spans of the score, in seconds, that take hardly any time in the recording and so count as missing in it."""
    places = np.flatnonzero(lengths < _SQUEEZED)
    if not len(places):
        return ()
    breaks = np.flatnonzero(np.diff(places) > _EVEN_BEATS)
    starts, ends = np.concatenate(([0], breaks + 1)), np.concatenate((breaks, [len(places) - 1]))
    spans = [
        UnmatchedSpan(float(beat_s[places[a]]), float(beat_s[places[b]])) for a, b in zip(starts, ends, strict=True)
    ]
    return tuple(span for span in spans if span.end - span.start >= MISSING_S)


def _joined(spans: Iterable[UnmatchedSpan]) -> tuple[UnmatchedSpan, ...]:
    """Order spans by time, and merge those less than `MISSING_S` apart."""
    result: list[UnmatchedSpan] = []
    for span in sorted(spans, key=lambda one: one.start):
        if result and span.start <= result[-1].end + MISSING_S:
            result[-1] = UnmatchedSpan(result[-1].start, max(result[-1].end, span.end))
        else:
            result.append(span)
    return tuple(result)


def _ticks(score: Score, span: UnmatchedSpan) -> UnmatchedSpan:
    return UnmatchedSpan(score.tempo_map.ticks(span.start), score.tempo_map.ticks(span.end))
