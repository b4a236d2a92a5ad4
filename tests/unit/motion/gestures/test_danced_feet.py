"""Feet of a dancing player: planted between moves, moved one at a time, and left to the user's gestures."""

from __future__ import annotations

import numpy as np
import pytest

from app.errors import Message
from app.motion.gestures.danced_feet import IN_HIPS, LIFT_M, MOVE_KINDS, PEELS_S, DancedFeet, with_danced
from app.plan.model import GestureEvent

STEP, HEEL, TOES = map(MOVE_KINDS.index, ("step", "heel", "toes"))
TIMES_S = np.arange(0.0, 8.0, 1 / 120)


def feet(*rows: tuple[int, int, float, float, float]) -> DancedFeet:
    """Moves of (foot, kind, beat of landing, left, ahead) at half a second per beat."""
    sides, kinds, beats, left_m, ahead_m = np.array(rows, np.float64).reshape(-1, 5).T
    lands_s = 0.5 * beats
    return DancedFeet(
        sides.astype(np.int64),
        kinds.astype(np.int64),
        np.where(kinds == HEEL, HEEL, TOES).astype(np.int64),
        lands_s - 0.4,
        lands_s,
        np.ones(len(rows)),
        np.stack([left_m, ahead_m], axis=1),
    )


WALK = feet((0, STEP, 2, 0.05, 0.0), (1, STEP, 4, -0.03, 0.04), (0, STEP, 6, -0.02, 0.02), (1, HEEL, 8, -0.03, 0.04))


def correction(kind: str, start_s: float, end_s: float, *, corrected: bool) -> GestureEvent:
    return GestureEvent("x", kind, 0, 480, start_s, end_s, 1.0, Message("gesture.tap", {}), corrected)


def test_a_foot_is_put_on_its_beat_and_stays_to_the_bit() -> None:
    found = WALK.sample(TIMES_S, steps=True)
    # The left foot lands at 1 and 3 s, each time from 0.4 s before.
    for first_s, last_s, place_m in ((0.0, 0.6, 0.0), (1.0, 2.6, 0.05), (3.0, 8.0, -0.02)):
        stands = (first_s <= TIMES_S) & (last_s >= TIMES_S)
        assert np.all(found["left_aside"][stands] == place_m)
        assert np.all(found["left_up"][stands] == 0.0)
    assert found["left_up"].max() == pytest.approx(LIFT_M, rel=0.01)
    # Heel first up, ball first down.
    at = [int(np.searchsorted(TIMES_S, time_s)) for time_s in (0.59, 1.01, 1.0 + PEELS_S + 0.01)]
    assert found["left_heel"][at[0]] > 0.0
    assert found["left_heel"][at[1]] > 0.0
    assert found["left_heel"][at[2]] == 0.0


def test_a_standing_foot_taps_with_its_heel_on_the_floor_and_the_weight_on_the_other_leg() -> None:
    """After a step of the other foot, toes rise by 10 to 20 degrees at the usual amount and are down on the beat."""
    found = feet((1, STEP, 2, 0.0, 0.0), (0, TOES, 3, 0.0, 0.0)).sample(TIMES_S, steps=True)
    shown = np.rad2deg(with_danced({}, found, 0.5)["left_toes"])
    assert 10.0 < shown.max() < 20.0
    assert np.all(shown[(TIMES_S <= 1.09) | (TIMES_S >= 1.51)] == 0.0)
    up = shown > 0.5 * shown.max()
    assert not np.any(found.get("left_heel", np.zeros(len(TIMES_S)))[up])
    # The hips are over the right leg, and rise: a bent ankle bends no farther.
    assert found["over"][up].max() < 0.0
    assert found["risen"].max() == pytest.approx(1.0, abs=0.01)


def test_the_usual_amount_shows_most_of_a_dance() -> None:
    """Steps of half a dance are seen from the front, and those of little of it are small."""
    few, usual, every = (with_danced({}, {"left_up": np.ones(1)}, amount)["left_up"][0] for amount in (0.05, 0.5, 1.0))
    assert few < 0.5
    assert 0.8 <= usual < 0.9
    assert every == 1.0


def test_one_foot_is_in_the_air_at_a_time_and_the_weight_on_the_other() -> None:
    found = WALK.sample(TIMES_S, steps=True)
    left, right = found["left_up"] > 0.0, found["right_up"] > 0.0
    assert not np.any(left & right)
    assert np.all(found["over"][left] < 0.0)
    assert np.all(found["over"][right] > 0.0)


def test_the_same_times_are_the_same_bits_in_every_span() -> None:
    whole = WALK.sample(TIMES_S, steps=True)
    for first in range(0, len(TIMES_S), 97):
        here = slice(first, first + 97)
        part = WALK.sample(TIMES_S[here], steps=True)
        for name, values in whole.items():
            assert part.get(name, np.zeros(len(TIMES_S[here]))).tobytes() == (values[here] + 0.0).tobytes(), name


def test_feet_that_keep_their_place_only_lift_heels_and_toes() -> None:
    found = WALK.sample(TIMES_S, steps=False)
    assert {name for name in found if name not in IN_HIPS} == {"left_toes", "right_toes", "right_heel"}


def test_what_the_animator_has_feet_do_is_left_to_the_animator() -> None:
    assert WALK.giving_way([correction("tap", 1.6, 2.1, corrected=False)]) is WALK
    assert WALK.giving_way([correction("sway", 1.6, 2.1, corrected=True)]) is WALK
    left = WALK.giving_way([correction("tap", 1.6, 2.1, corrected=True)])
    assert left.lands_s.tolist() == [1.0, 3.0, 4.0]
    # The next move starts from the foot's current place.
    found = left.sample(TIMES_S, steps=True)
    assert np.all(np.abs(np.diff(found["left_aside"])) < 0.005)
    assert not np.any(found.get("right_up", 0.0))


@pytest.mark.parametrize("gone", range(4))
def test_what_changes_is_within_the_spans_that_are_named(gone: int) -> None:
    kept = np.arange(len(WALK)) != gone
    other = DancedFeet(*(values[kept] for values in vars(WALK).values()))
    spans_s = WALK.changed_s(other)
    inside = np.any((TIMES_S[:, None] >= spans_s[:, 0]) & (TIMES_S[:, None] <= spans_s[:, 1]), axis=1)
    one, two = WALK.sample(TIMES_S, steps=True), other.sample(TIMES_S, steps=True)
    nothing = np.zeros(len(TIMES_S))
    for name in one.keys() | two.keys():
        differs = one.get(name, nothing) != two.get(name, nothing)
        assert not np.any(differs & ~inside), name
    assert not len(WALK.changed_s(WALK))
