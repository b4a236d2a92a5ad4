"""The parts of a glTF binary that characters and instruments are built from, decoded to arrays.

Messages
--------
model.unreadable : file, detail
    "{file}: cannot be read: {detail}"
model.invalid : file, detail
    "{file}: {detail}"
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from app.errors import FileError
from app.rig import quaternion
from app.rig.model import Material, Mesh, Morph

FloatArray = npt.NDArray[np.float64]
_DTYPES = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@dataclass(frozen=True, eq=False)
class Source:
    """A glTF file: its JSON and its binary chunk, and each node's rest transform.

    Attributes
    ----------
    file : str
    json : dict
    binary : memoryview
    parents : tuple of int
        Parent of each node, -1 for none.
    world_from_node : (N, 4, 4) float64
        At rest.
    """

    file: str
    json: dict[str, Any]
    binary: memoryview
    parents: tuple[int, ...]
    world_from_node: FloatArray


def read_source(path: Path) -> Source:
    """Read a glTF binary. Raises FileError (``model.unreadable``, ``model.invalid``)."""
    try:
        data = memoryview(path.read_bytes())
    except OSError as error:
        raise FileError("model.unreadable", file=str(path), detail=error.strerror or str(error)) from error
    try:
        magic, version, _ = struct.unpack_from("<4sII", data)
        if magic != b"glTF" or version != 2:
            raise invalid(path, "not a glTF 2.0 binary")
        length, kind = struct.unpack_from("<I4s", data, 12)
        if kind != b"JSON":
            raise invalid(path, "no JSON chunk")
        document = json.loads(bytes(data[20 : 20 + length]))
        start = 20 + length
        binary = data[start:start]
        if start < len(data):
            length, _ = struct.unpack_from("<I4s", data, start)
            binary = data[start + 8 : start + 8 + length]
        parents, world = _nodes(document)
    except (struct.error, ValueError, KeyError, IndexError, TypeError) as error:
        raise invalid(path, f"damaged: {error}") from error
    return Source(str(path), document, binary, parents, world)


def invalid(path: Path | str, detail: str) -> FileError:
    """Return the error of a file whose content will not do."""
    return FileError("model.invalid", file=str(path), detail=detail)


def accessor(source: Source, index: int) -> npt.NDArray[Any]:
    """Decode an accessor to (count, width), sparse values and normalised integers resolved."""
    entry = source.json["accessors"][index]
    dtype, width, count = np.dtype(_DTYPES[entry["componentType"]]), _WIDTHS[entry["type"]], entry["count"]
    if "bufferView" in entry:
        values = _view(source, entry["bufferView"], entry.get("byteOffset", 0), dtype, width, count)
    else:
        values = np.zeros((count, width), dtype)
    if "sparse" in entry:
        rows, changed = sparse(source, index)
        values = values.copy()
        values[rows] = changed
    if entry.get("normalized"):
        values = np.maximum(
            values.astype(np.float32) / (256**dtype.itemsize // (2 if dtype.kind == "i" else 1) - 1), -1.0
        )
    return values


def sparse(source: Source, index: int) -> tuple[npt.NDArray[np.intp], npt.NDArray[Any]]:
    """Return the rows of an accessor that are not zero, and their values: without spreading a sparse one."""
    entry = source.json["accessors"][index]
    if "sparse" not in entry or "bufferView" in entry:
        values = accessor(source, index)
        rows = np.flatnonzero(np.any(values != 0, axis=1))
        return rows, values[rows]
    part = entry["sparse"]
    place, value = part["indices"], part["values"]
    rows = _view(
        source,
        place["bufferView"],
        place.get("byteOffset", 0),
        np.dtype(_DTYPES[place["componentType"]]),
        1,
        part["count"],
    )[:, 0]
    dtype, width = np.dtype(_DTYPES[entry["componentType"]]), _WIDTHS[entry["type"]]
    values = _view(source, value["bufferView"], value.get("byteOffset", 0), dtype, width, part["count"])
    return rows.astype(np.intp), values


def _view(source: Source, view: int, offset: int, dtype: np.dtype[Any], width: int, count: int) -> npt.NDArray[Any]:
    entry = source.json["bufferViews"][view]
    start = entry.get("byteOffset", 0) + offset
    packed = dtype.itemsize * width
    stride = entry.get("byteStride", packed)
    if count and start + stride * (count - 1) + packed > len(source.binary):
        raise invalid(source.file, "an accessor reaches past the end of the buffer")
    return np.ndarray((count, width), dtype, source.binary, start, (stride, dtype.itemsize)).copy()


def build_mesh(source: Source, index: int, name: str) -> tuple[Mesh, bool]:
    """Build one mesh of a file, its primitives joined; the second value says whether it is skinned.

    Primitives that share their vertices stay shared, so that indices of the file's vertices remain valid.
    """
    entry = source.json["meshes"][index]
    names = entry.get("extras", {}).get("targetNames", [])
    blocks: dict[int, int] = {}
    primitives = []
    vertices = 0
    for primitive in entry["primitives"]:
        if primitive.get("mode", 4) != 4:
            continue
        key = primitive["attributes"]["POSITION"]
        if key not in blocks:
            blocks[key] = vertices
            primitives.append(primitive)
            vertices += source.json["accessors"][key]["count"]
    triangles, owners, materials = [], [], []
    for order, primitive in enumerate(p for p in entry["primitives"] if p.get("mode", 4) == 4):
        start, count = blocks[primitive["attributes"]["POSITION"]], 0
        if "indices" in primitive:
            corners = accessor(source, primitive["indices"])[:, 0].astype(np.int32)
        else:
            count = source.json["accessors"][primitive["attributes"]["POSITION"]]["count"]
            corners = np.arange(count, dtype=np.int32)
        triangles.append(corners.reshape(-1, 3) + start)
        owners.append(np.full(len(corners) // 3, order, dtype=np.int32))
        materials.append(_material(source, primitive.get("material")))
    positions = np.zeros((vertices, 3), np.float32)
    normals, uvs = np.zeros((vertices, 3), np.float32), np.zeros((vertices, 2), np.float32)
    weighted: list[tuple[int, npt.NDArray[Any], npt.NDArray[Any]]] = []
    morphs: dict[str, list[tuple[npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[Any] | None]]] = {}
    for primitive in primitives:
        attributes = primitive["attributes"]
        start = blocks[attributes["POSITION"]]
        block = accessor(source, attributes["POSITION"])
        span = slice(start, start + len(block))
        positions[span] = block
        if "NORMAL" in attributes:
            normals[span] = accessor(source, attributes["NORMAL"])
        if "TEXCOORD_0" in attributes:
            uvs[span] = accessor(source, attributes["TEXCOORD_0"])
        sets = [n for n in range(8) if f"JOINTS_{n}" in attributes]
        if sets:
            joints = np.concatenate([accessor(source, attributes[f"JOINTS_{n}"]) for n in sets], axis=1)
            weights = np.concatenate([accessor(source, attributes[f"WEIGHTS_{n}"]) for n in sets], axis=1)
            weighted.append((start, joints, weights))
        for order, target in enumerate(primitive.get("targets", [])):
            if "POSITION" not in target:
                continue
            title = names[order] if order < len(names) else f"morph_{order}"
            rows, deltas = sparse(source, target["POSITION"])
            turned = accessor(source, target["NORMAL"])[rows] if "NORMAL" in target else None
            morphs.setdefault(title, []).append((rows + start, deltas, turned))
    width = max((joints.shape[1] for _, joints, _ in weighted), default=1)
    all_joints, all_weights = np.zeros((vertices, width), np.int32), np.zeros((vertices, width), np.float32)
    for start, joints, weights in weighted:
        all_joints[start : start + len(joints), : joints.shape[1]] = joints
        all_weights[start : start + len(joints), : joints.shape[1]] = weights
    mesh = Mesh(
        name=name,
        positions_m=positions,
        normals=normals,
        uvs=uvs,
        triangles=np.concatenate(triangles) if triangles else np.zeros((0, 3), np.int32),
        triangle_materials=np.concatenate(owners) if owners else np.zeros(0, np.int32),
        materials=tuple(materials),
        joints=all_joints,
        weights=all_weights,
        morphs=tuple(_morph(title, parts) for title, parts in morphs.items()),
    )
    return mesh, bool(weighted)


def _morph(name: str, parts: list[tuple[npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[Any] | None]]) -> Morph:
    turned = [normals for _, _, normals in parts if normals is not None]
    return Morph(
        name=name,
        vertices=np.concatenate([rows for rows, _, _ in parts]).astype(np.int32),
        deltas_m=np.concatenate([deltas for _, deltas, _ in parts]).astype(np.float32),
        normal_deltas=np.concatenate(turned).astype(np.float32) if len(turned) == len(parts) else None,
    )


def _material(source: Source, index: int | None) -> Material:
    if index is None:
        return Material("default", (1.0, 1.0, 1.0, 1.0), 0.0, 1.0)
    entry = source.json["materials"][index]
    surface = entry.get("pbrMetallicRoughness", {})
    red, green, blue, alpha = surface.get("baseColorFactor", [1.0, 1.0, 1.0, 1.0])
    return Material(
        name=entry.get("name", f"material_{index}"),
        base_color=(red, green, blue, alpha),
        metallic=surface.get("metallicFactor", 1.0),
        roughness=surface.get("roughnessFactor", 1.0),
        double_sided=entry.get("doubleSided", False),
    )


def _nodes(document: dict[str, Any]) -> tuple[tuple[int, ...], FloatArray]:
    """Parents and rest transforms of all nodes."""
    nodes = document.get("nodes", [])
    parents = [-1] * len(nodes)
    for index, node in enumerate(nodes):
        for child in node.get("children", []):
            parents[child] = index
    world = np.tile(np.eye(4), (len(nodes), 1, 1))
    done = [False] * len(nodes)
    for index in range(len(nodes)):
        chain = [index]
        while parents[chain[-1]] >= 0 and not done[parents[chain[-1]]]:
            chain.append(parents[chain[-1]])
            if len(chain) > len(nodes):
                raise ValueError("nodes form a circle")
        for node in reversed(chain):
            if not done[node]:
                local = _local(nodes[node])
                world[node] = world[parents[node]] @ local if parents[node] >= 0 else local
                done[node] = True
    return tuple(parents), world


def _local(node: dict[str, Any]) -> FloatArray:
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    local = np.eye(4)
    local[:3, :3] = quaternion.to_matrix(quaternion.normalize(node.get("rotation", [0.0, 0.0, 0.0, 1.0])))
    local[:3, :3] *= np.asarray(node.get("scale", [1.0, 1.0, 1.0]), dtype=np.float64)
    local[:3, 3] = node.get("translation", [0.0, 0.0, 0.0])
    return local
