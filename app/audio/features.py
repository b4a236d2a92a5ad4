"""Features of a sound over time: chroma (energy of the twelve pitch classes), onset strength and tuning.

These are standard features of music analysis, as far as `offset` needs them. librosa has them too, but requires numba,
LLVM and scikit-learn: 270 MB.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from app.arrays import FloatArray, SingleArray

Sound = SingleArray

_A4_HZ: Final = 440.0
_PITCHED_HZ: Final = (60.0, 5000.0)
"""Frequency range of fundamentals and low harmonics of wind instruments; other peaks are useless for the tuning."""
_CENTRE_HZ: Final = 880.0
_OCTAVES: Final = 2.0
"""Standard deviation in octaves of the weights of frequencies around the middle of the range."""
_SPREAD: Final = 0.6
"""Standard deviation in semitones of the weight of a spectral line for the pitch classes near it."""
_BANDS: Final = 64
_LOWEST_BAND_HZ: Final = 40.0
_COMPRESSION: Final = 1e4
"""Factor by which band energies are scaled before their logarithm is taken, relative to the mean energy."""
_TUNED_FRAME: Final = 8192
"""Samples of a spectrum from which the tuning is determined."""
_FRAMES: Final = 1024
"""Number of frames transformed at a time, since those of an hour exceed the memory."""


def tuning(sound: Sound, rate_hz: int) -> float:
    """Return the deviation of a sound's tuning from 440 Hz: the circular mean over the peaks of its spectra.

    Parameters
    ----------
    sound : float32 array, shape (n,)
        Samples of one channel.

    Returns
    -------
    float
        Semitones, -0.5..0.5.
    """
    total = 0.0 + 0.0j
    for power in _spectra(sound, _TUNED_FRAME, _TUNED_FRAME // 2):
        level = np.log(power + 1e-12)
        frame, line = np.nonzero((level[:, 1:-1] > level[:, :-2]) & (level[:, 1:-1] > level[:, 2:]))
        below, peak, above = level[frame, line], level[frame, line + 1], level[frame, line + 2]
        # Vertex of the parabola through the three values.
        hz = (line + 1 + 0.5 * (below - above) / (below - 2.0 * peak + above)) * rate_hz / _TUNED_FRAME
        weights = np.exp(0.5 * peak) * ((hz > _PITCHED_HZ[0]) & (hz < _PITCHED_HZ[1]))
        total += complex((weights * np.exp(2j * np.pi * 12.0 * np.log2(hz / _A4_HZ))).sum())
    return float(np.angle(total) / (2.0 * np.pi))


def chroma(sound: Sound, rate_hz: int, size: int, hop: int, tuned: float) -> FloatArray:
    """Return the energy of each pitch class, C first.

    Parameters
    ----------
    sound : float32 array, shape (n,)
        Samples of one channel.
    size, hop : int
        Samples of a spectrum, and distance of spectra; the first is centred on the first sample.
    tuned : float
        Semitones above 440 Hz, as returned by `tuning`.

    Returns
    -------
    float64, shape (12, frames)
        Energy of each pitch class in each frame.
    """
    lines = np.arange(1, size // 2 + 1)
    octaves = np.log2(lines * rate_hz / size / _A4_HZ)
    apart = (12.0 * octaves[:, None] + 9.0 - tuned - np.arange(12) + 6.0) % 12.0 - 6.0
    # Low spectral lines are further apart than semitones: each counts for every semitone it may belong to.
    spread = np.maximum(_SPREAD, 6.0 * np.log2((lines + 1) / lines))[:, None]
    weights = np.exp(-0.5 * (apart / spread) ** 2)
    weights /= weights.sum(axis=1, keepdims=True)
    weights *= np.exp(-0.5 * ((octaves - np.log2(_CENTRE_HZ / _A4_HZ)) / _OCTAVES) ** 2)[:, None]
    return np.concatenate([power[:, 1:] @ weights for power in _spectra(sound, size, hop)]).T


def onset_strength(sound: Sound, rate_hz: int, size: int, hop: int) -> FloatArray:
    """Return the increase in loudness since the previous frame, summed over auditory bands (spectral flux).

    Parameters
    ----------
    sound : float32 array, shape (n,)
        Samples of one channel.
    size, hop : int
        Samples of a spectrum, and distance of spectra; the first is centred on the first sample.

    Returns
    -------
    float64, shape (frames,)
        Increase in loudness in each frame.
    """
    edges = np.geomspace(_LOWEST_BAND_HZ, rate_hz / 2, _BANDS, endpoint=False) * size / rate_hz
    starts = np.unique(np.round(edges).astype(np.intp))
    # Energy of a window, distributed over the bands.
    mean = max(float(np.square(sound, dtype=np.float64).mean()) * size**2 / 8 / len(starts), 1e-12)
    result: list[FloatArray] = []
    before: FloatArray | None = None
    for power in _spectra(sound, size, hop):
        level = np.log1p(_COMPRESSION / mean * np.add.reduceat(power, starts, axis=1))
        rise = np.diff(level, axis=0, prepend=level[:1] if before is None else before)
        result.append(np.maximum(rise, 0.0).mean(axis=1))
        before = level[-1:]
    return np.concatenate(result)


def _spectra(sound: Sound, size: int, hop: int) -> Iterator[FloatArray]:
    """Yield power spectra (frames, size // 2 + 1) of a sound, a limited number of frames at a time; ``hop`` is the
    number of samples from frame to frame."""
    padded = np.pad(sound, size // 2)
    frames = np.lib.stride_tricks.sliding_window_view(padded, size)[::hop]
    window = np.hanning(size + 1)[:-1].astype(np.float32)
    for first in range(0, len(frames), _FRAMES):
        spectrum = np.fft.rfft(frames[first : first + _FRAMES] * window, axis=1)
        yield spectrum.real.astype(np.float64) ** 2 + spectrum.imag.astype(np.float64) ** 2
