"""Kinds of bands that titles name, by which players are dressed and cast (`band_in_title.toml`).

A march is no marching band: concert bands play most marches. Titles name schools in many ways that mean none
(``Old-school funk``), so in English a school counts only where the title also names its kind or its band.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final, Literal

import msgspec

from app.formats.toml import read_toml, shaped

Band = Literal["marching", "japanese_school", "school"]
Years = tuple[tuple[float, float], ...]
"""Ranges of age (from, to before) in years from which people are cast, those of the first range first."""


class _Words(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Regular expressions of English and Japanese words; empty where a language has none."""

    en: str
    ja: str

    def are_in(self, title: str) -> bool:
        """Return whether any of the words is in a title."""
        return any(words and re.search(words, title, re.IGNORECASE) for words in (self.en, self.ja))


class _Ages(_Words, frozen=True, forbid_unknown_fields=True):
    """Ages of the players of the bands that words name."""

    years: Years


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    bands: dict[Band, _Words]
    ages: dict[str, _Ages]


_PATH: Final = Path(__file__).with_suffix(".toml")
_TABLE: Final = shaped(read_toml(_PATH, _PATH.name), _Table, _PATH.name)
ANY_AGE: Final[Years] = _TABLE.ages["everyone"].years
"""Ages of the players of a band that the title says nothing about: children come last."""


def bands_in_title(title: str) -> tuple[Band, ...]:
    """Return the kinds of bands that a title names, a marching band first."""
    return tuple(band for band, words in _TABLE.bands.items() if words.are_in(title))


def years_in_title(title: str) -> Years:
    """Return the ages of players that suit a title: children in an elementary school, pupils in other schools, the
    oldest first in a band of elders.
    """
    return next((ages.years for ages in _TABLE.ages.values() if ages.are_in(title)), ANY_AGE)
