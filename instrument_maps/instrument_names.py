"""The vocabulary of instruments: names in scores in many languages, and General MIDI programs.

The table is `instrument_names.toml` beside this module. An instrument may lack a map: the vocabulary identifies a part,
and the maps determine which instruments can play it.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Set
from functools import cache, lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import TypeVar

import msgspec

from app.formats.table_cache import kept
from app.formats.toml import read_toml, shaped
from instrument_maps.instruments import Instrument, InstrumentRelations, VocabularyTable, invalid
from instrument_maps.name_words import is_katakana, is_wide, words_of

T = TypeVar("T")

PATH = Path(__file__).with_name("instrument_names.toml")

_NAME_LETTERS = 4
"""Least number of letters of a name in running text: "Ob" or "Tr" may be any abbreviation, "Oboe" is not."""
_MOST_SHORT_KANA = 3
"""Greatest length in kana of a name recognised only at the end of a run of kana ("クラ", not in "スクラッチ")."""
_MOST_KANA = 8
"""Greatest number of kana examined on each side of a short kana name to see whether it is part of a longer word."""
_MOST_WORDS = 64
"""Greatest number of words of a part's name."""
_MOST_MEANINGS = 2048
"""Number of cached names, since a track's name is looked up a dozen times."""
_MOST_PARTS = 8
"""Greatest number of instruments of one player that are examined."""
_IN = frozenset({"in", "en", "em"})
"""Words before a key."""
_DOUBLING = re.compile(r"[/&+,;、]|\s[-–]\s|\b(?:and|und|et|ed|y|e(?!\W?(?:♭|b\b|flat\b)))\b", re.IGNORECASE)
"""Separators between two instruments of one player."""
_JOINED_KEYS = ("bb", "eb", "es", "b", "c", "d", "f")
"""Keys joined to a name ("Ebcl", "Fhorn"); not "Ahorn", "Repiano"."""
_TOGETHER = re.compile(r"(?<!\w)[aàá] ?\d(?!\w)")
"""Number of players of a part ("a2"), which is no key."""
_PLAYER = re.compile(r"\d+|i{1,3}|iv|vi{0,3}")
"""Number of a player between a name and its key ("Bass 1 C")."""
_LEAST_PLURAL = 4
"""Least number of letters of a word whose ending may be a plural."""
_PLURALS = (
    *(("es", ""), ("s", ""), ("i", "o"), ("i", "e"), ("e", "a"), ("en", "e"), ("en", ""), ("e", "")),
    *(("ы", ""), ("ы", "а"), ("а", "")),
)
"""Endings of plurals in the languages of the table (in Russian also of the genitive), and the endings of the singular;
longest first.
"""


class Vocabulary(InstrumentRelations):
    """Finds instruments by name and by program; immutable.

    Parameters
    ----------
    table : VocabularyTable
        The names of all instruments.
    file : str
        The table's name for messages.
    words_known : mapping of str to tuple of str
        Known results of `words_of` by name.

    Raises
    ------
    MapError
        A name belongs to two instruments; see `InstrumentRelations`.
    """

    def __init__(
        self, table: VocabularyTable, file: str, words_known: Mapping[str, tuple[str, ...]] = MappingProxyType({})
    ) -> None:
        super().__init__(table, file)
        self._meant = lru_cache(_MOST_MEANINGS)(self._by_name)
        self._by_tokens: dict[tuple[str, ...], Instrument] = {}

        @cache
        def words(name: str) -> tuple[str, ...]:
            return words_known.get(name) or words_of(name)

        instruments = table.instruments
        for instrument in instruments:
            vague = msgspec.structs.replace(instrument, vague=True)
            called = [(name, instrument) for name in instrument.names]
            for name, found in called + [(name, vague) for name in instrument.vague_names]:
                tokens = words(name)
                if not tokens or self._by_tokens.setdefault(tokens, found) is not found:
                    raise invalid(file, f"'{name}' belongs to two instruments")
        self._written_out = frozenset(
            words(name)
            for instrument in instruments
            for name in (*instrument.names, *instrument.vague_names, *instrument.keyed_names)
            if sum(map(str.isalpha, name)) >= _NAME_LETTERS or is_wide(name[0])
        )
        self._keyed = {words(name): each for each in instruments for name in each.keyed_names}
        self._longest = max(map(len, (*self._by_tokens, *self._keyed)), default=0)
        self._marks = {
            words(word): mark
            for marks in (table.sizes, table.keys, table.clefs)
            for mark, called_by in marks.items()
            for word in called_by
        }
        self._keys, self._clefs = frozenset(table.keys), frozenset(table.clefs)
        self._prefixes = frozenset(map(words, table.prefixes))
        self._short_kana = frozenset(
            words(name)
            for instrument in instruments
            if instrument.kind == "wind"
            for name in instrument.names
            if len(name) <= _MOST_SHORT_KANA and all(map(is_katakana, words(name)))
        )
        self._words = frozenset(word for name in (*self._by_tokens, *self._marks) for word in name)
        self._longest_mark = max(map(len, self._marks), default=0)

    def names_in(self, language: str) -> dict[str, str]:
        """Return the names of instruments in a language, by the English names that messages contain."""
        japanese = language == "ja"
        return {
            one.names[0]: one.japanese if japanese and one.japanese else one.names[0]
            for one in self.instruments.values()
        }

    def stroke(self, text: str) -> int | None:
        """Return the drum kit key (MIDI number) for percussion with this name; None if it is unknown."""
        found = self.by_name(text)
        return None if found is None else self._strokes.get(found.id)

    def within(self, text: str, member: Instrument) -> Instrument | None:
        """Find an instrument by a text that names only its size or key, given any member of its family: "Alto" and
        "Bari 1" among saxophones; None for other texts. A single letter counts only after "in".

        Parameters
        ----------
        member : Instrument
            Any instrument of the family.
        """
        tokens = words_of(text)[:_MOST_WORDS]
        beside = self._marks_beside(tokens, tuple(map(self._singular, tokens)), len(tokens), len(tokens))
        rest = [word for word in tokens if not _PLAYER.fullmatch(word) and word not in _IN]
        if not rest or len(rest) != sum(beside.values()) or (len(rest) == len(rest[0]) == 1 and len(tokens) == 1):
            return None
        general = member
        while general.sort_of:
            general = self.instruments[general.sort_of]
        form, reported_by = self._form(general, beside.keys())
        return form if reported_by else None

    def all_by_name(self, text: str) -> tuple[Instrument, ...]:
        """Return every instrument named in a running text, once, in order, ignoring abbreviations."""
        tokens, found, start = words_of(text), dict[str, Instrument](), 0
        while start < len(tokens):
            step = 1
            for length in range(min(self._longest, len(tokens) - start), 0, -1):
                own = tokens[start : start + length]
                named = self._by_tokens.get(own)
                if named is not None and own in self._written_out and self._is_whole(tokens, start, start + length):
                    found.setdefault(named.id, named)
                    step = length
                    break
            start += step
        return tuple(found.values())

    def by_name(self, text: str) -> Instrument | None:
        """Return the instrument that a text names.

        Only whole words are considered. Of several names, the one that explains most words is used, including sizes and
        keys beside it ("bass trombone" before "trombone", "Contrabass Cl." before "Contrabass"); among equals one that
        is not an abbreviation, then the first. Of two instruments of one player ("Oboe 2 / Engl. Horn") the first is
        used, unless the second is more specific ("Trombone 3 / Bass Trombone"); the same applies to brackets, so that
        "Flute (Piccolo)" is a flute and "Saxophone (alto)" an alto saxophone. Japanese has no spaces, so its names are
        found anywhere within a run of kana and kanji.
        """
        return self._meant(text)

    def _by_name(self, text: str) -> Instrument | None:
        text = _TOGETHER.sub(" ", unicodedata.normalize("NFKC", text))
        found = self._of_player(text)
        before, bracket, _ = text.partition("(")
        # An abbreviation is ambiguous: "Cor. 1 (Cornet)" is a cornet.
        first = self._of_player(before) if bracket and self.all_by_name(before) else None
        if found is None or first is None or first.vague or self.is_kind(found, first):
            return found
        return first

    def _of_player(self, text: str) -> Instrument | None:
        split = _DOUBLING.split(text, _MOST_PARTS)
        parts = [named for part in split if (named := self._one_by_name(part)) is not None]
        sure = [named for named in parts if not named.vague]
        if len(parts) < 2 or not sure:
            return self._one_by_name(text)
        first = next((named for named in sure[1:] if self.is_sort(named.id, sure[0].id)), sure[0])
        words = words_of(text)[:_MOST_WORDS]
        clefs = (
            self._clefs & self._marks_beside(words, tuple(map(self._singular, words)), len(words), len(words)).keys()
        )
        return self._form(first, clefs)[0]

    def _one_by_name(self, text: str) -> Instrument | None:
        tokens = tuple(part for token in words_of(text)[:_MOST_WORDS] for part in self._parts(token))
        singular = tuple(map(self._singular, tokens))
        best: tuple[tuple[bool, int, bool, bool, int, bool, int], Instrument] | None = None
        for start in range(len(tokens)):
            for length in range(1, min(self._longest, len(tokens) - start) + 1):
                own, one = tokens[start : start + length], singular[start : start + length]
                alone = self._by_tokens.get(own) or self._by_tokens.get(one)
                if (alone is None and own not in self._keyed) or not self._is_whole(tokens, start, start + length):
                    continue
                beside = self._marks_beside(tokens, singular, start, start + length)
                for named in filter(None, (alone, self._with_key(own, beside))):
                    keyed = self._keyed.get(own) is named
                    form, reported_by = self._form(named, beside.keys())
                    marks = {mark: count for mark, count in beside.items() if mark in self._keys | reported_by}
                    words = length - len(_IN.intersection(own))
                    # A name of the table has priority over a composed one.
                    total = 2 * (words + sum(marks.values())) - (bool(marks) and not keyed)
                    vague = form.vague or (keyed and self._is_loose(marks, tokens[:start] + tokens[start + length :]))
                    no_size = own not in self._marks and one not in self._marks
                    # Single letters are abbreviations: "Sax Alto" has priority over "S Sax".
                    written_out = (own in self._written_out or one in self._written_out) and not any(
                        len(word) == 1 and word.isascii() for word in own
                    )
                    rank = not vague, total, len(reported_by) > 1, no_size, words, written_out, -start
                    if best is None or rank > best[0]:
                        best = rank, msgspec.structs.replace(form, vague=True) if keyed and vague else form
        return None if best is None else best[1]

    def _is_whole(self, tokens: tuple[str, ...], start: int, end: int) -> bool:
        """Return whether tokens of kana form a complete name instead of part of a longer word: a short name may only be
        next to words of the table.
        """
        if tokens[start:end] not in self._short_kana:
            return True
        before, after = tokens[max(start - _MOST_KANA, 0) : start], tokens[end : end + _MOST_KANA]
        ends = (before[place:] for place in range(len(before)))
        begins = (after[:length] for length in range(1, len(after) + 1))
        return (not before or not is_katakana(before[-1]) or any(map(self._is_known, ends))) and (
            not after or not is_katakana(after[0]) or any(map(self._is_known, begins))
        )

    def _is_known(self, words: tuple[str, ...]) -> bool:
        return words in self._by_tokens or words in self._marks or words in self._prefixes

    def _with_key(self, own: tuple[str, ...], marks: Mapping[str, int]) -> Instrument | None:
        """Find an instrument whose name counts only together with a key beside it, given the keys found there
        (``marks``).
        """
        keyed = self._keyed.get(own)
        if keyed is None or marks.keys().isdisjoint({keyed.key, *self._form_keys(keyed)}):
            return None
        return keyed

    def _is_loose(self, marks: Mapping[str, int], beside: tuple[str, ...]) -> bool:
        """Return whether the keys beside a name are only single letters, as in "Bass B", and so may mean something
        else; a clef beside the name makes them certain.
        """
        written = any(len(word) > 1 and (word,) in self._marks for word in beside)
        return not written and _IN.isdisjoint(beside) and max(marks.values()) == 1

    def _form_keys(self, instrument: Instrument) -> frozenset[str]:
        return self._keys.intersection(mark for form in self._forms.get(instrument.id, ()) for mark in form.marks)

    def _singular(self, word: str) -> str:
        """Return the word of the table whose plural a word is; the word itself if there is none."""
        if len(word) >= _LEAST_PLURAL and not is_wide(word) and (word,) not in self._marks:
            for plural, singular in _PLURALS:
                if word.endswith(plural) and (one := word.removesuffix(plural) + singular) in self._words:
                    return one
        return word

    def _parts(self, token: str) -> tuple[str, ...]:
        """Split a word into a name and a size or prefix joined to it ("Altklar", "Soloflöte", "saxtenor")."""
        if (token,) not in self._by_tokens and (token,) not in self._marks and not is_wide(token):
            for cut in range(len(token) - 2, 2, -1):
                before, name = token[:cut], token[cut:]
                if (name,) in self._by_tokens and ((before,) in self._prefixes or (before,) in self._marks):
                    return before, name
                if (before,) in self._by_tokens and (name,) in self._marks and len(name) >= _NAME_LETTERS:
                    return before, name
            for key in _JOINED_KEYS:
                name = token.removeprefix(key)
                if name != token and (name,) in self._by_tokens and (len(key) > 1 or len(name) >= _NAME_LETTERS):
                    return key, name
        return (token,)

    def _form(self, instrument: Instrument, marks: Set[str]) -> tuple[Instrument, frozenset[str]]:
        """Choose the form of an instrument that sizes and keys (``marks``) beside its name select, and return it with
        the marks used: the form with most marks, sizes before keys; the instrument itself if none fits.
        """
        found, reported_by, best = instrument, frozenset[str](), (0, False)
        for form in self._forms.get(instrument.id, ()):
            for mark in form.marks:
                parts = frozenset(mark.split("+"))
                rank = len(parts), self._keys.isdisjoint(parts)
                if parts <= marks and rank > best:
                    found, reported_by, best = form, parts, rank
        return found, reported_by

    def _marks_beside(self, tokens: tuple[str, ...], singular: tuple[str, ...], begin: int, end: int) -> dict[str, int]:
        """Find the sizes, clefs and the nearest key (such as "B flat") among the words next to an instrument's name,
        each with the number of words it takes.
        """
        found: dict[str, int] = {}
        nearest: tuple[int, str] | None = None
        place = 0
        while place < len(tokens):
            if begin <= place < end:
                place = end
                continue
            room = (begin if place < begin else len(tokens)) - place
            for length in range(min(self._longest_mark, room), 0, -1):
                span = slice(place, place + length)
                mark = self._marks.get(tokens[span]) or self._marks.get(singular[span])
                if mark is None:
                    continue
                between = tokens[place + length : begin] if place < begin else tokens[end:place]
                beside = all(map(_PLAYER.fullmatch, between)) or (place > 0 and tokens[place - 1] in _IN)
                if length > 1 or len(tokens[place]) > 1 or beside:
                    if mark in self._keys:
                        if nearest is not None and nearest[0] <= len(between):
                            break
                        if nearest is not None:
                            del found[nearest[1]]
                        nearest = len(between), mark
                    found[mark] = length
                    place += length - 1
                    break
            place += 1
        return found


class _Kept(msgspec.Struct, frozen=True):
    """The vocabulary's table together with the normalised words of every name in it, as stored in a cache."""

    table: VocabularyTable
    words: dict[str, tuple[str, ...]]


@cache
def vocabulary() -> Vocabulary:
    """Return the bundled vocabulary.

    Raises
    ------
    MapError
        The table is invalid.
    """
    found = kept("maps", "vocabulary", PATH.parent, _DECODER, _read)
    return Vocabulary(found.table, PATH.name, found.words)


def _read() -> _Kept:
    table = shaped(read_toml(PATH, PATH.name), VocabularyTable, PATH.name)
    names = [name for one in table.instruments for name in (*one.names, *one.vague_names, *one.keyed_names)]
    marks = [word for marks in (table.sizes, table.keys, table.clefs) for words in marks.values() for word in words]
    return _Kept(table, {name: words_of(name) for name in (*names, *marks, *table.prefixes)})


# Created while the import lock is held: msgspec crashes if two threads use a type for the first time at once.
_DECODER = msgspec.msgpack.Decoder(_Kept)
