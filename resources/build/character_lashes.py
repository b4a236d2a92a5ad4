"""Brows and lashes as cards: MakeHuman's meshes with one picture of grey hairs, so that any colour tints them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from character_assets import Asset, asset_surface, read_asset, read_material
from character_skin import read_picture
from character_strands import ALPHAS, GREYS, HAIR_PX, STRANDS_MEAN_LINEAR, covered, directions, in_steps, strands
from character_surface import Surface
from character_textures import Texture, png, sampled, to_srgb
from scipy.ndimage import gaussian_filter

if TYPE_CHECKING:
    from character_skeleton import SkeletonFit
    from character_source import Source

LASH_GREY_LINEAR, LOWER_LASHES = 0.05, 0.6
BROW_PX, BROW_FROM = (2.0, 9.0), 0.35
"""Reach in pixels, down and along, over which the hairs of a brow close, and the density from which they do."""


def _strip(asset: Asset) -> tuple[np.ndarray, np.ndarray]:
    """Lower left and upper right corner of the part of its texture that an asset uses."""
    used = asset.uvs[np.unique(asset.uv_faces)]
    return np.clip(used.min(axis=0) - 0.004, 0, 1), np.clip(used.max(axis=0) + 0.004, 0, 1)


def _brow_picture(painted: np.ndarray) -> np.ndarray:
    """Grey hairs, single ones at the edges and closed in the middle, so that reduced pictures keep the brow whole."""
    alpha = np.clip(painted[..., 3], 0, 1)
    fine = strands(directions(gaussian_filter(alpha, 1.0) + 0.5 * painted[..., :3].mean(axis=-1), 2.5)[0], 32)
    grey = to_srgb(np.clip(STRANDS_MEAN_LINEAR * np.exp(0.45 * fine), 0.05, 0.9))
    closed = gaussian_filter(alpha, BROW_PX)
    closed = np.clip((closed / np.quantile(closed[closed > 0.02], 0.9) - BROW_FROM) / (1 - BROW_FROM), 0.0, 1.0)
    hairs = np.maximum(alpha * (0.95 + 0.32 * fine), closed + 0.40 * fine * (closed > 0.0) * (1.0 - 0.7 * closed))
    return np.stack([grey, grey, grey, np.clip(hairs, 0, 1)], axis=-1)


def _lash_picture(painted: np.ndarray, lower: np.ndarray) -> np.ndarray:
    """Near black, and thinner along the lower lid (mask `lower`)."""
    grey = to_srgb(np.full(painted.shape[:2], LASH_GREY_LINEAR))
    alpha = np.clip(painted[..., 3], 0, 1) * np.where(lower, LOWER_LASHES, 0.95)
    return np.stack([grey, grey, grey, alpha], axis=-1)


def brow_textures(name: str, brow: Asset, lash: Asset, lower_lid: np.ndarray) -> tuple[Texture, Asset, Asset]:
    """One picture, brows above lashes, and both assets with their texture coordinates in it.

    `lower_lid` are the base mesh's vertices of the lower lashes.
    """
    height, width = HAIR_PX // 2, HAIR_PX
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, 1 - (np.arange(height // 2) + 0.5) / (height // 2))
    halves, moved = [], []
    below = np.isin(lash.binding.corners[lash.faces], lower_lid).all(axis=(1, 2))
    lower = covered(lash.uvs, lash.uv_faces[below], HAIR_PX).astype(float)
    for asset, floor in ((brow, 0.5), (lash, 0.0)):
        if asset.material is None:
            raise ValueError(f"{asset.name} has no material")
        painted = read_picture(read_material(asset.material).textures["diffuseTexture"])
        low, high = _strip(asset)
        place = (low[0] + u * (high - low)[0], low[1] + v * (high - low)[1])
        part = sampled(painted, *place)
        halves.append(_brow_picture(part) if asset is brow else _lash_picture(part, sampled(lower, *place) > 0.5))
        moved.append(replace(asset, uvs=(asset.uvs - low) / (high - low) * [1.0, 0.5] + [0.0, floor]))
    picture = np.concatenate(halves)
    picture[..., :3] = in_steps(picture[..., :3], GREYS)
    picture[..., 3] = in_steps(picture[..., 3], 2 * ALPHAS)
    return png(name, picture), moved[0], moved[1]


def brows_and_lashes(
    folder: Path, brow: str, lash: str, source: Source, fit: SkeletonFit
) -> tuple[tuple[Surface, Surface], Texture]:
    """Brows and lashes on a body, with the shapes of the face, and their picture."""
    texture, *assets = brow_textures(
        f"{brow}_{lash}_color",
        read_asset(folder / "eyebrows" / brow / f"{brow}.mhclo"),
        read_asset(folder / "eyelashes" / lash / f"{lash}.mhclo"),
        np.unique([source.groups[group].vertices for group in ("helper-l-eyelashes-1", "helper-r-eyelashes-1")]),
    )
    first, second = (
        asset_surface(asset, source, fit, name, "brows", morphs=True)
        for asset, name in zip(assets, ("brows", "lashes"), strict=True)
    )
    return (first, second), texture
