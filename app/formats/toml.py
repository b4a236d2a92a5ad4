"""Writing TOML files: tables of texts, numbers, truth values and tables of such."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any


def toml(table: Mapping[str, Any], above: tuple[str, ...] = ()) -> str:
    """A table as TOML; None is left out.

    Parameters
    ----------
    table : mapping
    above : tuple of str
        Keys of the tables that it is in.
    """
    plain = {key: value for key, value in table.items() if not isinstance(value, Mapping) and value is not None}
    text = "".join(f"{_key(key)} = {_value(value)}\n" for key, value in plain.items())
    for key, value in table.items():
        if isinstance(value, Mapping):
            path = (*above, key)
            text += f"\n[{'.'.join(map(_key, path))}]\n{toml(value, path)}"
    return text


def _key(key: str) -> str:
    return key if key.isascii() and key.replace("_", "").isalnum() else _value(key)


def _value(value: Any) -> str:
    if isinstance(value, str):
        # A JSON text is a basic string of TOML, where DEL too must be escaped.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(float(value)) if isinstance(value, float) else str(int(value))
