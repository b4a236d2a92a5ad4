"""Encoding of a tree of records (`Element`) as the bytes of a binary FBX file.

Handles records, properties and the footer, not scenes. Layout: `FBX binary file format specification
<https://code.blender.org/2013/08/fbx-binary-file-format-specification/>`_; identifiers were measured with the FBX SDK's
own reader, which treats a file as empty if FileId, CreationTime and footer id do not match.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from operator import attrgetter
from typing import Any, Final, TypeAlias

import deflate
import msgspec
import numpy as np
import numpy.typing as npt

MAGIC = b"Kaydara FBX Binary  \0\x1a\0"
VERSION = 7400
LARGE_VERSION = 7500
"""File version with 64-bit offsets, used only for large files, since older programs refuse it."""

# A fixed creation time with its matching ids, so that the same scene gives the same bytes.
CREATION_TIME = "1970-01-01 10:00:00:000"
FILE_ID = bytes.fromhex("28b32aebb624ccc2bfc8b02aa92bfcf1")
FOOTER_ID = bytes.fromhex("fabcab09d0c8d466b176fb831cf7267e")
FOOTER_END = bytes.fromhex("f85a8c6adef5d97eece90ce3758f290b")

_LARGEST_OFFSET = 2**31 - 1
_RAW_ARRAY_BYTES = 128
_SMALL_BYTES = 1024
"""Records up to this size in bytes are joined before writing."""
_LEVEL = 1

_ARRAY_CODES = {"f4": b"f", "f8": b"d", "i4": b"i", "i8": b"l", "b1": b"b"}


@dataclass(frozen=True, slots=True, eq=False)
class PackedArray:
    """An array in the form in which FBX stores it; several records may share one, so that it is compressed once."""

    encoded: bytes


Property: TypeAlias = (
    "bool | np.int16 | np.int32 | np.int64 | np.float32 | float | str | bytes | npt.NDArray[np.generic] | PackedArray"
)


class Element(msgspec.Struct, frozen=True, eq=False):
    """A record of an FBX file: name, properties and nested records.

    Attributes
    ----------
    name : str
        Name, ASCII, at most 255 characters.
    properties : tuple of Property
        Values; the Python type determines the code in the file: bool C, np.int16 Y, np.int32 I, np.int64 L, np.float32
        F, float D, str S, bytes R, one-dimensional arrays of float32 f, float64 d, int32 i, int64 l, bool b. A plain
        int is refused, since its width is ambiguous.
    children : tuple of Element or None
        Nested records; None for no nested block, ``()`` for an empty block, which some records require.
    """

    name: str
    properties: tuple[Property, ...] = ()
    children: tuple[Element, ...] | None = None

    def child(self, name: str) -> Element | None:
        """Return the first child with a name; None if there is none."""
        return next((child for child in self.children or () if child.name == name), None)


def pack_array(values: npt.NDArray[np.generic], *, compress: bool = True) -> PackedArray:
    """Encode a one-dimensional array, compressed if that saves space.

    Raises
    ------
    TypeError
        The array's type has no code in the file.
    """
    code = _ARRAY_CODES.get(values.dtype.str[1:])
    if code is None or values.ndim != 1:
        raise TypeError(f"no FBX array of {values.dtype} with {values.ndim} dimensions")
    raw = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<")).tobytes()
    encoding = 0
    if compress and len(raw) > _RAW_ARRAY_BYTES:
        raw, encoding = bytes(deflate.zlib_compress(raw, _LEVEL)), 1
    return PackedArray(code + struct.pack("<III", len(values), encoding, len(raw)) + raw)


def element_pieces(elements: Sequence[Element]) -> list[bytes]:
    """Encode a whole FBX file, and return its bytes in pieces; large arrays are not copied.

    Parameters
    ----------
    elements : sequence of Element
        Top-level records in order; FileId and CreationTime must be `FILE_ID` and `CREATION_TIME`.
    """
    writer = _Writer(VERSION)
    writer.file(elements)
    if writer.position > _LARGEST_OFFSET:
        writer = _Writer(LARGE_VERSION)
        writer.file([_of_version(element, LARGE_VERSION) for element in elements])
    return writer.chunks


def _of_version(element: Element, version: int) -> Element:
    """Return the header record with the FBX version replaced; other records unchanged."""
    if element.name != "FBXHeaderExtension" or element.children is None:
        return element
    said = Element("FBXVersion", (np.int32(version),))
    children = tuple(said if child.name == "FBXVersion" else child for child in element.children)
    return Element(element.name, element.properties, children)


class _Writer:
    def __init__(self, version: int) -> None:
        self._version = version
        self._head = struct.Struct("<IIIB" if version < LARGE_VERSION else "<QQQB")
        self._null = bytes(self._head.size)
        self.chunks: list[bytes] = []
        self.position = 0

    def file(self, elements: Sequence[Element]) -> None:
        self._add(MAGIC + struct.pack("<I", self._version))
        for element in elements:
            self._record(element)
        self._add(self._null)
        self._add(FOOTER_ID + bytes(4))
        self._add(bytes(16 - self.position % 16))
        self._add(struct.pack("<I", self._version) + bytes(120) + FOOTER_END)

    def _add(self, chunk: bytes) -> None:
        self.chunks.append(chunk)
        self.position += len(chunk)

    def _record(self, element: Element) -> None:
        name, properties = element.name.encode("ascii"), [_encode_property(value) for value in element.properties]
        property_bytes = sum(map(len, properties))
        start = len(self.chunks)
        self.position += self._head.size + len(name) + property_bytes
        if element.children is None:
            head = self._head_of(properties, property_bytes, name)
            if property_bytes < _SMALL_BYTES:
                self.chunks.append(b"".join((head, name, *properties)))
            else:
                self.chunks += (head, name, *properties)
            return
        self.chunks += (b"", name, *properties)
        for child in element.children:
            self._record(child)
        self._add(self._null)
        self.chunks[start] = self._head_of(properties, property_bytes, name)

    def _head_of(self, properties: list[bytes], property_bytes: int, name: bytes) -> bytes:
        """Encode the head of the record that ends at the present position, including its length."""
        if self.position > _LARGEST_OFFSET and self._version < LARGE_VERSION:
            return self._null
        return self._head.pack(self.position, len(properties), property_bytes, len(name))


def _encode_property(value: Property) -> bytes:
    encode = _ENCODERS.get(type(value))
    if encode is None:
        raise TypeError(f"no FBX property for {type(value).__name__}")
    return encode(value)


def _scalar(layout: str, code: bytes) -> Callable[[Any], bytes]:
    pack = struct.Struct(layout).pack
    return lambda value: pack(code, value)


@lru_cache(maxsize=4096)
def _text(value: str) -> bytes:
    text = value.encode("utf-8", "surrogateescape")
    return b"S" + struct.pack("<I", len(text)) + text


_ENCODERS: Final[dict[type, Callable[[Any], bytes]]] = {
    PackedArray: attrgetter("encoded"),
    np.ndarray: lambda value: pack_array(value).encoded,
    str: _text,
    bytes: lambda value: b"R" + struct.pack("<I", len(value)) + value,
    bool: _scalar("<c?", b"C"),
    np.bool_: _scalar("<c?", b"C"),
    np.int16: _scalar("<ch", b"Y"),
    np.int32: _scalar("<ci", b"I"),
    np.int64: _scalar("<cq", b"L"),
    np.float32: _scalar("<cf", b"F"),
    float: _scalar("<cd", b"D"),
    np.float64: _scalar("<cd", b"D"),
}
