"""Reading of other programs' FBX files as plain values: nodes, meshes, skins, morphs. For this program's files see
`app.formats.fbx.read`.

The library ufbx reads every version and both encodings, with pre-rotations, pivots, geometric transforms, units and
axes. It runs in a separate process (`foreign_child`), so that crashes on damaged files become errors.
"""

from __future__ import annotations

import io
import json
import os
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import Any, Final, TypeAlias, TypeVar, get_args

import msgspec
import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray, IntArray
from app.errors import FileError
from app.formats.files import read_file
from app.formats.rates import exact_rate
from app.formats.reading_child import NO_MEMORY, NO_READER, UNREADABLE, read_by_child

T = TypeVar("T")
ByteArray: TypeAlias = npt.NDArray[np.uint8]

MOST_BYTES: Final = 2**30
"""Largest file in bytes; characters have a hundredth of it."""
MOTION: Final = "motion"
"""Argument of the child process that requests motion; must equal the constant in `foreign_child`, which this process
does not import.
"""


@dataclass(frozen=True, eq=False)
class FbxNode:
    """A node of the hierarchy, in metres, Y up.

    Attributes
    ----------
    parent : int
        Index of the parent; -1 for none.
    kind : str
        Kind of the attached object: ``BONE``, ``MESH``, ``EMPTY``, ``CAMERA``, ``LOD_GROUP`` ...
    world_from_node, world_from_geometry : (4, 4) float64
        World transforms in the file's pose. Vertices of a mesh on the node are in the geometry's space.
    """

    name: str
    parent: int
    kind: str
    visible: bool
    world_from_node: FloatArray
    world_from_geometry: FloatArray


@dataclass(frozen=True, eq=False)
class FbxCluster:
    """The vertices moved by a bone.

    Attributes
    ----------
    bone_from_mesh : (4, 4) float64
        The inverse bind matrix.
    world_from_bone : (4, 4) float64
        World transform of the bone when the mesh was bound.
    points, weights : (N,)
        Vertex indices and their weights.
    """

    node: int
    bone_from_mesh: FloatArray
    world_from_bone: FloatArray
    points: IntArray
    weights: FloatArray


@dataclass(frozen=True, eq=False)
class FbxMorph:
    """Blend shape of an FBX mesh at full weight: indices of moved points, and their offsets."""

    name: str
    points: IntArray
    deltas: FloatArray


@dataclass(frozen=True, eq=False)
class FbxTexture:
    """An image used by a material.

    Attributes
    ----------
    file : str
        Path of the image on the computer that wrote the file.
    image : int or None
        Index of the embedded image file; None if it is not embedded.
    moved, scaled : (float, float)
        Image coordinates are ``(uv - moved) * scaled``, v up.
    """

    name: str
    file: str
    image: int | None
    moved: tuple[float, float]
    scaled: tuple[float, float]


@dataclass(frozen=True, eq=False)
class FbxMaterial:
    """A surface material; colours are linear.

    Attributes
    ----------
    bump : float
        Strength of its normal map.
    textures : mapping of str to FbxTexture
        Textures by role: ``color``, ``opacity``, ``normal``, ``roughness``, ``metallic``.
    """

    name: str
    base_color: tuple[float, float, float, float]
    metallic: float
    roughness: float
    bump: float
    textures: Mapping[str, FbxTexture]


@dataclass(frozen=True, eq=False)
class FbxMesh:
    """A polygon mesh as read from an FBX file.

    Attributes
    ----------
    nodes : tuple of int
        Indices of the nodes that show it; several nodes show several copies.
    points : (P, 3) float64
        Positions of the vertices.
    corners : (C,) int64
        Index of the point of each corner.
    faces : (F, 2) int64
        First corner and number of corners of each polygon.
    face_materials : (F,) int64
        Material index of each polygon.
    normals, uvs : (C, 3) and (C, 2) float64, or None
        Values by corner; v points up.
    """

    name: str
    nodes: tuple[int, ...]
    points: FloatArray
    corners: IntArray
    faces: IntArray
    face_materials: IntArray
    normals: FloatArray | None
    uvs: FloatArray | None
    materials: tuple[FbxMaterial, ...]
    skins: tuple[tuple[FbxCluster, ...], ...]
    morphs: tuple[FbxMorph, ...]


@dataclass(frozen=True, eq=False)
class FbxContent:
    """Contents of an FBX file; `nodes` are in file order, the first one is the file's root.

    Attributes
    ----------
    images : tuple of (N,) uint8
        Embedded image files.
    """

    nodes: tuple[FbxNode, ...]
    meshes: tuple[FbxMesh, ...]
    images: tuple[ByteArray, ...]


@dataclass(frozen=True, eq=False)
class FbxMotion:
    """Animation of the nodes of a file.

    Attributes
    ----------
    nodes : tuple of FbxNode
        The nodes, as in `FbxContent`.
    bound : tuple of (int, (4, 4) float64)
        Nodes with their world transform when a mesh was bound to them.
    length_s : float
        Duration of the animation.
    transforms : (F, N, 10) float64
        Local transform of each node: translation in metres, rotation xyzw, scale. F = 0 if there is no animation or one
        longer than `app.formats.motion_limits.longest_motion_s`.
    """

    nodes: tuple[FbxNode, ...]
    bound: tuple[tuple[int, FloatArray], ...]
    fps: Fraction
    length_s: float
    transforms: FloatArray


def read_foreign_motion(path: str | os.PathLike[str]) -> FbxMotion:
    """Read the longest animation in an FBX file of any program. Raises the errors of `read_foreign_fbx`."""
    return _read(path, FbxMotion, _checked_motion, MOTION)


def read_foreign_fbx(path: str | os.PathLike[str]) -> FbxContent:
    """Read an FBX file of any program.

    Raises
    ------
    FileError
        The file cannot be read, is no FBX file, is damaged, or is too large.
    """
    return _read(path, FbxContent, _checked_content)


def _read(path: str | os.PathLike[str], kind: type[T], checked: Callable[[T], T], *arguments: str) -> T:
    """Run the child process on a file, and decode the description that it prints, in which arrays are referenced by
    name. Raises FileError.
    """
    file = os.fspath(path)
    printed = _child(read_file(path, MOST_BYTES), file, *arguments)
    try:
        with np.load(io.BytesIO(printed), allow_pickle=False) as packed:
            arrays = {name: packed[name] for name in packed.files}
        content = json.loads(arrays.pop("description").tobytes())
        return checked(msgspec.convert(content, kind, dec_hook=partial(_value, arrays)))
    except (ValueError, KeyError, IndexError, TypeError, zipfile.BadZipFile) as error:
        raise FileError("fbx.foreign_damaged", file=file, detail=str(error)) from error


def _child(data: bytes, file: str, *arguments: str) -> bytes:
    """Run the child process on a file's bytes and return its output. Raises FileError."""
    of_motion = arguments == (MOTION,)
    limits = f"ufbx.{MOTION}" if of_motion else "ufbx.figure"
    too_large = "fbx.motion_too_large" if of_motion else "fbx.too_large"
    status, printed = read_by_child("app.formats.fbx.foreign_child", limits, data, file, *arguments)
    if status == NO_MEMORY:
        raise FileError(too_large, file=file)
    if status == NO_READER:
        raise FileError("fbx.no_reader", file=file)
    if status == UNREADABLE:
        detail = printed.decode("utf-8", "replace")
        if "nrecognized file format" in detail:
            raise FileError("fbx.not_fbx", file=file)
        raise FileError("fbx.foreign_damaged", file=file, detail=detail)
    if status:
        raise FileError("fbx.foreign_damaged", file=file, detail=f"its reader ended with {status}")
    return printed


def _value(arrays: Mapping[str, npt.NDArray[Any]], kind: type, given: Any) -> Any:
    """Decode a value of the description: a frame rate, an array by its name, values per corner by two names, or a
    matrix by rows.
    """
    if kind is Fraction:
        return exact_rate(given)
    if isinstance(given, str):
        found = arrays[given]
    elif isinstance(given[0], str):
        values, indices = (arrays[name] for name in given)
        found = np.nan_to_num(values[_within(indices, len(values))] if len(values) else values)
    else:
        found = np.vstack([np.array(given, dtype=np.float64), (0.0, 0.0, 0.0, 1.0)])
    if not np.isfinite(found).all():
        raise ValueError("a number is not finite")
    if np.dtype[np.uint8] in get_args(kind):
        return found.astype(np.uint8)
    # Since NumPy 2.5 msgspec resolves the alias `npt.NDArray`, so the kind is no longer equal to `IntArray`.
    return found.astype(np.int64 if np.dtype[np.int64] in get_args(kind) else np.float64)


def _checked_motion(motion: FbxMotion) -> FbxMotion:
    _check_nodes(motion.nodes, [node for node, _ in motion.bound])
    return motion


def _checked_content(content: FbxContent) -> FbxContent:
    clusters = (cluster for mesh in content.meshes for skin in mesh.skins for cluster in skin)
    _check_nodes(content.nodes, [cluster.node for cluster in clusters])
    return replace(content, meshes=tuple(map(_checked_mesh, content.meshes)))


def _check_nodes(nodes: Sequence[FbxNode], skinned: Sequence[int]) -> None:
    for index, node in enumerate(nodes):
        if not -1 <= node.parent < index:
            raise ValueError(f"node {node.name!r} stands before its parent")
    if any(not 0 <= node < len(nodes) for node in skinned):
        raise ValueError("a skin without a bone")


def _checked_mesh(mesh: FbxMesh) -> FbxMesh:
    points, corners, faces = len(mesh.points), len(mesh.corners), mesh.faces
    for indices in (
        mesh.corners,
        *(one.points for skin in mesh.skins for one in skin),
        *(m.points for m in mesh.morphs),
    ):
        _within(indices, points)
    if len(faces) and (faces.min() < 0 or faces.sum(axis=1).max() > corners):
        raise ValueError(f"polygons of {mesh.name!r}")
    known = len(mesh.face_materials) == len(faces) and len(mesh.materials) > 0
    return replace(
        mesh,
        face_materials=np.clip(mesh.face_materials, 0, len(mesh.materials) - 1)
        if known
        else np.zeros(len(faces), np.int64),
        normals=_of_every_corner(mesh.normals, corners),
        uvs=_of_every_corner(mesh.uvs, corners),
        morphs=tuple(replace(morph, deltas=morph.deltas[: len(morph.points)]) for morph in mesh.morphs),
    )


def _of_every_corner(values: FloatArray | None, corners: int) -> FloatArray | None:
    return values if values is not None and len(values) == corners else None


def _within(indices: npt.NDArray[Any], count: int) -> npt.NDArray[Any]:
    if len(indices) and (indices.min() < 0 or indices.max() >= count):
        raise ValueError("an index points outside")
    return indices
