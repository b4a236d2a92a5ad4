"""Arrivals are moved to beats within the limits of speed."""

from __future__ import annotations

import numpy as np
import pytest

from app.choreography.accent_grid import AccentGrid, grid_of
from app.choreography.transition_scores import SPEEDS
from app.choreography.warp import REST_S, TimeMap, map_with_arrivals
from tests.support.dances import beaten


def even(length_s: float, every_s: float) -> TimeMap:
    """Warp without changes, with equally distant knots."""
    times_s = np.arange(0.0, length_s + 1e-9, every_s)
    return TimeMap(times_s, times_s.copy())


def test_arrivals_beside_the_beats_come_on_them() -> None:
    grid = grid_of(beaten(21))
    arrivals = 0.5 * np.arange(1, 19) + np.random.default_rng(1).uniform(-0.08, 0.08, 18)
    found = map_with_arrivals(even(10.0, 2.0), arrivals, grid)
    assert found.when(arrivals) == pytest.approx(0.5 * np.arange(1, 19), abs=1e-3)
    # The former map does not have this property.
    assert np.abs(even(10.0, 2.0).when(arrivals) - 0.5 * np.arange(1, 19)).max() > 0.05


def test_no_motion_is_hurried_or_held_beyond_the_limits() -> None:
    # Arrivals every 0.3 s to beats every second: most cannot meet one.
    arrivals = 0.3 * np.arange(1, 60) + np.random.default_rng(2).uniform(-0.1, 0.1, 59)
    found = map_with_arrivals(even(18.0, 1.0), arrivals, grid_of(beaten(19, 1.0)))
    speeds = np.diff(found.along_s) / np.diff(found.times_s)
    assert speeds.min() > SPEEDS[0] / 1.03
    assert speeds.max() < SPEEDS[1] * 1.03
    on_beat = np.abs(found.when(arrivals) - np.round(found.when(arrivals))) < 0.01
    assert on_beat.sum() >= 12


def test_without_beats_or_arrivals_it_goes_as_planned() -> None:
    plain = even(4.0, 1.0)
    for arrivals, grid in (
        (np.zeros(0), grid_of(beaten(9))),
        (np.array([1.2]), AccentGrid(np.zeros(0), np.zeros(0, bool))),
    ):
        times_s = np.linspace(0.0, 4.0, 50)
        assert map_with_arrivals(plain, arrivals, grid).at(times_s)[0] == pytest.approx(times_s)


def test_time_runs_out_before_and_after() -> None:
    along, speeds = even(4.0, 1.0).at(np.array([-10.0, -REST_S, 0.0, 2.0, 4.0, 14.0]))
    assert along == pytest.approx([-REST_S, -REST_S * (1 - np.exp(-1)), 0.0, 2.0, 4.0, 4.0 + REST_S], abs=1e-6)
    assert speeds == pytest.approx([0.0, np.exp(-1), 1.0, 1.0, 1.0, 0.0], abs=1e-6)


def test_there_and_back() -> None:
    way = TimeMap(np.array([0.0, 1.0, 1.8, 4.0]), np.array([0.0, 0.8, 2.0, 4.5]))
    times_s = np.linspace(0.0, 4.0, 33)
    assert way.when(way.at(times_s)[0]) == pytest.approx(times_s, abs=1e-4)


def test_of_two_arrivals_that_with_a_footfall_comes_on_the_beat() -> None:
    arrivals = 0.25 * np.arange(4, 68)
    steps = arrivals[1::2]
    found = map_with_arrivals(even(18.0, 6.0), arrivals, grid_of(beaten(37)), steps - 0.04)
    assert np.median(np.abs(found.when(steps) - 0.5 * np.round(found.when(steps) / 0.5))) < 0.01
    without = map_with_arrivals(even(18.0, 6.0), arrivals, grid_of(beaten(37)))
    assert np.median(np.abs(without.when(steps) - 0.5 * np.round(without.when(steps) / 0.5))) > 0.2


def test_what_was_put_there_by_hand_stays_when_arrivals_beside_it_come_on_beats() -> None:
    arrivals, grid = 0.5 * np.arange(1, 39) + 0.23, grid_of(beaten(41))
    plain = even(20.0, 2.0)
    held = np.isin(np.arange(len(plain.times_s)), (2, 5))
    at_s = plain.times_s[held] + 0.25
    by_hand = TimeMap(plain.times_s + 0.25 * held, plain.along_s + 0.23 * held, held)
    assert map_with_arrivals(by_hand, arrivals, grid).when(by_hand.along_s[held]) == pytest.approx(at_s, abs=0.005)
    moved = TimeMap(by_hand.times_s, by_hand.along_s)
    assert np.abs(map_with_arrivals(moved, arrivals, grid).when(by_hand.along_s[held]) - at_s).max() > 0.2
