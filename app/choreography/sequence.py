"""Sequence of segments for a piece: the Viterbi algorithm over segments with their accents on the beats (H5).

A state of the search is a segment whose accent is at a place of the grid: a beat, or between two as the metre divides
them. Going from one to the next counts

- the model: transition and emission probabilities, as logarithms of how much likelier than by chance they are, so that
  few long motions and many short ones are compared fairly; every hit counts in the segment during which it sounds, as
  when it was learned (`app.choreography.heard`);
- how well the second fits on the first (`app.choreography.joins`); the segment that follows in the capture fits best;
- how much faster or slower than captured both must be danced between their accents, within `SPEEDS`;
- an accent off the beat;
- a little chance, by the seed, so that a choreography does not repeat itself, and a cost of segments danced lately;
- where the music returns, what was danced to it before (`app.choreography.phrases`).

With one segment for each state, no costs and one place a step this is the Viterbi algorithm for the model whose
probabilities `app.choreography.hidden_markov` counts.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray, SingleArray
from app.choreography.heard import HeardHits
from app.choreography.rhythm import Rhythm

SPEEDS: Final = (0.67, 1.5)
"""A motion is danced no slower and no faster than this from one arrival to the next, beside the speed it was captured
at; in between its speed goes over smoothly and was up to 1.75 for a moment."""
MOST_BEATS: Final = 4
"""From one accent to the next there are at most so many beats."""


@dataclass(frozen=True)
class Weights:
    """Weights of the terms, in natural logarithms of probability.

    Attributes
    ----------
    join_per_m : float
        Of the distance at a join.
    speed : float
        Of a motion that is danced at a limit of `SPEEDS`; by the square in between.
    off_beat : float
        Of an accent between two beats.
    model : float
        Of the model's log odds.
    heard : float
        Of the log odds of what is struck, beside ``model``.
    chance : float
        Scale of the seed's noise, of Gumbel's distribution.
    lately : float
        Of each time that a segment was danced within `LATELY_S`.
    returns : float
        Of a segment that was danced where the music was as it is again.
    """

    join_per_m: float = 40.0
    speed: float = 1.5
    off_beat: float = 1.2
    model: float = 1.0
    heard: float = 1.3
    chance: float = 0.6
    lately: float = 2.0
    returns: float = 2.0


LATELY_S: Final = 12.0
PHRASE_BEATS: Final = 16
"""Beats that are searched at a time; the motions danced in them then count as danced lately."""
NEVER: Final = -1e9
_SHARES: Final = 64
"""Accuracy, as a part of the time from accent to accent, of where two segments meet."""


@dataclass(frozen=True, eq=False)
class AccentGrid:
    """Times at which a dance can place accents.

    Attributes
    ----------
    times_s : (G,) float64
        Ascending.
    on_beat : (G,) bool
    """

    times_s: FloatArray
    on_beat: BoolArray

    @cached_property
    def beats(self) -> FloatArray:
        """(G,) places in beats from the first one."""
        on_beat = np.flatnonzero(self.on_beat)
        return np.asarray(np.interp(np.arange(len(self.times_s)), on_beat, np.arange(len(on_beat))))


@dataclass(frozen=True, eq=False)
class SegmentCandidates:
    """Segments that a step of a dance can be made from.

    Attributes
    ----------
    states : (S,) int
    before_s, after_s : (S,) float64
        From start to accent and from accent to end, as captured.
    joins_m : (S, S) float64
        How far the end of the one is from the start of the other.
    log_transition : (S, S) float64
        Log odds of the second's state after the first's.
    """

    states: IntArray
    before_s: FloatArray
    after_s: FloatArray
    joins_m: FloatArray
    log_transition: FloatArray


@dataclass(frozen=True)
class Constraints:
    """The user's corrections as constraints of the search.

    Attributes
    ----------
    pinned : mapping of int to int
        State by place of the grid: an accent of this state is there.
    segments : mapping of int to int
        Segment by place.
    forbidden : frozenset of (place, state)
    """

    pinned: Mapping[int, int] = field(default_factory=dict)
    segments: Mapping[int, int] = field(default_factory=dict)
    forbidden: frozenset[tuple[int, int]] = frozenset()


def grid_of(rhythm: Rhythm) -> AccentGrid:
    """Beats, and the places between them that divide them as the metre does."""
    beats = rhythm.beats_s
    if len(beats) < 2:
        return AccentGrid(beats, np.ones(len(beats), bool))
    divisions = np.full(len(beats), 2) if rhythm.divisions is None else rhythm.divisions
    places = np.concatenate([at + np.arange(parts) / parts for at, parts in enumerate(divisions[:-1].tolist())])
    places = np.append(places, len(beats) - 1.0)
    return AccentGrid(np.interp(places, np.arange(len(beats)), beats), places % 1.0 == 0.0)


def choose(
    grid: AccentGrid,
    candidates: SegmentCandidates,
    heard: HeardHits,
    *,
    seed: int,
    weights: Weights | None = None,
    constraints: Constraints | None = None,
    usual: FloatArray | None = None,
    initial: FloatArray | None = None,
    final: FloatArray | None = None,
    returns: IntArray | None = None,
) -> list[tuple[int, int]]:
    """The best segments for a piece.

    Parameters
    ----------
    heard : HeardHits
        By segment of the candidates.
    constraints : Constraints, optional
    usual, initial, final : (S,) float64, optional
        Log odds of each segment wherever it is, as the first, and as the last.
    returns : (G,) int, optional
        The earlier place whose music returns at each place; -1 where none does.

    Returns
    -------
    list of (place, segment)
        Places ascending. Empty without places or segments.
    """
    weights, constraints = weights or Weights(), constraints or Constraints()
    count, segments = len(grid.times_s), len(candidates.states)
    if not count or not segments:
        return []
    random = np.random.default_rng(seed)
    search = _Search(grid, candidates, heard, weights, constraints, usual, initial)
    chosen: list[tuple[int, int]] = []
    phrases = np.flatnonzero(grid.on_beat)[::PHRASE_BEATS].tolist()
    for first, stop in pairwise((*phrases, count)):
        # What comes next is looked at too, so that a phrase does not end where nothing goes on.
        seen = search.latest(stop - 1) + 1
        noise = weights.chance * (random.gumbel(size=segments) + random.gumbel(size=(seen - first, segments)))
        since_s = grid.times_s[first] - LATELY_S
        lately = np.zeros(segments)
        for place, segment in chosen:
            lately[segment] += grid.times_s[place] >= since_s
        before = chosen[-1] if chosen and search.reaches(chosen[-1][0], first) else None
        ends = np.zeros(segments) if final is None or seen < count else weights.model * final
        extra = noise - weights.lately * lately
        if returns is not None:
            danced = dict(chosen)
            for row, earlier in enumerate(returns[first:seen].tolist()):
                if earlier in danced:
                    extra[row, danced[earlier]] += weights.returns
        found = search.phrase(before, first, seen, extra, ends)
        chosen += [row for row in found if row[0] < stop or seen == count]
        if seen == count:
            break
    return chosen


class _Search:
    """The search over a grid; what does not depend on the phrase is worked out once."""

    def __init__(
        self,
        grid: AccentGrid,
        candidates: SegmentCandidates,
        heard: HeardHits,
        weights: Weights,
        constraints: Constraints,
        usual: FloatArray | None,
        initial: FloatArray | None,
    ) -> None:
        self._grid, self._candidates, self._weights, self._constraints = grid, candidates, weights, constraints
        self._heard = replace(heard, summed=weights.model * weights.heard * heard.summed)
        self._earliest = np.searchsorted(grid.beats, grid.beats - MOST_BEATS - 1e-6).tolist()
        self._constrained = sorted({*constraints.pinned, *constraints.segments})
        self._forbidden: dict[int, list[int]] = {}
        for place, state in constraints.forbidden:
            self._forbidden.setdefault(place, []).append(state)
        nothing = np.zeros(len(candidates.states))
        self._usual = nothing if usual is None else weights.model * usual
        self._off_beat = -weights.off_beat * ~grid.on_beat
        self._initial = nothing if initial is None else weights.model * initial
        base = weights.model * candidates.log_transition - weights.join_per_m * candidates.joins_m
        np.fill_diagonal(base, NEVER)
        self._base = base.astype(np.float32)
        self._lasts_s = candidates.after_s[:, None] + candidates.before_s[None, :]
        # A row for each end, as of the scores of moves: where they meet, as places in the tables of `_add_struck`.
        meets = (_SHARES * candidates.after_s / np.maximum(self._lasts_s.T, 1e-9)).astype(np.intp)
        row, every = np.minimum(meets, _SHARES - 1) * len(nothing), np.arange(len(nothing))
        self._of_start, self._of_end = row + every, row + every[:, None]
        self._taken = np.empty(row.shape, np.float32)
        self._between: dict[int, SingleArray] = {}
        self._longest_s = float(self._lasts_s.max()) / SPEEDS[0] if self._lasts_s.size else 0.0
        self._shortest_s = float(self._lasts_s.min()) / SPEEDS[1] if self._lasts_s.size else 0.0

    def phrase(
        self, before: tuple[int, int] | None, first: int, stop: int, extra: FloatArray, ends: FloatArray
    ) -> list[tuple[int, int]]:
        """The best way through the places ``first`` to ``stop``, going on from an accent before.

        ``extra`` (stop - first, S) is added to the score of each accent, ``ends`` (S,) to that of the last one.
        """
        times = self._grid.times_s
        count = stop - first
        best = np.full((count, len(self._initial)), float(NEVER) * 10.0)
        came = np.full((count, len(self._initial), 2), -1, np.int64)
        scores, every = np.empty_like(self._base), np.arange(len(self._initial))
        for place in range(first, stop):
            row = place - first
            own = self._usual + self._off_beat[place] + extra[row] + self._allowed(place)
            if before is None and row == 0:
                struck = self._heard.between(times[place] - self._candidates.before_s, times[place])
                best[row] = self._initial + struck + own
            elif before is not None:
                gap_s = times[place] - times[before[0]]
                if self._possible(gap_s):
                    scores[:] = self._moves(gap_s)
                    self._add_struck(scores, before[0], place)
                    reached = scores[:, before[1]] + own
                    better = reached > best[row]
                    best[row, better] = reached[better]
                    came[row, better] = -1
            for earlier in range(max(first, self._earliest[place]), place):
                gap_s = times[place] - times[earlier]
                if not self._possible(gap_s) or self._skips(earlier, place):
                    continue
                np.add(self._moves(gap_s), best[earlier - first].astype(np.float32), out=scores)
                self._add_struck(scores, earlier, place)
                from_segment = scores.argmax(axis=1)
                reached = scores[every, from_segment] + own
                better = reached > best[row]
                best[row, better] = reached[better]
                came[row, better, 0], came[row, better, 1] = earlier, from_segment[better]
        return self._way_back(best + ends, came, first, stop)

    def latest(self, place: int) -> int:
        """The last place within `MOST_BEATS`."""
        return bisect_right(self._grid.beats, self._grid.beats[place] + MOST_BEATS + 1e-6) - 1

    def reaches(self, place: int, later: int) -> bool:
        """Return whether an accent at a place can be followed by one from ``later`` on."""
        gaps_s = self._grid.times_s[later : self.latest(place) + 1] - self._grid.times_s[place]
        return any(self._possible(gap_s) for gap_s in gaps_s)

    def _way_back(self, best: FloatArray, came: IntArray, first: int, stop: int) -> list[tuple[int, int]]:
        """From the best accent near the end."""
        reached = best.max(axis=1)
        # The phrase ends with an accent as late as one can be; a place or two later need not have one.
        last = max((row for row in range(stop - first) if reached[row] > NEVER / 2.0), default=-1)
        if last < 0:
            return []
        rows = range(max(0, last - 1), last + 1)
        times_s = self._grid.times_s[first:]
        finally_ = {
            at: best[at] + self._heard.between(times_s[at], times_s[at] + self._candidates.after_s) for at in rows
        }
        row = max(rows, key=lambda at: float(finally_[at].max()))
        segment = int(finally_[row].argmax())
        way = [(first + row, segment)]
        while came[row, segment, 0] >= 0:
            place, segment = int(came[row, segment, 0]), int(came[row, segment, 1])
            row = place - first
            way.append((place, segment))
        return way[::-1]

    def _allowed(self, place: int) -> FloatArray:
        """Nothing for the segments that may be at a place, never for the others."""
        constraints, states = self._constraints, self._candidates.states
        cost = np.zeros(len(states))
        if place in constraints.segments:
            cost[np.arange(len(states)) != constraints.segments[place]] = NEVER / 100.0
        elif place in constraints.pinned:
            cost[states != constraints.pinned[place]] = NEVER / 100.0
        elif place in self._forbidden:
            cost[np.isin(states, self._forbidden[place])] = NEVER / 100.0
        return cost

    def _skips(self, earlier: int, place: int) -> bool:
        """Return whether going from one place to the other leaves out one that has to have an accent."""
        return bisect_right(self._constrained, earlier) < bisect_left(self._constrained, place)

    def _add_struck(self, scores: SingleArray, earlier: int, place: int) -> None:
        """Add the log odds of what is struck from one accent to the next: of the one's segment until they meet, then of
        the other's."""
        start_s, stop_s = self._grid.times_s[[earlier, place]]
        times_s, summed = self._heard.times_s, self._heard.summed
        first, stop = self._heard.before(self._grid.times_s[[earlier, place]])
        if first == stop:
            return
        shares = (times_s[first:stop] - start_s) / (stop_s - start_s)
        met = first + np.searchsorted(shares, (np.arange(_SHARES) + 0.5) / _SHARES)
        for log_odds, which in (
            (summed[met] - summed[first], self._of_start),
            (summed[stop] - summed[met], self._of_end),
        ):
            scores += log_odds.astype(np.float32).take(which, out=self._taken, mode="clip")

    def _possible(self, gap_s: float) -> bool:
        return self._shortest_s <= gap_s <= self._longest_s

    def _moves(self, gap_s: float) -> SingleArray:
        """(S, S) score of going to the one's accent from the other's in a time; times are rounded to one in 50."""
        key = round(50.0 * float(np.log(gap_s)))
        if key not in self._between:
            off = np.log(self._lasts_s / np.exp(key / 50.0))
            limit = np.log(SPEEDS[1])
            cost = self._weights.speed * np.square(off / limit)
            moves = self._base - cost.astype(np.float32)
            moves[np.abs(off) > limit + 0.02] += np.float32(NEVER)
            # A row for each end: the search for the best start runs through memory.
            self._between[key] = np.ascontiguousarray(moves.T)
        return self._between[key]
