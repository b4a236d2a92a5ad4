"""Measures of how well arrivals and footfalls of a dance meet the beats, which determine its time map."""

from __future__ import annotations

import numpy as np
import pytest

from app.choreography.accent_grid import grid_of
from app.choreography.arrivals import BY_CHANCE, beats_met, chance_of_falls
from tests.support.dances import beaten

BEATS_S = 0.5 * np.arange(60)


def steps_s(spread_s: float, late_s: float = 0.0) -> np.ndarray:
    """Times of steps on most beats, some slightly early or late."""
    random = np.random.default_rng(4)
    chosen = BEATS_S[1:-1][random.uniform(size=58) < 0.8]
    return np.asarray(chosen + late_s + random.uniform(-spread_s, spread_s, len(chosen)))


@pytest.mark.parametrize(
    ("spread_s", "late_s", "least", "most"),
    [(0.0, 0.0, 0.0, 0.0), (0.05, 0.0, 0.0, 0.2), (0.25, 0.0, 0.3, 1.0), (0.05, 0.2, 1.0, 1.0)],
    ids=["on beats", "nearly", "anywhere", "late alike"],
)
def test_footfalls_keep_to_the_beats_if_shifted_copies_do_not(
    spread_s: float, late_s: float, least: float, most: float
) -> None:
    assert least <= chance_of_falls(steps_s(spread_s, late_s), BEATS_S) <= most


def test_without_beats_or_footfalls_nothing_is_by_chance() -> None:
    assert chance_of_falls(np.zeros(0), BEATS_S) == 0.0
    assert chance_of_falls(steps_s(0.0), BEATS_S[:1]) == 0.0


def test_a_dance_whose_feet_come_down_anywhere_is_worth_less() -> None:
    grid, arrivals_s = grid_of(beaten(60)), BEATS_S[2:-2]
    worths = [beats_met(arrivals_s, steps_s(*how), grid) for how in ((0.0,), (0.05,), (0.05, 0.2))]
    assert worths[0] > worths[1] > worths[2] + BY_CHANCE
    assert worths[1] > beats_met(arrivals_s + 0.1, steps_s(0.05), grid)
