"""Leaders, times of nods, and rests that require cues."""

from __future__ import annotations

import pytest

from app.plan.cues.cues import plan_cues
from app.plan.cues.entries import Entry
from app.plan.generate import MonophonicPart
from app.plan.model import CueEvent
from app.plan.music.piece import line_times
from app.plan.parameters import PlayerParameters
from app.score.metre_map import Metre
from tests.support.plan import PlainClock, line_of, make_plans, piece_of, slide, time_frame, valves

Q = 480
HIGH = MonophonicPart("high", line_of((0, 4 * Q, 72), (16 * Q, Q, 70), track=1), valves())
LOW = MonophonicPart("low", line_of((0, 4 * Q, 60), (16 * Q, Q, 75), track=2), valves())
LATE = MonophonicPart("late", line_of((2 * Q, 2 * Q, 50), (16 * Q, Q, 50), track=3), slide())


def cues(
    *lines: MonophonicPart, clock: PlainClock | None = None, felt: int | None = None, preroll: float = 4.0
) -> list[CueEvent]:
    clock = clock or PlainClock()
    piece = piece_of(clock, (Metre(0, 4, 4),), felt)
    plans = make_plans(piece, lines, time_frame(lines, clock, preroll, felt))
    found = [cue for plan in plans.values() for cue in plan.cues]
    for name, plan in plans.items():
        assert all(cue.player_id == name for cue in plan.cues)
    return sorted(found, key=lambda cue: cue.start_s)


def led(line: MonophonicPart, leads: bool) -> MonophonicPart:
    return MonophonicPart(line.player_id, line.notes, line.instrument_map, PlayerParameters(cue_leader=leads))


def test_the_first_part_of_the_melodys_section_leads_each_entry() -> None:
    first, second = cues(HIGH, LOW, LATE)
    assert (first.player_id, first.id) == ("high", "cue:1:1")
    # The second part is higher here, and still the second part.
    assert (second.player_id, second.id) == ("high", "cue:1:2")
    assert first.reason.id == "cue.start"
    assert second.reason.id == "cue.after_rest"
    assert second.reason.arguments["rest_s"] == 6.0


def test_the_preparatory_beat_is_one_beat_before_the_entry() -> None:
    first, _ = cues(HIGH)
    assert (first.start_s, first.peak_s, first.end_s, first.beat_s) == (-0.75, -0.5, 0.0, 0.5)
    assert (first.start_tick, first.end_tick) == (-720, 0)
    slow, _ = cues(HIGH, clock=PlainClock(((0, 60.0),)))
    assert slow.beat_s == 1.0
    felt, _ = cues(HIGH, felt=3 * Q // 2)
    assert felt.peak_s == -0.75


def test_the_beat_is_the_tempo_at_the_entry() -> None:
    _, second = cues(HIGH, clock=PlainClock(((0, 120.0), (10 * Q, 60.0))))
    assert second.beat_s == pytest.approx(1.0)
    assert second.peak_s == pytest.approx(10.0)


def test_a_chosen_leader_gives_every_entry() -> None:
    found = cues(HIGH, led(LOW, True), LATE)
    assert [cue.player_id for cue in found] == ["low", "low"]
    assert found[0].reason.arguments["leader_reason"] == "chosen"
    found = cues(HIGH, LOW, led(LATE, True))
    assert [cue.id for cue in found] == ["cue:@0", "cue:3:2"]


def test_who_must_not_lead_does_not() -> None:
    assert [cue.player_id for cue in cues(led(HIGH, False), LOW)] == ["low", "low"]
    assert cues(led(HIGH, False)) == []


@pytest.mark.parametrize(
    ("rest_beats", "bpm", "expected"),
    [(1, 120.0, 1), (2, 120.0, 2), (8, 120.0, 2), (1, 100.0, 1), (1.5, 60.0, 2), (1, 40.0, 2), (2, 180.0, 1)],
)
def test_long_common_rests_and_general_pauses_need_a_new_start(rest_beats: float, bpm: float, expected: int) -> None:
    line = MonophonicPart("p", line_of((0, 4 * Q, 65), (round((4 + rest_beats) * Q), Q, 65)), valves())
    assert len(cues(line, clock=PlainClock(((0, bpm),)))) == expected
    holding = MonophonicPart("q", line_of((0, 40 * Q, 60), track=2), valves())
    assert len(cues(line, holding, clock=PlainClock(((0, bpm),)))) == 1


def test_a_bar_cut_short_is_no_measure_of_a_rest() -> None:
    # 3/4, restated a quarter after a bar line: the rest of two quarters that holds it is no bar long.
    metres = (Metre(0, 3, 4), Metre(7 * Q, 3, 4))
    notes = line_of((5 * Q, Q // 2, 65), (8 * Q, Q, 67))
    piece = piece_of(PlainClock(), metres)
    line = MonophonicPart("p", notes, valves())
    cues = make_plans(piece, (line,), time_frame((line,), piece.clock))["p"].cues
    assert [(cue.end_tick, cue.reason.id) for cue in cues] == [(5 * Q, "cue.start"), (8 * Q, "cue.after_rest")]


def test_no_notes_no_cue() -> None:
    assert cues(MonophonicPart("p", (), valves())) == []


def test_no_one_nods_twice_at_once() -> None:
    # The second entry is half a beat after the first; the third, a beat and a half after it, is a nod of its own.
    notes = line_of(*((round(beat * Q), Q // 4, 60) for beat in (4, 4.5, 6)))
    line = MonophonicPart("p", notes, valves())
    entries = tuple(Entry(note.onset_tick, "cue.start", None, ((0, place),)) for place, note in enumerate(notes))
    frame = time_frame((line,), PlainClock())
    found = plan_cues(entries, (line,), (line_times(line, PlainClock()),), piece_of(PlainClock()), frame)
    assert [cue.end_tick / Q for cue in found.events] == [4, 6]


@pytest.mark.parametrize(("bpm", "starts_s"), [(120.0, [1.25, 2.25]), (80.0, [1.25, 2.0]), (72.0, [1.25])])
def test_after_a_cue_the_next_one_rises_for_as_long_as_is_left(bpm: float, starts_s: list[float]) -> None:
    # The second entry, a second after the first, begins with another tempo, whose beats its cue uses.
    clock = PlainClock(((0, 120.0), (6 * Q, bpm)))
    notes = line_of((4 * Q, Q, 60), (6 * Q, Q, 60))
    line = MonophonicPart("p", notes, valves())
    entries = tuple(Entry(note.onset_tick, "cue.start", None, ((0, place),)) for place, note in enumerate(notes))
    frame = time_frame((line,), clock)
    found = plan_cues(entries, (line,), (line_times(line, clock),), piece_of(clock), frame).events
    assert [cue.start_s for cue in found] == pytest.approx(starts_s)
    assert [cue.peak_s for cue in found] == pytest.approx([cue.end_s - cue.beat_s for cue in found])


def test_the_performance_begins_with_the_start_in_the_tempo_to_come() -> None:
    clock = PlainClock(((0, 120.0), (2, 20.0)))
    lines = (HIGH, LOW)
    first = cues(*lines, clock=clock)[0]
    assert time_frame(lines, clock).first_frame_s <= first.start_s
    assert time_frame(lines, PlainClock(), 1.0).first_frame_s == -2.0


def test_who_plays_a_part_of_the_melody_only_does_not_have_it() -> None:
    tune = [(place * Q, Q, pitch) for place, pitch in enumerate((72, 74, 76, 77, 79, 77, 76, 74))]
    below = [MonophonicPart(f"low{n}", line_of((0, Q, 60), (Q, Q, 62), track=n), slide()) for n in (1, 2)]
    (cue,) = cues(*below, MonophonicPart("tune", line_of(*tune, track=3), valves()))
    assert cue.player_id == "tune"
