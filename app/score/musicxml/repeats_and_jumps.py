"""Determines the order in which measures are played: repeats, endings, *D.C.*, *D.S.*, *Fine* and *Coda*.

After a jump, repeats are not played again and only the last ending is played, as is customary.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, pairwise
from typing import Final, NamedTuple

import msgspec

from app.errors import FileError
from app.score.limits import MOST_BARS
from app.score.musicxml.written import Bar

_ANY: Final = "*"
"""Target of signs or words without a sound element that names it."""

_STRAINS: Final = 4
"""Number of repeated sections of a minuet with its trio."""


class Order(msgspec.Struct, frozen=True):
    """Indices of the measures in playing order, and the indices of measures whose jump is invalid."""

    measures: tuple[int, ...]
    lost: tuple[str, ...] = ()


def playing_order(bars: Sequence[Bar], file: str) -> Order:
    """Determine the order in which the measures of a score are played.

    Raises
    ------
    FileError
        More measures would be played than a piece may have.
    """
    _explain(bars)
    return _Player(bars, file).play()


def _explain(bars: Sequence[Bar]) -> None:
    """Set jumps in ``bars`` from printed words and signs, if the file has no ``sound`` elements for them."""
    jumps = any(bar.da_capo or bar.dal_segno for bar in bars)
    for bar in bars:
        said = bar.said
        if "to_coda" in said and not any(one.to_coda for one in bars):
            bar.to_coda = _ANY
        if not jumps and "da_capo" in said:
            bar.da_capo = True
        elif not jumps and "dal_segno" in said:
            bar.dal_segno = _ANY
        if "fine" in said and bar.number and not any(one.fine for one in bars if one is not bar):
            bar.fine = True
        if "segno" in said and not any(one.segno for one in bars):
            bar.segno = _ANY
    if any(bar.da_capo for bar in bars) and not any(bar.fine or bar.to_coda for bar in bars):
        # After the trio a minuet is repeated without it.
        trio = next((place for place, bar in enumerate(bars) if "trio" in bar.said), 0) or _unnamed_trio(bars)
        if trio:
            bars[trio - 1].fine = True
    is_open = False
    for bar, following in pairwise(bars):
        if following.backward and not bar.backward and not (following.da_capo or following.dal_segno):
            # Wide text is often placed one measure early: the repeat comes first.
            following.da_capo, bar.da_capo = bar.da_capo, False
            following.dal_segno, bar.dal_segno = bar.dal_segno, ""
        is_open = is_open or bool(bar.ending_start)
        if bar.ending_stop and not is_open and following.ending_start:
            # The bracket lacks its beginning.
            bar.ending_start = frozenset(range(1, min(following.ending_start)))
        is_open = is_open and not bar.ending_stop
    signs = [bar for bar in bars if "coda" in bar.said]
    if signs and not any(bar.coda for bar in bars):
        signs[-1].coda = _ANY
        if len(signs) > 1 and not any(bar.to_coda for bar in bars):
            signs[0].to_coda = _ANY


def _unnamed_trio(bars: Sequence[Bar]) -> int:
    """Return the index of the first measure of an unmarked trio: the third section in a piece of exactly four repeated
    sections with a *D.C.*, as in a minuet; 0 for other pieces.
    """
    groups = [*_groups(bars, _endings(bars)), None]
    ends = [
        place
        for place, bar in enumerate(bars)
        if (bar.backward if groups[place] is None else groups[place] is not groups[place + 1])
    ]
    return ends[1] + 1 if len(ends) == _STRAINS and ends[-1] == len(bars) - 1 else 0


class _Player:
    """Walks through the measures in the order in which a player plays them."""

    def __init__(self, bars: Sequence[Bar], file: str) -> None:
        self.bars, self.file = bars, file
        self.endings = _endings(bars)
        self.groups = _groups(bars, self.endings)
        self.start, self.turn = 0, 1
        self.jumped = False
        self.done: set[tuple[str, int]] = set()
        self.lost: list[str] = []

    def play(self) -> Order:
        """Return the indices of the measures in the order in which they are played, with repeats and jumps followed."""
        order: list[int] = []
        place = 0
        while place < len(self.bars):
            bar = self.bars[place]
            group = self.groups[place - 1] if place else None
            has_ended = self.turn > 1 and group is not None and group is not self.groups[place]
            if (has_ended or bar.forward) and place != self.start:
                self.start, self.turn = place, 1
            if self._is_passed_over(place):
                place += 1
                continue
            order.append(place)
            if len(order) > MOST_BARS:
                raise FileError("musicxml.too_many_repeats", file=self.file, most=MOST_BARS)
            following = self._after(place, bar)
            if following is None:
                break
            place = following
        return Order(tuple(order), tuple(self.lost))

    def _is_passed_over(self, place: int) -> bool:
        """Return whether a measure belongs to an ending that is not played now."""
        numbers, group = self.endings[place], self.groups[place]
        if not numbers or group is None or (self.turn in numbers and not self.jumped):
            return False
        if self.jumped or self.turn > max(group.numbers):
            # The last ending, unless it repeats too.
            return max(group.numbers) not in numbers or (group.leads_back and not self.jumped)
        return self.turn in group.numbers

    def _after(self, place: int, bar: Bar) -> int | None:
        """Return the index of the measure that is played next, following repeats and jumps; None at the end."""
        if bar.backward and (not self.jumped or bar.after_jump):
            if self.turn < self._times(place, bar):
                self.turn += 1
                return self.start
            self.start, self.turn = place + 1, 1
        if self.jumped and bar.fine:
            return None
        if self.jumped and bar.to_coda and ("coda", place) not in self.done:
            self.done.add(("coda", place))
            target = self._find("coda", bar.to_coda, place)
            if target is not None:
                return self._jump(target)
        if bar.da_capo and ("capo", place) not in self.done:
            self.done.add(("capo", place))
            return self._jump(0)
        if bar.dal_segno and ("segno", place) not in self.done:
            self.done.add(("segno", place))
            target = self._find("segno", bar.dal_segno, place)
            if target is not None:
                return self._jump(target)
        return place + 1

    def _times(self, place: int, bar: Bar) -> int:
        """Return the number of times that the section ending with a measure is played in all."""
        group = self.groups[place]
        if group is None:
            return bar.backward
        return max(group.numbers) + group.leads_back * (group.endings == 1)

    def _jump(self, place: int) -> int:
        self.jumped = True
        self.start, self.turn = place, 1
        return place

    def _find(self, kind: str, name: str, place: int) -> int | None:
        """Index of the measure to which a jump of this kind and name leads, the nearest of several; None if there is
        none.
        """
        named = [one for one, bar in enumerate(self.bars) if getattr(bar, kind) and name in (getattr(bar, kind), _ANY)]
        named = named or [one for one, bar in enumerate(self.bars) if getattr(bar, kind)]
        if not named:
            self.lost.append(self.bars[place].number)
            return None
        if kind == "segno":
            return max((one for one in named if one <= place), default=named[0])
        return next((one for one in named if one > place), named[-1])


class _Group(NamedTuple):
    """Consecutive endings of a repeat ("1.", "2."): all their numbers, how many endings there are, and whether the last
    one leads back to the start.
    """

    numbers: frozenset[int]
    endings: int
    leads_back: bool


def _groups(bars: Sequence[Bar], endings: Sequence[frozenset[int] | None]) -> list[_Group | None]:
    """For each measure the group of consecutive endings that it belongs to; None if it is in no ending."""
    found: list[_Group | None] = []
    for is_ending, places in groupby(range(len(bars)), key=lambda place: bool(endings[place])):
        own = list(places)
        numbers = frozenset[int]().union(*(endings[place] or () for place in own))
        count = sum(bool(bars[place].ending_start) for place in own)
        group = _Group(numbers, count, bars[own[-1]].backward > 0) if is_ending else None
        found += [group] * len(own)
    return found


def _endings(bars: Sequence[Bar]) -> list[frozenset[int] | None]:
    """For each measure the numbers of the ending that it belongs to; None if it is in no ending."""
    found: list[frozenset[int] | None] = []
    current: frozenset[int] | None = None
    for bar in bars:
        if bar.ending_start:
            current = bar.ending_start
        found.append(current)
        if bar.ending_stop or (bar.backward and current is not None):
            current = None
    return found
