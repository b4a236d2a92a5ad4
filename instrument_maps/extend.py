"""Extension of one map by another: a clarinet in A contains only its differences from the one in B flat."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

BASE = "extends"
"""Key with the id of the extended map."""
WITHOUT = "without"
"""Key with the names of the extended map's controls that the instrument lacks."""
_OF_EACH = ("controls", "chart")
"""Keys of the lists with a row for each control."""


def extended(base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """Merge a map's tables into those of the map it extends.

    Tables are merged key by key, and lists of named tables (controls, their chart) by name. Own fingerings replace all
    of the base's for the same written pitch; base fingerings outside the own range and omitted controls are dropped.
    All other own values replace the base's.

    Parameters
    ----------
    base, own : mapping
        Tables as read from TOML; ``base`` is already extended. Neither is changed.
    """
    if WITHOUT in own:
        base = {
            **base,
            **{key: [row for row in _rows(base, key) if _name(row) not in own[WITHOUT]] for key in _OF_EACH},
        }
    merged = _merged(base, {key: value for key, value in own.items() if key not in (BASE, WITHOUT, "fingerings")})
    merged["fingerings"] = _fingerings(merged, base.get("fingerings", []), own.get("fingerings", []))
    return merged


def not_there(base: Mapping[str, Any], own: Mapping[str, Any]) -> str | None:
    """Return the fault in a map's list of omitted controls, such as a control that the base map lacks; None if there is
    none.
    """
    names = own.get(WITHOUT, [])
    if not isinstance(names, list):
        return "is not a list of names of controls"
    known = [_name(row) for row in _rows(base, "controls")]
    return next((f"there is no control {name!r} in '{own[BASE]}'" for name in names if name not in known), None)


def _rows(table: Mapping[str, Any], key: str) -> list[Any]:
    rows = table.get(key, [])
    return rows if isinstance(rows, list) else []


def _name(row: object) -> object:
    return row.get("name") if isinstance(row, Mapping) else None


def _merged(base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    result = dict(base)
    for key, value in own.items():
        before = result.get(key)
        if isinstance(value, Mapping) and isinstance(before, Mapping):
            result[key] = _merged(before, value)
        elif isinstance(before, list) and _named(value) and _named(before):
            rows = {row["name"]: row for row in before}
            for row in value:
                rows[row["name"]] = _merged(rows.get(row["name"], {}), row)
            result[key] = list(rows.values())
        else:
            result[key] = value
    return result


def _named(value: object) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(_name(row), str) for row in value)


def _fingerings(merged: Mapping[str, Any], base: Any, own: Any) -> Any:
    if not isinstance(base, list) or not isinstance(own, list):
        return own or base
    replaced = {_written(row) for row in own}
    limits, shift = merged.get("range"), merged.get("transposition_semitones")
    kept = [row for row in base if _written(row) not in replaced]
    if isinstance(limits, Mapping) and isinstance(shift, int):
        low, high = limits.get("low"), limits.get("high")
        if isinstance(low, int) and isinstance(high, int):
            kept = [row for row in kept if low + shift <= (_written(row) or 0) <= high + shift]
    return sorted([*kept, *own], key=lambda row: _written(row) or 0)


def _written(row: object) -> int | None:
    written = row.get("written_pitch") if isinstance(row, Mapping) else None
    return written if isinstance(written, int) else None
