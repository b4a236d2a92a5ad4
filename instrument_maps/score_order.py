"""Instruments in the order of a score, as every list of them shows them."""

from __future__ import annotations

from collections.abc import Iterable

from instrument_maps.model import InstrumentMap
from instrument_maps.vocabulary import vocabulary


def in_score_order(maps: Iterable[InstrumentMap]) -> list[InstrumentMap]:
    """Instruments by family as in a score (``score_order`` of the vocabulary), those of no known family last; in a
    family the higher one first, by its lowest and then its highest sounding pitch; of equal range by id."""
    return sorted(maps, key=_place)


def _place(instrument: InstrumentMap) -> tuple[int, int, int, str]:
    words = vocabulary()
    families = [words.instruments[id].family for id in instrument.plays if id in words.instruments]
    places = [words.score_order.index(family) for family in families if family]
    family = places[0] if places else len(words.score_order)
    return family, -instrument.range.low, -instrument.range.high, instrument.id
