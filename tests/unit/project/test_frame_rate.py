"""Frame rates as typed and displayed."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.project import limits
from app.project.frame_rate import USUAL_RATES, exact_number, frame_rate, frame_rate_text


@pytest.mark.parametrize(
    ("typed", "rate"),
    [
        ("24", Fraction(24)),
        ("29.970", Fraction(30000, 1001)),
        ("23.98", Fraction(24000, 1001)),
        ("59.94", Fraction(60000, 1001)),
        (" 2997/100 ", Fraction(2997, 100)),
        ("60.0", Fraction(60)),
        ("12.5", Fraction(25, 2)),
        ("２９．９７", Fraction(30000, 1001)),
        ("３００００／１００１", Fraction(30000, 1001)),
    ],
)
def test_what_is_typed(typed: str, rate: Fraction) -> None:
    assert frame_rate(typed) == rate


def test_usual_rates_are_shown_as_usually_written() -> None:
    shown = [frame_rate_text(rate) for rate in USUAL_RATES]
    assert shown == ["23.976", "24", "25", "29.97", "30", "48", "50", "59.94", "60", "120"]


@given(st.fractions(*limits.FPS, max_denominator=10_000))
def test_what_is_shown_is_read_back(rate: Fraction) -> None:
    assert frame_rate(frame_rate_text(rate)) == rate


@pytest.mark.parametrize("typed", ["", "fast", "30/", "1/0", "1e999999999", "１ｅ9", "nan", "inf"])
def test_what_is_no_number(typed: str) -> None:
    with pytest.raises((ValueError, ZeroDivisionError)):
        exact_number(typed)
