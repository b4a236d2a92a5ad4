"""Conversion of materials of a glTF file to scene materials with textures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from app.formats.gltf.model import GltfMaterial, GltfModel, GltfTextureUse
from app.formats.images import ImageReader
from app.formats.scene import Material
from app.formats.textures import AlphaMode, MaterialTextures, TextureUse

_ALPHA_MODES: Final[Mapping[str, AlphaMode]] = {"MASK": "mask", "BLEND": "blend"}


def scene_materials(model: GltfModel, *, own: bool) -> tuple[Material, ...]:
    """Return the materials of a file, with those of their textures that can be read.

    Parameters
    ----------
    own : bool
        Whether this program wrote the file, so that its images need not be checked.
    """
    contents = {id(image.content): len(image.content) for image in model.images}
    images = ImageReader(sum(contents.values()), own)
    return tuple(_material(model, surface, images) for surface in model.materials)


def _material(model: GltfModel, surface: GltfMaterial, images: ImageReader) -> Material:
    def used(use: GltfTextureUse | None, role: str) -> TextureUse | None:
        if use is None:
            return None
        image = model.images[use.image]
        texture = images.texture(image.name or f"{surface.name}_{role}", image.content)
        return None if texture is None else TextureUse(texture, use.scale, use.offset)

    red, green, blue, alpha = surface.base_color_rgba
    mode = _ALPHA_MODES.get(surface.alpha_mode)
    return Material(
        surface.name,
        (red, green, blue, 1.0 if mode is None else alpha),
        surface.metallic,
        surface.roughness,
        surface.double_sided,
        MaterialTextures(
            used(surface.color, "color"),
            used(surface.normal, "normal"),
            used(surface.metallic_roughness, "roughness"),
            used(surface.occlusion, "occlusion"),
            surface.normal_scale,
            surface.occlusion_strength,
        ),
        # A translucent colour is blended anyway.
        None if mode == "blend" and alpha < 1.0 else mode,
        surface.alpha_cutoff,
    )
