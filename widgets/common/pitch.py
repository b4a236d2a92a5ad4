"""Names of pitches, as the user reads and types them."""

from __future__ import annotations

import re
import unicodedata

from app.editor.session import PitchDisplay
from app.editor.translated import tr
from app.messages.pitches import LETTERS, pitch_name

BLACK = frozenset({1, 3, 6, 8, 10})
_STEP_SEMITONES = (0, 2, 4, 5, 7, 9, 11)
_ACCIDENTALS = {"": 0, "#": 1, "♯": 1, "b": -1, "♭": -1, "##": 2, "bb": -2, "x": 2}


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


def pitch_from(display: PitchDisplay, text: str, transposition_semitones: int = 0) -> int | None:
    """The sounding MIDI pitch that a text means, in the way pitches are shown; None where it means none.

    ``"B♭3"``, ``"bb3"``, ``"シ♭3"`` or a MIDI number (always the sounding one).
    """
    plain = unicodedata.normalize("NFKC", text).strip()
    if plain.isascii() and plain.isdigit():
        number = int(plain) if len(plain) < 4 else 128
        return number if number <= 127 else None
    for step, names in enumerate(zip(LETTERS, syllables(), strict=True)):
        for name in names:
            match = re.fullmatch(
                re.escape(unicodedata.normalize("NFKC", name)) + r"\s*(##|bb|[#♯b♭x]?)\s*([-−]?\d{1,2})",
                plain,
                re.IGNORECASE,
            )
            if match is not None:
                octave = int(match.group(2).replace("−", "-"))
                shown = (
                    (octave - display.middle_c_octave + 5) * 12
                    + _STEP_SEMITONES[step]
                    + _ACCIDENTALS[match.group(1).lower()]
                )
                pitch = shown - (transposition_semitones if display.written else 0)
                return pitch if 0 <= pitch <= 127 else None
    return None
