"""Speed of generation: one player's motion against real time, and against a fixed piece of numpy work."""

from __future__ import annotations

import time
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest

from app.plan.model import GestureEvent, PlayerPlan
from app.plan.parameters import PlayerParameters
from metadata.load import load_body
from tests.support.performed import perform
from tests.unit.motion import figure
from tests.unit.motion.events import REASON, TICKS, breath, cue, fingerings, plan_of, press, slide

MINUTES = 10.0
REAL_TIME_RATIO = 300.0


def best_s(work: Callable[[], object], times: int = 3) -> float:
    """Shortest of some runs."""
    spent = []
    for _ in range(times):
        start = time.perf_counter()
        work()
        spent.append(time.perf_counter() - start)
    return min(spent)


def calibration() -> None:
    """A fixed piece of work of the same kind: products of quaternions in chunks."""
    a = np.random.default_rng(1).normal(size=(4, 4096))
    for _ in range(2000):
        a[0] * a[3] + a[1] * a[2] - a[2] * a[1] + a[3] * a[0]


def long_plan() -> PlayerPlan:
    """Ten minutes of eighths, quarters and rests with all a plan has."""
    random = np.random.default_rng(1)
    rows, breaths, gestures = [], [], []
    t = 0.0
    while t < MINUTES * 60:
        length_s = float(random.choice([0.25, 0.5, 0.5, 1.0]))
        controls = {
            "valve_1": float(random.integers(2)),
            "slide": float(random.choice([0.0, 0.13, 0.27, 0.41, 0.57, 0.7])),
        }
        rows.append((t, t + length_s, controls))
        t += length_s
        if random.random() < 0.1:
            breaths.append(breath(t + 0.5, t + 1.0))
            t += 1.0
    for i, start in enumerate(np.arange(0.0, t, 1.0)):
        tick = round(start * 2 * TICKS)
        gestures.append(
            GestureEvent(f"s{i}", "sway", tick, tick + 2 * TICKS, float(start), float(start + 1), (-1.0) ** i, REASON)
        )
    return plan_of(
        fingerings(rows),
        breaths=(breath(-0.5, 0.0), *breaths),
        cues=(cue(0.0),),
        gestures=tuple(gestures),
    )


@pytest.mark.bench
@pytest.mark.parametrize("slide_m", [0.0, 0.4])
def test_motion_is_far_faster_than_real_time(slide_m: float) -> None:
    plan, body, character = long_plan(), load_body(), figure.character()
    hold, instrument = figure.hold(character.skeleton, slide_m), figure.instrument_map(press(), slide())

    def make() -> None:
        perform(plan, PlayerParameters(), instrument, character, hold, body, felt_beats=((0, TICKS),), fps=Fraction(60))

    spent_s, unit_s = best_s(make), best_s(calibration)
    length_s = plan.time_frame.end_s - plan.time_frame.first_frame_s
    print(
        f"\nmotion: {length_s / spent_s:.0f} x real time at 60 frames/s, "
        f"{spent_s / length_s / 60 * 1e6:.1f} us a frame, {spent_s / unit_s:.1f} calibration loops"
    )
    assert length_s / spent_s > REAL_TIME_RATIO
