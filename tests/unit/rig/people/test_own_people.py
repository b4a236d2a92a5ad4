"""The user's own people: made from a bundled body by a table in the folder of characters."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from app.errors import MapError
from app.performance.bodies import is_strained, model_of, suited_to
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.performers import Player
from app.rig.characters.character_library import (
    FOLDER_VARIABLE,
    add_person,
    character_library,
    character_named,
    character_problems,
    reload_characters,
    remove_character,
)
from app.rig.grip.carriage import carried_by
from app.rig.people.body_shapes import Phenotype, age_of
from app.rig.people.bundled_people import bundled_person, like, not_cast_for, person_of
from app.rig.people.person import Person
from app.rig.skeleton import rest_positions
from instrument_maps.hold import Carriage
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    reload_characters()
    return tmp_path


def taller(person: Person, height_m: float) -> Person:
    return msgspec.structs.replace(person, phenotype=msgspec.structs.replace(person.phenotype, height_m=height_m))


def test_a_person_is_kept_made_and_removed(folder: Path) -> None:
    id = add_person(taller(bundled_person("cast_marie"), 1.75), "My  Marie")
    assert id == "my_marie"
    assert character_library().own[id].title == "My Marie"
    assert [path.name for path in folder.iterdir()] == ["my_marie.toml"]
    eyes_m = [
        rest_positions(character_named(one).skeleton)[character_named(one).skeleton.index("leftEye"), 1]
        for one in ("cast_marie", id)
    ]
    assert eyes_m[1] - eyes_m[0] == pytest.approx(0.075, abs=0.02)
    remove_character(id)
    assert list(folder.iterdir()) == []
    assert id not in character_library().sources


def test_a_person_plays_the_instruments_of_the_finished_body(folder: Path) -> None:
    id = add_person(taller(bundled_person("cast_yumi"), 1.5), "Small")
    player = Player("p", "", "", "trumpet_Bb", id, PlayerParameters(), StagePosition(0.0, 0.0, 0.0))
    trumpet = bundled_maps()["trumpet_Bb"]
    assert suited_to(player, trumpet).instrument is trumpet


@pytest.mark.parametrize(
    "text",
    [
        'file = "a.glb"\n[person]\noriginal = "man_adult"\n[person.phenotype]\nheight_m = 1.7\n',
        '[person]\noriginal = "nobody"\n[person.phenotype]\nheight_m = 1.7\n',
        '[person]\noriginal = "man_adult"\n[person.phenotype]\nheight_m = 17.0\n',
        'title = "neither"\n',
    ],
)
def test_a_table_that_makes_no_one_is_reported(folder: Path, text: str) -> None:
    (folder / "odd.toml").write_text(text, encoding="utf-8")
    reload_characters()
    assert "odd" not in character_library().sources
    assert "odd" in character_problems()


def test_a_person_that_cannot_be_is_not_kept(folder: Path) -> None:
    with pytest.raises(MapError):
        add_person(Person("man_adult", Phenotype(3.0)), "Giant")
    assert list(folder.iterdir()) == []


def test_a_small_person_carries_an_instrument_within_its_range(folder: Path) -> None:
    horn = bundled_maps()["english_horn"]
    shares = bundled_person("cast_yumi").carriages["english_horn"]
    id = add_person(bundled_person("cast_yumi"), "Like Yumi")
    for one in ("cast_yumi", id):
        player = Player("p", "", "", horn.id, one, PlayerParameters(), StagePosition(0.0, 0.0, 0.0))
        carried = suited_to(player, horn).instrument
        assert carried is not horn
        assert suited_to(player, horn).instrument is carried
        assert model_of(carried) is model_of(horn)
        for posture in horn.hold.postures:
            usual, own = horn.hold.carriage(posture), carried.hold.carriage(posture)
            for share, before, after in zip(shares, ranges_of(usual), ranges_of(own), strict=True):
                low, middle, high = before
                end = high if share > 0.0 else low
                assert after == (low, pytest.approx(middle + abs(share) * (end - middle)), high)


def ranges_of(carriage: Carriage) -> tuple[tuple[float, ...], ...]:
    return carriage.pitch_down_deg, carriage.yaw_left_deg, carriage.roll_left_deg


def test_a_body_far_smaller_than_its_hands_is_strained() -> None:
    clarinet = bundled_maps()["clarinet_Bb"]
    small = person_of("small", taller(bundled_person("cast_yumi"), 1.41), character_named)
    assert is_strained(small, clarinet)
    assert not is_strained(character_named("cast_marie"), clarinet)
    assert not is_strained(character_named("woman_adult"), clarinet)


def test_whoever_bends_wrists_no_further_than_those_who_were_checked_is_not_strained() -> None:
    maps = bundled_maps()
    old = person_of("old", like("cast_thomas", {"age": age_of(88.0)}), character_named)
    assert [name for name in ("oboe", "clarinet_Bb", "flute", "english_horn") if is_strained(old, maps[name])] == []
    for id, name in (("cast_henry", "oboe"), ("cast_sachiko", "clarinet_bass_Bb"), ("child_leo", "clarinet_Bb")):
        assert name not in not_cast_for(id)
        assert not is_strained(character_named(id), carried_as(id, name)), (id, name)
    child = person_of("child", like("child_nia", {}), character_named)
    assert is_strained(child, maps["flute"]), "no child is cast for it"


def carried_as(id: str, name: str) -> InstrumentMap:
    shares = bundled_person(id).carriages.get(name)
    return bundled_maps()[name] if shares is None else carried_by(bundled_maps()[name], shares)
