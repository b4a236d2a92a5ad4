"""Recurring bars of a piece, to which a dancer repeats the previous dance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray, IntArray
from app.choreography.rhythm import Rhythm

POSITIONS: Final = 12
"""Number of distinguished positions of hits within a beat: thirds and quarters."""
AROUND_BARS: Final = 0.7
"""Standard deviation in bars of the Gaussian that averages similarity along two passages."""
APART_BARS: Final = 4
"""Least distance of recurring bars; nearer ones are a continuing pattern."""
UNUSUAL: Final = 2.0
"""Similarity of bars above the mean of the piece, in standard deviations, for a full recurrence."""
LEAST_MORE: Final = 0.1
"""Least difference in similarity (cosine) for a full recurrence, so that no bar recurs if all are alike."""
USUAL_MELODY: Final = 0.5
"""Amount 0..1 of a melody that counts as much as percussion when bars are compared."""
MELODY_RETURNS: Final = 2.0
"""Weight of a recurrence at the amount 1 of a melody, relative to one at the usual amount."""
ANEW: Final = 0.05
"""Share of the bars of a recurring section that are danced anew."""
COPIED_BEATS: Final = 6.0
"""Number of beats that are copied before a recurring section is varied."""
ANOTHER: Final = 0.5
SAME_KIND: Final = 0.6
"""Shares of the value of a recurrence by which, at varied places, the segments danced before lose and others of their
basic motions gain.
"""
_NEAR_BEATS: Final = 1e-3


@dataclass(frozen=True, eq=False)
class ReturningPlaces:
    """Places of a piece compared with those of earlier bars.

    Attributes
    ----------
    bars : (G,) int64
        Bar of each place; -1 before the first downbeat and from the last one on.
    earlier : (G, B) int64
        For each place, the place at the same position of each bar; -1 if there is none.
    worths : (G, B) float64
        Similarity of the place's bar to each earlier bar, relative to the mean of the piece: 1 if it recurs, -1 for the
        opposite, 0 for bars that are not earlier; up to `MELODY_RETURNS` times as much by a melody.
    """

    bars: IntArray
    earlier: IntArray
    worths: FloatArray


def returns_of_bars(rhythm: Rhythm, melody: float = USUAL_MELODY) -> FloatArray:
    """For all pairs of B bars, the similarity (B, B) of a bar to an earlier one relative to the mean of the piece,
    -1..1 times the weight of a recurrence; 0 for bars that are not earlier. A bar lasts from one downbeat to the next.

    Similarity has no scale of its own, since it is relative to its spread. So an amount ``melody`` 0..1 lies between
    the recurrences by percussion (0), by both (`USUAL_MELODY`), and by the melody alone (1, `MELODY_RETURNS`).
    """
    if rhythm.melody is None or melody <= 0.0:
        return _relative(likeness_of_bars(rhythm, 0.0))
    usual = _relative(likeness_of_bars(rhythm))
    if melody == USUAL_MELODY:
        return usual
    if melody < USUAL_MELODY:
        part, other = melody / USUAL_MELODY, _relative(likeness_of_bars(rhythm, 0.0))
    else:
        part = (1.0 - melody) / (1.0 - USUAL_MELODY)
        other = MELODY_RETURNS * _relative(likeness_of_bars(rhythm, 1.0))
    return part * usual + (1.0 - part) * other


def _relative(likeness: FloatArray) -> FloatArray:
    """Return similarities (B, B) relative to their mean and spread, -1..1; 0 for bars that are not earlier."""
    alike = _along_passages(likeness)
    bars = len(alike)
    later = np.tril(np.ones((bars, bars), bool), -APART_BARS)
    pairs = alike[later]
    if not len(pairs):
        return np.zeros((bars, bars))
    more = (alike - pairs.mean()) / max(LEAST_MORE, UNUSUAL * float(pairs.std()))
    return np.where(later, np.clip(more, -1.0, 1.0), 0.0)


def likeness_of_bars(rhythm: Rhythm, melody: float = USUAL_MELODY) -> FloatArray:
    """Cosine similarity (B, B) of the hits in all pairs of B bars, by sound, position and strength; averaged with that
    of the melody if there is one. A melody of the amount 0 does not count at all, one of `USUAL_MELODY` as much as
    percussion, and one of the amount 1 alone.
    """
    struck = _likeness(rhythm)
    if rhythm.melody is None or not melody:
        return struck
    return (1.0 - melody) * struck + melody * _likeness(rhythm.melody)


def _likeness(rhythm: Rhythm) -> FloatArray:
    downbeats = np.flatnonzero(rhythm.bar_beats == 0)
    if len(downbeats) < 2:
        return np.zeros((0, 0))
    beats = np.diff(downbeats)
    hits = np.interp(rhythm.hits_s, rhythm.beats_s, np.arange(len(rhythm.beats_s)))
    places = np.rint(POSITIONS * hits).astype(np.int64)
    bar = np.searchsorted(POSITIONS * downbeats, places, side="right") - 1
    inside = (bar >= 0) & (bar < len(beats))
    sounds, sound = np.unique(rhythm.symbols[inside], return_inverse=True)
    struck = np.zeros((len(beats), max(1, len(sounds)), POSITIONS * int(beats.max())))
    here = bar[inside]
    np.add.at(struck, (here, sound, places[inside] - POSITIONS * downbeats[here]), rhythm.strengths[inside])
    # Strokes are blurred, since drummers are never exactly on the grid.
    flat = gaussian_filter1d(struck, 0.7, axis=-1, mode="constant").reshape(len(beats), -1)
    flat /= np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-9)
    return np.asarray((flat @ flat.T) * (beats[:, None] == beats[None, :]))


def returning_places(rhythm: Rhythm, times_s: FloatArray, melody: float = USUAL_MELODY) -> ReturningPlaces | None:
    """Compare each of the ascending times with those at the same position in earlier bars; None if no bars recur. For
    ``melody`` see `likeness_of_bars`.
    """
    worths = returns_of_bars(rhythm, melody)
    if not worths.any():
        return None
    downbeats = np.flatnonzero(rhythm.bar_beats == 0)
    beats = np.interp(times_s, rhythm.beats_s, np.arange(len(rhythm.beats_s), dtype=np.float64))
    bar = np.searchsorted(downbeats, beats + _NEAR_BEATS, side="right") - 1
    inside = (bar >= 0) & (bar < len(worths))
    earlier = np.full((len(times_s), len(worths)), -1, np.int64)
    asked = (beats - downbeats[bar])[inside, None] + downbeats[:-1]
    at = np.minimum(np.searchsorted(beats, asked - _NEAR_BEATS), len(beats) - 1)
    earlier[inside] = np.where(np.abs(beats[at] - asked) < _NEAR_BEATS, at, -1)
    own = np.where(inside, bar, -1)
    return ReturningPlaces(own, earlier, np.where(inside[:, None], worths[own], 0.0))


def with_new_bars(returns: ReturningPlaces, random: np.random.Generator) -> ReturningPlaces:
    """Leave out randomly chosen bars from the recurrences, so that they get a new dance."""
    anew = random.random(returns.worths.shape[1] + 1) < ANEW
    return replace(
        returns, worths=np.where(anew[returns.bars][:, None], np.minimum(returns.worths, 0.0), returns.worths)
    )


def danced_again(
    returns: ReturningPlaces, chosen: Sequence[tuple[int, int]], places: range, segments: int
) -> FloatArray:
    """Return for each of P places of the music and each of S segments the similarity (P, S) of the place to earlier
    places where the segment was danced, minus that to the other earlier places.
    """
    danced = _danced(returns, chosen)
    again = np.zeros((len(places), segments))
    rows = slice(places.start, places.stop)
    # Index -1 is the row after the last accent, in which no segment is danced.
    own = danced[returns.earlier[rows]]
    row, bar = np.nonzero((own >= 0) & (returns.worths[rows] != 0.0))
    worths = returns.worths[rows][row, bar]
    least = np.zeros_like(again)
    np.maximum.at(again, (row, own[row, bar]), worths)
    np.minimum.at(least, (row, own[row, bar]), worths)
    return np.where(again > 0.0, again, least)


def copied_beats(returns: ReturningPlaces, chosen: Sequence[tuple[int, int]], beats: FloatArray, first: int) -> float:
    """Return for how many beats before the place ``first`` the dance has been a copy of what was danced to the same
    music before.

    Parameters
    ----------
    beats : (G,) float64
        Position of each place in beats.
    """
    danced, since = _danced(returns, chosen), first
    for place, segment in reversed(chosen):
        if not (danced[returns.earlier[place][returns.worths[place] > 0.0]] == segment).any():
            break
        since = place
    return float(beats[first] - beats[since])


def varied(again: FloatArray, states: IntArray) -> FloatArray:
    """Return worths (P, S), as of `danced_again`, by which other segments of the same basic motions, given for each
    segment, are danced instead of those that were danced before.
    """
    kinds = np.zeros((len(again), int(states.max()) + 1))
    for segment, state in enumerate(states.tolist()):
        np.maximum(kinds[:, state], again[:, segment], out=kinds[:, state])
    others = np.where(again < 0.0, again, SAME_KIND * kinds[:, states])
    return np.where(again > 0.0, -ANOTHER * again, others)


def _danced(returns: ReturningPlaces, chosen: Sequence[tuple[int, int]]) -> IntArray:
    """Return the segment danced at each place (G + 1,), -1 if none, with one place more at which none is."""
    danced = np.full(returns.earlier.shape[0] + 1, -1, np.int64)
    for place, segment in chosen:
        danced[place] = segment
    return danced


def _along_passages(alike: FloatArray) -> FloatArray:
    """Average the similarity (bars, bars) of each pair of bars with that of the pairs just before and after, so that
    similar passages stand out.
    """
    bars = len(alike)
    total, weight = np.zeros_like(alike), np.zeros_like(alike)
    reach = round(3.0 * AROUND_BARS)
    for by in range(-reach, reach + 1):
        first, last = max(0, -by), bars - max(0, by)
        if last > first:
            share = np.exp(-0.5 * (by / AROUND_BARS) ** 2)
            total[first:last, first:last] += share * alike[first + by : last + by, first + by : last + by]
            weight[first:last, first:last] += share
    return np.asarray(total / np.maximum(weight, 1e-9))
