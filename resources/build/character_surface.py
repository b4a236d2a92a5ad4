"""The surfaces of a character: one value per mesh of the file, with every operation that cuts or offsets them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components


@dataclass(frozen=True)
class Surface:
    """A skinned, morphable triangle mesh in anny's rest pose.

    Attributes
    ----------
    positions, normals : (N, 3).
    uvs : (N, 2), origin at the lower left.
    weights : (N, J).
    triangles : material name -> (F, 3); all materials share the vertices.
    morphs : morph target name -> (N, 3) offsets.
    origin : (N,) the base mesh's vertex that each vertex came from, -1 for modelled ones.
    """

    name: str
    positions: np.ndarray
    normals: np.ndarray
    uvs: np.ndarray
    weights: np.ndarray
    triangles: dict[str, np.ndarray]
    morphs: dict[str, np.ndarray] = field(default_factory=dict)
    origin: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    def all_triangles(self) -> np.ndarray:
        return np.concatenate(list(self.triangles.values()))


def triangulate(quads: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Two triangles per quad, cut along the shorter diagonal; degenerate corners are left out."""
    a, b, c, d = quads.T
    first = np.linalg.norm(points[a] - points[c], axis=1) <= np.linalg.norm(points[b] - points[d], axis=1)
    one = np.where(first[:, None], np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    two = np.where(first[:, None], np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    triangles = np.stack([one, two], axis=1).reshape(-1, 3)
    keep = (
        (triangles[:, 0] != triangles[:, 1])
        & (triangles[:, 1] != triangles[:, 2])
        & (triangles[:, 2] != triangles[:, 0])
    )
    return triangles[keep]


def vertex_normals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(N, 3) unit normals, faces weighted by their area; vertices without faces get +Y."""
    corners = points[triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(points)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], faces)
    lengths = np.linalg.norm(normals, axis=1)
    normals[lengths < 1e-14] = (0.0, 1.0, 0.0)
    return _normalise(normals)


def _normalise(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def split_seams(vertices: np.ndarray, uvs: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One output vertex per (vertex, texture coordinate) pair in use.

    Returns
    -------
    Source vertex and source texture coordinate of each output vertex, and the faces over the output vertices.
    """
    pairs = np.stack([vertices.ravel(), uvs.ravel()], axis=1)
    unique, inverse = np.unique(pairs, axis=0, return_inverse=True)
    return unique[:, 0], unique[:, 1], inverse.reshape(vertices.shape)


def weld(surface: Surface) -> np.ndarray:
    """(N,) label per vertex, equal for vertices in one place (the two sides of a texture seam)."""
    keys = np.round(surface.positions / 1e-6).astype(np.int64)
    return np.unique(keys, axis=0, return_inverse=True)[1].ravel()


def parts_of(faces: np.ndarray, count: int) -> np.ndarray:
    """(count,) number of the part that each vertex belongs to, parts being what faces (F, K) connect."""
    edges = np.concatenate([faces[:, [k, k + 1]] for k in range(faces.shape[1] - 1)])
    links = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    return connected_components(links, directed=False)[1]


def smooth_normals(surface: Surface) -> Surface:
    """The surface with its normals computed anew, smooth across texture seams."""
    labels = weld(surface)
    places = np.zeros((labels.max() + 1, 3))
    places[labels] = surface.positions
    normals = vertex_normals(places, labels[surface.all_triangles()])
    return replace(surface, normals=normals[labels])


def compact(surface: Surface) -> Surface:
    """The surface without vertices that no triangle uses."""
    used = np.unique(surface.all_triangles())
    renumber = np.full(len(surface.positions), -1)
    renumber[used] = np.arange(len(used))
    return replace(
        surface,
        positions=surface.positions[used],
        normals=surface.normals[used],
        uvs=surface.uvs[used],
        weights=surface.weights[used],
        triangles={name: renumber[faces] for name, faces in surface.triangles.items() if len(faces)},
        morphs={name: delta[used] for name, delta in surface.morphs.items()},
        origin=surface.origin[used] if len(surface.origin) else surface.origin,
    )


def modelled(
    name: str,
    positions: np.ndarray,
    weights: np.ndarray,
    triangles: Mapping[str, np.ndarray],
    *,
    uvs: np.ndarray | None = None,
    morphs: Mapping[str, np.ndarray] | None = None,
    origin: np.ndarray | None = None,
) -> Surface:
    """A surface with smooth normals, of vertices that are no base mesh's where no `origin` is given.

    Texture coordinates are those of the front where none are given.
    """
    surface = Surface(
        name=name,
        positions=positions,
        normals=np.zeros_like(positions),
        uvs=positions[:, :2] % 1.0 if uvs is None else uvs,
        weights=weights,
        triangles=dict(triangles),
        morphs=dict(morphs or {}),
        origin=np.full(len(positions), -1) if origin is None else origin,
    )
    return compact(smooth_normals(surface))


def keep_triangles(surface: Surface, keep: Mapping[str, np.ndarray]) -> Surface:
    """The surface with only the triangles whose flag is set, per material."""
    return compact(replace(surface, triangles={name: faces[keep[name]] for name, faces in surface.triangles.items()}))
