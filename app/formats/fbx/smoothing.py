"""Smoothing groups of FBX, for programs that compute normals themselves: faces that share a group are shaded
smoothly.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from app.arrays import AnyFloatArray, IntArray
from app.formats.scene import SkinnedMesh

GROUPS: Final = 31
"""Number of smoothing groups in a signed 32-bit integer; surfaces that do not touch may share a group."""
_PLACES: Final = 1e5
_DIRECTIONS: Final = 1e3
"""Steps per centimetre and per unit of a normal within which positions and normals count as equal."""


def smoothing_groups(mesh: SkinnedMesh) -> IntArray:
    """Return the smoothing group of each face (T,) as a bit.

    Faces on both sides of an edge share a group if their normals agree there; otherwise they have different ones,
    unless they also meet elsewhere.
    """
    faces = np.asarray(mesh.faces, np.int64)
    places = _numbered(np.asarray(mesh.vertices_cm, np.float64) * _PLACES)[faces]
    normals = np.asarray(mesh.normals, np.float64)
    lit = _numbered(normals * _DIRECTIONS)
    lit = lit[faces] if len(normals) == len(mesh.vertices_cm) else lit.reshape(faces.shape)
    corners = places * (int(lit.max(initial=0)) + 1) + lit
    number = np.repeat(np.arange(len(faces)), faces.shape[1])
    smooth = _neighbours(corners, number)
    count, surface = connected_components(coo_array((np.ones(len(smooth)), smooth.T), (len(faces), len(faces))), False)
    touching = surface[_neighbours(places, number)]
    touching = np.unique(np.sort(touching[touching[:, 0] != touching[:, 1]], axis=1), axis=0)
    around: list[list[int]] = [[] for _ in range(count)]
    for one, other in touching.tolist():
        around[other].append(one)
    group = np.zeros(count, np.int64)
    for one, others in enumerate(around):
        taken = {int(group[other]) for other in others}
        group[one] = next((bit for bit in range(GROUPS) if bit not in taken), 0)
    return (1 << group[surface]).astype(np.int32)


def _numbered(values: AnyFloatArray) -> IntArray:
    """Return for each row of values (N, 3) the index (N,) of the distinct row that it equals after rounding."""
    numbers: IntArray = np.unique(np.rint(values).astype(np.int64), axis=0, return_inverse=True)[1].reshape(-1)
    return numbers


def _neighbours(ends: IntArray, number: IntArray) -> IntArray:
    """Return the pairs (P, 2) of faces that share an edge.

    ``ends`` (T, N) are the corners of T faces with N corners each, numbered so that equal positions are equal;
    ``number`` (T * N,) is the face of each edge.
    """
    edges = np.sort(np.stack([ends.ravel(), np.roll(ends, -1, axis=1).ravel()], axis=1), axis=1)
    order = np.lexsort(edges.T)
    edges, number = edges[order], number[order]
    same = np.flatnonzero((edges[1:] == edges[:-1]).all(axis=1))
    pairs: IntArray = np.stack([number[same], number[same + 1]], axis=1)
    return pairs
