"""Sections of players by instrument family, for any instruments."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import pytest

from app.project.edit.players import order_players
from app.project.model import Project
from app.project.player_sections import GROUPED_FROM, are_worth_grouping, in_sections_of, sections
from tests.support.doubled import flutist


def _playing(*instrument_ids: str) -> Project:
    project = flutist()
    player = project.players[0]
    players = tuple(
        msgspec.structs.replace(player, id=f"p{number}", instrument_id=instrument_id)
        for number, instrument_id in enumerate(instrument_ids)
    )
    return replace(project, players=players)


def test_every_player_is_in_one_section_in_the_order_of_the_project() -> None:
    project = _playing("flute", "horn_double_F_Bb", "piccolo", "no such map", "trumpet_C", "flute")
    assert [(section.family, section.player_ids) for section in sections(project)] == [
        ("flutes", ("p0", "p2", "p5")),
        ("horns", ("p1",)),
        ("", ("p3",)),
        ("trumpets", ("p4",)),
    ]
    assert in_sections_of(project, ["p2", "p4"]) == ("p0", "p2", "p4", "p5")


@pytest.mark.parametrize(
    ("instruments", "grouped"),
    [
        (["flute"] * 3 + ["oboe"] * (GROUPED_FROM - 4), False),
        (["flute"] * GROUPED_FROM, False),
        (["flute", "oboe", "clarinet_Bb", "bassoon", "horn_double_F_Bb", "tuba_F"], False),
        (["flute", "oboe", "clarinet_Bb", "bassoon", "horn_double_F_Bb", "clarinet_A"], True),
    ],
    ids=("few", "one section", "soloists", "sextet"),
)
def test_a_list_is_grouped_where_some_sections_have_several_players(instruments: list[str], grouped: bool) -> None:
    assert are_worth_grouping(_playing(*instruments)) is grouped


def test_players_in_another_order_take_the_places_that_they_had() -> None:
    project = _playing("flute", "oboe", "flute", "oboe", "flute")
    ordered = order_players(project, ("p4", "p0", "p2"))
    assert [player.id for player in ordered.players] == ["p4", "p1", "p0", "p3", "p2"]
    assert order_players(project, ("p0", "p2", "p4")) is project
