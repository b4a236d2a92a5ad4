"""Widths of text in a terminal, where Japanese characters take two columns: padding and line breaking."""

from __future__ import annotations

import re
import unicodedata
from typing import Final

_WORDS: Final = re.compile(r"\s+|[!-\u2e7f\ufb00-\ufdff\ufe70-\ufefe]+|[ァ-ヺー]{1,12}|.", re.DOTALL)
"""Units of line breaking: blanks, words of narrow characters, katakana words, single wide characters."""
_NOT_FIRST: Final = frozenset(":;,.!?)、。，．・：；！？）」』】〕～ーぁぃぅぇぉっゃゅょァィゥェォッャュョ々")
"""Characters that must not begin a line (JIS X 4051)."""
_NOT_LAST: Final = frozenset("（「『【〔")
"""Characters that must not end a line."""


def width(text: str) -> int:
    """Return the number of columns of a text: two for each wide East Asian character."""
    if text.isascii():
        return len(text)
    return sum(
        0 if unicodedata.combining(character) else 2 if unicodedata.east_asian_width(character) in "WF" else 1
        for character in text
    )


def on_left(text: str, columns: int) -> str:
    """Return a text padded on the right to a number of columns."""
    return text + " " * (columns - width(text))


def on_right(text: str, columns: int) -> str:
    """Return a text padded on the left to a number of columns."""
    return " " * (columns - width(text)) + text


def cut(text: str, columns: int) -> str:
    """Return the longest beginning of a text that fits into a number of columns."""
    while width(text) > columns:
        text = text[:-1]
    return text


def wrapped(text: str, columns: int) -> list[str]:
    """Return a text broken into lines of at most a number of columns, at blanks and between Japanese characters;
    punctuation stays with the preceding character. A word longer than a line gets a line of its own.
    """
    lines, line = list[str](), ""
    for piece in _unbroken(" ".join(text.split())):
        if line and width(line + piece.rstrip()) > columns:
            lines.append(line.rstrip())
            line = ""
        line += piece if line else piece.lstrip()
    return [*lines, line.rstrip()] if line.strip() else lines


def _unbroken(text: str) -> list[str]:
    """Return the pieces of a text between which a line may break."""
    pieces: list[str] = []
    for word in _WORDS.findall(text):
        joined = pieces and not word.isspace() and (word[0] in _NOT_FIRST or pieces[-1][-1] in _NOT_LAST)
        if joined:
            pieces[-1] += word
        else:
            pieces.append(word)
    return pieces
