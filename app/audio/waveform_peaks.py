"""Least and greatest sample for each column of a waveform display, fast at every zoom."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from app.arrays import IntArray, SingleArray

Samples: TypeAlias = npt.NDArray[np.int16]

BASE_SAMPLES = 64
"""Samples per bin of the finest level; at closer zoom the samples are drawn."""
FACTOR = 4
"""Number of bins of a level in each bin of the next."""
_PIECE = 1024 * BASE_SAMPLES
_FULL_SCALE = np.float32(1.0 / 32768.0)


class Peaks:
    """Least and greatest samples of a recording, precomputed at several resolutions.

    Parameters
    ----------
    samples : int16 array, shape (samples, channels)
        Samples of the recording; not copied.
    """

    def __init__(self, samples: Samples, rate_hz: int) -> None:
        self.rate_hz = rate_hz
        self._samples = samples
        self._levels: list[tuple[Samples, Samples]] = []
        if not len(samples):
            return
        low, high = _finest(samples)
        self._levels.append((low, high))
        while len(low) > FACTOR:
            low, high = _bins(low, FACTOR, np.minimum), _bins(high, FACTOR, np.maximum)
            self._levels.append((low, high))

    @property
    def duration_s(self) -> float:
        """Length of the recording in seconds."""
        return len(self._samples) / self.rate_hz

    def levels(self, start_s: float, end_s: float, width_px: int) -> tuple[SingleArray, SingleArray]:
        """Return least and greatest samples of a span, one pair per column.

        Parameters
        ----------
        start_s, end_s : float
            Seconds of the recording; silence is assumed beyond its ends.

        Returns
        -------
        low, high : float32 arrays, shape (width_px,)
            Values -1..1 over all channels.
        """
        low, high = np.zeros(width_px, np.float32), np.zeros(width_px, np.float32)
        if width_px <= 0 or end_s <= start_s or not len(self._samples):
            return low, high
        edges = np.linspace(start_s, end_s, width_px + 1) * self.rate_hz
        per_column = (end_s - start_s) * self.rate_hz / width_px
        size, level = 1, -1
        while level + 1 < len(self._levels) and BASE_SAMPLES * FACTOR ** (level + 1) <= per_column:
            level += 1
            size = BASE_SAMPLES * FACTOR**level
        bins = len(self._samples) if level < 0 else len(self._levels[level][0])
        first = np.floor(edges[:-1] / size).astype(np.int64)
        last = np.maximum(np.ceil(edges[1:] / size).astype(np.int64), first + 1)
        inside = (last > 0) & (first < bins)
        if not inside.any():
            return low, high
        first, last = np.clip(first[inside], 0, bins - 1), np.clip(last[inside], 1, bins)
        start, end = int(first[0]), int(last[-1])
        if level < 0:
            lows, highs = _over_channels(self._samples[start:end])
        else:
            lows, highs = (extreme[start:end] for extreme in self._levels[level])
        low[inside] = _reduced(lows, first - start, last - start, np.minimum) * _FULL_SCALE
        high[inside] = _reduced(highs, first - start, last - start, np.maximum) * _FULL_SCALE
        return low, high


def _finest(samples: Samples) -> tuple[Samples, Samples]:
    """Least and greatest value of every `BASE_SAMPLES` samples, computed in pieces that fit the processor's cache."""
    lows, highs = [], []
    for start in range(0, len(samples), _PIECE):
        low, high = _over_channels(samples[start : start + _PIECE])
        lows.append(_bins(low, BASE_SAMPLES, np.minimum))
        highs.append(_bins(high, BASE_SAMPLES, np.maximum))
    return np.concatenate(lows), np.concatenate(highs)


def _over_channels(samples: Samples) -> tuple[Samples, Samples]:
    """Least and greatest value over the channels for each sample, one channel at a time, since numpy is slow along a
    short axis.
    """
    if not samples.shape[1]:
        return np.zeros(len(samples), np.int16), np.zeros(len(samples), np.int16)
    low = high = samples[:, 0]
    for channel in range(1, samples.shape[1]):
        low, high = np.minimum(low, samples[:, channel]), np.maximum(high, samples[:, channel])
    return low, high


def _bins(values: Samples, size: int, of: np.ufunc) -> Samples:
    """Apply ``of`` (`np.minimum` or `np.maximum`) to every ``size`` values; the last bin may be shorter."""
    whole = len(values) // size * size
    result: Samples = of.reduce(values[:whole].reshape(-1, size), axis=1)
    return result if whole == len(values) else np.append(result, of.reduce(values[whole:]))


def _reduced(values: Samples, first: IntArray, last: IntArray, of: np.ufunc) -> Samples:
    """Apply ``of`` (`np.minimum` or `np.maximum`) to ``values[first:last]`` for every column; adjacent columns may
    share a value.
    """
    # reduceat takes pairs of indices and accepts no end equal to the length of the array, hence the padding.
    padded = np.append(values, values[-1:])
    indices = np.empty(2 * len(first), np.int64)
    indices[0::2], indices[1::2] = first, last
    result: Samples = of.reduceat(padded, indices)[0::2]
    return result
