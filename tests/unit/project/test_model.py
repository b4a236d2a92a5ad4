"""From a score to a cast."""

from __future__ import annotations

import msgspec
import pytest

from app.errors import UsageError
from app.project.edit.players import cast_parameters
from app.project.model import Project, map_choices, project_from_score, with_settings
from app.project.parameters import parse_settings
from app.rig.characters.character_library import bundled_characters, our_characters
from app.score.model import Note, Part, Score
from app.score.tempo import TempoChange, TempoMap
from instrument_maps.load import bundled_maps

MAPS = bundled_maps()
TRUMPET, TROMBONE = "trumpet_Bb", "trombone_tenor_F_attachment"


def score(*parts: tuple[str, str]) -> Score:
    made = tuple(
        Part(f"{n}.1.1", name, n, 0, 0, None, None, map_id, (Note(f"{n}:1", 0, 480, 60, 80),))
        for n, (name, map_id) in enumerate(parts, 1)
    )
    return Score("t", 480, TempoMap.of_changes(480, [TempoChange(0, 500_000)]), parts=made)


@pytest.fixture
def quartet() -> Project:
    return project_from_score(
        score(("Trumpet", TRUMPET), ("trumpet", TRUMPET), ("Pos.", TROMBONE), ("Bass", TROMBONE)), MAPS, seed=3
    )


def test_everyone_is_a_user_else(quartet: Project) -> None:
    assert [player.name for player in quartet.players] == ["Trumpet 1", "trumpet 2", "Pos.", "Bass"]
    assert len({player.id for player in quartet.players}) == 4
    assert len({player.stage for player in quartet.players}) == 4
    assert len({player.parameters.seed for player in quartet.players}) == 4
    assert len({player.parameters.amplitude for player in quartet.players}) == 4
    assert len({player.character_id for player in quartet.players} & set(our_characters())) == 4
    assert [quartet.part(player).name for player in quartet.players] == ["Trumpet", "trumpet", "Pos.", "Bass"]


def test_the_same_score_is_cast_the_same_way(quartet: Project) -> None:
    again = project_from_score(quartet.score, MAPS, seed=3)
    assert again.players == quartet.players
    other = project_from_score(quartet.score, MAPS, seed=4)
    assert [p.parameters.seed for p in other.players] != [p.parameters.seed for p in quartet.players]
    assert [p.stage for p in other.players] == [p.stage for p in quartet.players]


def test_settings_touch_only_whom_they_name(quartet: Project) -> None:
    names = [player.name for player in quartet.players]
    texts = ["Bass.amplitude=1", "Bass.instrument=trumpet_Bb", "Bass.character=woman_adult", "Pos..posture=seated"]
    changed = with_settings(quartet, parse_settings(texts, names, MAPS, bundled_characters()), MAPS)
    assert changed.players[:2] == quartet.players[:2]
    assert changed.players[2].parameters.posture == "seated"
    assert changed.players[3].instrument_id == TRUMPET
    assert changed.players[3].character_id == "woman_adult"
    assert changed.players[3].parameters.amplitude == 1.0
    assert changed.players[3].parameters.seed == quartet.players[3].parameters.seed
    assert quartet.players[3].instrument_id == TROMBONE  # the project before is as it was


def test_a_score_without_players() -> None:
    assert project_from_score(score(), MAPS).players == ()


def test_the_reader_learns_what_the_maps_are_for() -> None:
    choices = {choice.map_id: choice for choice in map_choices(MAPS.values())}
    assert set(choices) == set(MAPS)
    assert "trumpet" in choices[TRUMPET].plays
    assert choices[TRUMPET].concert_low == MAPS[TRUMPET].range.low


def test_an_instrument_that_is_only_played_seated_is(quartet: Project) -> None:
    hold = msgspec.structs.replace(MAPS[TROMBONE].hold, standing=None, lowered_standing=None)
    maps = {**MAPS, TROMBONE: msgspec.structs.replace(MAPS[TROMBONE], hold=hold)}
    cast = project_from_score(quartet.score, maps)
    assert [player.parameters.posture for player in cast.players] == ["standing", "standing", "seated", "seated"]
    names = [player.name for player in cast.players]
    settings = parse_settings(["Bass.posture=standing"], names, maps, bundled_characters())
    with pytest.raises(UsageError) as caught:
        with_settings(cast, settings, maps)
    assert caught.value.message.id == "set.posture_impossible"
    assert caught.value.message.arguments == {
        "player": "Bass", "instrument": TROMBONE, "value": "standing", "possible": "seated",
    }  # fmt: skip
    # On another instrument the same player may stand.
    settings = parse_settings(
        ["Bass.posture=standing", f"Bass.instrument={TRUMPET}"], names, maps, bundled_characters()
    )
    assert with_settings(cast, settings, maps).players[3].parameters.posture == "standing"


@pytest.mark.parametrize(("count", "posture"), [(12, "standing"), (13, "seated")])
def test_a_few_stand_and_a_band_sits(quartet: Project, count: int, posture: str) -> None:
    part = quartet.score.parts[0]
    parts = tuple(msgspec.structs.replace(part, id=str(number)) for number in range(count))
    band = project_from_score(msgspec.structs.replace(quartet.score, parts=parts), MAPS)
    assert {player.parameters.posture for player in band.players} == {posture}
    assert {cast_parameters(band, player.id, MAPS[TRUMPET]).posture for player in band.players} == {posture}
