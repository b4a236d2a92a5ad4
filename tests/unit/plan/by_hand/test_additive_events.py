"""The user's curves: values between keys, limits, and reported problems."""

from __future__ import annotations

import math
from itertools import pairwise

import msgspec
import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from app.plan.by_hand.additive_curve import CHANNELS, AdditiveCurve, CurveKey, Tangent
from app.plan.by_hand.additive_events import channel_limits, plan_additive, segments
from app.plan.by_hand.bezier import looked_at_s, rows, sampled
from app.plan.parameters import PlayerParameters
from instrument_maps.load import bundled_maps
from metadata.load import load_body
from tests.support.plan import PlainClock

CLOCK = PlainClock(((0, 120.0),))
"""Clock with 960 ticks per second."""
TRUMPET = next(instrument for id, instrument in bundled_maps().items() if id.startswith("trumpet"))
CELLO_LIKE = [instrument for instrument in bundled_maps().values() if instrument.endpin is not None]
STANDING = PlayerParameters()
KEYS = (CurveKey(960, 0.0), CurveKey(1920, 4.0), CurveKey(2400, 6.0), CurveKey(3840, -2.0), CurveKey(4800, -2.0))


def values(curve: AdditiveCurve, times_s: np.ndarray) -> np.ndarray:
    return sampled(segments(curve, CLOCK), times_s)


def test_every_key_is_reached_whatever_the_interpolation() -> None:
    for interpolation in ("bezier", "linear", "constant"):
        keys = tuple(msgspec.structs.replace(key, interpolation=interpolation) for key in KEYS)
        found = values(AdditiveCurve("a", "head.up", keys), np.array([key.tick / 960 for key in keys]))
        np.testing.assert_allclose(found, [key.value for key in keys], atol=1e-9)


def test_automatic_curves_are_those_of_a_monotone_interpolator() -> None:
    times_s = np.linspace(1.0, 5.0, 801)
    knots_s, heights = [key.tick / 960 for key in KEYS], [key.value for key in KEYS]
    inner = PchipInterpolator(knots_s, heights)
    found = values(AdditiveCurve("a", "head.up", KEYS), times_s)
    between = (times_s >= 2.0) & (times_s <= 4.0)
    np.testing.assert_allclose(found[between], inner(times_s[between]), atol=1e-6)
    for (start_s, end_s), (low, high) in zip(pairwise(knots_s), pairwise(heights), strict=True):
        here = found[(times_s >= start_s) & (times_s <= end_s)]
        assert here.min() >= min(low, high) - 1e-9
        assert here.max() <= max(low, high) + 1e-9


def test_handles_make_the_cubic_that_they_say() -> None:
    keys = (
        CurveKey(960, 1.0, leave=Tangent(700, 5.0)),
        CurveKey(1920, 3.0, arrive=Tangent(200, -4.0)),
    )
    x, y = (1.0, 1.0 + 700 / 960, 2.0 - 200 / 960, 2.0), (1.0, 6.0, -1.0, 3.0)

    def cubic(points: tuple[float, ...], u: float) -> float:
        return sum(math.comb(3, n) * (1 - u) ** (3 - n) * u**n * point for n, point in enumerate(points))

    times_s = np.linspace(1.0, 2.0, 41)
    expected = []
    for time_s in times_s.tolist():
        u = brentq(lambda u, time_s=time_s: cubic(x, u) - time_s, 0.0, 1.0, xtol=1e-14)
        expected.append(cubic(y, u))
    np.testing.assert_allclose(values(AdditiveCurve("a", "head.up", keys), times_s), expected, atol=1e-7)


def test_a_handle_beyond_the_next_key_never_turns_time_back() -> None:
    keys = (CurveKey(960, 0.0, leave=Tangent(9600, 5.0)), CurveKey(1920, 1.0, arrive=Tangent(9600, -5.0)))
    (segment,) = [one for one in segments(AdditiveCurve("a", "head.up", keys), CLOCK) if not one.eased]
    assert segment.start_s <= segment.arrive_s <= segment.end_s
    assert segment.start_s <= segment.leave_s <= segment.end_s
    assert segment.leave_value == pytest.approx(0.5)


def test_it_comes_in_before_the_first_key_and_goes_after_the_last() -> None:
    curve = AdditiveCurve("a", "head.up", (CurveKey(1920, 5.0), CurveKey(2880, 5.0)), 480, 960)
    found = values(curve, np.array([1.49, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0, 4.1]))
    np.testing.assert_allclose(found, [0.0, 0.0, 2.5, 5.0, 5.0, 5.0, 2.5, 0.0, 0.0], atol=1e-9)


@pytest.mark.parametrize("value", [2.0, 12.0, -40.0])
def test_without_a_blend_it_comes_as_quickly_as_is_gentle(value: float) -> None:
    shape = segments(AdditiveCurve("a", "left_elbow.up", (CurveKey(1920, value),)), CLOCK)
    for one in shape:
        peak_rad_s2 = 10.0 / math.sqrt(3.0) * math.radians(abs(value)) / (one.end_s - one.start_s) ** 2
        assert peak_rad_s2 <= 40.0 + 1e-9


def test_a_constant_key_holds_and_steps_in_the_least_time() -> None:
    keys = (CurveKey(960, 0.0, "constant"), CurveKey(1920, 10.0, "constant"), CurveKey(2000, 0.0))
    found = values(AdditiveCurve("a", "head.up", keys), np.array([1.0, 1.5, 1.8, 2.0]))
    np.testing.assert_allclose(found, [0.0, 0.0, 0.0, 10.0], atol=1e-9)


def test_the_weight_scales_and_a_curve_that_is_off_is_nothing() -> None:
    curve = AdditiveCurve("a", "head.up", KEYS, 480, 480)
    times_s = np.linspace(0.0, 6.0, 200)
    half = msgspec.structs.replace(curve, weight=0.5)
    inside = (times_s >= 1.0) & (times_s <= 5.0)
    np.testing.assert_allclose(values(half, times_s)[inside], 0.5 * values(curve, times_s)[inside], atol=1e-9)
    off = (msgspec.structs.replace(curve, enabled=False), msgspec.structs.replace(curve, weight=0.0))
    assert plan_additive(off, TRUMPET, STANDING, CLOCK) == ((), ())


def test_events_are_in_order_and_know_their_limits() -> None:
    late, soon = AdditiveCurve("a", "head.up", (CurveKey(4800, 2.0),)), AdditiveCurve("b", "bell.up", KEYS)
    events, problems = plan_additive((late, soon), TRUMPET, STANDING, CLOCK)
    assert [event.id for event in events] == ["additive:b", "additive:a"]
    assert (events[0].start_tick, events[0].end_tick) == (960, 4800)
    assert all(event.low < 0.0 < event.high for event in events)
    assert not problems


def test_what_a_body_cannot_do_is_reported() -> None:
    far = AdditiveCurve("far", "hips.left", (CurveKey(1920, 0.5),), 960, 960)
    (_,), (problem,) = plan_additive((far,), TRUMPET, STANDING, CLOCK)
    assert problem.message.id == "additive.beyond_reach"
    assert problem.message.arguments == {"moved": "hips.left", "asked": 50.0, "most": 9.0, "unit": " cm"}
    fast = AdditiveCurve("fast", "head.left", (CurveKey(960, -8.0), CurveKey(970, 8.0, "linear"), CurveKey(980, -8.0)))
    _, (problem,) = plan_additive((fast,), TRUMPET, STANDING, CLOCK)
    assert problem.message.id == "additive.too_fast"


def test_hips_stay_on_a_seat() -> None:
    seated = PlayerParameters(posture="seated")
    curve = AdditiveCurve("a", "hips.left", (CurveKey(1920, 0.05),))
    events, (problem,) = plan_additive((curve,), TRUMPET, seated, CLOCK)
    assert not events
    assert problem.message.id == "additive.not_here"


def test_every_channel_has_limits_on_every_instrument() -> None:
    body = load_body()
    for instrument in bundled_maps().values():
        for posture in ("standing", "seated"):
            for channel in CHANNELS:
                low, high = channel_limits(channel, instrument, PlayerParameters(posture=posture), body)
                assert low <= 0.0 <= high


def test_a_key_beyond_all_music_costs_no_more_than_one_nearby() -> None:
    """Examining every frame up to the last possible tick would take 10 GB."""
    far = AdditiveCurve("far", "bell.up", (CurveKey(0, 1.0), CurveKey(2**31 - 2, 500.0)))
    assert len(looked_at_s(rows(segments(far, CLOCK)), 1 / 60, 240)) < 1000
    (_,), (problem,) = plan_additive((far,), TRUMPET, STANDING, CLOCK)
    assert problem.message.id == "additive.beyond_reach"
    assert problem.message.arguments["asked"] == 500.0


def test_what_is_too_fast_is_seen_in_a_long_segment() -> None:
    """Each handle extends to the other key, so that the curve is as steep as a step in the middle."""
    length = 60 * 960
    keys = CurveKey(0, -90.0, leave=Tangent(length, 0.0)), CurveKey(length, 90.0, arrive=Tangent(length, 0.0))
    gentle = CurveKey(0, -90.0), CurveKey(length, 90.0)
    for which, expected in ((keys, True), (gentle, False)):
        _, problems = plan_additive((AdditiveCurve("a", "head.left", which),), TRUMPET, STANDING, CLOCK)
        assert ("additive.too_fast" in [problem.message.id for problem in problems]) == expected
