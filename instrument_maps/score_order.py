"""Order of instruments as in a score, used in all lists."""

from __future__ import annotations

from collections.abc import Iterable

from instrument_maps.instrument_names import vocabulary
from instrument_maps.model import InstrumentMap


def in_score_order(maps: Iterable[InstrumentMap]) -> list[InstrumentMap]:
    """Sort instruments as in a score: by family (``score_order`` of the vocabulary), unknown families last; within a
    family by pitch, the higher first; then by id.

    Instruments of the same name in several keys stay together, at the place of the highest.
    """
    listed = list(maps)
    highest: dict[tuple[int, str], tuple[int, int, str]] = {}
    for one in listed:
        highest[_kind(one)] = min(highest.get(_kind(one), _height(one)), _height(one))
    return sorted(listed, key=lambda one: (_kind(one)[0], highest[_kind(one)], _height(one)))


def _height(instrument: InstrumentMap) -> tuple[int, int, str]:
    low, high = instrument.range.usual
    return -low, -high, instrument.id


def _kind(instrument: InstrumentMap) -> tuple[int, str]:
    """Return a sort key for the order of instruments in a score: place of the family, and the instrument of which it is
    a form (the tuba for a tuba in F)."""
    words = vocabulary()
    known = [words.instruments[id] for id in instrument.plays if id in words.instruments]
    places = [words.score_order.index(one.family) for one in known if one.family]
    family = places[0] if places else len(words.score_order)
    return family, (*known[0].form_of, known[0].id)[0] if known else instrument.id
