"""Neighbouring values of arrays."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import rows_of, running_medians


@given(st.lists(st.integers(-9, 9), min_size=9, max_size=30), st.sampled_from([1, 3, 5, 9]))
def test_running_medians_are_those_of_numpy(values: list[int], count: int) -> None:
    given_values = np.array(values)
    windows = np.lib.stride_tricks.sliding_window_view(given_values, count)
    np.testing.assert_array_equal(rows_of(given_values, count).T, windows)
    np.testing.assert_array_equal(running_medians(given_values, count), np.median(windows, axis=1))
    np.testing.assert_array_equal(given_values, values, "given values stay")
