"""The music as a dancer receives it: times of beats, bars and drum hits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray

SYMBOLS: Final = tuple(range(35, 82))
"""The 47 percussion sounds of General MIDI System Level 1: symbol n is note 35 + n."""


@dataclass(frozen=True, eq=False)
class Rhythm:
    """Beats and percussion hits of a piece in seconds from its first tick.

    Attributes
    ----------
    beats_s : (N,) float64
        Ascending times of the felt beats, from the first tick to after the last hit or note.
    bar_beats : (N,) int
        Place of each beat in its bar from 0 (the downbeat).
    hits_s : (H,) float64
        Ascending times of the hits.
    symbols : (H,) int
        Sound of each hit, 0..46, see `SYMBOLS`.
    strengths : (H,) float64
        0..1, the velocity of each hit.
    derived : bool
        Whether the piece has no percussion, so that the symbols were derived from melody, bass and accents.
    divisions : (N,) int, optional
        Division of each beat by the metre: 3 for a dotted quarter of six eighths; 2 by default.
    melody : Rhythm, optional
        Hits for melody, bass and accents in addition to percussion.
    written : (N,) bool, optional
        Whether each beat is one of the piece itself; dancers may feel others in between, see `felt_at`.
    """

    beats_s: FloatArray
    bar_beats: IntArray
    hits_s: FloatArray
    symbols: IntArray
    strengths: FloatArray
    derived: bool
    divisions: IntArray | None = None
    melody: Rhythm | None = None
    written: BoolArray | None = None

    @property
    def end_s(self) -> float:
        """Time in seconds of the last beat or hit; 0 without any."""
        last_s = 0.0 if self.melody is None else self.melody.end_s
        return float(np.concatenate([[last_s], self.beats_s[-1:], self.hits_s[-1:]]).max())

    @property
    def closes_s(self) -> float:
        """Time in seconds of the last accent: the last hit, also of the melody, or the last downbeat if that is later;
        without hits the last beat.
        """
        hits_s = np.concatenate([self.hits_s[-1:], () if self.melody is None else self.melody.hits_s[-1:]])
        downbeats_s = self.beats_s[self.bar_beats == 0]
        return float(np.concatenate([hits_s, downbeats_s[-1:]]).max()) if len(hits_s) else self.end_s


def are_alike(one: Rhythm | None, other: Rhythm | None) -> bool:
    """Return whether two rhythms have equal beats and hits, so that dances to them are equal."""
    if one is None or other is None:
        return one is other
    arrays = ("beats_s", "bar_beats", "hits_s", "symbols", "strengths", "divisions", "written")
    same = all(np.array_equal(getattr(one, name), getattr(other, name)) for name in arrays)
    return same and are_alike(one.melody, other.melody)


def delayed(rhythm: Rhythm, beats: float) -> Rhythm:
    """Shift a rhythm by a number of beats at its own tempo, for a dancer who enters later in a canon."""
    if len(rhythm.beats_s) < 2:
        return rhythm
    count = np.arange(len(rhythm.beats_s), dtype=np.float64)
    # The last tempo continues after the last beat.
    more = np.arange(1, int(np.ceil(beats)) + 2)
    all_s = np.concatenate([rhythm.beats_s, rhythm.beats_s[-1] + more * (rhythm.beats_s[-1] - rhythm.beats_s[-2])])
    numbers = np.arange(len(all_s), dtype=np.float64)

    def later_s(places: FloatArray) -> FloatArray:
        return np.asarray(np.interp(places + beats, numbers, all_s))

    def later(one: Rhythm) -> Rhythm:
        melody = None if one.melody is None else later(one.melody)
        hits_s = later_s(np.interp(one.hits_s, rhythm.beats_s, count))
        return replace(one, beats_s=later_s(count), hits_s=hits_s, melody=melody)

    return later(rhythm)


FAR: Final = 1.96
"""Ratio between a tempo and a dancer's own from which the beat is felt at half or double time; slightly below 2, so
that a piece at exactly half or double the tempo is treated equally despite rounding.
"""
BEAT_S: Final = 0.5
"""Beat in seconds of a dancer without steps."""
LONGEST_BEAT_S: Final = 2.0
"""Longest beat in seconds of a dancer; with a longer time between them, footfalls are no steps."""


def own_beat_s(gaps_s: FloatArray) -> float:
    """Return a dancer's own beat in seconds: the mean of the middle half of the times between footfalls, or `BEAT_S` if
    that is longer than `LONGEST_BEAT_S`.

    A footfall found a frame earlier or later changes it by a small part of a frame; it would change a median by a whole
    frame.

    Parameters
    ----------
    gaps_s : (N,) float64
        Times between footfalls in seconds.
    """
    if not len(gaps_s):
        return BEAT_S
    quarter = len(gaps_s) // 4
    beat_s = float(np.mean(np.sort(gaps_s)[quarter : len(gaps_s) - quarter]))
    return beat_s if beat_s <= LONGEST_BEAT_S else BEAT_S


def pace_of(rhythm: Rhythm, beat_s: float, fastest: float) -> float:
    """Return the speed, relative to the usual one, at which a dancer with beats of ``beat_s`` moves to a rhythm: 1 to
    music as slow as these beats or slower, at most ``fastest``.
    """
    if len(rhythm.beats_s) < 2:
        return 1.0
    return float(np.clip(beat_s / np.median(np.diff(rhythm.beats_s)), 1.0, fastest))


def felt_at(rhythm: Rhythm, beat_s: float) -> Rhythm:
    """Return the rhythm as felt by a dancer with beats of ``beat_s``: much slower beats are divided as by the metre,
    much faster ones grouped by twos or threes if every bar allows this.
    """
    if len(rhythm.beats_s) < 2:
        return rhythm
    usual_s = float(np.median(np.diff(rhythm.beats_s)))
    divisions = np.full(len(rhythm.beats_s), 2) if rhythm.divisions is None else rhythm.divisions
    if usual_s >= FAR * beat_s:
        count = np.append(divisions[:-1], 1)
        part = np.concatenate([np.arange(parts) for parts in count.tolist()])
        beats = np.repeat(np.arange(len(count)), count)
        divided = replace(
            rhythm,
            beats_s=np.interp(beats + part / count[beats], np.arange(len(count)), rhythm.beats_s),
            bar_beats=(rhythm.bar_beats * divisions)[beats] + part,
            divisions=np.full(len(beats), 2),
            written=(part == 0) & (True if rhythm.written is None else rhythm.written[beats]),
        )
        return felt_at(divided, beat_s)
    downbeats = np.flatnonzero(rhythm.bar_beats == 0)
    bars = np.diff(downbeats)
    if usual_s * FAR <= beat_s and len(bars):
        for together in (2, 3):
            if not (bars % together).any():
                kept = rhythm.bar_beats % together == 0
                joined = replace(
                    rhythm,
                    beats_s=rhythm.beats_s[kept],
                    bar_beats=rhythm.bar_beats[kept] // together,
                    divisions=np.full(int(kept.sum()), together),
                )
                return felt_at(joined, beat_s)
    return rhythm
