"""Conversion of metallic-roughness materials to FBX and back.

FBX 7.4 only has Phong surfaces, so a material is stored in several ways for different programs:

- Blender's importer in Python takes the colour from DiffuseColor alone, metallic from ReflectionFactor, roughness from
  Shininess as ``1 - sqrt(Shininess) / 10`` and the reflectance of non-metals from SpecularFactor
  (``io_scene_fbx/import_fbx.py``, Blender 5.0); assimp takes roughness from ShininessExponent in the same way.
- The FBX SDK, and with it Unreal, takes colours times their factors; Unreal's older importer finds colours of a Phong
  or Lambert surface only, so it must remain one.
- ufbx (Blender's newer importer, Godot), FBX2glTF and Unity take a 3ds Max Physical Material by the numbers of its
  class and its parameters; ufbx does so where the surface is not called Phong.

This program's reader uses the same properties as Blender's Python importer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from app.formats.fbx.graph import FbxObject, numbers, properties_of
from app.formats.scene import Material

DIELECTRIC_REFLECTANCE = 0.04
"""Reflectance of skin, cloth and lacquer at normal incidence (glTF 2.0, appendix B)."""
_BLENDER_SPECULAR = 0.25
"""Value of SpecularFactor that Blender uses for that reflectance."""
# A metal without a diffuse part is black in viewers without reflections.
_METAL_DIFFUSE = 0.4

SHADING_MODEL = "PHONG"
"""Name of the shading model: the FBX SDK ignores case (tested with 2019.2), ufbx accepts only "Phong" and "phong"."""
PHYSICAL_MATERIAL = {"ClassIDa": 1030429932, "ClassIDb": -559038463, "SuperClassID": 3072}
"""Class ids of 3ds Max's Physical Material; its parameters are children of ``3dsMax|Parameters``."""


@dataclass(frozen=True)
class Phong:
    """A Phong surface: linear RGB colours 0..1, each with a factor, and the exponent of its highlights."""

    diffuse_rgb: tuple[float, float, float]
    diffuse_factor: float
    specular_rgb: tuple[float, float, float]
    specular_factor: float
    shininess: float


def phong(material: Material) -> Phong:
    """Return the Phong surface nearest to a material; the colour of a metal becomes its reflection."""
    red, green, blue, _ = material.base_color
    metallic = material.metallic
    factor = _BLENDER_SPECULAR + (1.0 - _BLENDER_SPECULAR) * metallic

    def reflected(channel: float) -> float:
        return (DIELECTRIC_REFLECTANCE * (1.0 - metallic) + channel * metallic) / factor

    return Phong(
        diffuse_rgb=(red, green, blue),
        diffuse_factor=1.0 - (1.0 - _METAL_DIFFUSE) * metallic,
        specular_rgb=(reflected(red), reflected(green), reflected(blue)),
        specular_factor=factor,
        shininess=100.0 * (1.0 - material.roughness) ** 2,
    )


def roughness_of(shininess: float) -> float:
    """Return the roughness of the material whose `phong` surface has a given shininess."""
    return min(max(1.0 - math.sqrt(max(shininess, 0.0)) / 10.0, 0.0), 1.0)


def read_material(material: FbxObject) -> Material:
    """Return the material that an FBX material object describes."""
    properties = {name: numbers(values) for name, values in properties_of(material.element).items()}
    red, green, blue = (*properties.get("DiffuseColor", []), 0.0, 0.0, 0.0)[:3]

    def number(name: str, otherwise: float) -> float:
        return next(iter(properties.get(name, [])), otherwise)

    return Material(
        material.name,
        (red, green, blue, number("Opacity", 1.0)),
        number("ReflectionFactor", 0.0),
        roughness_of(number("Shininess", 20.0)),
    )
