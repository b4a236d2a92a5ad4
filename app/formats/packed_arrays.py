"""Reading of array files: a table of types and shapes, then each array, deflated separately.

``resources/build/character_arrays.py`` writes them.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import msgspec
import numpy as np
import numpy.typing as npt

from app.errors import FileError
from app.formats.files import read_file
from app.formats.json_data import decode_json

MAGIC: Final = b"SUISOU-ARRAYS-1\n"
MOST_FILE_BYTES, MOST_TABLE_BYTES, MOST_BYTES = 2**25, 2**16, 2**27
"""Largest sizes in bytes of a file, of its table, and of all its arrays."""
KINDS: Final = frozenset(("|u1", "<u2", "<i2", "<i4", "<f4"))


class _Row(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    name: str
    kind: str
    shape: tuple[int, ...]
    bytes: int


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    arrays: tuple[_Row, ...]
    names: dict[str, tuple[str, ...]]


@dataclass(frozen=True, eq=False)
class PackedArrays:
    """Contents of an array file: arrays and lists of names, by name."""

    arrays: Mapping[str, npt.NDArray[Any]]
    names: Mapping[str, tuple[str, ...]]


def read_arrays(path: Path) -> PackedArrays:
    """Read a file of packed arrays (`app.formats.packed_arrays`).

    Raises
    ------
    FileError
        The file cannot be read, or is damaged.
    """
    content = read_file(path, MOST_FILE_BYTES)
    start = len(MAGIC) + 4
    length = int.from_bytes(content[len(MAGIC) : start], "little")
    if not content.startswith(MAGIC) or not 0 < length <= min(MOST_TABLE_BYTES, len(content) - start):
        raise _invalid(path, "not a file of arrays")
    table = decode_json(content[start : start + length], _Table, str(path))
    sizes = [_size(path, row) for row in table.arrays]
    if sum(sizes) > MOST_BYTES:
        raise _invalid(path, "its arrays are too large")
    place, arrays = start + length, {}
    for row, size in zip(table.arrays, sizes, strict=True):
        arrays[row.name] = np.frombuffer(_inflated(path, content[place : place + row.bytes], size), row.kind)
        arrays[row.name] = arrays[row.name].reshape(row.shape)
        place += row.bytes
    return PackedArrays(arrays, table.names)


def _size(path: Path, row: _Row) -> int:
    """Return the size of an array in bytes. Raises FileError if its type or shape is invalid."""
    if row.kind not in KINDS or len(row.shape) > 4 or row.bytes < 0 or any(side < 0 for side in row.shape):
        raise _invalid(path, f"the array {row.name!r} has no known shape")
    return math.prod(row.shape) * np.dtype(row.kind).itemsize


def _inflated(path: Path, stream: bytes, size: int) -> bytes:
    opened = zlib.decompressobj()
    try:
        content = opened.decompress(stream, size + 1)
    except zlib.error as error:
        raise _invalid(path, "damaged") from error
    if len(content) != size or not opened.eof:
        raise _invalid(path, "an array is not as long as said")
    return content


def _invalid(path: Path, detail: str) -> FileError:
    return FileError("model.invalid", file=str(path), detail=detail)
