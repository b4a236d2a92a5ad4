"""Checked access to the parts of a glTF document: fields, buffers, accessors.

Documents are untrusted, so every index, offset and size is checked before bytes are accessed. Source: Khronos, "glTF
2.0 Specification", section 3.6.
"""

from __future__ import annotations

import base64
import binascii
from typing import Any

import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray, IntArray
from app.errors import FileError, shortened
from app.formats.gltf.container import field

COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}

# Total bytes that decoding may take: this and a multiple of the file's size. Accessors may overlap, be used many times
# or need no bytes, so a small file could request any amount; the most that a real file needs is eight times its size
# (numbers stored as bytes), or more if primitives share accessors.
_FREE_BYTES = 2**23
_MOST_TIMES = 32
_MOST_TIMES_UNPACKED = 8

# Extensions that can be ignored here: they change only materials or add information.
_HARMLESS = (
    *("KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "KHR_lights_punctual"),
    # Integer attributes are read with or without it.
    "KHR_mesh_quantization",
    *("VRMC_", "VRM"),
)


class Accessors:
    """A glTF document with its bytes; every method raises FileError for invalid data.

    Parameters
    ----------
    size : int
        Size of the file in bytes.
    unpacked : bytes
        Content of the last buffer if it holds decompressed data (`app.formats.gltf.packed`).
    """

    def __init__(
        self, document: dict[str, Any], binary: bytes | None, file: str, size: int, unpacked: bytes = b""
    ) -> None:
        self.document = document
        self._binary = binary
        self.file = file
        self._left_bytes = _FREE_BYTES + _MOST_TIMES * size + _MOST_TIMES_UNPACKED * len(unpacked)
        self._unpacked = unpacked
        self._lists: dict[str, list[Any]] = {}
        required = document.get("extensionsRequired")
        for name in required if isinstance(required, list) else []:
            if not str(name).startswith(_HARMLESS):
                id = "gltf.compressed" if "compression" in str(name) else "gltf.unsupported"
                raise FileError(id, file=file, what=shortened(str(name), 60))
        self._buffers = [self._buffer(buffer, index) for index, buffer in enumerate(self.items("buffers"))]

    # -------------------------------------------------------------------------------------------- checked fields

    def damaged(self, what: str) -> FileError:
        return FileError("gltf.damaged", file=self.file, what=what)

    def items(self, name: str, owner: object = None) -> list[Any]:
        if owner is not None:
            return self._list(owner, name)
        if name not in self._lists:
            # Parsed once, since each element refers to it.
            self._lists[name] = self._list(self.document, name)
        return self._lists[name]

    def _list(self, owner: object, name: str) -> list[Any]:
        values = field(owner, name)
        if values is None:
            return []
        if not isinstance(values, list) or any(value is None for value in values):
            raise self.damaged(name)
        return values

    def mapping(self, owner: object, name: str) -> dict[str, Any]:
        values = field(owner, name)
        return values if isinstance(values, dict) else {}

    def text(self, owner: object, name: str, otherwise: str) -> str:
        value = field(owner, name)
        return value if isinstance(value, str) and value else otherwise

    def number(self, owner: object, name: str, otherwise: int | None = None) -> int:
        """Return a count, offset or code of a JSON object: a non-negative integer, or ``otherwise`` if it is
        missing.
        """
        value = field(owner, name)
        if value is None and otherwise is not None:
            return otherwise
        if not isinstance(value, int) or isinstance(value, bool) or value < 0:
            raise self.damaged(name)
        return value

    def index(self, value: object, count: int, what: str) -> int:
        if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < count:
            raise self.damaged(what)
        return value

    def optional_index(self, owner: object, name: str, count: int) -> int | None:
        value = field(owner, name)
        return None if value is None else self.index(value, count, name)

    def floats(self, owner: object, name: str, otherwise: tuple[float, ...]) -> tuple[float, ...]:
        values = field(owner, name)
        if values is None or values == []:
            return otherwise
        return self.finite(values, len(otherwise), name)

    def finite(self, values: object, count: int, what: str) -> tuple[float, ...]:
        if not isinstance(values, list | tuple) or len(values) != count:
            raise self.damaged(what)
        if not all(isinstance(v, int | float) and not isinstance(v, bool) and abs(v) < 1e30 for v in values):
            raise self.damaged(what)
        return tuple(float(value) for value in values)

    # ------------------------------------------------------------------------------------- buffers and accessors

    def _buffer(self, buffer: object, index: int) -> bytes:
        uri = field(buffer, "uri")
        if uri is None:
            last = bool(self._unpacked) and index == len(self.items("buffers")) - 1
            data = self._unpacked if last else self._binary if index == 0 else None
        elif isinstance(uri, str) and uri.startswith("data:"):
            data = self.data(uri)
        else:
            raise FileError("gltf.external", file=self.file, uri=str(uri)[:200])
        if data is None or len(data) < self.number(buffer, "byteLength"):
            raise self.damaged("buffer")
        return bytes(data)

    def data(self, uri: str) -> bytes:
        """Return the bytes of a base64 data URI. Raises FileError if it is damaged."""
        try:
            return base64.b64decode(uri.partition(",")[2], validate=True)
        except (binascii.Error, ValueError) as error:
            raise self.damaged("data URI") from error

    def blob(self, number: object) -> bytes:
        """Return the bytes of the glTF buffer view with an index, such as a picture."""
        buffer, start, length, _ = self._place(number)
        self.take(length // 8)
        return buffer[start : start + length]

    def _place(self, number: object) -> tuple[bytes, int, int, int]:
        """Return the buffer of a buffer view, and start, length and stride (0 if none) of the view in it."""
        views = self.items("bufferViews")
        view = views[self.index(number, len(views), "bufferView")]
        return *self._span(view), self.number(view, "byteStride", 0)

    def _span(self, view: object) -> tuple[bytes, int, int]:
        """Return the bytes of the buffer to which a buffer view of glTF refers, and start and length of the view in it.
        Raises FileError if it exceeds the buffer."""
        buffer = self._buffers[self.index(field(view, "buffer"), len(self._buffers), "buffer")]
        start, length = self.number(view, "byteOffset", 0), self.number(view, "byteLength")
        if start + length > len(buffer):
            raise self.damaged("bufferView")
        return buffer, start, length

    def part_of_buffer(self, view: object) -> bytes:
        """Return the bytes described by a JSON object that has the fields of a buffer view."""
        buffer, start, length = self._span(view)
        self.take(length // 8)
        return buffer[start : start + length]

    def take(self, numbers: int) -> None:
        """Count numbers that are about to be allocated; raise FileError if the file expands more than real files do.

        Parameters
        ----------
        numbers : int
            Count of 8-byte numbers.
        """
        self._left_bytes -= 8 * numbers
        if self._left_bytes < 0:
            raise FileError("gltf.too_large", file=self.file)

    def _view(self, number: object, offset: int, count: int, dtype: np.dtype[Any], width: int) -> npt.NDArray[Any]:
        """Return a copy of elements (count, width) of a buffer view, from an offset in bytes."""
        buffer, start, length, stride = self._place(number)
        element = dtype.itemsize * width
        stride = stride or element
        if count and offset + stride * (count - 1) + element > length:
            raise self.damaged("bufferView")
        if stride < element:
            raise self.damaged("byteStride")
        self.take(count * width)
        rows = np.ndarray((count, width), dtype, buffer, start + offset, (stride, dtype.itemsize)) if count else None
        return np.empty((0, width), dtype) if rows is None else rows.copy()

    def _accessor(self, number: object) -> tuple[Any, np.dtype[Any], int, int]:
        """Return the glTF accessor with an index, its data type, the numbers per element, and the count of elements."""
        accessors = self.items("accessors")
        accessor = accessors[self.index(number, len(accessors), "accessor")]
        component = COMPONENTS.get(self.number(accessor, "componentType"))
        width = WIDTHS.get(self.text(accessor, "type", ""))
        if component is None or width is None:
            raise self.damaged("accessor type")
        return accessor, np.dtype(component), width, self.number(accessor, "count")

    def _sparse(self, accessor: object, dtype: np.dtype[Any], width: int, count: int) -> tuple[IntArray, Any]:
        """Return the indices (K,) of the elements that a sparse accessor of glTF replaces, and their values (K,
        width)."""
        sparse = field(accessor, "sparse")
        if sparse is None:
            return np.empty(0, dtype=np.int64), np.empty((0, width), dtype)
        changed = self.number(sparse, "count")
        places, values = field(sparse, "indices"), field(sparse, "values")
        index_type = COMPONENTS.get(self.number(places, "componentType"))
        if index_type not in ("<u1", "<u2", "<u4"):
            raise self.damaged("sparse indices")
        offset = self.number(places, "byteOffset", 0)
        indices = self._view(field(places, "bufferView"), offset, changed, np.dtype(index_type), 1)
        rows = indices[:, 0].astype(np.int64)
        if changed and (rows[-1] >= count or (np.diff(rows) <= 0).any()):
            raise self.damaged("sparse indices")
        offset = self.number(values, "byteOffset", 0)
        return rows, self._view(field(values, "bufferView"), offset, changed, dtype, width)

    def _scaled(self, accessor: object, values: npt.NDArray[Any]) -> FloatArray:
        """Return an accessor's values as floats; integers marked as normalised become fractions -1..1. Raises FileError
        for values that are not finite."""
        with np.errstate(invalid="ignore"):  # values that are not numbers are refused below
            result = values.astype(np.float64)
        if field(accessor, "normalized") is True and values.dtype.kind != "f":
            result = np.maximum(result / np.iinfo(values.dtype).max, -1.0)
        if not np.isfinite(result).all():
            raise self.damaged("accessor value")
        return result

    def _elements(self, number: object) -> tuple[object, npt.NDArray[Any]]:
        accessor, dtype, width, count = self._accessor(number)
        rows, changed = self._sparse(accessor, dtype, width, count)
        if field(accessor, "bufferView") is None:
            self.take(count * width)
            values = np.zeros((count, width), dtype)
        else:
            offset = self.number(accessor, "byteOffset", 0)
            values = self._view(field(accessor, "bufferView"), offset, count, dtype, width)
        values[rows] = changed
        return accessor, values

    def real(self, number: object, width: int) -> FloatArray:
        """Return the glTF accessor with an index as floats (N, width). Raises FileError for another width."""
        accessor, values = self._elements(number)
        if values.shape[1] != width:
            raise self.damaged("accessor type")
        return self._scaled(accessor, values)

    def weights(self, number: object, width: int) -> FloatArray:
        """Return the accessor with an index as skin weights (N, width).

        Values that are not numbers become 0, since some exporters divide 0 by 0 for vertices that no bone moves.
        """
        accessor, values = self._elements(number)
        if values.shape[1] != width:
            raise self.damaged("accessor type")
        if values.dtype.kind == "f":
            values = np.where(np.isfinite(values), values, 0.0).astype(values.dtype)
        return self._scaled(accessor, values)

    def whole(self, number: object, width: int) -> IntArray:
        """Return the glTF accessor with an index as unsigned integers (N, width). Raises FileError for another type or
        width."""
        _, values = self._elements(number)
        if values.shape[1] != width or values.dtype.kind != "u":
            raise self.damaged("accessor type")
        return values.astype(np.int64)

    def changes(self, number: object, count: int) -> tuple[IntArray, FloatArray]:
        """Return the indices (K,) and values (K, 3) of the non-zero rows of an accessor of ``count`` rows, without
        expanding sparse ones.
        """
        accessor, dtype, width, length = self._accessor(number)
        if width != 3 or length != count:
            raise self.damaged("morph target")
        if field(accessor, "bufferView") is None:
            rows, values = self._sparse(accessor, dtype, width, length)
            deltas = self._scaled(accessor, values)
        else:
            deltas = self.real(number, 3)
            rows = np.arange(count)
        moved = (deltas[:, 0] != 0.0) | (deltas[:, 1] != 0.0) | (deltas[:, 2] != 0.0)
        return rows[moved], deltas[moved]
