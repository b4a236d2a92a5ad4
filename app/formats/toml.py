"""Reading and writing of TOML: tables of texts, numbers, booleans, lists and nested tables.

Safe for untrusted files: TOML features that this program's tables do not need are refused (numbers beyond 64 bits, nan
and infinity, deeply nested names and tables), since they make later steps fail or take time quadratic in the file's
size.
"""

from __future__ import annotations

import json
import math
import os
import re
import tomllib
from collections.abc import Iterator, Mapping
from datetime import date, time
from typing import Any, Final, TypeVar

import msgspec

from app.errors import MapError, shortened
from app.formats.files import read_file

T = TypeVar("T")

MOST_BYTES: Final = 2**18
"""Largest table in bytes; bundled ones have at most a third of it. Parsing this size takes up to half a second."""
DEEPEST: Final = 16

_LINE_PLACE = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)$")
_KEY_PLACE = re.compile(r" - at (?:`key` in )?`\$?\.?(.*)`$", re.DOTALL)
# tomllib needs time quadratic in the length of a dotted name. The pattern is possessive, so that the search does not.
_LONG_NAME = re.compile(
    rf"""(?<![\w"'-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){{{DEEPEST}}}""", re.ASCII
)
_LONG_NUMBER = re.compile(r"[0-9][0-9_]{4000}", re.ASCII)


def read_toml(path: str | os.PathLike[str], file: str | None = None) -> dict[str, Any]:
    """Parse a TOML file.

    Parameters
    ----------
    file : str, optional
        File name for messages; by default its path.

    Raises
    ------
    FileError
        The file cannot be read, is not a regular file, or is too large.
    MapError
        It is no valid TOML, or uses unsupported features.
    """
    return parse_toml(toml_text(path, file), os.fspath(path) if file is None else file)


def toml_text(path: str | os.PathLike[str], file: str | None = None) -> str:
    """Read the text of a file, with line ends ``\\n``. Raises FileError, or MapError if it is not UTF-8."""
    try:
        return read_file(path, MOST_BYTES).decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise MapError("table.not_utf8", file=os.fspath(path) if file is None else file, byte=error.start) from error


def parse_toml(text: str, file: str) -> dict[str, Any]:
    """Parse a TOML text.

    Raises
    ------
    MapError
        It is no valid TOML (reported with line and column, from 1), or uses unsupported features (with the key path).
    """
    deep = _LONG_NAME.search(text)
    if deep is not None:
        raise _syntax(text, file, deep.start(), f"a name of more than {DEEPEST} parts")
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        found, detail = _LINE_PLACE.search(str(error)), shortened(_LINE_PLACE.sub("", str(error)))
        if found is None or found.group(1) is None:
            raise _syntax(text, file, len(text), detail) from error
        line, column = int(found.group(1)), int(found.group(2))
        raise MapError("table.syntax", file=file, line=line, column=column, detail=detail) from error
    except RecursionError as error:
        raise _syntax(text, file, _deepest(text), "lists or tables nested too deeply") from error
    except ValueError as error:
        # Python refuses to convert numbers of thousands of digits.
        number = _LONG_NUMBER.search(text)
        raise _syntax(text, file, 0 if number is None else number.start(), "a number with too many digits") from error
    for place, detail in _not_allowed(table):
        raise MapError("table.invalid", file=file, place=place, detail=detail)
    return table


def shaped(table: object, kind: type[T], file: str) -> T:
    """Convert a table to a typed value. Raises MapError with the key path of the fault."""
    try:
        return msgspec.convert(table, kind)
    except msgspec.ValidationError as error:
        detail = str(error)
        found = _KEY_PLACE.search(detail)
        place = "" if found is None else shortened(found.group(1))
        detail = shortened(detail if found is None else detail[: found.start()])
        raise MapError("table.invalid", file=file, place=place or "(top level)", detail=detail) from error


def toml(table: Mapping[str, Any], above: tuple[str, ...] = ()) -> str:
    """Format a table as TOML; None values are omitted.

    Parameters
    ----------
    above : tuple of str
        Keys of the enclosing tables.
    """
    plain = {key: value for key, value in table.items() if not isinstance(value, Mapping) and value is not None}
    text = "".join(f"{_key(key)} = {_value(value)}\n" for key, value in plain.items())
    for key, value in table.items():
        if isinstance(value, Mapping):
            path = (*above, key)
            text += f"\n[{header(path)}]\n{toml(value, path)}"
    return text


def header(path: tuple[str, ...], *, many: bool = False) -> str:
    """Return the header of a table without its outer brackets; with ``many`` the table is an element of a list."""
    name = ".".join(map(_key, path))
    return f"[{name}]" if many else name


def _syntax(text: str, file: str, at: int, detail: str) -> MapError:
    line = text.count("\n", 0, at) + 1
    column = at - text.rfind("\n", 0, at)
    return MapError("table.syntax", file=file, line=line, column=column, detail=shortened(detail))


def _deepest(text: str) -> int:
    """Return the offset of the first bracket nested too deep. Brackets in strings are counted too, since the result is
    only used for messages.
    """
    depth = 0
    for found in re.finditer(r"[\[\]{}]", text):
        depth += 1 if found.group() in "[{" else -1
        if depth > DEEPEST:
            return found.start()
    return 0


def _not_allowed(table: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield key path and description of each value that tables must not have: numbers that are not finite or too large,
    and tables nested too deeply.

    Works without recursion.
    """
    pending: list[tuple[tuple[str | int, ...], Any]] = [((), table)]
    while pending:
        keys, value = pending.pop()
        if isinstance(value, dict | list):
            if len(keys) > DEEPEST:
                yield _place(keys), f"nested in more than {DEEPEST} others"
                return
            items = value.items() if isinstance(value, dict) else enumerate(value)
            pending += [((*keys, key), item) for key, item in items]
        elif isinstance(value, float) and not math.isfinite(value):
            yield _place(keys), "not a finite number"
        elif isinstance(value, int) and not -(2**63) <= value < 2**63:
            yield _place(keys), "a number that is too large"


def _place(keys: tuple[str | int, ...]) -> str:
    return shortened("".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in keys).lstrip("."))


def _key(key: str) -> str:
    return key if key and key.isascii() and key.replace("_", "").isalnum() else _value(key)


def _value(value: Any) -> str:
    if isinstance(value, str):
        # A JSON string is a basic string of TOML, except that DEL must be escaped too.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, Mapping):
        # A table within a list.
        return f"{{{', '.join(f'{_key(key)} = {_value(item)}' for key, item in value.items())}}}"
    if isinstance(value, date | time):
        return value.isoformat()
    return repr(float(value)) if isinstance(value, float) else str(int(value))
