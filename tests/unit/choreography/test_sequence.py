"""The search over segments: against the Viterbi algorithm where it is one, against all ways where they are few."""

from __future__ import annotations

from itertools import pairwise, product

import numpy as np
import pytest
from hmmlearn.base import BaseHMM

from app.choreography.sequence import (
    AccentGrid,
    Constraints,
    SegmentCandidates,
    Weights,
    choose,
    grid_of,
    symbol_scores,
)
from tests.support.dances import beaten


class Scored(BaseHMM):
    """A model of hmmlearn whose observations are the states' scores themselves."""

    def _compute_log_likelihood(self, scores: np.ndarray) -> np.ndarray:
        return scores


PLAIN = Weights(join_per_m=0.0, speed=0.0, off_beat=0.0, chance=0.0, lately=0.0)


def candidates(count: int, seed: int, spread: float = 0.0) -> SegmentCandidates:
    random = np.random.default_rng(seed)
    lasts = 0.25 * np.exp(spread * random.uniform(-1.0, 1.0, (2, count)))
    return SegmentCandidates(
        states=np.arange(count),
        before_s=lasts[0],
        after_s=lasts[1],
        joins_m=random.uniform(0.0, 0.3, (count, count)),
        log_transition=np.log(random.dirichlet(np.ones(count), count) * count),
        log_emission=np.log(random.dirichlet(np.ones(47), count) * 47),
    )


@pytest.mark.parametrize("seed", range(5))
def test_with_a_segment_a_state_and_a_place_a_step_it_is_the_viterbi_algorithm(seed: int) -> None:
    own = candidates(5, seed)
    random = np.random.default_rng(seed)
    scores = random.normal(size=(20, 5))
    # A segment cannot follow itself: nor can a state here.
    transition = np.exp(own.log_transition) / 5.0
    np.fill_diagonal(transition, 0.0)
    transition /= transition.sum(axis=1, keepdims=True)
    with np.errstate(divide="ignore"):
        log = np.log(transition * 5)
    fixed = SegmentCandidates(
        own.states, own.before_s, own.after_s, own.joins_m, np.maximum(log, -1e6), own.log_emission
    )
    initial = random.dirichlet(np.ones(5))
    grid = AccentGrid(0.5 * np.arange(20), np.ones(20, bool))
    found = choose(grid, scores, fixed, seed=0, weights=PLAIN, initial=np.log(initial * 5))
    other = Scored(n_components=5)
    other.startprob_, other.transmat_ = initial, transition
    _, states = other.decode(scores)
    assert [place for place, _ in found] == list(range(20))
    assert [segment for _, segment in found] == states.tolist()


def scored(
    way: tuple[tuple[int, int], ...], grid: AccentGrid, scores: np.ndarray, own: SegmentCandidates, weights: Weights
) -> float:
    """What a way through the grid is worth, added up one by one; less than anything where it is too fast or slow."""
    total = 0.0
    for place, segment in way:
        total += weights.model * scores[place, segment] - (0.0 if grid.on_beat[place] else weights.off_beat)
    for (place, one), (later, other) in pairwise(way):
        off = np.log((own.after_s[one] + own.before_s[other]) / (grid.times_s[later] - grid.times_s[place]))
        if one == other or abs(off) > np.log(1.5):
            return -np.inf
        total += weights.model * own.log_transition[one, other] - weights.join_per_m * own.joins_m[one, other]
        total -= weights.speed * (off / np.log(1.5)) ** 2
    return float(total)


@pytest.mark.parametrize("seed", range(6))
def test_no_way_through_a_small_grid_is_better(seed: int) -> None:
    own = candidates(3, seed, spread=0.6)
    grid = AccentGrid(0.3 * np.arange(6), np.arange(6) % 2 == 0)
    scores = np.random.default_rng(seed).normal(size=(6, 3))
    weights = Weights(chance=0.0, lately=0.0, join_per_m=5.0)
    found = choose(grid, scores, own, seed=0, weights=weights)
    assert found[0][0] == 0
    # All ways from the first place to the one that it ends at.
    ways = []
    for used in product((False, True), repeat=found[-1][0] - 1):
        places = [0, *(at + 1 for at, one in enumerate(used) if one), found[-1][0]]
        ways += [tuple(zip(places, segments, strict=True)) for segments in product(range(3), repeat=len(places))]
    best = max(scored(way, grid, scores, own, weights) for way in ways)
    # Times are distinguished to 2 %.
    assert scored(tuple(found), grid, scores, own, weights) == pytest.approx(best, abs=0.12)


def test_constraints_are_met_and_solved_around() -> None:
    own, rhythm = candidates(8, 3, spread=0.3), beaten(32)
    grid = grid_of(rhythm)
    scores = symbol_scores(grid, rhythm, own)
    free = choose(grid, scores, own, seed=5)
    # A phrase that is not asked for anything begins on the beat.
    place = 16
    there = dict(free).get(place)
    requested = next(state for state in range(8) if state != there)
    pinned = choose(grid, scores, own, seed=5, constraints=Constraints(pinned={place: requested}))
    assert dict(pinned)[place] == requested
    banned = frozenset((at, state) for at in range(len(grid.times_s)) for state in range(4))
    assert all(
        segment >= 4 for _, segment in choose(grid, scores, own, seed=5, constraints=Constraints(forbidden=banned))
    )
    both = Constraints(pinned={place: 2}, forbidden=banned)
    assert dict(choose(grid, scores, own, seed=5, constraints=both))[place] == 2


def test_the_same_seed_is_the_same_dance_and_another_is_another() -> None:
    own, rhythm = candidates(12, 4, spread=0.3), beaten(64)
    grid = grid_of(rhythm)
    scores = symbol_scores(grid, rhythm, own)
    assert choose(grid, scores, own, seed=1) == choose(grid, scores, own, seed=1)
    assert choose(grid, scores, own, seed=1) != choose(grid, scores, own, seed=2)


def test_motions_keep_within_the_speeds_at_any_tempo() -> None:
    own = candidates(12, 4, spread=0.5)
    for beat_s in (0.3, 0.5, 0.9, 1.4):
        grid = grid_of(beaten(40, beat_s))
        found = choose(grid, np.zeros((len(grid.times_s), 12)), own, seed=1)
        for (place, one), (later, other) in pairwise(found):
            speed = (own.after_s[one] + own.before_s[other]) / (grid.times_s[later] - grid.times_s[place])
            assert 0.65 < speed < 1.54


def test_without_music_or_motion_there_is_nothing() -> None:
    own = candidates(3, 0)
    assert choose(AccentGrid(np.zeros(0), np.zeros(0, bool)), np.zeros((0, 3)), own, seed=0) == []
    assert choose(AccentGrid(np.zeros(1), np.ones(1, bool)), np.zeros((1, 3)), own, seed=0)
