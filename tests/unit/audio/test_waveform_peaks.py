"""The waveform display compared with a slow direct calculation."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.audio.waveform_peaks import BASE_SAMPLES, Peaks

RATE_HZ = 48000
NOISE = np.random.default_rng(1).integers(-32768, 32767, (200_000, 2), dtype=np.int16)
PEAKS = Peaks(NOISE, RATE_HZ)


@settings(deadline=None, max_examples=60)
@given(start_s=st.floats(-1.0, 4.5), span_s=st.floats(1e-4, 6.0), width_px=st.integers(1, 700))
def test_a_column_holds_its_extremes_and_no_more_than_its_surroundings(
    start_s: float, span_s: float, width_px: int
) -> None:
    low, high = PEAKS.levels(start_s, start_s + span_s, width_px)
    edges = np.linspace(start_s, start_s + span_s, width_px + 1) * RATE_HZ
    slack = max((edges[1] - edges[0]), BASE_SAMPLES)
    for column in (0, width_px // 2, width_px - 1):
        begin, end = int(np.ceil(max(edges[column], 0))), int(np.floor(edges[column + 1]))
        if end > begin and begin < len(NOISE):
            inner = NOISE[begin:end]
            assert low[column] <= inner.min() / 32768 + 1e-6
            assert high[column] >= inner.max() / 32768 - 1e-6
        outer = NOISE[max(int(edges[column] - slack - 1), 0) : max(int(edges[column + 1] + slack + 2), 0)]
        if len(outer):
            assert low[column] >= min(outer.min() / 32768, 0) - 1e-6
            assert high[column] <= max(outer.max() / 32768, 0) + 1e-6
        else:
            assert low[column] == high[column] == 0.0


def test_a_single_click_is_seen_at_every_zoom() -> None:
    samples = np.zeros((RATE_HZ * 60, 1), np.int16)
    samples[RATE_HZ * 30] = 20000
    peaks = Peaks(samples, RATE_HZ)
    assert peaks.duration_s == 60.0
    for span_s in (0.001, 0.1, 1.0, 10.0, 50.0):
        _, high = peaks.levels(30.0 - span_s / 3, 30.0 + span_s, 800)
        assert high.max() == pytest.approx(20000 / 32768)
        assert np.count_nonzero(high) <= 3 + 800 / (span_s * 4 / 3 * RATE_HZ)


@pytest.mark.parametrize("at", [0, -1], ids=["first", "last"])
def test_a_click_at_an_end_of_the_recording_is_seen_at_every_zoom(at: int) -> None:
    samples = np.zeros((RATE_HZ * 10 + 1, 1), np.int16)
    samples[at] = 20000
    peaks = Peaks(samples, RATE_HZ)
    end_s = 0.0 if at == 0 else peaks.duration_s
    for span_s in (0.001, 0.1, 1.0, 9.0):
        _, high = peaks.levels(end_s - span_s, end_s + span_s, 800)
        assert high.max() == pytest.approx(20000 / 32768), span_s


def test_nothing_to_show() -> None:
    empty = Peaks(np.zeros((0, 2), np.int16), RATE_HZ)
    assert empty.duration_s == 0.0
    assert [part.tolist() for part in empty.levels(0.0, 1.0, 3)] == [[0.0] * 3, [0.0] * 3]
    assert PEAKS.levels(1.0, 1.0, 4)[0].tolist() == [0.0] * 4
    assert len(PEAKS.levels(0.0, 1.0, 0)[0]) == 0
