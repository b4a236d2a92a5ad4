"""Shapes for the graphics card compared with the original meshes."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.characters.dressed_characters import character_in
from app.rig.people.wardrobe import OutfitChoice
from instrument_maps.load import bundled_maps
from tests.support.models import bundled_instrument
from widgets.viewport.geometry import (
    character_levels,
    crowd,
    crowd_edges,
    edges,
    instrument_levels,
    joined,
    stand,
)
from widgets.viewport.normals_across_seams import row_keys
from widgets.viewport.shape_model import FIRST_BONES, Geometry, LevelsOfDetail

CHARACTERS = tuple(bundled_characters())


@cache
def levels(name: str) -> LevelsOfDetail:
    return character_levels(character_named(name))


def area(geometry: Geometry) -> float:
    places = geometry.shape["a_position"].astype(np.float64)[geometry.triangles]
    return float(np.linalg.norm(np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]), axis=1).sum() / 2)


def test_a_skirt_that_five_bones_move_keeps_all_of_them_at_every_level() -> None:
    """Thighs would come through it on a chair."""
    character = character_in("woman_adult", OutfitChoice("school_blazer"))
    skirt = next(mesh for mesh in character.meshes if mesh.name == "skirt")
    assert ((skirt.weights > 0.0).sum(axis=1) > FIRST_BONES).any()
    wanted = {position.tobytes(): row for position, row in zip(skirt.positions_m, skirt.weights, strict=True)}
    for level in character_levels(character):
        surface = level.surface
        shares = np.concatenate([surface["a_weights"], surface["a_more_weights"]], axis=1)
        of_skirt = [
            (shares[vertex], wanted[position.tobytes()])
            for vertex, position in enumerate(level.shape["a_position"])
            if position.tobytes() in wanted
        ]
        assert len(of_skirt) > 100
        assert max(np.abs(np.sort(one)[::-1][:5] - np.sort(other)[::-1][:5]).max() for one, other in of_skirt) < 1e-3


@pytest.mark.parametrize("name", ["cast_elena", "cast_yumi"])
def test_bare_skin_of_an_outfit_joins_the_body_at_the_coarsest_level(name: str) -> None:
    """Holes in the chest would be black specks."""
    character = character_in(name, OutfitChoice("evening"))
    body, chest = (next(mesh for mesh in character.meshes if mesh.name == own) for own in ("body", "skin_chest"))
    common = set(map(tuple, body.positions_m.tolist())) & set(map(tuple, chest.positions_m.tolist()))
    seam = np.array([place for place in common if abs(place[0]) < 0.08 and place[2] > 0.03])
    assert len(seam) > 10
    geometry = character_levels(character)[-1]
    corners = geometry.triangles.astype(np.int64)
    sides = np.sort(np.concatenate([corners[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]), axis=1)
    pairs, count = np.unique(sides, axis=0, return_counts=True)
    open_m = geometry.shape["a_position"][pairs[count == 1]].mean(axis=1)
    far_m = np.linalg.norm(open_m[:, None] - seam, axis=2).min(axis=1)
    assert (far_m > 0.02).all(), np.round(np.sort(far_m)[:5], 3)


@pytest.mark.parametrize("name", CHARACTERS)
def test_the_finest_level_is_every_triangle_where_it_was_in_its_own_colour(name: str) -> None:
    character, geometry = character_named(name), levels(name)[0]
    requested, pictured = set(), set()
    for mesh in character.meshes:
        for triangle, number in zip(mesh.triangles, mesh.triangle_materials, strict=True):
            material, place = mesh.materials[number], mesh.positions_m[triangle].tobytes()
            if material.textures.color is not None:
                # Its vertices have the colours of the texture.
                pictured.add(place)
            else:
                requested.add((place, tuple(np.float32(material.base_color[:3]).tolist())))
    places = geometry.shape["a_position"][geometry.triangles]
    colors = geometry.surface["a_color"][geometry.triangles][:, :, :3]
    plain = np.array([place.tobytes() not in pictured for place in places])
    assert {place.tobytes() for place in places[~plain]} == pictured
    assert (colors[plain] == colors[plain][:, :1]).all()
    found = {
        (place.tobytes(), tuple(color[0].tolist())) for place, color in zip(places[plain], colors[plain], strict=True)
    }
    assert found == requested


@pytest.mark.parametrize("name", CHARACTERS)
def test_coarser_levels_are_smaller_but_cover_the_same_body(name: str) -> None:
    fine, middle, coarse = levels(name)
    assert len(fine.triangles) > 1.2 * len(middle.triangles) > 2.0 * len(coarse.triangles)
    for level in (middle, coarse):
        for bound in ("min", "max"):
            own = getattr(level.shape["a_position"], bound)(axis=0)
            assert own == pytest.approx(getattr(fine.shape["a_position"], bound)(axis=0), abs=0.02)
        assert area(level) == pytest.approx(area(fine), rel=0.25)
        a, b, c = level.triangles.T
        assert not ((a == b) | (b == c) | (c == a)).any()
        assert len(np.unique(level.triangles)) == len(level.shape)


@pytest.mark.parametrize("name", CHARACTERS)
def test_weights_sum_to_one_and_name_the_characters_own_joints(name: str) -> None:
    for level in levels(name):
        surface = level.surface
        shares = surface["a_weights"].sum(axis=1) + surface["a_more_weights"].sum(axis=1)
        assert shares == pytest.approx(1.0, abs=1e-5)
        for bones in ("a_bones", "a_more_bones"):
            assert surface[bones].max() < len(character_named(name).skeleton.names)


@pytest.mark.parametrize("name", CHARACTERS)
@pytest.mark.parametrize("level", [0, 1])
def test_a_morph_moves_the_vertices_the_character_says_and_only_the_first_ones(name: str, level: int) -> None:
    geometry = levels(name)[level]
    face = geometry.face
    assert face is not None
    body = character_named(name).meshes[0]
    morph = next(morph for morph in body.morphs if morph.name == "jawOpen")
    moved = {
        body.positions_m[vertex].tobytes(): body.positions_m[vertex] + delta
        for vertex, delta in zip(morph.vertices, morph.deltas_m, strict=True)
        if np.abs(delta).max() > 1e-6
    }
    weights = np.zeros(len(face.names), np.float32)
    weights[face.names.index("jawOpen")] = 1.0
    after = face.morphed(weights)
    assert len(after) == face.count
    met = 0
    for index in range(face.count):
        goal = moved.get(geometry.shape["a_position"][index].tobytes())
        if goal is not None:
            met += 1
            assert after["a_position"][index] == pytest.approx(goal, abs=1e-6)
    assert met > 300 if level == 0 else met > 100


@pytest.mark.parametrize("name", CHARACTERS)
def test_normals_follow_a_morph(name: str) -> None:
    """Compared with normals of the moved triangles by another method: finite areas around each vertex."""
    geometry = levels(name)[0]
    face = geometry.face
    weights = np.zeros(len(face.names), np.float32)
    weights[face.names.index("cheekPuff")] = 1.0
    shape = geometry.shape.copy()
    shape[: face.count] = face.morphed(weights)
    places = shape["a_position"].astype(np.float64)
    faces = np.cross(
        places[geometry.triangles[:, 1]] - places[geometry.triangles[:, 0]],
        places[geometry.triangles[:, 2]] - places[geometry.triangles[:, 0]],
    )
    total = np.zeros((len(places), 3))
    for corner in range(3):
        np.add.at(total, geometry.triangles[:, corner], faces)
    total /= np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-12)
    moved = np.linalg.norm(shape["a_position"] - geometry.shape["a_position"], axis=1) > 0.002
    given = shape["a_normal"] / np.linalg.norm(shape["a_normal"], axis=1, keepdims=True)
    assert moved.sum() > 100
    angles = np.degrees(np.arccos(np.clip((given[moved] * total[moved]).sum(axis=1), -1.0, 1.0)))
    assert np.median(angles) < 4.0
    assert np.percentile(angles, 95) < 20.0


@pytest.mark.parametrize("name", CHARACTERS)
def test_what_is_seen_from_one_side_faces_outwards_and_comes_first(name: str) -> None:
    """The backs of these triangles are not drawn, so their normals must determine the side."""
    two_sided = sum(
        int(np.array([material.double_sided for material in mesh.materials])[mesh.triangle_materials].sum())
        for mesh in character_named(name).meshes
    )
    level = levels(name)[0]
    assert len(level.triangles) - level.one_sided == two_sided
    one = level.triangles[: level.one_sided]
    places = level.shape["a_position"].astype(np.float64)[one]
    faces = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    outwards = (faces * level.shape["a_normal"][one].mean(axis=1)).sum(axis=1) >= 0.0
    area = np.linalg.norm(faces, axis=1)
    assert area[outwards].sum() > 0.995 * area.sum()


def test_instruments_move_with_bones_after_the_joints() -> None:
    made = []
    for instrument in bundled_maps().values():
        model = bundled_instrument(instrument)
        made.append((model, instrument_levels(model, 60)))
        for level in made[-1][1]:
            bones = level.surface["a_bones"][:, 0]
            assert bones.min() == 60
            assert bones.max() == 60 + len(model.node_names) - 1
    assert all(instrument_levels(model, 60) is levels for model, levels in made), "an orchestra has one of each"


def test_joined_shapes_keep_their_triangles() -> None:
    parts = [stand(3), stand(5)]
    whole = joined(parts)
    assert len(whole.triangles) == sum(len(part.triangles) for part in parts)
    assert whole.one_sided == len(whole.triangles)
    last = whole.shape["a_position"][whole.triangles[-1]]
    assert (last == parts[1].shape["a_position"][parts[1].triangles[-1]]).all()
    assert set(whole.surface["a_bones"][:, 0]) == {3.0, 5.0}


def test_a_crowd_is_its_parts_end_to_end() -> None:
    instrument = next(iter(bundled_maps().values()))
    things = [instrument_levels(bundled_instrument(instrument), 60)[-1], stand(3)]
    parts = [(0, things[0]), (0, things[1]), (1, things[0]), (2, things[1])]
    everyone = crowd(parts)
    assert (everyone.shape == np.concatenate([part.shape for _, part in parts])).all()
    assert (everyone.surface == np.concatenate([part.surface for _, part in parts])).all()
    assert everyone.rows.tolist() == [row for row, part in parts for _ in part.shape]
    starts = np.cumsum([0, *(len(part.shape) for _, part in parts)])
    one = [part.triangles[: part.one_sided] + start for (_, part), start in zip(parts, starts, strict=False)]
    both = [part.triangles[part.one_sided :] + start for (_, part), start in zip(parts, starts, strict=False)]
    assert everyone.one_sided == sum(map(len, one))
    assert (everyone.triangles == np.concatenate(one + both)).all()
    whole = Geometry(everyone.shape, everyone.surface, everyone.triangles, everyone.one_sided)
    found = {tuple(edge) for edge in crowd_edges(parts).tolist()}
    assert found == {tuple(edge) for edge in edges(whole).tolist()}


@pytest.mark.parametrize("largest", [3, 2**20, 2**31 - 1])
def test_rows_have_one_number_each_in_their_order(largest: int) -> None:
    """Also if the product of all columns' ranges exceeds an integer."""
    random = np.random.default_rng(3)
    rows = random.integers(-largest, largest, (500, 6))
    rows[250:] = rows[random.integers(0, 250, 250)]
    expected = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    found = np.unique(row_keys(*rows.T), return_index=True, return_inverse=True)
    np.testing.assert_array_equal(found[1], expected[1])
    np.testing.assert_array_equal(found[2], expected[2].reshape(-1))
