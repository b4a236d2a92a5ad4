"""Delay of visible motion behind the sound, with controls that were shifted in time."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import FloatArray
from app.errors import Message
from app.evaluation.onset_lag import LagMeasure, measure_lag
from app.plan.model import FingeringEvent
from instrument_maps.load import bundled_maps

MAPS = bundled_maps()
VALVES = [control for control in MAPS["trumpet_Bb"].controls if control.kind == "press"]
[SLIDE] = [control for control in MAPS["trombone_tenor_F_attachment"].controls if control.kind == "slide"]
WITHIN_MS = 5.0
"""Tolerance in milliseconds: frames are 17 ms apart, and the end of a motion lies between two."""
TIMES_S = np.arange(-2.0, 12.0, 1.0 / 60.0)


def notes(*fingered: tuple[float, float, dict[str, float]]) -> list[FingeringEvent]:
    """Notes from (start, end, controls)."""
    return [
        FingeringEvent(f"f{index}", f"n{index}", 0, 0, start_s, end_s, "", 0, controls, 0.0, Message("fingering.usual"))
        for index, (start_s, end_s, controls) in enumerate(fingered)
    ]


def moved(fingerings: list[FingeringEvent], name: str, late_s: float = 0.0, takes_s: float = 0.05) -> FloatArray:
    """Control that moves at constant speed and arrives at every note with a given delay."""
    times, values, before = [-10.0], [0.0], 0.0
    for note in fingerings:
        target = note.controls.get(name, 0.0)
        times += [note.start_s + late_s - takes_s, note.start_s + late_s]
        values += [before, target]
        before = target
    return np.interp(TIMES_S, times, values)


SCALE = notes(*((0.5 * n, 0.5 * n + 0.5, {VALVES[0].name: float(n % 2)}) for n in range(1, 16)))


def measured(late_s: float, fingerings: list[FingeringEvent] = SCALE) -> LagMeasure:
    return measure_lag(fingerings, VALVES[:1], {VALVES[0].name: moved(fingerings, VALVES[0].name, late_s)}, TIMES_S)


@pytest.mark.parametrize("late_ms", [-150, -60, 0, 30, 80, 200])
def test_a_shift_is_found(late_ms: int) -> None:
    found = measured(late_ms / 1000.0)
    # It counts as there within a tenth of its travel: 5 ms before it has arrived. The first note follows silence.
    assert found.median_ms == pytest.approx(late_ms - 5.0, abs=WITHIN_MS)
    assert (found.notes, found.missed) == (14, 0)
    assert found.detectable == float(not -125 <= late_ms - 5 <= 45)
    assert found.unacceptable == float(not -185 <= late_ms - 5 <= 90)


@given(st.floats(-0.2, 0.2), st.lists(st.sampled_from([0.13, 0.2, 0.35, 0.6]), min_size=4, max_size=12))
def test_a_trill_that_is_late_is_not_taken_for_its_next_note(late_s: float, lengths: list[float]) -> None:
    starts = np.cumsum([0.0, *lengths])
    trill = notes(
        *(
            (start, end, {VALVES[0].name: float(n % 2)})
            for n, (start, end) in enumerate(itertools.pairwise(starts), start=1)
        )
    )
    found = measured(late_s, trill)
    assert found.missed == 0
    assert found.median_ms == pytest.approx(1000.0 * late_s - 5.0, abs=WITHIN_MS)
    assert found.latest_ms == pytest.approx(1000.0 * late_s - 5.0, abs=WITHIN_MS)


def test_a_slide_passes_places_that_it_is_not_going_to() -> None:
    places = (0.0, 1.0, 0.5, 0.0, 1.0, 0.2, 0.8, 0.5)
    fingerings = notes(*((0.4 * n, 0.4 * n + 0.4, {SLIDE.name: place}) for n, place in enumerate(places)))
    values = moved(fingerings, SLIDE.name, 0.2, takes_s=0.15)
    found = measure_lag(fingerings, [SLIDE], {SLIDE.name: values}, TIMES_S)
    assert (found.notes, found.missed) == (7, 0)
    assert found.median_ms == pytest.approx(200.0, abs=WITHIN_MS)


def test_a_note_waits_for_its_last_valve() -> None:
    first, second = VALVES[0].name, VALVES[1].name
    fingerings = notes((0.0, 0.5, {}), (0.5, 1.0, {first: 1.0, second: 1.0}))
    values = {first: moved(fingerings, first, -0.02), second: moved(fingerings, second, 0.1)}
    found = measure_lag(fingerings, VALVES[:2], values, TIMES_S)
    assert (found.notes, found.detectable, found.unacceptable) == (1, 1.0, 1.0)
    assert found.median_ms == pytest.approx(95.0, abs=WITHIN_MS)


def test_a_valve_that_stays_up_is_missed() -> None:
    found = measure_lag(SCALE, VALVES[:1], {VALVES[0].name: np.zeros(len(TIMES_S))}, TIMES_S)
    assert (found.notes, found.missed, found.median_ms, found.detectable) == (14, 14, None, 1.0)


def test_nothing_to_judge() -> None:
    rests = notes((0.0, 0.5, {}), (2.0, 2.5, {VALVES[0].name: 1.0}))
    assert measured(0.0, rests) == LagMeasure(0, 0, None, None, None, None)
    assert measure_lag([], VALVES, {}, TIMES_S) == LagMeasure(0, 0, None, None, None, None)


def test_a_finger_that_is_lifted_in_a_rest_is_not_awaited() -> None:
    valve = VALVES[0].name
    rested = notes((0.0, 0.5, {valve: 1.0}), (2.5, 2.7, {}), (2.7, 3.0, {valve: 1.0}), (3.0, 3.3, {}))
    values = np.interp(TIMES_S, [-0.06, -0.01, 0.5, 0.55, 2.64, 2.69, 2.94, 2.99], [0, 1, 1, 0, 0, 1, 1, 0])
    found = measure_lag(rested, VALVES[:1], {valve: values}, TIMES_S)
    assert (found.notes, found.missed) == (2, 0)
    assert found.median_ms == pytest.approx(-15.0, abs=WITHIN_MS)


def test_a_small_way_is_not_done_when_it_begins() -> None:
    """A tuning slide that moves by 8 mm is within 5 mm of its place early in the move."""
    [slide] = [control for control in MAPS["trumpet_Bb"].controls if control.name == "first_slide"]
    assert slide.travel_m is not None
    tuned = notes((0.0, 0.5, {}), (0.5, 1.0, {slide.name: 0.008 / slide.travel_m}))
    found = measure_lag(tuned, [slide], {slide.name: moved(tuned, slide.name, 0.0, takes_s=0.25)}, TIMES_S)
    assert found.median_ms == pytest.approx(-25.0, abs=WITHIN_MS)
