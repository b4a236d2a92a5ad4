"""Log odds of every hit in the music during each segment of a choreography."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.drums_of_dancers import DancersDrums, beats_at, drums_of
from app.choreography.hidden_markov import count
from app.choreography.model import ChoreographyModel
from app.choreography.rhythm import SYMBOLS, Rhythm

OF_ALL: Final = 2.0
"""Weight of the sounds heard with any dancer in the estimate for one dancer, as a number of sounds."""
STRUCK: Final = 0.6
"""Share of a hit's log odds at its own time; the rest is spread over the time until the next sound."""
LASTS_S: Final = 1.0
"""Longest time in seconds over which the log odds of a hit are spread."""
PARTS: Final = 4
"""Number of equal parts of the spread share."""
MOST_MELODY: Final = 2.0
"""Weight of a melody of the amount 1 relative to percussion; one of the usual amount 0.5 has half the weight of
percussion.
"""
SAME_S: Final = 1e-6


@dataclass(frozen=True, eq=False)
class HeardHits:
    """The drum hits of a piece as H parts of hits, with the log odds of each sounding during each of S segments.

    Attributes
    ----------
    times_s : (H,) float64
        Ascending times of the parts in seconds.
    summed : (H + 1, S) float64
        Cumulative sums of the log odds of all earlier parts for each segment.
    """

    times_s: FloatArray
    summed: FloatArray

    def before(self, at_s: FloatArray | float) -> IntArray:
        """Number of hits before each given time; a hit exactly at the time (within rounding) does not count."""
        return np.asarray(np.searchsorted(self.times_s, np.asarray(at_s) - SAME_S))

    def between(self, start_s: FloatArray | float, stop_s: FloatArray | float) -> FloatArray:
        """Sum (S,) of the log odds of all hits between two times, for each of S segments; the times may differ by
        segment.
        """
        first, stop = self.before(start_s), self.before(stop_s)
        segments = np.arange(self.summed.shape[1])
        return np.asarray(self.summed[stop, segments] - self.summed[first, segments])


@dataclass(frozen=True, eq=False)
class SoundOdds:
    """Log odds of each of 47 sounds during each of S segments of a model, as the sum of two parts.

    Attributes
    ----------
    of_dancers : (S, 47) float64
        Mean over the segments of each clip: the sounds to which its dancer danced.
    of_motions : (S, 47) float64
        Additional log odds of each segment's motion.
    drums : DancersDrums
        Sounds to which each dancer was captured.
    """

    of_dancers: FloatArray
    of_motions: FloatArray
    drums: DancersDrums

    def of_hits(self, rhythm: Rhythm, *, any_dancer: bool) -> FloatArray:
        """Log odds (H, S) of each of H drum hits for each of S segments; with ``any_dancer`` including those of the
        segments' dancers.
        """
        found = self.of_motions[:, rhythm.symbols].T
        if not any_dancer or len(rhythm.beats_s) < 2:
            return found
        like = self.drums.likeness(rhythm)[0][beats_at(rhythm, rhythm.hits_s)]
        return np.asarray(found + like[:, None] * self.of_dancers[:, rhythm.symbols].T)


@dataclass(frozen=True, eq=False)
class Hearing:
    """Log odds with which sounds belong to the segments of a model, relative to how frequent the sounds are.

    Attributes
    ----------
    percussion, melody : SoundOdds
        Melody, bass and accents replace drums (`app.choreography.derived_rhythm`): in a piece without percussion they
        count as percussion, otherwise as ``melody``.
    """

    percussion: SoundOdds
    melody: SoundOdds

    def hits(self, rhythm: Rhythm, melody: float, *, any_dancer: bool = True) -> HeardHits:
        """Return the hits of a piece with their log odds for each segment, weighted by strength and partly spread
        over the time until the next sound (`STRUCK`), regardless of their position within a segment.

        Parameters
        ----------
        melody : float
            Amount 0..1 of melody, bass and accents relative to percussion; their weight is `MOST_MELODY` times its
            square, so that it is felt from small amounts up to 1.
        any_dancer : bool
            Whether sounds decide about the dancer and not only about the motion.
        """
        struck = self.percussion.of_hits(rhythm, any_dancer=any_dancer)
        times_s, scores = _spread(rhythm.hits_s, rhythm.strengths[:, None] * struck)
        tune = rhythm.melody
        if tune is not None and melody:
            beside = (
                MOST_MELODY * melody**2 * tune.strengths[:, None] * self.melody.of_hits(tune, any_dancer=any_dancer)
            )
            tune_s, beside = _spread(tune.hits_s, beside)
            times_s, scores = np.concatenate([times_s, tune_s]), np.concatenate([scores, beside])
        order = np.argsort(times_s, kind="stable")
        summed = np.cumsum(scores[order], axis=0)
        return HeardHits(times_s[order], np.concatenate([np.zeros((1, scores.shape[1])), summed]))


def _spread(times_s: FloatArray, scores: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Divide each of H hits into a part at its own time and others until the next sound, so that motions between two
    hits follow the last one: the times (P,) of the parts, and their log odds (P, S).

    Hits without information, such as those of sounds that were never learned, are left out, and end no other sound.
    """
    telling = scores.any(axis=1)
    times_s, scores = times_s[telling], scores[telling]
    sounding_s, at = np.unique(times_s, return_inverse=True)
    lasts_s = np.minimum(np.diff(sounding_s, append=np.inf), LASTS_S)[at]
    after = np.append(0.0, (np.arange(PARTS) + 0.5) / PARTS)
    shares = np.append(STRUCK, np.full(PARTS, (1.0 - STRUCK) / PARTS))
    parts_s = times_s[:, None] + lasts_s[:, None] * after
    return parts_s.ravel(), (scores[:, None, :] * shares[:, None]).reshape(-1, scores.shape[1])


def hearing(model: ChoreographyModel, trust: float = 1.0) -> Hearing:
    """Compute the log odds of sounds for a model's segments; a model without melodies uses the percussion that they
    replace.

    Parameters
    ----------
    trust : float
        Weight of a motion's own sounds beyond its dancer's (`app.choreography.music_motion_dependence.trust_in`).
    """
    percussion = _odds(model, [one.sounds for one in model.segments], model.emission, learned_symbols(model), trust)
    melodies = [one.melody for one in model.segments]
    known = tuple(set().union(*melodies))
    if not known:
        return Hearing(percussion, percussion)
    states = np.array([one.state for one in model.segments], np.int64)
    symbols = [np.array(own, np.int64) for own in melodies]
    _, emission, _ = count([states], [symbols], model.states, smoothing=1.0)
    return Hearing(percussion, _odds(model, melodies, emission, known, trust))


def _odds(
    model: ChoreographyModel,
    symbols: Sequence[Sequence[int]],
    emission: FloatArray,
    known: Sequence[int],
    trust: float,
) -> SoundOdds:
    """Return the log odds of each sound (``symbols``) during each segment.

    A basic motion of several dancers was danced to the drums of each; those of its own dancer have most weight. A
    symbol that was never heard gives no information, although smoothing alone would favour the motions with fewest
    sounds.
    """
    states = np.array([one.state for one in model.segments], np.int64)
    clips = np.array([one.clip for one in model.segments], np.int64)
    counts = np.zeros((model.states, len(model.clips), len(SYMBOLS)))
    for one, sounding in zip(model.segments, symbols, strict=True):
        np.add.at(counts[one.state, one.clip], list(sounding), 1.0)
    own = counts + OF_ALL * emission[:, None, :]
    shares = (own / own.sum(axis=-1, keepdims=True))[states, clips]
    log_odds = np.zeros(shares.shape)
    log_odds[:, list(known)] = np.log(shares / shares.mean(axis=0))[:, list(known)]
    of_dancers = np.zeros(log_odds.shape)
    for clip in np.unique(clips):
        of_dancers[clips == clip] = log_odds[clips == clip].mean(axis=0)
    return SoundOdds(of_dancers, trust * (log_odds - of_dancers), drums_of(clips, symbols, len(model.clips)))


def learned_symbols(model: ChoreographyModel) -> tuple[int, ...]:
    """Return the percussion symbols that occurred in training: those more probable for a motion than by smoothing
    alone."""
    least = model.emission.min(axis=1, keepdims=True)
    return tuple(np.flatnonzero((model.emission > least * (1.0 + 1e-9)).any(axis=0)).tolist())
