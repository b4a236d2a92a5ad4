from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from app.formats.fbx import ticks
from app.formats.rates import exact_rate

# Ticks of a frame as the FBX SDK has them (FbxTime::GetOneFrameValue).
EXACT = {24: 1924423250, 25: 1847446320, 30: 1539538600, 50: 923723160, 60: 769769300, 120: 384884650}
FRACTIONAL = [Fraction(24000, 1001), Fraction(30000, 1001), Fraction(60000, 1001)]


@pytest.mark.parametrize("fps", EXACT)
def test_whole_rates_have_whole_ticks(fps: int) -> None:
    np.testing.assert_array_equal(ticks.frame_ticks(Fraction(fps), 1000), np.arange(1000) * EXACT[fps])


@pytest.mark.parametrize("fps", [*FRACTIONAL, Fraction(37, 3)])
def test_other_rates_are_rounded_frame_by_frame(fps: Fraction) -> None:
    found = ticks.frame_ticks(fps, 200_000)
    for frame in (0, 1, 2, 1000, 1001, 99_999, 199_999):
        exact = Fraction(46186158000) * frame / fps
        assert abs(int(found[frame]) - exact) <= Fraction(1, 2)


@pytest.mark.parametrize("fps", [*map(Fraction, (24, 25, 30, 48, 50, 60, 72, 96, 100, 120, 1000)), *FRACTIONAL])
def test_named_rates_have_a_mode_of_their_own(fps: Fraction) -> None:
    mode = ticks.time_mode(fps)
    assert mode != ticks.CUSTOM_TIME_MODE
    assert ticks.rate(mode, 0.0) == fps


@pytest.mark.parametrize("fps", [Fraction(15), Fraction(37, 2), Fraction(12000, 1001), Fraction(240)])
def test_other_rates_are_custom(fps: Fraction) -> None:
    assert ticks.time_mode(fps) == ticks.CUSTOM_TIME_MODE
    assert ticks.rate(ticks.CUSTOM_TIME_MODE, float(fps)) == fps


@pytest.mark.parametrize(("mode", "custom"), [(0, 0.0), (99, 0.0), (14, 0.0), (14, -1.0), (14, float("nan"))])
def test_no_rate_is_no_rate(mode: int, custom: float) -> None:
    assert ticks.rate(mode, custom) is None


@pytest.mark.parametrize("fps", [*FRACTIONAL, Fraction(24), Fraction(60), Fraction(1, 2), Fraction(25, 2)])
def test_a_rounded_rate_is_understood(fps: Fraction) -> None:
    assert exact_rate(float(f"{float(fps):.7g}")) == fps
