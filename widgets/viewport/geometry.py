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
from app.rig.mesh import Mesh
from app.rig.model import Character, InstrumentModel
from app.rig.supports.model import Supports
from widgets.viewport.shape_cache import kept
from widgets.viewport.shape_model import SHAPE, SURFACE, Geometry, LevelsOfDetail, numbers
from widgets.viewport.texture_groups import textured_looks
from widgets.viewport.whole_figure import WholeFigure

BODY_CELLS_M = (0.0, 0.0055, 0.02)
"""Distance in metres within which vertices are merged, by level of detail; 0 keeps all."""
INSTRUMENT_CELLS_M = (0.0, 0.0035, 0.011)
PLAIN_FACTOR = 1.4
"""Factor by which cloth and hair are coarser than skin."""
THIN_SHARES = (0.0, 0.1, 0.34)
"""Coarsest cell for thin meshes (brows, eyes) by level, relative to their smallest side."""
LEVELS = len(BODY_CELLS_M)


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
def character_levels(character: Character) -> LevelsOfDetail:
    """Return all levels of detail of a character, finest first; the coarsest has no morphs."""
    skeleton = character.skeleton
    # A collar lies close to the neck.
    head = [skeleton.index("neck" if "neck" in skeleton.names else "head")]
    for bone, parent in enumerate(skeleton.parents):
        if parent in head:
            head.append(bone)
    return _levels(character.meshes, BODY_CELLS_M, PLAIN_FACTOR, tuple(head))


@lru_cache(maxsize=128)
def instrument_levels(model: InstrumentModel, first_bone: int) -> LevelsOfDetail:
    """Return all levels of detail of an instrument, whose node n moves with bone ``first_bone + n``.

    The cache is larger than the number of instruments: otherwise all would be made again for every added player, which
    takes seconds.
    """
    levels = _levels(model.meshes, INSTRUMENT_CELLS_M, 1.0)

    def finer() -> tuple[Geometry, ...]:
        return tuple(_moving_with(levels[level], first_bone) for level in range(LEVELS - 1))

    return LevelsOfDetail(_moving_with(levels.coarsest, first_bone), LEVELS, finer)


@lru_cache(maxsize=128)
def supports_geometry(supports: Supports, first_bone: int) -> Geometry:
    """Return straps and chair as a geometry with one level of detail; their bone n is bone ``first_bone + n``."""
    whole = WholeFigure(supports.meshes, 1.0)
    return _moving_with(whole.level(0.0, 0.0, far=True), first_bone)


def _moving_with(geometry: Geometry, first_bone: int) -> Geometry:
    """Return a geometry with its bone indices increased by ``first_bone``, for the shared table of all bones."""
    surfaces = geometry.surfaces.copy()
    for bones, weights in (("a_bones", "a_weights"), ("a_more_bones", "a_more_weights")):
        surfaces[bones] += first_bone * (surfaces[weights] > 0.0)
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


def _levels(
    meshes: Sequence[Mesh], cells_m: Sequence[float], plain_factor: float, head_bones: tuple[int, ...] = ()
) -> LevelsOfDetail:
    def made(numbers: Sequence[int]) -> tuple[Geometry, ...]:
        whole = WholeFigure(meshes, plain_factor, head_bones)
        return tuple(whole.level(cells_m[number], THIN_SHARES[number], number == LEVELS - 1) for number in numbers)

    def finer() -> tuple[Geometry, ...]:
        found = kept(meshes, (tuple(cells_m), plain_factor), lambda: made(range(LEVELS - 1)))
        return tuple(replace(level, looks=looks) for level in found)

    looks = textured_looks(meshes)
    # Morphs do not matter to the coarsest level, only that there are any.
    plain = [replace(mesh, morphs=()) for mesh in meshes]
    made_with = ("coarsest", *cells_m, plain_factor, head_bones, *(bool(mesh.morphs) for mesh in meshes))
    (coarsest,) = kept(plain, made_with, lambda: made([LEVELS - 1]))
    return LevelsOfDetail(replace(coarsest, looks=looks), LEVELS, finer)
