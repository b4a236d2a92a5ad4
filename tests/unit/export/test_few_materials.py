"""Small surfaces of characters share a few materials without visible change."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.arrays import FloatArray
from app.export.character import skinned_mesh
from app.export.few_materials import with_few_materials
from app.formats.images import decoded
from app.formats.scene import Material
from app.formats.texture_colors import linear
from app.rig.characters.character_library import character_named
from app.rig.mesh import Mesh
from app.rig.model import Character

MOST = 6


def materials_of(character: Character) -> set[Material]:
    return {material for mesh in character.meshes for material in mesh.materials}


def looks(mesh: Mesh) -> tuple[FloatArray, FloatArray]:
    """Colours and opacity (T, 4) and roughness (T,) at the centres of triangles, by the nearest pixel."""
    colors, rough = np.ones((len(mesh.triangles), 4)), np.ones(len(mesh.triangles))
    for number, material in enumerate(mesh.materials):
        own = np.flatnonzero(mesh.triangle_materials == number)
        middles = mesh.uvs[mesh.triangles[own]].mean(axis=1)
        colors[own, :3], rough[own] = material.base_color[:3], material.roughness
        color, surface = material.textures.color, material.textures.metallic_roughness
        if color is not None:
            seen = nearest(decoded(color.texture, 4096), middles * color.scale + color.offset)
            colors[own, :3] *= linear(seen[:, :3])
            colors[own, 3] = seen[:, 3]
        if surface is not None:
            rough[own] *= nearest(decoded(surface.texture, 4096), middles)[:, 1]
    return colors, rough


def nearest(pixels: object, places: FloatArray) -> FloatArray:
    picture = np.asarray(pixels, np.float64) / 255.0
    height, width = picture.shape[:2]
    x, y = (np.clip(places[:, axis] * side, 0, side - 1).astype(int) for axis, side in ((0, width), (1, height)))
    return picture[y, x]


@pytest.mark.parametrize("id", ["man_adult", "cast_elena"])
def test_small_surfaces_share_materials_and_are_seen_as_before(id: str) -> None:
    before = character_named(id)
    after = with_few_materials(before)
    assert len(materials_of(after)) <= MOST < len(materials_of(before))
    assert {material.name for material in materials_of(after)} == {"skin", "details", "hair", "shirt"}
    for own, shared in zip(before.meshes, after.meshes, strict=True):
        assert shared.positions_m is own.positions_m, "landmarks count vertices"
        assert shared.morphs is own.morphs
        (colors, rough), (colors_now, rough_now) = looks(own), looks(shared)
        opaque = colors[:, 3] > 0.9
        assert np.abs(colors_now - colors)[opaque].mean(axis=0).max(initial=0.0) < 0.02, own.name
        assert np.abs(colors_now[:, 3] - colors[:, 3]).mean() < 0.02, own.name
        assert np.abs(rough_now - rough).max() < 0.03, own.name


def test_materials_with_more_than_a_colour_stay_themselves() -> None:
    before = character_named("man_adult")
    after = with_few_materials(before)
    assert [material for material in materials_of(after) if material.name == "skin"] == [
        material for material in materials_of(before) if material.name == "skin"
    ]
    assert with_few_materials(before) is after, "made once"


def test_equal_materials_of_a_file_are_written_once() -> None:
    given = character_named("man_adult").meshes[0]
    count = len(given.materials)
    doubled = given.triangle_materials + count * (np.arange(len(given.triangles), dtype=np.int32) % 2)
    twice = replace(given, materials=given.materials * 2, triangle_materials=doubled)
    binds = np.tile(np.eye(4), (int(given.joints.max()) + 1, 1, 1))
    made = skinned_mesh(twice, "skin", twice.joints, twice.weights, binds)
    assert made.materials == given.materials
    np.testing.assert_array_equal(made.face_materials, given.triangle_materials)
