"""Counting, bowing, looking up and settling the hands only within their time spans."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from app.motion.gestures.body_lag import Overlapped
from app.motion.gestures.held_still import held_still, holds_of, with_holds
from app.motion.gestures.idle_gestures import Concert, Counting
from app.plan.model import GestureEvent
from tests.unit.motion.events import REASON, TICKS

TIMES_S = np.arange(0.0, 12.0, 1.0 / 240.0)
FELT = ((0, TICKS),)


def event(kind: str, start_s: float, end_s: float, amount: float = 1.0) -> GestureEvent:
    ticks = round(start_s * 2 * TICKS), round(end_s * 2 * TICKS)
    return GestureEvent(f"{kind}:{start_s}", kind, *ticks, start_s, end_s, amount, REASON)


def test_counting_is_lowest_on_each_beat_and_still_between() -> None:
    counted = Counting.of([event("count", 2.0, 6.0)], FELT).sample(TIMES_S)
    for beat in range(1, 7):
        near = np.abs(TIMES_S - (2.0 + 0.5 * beat)) < 0.24
        assert TIMES_S[near][counted[near].argmax()] == pytest.approx(2.0 + 0.5 * beat, abs=0.08)
        assert counted[near].max() > 0.3
    assert counted[(TIMES_S < 2.0) | (TIMES_S > 6.0)].max() == 0.0
    assert np.abs(np.diff(counted)).max() < 0.06


def test_a_bow_goes_down_stays_and_comes_up() -> None:
    bow = Concert.of([event("bow", 3.0, 5.5, 0.8)], FELT).sample(TIMES_S).bow
    assert bow.max() == pytest.approx(0.8)
    assert bow[(TIMES_S <= 3.0) | (TIMES_S >= 5.5)].max() == 0.0
    low = TIMES_S[bow > 0.799]
    assert low[-1] - low[0] > 0.4
    assert np.all(np.diff(bow[(TIMES_S > 3.0) & (TIMES_S < 3.8)]) >= 0.0)


def test_only_the_span_of_what_changed_is_made_anew() -> None:
    some = [event("settle_grip", 1.0, 2.0), event("count", 3.0, 6.0), event("bow", 8.0, 10.0)]
    one, other = Concert.of(some, FELT), Concert.of(some[:-1], FELT)
    assert one.changed_s(other).tolist() == [[8.0, 10.0]]
    assert len(one.changed_s(one)) == 0


@dataclass(frozen=True)
class Levels:
    sway: Overlapped
    lean: Overlapped
    accent: Overlapped
    weight: Overlapped
    giving: np.ndarray
    height: np.ndarray


def waving(times_s: np.ndarray) -> Levels:
    wave = np.sin(3.0 * times_s)
    return Levels(*(Overlapped(wave, 0.5 * wave, wave, wave) for _ in range(4)), wave, wave)  # type: ignore[call-arg]


def test_a_hold_keeps_what_is_held_where_it_is() -> None:
    holds = holds_of([event("hold_still", 4.0, 7.0)])
    levels = held_still(waving(TIMES_S), holds, TIMES_S, waving)
    for held, size in ((levels.height, 1.0), (levels.sway.hips, 1.0), (levels.lean.chest, 0.5)):
        inside = (TIMES_S > 4.36) & (TIMES_S < 6.39)
        assert np.ptp(held[inside]) < 1e-3
        outside = (TIMES_S <= 4.0) | (TIMES_S >= 7.0)
        np.testing.assert_array_equal(held[outside], size * np.sin(3.0 * TIMES_S)[outside])
        assert np.abs(np.diff(held)).max() < 0.04
    # The same frames are the same bits in every span.
    part = TIMES_S[1100:1300]
    np.testing.assert_array_equal(held_still(waving(part), holds, part, waving).height, levels.height[1100:1300])
    # A change at the beginning of a hold changes everything held.
    assert with_holds(np.array([[4.3, 4.4]]), holds).tolist() == [[4.3, 4.4], [4.0, 7.0]]
    assert with_holds(np.array([[8.0, 9.0]]), holds).tolist() == [[8.0, 9.0]]
