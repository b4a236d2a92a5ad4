"""Reading and writing of pitch names for the user."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from typing import Final

from app.editor.session import PitchDisplay
from app.editor.translated import tr
from app.messages.pitches import GERMAN, LETTERS, STEPS, pitch_name, spelled

BLACK = frozenset({1, 3, 6, 8, 10})
_STEP_SEMITONES: Final = (0, 2, 4, 5, 7, 9, 11)
_ACCIDENTALS: Final = {"": 0, "#": 1, "♯": 1, "b": -1, "♭": -1, "##": 2, "bb": -2, "x": 2}
_GERMAN: Final = {
    **dict(zip("CDEFGAH", _STEP_SEMITONES, strict=True)),
    **{f"{name}is": semitones + 1 for name, semitones in zip("CDEFGAH", _STEP_SEMITONES, strict=True)},
    **{f"{name}es": semitones - 1 for name, semitones in zip("CDFGH", (0, 2, 5, 7, 11), strict=True)},
    "Es": 3,
    "As": 8,
    "B": 10,
}
"""Semitones above C of German names: H is the step below C, B a semitone lower."""


def pitch_names(display: PitchDisplay) -> tuple[str, ...]:
    """Return the names of the twelve pitch classes from C on in the user's notation."""
    if display.names == "german":
        return GERMAN
    return spelled(_syllables()) if display.names == "syllables" else LETTERS


def _syllables() -> tuple[str, ...]:
    """Return the syllables (do, re, ...) for the notes C to B, in the editor's language."""
    return tuple(tr("pitch.do_re_mi_fa_so").split())


def pitch_text(display: PitchDisplay, concert_pitch: int, transposition_semitones: int = 0) -> str:
    """Return the name of a sounding pitch by the user's settings.

    Parameters
    ----------
    transposition_semitones : int
        Written minus concert pitch of the instrument; used if pitches are shown as written.
    """
    shown = concert_pitch + (transposition_semitones if display.written else 0)
    return pitch_name(shown, display.middle_c_octave, pitch_names(display))


def pitch_from(display: PitchDisplay, text: str, transposition_semitones: int = 0) -> int | None:
    """Return the sounding MIDI pitch for a text in the user's notation; None if it is invalid.

    Examples are ``"B♭3"``, ``"bb3"``, ``"シ♭3"``, ``"Es3"``, or a MIDI number (always sounding). ``"B3"`` is a semitone
    lower in German notation.
    """
    plain = unicodedata.normalize("NFKC", text).strip()
    if plain.isascii() and plain.isdigit():
        number = int(plain) if len(plain) < 4 else 128
        return number if number <= 127 else None
    found = re.fullmatch(r"(.*?)\s*([-−]?\d{1,2})", plain)
    if found is None:
        return None
    for names in (_german(), _named()) if display.names == "german" else (_named(), _german()):
        for name, semitones in names:
            if name.casefold() == found.group(1).casefold():
                octave = int(found.group(2).replace("−", "-"))
                shown = (octave - display.middle_c_octave + 5) * 12 + semitones
                pitch = shown - (transposition_semitones if display.written else 0)
                return pitch if 0 <= pitch <= 127 else None
    return None


def _german() -> Iterator[tuple[str, int]]:
    yield from _GERMAN.items()


def _named() -> Iterator[tuple[str, int]]:
    """Yield the names of notes (letters and syllables) with each accidental, and the semitones of each above C."""
    for steps in (STEPS, _syllables()):
        for step, semitones in zip(steps, _STEP_SEMITONES, strict=True):
            for accidental, more in _ACCIDENTALS.items():
                yield f"{unicodedata.normalize('NFKC', step)}{accidental}", semitones + more
