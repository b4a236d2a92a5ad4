"""Colours and opacity of textures at the vertices and triangles of split meshes, for drawing them without textures.

People made from one body share the results.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray, SingleArray
from app.formats.texture_colors import OPAQUE, linear, sampled
from app.formats.textures import TextureUse
from app.identity_cache import IdentityCache
from widgets.viewport.normals_across_seams import SplitMesh

_INSIDE = np.array(
    [
        *((1 / 3, 1 / 3, 1 / 3), (0.6, 0.2, 0.2), (0.2, 0.6, 0.2), (0.2, 0.2, 0.6)),
        *((0.45, 0.45, 0.1), (0.1, 0.45, 0.45), (0.45, 0.1, 0.45)),
    ]
)
"""Points in a triangle, as shares of its corners, where its texture is sampled."""
_LEAST_FILLED = 0.4
"""Mean opacity below which a cut-out triangle is left out at the coarsest level: fringes are above, single hairs along
hairlines below."""


@dataclass(frozen=True, eq=False)
class Places:
    """Texture coordinates (V, 2) and materials (V,) of the vertices of a split mesh, and its triangles (T, 3)."""

    uvs: SingleArray
    materials: IntArray
    triangles: IntArray


def placed(split: SplitMesh) -> Places:
    """Return the texture coordinates, materials and triangles of a split mesh; cached by these for skinned meshes."""
    if not split.mesh.is_skinned:
        return _places(split.vertices, split.materials, split.triangles, split.mesh.uvs)
    return _PLACES.step(_places, split.vertices, split.materials, split.triangles, split.mesh.uvs)


def _places(vertices: IntArray, materials: IntArray, triangles: IntArray, uvs: SingleArray) -> Places:
    return Places(uvs.take(vertices, axis=0), materials, triangles)


_PLACES: IdentityCache[Places] = IdentityCache(128)


@lru_cache(maxsize=32)
def pictured(use: TextureUse, places: Places, number: int, cut_out: bool) -> tuple[BoolArray, FloatArray] | None:
    """Return the linear colours (N, 3) of a texture at vertices with one material, those cut out excepted, and an array
    that is True for these vertices among all with the material; None if the texture cannot be read.
    """
    found = sampled(use, places.uvs[places.materials == number])
    if found is None:
        return None
    filled: BoolArray = found[:, 3] > (OPAQUE if cut_out else -1.0)
    return filled, linear(found[filled, :3])


@lru_cache(maxsize=32)
def mostly_filled(use: TextureUse, places: Places, number: int) -> BoolArray | None:
    """Return for each triangle with one material whether the texture covers enough of it to be drawn without texture;
    None if the texture cannot be read.
    """
    own = places.triangles[places.materials[places.triangles[:, 0]] == number]
    inside = np.einsum("pc,tcd->tpd", _INSIDE, places.uvs[own].astype(np.float64))
    found = sampled(use, inside.reshape(-1, 2))
    if found is None:
        return None
    filled: BoolArray = found[:, 3].reshape(len(own), -1).mean(axis=1) >= _LEAST_FILLED
    return filled
