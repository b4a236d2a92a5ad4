"""Cache of encoded meshes by content, since players with the same body have the same meshes."""

from __future__ import annotations

import hashlib
from typing import Final

import msgspec
import numpy as np

from app.formats.fbx.byte_cache import ByteCache
from app.formats.fbx.encode import Element, PackedArray, pack_array
from app.formats.fbx.geometry import geometry, morph_geometry, skin_clusters
from app.formats.scene import SkinnedMesh

_MOST_KEPT_BYTES: Final = 2**26


class PackedMesh(msgspec.Struct, frozen=True, eq=False):
    """Encoded mesh data, without names, materials and bind pose.

    Attributes
    ----------
    geometry : tuple of Element
        Children of the mesh's Geometry record.
    clusters : tuple of (int, Element, Element)
        Bone index, vertices and weights for each bone.
    morphs : tuple of tuple of Element
        Children of the Geometry records of its morphs, in order.
    """

    geometry: tuple[Element, ...]
    clusters: tuple[tuple[int, Element, Element], ...]
    morphs: tuple[tuple[Element, ...], ...]


def packed_mesh(mesh: SkinnedMesh) -> PackedMesh:
    """Return the encoded data of a mesh, computed once for all meshes with the same content."""
    known = _digest(mesh)
    packed = _meshes.get(known)
    if packed is None:
        packed = PackedMesh(
            tuple(map(_packed, geometry(mesh))),
            tuple(
                (bone, _packed(Element("Indexes", (indices,))), _packed(Element("Weights", (weights,))))
                for bone, indices, weights in skin_clusters(mesh)
            ),
            tuple(tuple(map(_packed, morph_geometry(morph))) for morph in mesh.morphs),
        )
        records = [*packed.geometry]
        records += [record for _, *own in packed.clusters for record in own]
        records += [record for morph in packed.morphs for record in morph]
        _meshes.keep(known, packed, sum(map(_size, records)))
    return packed


_meshes: Final = ByteCache[bytes, PackedMesh](_MOST_KEPT_BYTES, _MOST_KEPT_BYTES)


def _digest(mesh: SkinnedMesh) -> bytes:
    """Return a hash of everything that a `PackedMesh` depends on."""
    arrays = [mesh.vertices_cm, mesh.faces, mesh.normals, mesh.uvs, mesh.face_materials]
    arrays += [mesh.joint_indices, mesh.weights]
    for morph in mesh.morphs:
        arrays += [morph.vertex_indices, morph.position_deltas_cm, morph.normal_deltas]
    digest = hashlib.sha256()
    for array in arrays:
        if array is None:
            digest.update(b"none")
        else:
            digest.update(f"{array.dtype.str}{array.shape}".encode())
            digest.update(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data)
    return digest.digest()


def _packed(record: Element) -> Element:
    """Return an FBX record with its arrays, and those of its children, encoded."""
    properties = tuple(pack_array(value) if isinstance(value, np.ndarray) else value for value in record.properties)
    children = None if record.children is None else tuple(map(_packed, record.children))
    return Element(record.name, properties, children)


def _size(record: Element) -> int:
    """Return the total size in bytes of the encoded arrays of an FBX record and its children."""
    own = sum(len(value.encoded) for value in record.properties if isinstance(value, PackedArray))
    return own + sum(map(_size, record.children or ()))
