"""Names of pitches in scientific pitch notation, in messages, tables and the editor alike."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

LETTERS: Final = ("C", "D", "E", "F", "G", "A", "B")
SPELLING: Final = (
    (0, ""),
    (0, "♯"),
    (1, ""),
    (2, "♭"),
    (2, ""),
    (3, ""),
    (3, "♯"),
    (4, ""),
    (5, "♭"),
    (5, ""),
    (6, "♭"),
    (6, ""),
)
"""Step of the scale and accidental of each pitch class: the signs that winds read most often."""


def pitch_name(pitch: float, middle_c_octave: int = 4, steps: Sequence[str] = LETTERS) -> str:
    """A MIDI pitch by name: 60 is C4, or C3 where middle C is in octave 3.

    Parameters
    ----------
    pitch : float
        A mean is named by the nearest semitone.
    steps : sequence of str
        What C, D, E, F, G, A and B are called.
    """
    octave, pitch_class = divmod(round(pitch), 12)
    step, accidental = SPELLING[pitch_class]
    return f"{steps[step]}{accidental}{octave - 5 + middle_c_octave}"
