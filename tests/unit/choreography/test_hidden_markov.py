"""Counts of states and transitions compared with a slow count."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from app.choreography.hidden_markov import count
from app.choreography.rhythm import SYMBOLS


def test_count_is_the_slow_count() -> None:
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


def test_a_state_never_seen_may_lead_anywhere() -> None:
    transition, emission, initial = count([np.array([0, 0])], [[np.array([3]), np.array([], int)]], 4, smoothing=0.1)
    np.testing.assert_allclose(transition[3], 0.25)
    np.testing.assert_allclose(emission[3], 1 / len(SYMBOLS))
    assert initial.min() > 0.0


@pytest.mark.parametrize("smoothing", [0.0, -1.0, float("nan")])
def test_smoothing_must_leave_every_outcome_possible(smoothing: float) -> None:
    with pytest.raises(ValueError, match="smoothing"):
        count([], [], 2, smoothing=smoothing)


def test_segments_and_symbols_must_agree() -> None:
    with pytest.raises(ValueError, match="argument"):
        count([np.array([0, 1])], [[np.array([1])]], 2, smoothing=1.0)
