"""Pictures of a character's materials: noise that tiles, normals of heights, and the same bytes on every run.

Pictures are arrays (H, W, C) in 0..1 with the first row at the top; colours are sRGB unless a name ends in `_linear`.
"""

from __future__ import annotations

import io
from dataclasses import dataclass

import numpy as np
from PIL import Image
from scipy.ndimage import distance_transform_edt, map_coordinates
from scipy.spatial import cKDTree

JPEG_QUALITY = 88


@dataclass(frozen=True)
class Texture:
    """A stored picture: its name becomes that of the file, its content is PNG or JPEG. With a `uri` it is a separate
    file.

    With a `uri` it lies beside the files that use it, and is in none of them.
    """

    name: str
    content: bytes
    uri: str = ""

    @property
    def mime_type(self) -> str:
        return "image/png" if self.content.startswith(b"\x89PNG") else "image/jpeg"


def png(name: str, picture: np.ndarray) -> Texture:
    stream = io.BytesIO()
    _image(picture).save(stream, "PNG", optimize=True)
    return Texture(name, stream.getvalue())


def jpeg(name: str, picture: np.ndarray, quality: int = JPEG_QUALITY) -> Texture:
    stream = io.BytesIO()
    _image(picture).save(stream, "JPEG", quality=quality, optimize=True, subsampling=0)
    return Texture(name, stream.getvalue())


def _image(picture: np.ndarray) -> Image.Image:
    return Image.fromarray(np.round(np.clip(picture, 0.0, 1.0) * 255.0).astype(np.uint8))


def to_linear(srgb: np.ndarray) -> np.ndarray:
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def to_srgb(linear: np.ndarray) -> np.ndarray:
    clipped = np.clip(linear, 0.0, 1.0)
    return np.where(clipped <= 0.0031308, clipped * 12.92, 1.055 * clipped ** (1 / 2.4) - 0.055)


def sampled(picture: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """A picture's values at texture coordinates (origin at the lower left), by cubic interpolation; edges repeat."""
    height, width = picture.shape[:2]
    rows, columns = (1.0 - v) * height - 0.5, u * width - 0.5
    flat = picture.reshape(height, width, -1)
    layers = [
        map_coordinates(flat[:, :, layer], [rows, columns], order=3, mode="nearest") for layer in range(flat.shape[2])
    ]
    return np.stack(layers, axis=-1).reshape(*np.shape(u), *picture.shape[2:])


def spread(picture: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Picture with every pixel outside a mask set to the nearest value inside, so that no edge is visible."""
    rows, columns = distance_transform_edt(~inside, return_distances=False, return_indices=True)
    return picture[rows, columns]


def noise(size: int, finest_px: float, coarsest_px: float, seed: int) -> np.ndarray:
    """(size, size) noise that tiles, of waves between two lengths, with mean 0 and deviation 1."""
    white = np.random.Generator(np.random.PCG64(seed)).normal(0.0, 1.0, (size, size))
    y, x = np.meshgrid(np.fft.fftfreq(size), np.fft.fftfreq(size), indexing="ij")
    frequency = np.hypot(x, y)
    band = np.exp(-((frequency * finest_px) ** 2)) * (1.0 - np.exp(-((frequency * coarsest_px) ** 2)))
    waves = np.fft.ifft2(np.fft.fft2(white) * band).real
    return (waves - waves.mean()) / waves.std()


def cells(size: int, spacing_px: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Distances in pixels to the nearest and to the next of points strewn over a tile, (size, size) each."""
    rng = np.random.Generator(np.random.PCG64(seed))
    side = max(2, round(size / spacing_px))
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side), indexing="ij"), axis=-1).reshape(-1, 2)
    points = (grid + 0.5 + rng.uniform(-0.45, 0.45, grid.shape)) * (size / side) % size
    pixels = np.stack(np.meshgrid(np.arange(size), np.arange(size), indexing="ij"), axis=-1) + 0.5
    distances = cKDTree(points, boxsize=size).query(pixels.reshape(-1, 2), k=2)[0]
    return distances[:, 0].reshape(size, size), distances[:, 1].reshape(size, size)


def normals_of(heights: np.ndarray, strength: float) -> np.ndarray:
    """(H, W, 3) tangent-space normals (green up) of a tiling height field; `strength` is slope per unit of height."""
    right = (np.roll(heights, -1, axis=1) - np.roll(heights, 1, axis=1)) * 0.5 * strength
    down = (np.roll(heights, -1, axis=0) - np.roll(heights, 1, axis=0)) * 0.5 * strength
    vectors = np.stack([-right, down, np.ones_like(heights)], axis=-1)
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True) * 0.5 + 0.5
