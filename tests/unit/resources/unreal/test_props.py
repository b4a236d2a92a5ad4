"""Straps and chairs in a fake editor: attached to their player's actor, and removed if excluded from the export."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.export.rig_options import RigOptions
from app.formats.fbx.read import read_scene
from app.project.model import Project
from tests.unit.export.test_rig import world_m
from tests.unit.export.unreal.conftest import quartet
from tests.unit.resources.unreal.conftest import Editor, exported
from tests.unit.resources.unreal.test_import import ROOT, animation, bindings, description, transform
from tests.unit.resources.unreal.test_sockets import hung

WHO = ("Trumpet 1", "Trombone 1")
FILE = "Props/SK_Trumpet_1_props.fbx"
ASSETS = {f"{ROOT}/Props/Trumpet_1_props/{prefix}_Trumpet_1_props" for prefix in ("SK", "SKEL", "A")}


def seated(name: str) -> Project:
    """The quartet with one player seated and all others standing."""
    players = []
    for player in quartet().players:
        posture = "seated" if player.name == name else "standing"
        parameters = msgspec.structs.replace(player.parameters, posture=posture)
        players.append(msgspec.structs.replace(player, parameters=parameters))
    return replace(quartet(), players=tuple(players))


@pytest.fixture
def editor(plugin: None, tmp_path: Path) -> Editor:
    exported(tmp_path / "Game", seated("Trumpet 1"), WHO)
    editor = Editor(tmp_path / "Game")
    assert "is imported" in editor.import_performance()
    return editor


def test_a_chair_is_attached_to_its_players_actor(editor: Editor) -> None:
    there, reported = bindings(editor), description(editor)
    assert set(there) == {
        *("Trumpet 1", "Trumpet 1 (trumpet_Bb)", "Trumpet 1 (props)"),
        *("Trombone 1", "Trombone 1 (trombone_tenor_F_attachment)"),
    }
    worn, player = there["Trumpet 1 (props)"], there["Trumpet 1"]
    assert hung(worn) == [("None", player._id._value)]
    assert {name for name, value in transform(worn).items() if value != 0.0} == {"Scale.X", "Scale.Y", "Scale.Z"}
    assert set(editor.studio.assets) >= ASSETS
    section = animation(worn)
    assert section._animation is editor.studio.assets[f"{ROOT}/Props/Trumpet_1_props/A_Trumpet_1_props"]
    assert section._range == ("frames", 0, reported["frames"] - 1)
    sitting, standing = sorted(reported["players"], key=lambda one: one["name"] != "Trumpet 1")
    assert (sitting["props"]["file"], standing["props"]) == (FILE, None)
    assert sitting["props"]["bones"] == ["root", "chair"]
    # The player's actor is at the place on the stage; in the file, the chair is around the player's own origin.
    (mesh,) = read_scene(editor.folder / "SuisouSource" / "quartet" / FILE).meshes
    low_cm, high_cm = mesh.vertices_cm.min(axis=0), mesh.vertices_cm.max(axis=0)
    assert low_cm[1] == pytest.approx(0.0, abs=0.5)
    assert np.abs(low_cm[0] + high_cm[0]) < 1.0


def test_an_update_doubles_nothing(editor: Editor) -> None:
    before = bindings(editor)["Trumpet 1 (props)"]._id._value
    editor.update_performance()
    there = bindings(editor)
    assert there["Trumpet 1 (props)"]._id._value == before
    assert hung(there["Trumpet 1 (props)"]) == [("None", there["Trumpet 1"]._id._value)]


def test_who_stands_up_or_is_exported_without_has_none_any_more(editor: Editor) -> None:
    sources = editor.folder / "SuisouSource" / "quartet"
    exported(editor.folder, seated("Trumpet 1"), WHO, props=False)
    assert not (sources / FILE).exists()
    editor.update_performance()
    assert "Trumpet 1 (props)" not in bindings(editor)
    assert not ASSETS & set(editor.studio.assets)
    exported(editor.folder, seated("Trombone 1"), WHO)
    editor.update_performance()
    assert {name for name in bindings(editor) if "props" in name} == {"Trombone 1 (props)"}


def test_a_root_bone_at_the_place_takes_the_chair_along(plugin: None, tmp_path: Path) -> None:
    """Actors of player and chair are then at the origin, and both root bones at the place."""
    exported(tmp_path / "Game", seated("Trumpet 1"), WHO, rig=RigOptions(root_bone="place"))
    folder = tmp_path / "Game" / "SuisouSource" / "quartet"
    chair_m, player_m = (world_m(read_scene(folder / name))[0, 0] for name in (FILE, "Characters/SK_Trumpet_1.fbx"))
    np.testing.assert_allclose(chair_m, player_m, atol=1e-5)
    assert abs(chair_m[0, 3]) > 0.5
