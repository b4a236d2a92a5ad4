"""Garments of MakeHuman as pieces of outfits: cut by texture coordinates, laid on the atlas, parted by dye."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from character_assets import Asset, read_asset
from character_body import surface_of, visible
from character_garments import Tailoring
from character_skeleton import SkeletonFit
from character_skin import Layout, read_picture
from character_source import Source
from character_surface import Surface, compact, modelled, split_seams, triangulate, vertex_normals
from character_textures import to_linear
from scipy.ndimage import map_coordinates
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from wardrobe_atlas import LINEN, PATCHES

MAIN, SECOND, ACCENT = "cloth_main", "cloth_second", "cloth_accent"
LESS_WEIGHT = 2e-3


@dataclass(frozen=True)
class Wearer:
    """A finished body that garments are fitted to; `positions` (J, 3) are its joints as standing on the floor, `shirt`
    the patch of its own shirt."""

    name: str
    shirt: str
    source: Source
    fit: SkeletonFit
    tailoring: Tailoring
    layout: Layout
    assets: Path
    positions: np.ndarray


@lru_cache(maxsize=8)
def _asset(assets: Path, folder: str) -> Asset:
    (path,) = (assets / "clothes" / folder).glob(f"{folder}.mhclo")
    return read_asset(path)


def _outwards(asset: Asset, wearer: Wearer) -> np.ndarray:
    """Texture coordinates' islands of some assets are turned inside out: the (F,) faces to be turned round."""
    uv_faces, source = asset.uv_faces, wearer.source
    edges = np.concatenate([uv_faces[:, [0, 1]], uv_faces[:, [1, 2]], uv_faces[:, [2, 3]]])
    links = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(len(asset.uvs), len(asset.uvs)))
    island = connected_components(links, directed=False)[1][uv_faces[:, 0]]
    quads = np.concatenate([group.vertices for group in source.groups.values()])
    skin = vertex_normals(source.vertices, triangulate(quads, source.vertices))
    corners = asset.binding.positions(source.vertices)[asset.faces]
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    along = (across * asset.binding.carried(skin)[asset.faces].mean(axis=1)).sum(axis=1)
    return np.bincount(island, along)[island] < 0.0


@lru_cache(maxsize=8)
def _dyes(assets: Path, folder: str) -> np.ndarray:
    return to_linear(read_picture(assets / "clothes" / folder / f"{folder}_diffuse.png")[:, :, :3])


def few_bones(weights: np.ndarray, most: int = 4) -> np.ndarray:
    """Skin weights (N, J) of the heaviest bones."""
    few = np.where(weights < LESS_WEIGHT, 0.0, weights)
    np.put_along_axis(few, np.argsort(-few, axis=1, kind="stable")[:, most:], 0.0, axis=1)
    return few / few.sum(axis=1, keepdims=True)


def piece(
    wearer: Wearer,
    name: str,
    patch: str,
    chosen: Callable[[np.ndarray], np.ndarray],
    materials: Callable[[np.ndarray, np.ndarray], Mapping[str, np.ndarray]],
) -> Surface:
    """Cut a garment from one of MakeHuman's.

    Parameters
    ----------
    patch : the name of its picture in `PATCHES`.
    chosen : gives the faces (F,) that are wanted from the texture coordinates (F, 2) of their middles.
    materials : gives the material of each triangle (flags (T,) by name) from the middle (T, 2) and the linear dye
        (T, 3) of its quad.
    """
    place = PATCHES[patch]
    asset = _asset(wearer.assets, place.folder)
    wanted = chosen(asset.uvs[asset.uv_faces].mean(axis=1))
    turned = _outwards(asset, wearer)[:, None]
    faces, uv_faces = (np.where(turned, corners[:, ::-1], corners) for corners in (asset.faces, asset.uv_faces))
    vertex, uv_index, faces = split_seams(faces[wanted], uv_faces[wanted])
    binding = asset.binding.at(vertex)
    positions = binding.positions(wearer.source.vertices)
    uvs = asset.uvs[uv_index]
    triangles = triangulate(faces, positions)
    # Both triangles of a quad have one dye.
    corner = np.sort(faces, axis=1)
    quad = np.repeat(np.arange(len(faces)), np.where((corner[:, 1:] == corner[:, :-1]).any(axis=1), 1, 2))
    middles = uvs[faces].mean(axis=1)[quad]
    dyes = _dyes(wearer.assets, place.folder)
    height, width = dyes.shape[:2]
    at = [(1.0 - middles[:, 1]) * height - 0.5, middles[:, 0] * width - 0.5]
    dye = np.stack([map_coordinates(dyes[:, :, k], at, order=1, mode="nearest") for k in range(3)], axis=1)
    parts = {material: triangles[own] for material, own in materials(middles, dye).items() if own.any()}
    weights = few_bones(binding.skin_weights(wearer.fit.weights))
    return modelled(name, positions, weights, parts, uvs=place.uvs(uvs))


def connected(wearer: Wearer, patch: str, reach_m: float) -> Callable[[np.ndarray], np.ndarray]:
    """Function for `piece` that chooses the faces of an asset connected with any above a height in the T-pose."""
    asset = _asset(wearer.assets, PATCHES[patch].folder)
    faces, count = asset.faces, int(asset.faces.max()) + 1
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 3]]])
    links = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    part = connected_components(links, directed=False)[1]
    weights = asset.binding.skin_weights(wearer.fit.weights)
    heights = wearer.fit.to_t_pose(asset.binding.positions(wearer.source.vertices), weights)[:, 1]
    high = np.unique(part[np.flatnonzero(heights[:count] > reach_m)])
    return lambda uvs: np.isin(part[faces[:, 0]], high)


def all_of(material: str) -> Callable[[np.ndarray, np.ndarray], dict[str, np.ndarray]]:
    """Function for `piece` that gives everything one material."""
    return lambda centres, dye: {material: np.ones(len(centres), dtype=bool)}


TIE = (
    (0.3865, 0.9085),
    (0.3825, 0.905),
    (0.3835, 0.893),
    (0.3715, 0.868),
    (0.3685, 0.850),
    (0.3645, 0.833),
    (0.361, 0.818),
    (0.368, 0.8225),
    (0.381, 0.8375),
    (0.392, 0.8545),
    (0.3945, 0.863),
    (0.400, 0.870),
    (0.4035, 0.8815),
    (0.4065, 0.894),
    (0.4105, 0.898),
    (0.4095, 0.908),
    (0.4095, 0.917),
    (0.397, 0.9165),
    (0.392, 0.9135),
)
"""Outline of the suit's tie in texture coordinates."""


def _within(outline: Sequence[tuple[float, float]], places: np.ndarray) -> np.ndarray:
    """Flags (N,) of the places (N, 2) within an outline."""
    inside = np.zeros(len(places), dtype=bool)
    for one, other in zip(outline, (*outline[1:], outline[0]), strict=True):
        passes = (one[1] > places[:, 1]) != (other[1] > places[:, 1])
        at = one[0] + (places[:, 1] - one[1]) * (other[0] - one[0]) / (other[1] - one[1] or 1.0)
        inside ^= passes & (places[:, 0] < at)
    return inside


def linen_apart(cloth: str, linen: str, tie: str) -> Callable[[np.ndarray, np.ndarray], dict[str, np.ndarray]]:
    """The suit: white linen by its brightness, the tie by its place, the cloth of the jacket."""

    def parted(centres: np.ndarray, dye: np.ndarray) -> dict[str, np.ndarray]:
        # The linen's own island: above a line beside the jacket's shoulder.
        island = (centres[:, 0] > 0.345) & (1.0 - centres[:, 1] < 0.181 - 0.85 * (centres[:, 0] - 0.361))
        white = dye.mean(axis=1) > LINEN
        of_tie = _within(TIE, centres)
        of_linen = (white | island) & ~of_tie
        found: dict[str, np.ndarray] = {}
        for material, own in ((cloth, ~of_linen & ~of_tie), (linen, of_linen), (tie, of_tie)):
            found[material] = found.get(material, np.zeros(len(own), dtype=bool)) | own
        return found

    return parted


def merged(name: str, *surfaces: Surface) -> Surface:
    """Several surfaces as one, their materials joined."""
    starts = np.cumsum([0] + [len(surface.positions) for surface in surfaces])
    triangles: dict[str, list[np.ndarray]] = {}
    for surface, start in zip(surfaces, starts, strict=False):
        for material, faces in surface.triangles.items():
            triangles.setdefault(material, []).append(faces + start)
    return Surface(
        name=name,
        positions=np.concatenate([surface.positions for surface in surfaces]),
        normals=np.concatenate([surface.normals for surface in surfaces]),
        uvs=np.concatenate([surface.uvs for surface in surfaces]),
        weights=np.concatenate([surface.weights for surface in surfaces]),
        triangles={material: np.concatenate(faces) for material, faces in triangles.items()},
    )


def skin(wearer: Wearer, name: str, shown: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Surface:
    """The body's own skin where a garment leaves it bare, except for parts that the bundled body shows anyway.

    Parameters
    ----------
    shown : says by T-pose places (N, 3) and weights (N, J) which vertices are seen.
    """
    whole = surface_of(wearer.source, wearer.fit, name, ("body",), "skin", morphs=False)
    places = wearer.fit.to_t_pose(whole.positions, whole.weights)
    seen, faces = shown(places, whole.weights), whole.triangles["skin"]
    there = visible(wearer.tailoring, places)
    own = replace(whole, triangles={"skin": faces[seen[faces].all(axis=1) & ~there[faces].all(axis=1)]})
    return wearer.layout.dressed(compact(own))
