"""Points of a scene whose positions key reduction must preserve: landmarks, joints, and corners of boxes
around parts.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, BoolArray, IndexArray, IntArray
from app.export.joint_playback import JointPlayback
from app.export.playback import METRES, ScenePlayback, Surface
from app.formats.scene import SkinnedMesh
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.skinning import Skin

_NO_SHAPES: AnyFloatArray = np.zeros((0, 0, 3))


@dataclass(frozen=True, eq=False)
class BoneMarks:
    """Contribution of one bone to the positions of points on a skin.

    It is ``rotation @ (points + weights @ shapes) + shares * place``, with the bone's rotation and place and the
    weights of the morphs; a point is the sum over its bones.

    Attributes
    ----------
    marks : (K,) int
        Indices of the points.
    points_m : (K, 3)
        Points in the bone's frame, multiplied by the bone's shares.
    shares : (K,)
        Share of each point that the bone holds.
    shapes_m : (M, K, 3)
        Displacement of the points by each morph of `SkinnedMarks.morphs`.
    """

    marks: IndexArray
    points_m: AnyFloatArray
    shares: AnyFloatArray
    shapes_m: AnyFloatArray


@dataclass(frozen=True, eq=False)
class SkinnedMarks:
    """Points on a character or instrument, moved by linear blend skinning; the joints of all bones come first.

    Attributes
    ----------
    count : int
        Number of points, including the joints.
    carried : mapping of int to BoneMarks
        Contributions by bone, for the points after the joints.
    morphs : tuple of str
        Morphs that move any of the points.
    """

    count: int
    carried: Mapping[int, BoneMarks]
    morphs: tuple[str, ...] = ()

    def hang_on(self, parents: Sequence[int]) -> BoolArray:
        """Return a mask (K, B): whether the rotation of each of B bones moves each of K points."""
        above = np.eye(len(parents), dtype=bool)
        for bone, parent in enumerate(parents):
            if parent >= 0:
                above[bone] |= above[parent]
        result = np.zeros((self.count, len(parents)), bool)
        result[: len(parents)] = above
        for bone, carried in self.carried.items():
            result[carried.marks] |= above[bone]
        return result


@dataclass
class _Gathered:
    """Points while they are collected: index, position and share by bone, and displacement by morph."""

    count: int
    rows: dict[int, list[tuple[int, AnyFloatArray, float, dict[str, AnyFloatArray]]]] = field(default_factory=dict)

    def add(self, bone: int, point_m: AnyFloatArray, share: float = 1.0, **shapes_m: AnyFloatArray) -> None:
        self.rows.setdefault(bone, []).append((self.count, point_m, share, shapes_m))

    def add_box(self, bone: int, points_m: AnyFloatArray) -> None:
        """Add the corners of the bounding box of some points, which are in a bone's frame."""
        low, high = points_m.min(axis=0), points_m.max(axis=0)
        for corner in np.ndindex(2, 2, 2):
            self.add(bone, np.where(corner, high, low))
            self.count += 1

    def marks(self) -> SkinnedMarks:
        morphs = tuple(sorted({name for rows in self.rows.values() for *_, shapes in rows for name in shapes}))
        zero = np.zeros(3)
        carried = {
            bone: BoneMarks(
                np.array([number for number, *_ in rows]),
                np.array([point for _, point, *_ in rows]),
                np.array([share for _, _, share, _ in rows]),
                np.array([shapes.get(name, zero) for name in morphs for *_, shapes in rows]).reshape(-1, len(rows), 3),
            )
            for bone, rows in self.rows.items()
        }
        return SkinnedMarks(self.count, carried, morphs)


def character_marks(
    joints: JointPlayback, character: Character, hanging: Mapping[int, Sequence[Mesh]] | None = None
) -> SkinnedMarks:
    """Return the points of a character in a file: landmarks, all joints, and corners of the bounding boxes of attached
    objects.

    Parameters
    ----------
    joints : JointPlayback
        The file.
    character : Character
        The character.
    hanging : mapping of int to sequence of Mesh, optional
        Meshes of attached instruments at rest, by bone, in its frame.
    """
    gathered = _Gathered(len(joints.playback.bone_names))
    meshes: dict[int, tuple[SkinnedMesh, list[IntArray]]] = {}
    for name in sorted(character.landmarks):
        mesh, vertices = joints.surface(character.landmarks[name])
        meshes.setdefault(id(mesh), (mesh, []))[1].append(vertices)
    for mesh, places in meshes.values():
        skin, first = Surface(joints.playback, mesh, np.concatenate(places)).skin, 0
        for vertices in places:
            _add_mean(gathered, skin.part(np.arange(first, first + len(vertices))))
            first += len(vertices)
    for bone, held in (hanging or {}).items():
        gathered.add_box(bone, np.concatenate([mesh.positions_m for mesh in held]))
    return gathered.marks()


def part_marks(playback: ScenePlayback) -> SkinnedMarks:
    """Return the points of an instrument in a file: corners of the bounding box of everything each bone holds, and all
    joints.

    A rigid body deviates most at a corner, so these represent the whole surface of an instrument.
    """
    gathered = _Gathered(len(playback.bone_names))
    for mesh in playback.scene.meshes:
        points_m = np.c_[np.asarray(mesh.vertices_cm, np.float64) * METRES, np.ones(len(mesh.vertices_cm))]
        for bone in np.unique(mesh.joint_indices[mesh.weights > 0.0]).tolist():
            own = ((mesh.joint_indices == bone) & (mesh.weights > 0.0)).any(axis=1)
            bind = np.array(mesh.world_from_bone_bind[bone], np.float64)
            bind[:3, 3] *= METRES
            placed = points_m[own] @ np.linalg.inv(bind).T[:, :3]
            gathered.add_box(bone, placed)
    return gathered.marks()


def _add_mean(gathered: _Gathered, skin: Skin) -> None:
    """Add the mean of a landmark's vertices as one point, with the contributions of its joints and morphs."""
    share_of_vertex = skin.weights / len(skin.positions_m)
    placed = np.c_[skin.positions_m, np.ones(len(skin.positions_m))]
    points = np.einsum("vj,jik,vk->ji", share_of_vertex, skin.joint_from_mesh, placed, optimize=True)
    shapes = {
        name: np.einsum("vj,jik,vk->ji", share_of_vertex, skin.joint_from_mesh[..., :3], deltas, optimize=True)
        for name, deltas in skin.morphs.items()
    }
    for index, bone in enumerate(skin.joints.tolist()):
        moved = {name: shape[index] for name, shape in shapes.items() if shape[index].any()}
        gathered.add(bone, points[index], float(share_of_vertex[:, index].sum()), **moved)
    gathered.count += 1


@dataclass(frozen=True, eq=False)
class BoneLink:
    """Constant transform from a moving bone to its next moving ancestor.

    Attributes
    ----------
    above : int
        Index of the ancestor among the moving bones; -1 for none.
    turn : (3, 3) float32 or None
        Rotation of the bone's parent relative to the ancestor; None if the parent is the ancestor.
    offset_m : (3,) float32
        Position of the parent relative to the ancestor.
    place_m : (3,) float32
        Position of the bone relative to its parent, if constant.
    """

    above: int
    turn: AnyFloatArray | None
    offset_m: AnyFloatArray
    place_m: AnyFloatArray


def rigid_links(
    marks: SkinnedMarks, parents: Sequence[int], moving: AnyIntArray, turns: AnyFloatArray, places_m: AnyFloatArray
) -> tuple[list[BoneLink], dict[int, BoneMarks]]:
    """Return the links of N moving bones, and the contributions of bones to points on the skin; a bone that does not
    move relative to its parent is merged with it.

    Parameters
    ----------
    marks : SkinnedMarks
        Points on the skin.
    parents : sequence of int
        Parent of each bone.
    moving : (N,) int
        Indices of the moving bones.
    turns, places_m : (B, 3, 3) and (B, 3) float64
        Rotations and positions of all bones relative to their parents, at one frame.

    Returns
    -------
    list of BoneLink
        Links of the moving bones in single precision, accurate to some thousandths of a millimetre.
    dict of int to BoneMarks
        Contributions by index among the moving bones; -1 for points that do not move.
    """
    row_of = {bone: row for row, bone in enumerate(moving.tolist())}
    at: list[tuple[int, AnyFloatArray, AnyFloatArray]] = []
    links: list[BoneLink] = []
    parts: dict[int, list[BoneMarks]] = {}
    for bone, parent in enumerate(parents):
        row, turn, offset_m = at[parent] if parent >= 0 else (-1, np.eye(3), np.zeros(3))
        if bone in row_of:
            direct = parent < 0 or parent in row_of
            links.append(BoneLink(row, None if direct else _single(turn), _single(offset_m), _single(places_m[bone])))
            at.append((row_of[bone], np.eye(3), np.zeros(3)))
        else:
            at.append((row, turn @ turns[bone], turn @ places_m[bone] + offset_m))
        row, turn, offset_m = at[bone]
        parts.setdefault(row, []).append(BoneMarks(np.array([bone]), offset_m[None], np.ones(1), _NO_SHAPES))
        own = marks.carried.get(bone)
        if own is not None:
            points_m = own.points_m @ turn.T + own.shares[:, None] * offset_m
            parts[row].append(BoneMarks(own.marks, points_m, own.shares, own.shapes_m @ turn.T))
    return links, {row: _joined(found, len(marks.morphs), marks.count) for row, found in parts.items()}


def _joined(parts: Sequence[BoneMarks], morphs: int, count: int) -> BoneMarks:
    """Return the sum of the contributions of several bones that move together."""
    points_m, shares, shapes_m = np.zeros((count, 3)), np.zeros(count), np.zeros((morphs, count, 3))
    for part in parts:
        points_m[part.marks] += part.points_m
        shares[part.marks] += part.shares
        if part.shapes_m.size:
            shapes_m[:, part.marks] += part.shapes_m
    used = np.unique(np.concatenate([part.marks for part in parts]))
    return BoneMarks(used, _single(points_m[used]), _single(shares[used]), _single(shapes_m[:, used]))


def _single(values: AnyFloatArray) -> AnyFloatArray:
    return values.astype(np.float32)
