"""Lower levels of detail of meshes. A level consists of some of the mesh's own vertices, with their normals, UVs,
weights and morphs.

Edges are collapsed by fast-simplification (quadric error metrics: Garland and Heckbert 1997), which is loaded, like
scipy, when levels are made. No vertex moves, so that a level coincides with the mesh in every pose and expression.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from threading import Lock
from typing import Final, Literal, get_args

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, FloatArray, IntArray
from app.formats.scene import MorphTarget, Scene, SkinnedMesh
from app.formats.textures import NO_TEXTURES

MOST_LEVELS: Final = 3
"""Greatest number of levels, the full mesh included; see `TRIANGLE_SHARES`."""
LevelChoice = Literal[0, 1, 2, 3]
LEVEL_CHOICES: Final[tuple[LevelChoice, ...]] = get_args(LevelChoice)
"""Choices for the number of levels; 0 for the default (`levels_for`)."""
TRIANGLE_SHARES: Final = (0.5, 0.25)
"""Number of triangles of each reduced level, relative to the mesh."""
LEAST_HEIGHTS: Final = (0.5, 0.2)
"""Height of the figure relative to the screen below which each reduced level is displayed."""
_LEAST_TRIANGLES: Final = 64
"""Least number of triangles of a mesh that gets reduced levels; smaller ones are reeds or finger hooks."""
_TOUCHING_CM: Final = 1e-4
"""Rounding in centimetres within which vertices count as one."""
_TOUCHING_UV, _TOUCHING_WEIGHT = 1e-4, 1e-3
"""The same for texture coordinates and weights of joints."""
_UVS_COUNT: Final = 0.1
"""Cosine between normals that counts as much as a distance of 1 between texture coordinates."""
_SMALLEST: Final = 1e-12
_AGGRESSIVENESS: Final = 5.0
"""Growth of the error that the reduction allows. With the default of 7, levels deviate up to a third more from the
mesh.
"""
_WORTH_IT: Final = 0.8
"""Greatest ratio of a level's triangles to those of the level before; a level with more is omitted."""
_ONE_AT_A_TIME: Final = Lock()
"""Lock for the reduction, since the library keeps its mesh in a global variable."""


def levels_for(chosen: int, into_unreal: bool) -> int:
    """Return the number of levels of detail for a user's choice (`LEVEL_CHOICES`); 1 unless for Unreal, since other
    programs would show all levels at once.
    """
    return chosen or (MOST_LEVELS if into_unreal else 1)


def with_levels(scene: Scene, count: int) -> Scene:
    """Return a scene whose meshes have levels of detail.

    Parameters
    ----------
    scene : Scene
        The scene.
    count : int
        Number of levels, 1 to `MOST_LEVELS`, including the mesh itself.
    """
    if count == 1:
        return scene
    return replace(scene, meshes=tuple(replace(mesh, levels=lower_levels(mesh, count - 1)) for mesh in scene.meshes))


def lower_levels(mesh: SkinnedMesh, count: int) -> tuple[SkinnedMesh, ...]:
    """Return the lower levels of detail of a mesh whose normals and UVs are given per vertex.

    Parameters
    ----------
    mesh : SkinnedMesh
        The mesh.
    count : int
        Number of lower levels, at most the length of `TRIANGLE_SHARES`.

    Returns
    -------
    tuple of SkinnedMesh
        Levels from finer to coarser; fewer than ``count`` if a level would hardly have fewer triangles than the one
        before, as for a mesh with few triangles.
    """
    triangles = _triangles(mesh)
    if len(triangles) < _LEAST_TRIANGLES:
        return ()
    materials = _face_materials(mesh, len(triangles))
    vertices_cm = np.asarray(mesh.vertices_cm, dtype=np.float64)
    joined = _joined(mesh, vertices_cm, triangles, materials)
    parts = _parts(mesh, vertices_cm, joined, triangles, materials)
    levels = list[SkinnedMesh]()
    before = len(triangles)
    for number, share in enumerate(TRIANGLE_SHARES[:count], start=1):
        into = np.arange(len(vertices_cm))
        for part in parts:
            into = _collapsed(vertices_cm, part.triangles, round(share * len(part.triangles)), part.is_sewn)[into]
        places = into[joined[triangles]]
        whole = (places != np.roll(places, 1, axis=1)).all(axis=1)
        left = int(np.count_nonzero(whole))
        if not 0 < left <= _WORTH_IT * before:
            break
        before = left
        corners = _corners(mesh, joined, into, triangles[whole])
        levels.append(_level(mesh, number, corners, materials[whole]))
    return tuple(levels)


def _triangles(mesh: SkinnedMesh) -> IntArray:
    """Return the triangles (T, 3) of a mesh as vertex indices; larger faces become fans, whose triangles are adjacent
    rows."""
    faces = np.asarray(mesh.faces, dtype=np.int64)
    fan = [faces[:, [0, corner, corner + 1]] for corner in range(1, faces.shape[1] - 1)]
    return np.stack(fan, axis=1).reshape(-1, 3)


def _face_materials(mesh: SkinnedMesh, count: int) -> IntArray:
    if mesh.face_materials is None:
        return np.zeros(count, dtype=np.int64)
    return np.repeat(np.asarray(mesh.face_materials, dtype=np.int64), count // len(mesh.faces))


def _joined(mesh: SkinnedMesh, vertices_cm: AnyFloatArray, triangles: IntArray, materials: IntArray) -> IntArray:
    """Return for each vertex the first one (V,) at the same position that has the same material and moves alike: those
    of a hard edge, which differ in their normals, and those of a seam of UVs that no texture shows.
    """
    textured = np.array([material.textures != NO_TEXTURES for material in mesh.materials])
    material = np.zeros(len(vertices_cm), np.int64)
    material[triangles] = materials[:, None]
    columns = [vertices_cm / _TOUCHING_CM, mesh.joint_indices, mesh.weights / _TOUCHING_WEIGHT, material[:, None]]
    if mesh.uvs is not None:
        columns.append(textured[material][:, None] * mesh.uvs / _TOUCHING_UV)
    if mesh.morphs:
        # One number for all morphs: equal only for vertices that move alike.
        moved_cm = np.zeros((len(vertices_cm), 1))
        for number, morph in enumerate(mesh.morphs, start=1):
            moved_cm[morph.vertex_indices, 0] += morph.position_deltas_cm @ np.sqrt([number, number + 1, number + 2])
        columns.append(moved_cm / _TOUCHING_CM)
    keys = np.concatenate([np.round(np.asarray(one, np.float64)).astype(np.int64) for one in columns], axis=1)
    _, first, group = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return np.asarray(first[group.reshape(-1)])


def _corners(mesh: SkinnedMesh, joined: IntArray, into: IntArray, triangles: IntArray) -> IntArray:
    """Return the vertices (T, 3) of a level's triangles: of those joined where a corner is merged into, the one whose
    normal is most like the triangle's, and then whose UVs are most like the corner's.

    Parameters
    ----------
    joined : ndarray of int, shape (V,)
        First of the vertices that are joined with each.
    into : ndarray of int, shape (V,)
        Vertex that each first one is merged into, itself a first one.
    triangles : ndarray of int, shape (T, 3)
        Triangles of the mesh whose corners are merged into three places.
    """
    old, place = triangles.ravel(), into[joined[triangles]]
    one, two, three = (np.asarray(mesh.vertices_cm, np.float64)[place[:, corner]] for corner in range(3))
    across = np.cross(two - one, three - one)
    across = np.repeat(across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), _SMALLEST), 3, axis=0)
    order = np.argsort(joined, kind="stable")
    starts = np.searchsorted(joined[order], place.ravel())
    counts = np.bincount(joined, minlength=len(joined))[place.ravel()]
    best, most = place.ravel().copy(), np.full(len(old), -np.inf)
    for turn in range(int(counts.max(initial=0))):
        (rows,) = np.nonzero(turn < counts)
        other = order[starts[rows] + turn]
        likeness = np.einsum("vc,vc->v", across[rows], mesh.normals[other])
        if mesh.uvs is not None:
            likeness = likeness - _UVS_COUNT * np.linalg.norm(mesh.uvs[old[rows]] - mesh.uvs[other], axis=1)
        better = likeness > most[rows]
        best[rows[better]], most[rows[better]] = other[better], likeness[better]
    return best.reshape(-1, 3)


@dataclass(frozen=True, eq=False)
class _Part:
    """Triangles of a mesh that share no vertex with the other parts.

    Attributes
    ----------
    triangles : ndarray of int, shape (T, 3)
        Indices of joined vertices.
    is_sewn : bool
        Whether some vertices have the same position as others without being joined, along a seam of a texture. If one
        side of such a seam lost a vertex that the other keeps, there would be a crack.
    """

    triangles: IntArray
    is_sewn: bool


def _parts(
    mesh: SkinnedMesh, vertices_cm: AnyFloatArray, joined: IntArray, triangles: IntArray, materials: IntArray
) -> list[_Part]:
    """Return the triangles of a mesh with their vertices joined, in parts: by material, and by whether their connected
    patch has a seam.

    Triangles of materials that are not opaque are left out: cards of hair are so near to the head that it would come
    through.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    places = np.round(vertices_cm / _TOUCHING_CM).astype(np.int64)
    used = np.unique(joined)
    _, place, joined_there = np.unique(places[used], axis=0, return_inverse=True, return_counts=True)
    together = used[joined_there[place.reshape(-1)] > 1]
    corners = joined[triangles]
    starts, ends = corners[:, [0, 1]].ravel(), corners[:, [1, 2]].ravel()
    count = len(vertices_cm)
    links = coo_array((np.ones(len(starts)), (starts, ends)), shape=(count, count))
    patch_of_vertex = connected_components(links, directed=False)[1]
    patch = patch_of_vertex[corners[:, 0]]
    first = np.unique(patch, return_index=True, return_inverse=True)[1:]
    sewn = np.isin(patch, patch_of_vertex[together])
    key = 2 * materials[first[0]][first[1]] + sewn
    opaque = [material.alpha_mode == "opaque" for material in mesh.materials]
    whole = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    return [_Part(corners[whole & (key == value)], bool(value % 2)) for value in np.unique(key) if opaque[value // 2]]


def _collapsed(vertices_cm: AnyFloatArray, triangles: IntArray, target_count: int, is_sewn: bool) -> IntArray:
    """Reduce a mesh to about ``target_count`` triangles, and return for each old vertex the index (V,) of the remaining
    vertex it is merged into."""
    from fast_simplification import simplify

    with _ONE_AT_A_TIME:
        best, _, collapses = simplify(
            vertices_cm,
            triangles.astype(np.int32),
            target_count=target_count,
            agg=_AGGRESSIVENESS,
            return_collapses=True,
            preserve_border=is_sewn,
        )
    into = np.arange(len(vertices_cm))
    for kept, gone in np.asarray(collapses, dtype=np.int64)[::-1].tolist():
        into[gone] = into[kept]
    return _nearest_members(vertices_cm, into, triangles, np.asarray(best, dtype=np.float64))


def _nearest_members(vertices_cm: AnyFloatArray, into: IntArray, triangles: IntArray, best_cm: FloatArray) -> IntArray:
    corners = into[triangles]
    used = np.unique(corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)])
    if len(used) != len(best_cm):
        return into
    place_cm = vertices_cm.copy()
    place_cm[used] = best_cm
    distance_cm = np.linalg.norm(vertices_cm - place_cm[into], axis=1)
    order = np.lexsort((distance_cm, into))
    groups, first = np.unique(into[order], return_index=True)
    member = np.arange(len(vertices_cm))
    member[groups] = order[first]
    return member[into]


def _level(mesh: SkinnedMesh, number: int, triangles: IntArray, materials: IntArray) -> SkinnedMesh:
    """Return the mesh of some triangles of a mesh, with only the vertices and materials that they use; ``number`` is
    the level.
    """
    vertices = np.unique(triangles)
    row = np.full(len(mesh.vertices_cm), -1)
    row[vertices] = np.arange(len(vertices))
    used = np.unique(materials)
    return replace(
        mesh,
        name=f"{mesh.name}_LOD{number}",
        vertices_cm=mesh.vertices_cm[vertices],
        faces=row[triangles],
        normals=mesh.normals[vertices],
        uvs=None if mesh.uvs is None else mesh.uvs[vertices],
        materials=tuple(mesh.materials[index] for index in used),
        face_materials=np.searchsorted(used, materials),
        joint_indices=mesh.joint_indices[vertices],
        weights=mesh.weights[vertices],
        morphs=_morphs(mesh.morphs, row),
    )


def _morphs(morphs: Sequence[MorphTarget], row: AnyIntArray) -> tuple[MorphTarget, ...]:
    """Return the morphs reduced to the vertices that a level of detail keeps: ``row`` (V,) is each vertex's new row or
    -1. A morph without vertices stays, so that every level has the same morphs."""
    found = []
    for morph in morphs:
        rows = row[morph.vertex_indices]
        kept = rows >= 0
        normals = None if morph.normal_deltas is None else morph.normal_deltas[kept]
        found.append(MorphTarget(morph.name, rows[kept], morph.position_deltas_cm[kept], normals))
    return tuple(found)
