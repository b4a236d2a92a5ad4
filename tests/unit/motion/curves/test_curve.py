from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.curves.curve import Envelopes, Noise, bump, frame_times, minimum_jerk, moves, rows_changed_s
from app.motion.curves.seeded_chance import generator


def test_frame_times_do_not_drift_at_an_ntsc_rate() -> None:
    times_s = frame_times(-2.0, Fraction(30000, 1001), 0, 30_000 * 10 + 1)
    exact = [float(Fraction(-2) + Fraction(n * 1001, 30000)) for n in (0, 1, 299_999, 300_000)]
    np.testing.assert_allclose(times_s[[0, 1, 299_999, 300_000]], exact, rtol=0, atol=1e-11)


def test_minimum_jerk_against_its_derivatives() -> None:
    u = np.linspace(0.0, 1.0, 100_001)
    speed = np.gradient(minimum_jerk(u), u)
    assert speed.max() == pytest.approx(15 / 8, rel=1e-6)
    assert np.abs(np.gradient(speed, u)[1:-1]).max() == pytest.approx(10 / np.sqrt(3), rel=1e-4)


def slow_value(segments: list[tuple[float, float, float]], initial: float, time_s: float) -> float:
    """Value at one time, calculated segment by segment."""
    value = initial
    for start_s, end_s, target in segments:
        if time_s < start_s:
            break
        u = min((time_s - start_s) / (end_s - start_s), 1.0)
        value = value + (target - value) * (10 * u**3 - 15 * u**4 + 6 * u**5)
    return value


@given(
    st.lists(st.tuples(st.floats(0.0, 1.0), st.floats(0.01, 1.0), st.floats(-1.0, 1.0)), max_size=8),
    st.floats(-1.0, 1.0),
    st.lists(st.floats(-1.0, 10.0), max_size=30),
)
def test_a_curve_equals_the_obvious_way(
    rows: list[tuple[float, float, float]], initial: float, times: list[float]
) -> None:
    segments, time_s = [], 0.0
    for gap_s, length_s, value in rows:
        segments.append((time_s + gap_s, time_s + gap_s + length_s, value))
        time_s += gap_s + length_s
    times_s = np.sort(np.array(times, dtype=np.float64))
    expected = [slow_value(segments, initial, float(t)) for t in times_s]
    np.testing.assert_allclose(moves(segments, initial).sample(times_s), expected, atol=1e-12)


def test_overlapping_moves_are_refused() -> None:
    with pytest.raises(ValueError, match="overlaps"):
        moves([(0.0, 1.0, 1.0), (0.9, 2.0, 0.0)])


def test_of_overlapping_envelopes_the_higher_counts() -> None:
    envelopes = Envelopes.of([(0.0, 1.0, 4.0, 5.0, 0.5), (2.0, 2.5, 2.6, 3.0, 0.9)])
    values = envelopes.sample(np.array([-1.0, 0.5, 1.5, 2.55, 3.5, 4.5, 6.0]))
    np.testing.assert_allclose(values, [0.0, 0.25, 0.5, 0.9, 0.5, 0.25, 0.0], atol=1e-12)


def test_the_acceleration_of_a_bump_peaks_at_its_centre_only() -> None:
    times_s = np.linspace(0.0, 2.0, 20_001)
    acceleration = np.abs(np.gradient(np.gradient(bump(times_s, 1.1, 0.4), times_s), times_s))[2:-2]
    assert times_s[2:-2][acceleration.argmax()] == pytest.approx(1.1, abs=2e-4)
    assert acceleration.max() == pytest.approx(8 / 0.4**2, rel=1e-4)
    away = np.abs(times_s[2:-2] - 1.1) > 0.2
    assert acceleration[away].max() < 0.66 * acceleration.max()


def test_noise_has_unit_rms_and_stays_in_its_band() -> None:
    times_s = np.arange(0.0, 2000.0, 0.1)
    values = Noise.of(generator("someone", 1), 0.1, 0.6).sample(times_s)
    assert np.sqrt(np.mean(values**2)) == pytest.approx(1.0, abs=0.02)
    power = np.abs(np.fft.rfft(values)) ** 2
    frequency_hz = np.fft.rfftfreq(len(values), 0.1)
    assert power[(frequency_hz > 0.09) & (frequency_hz < 0.61)].sum() > 0.999 * power.sum()


def test_seeds_depend_on_every_name() -> None:
    draws = [generator(*names).random() for names in [("a", 1), ("a", 2), ("b", 1), ("a1",), ("a", "1")]]
    assert len({*draws[:4]}) == 4
    assert draws[0] == draws[4]


@given(*2 * [st.lists(st.integers(0, 9), max_size=8, unique=True)])
def test_what_changed_in_a_table_is_every_row_that_one_has_alone(mine: list[int], others: list[int]) -> None:
    one, other = (np.array([(value, 2.0 * value) for value in values]).reshape(-1, 2) for values in (mine, others))
    found = {tuple(row) for row in rows_changed_s(one, other, one, other + 100.0).tolist()}
    alone = {(value, 2.0 * value) for value in set(mine) - set(others)}
    assert found == alone | {(value + 100.0, 2.0 * value + 100.0) for value in set(others) - set(mine)}
