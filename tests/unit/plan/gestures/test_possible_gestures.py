"""Spans in which the instrument is off the lips, requested one by one and all together."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from app.plan.gestures.possible_gestures import LoweredSpans

TIMES = st.integers(0, 12).map(float)
SPANS = st.lists(st.tuples(TIMES, TIMES), max_size=8).map(tuple)


@given(SPANS, TIMES, TIMES, st.integers(0, 3).map(float), st.integers(0, 3).map(float))
def test_many_spans_are_found_as_if_each_was_looked_at(
    spans: tuple[tuple[float, float], ...], start_s: float, end_s: float, down_s: float, up_s: float
) -> None:
    lowered = LoweredSpans(spans)
    inside = any(first_s + down_s <= start_s and end_s <= last_s - up_s for first_s, last_s in spans)
    assert lowered.hold(start_s, end_s, down_s, up_s) == inside
    assert lowered.end_between(start_s, end_s) == any(first_s <= start_s < last_s < end_s for first_s, last_s in spans)
