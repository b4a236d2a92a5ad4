"""Writing of the materials of an FBX file, with textures as separate files.

In FBX a texture replaces a property: there are no factors, and no images that hold several values. So colours are
multiplied into the image; roughness, metallic and opacity become separate images, each connected for all programs:

- Blender's importer in Python: DiffuseColor, whose alpha it takes as the opacity of any material, NormalMap with
  BumpFactor, and ReflectionFactor as metal; the older importers of Unreal and three.js take the first two and
  TransparencyFactor as opacity. What Blender takes for roughness (ShininessExponent) is metal in Unreal, so it is not
  named, and the mean roughness stands in the properties.
- ufbx, and with it Blender's newer importer and Godot: the maps of the Physical Material.

A texture at ``scale * uv + offset`` is written as a translation by ``-offset / scale`` before scaling (measured in both
of Blender's importers).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.formats.fbx.assembly import Assembly
from app.formats.fbx.encode import Element
from app.formats.fbx.materials import PHYSICAL_MATERIAL, SHADING_MODEL, phong
from app.formats.fbx.sections import integer, property_block, property_row
from app.formats.images import mean, opacity, scaled_channel, tinted
from app.formats.scene import Material
from app.formats.textures import Texture, TextureUse

_MAPS = "3dsMax|Parameters|"


def material_object(graph: Assembly, material: Material) -> int:
    """Return the id of a material's object, adding it with its textures on first use."""
    if material not in graph.materials:
        maps = fbx_maps(material)
        properties = _properties(_shown(material, maps), material.textures.normal_scale)
        made = graph.materials[material] = graph.add("Material", material.name, "Material", "", properties)
        for role, use in maps.items():
            texture = _texture_object(graph, use)
            for name in _PROPERTIES[role]:
                graph.connect(texture, made, name)
    return graph.materials[material]


_PROPERTIES = {
    "color": ("DiffuseColor", f"{_MAPS}base_color_map"),
    "opacity": ("TransparencyFactor", f"{_MAPS}cutout_map"),
    "normal": ("NormalMap", f"{_MAPS}bump_map"),
    "roughness": (f"{_MAPS}roughness_map",),
    "metallic": ("ReflectionFactor", f"{_MAPS}metalness_map"),
}


def fbx_maps(material: Material) -> dict[str, TextureUse]:
    """Return the textures of a material in the form that FBX needs, by role: ``color``, ``opacity``, ``normal``,
    ``roughness``, ``metallic``.
    """
    textures, maps = material.textures, dict[str, TextureUse]()
    if textures.color is not None:
        solid = material.alpha_mode == "opaque"
        maps["color"] = replace(textures.color, texture=tinted(textures.color.texture, material.base_color[:3], solid))
        if not solid:
            maps["opacity"] = replace(textures.color, texture=opacity(textures.color.texture, material.base_color[3]))
    if textures.normal is not None:
        maps["normal"] = textures.normal
    surface = textures.metallic_roughness
    if surface is not None:
        rough = scaled_channel(surface.texture, "G", "roughness", material.roughness)
        maps["roughness"] = replace(surface, texture=rough)
        if material.metallic > 0.0:
            metal = scaled_channel(surface.texture, "B", "metallic", material.metallic)
            maps["metallic"] = replace(surface, texture=metal)
    return maps


def _shown(material: Material, maps: Mapping[str, TextureUse]) -> Material:
    """Return a material whose plain values suit programs that ignore its textures (roughness and metallic are the
    means), and are neutral for those that use them.
    """
    if "color" in maps:
        material = replace(material, base_color=(1.0, 1.0, 1.0, 1.0))
    if "roughness" in maps:
        material = replace(material, roughness=mean(maps["roughness"].texture))
    if "metallic" in maps:
        material = replace(material, metallic=mean(maps["metallic"].texture))
    return material


def _texture_object(graph: Assembly, use: TextureUse) -> int:
    if use not in graph.textures:
        path = graph.files.path(use.texture)
        name = use.texture.file_name.rpartition(".")[0]
        if use.texture not in graph.videos:
            graph.videos[use.texture] = _video(graph, use.texture, name, path)
        moved = tuple(-offset / scale if scale else 0.0 for offset, scale in zip(use.offset_up, use.scale, strict=True))
        children = (
            Element("Type", ("TextureVideoClip",)),
            integer("Version", 202),
            Element("TextureName", (f"{name}\0\x01Texture",)),
            property_block(
                property_row("UseMaterial", "bool", "", "", np.int32(1)),
                property_row("UseMipMap", "bool", "", "", np.int32(1)),
                property_row("Translation", "Vector", "", "A", *moved, 0.0),
                property_row("Scaling", "Vector", "", "A", *use.scale, 1.0),
            ),
            Element("Media", (f"{name}\0\x01Video",)),
            Element("FileName", (path,)),
            Element("RelativeFilename", (path,)),
            Element("ModelUVTranslation", moved),
            Element("ModelUVScaling", use.scale),
            Element("Texture_Alpha_Source", ("None",)),
            Element("Cropping", (np.int32(0),) * 4),
        )
        graph.textures[use] = graph.add("Texture", name, "Texture", "", children)
        graph.connect(graph.videos[use.texture], graph.textures[use])
    return graph.textures[use]


def _video(graph: Assembly, texture: Texture, name: str, path: str) -> int:
    children = (
        Element("Type", ("Clip",)),
        property_block(property_row("Path", "KString", "XRefUrl", "", path)),
        integer("UseMipMap", 0),
        Element("Filename", (path,)),
        Element("RelativeFilename", (path,)),
    )
    return graph.add("Video", name, "Video", "Clip", children)


def _properties(surface: Material, bump: float) -> tuple[Element, ...]:
    material = phong(surface)
    *rgb, opaque = (float(value) for value in surface.base_color)
    transparency = 1.0 - opaque

    def color(name: str, *values: float) -> Element:
        return property_row(name, "Color", "", "A", *values)

    def number(name: str, value: float) -> Element:
        return property_row(name, "Number", "", "A", float(value))

    def parameter(name: str, value: float) -> Element:
        return property_row(f"{_MAPS}{name}", "Float", "", "A", float(value))

    return (
        integer("Version", 102),
        Element("ShadingModel", (SHADING_MODEL,)),
        integer("MultiLayer", 0),
        property_block(
            color("DiffuseColor", *material.diffuse_rgb),
            number("DiffuseFactor", material.diffuse_factor),
            color("EmissiveColor", 0.0, 0.0, 0.0),
            color("AmbientColor", 0.0, 0.0, 0.0),
            color("SpecularColor", *material.specular_rgb),
            number("SpecularFactor", material.specular_factor),
            number("Shininess", material.shininess),
            number("ShininessExponent", material.shininess),
            number("ReflectionFactor", surface.metallic),
            color("TransparentColor", *[float(transparency > 0.0)] * 3),
            number("TransparencyFactor", transparency),
            number("Opacity", opaque),
            *((number("BumpFactor", bump),) if surface.textures.normal is not None else ()),
            property_row("3dsMax", "Compound", "", ""),
            *(
                property_row(f"3dsMax|{name}", "int", "Integer", "", np.int32(value))
                for name, value in PHYSICAL_MATERIAL.items()
            ),
            property_row("3dsMax|Parameters", "Compound", "", ""),
            parameter("base_weight", 1.0),
            property_row(f"{_MAPS}base_color", "ColorAndAlpha", "", "A", *rgb, 1.0),
            parameter("metalness", surface.metallic),
            parameter("roughness", surface.roughness),
            property_row(f"{_MAPS}roughness_inv", "Bool", "", "A", np.int32(0)),
            parameter("reflectivity", 1.0),
            property_row(f"{_MAPS}refl_color", "ColorAndAlpha", "", "A", 1.0, 1.0, 1.0, 1.0),
            parameter("trans_ior", 1.5),
            parameter("cutout", opaque),
        ),
    )
