"""Metallic-roughness surfaces become Phong ones and come back."""

from __future__ import annotations

import itertools

import pytest

from app.formats.fbx.materials import metallic_roughness, phong
from app.formats.scene import Material

COLORS = ((0.8, 0.6, 0.2), (0.02, 0.01, 0.03), (1.0, 1.0, 1.0), (0.9, 0.05, 0.05), (0.0, 0.0, 0.0))


@pytest.mark.parametrize(("color", "metallic"), list(itertools.product(COLORS, (0.0, 0.25, 0.6, 1.0))))
def test_a_surface_comes_back_or_one_that_looks_the_same(color: tuple[float, ...], metallic: float) -> None:
    given = Material("brass", (*color, 0.5), metallic, 0.6)  # type: ignore[arg-type]
    found = metallic_roughness(given.name, phong(given))
    assert found.roughness == pytest.approx(0.6)
    assert 0.0 <= found.metallic <= metallic + 1e-6
    seen, meant = phong(found), phong(given)
    assert seen.diffuse_rgb == pytest.approx(meant.diffuse_rgb, abs=1e-6)
    assert seen.specular_rgb == pytest.approx(meant.specular_rgb, abs=0.02)
    if sum(color) > 1.0:
        assert found.metallic == pytest.approx(metallic, abs=1e-6)
        assert found.base_color == pytest.approx(given.base_color, abs=1e-6)


def test_a_metal_reflects_its_color_and_a_dielectric_white() -> None:
    metal, paint = (phong(Material("x", (0.8, 0.6, 0.2, 1.0), metallic, 0.3)) for metallic in (1.0, 0.0))
    assert metal.specular_rgb == pytest.approx((0.8, 0.6, 0.2))
    assert paint.specular_rgb == pytest.approx((0.04, 0.04, 0.04))
    assert metal.shininess > phong(Material("x", (0.8, 0.6, 0.2, 1.0), 1.0, 0.6)).shininess
