"""Looks by age: hair, brows and skin of a person made older or younger than the one it is like."""

from __future__ import annotations

from itertools import pairwise

import msgspec
import numpy as np
import pytest

from app.formats.images import decoded, size_px
from app.formats.texture_colors import linear
from app.rig.characters.character_library import character_named
from app.rig.people.body_shapes import age_of
from app.rig.people.bundled_people import bundled_people, bundled_person, like, our_years, person_of
from app.rig.people.looks_by_age import GREY_YEARS, colors_by_age
from app.rig.people.make_person import NEUTRAL_MEANS
from app.rig.people.person import Person, originals, skins
from app.rig.skinning import mesh_named

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
DARK = [id for id in bundled_people() if our_years(id) < 45.0]


def aged(id: str, years: float) -> Person:
    return like(id, {"age": age_of(years)})


def lightness(person: Person, name: str) -> float:
    return float(LUMINANCE @ np.array(colors_by_age(person)[name]))


def skin_pixels(person: Person) -> np.ndarray:
    body = mesh_named(person_of("someone", person, character_named), "body")
    use = body.materials[0].textures.color
    assert use is not None
    pixels = decoded(use.texture, 8192)
    assert pixels is not None
    return pixels[..., :3].astype(np.float64)


@pytest.mark.parametrize("id", [id for id in DARK if not id.startswith("child")])
def test_hair_turns_grey_as_people_s_does(id: str) -> None:
    for name in ("hair", "brows"):
        by_age = [lightness(aged(id, years), name) for years in range(16, 91)]
        assert all(later > earlier - 1e-12 for earlier, later in pairwise(by_age)), name
        assert max(by_age[:19]) == pytest.approx(by_age[0]), f"{name}: nothing before 35"
        assert by_age[88 - 16] > by_age[60 - 16] > by_age[45 - 16]
    young, half, most = (np.cbrt(lightness(aged(id, years), "hair")) for years in (30.0, 60.0, 80.0))
    white = np.cbrt(0.59)
    assert (half - young) / (white - young) == pytest.approx(0.5, abs=0.06), "as it is perceived"
    assert (most - young) / (white - young) > 0.85


@pytest.mark.parametrize("id", bundled_people())
def test_nobody_looks_otherwise_at_their_own_age(id: str) -> None:
    person = bundled_person(id)
    assert colors_by_age(person) == person.colors
    same = like(id, {})
    if same.looks_years < GREY_YEARS[0]:
        assert colors_by_age(same) == person.colors
    for name, color in colors_by_age(same).items():
        assert color == pytest.approx(person.colors[name])
    near = [msgspec.structs.replace(same, looks_years=same.looks_years + step) for step in (-0.1, 0.1)]
    for one in near:
        assert lightness(one, "hair") == pytest.approx(lightness(person, "hair"), abs=0.02)


def test_who_is_grey_already_gets_dark_hair_when_made_young() -> None:
    for id in ("cast_henry", "cast_sachiko", "cast_kenji"):
        assert lightness(aged(id, 25.0), "hair") < 0.05
        assert lightness(aged(id, 88.0), "hair") >= lightness(bundled_person(id), "hair")


def test_chosen_colours_are_kept_at_any_age() -> None:
    dyed = msgspec.structs.replace(aged("cast_marie", 88.0), looks_years=0.0)
    assert colors_by_age(dyed) == bundled_person("cast_marie").colors
    np.testing.assert_array_equal(skin_pixels(dyed), skin_pixels(bundled_person("cast_marie")))


@pytest.mark.parametrize(("id", "old"), [("cast_marie", "cast_sachiko"), ("cast_thomas", "cast_henry")])
def test_old_skin_is_that_of_old_people(id: str, old: str) -> None:
    young = skin_pixels(bundled_person(id))
    expected = skin_pixels(bundled_person(old))
    between = [np.abs(skin_pixels(aged(id, years)) - expected).mean() for years in (45.0, 58.0, 70.0)]
    assert np.abs(young - expected).mean() > between[0] > between[1] > between[2]
    assert between[2] < 0.3 * np.abs(young - expected).mean()
    back = skin_pixels(aged(old, 20.0))
    assert np.abs(back - skin_pixels(msgspec.structs.replace(bundled_person(id), skin=""))).mean() < 2.0


@pytest.mark.parametrize("id", ["cast_marie", "cast_thomas", "cast_grace", "cast_samuel"])
def test_lines_grow_deeper_to_the_last(id: str) -> None:
    young = skin_pixels(aged(id, 30.0))
    changes = [np.abs(skin_pixels(aged(id, years)) - young).mean() for years in (45.0, 60.0, 75.0, 90.0)]
    assert all(later > earlier + 0.3 for earlier, later in pairwise([0.0, *changes])), changes


def test_dark_skin_ages_and_stays_dark() -> None:
    before, after = skin_pixels(bundled_person("cast_grace")), skin_pixels(aged("cast_grace", 88.0))
    assert 4.0 < np.abs(after - before).mean() < 25.0
    assert after.mean() == pytest.approx(before.mean(), rel=0.1)


def test_what_is_seen_of_an_old_person_is_grey() -> None:
    person = person_of("someone", aged("student_ren", 88.0), character_named)
    hair = mesh_named(person, "hair").materials[0]
    use = hair.textures.color
    assert use is not None
    pixels = decoded(use.texture, 8192)
    assert pixels is not None
    seen = linear(pixels[pixels[..., 3] > 128][:, :3] / 255.0) * hair.base_color[:3]
    assert seen.mean() > 1.3 * NEUTRAL_MEANS["hair"]
    assert np.ptp(seen.mean(axis=0)) < 0.06


def test_all_skins_have_one_layout() -> None:
    named = [name for table in originals().values() for name in table.aged_skins]
    assert set(named) <= set(skins())
    for id in ("man_adult", "woman_adult"):
        assert list(originals()[id].aged_skins.values()) == sorted(originals()[id].aged_skins.values())
        body = mesh_named(character_named(id), "body").materials[0].textures.color
        assert body is not None
        assert size_px(body.texture) == (1024, 1024)
