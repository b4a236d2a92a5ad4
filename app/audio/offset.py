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

from app.audio.score_sound import (
    CHROMA_S,
    EARLY_S,
    ONSET_S,
    ExpectedSound,
    Floats,
    RecordedSound,
    confidence_of,
    onset_edges,
    score_chroma,
    sounds_to_compare,
)
from app.audio.track import Samples
from app.errors import stoppable
from app.score.model import Score

Spectrum: TypeAlias = npt.NDArray[np.complex128]

TEMPO_RATIOS: Final = (0.94, 1.06)
"""A recording may be this much slower or faster than the score."""
_CANDIDATES: Final = 3
_LEAST_OVERLAP: Final = 0.35
"""Share of the shorter of the two that must overlap."""


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
    reached = stoppable(progress, stop_requested)
    reached(0.0)
    expected, recorded = sounds_to_compare(score, samples, rate_hz, lambda share: reached(0.6 * share))
    places = _by_chroma(recorded, expected, lambda share: reached(0.6 + 0.3 * share))
    fits = []
    for index, (start_s, ratio) in enumerate(places):
        fits.append(_by_onsets(recorded, expected, start_s, ratio))
        reached(0.9 + 0.1 * (index + 1) / len(places))
    strengths = [strength for _, _, strength in fits]
    start_s, ratio, _ = fits[int(np.argmax(strengths))]
    likeness = _likeness(recorded, expected, start_s, ratio)
    return Estimate(-(start_s + EARLY_S), ratio, confidence_of(likeness, max(strengths)))


def _by_chroma(
    recorded: RecordedSound, expected: ExpectedSound, progress: Callable[[float], None]
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
        expected_chroma = score_chroma(expected, ratio)
        lags, values = _correlate(recorded.chroma, expected_chroma, energy, spectra)
        for at in _peaks(values):
            found.append((float(values[at]), float(lags[at]) * CHROMA_S, ratio))
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
    apart = round(1.0 / CHROMA_S)
    result = []
    for _ in range(_CANDIDATES):
        at = int(rest.argmax())
        if rest[at] <= -1.0:
            break
        result.append(at)
        rest[max(at - apart, 0) : at + apart + 1] = -1.0
    return result


def _by_onsets(
    recorded: RecordedSound, expected: ExpectedSound, start_s: float, ratio: float
) -> tuple[float, float, float]:
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
        edges = onset_edges(recorded.onsets, width_s)
        shifts = np.arange(-reach_s, reach_s + 1e-9, step_s)
        slants = np.arange(-reach_s, reach_s + 1e-9, 2 * step_s) / (length_s / 2) * ratio
        best = (-np.inf, centre_s, ratio)
        for slant in slants:
            r = float(np.clip(ratio + slant, TEMPO_RATIOS[0] - 0.01, TEMPO_RATIOS[1] + 0.01))
            at = (centre_s + (times - middle) / r)[None, :] + shifts[:, None]
            frames = at / ONSET_S
            inside = (frames >= 0) & (frames < len(edges) - 1)
            strength = np.interp(frames, np.arange(len(edges)), edges)
            total = (np.where(inside, strength, 0.0) * weights).sum(axis=1) / weights.sum()
            top = int(total.argmax())
            if total[top] > best[0]:
                best = (float(total[top]), centre_s + float(shifts[top]), r)
        strength_there, centre_s, ratio = best
    return centre_s - middle / ratio, ratio, strength_there


def _likeness(recorded: RecordedSound, expected: ExpectedSound, start_s: float, ratio: float) -> float:
    """How alike the chroma of both are where the score now lies, against the score transposed: 0 for another piece."""
    expected_chroma = score_chroma(expected, ratio)
    lag = round(start_s / CHROMA_S)
    first, last = max(lag, 0), min(lag + expected_chroma.shape[1], recorded.chroma.shape[1])
    if last <= first:
        return 0.0
    there, ours = recorded.chroma[:, first:last], expected_chroma[:, first - lag : last - lag]
    size = float(np.sqrt((there**2).sum() * (ours**2).sum()))
    if size <= 0.0:
        return 0.0
    values = [float((there * np.roll(ours, turn, axis=0)).sum()) / size for turn in range(12)]
    return values[0] if values[0] >= max(values[1:]) else 0.0
