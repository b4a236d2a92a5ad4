"""Gestures placed by the bundled rules in long rests, by instrument, style and seed."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest

from app.performance.ensemble import Performance
from app.plan.gestures.lowered_instrument import LOWER_S, RAISE_S
from app.plan.model import GestureEvent, PlayerPlan
from app.project.edit.piece import set_seed
from app.project.edit.players import set_parameters
from metadata.library import bundled_gestures
from tests.support.live import performance_of
from tests.unit.performance.test_hands_away import QUARTER, _pitch

SEEDS = range(24)
REST_QUARTERS = 36
"""Length in quarters of a rest of eighteen seconds."""


def plans(instrument_id: str, rest: int = REST_QUARTERS, **parameters: object) -> list[PlayerPlan]:
    """Plans of a player with several seeds: 20 s of playing, a rest, and 4 s."""
    steps = [*range(40), *range(40 + rest, 48 + rest)]
    bare = performance_of(instrument_id, [(QUARTER * step, QUARTER - 40, _pitch(instrument_id)) for step in steps])
    project = set_parameters(bare.project, ("1.1.1",), **parameters) if parameters else bare.project
    return [Performance(set_seed(project, seed)).plans["1.1.1"] for seed in SEEDS]


def placed(plan: PlayerPlan) -> list[GestureEvent]:
    return [event for event in plan.gestures if event.kind == "named"]


@pytest.mark.parametrize(
    ("instrument_id", "water"),
    [
        ("trumpet_Bb", "press_water_key"),
        ("horn_double_F_Bb", "blow_water_out"),
        ("flute", "blow_keys_dry"),
        ("english_horn", "dry_reed"),
        ("ewi", None),
    ],
)
def test_water_is_let_out_as_the_instrument_asks(instrument_id: str, water: str | None) -> None:
    names = Counter(event.name for plan in plans(instrument_id) for event in placed(plan))
    letting = {name for name in names if bundled_gestures()[name].lets_out_water}
    assert letting == ({water} if water else set())
    assert 0.3 * len(SEEDS) < names["page_turn"] < 0.95 * len(SEEDS)


def test_everything_is_done_one_after_another_with_the_instrument_wholly_down() -> None:
    for plan in plans("trumpet_Bb"):
        (low,) = [one for one in plan.gestures if one.kind == "lower_instrument" and 15.0 < one.start_s < 30.0]
        done = sorted(placed(plan), key=lambda event: event.start_s)
        for event in done:
            assert low.start_s + LOWER_S <= event.start_s
            assert event.end_s <= low.end_s - RAISE_S
        for before, after in pairwise(done):
            assert before.end_s < after.start_s
        for event in done:
            if event.gesture is not None and event.gesture.needs_lowered:
                idle = ("look_about", "count", "settle_grip")
                at_once = [one for one in plan.gestures if one.kind in idle and one.start_s < event.end_s < one.end_s]
                assert not at_once, "a hand at the page, and eyes elsewhere"


def test_no_two_players_do_it_at_the_same_time() -> None:
    starts = [event.start_s for plan in plans("clarinet_Bb") for event in placed(plan) if event.name == "page_turn"]
    assert len({round(start_s, 2) for start_s in starts}) > 0.8 * len(starts)


def test_who_marches_has_no_page_to_turn_and_a_short_rest_no_time_for_it() -> None:
    marching = Counter(event.name for plan in plans("trumpet_Bb", style="marching_band") for event in placed(plan))
    assert marching["page_turn"] == 0
    assert marching["press_water_key"] > 0
    assert not any(placed(plan) for plan in plans("trumpet_Bb", 14))


def test_in_a_shorter_rest_players_listen_to_the_others() -> None:
    found = Counter(event.name for plan in plans("trumpet_Bb", 16) for event in placed(plan))
    assert set(found) == {"listen_left", "listen_right"}
    assert 0.2 * len(SEEDS) < found.total() < len(SEEDS)
