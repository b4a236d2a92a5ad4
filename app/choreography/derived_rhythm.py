"""Rhythm of a piece without percussion: melody, bass and accents replace the sounds of a drum kit.

The future work of K. Kameda, I. Watanabe, M. Yamamoto, "Music Driven Computer Animation Based On HMM". The mapping is
that of a drummer who plays along:

==================  =======================================================================================
Bass drum 1 (36)    The bass: no note that sounds with it or begins within half a beat is lower, and one of them is at
                    least a fifth higher.
Acoustic snare (38)  An accent: a moment that is louder, fuller or longer than those around it.
Crash cymbal 1 (49)  A phrase begins: nothing sounded for a beat.
High tom (50)        The melody leaps up by a fourth or more.
Low tom (45)         The melody leaps down by as much.
Open hi-hat (46)     Another note of the melody that lasts a beat or more.
Closed hi-hat (42)   Another note of the melody.
==================  =======================================================================================

The melody is the highest sounding note ("skyline": A. Uitdenbogerd, J. Zobel, "Manipulation of Music for Melody
Matching", ACM Multimedia 1998). Every hit is at the onset of a note, with the strength of the loudest note beginning
there.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.choreography.percussion import score_rhythm
from app.choreography.rhythm import SYMBOLS, Rhythm
from app.score.model import Score

BASS, ACCENT, PHRASE, LEAP_UP, LEAP_DOWN, LONG, SHORT = (
    SYMBOLS.index(sound) for sound in (36, 38, 49, 50, 45, 46, 42)
)  # fmt: skip
TOGETHER_S: Final = 0.03
"""Time in seconds within which notes begin together."""
FIFTH: Final = 7
LEAP: Final = 5
AROUND_BEATS: Final = 4.0
"""Beats before and after a moment with which it is compared."""
LOUDER: Final = 1.25
FULLER: Final = 2.0
LONGER: Final = 2.0
"""Ratio to the surrounding mean: one quantity with this ratio is an accent, or two with half of it each (as
logarithms).
"""


def audible_rhythm(score: Score) -> Rhythm:
    """Return the rhythm to which a dancer dances: the percussion, with the melody in addition, or the result of
    `derived_rhythm` if there is no percussion.
    """
    rhythm, melody = score_rhythm(score), derived_rhythm(score)
    if not len(rhythm.hits_s):
        return melody
    return replace(rhythm, melody=melody) if len(melody.hits_s) else rhythm


def derived_rhythm(score: Score) -> Rhythm:
    """Derive a rhythm from the parts of a piece without its percussion: beats, and hits for melody, bass
    and accents.
    """
    beats = score_rhythm(score)
    moments = _Moments(score)
    hits: list[tuple[int, int]] = []
    if len(moments.times_s):
        beat_s = _beat_at(beats.beats_s, moments.times_s)
        for moment, symbol in enumerate(moments.melody(beat_s).tolist()):
            if symbol >= 0:
                hits.append((moment, symbol))
        for symbol, there in (
            (BASS, moments.bass(beat_s)),
            (ACCENT, moments.accents(beat_s)),
            (PHRASE, moments.silence_s >= 0.999 * beat_s),
        ):
            hits += [(moment, symbol) for moment in np.flatnonzero(there).tolist()]
    hits.sort()
    at = np.array([moment for moment, _ in hits], np.int64)
    return Rhythm(
        beats_s=beats.beats_s,
        bar_beats=beats.bar_beats,
        hits_s=moments.times_s[at],
        symbols=np.array([symbol for _, symbol in hits], np.int64),
        strengths=moments.velocities[at] / 127.0,
        derived=True,
        divisions=beats.divisions,
    )


class _Moments:
    """Moments at which notes begin, in ascending order.

    Attributes
    ----------
    times_s : (M,) float64
        Times in seconds.
    velocities : (M,) float64
        Velocity of the loudest note that begins.
    counts : (M,) float64
        Number of notes that begin.
    lengths_s : (M,) float64
        Length in seconds of the longest note that begins.
    silence_s : (M,) float64
        Length in seconds of the silence before; infinite before the first.
    """

    def __init__(self, score: Score) -> None:
        notes = [note for part in score.parts for note in part.notes]
        seconds = score.tempo_map.seconds
        starts_s = seconds(np.array([note.onset_tick for note in notes], np.float64))
        order = np.argsort(starts_s, kind="stable")
        self._starts_s = starts_s[order]
        self._ends_s = seconds(np.array([note.end_tick for note in notes], np.float64))[order]
        self._pitches = np.array([note.pitch for note in notes], np.int64)[order]
        velocities = np.array([note.velocity for note in notes], np.float64)[order]
        first: list[int] = []
        for at, start_s in enumerate(self._starts_s.tolist()):
            if not first or start_s - self._starts_s[first[-1]] > TOGETHER_S:
                first.append(at)
        self._first = np.array(first, np.int64)
        self._bounds = [*first, len(notes)]
        self.times_s = self._starts_s[self._first]
        self.velocities = np.maximum.reduceat(velocities, self._first) if first else velocities
        self.counts = np.diff(self._bounds).astype(np.float64)
        self._lengths_s = self._ends_s - self._starts_s
        self.lengths_s = np.maximum.reduceat(self._lengths_s, self._first) if first else self._lengths_s
        self._sounded_s = np.maximum.accumulate(self._ends_s)
        self.silence_s = self.times_s - np.concatenate([[-np.inf], self._sounded_s])[self._first]

    def melody(self, beat_s: FloatArray) -> IntArray:
        """Symbol (M,) of the drum sound that replaces the melody note beginning at each of M moments; -1 if none
        begins.
        """
        found = np.full(len(self.times_s), -1, np.int64)
        last_pitch: int | None = None
        for moment, (time_s, highest) in enumerate(zip(self.times_s, self._begun(np.maximum), strict=True)):
            if highest < self._sounding(time_s + TOGETHER_S).max(initial=0):
                continue
            leap = 0 if last_pitch is None else int(highest) - last_pitch
            last_pitch = int(highest)
            here = slice(self._bounds[moment], self._bounds[moment + 1])
            length_s = self._lengths_s[here][self._pitches[here] == highest].max()
            if abs(leap) >= LEAP:
                found[moment] = LEAP_UP if leap > 0 else LEAP_DOWN
            else:
                found[moment] = LONG if length_s >= 0.9 * beat_s[moment] else SHORT
        return found

    def bass(self, beat_s: FloatArray) -> BoolArray:
        """Return a mask (M,) of the moments at which a note of the bass begins."""
        found = np.zeros(len(self.times_s), bool)
        for moment, (time_s, lowest) in enumerate(zip(self.times_s, self._begun(np.minimum), strict=True)):
            near_s = np.array([-1.0, 1.0]) * (0.5 * beat_s[moment] + 1e-6) + time_s
            start, stop = np.searchsorted(self._starts_s, near_s)
            pitches = np.concatenate([self._sounding(time_s + TOGETHER_S), self._pitches[start:stop]])
            found[moment] = lowest <= pitches.min() and lowest <= pitches.max() - FIFTH
        return found

    def accents(self, beat_s: FloatArray) -> BoolArray:
        """Mask (M,) of the moments that are accents; of several within half a beat only the greatest."""
        salience = np.zeros(len(self.times_s))
        reach_s = AROUND_BEATS * beat_s
        start = np.searchsorted(self.times_s, self.times_s - reach_s)
        stop = np.searchsorted(self.times_s, self.times_s + reach_s, side="right")
        for values, times in ((self.velocities, LOUDER), (self.counts, FULLER), (self.lengths_s, LONGER)):
            summed = np.concatenate([[0.0], np.cumsum(values)])
            mean = (summed[stop] - summed[start]) / (stop - start)
            salience += np.log(values / mean) / np.log(times)
        start = np.searchsorted(self.times_s, self.times_s - 0.5 * beat_s)
        stop = np.searchsorted(self.times_s, self.times_s + 0.5 * beat_s, side="right")
        greatest = [
            salience[first:last].argmax() == at - first
            for at, (first, last) in enumerate(zip(start, stop, strict=True))
        ]
        return np.asarray((salience >= 1.0) & greatest)

    def _begun(self, which: np.ufunc) -> IntArray:
        """Highest or lowest pitch (M,) among the notes that begin at each of M moments; ``which`` is `np.maximum` or
        `np.minimum`.
        """
        return np.asarray(which.reduceat(self._pitches, self._first), np.int64)

    def _sounding(self, time_s: float) -> IntArray:
        """Return the pitches (K,) of all notes that sound at a time."""
        # All notes that begin before the first sounding one have ended.
        start = np.searchsorted(self._sounded_s, time_s, side="right")
        stop = np.searchsorted(self._starts_s, time_s, side="right")
        return np.asarray(self._pitches[start:stop][self._ends_s[start:stop] > time_s])


def _beat_at(beats_s: FloatArray, times_s: FloatArray) -> FloatArray:
    """Return the length (M,) in seconds of the beat at each of M times."""
    if len(beats_s) < 2:
        return np.ones(len(times_s))
    lengths_s = np.diff(beats_s)
    return np.asarray(lengths_s[np.clip(np.searchsorted(beats_s, times_s, side="right") - 1, 0, len(lengths_s) - 1)])
