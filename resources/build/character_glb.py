"""Writing a character as a VRM 1.0 humanoid in one binary glTF file."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from character_surface import Surface
from character_textures import Texture
from pygltflib import GLTF2

if TYPE_CHECKING:
    from character_skeleton import SkeletonFit

FLOAT, USHORT, UBYTE, BYTE, UINT = 5126, 5123, 5121, 5120, 5125
_DTYPES: dict[int, np.dtype] = {
    FLOAT: np.dtype("<f4"),
    USHORT: np.dtype("<u2"),
    UBYTE: np.dtype("u1"),
    BYTE: np.dtype("i1"),
    UINT: np.dtype("<u4"),
}
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
LINEAR, LINEAR_MIPMAP_LINEAR, REPEAT = 9729, 9987, 10497
TRANSFORM = "KHR_texture_transform"
QUANTIZED = "KHR_mesh_quantization"
MORPH_THRESHOLD_M = 2e-6


@dataclass(frozen=True)
class Material:
    """A PBR material, no metal: linear base colour, roughness in 0..1.

    Attributes
    ----------
    colour, roughness : factors of the textures where there are some.
    colour_texture : base colour; its alpha counts where `alpha_cutoff` is given.
    normal_texture : normals, repeated `normal_tiles` times across the material's coordinates.
    orm_texture : occlusion (red), roughness (green) and metal (blue).
    alpha_cutoff : alpha below which nothing is drawn.
    """

    colour: tuple[float, float, float]
    roughness: float
    two_sided: bool = False
    colour_texture: Texture | None = None
    normal_texture: Texture | None = None
    normal_scale: float = 1.0
    normal_tiles: float = 1.0
    orm_texture: Texture | None = None
    alpha_cutoff: float | None = None

    def textures(self) -> tuple[Texture, ...]:
        present = (self.colour_texture, self.normal_texture, self.orm_texture)
        return tuple(texture for texture in present if texture is not None)


class _Buffer:
    """The one binary buffer of the file under construction, with its views and accessors."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, array: np.ndarray, target: int | None = None) -> int:
        self.data.extend(b"\0" * (-len(self.data) % 4))
        payload = np.ascontiguousarray(array).tobytes()
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(payload)}
        if target is not None:
            view["target"] = target
        self.data.extend(payload)
        self.views.append(view)
        return len(self.views) - 1

    def accessor(
        self, array: np.ndarray, component: int, kind: str, target: int | None = None, bounds: bool = False
    ) -> int:
        typed = np.ascontiguousarray(array, dtype=_DTYPES[component])
        entry: dict[str, Any] = {
            "bufferView": self.view(typed, target),
            "componentType": component,
            "count": len(typed),
            "type": kind,
        }
        if bounds:
            entry |= {"min": typed.min(axis=0).tolist(), "max": typed.max(axis=0).tolist()}
        self.accessors.append(entry)
        return len(self.accessors) - 1

    def packed(self, array: np.ndarray, component: int) -> int:
        """An accessor of numbers within -1 to 1 as integers, each row on a multiple of four bytes."""
        kind = _DTYPES[component]
        rows = np.round(np.clip(array, -1.0, 1.0) * np.iinfo(kind).max).astype(kind)
        width = rows.shape[1]
        room = -(-width * kind.itemsize // 4) * 4 // kind.itemsize
        padded = np.zeros((len(rows), room), dtype=kind)
        padded[:, :width] = rows
        view = self.view(padded, ARRAY_BUFFER)
        self.views[view]["byteStride"] = room * kind.itemsize
        self.accessors.append(
            {
                "bufferView": view,
                "componentType": component,
                "normalized": True,
                "count": len(rows),
                "type": f"VEC{width}",
            }
        )
        return len(self.accessors) - 1

    def sparse_vec3(self, array: np.ndarray) -> int:
        """A sparse accessor of (N, 3) offsets: only the rows that differ from zero are stored."""
        rows = np.flatnonzero(np.abs(array).max(axis=1) > MORPH_THRESHOLD_M)
        values = array[rows].astype("<f4")
        low = np.minimum(values.min(axis=0, initial=0.0), 0.0) if len(rows) < len(array) else values.min(axis=0)
        high = np.maximum(values.max(axis=0, initial=0.0), 0.0) if len(rows) < len(array) else values.max(axis=0)
        entry: dict[str, Any] = {
            "componentType": FLOAT,
            "count": len(array),
            "type": "VEC3",
            "min": low.tolist(),
            "max": high.tolist(),
        }
        if not len(rows):
            rows, values = np.zeros(1, dtype=np.int64), np.zeros((1, 3), dtype="<f4")
        entry["sparse"] = {
            "count": len(rows),
            "indices": {"bufferView": self.view(rows.astype("<u2")), "componentType": USHORT},
            "values": {"bufferView": self.view(values)},
        }
        self.accessors.append(entry)
        return len(self.accessors) - 1


def _shares_of_255(values: np.ndarray) -> np.ndarray:
    """Weights (N, K) as multiples of 1/255 that sum to 1."""
    rounded = np.round(values * 255.0)
    rounded[:, 0] += 255.0 - rounded.sum(axis=1)
    return rounded / 255.0


def _skin_attributes(buffer: _Buffer, weights: np.ndarray, compact: bool) -> dict[str, int]:
    """JOINTS_n and WEIGHTS_n with as many sets of four as the heaviest vertex needs."""
    count = max(4, -(-int((weights > 0).sum(axis=1).max()) // 4) * 4)
    order = np.argsort(-weights, axis=1, kind="stable")[:, :count]
    values = np.take_along_axis(weights, order, axis=1).astype(np.float32)
    if compact:
        values = _shares_of_255(values).astype(np.float32)
    order = np.where(values > 0, order, 0)
    attributes = {}
    for start in range(0, count, 4):
        attributes[f"JOINTS_{start // 4}"] = buffer.accessor(order[:, start : start + 4], UBYTE, "VEC4", ARRAY_BUFFER)
        part = values[:, start : start + 4]
        attributes[f"WEIGHTS_{start // 4}"] = (
            buffer.packed(part, UBYTE) if compact else buffer.accessor(part, FLOAT, "VEC4", ARRAY_BUFFER)
        )
    return attributes


def _mesh(buffer: _Buffer, surface: Surface, materials: Sequence[str], compact: bool) -> dict[str, Any]:
    downward = np.stack([surface.uvs[:, 0], 1.0 - surface.uvs[:, 1]], axis=1)
    attributes = {
        "POSITION": buffer.accessor(surface.positions, FLOAT, "VEC3", ARRAY_BUFFER, bounds=True),
        "NORMAL": buffer.packed(surface.normals, BYTE)
        if compact
        else buffer.accessor(surface.normals, FLOAT, "VEC3", ARRAY_BUFFER),
        "TEXCOORD_0": buffer.packed(downward, USHORT)
        if compact
        else buffer.accessor(downward, FLOAT, "VEC2", ARRAY_BUFFER),
    } | _skin_attributes(buffer, surface.weights, compact)
    targets = [{"POSITION": buffer.sparse_vec3(delta)} for delta in surface.morphs.values()]
    primitives = []
    for material, triangles in surface.triangles.items():
        primitive: dict[str, Any] = {
            "attributes": attributes,
            "indices": buffer.accessor(triangles.reshape(-1), USHORT, "SCALAR", ELEMENT_ARRAY_BUFFER),
            "material": materials.index(material),
            "mode": 4,
        }
        if targets:
            primitive["targets"] = targets
        primitives.append(primitive)
    mesh: dict[str, Any] = {"name": surface.name, "primitives": primitives}
    if targets:
        mesh["weights"] = [0.0] * len(targets)
        mesh["extras"] = {"targetNames": list(surface.morphs)}
    return mesh


def _nodes(fit: SkeletonFit, positions: np.ndarray) -> list[dict[str, Any]]:
    """Node 0 is `root`, node 1 + j is joint j."""
    nodes: list[dict[str, Any]] = [{"name": "root", "children": []}]
    for joint, (name, parent) in enumerate(zip(fit.names, fit.parents, strict=True)):
        offset = positions[joint] - (positions[parent] if parent >= 0 else 0.0)
        nodes.append({"name": name, "translation": np.float32(offset).tolist()})
        nodes[parent + 1].setdefault("children", []).append(joint + 1)
    return nodes


def _material(name: str, material: Material, textures: Sequence[Texture]) -> dict[str, Any]:
    physical: dict[str, Any] = {
        "baseColorFactor": [*material.colour, 1.0],
        "metallicFactor": 0.0,
        "roughnessFactor": material.roughness,
    }
    entry: dict[str, Any] = {"name": name, "pbrMetallicRoughness": physical, "doubleSided": material.two_sided}
    if material.colour_texture is not None:
        physical["baseColorTexture"] = {"index": textures.index(material.colour_texture)}
    if material.orm_texture is not None:
        physical["metallicRoughnessTexture"] = {"index": textures.index(material.orm_texture)}
        entry["occlusionTexture"] = {"index": textures.index(material.orm_texture)}
    if material.normal_texture is not None:
        normal: dict[str, Any] = {"index": textures.index(material.normal_texture), "scale": material.normal_scale}
        if material.normal_tiles != 1.0:
            normal["extensions"] = {TRANSFORM: {"scale": [material.normal_tiles, material.normal_tiles]}}
        entry["normalTexture"] = normal
    if material.alpha_cutoff is not None:
        entry |= {"alphaMode": "MASK", "alphaCutoff": material.alpha_cutoff}
    return entry


def _pictures(buffer: _Buffer, textures: Sequence[Texture]) -> dict[str, Any]:
    """The parts of a document that hold textures; none where there are none."""
    if not textures:
        return {}
    images = [
        {
            "name": texture.name,
            "mimeType": texture.mime_type,
            "bufferView": buffer.view(np.frombuffer(texture.content, np.uint8)),
        }
        if not texture.uri
        else {"name": texture.name, "uri": texture.uri}
        for texture in textures
    ]
    return {
        "images": images,
        "samplers": [{"magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR, "wrapS": REPEAT, "wrapT": REPEAT}],
        "textures": [{"source": index, "sampler": 0} for index in range(len(textures))],
    }


EXPRESSIONS: Mapping[str, Mapping[str, float]] = {
    "happy": {"mouthSmileLeft": 0.8, "mouthSmileRight": 0.8, "cheekSquintLeft": 0.4, "cheekSquintRight": 0.4},
    "angry": {"browDownLeft": 0.9, "browDownRight": 0.9, "mouthPressLeft": 0.4, "mouthPressRight": 0.4},
    "sad": {"browInnerUp": 0.8, "mouthFrownLeft": 0.7, "mouthFrownRight": 0.7},
    "relaxed": {"eyeBlinkLeft": 0.3, "eyeBlinkRight": 0.3, "mouthSmileLeft": 0.25, "mouthSmileRight": 0.25},
    "surprised": {"browInnerUp": 0.8, "browOuterUpLeft": 0.8, "browOuterUpRight": 0.8, "jawOpen": 0.3},
    "aa": {"jawOpen": 0.6},
    "ih": {"jawOpen": 0.2, "mouthStretchLeft": 0.4, "mouthStretchRight": 0.4},
    "ou": {"mouthPucker": 0.8, "jawOpen": 0.1},
    "ee": {"jawOpen": 0.15, "mouthSmileLeft": 0.4, "mouthSmileRight": 0.4},
    "oh": {"jawOpen": 0.35, "mouthFunnel": 0.6},
    "blink": {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0},
    "blinkLeft": {"eyeBlinkLeft": 1.0},
    "blinkRight": {"eyeBlinkRight": 1.0},
    "lookUp": {"eyeLookUpLeft": 1.0, "eyeLookUpRight": 1.0},
    "lookDown": {"eyeLookDownLeft": 1.0, "eyeLookDownRight": 1.0},
    "lookLeft": {"eyeLookOutLeft": 1.0, "eyeLookInRight": 1.0},
    "lookRight": {"eyeLookInLeft": 1.0, "eyeLookOutRight": 1.0},
}
"""VRM 1.0's preset expressions in ARKit shapes."""


def _vrm(
    fit: SkeletonFit, meta: Mapping[str, Any], surfaces: Sequence[Surface], mesh_nodes: Mapping[str, int]
) -> dict[str, Any]:
    def binds(shapes: Mapping[str, float]) -> list[dict[str, Any]]:
        return [
            {"node": mesh_nodes[surface.name], "index": list(surface.morphs).index(shape), "weight": weight}
            for surface in surfaces
            for shape, weight in shapes.items()
            if shape in surface.morphs and np.abs(surface.morphs[shape]).max() > MORPH_THRESHOLD_M
        ]

    presets = {name: {"morphTargetBinds": binds(shapes)} for name, shapes in EXPRESSIONS.items()}
    presets = {name: entry for name, entry in presets.items() if entry["morphTargetBinds"]}
    return {
        "specVersion": "1.0",
        "meta": dict(meta),
        "humanoid": {"humanBones": {name: {"node": joint + 1} for joint, name in enumerate(fit.names)}},
        "expressions": {"preset": presets},
        "lookAt": {
            "type": "bone",
            "offsetFromHeadBone": [0.0, 0.05, 0.08],
            "rangeMapHorizontalInner": {"inputMaxValue": 90.0, "outputScale": 25.0},
            "rangeMapHorizontalOuter": {"inputMaxValue": 90.0, "outputScale": 30.0},
            "rangeMapVerticalDown": {"inputMaxValue": 90.0, "outputScale": 20.0},
            "rangeMapVerticalUp": {"inputMaxValue": 90.0, "outputScale": 20.0},
        },
    }


def write_character(
    path: Path,
    fit: SkeletonFit,
    positions: np.ndarray,
    surfaces: Sequence[Surface],
    materials: Mapping[str, Material],
    meta: Mapping[str, Any],
    suisou: Mapping[str, Any],
    *,
    compact: Collection[str] = (),
) -> None:
    """Write one character; `positions` are the (J, 3) joint centres of the T-pose as standing on the floor.

    `compact` meshes have normals, texture coordinates and weights as integers: half the size, for what nothing touches.
    """
    buffer = _Buffer()
    used = [name for name in materials if any(name in surface.triangles for surface in surfaces)]
    textures = list(dict.fromkeys(texture for name in used for texture in materials[name].textures()))
    tiled = any(materials[name].normal_tiles != 1.0 for name in used)
    nodes = _nodes(fit, positions)
    meshes = [_mesh(buffer, surface, used, surface.name in compact) for surface in surfaces]
    quantized = any(surface.name in compact for surface in surfaces)
    inverse_binds = np.linalg.inv(fit.world_from_joint_rest)
    inverse_binds[:, 3] = (0.0, 0.0, 0.0, 1.0)
    skin = {
        "name": "skin",
        "skeleton": 0,
        "joints": [joint + 1 for joint in range(len(fit.names))],
        "inverseBindMatrices": buffer.accessor(np.swapaxes(inverse_binds, 1, 2).reshape(-1, 16), FLOAT, "MAT4"),
    }
    mesh_nodes = {}
    for index, surface in enumerate(surfaces):
        mesh_nodes[surface.name] = len(nodes)
        nodes.append({"name": surface.name, "mesh": index, "skin": 0})
    document = {
        "asset": {"version": "2.0", "generator": "Suisou build_characters", "copyright": meta["copyrightInformation"]},
        "extensionsUsed": ["VRMC_vrm", *([TRANSFORM] if tiled else []), *([QUANTIZED] if quantized else [])],
        **({"extensionsRequired": [QUANTIZED]} if quantized else {}),
        "scene": 0,
        "scenes": [{"name": meta["name"], "nodes": [0, *mesh_nodes.values()], "extras": {"suisou": suisou}}],
        "nodes": nodes,
        "meshes": meshes,
        "skins": [skin],
        "materials": [_material(name, materials[name], textures) for name in used],
        **_pictures(buffer, textures),
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
        "extensions": {"VRMC_vrm": _vrm(fit, meta, surfaces, mesh_nodes)},
    }
    gltf = GLTF2.from_json(json.dumps(document))
    for accessor in gltf.accessors:
        # pygltflib writes byteOffset 0 by default, which the format forbids where there is no buffer view.
        if accessor.bufferView is None:
            accessor.byteOffset = None
    gltf.set_binary_blob(bytes(buffer.data))
    path.write_bytes(b"".join(gltf.save_to_bytes()))
