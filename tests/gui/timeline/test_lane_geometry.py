"""Rows, visible spans and curves by column compared with slow direct calculations."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from widgets.timeline.model.geometry import StepCurve, TimeSpans, packed_rows, step_path

spans = st.lists(st.tuples(st.integers(0, 60), st.integers(1, 30)), max_size=25).map(
    lambda rows: sorted((start, start + length) for start, length in rows)
)


def arrays(rows: list[tuple[int, int]]) -> tuple[np.ndarray, np.ndarray]:
    table = np.array(rows, np.float64).reshape(-1, 2)
    return table[:, 0], table[:, 1]


@given(spans)
def test_no_two_spans_of_a_row_meet_and_no_row_is_wasted(rows: list[tuple[int, int]]) -> None:
    found = packed_rows(*arrays(rows)).tolist()
    for one, (start, end) in enumerate(rows):
        for other, (begin, finish) in enumerate(rows):
            if one < other and found[one] == found[other]:
                assert end <= begin or finish <= start
    most = max((sum(begin <= at < finish for begin, finish in rows) for at in range(100)), default=0)
    assert len(set(found)) == most


@given(spans, st.integers(-5, 95), st.integers(0, 40))
def test_visible_spans_are_those_that_meet_the_range(rows: list[tuple[int, int]], start: int, length: int) -> None:
    found = TimeSpans(*arrays(rows)).between(float(start), float(start + length)).tolist()
    assert found == [i for i, (begin, end) in enumerate(rows) if begin <= start + length and end >= start]


@settings(deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, 100), st.floats(0, 1)), max_size=40, unique_by=lambda row: row[0]),
    st.integers(-20, 100),
    st.integers(1, 50),
    st.integers(1, 30),
)
def test_columns_hold_the_extremes_of_the_steps(
    rows: list[tuple[int, float]], start: int, length: int, width_px: int
) -> None:
    rows.sort()
    steps = StepCurve(np.array([row[0] for row in rows], np.float64), np.array([row[1] for row in rows], np.float64))
    low, high = steps.columns(float(start), float(start + length), width_px)
    edges = np.linspace(start, start + length, width_px + 1)
    for column in range(width_px):
        begin, end = edges[column], edges[column + 1]
        before = [value for at, value in rows if at <= begin][-1:]
        values = before + [value for at, value in rows if begin < at < end]
        if values:
            assert (low[column], high[column]) == (min(values), max(values))
        else:
            assert np.isnan(low[column])
            assert np.isnan(high[column])


def test_a_path_goes_through_both_extremes_of_every_column() -> None:
    low, high = np.array([0.1, 0.2, 0.5]), np.array([0.1, 0.6, 0.5])
    points = step_path(low, high)
    assert points[:, 0].tolist() == [0, 0, 1, 1, 2, 2]
    assert points[2:4, 1].tolist() == [0.2, 0.6]


def test_many_values_are_few_points() -> None:
    time_s = np.arange(216_000) / 100.0
    low, high = StepCurve(time_s, np.sin(time_s)).columns(0.0, 2160.0, 1500)
    assert len(low) == len(high) == 1500
    assert low.min() < -0.999
    assert high.max() > 0.999
