"""Evaluation of a GLB or USD file at a frame, as its specification says and by none of our code.

Both give, in centimetres, where every joint is (J, 3), the weights of the morphs by name, and where the corners of all
faces of each material are (corners, 3), in the order of the file's faces.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pygltflib
from scipy.spatial.transform import Rotation

_DTYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@dataclass(frozen=True)
class Shown:
    """Joints, morphs and faces of one frame."""

    joints_cm: np.ndarray
    weights: dict[str, float]
    corners_cm: dict[str, np.ndarray]


class GlbFile:
    """A GLB file with one animation and one skin, loaded by pygltflib."""

    def __init__(self, path: Path) -> None:
        loaded = pygltflib.GLTF2().load(str(path))
        assert loaded is not None
        self._gltf = loaded
        self._bytes = loaded.binary_blob()
        self.parents = [-1] * len(loaded.nodes)
        for index, node in enumerate(loaded.nodes):
            for child in node.children or []:
                self.parents[child] = index
        (self._animation,) = loaded.animations
        (skin,) = loaded.skins
        self.joints = list(skin.joints)
        self.names = [loaded.nodes[joint].name for joint in self.joints]
        self._inverse_binds = self.values(skin.inverseBindMatrices).reshape(-1, 4, 4).transpose(0, 2, 1)
        self.times = self.values(self._animation.samplers[0].input)[:, 0]
        self._keys: dict[tuple[int, str], np.ndarray] = {}
        for channel in self._animation.channels:
            sampler = self._animation.samplers[channel.sampler]
            assert np.array_equal(self.values(sampler.input)[:, 0], self.times)
            values = self.values(sampler.output)
            self._keys[channel.target.node, channel.target.path] = values.reshape(len(self.times), -1)

    @property
    def frames(self) -> int:
        return len(self.times)

    def values(self, number: int) -> np.ndarray:
        """An accessor's elements (N, width)."""
        accessor = self._gltf.accessors[number]
        dtype, width = _DTYPES[accessor.componentType], _WIDTHS[accessor.type]
        result = np.zeros((accessor.count, width), dtype)
        if accessor.bufferView is not None:
            result[:] = self._view(accessor.bufferView, accessor.byteOffset, accessor.count, dtype, width)
        if accessor.sparse is not None:
            count, places, values = accessor.sparse.count, accessor.sparse.indices, accessor.sparse.values
            rows = self._view(places.bufferView, places.byteOffset, count, _DTYPES[places.componentType], 1)[:, 0]
            result[rows] = self._view(values.bufferView, values.byteOffset, count, dtype, width)
        return result

    def _view(self, number: int, offset: int, count: int, dtype: Any, width: int) -> np.ndarray:
        start = self._gltf.bufferViews[number].byteOffset + offset
        return np.frombuffer(self._bytes, dtype, count * width, start).reshape(count, width)

    def shown(self, frame: int) -> Shown:
        """Return the joints, morphs and vertices of a frame."""
        nodes = self._gltf.nodes
        world: dict[int, np.ndarray] = {}

        def of(node: int) -> np.ndarray:
            if node not in world:
                local = np.eye(4)
                place = self._keys.get((node, "translation"))
                turn = self._keys.get((node, "rotation"))
                local[:3, 3] = nodes[node].translation or (0, 0, 0) if place is None else place[frame]
                local[:3, :3] = Rotation.from_quat(
                    nodes[node].rotation or (0, 0, 0, 1) if turn is None else turn[frame]
                ).as_matrix()
                world[node] = local if self.parents[node] < 0 else of(self.parents[node]) @ local
            return world[node]

        world_from_joint = np.stack([of(joint) for joint in self.joints])
        world_from_mesh = world_from_joint @ self._inverse_binds
        weights: dict[str, float] = {}
        corners: dict[str, np.ndarray] = {}
        for index, node in enumerate(nodes):
            if node.mesh is None:
                continue
            mesh = self._gltf.meshes[node.mesh]
            names = mesh.extras.get("targetNames", [])
            moved = self._keys[index, "weights"][frame] if (index, "weights") in self._keys else np.zeros(len(names))
            weights |= dict(zip(names, moved.tolist(), strict=True))
            for primitive in mesh.primitives:
                name = self._gltf.materials[primitive.material].name
                corners[name] = 100.0 * self._skinned(primitive, moved, world_from_mesh)
        return Shown(100.0 * world_from_joint[:, :3, 3], weights, corners)

    def _skinned(self, primitive: Any, morph_weights: np.ndarray, world_from_mesh: np.ndarray) -> np.ndarray:
        attributes = primitive.attributes
        points = self.values(attributes.POSITION).astype(float)
        for target, weight in zip(primitive.targets or [], morph_weights, strict=True):
            points += weight * self.values(target["POSITION"])
        sets = [number for number in range(4) if getattr(attributes, f"JOINTS_{number}", None) is not None]
        joints = np.concatenate([self.values(getattr(attributes, f"JOINTS_{number}")) for number in sets], axis=1)
        weights = np.concatenate([self.values(getattr(attributes, f"WEIGHTS_{number}")) for number in sets], axis=1)
        blended = np.einsum("vk,vkij->vij", weights, world_from_mesh[joints])
        skinned = np.einsum("vij,vj->vi", blended[:, :3, :3], points) + blended[:, :3, 3]
        return skinned[self.values(primitive.indices)[:, 0]]


class UsdFile:
    """A USD file with one SkelRoot, evaluated by UsdSkel."""

    def __init__(self, path: Path) -> None:
        from pxr import Usd, UsdGeom, UsdSkel

        self._stage = Usd.Stage.Open(str(path))
        self._cm = 100.0 * UsdGeom.GetStageMetersPerUnit(self._stage)
        root = UsdSkel.Root(self._stage.GetDefaultPrim())
        self._cache = UsdSkel.Cache()
        self._cache.Populate(root, Usd.PrimDefaultPredicate)
        children = root.GetPrim().GetChildren()
        self._meshes = [child for child in children if child.IsA(UsdGeom.Mesh)]
        (skeleton,) = (UsdSkel.Skeleton(child) for child in children if child.IsA(UsdSkel.Skeleton))
        self._skeleton = self._cache.GetSkelQuery(skeleton)
        self.names = list(skeleton.GetJointNamesAttr().Get())
        self.frames = round(self._stage.GetEndTimeCode() - self._stage.GetStartTimeCode()) + 1
        self.fps = self._stage.GetFramesPerSecond()

    def shown(self, frame: int) -> Shown:
        """Return the joints, morphs and vertices of a frame."""
        from pxr import Usd

        time = Usd.TimeCode(frame)
        joints = np.array(self._skeleton.ComputeJointSkelTransforms(time))[:, 3, :3] * self._cm
        animation = self._skeleton.GetAnimQuery()
        order = animation.GetBlendShapeOrder()
        weights = dict(zip(order, animation.ComputeBlendShapeWeights(time) if order else (), strict=True))
        corners: dict[str, np.ndarray] = {}
        for prim in self._meshes:
            corners |= self._corners(prim, time)
        return Shown(joints, weights, corners)

    def points_cm(self, path: str, time: Any) -> np.ndarray:
        """Points of the mesh at a path after its blend shapes and its skeleton."""
        from pxr import UsdGeom, UsdSkel, Vt

        prim = self._stage.GetPrimAtPath(path)
        query = self._cache.GetSkinningQuery(prim)
        points = Vt.Vec3fArray(UsdGeom.Mesh(prim).GetPointsAttr().Get())
        if query.HasBlendShapes() and self._skeleton.GetAnimQuery().GetBlendShapeOrder():
            shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(prim))
            given = self._skeleton.GetAnimQuery().ComputeBlendShapeWeights(time)
            of_shapes = shapes.ComputeSubShapeWeights(query.GetBlendShapeMapper().Remap(given, Vt.FloatArray()))
            indices, offsets = shapes.ComputeBlendShapePointIndices(), shapes.ComputeSubShapePointOffsets()
            assert shapes.ComputeDeformedPoints(*of_shapes, indices, offsets, points)
        transforms = self._skeleton.ComputeSkinningTransforms(time)
        order = query.GetJointMapper()
        assert query.ComputeSkinnedPoints(transforms if order is None else order.Remap(transforms), points, time)
        return np.array(points) * self._cm

    def _corners(self, prim: Any, time: Any) -> dict[str, np.ndarray]:
        from pxr import UsdGeom, UsdShade

        points = self.points_cm(str(prim.GetPath()), time)
        mesh = UsdGeom.Mesh(prim)
        (width,) = set(mesh.GetFaceVertexCountsAttr().Get())
        faces = np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, width)
        subsets = UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets()
        if not subsets:
            return {_material(prim): points[faces.ravel()]}
        return {
            _material(subset.GetPrim()): points[faces[np.array(subset.GetIndicesAttr().Get())].ravel()]
            for subset in subsets
        }


def _material(prim: Any) -> str:
    from pxr import UsdShade

    material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
    name: str = material.GetPrim().GetDisplayName()
    return name
