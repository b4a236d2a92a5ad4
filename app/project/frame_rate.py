"""Parses and formats frame rates: ``24``, ``29.97``, ``30000/1001``."""

from __future__ import annotations

import re
import unicodedata
from fractions import Fraction
from typing import Final

PULLED_DOWN: Final = (24, 30, 48, 60, 120)
"""Nominal rates for which television uses 1000/1001 of the rate; 29.97 means 30000/1001 and not 2997/100."""

USUAL_RATES: Final = (
    Fraction(24000, 1001),
    Fraction(24),
    Fraction(25),
    Fraction(30000, 1001),
    Fraction(30),
    Fraction(48),
    Fraction(50),
    Fraction(60000, 1001),
    Fraction(60),
    Fraction(120),
)
"""Rates of film, television and games, in ascending order (SMPTE ST 12-1 and ST 12-3; 120 is what capture and games
have)."""

USUAL_RATE: Final = Fraction(60)
"""Default rate of a new piece's animation, its export and the live pose, in frames per second."""

USUAL_FILM_RATE: Final = Fraction(30)
"""Default rate of a film of the viewport, unless the piece has fewer frames per second."""


_STORED: Final = re.compile(r"[1-9][0-9]{0,8}(?:/[1-9][0-9]{0,8})?", re.ASCII)


def stored_rate(text: str) -> Fraction | None:
    """Parse the frame rate of a project file; None if it is invalid."""
    return Fraction(text) if _STORED.fullmatch(text) else None


def is_storable_rate(rate: Fraction) -> bool:
    """Return whether a project's file can hold a rate."""
    return _STORED.fullmatch(str(rate)) is not None


def exact_number(text: str) -> Fraction:
    """Convert a text such as ``1.5`` or ``3/2`` to an exact number. Raises ValueError, ZeroDivisionError."""
    plain = _plain(text)
    if "e" in plain.casefold():
        raise ValueError(text)  # 1e999999999 would take hours to convert
    return Fraction(plain)


def frame_rate(text: str) -> Fraction:
    """Parse a frame rate exactly, of any size. Raises ValueError or ZeroDivisionError."""
    rate = exact_number(text)
    return rate if "/" in _plain(text) else pulled_down(rate)


def pulled_down(rate: Fraction) -> Fraction:
    """Return the exact rate for a decimal short form (23.98, 23.976, 29.97 or 59.94), others unchanged."""
    for nominal in PULLED_DOWN:
        exact = Fraction(nominal * 1000, 1001)
        # Common short forms have two or three decimals.
        if abs(rate - exact) < Fraction(1, 200):
            return exact
    return rate


def frame_rate_text(rate: Fraction) -> str:
    """Format a rate so that `frame_rate` restores it exactly: ``60``, ``29.97``, or ``1000/7`` if decimals are not
    exact.
    """
    short = f"{float(rate):.3f}".rstrip("0").rstrip(".")
    return short if frame_rate(short) == rate else str(rate)


def _plain(text: str) -> str:
    """Return a text with full-width digits and signs, as typed by Japanese input methods, replaced by ASCII."""
    return unicodedata.normalize("NFKC", text).strip()
