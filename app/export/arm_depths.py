"""Measurement of how deep forearms and hands, including sleeves, penetrate clothes and skin of trunk and thighs.

The surfaces in the file are measured. Frames are tried in order of the distance between chest, hips and thighs in their
bind poses and the line from elbow to wrist, some time apart; surfaces are computed only for these frames. The result is
at or near the greatest depth, and never too large.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Final

import msgspec
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from app.arrays import AnyIntArray, BoolArray, FloatArray, IndexArray
from app.errors import StopRequested, raise_if_stopped
from app.export.joint_playback import JointPlayback
from app.export.playback import PlaybackBones, ScenePlayback, Surface
from app.formats.scene import SkinnedMesh
from app.rig import quaternion

ARM_MM: Final = 10.0
"""Depth in millimetres of a forearm inside cloth that is tolerated, since cloth yields."""
_TRUNK: Final = ("hips", "spine", "chest", "upperChest", "leftUpperLeg", "rightUpperLeg")
_THIGHS: Final = ("leftUpperLeg", "rightUpperLeg")
_SHINS: Final = ("leftLowerLeg", "rightLowerLeg")
_CARRIED: Final = 0.9
"""Least skin weight for the trunk, or for a forearm, of the vertices compared; those between, as in the armpit, touch
anyway.
"""
_MOSTLY: Final = 0.5
"""Least weight for the trunk where shins have the rest, as on the lap in a long skirt."""
_NEAR_M: Final = 0.06
"""Distance in metres within which surfaces are compared: about the thickness of a forearm in a sleeve."""
_ASIDE_M: Final = 0.015
"""Sideways distance in metres from the nearest vertex above which a point is beyond an edge such as a hem or collar,
and not inside.
"""
_ENCLOSED: Final = 0.6
"""Least winding number of a surface about a point inside it. Beside a closed surface with holes, such as a jacket with
neck and hem, it is near 1 inside; on either side of an open sheet, such as a trim, at most 0.5."""
_SEAM_M: Final = 1e-4
"""Distance in metres within which vertices are one, as at seams of textures."""
_BELOW_M, _PROBES = 0.004, 16
"""Depth in metres below a part of a surface, and number of points there, that show whether it encloses a volume."""
_TESTED: Final = 24
"""Number of points whose winding numbers are computed at a time."""
_MOST_TESTED: Final = 480
_CORNERS: Final = 8
"""Number of the corners nearest to a point whose triangles are asked for the nearest one."""
_MOST_FRAMES, _APART_S, _SAMPLES, _CHUNK = 12, 0.25, 8, 2048


class ArmDepth(msgspec.Struct, frozen=True):
    """Greatest depth of an arm in the trunk.

    Attributes
    ----------
    side : str
        ``left`` or ``right``; empty if no arm is inside.
    depth_mm : float
        The depth.
    frame : int
        Frame at which it occurs.
    bound_mm : float
        Greatest accepted depth.
    """

    side: str = ""
    depth_mm: float = 0.0
    frame: int = 0
    bound_mm: float = ARM_MM

    @property
    def kept(self) -> bool:
        """True if the depth is within the bound."""
        return self.depth_mm <= self.bound_mm


def arm_depth(joints: JointPlayback, stop_requested: StopRequested = lambda: False) -> ArmDepth:
    """Return the greatest depth of a forearm or hand in trunk and clothes in an exported file.

    Raises
    ------
    Cancelled
        ``stop_requested`` returned true.
    """
    playback = joints.playback
    trunk = [surface for mesh in playback.scene.meshes for surface in _surfaces(joints, mesh)]
    worst = ArmDepth()
    for side in ("left", "right"):
        arm = [
            Surface(playback, mesh, held)
            for mesh in playback.scene.meshes
            if len(held := np.flatnonzero(_share(joints, mesh, (f"{side}LowerArm", f"{side}Hand")) >= _CARRIED))
        ]
        for frame in _frames(joints, side, trunk) if arm and trunk else ():
            raise_if_stopped(stop_requested)
            world = playback.world(frame, frame + 1)
            points_m = np.concatenate([surface.positions_m(world, frame, frame + 1)[0] for surface in arm])
            depth_m = max(one.depth_m(points_m, world, frame) for one in trunk)
            if 1000.0 * depth_m > worst.depth_mm:
                worst = ArmDepth(side, round(1000.0 * depth_m, 3), frame)
    return worst


class _TrunkSurface:
    """The part of a mesh, with one material, that moves with the trunk."""

    def __init__(self, playback: ScenePlayback, mesh: SkinnedMesh, held: IndexArray, triangles: AnyIntArray) -> None:
        self._surface = Surface(playback, mesh, held)
        self._triangles = np.searchsorted(held, triangles)
        self.bound_m = self._surface.skin.positions_m
        self._mesh, self._held = mesh, held

    def moved_by(self, joints: JointPlayback, names: Collection[str]) -> BoolArray:
        """Return the mask (V,) of the vertices that the named joints move by half at least."""
        return _share(joints, self._mesh, names)[self._held] >= 0.5

    def normals(self, places_m: FloatArray) -> FloatArray:
        """Return the outward normals (V, 3) of the V vertices at given positions."""
        a, b, c = (places_m[self._triangles[:, corner]] for corner in range(3))
        across = np.cross(b - a, c - a)
        sums = np.zeros_like(places_m)
        for corner in range(3):
            np.add.at(sums, self._triangles[:, corner], across)
        return np.asarray(sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-12))

    def depth_m(self, points_m: FloatArray, world: FloatArray, frame: int) -> float:
        """Return the greatest depth in metres of P points (P, 3) below the trunk's surface at a frame; ``world`` (1, J,
        4, 4) has the transforms of all bones there.
        """
        places_m = self._surface.positions_m(world, frame, frame + 1)[0]
        low, high = places_m.min(axis=0), places_m.max(axis=0)
        points_m = points_m[((points_m > low) & (points_m < high)).all(axis=1)]
        if not len(points_m):
            return 0.0
        tree = cKDTree(places_m)
        away, nearest = tree.query(points_m)
        inside = -np.einsum("pi,pi->p", points_m - places_m[nearest], self.normals(places_m)[nearest])
        aside = np.sqrt(np.maximum(away**2 - inside**2, 0.0))
        deep = np.flatnonzero((aside < _ASIDE_M) & (inside > 0.0))
        deep = deep[np.argsort(-inside[deep], kind="stable")]
        # Of very many points of open sheets, some of all depths are tested.
        deep = deep[:: 1 + len(deep) // _MOST_TESTED]
        corners_m, deepest_m = places_m[self._triangles], 0.0
        for first in range(0, len(deep), _TESTED):
            tested = deep[first : first + _TESTED]
            tested = tested[inside[tested] > deepest_m]
            if not len(tested):
                break
            enclosed = tested[_winding_numbers(points_m[tested], corners_m) > _ENCLOSED]
            if len(enclosed):
                # Large triangles, as of a belt, are nearer than their corners.
                around = tree.query(points_m[enclosed], k=min(_CORNERS, len(places_m)))[1]
                beside = np.isin(self._triangles, around).any(axis=1)
                below_m = _distances_m(points_m[enclosed], corners_m[beside])
                deepest_m = max(deepest_m, float(np.minimum(inside[enclosed], below_m).max()))
        return deepest_m


def _distances_m(points_m: FloatArray, corners_m: FloatArray) -> FloatArray:
    """Return the distances (P,) of P points (P, 3) from the nearest of T triangles (T, 3, 3)."""
    to_edges = []
    for corner in range(3):
        begin_m, along_m = corners_m[:, corner], corners_m[:, (corner + 1) % 3] - corners_m[:, corner]
        from_m = points_m[:, None] - begin_m
        share = quaternion.dot(from_m, along_m) / np.maximum(quaternion.dot(along_m, along_m), 1e-18)
        to_edges.append(np.linalg.norm(from_m - np.clip(share, 0.0, 1.0)[:, :, None] * along_m, axis=2))
    across = np.cross(corners_m[:, 1] - corners_m[:, 0], corners_m[:, 2] - corners_m[:, 0])
    normals = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-18)
    beside = np.ones(to_edges[0].shape, np.bool_)
    for corner in range(3):
        inwards = np.cross(normals, corners_m[:, (corner + 1) % 3] - corners_m[:, corner])
        beside &= quaternion.dot(points_m[:, None] - corners_m[:, corner], inwards) >= 0.0
    over_m = np.abs(quaternion.dot(points_m[:, None] - corners_m[:, 0], normals))
    distances_m: FloatArray = np.minimum(np.minimum.reduce(to_edges), np.where(beside, over_m, np.inf)).min(axis=1)
    return distances_m


def _winding_numbers(points_m: FloatArray, corners_m: FloatArray) -> FloatArray:
    """Return the winding numbers (P,) of a surface of T triangles (T, 3, 3) about P points (P, 3): the sum of the solid
    angles of its triangles (van Oosterom and Strackee 1983) over a full sphere's; positive inside.
    """
    a, b, c = (corners_m[None, :, corner] - points_m[:, None] for corner in range(3))
    far_a, far_b, far_c = (np.sqrt(quaternion.dot(side, side)) for side in (a, b, c))
    volume = quaternion.dot(a, quaternion.cross(b, c))
    flat = far_a * far_b * far_c
    flat += quaternion.dot(a, b) * far_c + quaternion.dot(b, c) * far_a + quaternion.dot(c, a) * far_b
    turns: FloatArray = np.arctan2(volume, flat).sum(axis=1) / (2.0 * np.pi)
    return turns


def _surfaces(joints: JointPlayback, mesh: SkinnedMesh) -> Iterator[_TrunkSurface]:
    """Yield the surfaces of a mesh that move with the trunk, one for each material, such as skin, shirt and
    trousers.
    """
    with_trunk = _share(joints, mesh, _TRUNK)
    held = (with_trunk >= _MOSTLY) & (with_trunk + _share(joints, mesh, _SHINS) >= _CARRIED)
    materials = np.zeros(len(mesh.faces), np.int64) if mesh.face_materials is None else mesh.face_materials
    for material in np.unique(materials):
        faces = mesh.faces[materials == material]
        faces = faces[held[faces].all(axis=1)]
        if len(faces):
            # Polygons are split into fans of triangles.
            fans = [faces[:, [0, corner, corner + 1]] for corner in range(1, faces.shape[1] - 1)]
            triangles = _enclosing(np.asarray(mesh.vertices_cm, np.float64) / 100.0, np.concatenate(fans))
            if len(triangles):
                yield _TrunkSurface(joints.playback, mesh, np.unique(triangles), triangles)


def _enclosing(places_m: FloatArray, triangles: AnyIntArray) -> AnyIntArray:
    """Return those of the triangles (T, 3) over vertices (V, 3) whose connected parts enclose a volume, alone or
    together: no trims, linings or single panels, which have no inside."""
    used, corners = np.unique(triangles, return_inverse=True)
    # Vertices that lie together, as at seams of textures, are one.
    _, together = np.unique(np.rint(places_m[used] / _SEAM_M).astype(np.int64), axis=0, return_inverse=True)
    corners = together.reshape(-1)[corners.reshape(-1)].reshape(-1, 3)
    links = (np.ones(2 * len(corners)), (corners[:, [0, 1]].ravel(), corners[:, [1, 2]].ravel()))
    _, part_of = connected_components(coo_matrix(links, shape=(int(corners.max()) + 1,) * 2), directed=False)
    part = part_of[corners[:, 0]]
    kept = np.zeros(int(part.max()) + 1, np.bool_)
    shape_m = places_m[triangles]
    across = np.cross(shape_m[:, 1] - shape_m[:, 0], shape_m[:, 2] - shape_m[:, 0])
    below_m = shape_m.mean(axis=1) - _BELOW_M * across / np.maximum(np.linalg.norm(across, axis=1), 1e-12)[:, None]
    for number in range(len(kept)):
        own = np.flatnonzero(part == number)
        probed = own[:: 1 + len(own) // _PROBES]
        kept[number] = np.median(_winding_numbers(below_m[probed], shape_m)) > _ENCLOSED
    enclosing: AnyIntArray = triangles[kept[part]]
    return enclosing


def _share(joints: JointPlayback, mesh: SkinnedMesh, names: Collection[str]) -> FloatArray:
    """Return for each vertex (V,) of a mesh the sum of its weights on bones of the named joints; bones that are no
    joint count as their nearest joint above.
    """
    parents, holds = joints.playback.parents, list[bool]()
    for bone, parent in enumerate(parents):
        own = joints.joint_names.get(bone)
        holds.append(own in names if own is not None else parent >= 0 and holds[parent])
    weights = np.where(np.array(holds)[mesh.joint_indices], mesh.weights, 0.0).sum(axis=1)
    return np.asarray(weights / np.maximum(mesh.weights.sum(axis=1), 1e-12))


def _frames(joints: JointPlayback, side: str, trunk: list[_TrunkSurface]) -> list[int]:
    """Return frames in which a forearm is near to the trunk, nearest first."""
    playback = joints.playback
    chest, hips = joints.bone("upperChest", "chest", "spine", "hips"), joints.bone("hips")
    holders = dict.fromkeys(("spine", "chest", "upperChest"), chest) | {"hips": hips}
    # A file without bones for the thighs has none to bend.
    holders |= {name: joints.bone(name) for name in _THIGHS if name in joints.joint_names.values()}
    parts = [part for bone in sorted(set(holders.values())) if len(part := _Held.by(bone, holders, joints, trunk))]
    bones = [*(part.bone for part in parts), joints.bone(f"{side}LowerArm"), joints.bone(f"{side}Hand")]
    limbs = PlaybackBones(playback, bones)
    rows, frames = limbs.rows(bones), playback.clip.frames
    along = np.linspace(0.0, 1.0, _SAMPLES)[:, None, None]
    away_m = np.full(frames, np.inf)
    for first in range(0, frames, _CHUNK):
        last = min(first + _CHUNK, frames)
        world = limbs.world(first, last)[rows]
        points_m = ((1.0 - along) * world[-2, :, 3] + along * world[-1, :, 3]).transpose(2, 0, 1)
        for part, holder in zip(parts, world, strict=False):
            from_holder_m = points_m - holder[:, 3].T[:, None]
            there_m = np.einsum("jif,fsj->fsi", holder[:, :3], from_holder_m)
            away_m[first:last] = np.minimum(away_m[first:last], part.away_m(there_m).min(axis=1))
    apart, chosen = _APART_S * float(playback.clip.fps), list[int]()
    for frame in np.argsort(away_m, kind="stable"):
        if away_m[frame] > _NEAR_M or len(chosen) == _MOST_FRAMES:
            break
        if all(abs(int(frame) - other) >= apart for other in chosen):
            chosen.append(int(frame))
    return chosen


class _Held:
    """The vertices of a trunk that move mostly with one bone, as they are bound to it."""

    def __init__(self, bone: int, places_m: FloatArray, normals: FloatArray) -> None:
        self.bone = bone
        self._places_m, self._normals = places_m, normals
        self._tree = cKDTree(places_m) if len(places_m) else None

    def __len__(self) -> int:
        return len(self._places_m)

    @classmethod
    def by(cls, bone: int, holders: Mapping[str, int], joints: JointPlayback, trunk: list[_TrunkSurface]) -> _Held:
        """Return the vertices of a bone; ``holders`` are the bones by the joints whose vertices they hold."""
        bind = np.array(joints.playback.scene.meshes[0].world_from_bone_bind[bone], np.float64)
        bind[:3, 3] /= 100.0
        bone_from_mesh, names = np.linalg.inv(bind), [name for name, holder in holders.items() if holder == bone]
        own = [one.moved_by(joints, names) for one in trunk]
        places_m = np.concatenate([one.bound_m[rows] for one, rows in zip(trunk, own, strict=True)])
        normals = np.concatenate([one.normals(one.bound_m)[rows] for one, rows in zip(trunk, own, strict=True)])
        turn = bone_from_mesh[:3, :3]
        return cls(bone, places_m @ turn.T + bone_from_mesh[:3, 3], normals @ turn.T)

    def away_m(self, points_m: FloatArray) -> FloatArray:
        """Return the distance (...) of points (..., 3) in the bone's frame from the vertices; negative inside."""
        assert self._tree is not None
        distance_m, nearest = self._tree.query(points_m)
        inside_m = -np.einsum("fsi,fsi->fs", points_m - self._places_m[nearest], self._normals[nearest])
        aside_m = np.sqrt(np.maximum(distance_m**2 - inside_m**2, 0.0))
        return np.where((inside_m > 0.0) & (aside_m < _ASIDE_M), -inside_m, distance_m)
