"""Breath marks and slurs of the score: breaths that they cause and prevent."""

from __future__ import annotations

import pytest

from app.plan.by_hand.corrections import Correction, RemoveEvent, SetBreath
from app.plan.generate import MonophonicPart
from app.plan.model import PlayerPlan
from app.plan.parameters import PlayerParameters
from app.score.marks import Mark, Source
from app.score.metre_map import Metre
from tests.support.plan import PlainClock, PlainNote, line_of, make_plans, piece_of, time_frame, valves

Q = 480
CLOCK = PlainClock(((0, 120.0),))
QUARTERS = line_of(*((beat * Q, Q, 65 + beat % 2) for beat in range(32)))


def plans(
    notes: tuple[PlainNote, ...],
    *marks: Mark,
    source: Source = "score",
    lung_s: float = 12.0,
    corrections: tuple[Correction, ...] = (),
    players: int = 1,
) -> list[PlayerPlan]:
    parameters = PlayerParameters(lung_s=lung_s)
    lines = tuple(
        MonophonicPart(f"p{number}", notes, valves(), parameters, corrections, marks=marks, source=source)
        for number in range(players)
    )
    found = make_plans(piece_of(CLOCK, (Metre(0, 4, 4),)), lines, time_frame(lines, CLOCK))
    return [found[line.player_id] for line in lines]


def ends(plan: PlayerPlan) -> list[float]:
    """Ends of the breaths after the first one, in quarters from the start."""
    return [event.end_tick / Q for event in plan.breaths if event.kind == "breath"][1:]


@pytest.mark.parametrize("kind", ["breath", "caesura"])
@pytest.mark.parametrize("source", ["score", "sound"])
def test_a_breath_mark_is_a_breath_where_no_one_would_breathe(kind: str, source: Source) -> None:
    assert ends(plans(QUARTERS)[0]) == [16.0]
    [plan] = plans(QUARTERS, Mark(kind, "1:14"), source=source)
    assert 14.0 in ends(plan)
    assert 16.0 not in ends(plan)
    [written] = [event for event in plan.breaths if event.end_tick == 14 * Q]
    assert written.reason.id == "breath.written"
    assert 0.2 <= written.end_s - written.start_s <= 0.4


def test_a_rest_after_a_breath_mark_gives_the_breath() -> None:
    """Half a second after two notes, which would not be used for a breath otherwise."""
    notes = line_of((0, Q, 65), (Q, Q, 67), (3 * Q, Q, 65), (4 * Q, Q, 67))
    assert not ends(plans(notes)[0])
    [plan] = plans(notes, Mark("breath", "1:2"))
    assert ends(plan) == [3.0]
    written = plan.breaths[-1]
    assert written.reason.arguments["why"] == "breath.why_written"
    assert written.start_tick >= 2 * Q


def test_all_of_a_section_breathe_at_a_breath_mark() -> None:
    assert all(14.0 in ends(plan) for plan in plans(QUARTERS, Mark("breath", "1:14"), players=3))


def test_the_animator_wins_over_a_breath_mark() -> None:
    marks = (Mark("breath", "1:14"),)
    [removed] = plans(QUARTERS, *marks, corrections=(RemoveEvent(event_id="breath:1:15", note_id="1:15"),))
    assert 14.0 not in ends(removed)
    [moved] = plans(QUARTERS, *marks, corrections=(SetBreath("1:15", -200, -20, 0.5),))
    [event] = [event for event in moved.breaths if event.id == "breath:1:15"]
    assert event.corrected
    assert event.start_tick == 14 * Q - 200


def test_a_slur_over_the_best_place_moves_the_breath_out_of_it() -> None:
    [plan] = plans(QUARTERS, Mark("slur", "1:15", "1:18"))
    assert ends(plan)
    assert not any(14.0 < place < 18.0 for place in ends(plan))


def test_dots_under_a_slur_are_no_place_to_breathe() -> None:
    dots = [Mark("staccato", f"1:{number}") for number in range(15, 19)]
    [plan] = plans(QUARTERS, Mark("slur", "1:15", "1:18"), *dots)
    assert not any(14.0 < place < 18.0 for place in ends(plan))


def test_a_slur_longer_than_the_air_is_broken_and_reported() -> None:
    [plan] = plans(QUARTERS, Mark("slur", "1:1", "1:32"))
    [place] = ends(plan)
    [event] = [event for event in plan.breaths if event.end_tick == place * Q]
    assert event.reason.id == "breath.catch_slurred"
    [problem] = [problem for problem in plan.problems if problem.message.id == "breath.breaks_slur"]
    assert problem.note_id == f"1:{int(place)}"


def test_a_rest_under_a_slur_is_breathed_in_rather_than_the_slur_is_broken() -> None:
    notes = line_of(*((beat * Q, Q - (Q // 2 if beat == 12 else 0), 65 + beat % 2) for beat in range(32)))
    [plan] = plans(notes, Mark("slur", "1:1", "1:32"))
    assert ends(plan) == [13.0]
    assert plan.breaths[-1].reason.id == "breath.catch_rest_slurred"
    assert not plan.problems


@pytest.mark.parametrize(
    ("length", "reasons"),
    [(384, {"breath.slur_broken"}), (3, {"breath.slur_begins_late", "breath.slur_ends_early"})],
)
def test_notes_of_slurs_that_are_left_out_for_a_breath_are_reported(length: int, reasons: set[str]) -> None:
    """All notes are slurred and so short that two are omitted for a breath."""
    notes = line_of(*((step * 80, 80, 65 + step % 2) for step in range(384)))
    slurs = [Mark("slur", f"1:{first}", f"1:{first + length - 1}") for first in range(1, 385, length)]
    [plan] = plans(notes, *slurs)
    [*said] = (event.reason for event in plan.breaths if event.reason.id == "breath.catch_dropped_two_slurred")
    assert said
    assert {message.arguments["why"] for message in said} <= reasons


@pytest.mark.parametrize(("length", "lasts_ms"), [(30, 21), (60, 52), (120, 115), (200, 198), (205, None), (480, None)])
def test_a_mark_after_a_note_too_short_for_a_breath_is_reported(length: int, lasts_ms: int | None) -> None:
    """A breath takes 200 ms; at least 10 ms of the previous note remain."""
    notes = line_of((0, Q, 65), (Q, length, 67), (Q + length, Q, 65), (2 * Q + length, Q, 67))
    [plan] = plans(notes, Mark("breath", "1:2"))
    [breath] = [event for event in plan.breaths if event.id == "breath:1:3"]
    said = [problem for problem in plan.problems if problem.message.id == "breath.mark_too_short"]
    lasting_ms = 1000.0 * (breath.end_s - breath.start_s)
    assert [problem.note_id for problem in said] == (["1:2"] if lasting_ms < 199.0 else [])
    assert bool(said) == (lasts_ms is not None)
    assert all(problem.message.arguments["lasts_ms"] == lasts_ms for problem in said)
