"""Edits of additive curves, invalid stored curves, and curves after a re-import of the piece."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest

from app.errors import FileError
from app.plan.by_hand.additive_curve import AdditiveCurve, CurveKey, Tangent
from app.project.anchors import moved_correction
from app.project.edit import additive as edit
from app.project.edit.corrections import with_corrections
from app.project.edit.events import give_back
from app.project.model import Project
from app.project.storage import decode, encode
from tests.unit.project.pieces import full_project

PATH = Path("/nowhere/piece.suisou")


@pytest.fixture
def project() -> Project:
    """Project with a single curve of the first player."""
    bare = full_project("/nowhere")
    player = bare.players[0].id
    bare = edit.delete_curves(bare, player, [curve.name for curve in edit.curves_of(bare, player)])
    keys = (CurveKey(480, 1.0), CurveKey(960, 2.0, "linear"), CurveKey(1920, 3.0))
    return with_corrections(bare, player, (AdditiveCurve("own-1", "head.up", keys, 240, 240),))


def player_of(project: Project) -> str:
    return project.players[0].id


def keys_of(project: Project, name: str = "own-1") -> dict[int, float]:
    (curve,) = [item for item in edit.curves_of(project, player_of(project)) if item.name == name]
    return {key.tick: key.value for key in curve.keys}


def test_a_new_curve_has_a_name_of_its_own_and_blends(project: Project) -> None:
    player = player_of(project)
    after, name = edit.add_curve(project, player, "hips.left", ((960, 0.05), (480, -0.02)), "step")
    assert name == "own-2"
    (curve,) = edit.curves_of(after, player, "hips.left")
    assert [key.tick for key in curve.keys] == [480, 960]
    assert curve.blend_in_ticks == curve.blend_out_ticks == project.score.ticks_per_quarter
    assert (curve.title, curve.weight, curve.enabled) == ("step", 1.0, True)
    assert len(edit.curves_of(after, player)) == 2
    assert len(edit.curves_of(project, player)) == 1


def test_a_new_key_goes_on_as_the_one_before_it(project: Project) -> None:
    after = edit.add_key(project, player_of(project), "own-1", 1200, 7.0)
    (curve,) = edit.curves_of(after, player_of(project))
    assert [(key.tick, key.interpolation) for key in curve.keys][2] == (1200, "linear")
    again = edit.add_key(after, player_of(project), "own-1", 1200, 500.0)
    assert keys_of(again)[1200] == 180.0
    assert len(keys_of(again)) == 4


def test_keys_move_together_and_take_the_place_of_what_is_there(project: Project) -> None:
    player = player_of(project)
    after = edit.move_keys(project, player, {"own-1": (480, 960)}, 480, 0.5)
    assert keys_of(after) == {960: 1.5, 1440: 2.5, 1920: 3.0}
    assert keys_of(edit.move_keys(project, player, {"own-1": (480,)}, 480)) == {960: 1.0, 1920: 3.0}


def test_deleting_every_key_deletes_the_curve(project: Project) -> None:
    player = player_of(project)
    assert keys_of(edit.delete_keys(project, player, {"own-1": (960,)})) == {480: 1.0, 1920: 3.0}
    assert not edit.curves_of(edit.delete_keys(project, player, {"own-1": (480, 960, 1920)}), player)


def test_handles_are_placed_levelled_and_freed(project: Project) -> None:
    player = player_of(project)
    one = edit.set_tangent(project, player, "own-1", 960, "leave", Tangent(0, 4.0), Tangent(90, -1.0))
    (curve,) = edit.curves_of(one, player)
    assert (curve.keys[1].leave, curve.keys[1].arrive) == (Tangent(1, 4.0), Tangent(90, -1.0))
    level = edit.flatten_tangents(one, player, {"own-1": (960,)})
    (curve,) = edit.curves_of(level, player)
    assert (curve.keys[1].leave, curve.keys[1].arrive) == (Tangent(320, 0.0), Tangent(160, 0.0))
    free = edit.free_tangents(level, player, {"own-1": (960,)})
    assert edit.curves_of(free, player) == edit.curves_of(project, player)


def test_pasted_keys_take_the_place_of_those_between(project: Project) -> None:
    player = player_of(project)
    copied = (CurveKey(0, 5.0), CurveKey(600, 6.0, "constant"))
    after = edit.paste_keys(project, player, "own-1", copied, 480)
    assert keys_of(after) == {480: 5.0, 1080: 6.0, 1920: 3.0}


def test_settings_of_a_curve_stay_within_what_there_is(project: Project) -> None:
    player = player_of(project)
    after = edit.change_curves(project, player, ("own-1",), weight=7.0, blend_in_ticks=-4, title="  up ", enabled=False)
    (curve,) = edit.curves_of(after, player)
    assert (curve.weight, curve.blend_in_ticks, curve.title, curve.enabled) == (1.0, 0, "up", False)


def test_a_curve_is_given_back_as_an_event(project: Project) -> None:
    after = give_back(project, player_of(project), ("additive:own-1",))
    assert not edit.curves_of(after, player_of(project))


def test_a_curve_moves_with_its_places_and_keeps_all_keys() -> None:
    keys = (CurveKey(0, 0.0), CurveKey(10, 1.0, leave=Tangent(4, 2.0)), CurveKey(20, 0.0))
    curve = AdditiveCurve("a", "head.up", keys, 6, 8)
    after = moved_correction(curve, {}, lambda tick: 100 + tick // 20, Fraction(2))
    assert [key.tick for key in after.keys] == [100, 101, 102]
    assert after.keys[1].leave == Tangent(8, 2.0)
    assert (after.blend_in_ticks, after.blend_out_ticks) == (12, 16)
    assert moved_correction(curve, {}) is curve


@pytest.mark.parametrize(
    ("change", "place"),
    [
        ({"channel": "head.sideways"}, "channel"),
        ({"keys": []}, "keys"),
        ({"weight": 1.5}, "weight"),
        ({"blend_out_ticks": -1}, "blend_out_ticks"),
        ({"keys": [{"tick": 5, "value": 0.0}, {"tick": 5, "value": 1.0}]}, "keys[1].tick"),
        ({"keys": [{"tick": 5, "value": 181.0}]}, "keys[0].value"),
        ({"keys": [{"tick": 5, "value": 0.0, "leave": {"ticks": -3, "value": 0.0}}]}, "keys[0].leave.ticks"),
        ({"keys": [{"tick": 5, "value": 0.0, "interpolation": "spline"}]}, "keys[0].interpolation"),
        ({"keys": [{"tick": 5, "value": 0.0, "colour": "red"}]}, "keys[0]"),
    ],
)
def test_what_is_wrong_in_a_file_is_reported_by_its_place(
    project: Project, change: dict[str, object], place: str
) -> None:
    raw = json.loads(encode(project, PATH))
    items = raw["corrections"][player_of(project)]
    at = next(index for index, item in enumerate(items) if item["correction"] == "additive")
    items[at] |= change
    with pytest.raises(FileError) as error:
        decode(json.dumps(raw).encode(), PATH)
    assert error.value.message.id == "project.invalid"
    assert f"[{at}]" in str(error.value.message.arguments["place"])
    assert place.split("]")[-1].strip(".") in str(error.value.message.arguments["place"])
