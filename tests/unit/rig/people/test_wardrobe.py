"""Outfits on people: transferred to their bodies in chosen colours, with nothing else changed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from app.errors import FileError
from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.characters.dressed_characters import character_in, person_behind, worn_colours
from app.rig.people.wardrobe import OutfitChoice, linear_colour, wardrobe
from app.rig.skinning import mesh_named
from tests.support.wardrobe import GARMENTS, TITLE, wardrobe_in, write_outfit


@pytest.fixture(scope="module", autouse=True)
def suits(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    folder = tmp_path_factory.mktemp("wardrobe")
    write_outfit(folder / "test_suit.glb")
    write_outfit(folder / "test_pair_man.glb", "test_pair", "man_adult", hides_skin=list(range(13380)))
    write_outfit(folder / "test_pair_woman.glb", "test_pair", "woman_adult", means={"shirt": 0.5})
    write_outfit(
        folder / "test_tie.glb",
        "test_tie",
        hides=["shoes"],
        meshes=["shoes"],
        tints={"shirt": "main"},
        means={"shirt": 0.8},
    )
    (folder.parent / "man_adult.glb").write_bytes(bundled_characters()["man_adult"].read_bytes())
    with wardrobe_in(folder):
        yield


def test_an_outfit_may_colour_clothes_that_people_keep() -> None:
    assert wardrobe()["test_tie"].colours == {"main": "#e1e1df"}
    own = np.array(character_colors("cast_yumi")["shirt"][:3])
    assert 0.8 * own == pytest.approx(linear_colour("#e1e1df"), abs=0.01)
    worn = character_in("cast_yumi", OutfitChoice("test_tie", main="#336699"))
    (shirt,) = (mesh for mesh in worn.meshes if mesh.name == "shirt")
    assert shirt.positions_m is mesh_named(character_named("cast_yumi"), "shirt").positions_m
    assert shirt.materials[0].base_color[:3] == pytest.approx([part / 0.8 for part in linear_colour("#336699")])


def test_the_wardrobe_lists_outfits_with_their_titles_and_colours() -> None:
    assert [*wardrobe()] == ["test_pair", "test_suit", "test_tie"]
    suit = wardrobe()["test_suit"]
    assert {"en": suit.title.en, "ja": suit.title.ja} == TITLE
    assert suit.tints == ("main", "second")
    assert {*suit.files} == {"man_adult", "woman_adult"}
    assert {body: facts.body for body, (_, facts) in wardrobe()["test_pair"].files.items()} == {
        "man_adult": "man_adult",
        "woman_adult": "woman_adult",
    }


@pytest.mark.parametrize(("id", "sex"), [("child_leo", "man"), ("child_sota", "man"), ("child_nia", "woman")])
def test_children_wear_the_garments_of_their_own_sex(id: str, sex: str) -> None:
    """The man's garments of the pair replace all of the skin."""
    bare, worn = character_named(id), character_in(id, OutfitChoice("test_pair"))
    covered = len(mesh_named(worn, "body").triangles) < 0.05 * len(mesh_named(bare, "body").triangles)
    assert covered == (sex == "man")
    height_m = [mesh_named(one, "shirt").positions_m[:, 1].max() for one in (bare, worn)]
    assert height_m[1] == pytest.approx(height_m[0], abs=0.05), "as small as the child"
    wrist_m = np.linalg.inv(bare.joint_from_mesh)[bare.skeleton.index("leftHand"), :3, 3]
    short_m = [np.linalg.norm(mesh_named(one, "shirt").positions_m - wrist_m, axis=1).min() for one in (bare, worn)]
    assert short_m[1] == pytest.approx(short_m[0], abs=0.012), "sleeves end at the child's own wrists"


def test_colours_are_those_that_the_person_wears() -> None:
    """The woman's shirt of the pair has a texture half as bright, and so half the linear colour."""
    man, woman = (worn_colours(id, OutfitChoice("test_pair")) for id in ("cast_daichi", "cast_yumi"))
    assert man is not None
    assert woman is not None
    assert linear_colour(woman["main"]) == pytest.approx([part / 2.0 for part in linear_colour(man["main"])], abs=0.01)
    assert worn_colours("cast_yumi", OutfitChoice("test_pair", main="#336699")) == {**woman, "main": "#336699"}
    assert worn_colours("cast_yumi", OutfitChoice()) is None
    assert worn_colours("cast_yumi", OutfitChoice("no_such")) is None


@pytest.mark.parametrize("id", ["man_adult", "woman_adult", "cast_daichi", "cast_yumi"])
def test_garments_lie_on_the_body_of_whoever_wears_them(id: str) -> None:
    bare, worn = character_named(id), character_in(id, OutfitChoice("test_suit"))
    assert worn.id == f"{id}-test_suit"
    assert worn.skeleton is bare.skeleton
    assert mesh_named(worn, "body") is mesh_named(bare, "body"), "what is not clothes is shared"
    assert [mesh.name for mesh in worn.meshes].count("shirt") == 1
    for name in GARMENTS:
        own, other = mesh_named(bare, name), mesh_named(worn, name)
        off_m = np.abs(
            np.array([own.positions_m.min(0), own.positions_m.max(0)])
            - [other.positions_m.min(0), other.positions_m.max(0)]
        )
        # A man's shirt on a woman is not her own, but about as large.
        assert off_m.max() < (0.001 if bare.hands_of is None and id == "man_adult" else 0.08), name


def test_soles_of_shoes_that_are_left_out_are_those_of_the_others() -> None:
    bare, worn = character_named("cast_yumi"), character_in("cast_yumi", OutfitChoice("test_suit"))
    for name in ("left.foot.sole", "right.foot.sole"):
        before, after = (
            mesh_named(one, one.landmarks[name].mesh).positions_m[one.landmarks[name].vertices].mean(axis=0)
            for one in (bare, worn)
        )
        assert np.linalg.norm(after - before) < 0.02


def test_colours_are_those_chosen_and_others_stay_the_outfit_s() -> None:
    worn = character_in("cast_haruto", OutfitChoice("test_suit", main="#336699"))
    colors = {material.name: material.base_color for mesh in worn.meshes for material in mesh.materials}
    assert colors["shirt"][:3] == pytest.approx(linear_colour("#336699"))
    assert colors["trousers"] == character_colors("cast_haruto")["trousers"]
    tinted = character_in("cast_yumi", OutfitChoice("test_pair", main="#336699"))
    of_texture = next(m for mesh in tinted.meshes for m in mesh.materials if m.name == "shirt")
    assert of_texture.base_color[:3] == pytest.approx([2.0 * part for part in linear_colour("#336699")])


def character_colors(id: str) -> dict[str, tuple[float, float, float, float]]:
    return {material.name: material.base_color for mesh in character_named(id).meshes for material in mesh.materials}


def test_skin_under_clothes_is_not_drawn_and_its_vertices_stay() -> None:
    for id in ("man_adult", "cast_haruto"):
        bare, worn = character_named(id), character_in(id, OutfitChoice("test_pair"))
        before, after = mesh_named(bare, "body"), mesh_named(worn, "body")
        assert len(after.positions_m) == len(before.positions_m), "landmarks count them"
        assert len(after.triangles) < 0.05 * len(before.triangles), "all of the skin was said to be covered"


def test_what_cannot_be_worn_leaves_a_person_as_they_are() -> None:
    assert character_in("cast_yumi", OutfitChoice("none_such")) is character_named("cast_yumi")
    assert character_in("cast_yumi", OutfitChoice()) is character_named("cast_yumi")
    assert person_behind("none_such") is None
    assert character_in("cast_yumi", OutfitChoice("test_suit")) is character_in("cast_yumi", OutfitChoice("test_suit"))


def test_a_file_that_is_no_outfit_is_refused(tmp_path: Path) -> None:
    write_outfit(tmp_path / "odd.glb", tints={"shirt": "fourth"})
    with wardrobe_in(tmp_path), pytest.raises(FileError):
        wardrobe()
