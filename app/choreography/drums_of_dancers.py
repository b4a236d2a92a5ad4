"""Choice of dancers by drums: for each beat of a piece, the captured dancers who danced to similar drums.

If no capture has similar drums, all dancers are used in proportion to the length of their captures, since unfamiliar
sounds would always favour the same dancer. Sounds that only some dancers heard distinguish these whatever unheard drums
are played.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.rhythm import SYMBOLS, Rhythm

WINDOW_BEATS: Final = 16
"""Number of beats over which sounds are compared, half of them before each beat."""
LIKE: Final = 0.18
"""Relative entropy, in natural units per hit, between drums and the nearest mixture of the dancers' drums at which they
count as half unlike. Other takes of the learned drums have 0.05 to 0.15, other pieces of their styles 0.25, other drums
0.5 to 2.5.
"""
STEEP: Final = 4.0
TOLD: Final = 0.75
"""Mean information of the hits about the dancer, 0..1, at which it is half sufficient, whatever unheard drums are
played. Drums of which each dancer heard only some have 0.9 or more, other pieces with common drums 0.1 to 0.6.
"""
STEEP_TOLD: Final = 8.0
TELLING: Final = 0.1
"""Difference of relative entropy between two dancers at which one is used e times as much as the other."""
CLEAR: Final = 3.0
"""Log odds against a take, from drums alone, from which they count against each of its motions, and not only against
its turns (`app.choreography.take_turns`). 3 is a twentieth of its usual share.
"""
MOST_AGAINST: Final = 9.0
"""Greatest log odds against a motion by this."""
OF_ALL: Final = 2.0
"""Weight of all dancers' drums in each dancer's, as a number of sounds, to allow for sounds that were not heard."""
_ROUNDS: Final = 40


@dataclass(frozen=True, eq=False)
class DancersDrums:
    """Sounds to which the dancers of a model were captured.

    Attributes
    ----------
    shares : (K, 47) float64
        Share of each sound for each dancer (clip); 0 for sounds that no dancer heard.
    """

    shares: FloatArray

    def likeness(self, rhythm: Rhythm) -> tuple[FloatArray, FloatArray]:
        """Compare the drum sounds around each beat of a piece with those that the dancers heard.

        Returns
        -------
        like : (N,) float64
            For each beat the similarity to the sounds of all dancers, or the information about the dancer, 0..1; 0
            without familiar sounds.
        unlike : (N, K) float64
            For each beat the dissimilarity to each dancer's sounds, as relative entropy.
        """
        known = self.shares.any(axis=0)
        counts, shares = _around(rhythm)[:, known], self.shares[:, known]
        heard = counts.sum(axis=1)
        struck = counts / np.maximum(heard, 1.0)[:, None]
        itself = np.sum(struck * np.log(np.maximum(struck, 1e-12)), axis=1)
        unlike = itself[:, None] - struck @ np.log(shares).T
        # Expectation maximisation of the closest mixture; no round makes the distance greater.
        parts = np.full(unlike.shape, 1.0 / max(len(shares), 1))
        for _ in range(_ROUNDS if known.any() else 0):
            parts = parts * ((struck / np.maximum(parts @ shares, 1e-12)) @ shares.T)
        mixed = itself - np.sum(struck * np.log(np.maximum(parts @ shares, 1e-12)), axis=1)
        like = np.exp(-((np.maximum(mixed, 0.0) / LIKE) ** STEEP))
        told = (struck @ _information(shares) / TOLD) ** STEEP_TOLD
        like = np.maximum(like, told / (told + 1.0))
        return np.where(heard > 0.0, like, 0.0), unlike


def _information(shares: FloatArray) -> FloatArray:
    """Information (O,) of each of O sounds about the dancer who heard it: 0 if its shares (K, O) are equal for all K
    dancers, 1 if only one heard it."""
    if len(shares) < 2:
        return np.zeros(shares.shape[1])
    by_dancer = shares / np.maximum(shares.sum(axis=0), 1e-12)
    return np.asarray(1.0 + np.sum(by_dancer * np.log(np.maximum(by_dancer, 1e-12)), axis=0) / np.log(len(shares)))


def drums_of(clips: IntArray, symbols: Sequence[Sequence[int]], count: int) -> DancersDrums:
    """Count the sounds of each dancer (clip), from the sounds and the clip of each segment."""
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
    """Takes of a model, and the share of each over time.

    Attributes
    ----------
    takes : (S,) int64
        Clip of each segment.
    shares : (G, K) float64
        Share of each take at each place of a grid; rows sum to 1.
    usual : (K,) float64
        Share of each take whatever is played.
    """

    takes: IntArray
    shares: FloatArray
    usual: FloatArray

    def against(self, places: slice) -> FloatArray:
        """Log odds (P, S) against each segment at each of P places: 0 unless the drums there are clearly those of other
        takes (`CLEAR`), so that no motion of another dancer slips in between two sounds.
        """
        odds = np.log(np.maximum(self.shares[places], 1e-12) / np.maximum(self.usual, 1e-12))
        return np.asarray(np.where(odds < -CLEAR, np.minimum(-odds, MOST_AGAINST), 0.0)[:, self.takes])


def take_shares(
    drums: DancersDrums, rhythm: Rhythm, times_s: FloatArray, takes: IntArray, lasting: FloatArray
) -> TakeShares:
    """Return the share of each take at given times.

    Parameters
    ----------
    lasting : (S,) float64
        Length of each segment in seconds.
    """
    captured = np.bincount(takes, lasting, len(drums.shares))
    if len(rhythm.beats_s) < 2:
        shares = np.tile(captured, (len(times_s), 1))
    else:
        like, unlike = drums.likeness(rhythm)
        nearer = (unlike - unlike.min(axis=1, keepdims=True)) * like[:, None] / TELLING
        shares = (captured * np.exp(-nearer))[beats_at(rhythm, times_s)]
    usual = captured / max(float(captured.sum()), 1e-12)
    return TakeShares(takes, shares / np.maximum(shares.sum(axis=1, keepdims=True), 1e-12), usual)


def beats_at(rhythm: Rhythm, times_s: FloatArray) -> IntArray:
    """Return for each time the index (N,) of the last beat at or before it, 0 before the first beat."""
    return np.clip(np.searchsorted(rhythm.beats_s, times_s + 1e-6, side="right") - 1, 0, len(rhythm.beats_s) - 1)


def _around(rhythm: Rhythm) -> FloatArray:
    """Return the number of hits (N, 47) of each sound around each beat."""
    counts = np.zeros((len(rhythm.beats_s) + 1, len(SYMBOLS)))
    np.add.at(counts, (1 + beats_at(rhythm, rhythm.hits_s), rhythm.symbols), 1.0)
    summed = np.cumsum(counts, axis=0)
    beats = np.arange(len(rhythm.beats_s))
    first = np.maximum(0, beats - WINDOW_BEATS // 2)
    return np.asarray(summed[np.minimum(beats + WINDOW_BEATS // 2, len(beats))] - summed[first])
