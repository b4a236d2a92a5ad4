"""Brows and lashes as cards: MakeHuman's meshes with one picture of grey hairs, so that any colour tints them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from character_assets import Asset, asset_surface, read_asset, read_material
from character_brow_hairs import brow_hairs
from character_skin import read_picture
from character_strands import ALPHAS, GREYS, HAIR_PX, STRANDS_MEAN_LINEAR, covered, in_steps
from character_surface import Surface
from character_textures import Texture, png, sampled, to_srgb

if TYPE_CHECKING:
    from character_skeleton import SkeletonFit
    from character_source import Source

LASH_GREY_LINEAR, LOWER_LASHES = 0.05, 0.6
MARGIN = 0.004
"""Share of a texture around what its asset uses of it."""


def _strip(uvs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower left and upper right corner of the part of a texture in which texture coordinates are."""
    return np.clip(uvs.min(axis=0) - MARGIN, 0, 1), np.clip(uvs.max(axis=0) + MARGIN, 0, 1)


def _stripped(asset: Asset, mirrored: np.ndarray) -> tuple[Asset, tuple[np.ndarray, np.ndarray]]:
    """An asset whose texture is only the strip that its faces use, and the corners of the strip.

    Faces of the mask `mirrored` show the strip of the others from the other side.
    """
    uvs, strip = asset.uvs.copy(), _strip(asset.uvs[np.unique(asset.uv_faces[~mirrored])])
    for side in (mirrored, ~mirrored):
        own = np.unique(asset.uv_faces[side])
        if len(own):
            low, high = _strip(asset.uvs[own])
            uvs[own] = (asset.uvs[own] - low) / (high - low)
    own = np.unique(asset.uv_faces[mirrored])
    uvs[own, 0] = 1.0 - uvs[own, 0]
    return replace(asset, uvs=uvs), strip


def _brow_picture(painted: np.ndarray) -> np.ndarray:
    """Grey hairs, their inner end at the left."""
    shade, alpha = brow_hairs(np.clip(painted[..., 3], 0, 1))
    grey = to_srgb(np.clip(STRANDS_MEAN_LINEAR * shade, 0.05, 0.9))
    return np.stack([grey, grey, grey, alpha], axis=-1)


def _lash_picture(painted: np.ndarray, lower: np.ndarray) -> np.ndarray:
    """Near black, and thinner along the lower lid (mask `lower`)."""
    grey = to_srgb(np.full(painted.shape[:2], LASH_GREY_LINEAR))
    alpha = np.clip(painted[..., 3], 0, 1) * np.where(lower, LOWER_LASHES, 0.95)
    return np.stack([grey, grey, grey, alpha], axis=-1)


def brow_textures(
    name: str, brow: Asset, lash: Asset, lower_lid: np.ndarray, mirrored: np.ndarray
) -> tuple[Texture, Asset, Asset]:
    """One picture, a brow above lashes, and both assets with their texture coordinates in it.

    `lower_lid` are the base mesh's vertices of the lower lashes, `mirrored` (F,) the faces of the brow whose inner end
    is at the right in its picture: they show the other one, so that it has twice the pixels.
    """
    height, width = HAIR_PX // 2, HAIR_PX
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, 1 - (np.arange(height // 2) + 0.5) / (height // 2))
    halves, moved = [], []
    below = np.isin(lash.binding.corners[lash.faces], lower_lid).all(axis=(1, 2))
    lower = covered(lash.uvs, lash.uv_faces[below], HAIR_PX).astype(float)
    for asset, turned, floor in ((brow, mirrored, 0.5), (lash, np.zeros(len(lash.faces), dtype=bool), 0.0)):
        if asset.material is None:
            raise ValueError(f"{asset.name} has no material")
        painted = read_picture(read_material(asset.material).textures["diffuseTexture"])
        stripped, (low, high) = _stripped(asset, turned)
        place = (low[0] + u * (high - low)[0], low[1] + v * (high - low)[1])
        part = sampled(painted, *place)
        halves.append(_brow_picture(part) if asset is brow else _lash_picture(part, sampled(lower, *place) > 0.5))
        moved.append(replace(stripped, uvs=stripped.uvs * [1.0, 0.5] + [0.0, floor]))
    picture = np.concatenate(halves)
    picture[..., :3] = in_steps(picture[..., :3], GREYS)
    picture[..., 3] = in_steps(picture[..., 3], 2 * ALPHAS)
    return png(name, picture), moved[0], moved[1]


def brows_and_lashes(
    folder: Path, brow: str, lash: str, source: Source, fit: SkeletonFit
) -> tuple[tuple[Surface, Surface], Texture]:
    """Brows and lashes on a body, with the shapes of the face, and their picture."""
    painted = read_asset(folder / "eyebrows" / brow / f"{brow}.mhclo")
    places = painted.binding.positions(source.vertices)
    texture, *assets = brow_textures(
        f"{brow}_{lash}_color",
        painted,
        read_asset(folder / "eyelashes" / lash / f"{lash}.mhclo"),
        np.unique([source.groups[group].vertices for group in ("helper-l-eyelashes-1", "helper-r-eyelashes-1")]),
        places[painted.faces].mean(axis=1)[:, 0] < 0.0,
    )
    first, second = (
        asset_surface(asset, source, fit, name, "brows", morphs=True)
        for asset, name in zip(assets, ("brows", "lashes"), strict=True)
    )
    return (first, second), texture
