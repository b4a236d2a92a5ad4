"""Fingers with several keys are over a key before pressing it, and never leave a pressed key."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import FloatArray
from app.motion.fingering.control_curves import control_curves
from app.motion.fingering.finger_curves import HOME_S, raised_curve, sampled, station_curves
from app.plan.model import FingeringEvent
from app.rig.grip.finger_stations import stations, stations_of_notes
from app.rig.grip.grip_pose import StationBlend, giving_for
from instrument_maps.load import load_map
from instrument_maps.model import InstrumentMap
from tests.support import pipe
from tests.unit.motion.events import TICKS, fingerings

LITTLE = {"key_E": 0, "key_F": 1, "key_G": 2}


@pytest.fixture(scope="module")
def made_up(tmp_path_factory: pytest.TempPathFactory) -> InstrumentMap:
    path: Path = pipe.add(tmp_path_factory.mktemp("maps"))
    return load_map(path)


def little(
    events: tuple[FingeringEvent, ...], instrument: InstrumentMap, times_s: np.ndarray, name: str = "right.little"
) -> tuple[StationBlend, dict[str, FloatArray]]:
    curves = control_curves(events, instrument.controls, ((0, TICKS),))
    where = sampled(station_curves(events, instrument, curves)[name], times_s)
    return where, {name: curves[name].sample(times_s) for name in LITTLE}


def share_at(where: StationBlend, place: int) -> np.ndarray:
    return (where.after == place) * where.share + (where.before == place) * (1.0 - where.share)


def steps_of(steps: list[tuple[str | None, float, float]]) -> list[tuple[float, float, dict[str, float]]]:
    rows, time_s = [], 0.2
    for key, length_s, gap_s in steps:
        rows.append((time_s, time_s + length_s, {} if key is None else {key: 1.0}))
        time_s += length_s + gap_s
    return rows


def test_a_finger_goes_straight_to_a_key_it_needs_soon_and_home_where_it_has_time(made_up: InstrumentMap) -> None:
    rows = [(0.0, 0.5, {"key_F": 1.0}), (0.5, 1.0, {}), (1.0, 1.5, {"key_G": 1.0}), (5.0, 5.5, {"key_F": 1.0})]
    times_s = np.arange(-1.0, 7.0, 0.01)
    where, _ = little(fingerings(rows), made_up, times_s)
    at = dict(zip(np.round(times_s, 2).tolist(), zip(*map(np.ndarray.tolist, where), strict=True), strict=True))
    assert at[-0.9] == (0.0, 0.0, 1.0)
    assert at[0.2] == (1.0, 1.0, 1.0)
    assert {pair[:2] for time_s, pair in at.items() if 0.5 < time_s < 1.0} == {(1.0, 1.0), (1.0, 2.0), (2.0, 2.0)}
    assert at[1.2] == (2.0, 2.0, 1.0)
    assert at[3.0] == (0.0, 0.0, 1.0)
    assert at[5.2] == (1.0, 1.0, 1.0)
    assert at[6.8] == (0.0, 0.0, 1.0)


def test_repeated_notes_keep_a_finger_where_it_is(made_up: InstrumentMap) -> None:
    rows = [(0.3 * step, 0.3 * step + 0.25, {"key_G": 1.0}) for step in range(8)]
    times_s = np.arange(0.0, 2.3, 0.01)
    where, _ = little(fingerings(rows), made_up, times_s)
    assert set(where.after.tolist()) == {2.0}
    assert set(where.share.tolist()) == {1.0}


def test_a_player_who_plays_nothing_keeps_every_finger_at_home(made_up: InstrumentMap) -> None:
    where, _ = little((), made_up, np.arange(0.0, 1.0, 0.1))
    assert set(where.after.tolist()) == {0.0}


STEPS = st.lists(
    st.tuples(
        st.sampled_from([None, *LITTLE]), st.floats(0.09, 0.8), st.sampled_from([0.0, 0.0, 0.05, 0.3, HOME_S, 2.5])
    ),
    min_size=1,
    max_size=14,
)


@given(steps=STEPS)
@settings(max_examples=80, deadline=None)
def test_a_key_that_is_down_has_its_finger_on_it(
    made_up: InstrumentMap, steps: list[tuple[str | None, float, float]]
) -> None:
    events = fingerings(steps_of(steps))
    times_s = np.arange(-1.0, events[-1].end_s + 3.5, 1.0 / 240.0)
    where, values = little(events, made_up, times_s)
    for name, place in LITTLE.items():
        assert share_at(where, place)[values[name] > 0.97].min(initial=1.0) > 0.99
    assert stations(made_up)["right.little"][0].controls == ("key_E",)
    assert len(stations_of_notes(made_up, ((e.controls, e.fingers) for e in events))["right.little"]) == len(events)


@given(steps=STEPS)
@settings(max_examples=80, deadline=None)
def test_a_hand_gives_way_while_the_key_is_down_and_for_nothing_else(
    made_up: InstrumentMap, steps: list[tuple[str | None, float, float]]
) -> None:
    events = fingerings(steps_of(steps))
    times_s = np.arange(-1.0, events[-1].end_s + 3.5, 1.0 / 240.0)
    giving, values = little(events, made_up, times_s, giving_for("right.little"))
    for name, place in LITTLE.items():
        if not place:  # home asks nothing of the hand
            continue
        share = share_at(giving, place)
        assert share[values[name] > 0.99].min(initial=1.0) > 0.95
        # It does not go ahead of the key.
        moving = np.flatnonzero(np.diff(share) > 1e-9)
        assert (values[name][moving + 1] > 0.0).all()


def test_a_hand_stays_where_the_next_note_needs_it_again(made_up: InstrumentMap) -> None:
    rows = [(0.12 * step, 0.12 * step + 0.12, {"key_G": 1.0} if step % 2 else {}) for step in range(9)]
    times_s = np.arange(0.12, 0.9, 0.01)
    giving, values = little(fingerings(rows), made_up, times_s, giving_for("right.little"))
    assert set(giving.after.tolist()) == {2.0}
    assert set(giving.share.tolist()) == {1.0}
    assert values["key_G"].min() == 0.0


def test_a_hand_has_given_way_by_the_onset_of_a_key_that_came_up_in_a_rest(made_up: InstrumentMap) -> None:
    """The previous note uses the same key with others: it is released with them and then pressed alone."""
    rows = [(0.0, 0.25, {"hole_T": 1.0, "key_Reg": 1.0}), (1.0, 2.0, {"key_Reg": 1.0})]
    events = fingerings(rows)
    controls = control_curves(events, made_up.controls, ((0, TICKS),))
    assert controls["key_Reg"].sample(np.array([0.6]))[0] == 0.0
    curves = station_curves(events, made_up, controls)
    at_s = np.array([0.6, 1.0, 1.5])
    assert share_at(sampled(curves[giving_for("left.thumb")], at_s), 1).tolist() == [0.0, 1.0, 1.0]
    assert share_at(sampled(curves["left.thumb"], at_s), 1)[1:].tolist() == [1.0, 1.0]


@pytest.mark.parametrize(("between", "kept"), [({"hole_T": 1.0}, True), ({"key_Reg": 1.0}, False)])
def test_a_hand_does_not_stay_where_another_finger_goes_away_from_home_meanwhile(
    made_up: InstrumentMap, between: dict[str, float], kept: bool
) -> None:
    lever = {"hole_T": 1.0, "key_D": 1.0}
    events = fingerings([(0.0, 0.12, lever), (0.12, 0.24, between), (0.24, 0.36, lever)])
    controls = control_curves(events, made_up.controls, ((0, TICKS),))
    curve = station_curves(events, made_up, controls)[giving_for("left.little")]
    assert share_at(sampled(curve, np.array([0.06, 0.14, 0.30])), 1).round(3).tolist() == [1.0, float(kept), 1.0]


def test_a_part_of_the_curves_is_that_of_the_whole(made_up: InstrumentMap) -> None:
    rows = [(0.25 * step, 0.25 * step + 0.25, {f"key_{'EFG'[step % 3]}": 1.0}) for step in range(12)]
    times_s = np.arange(-0.5, 4.0, 0.01)
    whole, _ = little(fingerings(rows), made_up, times_s)
    part, _ = little(fingerings(rows), made_up, times_s[130:200])
    for mine, others in zip(part, whole, strict=True):
        np.testing.assert_array_equal(mine, others[130:200])


def test_fingers_wait_higher_in_fast_passages() -> None:
    slow = [(0.5 * step, 0.5 * step + 0.5, {}) for step in range(12)]
    fast = [(6.0 + 0.1 * step, 6.1 + 0.1 * step, {}) for step in range(40)]
    raised = raised_curve(fingerings([*slow, *fast])).sample(np.array([2.0, 9.0]))
    assert raised[0] == pytest.approx(0.0, abs=0.01)
    assert raised[1] == pytest.approx(1.0, abs=0.01)
