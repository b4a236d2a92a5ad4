"""Rules that make players react to the music, with every condition compared with its definition."""

from __future__ import annotations

import numpy as np
import pytest
from msgspec.structs import replace

from app.plan.by_hand.corrections import AddExpression, AddGesture, ChangeGesture, RemoveEvent
from app.plan.generate import MonophonicPart
from app.plan.gestures.named_gestures import fitted
from app.plan.model import PlayerPlan
from app.plan.music.dynamics import dynamics_of
from app.plan.music.piece import line_times
from app.plan.parameters import PlayerParameters
from app.plan.rule_conditions import facts_of, matches
from metadata.gestures import AngleKey, AngleTrack, Gesture
from metadata.library import _all_rules, bundled_gestures, bundled_rules
from metadata.rules import Do, Rule, RuleSet, When, rule_faults
from metadata.tables import Title
from tests.support.plan import PlainClock, line_of, make_plans, piece_of, time_frame, valves

Q = 480
CLOCK = PlainClock()
PIECE = piece_of(CLOCK)
# On valves() 65 is easy; the last phrase is after four bars of rest.
NOTES = line_of(
    (0, Q, 65, 60), (Q, Q, 67, 60), (2 * Q, 4 * Q, 79, 120), (6 * Q, Q, 60, 60),
    (24 * Q, Q, 62, 60), (25 * Q, Q, 76, 60), (26 * Q, 2 * Q, 64, 60),
)  # fmt: skip
LINE = MonophonicPart("p", NOTES, valves())
NOD = Gesture(
    "nodding",
    Title("Nodding"),
    1.0,
    (AngleTrack("head", "up", (AngleKey(0.0, 0.0), AngleKey(0.4, -8.0), AngleKey(1.0, 0.0))),),
)


def plan(*rules: Rule, line: MonophonicPart = LINE, gesture: Gesture = NOD) -> PlayerPlan:
    made = make_plans(
        PIECE, (line,), time_frame((line,), CLOCK), rules=rules, gestures={gesture.name: gesture, "shrug": gesture}
    )
    return made["p"]


def found(when: When) -> list[int]:
    times = line_times(LINE, CLOCK)
    return np.flatnonzero(matches(when, facts_of(times, PIECE, valves(), dynamics_of(times, None)))).tolist()


@pytest.mark.parametrize(
    ("when", "notes"),
    [
        (When(longer_s=1.5), [2]),
        (When(shorter_s=0.5), [0, 1, 3, 4, 5]),
        (When(loudness_above=0.8), [2]),
        (When(loudness_below=0.8), [0, 1, 3, 4, 5, 6]),
        (When(rest_longer_s=4.0), [0, 4]),
        (When(rest_after_longer_s=4.0), [3, 6]),
        (When(leap_up=12), [2, 5]),
        (When(leap_down=12), [3, 6]),
        (When(place=("first",)), [0]),
        (When(place=("last",)), [6]),
        (When(place=("after_rest",)), [4]),
        (When(place=("phrase_end",)), [3, 6]),
        (When(place=("climax",)), [2, 5]),
        (When(place=("climax",), loudness_above=0.8), [2]),
        (When(accent=0.2), [2]),
        (When(styles=("jazz",)), [0, 1, 2, 3, 4, 5, 6]),
    ],
)
def test_every_condition_holds_of_the_notes_it_says(when: When, notes: list[int]) -> None:
    assert found(when) == notes


def test_height_is_against_the_easy_range_of_the_instrument() -> None:
    easy = valves().range
    above = [index for index, note in enumerate(NOTES) if note.pitch >= easy.easy_high + 1]
    below = [index for index, note in enumerate(NOTES) if note.pitch <= easy.easy_low - 1]
    assert found(When(semitones_above_easy=1)) == above
    assert found(When(semitones_below_easy=1)) == below


def test_a_rule_shows_an_expression_over_its_notes_and_says_why() -> None:
    rule = Rule("leaps", When(leap_up=12), Do(expression="smile", strength=0.6, start_s=-0.2, end_s=0.1))
    events = [event for event in plan(rule).expressions if event.id.startswith("expression:rule:")]
    assert [event.id for event in events] == ["expression:rule:leaps:1:3", "expression:rule:leaps:1:6"]
    first = events[0]
    assert (first.start_s, first.end_s) == pytest.approx((1.0 - 0.2, 3.0 + 0.1))
    assert (first.expression, first.strength) == ("smile", 0.6)
    assert (first.reason.id, first.reason.arguments) == ("rule.applied", {"rule": "leaps"})


def test_notes_close_together_share_an_expression_and_the_strength_grows() -> None:
    rule = Rule("loud", When(loudness_above=0.0), Do(expression="strained", grows_with="loudness"), apart_s=0.5)
    events = [event for event in plan(rule).expressions if ":rule:" in event.id]
    assert [event.id for event in events] == ["expression:rule:loud:1:1", "expression:rule:loud:1:5"]
    assert events[0].strength > events[1].strength


def test_a_rule_is_for_its_styles_and_habits_only() -> None:
    rule = Rule("some", When(place=("first",), styles=("jazz",), habits=("tapper",)), Do(gesture="nodding"))
    for parameters, count in (
        (PlayerParameters(), 0),
        (PlayerParameters(style="jazz"), 0),
        (PlayerParameters(habits="tapper"), 0),
        (PlayerParameters(style="jazz", habits="nodder,tapper"), 1),
    ):
        made = plan(rule, line=replace(LINE, parameters=parameters))
        assert sum(event.kind == "named" for event in made.gestures) == count


def test_chance_is_of_player_and_place_and_another_seed_throws_again() -> None:
    rule = Rule("half", When(longer_s=0.0, chance=0.5), Do(gesture="nodding"), apart_s=0.0)
    quick = replace(NOD, length_s=0.3)

    def ids(seed: int) -> list[str]:
        line = replace(LINE, parameters=PlayerParameters(seed=seed))
        return [event.id for event in plan(rule, line=line, gesture=quick).gestures if event.kind == "named"]

    assert ids(1) == ids(1)
    assert len({tuple(ids(seed)) for seed in range(6)}) > 3


@pytest.mark.parametrize(
    ("may_start", "while_playing", "after_playing", "in_the_long_rest"),
    [("anytime", 2, 2, 2), ("resting", 0, 2, 2), ("lowered", 0, 0, 1)],
)
def test_a_gesture_starts_only_where_it_may(
    may_start: str, while_playing: int, after_playing: int, in_the_long_rest: int
) -> None:
    gesture = replace(NOD, may_start=may_start)

    def count(when: When, **do: object) -> int:
        made = plan(Rule("here", when, Do(gesture="nodding", **do)), gesture=gesture)
        assert not made.problems
        return sum(event.kind == "named" for event in made.gestures)

    ends = When(place=("phrase_end",))
    assert count(ends, start="end", start_s=-0.2) == while_playing
    assert count(ends, start="end", start_s=0.2) == after_playing
    assert count(When(rest_longer_s=6.0), start_s=-4.5) == in_the_long_rest


def test_gestures_are_corrected_like_all_others() -> None:
    rule = Rule("leaps", When(leap_up=12), Do(gesture="nodding"))
    first, second = (event for event in plan(rule).gestures if event.kind == "named")
    assert first.gesture is not None
    moved = ChangeGesture(first.id, start_tick=4 * Q, end_tick=8 * Q, amount=0.25)
    added = AddGesture("mine", "named", 30 * Q, 33 * Q, 1.0, "shrug")
    line = replace(LINE, corrections=(moved, RemoveEvent(second.id), added))
    made = [event for event in plan(rule, line=line).gestures if event.kind == "named"]
    assert [(event.id, event.start_tick, event.amount, event.corrected) for event in made] == [
        (first.id, 4 * Q, 0.25, True),
        ("named:mine", 30 * Q, 1.0, True),
    ]
    assert all(event.gesture is not None for event in made)
    assert not plan(rule, line=line).problems


def test_what_is_placed_by_hand_wins_over_the_rules_there_and_only_there() -> None:
    rules = (
        Rule("leaps", When(leap_up=12), Do(gesture="nodding")),
        Rule("faces", When(leap_up=12), Do(expression="smile")),
    )
    free = plan(*rules)
    first = next(event for event in free.gestures if event.kind == "named")
    by_hand = (
        AddGesture("mine", "named", first.start_tick - 10, first.start_tick + 10, 1.0, "shrug"),
        AddExpression("yours", "strained", first.start_tick, first.end_tick),
        AddGesture("sways", "sway", 24 * Q, 28 * Q, 1.0),
    )
    held = plan(*rules, line=replace(LINE, corrections=by_hand))
    assert {event.id for event in free.gestures} - {event.id for event in held.gestures} == {first.id}
    assert {event.id for event in free.expressions} - {event.id for event in held.expressions} == {
        "expression:rule:faces:1:3"
    }
    assert not held.problems, "no correction is about what gave way"


def test_what_does_not_exist_is_reported() -> None:
    rules = (
        Rule("face", When(place=("first",)), Do(expression="gone")),
        Rule("body", When(place=("first",)), Do(gesture="gone")),
    )
    line = replace(LINE, corrections=(AddGesture("mine", "named", 0, Q, 1.0, "gone"),))
    made = plan(*rules, line=line)
    assert [problem.message.id for problem in made.problems] == [
        "rule.unknown_expression",
        "rule.unknown_gesture",
        "gesture.unknown",
    ]
    assert all(event.kind != "named" for event in made.gestures)


def test_one_placed_by_hand_where_it_may_not_start_is_done_and_reported() -> None:
    line = replace(LINE, corrections=(AddGesture("mine", "named", 0, 2 * Q, 1.0, "nodding"),))
    made = plan(line=line, gesture=replace(NOD, may_start="resting"))
    assert [problem.message.id for problem in made.problems] == ["gesture.not_here"]
    assert [event.id for event in made.gestures if event.gesture is not None] == ["named:mine"]


def test_a_gesture_is_no_larger_than_hands_follow_and_no_quicker_than_a_body() -> None:
    limits = {"head": {"up_deg": (-6.0, 12.0)}}
    slow, quick = fitted(NOD, 4.0, limits), fitted(NOD, 0.3, limits)
    largest = NOD.amplitude[2] * max(abs(key.deg) for key in slow.tracks[0].keys)
    assert largest == pytest.approx(6.0)
    assert abs(quick.tracks[0].keys[1].deg) < abs(slow.tracks[0].keys[1].deg)
    assert fitted(NOD, 4.0, {"head": {"up_deg": (-45.0, 45.0)}}) == NOD


def test_bundled_rules_leave_a_usual_player_alone() -> None:
    usual = make_plans(PIECE, (LINE,), time_frame((LINE,), CLOCK))["p"]
    placed = [event.id for event in (*usual.expressions, *usual.gestures) if ":rule:" in event.id]  # type: ignore[attr-defined]
    # In its rest of six seconds a player listens to the others.
    assert not [event_id for event_id in placed if ":rule:listens_" not in event_id]
    jazz = replace(LINE, parameters=PlayerParameters(style="soloist"))
    ruled = make_plans(PIECE, (jazz,), time_frame((jazz,), CLOCK))["p"]
    made = [event for event in ruled.gestures if event.kind == "named"]
    assert made
    assert {event.name for event in made} <= set(bundled_gestures())


def shown(*rules: Rule, line: MonophonicPart = LINE) -> list[tuple[str, float]]:
    """Ids and strengths of the visible expressions except the neutral face."""
    return [(event.id, event.strength) for event in plan(*rules, line=line).expressions[1:]]


def test_effort_shows_from_its_bound_on_and_stays_until_the_next() -> None:
    face = Do(expression="strained", grows_with="effort", grows_from=0.0, stays_s=0.5)
    rule = Rule("work", When(effort_above=0.3), face)
    made = plan(rule)
    efforts = [event.effort for event in made.embouchures]
    events = made.expressions[1:]
    assert events
    hard = [index for index, effort in enumerate(efforts) if effort > 0.3]
    assert events[0].strength == pytest.approx((efforts[hard[0]] - 0.3) / 0.7, abs=1e-4)
    ends = [made.fingerings[index].end_s for index in hard]
    assert min(abs(events[0].end_s - 0.5 - end) for end in ends) < 0.06
    assert not shown(replace(rule, enabled=False))


def test_of_two_growths_the_strength_is_the_mean_and_nothing_where_one_is_just_met() -> None:
    do = Do(expression="puffed", grows_with=("depth", "loudness"), grows_from=0.0)
    when = When(semitones_below_easy=-30, loudness_above=0.5)
    both = dict(shown(Rule("both", when, do)))
    deep = dict(shown(Rule("both", when, replace(do, grows_with="depth"))))
    assert both
    assert deep
    assert max(both.values()) <= 1.0
    assert not shown(Rule("both", when, replace(do, scaled_by="puff")), line=_unpuffed())


def _unpuffed() -> MonophonicPart:
    instrument = LINE.instrument_map
    return replace(LINE, instrument_map=replace(instrument, embouchure=replace(instrument.embouchure, puff=0.0)))


def test_moments_are_those_of_cues_breaths_and_the_end() -> None:
    def of(moment: str, **more: float) -> list[tuple[str, float]]:
        return shown(Rule("here", When(moment=moment, **more), Do(expression="brows_up", strength=0.5)))

    assert [id for id, _ in of("gives_entry")] == [f"expression:rule:here:{cue.id}" for cue in plan().cues]
    assert of("takes_entry", rest_longer_s=60.0) == []
    assert [id for id, _ in of("ending")] in ([], ["expression:rule:here"])


def test_the_users_rule_takes_the_place_of_ours_whatever_its_file_is_called() -> None:
    ours = RuleSet("faces", "", (Rule("strained", When(effort_above=0.5), Do(expression="strained")),))
    own = RuleSet("aaa", "", (replace(ours.rules[0], enabled=False),))
    assert _all_rules({"faces": ours, "aaa": own}, {"aaa"}) == own.rules
    assert _all_rules({"faces": ours, "aaa": own}) == ours.rules
    names = [rule.name for rule in bundled_rules()]
    assert {"strained", "puffed", "gives_entry", "takes_entry", "smile"} <= set(names)


@pytest.mark.parametrize(
    ("when", "do", "key"),
    [
        (When(moment="ending"), Do(gesture="shrug"), "when.moment"),
        (When(moment="ending"), Do(expression="smile", grows_with="length"), "do.grows_with"),
        (When(loudness_above=0.5), Do(expression="smile", grows_with=("loudness", "effort")), "do.grows_with"),
        (When(loudness_above=0.5), Do(gesture="shrug", stays_s=1.0), "do.stays_s"),
        (When(), Do(expression="smile"), "when"),
    ],
)
def test_what_a_rule_cannot_say_is_named(when: When, do: Do, key: str) -> None:
    assert key in [fault.key for fault in rule_faults(Rule("r", when, do))]
