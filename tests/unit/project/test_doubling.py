"""One musician with several instruments: data of the musician, joining, separating, and refused cases."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from app.errors import AppError, FileError
from app.project.casting import StagePosition
from app.project.doubling import together_s
from app.project.edit import players as edit
from app.project.edit.generation import vary_players
from app.project.model import project_from_score, with_settings
from app.project.parameters import ParameterSetting
from app.project.performers import Player
from app.project.reimport import reimport
from app.project.storage import load, save
from app.score.model import Note, Score
from app.score.tempo import TempoMap
from instrument_maps.load import bundled_maps
from tests.support.doubled import QUARTER, flutist, notes, part

MAPS = bundled_maps()


def body(player: Player) -> tuple[object, ...]:
    return player.character_id, player.parameters, player.stage


def test_a_track_that_changes_instruments_is_cast_as_one_musician() -> None:
    project = flutist()
    flute, piccolo, oboe = project.players
    assert [player.doubles for player in project.players] == ["", flute.id, ""]
    assert project.bodies == (flute, oboe)
    assert project.played_by(piccolo) == project.played_by(flute) == (flute, piccolo)
    assert body(piccolo) == body(flute)
    alone = project_from_score(msgspec.structs.replace(project.score, parts=project.score.parts[::2]), MAPS)
    assert [player.stage for player in project.bodies] == [player.stage for player in alone.players]
    assert [player.character_id for player in project.bodies] == [player.character_id for player in alone.players]


def test_parts_that_sound_at_once_or_ask_for_other_postures_are_two_musicians() -> None:
    at_once = (
        part("flute", "Flute", 0, notes(1, 1, (0, 1), (72,))),
        part("piccolo", "Piccolo", 1, notes(1, 9, (1, 2), (86,))),
    )
    project = project_from_score(Score("t", QUARTER, TempoMap(QUARTER), parts=at_once), MAPS)
    assert len(project.bodies) == 2
    seated = next(id for id, one in MAPS.items() if one.hold.postures == ("seated",))
    hold = msgspec.structs.replace(MAPS["flute"].hold, seated=None, lowered_seated=None)
    maps = {**MAPS, "flute": msgspec.structs.replace(MAPS["flute"], hold=hold)}
    apart = (part(seated, "A", 0, notes(1, 1, (0,), (50,))), part("flute", "B", 1, notes(1, 9, (4,), (72,))))
    project = project_from_score(Score("t", QUARTER, TempoMap(QUARTER), parts=apart), maps)
    assert len(project.bodies) == 2


def test_how_long_lines_sound_at_once_counts_every_moment_once() -> None:
    clock = TempoMap(QUARTER)
    long = [Note("1", 0, 4 * QUARTER, 60, 80), Note("2", QUARTER, QUARTER, 64, 80)]
    short = [Note("3", QUARTER, QUARTER, 70, 80), Note("4", 3 * QUARTER, 2 * QUARTER, 70, 80)]
    # Brute force: every tick of both.
    sounding = [{tick for one in line for tick in range(one.onset_tick, one.end_tick)} for line in (long, short)]
    assert together_s([long], short, clock) == pytest.approx(len(sounding[0] & sounding[1]) * 0.5 / QUARTER)
    assert together_s([short], long, clock) == together_s([long], short, clock)


def test_six_instruments_by_turns_are_compared_in_the_order_of_time() -> None:
    """Comparing every note with all later ones takes minutes for 60,000 notes."""
    clock = TempoMap(QUARTER)
    lines = [[Note(f"{line}:{at}", (6 * at + line) * 10, 10, 60, 80) for at in range(20_000)] for line in range(6)]
    start_s = time.process_time()
    assert together_s(lines[:5], lines[5], clock) == 0.0
    assert together_s(lines[:5], [msgspec.structs.replace(note, duration_tick=20) for note in lines[5]], clock) > 1.0
    assert time.process_time() - start_s < 20.0


def test_what_is_changed_of_one_instrument_is_changed_of_the_musician() -> None:
    project = flutist()
    flute, piccolo, oboe = (player.id for player in project.players)
    changes = [
        edit.set_parameters(project, (piccolo,), amplitude=0.9),
        edit.change(project, (piccolo,), character_id="woman_adult"),
        edit.place(project, {piccolo: StagePosition(3.0, 1.0, 0.2)}),
        edit.randomise(project, (piccolo, oboe), 1.0),
        vary_players(project, (piccolo,)),
    ]
    for changed in changes:
        assert body(changed.player(flute)) == body(changed.player(piccolo)) != body(project.player(flute))
    back = edit.reset_parameters(changes[0], (piccolo,))
    assert back.players == project.players


def test_who_is_separated_has_a_place_and_chances_of_their_own_and_is_joined_again() -> None:
    project = flutist()
    flute, piccolo, oboe = (player.id for player in project.players)
    apart = edit.separate(project, (piccolo,))
    assert len(apart.bodies) == 3
    assert [player.id for player in apart.players] == [flute, piccolo, oboe]
    assert len({(player.stage.x_m, player.stage.z_m) for player in apart.players}) == 3
    assert apart.player(piccolo).parameters.seed != apart.player(flute).parameters.seed
    assert edit.join(apart, piccolo, flute).players == project.players
    assert edit.separate(apart, (flute, piccolo)) is apart


def test_joining_is_refused_where_both_sound() -> None:
    project = edit.separate(flutist(), ("2.1.17",))
    with pytest.raises(AppError) as error:
        edit.join(project, "3.1.1", "2.1.1")
    assert error.value.message.id == "doubling.together"
    assert edit.join(project, "2.1.17", "2.1.1").player("2.1.17").doubles == "2.1.1"


def test_a_musician_whose_first_instrument_goes_keeps_the_next() -> None:
    project = flutist()
    flute, piccolo, _ = (player.id for player in project.players)
    left = edit.remove_players(project, (flute,))
    assert left.player(piccolo).doubles == ""
    assert len(left.bodies) == 2


def test_a_copy_of_both_is_another_musician_and_a_copy_of_one_has_a_body() -> None:
    project = flutist()
    flute, piccolo, _ = (player.id for player in project.players)
    both, (first, second) = edit.duplicate_players(project, (flute, piccolo))
    assert both.player(second).doubles == first
    assert both.player(first).parameters.seed != both.player(flute).parameters.seed
    one, (alone,) = edit.duplicate_players(project, (piccolo,))
    assert one.player(alone).doubles == ""


def test_a_file_keeps_it_and_refuses_a_body_that_is_not_there(tmp_path: Path) -> None:
    project, path = flutist(), tmp_path / "changes.suisou"
    save(project, path)
    assert load(path).players == project.players
    path.write_bytes(path.read_bytes().replace(b'"doubles": "2.1.1"', b'"doubles": "9.9.9"'))
    with pytest.raises(FileError, match="doubles"):
        load(path)


def test_a_reimport_keeps_it_and_casts_a_new_change_so() -> None:
    project = flutist()
    again = reimport(project, project.score, MAPS).project
    assert again.players == project.players
    without = edit.remove_players(project, ("2.1.17",))
    fewer = replace(without, score=msgspec.structs.replace(project.score, parts=project.score.parts[::2]))
    fresh = reimport(fewer, project.score, MAPS).project
    assert sorted(player.doubles for player in fresh.players) == ["", "", "2.1.1"]
    assert len(fresh.bodies) == 2


def test_a_setting_of_one_instrument_is_one_of_the_musician() -> None:

    project = flutist()
    changed = with_settings(project, [ParameterSetting(1, "amplitude", 0.77)], MAPS)
    assert [player.parameters.amplitude for player in changed.players[:2]] == [0.77, 0.77]


def test_a_posture_fits_everything_that_one_musician_plays() -> None:
    seated_only = next(id for id, one in MAPS.items() if one.hold.postures == ("seated",))
    project = flutist()
    flute, piccolo, _ = (player.id for player in project.players)
    assert project.player(flute).parameters.posture == "standing"
    changed = edit.change(project, (piccolo,), instrument_id=seated_only)
    assert [changed.player(id).parameters.posture for id in (flute, piccolo)] == ["seated", "seated"]
    assert edit.postures_of_musician(changed, changed.player(flute)) == ("seated",)
