"""The skin: MakeHuman's painted skins laid out anew with more room for head and hands, and fine detail over them.

Only head, neck and hands are seen from near, so their parts of the texture get more of it than hm08's layout gives. The
skins are 512 pixels wide: blotches, pores and the sheen of brow, nose and lips come from here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from character_surface import Surface
from character_textures import Texture, cells, jpeg, noise, normals_of, png, sampled, spread, to_linear, to_srgb
from PIL import Image, ImageDraw
from scipy.ndimage import gaussian_filter
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

SKIN_PX, ORM_PX, PORES_PX = 1024, 512, 256
SKIN_MEAN_LINEAR = 0.70
PORE_TILES = 22.0
"""Tiles of pores across the texture: one covers 2 cm of face."""
MARGIN_PX = 6

ISLANDS = (
    # A texture coordinate that is in the island, lower left corner in the new layout, and how much larger it becomes.
    ((0.93, 0.49), (0.004, 0.012), 1.455),
    ((0.38, 0.60), (0.535, 0.470), 0.61),
    ((0.44, 0.10), (0.528, 0.225), 1.20),
    ((0.68, 0.10), (0.763, 0.225), 1.20),
    ((0.10, 0.09), (0.530, 0.110), 0.62),
    ((0.28, 0.09), (0.650, 0.110), 0.62),
    ((0.84, 0.07), (0.780, 0.110), 0.70),
    ((0.045, 0.59), (0.530, 0.030), 0.60),
    ((0.118, 0.59), (0.590, 0.030), 0.60),
)
"""Head, trunk with limbs, right hand, left hand, feet, mouth, nostrils or sockets."""


PAINTED_PALER, PALER_UNDONE = (2, 3, 4, 5), 0.85
"""Indices in `ISLANDS` of hands and feet, whose colour is moved towards the face's, and the share; the trunk meets the
neck unchanged.
"""
REDDER = {"cheeks": 0.07, "nose": 0.05, "chin": 0.03, "ears": 0.10, "lids": 0.05}
DARKER = {"lids": 0.10, "sockets": 0.11, "wings": 0.16}
"""Shares by which spots of the face are redder, and darker."""
LIPS_REDDER = np.array([0.08, 0.26, 0.20])
"""Share of each channel that lips lack, which are painted pale."""
KNEE_LINEAR = 0.80
"""Linear brightness above which values approach white gradually instead of being cut off."""


@dataclass(frozen=True)
class Layout:
    """The new layout of the body's texture.

    Attributes
    ----------
    hm08, uvs : (T, 2) old and new texture coordinates of the base mesh.
    source_u, source_v : (SKIN_PX, SKIN_PX) hm08's coordinates per pixel.
    part : (SKIN_PX, SKIN_PX) the part of `ISLANDS` that a pixel belongs to, -1 outside.
    """

    hm08: np.ndarray
    uvs: np.ndarray
    source_u: np.ndarray
    source_v: np.ndarray
    part: np.ndarray

    @property
    def inside(self) -> np.ndarray:
        """(SKIN_PX, SKIN_PX) whether a pixel belongs to the body."""
        return self.part >= 0

    def picture(self, hm08: np.ndarray) -> np.ndarray:
        """A picture over hm08's coordinates in the new layout."""
        return sampled(hm08, self.source_u, self.source_v)

    def dressed(self, body: Surface) -> Surface:
        """A surface cut from the body, with the new coordinates and the one material `skin`."""
        rows = cKDTree(self.hm08).query(body.uvs)[1]
        return replace(body, uvs=self.uvs[rows], triangles={"skin": body.all_triangles()})


def skin_layout(uvs: np.ndarray, faces: np.ndarray) -> Layout:
    """The layout of a body with hm08's (T, 2) texture coordinates and its (F, 4) corners."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 3]]])
    links = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(len(uvs), len(uvs)))
    labels = connected_components(links, directed=False)[1]
    used = np.unique(faces)
    moved = uvs.copy()
    centres = (np.arange(SKIN_PX) + 0.5) / SKIN_PX
    grid_u, grid_v = np.meshgrid(centres, centres[::-1])
    source_u, source_v = np.zeros_like(grid_u), np.zeros_like(grid_v)
    part = np.full(grid_u.shape, -1)
    for number, (spot, corner, scale) in enumerate(ISLANDS):
        label = labels[used[np.linalg.norm(uvs[used] - spot, axis=1).argmin()]]
        rows = used[labels[used] == label]
        low, high = uvs[rows].min(axis=0), uvs[rows].max(axis=0)
        moved[rows] = (uvs[rows] - low) * scale + corner
        canvas = Image.new("1", (SKIN_PX, SKIN_PX))
        drawing = ImageDraw.Draw(canvas)
        for face in faces[labels[faces[:, 0]] == label]:
            drawing.polygon([(u * SKIN_PX, (1 - v) * SKIN_PX) for u, v in moved[face]], fill=1, outline=1)
        part[np.asarray(canvas)] = number
        room = MARGIN_PX / SKIN_PX
        top = np.asarray(corner) + (high - low) * scale
        near = (grid_u > corner[0] - room) & (grid_u < top[0] + room) & (grid_v > corner[1] - room)
        near &= grid_v < top[1] + room
        source_u[near] = (grid_u[near] - corner[0]) / scale + low[0]
        source_v[near] = (grid_v[near] - corner[1]) / scale + low[1]
    return Layout(uvs, moved, source_u, source_v, part)


def _blob(layout: Layout, u: float, v: float, wide: float, high: float) -> np.ndarray:
    """A soft spot about a place in hm08's coordinates."""
    return np.exp(-(((layout.source_u - u) / wide) ** 2) - ((layout.source_v - v) / high) ** 2)


def _face_masks(layout: Layout) -> dict[str, np.ndarray]:
    """Parts of the face as soft spots; hm08's head lies on its side, forehead to the left, chin to the right."""
    return {
        "forehead": _blob(layout, 0.80, 0.484, 0.030, 0.055),
        "nose": _blob(layout, 0.865, 0.484, 0.020, 0.012) + _blob(layout, 0.886, 0.484, 0.010, 0.018),
        "cheeks": _blob(layout, 0.885, 0.415, 0.025, 0.030) + _blob(layout, 0.885, 0.553, 0.025, 0.030),
        "chin": _blob(layout, 0.945, 0.484, 0.014, 0.022),
        "lids": _pair(layout, 0.828, 0.031, 0.007, 0.017),
        "sockets": _pair(layout, 0.832, 0.020, 0.010, 0.009) + 0.6 * _pair(layout, 0.853, 0.026, 0.006, 0.014),
        "wings": _pair(layout, 0.877, 0.011, 0.005, 0.006) + 0.8 * _blob(layout, 0.926, 0.484, 0.005, 0.014),
        "ears": _pair(layout, 0.838, 0.140, 0.040, 0.018),
    }


def _pair(layout: Layout, u: float, beside: float, wide: float, high: float) -> np.ndarray:
    """Soft spots on both sides of the face's middle."""
    return _blob(layout, u, 0.484 - beside, wide, high) + _blob(layout, u, 0.484 + beside, wide, high)


def read_picture(path: Path) -> np.ndarray:
    """(H, W, 3) or, where the file has alpha, (H, W, 4)."""
    image = Image.open(path)
    return np.asarray(image.convert("RGBA" if "A" in image.getbands() else "RGB"), dtype=np.float64) / 255.0


def skin_colour(name: str, painted: np.ndarray, layout: Layout, masks: dict[str, np.ndarray]) -> Texture:
    """The base colour: a painted skin with blotches, redness and pores, its face SKIN_MEAN_LINEAR on average.

    A colour of skin divided by that mean tints it.

    Parameters
    ----------
    painted : (H, W, 3) one of MakeHuman's skins over hm08's coordinates.
    masks : the base mesh's masks ("lips", "fingernails") over hm08's coordinates.
    """
    colour = to_linear(np.clip(layout.picture(painted), 0.0, 1.0))
    face = _face_masks(layout)
    middle = face["cheeks"] + 0.5 * face["forehead"]
    mean = (colour * middle[..., None]).sum(axis=(0, 1)) / middle.sum()
    colour *= SKIN_MEAN_LINEAR / mean
    for number in PAINTED_PALER:
        # In the paintings hands are paler and bluer than faces.
        own = layout.part == number
        if own.any():
            colour[own] *= (SKIN_MEAN_LINEAR / colour[own].mean(axis=0)) ** PALER_UNDONE
    colour = np.where(
        colour > KNEE_LINEAR, 1 - (1 - KNEE_LINEAR) * np.exp((KNEE_LINEAR - colour) / (1 - KNEE_LINEAR)), colour
    )
    lips = np.clip(layout.picture(masks["lips"]), 0.0, 1.0)
    nails = np.clip(layout.picture(masks["fingernails"]), 0.0, 1.0)
    skin = 1.0 - np.clip(lips + nails, 0.0, 1.0)
    blotches = 0.6 * noise(SKIN_PX, 14, 60, 3) + 0.4 * noise(SKIN_PX, 4, 16, 4)
    redness = 0.018 * blotches + sum(share * face[place] for place, share in REDDER.items())
    colour *= 1.0 + redness[..., None] * np.array([0.25, -1.0, -0.9])
    # Folds get little light and blood shows there; few programs shade them so finely.
    folds = sum(share * face[place] for place, share in DARKER.items())
    colour *= 1.0 - folds[..., None] * np.array([0.85, 1.0, 1.0])
    pores = np.maximum(0.0, noise(SKIN_PX, 1.2, 3.5, 5))
    freckles = np.maximum(0.0, noise(SKIN_PX, 2.5, 6, 6) - 2.2)
    colour *= 1.0 - skin[..., None] * (0.035 * pores[..., None] + 0.10 * freckles[..., None] * np.array([0.6, 1, 1.2]))
    # Lips have fine lines across; nails are paler.
    colour *= 1.0 - lips[..., None] * LIPS_REDDER
    colour *= 1.0 + lips[..., None] * 0.05 * noise(SKIN_PX, 1.2, 5, 7)[..., None]
    pale = SKIN_MEAN_LINEAR * np.array([1.2, 1.0, 0.95])
    colour = colour * (1 - 0.35 * nails[..., None]) + 0.35 * nails[..., None] * pale
    return jpeg(name, spread(to_srgb(colour), layout.inside))


def skin_roughness(name: str, layout: Layout, masks: dict[str, np.ndarray]) -> Texture:
    """Occlusion (none), roughness and metal (none): brow, nose and lips shine a little more than cheeks and hands."""
    face = _face_masks(layout)
    lips = np.clip(layout.picture(masks["lips"]), 0.0, 1.0)
    nails = np.clip(layout.picture(masks["fingernails"]), 0.0, 1.0)
    mouth = np.clip(layout.picture(masks["inside-mouth"]), 0.0, 1.0)
    rough = 0.64 - 0.08 * face["forehead"] - 0.13 * face["nose"] - 0.05 * face["chin"] + 0.03 * noise(SKIN_PX, 3, 24, 8)
    for part, value in ((lips, 0.38), (nails, 0.30), (mouth, 0.35)):
        rough = rough * (1 - part) + value * part
    filled = spread(rough, layout.inside)
    small = gaussian_filter(filled, 0.7)[:: SKIN_PX // ORM_PX, :: SKIN_PX // ORM_PX]
    return jpeg(name, np.stack([np.ones_like(small), small, np.zeros_like(small)], axis=-1))


def pores(name: str) -> Texture:
    """Normals of a tile of skin: furrows between fine plates, and pores where they meet."""
    near, following = cells(PORES_PX, 8.0, 11)
    furrows = np.exp(-(((following - near) / 1.3) ** 2))
    holes = np.exp(-((cells(PORES_PX, 15.0, 12)[0] / 1.6) ** 2))
    heights = -0.55 * furrows - 0.8 * holes + 0.12 * noise(PORES_PX, 2, 10, 13)
    return png(name, normals_of(gaussian_filter(heights, 0.6, mode="wrap"), 0.55))
