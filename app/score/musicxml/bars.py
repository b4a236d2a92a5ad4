"""Bars of a score as it is played: the length of each measure, and the metres by which bars are numbered."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from app.score.metre_map import Metre
from app.score.musicxml.written import Bar, Measure, Time

_FOUR = (4, 4)
_MOST_NUMERATOR, _MOST_DENOMINATOR = 255, 64


def measure_lengths(bars: Sequence[Bar], parts: Sequence[Sequence[Measure]], quarter: int) -> list[tuple[int, int]]:
    """Set the length of every measure, and return the metre (beats, unit) in force in each.

    A measure is as long as its longest content, whatever the time signature says; a measure without notes has the
    length of the time signature. If the parts disagree, rests alone do not make a measure longer.
    """
    metres = []
    metre = _FOUR
    for place, bar in enumerate(bars):
        own = [part[place] for part in parts if place < len(part)]
        free = bar.metre is not None and bar.metre[1] == 0
        if bar.metre is not None and not free:
            metre = bar.metre
        nominal = nominal_ticks(metre, quarter)
        length = _longest(own, nominal, bar.implicit)
        bar.length = length or nominal
        if not any(measure.chords for measure in own) and length < nominal:
            bar.length = nominal
        metres.append(metre)
    return metres


def _longest(parts: Sequence[Measure], nominal: Time, is_implicit: bool) -> Time:
    """Length in ticks of a measure: that of its longest part, or of its notes if only rests of other parts
    are longer.
    """
    longest = max((measure.length for measure in parts), default=0)
    if len({measure.length for measure in parts if measure.chords}) < 2:
        return longest
    sounding = [measure for measure in parts if any(chord.tones for chord in measure.chords)]
    if is_implicit:
        return max((measure.length for measure in sounding), default=longest)
    ends = [chord.start + chord.length for measure in sounding for chord in measure.chords if chord.tones]
    return min(longest, max(nominal, *ends)) if ends else longest


def nominal_ticks(metre: tuple[int, int], quarter: int) -> Time:
    """Length in ticks of a full bar of a metre (beats, unit)."""
    ticks = Fraction(4 * quarter * metre[0], metre[1])
    return ticks.numerator if ticks.denominator == 1 else ticks


class Metred(NamedTuple):
    """Metres of a piece in order of time, and the length of its pickup in ticks."""

    metres: tuple[Metre, ...]
    pickup_ticks: int


def metres_of(
    order: Sequence[int], starts: Sequence[Time], bars: Sequence[Bar], written: Sequence[tuple[int, int]], quarter: int
) -> Metred:
    """Return the metres of a piece in the order it is played: the written ones, and an additional one wherever a
    measure is shorter or longer than written. Consecutive short measures that together form a full bar count as one
    bar.
    """
    found: list[Metre] = []
    pickup = 0
    place = 0
    aligned = True
    while place < len(order):
        metre = written[order[place]]
        nominal = nominal_ticks(metre, quarter)
        first, length = place, bars[order[place]].length
        while length < nominal and place + 1 < len(order):
            following = bars[order[place + 1]].length
            if first == 0 or written[order[place + 1]] != metre or length + following > nominal:
                break
            length += following
            place += 1
        place += 1
        tick = round(starts[first])
        if length == nominal:
            if not found or not aligned or (found[-1].numerator, found[-1].denominator) != metre:
                found.append(Metre(tick, *metre))
            aligned = True
            continue
        fitting = _fitting(length, metre[1], quarter)
        if first == 0 and length < nominal and len(order) > 1:
            pickup = round(length)
            fitting = metre
        elif (
            place == len(order)
            and length < nominal
            and aligned
            and found
            and written[order[first]]
            == (
                found[-1].numerator,
                found[-1].denominator,
            )
        ):
            # The last bar, which is complete together with the pickup.
            continue
        found.append(Metre(tick, *(fitting or metre)))
        aligned = False
    return Metred(_once(found) or (Metre(0, *_FOUR),), pickup)


def _fitting(length: Time, denominator: int, quarter: int) -> tuple[int, int] | None:
    """Find a time signature (beats, unit) whose bar has exactly this length, trying units from ``denominator`` to
    smaller ones; None if there is none.
    """
    while denominator <= _MOST_DENOMINATOR:
        beats = Fraction(length) * denominator / (4 * quarter)
        if beats.denominator == 1:
            return (int(beats), denominator) if 1 <= beats <= _MOST_NUMERATOR else None
        denominator *= 2
    return None


def _once(metres: Sequence[Metre]) -> tuple[Metre, ...]:
    """Keep one metre per tick: the last of several at the same tick."""
    return tuple({metre.tick: metre for metre in metres}.values())
