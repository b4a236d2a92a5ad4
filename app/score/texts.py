"""The texts of a MIDI file, which does not say how they are encoded."""

from __future__ import annotations

import re
import unicodedata

# One character from beyond ASCII, alone, touching a small Latin letter: what "Flöte" in Latin-1 looks like in CP932.
_LONE_IN_WORD = re.compile(r"(?<=[a-z])[^\x00-\x7f](?![^\x00-\x7f])|(?<![^\x00-\x7f])[^\x00-\x7f](?=[a-z])")


def decoded(data: bytes, encoding: str | None = None) -> str:
    """Decode a text of a MIDI file.

    UTF-8 if it is valid, else CP932 (Japanese sequencers), else Latin-1. Nearly every pair of bytes is valid CP932, so
    its reading is refused if it holds private characters or single ones within Latin words.

    Parameters
    ----------
    data : bytes
    encoding : str, optional
        Overrides the guess; what it cannot decode becomes U+FFFD.
    """
    text = _guessed(data) if encoding is None else data.decode(encoding, errors="replace")
    return "".join(c for c in text if c.isprintable() or c.isspace()).strip()


def _guessed(data: bytes) -> str:
    if data.isascii():
        return data.decode("ascii")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        pass
    try:
        japanese = data.decode("cp932")
    except UnicodeDecodeError:
        return data.decode("latin-1")
    private = any(unicodedata.category(character) == "Co" for character in japanese)
    return data.decode("latin-1") if private or _LONE_IN_WORD.search(japanese) else japanese
