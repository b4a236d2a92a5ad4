"""The one atlas of all outfits: neutral colour, normals, and occlusion with roughness, from MakeHuman's pictures.

Every picture shows shade and structure only (seams, folds, weave), 0.80 on average: a colour divided by that mean
tints it. So all outfits share three files, whatever their colours.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from character_textures import Texture, jpeg, noise, normals_of, to_linear, to_srgb
from PIL import Image
from scipy.ndimage import gaussian_filter

ATLAS_PX = 2048
CLOTH_MEAN_LINEAR = 0.80
PLAIN_ROUGHNESS = 0.86
STEP_PX = 8.0
"""Width in pixels up to which differences in a source's picture are structure; wider ones are its dye."""
LINEN = 0.25
"""Linear brightness above which cloth is linen."""


@dataclass(frozen=True)
class Patch:
    """A source's picture in the atlas: `box` (left, top, right, bottom) of its 512 pixels, put at `corner` (left, top)
    of the atlas, `scale` times as large. From a print only folds are used: it has no `structure`.
    A `tone` below 1 is for what stays darker than the rest of its material: grey trousers beside a white shirt.
    """

    folder: str
    box: tuple[int, int, int, int]
    corner: tuple[int, int]
    scale: int = 2
    structure: bool = True
    tone: float = 1.0
    source_px: int = 512

    def uvs(self, uvs: np.ndarray) -> np.ndarray:
        """Texture coordinates (N, 2), origin at the lower left, in the atlas."""
        x = (uvs[:, 0] * self.source_px - self.box[0]) * self.scale + self.corner[0]
        y = ((1.0 - uvs[:, 1]) * self.source_px - self.box[1]) * self.scale + self.corner[1]
        return np.stack([x, ATLAS_PX - y], axis=1) / ATLAS_PX

    def slices(self) -> tuple[slice, slice]:
        """Rows and columns of the atlas."""
        left, top = self.corner
        width, height = (self.box[2] - self.box[0]) * self.scale, (self.box[3] - self.box[1]) * self.scale
        return slice(top, top + height), slice(left, left + width)


PATCHES = {
    "suit": Patch("male_elegantsuit01", (0, 0, 512, 512), (0, 0)),
    "blouse": Patch("female_elegantsuit01", (0, 0, 512, 512), (1024, 0), structure=False),
    "shirt": Patch("male_casualsuit03", (0, 0, 512, 512), (1032, 8), scale=1, structure=False),
    "dark_trousers": Patch("male_elegantsuit01", (0, 240, 384, 512), (1280, 1024), tone=0.10),
    "tee": Patch("male_casualsuit06", (0, 0, 512, 216), (0, 1024), structure=False),
}
PLAIN = (0, 1456, 1024, 2048)
"""Part of the atlas (left, top, right, bottom) of plain cloth with soft folds, for garments of our own."""
CHECK = (1024, 1568, 2048, 2048)
"""Part of the atlas of checked cloth."""
GOLD = (1024, 1024, 1280, 1280)
"""Part of the atlas of smooth shining metal and braid."""
PLAIN_M = (2.0, 1.156)
"""Width and height in metres that `PLAIN` covers."""


def plain_uvs(across_m: np.ndarray, up_m: np.ndarray) -> np.ndarray:
    """Coordinates (N, 2) on plain cloth of positions in metres; they wrap around at the edges."""
    left, top, right, bottom = PLAIN
    margin = 8
    wide, high = right - left - 2 * margin, bottom - top - 2 * margin

    def folded(share: np.ndarray) -> np.ndarray:
        share = np.abs(share) % 2.0
        return np.where(share > 1.0, 2.0 - share, share)

    x = left + margin + folded(across_m / PLAIN_M[0] + 0.5) * wide
    y = bottom - margin - folded(up_m / PLAIN_M[1]) * high
    return np.stack([x / ATLAS_PX, 1.0 - y / ATLAS_PX], axis=1)


def spot_uvs(box: tuple[int, int, int, int], shares: np.ndarray) -> np.ndarray:
    """Coordinates (N, 2) in a part of the atlas from shares (N, 2) of its width and height."""
    left, top, right, bottom = box
    x = left + 6 + np.clip(shares[:, 0], 0.0, 1.0) * (right - left - 12)
    y = bottom - 6 - np.clip(shares[:, 1], 0.0, 1.0) * (bottom - top - 12)
    return np.stack([x / ATLAS_PX, 1.0 - y / ATLAS_PX], axis=1)


def _picture(path: Path, patch: Patch) -> np.ndarray | None:
    """A picture (H, W, 3) as large as in the atlas; None where there is no such file."""
    if not path.is_file():
        return None
    image = Image.open(path).convert("RGB").crop(patch.box)
    width, height = image.width * patch.scale, image.height * patch.scale
    return np.asarray(image.resize((width, height), Image.Resampling.BICUBIC), dtype=np.float64) / 255.0


def _structure(colour: np.ndarray) -> np.ndarray:
    """Brightness of a picture over that of its surroundings, about 1: its seams and shade without its dyes."""
    brightness = to_linear(colour).mean(axis=2) + 0.01
    ratio = np.ones_like(brightness)
    # White linen beside dark cloth is no structure: each is measured against its like.
    for own in (brightness > LINEN, brightness <= LINEN):
        mean = gaussian_filter(brightness * own, STEP_PX) / np.maximum(gaussian_filter(own * 1.0, STEP_PX), 1e-3)
        ratio[own] = (brightness / np.maximum(mean, 1e-3))[own]
    return np.clip(ratio, 0.45, 1.25)


def _check(rows: int, columns: int) -> np.ndarray:
    """A check (rows, columns) of dark grey with lighter and darker bands, 96 pixels wide."""

    def bands(count: int) -> np.ndarray:
        place = np.arange(count) % 96
        broad = np.where(place < 34, 0.55, 1.0)
        return np.where((place > 60) & (place < 66), 2.4, broad)

    return 0.12 * np.sqrt(bands(rows)[:, None] * bands(columns)[None, :])


def _weave(size: int) -> np.ndarray:
    """Fine twill (size, size), mean 0, deviation 1."""
    return noise(size, 1.2, 6.0, 71) + 0.6 * noise(size, 6.0, 60.0, 72)


@dataclass(frozen=True)
class Layers:
    """Pictures of the atlas: linear grey and occlusion (N, N), heights (N, N), normals (N, N, 3), roughness."""

    grey: np.ndarray
    occlusion: np.ndarray
    heights: np.ndarray
    bent: np.ndarray
    roughness: np.ndarray


def _laid(assets: Path) -> Layers:
    size = (ATLAS_PX, ATLAS_PX)
    grey, occlusion, heights = np.ones(size), np.ones(size), np.zeros(size)
    bent, roughness = np.zeros((*size, 2)), np.full(size, PLAIN_ROUGHNESS)
    for patch in PATCHES.values():
        rows, columns = patch.slices()
        stem = assets / "clothes" / patch.folder / patch.folder
        colour = _picture(Path(f"{stem}_diffuse.png"), patch)
        if colour is None:
            raise FileNotFoundError(f"{stem}_diffuse.png")
        structure = _structure(colour) if patch.structure else np.ones(colour.shape[:2])
        grey[rows, columns] = structure * patch.tone
        heights[rows, columns] = 0.5 * (gaussian_filter(structure, 1.0) - 1.0)
        shade = _picture(Path(f"{stem}_ao.png"), patch)
        if shade is not None:
            occlusion[rows, columns] = 0.35 + 0.65 * shade.mean(axis=2)
        normals = _picture(Path(f"{stem}_normal.png"), patch)
        if normals is not None:
            bent[rows, columns] = normals[:, :, :2] * 2.0 - 1.0
    left, top, right, bottom = PLAIN
    folds = noise(1024, 40.0, 300.0, 73)[: bottom - top, : right - left]
    heights[top:bottom, left:right] += 0.10 * gaussian_filter(folds, 6.0)
    left, top, right, bottom = CHECK
    grey[top:bottom, left:right] = _check(bottom - top, right - left)
    left, top, right, bottom = GOLD
    roughness[top:bottom, left:right] = 0.38
    return Layers(grey, occlusion, heights, bent, roughness)


def write_atlas(assets: Path, folder: Path) -> None:
    """Write the three pictures into a folder."""
    layers = _laid(assets)
    weave = _weave(ATLAS_PX)
    grey = CLOTH_MEAN_LINEAR * layers.grey * (0.75 + 0.25 * layers.occlusion) * (1.0 + 0.012 * weave)
    normals = normals_of(layers.heights + 0.012 * weave, 2.2) * 2.0 - 1.0
    normals[:, :, :2] += layers.bent
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    rough = np.clip(layers.roughness + 0.02 * weave, 0.2, 1.0)
    orm = np.stack([layers.occlusion, rough, np.zeros_like(rough)], axis=2)
    pictures = {
        "color": (np.repeat(to_srgb(grey)[:, :, None], 3, axis=2), 72),
        "normal": (normals * 0.5 + 0.5, 76),
        "orm": (orm[::2, ::2], 62),
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, (picture, quality) in pictures.items():
        (folder / f"cloth_{name}.jpg").write_bytes(jpeg(f"cloth_{name}", picture, quality).content)


def atlas_textures(folder: Path, beside: str = "") -> tuple[Texture, Texture, Texture]:
    """Colour, normals, and occlusion with roughness, from a folder; files name them by their place `beside` them."""
    colour, normal, orm = (
        Texture(f"cloth_{name}", (folder / f"cloth_{name}.jpg").read_bytes(), f"{beside}cloth_{name}.jpg")
        for name in ("color", "normal", "orm")
    )
    return colour, normal, orm
