"""Names of pitches in messages, tables and the editor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

from app.messages.wordings import wording

PitchNames = Literal["letters", "german", "syllables"]
"""Notation of pitches: letters (B♭4), German letters as used by school bands (B4), or syllables (Ti♭4)."""

STEPS: Final = ("C", "D", "E", "F", "G", "A", "B")
_SPELLING: Final = (
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
"""Step of the scale and accidental of each pitch class, in the spelling most common in wind parts."""


def spelled(steps: Sequence[str]) -> tuple[str, ...]:
    """Complete the names of the seven steps C to B to those of the twelve pitch classes from C on."""
    return tuple(f"{steps[step]}{accidental}" for step, accidental in _SPELLING)


LETTERS: Final = spelled(STEPS)
GERMAN: Final = ("C", "Cis", "D", "Es", "E", "F", "Fis", "G", "As", "A", "B", "H")


def pitch_class_names(names: PitchNames, language: str) -> tuple[str, ...]:
    """Return the names of the twelve pitch classes from C on; syllables depend on the language."""
    if names == "german":
        return GERMAN
    return LETTERS if names == "letters" else spelled(wording("pitch.do_re_mi_fa_so", language).split())


def named_pitch(pitch: float, names: PitchNames, language: str, middle_c_octave: int = 4) -> str:
    """Return the name of a MIDI pitch in a notation; see `pitch_name`."""
    return pitch_name(pitch, middle_c_octave, pitch_class_names(names, language))


def pitch_name(pitch: float, middle_c_octave: int = 4, names: Sequence[str] = LETTERS) -> str:
    """Return the name of a MIDI pitch: 60 is C4, or C3 if middle C is in octave 3.

    Parameters
    ----------
    pitch : float
        MIDI pitch; a fraction is rounded to the nearest semitone.
    names : sequence of str
        Names of the pitch classes from C to B.
    """
    octave, pitch_class = divmod(round(pitch), 12)
    return f"{names[pitch_class]}{octave - 5 + middle_c_octave}"
