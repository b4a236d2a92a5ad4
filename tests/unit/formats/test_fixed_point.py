from __future__ import annotations

from decimal import Decimal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_numpy

from app.formats.fixed_point import table_text

SMALL = st.floats(-2146, 2146) | st.sampled_from([0.0, -0.0, 1e-7, -4e-7, 0.9999996, -999.9999996, 1000.0, 9.9999999])
LARGE = st.floats(-9.9e8, 9.9e8)


def _slowly(values: np.ndarray) -> bytes:
    """Convert one number after another with Python's decimals."""
    lines = []
    for row in values.tolist():
        millionths = [Decimal(round(value * 1e6)).scaleb(-6) for value in row]
        lines.append(" ".join(format(value.quantize(Decimal("1e-6")), "f") for value in millionths))
    return "".join(line + "\n" for line in lines).encode()


@given(st_numpy.arrays(np.float64, st.tuples(st.integers(1, 4), st.integers(1, 5)), elements=SMALL | LARGE))
@settings(max_examples=300, deadline=None)
def test_digits_are_pythons(values: np.ndarray) -> None:
    assert b"".join(table_text(values)) == _slowly(values)


@given(st_numpy.arrays(np.float64, st.tuples(st.integers(1, 4), st.integers(1, 5)), elements=SMALL))
@settings(max_examples=300, deadline=None)
def test_digits_of_small_numbers_are_pythons(values: np.ndarray) -> None:
    assert b"".join(table_text(values)) == _slowly(values)


def test_large_tables_are_written_whole() -> None:
    values = np.random.default_rng(1).normal(scale=90, size=(3000, 30))
    text = b"".join(table_text(values))
    np.testing.assert_allclose(np.loadtxt(text.decode().splitlines()), values, atol=0.5000001e-6)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e9])
def test_what_has_no_such_text_is_refused(value: float) -> None:
    with pytest.raises(ValueError, match="finite"):
        table_text(np.array([[0.0, value]]))


def test_a_table_without_columns_is_empty_lines() -> None:
    assert b"".join(table_text(np.empty((3, 0)))) == b"\n\n\n"
