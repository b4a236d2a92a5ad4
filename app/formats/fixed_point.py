"""Tables of numbers -> decimal text, digit by digit in arrays, many times faster than formatting each number."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

DECIMALS = 6
_SCALE = 10**DECIMALS

# The three digits of 0 to 999.
_TRIPLES = np.array([list(b"%03d" % n) for n in range(1000)], dtype=np.uint8)

# Numbers worked on at once: their digits stay in a core's cache.
_BLOCK = 16384


def table_text(values: npt.NDArray[np.floating]) -> list[bytes]:
    """Text of a table: rows on lines, numbers with `DECIMALS` decimals and one blank between them.

    Parameters
    ----------
    values : ndarray, shape (R, C)
        Finite, smaller than 1e9.

    Returns
    -------
    list of bytes
        Pieces of the text, in order; together they end with a line break.

    Raises
    ------
    ValueError
        If a value is not finite or too large.
    """
    rows, columns = values.shape
    if not columns:
        return [b"\n" * rows]
    step = max(1, _BLOCK // columns)
    return [_block_text(np.asarray(values[first : first + step], dtype=np.float64)) for first in range(0, rows, step)]


def _block_text(values: npt.NDArray[np.float64]) -> bytes:
    largest = np.abs(values).max(initial=0.0)
    if not largest < 1e9:
        raise ValueError("a value is not finite or not below 1e9")
    scaled = np.rint(values * _SCALE).astype(np.int64)
    negative = scaled < 0
    np.abs(scaled, out=scaled)
    # 32-bit division is several times faster; it holds for what is below 2147.
    digits = scaled.astype(np.int32) if largest < 2147.0 else scaled
    thousandths, low = np.divmod(digits, 1000)
    whole, high = np.divmod(thousandths, 1000)
    groups = 1 + max(0, (len(str(int(whole.max(initial=0)))) - 1) // 3)

    width = 1 + 3 * groups + 1 + DECIMALS + 1
    text = np.empty((*values.shape, width), dtype=np.uint8)
    text[..., 0] = np.where(negative, ord("-"), 0)
    rest = whole
    for group in range(groups, 0, -1):
        rest, triple = np.divmod(rest, 1000) if group > 1 else (rest, rest)
        text[..., 3 * group - 2 : 3 * group + 1] = _TRIPLES[triple]
    for place in range(3 * groups - 1):  # leading zeros but the last
        leading = text[..., 1 + place]
        leading[whole < 10 ** (3 * groups - 1 - place)] = 0
    text[..., 3 * groups + 1] = ord(".")
    text[..., 3 * groups + 2 : 3 * groups + 5] = _TRIPLES[high]
    text[..., 3 * groups + 5 : 3 * groups + 8] = _TRIPLES[low]
    text[..., -1] = ord(" ")
    text[:, -1, -1] = ord("\n")
    flat = text.reshape(-1)
    return bytes(flat[flat != 0])
