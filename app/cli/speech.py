"""Language and pitch notation of the command line: those of its options, else of the system.

Texts for scripts are always English: JSON, statuses, names of options and files.
"""

from __future__ import annotations

import locale
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Final, Protocol, get_args

from app.errors import AppError, Argument, Message
from app.messages import LANGUAGES, TRANSPOSITION, text
from app.messages.pitches import PitchNames, named_pitch
from instrument_maps.instrument_names import vocabulary

LANGUAGE, PITCH_NAMES, MIDDLE_C, PITCHES = "--language", "--pitch-names", "--middle-c", "--pitches"
PITCH_CHOICES: Final = ("concert", "written")
"""Choices for pitches: sounding, or as written in the parts of transposing instruments."""
PITCH_NAME_CHOICES: Final[tuple[PitchNames, ...]] = get_args(PitchNames)
MIDDLE_C_OCTAVES: Final = {"C4": 4, "C3": 3}
"""Octave number of middle C, by the name of middle C."""
INSTRUMENTS: Final = frozenset({"instrument", "said", "played"})
"""Arguments of messages that are English names of instruments."""
_JAPANESE: Final = ("ja", "japanese")
_SAMPLE: Final = "あ"


class InLanguages(Protocol):
    """Interface of texts that a table has in several languages."""

    @property
    def en(self) -> str:
        """Return the English text."""

    @property
    def ja(self) -> str:
        """Return the Japanese text; empty if there is none."""


@dataclass(frozen=True)
class Speech:
    """Language of printed sentences and notation of pitches.

    Attributes
    ----------
    language : str
        Code of the language, one of `LANGUAGES`.
    names : str
        Names of pitches, one of `PITCH_NAME_CHOICES`.
    middle_c_octave : int
        Number of the octave that begins with middle C.
    written : bool
        Whether a player's pitches are written as in the player's part.
    """

    language: str = "en"
    names: PitchNames = "letters"
    middle_c_octave: int = 4
    written: bool = False

    def __call__(self, message: Message) -> str:
        """Return the sentence of a message in the language of the command, with pitches spelled."""
        semitones = int(message.arguments.get(TRANSPOSITION, 0))
        named = message if self.language == "en" else self._with_instruments(message)
        return text(named, self.language, lambda pitch: self.pitch(pitch, semitones))

    def _with_instruments(self, message: Message) -> Message:
        """Return a message with its instruments named in the language; unknown names are unchanged."""
        given = {name: value for name, value in message.arguments.items() if name in INSTRUMENTS}
        if not given:
            return message
        known = vocabulary().names_in(self.language)
        return Message(
            message.id, {**message.arguments, **{name: known.get(str(value), value) for name, value in given.items()}}
        )

    def name(self, words: InLanguages) -> str:
        """Return a name from a table; the English one if there is no Japanese one."""
        return (words.ja if self.language == "ja" else "") or words.en

    def pitch(self, pitch: float, transposition_semitones: int = 0) -> str:
        """Return the name of a MIDI pitch on an instrument with a transposition (written minus sounding pitch)."""
        shown = pitch + (transposition_semitones if self.written else 0)
        return named_pitch(shown, self.names, self.language, self.middle_c_octave)


ENGLISH: Final = Speech()
"""Language and notation of files and JSON."""
_SPOKEN: Final[list[Speech]] = [ENGLISH]


def spoken() -> Speech:
    """Return the language and notation of the current command."""
    return _SPOKEN[-1]


@contextmanager
def speaking(speech: Speech) -> Iterator[None]:
    """Use a language and notation for the duration of a block."""
    _SPOKEN.append(speech)
    try:
        yield
    finally:
        _SPOKEN.pop()


def sentence(message: Message) -> str:
    """Return a message in the language of the command line."""
    return spoken()(message)


def said(id: str, **arguments: Argument) -> str:
    """Return the text with an id in the language of the command line, filled with the arguments."""
    return sentence(Message(id, arguments))


def error_sentence(error: AppError) -> str:
    """Return an error in the language of the command line."""
    return sentence(error.message)


def requested_speech(arguments: Sequence[str]) -> Speech:
    """Return the language and notation requested by a command line, before it is parsed, so that parsing errors use
    them; impossible values are ignored here and refused later.
    """
    options = (LANGUAGE, PITCH_NAMES, MIDDLE_C, PITCHES)
    language, names, middle_c, pitches = (_value(arguments, option) for option in options)
    return Speech(
        language if language in LANGUAGES else system_language(),
        next((known for known in PITCH_NAME_CHOICES if known == names), "letters"),
        MIDDLE_C_OCTAVES.get(middle_c, 4),
        pitches == "written",
    )


def command_first(arguments: Sequence[str]) -> list[str]:
    """Return the command line with a language option that precedes the sub-command moved to the end."""
    first = arguments[0] if arguments else ""
    taken = 2 if first == LANGUAGE else 1 if first.startswith(f"{LANGUAGE}=") else 0
    return [*arguments[taken:], *arguments[:taken]]


def _value(arguments: Sequence[str], option: str) -> str:
    """Return the last value of an option in a command line, given as ``--option VALUE`` or ``--option=VALUE``; empty if
    there is none.
    """
    found = ""
    for place, argument in enumerate(arguments):
        if argument == "--":
            break
        if argument == option:
            found = next(iter(arguments[place + 1 : place + 2]), "")
        elif argument.startswith(f"{option}="):
            found = argument.removeprefix(f"{option}=")
    return found


def system_language(environment: Mapping[str, str] = os.environ) -> str:
    """Return the language of the system's locale, found as in POSIX and GNU gettext: LC_ALL, LC_MESSAGES or LANG,
    preceded by LANGUAGE unless that is C. English if the language is not supported or standard output cannot show
    Japanese.
    """
    named = next(filter(None, map(environment.get, ("LC_ALL", "LC_MESSAGES", "LANG"))), "")
    listed = [] if named.partition(".")[0] in ("C", "POSIX") else environment.get("LANGUAGE", "").split(":")
    if not named:
        named = locale.getlocale()[0] or ""
    codes = [name.replace("-", "_").partition("_")[0].partition(".")[0].casefold() for name in (*listed, named)]
    first = next((code for code in codes if code in (*LANGUAGES, *_JAPANESE)), "en")
    return "ja" if first in _JAPANESE and _can_show(_SAMPLE) else "en"


def _can_show(sample: str) -> bool:
    try:
        sample.encode(getattr(sys.stdout, "encoding", None) or "utf-8")
    except UnicodeEncodeError:
        return False
    return True
