"""Scaling of an instrument's map, as for children."""

from __future__ import annotations

from typing import TypeVar

import msgspec

from instrument_maps.model import InstrumentMap

_LENGTHS = ("_m", "_m_s")
"""Suffixes of the fields that scale with an instrument: lengths and positions, and the speed of a slide, whose travel
is longer.
"""
_Table = TypeVar("_Table", bound=msgspec.Struct)


def scaled(instrument: InstrumentMap, size: float) -> InstrumentMap:
    """Return the map with all lengths multiplied; `InstrumentMap.size` is the total factor."""
    if size == 1.0:
        return instrument
    return msgspec.structs.replace(_scaled(instrument, size), size=instrument.size * size)


def _scaled(table: _Table, size: float) -> _Table:
    changed = {}
    for name in table.__struct_fields__:
        value = getattr(table, name)
        found = _times(value, size) if name.endswith(_LENGTHS) else _within(value, size)
        if found is not value:
            changed[name] = found
    return msgspec.structs.replace(table, **changed) if changed else table


def _times(value: object, size: float) -> object:
    if isinstance(value, tuple):
        return tuple(size * number for number in value)
    return size * value if isinstance(value, int | float) else value


def _within(value: object, size: float) -> object:
    if isinstance(value, msgspec.Struct):
        return _scaled(value, size)
    if isinstance(value, tuple) and value and isinstance(value[0], msgspec.Struct):
        found = tuple(_scaled(item, size) for item in value)
        return value if all(a is b for a, b in zip(found, value, strict=True)) else found
    return value
