"""Names of pitches, in messages, tables and the editor alike."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

from app.messages.wordings import wording

PitchNames = Literal["letters", "german", "syllables"]
"""Letters (B♭4), the German letters of school bands (B4), or syllables (Ti♭4)."""

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
"""Step of the scale and accidental of each pitch class: the signs that winds read most often."""


def spelled(steps: Sequence[str]) -> tuple[str, ...]:
    """Names of the twelve pitch classes from C on, by those of the steps C to B."""
    return tuple(f"{steps[step]}{accidental}" for step, accidental in _SPELLING)


LETTERS: Final = spelled(STEPS)
GERMAN: Final = ("C", "Cis", "D", "Es", "E", "F", "Fis", "G", "As", "A", "B", "H")


def pitch_class_names(names: PitchNames, language: str) -> tuple[str, ...]:
    """Names of the twelve pitch classes from C on; syllables are those of a language."""
    if names == "german":
        return GERMAN
    return LETTERS if names == "letters" else spelled(wording("pitch.do_re_mi_fa_so", language).split())


def named_pitch(pitch: float, names: PitchNames, language: str, middle_c_octave: int = 4) -> str:
    """A MIDI pitch by name, as `pitch_name`, in one of the ways of naming."""
    return pitch_name(pitch, middle_c_octave, pitch_class_names(names, language))


def pitch_name(pitch: float, middle_c_octave: int = 4, names: Sequence[str] = LETTERS) -> str:
    """A MIDI pitch by name: 60 is C4, or C3 where middle C is in octave 3.

    Parameters
    ----------
    pitch : float
        A mean is named by the nearest semitone.
    names : sequence of str
        What the pitch classes from C to B are called.
    """
    octave, pitch_class = divmod(round(pitch), 12)
    return f"{names[pitch_class]}{octave - 5 + middle_c_octave}"
