"""Edits of dancers and of corrections of their dances."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from pathlib import Path

import pytest

from app.errors import AppError
from app.project.casting import DANCER_ROOM_M, StagePosition
from app.project.check import faults
from app.project.dance_corrections import ForbidState, PinState, UseSegment
from app.project.edit import dance_corrections as corrections
from app.project.edit import dancers as edit
from app.project.edit import players as edit_players
from app.project.footprint import footprint
from app.project.limits import MOST_DANCERS
from app.project.model import Project
from instrument_maps.load import bundled_maps
from tests.unit.project.pieces import small_project

MAPS = bundled_maps()


@pytest.fixture
def pair() -> Project:
    """Two dancers in front of two players."""
    project, _ = edit.add_dancer(small_project(), "salsa", "Dancer")
    return edit.add_dancer(project, "salsa", "Dancer")[0]


def test_a_dancer_is_cast_beside_the_players(pair: Project) -> None:
    first, second = pair.dancers
    assert [first.name, second.name] == ["Dancer", "Dancer 2"]
    assert [first.id, second.id] == ["dancer:1", "dancer:2"]
    assert first.character_id == "woman_adult"  # both players are men
    assert edit.add_dancer(pair, "salsa", "TRUMPET")[0].dancers[2].name == "TRUMPET 2"
    assert list(faults(pair)) == []
    assert edit_players.rename(pair, pair.players[0].id, "dancer").players[0].name == "dancer 3"
    assert edit_players.add_player(pair, MAPS["flute"], MAPS, "Dancer 2")[0].players[2].name == "Dancer 3"


@pytest.mark.parametrize("instruments", [[], ["trombone_tenor_F_attachment"], sorted(MAPS)[:20]])
def test_dancers_have_room_beside_any_instruments(instruments: list[str]) -> None:
    project = replace(small_project(), players=())
    for instrument in instruments:
        project, _ = edit_players.add_player(project, MAPS[instrument], MAPS, "")
    for _ in range(7):
        project, _ = edit.add_dancer(project, "salsa", "Dancer")
    places = [dancer.stage for dancer in project.dancers]
    for number, one in enumerate(places):
        assert one.turn_rad == 0.0
        for other in places[:number]:
            assert math.hypot(one.x_m - other.x_m, one.z_m - other.z_m) >= DANCER_ROOM_M - 1e-6
        for player in project.players:
            room = footprint(MAPS[player.instrument_id])
            reach_m = max(room.left_m, room.right_m, room.ahead_m)
            assert one.z_m >= player.stage.z_m + reach_m + DANCER_ROOM_M - 1e-3
    assert len({place.z_m for place in places}) == 2


def test_no_dancer_of_the_first_row_hides_a_lone_player_from_the_audience() -> None:
    project = replace(small_project(), players=())
    project, _ = edit_players.add_player(project, MAPS["flute"], MAPS, "")
    for _ in range(4):
        project, _ = edit.add_dancer(project, "salsa", "Dancer")
    front_m = min(dancer.stage.z_m for dancer in project.dancers)
    (player,) = project.players
    row = [dancer.stage.x_m for dancer in project.dancers if dancer.stage.z_m == front_m]
    assert len(row) == 4
    assert min(abs(x_m - player.stage.x_m) for x_m in row) > 1.0


def test_a_place_that_was_taken_by_hand_is_not_given_again(pair: Project) -> None:
    first, second = pair.dancers
    free = edit.free_places(pair, 1)[0]
    moved = edit.place_dancers(pair, {second.id: free})
    assert moved.dancer(second.id).stage == free
    assert edit.add_dancer(moved, "salsa", "x")[0].dancers[2].stage == second.stage
    assert edit.place_dancers(pair, {first.id: first.stage}) is pair


def test_a_new_player_stands_beside_dancers_who_were_put_among_players(pair: Project) -> None:
    trumpet, trombone = pair.players
    pair = edit_players.place(pair, {trumpet.id: StagePosition(-2.0, 0.0, 0.0), trombone.id: StagePosition(0.0, 0, 0)})
    pair = edit.place_dancers(pair, {"dancer:1": StagePosition(1.3, 0.0, 0.0)})
    assert edit_players.add_player(pair, MAPS["flute"], MAPS, "x")[0].players[2].stage.x_m > 2.5


def test_a_dancer_of_a_row_is_seen_between_those_of_the_row_before() -> None:
    project = replace(small_project(), players=())
    for _ in range(14):
        project, _ = edit.add_dancer(project, "salsa", "x")
    rows: dict[float, list[float]] = {}
    for dancer in project.dancers:
        rows.setdefault(dancer.stage.z_m, []).append(dancer.stage.x_m)
    assert [len(row) for _, row in sorted(rows.items())] == [5, 4, 5]
    for row, behind in itertools.pairwise(x_m for _, x_m in sorted(rows.items())):
        gaps = [abs(one - other) for one in row for other in behind]
        # From the front no one stands before anyone of the row behind, and both rows are about the middle.
        assert min(gaps) == pytest.approx(0.5 * DANCER_ROOM_M)
        assert sum(row) == pytest.approx(0.0)
        assert sum(behind) == pytest.approx(0.0)


def test_the_stage_ends_and_its_last_row_goes_on() -> None:
    project = small_project()
    far = edit_players.place(project, {project.players[0].id: StagePosition(0.0, 1000.0, 0.0)})
    for _ in range(3):
        far, _ = edit.add_dancer(far, "salsa", "x")
    assert list(faults(far)) == []
    assert len({dancer.stage for dancer in far.dancers}) == 3


def test_choreographies_are_files_or_bundled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pair: Project) -> None:
    monkeypatch.chdir(tmp_path)
    changed = edit.set_choreography(pair, ["dancer:1"], Path("mine.choreography"))
    assert changed.dancers[0].choreography == str(tmp_path / "mine.choreography")
    assert changed.dancers[1] is pair.dancers[1]
    for text in ("mine.bvh", "a\0.choreography", ""):
        with pytest.raises(AppError, match=r"dancer\.no_choreography"):
            edit.set_choreography(pair, ["dancer:1"], text)
    assert edit.set_choreography(pair, ["dancer:1"], "salsa") is pair


def test_fields_are_held_in_their_bounds(pair: Project) -> None:
    changed = edit.change_dancers(pair, ["dancer:2"], size=9.0, delay_beats=-3.0, source=-7, mirrored=True, seed=-1)
    dancer = changed.dancers[1]
    assert (dancer.size, dancer.delay_beats, dancer.source, dancer.mirrored, dancer.seed) == (1.5, 0.0, -1, True, 0)
    assert list(faults(changed)) == []
    assert edit.change_dancers(pair, ["dancer:2"], mirrored=False) is pair


def test_names_are_visible_and_unique(pair: Project) -> None:
    assert edit.rename_dancer(pair, "dancer:2", "DANCER").dancers[1].name == "DANCER 2"
    assert edit.rename_dancer(pair, "dancer:2", "trombone").dancers[1].name == "trombone 2"
    assert edit.rename_dancer(pair, "dancer:2", "Dancer 2") is pair
    with pytest.raises(AppError, match=r"player\.no_name"):
        edit.rename_dancer(pair, "dancer:2", " \n")


def test_who_is_duplicated_dances_in_unison_behind_the_original(pair: Project) -> None:
    pair = corrections.pin_state(edit.change_dancers(pair, ["dancer:1"], seed=7), "dancer:1", 480, 3)
    doubled, ids = edit.duplicate_dancers(pair, ["dancer:1"])
    assert [dancer.id for dancer in doubled.dancers] == ["dancer:1", *ids, "dancer:2"]
    copy = doubled.dancer(ids[0])
    assert (copy.name, copy.seed) == ("Dancer 3", 7)
    assert doubled.dance_corrections[copy.id] == (PinState(480, 3),)
    assert len({(dancer.stage.x_m, dancer.stage.z_m) for dancer in doubled.dancers}) == 3
    assert list(faults(doubled)) == []


def test_removing_takes_corrections_along_and_order_can_be_changed(pair: Project) -> None:
    pair = corrections.pin_state(pair, "dancer:1", 480, 3)
    removed = edit.remove_dancers(pair, ["dancer:1"])
    assert removed.dance_corrections == {}
    assert [dancer.id for dancer in removed.dancers] == ["dancer:2"]
    assert edit.remove_dancers(pair, ["unknown"]) is pair
    # An id is not given again while one behind it lives.
    assert edit.add_dancer(removed, "salsa", "x")[1] == "dancer:3"
    moved = edit.move_dancers(pair, ["dancer:2"], 0)
    assert [dancer.id for dancer in moved.dancers] == ["dancer:2", "dancer:1"]
    assert edit.move_dancers(pair, ["dancer:1"], 1) is pair


def test_a_project_has_room_for_so_many_dancers(pair: Project) -> None:
    many = replace(pair, dancers=pair.dancers * (MOST_DANCERS // 2))
    with pytest.raises(AppError, match=r"dancer\.too_many"):
        edit.add_dancer(many, "salsa", "x")


def test_one_thing_is_pinned_at_a_tick(pair: Project) -> None:
    project = corrections.pin_state(pair, "dancer:1", 960, 2)
    project = corrections.forbid_state(project, "dancer:1", 480, 1920, 5)
    assert project.dance_corrections == {"dancer:1": (ForbidState(480, 1920, 5), PinState(960, 2))}
    assert corrections.pin_state(project, "dancer:1", 960, 2) is project
    project = corrections.use_segment(project, "dancer:1", 960, 17)
    assert project.dance_corrections["dancer:1"] == (ForbidState(480, 1920, 5), UseSegment(960, 17))
    both = corrections.forbid_state(project, "dancer:1", 480, 1920, 6)
    assert len(both.dance_corrections["dancer:1"]) == 3
    assert corrections.forbid_state(project, "dancer:1", 480, 480, 6) is project
    with pytest.raises(KeyError):
        corrections.pin_state(pair, "1.1.1", 0, 0)


def test_corrections_are_taken_back(pair: Project) -> None:
    project = corrections.use_segment(corrections.pin_state(pair, "dancer:1", 0, 2), "dancer:1", 480, 1)
    project = corrections.forbid_state(project, "dancer:1", 0, 960, 4)
    left = corrections.take_back(project, "dancer:1", [ForbidState(0, 960, 4)])
    assert left.dance_corrections["dancer:1"] == (PinState(0, 2), UseSegment(480, 1))
    assert corrections.clear(project, "dancer:1") == pair
    assert corrections.clear(pair, "dancer:1") is pair
