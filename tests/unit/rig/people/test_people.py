"""Bodies compared with those of anny, and people made from bundled bodies."""

from __future__ import annotations

import json
import tomllib
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.errors import MapError
from app.formats.toml import toml
from app.project.band_in_title import years_in_title
from app.project.casting import stage_arc
from app.project.character_choice import characters_for
from app.rig import quaternion
from app.rig.characters.character_library import bundled_characters, character_named, our_arm_m, our_characters
from app.rig.mesh import Mesh, Morph
from app.rig.model import Character
from app.rig.people import make_person
from app.rig.people.body_shapes import SKIN_VERTICES, Phenotype, body_m, body_shapes, heights_m, years_of
from app.rig.people.bundled_people import (
    bundled_people,
    bundled_person,
    finished_character,
    person_of,
    whole_phenotype,
)
from app.rig.people.make_person import Original, original_of, person_character
from app.rig.people.person import originals, ranges, read_person
from app.rig.skeleton import forward, rest_positions
from app.rig.skinning import mesh_named, patch
from instrument_maps.load import bundled_maps
from tests.support.deformed import deform
from widgets.viewport.geometry import character_levels

ANNY = Path(__file__).parents[3] / "data" / "anny_bodies.json"
"""Results of anny 0.6.2 for three people: some vertices and joints in metres, soles on the floor."""

ANATOMY = Path(__file__).parents[4] / "resources" / "build" / "anatomy.toml"

PARTS = ("UpperArm", "LowerArm", "Hand")


@cache
def answers() -> dict[str, Any]:
    read: dict[str, Any] = json.loads(ANNY.read_text(encoding="utf-8"))
    return read


def phenotype_of(asked: dict[str, float], height_m: float) -> Phenotype:
    renamed = {"gender": "sex", "cupsize": "cup"}
    return Phenotype(height_m, **{renamed.get(name, name): value for name, value in asked.items()})


@pytest.mark.parametrize("name", ["child", "elder", "stout"])
def test_a_body_is_what_anny_makes_of_the_same_phenotype(name: str) -> None:
    shapes, told = body_shapes(), answers()["people"][name]
    body = body_m(shapes, phenotype_of(told["phenotype"], told["height_m"]))
    rows = np.searchsorted(shapes.vertices, answers()["vertices"])
    assert (shapes.vertices[rows] == answers()["vertices"]).all()
    off_mm = 1000.0 * np.linalg.norm(body[rows] - told["positions_m"], axis=1)
    assert off_mm.max() < 0.3
    assert off_mm.mean() < 0.1
    for joint, place in told["joints_m"].items():
        place_m = body[len(shapes.vertices) + shapes.joints.index(joint)]
        assert 1000.0 * np.linalg.norm(place_m - place) < 0.3, joint


@pytest.mark.parametrize("id", bundled_characters())
def test_a_finished_body_is_made_of_its_own_phenotype_again(id: str) -> None:
    before, shapes = character_named(id), body_shapes()
    original = original_of(before, shapes, originals()[id])
    skin = mesh_named(before, "body")
    nearest = original.base_m[original.bindings["body"].corners[:, 0]]
    # Hands, lids and the face at rest with its forehead were changed after the phenotype; skull, neck, ears were not.
    assert np.mean(np.linalg.norm(nearest - skin.positions_m, axis=1) < 1e-4) > 0.25
    after = person_character("again", original, shapes, originals()[id])
    for old, new in zip(before.meshes, after.meshes, strict=True):
        np.testing.assert_allclose(new.positions_m, old.positions_m, atol=1e-6)
        lengths = np.linalg.norm(old.normals, axis=1, keepdims=True)
        assert np.allclose(lengths, 1.0, atol=0.01)
        np.testing.assert_allclose(new.normals, old.normals / lengths, atol=1e-5)
        for shape, same in zip(old.morphs, new.morphs, strict=True):
            np.testing.assert_allclose(same.deltas_m, shape.deltas_m, atol=1e-6)
    np.testing.assert_allclose(rest_positions(after.skeleton), rest_positions(before.skeleton), atol=1e-6)


def skin_at_rest(character: Character, mark: str) -> np.ndarray:
    """Vertices (N, 3) of a landmark in the T-pose."""
    landmark = character.landmarks[mark]
    still = np.tile(quaternion.IDENTITY, (1, len(character.skeleton.names), 1))
    joints = forward(character.skeleton, still)
    part = patch(character, mesh_named(character, landmark.mesh), landmark.vertices)
    return np.asarray(deform(part, joints)[0])


@pytest.mark.parametrize("id", bundled_people())
def test_a_person_has_the_hands_of_the_finished_body_and_a_height_of_its_own(id: str) -> None:
    person, character = bundled_person(id), character_named(id)
    before = finished_character(person.original, character_named)
    for side in ("left", "right"):
        wrist = before.skeleton.index(f"{side}Hand")
        hands = [skin_at_rest(one, f"{side}.hand") - rest_positions(one.skeleton)[wrist] for one in (before, character)]
        np.testing.assert_allclose(hands[1], hands[0], atol=2e-6)
    assert character.hands_of is before
    low_m, high_m = heights_m(body_shapes(), person.phenotype)
    assert low_m < person.phenotype.height_m < high_m
    eyes_m = rest_positions(character.skeleton)[character.skeleton.index("leftEye"), 1]
    # Eyes lie 0.93 to 0.94 of stature high (ANSUR II: 1.632 of 1.752 m, 1.520 of 1.629 m); shoes lift them.
    assert 0.92 * person.phenotype.height_m < eyes_m < 0.97 * person.phenotype.height_m


@pytest.mark.parametrize("id", ["cast_yumi", "cast_henry", "child_hina"])
def test_lids_close_over_the_eyes_of_everyone(id: str) -> None:
    """During a blink, the skin next to an eyeball is as far from it as on the bundled body."""
    character, before = character_named(id), finished_character(bundled_person(id).original, character_named)
    least = []
    for one in (before, character):
        skin, eye = mesh_named(one, "body"), one.skeleton.index("leftEye")
        blink = next(morph for morph in skin.morphs if morph.name == "eyeBlinkLeft")
        shut = skin.positions_m[blink.vertices] + blink.deltas_m
        far = np.linalg.norm(shut - np.linalg.inv(one.joint_from_mesh[eye])[:3, 3], axis=1)
        least.append(np.sort(far)[:100])
    np.testing.assert_allclose(least[1], least[0], atol=3e-4)


def test_a_face_is_made_when_its_person_is_seen_near(monkeypatch: pytest.MonkeyPatch) -> None:
    """A band is drawn from afar without any. Few shapes, as of a breathing chest, are not worth waiting for."""
    made, make = list[str](), make_person._shapes

    def counted(original: Original, mesh: Mesh, *others: Any) -> tuple[Morph, ...]:
        made.append(mesh.name)
        return make(original, mesh, *others)

    monkeypatch.setattr(make_person, "_shapes", counted)
    person = person_of("seen", bundled_person("cast_yumi"), character_named)
    levels = character_levels(person)
    assert levels.coarsest.face is None
    assert "body" not in made
    face = levels[0].face
    assert face is not None
    assert "jawOpen" in face.names
    skin = mesh_named(person, "body")
    assert len(skin.morphs) == len(list(skin.morphs)) > 50
    assert sorted(made) == sorted(mesh.name for mesh in person.meshes if mesh.morphs)


def test_a_child_has_hands_of_its_own_and_arms_that_go_with_its_body() -> None:
    child, woman = finished_character("child", character_named), character_named("woman_adult")
    assert child.hands_of is None
    assert child is finished_character("child", character_named)
    spans = [np.ptp(skin_at_rest(one, "left.hand"), axis=0) for one in (woman, child)]
    np.testing.assert_allclose(spans[1], originals()["child"].hands * spans[0], rtol=1e-3)
    arms_m = []
    for one in (woman, child):
        places = np.linalg.inv(one.joint_from_mesh[[one.skeleton.index(f"right{part}") for part in PARTS]])[:, :3, 3]
        arms_m.append(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
    # Shares of stature: nothing is stretched.
    assert arms_m[1] / 1.43 == pytest.approx(arms_m[0] / 1.68, rel=0.06)
    assert our_arm_m("child_hina") < our_arm_m("cast_yumi")


def test_children_are_made_from_the_child_within_its_ranges(tmp_path: Path) -> None:
    children = [id for id in bundled_people() if bundled_person(id).original == "child"]
    assert len(children) >= 3
    assert ranges(["child"]) == ((1.3, 1.58), (11.0, 15.0))
    table = {"original": "child", "name": {"en": "A", "ja": "A"}, "phenotype": {"height_m": 1.7, "age": 0.36}}
    path = tmp_path / "a.toml"
    path.write_text(toml(table), encoding="utf-8")
    with pytest.raises(MapError) as raised:
        read_person(path)
    assert raised.value.message.arguments["place"] == "phenotype.height_m"


def test_people_differ_and_are_named() -> None:
    assert len(our_characters()) >= 16
    names = [bundled_person(id).name for id in bundled_people()]
    assert len({name.en for name in names}) == len({name.ja for name in names}) == len(names)
    bodies = [(bundled_person(id).phenotype, bundled_person(id).colors["skin"]) for id in bundled_people()]
    assert len({body.height_m for body, _ in bodies}) > 10
    assert all(set(bundled_person(id).not_cast_for) <= set(bundled_maps()) for id in bundled_people())


def test_pupils_have_bodies_of_their_own_within_the_schools_statistics() -> None:
    table = tomllib.loads(ANATOMY.read_text(encoding="utf-8"))["stature"]
    pupils = [bundled_person(id) for id in bundled_people() if id.startswith("student_")]
    assert len(pupils) == 21
    for person in pupils:
        years = years_of(person.phenotype.age)
        assert 15.0 <= years < 19.0
        mean_cm, deviation_cm = table["women" if person.phenotype.sex else "men"][str(min(int(years), 17))]
        # The survey is of pupils in Japan.
        most = 2.0 if person.phenotype.asian > 0.9 else 2.5
        assert abs(100.0 * person.phenotype.height_m - mean_cm) < most * deviation_cm, person.name.en
    assert len({(one.original, one.phenotype.height_m) for one in pupils}) == len(pupils)
    assert len({(one.phenotype.age, one.phenotype.weight) for one in pupils}) == len(pupils)


def test_the_players_of_a_school_band_are_told_apart() -> None:
    shapes = body_shapes()
    years = years_in_title("県立西高等学校吹奏楽部")
    people = [bundled_person(id) for id in characters_for([[bundled_maps()["flute"]]] * 27, stage_arc(27), years)]
    faces = []
    for person in people:
        skin_m = body_m(shapes, whole_phenotype(person))[: np.searchsorted(shapes.vertices, SKIN_VERTICES)]
        faces.append(skin_m - skin_m[:, 1].max() * np.array([0.0, 1.0, 0.0]))
    head = np.min(faces, axis=0)[:, 1] > -0.22
    for (one, face), (other, beside) in combinations(zip(people, faces, strict=True), 2):
        off_m = (face - beside)[head]
        apart_mm = float(1000.0 * np.sqrt(np.square(off_m - off_m.mean(axis=0)).sum(axis=1).mean()))
        dyed = bool(np.abs(np.log(one.colors["hair"]) - np.log(other.colors["hair"])).max() > 0.25)
        looks = (one.original, one.hair) != (other.original, other.hair) or dyed
        taller = abs(one.phenotype.height_m - other.phenotype.height_m) > 0.015
        assert [apart_mm > 1.0, looks, taller].count(True) >= 2, (one.name.en, other.name.en, apart_mm)


@pytest.mark.parametrize(
    ("field", "value"),
    [("height_m", 0.4), ("age", 0.1), ("muscle", 1.2), ("weight", float("-1")), ("asian", -0.1)],
)
def test_a_person_that_cannot_be_is_refused(tmp_path: Path, field: str, value: float) -> None:
    table = {"original": "man_adult", "name": {"en": "A", "ja": "A"}, "phenotype": {"height_m": 1.7, field: value}}
    path = tmp_path / "a.toml"
    path.write_text(toml(table), encoding="utf-8")
    with pytest.raises(MapError) as raised:
        read_person(path)
    assert field in str(raised.value.message.arguments["place"])
