"""Lips, tongue and face, the time frame, and bars."""

from __future__ import annotations

import msgspec
import pytest

from app.chance import chance
from app.plan.by_hand.corrections import ChangeExpression, RemoveEvent
from app.plan.generate import AFTER_LAST_S, MonophonicPart
from app.plan.lips.tonguing import TONGUE_S
from app.plan.model import ExpressionEvent, PlayerPlan
from app.plan.music.piece import MEZZOFORTE, line_times
from app.plan.parameters import PlayerParameters
from app.score.metre_map import Metre
from instrument_maps.load import bundled_maps
from tests.support.plan import PlainClock, PlainNote, even, line_of, make_plans, piece_of, slide, time_frame, valves

Q = 480
CLOCK = PlainClock()
PIECE = piece_of(CLOCK, (Metre(0, 4, 4),))


def plan(line: MonophonicPart) -> PlayerPlan:
    return make_plans(PIECE, (line,), time_frame((line,), CLOCK))[line.player_id]


def test_lips_tighten_with_height() -> None:
    lips = plan(MonophonicPart("p", even(list(range(52, 83)), Q), valves())).embouchures
    tensions = [event.tension for event in lips]
    assert tensions == sorted(tensions)
    assert tensions[0] < 0.02
    assert tensions[-1] > 0.98
    assert 0.25 < tensions[6] < tensions[22] < 0.65
    loose = plan(MonophonicPart("p", even([75], Q), valves(), PlayerParameters(embouchure_tension=0.5))).embouchures[0]
    assert loose.tension == pytest.approx(0.5 * tensions[75 - 52], abs=1e-3)


def test_effort_is_height_loudness_and_length() -> None:
    def effort(pitch: int, velocity: int, length: int) -> float:
        # A second, soft note elsewhere: one velocity throughout would say nothing about dynamics.
        notes = (*line_of((0, length, pitch, velocity)), PlainNote("1:2", 40 * Q, Q, 60, 1))
        return plan(MonophonicPart("p", notes, valves())).embouchures[0].effort

    easy = effort(65, 60, Q)
    assert easy < 0.1
    assert effort(82, 60, Q) > 0.6
    assert effort(65, 127, Q) > 0.4
    assert effort(65, 60, 12 * Q) > 0.3
    assert effort(82, 127, 12 * Q) > max(effort(82, 60, Q), effort(65, 127, Q))


def test_one_velocity_throughout_is_mezzoforte_and_curves_win() -> None:
    constant = line_times(MonophonicPart("p", line_of((0, Q, 65, 127), (Q, Q, 65, 127)), valves()), CLOCK)
    assert constant.loudness.tolist() == [MEZZOFORTE, MEZZOFORTE]
    curved = MonophonicPart("p", line_of((0, Q, 65, 127), (Q, Q, 65, 127)), valves(), loudness=(0.2, 0.9))
    assert line_times(curved, CLOCK).loudness.tolist() == [0.2, 0.9]


def test_every_attack_is_tongued_and_a_slur_is_not() -> None:
    touching = plan(MonophonicPart("p", even([65, 67, 69], Q), valves())).tongues
    assert [event.note_id for event in touching] == ["1:1", "1:2", "1:3"]
    assert [event.end_s for event in touching] == [0.0, 0.5, 1.0]
    assert all(event.end_s - event.start_s == pytest.approx(TONGUE_S) for event in touching)
    slurred = line_of((0, Q + 20, 65), (Q, Q + 20, 67), (2 * Q, Q, 67))
    assert [event.note_id for event in plan(MonophonicPart("p", slurred, valves())).tongues] == ["1:1", "1:3"]


def test_a_slide_that_moves_far_is_tongued_even_in_a_slur() -> None:
    # 58 is 1, 60 is 3 (or thereabouts), 53 is 1 too.
    smear = line_of((0, Q + 20, 58), (Q, Q, 56))
    lip = line_of((0, Q + 20, 58), (Q, Q, 53))
    assert len(plan(MonophonicPart("p", smear, slide())).tongues) == 2
    assert len(plan(MonophonicPart("p", lip, slide())).tongues) == 1


def test_faces_follow_effort_entries_and_the_end() -> None:
    notes = (
        *even([65] * 8, Q),
        *(PlainNote(f"1:{9 + index}", (8 + index) * Q, Q, 82) for index in range(8)),
        PlainNote("1:17", 40 * Q, 2 * Q, 65),
    )
    follower = MonophonicPart("p", notes, valves(), PlayerParameters(cue_leader=False))
    faces = {event.id: event for event in plan(follower).expressions}
    assert faces["expression:neutral"].start_s == -2.0
    strained = faces["expression:strained:1:9"]
    assert (strained.expression, strained.start_s, strained.end_s) == ("strained", 4.0, 8.77)
    entry = faces["expression:brows_up:1:17"]
    assert entry.end_s == 20.0
    assert entry.reason.id == "expression.takes_entry"
    leader = {event.id: event for event in plan(MonophonicPart("p", notes, valves())).expressions}
    assert leader["expression:brows_up:cue:1:1"].reason.id == "expression.gives_entry"
    assert leader["expression:brows_up:cue:1:1"].end_s == 0.0


@pytest.mark.parametrize(
    ("third", "bpm", "velocity", "smiles"),
    [(4, 132.0, 90, True), (3, 132.0, 90, False), (4, 60.0, 90, False), (4, 132.0, 40, False)],
    ids=["lively and major", "minor", "slow", "soft"],
)
def test_only_a_bright_ending_is_smiled_at(third: int, bpm: float, velocity: int, smiles: bool) -> None:
    tune = [60 + step for step in (0, third, 7, third, 2, third, 2, 0)] * 8
    # Loud enough before the end: the velocities say something.
    notes = line_of(
        *((index * Q, Q, pitch, 100 if index < 16 else velocity) for index, pitch in enumerate(tune)),
    )
    clock = PlainClock(((0, bpm),))
    line = MonophonicPart("p", notes, valves())

    def smile(line: MonophonicPart) -> list[ExpressionEvent]:
        plan = make_plans(piece_of(clock, (Metre(0, 4, 4),)), (line,), time_frame((line,), clock))["p"]
        assert plan.problems == ()
        return [event for event in plan.expressions if event.id == "expression:smile"]

    assert bool(smile(line)) == smiles
    # In an old project, a changed or removed smile stays changed or removed.
    changed = (ChangeExpression("expression:smile", strength=0.3),)
    assert [event.strength for event in smile(msgspec.structs.replace(line, corrections=changed))] == [0.3]
    assert smile(msgspec.structs.replace(line, corrections=(RemoveEvent("expression:smile"),))) == []


@pytest.mark.parametrize("map_id", ["flute", "piccolo", "oboe", "english_horn", "clarinet_Bb"])
def test_cheeks_that_stay_flat_do_not_puff(map_id: str) -> None:
    instrument = bundled_maps()[map_id]
    notes = line_of((0, 4 * Q, instrument.range.low, 127), (8 * Q, 4 * Q, instrument.range.low + 4, 60))
    assert not [
        event for event in plan(MonophonicPart("p", notes, instrument)).expressions if event.expression == "puffed"
    ]


def test_low_and_loud_notes_puff() -> None:
    notes = line_of((0, 4 * Q, 53, 127), (8 * Q, 4 * Q, 53, 60), (16 * Q, 4 * Q, 70, 127))
    puffed = [event for event in plan(MonophonicPart("p", notes, valves())).expressions if event.expression == "puffed"]
    assert [event.id for event in puffed] == ["expression:puffed:1:1"]


@pytest.mark.parametrize(
    ("bpm", "beats", "start_s"), [(60.0, 4.0, -4.0), (120.0, 4.0, -2.0), (200.0, 4.0, -2.0), (60.0, 1.0, -2.0)]
)
def test_the_time_frame(bpm: float, beats: float, start_s: float) -> None:
    clock = PlainClock(((0, bpm),))
    early, late = (
        MonophonicPart("a", line_of((0, Q, 65)), valves()),
        MonophonicPart("b", line_of((8 * Q, 3 * Q, 65)), valves()),
    )
    frame = time_frame((late, early), clock, beats)
    assert frame.first_frame_s == pytest.approx(start_s)
    assert frame.end_s == pytest.approx(11 * 60.0 / bpm + AFTER_LAST_S)


def test_the_pre_roll_counts_from_the_first_note() -> None:
    line = MonophonicPart("p", line_of((16 * Q, Q, 65)), valves())
    assert time_frame((line,), CLOCK).first_frame_s == pytest.approx(6.0)
    assert time_frame((line,), CLOCK, 4.0, 3 * Q // 2).first_frame_s == pytest.approx(5.0)
    assert time_frame((MonophonicPart("p", (), valves()),), CLOCK).first_frame_s == -2.0


def test_bars_run_through_metres_backwards_and_from_a_pickup() -> None:
    metres = (Metre(0, 4, 4), Metre(8 * Q, 3, 4))
    assert piece_of(CLOCK, metres).bars(0, 14 * Q).tolist() == [0, 4 * Q, 8 * Q, 11 * Q]
    assert piece_of(CLOCK, metres).bars(-5 * Q, Q).tolist() == [-8 * Q, -4 * Q, 0]
    assert piece_of(CLOCK, metres).bars(9 * Q, 12 * Q).tolist() == [8 * Q, 11 * Q]
    assert piece_of(CLOCK).bars(0, 5 * Q).tolist() == [0, 4 * Q]
    pickup = piece_of(CLOCK, (Metre(Q, 4, 4),))
    assert pickup.bars(-2 * Q, 18 * Q).tolist() == [-3 * Q, Q, 5 * Q, 9 * Q, 13 * Q, 17 * Q]


def test_chance_depends_on_its_arguments_alone() -> None:
    assert chance("a", 1) == chance("a", 1)
    assert chance("a", 1) != chance("a", 2)
    assert chance("a", 11) != chance("a1", 1)
    draws = [chance("x", index) for index in range(2000)]
    assert 0.47 < sum(draws) / len(draws) < 0.53
