"""Dancers by their drums: whose captured dances are danced to a piece, beat by beat.

Where drums are like those that dancers were captured or learned with, the sounds decide. Other drums decide nothing:
each of many hits that no dancer heard as often would speak a little for one and the same dancer, and only that one
would dance. There everyone dances, each as much as there is of their dances.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.rhythm import SYMBOLS, Rhythm

WINDOW_BEATS: Final = 16
"""Sounds are compared over so many beats, half of them before each."""
LIKE: Final = 0.18
"""Relative entropy, in natural units a hit, of drums from the nearest mixture of those of the dancers, at which they
are taken for half unlike. Other takes of the drums that were learned from are at 0.05 to 0.15, other pieces of their
styles at 0.25, other drums at 0.5 to 2.5."""
STEEP: Final = 4.0
TELLING: Final = 0.1
"""Relative entropy by which drums are farther from those of one dancer than of another who dances e times as much."""
OF_ALL: Final = 2.0
"""Weight of the drums of all dancers in those of each, in sounds: few were heard, and others may come."""
_ROUNDS: Final = 40


@dataclass(frozen=True, eq=False)
class DancersDrums:
    """Sounds that the dancers of a model were learned with.

    Attributes
    ----------
    shares : (K, 47) float64
        Of each dancer's (each clip's) sounds; 0 of those that none heard.
    """

    shares: FloatArray

    def likeness(self, rhythm: Rhythm) -> tuple[FloatArray, FloatArray]:
        """Return by beat how alike a piece's sounds are to those of the dancers, and how unlike to those of each.

        Returns
        -------
        like : (N,) float64
            0..1; 0 where nothing sounds that a dancer heard.
        unlike : (N, K) float64
            Relative entropies.
        """
        known = self.shares.any(axis=0)
        counts, shares = _around(rhythm)[:, known], self.shares[:, known]
        heard = counts.sum(axis=1)
        struck = counts / np.maximum(heard, 1.0)[:, None]
        itself = np.sum(struck * np.log(np.maximum(struck, 1e-12)), axis=1)
        unlike = itself[:, None] - struck @ np.log(shares).T
        # The nearest mixture: expectation maximisation, of which every round comes nearer.
        parts = np.full(unlike.shape, 1.0 / max(len(shares), 1))
        for _ in range(_ROUNDS if known.any() else 0):
            parts = parts * ((struck / np.maximum(parts @ shares, 1e-12)) @ shares.T)
        mixed = itself - np.sum(struck * np.log(np.maximum(parts @ shares, 1e-12)), axis=1)
        like = np.exp(-((np.maximum(mixed, 0.0) / LIKE) ** STEEP))
        return np.where(heard > 0.0, like, 0.0), unlike


def drums_of(clips: IntArray, symbols: Sequence[Sequence[int]], count: int) -> DancersDrums:
    """Return what the dancers heard: the sounds of each segment, and its clip, of so many."""
    counts = np.zeros((count, len(SYMBOLS)))
    for clip, sounding in zip(clips.tolist(), symbols, strict=True):
        np.add.at(counts[clip], list(sounding), 1.0)
    total = counts.sum()
    if not total:
        return DancersDrums(counts)
    own = counts + OF_ALL * counts.sum(axis=0) / total
    return DancersDrums(own / own.sum(axis=1, keepdims=True))


@dataclass(frozen=True, eq=False)
class TakeShares:
    """Takes of a model, and how much of each is danced when.

    Attributes
    ----------
    takes : (S,) int64
        Clip of each segment.
    shares : (G, K) float64
        Of each take, at each place of a grid; rows sum to 1.
    """

    takes: IntArray
    shares: FloatArray


def take_shares(
    drums: DancersDrums, rhythm: Rhythm, times_s: FloatArray, takes: IntArray, lasting: FloatArray
) -> TakeShares:
    """Return how much of each take is to be danced at some times.

    Parameters
    ----------
    lasting : (S,) float64
        Of each segment, how long it is.
    """
    captured = np.bincount(takes, lasting, len(drums.shares))
    if len(rhythm.beats_s) < 2:
        shares = np.tile(captured, (len(times_s), 1))
    else:
        like, unlike = drums.likeness(rhythm)
        nearer = (unlike - unlike.min(axis=1, keepdims=True)) * like[:, None] / TELLING
        shares = (captured * np.exp(-nearer))[beats_at(rhythm, times_s)]
    return TakeShares(takes, shares / np.maximum(shares.sum(axis=1, keepdims=True), 1e-12))


def beats_at(rhythm: Rhythm, times_s: FloatArray) -> IntArray:
    """Numbers of the beats during which times are."""
    return np.clip(np.searchsorted(rhythm.beats_s, times_s + 1e-6, side="right") - 1, 0, len(rhythm.beats_s) - 1)


def _around(rhythm: Rhythm) -> FloatArray:
    """(N, 47) how often each sound is struck about each beat."""
    counts = np.zeros((len(rhythm.beats_s) + 1, len(SYMBOLS)))
    np.add.at(counts, (1 + beats_at(rhythm, rhythm.hits_s), rhythm.symbols), 1.0)
    summed = np.cumsum(counts, axis=0)
    beats = np.arange(len(rhythm.beats_s))
    first = np.maximum(0, beats - WINDOW_BEATS // 2)
    return np.asarray(summed[np.minimum(beats + WINDOW_BEATS // 2, len(beats))] - summed[first])
