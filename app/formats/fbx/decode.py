"""Bytes of a binary FBX file -> Element tree.

Meant for files of any origin: every length is checked before it is believed, records may nest only so deep, and an
array is never unpacked to more than its compressed bytes can hold.

Messages (all with ``file`` and the ``offset`` of the trouble in bytes): ``fbx.not_binary``, ``fbx.truncated``,
``fbx.bad_record``, ``fbx.bad_property``, ``fbx.bad_array``, ``fbx.too_large``, ``fbx.too_deep``.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable
from threading import Lock
from typing import Any

import numpy as np
import numpy.typing as npt

from app.errors import FileError
from app.formats.fbx.encode import LARGE_VERSION, MAGIC, Element, Property

_DEEPEST = 32
"""Files of real programs nest up to about 8 records."""

# DEFLATE cannot pack more than 1032 bytes into one.
_LARGEST_RATIO = 1032
# What all packed arrays may take together: this and a multiple of the file's size. What stands still packs well.
_FREE_BYTES = 2**26
_MOST_TIMES = 256

_MOST_KEPT_BYTES, _LARGEST_KEPT_BYTES = 2**25, 2**21
_Packed = tuple[np.dtype[np.generic], int, bytes]

_ARRAYS = {b"f": "<f4", b"d": "<f8", b"i": "<i4", b"l": "<i8", b"b": "?", b"c": "u1"}
_SCALARS = {b"C": "<?", b"B": "<?", b"Y": "<h", b"I": "<i", b"L": "<q", b"F": "<f", b"D": "<d"}
_SCALAR_TYPES: dict[bytes, Callable[[Any], Property]] = {
    b"C": bool,
    b"B": bool,
    b"Y": np.int16,
    b"I": np.int32,
    b"L": np.int64,
    b"F": np.float32,
    b"D": float,
}


def read_elements(data: bytes, file: str) -> Element:
    """Decode a whole file.

    Parameters
    ----------
    file : str
        Its name, for messages.

    Returns
    -------
    Element
        Nameless, with the file's version as an int32 property and the top level as its children.

    Raises
    ------
    FileError
        If anything about the bytes is wrong; see the module's messages.
    """
    if len(data) < len(MAGIC) + 4 or not data.startswith(MAGIC[:20]):
        raise FileError("fbx.not_binary", file=file)
    (version,) = struct.unpack_from("<I", data, len(MAGIC))
    reader = _Reader(data, file, version)
    children, _ = reader.block(len(MAGIC) + 4, len(data), 0)
    return Element("", (np.int32(version & 0x7FFFFFFF),), children)


class _Arrays:
    """Arrays by what they are packed as, some of those that were unpacked last: players with the same body have the
    same meshes."""

    def __init__(self) -> None:
        self._kept: dict[_Packed, npt.NDArray[np.generic]] = {}
        self._bytes = 0
        self._lock = Lock()

    def get(self, packed: _Packed) -> npt.NDArray[np.generic] | None:
        return self._kept.get(packed)

    def keep(self, packed: _Packed, values: npt.NDArray[np.generic]) -> None:
        size = values.nbytes + len(packed[2])
        if size > _LARGEST_KEPT_BYTES:
            return
        with self._lock:
            if self._bytes + size > _MOST_KEPT_BYTES:
                self._kept, self._bytes = {}, 0
            if packed not in self._kept:
                self._kept[packed] = values
                self._bytes += size


_arrays = _Arrays()


class _Reader:
    def __init__(self, data: bytes, file: str, version: int) -> None:
        self._data = data
        self._file = file
        self._left_bytes = _FREE_BYTES + _MOST_TIMES * len(data)
        self._unpacked: dict[_Packed, npt.NDArray[np.generic]] = {}
        self._head = struct.Struct("<IIIB" if version < LARGE_VERSION else "<QQQB")

    def _error(self, what: str, offset: int) -> FileError:
        return FileError(f"fbx.{what}", file=self._file, offset=offset)

    def block(self, position: int, end: int, depth: int) -> tuple[tuple[Element, ...], int]:
        """Records up to the all-zero head that closes them; and where that ends."""
        if depth > _DEEPEST:
            raise self._error("too_deep", position)
        elements: list[Element] = []
        while True:
            if position + self._head.size > end:
                raise self._error("truncated" if end == len(self._data) else "bad_record", position)
            record_end, count, property_bytes, name_length = self._head.unpack_from(self._data, position)
            if record_end == 0:
                if count or property_bytes or name_length:
                    raise self._error("bad_record", position)
                return tuple(elements), position + self._head.size
            element = self._record(position, end, depth)
            elements.append(element)
            position = record_end

    def _record(self, position: int, limit: int, depth: int) -> Element:
        record_end, count, property_bytes, name_length = self._head.unpack_from(self._data, position)
        start = position + self._head.size + name_length
        stop = start + property_bytes
        if record_end > limit or stop > record_end:
            raise self._error("truncated" if record_end > len(self._data) else "bad_record", position)
        name = self._data[start - name_length : start].decode("latin-1")
        properties: list[Property] = []
        at = start
        for _ in range(count):
            value, at = self._property(at, stop)
            properties.append(value)
        if at != stop:
            raise self._error("bad_record", position)
        children = None
        if stop < record_end:
            children, at = self.block(stop, record_end, depth + 1)
            if at != record_end:
                raise self._error("bad_record", position)
        return Element(name, tuple(properties), children)

    def _property(self, at: int, stop: int) -> tuple[Property, int]:
        code = self._data[at : at + 1]
        body = at + 1
        if at < stop and code in _SCALARS:
            layout = _SCALARS[code]
            end = body + struct.calcsize(layout)
            if end <= stop:
                value: Property = _SCALAR_TYPES[code](struct.unpack_from(layout, self._data, body)[0])
                return value, end
        elif code in (b"S", b"R") and body + 4 <= stop:
            (length,) = struct.unpack_from("<I", self._data, body)
            end = body + 4 + length
            if end <= stop:
                raw = self._data[body + 4 : end]
                return (raw.decode("utf-8", "surrogateescape") if code == b"S" else raw), end
        elif code in _ARRAYS and body + 12 <= stop:
            count, encoding, length = struct.unpack_from("<III", self._data, body)
            end = body + 12 + length
            if end <= stop:
                return self._array(np.dtype(_ARRAYS[code]), count, encoding, body + 12, end), end
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
            # All curves of a clip have the same times.
            packed = dtype, count, bytes(raw)
            found = self._unpacked.get(packed)
            if found is None:
                found = _arrays.get(packed)
                if found is None:
                    found = self._values(dtype, size, self._inflated(raw, size, start), start)
                    _arrays.keep(packed, found)
                self._unpacked[packed] = found
            return found
        if encoding != 0:
            raise self._error("bad_array", start)
        return self._values(dtype, size, raw, start)

    def _inflated(self, raw: memoryview, size: int, start: int) -> bytes:
        inflate = zlib.decompressobj()
        try:
            found = inflate.decompress(raw, size + 1)
        except zlib.error as error:
            raise self._error("bad_array", start) from error
        if not inflate.eof and len(found) <= size:
            raise self._error("bad_array", start)
        return found

    def _values(
        self, dtype: np.dtype[np.generic], size: int, raw: bytes | memoryview, start: int
    ) -> npt.NDArray[np.generic]:
        if len(raw) != size:
            raise self._error("bad_array", start)
        if dtype.kind == "b":  # any nonzero byte means true
            return np.frombuffer(raw, dtype=np.uint8).astype(np.bool_)
        values: npt.NDArray[np.generic] = np.frombuffer(raw, dtype=dtype)
        return values
