"""Peaks found without `scipy.signal` equal scipy's to the bit."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import find_peaks

from app.choreography.peaks import prominent_peaks

FEW_LEVELS = st.lists(st.integers(0, 6).map(float), max_size=60)
ANY = st.lists(st.floats(-1e3, 1e3), max_size=60)


@given(st.one_of(FEW_LEVELS, ANY), st.sampled_from([1e-6, 0.5, 2.0]))
def test_peaks_are_those_of_scipy(drawn: list[float], least: float) -> None:
    values = np.array(drawn, np.float64)
    peaks, prominences = prominent_peaks(values, least)
    expected, found = find_peaks(values, prominence=least)
    np.testing.assert_array_equal(peaks, expected)
    np.testing.assert_array_equal(prominences, found["prominences"])


def test_a_curve_of_many_peaks_is_gone_through_once() -> None:
    values = np.sin(np.arange(60_000) * 0.2) * np.linspace(1.0, 2.0, 60_000)
    peaks, prominences = prominent_peaks(values, 1e-6)
    expected, found = find_peaks(values, prominence=1e-6)
    np.testing.assert_array_equal(peaks, expected)
    np.testing.assert_array_equal(prominences, found["prominences"])


@pytest.mark.parametrize("module", ["app.choreography.performed.dancers", "app.choreography.music_offset"])
def test_a_dance_needs_no_signal_processing(module: str) -> None:
    code = (
        f"import sys, numpy as np, {module}; from app.choreography.music_offset import speed_minima;"
        "speed_minima(np.sin(np.arange(99.0)), 30.0, 0.01); sys.exit('scipy.signal' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
