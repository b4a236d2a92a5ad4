"""Hair, skin and colours of people: separate styles and textures on other bodies."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from app.errors import MapError
from app.formats.texture_colors import linear, sampled
from app.rig.characters.character_library import character_named
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.people.bundled_people import bundled_people, bundled_person, person_of
from app.rig.people.make_person import NEUTRAL_MEANS
from app.rig.people.person import checked, hair_styles, skins
from app.rig.skinning import mesh_named


def _triangles(mesh: Mesh) -> int:
    return len(mesh.triangles)


def _person(**changes: object) -> Character:
    person = msgspec.structs.replace(bundled_person("cast_marie"), **changes)
    return person_of("someone", person, character_named)


@pytest.mark.parametrize("style", hair_styles())
def test_a_style_of_hair_sits_on_the_head_of_another_body(style: str) -> None:
    person = _person(hair=style)
    hair, head = mesh_named(person, "hair"), mesh_named(person, "body")
    assert 500 < _triangles(hair) < 8000
    scalp = head.positions_m[:, 1].max()
    assert -0.02 < hair.positions_m[:, 1].max() - scalp < 0.06, "on top of the head, not above or in it"
    assert abs(np.ptp(hair.positions_m[:, 0]) / 2 + hair.positions_m[:, 0].min()) < 0.03, "about the middle"
    assert hair.materials[0].alpha_mode == "mask"
    assert hair.materials[0].textures.color is not None
    assert np.ptp(hair.uvs[hair.triangles], axis=1).max() < 0.3, "no face goes around the edge of its picture"


@pytest.mark.parametrize("style", hair_styles())
def test_no_hair_hangs_before_an_eye(style: str) -> None:
    person = _person(hair=style)
    hair = mesh_named(person, "hair")
    for side in ("left", "right"):
        eye_m = np.linalg.inv(person.joint_from_mesh[person.skeleton.index(f"{side}Eye")])[:3, 3]
        off_m = hair.positions_m[hair.triangles].mean(axis=1) - eye_m
        before = (off_m[:, 2] > 0.0) & (np.abs(off_m[:, 0]) < 0.012) & (np.abs(off_m[:, 1]) < 0.008)
        assert not before.any(), f"{before.sum()} faces of hair before the {side} eye"


@pytest.mark.parametrize("skin", skins())
def test_a_skin_by_itself_takes_the_place_of_the_body_s(skin: str) -> None:
    before, after = (mesh_named(_person(skin=name), "body").materials[0] for name in ("", skin))
    assert before.textures.color is not None
    assert after.textures.color is not None
    assert after.textures.color.texture != before.textures.color.texture
    assert replace(after, textures=before.textures) == before


def test_colours_are_what_is_seen_of_neutral_textures() -> None:
    person, wanted = _person(), bundled_person("cast_marie").colors
    for material in (material for mesh in person.meshes for material in mesh.materials):
        if material.name in wanted and material.name in NEUTRAL_MEANS:
            tinted = np.array(material.base_color[:3]) * NEUTRAL_MEANS[material.name]
            assert tinted == pytest.approx(np.minimum(wanted[material.name], NEUTRAL_MEANS[material.name]))
    body = mesh_named(person, "body")
    lips_m = body.positions_m[person.landmarks["lips.contact"].vertices].mean(axis=0)
    material = body.materials[0]
    cheeks = np.linalg.norm(body.positions_m - lips_m - [0.035, 0.035, -0.02], axis=1) < 0.02
    assert material.textures.color is not None
    assert body.uvs is not None
    seen = sampled(material.textures.color, body.uvs[cheeks])
    assert seen is not None
    # The median: nostrils and the mouth's inside lie near.
    assert np.median(linear(seen[:, :3]), axis=0).mean() == pytest.approx(NEUTRAL_MEANS["skin"], rel=0.2)


def test_people_differ_in_their_hair_and_what_is_unknown_is_refused() -> None:
    people = [bundled_person(id) for id in bundled_people()]
    assert len({(person.original, person.hair) for person in people}) >= 8
    assert {person.hair for person in people} - {""} == set(hair_styles())
    for field in ("hair", "skin"):
        with pytest.raises(MapError):
            checked(msgspec.structs.replace(people[0], **{field: "none_such"}), "x.toml")
