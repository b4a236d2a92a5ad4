"""Reading of the rows of numbers after the heading of a BVH file's motion.

Each line is a frame. A row may be broken into several lines, or all numbers may follow each other in lines of any
length if most lines do. Comments and text after the last row are left out and recorded. Any other line that does not
fit is an error, since its numbers would slide into other channels.
"""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.errors import FileError, Message, shortened

COMMENTS: Final = ("#", "//")
"""Beginnings of lines that are left out wherever they are."""
_DECIMAL_COMMA: Final = re.compile(r"[-+]?[0-9]*,[0-9]+(?:[eE][-+]?[0-9]+)?")

Rows = list[list[str]]


def read_rows(text: str, frames: int, width: int, file: str, line: int) -> tuple[FloatArray, tuple[Message, ...]]:
    """Parse the rows of a motion as a table (F, ``width``), with messages about lines that were left out and about
    a number of rows that differs from the stated one.

    Parameters
    ----------
    frames : int
        Number of rows stated in the file.
    line : int
        Line number at which the text begins.

    Raises
    ------
    FileError
        There is no whole row, or a line does not fit.
    """
    rows = [words.split() for words in text.splitlines()]
    left_out = [at for at, words in enumerate(rows) if words and words[0].startswith(COMMENTS)]
    for at in left_out:
        rows[at] = []
    stop = _end_of_numbers(rows)
    if "," in text:
        rows[:stop] = without_commas(rows[:stop], width)
    values = _parsed(rows[:stop])
    if values is None or any(len(words) != width for words in rows[:stop] if words):
        stop = _end(rows, frames, width)
        values = _numbers(rows[:stop], file, line)
    if not width and not len(values):
        return np.zeros((frames, 0)), ()
    whole = _whole_rows(rows[:stop], frames, width, file, line)
    if not whole:
        raise FileError("bvh.truncated", file=file, line=line + max(0, len(rows) - 1))
    after = [at for at in range(stop, len(rows)) if rows[at]]
    cut = len(values) > whole * width or (bool(after) and whole < frames and _is_number(rows[after[0]][0]))
    found = []
    if left_out or (after and not cut):
        found.append(Message("motion.text_ignored", {"line": line + min([*left_out, *after])}))
    if cut:
        found.append(Message("motion.row_cut", {"frames": frames, "found": whole}))
    elif whole != frames:
        found.append(Message("motion.rows", {"frames": frames, "found": whole}))
    return values[: whole * width].reshape(whole, width), tuple(found)


def without_commas(rows: Rows, width: int) -> Rows:
    """Return rows of ``width`` numbers without commas: decimal commas become points, or commas separate numbers.

    If neither gives the right count, the rows are returned unchanged.
    """
    decimal = all("," not in word or _DECIMAL_COMMA.fullmatch(word) for words in rows for word in words)
    if decimal and _fit(rows, width):
        return [[word.replace(",", ".") for word in words] for words in rows]
    parted = [" ".join(words).replace(",", " ").split() for words in rows]
    return parted if _fit(parted, width) else rows


def _fit(rows: Rows, width: int) -> bool:
    """Return whether every row that is not empty has ``width`` words; the last row may be incomplete."""
    filled = [len(words) for words in rows if words]
    return all(count == width for count in filled[:-1] or filled)


def _end_of_numbers(rows: Rows) -> int:
    """Index after the last line that begins with a number."""
    stops = range(len(rows), 0, -1)
    return next((at for at in stops if rows[at - 1] and _is_number(rows[at - 1][0].partition(",")[0])), 0)


def _end(rows: Rows, frames: int, width: int) -> int:
    """Index of the first line after the last row; the number of lines if there is none.

    The rows end at a line that is no row of numbers if the stated number of frames is complete there, or if no full
    row follows a line with other text.
    """
    last_full = max((at for at, words in enumerate(rows) if len(words) == width and _is_row(words)), default=-1)
    full = 0
    for at, words in enumerate(rows):
        if not words:
            continue
        if len(words) == width and _is_row(words):
            full += 1
        elif full and (full >= frames or (at > last_full and not _is_row(words))):
            return at
    return len(rows)


def _whole_rows(rows: Rows, frames: int, width: int, file: str, line: int) -> int:
    """Count the whole frames of the rows; the last one may be incomplete."""
    counts = [(at, len(words)) for at, words in enumerate(rows) if words]
    total = sum(count for _, count in counts)
    in_rows = sum(count for _, count in counts if count == width)
    if total == frames * width and 2 * in_rows < total:
        # Numbers in lines of any length.
        return frames
    start, gathered, whole = 0, 0, 0
    for at, count in counts:
        start = start if gathered else at
        gathered += count
        if gathered > width:
            raise FileError("bvh.row", file=file, line=line + start, found=len(rows[start]), width=width)
        if gathered == width:
            gathered, whole = 0, whole + 1
    return whole


def _numbers(rows: Rows, file: str, line: int) -> FloatArray:
    values = _parsed(rows)
    if values is None:
        all_words = ((at, word) for at, words in enumerate(rows) for word in words)
        bad, word = next((at, word) for at, word in all_words if not _is_number(word))
        raise FileError("bvh.number", file=file, line=bad + line, found=shortened(word, 40))
    return values


def _parsed(rows: Rows) -> FloatArray | None:
    """Return all numbers of the rows (N,); None if a word is no finite number."""
    try:
        values = np.array([word for words in rows for word in words], dtype=np.float64)
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


def _is_row(words: list[str]) -> bool:
    return all(map(_is_number, words))


def _is_number(word: str) -> bool:
    try:
        return bool(np.isfinite(float(word)))
    except ValueError:
        return False
