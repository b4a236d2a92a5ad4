"""What a person types."""

from __future__ import annotations

import argparse
from fractions import Fraction

import pytest

from app.cli.options import beats, frame_rate, frame_rate_text, whole_number


@pytest.mark.parametrize(
    ("typed", "rate"),
    [
        ("24", Fraction(24)),
        ("25", Fraction(25)),
        ("29.97", Fraction(30000, 1001)),
        ("29.970", Fraction(30000, 1001)),
        ("23.976", Fraction(24000, 1001)),
        ("23.98", Fraction(24000, 1001)),
        ("59.94", Fraction(60000, 1001)),
        ("30000/1001", Fraction(30000, 1001)),
        ("2997/100", Fraction(2997, 100)),
        ("30", Fraction(30)),
        ("60.0", Fraction(60)),
        ("12.5", Fraction(25, 2)),
        ("120", Fraction(120)),
    ],
)
def test_frame_rates(typed: str, rate: Fraction) -> None:
    assert frame_rate(typed) == rate
    assert frame_rate(frame_rate_text(rate)) == rate


@pytest.mark.parametrize("typed", ["0", "-30", "1000", "nan", "inf", "fast", "1/0", "", "30/", "1e400"])
def test_what_is_no_frame_rate(typed: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError):
        frame_rate(typed)


@pytest.mark.parametrize("typed", ["-1", "1.5", "x", "", "1e3", "9" * 30])
def test_what_is_no_whole_number(typed: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError):
        whole_number(typed)


@pytest.mark.parametrize("typed", ["-1", "nan", "inf", "x", "65"])
def test_what_are_no_beats(typed: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError):
        beats(typed)


def test_numbers() -> None:
    assert whole_number("12") == 12
    assert beats("2.5") == 2.5
