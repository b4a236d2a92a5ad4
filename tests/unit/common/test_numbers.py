"""Numbers as users type and read them."""

from __future__ import annotations

import pytest

from widgets.common.numbers import number_from, number_text


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.5", 0.5),
        (" 1/3 ", 1 / 3),
        ("-2", -2.0),
        ("−2", -2.0),
        ("2*(4+0.5)", 9.0),
        ("0,25", 0.25),
        ("１２．５", 12.5),
        ("1.5 beats", 1.5),
        ("1.5拍", 1.5),
        (".5", 0.5),
    ],
)
def test_what_is_typed_is_understood(text: str, value: float) -> None:
    unit = "拍" if "拍" in text else "beats"
    assert number_from(text, unit) == pytest.approx(value)


@pytest.mark.parametrize(
    "text", ["", "x", "1/0", "9**9**9", "__import__('os')", "True", "1e400", "1 2", "(" * 200, "—", "[1]", "1" * 90]
)
def test_what_is_no_number_is_refused(text: str) -> None:
    assert number_from(text) is None


def test_numbers_are_written_with_their_decimals() -> None:
    assert number_text(0.5, 2) == "0.50"
    assert number_text(-0.001, 2) == "0.00"
    assert number_text(-1.5, 1) == "−1.5"
    assert number_text(12.6, 0) == "13"
