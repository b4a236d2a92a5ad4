"""Edits of players."""

from __future__ import annotations

from dataclasses import replace
from statistics import mean, pstdev

import pytest

from app.errors import AppError
from app.plan.by_hand.corrections import PinFingering
from app.project.casting import StagePosition, stage_arc
from app.project.edit import players as edit
from app.project.edit.corrections import with_corrections
from app.project.model import Project, map_choices, project_from_score
from app.score.assignments import PartAssignment
from app.score.model import Note, Part, Score
from app.score.parts import assigned_parts
from app.score.tempo import TempoMap
from app.score.track_channel import TrackChannel
from instrument_maps.load import bundled_maps

MAPS = bundled_maps()
TRUMPET, TROMBONE = "trumpet_Bb", "trombone_tenor_F_attachment"


@pytest.fixture
def trio() -> Project:
    parts = tuple(
        Part(f"{n}.1.1", name, n, 0, n - 1, None, None, map_id, (Note(f"{n}:1", 0, 480, 60, 80),))
        for n, (name, map_id) in enumerate([("First", TRUMPET), ("Second", TRUMPET), ("Low", TROMBONE)], 1)
    )
    return project_from_score(Score("t", 480, TempoMap(480), parts=parts), MAPS, seed=3)


def names(project: Project) -> list[str]:
    return [player.name for player in project.players]


def test_what_changes_nothing_is_the_same_value(trio: Project) -> None:
    first = trio.players[0]
    assert edit.change(trio, (first.id,), muted=False) is trio
    assert edit.set_parameters(trio, (first.id,), amplitude=first.parameters.amplitude) is trio
    assert edit.rename(trio, first.id, "First") is trio
    assert edit.arrange(trio) is trio
    assert edit.reset_parameters(trio, [player.id for player in trio.players]) is trio
    assert edit.move_players(trio, (first.id,), 1) is trio


def test_names_stay_unique_and_visible(trio: Project) -> None:
    first, second, low = (player.id for player in trio.players)
    assert names(edit.rename(trio, second, "FIRST")) == ["First", "FIRST 2", "Low"]
    assert names(edit.rename(trio, low, "Low\n 2")) == ["First", "Second", "Low 2"]
    with pytest.raises(AppError, match=r"player\.no_name"):
        edit.rename(trio, first, " \u0007 ")


def test_parameters_are_held_in_bounds_and_reset_to_the_cast(trio: Project) -> None:
    first, second, _ = trio.players
    changed = edit.set_parameters(trio, (first.id, second.id), amplitude=4.0, lung_s=0.0, cue_leader=True)
    assert changed.player(first.id).parameters.amplitude == 1.0
    assert changed.player(second.id).parameters.lung_s == 1.0
    assert changed.players[2] is trio.players[2]
    partly = edit.reset_parameters(changed, (first.id,), ["amplitude"])
    assert partly.player(first.id).parameters.amplitude == first.parameters.amplitude
    assert partly.player(first.id).parameters.lung_s == 1.0
    assert edit.reset_parameters(changed, (first.id, second.id)) == trio


def test_randomising_spreads_about_the_middle(trio: Project) -> None:
    everyone = [player.id for player in trio.players]
    quiet = edit.set_parameters(trio, everyone, amplitude=0.3)
    spread = edit.randomise(quiet, everyone, 0.3)
    amplitudes = [player.parameters.amplitude for player in spread.players]
    assert mean(amplitudes) == pytest.approx(0.3, abs=0.02)
    assert len(set(amplitudes)) == 3
    assert max(abs(amplitude - 0.3) for amplitude in amplitudes) <= 0.3
    again = edit.randomise(spread, everyone, 0.3)
    assert [player.parameters.amplitude for player in again.players] != amplitudes
    assert edit.randomise(quiet, everyone, 0.3) == spread
    wide = edit.randomise(quiet, everyone, 0.6)
    assert pstdev(player.parameters.sway for player in wide.players) > pstdev(
        player.parameters.sway for player in spread.players
    )
    even = edit.randomise(spread, everyone, 0.0)
    assert len({player.parameters.amplitude for player in even.players}) == 1
    assert len({player.parameters.seed for player in even.players}) == 3


def test_a_newcomer_has_an_empty_part_and_joins_the_arc(trio: Project) -> None:
    more, player_id = edit.add_player(trio, MAPS[TROMBONE], MAPS, "Low")
    player = more.player(player_id)
    assert player.name == "Low 2"
    assert more.part(player).notes == ()
    assert more.part(player).channel not in {part.channel for part in trio.score.parts}
    assert tuple(one.stage for one in more.players) == stage_arc(4)
    moved = edit.place(trio, {trio.players[0].id: StagePosition(-9.0, 0.0, 0.0)})
    more, player_id = edit.add_player(moved, MAPS[TRUMPET], MAPS, "New")
    assert more.players[0].stage.x_m == -9.0
    assert more.player(player_id).stage.x_m > max(one.stage.x_m for one in moved.players)
    empty = replace(trio, players=(), score=Score("t", 480, TempoMap(480)))
    assert edit.add_player(empty, MAPS[TRUMPET], MAPS, "")[0].players[0].stage == StagePosition(0.0, 0.0, 0.0)


def test_a_double_plays_the_same_part_as_a_user_else(trio: Project) -> None:
    first, second, _ = trio.players
    pinned = with_corrections(trio, first.id, [PinFingering("1:1", "13")])
    more, ids = edit.duplicate_players(pinned, (second.id, first.id))
    assert names(more) == ["First", "First 2", "Second", "Second 2", "Low"]
    double = more.players[1]
    assert ids == (double.id, more.players[3].id)
    part, copy = more.part(first), more.part(double)
    assert copy is not part
    assert [(note.pitch, note.onset_tick) for note in copy.notes] == [
        (note.pitch, note.onset_tick) for note in part.notes
    ]
    assert len({note.id for part in more.score.parts for note in part.notes}) == 5
    assert double.parameters.seed != first.parameters.seed
    assert more.corrections[double.id] == (PinFingering(copy.notes[0].id, "13"),)
    assert edit.remove_players(more, ids) == pinned
    assert tuple(one.stage for one in more.players) == stage_arc(5)


def test_a_player_may_be_given_another_part(trio: Project) -> None:
    first, second, _ = trio.players
    given = edit.assign(trio, [first.id], part_id=second.part_id)
    assert given.part(given.player(first.id)) is trio.part(second)
    assert len(given.score.parts) == 3
    assert edit.assign(given, [first.id], part_id=first.part_id) == trio
    assert edit.assign(trio, [first.id], part_id=first.part_id) is trio
    more, new = edit.add_player(trio, MAPS[TRUMPET], MAPS, "New")
    assert len(edit.assign(more, [new], part_id=first.part_id).score.parts) == 3
    with pytest.raises(AppError, match=r"player\.no_part"):
        edit.assign(trio, [first.id], part_id="nowhere")


def test_an_instrument_that_is_not_there_is_assigned_to_no_one(trio: Project) -> None:
    """The message is the same for a player in a project and for a track of a file."""
    first = trio.players[0]
    assert edit.assign(trio, [first.id], instrument_id="flute").player(first.id).instrument_id == "flute"
    with pytest.raises(AppError, match=r"assign\.instrument_unknown") as caught:
        edit.assign(trio, [first.id], instrument_id="flut")
    stream = TrackChannel(0, 0, "Lead", "", None, [0], [480], [70], [80], [1], ())
    with pytest.raises(AppError) as read:
        assigned_parts([stream], [PartAssignment((0,), "flut")], map_choices(MAPS.values()), trio.score)
    assert read.value.message == caught.value.message


def test_the_empty_part_of_before_goes_with_several_players_too(trio: Project) -> None:
    one, new = edit.add_player(trio, MAPS[TRUMPET], MAPS, "New")
    two, other = edit.add_player(one, MAPS[TRUMPET], MAPS, "Newer")
    given = edit.assign(two, [new, other], part_id=trio.players[0].part_id)
    assert given.score.parts == trio.score.parts


def test_who_leaves_takes_the_corrections_along_but_not_the_music(trio: Project) -> None:
    first = trio.players[0]
    pinned = with_corrections(trio, first.id, [PinFingering("1:1", "13")])
    fewer = edit.remove_players(pinned, (first.id,))
    assert names(fewer) == ["Second", "Low"]
    assert fewer.corrections == {}
    assert len(fewer.score.parts) == 3
    more, player_id = edit.add_player(trio, MAPS[TRUMPET], MAPS, "New")
    assert edit.remove_players(more, (player_id,)) == trio


def test_the_order_is_the_users_and_the_arc_follows(trio: Project) -> None:
    first, second, low = (player.id for player in trio.players)
    turned = edit.move_players(trio, (first, second), 3)
    assert names(turned) == ["Low", "First", "Second"]
    assert tuple(one.stage for one in turned.players) == stage_arc(3)
    assert names(edit.move_players(trio, (low, first), 1)) == ["First", "Low", "Second"]
