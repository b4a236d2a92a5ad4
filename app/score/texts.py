"""The texts of a MIDI file, which does not say how they are encoded."""

from __future__ import annotations

from app.encoding import guessed


def decoded(data: bytes, encoding: str | None = None) -> str:
    """Decode a text of a MIDI file.

    Parameters
    ----------
    encoding : str, optional
        Overrides the guess (`app.encoding.guessed`); what it cannot decode becomes U+FFFD.
    """
    text = guessed(data) if encoding is None else data.decode(encoding, errors="replace")
    return "".join(c for c in text if c.isprintable() or c.isspace()).strip()
