"""Gestures: on the beat, seeded by player and place, with the instrument lowered only if there is time."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import Message
from app.plan.generate import MonophonicPart
from app.plan.gestures.gestures import ARCH, RELEASE, in_order
from app.plan.gestures.lowered_instrument import LOWER_S, LOWERED_LEAST_S, RAISE_S
from app.plan.gestures.sways import STIR_S
from app.plan.model import GestureEvent, PlayerPlan
from app.plan.parameters import PlayerParameters
from app.score.metre_map import Metre
from tests.support.plan import PlainClock, PlainNote, even, line_of, make_plans, piece_of, time_frame, valves

Q = 480
CLOCK = PlainClock()
PIECE = piece_of(CLOCK, (Metre(0, 4, 4),))


def plans(*lines: MonophonicPart, seed: int = 0) -> dict[str, PlayerPlan]:
    return make_plans(PIECE, lines, time_frame(lines, CLOCK), seed)


def of_kind(plan: PlayerPlan, kind: str) -> list[GestureEvent]:
    return [event for event in plan.gestures if event.kind == kind]


def tune(track: int = 1, bars: int = 32) -> tuple[PlainNote, ...]:
    return even([65, 67, 69, 70] * bars, Q, track=track)


@given(st.lists(st.tuples(st.integers(0, 4), st.sampled_from("abcdef")), max_size=20))
def test_gestures_are_ordered_by_start_then_by_id(rows: list[tuple[int, str]]) -> None:
    events = [
        GestureEvent(f"lean:{name}", "lean", start, start + 1, float(start), start + 1.0, 1.0, Message("gesture.lean"))
        for start, name in rows
    ]
    expected = sorted(events, key=lambda event: (event.start_s, event.id))
    assert list(in_order((events[::2], events[1::2]))) == expected


def test_sway_goes_from_beat_to_beat_without_gaps() -> None:
    sways = of_kind(plans(MonophonicPart("p", tune(), valves()))["p"], "sway")
    for event, following in itertools.pairwise(sways):
        assert event.end_tick == following.start_tick
        assert event.start_tick % Q == 0
    assert sways[0].start_s <= -2.0
    assert sways[-1].end_s >= 64.0


def test_a_swing_takes_a_bodys_time_at_every_tempo() -> None:
    for bpm in (40.0, 60.0, 90.0, 132.0, 200.0, 6000.0):
        clock = PlainClock(((0, bpm),))
        line = MonophonicPart("p", tune(), valves())
        plan = make_plans(piece_of(clock), (line,), time_frame((line,), clock))["p"]
        lengths = {round(event.end_s - event.start_s, 3) for event in of_kind(plan, "sway")}
        assert len(lengths) == 1
        assert 0.7 <= lengths.pop() <= 3.2


def test_silence_between_notes_costs_nothing_however_long_it_is() -> None:
    notes = tune(bars=4)
    counts = []
    for hours in (1, 11):
        later = tuple(replace(note, id=f"{note.id}x", onset_tick=note.onset_tick + hours * 7200 * Q) for note in notes)
        sways = of_kind(plans(MonophonicPart("p", notes + later, valves()))["p"], "sway")
        counts.append(len(sways))
        near = [event for event in sways if event.end_s < 8.0 + STIR_S]
        alone = [
            event for event in of_kind(plans(MonophonicPart("p", notes, valves()))["p"], "sway") if event.end_s < 8.0
        ]
        # Near the music nothing is different, and some time after it everybody is still.
        assert near[: len(alone)] == alone
        assert not any(60.0 < event.start_s < 3600.0 * hours - 60.0 for event in sways)
    assert counts[0] == pytest.approx(counts[1], abs=6)


def test_two_players_of_one_part_never_sway_alike() -> None:
    grid_s = np.arange(0.0, 60.0, 0.25)

    def curve(plan: PlayerPlan) -> np.ndarray:
        events = of_kind(plan, "sway")
        return np.interp(grid_s, [event.end_s for event in events], [event.amount for event in events])

    lines = tuple(MonophonicPart(f"player {index}", tune(index), valves()) for index in range(12))
    curves = [curve(plan) for plan in plans(*lines).values()]
    correlation = np.corrcoef(curves) - np.eye(len(curves))
    assert np.abs(correlation).max() < 0.9


def test_gestures_belong_to_player_seed_and_place() -> None:
    line = MonophonicPart("p", tune(), valves())
    again = plans(line)["p"]
    assert plans(line)["p"] == again
    assert plans(line, seed=1)["p"].gestures != again.gestures
    other = MonophonicPart("p", tune(), valves(), PlayerParameters(seed=3))
    assert plans(other)["p"].gestures != again.gestures
    # A change at the end leaves the gestures of the beginning alone.
    longer = MonophonicPart("p", (*tune(), PlainNote("1:999", 128 * Q, Q, 70)), valves())
    early = {event.id: event.amount for event in again.gestures if event.kind == "sway" and event.end_s < 50.0}
    changed = {event.id: event.amount for event in plans(longer)["p"].gestures if event.kind == "sway"}
    assert early.items() <= changed.items()


def test_weight_rests_somewhere_from_shift_to_shift() -> None:
    shifts = of_kind(plans(MonophonicPart("p", tune(bars=128), valves()))["p"], "weight_shift")
    assert 256.0 / 20.0 < len(shifts) < 256.0 / 4.0
    assert any(event.start_tick % Q for event in shifts)
    for event, following in itertools.pairwise(shifts):
        assert event.end_s == following.start_s
        assert following.start_s - event.start_s >= 3.0
        assert 0.2 <= abs(event.amount) <= 1.0


def test_the_bell_follows_the_melody() -> None:
    notes = even([60] * 8 + [72] * 8 + [60] * 8, Q)
    bells = of_kind(plans(MonophonicPart("p", notes, valves()))["p"], "bell_height")
    assert [event.id for event in bells] == [
        "bell_height:1:1",
        "bell_height:1:9",
        "bell_height:1:17",
        "bell_height:1:24",
    ]
    assert bells[0].amount == pytest.approx(-0.4) == pytest.approx(bells[2].amount, abs=0.03)
    assert bells[1].amount == pytest.approx(0.8 + ARCH)
    assert bells[3].amount == pytest.approx(-0.4 - RELEASE * ARCH)
    assert (bells[1].start_tick, bells[1].end_tick) == (8 * Q, 16 * Q)


@pytest.mark.parametrize(("rest_beats", "lowered"), [(11, False), (12, True), (40, True)])
def test_the_instrument_comes_down_only_in_long_rests(rest_beats: int, lowered: bool) -> None:
    notes = line_of((0, Q, 65), ((1 + rest_beats) * Q, Q, 65))
    plan = plans(MonophonicPart("p", notes, valves()))["p"]
    spans = [event for event in of_kind(plan, "lower_instrument") if event.id != "lower_instrument:end"]
    assert bool(spans) == lowered
    for span in spans:
        assert span.id == "lower_instrument:1:2"
        assert span.start_s > 0.5
        assert span.end_s - span.start_s >= LOWER_S + LOWERED_LEAST_S + RAISE_S
        preparation = next(event for event in plan.breaths if event.id == "preparation:1:2")
        assert span.end_s < min(preparation.start_s, *(cue.start_s for cue in plan.cues if cue.end_s > 1.0))


def test_a_late_player_begins_with_the_instrument_down_and_all_end_so() -> None:
    early = MonophonicPart("early", tune(), valves())
    late = MonophonicPart("late", line_of((64 * Q, Q, 60), track=2), valves())
    plan = plans(early, late)["late"]
    first, last = of_kind(plan, "lower_instrument")
    assert first.start_s < plan.time_frame.first_frame_s
    assert first.end_s < plan.breaths[0].start_s
    assert last.id == "lower_instrument:end"
    assert last.start_s > 32.5
    assert last.end_s > plan.time_frame.end_s
    assert not [event for event in of_kind(plans(early)["early"], "lower_instrument") if event.start_s < 0.0]


def test_a_player_without_notes_holds_the_instrument_down() -> None:
    plan = plans(MonophonicPart("p", tune(), valves()), MonophonicPart("q", (), valves()))["q"]
    (span,) = of_kind(plan, "lower_instrument")
    assert span.start_s < plan.time_frame.first_frame_s
    assert span.end_s > plan.time_frame.end_s


def test_sway_follows_the_bars_through_a_pickup_and_odd_metres() -> None:
    metres = (Metre(0, 4, 4), Metre(Q // 2, 4, 4), Metre(8 * Q + Q // 2, 7, 8))
    piece = piece_of(CLOCK, metres, has_pickup=True)
    line = MonophonicPart("p", tune(), valves())
    plan = make_plans(piece, (line,), time_frame((line,), CLOCK))["p"]
    beats = set(piece.metre_map.felt_between(-10 * Q, 140 * Q).tolist())
    assert set(piece.bars(-10 * Q, 140 * Q).tolist()) <= beats
    sways = of_kind(plan, "sway")
    assert {event.start_tick for event in sways} <= beats
    for event, following in itertools.pairwise(sways):
        assert event.end_tick == following.start_tick
