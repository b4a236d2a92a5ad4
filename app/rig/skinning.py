"""Linear blend skinning of selected vertices with morph targets, vectorised over frames."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, BoolArray, FloatArray, IndexArray
from app.identity_cache import IdentityCache
from app.rig import quaternion
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.skeleton import JointTransforms


@dataclass(frozen=True, eq=False)
class Skin:
    """Vertices prepared for deformation: linear blend skinning after morph targets.

    Attributes
    ----------
    positions_m : (V, 3) float64
        Positions in the mesh's bind space.
    joints : (J,) int
        Joints with weight for any of the vertices.
    weights : (V, J) float64
        Weight of each joint on each vertex.
    joint_from_mesh : (J, 3, 4) float64
        Inverse bind matrices.
    morphs : dict of str to (V, 3) float64
        Displacements of the morphs that move any of the vertices.
    """

    positions_m: FloatArray
    joints: IndexArray
    weights: FloatArray
    joint_from_mesh: FloatArray
    morphs: Mapping[str, FloatArray]

    @cached_property
    def _blend(self) -> FloatArray:
        """Return the matrix (4 J, V) whose product with the joints' matrices of all frames gives the skinned
        vertices.
        """
        homogeneous = np.concatenate([self.positions_m, np.ones((len(self.positions_m), 1))], axis=1)
        blend: FloatArray = np.einsum("vj,vi->jiv", self.weights, homogeneous).reshape(-1, len(self.positions_m))
        return blend

    def part(self, rows: AnyIntArray) -> Skin:
        """Return the skinning data of only the vertices ``rows``."""
        weights = self.weights[rows]
        used = np.flatnonzero(weights.any(axis=0))
        morphs = {name: deltas[rows] for name, deltas in self.morphs.items() if deltas[rows].any()}
        positions_m, joint_from_mesh = self.positions_m[rows], self.joint_from_mesh[used]
        return Skin(positions_m, self.joints[used], weights[:, used], joint_from_mesh, morphs)

    def deformed(self, world_from_joint: FloatArray, morphs: Mapping[str, AnyFloatArray] | None = None) -> FloatArray:
        """Return positions (F, V, 3) of the vertices in metres.

        Parameters
        ----------
        world_from_joint : (F, A, 4, 4) float64
            Transforms of all joints of the character.
        morphs : dict of str to (F,), optional
            Weight curves by morph name.
        """
        frames = len(world_from_joint)
        world = world_from_joint[:, self.joints, :3]
        matrices = world[..., :3] @ self.joint_from_mesh
        matrices[..., 3] += world[..., 3]
        rows = matrices.transpose(0, 2, 1, 3).reshape(frames * 3, -1)
        result: FloatArray = (rows @ self._blend).reshape(frames, 3, -1).transpose(0, 2, 1)
        shown = [(morphs[name], deltas) for name, deltas in self.morphs.items() if name in morphs] if morphs else []
        if shown:
            touched = np.flatnonzero(np.any([deltas.any(axis=1) for _, deltas in shown], axis=0))
            moved = np.zeros((frames, len(touched), 3))
            for curve, deltas in shown:
                moved += np.asarray(curve, dtype=np.float64)[:, None, None] * deltas[touched]
            blended = np.tensordot(self.weights[touched], matrices[..., :3], axes=(1, 1))
            result = result.copy()
            result[:, touched] += np.einsum("vfij,fvj->fvi", blended, moved)
        return result


@dataclass(frozen=True, eq=False)
class Patch(Skin):
    """Skinning data as in `Skin`, with the normals (V, 3) of the vertices."""

    normals: FloatArray


def mesh_named(character: Character, name: str) -> Mesh:
    """Return a mesh of a character; KeyError for an unknown name."""
    for mesh in character.meshes:
        if mesh.name == name:
            return mesh
    raise KeyError(name)


def skin_of(
    vertices: AnyIntArray,
    positions_m: AnyFloatArray,
    joints: AnyIntArray,
    weights: FloatArray,
    joint_from_mesh: FloatArray,
    morphs: Iterable[tuple[str, AnyIntArray, AnyFloatArray]],
) -> Skin:
    """Prepare some vertices (V,) of a mesh for deformation.

    Parameters
    ----------
    vertices : (V,) int
        Indices of the vertices.
    positions_m : (N, 3)
        Positions of all vertices of the mesh.
    joints, weights : (V, K)
        Joints and weights of the vertices; weights of a repeated joint are added.
    joint_from_mesh : (J, 3 or more, 4) float64
        Inverse bind matrices of all joints.
    morphs : iterable of (name, vertices, displacements)
        Morphs of the mesh: M vertices, and their displacements (M, 3) in metres.
    """
    is_used = np.zeros(len(joint_from_mesh), dtype=np.bool_)
    is_used[joints[weights != 0.0]] = True
    used = np.flatnonzero(is_used)
    columns = np.maximum(np.cumsum(is_used) - 1, 0)[joints]
    places = (np.arange(len(vertices))[:, None] * len(used) + columns).ravel()
    total = len(vertices) * len(used)
    summed = np.asarray(np.bincount(places, weights.ravel(), total)[:total], dtype=np.float64)
    moved = {}
    chosen = np.zeros(len(positions_m), dtype=np.bool_)
    chosen[vertices] = True
    rank = np.empty(len(positions_m), dtype=np.intp)
    for name, touched, deltas_m in morphs:
        rows = np.flatnonzero(chosen[touched])
        if len(rows):
            rank[vertices] = -1
            rank[touched[rows]] = rows
            hit = rank[vertices] >= 0
            moved[name] = np.zeros((len(vertices), 3))
            moved[name][hit] = deltas_m[rank[vertices[hit]]]
    place_m = positions_m[vertices].astype(np.float64)
    return Skin(place_m, used, summed.reshape(len(vertices), len(used)), joint_from_mesh[used, :3], moved)


def _moved(*touched: AnyIntArray) -> BoolArray:
    """Return a mask of the vertices that any of several morphs moves; its last entry is for all vertices beyond."""
    found = np.zeros(max(int(one.max(initial=-1)) for one in touched) + 2, dtype=np.bool_)
    for one in touched:
        found[one] = True
    return found


# People made from one body share the vertices of their morphs.
_MOVED: IdentityCache[BoolArray] = IdentityCache(32)


def patch(character: Character, mesh: Mesh, vertices: AnyIntArray) -> Patch:
    """Prepare vertices of a character's mesh for `Patch.deformed`, with their normals."""
    vertices = np.asarray(vertices, dtype=np.intp)
    weights = mesh.weights[vertices].astype(np.float64)
    morphs = [(morph.name, morph.vertices, morph.deltas_m) for morph in mesh.morphs]
    if morphs:
        # Of hands and legs the face moves nothing.
        moved = _MOVED.step(_moved, *(touched for _, touched, _ in morphs))
        morphs = morphs if moved[np.minimum(vertices, len(moved) - 1)].any() else []
    skin = skin_of(vertices, mesh.positions_m, mesh.joints[vertices], weights, character.joint_from_mesh, morphs)
    return Patch(**vars(skin), normals=mesh.normals[vertices].astype(np.float64))


def skin_matrices(joints: IndexArray, joint_from_mesh: FloatArray, transforms: JointTransforms) -> FloatArray:
    """Return the matrices (F, J, 3, 4) that move the mesh with J joints in F frames, ``world_from_mesh``, for the
    joints' inverse bind matrices (J, 3, 4)."""
    places = np.searchsorted(np.asarray(transforms.joints), joints)
    turn = quaternion.to_matrix(transforms.rotations[:, places])
    result: FloatArray = turn @ joint_from_mesh
    result[..., 3] += transforms.positions_m[:, places]
    return result


@dataclass(frozen=True, eq=False)
class LandmarkSet:
    """Landmarks prepared for `landmark_positions`.

    The mean of linearly blended vertices is linear in the joints' matrices, so a landmark is stored as one weighted
    homogeneous point per joint.

    Attributes
    ----------
    joints : (J,) int
        Joints that influence any of the landmarks.
    joint_from_mesh : (J, 3, 4) float64
        Their inverse bind matrices.
    points : (J, 4, L) float64
        Weighted homogeneous point of each joint for each of L landmarks.
    morphs : dict of str to (J, 3, L) float64
        Weighted displacement of these points by each morph.
    """

    names: tuple[str, ...]
    joints: IndexArray
    joint_from_mesh: FloatArray
    points: FloatArray
    morphs: Mapping[str, FloatArray]


@lru_cache(maxsize=256)
def landmark_set(character: Character, names: tuple[str, ...]) -> LandmarkSet:
    """Prepare landmarks of a character; KeyError if one is missing. Cached by the character's identity."""
    count = len(character.skeleton.names)
    points = np.zeros((count, 4, len(names)))
    morphs: dict[str, FloatArray] = {}
    for column, name in enumerate(names):
        landmark = character.landmarks[name]
        part = patch(character, mesh_named(character, landmark.mesh), landmark.vertices)
        share = part.weights.T / len(landmark.vertices)
        points[part.joints, :3, column] = share @ part.positions_m
        points[part.joints, 3, column] = share.sum(axis=1)
        for morph, deltas in part.morphs.items():
            morphs.setdefault(morph, np.zeros((count, 3, len(names))))[part.joints, :, column] = share @ deltas
    joints = np.flatnonzero(np.any(points[:, 3] > 0.0, axis=1))
    return LandmarkSet(
        names=names,
        joints=joints,
        joint_from_mesh=character.joint_from_mesh[joints, :3, :],
        points=points[joints],
        morphs={name: deltas[joints] for name, deltas in morphs.items()},
    )


def landmark_positions(
    character: Character,
    names: Sequence[str],
    transforms: JointTransforms,
    morphs: Mapping[str, AnyFloatArray] | None = None,
) -> FloatArray:
    """Return positions of landmarks on the deformed meshes.

    Parameters
    ----------
    names : sequence of str
        L landmarks.
    transforms : JointTransforms
        Transforms of all joints with influence on them (see `landmark_joints`).
    morphs : dict of str to (F,), optional
        Weight curves by morph name.

    Returns
    -------
    (F, L, 3) float64
        World positions, metres.
    """
    marks = landmark_set(character, tuple(names))
    matrices = skin_matrices(marks.joints, marks.joint_from_mesh, transforms)
    result = np.tensordot(matrices, marks.points, axes=([1, 3], [0, 1]))  # (F, 3, L)
    for name, deltas in marks.morphs.items():
        if morphs is not None and name in morphs and np.any(morphs[name]):
            # A morph moves few landmarks, which are weighted to few joints.
            carrying, moving = np.flatnonzero(deltas.any(axis=(1, 2))), np.flatnonzero(deltas.any(axis=(0, 1)))
            rows = matrices[:, carrying, :, :3].transpose(0, 2, 1, 3).reshape(-1, 3 * len(carrying))
            moved = (rows @ deltas[carrying][..., moving].reshape(-1, len(moving))).reshape(-1, 3, len(moving))
            result[..., moving] += np.asarray(morphs[name], dtype=np.float64)[:, None, None] * moved
    return np.ascontiguousarray(result.transpose(0, 2, 1))


def landmark_joints(character: Character, names: Sequence[str]) -> tuple[int, ...]:
    """Return the ascending indices of the joints that must be posed for `landmark_positions` of these landmarks."""
    return tuple(landmark_set(character, tuple(names)).joints.tolist())
