"""Change of speed without change of pitch in a stream, by waveform-similarity overlap-add (WSOLA).

Verhelst and Roelands, "An overlap-add technique based on waveform similarity (WSOLA) for high quality time-scale
modification of speech" (ICASSP 1993). Unsuitable libraries: Rubber Band is under GPL, python-stretch restarts with
every block, audiotsm is unmaintained.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from app.arrays import FloatArray, SingleArray
from app.audio.track import RATE_HZ, Block

HOP: Final = round(0.03 * RATE_HZ)
"""Number of samples generated in a step."""
_LENGTH: Final = 2 * HOP
_SEARCH: Final = round(0.012 * RATE_HZ)
"""Greatest distance in samples of a frame from its ideal position: more than half a period of the lowest wind notes."""
_COARSE: Final = 4
_WINDOW: Final = np.hanning(_LENGTH + 1)[:-1].astype(np.float32)[:, None]


class TimeStretcher:
    """Time stretcher for a stream of samples.

    Parameters
    ----------
    more : callable
        Function that returns a number of further samples of the stream, float32, shape (n, 2).
    """

    def __init__(self, more: Callable[[int], Block]) -> None:
        self._more = more
        self._input = np.zeros((0, 2), np.float32)
        self._first = 0
        """Place in the stream of the buffer's first sample."""
        self._ideal = 0.0
        self._before: int | None = None
        """Place of the frame before."""
        self._tail = np.zeros((HOP, 2), np.float32)

    @property
    def position(self) -> float:
        """Return the position in the input stream, in samples, that the next output corresponds to."""
        return self._ideal

    def step(self, speed: float) -> Block:
        """Return the next `HOP` samples at a speed."""
        ideal = round(self._ideal)
        self._fill(max(ideal + _SEARCH, (self._before or 0) + HOP) + _LENGTH)
        at = ideal if self._before is None else self._best(ideal)
        frame = self._input[at - self._first : at - self._first + _LENGTH] * _WINDOW
        out = frame[:HOP] + self._tail
        if self._before is None:
            # No sound precedes the beginning, so it is not faded in.
            out = self._input[at - self._first : at - self._first + HOP].copy()
        self._tail = frame[HOP:].copy()
        self._before = at
        self._ideal += HOP * speed
        self._drop(min(round(self._ideal) - _SEARCH, at + HOP))
        return out

    def _best(self, ideal: int) -> int:
        """Return the position near ``ideal`` at which the input continues the previous output most smoothly."""
        assert self._before is not None
        goes_on = self._before + HOP
        low = max(ideal - _SEARCH, self._first)
        if low <= goes_on <= ideal + _SEARCH and abs(goes_on - ideal) < _COARSE:
            return goes_on
        pattern = self._mono(goes_on, HOP)
        field = self._mono(low, ideal + _SEARCH - low + HOP)
        coarse = _likeness(field[::_COARSE], pattern[::_COARSE])
        near = int(coarse.argmax()) * _COARSE
        start = max(near - _COARSE, 0)
        fine = _likeness(field[start : near + _COARSE + HOP], pattern)
        return low + start + int(fine.argmax())

    def _mono(self, at: int, count: int) -> SingleArray:
        part = self._input[at - self._first : at - self._first + count]
        result: SingleArray = part[:, 0] + part[:, 1]
        return result

    def _fill(self, end: int) -> None:
        missing = end - self._first - len(self._input)
        if missing > 0:
            self._input = np.concatenate([self._input, self._more(missing)])

    def _drop(self, before: int) -> None:
        gone = before - self._first
        if gone > 0:
            self._input = self._input[gone:]
            self._first += gone


def _likeness(field: SingleArray, pattern: SingleArray) -> FloatArray:
    """Return the correlation of a pattern with every position of a signal, normalised by loudness."""
    products = np.correlate(field, pattern, "valid")
    energy = np.concatenate([[0.0], np.cumsum(field.astype(np.float64) ** 2)])
    sizes = np.sqrt(np.maximum(energy[len(pattern) :] - energy[: -len(pattern)], 1e-6))
    result: FloatArray = products / sizes
    return result
