"""Corrections survive regenerating, have priority over rules, and are reported if their place is gone."""

from __future__ import annotations

import msgspec
import pytest

from app.plan.by_hand.corrections import (
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    Correction,
    PinFingering,
    RemoveEvent,
    SetBreath,
    SetCue,
    SetEmbouchure,
)
from app.plan.generate import MonophonicPart
from app.plan.model import PlayerPlan
from app.score.metre_map import Metre
from tests.support.plan import PlainClock, PlainNote, line_of, make_plans, piece_of, time_frame, valves

Q = 480
CLOCK = PlainClock()
PIECE = piece_of(CLOCK, (Metre(0, 4, 4),))
NOTES = line_of((0, Q, 65), (Q, 2 * Q, 77), (5 * Q, Q, 67), (6 * Q, Q, 69), (24 * Q, 4 * Q, 82))


def plan(*corrections: Correction, notes: tuple[PlainNote, ...] = NOTES) -> PlayerPlan:
    line = MonophonicPart("p", notes, valves(), corrections=corrections)
    return make_plans(PIECE, (line,), time_frame((line,), CLOCK))["p"]


def events(plan_: PlayerPlan) -> dict[str, object]:
    return {
        event.id: event
        for name in ("fingerings", "breaths", "tongues", "embouchures", "cues", "gestures", "expressions")
        for event in getattr(plan_, name)
    }


EVERY: tuple[Correction, ...] = (
    PinFingering("1:3", "3"),
    RemoveEvent("breath:1:3", "1:3"),
    SetBreath("1:4", -Q // 4, depth=0.4),
    SetBreath("1:5", -4 * Q, -2 * Q, kind="preparation"),
    SetCue("1:5", 2.0),
    SetEmbouchure("1:2", tension=0.9),
    ChangeGesture("bell_height:1:1", amount=-0.5),
    AddGesture("look", "sway", 2 * Q, 4 * Q, 0.7),
    ChangeExpression("expression:neutral", strength=0.25),
    AddExpression("grin", "smile", 8 * Q, 12 * Q),
)


def test_corrections_are_json() -> None:
    data = msgspec.json.encode(EVERY)
    assert msgspec.json.decode(data, type=tuple[Correction, ...]) == EVERY


def test_every_correction_wins_and_is_marked() -> None:
    made = events(plan(*EVERY))
    assert made["fingering:1:3"].label == "3"  # type: ignore[attr-defined]
    assert "breath:1:3" not in made
    assert made["breath:1:4"].start_tick == 6 * Q - Q // 4  # type: ignore[attr-defined]
    assert made["breath:1:4"].depth == 0.4  # type: ignore[attr-defined]
    assert made["preparation:1:5"].start_tick == 20 * Q  # type: ignore[attr-defined]
    assert made["cue:1:5"].beat_s == pytest.approx(1.0)  # type: ignore[attr-defined]
    assert made["embouchure:1:2"].tension == 0.9  # type: ignore[attr-defined]
    assert made["bell_height:1:1"].amount == -0.5  # type: ignore[attr-defined]
    assert made["sway:look"].start_s == pytest.approx(1.0)  # type: ignore[attr-defined]
    assert made["expression:neutral"].strength == 0.25  # type: ignore[attr-defined]
    assert made["expression:grin"].expression == "smile"  # type: ignore[attr-defined]
    corrected = {name for name, event in made.items() if getattr(event, "corrected", False)}
    assert corrected == {
        "fingering:1:3", "breath:1:4", "preparation:1:5", "cue:1:5", "embouchure:1:2", "bell_height:1:1",
        "sway:look", "expression:neutral", "expression:grin",
    }  # fmt: skip


def test_nothing_else_changes() -> None:
    free, corrected = events(plan()), events(plan(ChangeGesture("bell_height:1:1", amount=-0.5)))
    assert set(free) == set(corrected)
    assert [name for name in free if free[name] != corrected[name]] == ["bell_height:1:1"]


def test_corrections_stay_when_other_notes_change() -> None:
    earlier = (PlainNote("9:1", -2 * Q, Q, 60), *NOTES)
    made = events(plan(*EVERY[:6], notes=earlier))
    assert made["fingering:1:3"].label == "3"  # type: ignore[attr-defined]
    assert "breath:1:3" not in made
    assert made["breath:1:4"].corrected  # type: ignore[attr-defined]
    assert not [problem for problem in plan(*EVERY[:6], notes=earlier).problems if "orphaned" in problem.message.id]


def test_a_breath_moves_with_its_note() -> None:
    later = (*NOTES[:3], PlainNote("1:4", 7 * Q, Q, 69), NOTES[4])
    assert events(plan(EVERY[2], notes=later))["breath:1:4"].end_tick == 7 * Q  # type: ignore[attr-defined]


def test_a_correction_without_its_place_becomes_a_problem() -> None:
    without = tuple(note for note in NOTES if note.id not in ("1:3", "1:4"))
    problems = plan(
        PinFingering("1:3", "3"),
        RemoveEvent("breath:1:3", "1:3"),
        RemoveEvent("expression:strained:1:3"),
        SetBreath("1:4", -Q),
        SetEmbouchure("1:4", air=1.0),
        ChangeGesture("bell_height:1:3", amount=0.0),
        PinFingering("1:1", "0"),
        notes=without,
    ).problems
    orphaned = [problem.message.arguments for problem in problems if problem.message.id == "correction.orphaned"]
    assert orphaned == [
        {"kind": "pin_fingering", "anchor": "1:3"},
        {"kind": "remove", "anchor": "breath:1:3"},
        {"kind": "remove", "anchor": "expression:strained:1:3"},
        {"kind": "set_breath", "anchor": "1:4"},
        {"kind": "set_embouchure", "anchor": "1:4"},
        {"kind": "change_gesture", "anchor": "bell_height:1:3"},
    ]


def test_a_breath_by_hand_inside_a_note_is_kept_and_flagged() -> None:
    plan_ = plan(SetBreath("1:2", -Q // 4))
    assert events(plan_)["breath:1:2"].corrected  # type: ignore[attr-defined]
    assert [problem.message.id for problem in plan_.problems] == ["breath.inside_note"]
    assert plan_.embouchures[0].end_s == pytest.approx(0.375)


def test_removing_a_rests_breath_can_call_for_a_catch_breath() -> None:
    notes = line_of(*((index * Q, Q, 65) for index in range(12)), *((index * Q, Q, 67) for index in range(13, 26)))
    assert not [e for e in plan(notes=notes).breaths if e.reason.id == "breath.catch"]
    caught = [e for e in plan(RemoveEvent("breath:1:13", "1:13"), notes=notes).breaths if e.reason.id == "breath.catch"]
    assert caught
    assert all(event.id != "breath:1:13" for event in caught)


def test_a_place_whose_breath_is_set_by_hand_gets_no_catch_breath_as_well() -> None:
    notes = line_of(*((index * Q, Q, 65) for index in range(60)))
    caught = next(event for event in plan(notes=notes).breaths if event.reason.id == "breath.catch")
    note = caught.id.split(":", 1)[1]
    # A breath without depth fills no lungs, so that the rules still look for a place.
    made = plan(SetBreath(note, -Q // 4, depth=0.0), notes=notes).breaths
    assert [event.depth for event in made if event.id == caught.id] == [0.0]


@pytest.mark.parametrize(
    ("correction", "rule"),
    [
        (SetBreath("1:4", 0, -Q), "correction.empty_span"),
        (SetCue("1:5", 0.0), "correction.empty_span"),
        (AddGesture("look", "sway", 4 * Q, 2 * Q, 0.7), "correction.empty_span"),
        (ChangeExpression("expression:neutral", start_tick=5, end_tick=5), "correction.empty_span"),
        (AddExpression("grin", "grimace", 0, Q), "correction.unknown_expression"),
        (ChangeExpression("expression:neutral", expression="grimace"), "correction.unknown_expression"),
        (RemoveEvent("fingering:1:1", "1:1"), "correction.orphaned"),
    ],
)
def test_a_correction_that_cannot_be_done_is_a_problem_and_changes_nothing(correction: Correction, rule: str) -> None:
    corrected, free = plan(correction), plan()
    assert [problem.message.id for problem in corrected.problems] == [rule]
    assert events(corrected) == events(free)


def test_one_moved_end_wins_over_the_generated_other() -> None:
    made = events(plan(ChangeGesture("bell_height:1:1", start_tick=100 * Q)))["bell_height:1:1"]
    assert (made.start_tick, made.end_tick) == (100 * Q, 100 * Q + 1)  # type: ignore[attr-defined]
    assert made.start_s < made.end_s  # type: ignore[attr-defined]
