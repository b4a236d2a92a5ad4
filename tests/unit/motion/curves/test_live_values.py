"""Live motion starts from its current value, never jumps, and comes to rest at the reported value."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.curves.curve import minimum_jerk
from app.motion.curves.live_values import Journey, Reach, Spring

STEP_S = 1e-4


def test_from_rest_it_is_a_minimum_jerk_move() -> None:
    reach = Reach.at_rest(0.2).toward(5.0, 1.0, 0.08)
    shares = np.linspace(0.0, 1.0, 50)
    found = [reach.at(5.0 + 0.08 * share) for share in shares]
    np.testing.assert_allclose(found, 0.2 + 0.8 * minimum_jerk(shares), atol=1e-12)
    assert reach.at(4.0) == 0.2
    assert reach.at(6.0) == 1.0
    assert reach.ended(5.08)
    assert not reach.ended(5.07)


@given(st.lists(st.tuples(st.floats(0.0, 0.2), st.floats(0.0, 1.0), st.floats(0.02, 0.3)), min_size=1, max_size=12))
def test_turned_to_other_targets_it_goes_on_with_place_and_speed(turns: list[tuple[float, float, float]]) -> None:
    reach, now_s = Reach.at_rest(0.0), 100.0
    for wait_s, target, length_s in turns:
        now_s += wait_s
        turned = reach.toward(now_s, target, length_s)
        assert turned.at(now_s) == pytest.approx(reach.at(now_s), abs=1e-9)
        speed = (reach.at(now_s + STEP_S) - reach.at(now_s - STEP_S)) / (2 * STEP_S)
        assert turned.speed_at(now_s) == pytest.approx(reach.speed_at(now_s))
        if not reach.ended(now_s - STEP_S) and now_s - STEP_S > reach.start_s and not reach.ended(now_s + STEP_S):
            assert reach.speed_at(now_s) == pytest.approx(speed, rel=1e-3, abs=0.05)
        assert turned.at(now_s + length_s) == pytest.approx(target, abs=1e-9)
        assert turned.speed_at(now_s + length_s) == 0.0
        reach = turned


def test_a_spring_is_as_good_as_there_when_it_should_be_whatever_the_steps() -> None:
    for steps in (1, 7, 100):
        spring = Spring(0.0, 0.2)
        values = [spring.follow(1.0, 0.2 / steps) for _ in range(steps)]
        assert values[-1] == pytest.approx(0.98, abs=0.003)
        assert max(values) < 1.0
        assert values == sorted(values)


def test_a_journey_leads_from_place_to_place() -> None:
    journey = Journey()
    assert journey.at(1.0) == (0, 0, 1.0)
    journey.go(2.0, 3, 0.1)
    before, after, share = journey.at(2.05)
    assert (before, after) == (0, 3)
    assert share == pytest.approx(0.5)
    assert journey.at(2.1) == (3, 3, 1.0)


def test_on_its_way_it_turns_back_at_once() -> None:
    journey = Journey()
    journey.go(2.0, 3, 0.1)
    journey.go(2.04, 0, 0.1)
    shares = [journey.at(2.04 + 0.01 * step)[2] for step in range(11)]
    assert shares[1] > shares[0]
    assert shares[-2] < 0.05
    assert journey.at(2.15) == (0, 0, 1.0)


@pytest.mark.parametrize(("asked_s", "through"), [(2.03, 0), (2.07, 3)])
def test_to_a_third_place_it_goes_by_the_nearer_end(asked_s: float, through: int) -> None:
    journey = Journey()
    journey.go(2.0, 3, 0.1)
    journey.go(asked_s, 1, 0.1)
    seen = [journey.at(asked_s + 0.002 * step) for step in range(120)]
    ways = list(dict.fromkeys((before, after) for before, after, _ in seen))
    assert ways == [(0, 3), (through, 1), (1, 1)]
    assert seen[-1] == (1, 1, 1.0)
    # Between and at these times the value is continuous, so no jump is visible.
    for (before, after, share), (then, there, gone) in itertools.pairwise(seen):
        if (before, after) == (then, there):
            assert abs(gone - share) < 0.12
        else:
            at = {before: 1.0 - share, after: share}
            assert at[then] > 0.9


@given(st.lists(st.tuples(st.floats(0.0, 0.15), st.integers(0, 4)), max_size=25))
def test_it_gets_there_whatever_was_asked_meanwhile(asked: list[tuple[float, int]]) -> None:
    journey, now_s = Journey(), 0.0
    for wait_s, goal in asked:
        now_s += wait_s
        journey.go(now_s, goal, 0.06)
        _, _, share = journey.at(now_s)
        assert 0.0 <= share <= 1.0
    assert journey.at(now_s + 0.3) == (journey.goal, journey.goal, 1.0)
