"""The vocabulary of instruments: what they are called in scores, and their General MIDI programs.

The table itself is `vocabulary.toml` beside this module. An instrument here need not have a map; the vocabulary tells
what a part is, and the maps tell who can play it.

Messages
--------
vocabulary.invalid : file, detail
    "{file}: {detail}"
"""

from __future__ import annotations

import re
import tomllib
import unicodedata
from functools import cache
from pathlib import Path
from typing import Literal

import msgspec

from app.errors import MapError

PATH = Path(__file__).with_name("vocabulary.toml")

# A token is a word, one kana or kanji (Japanese has no spaces), a number or an accidental.
_WIDE = re.compile(r"[\u3040-\u30ff\u3400-\u9fff]")
_TOKEN = re.compile(r"[\u3040-\u30ff\u3400-\u9fff]|[^\W\d_\u3040-\u30ff\u3400-\u9fff]+|\d+|[♭♯#]")
_CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])")


class Instrument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One instrument.

    Attributes
    ----------
    id : str
    kind : {"wind", "percussion", "other"}
    names : tuple of str
        The first is the English name for people; matching ignores case, diacritics, width and punctuation.
    programs : tuple of int
        General MIDI programs, 0..127.
    any_pitch : bool
        A wind section without a range of its own ("brass"): the range of its notes decides who plays.
    vague : bool
        Its names may mean a part of any instrument ("Voice 1"): the program of a wind says more.
    """

    id: str
    kind: Literal["wind", "percussion", "other"]
    names: tuple[str, ...]
    programs: tuple[int, ...] = ()
    any_pitch: bool = False
    vague: bool = False


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    instruments: tuple[Instrument, ...]


class Vocabulary:
    """Finds instruments by name and by program; immutable once built.

    Parameters
    ----------
    instruments : tuple of Instrument
        Names and programs belong to one instrument each.

    Raises
    ------
    MapError
        If a name or a program belongs to two.
    """

    def __init__(self, instruments: tuple[Instrument, ...], file: str) -> None:
        self.instruments = {instrument.id: instrument for instrument in instruments}
        self._by_program: dict[int, Instrument] = {}
        self._by_tokens: dict[tuple[str, ...], Instrument] = {}
        for instrument in instruments:
            for program in instrument.programs:
                if self._by_program.setdefault(program, instrument) is not instrument:
                    raise MapError(
                        "vocabulary.invalid", file=file, detail=f"program {program} belongs to two instruments"
                    )
            for name in instrument.names:
                tokens = _tokens(name)
                if not tokens or self._by_tokens.setdefault(tokens, instrument) is not instrument:
                    raise MapError("vocabulary.invalid", file=file, detail=f"'{name}' belongs to two instruments")
        self._longest = max(map(len, self._by_tokens), default=0)

    def by_program(self, program: int) -> Instrument | None:
        """The instrument of a General MIDI program, 0..127."""
        return self._by_program.get(program)

    def by_name(self, text: str) -> Instrument | None:
        """The instrument that a text names.

        Whole words only; of several names the longest counts ("bass trombone" before "trombone"), then the first.
        Japanese is written without spaces, so its names are found anywhere within a run of kana and kanji.
        """
        tokens = _tokens(text)
        for length in range(min(self._longest, len(tokens)), 0, -1):
            for start in range(len(tokens) - length + 1):
                found = self._by_tokens.get(tokens[start : start + length])
                if found is not None:
                    return found
        return None


def _tokens(text: str) -> tuple[str, ...]:
    """The words of a text, case, width, diacritics and punctuation dropped."""
    spaced = _CAMEL.sub(" ", unicodedata.normalize("NFKC", text))
    return tuple(_TOKEN.findall(_without_marks(spaced).casefold()))


def _without_marks(text: str) -> str:
    """Diacritics dropped from Latin letters; the voicing marks of kana stay, for they tell names apart."""
    kept = []
    for character in text:
        if _WIDE.match(character):
            kept.append(character)
        else:
            decomposed = unicodedata.normalize("NFD", character)
            kept.append("".join(c for c in decomposed if not unicodedata.combining(c)))
    return "".join(kept)


@cache
def vocabulary() -> Vocabulary:
    """The bundled vocabulary.

    Raises
    ------
    MapError
        If the table is not valid.
    """
    try:
        table = msgspec.convert(tomllib.loads(PATH.read_text(encoding="utf-8")), _Table)
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise MapError("vocabulary.invalid", file=PATH.name, detail=str(error)) from error
    return Vocabulary(table.instruments, PATH.name)


# Worked out here, under the import's lock: two threads that use a type for the first time at once crash msgspec.
msgspec.json.Decoder(_Table)
