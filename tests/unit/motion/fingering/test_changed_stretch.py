"""Curves updated after an edit equal those of the whole line to the bit."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cache

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.motion.fingering.changed_stretch import changed_stretch, spliced
from app.motion.fingering.control_curves import control_curves
from app.motion.fingering.finger_curves import station_curves
from app.motion.perform import PerformanceCurves, prepare
from app.performance.ensemble import Performance
from app.plan.model import FingeringEvent
from app.plan.parameters import PlayerParameters
from app.steps import StepRuns
from instrument_maps.library import find_map
from tests.bench.performance.large import large_project
from tests.unit.motion.test_perform import BODY, CHARACTER, HOLD, MAP, piece

pytestmark = pytest.mark.slow

BEAT_TICKS = 480
NOTES = 300


@cache
def lines() -> dict[str, tuple[FingeringEvent, ...]]:
    """A line for every instrument, by its id."""
    project = large_project(40, NOTES)
    performance = Performance(project)
    return {player.instrument_id: performance.plan(player).fingerings for player in project.players}


def edited(line: tuple[FingeringEvent, ...], at: int, other: int, kind: str) -> tuple[FingeringEvent, ...]:
    """Line with a note fingered like another one, shortened, removed or slightly delayed."""
    note, like = line[at], line[other]
    if kind == "gone":
        return line[:at] + line[at + 1 :]
    if kind == "shorter":
        middle_s, middle = 0.5 * (note.start_s + note.end_s), (note.start_tick + note.end_tick) // 2
        changed = msgspec.structs.replace(note, end_s=middle_s, end_tick=middle)
    elif kind == "later":
        start_s, start = 0.5 * (note.start_s + note.end_s), (note.start_tick + note.end_tick) // 2
        changed = msgspec.structs.replace(note, start_s=start_s, start_tick=start)
    else:
        changed = msgspec.structs.replace(note, controls=like.controls, fingers=like.fingers, label=like.label)
    return (*line[:at], changed, *line[at + 1 :])


@given(st.data())
@settings(deadline=None, max_examples=120)
def test_what_is_put_together_is_what_is_made_of_the_whole(data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(sorted(lines())))
    line, instrument = lines()[name], find_map(name)
    index = st.integers(0, NOTES - 1)
    kind = data.draw(st.sampled_from(["other", "shorter", "later", "gone"]))
    after = edited(line, data.draw(index), data.draw(index), kind)
    controls = control_curves(line, instrument.controls, ((0, BEAT_TICKS),))
    places = station_curves(line, instrument, controls)
    stretch = changed_stretch(line, after, ((0, BEAT_TICKS),))
    if stretch is None:
        return
    own = stretch.notes(after)
    whole = control_curves(after, instrument.controls, ((0, BEAT_TICKS),))
    put_controls = spliced(controls, control_curves(own, instrument.controls, ((0, BEAT_TICKS),)), stretch)
    assert put_controls is not None
    put_places = spliced(places, station_curves(own, instrument, put_controls), stretch)
    assert put_places is not None
    for put, made in ((put_controls, whole), (put_places, station_curves(after, instrument, whole))):
        assert put.keys() == made.keys()
        for key, curve in made.items():
            assert curve.initial == put[key].initial
            for column in ("start_s", "end_s", "before", "after"):
                np.testing.assert_array_equal(getattr(put[key], column), getattr(curve, column))


def test_one_note_is_a_stretch_between_two_long_rests() -> None:
    line = lines()["clarinet_Bb"]
    lengths = []
    for at in range(0, NOTES, 10):
        stretch = changed_stretch(line, edited(line, at, (at + 7) % NOTES, "shorter"), ((0, BEAT_TICKS),))
        assert stretch.first <= at < stretch.last
        lengths.append(stretch.last - stretch.first)
    assert np.median(lengths) < NOTES / 3


def test_a_line_without_long_rests_is_made_whole() -> None:
    line = lines()["clarinet_Bb"][:6]
    touching = tuple(
        msgspec.structs.replace(note, start_s=0.5 * index, end_s=0.5 * index + 0.5) for index, note in enumerate(line)
    )
    assert changed_stretch(touching, edited(touching, 3, 1, "shorter"), ((0, BEAT_TICKS),)) is None


def test_curves_that_move_in_the_silence_are_not_put_together() -> None:
    line, instrument = lines()["clarinet_Bb"], find_map("clarinet_Bb")
    after = edited(line, 100, 107, "shorter")
    stretch = changed_stretch(line, after, ((0, BEAT_TICKS),))
    assert stretch is not None
    controls = control_curves(line, instrument.controls, ((0, BEAT_TICKS),))
    own = control_curves(stretch.notes(after), instrument.controls, ((0, BEAT_TICKS),))
    key, curve = next((key, curve) for key, curve in controls.items() if not curve.still)
    at_s = stretch.start_s if np.isfinite(stretch.start_s) else stretch.end_s
    slow = replace(curve, end_s=np.where(curve.end_s < at_s, at_s + 0.1, curve.end_s))
    assert spliced({**controls, key: slow}, own, stretch) is None
    assert spliced({}, own, stretch) is None


@pytest.mark.parametrize("seconds", [3.4, 3.6])
def test_how_long_a_rest_must_be(seconds: float) -> None:
    line = lines()["clarinet_Bb"][:8]
    row = [msgspec.structs.replace(note, start_s=0.5 * i, end_s=0.5 * i + 0.5) for i, note in enumerate(line[:4])]
    row += [
        msgspec.structs.replace(
            note,
            start_s=1.5 + seconds + 0.5 * i,
            end_s=2.0 + seconds + 0.5 * i,
            start_tick=note.start_tick + 9000,
            end_tick=note.end_tick + 9000,
        )
        for i, note in enumerate(line[4:])
    ]
    notes = tuple(row)
    stretch = changed_stretch(notes, edited(notes, 6, 1, "shorter"), ((0, BEAT_TICKS),))
    assert (stretch is not None) == (seconds - 0.5 >= 3.0)


def test_with_another_seed_the_same_plan_is_looked_at_otherwise() -> None:
    plan = piece()

    def made(seed: int, before: PerformanceCurves | None = None) -> PerformanceCurves:
        parameters = PlayerParameters(seed=seed)
        beats = ((0, BEAT_TICKS),)
        runs = StepRuns(None if before is None else before.runs)
        return prepare(runs, plan, parameters, MAP, CHARACTER, HOLD, BODY, felt_beats=beats)

    times_s = np.arange(0.0, 20.0, 0.05)
    before = made(1)
    known, other = made(1, before).gaze, made(2, before).gaze
    assert known is before.gaze
    expected, first = made(2).gaze.sample(times_s), before.gaze.sample(times_s)
    for member in fields(expected):
        np.testing.assert_array_equal(getattr(other.sample(times_s), member.name), getattr(expected, member.name))
    assert not np.array_equal(first.yaw_rad, expected.yaw_rad)
