"""Decodes the texts of a MIDI file, whose encoding is not stated in the file.

Unicode is recognised by a byte order mark or by valid UTF-8. All other texts of a file usually share one legacy
encoding, so they are judged together: each encoding has a cost, the improbability of its characters in sequence in a
language written in it. Instrument names known to the vocabulary are the strongest evidence. A text that is much
likelier in another encoding is decoded with that one.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Callable, Iterable
from functools import cache
from math import inf
from typing import Final

import msgspec

from app.score.frequent_characters import ACCENTED, CENTRAL, CYRILLIC, GREEK, HANGUL, KANJI, SIMPLIFIED, TRADITIONAL
from instrument_maps.instrument_names import vocabulary
from instrument_maps.name_words import is_wide

_MOST_TEXTS: Final = 200
"""Greatest number of texts that are examined, and of bytes in each."""
_MOST_BYTES: Final = 120
_MOST_NAMES: Final = 64
_KNOWN: Final = 8.0
"""Benefit of a name from the vocabulary, in nats like all costs."""
_KNOWN_BY_ONE: Final = 2.0
"""Benefit of a name with a single character, which may be a coincidence."""
_OWN_ENCODING: Final = 9.0
"""Cost of an encoding that differs from the file's other texts."""
_UNREADABLE: Final = 25.0
_BESIDE_LATIN: Final = 6.0
"""Cost of a character of another script next to a small Latin letter, such as "Flöte" read as CP932."""
_NOT_ASCII: Final = re.compile(r"[^\x00-\x7f]+")
_SHORT: Final = 8
_NO_LETTERS: Final = re.compile("[\u0080-\u009f\u0180-\u0217\u021c-\u02bb\u02bd-\u036f\u0460-\u058f\u0700-\u07ff]")
_BOMS: Final = ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_BE, "utf-16"), (codecs.BOM_UTF16_LE, "utf-16"))

_FREQUENT, _USUAL, _RARE, _ODD = 6.2, 8.8, 12.0, 14.0
"""Costs of Chinese characters by frequency: a list of 300 makes up half of a text, the other 3500 of a character set's
first level nearly all the rest, the 3000 of the second level a hundredth.
"""
_FREQUENT_HANGUL, _USUAL_HANGUL = 5.2, 8.5
_KANA, _HALF_KANA, _HALF_MARK = 3.8, 4.0, 7.0
_NO_WORD: Final = 5.0
"""Cost of a character in an impossible position for its script: a single half-width kana, a dash within a word."""


class TextDecoder:
    """Decoder of the texts of a MIDI file.

    Parameters
    ----------
    names : iterable of bytes
        Names of tracks and instruments.
    others : iterable of bytes
        All other texts, which count as evidence too.
    encoding : str, optional
        Overrides the guess; undecodable bytes become U+FFFD.

    Attributes
    ----------
    encoding : str
        The given or guessed encoding of the texts that are not Unicode; empty if all are Unicode.
    """

    def __init__(self, names: Iterable[bytes], others: Iterable[bytes] = (), encoding: str | None = None) -> None:
        self._given = encoding
        named = [data for data in dict.fromkeys(names) if _unicode(data) is None][:_MOST_NAMES]
        further = [data for data in dict.fromkeys(others) if _unicode(data) is None][:_MOST_TEXTS]
        self._names = frozenset(named)
        texts = list(dict.fromkeys([*named, *further]))[:_MOST_TEXTS]
        costs = {one.name: one.prior + sum(self._cost(one, data) for data in texts) for one in _ENCODINGS}
        self.encoding = encoding or (min(costs, key=costs.__getitem__) if texts else "")
        self._read: dict[bytes, str] = {}

    def read(self, data: bytes) -> str:
        """Decode a text, without unprintable characters and surrounding space."""
        if data not in self._read:
            text = self._decoded(data)
            self._read[data] = "".join(c for c in text if c.isprintable() or c.isspace()).strip()
        return self._read[data]

    def _decoded(self, data: bytes) -> str:
        if self._given is not None:
            return data.decode(self._given, errors="replace")
        text = _unicode(data)
        if text is not None:
            return text
        if len(self._read) >= _MOST_TEXTS:
            return data.decode(self.encoding, errors="replace")
        costs = {
            one.name: self._cost(one, data) + (0.0 if one.name == self.encoding else _OWN_ENCODING + one.prior)
            for one in _ENCODINGS
        }
        return data.decode(min(costs, key=costs.__getitem__), errors="replace")

    def _cost(self, encoding: _Encoding, data: bytes) -> float:
        cost = _cost(encoding.name, data[:_MOST_BYTES])
        return cost - (_evidence(encoding.name, data) if data in self._names and cost < inf else 0.0)


def _unicode(data: bytes) -> str | None:
    """Decode a text as Unicode; None if it is in another encoding."""
    for mark, encoding in _BOMS:
        if data.startswith(mark):
            return data.decode(encoding, errors="replace")
    if len(data) % 2 == 0 and len(data) > 2:
        # In UTF-16 every other byte of unaccented Latin text is 0.
        for first, encoding in ((0, "utf-16-be"), (1, "utf-16-le")):
            if not any(data[first::2]) and all(data[1 - first :: 2]):
                return data.decode(encoding)
    try:
        text = data.decode()
    except UnicodeDecodeError:
        return None
    # Two Chinese characters may be valid UTF-8 of letters that never occur together in a language.
    return None if len(data) <= _SHORT and _NO_LETTERS.search(text) else text


class _Encoding(msgspec.Struct, frozen=True):
    """A legacy text encoding found in MIDI files.

    Attributes
    ----------
    prior : float
        Cost of the encoding in advance, before any text is seen.
    """

    name: str
    prior: float
    cost: Callable[[str], float]


def _evidence(encoding: str, data: bytes) -> float:
    """Score the match of a text, decoded in an encoding, with instrument names: higher is better; ASCII letters do not
    count.
    """
    text = data[:_MOST_BYTES].decode(encoding, errors="replace")
    found = vocabulary().by_name(text)
    if found is None or found == vocabulary().by_name(_NOT_ASCII.sub(" ", text)):
        return 0.0
    without = "".join(" " if (c,) in _single() else c for c in text)
    return _KNOWN if vocabulary().by_name(without) == found else _KNOWN_BY_ONE


@cache
def _single() -> frozenset[tuple[str, ...]]:
    """Instrument names of a single character, as used in Japanese."""
    return frozenset((name,) for one in vocabulary().instruments.values() for name in one.names if len(name) == 1)


@cache
def _known_characters() -> frozenset[str]:
    """Characters of scripts without spaces that occur in instrument names."""
    return frozenset(c for one in vocabulary().instruments.values() for name in one.names for c in name if is_wide(c))


@cache
def _cost_of(encoding: str) -> Callable[[str], float]:
    return next(one.cost for one in _ENCODINGS if one.name == encoding)


def _cost(encoding: str, data: bytes) -> float:
    """Return the cost of bytes as a text in an encoding: the higher, the less likely."""
    text = data.decode(encoding, errors="replace")
    return _cost_of(encoding)(text)


def _wide_cost(frequent: frozenset[str], level: Callable[[str], float]) -> Callable[[str], float]:
    """Return a cost function for texts in a script of wide characters.

    Parameters
    ----------
    level : callable
        Cost of a character that is not in ``frequent``.
    """

    def cost(text: str) -> float:
        total = 0.0
        for place, c in enumerate(text):
            if c < "\x80":
                continue
            if c == "\ufffd":
                total += _UNREADABLE
                continue
            known = c in frequent or c in _known_characters()
            total += min(level(c), _FREQUENT_HANGUL if c >= "\uac00" else _FREQUENT) if known else level(c)
            beside = text[max(place - 1, 0) : place] + text[place + 1 : place + 2]
            if any("a" <= other <= "z" for other in beside):
                total += _BESIDE_LATIN
            if _is_half(c) and not any(map(_is_half, beside)):
                total += _NO_WORD
        total += _HALF_KANA * any(map(_is_half, text))
        return total

    return cost


def _is_half(c: str) -> bool:
    """Return whether a character is half-width kana or half-width kana punctuation."""
    return "\uff61" <= c <= "\uff9f"


def _bytes_of(c: str, encoding: str) -> bytes:
    return c.encode(encoding, errors="ignore")


def _east_asian(c: str) -> float:
    """Cost (improbability) of a character that all East Asian encodings share: full-width letters and punctuation,
    Greek, Cyrillic, box lines.
    """
    if "\uff01" <= c <= "\uff5e" or c in "、。・「」『』（）！？～：；，．　★☆♪♭♯①②③④⑤⑥⑦⑧⑨ⅠⅡⅢⅣⅤ":
        return _FREQUENT
    return 2 * _ODD if "\ue000" <= c <= "\uf8ff" else _ODD


def _japanese(c: str) -> float:
    if "\u3041" <= c <= "\u30fe":
        return _KANA
    if _is_half(c):
        return _HALF_KANA if c >= "\uff66" else _HALF_MARK
    lead = _bytes_of(c, "euc_jp")
    if len(lead) == 2 and lead[0] >= 0xB0:
        return _USUAL if lead[0] <= 0xCF else _RARE
    return _ODD if is_wide(c) else _east_asian(c)


def _simplified(c: str) -> float:
    lead = _bytes_of(c, "gb2312")
    if len(lead) == 2 and 0xB0 <= lead[0] <= 0xF7:
        return _USUAL if lead[0] <= 0xD7 else _RARE
    if "\u3041" <= c <= "\u30fe":
        return _RARE
    return _ODD if is_wide(c) else _east_asian(c)


def _traditional(c: str) -> float:
    lead = _bytes_of(c, "cp950")
    if len(lead) == 2 and is_wide(c):
        return _USUAL if lead[0] <= 0xC6 else _RARE
    return _east_asian(c)


def _korean(c: str) -> float:
    lead = _bytes_of(c, "euc_kr")
    if "\uac00" <= c <= "\ud7a3":
        return _USUAL_HANGUL if len(lead) == 2 else _ODD
    return _RARE if is_wide(c) else _east_asian(c)


def _cyrillic_cost(text: str) -> float:
    """Cost (improbability) of a text in Russian, where words begin with a capital or are all capitals."""
    total = 0.0
    for place, c in enumerate(text):
        if c < "\x80":
            continue
        before = text[place - 1] if place else " "
        small = c.lower()
        if small not in CYRILLIC:
            total += 5.5 if c in "«»—–№“”„…’іїєґўІЇЄҐЎ" else 0.5 * _ODD + 3.0
            total += _BESIDE_LATIN if c.isalpha() and before.isascii() and before.isalpha() else 0.0
        else:
            total += CYRILLIC[small]
            if c != small:
                total += 0.4 if not before.isalpha() or before.isupper() else _NO_WORD
        if small in CYRILLIC:
            after = text[place + 1 : place + 2]
            total += _BESIDE_LATIN if before.isascii() and before.isalpha() else 0.0
            total += 0.0 if before.lower() in CYRILLIC or after.lower() in CYRILLIC else _NO_WORD
    return total


def _latin_cost(text: str) -> float:
    """Cost (improbability) of a text in a Western language, where accented letters are single within words of plain
    letters.
    """
    total = 0.0
    for place, c in enumerate(text):
        if c < "\x80":
            continue
        before, after = text[place - 1] if place else " ", text[place + 1] if place + 1 < len(text) else " "
        if c.lower() in ACCENTED:
            total += 4.2 if c.islower() else 5.0
            if c == "œ" and after not in "ui":
                total += _NO_WORD
            if c.isupper() and before.islower():
                total += _BESIDE_LATIN
            beside = sum(other.isascii() and other.isalpha() for other in (before, after))
            total += 0.0 if beside else 1.5
            total += 2.5 * (before >= "\x80")
        elif c in "’‘“”«»–—…°ªº©®•№":
            within = before.isalpha() and after.isalpha() and c not in "’‘"
            total += 5.0 + 2.5 * (before >= "\x80") + _NO_WORD * within
        else:
            total += 8.5 + 2.5 * (before >= "\x80")
    return total


def _dos_cost(text: str) -> float:
    """Cost (improbability) of a Cyrillic text in the DOS code page, with a penalty for box-drawing characters."""
    return _cyrillic_cost(text) + 2.0 * sum("\u2500" <= c <= "\u25ff" for c in text)


def _greek_cost(text: str) -> float:
    """Cost (improbability) of a Greek text, with words of small letters and one accent each."""
    total = 0.0
    for place, c in enumerate(text):
        if c < "\x80":
            continue
        before = text[place - 1] if place else " "
        if c not in GREEK:
            total += 5.5 if c in "«»—–“”’…·" else 0.5 * _ODD + 3.0
            continue
        total += GREEK[c] - (0.8 if c.isupper() and before.isupper() else 0.0)
        if before.islower() and c.isupper():
            total += _NO_WORD
        total += _BESIDE_LATIN if before.isascii() and before.isalpha() else 0.0
        after = text[place + 1 : place + 2]
        total += 0.0 if before in GREEK or after in GREEK else _NO_WORD
        # Sigma has a special form at the end of words only.
        total += _NO_WORD * ((c == "ς") == (after in GREEK) and c in "ςσ")
    return total


_FRENCH: Final = re.compile("č[cdfgprs]")
"""Letter pairs that occur in no Czech text, but in "Pièce" and "Prière" with a wrong encoding."""


def _central_cost(text: str) -> float:
    """Cost of a text in Polish, Czech, Slovak or Hungarian: as `_latin_cost` with their accented letters."""
    western = "".join("é" if c.lower() in CENTRAL else c for c in text if c.lower() in CENTRAL or c.isascii())
    others = sum(c >= "\x80" and c.lower() not in CENTRAL for c in text)
    return _latin_cost(western) + 3.0 * _NO_WORD * (others + len(_FRENCH.findall(text)))


_ENCODINGS: Final = (
    _Encoding("cp932", 0.0, _wide_cost(KANJI, _japanese)),
    _Encoding("cp1252", 0.0, _latin_cost),
    _Encoding("gbk", 0.5, _wide_cost(SIMPLIFIED, _simplified)),
    _Encoding("cp950", 1.0, _wide_cost(TRADITIONAL, _traditional)),
    _Encoding("cp949", 1.0, _wide_cost(HANGUL, _korean)),
    _Encoding("cp1251", 1.0, _cyrillic_cost),
    _Encoding("euc_jp", 2.0, _wide_cost(KANJI, _japanese)),
    _Encoding("mac_roman", 2.0, _latin_cost),
    _Encoding("koi8_r", 2.0, _cyrillic_cost),
    _Encoding("cp1250", 2.0, _central_cost),
    _Encoding("cp866", 2.0, _dos_cost),
    _Encoding("cp1253", 1.0, _greek_cost),
    _Encoding("iso8859_7", 1.5, _greek_cost),
)
