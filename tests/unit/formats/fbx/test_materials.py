"""Metallic-roughness materials are converted to Phong materials of the same reflection, and back without loss."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from app.formats.fbx.materials import phong
from app.formats.fbx.read import decode_scene
from app.formats.scene import Material
from tests.support.encoded import encode_scene
from tests.unit.formats import scenes

SURFACES = (
    Material("skin", (0.6, 0.3, 0.2, 1.0), 0.0, 0.55),
    Material("brass", (0.83, 0.56, 0.19, 1.0), 1.0, 0.2),
    Material("black", (0.0, 0.0, 0.0, 1.0), 0.25, 0.0),
    Material("lens", (0.2, 0.3, 0.8, 0.5), 0.5, 1.0),
)


@pytest.mark.parametrize("given", SURFACES, ids=lambda surface: surface.name)
def test_a_surface_comes_back(given: Material) -> None:
    scene = scenes.instrument(Fraction(24), frames=2)
    file = encode_scene(replace(scene, meshes=(replace(scene.meshes[0], materials=(given,)),)))
    (found,) = decode_scene(file, "x").meshes[0].materials
    assert found.name == given.name
    assert found.base_color == pytest.approx(given.base_color, abs=1e-12)
    assert found.metallic == pytest.approx(given.metallic, abs=1e-12)
    assert found.roughness == pytest.approx(given.roughness, abs=1e-12)


def test_a_metal_reflects_its_color_and_a_dielectric_white() -> None:
    for metallic, reflected, scattered in ((1.0, (0.8, 0.6, 0.2), 0.4), (0.0, (0.04, 0.04, 0.04), 1.0)):
        surface = phong(Material("x", (0.8, 0.6, 0.2, 1.0), metallic, 0.3))
        assert [surface.specular_factor * channel for channel in surface.specular_rgb] == pytest.approx(reflected)
        assert surface.diffuse_factor == pytest.approx(scattered)
    assert surface.specular_factor == 0.25  # Blender's ordinary reflectance
