"""Decompression of the meshes and buffers of glTF documents.

Supports KHR_draco_mesh_compression (with DracoPy) and EXT_meshopt_compression, also under its later KHR name (with
meshopt), in a separate process. Source: the extensions' texts in Khronos' glTF repository.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, get_args

import msgspec
import numpy as np

from app.errors import FileError
from app.formats.gltf.accessors import COMPONENTS, WIDTHS, Accessors
from app.formats.gltf.container import field as member
from app.formats.gltf.packed_parts import (
    INDICES,
    LIMITS_ROW,
    DracoPart,
    Filter,
    MeshoptPart,
    Mode,
    PackedPart,
    PackedParts,
    UnpackedArray,
)
from app.formats.reading_child import NO_MEMORY, NO_READER, UNREADABLE, read_by_child

DRACO: Final = "KHR_draco_mesh_compression"
MESHOPT: Final = ("EXT_meshopt_compression", "KHR_meshopt_compression")
FREE_BYTES: Final = 2**23
MOST_TIMES: Final = 64
"""Limit of the decompressed size: a fixed number of bytes plus this multiple of the file's size. Real files need 2 to
20 times.
"""
_NOTHING: Final = {"byteLength": 0, "uri": "data:,"}


def unpacked(document: dict[str, Any], binary: bytes | None, file: str, size: int) -> tuple[dict[str, Any], bytes]:
    """Decompress everything compressed in a document.

    Parameters
    ----------
    document, binary
        Parts of the file, from `app.formats.gltf.container.split`.
    size : int
        Size of the file in bytes.

    Returns
    -------
    dict of str to Any
        The document without compression; the same object if there is none.
    bytes
        Content of its last buffer, which has no address in the document; empty if nothing was decompressed.

    Raises
    ------
    FileError
        The data is damaged or too large, or the required library is not installed.
    """
    required = document.get("extensionsRequired")
    required = required if isinstance(required, list) else []
    known = [name for name in required if name in (DRACO, *MESHOPT)]
    if not known:
        return document, b""
    plain = {**document, "extensionsRequired": [name for name in required if name not in known]}
    buffers = member(document, "buffers")
    if isinstance(buffers, list):
        plain["buffers"] = [_NOTHING if _is_fallback(buffer) else buffer for buffer in buffers]
    unpacking = _Unpacking(Accessors(plain, binary, file, size), known)
    unpacking.collect()
    if unpacking.parts:
        unpacking.put(_answer(unpacking.parts, file, size, known))
    return unpacking.document, bytes(unpacking.data)


def _is_fallback(buffer: object) -> bool:
    """Return whether a buffer has no bytes, because all of its views are compressed."""
    extensions = member(buffer, "extensions")
    marked = any(member(member(extensions, name), "fallback") is True for name in MESHOPT)
    return marked and member(buffer, "uri") is None


@dataclass(eq=False)
class _Unpacking:
    """State while the compressed parts of a document are replaced.

    Attributes
    ----------
    reader : Accessors
        Access to the document.
    required : sequence of str
        Extensions required to read it.
    parts : list of PackedPart
        The compressed parts.
    places : list
        Place of each part: index of a view, or indices of a mesh and its primitive.
    data : bytearray
        Bytes of the buffer with decompressed data.
    """

    reader: Accessors
    required: Sequence[str]
    parts: list[PackedPart] = field(default_factory=list)
    places: list[int | tuple[int, int]] = field(default_factory=list)
    data: bytearray = field(default_factory=bytearray)

    def __post_init__(self) -> None:
        reader = self.reader
        self.document = {
            **reader.document,
            "buffers": list(reader.items("buffers")),
            "bufferViews": list(reader.items("bufferViews")),
            "accessors": list(reader.items("accessors")),
            "meshes": [
                {**mesh, "primitives": list(reader.items("primitives", mesh))} if isinstance(mesh, dict) else mesh
                for mesh in reader.items("meshes")
            ],
        }

    def collect(self) -> None:
        """Collect the compressed parts of the glTF document, which a child process decompresses."""
        reader, views = self.reader, self.document["bufferViews"]
        for number, view in enumerate(views):
            extensions = reader.mapping(view, "extensions")
            name = next((name for name in MESHOPT if name in self.required and extensions.get(name)), None)
            if name is not None:
                self.parts.append(self._meshopt(extensions[name]))
                self.places.append(number)
        if DRACO not in self.required:
            return
        for number, mesh in enumerate(self.document["meshes"]):
            for order, primitive in enumerate(reader.items("primitives", mesh)):
                packed = reader.mapping(primitive, "extensions").get(DRACO)
                if packed is not None:
                    ids = reader.mapping(packed, "attributes")
                    attributes = {name: reader.number(ids, name) for name in ids}
                    self.parts.append(DracoPart(reader.blob(member(packed, "bufferView")), attributes))
                    self.places.append((number, order))

    def _meshopt(self, packed: object) -> MeshoptPart:
        reader = self.reader
        mode, filtering = reader.text(packed, "mode", ""), reader.text(packed, "filter", "NONE")
        stride = reader.number(packed, "byteStride")
        if mode not in get_args(Mode) or filtering not in get_args(Filter) or not 0 < stride <= 256:
            raise reader.damaged("bufferView")
        return MeshoptPart(reader.part_of_buffer(packed), reader.number(packed, "count"), stride, mode, filtering)  # type: ignore[arg-type]

    def put(self, unpacked: Sequence[Mapping[str, UnpackedArray]]) -> None:
        """Replace the compressed parts by their decompressed data, in a new buffer."""
        self.document["buffers"].append({"byteLength": 0})
        for place, part, arrays in zip(self.places, self.parts, unpacked, strict=True):
            if isinstance(part, MeshoptPart) and isinstance(place, int):
                view = self._view(arrays[INDICES].data)
                if part.mode == "ATTRIBUTES":
                    view["byteStride"] = part.stride
                self.document["bufferViews"][place] = view
            elif isinstance(place, tuple):
                self._put_primitive(*place, arrays)
        self.document["buffers"][-1]["byteLength"] = len(self.data)

    def _put_primitive(self, mesh: int, order: int, arrays: Mapping[str, UnpackedArray]) -> None:
        primitives = self.document["meshes"][mesh]["primitives"]
        primitive = dict(primitives[order])
        attributes = dict(self.reader.mapping(primitive, "attributes"))
        for name, array in arrays.items():
            if name == INDICES:
                primitive["indices"] = self._accessor(primitive.get("indices"), array, "SCALAR")
            else:
                attributes[name] = self._accessor(attributes.get(name), array, "")
        primitives[order] = {**primitive, "attributes": attributes}

    def _accessor(self, number: object, array: UnpackedArray, otherwise: str) -> int:
        """Add an accessor of decompressed values with the type of the original accessor (else ``otherwise``), and
        return its index.
        """
        accessors = self.reader.items("accessors")
        own = accessors[self.reader.index(number, len(accessors), "accessor")] if number is not None else {}
        kind = self.reader.text(own, "type", otherwise)
        values = np.frombuffer(array.data, np.dtype(array.kind))
        code = self.reader.number(own, "componentType", 5125)
        if code not in COMPONENTS or WIDTHS.get(kind) != array.width:
            raise self.reader.damaged("accessor type")
        with np.errstate(invalid="ignore"):
            data = values.astype(COMPONENTS[code]).tobytes()
        self.document["bufferViews"].append(self._view(data))
        accessor = {"bufferView": len(self.document["bufferViews"]) - 1, "componentType": code, "type": kind}
        self.document["accessors"].append(
            {**accessor, "count": len(values) // array.width, "normalized": member(own, "normalized") is True}
        )
        return len(self.document["accessors"]) - 1

    def _view(self, data: bytes) -> dict[str, Any]:
        """Append bytes to the glTF buffer, padded to four bytes, and return the JSON of a buffer view on them."""
        start = len(self.data)
        self.data += data + bytes(-len(data) % 4)
        return {"buffer": len(self.document["buffers"]) - 1, "byteOffset": start, "byteLength": len(data)}


def _answer(
    parts: list[PackedPart], file: str, size: int, names: Sequence[str]
) -> Sequence[Mapping[str, UnpackedArray]]:
    """Decompress parts of a glTF file in a child process with limited memory, and return the arrays of each part by
    name.

    Raises
    ------
    FileError
        The parts are damaged, or too large when decompressed.
    """
    most = FREE_BYTES + MOST_TIMES * size
    if sum(part.count * part.stride for part in parts if isinstance(part, MeshoptPart)) > most:
        raise FileError("gltf.too_large", file=file)
    request = msgspec.msgpack.encode(PackedParts(parts, most))
    status, printed = read_by_child("app.formats.gltf.packed_child", LIMITS_ROW, request, file)
    if status == NO_MEMORY:
        raise FileError("gltf.too_large", file=file)
    if status == NO_READER:
        package = printed.decode("utf-8", "replace")
        raise FileError("gltf.no_unpacker", file=file, what=", ".join(names), package=package)
    if status:
        detail = printed.decode("utf-8", "replace") if status == UNREADABLE else f"its reader ended with {status}"
        raise FileError("gltf.packed_damaged", file=file, what=", ".join(names), detail=detail)
    try:
        return msgspec.msgpack.decode(printed, type=list[dict[str, UnpackedArray]])
    except msgspec.MsgspecError as error:
        raise FileError("gltf.packed_damaged", file=file, what=", ".join(names), detail=str(error)) from error
