"""Acting metadata of a piece: saved, loaded, compared."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from app.errors import FileError, MapError
from app.plan.by_hand.additive_curve import AdditiveCurve
from app.plan.by_hand.corrections import AddGesture, PinFingering, RemoveEvent, SetBreath
from app.plan.by_hand.mark_corrections import SetMark
from app.project.edit.corrections import with_corrections
from app.project.edit.piece import set_section_intensity
from app.project.edit.players import rename, set_parameters
from app.project.piece_metadata import (
    VERSION,
    differences,
    is_acting,
    load_metadata,
    metadata_of,
    save_metadata,
    with_metadata,
)
from tests.unit.project.pieces import full_project, small_project


def test_what_is_saved_is_what_is_loaded_and_nothing_else_of_the_piece_changes(tmp_path: Path) -> None:
    project = full_project(str(tmp_path))
    metadata = metadata_of(project)
    save_metadata(metadata, tmp_path / "piece.toml")
    assert load_metadata(tmp_path / "piece.toml") == metadata
    bare = replace(
        project,
        section_intensity=1.0,
        expressions=(),
        corrections={
            id: tuple(item for item in items if not is_acting(item)) for id, items in project.corrections.items()
        },
    )
    bare = set_parameters(bare, ("1.1.1",), style="student", habits="", gaze=0.0, amplitude=0.9)
    loaded = with_metadata(bare, metadata)
    assert not loaded.problems
    assert metadata_of(loaded.project) == metadata
    for player, before in zip(loaded.project.players, project.players, strict=True):
        assert player.parameters == before.parameters
        said = loaded.project.corrections[player.id]
        assert set(map(repr, said)) == set(map(repr, project.corrections[player.id]))
    assert with_metadata(project, metadata).project.score is project.score


def test_breaths_cues_and_fingerings_are_no_acting() -> None:
    playing = PinFingering("1", "1"), SetBreath("1", -10), RemoveEvent("breath:1", "1"), SetMark("breath", "1")
    assert not any(map(is_acting, playing))
    assert all(map(is_acting, (RemoveEvent("sway:@960"), RemoveEvent("expression:smile"), RemoveEvent("named:x"))))


def test_a_player_who_is_not_named_keeps_all_and_one_who_is_not_there_is_reported() -> None:
    project = small_project()
    first, second = project.players
    other = with_corrections(rename(project, first.id, "Another"), second.id, [AddGesture("x", "sway", 0, 480, 0.5)])
    loaded = with_metadata(other, metadata_of(set_parameters(project, (second.id,), style="jazz")))
    assert [problem.id for problem in loaded.problems] == ["metadata.no_player"]
    assert loaded.problems[0].arguments["players"] == first.name
    assert loaded.project.players[0] == other.players[0]
    assert loaded.project.players[1].parameters.style == "jazz"
    assert second.id not in loaded.project.corrections


def test_ticks_are_those_of_the_piece_they_are_loaded_into() -> None:
    project = small_project()
    first = project.players[0]
    said = metadata_of(with_corrections(project, first.id, [AddGesture("x", "named", 480, 960, 0.5, "shrug")]))
    twice = msgspec.structs.replace(said, ticks_per_quarter=project.score.ticks_per_quarter * 2)
    [gesture] = with_metadata(project, twice).project.corrections[first.id]
    assert isinstance(gesture, AddGesture)
    assert (gesture.start_tick, gesture.end_tick, gesture.amount, gesture.gesture) == (240, 480, 0.5, "shrug")


def test_differences_say_where_and_what() -> None:
    project = small_project()
    first = project.players[0]
    changed = set_section_intensity(set_parameters(project, (first.id,), style="jazz"), 0.5)
    changed = with_corrections(changed, first.id, [AddGesture("x", "named", 480, 960, 0.5, "shrug")])
    found = {item.place: (item.one, item.other) for item in differences(metadata_of(project), metadata_of(changed))}
    assert found["section_intensity"] == ("1.0", "0.5")
    assert found[f"players.{first.name}.parameters.style"] == ("section_player", "jazz")
    assert found[f"players.{first.name}.corrections[add_gesture x].gesture"] == ("", "shrug")
    assert not differences(metadata_of(project), metadata_of(project))


@pytest.mark.parametrize(
    ("wrong", "instead", "place"),
    [
        ("section_intensity = 1.0", "section_intensity = 3.0", "section_intensity"),
        ("ticks_per_quarter = 480", "ticks_per_quarter = 0", "ticks_per_quarter"),
        ("gaze = 1.0", "gaze = 5.0", "players.A.parameters.gaze"),
        ("gaze = 1.0", 'posture = "seated"', "players.A.parameters.posture"),
        ('correction = "add_gesture"', 'correction = "dance"', "players.A.corrections[0].correction"),
        ("amount = 0.5", 'amount = "much"', "players.A.corrections[0].amount"),
    ],
)
def test_what_is_wrong_in_a_file_is_reported_with_its_place(
    tmp_path: Path, wrong: str, instead: str, place: str
) -> None:
    project = small_project()
    first = project.players[0]
    project = with_corrections(rename(project, first.id, "A"), first.id, [AddGesture("x", "sway", 0, 480, 0.5)])
    path = tmp_path / "piece.toml"
    save_metadata(metadata_of(project), path)
    text = path.read_text(encoding="utf-8")
    assert wrong in text
    path.write_text(text.replace(wrong, instead, 1), encoding="utf-8")
    with pytest.raises(MapError) as raised:
        load_metadata(path)
    assert (raised.value.message.id, raised.value.message.arguments["place"]) == ("table.invalid", place)


CURVE = """version = 2
ticks_per_quarter = 480

[[players.A.corrections]]
correction = "additive"
name = "a1"
channel = "{channel}"
[[players.A.corrections.keys]]
tick = 0
value = {value}
"""


@pytest.mark.parametrize(
    ("channel", "value", "place"),
    [
        ("bell.upp", "5.0", "players.A.corrections[0].channel"),
        ("bell.up", "5.0e9", "players.A.corrections[0].keys[0].value"),
    ],
)
def test_a_curve_that_no_project_could_keep_is_refused(tmp_path: Path, channel: str, value: str, place: str) -> None:
    path = tmp_path / "piece.toml"
    path.write_text(CURVE.format(channel=channel, value=value), encoding="utf-8")
    with pytest.raises(MapError) as raised:
        load_metadata(path)
    assert raised.value.message.arguments["file"] == "piece.toml"
    assert raised.value.message.arguments["place"] == place


def test_keys_that_coarser_ticks_put_in_one_place_are_one(tmp_path: Path) -> None:
    path = tmp_path / "piece.toml"
    more = "".join(
        f"[[players.trumpet.corrections.keys]]\ntick = {tick}\nvalue = {tick % 100}.0\n" for tick in (1, 2, 480)
    )
    text = CURVE.format(channel="bell.up", value=0.0).replace("players.A", "players.trumpet") + more
    path.write_text(text.replace("ticks_per_quarter = 480", "ticks_per_quarter = 30000"), encoding="utf-8")
    project = small_project()
    [curve] = with_metadata(project, load_metadata(path)).project.corrections[project.players[0].id]
    assert isinstance(curve, AdditiveCurve)
    assert [(key.tick, key.value) for key in curve.keys] == [(0, 2.0), (8, 80.0)]


def test_a_newer_file_and_none_at_all_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "piece.toml"
    path.write_text(f"version = {VERSION + 1}\nticks_per_quarter = 480\n", encoding="utf-8")
    with pytest.raises(MapError) as raised:
        load_metadata(path)
    assert raised.value.message.id == "metadata.newer"
    with pytest.raises(FileError):
        load_metadata(tmp_path / "none.toml")
