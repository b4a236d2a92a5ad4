"""Sound on the time line of the performance: segments, tracks of segments, and the mix of tracks."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from app.arrays import SingleArray

Samples: TypeAlias = npt.NDArray[np.int16]
Block: TypeAlias = SingleArray

RATE_HZ: Final = 48000
"""Sample rate of the mix in Hz; sound for devices of another rate is resampled."""
_FULL_SCALE: Final = 1.0 / 32768.0
_KNEE: Final = 0.8
"""Amplitude above which peaks are compressed instead of clipped."""


@dataclass(frozen=True, eq=False)
class AudioSegment:
    """Samples with a start time.

    Attributes
    ----------
    start : int
        Performance time of the first sample, in samples; may be negative.
    samples : int16 array, shape (n,) or (n, 2)
        Mono or stereo samples.
    """

    start: int
    samples: Samples


class MixTrack:
    """Segments of sound with one loudness and place in the mix; they may overlap.

    Parameters
    ----------
    left, right : float
        Gains of the two channels.
    """

    def __init__(self, pieces: Iterable[AudioSegment], left: float = 1.0, right: float = 1.0) -> None:
        self.pieces = tuple(sorted(pieces, key=lambda piece: piece.start))
        self.gains = np.array([left, right], np.float32) * np.float32(_FULL_SCALE)

    @cached_property
    def _starts(self) -> list[int]:
        return [piece.start for piece in self.pieces]

    @cached_property
    def _longest(self) -> int:
        return max((len(piece.samples) for piece in self.pieces), default=0)

    def moved(self, samples: int) -> MixTrack:
        """Return the track delayed by a number of samples."""
        track = MixTrack(AudioSegment(piece.start + samples, piece.samples) for piece in self.pieces)
        track.gains = self.gains
        return track

    @property
    def end(self) -> int:
        """Return the end of the last segment in samples; 0 if there are none."""
        return max((piece.start + len(piece.samples) for piece in self.pieces), default=0)

    def add_to(self, out: Block, start: int) -> None:
        """Add the track's sound from the sample ``start`` on to a block."""
        end = start + len(out)
        first = bisect_left(self._starts, start - self._longest)
        for piece in self.pieces[first : bisect_right(self._starts, end)]:
            begin, stop = max(piece.start, start), min(piece.start + len(piece.samples), end)
            if begin < stop:
                part = piece.samples[begin - piece.start : stop - piece.start]
                out[begin - start : stop - start] += (part if part.ndim == 2 else part[:, None]) * self.gains


class Mix:
    """The sum of tracks; immutable, so that it can be read while another is made."""

    def __init__(self, tracks: Iterable[MixTrack] = ()) -> None:
        self.tracks = tuple(tracks)

    def read(self, start: int, count: int) -> Block:
        """Return the sound from a sample on.

        Returns
        -------
        float32 array, shape (count, 2)
            Within -1..1.
        """
        out = np.zeros((count, 2), np.float32)
        for track in self.tracks:
            track.add_to(out, start)
        return soft_clipped(out)


def soft_clipped(block: Block) -> Block:
    """Compress the peaks of a block below full scale; softer blocks are unchanged."""
    size = np.abs(block)
    if block.size == 0 or size.max() <= _KNEE:
        return block
    room = np.float32(1.0 - _KNEE)
    bent = np.float32(_KNEE) + room * np.tanh((size - np.float32(_KNEE)) / room)
    return np.where(size > _KNEE, np.copysign(bent, block), block).astype(np.float32)
