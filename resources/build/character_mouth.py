"""The inside of the mouth as one material: a small picture with a patch each for teeth, gums and tongue."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from character_surface import Surface
from character_textures import Texture, jpeg, noise, to_srgb

MOUTH_PX = 128
PATCHES: Mapping[str, tuple[float, tuple[float, float, float], float]] = {
    "teeth": (0.0, (0.70, 0.64, 0.52), 0.02),
    "gums": (1 / 3, (0.42, 0.13, 0.12), 0.10),
    "tongue": (2 / 3, (0.42, 0.14, 0.14), 0.14),
}
"""Left edge, linear colour, and how blotchy it is."""
PATCH_SHARE = 0.28
"""Width of a patch: less than a third, so that what is small by distance does not mix two."""


def mouth_colour(name: str) -> Texture:
    picture = np.empty((MOUTH_PX, MOUTH_PX, 3))
    columns = (np.arange(MOUTH_PX) + 0.5) / MOUTH_PX
    for seed, (left, colour, blotchy) in enumerate(PATCHES.values(), start=41):
        mottled = 1 + blotchy * noise(MOUTH_PX, 3, 16, seed)[..., None]
        picture = np.where((columns >= left)[None, :, None], np.asarray(colour) * mottled, picture)
    # Teeth are yellower at the gums (the picture's top and bottom) and paler at the biting edge (its middle).
    rows = np.abs(np.linspace(-1, 1, MOUTH_PX))[:, None, None]
    teeth = (columns < PATCHES["gums"][0])[None, :, None]
    picture = np.where(teeth, picture * (1 - rows * np.array([0.06, 0.12, 0.24])), picture)
    return jpeg(name, to_srgb(picture))


def with_mouth_material(surface: Surface) -> Surface:
    """A surface of teeth, gums or tongue with the one material `mouth`, laid into the patches from the front."""
    uvs = surface.uvs.copy()
    for name, triangles in surface.triangles.items():
        rows = np.unique(triangles)
        places = surface.positions[rows][:, :2]
        low, span = places.min(axis=0), np.ptp(places, axis=0)
        share = (places - low) / span
        left = PATCHES[name][0]
        uvs[rows] = np.stack([left + 0.02 + PATCH_SHARE * share[:, 0], share[:, 1]], axis=1)
    return replace(surface, uvs=uvs, triangles={"mouth": surface.all_triangles()})
