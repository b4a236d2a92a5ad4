"""Sliding of feet in files: standing feet do not slide, and planned steps do not count."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from app.export.measure import slid_m
from app.plan.model import GestureEvent, PlayerPlan, TimeFrame
from metadata.load import load_body
from tests.unit.motion.events import REASON

BODY = load_body()
TIMES_S = np.arange(0.0, 10.0, 0.02)
PLAN = PlayerPlan("p", TimeFrame(0.0, 10.0), (), (), (), (), (), (), (), ())


def plan(*rows: tuple[str, float, float, float]) -> PlayerPlan:
    events = [GestureEvent(f"{i}", kind, 0, 1, a, b, amount, REASON) for i, (kind, a, b, amount) in enumerate(rows)]
    return msgspec.structs.replace(PLAN, gestures=tuple(events))


def stepping(out_m: float = 0.08) -> np.ndarray:
    """Foot that stands forward from 2 s to 6 s, with steps of half a second."""
    ahead = out_m * (np.clip((TIMES_S - 2.0) / 0.5, 0, 1) - np.clip((TIMES_S - 5.5) / 0.5, 0, 1))
    return np.stack((np.zeros(len(TIMES_S)), 0.02 * np.sin(np.pi * ahead / out_m), ahead), axis=1)


def test_a_planned_step_is_no_slide_and_one_that_is_not_planned_is() -> None:
    step = plan(("step", 2.0, 6.0, 0.7))
    assert slid_m(stepping(), TIMES_S, step, "left.foot.sole", BODY).max() < 1e-6
    assert slid_m(stepping(), TIMES_S, step, "right.foot.sole", BODY).max() == pytest.approx(0.08, abs=1e-3)
    assert slid_m(stepping(), TIMES_S, plan(), "left.foot.sole", BODY).max() == pytest.approx(0.08, abs=1e-3)


def test_a_foot_slides_where_it_stands_also_between_the_ways_of_a_step() -> None:
    sole_m = stepping()
    sole_m[(TIMES_S > 3.5) & (TIMES_S < 4.0), 0] += 0.004
    found = slid_m(sole_m, TIMES_S, plan(("step", 2.0, 6.0, 0.7)), "left.foot.sole", BODY)
    assert found.max() == pytest.approx(0.004, abs=1e-6)
    # A foot that does not return counts with its full distance.
    sole_m = stepping()
    sole_m[TIMES_S > 6.0, 2] = 0.01
    found = slid_m(sole_m, TIMES_S, plan(("step", 2.0, 6.0, 0.7)), "left.foot.sole", BODY)
    assert found.max() == pytest.approx(0.01, abs=1e-6)


def test_a_tap_lifts_its_own_foot_for_its_own_time() -> None:
    sole_m = np.zeros((len(TIMES_S), 3))
    sole_m[(TIMES_S > 1.0) & (TIMES_S < 1.4), 1] = 0.01
    assert slid_m(sole_m, TIMES_S, plan(("tap", 1.0, 1.4, -1.0)), "right.foot.sole", BODY).max() == 0.0
    assert slid_m(sole_m, TIMES_S, plan(("tap", 1.0, 1.2, -1.0)), "right.foot.sole", BODY).max() == pytest.approx(0.01)
