"""Messages to and from the child process that decompresses glTF files (`packed_child`)."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

import msgspec

INDICES: Final = ""
"""Key of a mesh's triangles among its attributes; no attribute has this name."""
LIMITS_ROW: Final = "unpacker"
"""Row of `app.child_limits.LIMITS`."""
Mode: TypeAlias = Literal["ATTRIBUTES", "TRIANGLES", "INDICES"]
Filter: TypeAlias = Literal["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"]


class MeshoptPart(msgspec.Struct, frozen=True, tag="meshopt"):
    """A buffer view with EXT_meshopt_compression: ``count`` elements of ``stride`` bytes."""

    data: bytes
    count: int
    stride: int
    mode: Mode
    filter: Filter


class DracoPart(msgspec.Struct, frozen=True, tag="draco"):
    """A primitive with KHR_draco_mesh_compression: Draco's ids of its attributes, by name in the file."""

    data: bytes
    attributes: dict[str, int]


PackedPart: TypeAlias = MeshoptPart | DracoPart


class PackedParts(msgspec.Struct, frozen=True):
    """Request to decompress parts to at most ``most_bytes`` in total."""

    parts: list[PackedPart]
    most_bytes: int


class UnpackedArray(msgspec.Struct, frozen=True):
    """An array decompressed by the child process: the bytes of rows of ``width`` numbers of the type ``kind``
    (`numpy.dtype.str`).
    """

    kind: str
    width: int
    data: bytes
