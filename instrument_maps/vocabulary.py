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
import unicodedata
from functools import cache
from pathlib import Path
from typing import Literal

import msgspec

from app.errors import MapError
from app.formats.toml import read_toml, shaped

PATH = Path(__file__).with_name("vocabulary.toml")

# A token is a word, one kana or kanji (Japanese has no spaces), a number or an accidental.
_WIDE = re.compile(r"[\u3040-\u30ff\u3400-\u9fff]")
_TOKEN = re.compile(r"[\u3040-\u30ff\u3400-\u9fff]|[^\W\d_\u3040-\u30ff\u3400-\u9fff]+|\d+|[♭♯#]")
_NAME_LETTERS = 4
"""In a running text "Ob" or "Tr" may be anything; "Oboe" is not."""
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
    family : str
        Of a wind: the section it sits in, one of those in the table's ``seating``.
    sort_of : str
        Id of the more general instrument that this is a size or key of: a clarinet in A is a sort of clarinet. A part
        for the one may be played by the other where nothing fits better.
    by_name_only : bool
        Nobody is given this instrument because of the range of the notes alone.
    any_pitch : bool
        A wind section without a range of its own ("brass"): the range of its notes decides who plays, among
        ``families`` where they are named.
    vague : bool
        Its names may mean a part of any instrument ("Voice 1"): the program of a wind says more.
    """

    id: str
    kind: Literal["wind", "percussion", "other"]
    names: tuple[str, ...]
    programs: tuple[int, ...] = ()
    family: str = ""
    sort_of: str = ""
    by_name_only: bool = False
    families: tuple[str, ...] = ()
    any_pitch: bool = False
    vague: bool = False


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    seating: tuple[tuple[str, ...], ...]
    instruments: tuple[Instrument, ...]


class Vocabulary:
    """Finds instruments by name and by program; immutable once built.

    Parameters
    ----------
    instruments : tuple of Instrument
        Names and programs belong to one instrument each.
    file : str
        The table's name for messages.
    seating : tuple of tuple of str
        Families of winds, by row from the audience's side, each row from the audience's left.

    Raises
    ------
    MapError
        If a name or a program belongs to two, or a kind or a family is not in the table.
    """

    def __init__(
        self, instruments: tuple[Instrument, ...], file: str, seating: tuple[tuple[str, ...], ...] = ()
    ) -> None:
        self.seating = seating
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
        families = {"", *(family for row in seating for family in row)}
        for instrument in instruments:
            for family in (instrument.family, *instrument.families):
                if family not in families:
                    raise MapError("vocabulary.invalid", file=file, detail=f"'{family}' has no place in the seating")
            above = [instrument.id]
            while (more := self.instruments.get(above[-1])) is not None and more.sort_of:
                if more.sort_of in above or more.sort_of not in self.instruments:
                    detail = f"'{instrument.id}' is a sort of '{more.sort_of}', which is no other instrument"
                    raise MapError("vocabulary.invalid", file=file, detail=detail)
                above.append(more.sort_of)

    def by_program(self, program: int) -> Instrument | None:
        """The instrument of a General MIDI program, 0..127."""
        return self._by_program.get(program)

    def is_sort(self, id: str, general: str) -> bool:
        """Whether an instrument is a sort of another one, over any number of steps."""
        known = self.instruments.get(id)
        return (
            known is not None
            and bool(known.sort_of)
            and (known.sort_of == general or self.is_sort(known.sort_of, general))
        )

    def lineage(self, id: str) -> tuple[str, ...]:
        """An instrument and what it is a sort of, from itself to the most general."""
        known = self.instruments.get(id)
        return (id, *(self.lineage(known.sort_of) if known is not None and known.sort_of else ()))

    def family(self, ids: tuple[str, ...]) -> str:
        """The section of the first of these instruments that has one; empty if none has."""
        families = (self.instruments[id].family for id in ids if id in self.instruments)
        return next((family for family in families if family), "")

    def all_by_name(self, text: str) -> tuple[Instrument, ...]:
        """Every instrument that a running text names, once, in its order. Abbreviations do not count."""
        tokens, found, start = _tokens(text), dict[str, Instrument](), 0
        while start < len(tokens):
            step = 1
            for length in range(min(self._longest, len(tokens) - start), 0, -1):
                own = tokens[start : start + length]
                named = self._by_tokens.get(own)
                if named is not None and (len("".join(own)) >= _NAME_LETTERS or _WIDE.match(own[0])):
                    found.setdefault(named.id, named)
                    step = length
                    break
            start += step
        return tuple(found.values())

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
    table = shaped(read_toml(PATH, PATH.name), _Table, PATH.name)
    return Vocabulary(table.instruments, PATH.name, table.seating)


# Worked out here, under the import's lock: two threads that use a type for the first time at once crash msgspec.
msgspec.json.Decoder(_Table)
