"""Breaths are visible whatever else the body does."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.breath.breaths_that_show import LEAST_RAD, leaning_further
from app.motion.curves.curve import moves
from app.motion.perform import prepare
from app.plan.events_by_hand import PoseEvent
from app.plan.model import GestureEvent, PlayerPlan
from app.plan.parameters import PlayerParameters
from app.steps import StepRuns
from tests.unit.motion.events import REASON, TICKS, breath
from tests.unit.motion.test_perform import BODY, CHARACTER, FPS, HOLD, MAP, made, piece, times, world

FULL = moves([(0.0, 0.4, 0.8), (0.45, 1.2, 0.1), (1.5, 1.9, 0.7), (1.95, 4.0, 0.0)])
BREATHS = (breath(0.0, 0.43), breath(1.5, 1.93))


@given(
    st.lists(st.tuples(st.floats(0.2, 3.0), st.floats(0.0, 6.3), st.floats(-0.1, 0.1)), max_size=4),
    st.floats(0.0, 0.08),
)
def test_a_breath_shows_most_of_its_own_lean_and_one_that_does_is_left_as_it_is(
    waves: list[tuple[float, float, float]], size_rad: float
) -> None:
    def others_rad(at_s: np.ndarray) -> np.ndarray:
        return sum((size * np.sin(2.0 * np.pi * hz * at_s + phase) for hz, phase, size in waves), np.zeros(len(at_s)))

    def torso_rad(at_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return others_rad(at_s), others_rad(at_s) - size_rad * FULL.sample(at_s)

    further = leaning_further(BREATHS, FULL, torso_rad)
    for event in BREATHS:
        at_s = np.linspace(event.start_s, event.end_s, 400)
        alone, shown = torso_rad(at_s)[1], torso_rad(at_s)[1] - size_rad * further.sample(at_s)
        own = size_rad * np.ptp(FULL.sample(at_s))
        if own > 2.0 * LEAST_RAD:
            assert shown[0] - shown.min() >= 0.77 * own
        if alone[0] - alone[200::25].min() > own:
            assert not further.sample(at_s).any()


@pytest.mark.parametrize("amplitude", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("seed", [0, 5])
def test_a_nod_and_a_lean_do_not_hide_a_breath(amplitude: float, seed: int) -> None:
    """Case from the bundled quartet: a nod on the beat that ends a breath, and a lean that begins within it."""
    event = breath(15.5, 16.0)
    rows = (("nod", 14.9, 16.02, 1.0), ("lean", 15.6, 19.0, 1.0), ("bell_height", 15.5, 20.0, -1.0))
    added = tuple(
        GestureEvent(f"more{kind}", kind, round(start * 960), round(end * 960), start, end, amount, REASON)
        for kind, start, end, amount in rows
    )

    def leant_deg(gestures: tuple[GestureEvent, ...]) -> float:
        plan = msgspec.structs.replace(piece(), breaths=(event,), cues=(), gestures=gestures)
        motion = made(plan, amplitude=amplitude, seed=seed)
        (hips, neck) = (place_m for place_m, _ in world(motion, "hips", "neck"))
        lean = np.degrees(np.arctan2((neck - hips)[:, 2], (neck - hips)[:, 1]))
        first, last = np.searchsorted(times(motion), (event.start_s, event.end_s))
        return float(lean[first - 1] - lean[first : last + 1].min())

    assert leant_deg(added) >= 0.75 * leant_deg(())


def test_the_trunk_is_not_taken_back_against_what_the_animator_holds() -> None:
    """The user's correction has priority over generated motion."""
    held = PoseEvent("pose:x", "torso", 0, 0, 15.8, 16.5, -12.0, 0.0, 0.0, 0.2, 0.2, REASON)
    times_s = np.arange(15.0, 17.0, 1.0 / float(FPS))

    def further(plan: PlayerPlan) -> np.ndarray:
        curves = prepare(StepRuns(), plan, PlayerParameters(), MAP, CHARACTER, HOLD, BODY, felt_beats=((0, TICKS),))
        return np.broadcast_to(curves.frames(times_s).levels.further, len(times_s))

    assert np.array_equal(further(msgspec.structs.replace(piece(), poses=(held,))), further(piece()))
