"""Normalised words of a part's name, without case, width, diacritics, punctuation and variants of spelling.

Names of the table and of the score are both normalised, so that "FLUEGELHORN" and "Flügelhorn", "Saxophon"
and "Saxofon", "Clarinnette" and "Clarinete", "サキソフォーン" and "サキソホン" are equal.
"""

from __future__ import annotations

import re
import unicodedata

# A word is a run of letters, a single kana, kanji or hangul (Japanese and Chinese have no spaces, Korean joins words),
# a number, or an accidental.
_WIDE = re.compile(r"[\u3040-\u30fa\u30fc-\u30ff\u3400-\u9fff\uac00-\ud7a3]")
_WORD = re.compile(
    r"[\u3040-\u30fa\u30fc-\u30ff\u3400-\u9fff\uac00-\ud7a3]"
    r"|[^\W\d_\u3040-\u30ff\u3400-\u9fff\uac00-\ud7a3]+|\d+|[♭♯#]"
)
_CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])|(?<=\b[A-Z])(?=[A-Z][ac-z])")
"""Boundary between joined words, also after a single letter ("ACl"), but not in "BBb"."""
_ORDINAL = re.compile(r"(?<=\d)(?:st|nd|rd|th|ers?|eres?|res?|emes?|es?|v[ab]|m[ab]|[mdrt]?[ao])(?![^\W\d_])")
"""Endings of numbers: 1st, 2es, 3ª, 1mo, 8va; no key ("Es", "A")."""
_LEAST_SPELLED = 4
"""Least number of letters of a word whose spelling is normalised; shorter ones are abbreviations and keys."""
_SPELLING = re.compile(r"ph|oe|ue|y|(?<=[^\W\d_])([b-df-hj-np-tv-z])\1(?=[aeiouy])")
_SPELLED = {"ph": "f", "oe": "o", "ue": "u", "y": "i"}
"""Replacements for Greek, German and Italian spellings; doubled consonants between vowels are also reduced to one."""
_MARKED = re.compile(r"[^\x00-\x7f]")
_LETTERS = {"œ": "oe", "æ": "ae", "ø": "o", "ł": "l", "đ": "d", "ı": "i"}
"""Letters that Unicode does not decompose, with their replacements."""
_KANA = re.compile("ー|ヴ[ァィェォ]?|フォ|テュ|ウィ|ウェ|ウォ")
_KANA_SPELLED = {
    "ー": "",
    "ヴ": "ブ",
    "ヴァ": "バ",
    "ヴィ": "ビ",
    "ヴェ": "ベ",
    "ヴォ": "ボ",
    "フォ": "ホ",
    "テュ": "チュ",
    "ウィ": "ウイ",
    "ウェ": "ウエ",
    "ウォ": "ウオ",
}


def is_wide(word: str) -> bool:
    """Return whether a word begins with a Japanese, Chinese or Korean character, in scripts without spaces between
    words.
    """
    return _WIDE.match(word) is not None


def is_katakana(word: str) -> bool:
    """Return whether a word begins with a katakana."""
    return "\u30a1" <= word <= "\u30fa"


def words_of(text: str) -> tuple[str, ...]:
    """Split a name of a track or instrument into its words, spelled uniformly for comparison."""
    spaced = _CAMEL.sub(" ", unicodedata.normalize("NFKC", text))
    plain = _ORDINAL.sub("", _MARKED.sub(_unmarked, spaced).casefold())
    if not plain.isascii():
        plain = _KANA.sub(lambda found: _KANA_SPELLED[found[0]], plain)
    return tuple(map(_spelled, _WORD.findall(plain)))


def _spelled(word: str) -> str:
    """Normalise spelling variants of a word."""
    if len(word) < _LEAST_SPELLED:
        return word
    return _SPELLING.sub(lambda found: found[1] or _SPELLED[found[0]], word)


def _unmarked(found: re.Match[str]) -> str:
    """Remove the diacritics from a letter; voicing marks of kana are kept, since they distinguish names."""
    if _WIDE.match(found[0]):
        return found[0]
    # "Bässe" is not "Basse"; ö and ü are more often written without dots than as two letters.
    letter = found[0].casefold()
    decomposed = unicodedata.normalize("NFD", _LETTERS.get(letter, letter)).replace("a\u0308", "ae")
    return "".join(c for c in decomposed if not unicodedata.combining(c))
