"""Nods: up before the beat and down on it, with the greatest acceleration there."""

from __future__ import annotations

import numpy as np
import pytest

from app.motion.gestures.nods import Nods
from app.plan.model import CueEvent, GestureEvent
from tests.unit.motion.events import REASON, cue

TIMES_S = np.arange(-4.0, 8.0, 1.0 / 240.0)


def answer(beat_s: float, length_s: float, amount: float = 0.5) -> GestureEvent:
    return GestureEvent(f"nod:{beat_s}", "nod", 0, 1, beat_s - 1.5 * length_s, beat_s, amount, REASON)


def height(nods: Nods) -> np.ndarray:
    dip, lift = nods.sample(TIMES_S)
    return 0.6 * lift - dip


@pytest.mark.parametrize("length_s", [0.3, 0.5, 0.9, 1.5])
def test_the_acceleration_peaks_on_the_downbeat_and_nothing_falls_before(length_s: float) -> None:
    for nods in (Nods.of([cue(2.0, length_s)]), Nods.of([], [answer(2.0, length_s)])):
        up = height(nods)
        acceleration = np.gradient(np.gradient(up, TIMES_S), TIMES_S)
        assert TIMES_S[np.abs(acceleration).argmax()] == pytest.approx(2.0, abs=1.0 / 120.0)
        # On the preparatory beat it is on its way up, and it is highest between that beat and the next.
        assert np.interp(2.0 - length_s, TIMES_S, np.gradient(up, TIMES_S)) > 0.0
        assert 2.0 - length_s < TIMES_S[up.argmax()] < 2.0 - 0.3 * length_s
        assert up[2.0 - 0.6 * length_s > TIMES_S].min() >= 0.0
        # The tempo is how long it takes: from the first rise to rest.
        moving = TIMES_S[np.abs(up) > 1e-6]
        assert moving[0] == pytest.approx(2.0 - 1.4 * length_s, abs=0.2 * length_s)
        # It comes up more slowly than it dropped, and is there before the next beat.
        assert 0.5 * length_s < moving[-1] - 2.0 < length_s
        speed = np.gradient(up, TIMES_S)
        assert speed[TIMES_S > 2.0].max() < -0.7 * speed.min()


def test_before_a_pickup_it_drops_on_the_beat_that_the_pickup_lies_in() -> None:
    pickup = CueEvent("c", "player", 0, 0, 0.25, 0.5, 1.25, 0.5, REASON)
    assert pickup.downbeat_s == 1.0
    assert TIMES_S[height(Nods.of([pickup])).argmin()] == pytest.approx(1.0, abs=0.015)


def test_a_cue_that_begins_late_has_less_room_to_rise() -> None:
    late = CueEvent("c", "player", 0, 0, 0.6, 0.5, 1.0, 0.5, REASON)
    up = height(Nods.of([late]))
    assert np.abs(up[TIMES_S < 0.6]).max() == 0.0
    assert TIMES_S[up.argmin()] == pytest.approx(1.0, abs=0.015)


def test_what_is_the_same_needs_no_new_picture() -> None:
    one, other = Nods.of([cue(0.0), cue(4.0)]), Nods.of([cue(0.0), cue(4.0)], [answer(6.0, 0.5)])
    (span,) = one.changed_s(other).tolist()
    differ = height(one) != height(other)
    assert differ.any()
    assert span[0] <= TIMES_S[differ].min()
    assert TIMES_S[differ].max() <= span[1]
    assert len(one.changed_s(one)) == 0
