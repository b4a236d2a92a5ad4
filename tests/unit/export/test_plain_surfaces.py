"""Characters in files without textures: cards of hair, brows and lashes are no wedges, and materials are few."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.export.plain_surfaces import MOST_MATERIALS, with_plain_surfaces
from app.formats.scene import Material
from app.formats.textures import NO_TEXTURES
from tests.support.textured import card_material, textured_scene


def test_transparent_faces_of_cards_are_removed_and_vertices_stay() -> None:
    scene = textured_scene(card_material())
    (card,) = scene.meshes
    # The first triangle lies in the part that is cut out, the second one in the opaque part.
    uvs = np.array([(0.6, 0.05), (0.95, 0.05), (0.95, 0.4), (0.05, 0.95)])
    moved = replace(card, uvs=uvs, faces=np.array([(0, 1, 2), (0, 3, 3)]))
    (plain,) = with_plain_surfaces(replace(scene, meshes=(moved,))).meshes
    assert plain.faces.tolist() == [[0, 3, 3]]
    assert plain.vertices_cm is moved.vertices_cm
    assert [material.alpha_mode for material in plain.materials] == ["opaque"]


def test_opaque_materials_lose_no_face() -> None:
    scene = textured_scene(replace(card_material(), alpha="opaque"))
    (plain,) = with_plain_surfaces(scene).meshes
    assert plain.faces.tolist() == scene.meshes[0].faces.tolist()
    assert all(material.textures == NO_TEXTURES for material in plain.materials)


def test_the_most_similar_colours_become_one_until_few_remain() -> None:
    shades = (0.0, 0.02, 0.1, 0.2, 0.3, 0.45, 0.6, 0.62, 1.0)
    scene = textured_scene(*(Material(f"grey {shade}", (shade, shade, shade, 1.0)) for shade in shades))
    (mesh,) = scene.meshes
    (plain,) = with_plain_surfaces(scene).meshes
    assert len(plain.materials) == MOST_MATERIALS
    assert plain.face_materials is not None
    assert mesh.face_materials is not None
    before, after = (
        np.array([one.base_color[0] for one in each.materials])[each.face_materials]
        for each in (mesh, plain)
        if each.face_materials is not None
    )
    assert np.abs(after - before).max() < 0.16
    assert {"grey 0.0", "grey 1.0"} <= {material.name for material in plain.materials}


def test_few_materials_stay_themselves() -> None:
    scene = textured_scene(Material("skin", (0.5, 0.3, 0.2, 1.0)), Material("hair", (0.5, 0.3, 0.2, 0.9)))
    assert with_plain_surfaces(scene).meshes[0].materials == scene.meshes[0].materials
