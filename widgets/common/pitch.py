"""Names of pitches, as the user reads them."""

from __future__ import annotations

from app.editor.session import PitchDisplay
from app.editor.translated import tr
from app.messages.pitches import LETTERS, pitch_name

BLACK = frozenset({1, 3, 6, 8, 10})


def syllables() -> tuple[str, ...]:
    """Syllables for C to B, in the editor's language."""
    return tuple(tr("pitch.do_re_mi_fa_so").split())


def pitch_text(display: PitchDisplay, concert_pitch: int, transposition_semitones: int = 0) -> str:
    """A sounding pitch named by the user's settings.

    Parameters
    ----------
    transposition_semitones : int
        Written minus concert pitch of the instrument; counts where pitches are shown as written.
    """
    shown = concert_pitch + (transposition_semitones if display.written else 0)
    return pitch_name(shown, display.middle_c_octave, syllables() if display.syllables else LETTERS)
