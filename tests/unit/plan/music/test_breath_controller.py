"""Blown breaths: gaps compared with a slow second method, and takes with known breaths."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import BoolArray
from app.performance.loudness import controller_input, note_loudness
from app.plan.breath.lungs import air_used_s
from app.plan.by_hand.corrections import RemoveEvent, SetBreath
from app.plan.generate import MonophonicPart
from app.plan.model import BreathEvent, PlayerPlan
from app.plan.music.breath_controller import BLOWS_FROM, STOPS_AT, blown, find_gaps, silences
from app.plan.music.piece import line_times
from app.plan.parameters import PlayerParameters
from app.score.model import ControllerCurve, Part
from instrument_maps.load import bundled_maps
from tests.support.blown import TEMPO, Blow, breath_curve, take, ticks
from tests.support.plan import make_plans, piece_of, time_frame

TRUMPET = bundled_maps()["trumpet_Bb"]


def plan_of(part: Part, corrections: tuple[object, ...] = (), **parameters: float) -> PlayerPlan:
    line = MonophonicPart(
        "p",
        part.notes,
        TRUMPET,
        PlayerParameters(**parameters),
        corrections,
        note_loudness(part),
        controller_input(part),
    )
    return make_plans(piece_of(TEMPO), (line,), time_frame((line,), TEMPO))["p"]


def breaths(plan: PlayerPlan) -> list[BreathEvent]:
    """Breaths after the first."""
    return [event for event in plan.breaths if event.kind == "breath" and event.reason.id != "breath.first"]


def slow_gaps(at_s: list[float], values: list[float], until_s: float) -> BoolArray:
    """Gaps found millisecond by millisecond."""
    blows, result = False, []
    for millisecond in range(int(until_s * 1000)):
        value = None
        for place, reported in zip(at_s, values, strict=True):
            if place <= millisecond / 1000:
                value = reported
        if value is not None and value >= BLOWS_FROM:
            blows = True
        elif value is not None and value <= STOPS_AT:
            blows = False
        result.append(not blows)
    return np.array(result)


@given(st.lists(st.tuples(st.integers(1, 40), st.integers(0, 12)), min_size=1, max_size=25))
def test_gaps_are_those_of_a_slow_second_finder(steps: list[tuple[int, int]]) -> None:
    at_s = (np.cumsum([gap for gap, _ in steps]) / 1000).tolist()
    values = [value / 127 for _, value in steps]
    expected = slow_gaps(at_s, values, at_s[-1] + 0.05)
    silent = np.zeros(len(expected), dtype=bool)
    found = find_gaps(np.array(at_s), np.array(values))
    for start_s, end_s in found:
        first = 0 if start_s == -np.inf else round(1000 * start_s)
        silent[first : len(silent) if end_s == np.inf else round(1000 * end_s)] = True
    assert (silent == expected).all()
    assert (found[:, 1] > found[:, 0]).all()
    assert (found[1:, 0] > found[:-1, 1]).all(), "in order, and none touches the next"


# Legato throughout except for three rests; in the rest from 2.0 to 2.6 s the player continues to blow. A breath from
# 4.0 to 4.4 s between notes that touch in the score, and a tongued end of 0.15 s at 5.0.
NOTES = [
    (0.5, 1.5, 65), (1.5, 2.0, 67), (2.6, 3.2, 69), (3.2, 4.4, 70), (4.4, 5.1, 72), (5.1, 6.0, 70), (6.5, 7.5, 69),
    (8.2, 9.0, 67),
]  # fmt: skip
BLOWS = [Blow(0.49, 4.0), Blow(4.4, 4.95), Blow(5.1, 6.0), Blow(6.49, 7.5), Blow(8.19, 9.0)]


def test_breaths_are_where_they_were_taken() -> None:
    plan = plan_of(take(NOTES, breath_curve(BLOWS)))
    found = breaths(plan)
    assert [event.id for event in found] == ["breath:1:5", "breath:1:7", "breath:1:8"]
    known = [(4.0, 4.4), (6.0, 6.49), (7.5, 8.19)]
    for event, (start_s, end_s) in zip(found, known, strict=True):
        assert end_s - 0.02 <= event.end_s <= end_s + 0.03
        # A gap of a beat and more is breathed in on its last beat, as a rest is.
        assert max(start_s, end_s - 0.5) - 0.03 <= event.start_s <= max(start_s, end_s - 0.5) + 0.03
        assert event.reason.id == "breath.blown"
    lips = {event.note_id: event.end_s for event in plan.embouchures}
    assert lips["1:4"] == pytest.approx(4.0, abs=0.03), "the lips leave where the breath begins"


HELD = [(0.5, 1.5, 65), (1.5, 6.5, 67), (7.2, 8.0, 69), (8.0, 12.0, 70)]
HELD_BLOWS = [Blow(0.5, 3.0), Blow(3.45, 4.9), Blow(5.05, 6.5), Blow(7.2, 9.0), Blow(9.5, 12.0)]
"""Blows with a breath of 0.45 s and tonguing of 0.15 s within the second note, a rest, and a breath of 0.5 s within the
last note.
"""


def test_who_stops_blowing_within_a_note_breathes_there() -> None:
    plan = plan_of(take(HELD, breath_curve(HELD_BLOWS)))
    found = {event.id: event for event in breaths(plan)}
    assert sorted(found) == ["breath:1:3", "within:1:2", "within:1:4"]
    for id, start_s, end_s in (("within:1:2", 3.0, 3.45), ("within:1:4", 9.0, 9.5)):
        event = found[id]
        assert event.start_s == pytest.approx(start_s, abs=0.03)
        assert event.end_s == pytest.approx(end_s, abs=0.03)
        assert event.reason.id == "breath.blown"
        assert event.depth > 0.3
    assert [(event.note_id, event.end_s) for event in plan.embouchures if event.note_id == "1:2"] == [("1:2", 6.5)]


def test_a_breath_within_a_note_fills_the_lungs() -> None:
    # Lungs of 6 s are good for 8 s of this trumpet.
    notes = [(0.5, 12.5, 65), (12.5, 20.5, 67)]
    long = [Blow(0.5, 20.5)]
    fault = "breath.too_long"
    assert fault in [problem.message.id for problem in plan_of(take(notes, breath_curve(long)), lung_s=6.0).problems]
    broken = [Blow(0.5, 7.0), Blow(7.8, 14.0), Blow(14.8, 20.5)]
    plan = plan_of(take(notes, breath_curve(broken)), lung_s=6.0)
    assert fault not in [problem.message.id for problem in plan.problems]


def test_a_breath_within_a_note_is_moved_and_taken_out_by_hand() -> None:
    part = take(HELD, breath_curve(HELD_BLOWS))
    plan = plan_of(part, (RemoveEvent("within:1:2"), SetBreath("1:4", 240, 720, 0.5, "within")))
    assert sorted(event.id for event in breaths(plan)) == ["breath:1:3", "within:1:4"]
    (moved,) = [event for event in breaths(plan) if event.corrected]
    assert (moved.kind, moved.start_s, moved.end_s) == ("breath", pytest.approx(8.25), pytest.approx(8.75))
    assert not plan.problems


def test_without_the_curve_they_are_guessed_from_the_rests() -> None:
    plan = plan_of(take(NOTES), breath_need=0.0)
    assert [event.id for event in breaths(plan)] == ["breath:1:3", "breath:1:7", "breath:1:8"]
    assert plan.traces is None


def test_a_short_gap_is_breathed_in_only_where_air_is_needed() -> None:
    notes = [(0.5 + beat, 1.5 + beat, 65 + beat % 3) for beat in range(14)]
    # A tongued gap of 0.2 s every second note, no longer one.
    blows = [Blow(0.5 + beat, 2.3 + beat) for beat in range(0, 14, 2)]
    part = take(notes, breath_curve(blows))
    assert [event.id for event in breaths(plan_of(part, lung_s=60.0))] == []
    found = breaths(plan_of(part, lung_s=9.0))
    assert found
    for event in found:
        assert event.reason.id == "breath.blown_short"
        assert event.end_s - event.start_s == pytest.approx(0.2, abs=0.04)
        assert (event.end_s - 0.5) % 2.0 == pytest.approx(0.0, abs=0.02)


def test_who_never_stopped_blowing_takes_no_breath_and_is_reported() -> None:
    notes = [(0.5 + beat, 1.5 + beat, 65) for beat in range(20)]
    curve = breath_curve([Blow(0.5, 19.1), Blow(19.5, 20.5)])
    plan = plan_of(take(notes, curve), lung_s=6.0)
    assert [event.id for event in breaths(plan)] == ["breath:1:20"]
    assert "breath.too_long" in [problem.message.id for problem in plan.problems]


def test_a_curve_drawn_for_the_dynamics_has_no_breath_gaps() -> None:
    drawn = ControllerCurve("expression", (0, ticks(3.0), ticks(5.0)), (0.5, 0.9, 0.4))
    with_it, without = plan_of(take(NOTES, drawn)), plan_of(take(NOTES))
    places = [(event.id, event.start_s, event.end_s) for event in with_it.breaths]
    assert places == [(event.id, event.start_s, event.end_s) for event in without.breaths]
    assert with_it.traces is not None, "but the lips follow it"


def test_curves_that_do_not_move_change_nothing() -> None:
    levels = [
        ControllerCurve("volume", (0,), (0.8,)),
        ControllerCurve("pitch_bend", (0, 10), (0.0, 0.0)),
        ControllerCurve("bite", (5,), (0.5,)),
    ]
    part = take(NOTES, *levels)
    assert controller_input(part) is None
    assert plan_of(part) == plan_of(take(NOTES))


def test_corrections_win() -> None:
    by_hand = SetBreath("1:6", -240, 0, 0.7)
    plan = plan_of(take(NOTES, breath_curve(BLOWS)), (RemoveEvent("breath:1:5"), by_hand))
    assert [event.id for event in breaths(plan)] == ["breath:1:6", "breath:1:7", "breath:1:8"]
    assert [event.corrected for event in breaths(plan)] == [True, False, False]


def test_air_is_what_the_curve_took() -> None:
    part = take(NOTES, breath_curve(BLOWS, noise=0))
    line = MonophonicPart("p", part.notes, TRUMPET, loudness=note_loudness(part), controller=controller_input(part))
    assert line.controller.breath is not None
    breath, times = blown(line.controller.breath, TEMPO), line_times(line, TEMPO)
    used = air_used_s(times, None, breath)
    # Millisecond by millisecond, from the same curve.
    at = np.arange(0.0, 9.0, 0.001)
    value = breath.values[np.maximum(np.searchsorted(breath.at_s, at, side="right") - 1, 0)]
    rate = np.where(value > STOPS_AT, np.interp(value, [0.0, 0.63, 1.0], [0.6, 1.0, 1.6]), 0.0)
    for index, onset_s in enumerate(times.onset_s.tolist()):
        assert used[index] == pytest.approx(rate[(at >= 0.5) & (at < onset_s)].sum() / 1000, abs=0.01)


def test_gaps_serve_the_note_they_come_before() -> None:
    part = take(NOTES, breath_curve(BLOWS))
    line = MonophonicPart("p", part.notes, TRUMPET, controller=controller_input(part))
    assert line.controller is not None
    assert line.controller.breath is not None
    times = line_times(line, TEMPO)
    gaps = silences(blown(line.controller.breath, TEMPO), times)
    assert np.flatnonzero(gaps.length_s > 0).tolist() == [4, 5, 6, 7]
    assert (gaps.end_s[4:] <= times.onset_s[4:]).all()


def test_what_was_drawn_beside_the_recorded_bars_is_breathed_by_its_rests() -> None:
    drawn = [(20.0, 21.0, 65), (22.0, 23.0, 67), (23.0, 24.0, 69)]
    part = take([*NOTES, *drawn], breath_curve(BLOWS))
    plan = plan_of(part)
    assert [(event.id, event.reason.id) for event in breaths(plan)][3:] == [
        ("breath:1:9", "breath.prepared"),
        ("breath:1:10", "breath.prepared"),
    ]
    levels = {event.note_id: event.air for event in plan.embouchures}
    assert levels["1:9"] == levels["1:11"] == 0.63
    assert plan.traces.air is not None
    at_s = plan.traces.start_s + plan.traces.step_s * np.arange(len(plan.traces.air))
    np.testing.assert_allclose(plan.traces.air[(at_s > 22.2) & (at_s < 23.8)], 0.63)
    # Notes in a row between two recorded stretches: the gap is theirs.
    between = plan_of(take([*NOTES[:5], (5.1, 6.0, 70), *NOTES[6:]], breath_curve([*BLOWS[:2], *BLOWS[3:]])))
    assert [event.id for event in breaths(between)] == ["breath:1:5", "breath:1:7", "breath:1:8"]
