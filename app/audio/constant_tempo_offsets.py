"""Likely places of a score in a recording at a constant tempo: the chroma of both is correlated at every offset."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from app.arrays import ComplexArray, FloatArray, IntArray
from app.audio.score_sound import CHROMA_S, ExpectedSound, RecordedSound, score_chroma
from app.errors import Progress

Spectrum: TypeAlias = ComplexArray

TEMPO_RATIOS: Final = (0.94, 1.06)
"""A recording may be this much slower or faster than the score."""
_CANDIDATES: Final = 4
_APART_S: Final = 1.0
LEAST_APART_S: Final = 0.1
"""Alignments nearer to one another than this are the same."""
_LEAST_OVERLAP: Final = 0.35
"""Share of the shorter of the two that must overlap."""


@dataclass(frozen=True)
class RecordingPlace:
    """Position and tempo ratio of a score in a recording.

    Attributes
    ----------
    start_s : float
        Second of the recording at which the score's second 0 lies; may be negative.
    ratio : float
        The recording's tempo divided by the score's.
    """

    start_s: float
    ratio: float


def is_other(one: RecordingPlace, other: RecordingPlace) -> bool:
    """Return whether two places are more than a rounding apart."""
    return abs(one.start_s - other.start_s) > LEAST_APART_S


def usual_ratios(expected: ExpectedSound) -> list[float]:
    """The tempi within `TEMPO_RATIOS`, so close that a wrong one puts no chord next to another at the piece's ends."""
    length_s = float(expected.end_s.max())
    step = float(np.clip(0.25 / max(length_s, 1.0), 4e-4, 5e-3))
    half = int(np.ceil((TEMPO_RATIOS[1] - 1.0) / step))
    return [1.0 + step * index for index in range(-half, half + 1)]


def places(
    recorded: RecordedSound, expected: ExpectedSound, ratios: Sequence[float], progress: Progress = lambda share: None
) -> list[RecordingPlace]:
    """Find the likeliest places, those first that are most alike; they lie a second apart.

    Parameters
    ----------
    ratios : sequence of float
        Tempi that are tried, as `RecordingPlace.ratio`.
    progress : callable
        Called with the share 0..1 that is done.
    """
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
    kept: list[RecordingPlace] = []
    for _, start_s, ratio in found:
        if all(abs(start_s - other.start_s) > _APART_S for other in kept):
            kept.append(RecordingPlace(start_s, ratio))
        if len(kept) == _CANDIDATES:
            break
    return kept


def _correlate(
    recorded: FloatArray, expected_chroma: FloatArray, energy: FloatArray, spectra: dict[int, Spectrum]
) -> tuple[IntArray, FloatArray]:
    """Likeness (-1..1) of score and recording at every lag of the recording, weighted by how much of them overlaps."""
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


def _peaks(values: FloatArray) -> list[int]:
    """The highest few values that lie apart."""
    rest = values.copy()
    apart = round(_APART_S / CHROMA_S)
    result = []
    for _ in range(_CANDIDATES):
        at = int(rest.argmax())
        if rest[at] <= -1.0:
            break
        result.append(at)
        rest[max(at - apart, 0) : at + apart + 1] = -1.0
    return result
