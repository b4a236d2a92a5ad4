"""Vertex arrays of characters and instruments for the graphics card: levels of detail, faces with morphs.

Computed with numpy, once for each character and instrument, outside the window's thread.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray, IntArray, SingleArray
from app.formats.scene import Material
from app.formats.texture_colors import linear, sampled
from app.rig.mesh import Mesh, plain_materials
from app.rig.model import Character, InstrumentModel
from app.rig.supports.model import Supports
from widgets.viewport.normals_across_seams import SplitMesh, numbered, row_keys, split_mesh, turned_morphs
from widgets.viewport.shape_cache import kept
from widgets.viewport.shape_model import BONES_PER_VERTEX, SHAPE, SURFACE, Geometry, MorphTargets, numbers
from widgets.viewport.texture_groups import texture_groups, textured_looks, uv_islands

BODY_CELLS_M = (0.0, 0.0055, 0.02)
"""Distance in metres within which vertices are merged, by level of detail; 0 keeps all."""
INSTRUMENT_CELLS_M = (0.0, 0.0035, 0.011)
PLAIN_FACTOR, PLAIN_LEAST_M = 1.4, 0.08
"""Factor by which cloth and hair are coarser than skin, and the thickness in metres below which a mesh (eyes) is
not.
"""
THIN_SHARES = (0.0, 0.1, 0.34)
"""Coarsest cell for thin meshes (brows, eyes) by level, relative to their smallest side."""
LEAST_CELL_M = 1e-5
"""Finest cell in metres for flat meshes."""
LEVELS = len(BODY_CELLS_M)
_MOST_SHORT = 2**16 - 1
"""Greatest number of vertices with 16-bit indices."""


@dataclass(frozen=True, eq=False)
class Crowd:
    """Geometries of many players concatenated for a single draw call.

    Attributes
    ----------
    parts : tuple of (int, Geometry)
        Row of the player and geometry of each part, in order.
    shape : (V,) SHAPE
        Vertices of all players.
    surface : (V,) SURFACE
        Surfaces of the vertices.
    rows : (V,) float32
        Row of the player to which each vertex belongs.
    triangles : (T, 3) uint32
        Vertex indices; one-sided triangles first.
    one_sided : int
        Number of one-sided triangles.
    """

    parts: tuple[tuple[int, Geometry], ...]
    shape: npt.NDArray[np.void]
    surface: npt.NDArray[np.void]
    rows: SingleArray
    triangles: npt.NDArray[np.uint32]
    one_sided: int


@lru_cache(maxsize=16)
def character_levels(character: Character) -> tuple[Geometry, ...]:
    """Return all levels of detail of a character, finest first; the coarsest has no morphs."""
    return _levels(character.meshes, BODY_CELLS_M, PLAIN_FACTOR)


@lru_cache(maxsize=128)
def instrument_levels(model: InstrumentModel, first_bone: int) -> tuple[Geometry, ...]:
    """Return all levels of detail of an instrument, whose node n moves with bone ``first_bone + n``.

    The cache is larger than the number of instruments: otherwise all would be made again for every added player, which
    takes seconds.
    """
    return tuple(_moving_with(level, first_bone) for level in _levels(model.meshes, INSTRUMENT_CELLS_M, 1.0))


@lru_cache(maxsize=128)
def supports_geometry(supports: Supports, first_bone: int) -> Geometry:
    """Return straps and chair as a geometry with one level of detail; their bone n is bone ``first_bone + n``."""
    whole = _Whole([split_mesh(mesh) for mesh in supports.meshes], 1.0)
    return _moving_with(whole.level(0.0, 0.0, far=True), first_bone)


def _moving_with(geometry: Geometry, first_bone: int) -> Geometry:
    """Return a geometry with its bone indices increased by ``first_bone``, for the shared table of all bones."""
    surfaces = geometry.surfaces.copy()
    surfaces["a_bones"] += first_bone * (surfaces["a_weights"] > 0.0)
    return replace(geometry, surfaces=surfaces)


def stand(bone: int) -> Geometry:
    """Return the stand for an instrument: a rod on a foot, of height 1, with its top at the origin; moves with one
    bone.
    """
    metal = (0.16, 0.165, 0.175)
    profiles = (
        [(0.0, 0.0), (0.011, -0.004), (0.011, -0.05), (0.008, -0.055), (0.008, -0.985)],
        [(0.0, -0.982), (0.10, -0.988), (0.125, -0.994), (0.125, -1.0)],
    )
    return joined([_turned(np.array(points), metal, 0.45, 1.0, bone) for points in profiles])


def joined(parts: Sequence[Geometry]) -> Geometry:
    """Return several geometries joined, without their morphs."""
    whole = crowd([(0, part) for part in parts])
    return Geometry(whole.shape, whole.surface, whole.triangles, whole.one_sided)


def crowd(parts: Sequence[tuple[int, Geometry]]) -> Crowd:
    """Return players and their geometries joined.

    Copied part by part, since fifty players take sixty megabytes, and numpy blocks other threads while copying.
    """
    count = sum(len(part.shape) for _, part in parts)
    shape, surface, rows = np.empty(count, SHAPE), np.empty(count, SURFACE), np.empty(count, np.float32)
    triangles = np.empty((sum(len(part.triangles) for _, part in parts), 3), np.uint32)
    one_sided = sum(part.one_sided for _, part in parts)
    start, first, second = 0, 0, one_sided
    for row, part in parts:
        here = slice(start, start + len(part.shape))
        # Copying plain numbers is ten times as fast as copying records.
        numbers(shape)[here] = numbers(part.shape)
        numbers(surface)[here] = numbers(part.surface)
        rows[here] = row
        for place, own in ((first, part.triangles[: part.one_sided]), (second, part.triangles[part.one_sided :])):
            np.add(own, np.uint32(start), dtype=np.uint32, out=triangles[place : place + len(own)])
        start, first = here.stop, first + part.one_sided
        second += len(part.triangles) - part.one_sided
    return Crowd(tuple(parts), shape, surface, rows, triangles, one_sided)


def crowd_edges(parts: Sequence[tuple[int, Geometry]]) -> npt.NDArray[np.uint32]:
    """Return the E edges (E, 2) of all parts of a crowd as vertex indices, each once; edges of repeated geometries are
    computed once."""
    known = {id(part): edges(part) for part in {id(part): part for _, part in parts}.values()}
    starts = np.cumsum([0, *(len(part.shape) for _, part in parts)])
    return np.concatenate([known[id(part)] + np.uint32(start) for (_, part), start in zip(parts, starts, strict=False)])


def edges(geometry: Geometry) -> npt.NDArray[np.uint32]:
    """Return the E edges (E, 2) between two vertices, each once."""
    triangles = geometry.triangles.astype(np.int64)
    pairs = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    count = len(geometry.shape)
    keys = np.unique(pairs[:, 0] * count + pairs[:, 1])
    return np.stack([keys // count, keys % count], axis=1).astype(np.uint32)


def _turned(
    profile: FloatArray, color: tuple[float, float, float], roughness: float, metallic: float, bone: int
) -> Geometry:
    """Return a surface of revolution about Y through points (radius, height), with an edge at every point."""
    steps = 28
    angles = np.linspace(0.0, 2.0 * np.pi, steps + 1)
    around = np.stack([np.cos(angles), np.zeros(steps + 1), np.sin(angles)], axis=1)
    shapes: list[npt.NDArray[np.void]] = []
    triangles: list[IntArray] = []
    for (r0, y0), (r1, y1) in pairwise(profile):
        slope = np.array([y0 - y1, r1 - r0])
        slope /= max(float(np.linalg.norm(slope)), 1e-9)
        normals = around * slope[0] + np.array([0.0, slope[1], 0.0])
        ring0, ring1 = around * r0 + [0.0, y0, 0.0], around * r1 + [0.0, y1, 0.0]
        first = 2 * (steps + 1) * len(shapes)
        shape = np.zeros(2 * (steps + 1), SHAPE)
        shape["a_position"] = np.concatenate([ring0, ring1])
        shape["a_normal"] = np.concatenate([normals, normals])
        shapes.append(shape)
        a = first + np.arange(steps)
        b = a + steps + 1
        triangles += [np.stack([a, a + 1, b], axis=1), np.stack([a + 1, b + 1, b], axis=1)]
    shape = np.concatenate(shapes)
    surface = np.zeros(len(shape), SURFACE)
    surface["a_bones"][:, 0] = bone
    surface["a_weights"][:, 0] = 1.0
    surface["a_color"] = (*color, roughness)
    surface["a_metallic"] = metallic
    whole = np.concatenate(triangles).astype(np.uint32)
    return Geometry(shape, surface, whole, len(whole))


def _levels(meshes: Sequence[Mesh], cells_m: Sequence[float], plain_factor: float) -> tuple[Geometry, ...]:
    def make() -> tuple[Geometry, ...]:
        whole = _Whole([split_mesh(mesh) for mesh in meshes], plain_factor)
        return tuple(
            whole.level(cell_m, share, far=index == len(cells_m) - 1)
            for index, (cell_m, share) in enumerate(zip(cells_m, THIN_SHARES, strict=True))
        )

    looks = textured_looks(meshes)
    return tuple(replace(level, looks=looks) for level in kept(meshes, (tuple(cells_m), plain_factor), make))


class _Whole:
    """All meshes of a character or instrument concatenated, from which levels of detail are made."""

    def __init__(self, splits: Sequence[SplitMesh], plain_factor: float) -> None:
        counts = [len(split.vertices) for split in splits]
        self._starts = np.cumsum([0, *counts])
        self._splits = splits
        self._bends = any(split.mesh.joints.shape[1] > 1 for split in splits)
        self._triangles = np.concatenate(
            [split.triangles + start for split, start in zip(splits, self._starts, strict=False)]
        )
        total = int(self._starts[-1])
        self._shape = np.zeros(total, SHAPE)
        self._surface = np.zeros(total, SURFACE)
        self._part = np.repeat(np.arange(len(splits)), counts)
        self._thickness = np.repeat([_thickness_m(split.mesh) for split in splits], counts)
        self._two_sided = np.zeros(total, dtype=bool)
        self._uvs, self._look = np.zeros((total, 2), np.float32), np.full(total, -1, np.int32)
        self._shades = np.ones((total, 3), np.float32)
        """Colour of a texture at a vertex, beside its mean."""
        looks = textured_looks([split.mesh for split in splits])
        self._coarser = np.repeat([plain_factor if _is_plain(split.mesh) else 1.0 for split in splits], counts)
        for split, start in zip(splits, self._starts, strict=False):
            own = slice(int(start), int(start) + len(split.vertices))
            mesh = split.mesh
            self._shape["a_position"][own] = mesh.positions_m[split.vertices]
            self._shape["a_normal"][own] = mesh.normals[split.vertices]
            bones, weights = _strongest(mesh.joints[split.vertices], mesh.weights[split.vertices])
            self._surface["a_bones"][own, : bones.shape[1]] = bones
            self._surface["a_weights"][own, : bones.shape[1]] = weights
            plain = plain_materials(mesh)
            colors = np.array([(*material.base_color[:3], material.roughness) for material in plain], np.float32)
            metallic = np.array([material.metallic for material in plain], np.float32)
            self._surface["a_color"][own] = colors[split.materials]
            self._surface["a_metallic"][own] = metallic[split.materials]
            self._texture(own, split, looks, plain)
            two_sided = np.array([material.double_sided for material in mesh.materials])
            self._two_sided[own] = two_sided[split.materials]
        colors = np.ascontiguousarray(self._surface["a_color"]).view(np.int32)
        islands = uv_islands(self._triangles, self._look >= 0)
        self._looks = numbered(row_keys(self._part, islands, *colors.T))[1]
        """The same number for vertices of one mesh and colour and, where they have textures, of one part of these."""
        self._surface["a_color"][:, :3] *= self._shades
        self._morphs = self._all_morphs()

    def _texture(self, own: slice, split: SplitMesh, looks: tuple[Material, ...], plains: tuple[Material, ...]) -> None:
        """Store texture coordinates, textured materials and colours of a mesh's vertices, which are in the range
        ``own``.
        """
        mesh, uvs = split.mesh, split.mesh.uvs[split.vertices]
        self._uvs[own] = uvs
        for number, (material, plain) in enumerate(zip(mesh.materials, plains, strict=True)):
            if material not in looks:
                continue
            here = np.flatnonzero(split.materials == number)
            self._look[own][here] = looks.index(material)
            found = None
            if material.textures.color is not None and material.alpha_mode == "opaque":
                found = sampled(material.textures.color, uvs[here])
            if found is not None:
                shade = linear(found[:, :3]) * material.base_color[:3] / np.maximum(plain.base_color[:3], 1e-4)
                self._shades[own][here] = shade

    def level(self, cell_m: float, thin_share: float, far: bool) -> Geometry:
        """Return one level of detail; the ``far`` one has no morphs, and mean colours instead of textures."""
        kept, triangles = self._clustered(cell_m, thin_share)
        names = () if far else tuple(self._morphs)
        moved = np.zeros(len(self._shape), dtype=bool)
        for name in names:
            moved[self._morphs[name][0]] = True
        # Vertices that morph come first, so that only they are uploaded again.
        order = kept[np.argsort(~moved[kept], kind="stable")]
        place = np.full(len(self._shape), -1, np.int64)
        place[order] = np.arange(len(order))
        count = int(moved[kept].sum())
        shape = self._shape.take(order)
        face = self._face(names, shape, place, count) if count else None
        # Vertices of different materials are never merged, so the first corner decides for the triangle.
        last = self._two_sided[triangles[:, 0]]
        look = self._look[triangles[:, 0]]
        textured = not far and bool((look >= 0).any())
        if textured:
            ranked = np.lexsort((look, last))
            sorted_triangles = triangles[ranked]
        else:
            sorted_triangles = np.concatenate([triangles[~last], triangles[last]])
        surfaces, surface_of = self._surfaces(order)
        numbered = place[sorted_triangles]
        corners = numbered.astype(np.uint16) if len(order) <= _MOST_SHORT else numbered.astype(np.uint32)
        if not textured:
            return Geometry(shape, surfaces, corners, int((~last).sum()), face, surface_of)
        groups = texture_groups(look[ranked], last[ranked])
        return Geometry(shape, surfaces, corners, int((~last).sum()), face, surface_of, self._uvs[order], groups)

    def _surfaces(self, order: IntArray) -> tuple[npt.NDArray[np.void], npt.NDArray[np.uint16] | None]:
        """Return the surfaces of the vertices in ``order`` for `Geometry.surfaces` and `Geometry.surface_of`: each
        distinct surface once with the index for every vertex, or one surface for each vertex and None.
        """
        if self._bends:
            return self._surface.take(order), None
        rows = numbers(self._surface).take(order, axis=0)
        keys = row_keys(*np.ascontiguousarray(rows.T[np.ptp(rows, axis=0) > 0.0]).view(np.int32), size=len(order))
        first, surface_of = numbered(keys)
        if len(first) > np.iinfo(np.uint16).max:
            return self._surface.take(order), None
        return self._surface.take(order[first]), surface_of.astype(np.uint16)

    def _face(self, names: tuple[str, ...], shape: npt.NDArray[np.void], place: IntArray, count: int) -> MorphTargets:
        targets = []
        for name in names:
            vertices, moves, turns = self._morphs[name]
            own = place[vertices]
            here = own >= 0
            targets.append((own[here].astype(np.int32), np.concatenate([moves[here], turns[here]], axis=1)))
        rest = np.ascontiguousarray(shape[:count]).view(np.float32).reshape(count, -1).copy()
        return MorphTargets(count, names, tuple(targets), rest)

    def _clustered(self, cell_m: float, thin_share: float) -> tuple[IntArray, IntArray]:
        """Return the kept vertices (K,) and the triangles between them (T, 3) of a coarser mesh: the first vertex in
        each cell and surface is kept. ``cell_m`` 0 keeps all."""
        if cell_m <= 0.0:
            return np.arange(len(self._shape)), self._triangles
        wide = np.maximum(np.minimum(cell_m * self._coarser, thin_share * self._thickness), LEAST_CELL_M)[:, None]
        cells = np.floor(self._shape["a_position"].astype(np.float64) / wide).astype(np.int64)
        # Surfaces that face in different directions are not merged through a thin wall.
        facing = np.argmax(np.abs(self._shape["a_normal"]), axis=1)
        sign = np.take_along_axis(self._shape["a_normal"], facing[:, None], axis=1)[:, 0] > 0.0
        keys = row_keys(*cells.T, facing * 2 + sign, self._looks)
        first, cluster = numbered(keys)
        triangles = first[cluster][self._triangles]
        a, b, c = triangles.T
        triangles = triangles[(a != b) & (b != c) & (c != a)]
        triangles = triangles[numbered(row_keys(*np.sort(triangles, axis=1).T))[0]]
        used = np.zeros(len(self._shape), np.bool_)
        used[triangles] = True
        return np.flatnonzero(used), triangles

    def _all_morphs(self) -> dict[str, tuple[IntArray, SingleArray, SingleArray]]:
        """Return every morph over all meshes by name: vertex indices, displacements, and changes of the normals."""
        found: dict[str, list[tuple[IntArray, SingleArray, SingleArray]]] = {}
        for split, start in zip(self._splits, self._starts, strict=False):
            if not split.mesh.morphs:
                continue
            for morph, turned in zip(split.mesh.morphs, turned_morphs(split), strict=True):
                parts = found.setdefault(morph.name, [])
                if len(morph.vertices):
                    parts.append((turned.vertices + start, turned.moves_m, turned.turns))
        return {
            name: (
                np.concatenate([part[0] for part in parts]),
                np.concatenate([part[1] for part in parts]),
                np.concatenate([part[2] for part in parts]),
            )
            for name, parts in found.items()
            if parts
        }


def _is_plain(mesh: Mesh) -> bool:
    """Return whether a mesh is large and has no morphs, so that it can be simplified more."""
    return not mesh.morphs and _thickness_m(mesh) > PLAIN_LEAST_M


def _thickness_m(mesh: Mesh) -> float:
    """Return the smallest side of the box around a mesh, in metres."""
    return float((mesh.positions_m.max(axis=0) - mesh.positions_m.min(axis=0)).min())


def _strongest(joints: npt.NDArray[np.int32], weights: SingleArray) -> tuple[npt.NDArray[np.int32], SingleArray]:
    """Return the `BONES_PER_VERTEX` strongest joints of every vertex (V, K) with their weights, which sum to 1."""
    if joints.shape[1] > BONES_PER_VERTEX:
        order = np.argsort(-weights, axis=1, kind="stable")[:, :BONES_PER_VERTEX]
        joints, weights = np.take_along_axis(joints, order, 1), np.take_along_axis(weights, order, 1)
    total = weights.sum(axis=1, keepdims=True)
    return joints, (weights / np.where(total > 0.0, total, 1.0)).astype(np.float32)
