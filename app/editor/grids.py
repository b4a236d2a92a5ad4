"""Grid steps of the timeline that the user can choose, as note values."""

from __future__ import annotations

from fractions import Fraction
from typing import Final

_LENGTHS = (1, 2, 4, 8, 16, 32)
_KINDS = (("", Fraction(1)), ("T", Fraction(2, 3)), (".", Fraction(3, 2)))
GRIDS: Final[dict[str, Fraction]] = {
    f"1/{length}{sign}": Fraction(4, length) * factor
    for sign, factor in _KINDS
    for length in _LENGTHS[2 if sign else 0 :]
}
"""Length of a grid step in quarter notes by its name: straight, triplet and dotted values."""
