"""Search for the sequence of segments, compared with the Viterbi algorithm and with all sequences if there are few."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise, product

import numpy as np
import pytest
from hmmlearn.base import BaseHMM

from app.choreography.accent_grid import AccentGrid, grid_of
from app.choreography.drums_of_dancers import DancersDrums, TakeShares
from app.choreography.hit_log_odds import HeardHits, Hearing, SoundOdds
from app.choreography.rhythm import SYMBOLS, Rhythm
from app.choreography.sequence import Constraints, SegmentCandidates, Weights, choose
from app.choreography.transition_scores import (
    MOST_STARTS,
    NEAR_S,
    NEVER,
    MoveCosts,
    MoveTable,
    SegmentMeets,
    SegmentMoves,
)
from tests.support.dances import beaten


class Scored(BaseHMM):
    """Model of hmmlearn whose observations are the states' scores."""

    def _compute_log_likelihood(self, scores: np.ndarray) -> np.ndarray:
        return scores


PLAIN = Weights(join_per_m=0.0, speed=0.0, off_beat=0.0, chance=0.0, lately=0.0, repeats=0.0, heard=1.0)


def candidates(count: int, seed: int, spread: float = 0.0) -> SegmentCandidates:
    random = np.random.default_rng(seed)
    lasts = 0.25 * np.exp(spread * random.uniform(-1.0, 1.0, (2, count)))
    return SegmentCandidates(
        states=np.arange(count),
        before_s=lasts[0],
        after_s=lasts[1],
        joins_m=random.uniform(0.0, 0.3, (count, count)),
        log_transition=np.log(random.dirichlet(np.ones(count), count) * count),
    )


def emission(count: int, seed: int) -> np.ndarray:
    """Log odds of symbols during segments."""
    return np.log(np.random.default_rng(seed).dirichlet(np.ones(47), count) * 47)


def heard_by(log_odds: np.ndarray) -> Hearing:
    """Segments with given log odds (S, 47) of symbols."""
    odds = SoundOdds(np.zeros(log_odds.shape), log_odds, DancersDrums(np.zeros((1, len(SYMBOLS)))))
    return Hearing(odds, odds)


def struck(times_s: np.ndarray, scores: np.ndarray) -> HeardHits:
    """Hits with given log odds (H, S)."""
    return HeardHits(times_s, np.concatenate([np.zeros((1, scores.shape[1])), np.cumsum(scores, axis=0)]))


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
    fixed = SegmentCandidates(own.states, own.before_s, own.after_s, own.joins_m, np.maximum(log, -1e6))
    initial = random.dirichlet(np.ones(5))
    grid = AccentGrid(0.5 * np.arange(20), np.ones(20, bool))
    heard = struck(grid.times_s, scores)
    found = choose(grid, fixed, heard, seed=0, weights=PLAIN, initial=np.log(initial * 5))
    other = Scored(n_components=5)
    other.startprob_, other.transmat_ = initial, transition
    _, states = other.decode(scores)
    assert [place for place, _ in found] == list(range(20))
    assert [segment for _, segment in found] == states.tolist()


def scored(
    way: tuple[tuple[int, int], ...],
    grid: AccentGrid,
    hits: list[tuple[float, np.ndarray]],
    own: SegmentCandidates,
    weights: Weights,
) -> float:
    """Score of a path through the grid, calculated step by step; negative infinity if a step is too fast or too slow or
    repeats a segment.
    """
    total, starts = 0.0, [float(grid.times_s[way[0][0]] - own.before_s[way[0][1]])]
    for place, _ in way:
        total -= 0.0 if grid.on_beat[place] else weights.off_beat
    for (place, one), (later, other) in pairwise(way):
        gap_s = grid.times_s[later] - grid.times_s[place]
        lasts_s = own.after_s[one] + own.before_s[other]
        off = np.log(lasts_s / gap_s)
        if one == other or abs(off) > np.log(1.5):
            return -np.inf
        total += weights.model * own.log_transition[one, other] - weights.join_per_m * own.joins_m[one, other]
        total -= weights.speed * (off / np.log(1.5)) ** 2
        starts.append(float(grid.times_s[place] + gap_s * own.after_s[one] / lasts_s))
        if own.meets is not None:
            beats_s = grid.times_s[place : later + 1][grid.on_beat[place : later + 1]]
            meets = [(grid.times_s[place] + gap_s * at / lasts_s, worth) for at, worth in events(own, one) if at > 0.0]
            meets += [(grid.times_s[later] + gap_s * at / lasts_s, worth) for at, worth in events(own, other) if at < 0]
            for at_s, worth in meets:
                near = np.exp(-np.square((beats_s - at_s) / NEAR_S) / 2.0).max(initial=0.0)
                total += weights.meets * worth * (near - 0.5)
    if own.meets is not None:
        total += sum(weights.meets * own.meets.accents[one] * (grid.on_beat[place] - 0.5) for place, one in way)
    end_s = grid.times_s[way[-1][0]] + own.after_s[way[-1][1]]
    for time_s, log_odds in hits:
        if starts[0] <= time_s < end_s:
            during = max(at for at, start_s in enumerate(starts) if start_s <= time_s)
            total += weights.heard * log_odds[way[during][1]]
    return float(total)


def events(own: SegmentCandidates, segment: int) -> list[tuple[float, float]]:
    """Arrivals of a segment with their values."""
    assert own.meets is not None
    pairs = zip(own.meets.times_s[segment], own.meets.worths[segment], strict=True)
    return [(float(at), float(worth)) for at, worth in pairs if np.isfinite(at)]


@pytest.mark.parametrize("arrive", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_no_way_through_a_small_grid_is_better(seed: int, arrive: bool) -> None:
    own = candidates(3, seed, spread=0.6)
    grid = AccentGrid(0.3 * np.arange(6), np.arange(6) % 2 == 0)
    random = np.random.default_rng(seed)
    if arrive:
        chance = np.random.default_rng(seed + 100)
        times_s = chance.uniform(-1.0, 1.0, (3, 3)) * np.where(np.arange(3) % 2, own.before_s, own.after_s)[:, None]
        times_s = np.clip(times_s, -own.before_s[:, None], own.after_s[:, None])
        times_s[0, 2] = np.nan
        own = replace(
            own,
            meets=SegmentMeets(
                times_s, chance.uniform(0.3, 1.0, (3, 3)), np.zeros((3, 3), bool), chance.uniform(size=3)
            ),
        )
    times_s, scores = np.sort(random.uniform(-0.3, 1.9, 12)), random.normal(size=(12, 3))
    hits = list(zip(times_s.tolist(), scores, strict=True))
    weights = Weights(chance=0.0, lately=0.0, repeats=0.0, join_per_m=5.0)
    found = choose(grid, own, struck(times_s, scores), seed=0, weights=weights)
    assert found[0][0] == 0
    # All sequences from the first place to the final one.
    ways = []
    for used in product((False, True), repeat=found[-1][0] - 1):
        places = [0, *(at + 1 for at, one in enumerate(used) if one), found[-1][0]]
        ways += [tuple(zip(places, segments, strict=True)) for segments in product(range(3), repeat=len(places))]
    best = max(scored(way, grid, hits, own, weights) for way in ways)
    # Times are distinguished to 2 %.
    assert scored(tuple(found), grid, hits, own, weights) == pytest.approx(best, abs=0.3 if arrive else 0.12)


def test_ways_by_starts_that_fit_badly_are_hardly_ever_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
    own, rhythm = candidates(3 * MOST_STARTS, 7, spread=0.5), beaten(40)
    grid = grid_of(rhythm)
    heard = struck(rhythm.hits_s, 0.5 * np.random.default_rng(9).normal(size=(len(rhythm.hits_s), len(own.states))))
    few = [choose(grid, own, heard, seed=seed) for seed in range(4)]
    monkeypatch.setattr("app.choreography.transition_scores.MOST_STARTS", len(own.states))
    assert few == [choose(grid, own, heard, seed=seed) for seed in range(4)]


def test_a_start_that_fits_badly_is_danced_where_it_is_pinned() -> None:
    own, rhythm = candidates(3 * MOST_STARTS, 7), beaten(32)
    joins_m = own.joins_m.copy()
    joins_m[5] = 3.0
    own, grid = replace(own, joins_m=joins_m), grid_of(rhythm)
    silence = struck(np.zeros(0), np.zeros((0, len(own.states))))
    found = dict(choose(grid, own, silence, seed=1, constraints=Constraints(segments={16: 5})))
    assert found[16] == 5
    assert max(found) > 56


def test_arrivals_within_motions_are_danced_to_beats() -> None:
    """Every other motion has another arrival a beat after its accent, the others between two beats."""
    count = 12
    between = np.where(np.arange(count) % 2, 0.25, 0.5)
    own = SegmentCandidates(
        np.arange(count), np.full(count, 0.3), np.full(count, 0.7), np.zeros((count, count)), np.zeros((count, count)),
        SegmentMeets(between[:, None], np.ones((count, 1)), np.zeros((count, 1), bool), np.ones(count)),
    )  # fmt: skip
    silence = struck(np.zeros(0), np.zeros((0, count)))
    found = choose(grid_of(beaten(64)), own, silence, seed=0, weights=Weights(chance=0.2, lately=0.0))
    assert np.mean([segment % 2 == 0 for _, segment in found]) > 0.8


@pytest.mark.parametrize("beat_s", [0.6, 0.9])
def test_footfalls_at_chance_count_nothing_at_any_tempo(beat_s: float) -> None:
    """Footfalls evenly about motions of one beat: those off the beat cost what those on it are worth."""
    count = 90
    half_s = np.full(count, 0.5 * beat_s)
    after_s = np.linspace(0.0, 0.5 * beat_s, count + 1)[1:]
    grid, nothing = AccentGrid(beat_s * np.arange(3), np.ones(3, bool)), np.zeros((count, count))

    def scores(falls: bool) -> np.ndarray:
        meets = SegmentMeets(after_s[:, None], np.ones((count, 1)), np.full((count, 1), falls), np.zeros(count))
        moves = SegmentMoves(grid, MoveCosts(nothing, half_s, half_s, 1.5, np.zeros(count), meets))
        found = moves.table(0, 1, every=True).scores
        return found[found > NEVER / 2.0]

    assert scores(True).mean() == pytest.approx(0.0, abs=0.03)
    assert scores(False).mean() < -0.1 if beat_s > 0.8 else scores(False).mean() < 0.0


@pytest.mark.parametrize("where", [0.0, 0.2, 0.4, 0.6, 0.8])
def test_a_sound_is_heard_wherever_it_is_in_a_beat(where: float) -> None:
    """Two kinds of motions with one sound each: each is danced while its sound is struck."""
    random = np.random.default_rng(1)
    own = SegmentCandidates(
        np.arange(12) % 2, np.full(12, 0.25), np.full(12, 0.25), random.uniform(0.0, 0.05, (12, 12)), np.zeros((12, 12))
    )
    log_odds = np.zeros((12, 47))
    log_odds[:, 20], log_odds[:, 21] = np.where(own.states, -2.0, 0.6), np.where(own.states, 0.6, -2.0)
    beats = 0.5 * np.arange(64)
    # Four beats of the one sound, then four of the other.
    symbols = 20 + np.arange(64) // 4 % 2
    music = Rhythm(beats, np.arange(64) % 4, beats + 0.5 * where, symbols, np.ones(64), derived=False)
    found = choose(grid_of(music), own, heard_by(log_odds).hits(music, 0.0), seed=0)
    # Motions meet half way from accent to accent.
    accents_s = 0.25 * np.array([place for place, _ in found])
    danced = np.searchsorted(0.5 * (accents_s[1:] + accents_s[:-1]), music.hits_s, side="right")
    states = own.states[[segment for _, segment in found]]
    assert np.mean(states[danced] == symbols - 20) > 0.9


def test_constraints_are_met_and_solved_around() -> None:
    own, rhythm = candidates(8, 3, spread=0.3), beaten(32)
    grid = grid_of(rhythm)
    heard = heard_by(emission(len(own.states), 9)).hits(rhythm, 0.0)
    free = choose(grid, own, heard, seed=5)
    # A phrase without requirements begins on the beat.
    place = 16
    there = dict(free).get(place)
    requested = next(state for state in range(8) if state != there)
    pinned = choose(grid, own, heard, seed=5, constraints=Constraints(pinned={place: requested}))
    assert dict(pinned)[place] == requested
    banned = frozenset((at, state) for at in range(len(grid.times_s)) for state in range(4))
    assert all(
        segment >= 4 for _, segment in choose(grid, own, heard, seed=5, constraints=Constraints(forbidden=banned))
    )
    both = Constraints(pinned={place: 2}, forbidden=banned)
    assert dict(choose(grid, own, heard, seed=5, constraints=both))[place] == 2


@pytest.mark.parametrize(("segments", "remembered"), [(12, 2), (24, 4), (64, 8)])
def test_no_motion_is_danced_again_at_once_even_if_it_fits_best(segments: int, remembered: int) -> None:
    own = candidates(segments, 2)
    # After each other, two segments fit best.
    loop = np.zeros((segments, segments))
    loop[0, 1] = loop[1, 0] = 8.0
    own = replace(own, log_transition=loop)
    grid, heard = grid_of(beaten(64)), struck(np.zeros(0), np.zeros((0, segments)))

    def soon_again(repeats: float) -> int:
        danced = [segment for _, segment in choose(grid, own, heard, seed=1, weights=Weights(repeats=repeats))]
        return sum(segment in danced[max(0, at - remembered) : at] for at, segment in enumerate(danced))

    assert soon_again(0.0) > 2
    assert soon_again(24.0) == 0


def test_no_motion_of_another_dancer_fills_the_time_between_sounds_that_name_the_dancer() -> None:
    """Motions of the other dancer would fit better, and no sound is struck during them."""
    takes = np.repeat([0, 1], 20)
    joins_m = np.where((takes[:, None] == 1) & (takes[None, :] == 1), 0.03, 0.0)
    made = replace(candidates(40, 3), joins_m=joins_m)
    music = beaten(32)
    silence = heard_by(np.zeros((40, 47))).hits(
        replace(music, symbols=music.symbols[:0], hits_s=music.hits_s[:0], strengths=music.strengths[:0]), 0.0
    )
    grid = grid_of(music)

    def danced(share: float) -> float:
        shares = TakeShares(takes, np.tile((share, 1.0 - share), (len(grid.times_s), 1)), np.array([0.5, 0.5]))
        found = [choose(grid, made, silence, seed=seed, takes=shares) for seed in range(3)]
        return float(np.mean([takes[segment] == 1 for one in found for _, segment in one]))

    assert danced(0.2) < 0.9
    assert danced(0.0001) == 1.0


def test_the_same_seed_is_the_same_dance_and_another_is_another() -> None:
    own, rhythm = candidates(12, 4, spread=0.3), beaten(64)
    grid = grid_of(rhythm)
    heard = heard_by(emission(len(own.states), 9)).hits(rhythm, 0.0)
    assert choose(grid, own, heard, seed=1) == choose(grid, own, heard, seed=1)
    assert choose(grid, own, heard, seed=1) != choose(grid, own, heard, seed=2)


def test_motions_keep_within_the_speeds_at_any_tempo() -> None:
    own = candidates(12, 4, spread=0.5)
    for beat_s in (0.3, 0.5, 0.9, 1.4):
        grid = grid_of(beaten(40, beat_s))
        found = choose(grid, own, struck(np.zeros(0), np.zeros((0, 12))), seed=1)
        for (place, one), (later, other) in pairwise(found):
            speed = (own.after_s[one] + own.before_s[other]) / (grid.times_s[later] - grid.times_s[place])
            assert 0.65 < speed < 1.54


@pytest.mark.parametrize("pace", [1.0, 1.4])
def test_motions_are_danced_at_the_pace_of_the_music(pace: float) -> None:
    """Motions of .35 to .7 s fill the time between accents at many speeds."""
    own, grid = candidates(40, 3, spread=0.5), grid_of(beaten(64))
    heard = struck(np.zeros(0), np.zeros((0, 40)))
    weights = Weights(join_per_m=0.0, chance=0.3, lately=0.0)
    found = choose(grid, replace(own, pace=pace), heard, seed=0, weights=weights)
    speeds = [
        (own.after_s[one] + own.before_s[other]) / (grid.times_s[later] - grid.times_s[place])
        for (place, one), (later, other) in pairwise(found)
    ]
    assert np.median(speeds) == pytest.approx(pace, abs=0.1)


def test_without_music_or_motion_there_is_nothing() -> None:
    own = candidates(3, 0)
    silence = struck(np.zeros(0), np.zeros((0, 3)))
    assert choose(AccentGrid(np.zeros(0), np.zeros(0, bool)), own, silence, seed=0) == []
    assert choose(AccentGrid(np.zeros(1), np.ones(1, bool)), own, silence, seed=0)


@pytest.mark.parametrize("seed", range(3))
def test_a_segment_danced_before_a_predecessor_costs_as_often_as_it_was_danced(seed: int) -> None:
    random, segments, starts_each = np.random.default_rng(seed), 12, 5
    starts = np.sort([random.permutation(segments)[:starts_each] for _ in range(segments)], axis=1)
    scores, before = random.normal(size=starts.shape).astype(np.float32), random.normal(size=segments)
    danced = random.integers(-1, segments, (segments, 4))
    nowhere = np.zeros(starts.shape, np.int64)
    table = MoveTable(scores, starts, nowhere, nowhere, np.empty(starts.shape, np.float32))
    chosen, best = table.best(before.astype(np.float32), None, danced, 0.7)
    for segment in range(segments):
        found = {
            int(start): before[start] + score - 0.7 * (danced[start] == segment).sum()
            for start, score in zip(starts[segment], scores[segment], strict=True)
        }
        assert chosen[segment] == max(found, key=lambda start: found[start])
        assert best[segment] == pytest.approx(max(found.values()), abs=1e-5)
