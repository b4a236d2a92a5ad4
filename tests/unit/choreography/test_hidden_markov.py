"""Counting and Viterbi, against a slow count, every possible sequence, and hmmlearn."""

from __future__ import annotations

from itertools import pairwise, product
from math import log

import numpy as np
import pytest
from hmmlearn.hmm import CategoricalHMM

from app.choreography.hidden_markov import count, log_likelihood, viterbi
from app.choreography.rhythm import SYMBOLS


def random_model(rng, states, symbols):
    return (
        rng.dirichlet(np.ones(states)),
        rng.dirichlet(np.ones(states), states),
        rng.dirichlet(np.ones(symbols), states),
    )


def test_count_is_the_slow_count():
    rng = np.random.default_rng(5)
    n_states = 6
    states = [rng.integers(0, n_states - 1, length) for length in (0, 1, 2, 40)]
    symbols = [[rng.integers(0, len(SYMBOLS), rng.integers(0, 6)) for _ in clip] for clip in states]

    transition, emission, initial = count(states, symbols, n_states, smoothing=0.7)

    pairs = [pair for clip in states for pair in pairwise(clip.tolist())]
    observed = [
        (state, symbol)
        for clip, its_symbols in zip(states, symbols, strict=True)
        for state, some in zip(clip.tolist(), its_symbols, strict=True)
        for symbol in some.tolist()
    ]
    first = [int(clip[0]) for clip in states if len(clip)]
    for i in range(n_states):
        left = sum(a == i for a, _ in pairs)
        for j in range(n_states):
            expected = (pairs.count((i, j)) + 0.7 / n_states) / (left + 0.7)
            assert transition[i, j] == pytest.approx(expected, rel=1e-12)
        sounding = sum(a == i for a, _ in observed)
        for o in range(len(SYMBOLS)):
            expected = (observed.count((i, o)) + 0.7 / len(SYMBOLS)) / (sounding + 0.7)
            assert emission[i, o] == pytest.approx(expected, rel=1e-12)
        assert initial[i] == pytest.approx((first.count(i) + 0.7 / n_states) / (len(first) + 0.7), rel=1e-12)


def test_a_state_never_seen_may_lead_anywhere():
    transition, emission, initial = count([np.array([0, 0])], [[np.array([3]), np.array([], int)]], 4, smoothing=0.1)
    np.testing.assert_allclose(transition[3], 0.25)
    np.testing.assert_allclose(emission[3], 1 / len(SYMBOLS))
    assert initial.min() > 0.0


@pytest.mark.parametrize("smoothing", [0.0, -1.0, float("nan")])
def test_smoothing_must_leave_every_outcome_possible(smoothing):
    with pytest.raises(ValueError, match="smoothing"):
        count([], [], 2, smoothing=smoothing)


def test_segments_and_symbols_must_agree():
    with pytest.raises(ValueError, match="argument"):
        count([np.array([0, 1])], [[np.array([1])]], 2, smoothing=1.0)


@pytest.mark.parametrize("seed", range(20))
def test_viterbi_is_the_best_of_all_sequences(seed):
    rng = np.random.default_rng(seed)
    initial, transition, emission = random_model(rng, 3, 4)
    observed = [rng.integers(0, 4, rng.integers(0, 4)) for _ in range(5)]

    def log_probability(states):
        total = log(initial[states[0]]) + sum(log(transition[a, b]) for a, b in pairwise(states))
        return total + sum(log(emission[state, o]) for state, some in zip(states, observed, strict=True) for o in some)

    best = max(product(range(3), repeat=5), key=log_probability)
    states, found = viterbi(initial, transition, log_likelihood(emission, observed))

    assert tuple(states) == best
    assert found == pytest.approx(log_probability(best), rel=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_viterbi_is_that_of_hmmlearn(seed):
    rng = np.random.default_rng(100 + seed)
    other = CategoricalHMM(n_components=12)
    other.startprob_, other.transmat_, other.emissionprob_ = random_model(rng, 12, len(SYMBOLS))
    observed = rng.integers(0, len(SYMBOLS), 400)
    observed[:47] = np.arange(47)

    expected_log_probability, expected = other.decode(observed[:, None], algorithm="viterbi")
    likelihoods = log_likelihood(other.emissionprob_, list(observed[:, None]))
    states, found = viterbi(other.startprob_, other.transmat_, likelihoods)

    np.testing.assert_array_equal(states, expected)
    assert found == pytest.approx(expected_log_probability, rel=1e-9)


def test_a_long_piece_does_not_underflow():
    rng = np.random.default_rng(1)
    initial, transition, emission = random_model(rng, 8, 47)
    states, found = viterbi(initial, transition, log_likelihood(emission, [np.array([n % 47]) for n in range(20_000)]))
    assert len(states) == 20_000
    assert np.isfinite(found)


def test_impossible_steps_are_avoided_or_refused():
    initial = np.array([1.0, 0.0])
    transition = np.array([[0.0, 1.0], [1.0, 0.0]])
    nothing_received = log_likelihood(np.full((2, 47), 1 / 47), [np.array([], int)] * 3)
    assert viterbi(initial, transition, nothing_received)[0].tolist() == [0, 1, 0]
    with pytest.raises(ValueError, match="possible"):
        viterbi(initial, np.zeros((2, 2)), nothing_received)


def test_a_piece_without_steps_has_no_states():
    states, found = viterbi(np.ones(1), np.ones((1, 1)), log_likelihood(np.ones((1, 47)), []))
    assert states.shape == (0,)
    assert found == 0.0
