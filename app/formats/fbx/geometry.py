"""Encoding of meshes, morphs and skin weights as FBX records."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from app.arrays import AnyFloatArray, FloatArray
from app.formats.fbx.encode import Element, Property
from app.formats.fbx.smoothing import smoothing_groups
from app.formats.scene import MorphTarget, SkinnedMesh


def geometry(mesh: SkinnedMesh) -> tuple[Element, ...]:
    """Return the child records of an FBX geometry: vertices, polygons, normals, UVs and materials of a mesh."""
    faces = np.array(mesh.faces, dtype=np.int32)
    faces[:, -1] = -faces[:, -1] - 1  # a negative index ends a polygon
    layers = [_normal_layer(mesh), _smoothing_layer(mesh)]
    if mesh.uvs is not None:
        layers.append(_uv_layer(mesh, mesh.uvs))
    layers.append(_material_layer(mesh))
    listed = tuple(
        Element("LayerElement", (), (Element("Type", (layer.name,)), Element("TypedIndex", (np.int32(0),))))
        for layer in layers
    )
    return (
        Element("GeometryVersion", (np.int32(124),)),
        Element("Vertices", (_flat(mesh.vertices_cm),)),
        Element("PolygonVertexIndex", (faces.ravel(),)),
        *layers,
        Element("Layer", (np.int32(0),), (Element("Version", (np.int32(100),)), *listed)),
    )


def morph_geometry(morph: MorphTarget) -> tuple[Element, ...]:
    """Return the child records of a Geometry of class Shape: moved vertices and their offsets."""
    normals = morph.normal_deltas if morph.normal_deltas is not None else np.zeros_like(morph.position_deltas_cm)
    return (
        Element("Version", (np.int32(100),)),
        Element("Indexes", (np.ascontiguousarray(morph.vertex_indices, dtype=np.int32),)),
        Element("Vertices", (_flat(morph.position_deltas_cm),)),
        Element("Normals", (_flat(normals),)),
    )


def skin_clusters(mesh: SkinnedMesh) -> Iterator[tuple[int, npt.NDArray[np.int32], FloatArray]]:
    """Yield for every bone that moves vertices its index, the sorted indices of the vertices, and their weights."""
    vertex_count = len(mesh.vertices_cm)
    weights = np.asarray(mesh.weights, dtype=np.float64)
    vertices, slots = np.nonzero(weights > 0)
    keys = mesh.joint_indices[vertices, slots].astype(np.int64) * vertex_count + vertices
    keys, inverse = np.unique(keys, return_inverse=True)
    summed = np.bincount(inverse, weights[vertices, slots], minlength=len(keys))
    joints, vertices = np.divmod(keys, max(1, vertex_count))
    bones, starts = np.unique(joints, return_index=True)
    for bone, start, stop in zip(bones, starts, np.append(starts[1:], len(keys)), strict=True):
        yield int(bone), vertices[start:stop].astype(np.int32), summed[start:stop].astype(np.float64)


def _layer(name: str, version: int, mapping: str, reference: str, *values: tuple[str, Property]) -> Element:
    return Element(
        name,
        (np.int32(0),),
        (
            Element("Version", (np.int32(version),)),
            Element("Name", ("",)),
            Element("MappingInformationType", (mapping,)),
            Element("ReferenceInformationType", (reference,)),
            *(Element(key, (value,)) for key, value in values),
        ),
    )


def _normal_layer(mesh: SkinnedMesh) -> Element:
    normals = mesh.normals
    if len(normals) == len(mesh.vertices_cm):
        normals = normals[mesh.faces.ravel()]
    return _layer("LayerElementNormal", 101, "ByPolygonVertex", "Direct", ("Normals", _flat(normals)))


def _smoothing_layer(mesh: SkinnedMesh) -> Element:
    return _layer("LayerElementSmoothing", 102, "ByPolygon", "Direct", ("Smoothing", smoothing_groups(mesh)))


def _uv_layer(mesh: SkinnedMesh, uvs: AnyFloatArray) -> Element:
    if len(uvs) == len(mesh.vertices_cm):
        indices = mesh.faces.ravel().astype(np.int32)
    else:
        indices = np.arange(mesh.faces.size, dtype=np.int32)
    return _layer("LayerElementUV", 101, "ByPolygonVertex", "IndexToDirect", ("UV", _flat(uvs)), ("UVIndex", indices))


def _material_layer(mesh: SkinnedMesh) -> Element:
    if mesh.face_materials is None:
        return _layer(
            "LayerElementMaterial", 101, "AllSame", "IndexToDirect", ("Materials", np.zeros(1, dtype=np.int32))
        )
    indices = np.ascontiguousarray(mesh.face_materials, dtype=np.int32)
    return _layer("LayerElementMaterial", 101, "ByPolygon", "IndexToDirect", ("Materials", indices))


def _flat(values: AnyFloatArray) -> FloatArray:
    return np.ascontiguousarray(values, dtype=np.float64).ravel()
