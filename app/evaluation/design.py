"""Design of an evaluation: codes without meaning, and balanced orders of clips.

Orders are Williams squares (Williams 1949, Australian Journal of Scientific Research A2): every clip is equally often
at every position, and directly precedes every other clip equally often.
"""

from __future__ import annotations

import math
import random
import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

from app.evaluation.key import Variant

PRESENTATIONS: Final = ("both", "single", "pair")
Presentations: TypeAlias = Literal["both", "single", "pair"]
_FIRST_DIGITS: Final = "abcdf"
"""First digits of an id, without e: spreadsheets would convert ids such as 12345e67 or 00123456 to numbers."""


@dataclass(frozen=True)
class ClipPair:
    """One item shown to a viewer: a single clip, or two clips side by side.

    Attributes
    ----------
    left : str
        Code of the clip, or of the left clip of a pair.
    right : str
        Code of the right clip of a pair; empty for a single clip.
    """

    left: str
    right: str = ""


Order: TypeAlias = tuple[ClipPair, ...]


def new_id() -> str:
    """Return 8 random hexadecimal digits that no program interprets as a number."""
    return secrets.choice(_FIRST_DIGITS) + secrets.token_hex(4)[1:]


def codes(count: int, seed: int) -> tuple[str, ...]:
    """Return random but reproducible codes (``"c01"``, ``"c02"``, ...) that hide from viewers how a video was made."""
    width = max(2, len(str(count)))
    drawn = [f"c{number:0{width}d}" for number in range(1, count + 1)]
    random.Random(seed).shuffle(drawn)
    return tuple(drawn)


def williams(count: int) -> tuple[tuple[int, ...], ...]:
    """Return a Williams square: orders (rows) of the numbers 0 to count - 1, with twice as many rows if the count is
    odd.

    Every number is equally often at every position, and directly precedes every other number equally often.
    """
    if count < 1:
        return ((),)
    # 0, 1, n - 1, 2, n - 2, ...: each difference between neighbours occurs once.
    first = [0]
    for step in range(1, count):
        first.append((step + 1) // 2 if step % 2 else count - step // 2)
    rows = [tuple((value + shift) % count for value in first) for shift in range(count)]
    if count % 2 and count > 1:
        rows += [row[::-1] for row in rows]
    return tuple(rows)


def pairs_of(clips: Sequence[tuple[str, Variant, int]]) -> tuple[tuple[str, str], ...]:
    """Return the pairs of clips to show side by side: the variant under test with every other variant, alternating
    between excerpts.

    Parameters
    ----------
    clips : sequence of (code, variant, excerpt)
        All clips, with the number of the excerpt.
    """
    by_place = {(variant, excerpt): code for code, variant, excerpt in clips}
    variants = list(dict.fromkeys(variant for _, variant, _ in clips))
    excerpts = sorted({excerpt for _, _, excerpt in clips})
    one: Variant = "generated" if "generated" in variants else variants[0]
    others = [variant for variant in variants if variant != one]
    found = []
    for number, other in enumerate(others):
        excerpt = excerpts[number % len(excerpts)]
        found.append((by_place[one, excerpt], by_place[other, excerpt]))
    return tuple(found)


def orders(singles: Sequence[str], pairs: Sequence[tuple[str, str]]) -> tuple[Order, ...]:
    """Compute the order of clips for each viewer by number: first single clips, then pairs. After the last order they
    repeat.

    Singles and pairs are balanced over all orders, and both clips of a pair are equally often at the left.
    """
    rows, pair_rows = williams(len(singles)), williams(len(pairs))
    sides = 2 if pairs else 1
    found = []
    for viewer in range(math.lcm(len(rows), sides * len(pair_rows))):
        order = [ClipPair(singles[place]) for place in rows[viewer % len(rows)]]
        turned = viewer // len(pair_rows)
        for place in pair_rows[viewer % len(pair_rows)]:
            left, right = pairs[place] if (turned + place) % 2 == 0 else pairs[place][::-1]
            order.append(ClipPair(left, right))
        found.append(tuple(order))
    return tuple(found)
