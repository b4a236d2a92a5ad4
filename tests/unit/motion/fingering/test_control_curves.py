"""Controls are judged at whole frames of every frame rate, as in exported files."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import FloatArray
from app.motion.curves.curve import Curve, frame_times
from app.motion.fingering.control_curves import control_curves, window_s
from app.plan.model import FingeringEvent
from instrument_maps.model import Control
from tests.unit.motion.events import TICKS, fingerings, press, slide

RATES = [Fraction(24), Fraction(25), Fraction(30000, 1001), Fraction(30), Fraction(60)]
FIRST_FRAME_S = -2.0


@st.composite
def passages(
    draw: st.DrawFn, name: str, values: st.SearchStrategy[float], shortest_s: float
) -> tuple[FingeringEvent, ...]:
    """Notes of a line: (onset_s, end_s, controls), with gaps below a beat and rests of a beat or more."""
    rows = []
    time_s = draw(st.floats(0.0, 1.0))
    for _ in range(draw(st.integers(1, 12))):
        length_s = draw(st.floats(shortest_s, 1.2))
        gap_s = draw(st.sampled_from([0.0, 0.0, 0.0, 0.02, 0.1, 0.3, 0.5, 0.62, 1.4]))
        rows.append((time_s, time_s + length_s, {name: draw(values)}))
        time_s += length_s + gap_s
    return fingerings(rows)


def control_curve(events: Sequence[FingeringEvent], control: Control, felt_beats: tuple[tuple[int, int], ...]) -> Curve:
    return control_curves(events, (control,), felt_beats)[control.name]


def judged_frame(onset_s: float, fps: Fraction) -> int:
    return math.ceil(round((onset_s - FIRST_FRAME_S) * fps.numerator / fps.denominator, 9))


def sampled(events: Sequence[FingeringEvent], control: Control, fps: Fraction) -> tuple[FloatArray, FloatArray]:
    frames = int((events[-1].end_s + 3.0 - FIRST_FRAME_S) * fps) + 1
    times_s = frame_times(FIRST_FRAME_S, fps, 0, frames)
    return times_s, control_curve(events, control, ((0, TICKS),)).sample(times_s)


@pytest.mark.parametrize("fps", RATES)
@given(events=passages("valve_1", st.sampled_from([0.0, 1.0]), 2 / 24 + 0.001))
@settings(max_examples=60, deadline=None)
def test_a_press_is_exact_at_the_judged_frame_and_until_its_window(
    fps: Fraction, events: Sequence[FingeringEvent]
) -> None:
    times_s, values = sampled(events, press(), fps)
    for event, following in zip(events, [*events[1:], None], strict=True):
        target = event.controls["valve_1"]
        assert values[judged_frame(event.start_s, fps)] == pytest.approx(target, abs=1e-9)
        end_s = event.end_s if following is None else min(event.end_s, following.start_s)
        leave_s = end_s
        if following is not None:
            leave_s = min(end_s, following.start_s - min(0.060, 0.40 * (end_s - event.start_s)))
        held = (times_s >= event.start_s + 1e-9) & (times_s <= leave_s - 1e-9)
        np.testing.assert_allclose(values[held], target, atol=0.1 + 1e-9)


@pytest.mark.parametrize("fps", RATES)
@given(events=passages("slide", st.sampled_from([0.0, 0.14, 0.29, 0.31, 0.6, 1.0]), 0.5))
@settings(max_examples=60, deadline=None)
def test_a_slide_is_exact_at_the_judged_frame_and_until_its_window(
    fps: Fraction, events: Sequence[FingeringEvent]
) -> None:
    times_s, values = sampled(events, slide(), fps)
    for event, following in zip(events, [*events[1:], None], strict=True):
        target = event.controls["slide"]
        assert abs(values[judged_frame(event.start_s, fps)] - target) * 0.6 < 1e-9
        end_s = event.end_s if following is None else min(event.end_s, following.start_s)
        leave_s = end_s
        if following is not None:
            distance_m = abs(following.controls["slide"] - target) * 0.6
            window = min(max(0.060, distance_m / 2.5), 0.5 * (end_s - event.start_s))
            leave_s = min(end_s, following.start_s - window)
        held = (times_s >= event.start_s + 1e-9) & (times_s <= leave_s - 1e-9)
        assert np.all(np.abs(values[held] - target) * 0.6 <= 0.005)


@given(events=passages("slide", st.floats(0.0, 1.0), 0.06))
@settings(max_examples=100, deadline=None)
def test_between_two_notes_a_control_goes_one_way_and_no_further(events: Sequence[FingeringEvent]) -> None:
    curve = control_curve(events, slide(), ((0, TICKS),))
    for event, following in itertools.pairwise(events):
        if following.start_tick - event.end_tick >= TICKS:
            continue
        values = curve.sample(np.linspace(event.start_s, following.start_s, 400))
        steps = np.diff(values)
        direction = np.sign(following.controls["slide"] - event.controls["slide"])
        assert np.all(steps * direction >= -1e-12)


@pytest.mark.parametrize("control", [press(), slide(name="valve_1")])
@pytest.mark.parametrize("beats", [1.0, 1.5, 4.0])
@pytest.mark.parametrize("quarter_s", [0.22, 0.5, 1.5])
def test_in_a_rest_of_a_beat_or_more_a_control_is_at_rest(control: Control, beats: float, quarter_s: float) -> None:
    onset_s = 1.0 + beats * quarter_s
    events = fingerings([(0.0, 1.0, {"valve_1": 1.0}), (onset_s, onset_s + 1.0, {"valve_1": 0.8})], quarter_s)
    curve = control_curve(events, control, ((0, TICKS),))
    values = curve.sample(np.linspace(1.0, onset_s, 500))
    assert values.min() == pytest.approx(0.0, abs=1e-6)
    assert values[0] == 1.0
    assert values[-1] == pytest.approx(0.8, abs=1e-12)


def test_in_a_rest_below_a_beat_a_control_stays_and_moves_late() -> None:
    events = fingerings([(0.0, 1.0, {"valve_1": 1.0}), (1.4, 2.0, {"valve_1": 1.0}), (2.4, 3.0, {})])
    values = control_curve(events, press(), ((0, TICKS),)).sample(np.array([0.5, 1.2, 1.39, 2.2, 2.339, 2.4]))
    np.testing.assert_allclose(values, [1.0, 1.0, 1.0, 1.0, 1.0, 0.0], atol=0.08)


def test_the_beat_of_a_rest_is_the_one_felt_there() -> None:
    events = fingerings([(at, at + 1.0, {"valve_1": 1.0}) for at in (0.0, 1.5, 3.0)], 0.5)
    changes = ((0, TICKS), (events[2].start_tick, 2 * TICKS))
    values = control_curve(events, press(), changes).sample(np.array([1.25, 2.75]))
    np.testing.assert_allclose(values, [0.0, 1.0], atol=1e-6)


def test_before_the_first_note_and_after_the_last_a_control_is_at_its_own_rest_value() -> None:
    control = press(rest_value=0.25)
    curve = control_curve(fingerings([(1.0, 2.0, {"valve_1": 1.0})]), control, ((0, TICKS),))
    np.testing.assert_array_equal(curve.sample(np.array([-1.0, 0.9, 1.0, 2.0, 2.5])), [0.25, 0.25, 1.0, 1.0, 0.25])


def test_repeated_notes_do_not_lift() -> None:
    events = fingerings([(0.3 * i, 0.3 * i + 0.25, {"valve_1": 1.0}) for i in range(8)])
    values = control_curve(events, press(), ((0, TICKS),)).sample(np.linspace(0.0, events[-1].end_s, 3000))
    np.testing.assert_array_equal(values, 1.0)


def test_a_slide_too_far_for_half_its_note_starts_earlier_but_leaves_the_first_frame() -> None:
    # 0.6 m need 0.24 s; a note of 0.2 s has 0.1 s in its half and 0.1583 s after its first frame at 24 frames/s
    distances, durations_s = np.array([1.0, 1.0, 1.0, 0.05]), np.array([0.2, 0.47, 1.0, 1.0])
    windows_s = window_s(slide(), distances, durations_s, np.zeros(4))
    assert windows_s == pytest.approx([0.2 - 1 / 24, 0.24, 0.24, 0.060])


def test_a_long_move_gathers_speed_while_it_still_looks_in_place() -> None:
    events = fingerings([(0.0, 1.0, {"slide": 0.0}), (1.0, 2.0, {"slide": 1.0})])
    times_s = np.linspace(0.6, 1.0, 40001)
    place_m = control_curve(events, slide(), ((0, TICKS),)).sample(times_s) * 0.6
    assert 0.0 < place_m[np.searchsorted(times_s, 1.0 - 0.24)] < 0.0045
    assert place_m[np.searchsorted(times_s, 1.0 - 0.30)] == 0.0
    speed_m_s = np.gradient(place_m, times_s)
    assert 0.8 * 15 / 8 * 2.5 < speed_m_s.max() < 15 / 8 * 2.5
    # less acceleration than a move that waits for its window: 10 / sqrt(3) d / T²
    assert np.abs(np.gradient(speed_m_s, times_s)).max() < 0.85 * 10 / np.sqrt(3) * 0.6 / 0.24**2


@pytest.mark.parametrize(("control", "window"), [(press(), 0.06), (slide(), 0.3 / 2.5)])
def test_when_its_window_opens_a_control_has_come_as_far_as_no_one_sees(control: Control, window: float) -> None:
    events = fingerings([(0.0, 2.0, {control.name: 0.5}), (2.0, 4.0, {control.name: 1.0})])
    values = control_curve(events, control, ((0, TICKS),)).sample(np.array([2.0 - window, 2.0]))
    unseen = 0.07 if control.kind != "slide" else 0.004 / 0.3
    assert (values - 0.5) / 0.5 == pytest.approx([unseen, 1.0], abs=1e-4)


EASY = slide(unhurried_speed_m_s=0.9)
MOST_M_S = 15 / 8 * 0.9


def slide_motion(events: Sequence[FingeringEvent]) -> tuple[FloatArray, FloatArray]:
    """Positions and speeds of an unhurried slide, 2000 times a second."""
    times_s = np.arange(events[0].start_s - 1.0, events[-1].end_s + 2.0, 0.0005)
    place_m = control_curve(events, EASY, ((0, TICKS),)).sample(times_s) * 0.6
    return times_s, np.abs(np.gradient(place_m, times_s))


@pytest.mark.parametrize("places", [(0.0, 0.8, 0.2, 0.9, 0.1), (0.9, 0.4, 0.9, 0.0, 1.0)])
def test_a_slide_leaves_early_enough_to_be_unhurried_where_half_the_note_before_is_enough(
    places: tuple[float, ...],
) -> None:
    # 0.6 m at 0.9 m/s take 0.67 s; half of a note is 0.7 s.
    events = fingerings([(1.4 * index, 1.4 * index + 1.4, {"slide": place}) for index, place in enumerate(places)])
    _, speeds_m_s = slide_motion(events)
    assert 1.2 < speeds_m_s.max() < MOST_M_S + 0.005
    curve = control_curve(events, EASY, ((0, TICKS),))
    for event, place in zip(events, places, strict=True):
        held = curve.sample(np.linspace(event.start_s, event.start_s + 0.7, 200))
        assert np.abs(held - place).max() * 0.6 < 0.0045


@pytest.mark.parametrize(("length_s", "place"), [(0.192, 0.25), (0.326, 0.43), (0.5, 0.6), (1.0, 1.0)])
def test_a_slide_takes_of_a_notes_tail_what_keeps_the_hand_slow(length_s: float, place: float) -> None:
    # Half of these notes is too short for an unhurried way; two thirds are enough for a peak of 2.05 m/s.
    events = fingerings([(0.0, length_s, {"slide": 0.0}), (length_s, length_s + 2.0, {"slide": place})])
    curve = control_curve(events, EASY, ((0, TICKS),))
    assert 1.95 < slide_motion(events)[1].max() < 2.06
    held = curve.sample(np.linspace(0.0, 0.34 * length_s, 50)) * 0.6
    assert held.max() < 0.0045
    assert curve.sample(np.array([length_s]))[0] == pytest.approx(place, abs=1e-9)


def test_a_detached_note_gives_its_tail_and_the_gap_after_it_to_the_slide() -> None:
    events = fingerings([(0.0, 0.163, {"slide": 0.0}), (0.326, 2.0, {"slide": 0.42})])
    assert slide_motion(events)[1].max() < 2.06


def test_a_note_too_short_even_so_keeps_its_first_quarter() -> None:
    for length_s in (0.38, 0.4, 0.45):
        events = fingerings([(0.0, length_s, {"slide": 0.0}), (length_s, 2.0, {"slide": 1.0})])
        curve = control_curve(events, EASY, ((0, TICKS),))
        assert curve.sample(np.array([0.25 * length_s]))[0] == 0.0
        left, arrived = curve.sample(np.array([0.35 * length_s, length_s])) * 0.6
        assert left < 0.0045
        assert arrived == pytest.approx(0.6, abs=1e-9)


def test_in_a_rest_too_short_to_go_home_and_out_unhurried_a_slide_goes_straight_to_its_next_place() -> None:
    # Home and out again, 0.9 m, would take a second.
    events = fingerings([(0.0, 1.0, {"slide": 0.8}), (1.6, 2.6, {"slide": 0.7}), (4.6, 5.6, {"slide": 0.7})])
    times_s, speeds_m_s = slide_motion(events)
    place = control_curve(events, EASY, ((0, TICKS),)).sample(times_s)
    assert place[(times_s > 0.1) & (times_s < 1.6)].min() > 0.69
    assert place[(times_s > 2.6) & (times_s < 4.6)].min() == 0.0
    assert speeds_m_s.max() < MOST_M_S + 0.005
