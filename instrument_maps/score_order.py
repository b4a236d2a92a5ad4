"""Instruments in the order of a score, as every list of them shows them."""

from __future__ import annotations

from collections.abc import Iterable

from instrument_maps.instrument_names import vocabulary
from instrument_maps.model import InstrumentMap


def in_score_order(maps: Iterable[InstrumentMap]) -> list[InstrumentMap]:
    """Instruments by family as in a score (``score_order`` of the vocabulary), those of no known family last; in a
    family the higher one first, by its lowest and then its highest usual pitch; of equal range by id.

    Those that are called the same, in several keys, stay together: where the highest of them has its place."""
    listed = list(maps)
    highest: dict[tuple[int, str], tuple[int, int, str]] = {}
    for one in listed:
        highest[_kind(one)] = min(highest.get(_kind(one), _height(one)), _height(one))
    return sorted(listed, key=lambda one: (_kind(one)[0], highest[_kind(one)], _height(one)))


def _height(instrument: InstrumentMap) -> tuple[int, int, str]:
    low, high = instrument.range.usual
    return -low, -high, instrument.id


def _kind(instrument: InstrumentMap) -> tuple[int, str]:
    """The place of its family in a score, and the instrument of which it is a form: a tuba in F of the tuba."""
    words = vocabulary()
    known = [words.instruments[id] for id in instrument.plays if id in words.instruments]
    places = [words.score_order.index(one.family) for one in known if one.family]
    family = places[0] if places else len(words.score_order)
    return family, (*known[0].form_of, known[0].id)[0] if known else instrument.id
