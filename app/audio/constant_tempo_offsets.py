"""Likely positions of a score in a recording at a constant tempo, by correlating the chroma of both at every offset."""

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
"""Least and greatest tempo of a recording relative to the score's."""
_CANDIDATES: Final = 4
_APART_S: Final = 1.0
LEAST_APART_S: Final = 0.1
"""Positions closer than this number of seconds are equal."""
_LEAST_OVERLAP: Final = 0.35
"""Least overlap as a share of the shorter of score and recording."""


@dataclass(frozen=True)
class RecordingPlace:
    """Position and tempo ratio of a score in a recording.

    Attributes
    ----------
    start_s : float
        Second of the recording at the score's second 0; may be negative.
    ratio : float
        The recording's tempo divided by the score's.
    """

    start_s: float
    ratio: float


def is_other(one: RecordingPlace, other: RecordingPlace) -> bool:
    """Return whether two places of a score in a recording differ by more than rounding errors."""
    return abs(one.start_s - other.start_s) > LEAST_APART_S


def usual_ratios(expected: ExpectedSound) -> list[float]:
    """Return the tempo ratios to try, within `TEMPO_RATIOS` and so close together that at the ends of the piece the
    error in time is less than a chord.
    """
    length_s = float(expected.end_s.max())
    step = float(np.clip(0.25 / max(length_s, 1.0), 4e-4, 5e-3))
    half = int(np.ceil((TEMPO_RATIOS[1] - 1.0) / step))
    return [1.0 + step * index for index in range(-half, half + 1)]


def places(
    recorded: RecordedSound, expected: ExpectedSound, ratios: Sequence[float], progress: Progress = lambda share: None
) -> list[RecordingPlace]:
    """Find the likeliest places of a score in a recording, at least a second apart, the best first.

    Parameters
    ----------
    ratios : sequence of float
        Tempo ratios to try, as `RecordingPlace.ratio`.
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
    """Return the lags in frames (N,), and the similarity (N,), -1..1, of score and recording at each, weighted by their
    overlap; ``spectra`` caches transforms by size."""
    frames, length = recorded.shape[1], expected_chroma.shape[1]
    from scipy import fft  # slow to import and used only here

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
    """Indices of the few highest maxima that are not next to a higher one."""
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
