"""Existing classes of motions are found, identically in every run."""

from __future__ import annotations

import numpy as np
import pytest

from app.arrays import FloatArray
from app.choreography.basic_motions import SPREAD, classify


def groups(
    spread: float, sizes: tuple[int, ...] = (9, 5, 12, 7), dimensions: int = 189
) -> tuple[FloatArray, list[int]]:
    """Features around distant centres in mixed order; points deviate by `spread` (root mean square)."""
    generator = np.random.default_rng(3)
    centres = generator.standard_normal((4, 189))
    truth = generator.permutation(np.repeat(np.arange(4), (9, 5, 12, 7)))
    noise = generator.standard_normal((len(truth), 189))
    return centres[truth] + noise * spread / np.sqrt(3.0), truth.tolist()


def by_appearance(truth: list[int]) -> list[int]:
    order = list(dict.fromkeys(truth))
    return [order.index(one) for one in truth]


@pytest.mark.parametrize("states", [4, None])
def test_separate_classes_are_found(states: int | None) -> None:
    features, truth = groups(0.7 * SPREAD)
    assert classify(features, states, 0).tolist() == by_appearance(truth)


def test_the_spread_decides_how_many_there_are() -> None:
    features, _ = groups(0.7 * SPREAD)
    # The same motions of a body three times as lively: more kinds, but never more than one for three motions.
    lively = classify(3.0 * features, None, 0)
    assert 4 < lively.max() + 1 <= len(features) // 3
    assert classify(0.01 * features, None, 0).max() == 0


def test_a_seed_gives_the_same_classes_and_all_are_used() -> None:
    features = np.random.default_rng(5).standard_normal((300, 189))
    first, again = (classify(features, 20, 7) for _ in range(2))
    assert first.tolist() == again.tolist()
    assert sorted(set(first.tolist())) == list(range(20))
    assert classify(features, 20, 8).tolist() != first.tolist()
    assert classify(features, 20, 2**40 + 7).max() == 19


def test_equal_motions_are_one_class() -> None:
    assert classify(np.ones((5, 6)), 3, 0).tolist() == [0] * 5
    assert classify(np.zeros((0, 6)), None, 0).tolist() == []
    assert classify(np.zeros((0, 6)), 3, 0).tolist() == []
    assert classify(np.ones((1, 6)), None, 0).tolist() == [0]
