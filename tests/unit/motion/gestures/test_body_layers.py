from __future__ import annotations

import numpy as np
import pytest

from app.motion.breath.air_in_trunk import air, lungs
from app.motion.curves.following_gestures import follow, path
from app.motion.gestures.accents import Accents
from app.motion.gestures.body_layers import sunk
from app.motion.gestures.feet import Feet
from app.motion.gestures.layers import lowering_curve
from app.plan.model import GestureEvent
from tests.unit.motion.events import REASON, TICKS, breath


def gesture(kind: str, start_s: float, end_s: float, amount: float = 1.0) -> GestureEvent:
    ticks = round(start_s * 2 * TICKS), round(end_s * 2 * TICKS)
    return GestureEvent(f"{kind}{start_s}", kind, *ticks, start_s, end_s, amount, REASON)


def test_a_sway_is_where_it_goes_at_its_end() -> None:
    swings = [gesture("sway", float(i), float(i + 1), amount) for i, amount in enumerate([0.8, -0.5, 0.3])]
    values = path(swings).sample(np.array([-1.0, 0.0, 1.0, 2.0, 3.0, 9.0]))
    np.testing.assert_allclose(values, [0.0, 0.0, 0.8, -0.5, 0.3, 0.0], atol=1e-12)


def test_hips_sink_into_an_accent_without_a_jerk() -> None:
    times_s = np.linspace(0.0, 1.0, 241)
    down = Accents.of([gesture("accent", 0.2, 0.8)]).sample(times_s)
    by = sunk(down)
    assert down.min() < -0.1
    assert by.min() == 0.0
    assert by.max() == pytest.approx(1.0, abs=0.01)
    jolts, clipped = (np.abs(np.diff(one, 2)).max() for one in (by, np.maximum(down, 0.0)))
    assert jolts < 0.4 * clipped


def test_a_weight_shift_goes_over_in_its_transition_and_stays() -> None:
    shifts = [gesture("weight_shift", 1.0, 5.0, 1.0), gesture("weight_shift", 5.0, 9.0, -1.0)]
    values = follow(shifts, 1.2).sample(np.array([1.0, 1.6, 2.2, 4.9, 5.0, 5.6, 6.2]))
    np.testing.assert_allclose(values, [0.0, 0.5, 1.0, 1.0, 1.0, 0.0, -1.0], atol=1e-12)


def test_nothing_planned_is_nothing_done() -> None:
    times_s = np.linspace(0.0, 10.0, 50)
    assert not path(()).sample(times_s).any()
    assert not follow((), 1.0).sample(times_s).any()
    assert not Accents.of(()).sample(times_s).any()
    assert not Feet.of((), 0.5).sample(times_s)
    assert not air(()).sample(times_s).any()
    assert not lowering_curve((), 1.0, 1.0).sample(times_s).any()
    assert not lungs(())[0].sample(times_s).any()


def test_the_instrument_is_up_again_when_the_gesture_ends() -> None:
    curve = lowering_curve([gesture("lower_instrument", 2.0, 8.0), gesture("lower_instrument", 10.0, 11.0)], 1.1, 1.2)
    values = curve.sample(np.array([2.0, 3.1, 5.0, 6.8, 8.0, 9.0, 10.0, 10.47, 11.0]))
    np.testing.assert_allclose(values[[0, 1, 2, 3, 4, 5, 6, 8]], [0, 1, 1, 1, 0, 0, 0, 0], atol=1e-9)


def test_lowerings_that_overlap_are_one() -> None:
    whole, within = gesture("lower_instrument", 0.0, 20.0, 0.4), gesture("lower_instrument", 0.0, 5.0)
    after = gesture("lower_instrument", 18.0, 25.0, 0.2)
    curve = lowering_curve([whole, within, after, gesture("lower_instrument", 30.0, 30.0)], 1.0, 1.0)
    values = curve.sample(np.array([0.0, 1.0, 5.0, 19.9, 24.0, 25.0, 30.0]))
    np.testing.assert_allclose(values, [0, 1, 1, 1, 1, 0, 0], atol=1e-9)


def test_sways_that_begin_together_are_the_last_of_them() -> None:
    times_s = np.linspace(0.0, 10.0, 300)
    both = [gesture("sway", 1.0, 4.0, 0.2), gesture("sway", 1.0, 6.0)]
    np.testing.assert_array_equal(path(both).sample(times_s), path(both[1:]).sample(times_s))


def test_the_lungs_fill_over_a_breath_and_empty_over_the_phrase() -> None:
    full, lean = lungs((breath(0.0, 0.5, 0.4, "preparation"), breath(0.5, 1.0, 1.0), breath(6.0, 6.3, 0.2)))
    values = full.sample(np.array([0.5, 0.97, 1.0, 4.0, 6.0, 6.28]))
    np.testing.assert_allclose(values, [0.0, 1.0, 1.0, 0.0, 0.0, 0.6], atol=1e-9)
    np.testing.assert_allclose(lean.sample(np.array([0.0, 0.5, 0.9])), [0.0, 1.0, 0.0], atol=1e-9)


def test_breaths_that_follow_each_other_closely_all_show() -> None:
    breaths = tuple(breath(0.33 * i, 0.33 * i + 0.16, 0.3) for i in range(12))
    full, _ = lungs(breaths)
    rises = [full.sample(np.array([each.start_s, each.end_s])) for each in breaths]
    assert min(end - start for start, end in rises) > 0.39


def test_breaths_that_overlap_fill_the_lungs_once() -> None:
    breaths = (breath(0.0, 1.0, 0.5), breath(0.2, 0.6, 0.5), breath(0.9, 1.4, 1.0), breath(0.95, 0.96, 1.0))
    full, _ = lungs(breaths)
    times_s = np.linspace(-1.0, 3.0, 400)
    values = full.sample(times_s)
    assert np.isfinite(values).all()
    assert full.sample(np.array([0.0, 1.4]))[1] > 0.9
