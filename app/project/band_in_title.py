"""Kinds of bands that titles name, by which players are dressed and cast.

A march is no marching band: concert bands play most marches. Titles name schools in many ways that mean none
(``Old-school funk``), so in English a school counts only where the title also names its band.
"""

from __future__ import annotations

import re
from typing import Final, Literal

Band = Literal["marching", "school", "japanese_school"]

_BANDS: Final[tuple[tuple[Band, re.Pattern[str]], ...]] = (
    (
        "marching",
        re.compile(
            r"\b(marching[ -]band|drum[ -]?(and bugle )?corps|field show)\b|マーチングバンド|マーチング・バンド", re.I
        ),
    ),
    ("japanese_school", re.compile(r"吹奏楽部|[小中]学校|中学生|高校|高等学校|校歌|スクールバンド")),
    ("school", re.compile(r"\b(school|college)\b.*\b(band|orchestra|ensemble|winds?|brass)\b", re.I)),
)


def bands_in_title(title: str) -> tuple[Band, ...]:
    """Return the kinds of bands that a title names, a marching band first."""
    return tuple(band for band, pattern in _BANDS if pattern.search(title))


def plays_at_school(title: str) -> bool:
    """Return whether the title names a school's band, whose players are young."""
    return any(band != "marching" for band in bands_in_title(title))
