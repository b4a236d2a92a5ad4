"""Metallic-roughness surfaces as the Phong materials that FBX 7.4 knows, and back."""

from __future__ import annotations

import math
from dataclasses import dataclass

from app.formats.scene import Material

DIELECTRIC_REFLECTANCE = 0.04
"""Of skin, cloth and lacquer at normal incidence (glTF 2.0, appendix B)."""
_SHININESS = (2.0, 256.0)
# A metal without any diffuse part is black in viewers that have nothing to reflect.
_METAL_DIFFUSE = 0.4


@dataclass(frozen=True)
class Phong:
    """A Phong surface; colours are linear RGB from 0 to 1, shininess is the Phong exponent."""

    diffuse_rgb: tuple[float, float, float]
    specular_rgb: tuple[float, float, float]
    shininess: float
    opacity: float


def phong(material: Material) -> Phong:
    """The nearest Phong surface: a metal's colour is in its reflection, and roughness alpha = r^2 gives the exponent
    ``2 / alpha^2 - 2`` (Walter et al. 2007, the Phong lobe as wide as a Beckmann lobe)."""
    red, green, blue, opacity = material.base_color
    metallic = material.metallic

    def reflected(channel: float) -> float:
        return DIELECTRIC_REFLECTANCE * (1.0 - metallic) + channel * metallic

    diffuse = 1.0 - (1.0 - _METAL_DIFFUSE) * metallic
    exponent = 2.0 / max(material.roughness, 0.05) ** 4 - 2.0
    return Phong(
        diffuse_rgb=(red * diffuse, green * diffuse, blue * diffuse),
        specular_rgb=(reflected(red), reflected(green), reflected(blue)),
        shininess=min(max(exponent, _SHININESS[0]), _SHININESS[1]),
        opacity=opacity,
    )


def metallic_roughness(name: str, surface: Phong) -> Material:
    """The surface whose `phong` this is, as far as that shows: a roughness beyond the exponent's bounds is lost, and
    so is whether both sides show. Of two metallic values that look alike it is the smaller."""
    # Summed over the channels, specular = 0.04 (1 - m) + m diffuse / (1 - 0.6 m): a quadratic equation for m.
    lost, plain = 1.0 - _METAL_DIFFUSE, 3.0 * DIELECTRIC_REFLECTANCE
    diffuse, beyond = sum(surface.diffuse_rgb), sum(surface.specular_rgb) - plain
    linear, quadratic = diffuse + lost * beyond - plain, lost * plain
    root = math.sqrt(max(linear**2 + 4.0 * quadratic * beyond, 0.0))
    candidates = [(-linear - root) / (2.0 * quadratic), (-linear + root) / (2.0 * quadratic)]
    metallic = min((value for value in candidates if value > -1e-9), default=0.0)
    metallic = min(max(metallic, 0.0), 1.0)
    red, green, blue = (min(channel / (1.0 - lost * metallic), 1.0) for channel in surface.diffuse_rgb)
    roughness = (2.0 / (max(surface.shininess, 0.0) + 2.0)) ** 0.25
    return Material(name, (red, green, blue, surface.opacity), metallic, roughness)
