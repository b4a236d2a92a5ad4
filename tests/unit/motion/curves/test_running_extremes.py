"""Running maxima and minima compared with scipy's."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from app.arrays import FloatArray
from app.motion.contacts.shares_of_help import greatest_within, least_within

finite = st.floats(-10.0, 10.0)


@given(arrays(np.float64, st.integers(1, 40), elements=finite), st.integers(0, 60))
def test_they_are_those_of_scipy(values: FloatArray, half: int) -> None:
    np.testing.assert_array_equal(greatest_within(values, half), maximum_filter1d(values, 2 * half + 1))
    np.testing.assert_array_equal(least_within(values, half), minimum_filter1d(values, 2 * half + 1))
