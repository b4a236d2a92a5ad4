"""Writing of the materials of a scene to a glTF document, with embedded textures.

Source: Khronos, "glTF 2.0 Specification", sections 3.8 and 3.9; "KHR_texture_transform".
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

import pygltflib as gltf

from app.formats.gltf.document import GlbDocument
from app.formats.scene import Material
from app.formats.textures import Texture, TextureUse

_TRANSFORM: Final = "KHR_texture_transform"
_MODES: Final = {"opaque": gltf.OPAQUE, "mask": gltf.MASK, "blend": gltf.BLEND}


def add_materials(document: GlbDocument, materials: Iterable[Material]) -> None:
    """Add materials in order, and each of their images once."""
    numbers: dict[Texture, int] = {}
    document.gltf.materials = [_material(document, material, numbers) for material in materials]
    if numbers:
        repeated = gltf.Sampler(
            wrapS=gltf.REPEAT, wrapT=gltf.REPEAT, magFilter=gltf.LINEAR, minFilter=gltf.LINEAR_MIPMAP_LINEAR
        )
        document.gltf.samplers = [repeated]


def _material(document: GlbDocument, material: Material, numbers: dict[Texture, int]) -> gltf.Material:
    textures = material.textures

    def used(use: TextureUse | None, kind: type[Any] = gltf.TextureInfo, **more: float) -> Any:
        if use is None:
            return None
        extensions: dict[str, Any] = {}
        if use.scale != (1.0, 1.0) or use.offset != (0.0, 0.0):
            extensions = {_TRANSFORM: {"scale": list(use.scale), "offset": list(use.offset)}}
            document.use_extension(_TRANSFORM)
        return kind(index=_texture(document, use.texture, numbers), extensions=extensions, **more)

    mode = material.alpha_mode
    return gltf.Material(
        name=material.name,
        pbrMetallicRoughness=gltf.PbrMetallicRoughness(
            baseColorFactor=list(material.base_color),
            metallicFactor=material.metallic,
            roughnessFactor=material.roughness,
            baseColorTexture=used(textures.color),
            metallicRoughnessTexture=used(textures.metallic_roughness),
        ),
        normalTexture=used(textures.normal, gltf.NormalMaterialTexture, scale=textures.normal_scale),
        occlusionTexture=used(textures.occlusion, gltf.OcclusionTextureInfo, strength=textures.occlusion_strength),
        alphaMode=_MODES[mode],
        # The threshold is legal only in mask mode; the library would set it always.
        alphaCutoff=material.alpha_cutoff if mode == "mask" else None,
        doubleSided=material.double_sided,
    )


def _texture(document: GlbDocument, texture: Texture, numbers: dict[Texture, int]) -> int:
    if texture not in numbers:
        numbers[texture] = len(numbers)
        view = document.blob(f"image {texture.digest}", texture.content)
        document.gltf.images.append(gltf.Image(name=texture.name, bufferView=view, mimeType=texture.mime_type))
        document.gltf.textures.append(gltf.Texture(source=numbers[texture], sampler=0))
    return numbers[texture]
