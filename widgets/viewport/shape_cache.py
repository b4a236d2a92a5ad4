"""Cache files of geometries for the graphics card, since making those of fifty players takes seconds. Files are
memory-mapped, so that the system reads only the parts that are sent to the card.
"""

from __future__ import annotations

import contextlib
import hashlib
import mmap
import struct
import zlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, BinaryIO, Final

import msgspec
import numpy as np
import numpy.typing as npt

from app.errors import FileError
from app.formats.atomic import atomic_write
from app.formats.cache import cache_folder
from app.formats.files import open_file
from app.formats.json_data import UNREADABLE
from app.formats.table_cache import digest_of
from app.identity_cache import IdentityCache
from app.rig.mesh import Mesh
from widgets.viewport.shape_model import SHAPE, SURFACE, Geometry, MorphTargets

MOST_FILES: Final = 256
"""Greatest number of cached files, two for each character and instrument, earlier versions included; the oldest are
deleted."""
_ALIGNED: Final = 64
_BEGINNING: Final = struct.Struct("<II")
"""Format of the beginning of a file: length of the head, and CRC-32 of the remaining content."""
_KINDS: Final = {
    "shape": SHAPE,
    "surface": SURFACE,
    **{name: np.dtype(name) for name in ("uint16", "uint32", "int32", "float32")},
}
_NAMES: Final = {kind: name for name, kind in _KINDS.items()}


class _Array(msgspec.Struct, frozen=True, array_like=True):
    """Position, type and shape of an array in a cache file; ``start`` counts from the end of the file's head."""

    start: int
    kind: str
    size: tuple[int, ...]


class _Face(msgspec.Struct, frozen=True):
    count: int
    names: tuple[str, ...]
    targets: tuple[tuple[_Array, _Array], ...]
    rest: _Array


class _Level(msgspec.Struct, frozen=True):
    shape: _Array
    surfaces: _Array
    triangles: _Array
    one_sided: int
    face: _Face | None
    surface_of: _Array | None
    uvs: _Array | None
    groups: _Array | None


class _Head(msgspec.Struct, frozen=True):
    levels: tuple[_Level, ...]


# Created while the import lock is held: msgspec crashes if two threads use a type for the first time at once.
_DECODER: Final = msgspec.msgpack.Decoder(_Head)


def kept(
    meshes: Sequence[Mesh], made_with: tuple[object, ...], make: Callable[[], tuple[Geometry, ...]]
) -> tuple[Geometry, ...]:
    """Return the geometries of meshes from the cache, or made by ``make``.

    Parameters
    ----------
    made_with : tuple
        All inputs other than the meshes and the code in this folder.
    """
    path = cache_folder("shapes") / f"{_digest(meshes, made_with)}.shapes"
    found = _read(path)
    if found is not None:
        return found
    made = make()
    # If the cache cannot be written, only the next start takes some tenths of a second longer.
    with contextlib.suppress(OSError, FileError):
        path.parent.mkdir(parents=True, exist_ok=True)
        with atomic_write(path, durable=False) as file:
            _write(file, made)
        files = sorted(path.parent.glob("*.shapes"), key=lambda one: one.stat().st_mtime)
        for older in files[:-MOST_FILES]:
            older.unlink(missing_ok=True)
    return _read(path, just_written=True) or made


def _digest(meshes: Sequence[Mesh], made_with: tuple[object, ...]) -> str:
    digest = hashlib.blake2b(repr((digest_of(Path(__file__).parent), made_with)).encode(), digest_size=16)
    for mesh in meshes:
        digest.update(repr((mesh.materials, [morph.name for morph in mesh.morphs])).encode())
        arrays = (mesh.uvs, mesh.triangles, mesh.triangle_materials, mesh.joints, mesh.weights)
        shared = (*arrays, *(morph.vertices for morph in mesh.morphs))
        digest.update(_SHARED.step(_digest_of, *shared) if mesh.is_skinned else _digest_of(*shared))
        digest.update(_digest_of(mesh.positions_m, mesh.normals, *(morph.deltas_m for morph in mesh.morphs)))
    return digest.hexdigest()


def _digest_of(*arrays: npt.NDArray[Any]) -> bytes:
    digest = hashlib.blake2b(digest_size=16)
    for array in arrays:
        digest.update(repr((array.shape, array.dtype.str)).encode())
        digest.update(np.ascontiguousarray(array).data)
    return digest.digest()


# People made from one body share these arrays.
_SHARED: Final[IdentityCache[bytes]] = IdentityCache(128)


def _write(file: BinaryIO, levels: Sequence[Geometry]) -> None:
    blocks = list[bytes]()
    place = 0

    def put(array: npt.NDArray[Any]) -> _Array:
        nonlocal place
        content = array.tobytes()
        content += bytes(-len(content) % _ALIGNED)
        blocks.append(content)
        place += len(content)
        return _Array(place - len(content), _NAMES[array.dtype], array.shape)

    def put_face(face: MorphTargets) -> _Face:
        targets = tuple((put(vertices), put(deltas)) for vertices, deltas in face.targets)
        return _Face(face.count, face.names, targets, put(face.rest))

    stored = tuple(
        _Level(
            put(level.shape),
            put(level.surfaces),
            put(level.triangles),
            level.one_sided,
            None if level.face is None else put_face(level.face),
            None if level.surface_of is None else put(level.surface_of),
            None if level.uvs is None else put(level.uvs),
            None if level.groups is None else put(level.groups),
        )
        for level in levels
    )
    head = msgspec.msgpack.encode(_Head(stored))
    blocks.insert(0, head + bytes(-(_BEGINNING.size + len(head)) % _ALIGNED))
    check = 0
    for block in blocks:
        check = zlib.crc32(block, check)
    file.write(_BEGINNING.pack(len(head), check))
    file.writelines(blocks)


def _sum_of(file: BinaryIO) -> int:
    """Return the CRC-32 of the content from the present place on."""
    check = 0
    while block := file.read(2**20):
        check = zlib.crc32(block, check)
    return check


def _read(path: Path, just_written: bool = False) -> tuple[Geometry, ...] | None:
    """Return the geometries (levels of detail) in a cache file; None if it is missing or damaged. The sum of a file
    that was just written is not checked."""
    try:
        with open_file(path) as file:
            length, expected = _BEGINNING.unpack(file.read(_BEGINNING.size))
            if not just_written and _sum_of(file) != expected:
                return None
            file.seek(_BEGINNING.size)
            head = _DECODER.decode(file.read(length))
            first = file.tell() + -file.tell() % _ALIGNED
            memory = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    except (FileError, OSError, OverflowError, struct.error, *UNREADABLE):
        return None

    def got(array: _Array) -> npt.NDArray[Any]:
        return np.ndarray(array.size, _KINDS[array.kind], memory, first + array.start)

    def face_of(face: _Face) -> MorphTargets:
        targets = tuple((got(vertices), got(deltas)) for vertices, deltas in face.targets)
        return MorphTargets(face.count, face.names, targets, got(face.rest))

    return tuple(
        Geometry(
            got(level.shape),
            got(level.surfaces),
            got(level.triangles),
            level.one_sided,
            None if level.face is None else face_of(level.face),
            None if level.surface_of is None else got(level.surface_of),
            None if level.uvs is None else got(level.uvs),
            None if level.groups is None else got(level.groups),
        )
        for level in head.levels
    )
