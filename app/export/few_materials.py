"""Characters with few materials: small surfaces share one texture, and cards of hair, brows and lashes another.

Every material of a mesh is a draw call of the graphics card, and a slot to be set up in other programs. A material with
only a colour becomes a small square of that colour in the shared texture; a material with a texture is copied beside
it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Final

import numpy as np

from app.formats.images import montage, size_px, tinted
from app.formats.scene import Material
from app.formats.texture_colors import encoded_color
from app.formats.textures import MaterialTextures, Texture, TextureUse
from app.rig.mesh import Mesh
from app.rig.model import Character

SPOT_PX: Final = 32
"""Side in pixels of the area for a plain colour."""
MOST_PX: Final = 4096
COARSER: Final = 8
"""Factor by which maps of roughness are smaller than those of colours, since roughness is constant on a surface."""
_FLAT: Final = (128, 128, 255)

Place = tuple[int, int, int, int]


@dataclass(frozen=True)
class _Sheet:
    """A shared material, and the rectangle (left, top, width, height; shares of the sides) of each replaced material in
    its texture.
    """

    material: Material
    places: Mapping[Material, tuple[float, float, float, float]]


@lru_cache(maxsize=32)
def with_few_materials(character: Character) -> Character:
    """Return a character whose small surfaces share a material; a character from the user's file is returned
    unchanged.
    """
    if character.own is not None:
        return character
    materials = tuple(dict.fromkeys(one for mesh in character.meshes for one in mesh.materials))
    sheets = [
        make(tuple(group))
        for make, group in ((_details, [*filter(_is_small, materials)]), (_cards, [*filter(_is_card, materials)]))
        if len(group) > 1
    ]
    places = {old: (sheet.material, place) for sheet in sheets for old, place in sheet.places.items()}
    return replace(character, meshes=tuple(_placed(mesh, places) for mesh in character.meshes))


def _is_small(material: Material) -> bool:
    """Return whether a material is opaque and has at most a colour texture, which does not repeat."""
    textures = material.textures
    alone = textures.normal is None and textures.metallic_roughness is None and textures.occlusion is None
    return alone and material.alpha_mode == "opaque" and _is_once(textures.color)


def _is_card(material: Material) -> bool:
    """Return whether a material is a cut-out (such as a card of hair) whose texture does not repeat."""
    textures = material.textures
    plain = textures.metallic_roughness is None and textures.occlusion is None
    return plain and material.alpha_mode == "mask" and textures.color is not None and _is_once(textures.color)


def _is_once(use: TextureUse | None) -> bool:
    return use is None or (use.scale == (1.0, 1.0) and use.offset == (0.0, 0.0))


@lru_cache(maxsize=32)
def _details(materials: tuple[Material, ...]) -> _Sheet:
    """Return one material for all given opaque ones, whose textures hold their colours, roughness and metallic."""
    pictures = [None if one.textures.color is None else one.textures.color.texture for one in materials]
    places, size = _packed([(SPOT_PX, SPOT_PX) if one is None else size_px(one) for one in pictures])
    colors: list[tuple[Texture | tuple[int, int, int], Place]] = []
    surfaces: list[tuple[Texture | tuple[int, int, int], Place]] = []
    for material, picture, place in zip(materials, pictures, places, strict=True):
        red, green, blue = material.base_color[:3]
        colors.append(
            (encoded_color((red, green, blue)) if picture is None else tinted(picture, (red, green, blue), True), place)
        )
        surface = (255, round(255.0 * material.roughness), round(255.0 * material.metallic))
        left, top, width, height = (side // COARSER for side in place)
        surfaces.append((surface, (left, top, width, height)))
    made = Material(
        name="details",
        base_color=(1.0, 1.0, 1.0, 1.0),
        metallic=1.0,
        roughness=1.0,
        double_sided=any(one.double_sided for one in materials),
        textures=MaterialTextures(
            color=TextureUse(montage("details_color", colors, size, (0, 0, 0), exact=False)),
            metallic_roughness=TextureUse(
                montage("details_orm", surfaces, (size[0] // COARSER, size[1] // COARSER), (255, 255, 0))
            ),
        ),
    )
    return _Sheet(made, _shares(materials, pictures, places, size))


@lru_cache(maxsize=32)
def _cards(materials: tuple[Material, ...]) -> _Sheet:
    """Return one material for all given cut-out ones. Its base colour is the brightest of theirs; darker ones are
    darkened in the texture.
    """
    pictures = [one.textures.color.texture for one in materials if one.textures.color is not None]
    places, size = _packed([size_px(one) for one in pictures])
    brightest = tuple(max(max(one.base_color[part] for one in materials), 1e-4) for part in range(3))
    colors = []
    for material, picture, place in zip(materials, pictures, places, strict=True):
        red, green, blue = (min(1.0, material.base_color[part] / brightest[part]) for part in range(3))
        colors.append((tinted(picture, (red, green, blue), False), place))
    normals = [
        (one.textures.normal.texture, (left // 2, top // 2, width // 2, height // 2))
        for one, (left, top, width, height) in zip(materials, places, strict=True)
        if one.textures.normal is not None
    ]
    bumpy = next((one for one in materials if one.textures.normal is not None), materials[0])
    normal = montage("hair_normal", normals, (size[0] // 2, size[1] // 2), _FLAT, exact=False) if normals else None
    made = replace(
        bumpy,
        name="hair",
        base_color=(brightest[0], brightest[1], brightest[2], 1.0),
        double_sided=any(one.double_sided for one in materials),
        textures=replace(
            bumpy.textures,
            color=TextureUse(montage("hair_color", colors, size, (0, 0, 0, 0))),
            normal=None if normal is None else TextureUse(normal),
        ),
    )
    return _Sheet(made, _shares(materials, pictures, places, size))


def _packed(sizes: Sequence[tuple[int, int]]) -> tuple[list[Place], tuple[int, int]]:
    """Return the rectangles of images packed in rows, the highest first, and the size of the whole, a power of two in
    both directions.
    """
    order = sorted(range(len(sizes)), key=lambda index: (-sizes[index][1], -sizes[index][0], index))
    best: tuple[list[Place], tuple[int, int]] | None = None
    width = _power(max(width for width, _ in sizes))
    while width <= MOST_PX or best is None:
        places: dict[int, Place] = {}
        left = top = row = 0
        for index in order:
            own_width, own_height = sizes[index]
            if left + own_width > width:
                left, top, row = 0, top + row, 0
            places[index] = (left, top, own_width, own_height)
            left, row = left + own_width, max(row, own_height)
        found = [places[index] for index in range(len(sizes))], (width, _power(top + row))
        if best is None or found[1][0] * found[1][1] < best[1][0] * best[1][1]:
            best = found
        width *= 2
    return best


def _power(number: int) -> int:
    return 1 << max(number - 1, 0).bit_length()


def _shares(
    materials: Sequence[Material],
    pictures: Sequence[Texture | None],
    places: Sequence[Place],
    size: tuple[int, int],
) -> dict[Material, tuple[float, float, float, float]]:
    """Return left, top, width and height of each material in the shared texture as shares 0..1; a material without a
    texture becomes a point (width and height 0).
    """
    found = {}
    for material, picture, (left, top, width, height) in zip(materials, pictures, places, strict=True):
        if picture is None:
            left, top, width, height = left + width // 2, top + height // 2, 0, 0
        found[material] = (left / size[0], top / size[1], width / size[0], height / size[1])
    return found


def _placed(mesh: Mesh, places: Mapping[Material, tuple[Material, tuple[float, float, float, float]]]) -> Mesh:
    """Return a mesh with its materials replaced by shared ones, and its UVs moved into their textures."""
    if not any(material in places for material in mesh.materials) or _is_seamless(mesh):
        return mesh
    uvs = mesh.uvs.astype(np.float64)
    for number, material in enumerate(mesh.materials):
        if material in places:
            left, top, width, height = places[material][1]
            rows = np.unique(mesh.triangles[mesh.triangle_materials == number])
            uvs[rows] = np.clip(uvs[rows], 0.0, 1.0) * (width, height) + (left, top)
    shared = [places[material][0] if material in places else material for material in mesh.materials]
    kept = tuple(dict.fromkeys(shared))
    table = np.array([kept.index(material) for material in shared], np.int32)
    return replace(mesh, uvs=uvs.astype(np.float32), materials=kept, triangle_materials=table[mesh.triangle_materials])


def _is_seamless(mesh: Mesh) -> bool:
    """Return whether materials of a mesh share vertices, whose UVs cannot be in two places of a texture."""
    used = [np.unique(mesh.triangles[mesh.triangle_materials == one]) for one in range(len(mesh.materials))]
    return sum(map(len, used)) > len(np.unique(mesh.triangles))
