"""Reading of glTF 2.0 files (``.glb``, ``.gltf``) as plain values.

Files are untrusted, so every index, offset and size is checked before bytes are accessed, and nothing outside the
file's folder is opened. Units as in glTF: metres, right-handed, Y up, quaternions xyzw. Source: Khronos, "glTF 2.0
Specification", sections 3.6 (buffers and accessors), 3.7 (geometry, skins, morph targets) and 4 (GLB).
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from app.arrays import FloatArray, IntArray
from app.errors import FileError, shortened
from app.formats.gltf.accessors import Accessors
from app.formats.gltf.container import field, split
from app.formats.gltf.model import (
    GltfAnimation,
    GltfChannel,
    GltfImage,
    GltfMaterial,
    GltfMesh,
    GltfModel,
    GltfMorph,
    GltfNode,
    GltfPrimitive,
    GltfSkin,
    GltfTextureUse,
)
from app.formats.gltf.packed import unpacked
from app.formats.gltf.self_contained import read_whole

MOST_NODES = 20_000
DEEPEST = 500
"""Greatest nesting depth of nodes; strands of hair have some dozens of bones."""
_FREE_NUMBERS = 2**19
"""Fixed amount of numbers in repeated meshes that a small file may have."""
_ANIMATED = {"translation": 3, "rotation": 4, "scale": 3}
_INTERPOLATIONS = ("LINEAR", "STEP", "CUBICSPLINE")
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


class _Vertices(NamedTuple):
    """Arrays of the vertices of one glTF primitive: positions, normals, UVs, joints and weights."""

    positions: FloatArray
    normals: FloatArray | None
    uvs: FloatArray | None
    joint_indices: IntArray
    weights: FloatArray
    morphs: tuple[GltfMorph, ...]


def read_glb(path: str | os.PathLike[str], *, animated: bool = False, morphing: bool = False) -> GltfModel:
    """Read a glTF file.

    Parameters
    ----------
    animated : bool
        Whether to read animations.
    morphing : bool
        Whether to read animations of morphs.

    Raises
    ------
    FileError
        The file cannot be read, is damaged, or needs a file outside its folder.
    """
    return decode_gltf(read_whole(path), os.fspath(path), animated=animated, morphing=morphing)


def decode_gltf(data: bytes, file: str, *, animated: bool = False, morphing: bool = False) -> GltfModel:
    """Decode a glTF or GLB file from its bytes; ``file`` names it in errors, ``animated`` and ``morphing`` as in
    `read_glb`."""
    document, binary = split(data, file)
    document, parts = unpacked(document, binary, file, len(data))
    reader = _Reader(document, binary, file, len(data), parts)
    nodes = reader.nodes()
    meshes = tuple(reader.mesh(mesh, index) for index, mesh in enumerate(reader.items("meshes")))
    reader.check_instances(nodes, meshes)
    counts = [len(meshes[node.mesh].morph_names) if morphing and node.mesh is not None else 0 for node in nodes]
    return GltfModel(
        nodes=nodes,
        meshes=meshes,
        skins=tuple(reader.skin(skin) for skin in reader.items("skins")),
        materials=tuple(reader.material(material) for material in reader.items("materials")),
        images=reader.images(),
        extensions=reader.mapping(reader.document, "extensions"),
        scene_extras=reader.scene_extras(),
        size_bytes=len(data),
        generator=str(field(reader.mapping(reader.document, "asset"), "generator") or ""),
        animations=tuple(reader.animation(one, counts) for one in reader.items("animations")) if animated else (),
    )


class _Reader(Accessors):
    """Converter of a checked glTF document to plain values."""

    def mesh(self, mesh: object, index: int) -> GltfMesh:
        primitives = self.items("primitives", mesh)
        names = self.mapping(mesh, "extras").get("targetNames")
        if not isinstance(names, list) and primitives:  # some exporters store the names here
            names = self.mapping(primitives[0], "extras").get("targetNames")
        names = [str(name) for name in names] if isinstance(names, list) else []
        known: dict[str, _Vertices] = {}
        return GltfMesh(
            self.text(mesh, "name", f"mesh_{index}"),
            tuple(self._primitive(primitive, names, known) for primitive in primitives),
        )

    def check_instances(self, nodes: tuple[GltfNode, ...], meshes: tuple[GltfMesh, ...]) -> None:
        """Raise FileError if the nodes show meshes more often than any character does, which would fill the memory."""
        sizes = [_size(mesh) for mesh in meshes]
        shown = sum(sizes[node.mesh] for node in nodes if node.mesh is not None)
        if shown > _FREE_NUMBERS + 2 * sum(sizes):
            raise FileError("gltf.too_large", file=self.file)

    def _primitive(self, primitive: object, names: list[str], known: dict[str, _Vertices]) -> GltfPrimitive:
        attributes, targets = self.mapping(primitive, "attributes"), self.items("targets", primitive)
        # Primitives with different materials often share their vertices, which are read once.
        key = repr((attributes, targets))
        if key not in known:
            known[key] = self._vertices(attributes, targets, names)
        return GltfPrimitive(
            **known[key]._asdict(),
            triangles=self._triangles(primitive, len(known[key].positions)),
            material=self.optional_index(primitive, "material", len(self.items("materials"))),
        )

    def _vertices(self, attributes: dict[str, Any], targets: list[Any], names: list[str]) -> _Vertices:
        positions = self.real(attributes.get("POSITION"), 3)
        count = len(positions)

        def optional(name: str, width: int) -> FloatArray | None:
            if attributes.get(name) is None:
                return None
            read = self.weights if name.startswith("WEIGHTS") else self.real
            values = read(attributes[name], width)
            if len(values) != count:
                raise self.damaged(name)
            return values

        sets = 0
        while attributes.get(f"JOINTS_{sets}") is not None:
            sets += 1
        joints = [self.whole(attributes[f"JOINTS_{number}"], 4) for number in range(sets)]
        weights = [optional(f"WEIGHTS_{number}", 4) for number in range(sets)]
        if any(values is None for values in weights) or any(len(values) != count for values in joints):
            raise self.damaged("JOINTS")
        self.take(count * 8 * sets)
        return _Vertices(
            positions=positions,
            normals=optional("NORMAL", 3),
            uvs=optional("TEXCOORD_0", 2),
            joint_indices=np.concatenate([np.empty((count, 0), np.int64), *joints], axis=1),
            weights=np.concatenate([np.empty((count, 0)), *(w for w in weights if w is not None)], axis=1),
            morphs=tuple(
                self._morph(target, names[number] if number < len(names) else f"morph_{number}", count)
                for number, target in enumerate(targets)
            ),
        )

    def _triangles(self, primitive: object, count: int) -> IntArray:
        number = field(primitive, "indices")
        if number is None:
            self.take(count)
            indices = np.arange(count)
        else:
            indices = self.whole(number, 1)[:, 0]
            if indices.size and indices.max() >= count:
                raise self.damaged("indices")
        mode = self.number(primitive, "mode", _TRIANGLES)
        if len(indices) < 3 and mode in (_TRIANGLES, _STRIP, _FAN):
            return np.empty((0, 3), dtype=np.int64)
        if mode == _TRIANGLES:
            return indices[: len(indices) // 3 * 3].reshape(-1, 3)
        if mode in (_STRIP, _FAN):
            self.take(3 * len(indices))
        if mode == _STRIP:
            strip = np.stack([indices[:-2], indices[1:-1], indices[2:]], axis=1)
            strip[1::2] = strip[1::2, [1, 0, 2]]
            return strip
        if mode == _FAN:
            return np.stack([indices[1:-1], indices[2:], np.full(len(indices) - 2, indices[0])], axis=1)
        raise FileError("gltf.unsupported", file=self.file, what="points or lines")

    def _morph(self, target: object, name: str, count: int) -> GltfMorph:
        attributes = target if isinstance(target, dict) else {}
        rows, deltas = np.empty(0, dtype=np.int64), np.empty((0, 3))
        if attributes.get("POSITION") is not None:
            rows, deltas = self.changes(attributes["POSITION"], count)
        if attributes.get("NORMAL") is None:
            return GltfMorph(name, rows, deltas, None)
        normal_rows, normal_deltas = self.changes(attributes["NORMAL"], count)
        self.take(7 * (len(rows) + len(normal_rows)))
        both = np.union1d(rows, normal_rows)
        deltas_of_both = np.zeros((2, len(both), 3))
        deltas_of_both[0, np.searchsorted(both, rows)] = deltas
        deltas_of_both[1, np.searchsorted(both, normal_rows)] = normal_deltas
        return GltfMorph(name, both, deltas_of_both[0], deltas_of_both[1])

    def skin(self, skin: object) -> GltfSkin:
        nodes = self.items("nodes")
        joints = tuple(self.index(joint, len(nodes), "skin joint") for joint in self.items("joints", skin))
        self.take(16 * len(joints))
        matrices = np.tile(np.eye(4), (len(joints), 1, 1))
        number = field(skin, "inverseBindMatrices")
        if number is not None:
            values = self.real(number, 16)
            if len(values) < len(joints):
                raise self.damaged("inverseBindMatrices")
            # stored column by column
            matrices = values[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1).copy()
        return GltfSkin(self.text(skin, "name", ""), joints, matrices)

    def animation(self, animation: object, morph_counts: Sequence[int]) -> GltfAnimation:
        """Return the channels of an animation for nodes' transforms, and for morphs of nodes that have any
        (``morph_counts``); channels of extensions are skipped.
        """
        nodes, samplers = self.items("nodes"), self.items("samplers", animation)
        channels: list[GltfChannel] = []
        weights: list[GltfChannel] = []
        for channel in self.items("channels", animation):
            target = self.mapping(channel, "target")
            path = self.text(target, "path", "")
            node = self.optional_index(target, "node", len(nodes))
            count = 0 if node is None else morph_counts[node]
            if node is None or (path not in _ANIMATED and not (path == "weights" and count)):
                continue
            sampler = samplers[self.index(field(channel, "sampler"), len(samplers), "sampler")]
            interpolation = self.text(sampler, "interpolation", "LINEAR")
            times = self.real(field(sampler, "input"), 1)[:, 0]
            values = self.real(field(sampler, "output"), _ANIMATED.get(path, 1))
            rows = len(times) * (3 if interpolation == "CUBICSPLINE" else 1)
            if path == "weights" and len(values) == rows * count:
                values = values.reshape(rows, count)
            if not len(times) or len(values) != rows or not (np.diff(times) > 0.0).all():
                raise self.damaged("animation")
            if interpolation not in _INTERPOLATIONS:
                raise FileError("gltf.unsupported", file=self.file, what=shortened(interpolation, 40))
            found = weights if path == "weights" else channels
            found.append(GltfChannel(node, path, interpolation, times, values))
        name, extras = self.text(animation, "name", ""), self.mapping(animation, "extras")
        return GltfAnimation(name, tuple(channels), tuple(weights), extras)

    def material(self, material: object) -> GltfMaterial:
        surface = field(material, "pbrMetallicRoughness")
        red, green, blue, alpha = self.floats(surface, "baseColorFactor", (1.0, 1.0, 1.0, 1.0))
        normal, occlusion = field(material, "normalTexture"), field(material, "occlusionTexture")
        return GltfMaterial(
            name=self.text(material, "name", ""),
            base_color_rgba=(red, green, blue, alpha),
            metallic=self._factor(surface, "metallicFactor"),
            roughness=self._factor(surface, "roughnessFactor"),
            alpha_mode=self.text(material, "alphaMode", "OPAQUE"),
            double_sided=field(material, "doubleSided") is True,
            alpha_cutoff=self._factor(material, "alphaCutoff", 0.5),
            color=self._texture(field(surface, "baseColorTexture")),
            normal=self._texture(normal),
            metallic_roughness=self._texture(field(surface, "metallicRoughnessTexture")),
            occlusion=self._texture(occlusion),
            normal_scale=self._factor(normal, "scale"),
            occlusion_strength=self._factor(occlusion, "strength"),
        )

    def _factor(self, owner: object, name: str, otherwise: float = 1.0) -> float:
        value = field(owner, name)
        return otherwise if value is None else self.finite([value], 1, name)[0]

    def _texture(self, use: object) -> GltfTextureUse | None:
        """Return a texture reference of a material; None if its image needs an unknown extension, or if it does not use
        the first UV set.
        """
        if use is None:
            return None
        textures = self.items("textures")
        texture = textures[self.index(field(use, "index"), len(textures), "texture")]
        moved = self.mapping(self.mapping(use, "extensions"), "KHR_texture_transform")
        count = len(self.items("images"))
        webp = self.mapping(self.mapping(texture, "extensions"), "EXT_texture_webp")
        image = self.optional_index(texture, "source", count)
        image = self.optional_index(webp, "source", count) if image is None else image
        if image is None or (moved.get("texCoord") or field(use, "texCoord") or 0) != 0:
            return None
        scale_u, scale_v = self.floats(moved, "scale", (1.0, 1.0))
        offset_u, offset_v = self.floats(moved, "offset", (0.0, 0.0))
        return GltfTextureUse(image, (scale_u, scale_v), (offset_u, offset_v))

    def images(self) -> tuple[GltfImage, ...]:
        """Return the bytes of the images; empty for external ones, which are not needed. Equal bytes are shared."""
        blobs: dict[int, bytes] = {}
        found = []
        for image in self.items("images"):
            uri = field(image, "uri")
            view = self.optional_index(image, "bufferView", len(self.items("bufferViews")))
            name = self.text(image, "name", "")
            if isinstance(uri, str) and uri.startswith("data:"):
                found.append(GltfImage(name, self.data(uri)))
            elif view is None:
                found.append(GltfImage(name, b""))
            else:
                if view not in blobs:
                    blobs[view] = self.blob(view)
                found.append(GltfImage(name, blobs[view]))
        return tuple(found)

    def nodes(self) -> tuple[GltfNode, ...]:
        nodes = self.items("nodes")
        if not nodes:
            raise self.damaged("nodes")
        if len(nodes) > MOST_NODES:
            raise FileError("gltf.too_large", file=self.file)
        parents = [-1] * len(nodes)
        for number, node in enumerate(nodes):
            for child in self.items("children", node):
                if parents[self.index(child, len(nodes), "child")] != -1:
                    raise self.damaged("node with two parents")
                parents[child] = number
        self._check_depth(parents)
        return tuple(self._node(node, number, parents[number]) for number, node in enumerate(nodes))

    def _check_depth(self, parents: list[int]) -> None:
        """Raise FileError for cycles and excessive nesting of nodes."""
        children: list[list[int]] = [[] for _ in parents]
        for number, parent in enumerate(parents):
            if parent >= 0:
                children[parent].append(number)
        level = [number for number, parent in enumerate(parents) if parent < 0]
        reached = depth = 0
        while level:
            reached, depth = reached + len(level), depth + 1
            if depth > DEEPEST:
                raise FileError("gltf.too_deep", file=self.file, most=DEEPEST)
            level = [child for number in level for child in children[number]]
        if reached != len(parents):
            raise self.damaged("node that is its own ancestor")

    def _node(self, node: object, number: int, parent: int) -> GltfNode:
        translation: FloatArray = np.array(self.floats(node, "translation", (0.0, 0.0, 0.0)))
        rotation: FloatArray = np.array(self.floats(node, "rotation", (0.0, 0.0, 0.0, 1.0)))
        scale: FloatArray = np.array(self.floats(node, "scale", (1.0, 1.0, 1.0)))
        length = math.sqrt(float(rotation @ rotation))
        if length < 1e-6:
            raise self.damaged("rotation")
        rotation = rotation / length
        if field(node, "matrix"):
            entries: FloatArray = np.array(self.finite(field(node, "matrix"), 16, "matrix"))
            matrix = entries.reshape(4, 4).T
            translation, rotation, scale = self._parts(matrix)
        return GltfNode(
            name=self.text(node, "name", f"node_{number}"),
            parent=parent,
            translation=translation,
            rotation_xyzw=rotation,
            scale=scale,
            mesh=self.optional_index(node, "mesh", len(self.items("meshes"))),
            skin=self.optional_index(node, "skin", len(self.items("skins"))),
            extensions=self.mapping(node, "extensions"),
        )

    def _parts(self, matrix: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return translation, rotation and scale of a matrix, the only transforms that glTF allows."""
        scale: FloatArray = np.sqrt((matrix[:3, :3] ** 2).sum(axis=0))
        if not (scale > 1e-12).all():
            raise self.damaged("matrix")
        if np.linalg.det(matrix[:3, :3]) < 0:
            scale[0] = -scale[0]
        m = matrix[:3, :3] / scale
        if np.abs(m.T @ m - np.eye(3)).max() > 1e-3:
            raise self.damaged("matrix")
        # Shepperd's method, which divides by the largest of the four candidates.
        squares = np.array([m[0, 0], m[1, 1], m[2, 2], np.trace(m)])
        largest = int(np.argmax(squares))
        if largest == 3:
            quaternion = np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], 1 + squares[3]])
        else:
            i, j, k = largest, (largest + 1) % 3, (largest + 2) % 3
            quaternion = np.empty(4)
            quaternion[i] = 1 - squares[3] + 2 * m[i, i]
            quaternion[j], quaternion[k] = m[j, i] + m[i, j], m[k, i] + m[i, k]
            quaternion[3] = m[k, j] - m[j, k]
        return matrix[:3, 3].copy(), quaternion / np.linalg.norm(quaternion), scale

    def scene_extras(self) -> dict[str, Any]:
        scenes = self.items("scenes")
        if not scenes:
            return {}
        return self.mapping(scenes[self.index(field(self.document, "scene") or 0, len(scenes), "scene")], "extras")


def _size(mesh: GltfMesh) -> int:
    """Return the count of numbers of a mesh, plus an allowance for each primitive."""
    shared = {id(primitive.positions): primitive for primitive in mesh.primitives}
    size = sum(256 + primitive.triangles.size for primitive in mesh.primitives)
    for primitive in shared.values():
        size += primitive.positions.size + primitive.joint_indices.size + primitive.weights.size
        size += sum(morph.position_deltas.size for morph in primitive.morphs)
    return size
