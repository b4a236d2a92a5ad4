"""Colours of textured surfaces at points and on average, for uses without textures."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.formats.images import Pixels, resized, small
from app.formats.scene import Material, Scene, SkinnedMesh
from app.formats.textures import NO_TEXTURES, TextureUse

OPAQUE: Final = 0.5
"""Least opacity of a pixel whose colour counts; more transparent ones are treated as cut out."""


def sampled(use: TextureUse, uvs: AnyFloatArray) -> FloatArray | None:
    """Return texture values (N, 4), 0..1, at texture coordinates (N, 2), v down; None if the texture cannot be read."""
    found = _sampled(use, uvs)
    return None if found is None else found.astype(np.float64) / 255.0


def _sampled(use: TextureUse, uvs: AnyFloatArray) -> Pixels | None:
    """Return the values of `sampled` as they are in the picture, 0..255."""
    pixels = small(use.texture)
    if pixels is None:
        return None
    height, width = pixels.shape[:2]
    places = np.asarray(uvs, np.float64) * use.scale + use.offset
    if len(places) and (places.min() < 0.0 or places.max() > 1.0):
        # A coordinate of exactly 1 is the end of the picture and does not wrap to its beginning.
        places = np.where((places < 0.0) | (places > 1.0), places % 1.0, places)
    rows = np.minimum((places[:, 1] * height).astype(np.intp), height - 1)
    columns = np.minimum((places[:, 0] * width).astype(np.intp), width - 1)
    found: Pixels = pixels.reshape(-1, 4).take(rows * width + columns, axis=0)
    return found


def linear(srgb: FloatArray) -> FloatArray:
    """Convert sRGB values 0..1 of any shape to linear ones (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


_LINEAR: Final = linear(np.arange(256) / 255.0)
"""Linear value of each sRGB value 0..255."""


def encoded_color(linear_color: tuple[float, float, float]) -> tuple[int, int, int]:
    """Return the sRGB numbers, 0 to 255, of a linear colour (IEC 61966-2-1)."""
    part = np.clip(np.array(linear_color), 0.0, 1.0)
    shown = np.where(part <= 0.0031308, 12.92 * part, 1.055 * part ** (1.0 / 2.4) - 0.055)
    red, green, blue = np.round(255.0 * shown).astype(int).tolist()
    return red, green, blue


def plain_material(material: Material, uvs: AnyFloatArray) -> Material:
    """Return the material without textures, with their mean colour and roughness at some texture coordinates, v down.

    The result is neither cut out nor blended.
    """
    if material.textures == NO_TEXTURES:
        return material
    color, roughness, metallic = np.array(material.base_color[:3]), material.roughness, material.metallic
    if material.textures.color is not None and len(uvs):
        found = _sampled(material.textures.color, uvs)
        if found is not None:
            seen = found if material.alpha_mode == "opaque" else found[found[:, 3] > 255.0 * OPAQUE]
            if len(seen):
                color = color * _LINEAR[seen[:, :3]].mean(axis=0)
    if material.textures.metallic_roughness is not None and len(uvs):
        found = _sampled(material.textures.metallic_roughness, uvs)
        if found is not None:
            rough, metal = found[:, 1:3].mean(axis=0) / 255.0
            roughness, metallic = roughness * float(rough), metallic * float(metal)
    red, green, blue = color.tolist()
    alpha = None if material.alpha == "mask" else material.alpha
    return replace(
        material,
        base_color=(red, green, blue, material.base_color[3]),
        roughness=roughness,
        metallic=metallic,
        textures=NO_TEXTURES,
        alpha=alpha,
    )


def with_textures(scene: Scene, most_px: int) -> Scene:
    """Return a scene with its textures scaled down so that no side exceeds ``most_px``; 0 removes them."""
    return replace(scene, meshes=tuple(_with_textures(mesh, most_px) for mesh in scene.meshes))


def _with_textures(mesh: SkinnedMesh, most_px: int) -> SkinnedMesh:
    if not most_px:
        return without_textures(mesh)
    fitted = tuple(replace(one, textures=resized(one.textures, most_px)) for one in mesh.materials)
    return mesh if fitted == mesh.materials else replace(mesh, materials=fitted)


def without_textures(mesh: SkinnedMesh) -> SkinnedMesh:
    """Return a mesh with its materials replaced by plain ones (`plain_material`)."""
    if all(material.textures == NO_TEXTURES for material in mesh.materials):
        return mesh
    owners = np.zeros(len(mesh.faces), np.int64) if mesh.face_materials is None else mesh.face_materials
    uvs = np.zeros((len(mesh.vertices_cm), 2)) if mesh.uvs is None else mesh.uvs
    by_vertex = len(uvs) == len(mesh.vertices_cm)
    corners = np.arange(mesh.faces.size).reshape(mesh.faces.shape)
    plain: dict[Material, int] = {}
    table = []
    for number, material in enumerate(mesh.materials):
        own = owners == number
        places = uvs[np.unique(mesh.faces[own]) if by_vertex else corners[own].ravel()]
        made = plain_material(material, np.stack([places[:, 0], 1.0 - places[:, 1]], axis=1))
        table.append(plain.setdefault(made, len(plain)))
    return replace(mesh, materials=tuple(plain), face_materials=np.array(table)[owners])
