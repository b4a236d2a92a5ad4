"""Sequence of segments for a piece: the Viterbi algorithm over segments with their accents on the beats (H5).

A state of the search is a segment whose accent is at a place of the grid: a beat, or between two as the metre divides
them. Going from one to the next counts

- the model: transition and emission probabilities, as logarithms of how much likelier than by chance they are, so that
  few long motions and many short ones are compared fairly; every hit counts in the segment during which it sounds, as
  when it was learned, and partly in those until the next (`app.choreography.hit_log_odds`);
- how well the second fits on the first (`app.choreography.joins`); the segment that follows in the capture fits best;
- how much faster or slower than at the pace of the music both must be danced between their accents, within `SPEEDS`;
- an accent off the beat;
- a little chance, by the seed, so that a choreography does not repeat itself, and a cost of segments danced lately;
- where the music returns, what was danced to it before (`app.choreography.phrases`).

With one segment for each state, no costs and one place a step this is the Viterbi algorithm for the model whose
probabilities `app.choreography.hidden_markov` counts.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray, SingleArray
from app.choreography.accent_grid import AccentGrid
from app.choreography.drums_of_dancers import TakeShares
from app.choreography.hit_log_odds import HeardHits
from app.choreography.phrases import COPIED_BEATS, ReturningPlaces, copied_beats, danced_again, varied, with_new_bars
from app.choreography.step_balance import StepBalance
from app.choreography.take_turns import TakeTurns
from app.choreography.transition_scores import NEVER, SHARES, MoveCosts, SegmentMeets, SegmentMoves, no_meets

MOST_BEATS: Final = 4
"""Greatest number of beats between accents."""


@dataclass(frozen=True)
class Weights:
    """Weights of the terms in natural logarithms of probability.

    Attributes
    ----------
    join_per_m : float
        Cost of the distance at a join, per metre.
    speed : float
        Cost of a speed that differs from the pace by a factor of `SPEEDS`; it grows quadratically with the difference.
    off_beat : float
        Cost of an accent between two beats.
    model : float
        Weight of the model's log odds of transitions and sounds.
    heard : float
        Weight of the log odds of hits in addition to ``model``.
    chance : float
        Scale of the seed's noise, of Gumbel's distribution.
    lately : float
        Cost of each time that a segment was danced within `LATELY_S`, unless the music recurs; also of a segment that
        follows itself.
    repeats : float
        Cost of a segment that was danced a few motions before; see `RECENT`.
    returns : float
        Value of a segment that was danced where the music was the same.
    meets : float
        Value of an arrival of the body, or of a footfall, on a beat instead of between beats.
    take : float
        Value of a segment of the favoured take.
    steps : float
        Value of a step more than usual while the dance has fewer than the captures.
    """

    join_per_m: float = 55.0
    speed: float = 6.0
    off_beat: float = 1.2
    model: float = 1.0
    heard: float = 2.4
    chance: float = 0.6
    lately: float = 4.5
    repeats: float = 12.0
    returns: float = 34.0
    meets: float = 8.0
    take: float = 2.5
    steps: float = 12.0


LATELY_S: Final = 12.0
CLOSING_S: Final = 2.5
"""Seconds before the last accent in which a dance comes to its end, facing the audience."""
RECENT: Final = 7
"""Greatest number of motions before the last one that are not soon danced again."""
PER_RECENT: Final = 8
"""Number of segments per such motion: of few segments, those that fit the music are soon danced again."""
FEW: Final = 24.0
"""Number of segments in which each counts half as danced recently, since few segments must repeat."""
PHRASE_BEATS: Final = 8
"""Number of beats searched at a time, whose motions then count as danced recently."""

_MIDDLES: Final = (np.arange(SHARES) + 0.5) / SHARES


@dataclass(frozen=True, eq=False)
class SegmentCandidates:
    """Captured segments of motion, from which a dance is joined together; each has an accent, which is put on a beat.

    Attributes
    ----------
    states : (S,) int
        The basic motion (state of the hidden Markov model) of each segment.
    before_s, after_s : (S,) float64
        Seconds from start to accent and from accent to end, as captured.
    joins_m : (S, S) float64
        For each pair of segments, the distance in metres between the body at the end of the first and at the start of
        the second, turned and moved to fit best.
    log_transition : (S, S) float64
        Log odds with which the state of the second segment follows that of the first.
    meets : SegmentMeets, optional
        Seconds after the accent at which the body comes to rest and feet touch the floor; None: not considered.
    least_before_s, least_after_s : (S,) float64, optional
        Shortest times in seconds in which ``before_s`` and ``after_s`` may be danced; by default by `SPEEDS`.
    pace : float
        Speed relative to the capture at which segments are danced best.
    """

    states: IntArray
    before_s: FloatArray
    after_s: FloatArray
    joins_m: FloatArray
    log_transition: FloatArray
    meets: SegmentMeets | None = None
    least_before_s: FloatArray | None = None
    least_after_s: FloatArray | None = None
    pace: float = 1.0


@dataclass(frozen=True)
class Constraints:
    """The user's corrections as constraints of the search.

    Attributes
    ----------
    pinned : mapping of int to int
        State that must have its accent at a place of the grid, by place.
    segments : mapping of int to int
        Segment that must have its accent at a place, by place.
    forbidden : frozenset of (place, state)
        States that must not have their accent at a place.
    """

    pinned: Mapping[int, int] = field(default_factory=dict)
    segments: Mapping[int, int] = field(default_factory=dict)
    forbidden: frozenset[tuple[int, int]] = frozenset()


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
    closing: FloatArray | None = None,
    returns: ReturningPlaces | None = None,
    takes: TakeShares | None = None,
    steps: StepBalance | None = None,
) -> list[tuple[int, int]]:
    """Find the best sequence of segments for a piece.

    Parameters
    ----------
    heard : HeardHits
        Log odds of hits by segment of the candidates.
    constraints : Constraints, optional
        The user's corrections.
    usual, initial, final, closing : (S,) float64, optional
        Log odds of each segment anywhere, as the first, as the last, and as one of the last `CLOSING_S`.
    returns : ReturningPlaces, optional
        Places at which earlier music recurs.
    takes : TakeShares, optional
        Share of each take; by drums only if omitted.
    steps : StepBalance, optional
        Steps of each segment; not considered if omitted.

    Returns
    -------
    list of (place, segment)
        Ascending places with the segment whose accent is there; empty without places or segments.
    """
    weights, constraints = weights or Weights(), constraints or Constraints()
    count, segments = len(grid.times_s), len(candidates.states)
    if not count or not segments:
        return []
    random = np.random.default_rng(seed)
    renewed = None if returns is None else with_new_bars(returns, random)
    weights = replace(weights, lately=weights.lately * segments / (segments + FEW))
    search = _Search(grid, candidates, heard, weights, constraints, usual, initial)
    turns = None if takes is None else TakeTurns(takes, random, PHRASE_BEATS)
    chosen: list[tuple[int, int]] = []
    phrases = np.flatnonzero(grid.on_beat)[::PHRASE_BEATS].tolist()
    for first, stop in pairwise((*phrases, count)):
        # The search looks beyond the phrase, so that it does not end with a motion that cannot continue.
        seen = search.latest(stop - 1) + 1
        noise = weights.chance * (random.gumbel(size=segments) + random.gumbel(size=(seen - first, segments)))
        since_s = grid.times_s[first] - LATELY_S
        lately = np.zeros(segments)
        for place, segment in chosen:
            lately[segment] += grid.times_s[place] >= since_s
        before = chosen[-1] if chosen and search.reaches(chosen[-1][0], first) else None
        ends = np.zeros(segments) if final is None or seen < count else weights.model * final
        extra = noise - weights.lately * lately
        again = np.zeros((seen - first, segments))
        if returns is not None and renewed is not None:
            again = danced_again(renewed, chosen, range(first, seen), segments)
            if copied_beats(returns, chosen, grid.beats, first) >= COPIED_BEATS:
                half = range((first + stop) // 2, stop)
                known = danced_again(returns, chosen, half, segments)
                again[half.start - first : stop - first] = varied(known, candidates.states)
            extra += weights.returns * again + weights.lately * lately * np.maximum(again, 0.0)
        if turns is not None:
            extra += weights.take * turns.favoured(grid, chosen, first, again)
        if takes is not None:
            extra -= takes.against(slice(first, seen))
        if closing is not None:
            extra += weights.model * closing * (grid.times_s[first:seen, None] > grid.times_s[-1] - CLOSING_S)
        if steps is not None:
            extra += weights.steps * steps.favoured(grid, chosen, first)
        recent = [segment for _, segment in chosen[: -search.remembered - 2 : -1]]
        found = search.phrase(before, first, seen, extra, ends, recent)
        chosen += [row for row in found if row[0] < stop or seen == count]
        if seen == count:
            break
    return chosen


class _Search:
    """Search for the best sequence of segments over a grid; everything independent of the phrase is computed once."""

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
        self._hits = heard.before(grid.times_s).tolist()
        self._earliest = np.searchsorted(grid.beats, grid.beats - MOST_BEATS - 1e-6).tolist()
        self._constrained = sorted({*constraints.pinned, *constraints.segments})
        self._forbidden: dict[int, list[int]] = {}
        for place, state in constraints.forbidden:
            self._forbidden.setdefault(place, []).append(state)
        self._nothing = nothing = np.zeros(len(candidates.states))
        self._usual = nothing if usual is None else weights.model * usual
        meets = candidates.meets or no_meets(len(nothing))
        self._off_beat = -weights.off_beat * ~grid.on_beat
        self._at_accent = weights.meets * (grid.strengths[:, None] - 0.5) * meets.accents
        self._initial = nothing if initial is None else weights.model * initial
        self.remembered = min(RECENT, max(1, len(nothing) // PER_RECENT))
        self._moves = SegmentMoves(
            grid,
            MoveCosts(
                weights.model * candidates.log_transition
                - weights.join_per_m * candidates.joins_m
                - weights.lately * np.eye(len(nothing)),
                candidates.before_s,
                candidates.after_s,
                weights.speed,
                self._usual,
                replace(meets, worths=weights.meets * meets.worths),
                candidates.least_before_s,
                candidates.least_after_s,
                candidates.pace,
            ),
        )

    def phrase(
        self,
        before: tuple[int, int] | None,
        first: int,
        stop: int,
        extra: FloatArray,
        ends: FloatArray,
        recent: Sequence[int],
    ) -> list[tuple[int, int]]:
        """Find the best path through the places ``first`` to ``stop`` of the grid, continuing from an earlier accent.

        ``extra`` (stop - first, S) is added to the score of each accent, ``ends`` (S,) to that of the last one;
        ``recent`` are the segments before, from the last one back, one more than ``remembered``.
        """
        times, count, segments = self._grid.times_s, stop - first, len(self._initial)
        best = np.full((count, segments), float(NEVER) * 10.0)
        # Preceding accent and segment of each entry, encoded as one number.
        came = np.full((count, segments), -1, np.int64)
        # The segments before each entry, from the last one back.
        danced = np.full((count, segments, self.remembered), -1, np.int64)
        for place in range(first, stop):
            row = place - first
            own = self._usual + self._off_beat[place] + self._at_accent[place] + extra[row] + self._allowed(place)
            if before is None and row == 0:
                struck = self._heard.between(times[place] - self._candidates.before_s, times[place])
                best[row] = self._initial + struck + own
            elif before is not None and self._moves.possible(times[place] - times[before[0]]):
                table = self._moves.table_from(before[1], before[0], place)
                heard, total = self._struck(before[0], place)
                reached = table.best(np.zeros(len(own), np.float32), heard)[1] + own + total
                reached[list(recent[1:])] -= self._weights.repeats
                danced[row, :, : len(recent)] = recent[: self.remembered]
                np.maximum(best[row], reached, out=best[row])
            found = []
            for earlier in range(max(first, self._earliest[place]), place):
                if not self._moves.possible(times[place] - times[earlier]) or self._skips(earlier, place):
                    continue
                table = self._moves.table(earlier, place, every=self._is_constrained(earlier))
                heard, total = self._struck(earlier, place)
                so_far = best[earlier - first].astype(np.float32)
                from_segment, reached = table.best(so_far, heard, danced[earlier - first], self._weights.repeats)
                found.append((reached, total, earlier * segments + from_segment))
            if not found:
                continue
            scores, totals, reached_from = (np.array(rows) for rows in zip(*found, strict=True))
            every = scores + own + totals
            at = every.argmax(axis=0), np.arange(segments)
            better = np.flatnonzero(every[at] > best[row])
            best[row, better], came[row, better] = every[at][better], reached_from[at][better]
            rows, from_segment = np.divmod(came[row, better] - first * segments, segments)
            danced[row, better, 0] = from_segment
            danced[row, better, 1:] = danced[rows, from_segment, :-1]
        return self._way_back(best + ends, came, first, stop)

    def latest(self, place: int) -> int:
        """Index of the last accent at most `MOST_BEATS` beats after the accent ``place``."""
        return bisect_right(self._grid.beats, self._grid.beats[place] + MOST_BEATS + 1e-6) - 1

    def reaches(self, place: int, later: int) -> bool:
        """Return whether the accent after the one at ``place`` may be at ``later`` or beyond."""
        gaps_s = self._grid.times_s[later : self.latest(place) + 1] - self._grid.times_s[place]
        return any(self._moves.possible(gap_s) for gap_s in gaps_s)

    def _way_back(self, best: FloatArray, came: IntArray, first: int, stop: int) -> list[tuple[int, int]]:
        """Return the best sequence as (accent, segment) pairs, traced back from the best accent near the end; ``best``
        are scores (accents, segments), ``came`` the predecessors."""
        reached = best.max(axis=1)
        # The phrase ends at the latest accent that can be reached; the accents after it may be unreachable.
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
        while came[row, segment] >= 0:
            place, segment = divmod(int(came[row, segment]), came.shape[1])
            row = place - first
            way.append((place, segment))
        return way[::-1]

    def _allowed(self, place: int) -> FloatArray:
        """Cost (S,) of each segment at an accent: 0 if the user's corrections allow it, else prohibitive."""
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
        """Return whether a move from one place to another passes over a place at which the user requires an accent."""
        return bisect_right(self._constrained, earlier) < bisect_left(self._constrained, place)

    def _is_constrained(self, place: int) -> bool:
        return place in self._forbidden or place in self._constraints.pinned or place in self._constraints.segments

    def _struck(self, earlier: int, place: int) -> tuple[SingleArray | None, FloatArray]:
        """Sums of the log odds of the hits between two accents for S segments: (SHARES, S) up to each possible change
        of segments, and (S,) in total.
        """
        first, stop = self._hits[earlier], self._hits[place]
        if first == stop:
            return None, self._nothing
        start_s, stop_s = self._grid.times_s[earlier], self._grid.times_s[place]
        times_s, summed = self._heard.times_s, self._heard.summed
        met = np.searchsorted((times_s[first:stop] - start_s) / (stop_s - start_s), _MIDDLES)
        until = summed[first : stop + 1] - summed[first]
        return until.astype(np.float32).take(met, axis=0), until[-1]
