"""Music as the segments of a choreography hear it: log odds of every hit in each of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.model import ChoreographyModel
from app.choreography.rhythm import SYMBOLS, Rhythm

OF_ALL: Final = 2.0
"""Weight of what a basic motion sounded to with all dancers, in sounds of its own with one."""
SAME_S: Final = 1e-6


@dataclass(frozen=True, eq=False)
class HeardHits:
    """Hits of a piece as log odds of each segment.

    Attributes
    ----------
    times_s : (H,) float64
        Ascending.
    summed : (H + 1, S) float64
        Log odds of all hits before each one, if they sounded during the segment.
    """

    times_s: FloatArray
    summed: FloatArray

    def before(self, at_s: FloatArray | float) -> IntArray:
        """Numbers of hits before some times; a hit at a time, but for rounding, is not before it."""
        return np.asarray(np.searchsorted(self.times_s, np.asarray(at_s) - SAME_S))

    def between(self, start_s: FloatArray | float, stop_s: FloatArray | float) -> FloatArray:
        """(S,) log odds of the hits in a span of each segment, or in one span."""
        first, stop = self.before(start_s), self.before(stop_s)
        segments = np.arange(self.summed.shape[1])
        return np.asarray(self.summed[stop, segments] - self.summed[first, segments])


def heard_hits(rhythm: Rhythm, log_emission: FloatArray) -> HeardHits:
    """The hits of a piece, each counted by its strength wherever in a segment it is, as when they are learned.

    Parameters
    ----------
    log_emission : (S, 47) float64
        See `log_emission`.
    """
    summed = np.zeros((len(rhythm.hits_s) + 1, len(log_emission)))
    np.cumsum(rhythm.strengths[:, None] * log_emission[:, rhythm.symbols].T, axis=0, out=summed[1:])
    return HeardHits(rhythm.hits_s, summed)


def log_emission(model: ChoreographyModel) -> FloatArray:
    """(S, 47) log odds of each symbol during each segment, against how often it sounds at all.

    A basic motion of several dancers sounded to the drums of each: those of its own dancer count most. A symbol that
    was never heard tells nothing; smoothing alone would have it of the motions that heard least.
    """
    states = np.array([one.state for one in model.segments], np.int64)
    clips = np.array([one.clip for one in model.segments], np.int64)
    counts = np.zeros((model.states, len(model.clips), len(SYMBOLS)))
    for one in model.segments:
        np.add.at(counts[one.state, one.clip], list(one.sounds), 1.0)
    own = counts + OF_ALL * model.emission[:, None, :]
    emission = (own / own.sum(axis=-1, keepdims=True))[states, clips]
    log_odds = np.zeros(emission.shape)
    known = list(learned_symbols(model))
    log_odds[:, known] = np.log(emission / emission.mean(axis=0))[:, known]
    return log_odds


def learned_symbols(model: ChoreographyModel) -> tuple[int, ...]:
    """Percussion symbols that were counted with some state: those that are more probable in it than by smoothing alone,
    which is what the least probable symbol of a state has."""
    least = model.emission.min(axis=1, keepdims=True)
    return tuple(np.flatnonzero((model.emission > least * (1.0 + 1e-9)).any(axis=0)).tolist())
