"""A figure with all its meshes, from which the levels of detail of characters and instruments are made.

What depends only on arrays that all people made from one body share is computed once for them.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from app.arrays import AnyFloatArray, BoolArray, FloatArray, IntArray, SingleArray
from app.formats.scene import Material
from app.identity_cache import IdentityCache
from app.rig.mesh import Mesh, plain_materials
from widgets.viewport.normals_across_seams import SplitMesh, numbered, row_keys, split_mesh, turned_morphs
from widgets.viewport.shape_model import BONES_PER_VERTEX, FIRST_BONES, SHAPE, SURFACE, Geometry, MorphTargets, numbers
from widgets.viewport.texture_at_vertices import mostly_filled, pictured, placed
from widgets.viewport.texture_groups import texture_groups, textured_looks, uv_islands

PLAIN_LEAST_M = 0.08
"""Thickness in metres below which a mesh without morphs (eyes) is not simplified more than skin."""
LEAST_CELL_M = 1e-5
"""Finest cell in metres for flat meshes."""
FAR_HEAD_SHARE = 0.4
"""Size of the cells of heads relative to that of others at the coarsest level: a face is known by its small parts."""
_MOST_SHORT = 2**16 - 1
"""Greatest number of vertices with 16-bit indices."""


class WholeFigure:
    """All meshes of a character or instrument concatenated.

    Parameters
    ----------
    meshes : sequence of Mesh
        The meshes.
    plain_factor : float
        Factor by which cloth and hair are coarser than skin.
    head_bones : collection of int, optional
        Bones of the head, which is less coarse than the rest.
    """

    def __init__(self, meshes: Sequence[Mesh], plain_factor: float, head_bones: Collection[int] = ()) -> None:
        splits = [split_mesh(mesh) for mesh in meshes]
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
        # Skin that an outfit shows is part of the body's, without a gap where they meet.
        wholes = _wholes(meshes)
        thick_m = [_thickness_m(meshes[whole]) for whole in wholes]
        self._thickness = np.repeat(thick_m, counts)
        self._two_sided = np.zeros(total, dtype=bool)
        self._look = np.full(total, -1, np.int32)
        self._shades = np.ones((total, 3), np.float32)
        """Colour of a texture at a vertex, beside its mean."""
        self._colored = np.zeros(total, np.intp)
        """The same number for vertices of one mesh and colour. Sheets of hair have one, to be joined along their edges
        at the coarsest level: the scalp would show."""
        looks = textured_looks(meshes)
        plain = [
            not meshes[whole].morphs and own_m > PLAIN_LEAST_M for whole, own_m in zip(wholes, thick_m, strict=True)
        ]
        self._coarser = np.repeat(np.where(plain, plain_factor, 1.0), counts)
        known: dict[tuple[int, bytes], int] = {}
        for part, (split, start) in enumerate(zip(splits, self._starts, strict=False)):
            own = slice(int(start), int(start) + len(split.vertices))
            mesh = split.mesh
            self._shape["a_position"][own] = mesh.positions_m.take(split.vertices, axis=0)
            self._shape["a_normal"][own] = mesh.normals.take(split.vertices, axis=0)
            bones, weights = _strongest(split)
            for name, more, values in (("a_bones", "a_more_bones", bones), ("a_weights", "a_more_weights", weights)):
                first, others = values[:, :FIRST_BONES], values[:, FIRST_BONES:]
                self._surface[name][own, : first.shape[1]] = first
                self._surface[more][own, : others.shape[1]] = others
            plains = plain_materials(mesh)
            colors = np.array([(*material.base_color[:3], material.roughness) for material in plains], np.float32)
            metallic = np.array([material.metallic for material in plains], np.float32)
            self._surface["a_color"][own] = colors[split.materials]
            numbers_of = [known.setdefault((part, color.tobytes()), len(known)) for color in colors]
            self._colored[own] = np.array(numbers_of)[split.materials]
            self._surface["a_metallic"][own] = metallic[split.materials]
            self._texture(own, split, looks, plains)
            two_sided = np.array([material.double_sided for material in mesh.materials])
            self._two_sided[own] = two_sided[split.materials]
        self._far_colored = self._colored.copy()
        """The same, with one number for skin of the body and of an outfit."""
        for part, whole in enumerate(wholes):
            if whole != part:
                number = _number_of(meshes[part].materials[0], meshes[whole])
                first = self._starts[whole] + int((splits[whole].materials == number).argmax())
                self._far_colored[self._starts[part] : self._starts[part + 1]] = self._colored[first]
        self._surface["a_color"][:, :3] *= self._shades
        self._head_bones = np.array(sorted(head_bones), np.float32)

    def _texture(self, own: slice, split: SplitMesh, looks: tuple[Material, ...], plains: tuple[Material, ...]) -> None:
        """Store textured materials and colours of a mesh's vertices, which are in the range ``own``."""
        mesh, places = split.mesh, placed(split)
        for number, (material, plain) in enumerate(zip(mesh.materials, plains, strict=True)):
            if material not in looks:
                continue
            here = np.flatnonzero(split.materials == number)
            self._look[own][here] = looks.index(material)
            found = None
            if material.textures.color is not None and material.alpha_mode != "blend":
                found = pictured(material.textures.color, places, number, material.alpha_mode == "mask")
            if found is not None:
                filled, colors = found
                self._shades[own][here[filled]] = (
                    colors * material.base_color[:3] / np.maximum(plain.base_color[:3], 1e-4)
                )

    def level(self, cell_m: float, thin_share: float, far: bool) -> Geometry:
        """Return one level of detail; the ``far`` one has no morphs, and mean colours instead of textures."""
        clusters = self._clusters(cell_m, thin_share, far)
        kept, triangles = self._joined(clusters, far)
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
        surface = self._surface
        if far and clusters is not None:
            shape["a_normal"], surface = self._means(clusters, order)
        surfaces, surface_of = self._surfaces(surface, order)
        numbered = place[sorted_triangles]
        corners = numbered.astype(np.uint16) if len(order) <= _MOST_SHORT else numbered.astype(np.uint32)
        if not textured:
            return Geometry(shape, surfaces, corners, int((~last).sum()), face, surface_of)
        groups = texture_groups(look[ranked], last[ranked])
        return Geometry(shape, surfaces, corners, int((~last).sum()), face, surface_of, self._uvs[order], groups)

    def _surfaces(
        self, surface: npt.NDArray[np.void], order: IntArray
    ) -> tuple[npt.NDArray[np.void], npt.NDArray[np.uint16] | None]:
        """Return the surfaces of the vertices in ``order``, out of those of all, for `Geometry.surfaces` and
        `Geometry.surface_of`: each distinct surface once with the index for every vertex, or one surface for each
        vertex and None.
        """
        if self._bends:
            return surface.take(order), None
        rows = numbers(surface).take(order, axis=0)
        keys = row_keys(*np.ascontiguousarray(rows.T[np.ptp(rows, axis=0) > 0.0]).view(np.int32), size=len(order))
        first, surface_of = numbered(keys)
        if len(first) > np.iinfo(np.uint16).max:
            return surface.take(order), None
        return surface.take(order[first]), surface_of.astype(np.uint16)

    def _face(self, names: tuple[str, ...], shape: npt.NDArray[np.void], place: IntArray, count: int) -> MorphTargets:
        targets = []
        for name in names:
            vertices, moves, turns = self._morphs[name]
            own = place[vertices]
            here = own >= 0
            targets.append((own[here].astype(np.int32), np.concatenate([moves[here], turns[here]], axis=1)))
        rest = np.ascontiguousarray(shape[:count]).view(np.float32).reshape(count, -1).copy()
        return MorphTargets(count, names, tuple(targets), rest)

    def _clusters(self, cell_m: float, thin_share: float, far: bool) -> tuple[IntArray, IntArray] | None:
        """Return the vertices (C,) that stand for the clusters of those in one cell and surface, and the cluster (V,)
        of each vertex; None if ``cell_m`` is 0, which keeps all.
        """
        if cell_m <= 0.0:
            return None
        places_m = self._shape["a_position"].astype(np.float64)
        wide = np.minimum(cell_m * self._coarser, thin_share * self._thickness)
        head = self._is_head() if far else np.zeros(len(wide), np.bool_)
        wide = np.maximum(np.where(head, FAR_HEAD_SHARE, 1.0) * wide, LEAST_CELL_M)[:, None]
        cells = np.floor(places_m / wide).astype(np.int64)
        # Surfaces that face in different directions are not merged through a thin wall.
        facing, sign = _facing(self._shape["a_normal"])
        looks = self._far_colored if far else self._looks
        first, cluster = numbered(row_keys(*cells.T, (facing * 2 + sign) * 2 + head, looks))
        if far:
            # Triangles between the middles of cells are more regular.
            middles_m = _mean(places_m, cluster, np.ones(len(cluster)))
            off_m = np.linalg.norm(places_m - middles_m.take(cluster, axis=0), axis=1)
            least_m = np.full(len(first), np.inf)
            np.minimum.at(least_m, cluster, off_m)
            nearest = np.flatnonzero(off_m == least_m.take(cluster))[::-1]
            # Of equally near ones the last one stored stays, which is the first.
            first[cluster[nearest]] = nearest
        return first, cluster

    def _joined(self, clusters: tuple[IntArray, IntArray] | None, far: bool) -> tuple[IntArray, IntArray]:
        """Return the kept vertices (K,) and the triangles between them (T, 3) of a mesh of clusters."""
        if clusters is None:
            return np.arange(len(self._shape)), self._triangles
        first, cluster = clusters
        triangles = first[cluster].take(self._triangles[self._filled] if far else self._triangles)
        a, b, c = triangles.T
        triangles = triangles[(a != b) & (b != c) & (c != a)]
        a, b, c = triangles.T
        low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
        triangles = triangles[numbered(row_keys(low, a + b + c - low - high, high))[0]]
        used = np.zeros(len(self._shape), np.bool_)
        used[triangles] = True
        return np.flatnonzero(used), triangles

    def _means(self, clusters: tuple[IntArray, IntArray], order: IntArray) -> tuple[SingleArray, npt.NDArray[np.void]]:
        """Return the normals (K, 3) of the vertices in ``order``, and the surfaces of all in which these have other
        colours: both are means over the clusters, weighted by area.
        """
        cluster = clusters[1]
        triangles = self._triangles[self._filled]
        a, b, c = self._shape["a_position"].T.take(triangles.T, axis=1).transpose(1, 0, 2)
        (ax, ay, az), (bx, by, bz) = b - a, c - a
        x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        area = np.sqrt(x * x + y * y + z * z).astype(np.float64)
        shares = np.full(len(self._shape), 1e-12)
        shares += np.bincount(triangles.ravel(), np.repeat(area, 3), len(shares))
        own = cluster[order]
        normals = _mean(self._shape["a_normal"], cluster, shares)[own]
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
        surface = self._surface.copy()
        surface["a_color"][order, :3] = _mean(self._surface["a_color"][:, :3], cluster, shares)[own]
        return normals.astype(np.float32), surface

    def _is_head(self) -> BoolArray:
        """Return an array (V,), True for vertices that belong mostly to the head."""
        if not len(self._head_bones):
            return np.zeros(len(self._surface), np.bool_)
        of_head = np.isin(self._surface["a_bones"], self._head_bones)
        mostly: BoolArray = (self._surface["a_weights"] * of_head).sum(axis=1) > 0.5
        return mostly

    @cached_property
    def _uvs(self) -> SingleArray:
        """Texture coordinates (V, 2) of the vertices."""
        return np.concatenate([placed(split).uvs for split in self._splits]).astype(np.float32, copy=False)

    @cached_property
    def _looks(self) -> IntArray:
        """The same number (V,) for vertices of one mesh and colour and, where they have textures, of one part of
        these.
        """
        return numbered(row_keys(self._colored, np.concatenate([_islands(split) for split in self._splits])))[1]

    @cached_property
    def _filled(self) -> BoolArray:
        """Array (T,), False for triangles that are mostly cut out, such as single hairs: without their textures, they
        would be drawn whole.
        """
        found = [np.ones(len(split.triangles), np.bool_) for split in self._splits]
        for filled, split in zip(found, self._splits, strict=True):
            for number, material in enumerate(split.mesh.materials):
                if material.textures.color is None or material.alpha_mode != "mask":
                    continue
                pictured = mostly_filled(material.textures.color, placed(split), number)
                if pictured is not None:
                    filled[split.materials[split.triangles[:, 0]] == number] = pictured
        return np.concatenate(found)

    @cached_property
    def _morphs(self) -> dict[str, tuple[IntArray, SingleArray, SingleArray]]:
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


def _wholes(meshes: Sequence[Mesh]) -> list[int]:
    """Return for each mesh the first one with a face that it continues, or itself."""
    return [
        next((whole for whole in range(part) if _continues(mesh, meshes[whole])), part)
        for part, mesh in enumerate(meshes)
    ]


def _continues(mesh: Mesh, whole: Mesh) -> bool:
    """Return True if a mesh has the material of another one, which morphs, and vertices at places of its vertices."""
    if not (mesh.is_skinned and whole.morphs and len(mesh.materials) == 1):
        return False
    if _number_of(mesh.materials[0], whole) is None:
        return False
    places_m = np.concatenate([mesh.positions_m, whole.positions_m])
    keys = row_keys(*np.ascontiguousarray(places_m.T, np.float32).view(np.int32), size=len(places_m))
    return bool(np.isin(keys[: len(mesh.positions_m)], keys[len(mesh.positions_m) :]).any())


def _number_of(material: Material, mesh: Mesh) -> int | None:
    """Return the index of the same material in a mesh; None if it has another."""
    return next((number for number, own in enumerate(mesh.materials) if own is material), None)


def _facing(normals: SingleArray) -> tuple[IntArray, BoolArray]:
    """Return the axis (V,) nearest to each of V normals (V, 3), and True where the normal points along it, not against
    it.
    """
    x, y, z = normals.T
    ahead, up, aside = np.abs(z), np.abs(y), np.abs(x)
    of_two = (up > aside).astype(np.intp)
    along_z = ahead > np.maximum(up, aside)
    return np.where(along_z, 2, of_two), np.where(along_z, z, np.where(of_two, y, x)) > 0.0


def _mean(values: AnyFloatArray, cluster: IntArray, shares: FloatArray) -> FloatArray:
    """Return the means (C, 3) of values (V, 3) over clusters, weighted by shares (V,)."""
    total = np.bincount(cluster, shares)
    return np.stack([np.bincount(cluster, shares * column) / total for column in values.T], axis=1)


def _thickness_m(mesh: Mesh) -> float:
    """Return the smallest side of the box around a mesh, in metres."""
    sides_m = np.ascontiguousarray(mesh.positions_m.T)
    return float((sides_m.max(axis=1) - sides_m.min(axis=1)).min())


def _strongest(split: SplitMesh) -> tuple[npt.NDArray[np.int32], SingleArray]:
    mesh = split.mesh
    if not mesh.is_skinned:
        return _strongest_of(split.vertices, mesh.joints, mesh.weights)
    return _STRONGEST.step(_strongest_of, split.vertices, mesh.joints, mesh.weights)


def _strongest_of(
    vertices: IntArray, joints: npt.NDArray[np.int32], weights: SingleArray
) -> tuple[npt.NDArray[np.int32], SingleArray]:
    """Return the `BONES_PER_VERTEX` strongest joints of each of some vertices (V, K) with their weights, which sum to
    1.
    """
    joints, weights = joints.take(vertices, axis=0), weights.take(vertices, axis=0)
    if joints.shape[1] > BONES_PER_VERTEX:
        order = np.argsort(-weights, axis=1, kind="stable")[:, :BONES_PER_VERTEX]
        joints, weights = np.take_along_axis(joints, order, 1), np.take_along_axis(weights, order, 1)
    total = weights.sum(axis=1, keepdims=True)
    return joints, (weights / np.where(total > 0.0, total, 1.0)).astype(np.float32)


_STRONGEST: IdentityCache[tuple[npt.NDArray[np.int32], SingleArray]] = IdentityCache(128)


def _islands(split: SplitMesh) -> IntArray:
    textured = np.array([bool(material.textures.uses) for material in split.mesh.materials])[split.materials]
    if not split.mesh.is_skinned or not textured.any():
        return uv_islands(split.triangles, textured)
    return _ISLANDS.step(uv_islands, split.triangles, _same(textured.tobytes()))


@lru_cache(maxsize=128)
def _same(content: bytes) -> BoolArray:
    """Convert bytes to an array of truth values; equal bytes give the same object."""
    return np.frombuffer(content, np.bool_)


_ISLANDS: IdentityCache[IntArray] = IdentityCache(128)
