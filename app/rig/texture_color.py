"""The colour of a textured surface, where textures are not shown: the mean of its texture where vertices lie on it."""

from __future__ import annotations

import io
import warnings
from dataclasses import replace
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from PIL import Image

from app.formats.gltf import GltfModel, GltfPrimitive
from app.formats.scene import Material

FloatArray = npt.NDArray[np.float64]

SAMPLED_PX: Final = 256
"""Textures are made so small first: a mean needs no more."""
MOST_PX: Final = 8192
"""A texture larger than this on a side is left alone."""
OPAQUE: Final = 0.5
"""What lets more light through than it keeps is cut out and has no colour."""


Seen: TypeAlias = dict[int, "FloatArray | None"]
"""Images that have been looked at, by number: many surfaces share one."""


def coloured(
    materials: tuple[Material, ...], primitives: tuple[GltfPrimitive, ...], gltf: GltfModel, seen: Seen
) -> tuple[Material, ...]:
    """Materials of a mesh's primitives with the mean colours of their textures; one that cannot be read has none."""
    return tuple(
        _coloured(material, primitive, gltf, seen) for material, primitive in zip(materials, primitives, strict=True)
    )


def _coloured(material: Material, primitive: GltfPrimitive, gltf: GltfModel, seen: Seen) -> Material:
    if primitive.material is None or primitive.uvs is None or not len(primitive.triangles):
        return material
    number = gltf.materials[primitive.material].color_image
    if number is None:
        return material
    if number not in seen:
        seen[number] = _pixels(gltf.images[number])
    pixels = seen[number]
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


def _pixels(image: bytes) -> FloatArray | None:
    """An image as (H, W, 4) values 0..1, made small; None where it is none, or too large."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(io.BytesIO(image), formats=("PNG", "JPEG", "WEBP")) as opened:
                if max(opened.size) > MOST_PX:
                    return None
                opened.draft("RGB", (SAMPLED_PX, SAMPLED_PX))
                small = opened.convert("RGBA")
    except (OSError, ValueError, SyntaxError, EOFError, Image.DecompressionBombError, Image.DecompressionBombWarning):
        return None
    small.thumbnail((SAMPLED_PX, SAMPLED_PX), Image.Resampling.BOX)
    return np.asarray(small, dtype=np.float64) / 255.0


def _linear(srgb: FloatArray) -> FloatArray:
    """Linear values of sRGB ones (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
