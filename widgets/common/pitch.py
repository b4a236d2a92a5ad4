"""Names of pitches, as a person reads them."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QCoreApplication

from widgets.common.session import PitchDisplay

LETTERS = ("C", "D", "E", "F", "G", "A", "B")
SPELLING = (
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
BLACK = frozenset({1, 3, 6, 8, 10})


def pitch_name(pitch: int, middle_c_octave: int = 4, steps: Sequence[str] = LETTERS) -> str:
    """A MIDI pitch by name: 60 is C4, or C3 where middle C is in octave 3.

    Parameters
    ----------
    pitch : int
    middle_c_octave : int
    steps : sequence of str
        What C, D, E, F, G, A and B are called.
    """
    step, accidental = SPELLING[pitch % 12]
    return f"{steps[step]}{accidental}{pitch // 12 - 5 + middle_c_octave}"


def syllables() -> tuple[str, ...]:
    """What C to B are called in syllables, in the language of the editor."""
    return tuple(QCoreApplication.translate("Pitch", "Do Re Mi Fa So La Ti").split())


def pitch_text(display: PitchDisplay, concert_pitch: int, transposition_semitones: int = 0) -> str:
    """A sounding pitch as the person wants it named.

    Parameters
    ----------
    display : PitchDisplay
    concert_pitch : int
    transposition_semitones : int
        Written minus concert pitch of the instrument; counts where pitches are shown as written.
    """
    shown = concert_pitch + (transposition_semitones if display.written else 0)
    return pitch_name(shown, display.middle_c_octave, syllables() if display.syllables else LETTERS)
