"""Teeth, gums and tongue as patches of one texture for wet surfaces, which also contains the white of the eyes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from character_surface import Surface
from character_textures import noise

WET = "mouth_eyes"
"""Material of teeth, gums, tongue and the white of the eyes."""
PATCHES: Mapping[str, tuple[float, tuple[float, float, float], float]] = {
    "tongue": (0.0, (0.42, 0.14, 0.14), 0.14),
    "gums": (1 / 3, (0.42, 0.13, 0.12), 0.10),
    "teeth": (2 / 3, (0.70, 0.64, 0.52), 0.02),
}
"""Lower edge, linear colour and amount of blotches of each patch."""
PATCHES_LEFT = 0.77
MARGIN = 0.02
"""Margin around the used part of a patch, so that reduced textures do not mix two patches."""


def mouth_patches(size: int) -> np.ndarray:
    """(size, size, 3) linear colours: the patches one over the other."""
    picture = np.empty((size, size, 3))
    height = 1 - (np.arange(size) + 0.5) / size
    for seed, (low, colour, blotchy) in enumerate(PATCHES.values(), start=41):
        mottled = np.asarray(colour) * (1 + blotchy * noise(size, 6, 40, seed)[..., None])
        picture = np.where((height >= low)[:, None, None], mottled, picture)
    # Teeth are yellower at the gums (top and bottom of their patch) and paler at the biting edge (its middle).
    low = PATCHES["teeth"][0]
    off = np.where(height >= low, np.abs((height - low) / (1 - low) * 2 - 1), 0.0)
    return picture * (1 - off[:, None, None] * np.array([0.06, 0.12, 0.24]))


def with_wet_material(surface: Surface) -> Surface:
    """Surface of teeth, gums or tongue with the material for wet surfaces, projected to its patch from the front."""
    uvs = surface.uvs.copy()
    room = np.array([1.0 - PATCHES_LEFT, 1 / 3]) - 2 * MARGIN
    for name, triangles in surface.triangles.items():
        rows = np.unique(triangles)
        places = surface.positions[rows][:, :2]
        share = (places - places.min(axis=0)) / np.ptp(places, axis=0)
        uvs[rows] = [PATCHES_LEFT + MARGIN, PATCHES[name][0] + MARGIN] + room * share
    return replace(surface, uvs=uvs, triangles={WET: surface.all_triangles()})
