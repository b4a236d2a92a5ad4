"""Decoding of the bytes of a binary FBX file to a tree of records (`Element`).

Safe for untrusted files: every length is checked, nesting is limited, and an array is never unpacked beyond what its
compressed bytes can hold.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, Final

import deflate
import numpy as np
import numpy.typing as npt

from app.errors import FileError
from app.formats.fbx.byte_cache import ByteCache
from app.formats.fbx.encode import LARGE_VERSION, MAGIC, Element, Property

_DEEPEST = 32
"""Greatest nesting depth of records; files of real programs have about 8 levels."""

# DEFLATE compresses at most 1032 bytes into one.
_LARGEST_RATIO = 1032
# Total size of all unpacked arrays: this and a multiple of the file's size, since constant curves compress well.
_FREE_BYTES = 2**26
_MOST_TIMES = 256

_MOST_KEPT_BYTES, _LARGEST_KEPT_BYTES = 2**26, 2**24
_SMALL_BYTES = 1024
_Packed = tuple[np.dtype[np.generic], int, bytes]
"""A packed array: type, number of values and compressed bytes."""

_ARRAYS: Final = {
    ord(code): np.dtype(kind)
    for code, kind in {"f": "<f4", "d": "<f8", "i": "<i4", "l": "<i8", "b": "?", "c": "u1"}.items()
}
_SCALARS: Final[dict[int, tuple[struct.Struct, Callable[[Any], Property]]]] = {
    ord("C"): (struct.Struct("<?"), bool),
    ord("B"): (struct.Struct("<?"), bool),
    ord("Y"): (struct.Struct("<h"), np.int16),
    ord("I"): (struct.Struct("<i"), np.int32),
    ord("L"): (struct.Struct("<q"), np.int64),
    ord("F"): (struct.Struct("<f"), np.float32),
    ord("D"): (struct.Struct("<d"), float),
}
_TEXT, _BYTES = ord("S"), ord("R")
_LENGTH, _ARRAY = struct.Struct("<I"), struct.Struct("<III")


def read_elements(data: bytes, file: str) -> Element:
    """Decode a whole FBX file.

    Parameters
    ----------
    file : str
        File name for messages.

    Returns
    -------
    Element
        Element without a name, with the file's version as an int32 property and the top-level records as its children.

    Raises
    ------
    FileError
        The bytes are invalid.
    """
    if len(data) < len(MAGIC) + 4 or not data.startswith(MAGIC[:20]):
        raise FileError("fbx.not_binary", file=file)
    (version,) = struct.unpack_from("<I", data, len(MAGIC))
    reader = _Reader(data, file, version)
    children, _ = reader.block(len(MAGIC) + 4, len(data), 0)
    return Element("", (np.int32(version & 0x7FFFFFFF),), children)


_arrays: Final = ByteCache[_Packed, npt.NDArray[np.generic]](_MOST_KEPT_BYTES, _LARGEST_KEPT_BYTES)
"""Unpacked arrays: players with the same body have the same meshes."""


class _Reader:
    def __init__(self, data: bytes, file: str, version: int) -> None:
        self._data = data
        self._file = file
        self._left_bytes = _FREE_BYTES + _MOST_TIMES * len(data)
        self._unpacked: dict[_Packed, npt.NDArray[np.generic]] = {}
        self._last: dict[tuple[np.dtype[np.generic], int, int], tuple[bytes, npt.NDArray[np.generic]]] = {}
        self._known: dict[bytes, Element] = {}
        self._head = struct.Struct("<IIIB" if version < LARGE_VERSION else "<QQQB")
        self._end_bytes = 4 if version < LARGE_VERSION else 8

    def _error(self, what: str, offset: int) -> FileError:
        return FileError(f"fbx.{what}", file=self._file, offset=offset)

    def block(self, position: int, end: int, depth: int) -> tuple[tuple[Element, ...], int]:
        """Decode the child records of a block up to its closing null record. Return the records and the offset after
        them. Raises FileError if nested too deeply.
        """
        if depth > _DEEPEST:
            raise self._error("too_deep", position)
        elements: list[Element] = []
        size = self._head.size
        while True:
            if position + size > end:
                raise self._error("truncated" if end == len(self._data) else "bad_record", position)
            head = self._head.unpack_from(self._data, position)
            if head[0] == 0:
                if any(head):
                    raise self._error("bad_record", position)
                return tuple(elements), position + size
            elements.append(self._record(position, head, end, depth))
            position = head[0]

    def _record(self, position: int, head: tuple[int, ...], limit: int, depth: int) -> Element:
        record_end, count, property_bytes, name_length = head
        start = position + self._head.size + name_length
        stop = start + property_bytes
        if record_end > limit or stop > record_end:
            raise self._error("truncated" if record_end > len(self._data) else "bad_record", position)
        # Records of a file that differ only in their end offset are decoded once.
        same = self._data[position + self._end_bytes : stop] if stop == record_end < position + _SMALL_BYTES else b""
        known = self._known.get(same)
        if known is not None:
            return known
        name = self._data[start - name_length : start].decode("latin-1")
        properties: list[Property] = []
        at = start
        for _ in range(count):
            value, at = self._property(at, stop)
            properties.append(value)
        if at != stop:
            raise self._error("bad_record", position)
        if stop < record_end:
            children, at = self.block(stop, record_end, depth + 1)
            if at != record_end:
                raise self._error("bad_record", position)
            return Element(name, tuple(properties), children)
        element = Element(name, tuple(properties))
        if same:
            self._known[same] = element
        return element

    def _property(self, at: int, stop: int) -> tuple[Property, int]:
        code, body = self._data[at] if at < stop else -1, at + 1
        if code in _SCALARS:
            layout, kind = _SCALARS[code]
            end = body + layout.size
            if end <= stop:
                return kind(layout.unpack_from(self._data, body)[0]), end
        elif code in (_TEXT, _BYTES) and body + 4 <= stop:
            end = body + 4 + _LENGTH.unpack_from(self._data, body)[0]
            if end <= stop:
                raw = self._data[body + 4 : end]
                return (raw.decode("utf-8", "surrogateescape") if code == _TEXT else raw), end
        elif code in _ARRAYS and body + 12 <= stop:
            count, encoding, length = _ARRAY.unpack_from(self._data, body)
            end = body + 12 + length
            if end <= stop:
                return self._array(_ARRAYS[code], count, encoding, body + 12, end), end
        raise self._error("bad_property", at)

    def _array(self, dtype: np.dtype[np.generic], count: int, encoding: int, start: int, end: int) -> Property:
        size = count * dtype.itemsize
        raw = memoryview(self._data)[start:end]
        if encoding == 1:
            if size > _LARGEST_RATIO * (end - start):
                raise self._error("bad_array", start)
            self._left_bytes -= size
            if self._left_bytes < 0:
                raise FileError("fbx.too_large", file=self._file)
            return self._unpack(dtype, count, bytes(raw), start)
        if encoding != 0:
            raise self._error("bad_array", start)
        return self._values(dtype, size, raw, start)

    def _unpack(self, dtype: np.dtype[np.generic], count: int, raw: bytes, start: int) -> npt.NDArray[np.generic]:
        # All curves of a clip share their times.
        last, found = self._last.get((dtype, count, len(raw)), (b"", None))
        if found is not None and last == raw:
            return found
        packed = dtype, count, raw
        found = self._unpacked.get(packed)
        if found is None:
            found = _arrays.get(packed)
            if found is None:
                size = count * dtype.itemsize
                found = self._values(dtype, size, self._inflated(raw, size, start), start)
                _arrays.keep(packed, found, found.nbytes + len(raw))
            self._unpacked[packed] = found
        self._last[dtype, count, len(raw)] = raw, found
        return found

    def _inflated(self, raw: bytes, size: int, start: int) -> bytes:
        try:
            return bytes(deflate.zlib_decompress(raw, size))
        except deflate.DeflateError as error:
            raise self._error("bad_array", start) from error

    def _values(
        self, dtype: np.dtype[np.generic], size: int, raw: bytes | memoryview, start: int
    ) -> npt.NDArray[np.generic]:
        if len(raw) != size:
            raise self._error("bad_array", start)
        if dtype.kind == "b":  # any nonzero byte means true
            return np.frombuffer(raw, dtype=np.uint8).astype(np.bool_)
        values: npt.NDArray[np.generic] = np.frombuffer(raw, dtype=dtype)
        return values
