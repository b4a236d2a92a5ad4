"""Raising the instrument from rest, gestures in long rests and after the last note; followers answer the
leader's cue.
"""

from __future__ import annotations

import itertools

import pytest

from app.plan.by_hand.corrections import AddGesture, ChangeGesture, Correction, RemoveEvent, SetCue
from app.plan.faces.glances import StagePlace, bearing_rad
from app.plan.generate import AFTER_LAST_S, COME_UP_S, usual_preroll
from app.plan.gestures.idle_gestures import LONG_REST_S
from app.plan.gestures.lowered_instrument import LOWER_S, RAISE_S
from app.plan.model import AUDIENCE, GestureEvent, PlayerPlan
from app.plan.music.piece import MonophonicPart
from app.score.metre_map import Metre
from tests.support.plan import PlainClock, line_of, make_plans, piece_of, slide, time_frame, valves

Q = 480
CLOCK = PlainClock()
PIECE = piece_of(CLOCK, (Metre(0, 4, 4),))
PLACES = {"high": StagePlace(-1.0, 0.0, 0.3), "low": StagePlace(0.0, -0.4, 0.0), "late": StagePlace(1.0, 0.0, -0.3)}


def lines(corrections: tuple[Correction, ...] = ()) -> tuple[MonophonicPart, ...]:
    """Lines of which two begin, all rest for 30 s, and all enter again."""
    return (
        MonophonicPart("high", line_of((0, 4 * Q, 72), (64 * Q, Q, 70), track=1), valves(), corrections=corrections),
        MonophonicPart("low", line_of((0, 4 * Q, 60), (64 * Q, Q, 75), track=2), valves()),
        MonophonicPart("late", line_of((2 * Q, 2 * Q, 50), (64 * Q, Q, 50), track=3), slide()),
    )


def plans(corrections: tuple[Correction, ...] = (), seed: int = 0) -> dict[str, PlayerPlan]:
    played = lines(corrections)
    frame = time_frame(played, CLOCK, usual_preroll(0.5))
    return make_plans(PIECE, played, frame, seed, places=PLACES)


def of_kind(plan: PlayerPlan, kind: str) -> list[GestureEvent]:
    return [event for event in plan.gestures if event.kind == kind]


@pytest.mark.parametrize(("beat_s", "beats"), [(0.5, 6.0), (1.0, 4.0), (2.0, 4.0), (0.3, 10.0), (0.01, 32.0)])
def test_the_pre_roll_of_a_new_piece_is_long_enough_to_come_up(beat_s: float, beats: float) -> None:
    assert usual_preroll(beat_s) == beats


def test_players_come_up_from_rest_before_cue_and_breath() -> None:
    made = plans()
    raised_s = []
    for name in ("high", "low"):
        plan = made[name]
        low = of_kind(plan, "lower_instrument")[0]
        assert low.start_s + LOWER_S <= plan.time_frame.first_frame_s + 1e-9
        assert low.end_s - RAISE_S > plan.time_frame.first_frame_s
        assert low.end_s <= min(breath.start_s for breath in plan.breaths if breath.kind == "breath")
        assert low.end_s <= made["high"].cues[0].start_s
        raised_s.append(low.end_s)
    assert raised_s[0] != raised_s[1]


def test_followers_nod_less_and_a_little_later_each_in_a_way_of_their_own() -> None:
    made = plans()
    cue = made["high"].cues[1]
    assert cue.takers == ("low", "late")
    nods = [of_kind(made[name], "nod")[-1] for name in cue.takers]
    for nod in nods:
        assert 0.02 <= nod.end_s - cue.downbeat_s <= 0.06
        assert nod.end_s - nod.start_s == pytest.approx(cue.downbeat_s - cue.start_s)
        assert 0.25 * cue.amount < nod.amount < 0.6 * cue.amount
    assert nods[0].end_s != nods[1].end_s
    assert nods[0].amount != nods[1].amount
    assert not of_kind(made["high"], "nod")
    # The same again.
    assert [of_kind(plans()[name], "nod")[-1] for name in cue.takers] == nods


def test_a_cue_by_hand_is_answered_by_those_who_come_in() -> None:
    made = plans((SetCue("1:2", 2.0),))
    assert made["high"].cues[1].takers == ("low", "late")
    assert len(of_kind(made["late"], "nod")) == 1


def test_followers_look_at_the_giver_and_the_giver_at_them() -> None:
    made = plans()
    cue = made["high"].cues[1]
    for name, side in (("low", -1.0), ("late", -1.0)):
        (glance,) = [one for one in made[name].glances if one.at == "high" and one.end_s > 20.0]
        assert glance.start_s < cue.start_s
        assert cue.downbeat_s <= glance.end_s < cue.downbeat_s + 0.5
        assert glance.yaw_rad * side > 0.3
    seen = [one for one in made["high"].glances if one.at in ("low", "late") and one.end_s > 20.0]
    assert seen
    assert all(one.start_s < cue.peak_s and one.yaw_rad > 0.3 for one in seen)
    for plan in made.values():
        for one, following in itertools.pairwise(plan.glances):
            assert one.start_s < one.end_s <= following.start_s


def test_bearings_are_from_the_direction_a_player_faces() -> None:
    own = StagePlace(0.0, 0.0, 0.0)
    assert bearing_rad(own, StagePlace(0.0, 2.0, 0.0)) == 0.0
    assert bearing_rad(own, StagePlace(1.0, 1.0, 0.0)) == pytest.approx(0.7854, abs=1e-3)
    assert bearing_rad(StagePlace(0.0, 0.0, 0.5), StagePlace(1.0, 1.0, 0.0)) == pytest.approx(0.2854, abs=1e-3)
    assert bearing_rad(own, own) == 0.0


def test_in_a_long_rest_they_look_about_and_count_while_the_instrument_is_down() -> None:
    assert LONG_REST_S <= 30.0
    places = []
    for seed in range(3):
        for plan in plans(seed=seed).values():
            low = next(event for event in of_kind(plan, "lower_instrument") if 0.0 < event.start_s < 20.0)
            beside = [event for event in plan.gestures if event.kind in ("count", "look_about", "settle_grip")]
            beside = [event for event in beside if event.start_s > 0.0]
            assert any(event.kind == "look_about" for event in beside)
            for event in beside:
                assert low.start_s + LOWER_S <= event.start_s < event.end_s <= low.end_s - RAISE_S
            places.append(tuple(event.start_s for event in beside if event.kind == "look_about"))
            for event in beside:
                if event.kind == "count":
                    assert event.start_tick % Q == 0
                    assert event.end_tick % Q == 0
    assert len(set(places)) == len(places)


def test_a_short_rest_leaves_no_time_for_it() -> None:
    line = MonophonicPart("p", line_of((0, Q, 65), (15 * Q, Q, 65)), valves())
    plan = make_plans(PIECE, (line,), time_frame((line,), CLOCK))["p"]
    assert of_kind(plan, "lower_instrument")[0].end_s < 7.5
    assert not [event for event in plan.gestures if event.kind in ("count", "look_about", "settle_grip")]


def test_after_the_last_note_they_hold_lower_look_up_and_bow_but_not_at_once() -> None:
    made = plans()
    last_s = CLOCK.seconds(65 * Q)
    bows = []
    for plan in made.values():
        low = of_kind(plan, "lower_instrument")[-1]
        (up,), (bow,) = of_kind(plan, "look_up"), of_kind(plan, "bow")
        assert last_s + 0.8 < low.start_s < up.start_s < bow.start_s < bow.end_s < plan.time_frame.end_s
        assert low.start_s + LOWER_S < bow.start_s + 0.2
        (still,) = of_kind(plan, "hold_still")
        assert last_s - 0.3 < still.start_s < last_s < low.start_s < still.end_s
        assert plan.time_frame.end_s == pytest.approx(last_s + AFTER_LAST_S)
        (seen,) = [one for one in plan.glances if one.at == AUDIENCE]
        assert seen.yaw_rad == pytest.approx(-PLACES[plan.player_id].turn_rad)
        bows.append(bow.start_s)
    assert max(bows) - min(bows) < 0.3
    assert len(set(bows)) == len(bows)


def test_what_is_done_beside_playing_can_be_placed_moved_and_removed() -> None:
    made = plans(
        (
            RemoveEvent("bow:end"),
            ChangeGesture("look_up:end", amount=0.25),
            AddGesture("own-1", "bow", 20 * Q, 24 * Q, 0.5),
        )
    )["high"]
    assert [event.id for event in of_kind(made, "bow")] == ["bow:own-1"]
    assert of_kind(made, "look_up")[0].amount == 0.25
    assert not [problem for problem in made.problems if problem.message.id == "correction.orphaned"]


def test_a_pre_roll_of_two_seconds_stays_as_it_was() -> None:
    assert COME_UP_S > 2.0
    played = lines()
    made = make_plans(PIECE, played, time_frame(played, CLOCK))
    assert not [event for event in of_kind(made["high"], "lower_instrument") if event.start_s < 0.0]
