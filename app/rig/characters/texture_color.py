"""The colour of a textured surface, where textures are not shown: the mean of its texture where vertices lie on it."""

from __future__ import annotations

import io
import warnings
from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.formats.gltf.model import GltfModel, GltfPrimitive
from app.formats.scene import Material

SAMPLED_PX: Final = 256
"""Textures are made so small first: a mean needs no more."""
FREE_PX: Final = 2**24
PX_PER_BYTE: Final = 64
"""Most pixels that are looked at, and most for each byte of the images: a few bytes can be any number."""
MOST_SCANS: Final = 64
"""A JPEG is read once for each of its scans, of which real ones have about ten."""
_SCAN: Final = b"\xff\xda"
OPAQUE: Final = 0.5
"""Least opacity that has a colour; what lets more light through is cut out."""


class Textures:
    """The images of a file, each looked at once: many surfaces share one."""

    def __init__(self, gltf: GltfModel) -> None:
        self._images = gltf.images
        unique = {id(image): len(image) for image in gltf.images}
        self._left_px = FREE_PX + PX_PER_BYTE * sum(unique.values())
        self._seen: dict[int, FloatArray | None] = {}

    def pixels(self, number: int) -> FloatArray | None:
        """An image as (H, W, 4) values 0..1, made small; None where it is none, or too large."""
        image = self._images[number]
        if id(image) not in self._seen:
            self._seen[id(image)] = self._opened(image)
        return self._seen[id(image)]

    def _opened(self, image: bytes) -> FloatArray | None:
        from PIL import Image  # heavy; few figures have textures

        unreadable = (
            *(OSError, ValueError, SyntaxError, EOFError),
            *(Image.DecompressionBombError, Image.DecompressionBombWarning),
        )
        if image.startswith(b"\xff\xd8") and image.count(_SCAN) > MOST_SCANS:
            return None
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", Image.DecompressionBombWarning)
                with Image.open(io.BytesIO(image), formats=("PNG", "JPEG", "WEBP")) as opened:
                    self._left_px -= opened.width * opened.height
                    if self._left_px < 0:
                        return None
                    opened.draft("RGB", (SAMPLED_PX, SAMPLED_PX))
                    small = opened.convert("RGBA")
        except unreadable:
            return None
        small.thumbnail((SAMPLED_PX, SAMPLED_PX), Image.Resampling.BOX)
        return np.asarray(small, dtype=np.float64) / 255.0


def coloured(
    materials: tuple[Material, ...], primitives: tuple[GltfPrimitive, ...], gltf: GltfModel, textures: Textures
) -> tuple[Material, ...]:
    """Materials of a mesh's primitives with the mean colours of their textures; one that cannot be read has none."""
    return tuple(
        _coloured(material, primitive, gltf, textures)
        for material, primitive in zip(materials, primitives, strict=True)
    )


def _coloured(material: Material, primitive: GltfPrimitive, gltf: GltfModel, textures: Textures) -> Material:
    if primitive.material is None or primitive.uvs is None or not len(primitive.triangles):
        return material
    number = gltf.materials[primitive.material].color_image
    if number is None:
        return material
    pixels = textures.pixels(number)
    if pixels is None:
        return material
    height, width = pixels.shape[:2]
    places = primitive.uvs[np.unique(primitive.triangles)] % 1.0
    rows = np.minimum((places[:, 1] * height).astype(np.intp), height - 1)
    columns = np.minimum((places[:, 0] * width).astype(np.intp), width - 1)
    found = pixels[rows, columns]
    found = found[found[:, 3] > OPAQUE]
    if not len(found):
        return material
    red, green, blue = (_linear(found[:, :3]).mean(axis=0) * material.base_color[:3]).tolist()
    return replace(material, base_color=(red, green, blue, material.base_color[3]))


def _linear(srgb: FloatArray) -> FloatArray:
    """Linear values of sRGB ones (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
