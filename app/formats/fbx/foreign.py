"""FBX files of other programs -> plain values: nodes, meshes, skins, morphs. What ours need is `app.formats.fbx.read`.

Any version and both encodings are read by the library ufbx, which knows pre-rotations, pivots, geometric transforms,
units and axes. It runs in a process of its own (`foreign_child`): what a damaged file does to it is reported as an
error.

Messages (all with ``file``)
--------
file.cannot_read : reason
file.too_large : size_mb, most_mb
fbx.not_fbx : "{file} is not an FBX file"
fbx.foreign_damaged : detail
    "{file} is damaged: {detail}"
fbx.too_large : "{file} describes far more data than a file of its size holds"
"""

from __future__ import annotations

import io
import json
import os
import signal
import subprocess
import zipfile
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from app.errors import FileError
from app.formats.files import read_file
from app.formats.rates import exact_rate
from app.own_process import own_process

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

MOST_BYTES: Final = 2**30
"""Of a file; characters have a hundredth of it."""
PATIENCE_S: Final = 180.0
MOTION: Final = "motion"
TRANSFORM: Final = 10
"""As in the child, which this process does not import."""
UNREADABLE, NO_MEMORY = 3, 4
"""What the child's end means."""
_LIMITS: Final = frozenset(-number for name in ("SIGXCPU", "SIGKILL") if (number := getattr(signal, name, 0)))
"""The system ended the child: it had taken too long, or all the memory there is."""


@dataclass(frozen=True, eq=False)
class FbxNode:
    """A node of the hierarchy, in metres, Y up.

    Attributes
    ----------
    name : str
    parent : int
        -1: none.
    kind : str
        What hangs on it: ``BONE``, ``MESH``, ``EMPTY``, ``CAMERA``, ``LOD_GROUP`` ...
    visible : bool
    world_from_node, world_from_geometry : (4, 4) float64
        As the file poses it. The vertices of a mesh on the node are in its geometry's space.
    """

    name: str
    parent: int
    kind: str
    visible: bool
    world_from_node: FloatArray
    world_from_geometry: FloatArray


@dataclass(frozen=True, eq=False)
class FbxCluster:
    """The vertices that a bone moves.

    Attributes
    ----------
    node : int
    bone_from_mesh : (4, 4) float64
        The inverse bind matrix.
    world_from_bone : (4, 4) float64
        Where the bone was when the mesh was bound.
    points, weights : (N,)
    """

    node: int
    bone_from_mesh: FloatArray
    world_from_bone: FloatArray
    points: IntArray
    weights: FloatArray


@dataclass(frozen=True, eq=False)
class FbxMorph:
    """What a blend shape channel is at full weight: some points and how they move."""

    name: str
    points: IntArray
    deltas: FloatArray


@dataclass(frozen=True)
class FbxMaterial:
    """A surface; colours are linear."""

    name: str
    base_color: tuple[float, float, float, float]
    metallic: float
    roughness: float


@dataclass(frozen=True, eq=False)
class FbxMesh:
    """A mesh of polygons.

    Attributes
    ----------
    name : str
    nodes : tuple of int
        Where it hangs; more than one: it is shown as often.
    points : (P, 3) float64
    corners : (C,) int64
        Point of each corner.
    faces : (F, 2) int64
        First corner and number of corners of each polygon.
    face_materials : (F,) int64
    normals, uvs : (C, 3) and (C, 2) float64, or None
        By corner; v points up.
    materials : tuple of FbxMaterial
    skins : tuple of tuple of FbxCluster
    morphs : tuple of FbxMorph
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
    """What a file holds; `nodes` in the file's order, the first is the file's own root."""

    nodes: tuple[FbxNode, ...]
    meshes: tuple[FbxMesh, ...]


@dataclass(frozen=True, eq=False)
class FbxMotion:
    """What an animation does to the nodes of a file.

    Attributes
    ----------
    nodes : tuple of FbxNode
        As in `FbxContent`.
    bound : tuple of (int, (4, 4) float64)
        Nodes, and where each was when a mesh was bound to it.
    fps : Fraction
    transforms : (F, N, 10) float64
        Of each node on its parent: translation in metres, rotation xyzw, scale. No frames: the file has no animation.
    """

    nodes: tuple[FbxNode, ...]
    bound: tuple[tuple[int, FloatArray], ...]
    fps: Fraction
    transforms: FloatArray


def read_foreign_motion(path: str | os.PathLike[str]) -> FbxMotion:
    """Read the longest animation of an FBX file of any program. Raises as `read_foreign_fbx`."""
    file = os.fspath(path)
    content, arrays = _read(file, path, MOTION)
    try:
        nodes = _nodes(content)
        bound = tuple((entry["node"], _matrix(entry["world_from_bone"])) for entry in content["bound"])
        if any(not 0 <= node < len(nodes) for node, _ in bound):
            raise ValueError("a skin without a bone")
        empty = np.zeros((0, len(nodes), TRANSFORM))
        transforms = _finite(arrays[content["transforms"]]) if content["frames"] else empty
        return FbxMotion(nodes, bound, exact_rate(content["fps"]), transforms)
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise FileError("fbx.foreign_damaged", file=file, detail=str(error)) from error


def read_foreign_fbx(path: str | os.PathLike[str]) -> FbxContent:
    """Read an FBX file of any program.

    Raises
    ------
    FileError
        If it cannot be read, is no FBX file, is damaged or absurdly large.
    """
    file = os.fspath(path)
    content, arrays = _read(file, path)
    try:
        return _content(content, arrays)
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise FileError("fbx.foreign_damaged", file=file, detail=str(error)) from error


def _read(
    file: str, path: str | os.PathLike[str], *arguments: str
) -> tuple[dict[str, Any], dict[str, npt.NDArray[Any]]]:
    """The description and the arrays that the child prints. Raises FileError."""
    printed = _child(read_file(path, MOST_BYTES), file, *arguments)
    try:
        with np.load(io.BytesIO(printed), allow_pickle=False) as packed:
            arrays = {name: packed[name] for name in packed.files}
        content: dict[str, Any] = json.loads(arrays.pop("description").tobytes())
    except (ValueError, KeyError, zipfile.BadZipFile) as error:
        raise FileError("fbx.foreign_damaged", file=file, detail=str(error)) from error
    return content, arrays


def _child(data: bytes, file: str, *arguments: str) -> bytes:
    """What the child printed of a file's bytes. Raises FileError."""
    try:
        ended: subprocess.CompletedProcess[bytes] = subprocess.run(
            input=data,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=PATIENCE_S,
            check=False,
            **own_process("app.formats.fbx.foreign_child", *arguments),
        )
    except subprocess.TimeoutExpired as error:
        raise FileError("fbx.too_large", file=file) from error
    except OSError as error:
        raise FileError("file.cannot_read", file=file, reason=str(error)) from error
    if ended.returncode in (NO_MEMORY, *_LIMITS):
        raise FileError("fbx.too_large", file=file)
    if ended.returncode == UNREADABLE:
        detail = ended.stdout.decode("utf-8", "replace")
        if "nrecognized file format" in detail:
            raise FileError("fbx.not_fbx", file=file)
        raise FileError("fbx.foreign_damaged", file=file, detail=detail)
    if ended.returncode:
        raise FileError("fbx.foreign_damaged", file=file, detail=f"its reader ended with {ended.returncode}")
    return ended.stdout


def _content(content: dict[str, Any], arrays: dict[str, npt.NDArray[Any]]) -> FbxContent:
    nodes = _nodes(content)
    return FbxContent(nodes, tuple(_mesh(mesh, arrays, len(nodes)) for mesh in content["meshes"]))


def _nodes(content: dict[str, Any]) -> tuple[FbxNode, ...]:
    nodes = tuple(
        FbxNode(
            node["name"],
            node["parent"],
            node["kind"],
            node["visible"],
            _matrix(node["world_from_node"]),
            _matrix(node["world_from_geometry"]),
        )
        for node in content["nodes"]
    )
    for index, node in enumerate(nodes):
        if not -1 <= node.parent < index:
            raise ValueError(f"node {node.name!r} stands before its parent")
    return nodes


def _matrix(rows: list[list[float]]) -> FloatArray:
    result = np.eye(4)
    result[:3] = np.array(rows, dtype=np.float64)
    if not np.isfinite(result).all():
        raise ValueError("a transform is not finite")
    return result


def _mesh(mesh: dict[str, Any], arrays: dict[str, npt.NDArray[Any]], node_count: int) -> FbxMesh:
    points = _finite(arrays[mesh["points"]])
    corners = _within(arrays[mesh["corners"]], len(points))
    faces = arrays[mesh["faces"]]
    if len(faces) and (faces.min() < 0 or faces.sum(axis=1).max() > len(corners)):
        raise ValueError(f"polygons of {mesh['name']!r}")
    face_materials = arrays[mesh["face_materials"]]
    materials = tuple(
        FbxMaterial(entry["name"], tuple(entry["color"]), entry["metallic"], entry["roughness"])
        for entry in mesh["materials"]
    )
    if len(face_materials) != len(faces) or not len(materials):
        face_materials = np.zeros(len(faces), dtype=np.int64)
    return FbxMesh(
        name=mesh["name"],
        nodes=tuple(mesh["nodes"]),
        points=points,
        corners=corners,
        faces=faces,
        face_materials=np.clip(face_materials, 0, max(len(materials) - 1, 0)),
        normals=_by_corner(mesh["normals"], arrays, len(corners)),
        uvs=_by_corner(mesh["uvs"], arrays, len(corners)),
        materials=materials,
        skins=tuple(
            tuple(_cluster(entry, arrays, len(points), node_count) for entry in skin) for skin in mesh["skins"]
        ),
        morphs=tuple(
            FbxMorph(
                entry["name"],
                _within(arrays[entry["points"]], len(points)),
                _finite(arrays[entry["deltas"]][: len(arrays[entry["points"]])]),
            )
            for entry in mesh["morphs"]
        ),
    )


def _cluster(entry: dict[str, Any], arrays: dict[str, npt.NDArray[Any]], points: int, nodes: int) -> FbxCluster:
    if not 0 <= entry["node"] < nodes:
        raise ValueError("a skin without a bone")
    return FbxCluster(
        node=entry["node"],
        bone_from_mesh=_matrix(entry["bone_from_mesh"]),
        world_from_bone=_matrix(entry["world_from_bone"]),
        points=_within(arrays[entry["points"]], points),
        weights=_finite(arrays[entry["weights"]]),
    )


def _by_corner(names: list[str] | None, arrays: dict[str, npt.NDArray[Any]], corners: int) -> FloatArray | None:
    if names is None:
        return None
    values, indices = (arrays[name] for name in names)
    if len(indices) != corners or not len(values):
        return None
    result: FloatArray = np.nan_to_num(values[_within(indices, len(values))])
    return result


def _within(indices: npt.NDArray[Any], count: int) -> IntArray:
    if len(indices) and (indices.min() < 0 or indices.max() >= count):
        raise ValueError("an index points outside")
    return indices.astype(np.int64)


def _finite(values: npt.NDArray[Any]) -> FloatArray:
    if not np.isfinite(values).all():
        raise ValueError("a number is not finite")
    return values.astype(np.float64)
