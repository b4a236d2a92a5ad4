"""Loudness within notes according to hairpins and sforzandi."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.plan.generate import MonophonicPart
from app.plan.model import PlayerPlan
from app.plan.music.dynamics_within_notes import ATTACK_S, FALL_S, dynamics_within
from app.plan.music.piece import line_times
from app.plan.music.velocity_ladders import DYNAMICS, LEVELS
from app.score.marks import Mark, Source
from tests.support.plan import PlainClock, PlainNote, make_plans, piece_of, time_frame, valves

Q = 480
CLOCK = PlainClock(((0, 60.0),))
LEVEL = {name: float(level) for (name, _), level in zip(DYNAMICS, LEVELS, strict=True)}


def notes_of(*quarters: float) -> tuple[PlainNote, ...]:
    at, notes = 0, []
    for number, length in enumerate(quarters):
        notes.append(PlainNote(f"1:{number + 1}", at, round(length * Q), 60 + number % 3))
        at += round(length * Q)
    return tuple(notes)


def part_of(notes: tuple[PlainNote, ...], marks: tuple[Mark, ...], source: Source = "score") -> MonophonicPart:
    return MonophonicPart("p", notes, valves(), marks=marks, source=source)


def loudness_at(notes: tuple[PlainNote, ...], marks: tuple[Mark, ...], *at_s: float) -> list[float]:
    envelope = dynamics_within(line_times(part_of(notes, marks), CLOCK), marks, "score", CLOCK)
    found: list[float] = envelope.mean(np.array(at_s) - 0.01, np.array(at_s) + 0.01).tolist()
    return found


def planned(notes: tuple[PlainNote, ...], marks: tuple[Mark, ...]) -> PlayerPlan:
    line = part_of(notes, marks)
    return make_plans(piece_of(CLOCK), (line,), time_frame((line,), CLOCK))["p"]


def dynamic(text: str, quarter: float) -> Mark:
    return Mark("dynamic", tick=round(quarter * Q), text=text)


def test_a_hairpin_over_a_held_note_goes_from_dynamic_to_dynamic() -> None:
    marks = (dynamic("p", 0), Mark("crescendo", tick=0, end_tick=4 * Q), dynamic("f", 4))
    begin, middle, end, after = loudness_at(notes_of(4, 2), marks, 0.03, 2.0, 3.97, 5.0)
    assert begin == pytest.approx(LEVEL["p"], abs=0.02)
    assert LEVEL["mp"] < middle < LEVEL["f"]
    assert end == pytest.approx(LEVEL["f"], abs=0.02)
    assert after == pytest.approx(LEVEL["f"])


def test_a_hairpin_up_and_one_down_over_one_note() -> None:
    marks = (
        dynamic("p", 0),
        Mark("crescendo", tick=0, end_tick=2 * Q),
        Mark("diminuendo", tick=2 * Q, end_tick=4 * Q),
    )
    begin, middle, end = loudness_at(notes_of(4), marks, 0.03, 2.0, 3.97)
    assert begin == pytest.approx(end, abs=0.02)
    assert middle > begin + 0.08


@pytest.mark.parametrize(("text", "after"), [("fp", "p"), ("sfz", "mf"), ("sfpp", "pp")])
def test_a_sforzando_falls_to_the_dynamic_after_its_attack(text: str, after: str) -> None:
    marks = (dynamic("mf", 0), dynamic(text, 2))
    before, attack, left = loudness_at(notes_of(2, 4), marks, 1.0, 2.0 + ATTACK_S / 2, 2.1 + ATTACK_S + FALL_S)
    assert before == pytest.approx(LEVEL["mf"])
    assert attack >= LEVEL["f"] - 0.01
    assert left == pytest.approx(LEVEL[after], abs=0.01)


def test_without_changes_within_notes_there_is_no_curve() -> None:
    marks = (dynamic("p", 0), dynamic("f", 2), dynamic("pp", 3))
    notes = notes_of(2, 1, 1)
    assert dynamics_within(line_times(part_of(notes, marks), CLOCK), marks, "score", CLOCK) is None


def test_a_hairpin_shows_in_lips_air_and_size_of_motion() -> None:
    marks = (dynamic("pp", 0), Mark("crescendo", tick=0, end_tick=8 * Q), dynamic("ff", 8))
    traces = planned(notes_of(8, 4), marks).traces
    assert not traces.recorded
    assert traces.air is not None
    assert traces.effort is not None
    at = [round((second - traces.start_s) / traces.step_s) for second in (0.5, 3.0, 5.0, 7.5)]
    assert np.diff(traces.air[at]).min() > 0.0
    # Below mezzoforte loudness costs no effort.
    assert traces.effort[at[0]] == traces.effort[at[1]] < traces.effort[at[2]] < traces.effort[at[3]]
    assert traces.tension[at[3]] > traces.tension[at[0]]


def test_lips_that_follow_the_score_keep_their_vibrato() -> None:
    marks = (dynamic("pp", 0), Mark("crescendo", tick=0, end_tick=8 * Q), dynamic("ff", 8))
    assert not planned(notes_of(8, 4), marks).has_recorded_lips


@settings(deadline=None, max_examples=60)
@given(st.data())
def test_hairpins_rise_and_fall_as_they_are_drawn_and_stay_between_their_dynamics(data: st.DataObject) -> None:
    names = [name for name, _ in DYNAMICS]
    marks, at, ways = [], 0, []
    for _ in range(data.draw(st.integers(1, 5))):
        low, high = sorted(data.draw(st.lists(st.integers(0, 7), min_size=2, max_size=2, unique=True)))
        up = data.draw(st.booleans())
        length = data.draw(st.integers(1, 8))
        begin, end = (low, high) if up else (high, low)
        marks += [
            dynamic(names[begin], at),
            Mark("crescendo" if up else "diminuendo", tick=at * Q, end_tick=(at + length) * Q),
            dynamic(names[end], at + length),
        ]
        ways.append((at, at + length, begin, end))
        at += length + 2
    lengths = []
    while sum(lengths) < at:
        lengths.append(data.draw(st.sampled_from((0.25, 0.5, 1.0, 3.0, 7.0))))
    notes = notes_of(*lengths)
    written = tuple(marks)
    envelope = dynamics_within(line_times(part_of(notes, written), CLOCK), written, "score", CLOCK)
    if envelope is None:
        return
    for start, end, begin, goal in ways:
        inside = (envelope.at_s >= start) & (envelope.at_s + 0.05 < end)
        values = envelope.values[inside]
        low, high = sorted((LEVELS[begin], LEVELS[goal]))
        assert ((values > low - 1e-6) & (values < high + 1e-6)).all()
        steps = np.diff(values)
        assert (steps >= -1e-9).all() if goal > begin else (steps <= 1e-9).all()
