"""Names of pitches, as a person reads them."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from app.messages.pitches import LETTERS, pitch_name
from widgets.common.session import PitchDisplay

BLACK = frozenset({1, 3, 6, 8, 10})


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
