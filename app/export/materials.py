"""Metal-rough surfaces as the Phong materials FBX 7.4 knows."""

from __future__ import annotations

from app.formats.scene import PhongMaterial
from app.rig.model import Material

DIELECTRIC_REFLECTANCE = 0.04
"""Of skin, cloth and lacquer at normal incidence (glTF 2.0, appendix B)."""
_SHININESS = (2.0, 256.0)


def phong(material: Material) -> PhongMaterial:
    """The nearest Phong surface: a metal's colour is in its reflection, and roughness alpha = r^2 gives the exponent
    ``2 / alpha^2 - 2`` (Walter et al. 2007, the Phong lobe as wide as a Beckmann lobe)."""
    red, green, blue, opacity = material.base_color
    metallic = material.metallic

    def reflected(channel: float) -> float:
        return DIELECTRIC_REFLECTANCE * (1.0 - metallic) + channel * metallic

    # A metal without any diffuse part is black in viewers that have nothing to reflect.
    diffuse = 1.0 - 0.6 * metallic
    exponent = 2.0 / max(material.roughness, 0.05) ** 4 - 2.0
    return PhongMaterial(
        name=material.name,
        diffuse_rgb=(red * diffuse, green * diffuse, blue * diffuse),
        specular_rgb=(reflected(red), reflected(green), reflected(blue)),
        shininess=min(max(exponent, _SHININESS[0]), _SHININESS[1]),
        opacity=opacity,
    )
