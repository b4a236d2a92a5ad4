"""Where a recording stands against the score: from what sounds (chroma) and when tones begin (onsets).

The recording may begin earlier or later than the score, end elsewhere, be tuned differently, and be a few per cent
faster or slower. What the score should sound like is made from its notes. The chroma of both is correlated at every
offset for a grid of tempi; the best places are then made exact by letting the expected onsets lie on the recording's.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
import soxr

from app.audio.features import chroma, onset_strength, tuning
from app.audio.track import Samples
from app.errors import AppError, Cancelled
from app.score.model import Score

Floats: TypeAlias = npt.NDArray[np.float64]
Spectrum: TypeAlias = npt.NDArray[np.complex128]

TEMPO_RATIOS: Final = (0.94, 1.06)
"""A recording may be this much slower or faster than the score."""
_RATE_HZ: Final = 22050
_CHROMA_HOP: Final = 2048
_CHROMA_S: Final = _CHROMA_HOP / _RATE_HZ
_ONSET_HOP: Final = 220
_ONSET_S: Final = _ONSET_HOP / _RATE_HZ
_LEAST_SAMPLES: Final = 4 * _RATE_HZ
"""Shorter recordings are filled up with silence: what surrounds an onset must be there."""
_HARMONICS: Final = ((0, 1.0), (7, 0.25), (4, 0.08))
"""Pitch classes above a note's own that its overtones sound in (the third and the fifth harmonic), and how loud."""
_CANDIDATES: Final = 3
_LEAST_OVERLAP: Final = 0.35
"""Share of the shorter of the two that must overlap."""
_EARLY_S: Final = 0.007
"""How much earlier than the note its onset is found, by windows that reach ahead: mean over seven pieces by the
built-in synthesiser."""


@dataclass(frozen=True)
class Estimate:
    """A recording's place.

    Attributes
    ----------
    offset_s : float
        Performance time at which its first sample sounds.
    tempo_ratio : float
        Its tempo divided by the score's.
    confidence : float
        0..1; below 0.5 it is rather another piece.
    """

    offset_s: float
    tempo_ratio: float
    confidence: float


@dataclass(frozen=True)
class _Features:
    """What a recording sounds like: chroma (12, frames), onset strength (frames,)."""

    chroma: Floats
    onsets: Floats


@dataclass(frozen=True)
class _Expected:
    """What a score asks for: notes' onsets and ends in seconds, pitches, weights."""

    onset_s: Floats
    end_s: Floats
    pitch: npt.NDArray[np.int64]
    loudness: Floats


def estimate_offset(
    samples: Samples,
    rate_hz: int,
    score: Score,
    progress: Callable[[float], None] = lambda share: None,
    stop_requested: Callable[[], bool] = lambda: False,
) -> Estimate:
    """Find where a recording stands.

    Parameters
    ----------
    samples : int16 array, shape (n, channels)
    progress : callable
        Called with the share 0..1 that is done.
    stop_requested : callable
        Asked now and then; true ends the work.

    Raises
    ------
    AppError
        ``audio.nothing_to_compare``: the recording is silent, or the score has no notes.
    Cancelled
    """

    def reached(share: float) -> None:
        if stop_requested():
            raise Cancelled("work.stopped")
        progress(share)

    expected = _expected(score)
    if not len(samples) or not samples.any() or not len(expected.onset_s):
        raise AppError("audio.nothing_to_compare")
    reached(0.0)
    recorded = _features(samples, rate_hz, lambda share: reached(0.6 * share))
    places = _by_chroma(recorded, expected, lambda share: reached(0.6 + 0.3 * share))
    fits = []
    for index, (start_s, ratio) in enumerate(places):
        fits.append(_by_onsets(recorded, expected, start_s, ratio))
        reached(0.9 + 0.1 * (index + 1) / len(places))
    strengths = [strength for _, _, strength in fits]
    start_s, ratio, _ = fits[int(np.argmax(strengths))]
    likeness = _likeness(recorded, expected, start_s, ratio)
    return Estimate(-(start_s + _EARLY_S), ratio, _confidence(likeness, max(strengths)))


def _expected(score: Score) -> _Expected:
    notes = [note for part in score.parts for note in part.notes]
    seconds = score.tempo_map.seconds
    return _Expected(
        seconds(np.array([note.onset_tick for note in notes], np.float64)),
        seconds(np.array([note.end_tick for note in notes], np.float64)),
        np.array([note.pitch for note in notes], np.int64),
        np.array([0.3 + 0.7 * note.velocity / 127 for note in notes], np.float64),
    )


def _features(samples: Samples, rate_hz: int, progress: Callable[[float], None]) -> _Features:
    sound = soxr.resample(samples.astype(np.float32).mean(axis=1) / 32768.0, rate_hz, _RATE_HZ)
    sound = np.pad(sound, (0, max(_LEAST_SAMPLES - len(sound), 0)))
    progress(0.2)
    sounding = np.flatnonzero(np.abs(sound) > 1e-3)
    middle = int(sounding[len(sounding) // 2]) if len(sounding) else 0
    part = sound[max(middle - 30 * _RATE_HZ, 0) : middle + 30 * _RATE_HZ]
    tuned = tuning(part, _RATE_HZ)
    progress(0.3)
    classes = chroma(sound, _RATE_HZ, 2 * _CHROMA_HOP, _CHROMA_HOP, tuned)
    progress(0.5)
    onsets = onset_strength(sound, _RATE_HZ, 1024, _ONSET_HOP)
    progress(1.0)
    return _Features(_shape(classes), _evened(onsets))


def _shape(chroma: Floats) -> Floats:
    """Each frame as a direction: which pitch classes stand out, however loud; near silence counts less."""
    level = np.sqrt(chroma.sum(axis=0))
    chroma = np.sqrt(chroma)
    chroma = chroma - chroma.mean(axis=0)
    size = np.sqrt((chroma**2).sum(axis=0))
    typical = np.median(level[level > 0]) if (level > 0).any() else 1.0
    result: Floats = chroma / np.maximum(size, 1e-9) * np.minimum(level / typical, 1.0)
    return result


def _evened(onsets: Floats) -> Floats:
    """Onset strength above its surroundings, in units of its own spread."""
    width = round(1.5 / _ONSET_S)
    around = np.convolve(onsets, np.ones(width) / width, "same")
    spread = np.sqrt(np.convolve((onsets - around) ** 2, np.ones(width) / width, "same"))
    result: Floats = np.clip((onsets - around) / np.maximum(spread, 0.3 * spread.max() + 1e-9), -1.0, 4.0)
    return result


def _score_chroma(expected: _Expected, ratio: float) -> Floats:
    """The score's chroma at a tempo, from second 0 of the score."""
    begin, end = expected.onset_s / ratio / _CHROMA_S, expected.end_s / ratio / _CHROMA_S
    frames = int(np.ceil(end.max())) + 1
    steps = np.zeros((12, frames + 2))
    first, last = np.floor(begin).astype(int), np.floor(end).astype(int)
    for above, loudness in _HARMONICS:
        row = (expected.pitch + above) % 12
        amount = expected.loudness * loudness
        # A note fills its frames; the first and the last in part: written as differences, summed afterwards.
        for place, share, sign in ((first, begin - first, 1.0), (last, end - last, -1.0)):
            np.add.at(steps, (row, place), sign * amount * (1.0 - share))
            np.add.at(steps, (row, place + 1), sign * amount * share)
    return _shape(np.maximum(np.cumsum(steps, axis=1)[:, :frames], 0.0) ** 2)


def _by_chroma(
    recorded: _Features, expected: _Expected, progress: Callable[[float], None]
) -> list[tuple[float, float]]:
    """The likeliest places: (second of the recording at which the score's second 0 lies, tempo ratio)."""
    length_s = float(expected.end_s.max())
    # At the ends of the piece a wrong tempo must not put chords beside one another.
    step = float(np.clip(0.25 / max(length_s, 1.0), 4e-4, 5e-3))
    half = int(np.ceil((TEMPO_RATIOS[1] - 1.0) / step))
    ratios = [1.0 + step * index for index in range(-half, half + 1)]
    found: list[tuple[float, float, float]] = []
    spectra: dict[int, Spectrum] = {}
    energy = np.concatenate([[0.0], np.cumsum((recorded.chroma**2).sum(axis=0))])
    for index, ratio in enumerate(ratios):
        expected_chroma = _score_chroma(expected, ratio)
        lags, values = _correlate(recorded.chroma, expected_chroma, energy, spectra)
        for at in _peaks(values):
            found.append((float(values[at]), float(lags[at]) * _CHROMA_S, ratio))
        progress((index + 1) / len(ratios))
    found.sort(reverse=True)
    kept: list[tuple[float, float]] = []
    for _, start_s, ratio in found:
        if all(abs(start_s - other) > 1.0 for other, _ in kept):
            kept.append((start_s, ratio))
        if len(kept) == _CANDIDATES:
            break
    return kept


def _correlate(
    recorded: Floats, expected_chroma: Floats, energy: Floats, spectra: dict[int, Spectrum]
) -> tuple[npt.NDArray[np.int64], Floats]:
    """Likeness of the two at every lag of the recording, -1..1, by how much of them overlaps."""
    frames, length = recorded.shape[1], expected_chroma.shape[1]
    from scipy import fft  # heavy, and only here

    size = fft.next_fast_len(frames + length, real=True)
    if size not in spectra:
        spectra.clear()
        spectra[size] = fft.rfft(recorded, size, axis=1)
    products = fft.irfft((spectra[size] * np.conj(fft.rfft(expected_chroma, size, axis=1))).sum(axis=0), size)
    lags = np.arange(-length + 1, frames)
    values = products[lags % size]
    own = np.concatenate([[0.0], np.cumsum((expected_chroma**2).sum(axis=0))])
    begin, end = np.clip(lags, 0, frames), np.clip(lags + length, 0, frames)
    there = energy[end] - energy[begin]
    ours = own[np.clip(end - lags, 0, length)] - own[np.clip(begin - lags, 0, length)]
    least = _LEAST_OVERLAP * min(own[-1], energy[-1])
    likeness = values / np.sqrt(np.maximum(there * ours, 1e-9))
    overlap = np.minimum(ours / max(own[-1], 1e-9), 1.0)
    return lags, np.where(ours >= least, likeness * np.sqrt(overlap), -1.0)


def _peaks(values: Floats) -> list[int]:
    """The highest few values that lie apart."""
    rest = values.copy()
    apart = round(1.0 / _CHROMA_S)
    result = []
    for _ in range(_CANDIDATES):
        at = int(rest.argmax())
        if rest[at] <= -1.0:
            break
        result.append(at)
        rest[max(at - apart, 0) : at + apart + 1] = -1.0
    return result


def _by_onsets(recorded: _Features, expected: _Expected, start_s: float, ratio: float) -> tuple[float, float, float]:
    """The exact place near a rough one: (start, ratio, mean onset strength there in spreads).

    Round by round the onsets may lie less and less beside the recording's.
    """
    times, counts = np.unique(np.round(expected.onset_s, 3), return_counts=True)
    weights = np.sqrt(counts.astype(np.float64))
    middle = float(times.mean())
    length_s = max(float(np.ptp(times)), 1.0)
    centre_s = start_s + middle / ratio
    for width_s, reach_s, step_s in (
        (0.06, 0.20, 0.015),
        (0.03, 0.06, 0.008),
        (0.02, 0.02, 0.004),
        (0.02, 0.006, 0.001),
    ):
        edges = _edges(recorded.onsets, width_s)
        shifts = np.arange(-reach_s, reach_s + 1e-9, step_s)
        slants = np.arange(-reach_s, reach_s + 1e-9, 2 * step_s) / (length_s / 2) * ratio
        best = (-np.inf, centre_s, ratio)
        for slant in slants:
            r = float(np.clip(ratio + slant, TEMPO_RATIOS[0] - 0.01, TEMPO_RATIOS[1] + 0.01))
            at = (centre_s + (times - middle) / r)[None, :] + shifts[:, None]
            frames = at / _ONSET_S
            inside = (frames >= 0) & (frames < len(edges) - 1)
            strength = np.interp(frames, np.arange(len(edges)), edges)
            total = (np.where(inside, strength, 0.0) * weights).sum(axis=1) / weights.sum()
            top = int(total.argmax())
            if total[top] > best[0]:
                best = (float(total[top]), centre_s + float(shifts[top]), r)
        strength_there, centre_s, ratio = best
    return centre_s - middle / ratio, ratio, strength_there


def _edges(onsets: Floats, width_s: float) -> Floats:
    """How much more of an onset comes after a moment than before it.

    A tone's strength rises at once and goes on rising for a while, the longer the slower it speaks: its beginning is
    where the strength sets in, not where it is greatest.
    """
    reach = max(round(3 * width_s / _ONSET_S), 1)
    decay = np.exp(-(np.arange(reach) + 0.5) * _ONSET_S / width_s)
    # np.convolve turns its kernel round: what comes after a moment stands first.
    kernel = np.concatenate([decay[::-1], -decay]) / decay.sum()
    result: Floats = np.convolve(onsets, kernel, "full")[reach - 1 : reach - 1 + len(onsets)]
    return result


def _likeness(recorded: _Features, expected: _Expected, start_s: float, ratio: float) -> float:
    """How alike the chroma of both are where the score now lies, against the score transposed: 0 for another piece."""
    expected_chroma = _score_chroma(expected, ratio)
    lag = round(start_s / _CHROMA_S)
    first, last = max(lag, 0), min(lag + expected_chroma.shape[1], recorded.chroma.shape[1])
    if last <= first:
        return 0.0
    there, ours = recorded.chroma[:, first:last], expected_chroma[:, first - lag : last - lag]
    size = float(np.sqrt((there**2).sum() * (ours**2).sum()))
    if size <= 0.0:
        return 0.0
    values = [float((there * np.roll(ours, turn, axis=0)).sum()) / size for turn in range(12)]
    return values[0] if values[0] >= max(values[1:]) else 0.0


def _confidence(likeness: float, onsets: float) -> float:
    """0..1. Right places of test pieces, with noise, reverberation and applause, had likeness 0.38 and onsets 0.36 or
    more; wrong pieces and transposed ones at most 0.29, and where it was more than 0.2, onsets of 0.3."""
    return float(_rising(12.0 * (likeness - 0.34)) * _rising(8.0 * (onsets - 0.28)))


def _rising(x: float) -> float:
    return float(1.0 / (1.0 + np.exp(-np.clip(x, -30.0, 30.0))))
