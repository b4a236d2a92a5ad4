from __future__ import annotations

import numpy as np
import pytest

from app.motion.body import Bobbing, follow, lungs
from app.motion.lowering import lowering
from app.plan.model import GestureEvent
from tests.unit.motion.events import REASON, TICKS, breath


def gesture(kind: str, start_s: float, end_s: float, amount: float = 1.0) -> GestureEvent:
    ticks = round(start_s * 2 * TICKS), round(end_s * 2 * TICKS)
    return GestureEvent(f"{kind}{start_s}", kind, *ticks, start_s, end_s, amount, REASON)  # type: ignore[arg-type]


def test_a_sway_is_where_it_goes_at_its_end() -> None:
    swings = [gesture("sway", float(i), float(i + 1), amount) for i, amount in enumerate([0.8, -0.5, 0.3])]
    values = follow(swings, "sway").sample(np.array([-1.0, 0.0, 1.0, 2.0, 3.0, 9.0]))
    np.testing.assert_allclose(values, [0.0, 0.0, 0.8, -0.5, 0.3, 0.0], atol=1e-12)


def test_a_weight_shift_goes_over_in_its_transition_and_stays() -> None:
    shifts = [gesture("weight_shift", 1.0, 5.0, 1.0), gesture("weight_shift", 5.0, 9.0, -1.0)]
    values = follow(shifts, "weight_shift", 1.2).sample(np.array([1.0, 1.6, 2.2, 4.9, 5.0, 5.6, 6.2]))
    np.testing.assert_allclose(values, [0.0, 0.5, 1.0, 1.0, 1.0, 0.0, -1.0], atol=1e-12)


def test_nothing_planned_is_nothing_done() -> None:
    times_s = np.linspace(0.0, 10.0, 50)
    assert not follow((), "sway").sample(times_s).any()
    assert not Bobbing.of((), ((0, TICKS),)).sample(times_s).any()
    assert not lowering((), 1.0, 1.0).sample(times_s).any()
    assert not lungs(())[0].sample(times_s).any()


@pytest.mark.parametrize("beats", [1, 2, 4])
def test_a_bob_is_lowest_and_accelerates_most_on_every_beat(beats) -> None:
    beat_s = 0.5
    swings = [gesture("sway", i * beats * beat_s, (i + 1) * beats * beat_s) for i in range(8)]
    times_s = np.arange(0.0, 8 * beats * beat_s, 1e-3)
    down = Bobbing.of(swings, ((0, TICKS),)).sample(times_s)
    for beat in np.arange(1, 8 * beats - 2):
        near = np.abs(times_s - beat * beat_s) < 0.24
        assert times_s[near][down[near].argmax()] == pytest.approx(beat * beat_s, abs=0.02)


def test_a_swing_has_the_beats_that_are_felt_where_it_begins() -> None:
    swings = [gesture("sway", 2.0 * i, 2.0 * (i + 1)) for i in range(4)]
    lasts_ticks = swings[0].end_tick - swings[0].start_tick
    changes = ((0, lasts_ticks // 4), (swings[2].start_tick, lasts_ticks // 2))
    np.testing.assert_array_equal(Bobbing.of(swings, changes).beats, [4, 4, 2, 2])


def test_between_swings_far_apart_the_body_stands_upright() -> None:
    swings = [gesture("sway", float(i), float(i + 1)) for i in (0, 1, 2, 100, 101)]
    times_s = np.arange(-1.0, 104.0, 1e-3)
    down = Bobbing.of(swings, ((0, TICKS),)).sample(times_s)
    assert not down[(times_s > 4.0) & (times_s < 99.0)].any()
    assert down[(times_s > 99.9) & (times_s < 100.9)].max() > 0.5
    # It comes up and goes down in a second each, without a jump.
    assert np.abs(np.diff(down)).max() < 0.02


def test_the_instrument_is_up_again_when_the_gesture_ends() -> None:
    curve = lowering([gesture("lower_instrument", 2.0, 8.0), gesture("lower_instrument", 10.0, 11.0)], 1.1, 1.2)
    values = curve.sample(np.array([2.0, 3.1, 5.0, 6.8, 8.0, 9.0, 10.0, 10.47, 11.0]))
    np.testing.assert_allclose(values[[0, 1, 2, 3, 4, 5, 6, 8]], [0, 1, 1, 1, 0, 0, 0, 0], atol=1e-9)


def test_lowerings_that_overlap_are_one() -> None:
    whole, within = gesture("lower_instrument", 0.0, 20.0, 0.4), gesture("lower_instrument", 0.0, 5.0)
    after = gesture("lower_instrument", 18.0, 25.0, 0.2)
    curve = lowering([whole, within, after, gesture("lower_instrument", 30.0, 30.0)], 1.0, 1.0)
    values = curve.sample(np.array([0.0, 1.0, 5.0, 19.9, 24.0, 25.0, 30.0]))
    np.testing.assert_allclose(values, [0, 1, 1, 1, 1, 0, 0], atol=1e-9)


def test_sways_that_begin_together_are_the_last_of_them() -> None:
    times_s = np.linspace(0.0, 10.0, 300)
    both = [gesture("sway", 1.0, 4.0, 0.2), gesture("sway", 1.0, 6.0)]
    np.testing.assert_array_equal(
        Bobbing.of(both, ((0, TICKS),)).sample(times_s), Bobbing.of(both[1:], ((0, TICKS),)).sample(times_s)
    )
    np.testing.assert_array_equal(follow(both, "sway").sample(times_s), follow(both[1:], "sway").sample(times_s))


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
