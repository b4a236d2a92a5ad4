"""Outfits of a piece: chosen by its kind, for players added later, and requested on the command line."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from app.errors import UsageError
from app.project.band_in_title import years_in_title
from app.project.casting import stage_arc
from app.project.character_choice import characters_for
from app.project.edit.outfits import colour_outfit, dress_everyone, give_outfit, with_outfits
from app.project.edit.players import add_player
from app.project.importing import import_project, usual_rows
from app.project.usual_outfits import common_outfit, outfit_of_piece
from app.rig.characters.character_library import our_characters
from app.rig.people.bundled_people import our_years
from app.rig.people.wardrobe import OutfitChoice
from app.score.contents import PieceContents
from app.score.read import read_contents
from instrument_maps.load import bundled_maps
from tests.support.wardrobe import wardrobe_in, write_outfit
from tests.unit.project.pieces import full_project, small_project


@pytest.fixture(scope="module", autouse=True)
def suits(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    folder = tmp_path_factory.mktemp("wardrobe")
    for id in ("concert_black", "jazz_suit", "marching", "school_blazer", "school_uniform"):
        write_outfit(folder / f"{id}.glb", id)
    with wardrobe_in(folder):
        yield


QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
MAPS = bundled_maps()


def contents_with(programs: list[int], drums: bool = True) -> PieceContents:
    """The quartet with additional silent tracks of these programs and a track of drums."""
    contents = read_contents(QUARTET)
    first = contents.channels[0]
    others = [
        msgspec.structs.replace(first, track=20 + index, program=program, name="", instrument_name="", reported=())
        for index, program in enumerate(programs)
    ]
    kit = [msgspec.structs.replace(first, track=40, use="rhythm", certain=True, name="", reported=())] * drums
    return msgspec.structs.replace(contents, channels=(*contents.channels, *others, *kit))


def test_a_piece_is_dressed_by_its_kind_and_as_it_is_told_to_be() -> None:
    contents = read_contents(QUARTET)
    for told, worn in ((None, "concert_black"), ("", ""), ("jazz_suit", "jazz_suit")):
        project = import_project(contents, usual_rows(contents, MAPS), MAPS, outfit=told)
        assert {player.outfit for player in project.players} == {OutfitChoice(worn)}


def test_winds_with_a_rhythm_section_play_jazz() -> None:
    for programs, drums, players, worn in (
        ([33, 0], True, 17, "jazz_suit"),
        ([33, 0], True, 40, "concert_black"),
        ([33, 0], False, 17, "concert_black"),
        ([33], True, 17, "concert_black"),
        ([0], True, 17, "concert_black"),
    ):
        assert outfit_of_piece(contents_with(programs, drums), players) == worn, (programs, drums, players)


@pytest.mark.parametrize(
    ("title", "worn"),
    [
        ("Fall Show 2026 - Lincoln High School Marching Band", "marching"),
        ("Drum Corps Warm-Up", "marching"),
        ("県大会 マーチングバンド部門", "marching"),
        ("Oakfield Middle School Symphonic Band - Warm-ups", "school_blazer"),
        ("県立西高等学校吹奏楽部 定期演奏会", "school_uniform"),
        ("第三中学校 校歌", "school_uniform"),
        ("Maple Elementary School Winter Songs", "school_blazer"),
        ("みなみ小学校 音楽会", "school_uniform"),
        ("Wedding March", "concert_black"),
        ("Stars and Stripes Forever (March)", "concert_black"),
        ("行進曲「威風堂々」", "concert_black"),
        ("High School Musical", "concert_black"),
        ("Old-school funk", "concert_black"),
        ("", "concert_black"),
    ],
)
def test_a_band_named_in_the_title_wears_its_uniform(title: str, worn: str) -> None:
    contents = msgspec.structs.replace(read_contents(QUARTET), title=title)
    assert outfit_of_piece(contents, 17) == worn


def test_a_schools_band_is_cast_with_young_people() -> None:
    def ages(title: str) -> list[float]:
        contents = msgspec.structs.replace(read_contents(QUARTET), title=title)
        project = import_project(contents, usual_rows(contents, MAPS), MAPS)
        return [our_years(player.character_id) for player in project.players]

    assert 14 <= min(ages("県立西高等学校吹奏楽部 定期演奏会")) <= max(ages("県立西高等学校吹奏楽部 定期演奏会")) < 28
    everyone = characters_for([[MAPS["flute"]]] * 40, stage_arc(40), years_in_title("Lincoln High School Band"))
    assert {14 <= our_years(id) < 28 for id in everyone} == {True}
    assert len({*everyone}) >= 27
    anyone = characters_for([[MAPS["trumpet_Bb"]]] * 40, stage_arc(40))
    assert max(our_years(id) for id in anyone) > 60
    children = [id for id in our_characters() if our_years(id) < 14]
    assert len({*anyone}) == 40
    assert len({*anyone} & {*children}) == 40 - (len(our_characters()) - len(children))


def test_who_comes_later_wears_what_most_do() -> None:
    project = small_project()
    assert common_outfit(replace(project, players=())) == OutfitChoice("concert_black")
    red = OutfitChoice("jazz_suit", "#aa0000")
    dressed = dress_everyone(project, red)
    more, id = add_player(dressed, MAPS["trumpet_Bb"], MAPS, "Horn")
    assert more.player(id).outfit == red


def test_outfits_and_colours_are_those_of_the_performers_named_and_nothing_else_changes() -> None:
    project = full_project()
    first, dancer = project.players[0].id, project.dancers[0].id
    worn = give_outfit(project, [first, dancer], "jazz_suit")
    assert worn.player(first).outfit == worn.dancer(dancer).outfit == OutfitChoice("jazz_suit")
    assert worn.players[1] is project.players[1]
    assert worn.corrections is project.corrections
    red = colour_outfit(worn, [first], "second", "#aa0000")
    assert red.player(first).outfit == OutfitChoice("jazz_suit", second="#aa0000")
    assert colour_outfit(red, [first], "second", "").player(first).outfit == OutfitChoice("jazz_suit")
    assert give_outfit(red, [first], "jazz_suit") is red, "it is worn already, in its colours"


def test_a_musician_wears_one_outfit_with_every_instrument() -> None:
    project = small_project()
    first, second = project.players
    doubling = replace(project, players=(first, msgspec.structs.replace(second, doubles=first.id)))
    worn = give_outfit(doubling, [second.id], "jazz_suit")
    assert {player.outfit.id for player in worn.players} == {"jazz_suit"}


def told(*texts: str) -> list[OutfitChoice]:
    return [one.outfit for one in with_outfits(small_project(), texts).performers]


def test_outfits_in_words_are_of_everyone_or_of_those_named() -> None:
    assert told("jazz_suit") == 2 * [OutfitChoice("jazz_suit")]
    assert told("jazz_suit", "tromb*=concert_black,#AA0000,,#ffffff") == [
        OutfitChoice("jazz_suit"),
        OutfitChoice("concert_black", "#AA0000", "", "#ffffff"),
    ]
    assert told("jazz_suit", "trumpet=own") == [OutfitChoice(), OutfitChoice("jazz_suit")]
    unknown = ("sailor", "tuba=jazz_suit", "x=", "=polo", "")
    for wrong in (*unknown, "jazz_suit,red", "jazz_suit,#000,#000000", "own,#000000"):
        with pytest.raises(UsageError):
            told(wrong)
