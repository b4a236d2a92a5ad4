"""Grouping of triangles by their textures for the graphics card."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from app.arrays import AnyIntArray, IntArray
from app.formats.scene import Material
from app.rig.mesh import Mesh


def textured_looks(meshes: Sequence[Mesh]) -> tuple[Material, ...]:
    """Return those materials of the meshes that have textures, each once."""
    materials = (material for mesh in meshes for material in mesh.materials)
    return tuple(dict.fromkeys(material for material in materials if material.textures.uses))


def uv_islands(triangles: AnyIntArray, textured: npt.NDArray[np.bool_]) -> IntArray:
    """Return a number for the vertices (V,) of each connected textured part; 0 for all others.

    Texture coordinates are discontinuous between such parts, so that merging vertices across them would distort the
    texture.
    """
    count = len(textured)
    if not textured.any():
        return np.zeros(count, np.int64)
    from scipy.sparse import coo_matrix  # slow to import; not needed before the first figure with textures
    from scipy.sparse.csgraph import connected_components

    own = triangles[textured[triangles[:, 0]]]
    ends = np.concatenate([own[:, [0, 1]], own[:, [1, 2]]])
    links = coo_matrix((np.ones(len(ends), bool), (ends[:, 0], ends[:, 1])), shape=(count, count))
    parts: IntArray = connected_components(links, directed=False)[1].astype(np.int64)
    return np.where(textured, parts + 1, 0)


def texture_groups(look: AnyIntArray, two_sided: npt.NDArray[np.bool_]) -> npt.NDArray[np.int32]:
    """Return `Geometry.groups` for triangles that are ordered by look (index of the textured material) and sides."""
    keys = look.astype(np.int64) * 2 + two_sided
    first = np.flatnonzero(np.r_[True, keys[1:] != keys[:-1]])
    counts = np.diff(np.r_[first, len(keys)])
    return np.stack([first, counts, look[first]], axis=1).astype(np.int32)
