"""A glTF document under construction: its JSON, and the bytes of its accessors."""

from __future__ import annotations

from dataclasses import dataclass, field
from hashlib import blake2b
from typing import Any

import numpy as np
import numpy.typing as npt
import pygltflib as gltf

from app.arrays import AnyIntArray, SingleArray

_COMPONENTS = {
    np.dtype(np.uint8): gltf.UNSIGNED_BYTE,
    np.dtype(np.uint16): gltf.UNSIGNED_SHORT,
    np.dtype(np.uint32): gltf.UNSIGNED_INT,
    np.dtype(np.float32): gltf.FLOAT,
}
_TYPES = {1: gltf.SCALAR, 2: gltf.VEC2, 3: gltf.VEC3, 4: gltf.VEC4, 16: gltf.MAT4}

Pieces = list[bytes | memoryview]


@dataclass
class _Buffer:
    """The binary chunk while it is built: one buffer view for each kind of data; equal data is stored once."""

    views: list[gltf.BufferView] = field(default_factory=list)
    _index: dict[str, int] = field(default_factory=dict)
    _parts: list[list[npt.NDArray[Any]]] = field(default_factory=list)
    _starts: dict[tuple[str, bytes], int] = field(default_factory=dict)

    def add(self, kind: str, values: npt.NDArray[Any], target: int | None, stride: int | None) -> tuple[int, int]:
        """Add an array to the buffer view for its kind and stride. Return the index of the view, and the offset within
        it in bytes.
        """
        kind = f"{kind} {stride}"
        if kind not in self._index:
            self._index[kind] = len(self.views)
            self.views.append(gltf.BufferView(buffer=0, byteLength=0, byteStride=stride, target=target))
            self._parts.append([])
        view = self._index[kind]
        data = np.ascontiguousarray(values).reshape(-1).view(np.uint8)
        there: int = self.views[view].byteLength + -self.views[view].byteLength % 4
        start = self._starts.setdefault((kind, blake2b(data.data).digest()), there)
        if start != there:
            return view, start
        padding = -len(data) % 4
        self._parts[view] += [data, np.zeros(padding, np.uint8)] if padding else [data]
        self.views[view].byteLength = there + len(data)
        return view, start

    def pieces(self) -> Pieces:
        """Return all bytes, and set the offsets of the buffer views."""
        start = 0
        for view in self.views:
            view.byteOffset = start
            start += view.byteLength + -view.byteLength % 4
        return [part.data for parts in self._parts for part in parts]


@dataclass
class GlbDocument:
    """A glTF document and its binary data while they are built."""

    gltf: gltf.GLTF2
    buffer: _Buffer = field(default_factory=_Buffer)

    def use_extension(self, name: str) -> None:
        """Add an extension to those that the file states it uses."""
        if name not in (self.gltf.extensionsUsed or []):
            self.gltf.extensionsUsed = [*(self.gltf.extensionsUsed or []), name]

    def accessor(
        self,
        kind: str,
        values: npt.NDArray[Any],
        *,
        target: int | None = None,
        bounds: bool = False,
        flat: bool = False,
    ) -> int:
        """Add an accessor of values (N,) or (N, width), and return its index. ``kind`` names the data with which it
        shares a buffer view; with ``flat`` every number is an element.
        """
        width = 1 if flat or values.ndim == 1 else values.shape[1]
        stride = values.itemsize * width if target == gltf.ARRAY_BUFFER else None
        view, start = self.buffer.add(kind, values, target, stride)
        return self._add(
            gltf.Accessor(
                bufferView=view,
                byteOffset=start,
                componentType=_COMPONENTS[values.dtype],
                count=values.size // width,
                type=_TYPES[width],
                min=listed(values.reshape(-1, width).min(axis=0)) if bounds else None,
                max=listed(values.reshape(-1, width).max(axis=0)) if bounds else None,
            )
        )

    def sparse(self, count: int, rows: AnyIntArray, values: SingleArray) -> int:
        """Add a sparse accessor of vectors (count, 3) with few non-zero rows, and return its index."""
        if not len(rows):  # legal without any, but assimp refuses an accessor without bytes
            rows, values = np.zeros(1, np.int64), np.zeros((1, 3), np.float32)
        bounds = values if len(rows) == count else np.concatenate([np.zeros((1, 3), np.float32), values])
        indices = rows.astype(np.uint16 if count <= 2**16 else np.uint32)
        index_view, index_start = self.buffer.add("sparse indices", indices, None, None)
        value_view, value_start = self.buffer.add("sparse values", values, None, None)
        accessor = gltf.Accessor(
            # Without a buffer view there is no offset, which the library would set.
            byteOffset=None,
            componentType=gltf.FLOAT,
            count=count,
            type=gltf.VEC3,
            min=listed(bounds.min(axis=0)),
            max=listed(bounds.max(axis=0)),
            sparse=gltf.Sparse(
                count=len(rows),
                indices=gltf.AccessorSparseIndices(
                    bufferView=index_view, byteOffset=index_start, componentType=_COMPONENTS[indices.dtype]
                ),
                values=gltf.AccessorSparseValues(bufferView=value_view, byteOffset=value_start),
            ),
        )
        return self._add(accessor)

    def blob(self, kind: str, content: bytes) -> int:
        """Add bytes, such as an image, to the buffer as a view of their own, and return the view's index."""
        return self.buffer.add(kind, np.frombuffer(content, np.uint8), None, None)[0]

    def _add(self, accessor: gltf.Accessor) -> int:
        self.gltf.accessors.append(accessor)
        return len(self.gltf.accessors) - 1


def listed(values: npt.NDArray[Any]) -> list[float]:
    """Return the numbers of an array as a list of floats for JSON."""
    return [float(value) for value in values]
