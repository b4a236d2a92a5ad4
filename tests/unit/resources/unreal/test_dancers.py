"""Dancers in a fake editor: imported, updated and removed like players, without an instrument."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from app.project.casting import StagePosition
from app.project.model import Project
from tests.unit.export.unreal.conftest import quartet, with_dancers
from tests.unit.resources.unreal.conftest import Editor, exported
from tests.unit.resources.unreal.test_import import ROOT, animation, bindings, description, figure_assets, transform

WHO = ("Trumpet 1", "Ana")


@pytest.fixture(scope="module")
def danced(tmp_path_factory: pytest.TempPathFactory) -> Project:
    return with_dancers(quartet(), tmp_path_factory.mktemp("dances"), "Ana")


@pytest.fixture(scope="module")
def both(danced: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A player and a dancer, exported once."""
    folder = tmp_path_factory.mktemp("exported") / "Game"
    exported(folder, danced, WHO)
    return folder


@pytest.fixture
def editor(plugin: None, both: Path, tmp_path: Path) -> Editor:
    """A player and a dancer, imported."""
    shutil.copytree(both, tmp_path / "Game")
    editor = Editor(tmp_path / "Game")
    assert "is imported" in editor.import_performance()
    return editor


def test_a_dancer_is_in_the_sequence_at_the_place_of_the_dance(editor: Editor) -> None:
    there = bindings(editor)
    assert set(there) == {"Trumpet 1", "Trumpet 1 (trumpet_Bb)", "Ana"}
    assert {path for path in editor.studio.assets if "/Ana/" in path} >= figure_assets("Characters", "Ana")
    reported = description(editor)
    (dancer,) = reported["dancers"]
    place = transform(there["Ana"])
    assert (place["Location.X"], place["Location.Y"]) == (-50.0, 200.0)
    assert place["Rotation.Z"] == dancer["place"]["yaw_deg"] < 0.0
    section = animation(there["Ana"])
    assert section._range == ("frames", 0, reported["frames"] - 1)
    assert section._animation is editor.studio.assets[dancer["character"]["animation"]]
    assert section._animation._frames == reported["frames"]
    assert there["Ana"]._mesh is editor.studio.assets[dancer["character"]["mesh"]]
    assert "eyeBlinkLeft" in section._animation._curves


def test_an_update_moves_a_dancer_and_keeps_the_assets(editor: Editor, danced: Project) -> None:
    before = {path: id(asset) for path, asset in editor.studio.assets.items()}
    body = {one["name"]: one["character_id"] for kind in ("players", "dancers") for one in description(editor)[kind]}
    gone = {"Trumpet"} | {body["Trumpet 1"]} - {body["Ana"]}
    now = msgspec.structs.replace(danced.dancers[0], stage=StagePosition(1.0, 3.0, 0.0))
    exported(editor.folder, replace(danced, dancers=(now,)), ("Ana",), last_bar=2)
    assert "up to date" in editor.update_performance()
    after = {path: id(asset) for path, asset in editor.studio.assets.items()}
    assert after.items() <= before.items()
    # Textures and materials go with the last body that has them.
    shared = (*gone, "/Textures/", "/Materials/")
    removed = [path for path in before if path not in after]
    assert [path for path in removed if not any(name in path for name in shared)] == []
    assert transform(bindings(editor)["Ana"])["Location.X"] == 100.0
    assert animation(bindings(editor)["Ana"])._range[2] == description(editor)["frames"] - 1


def test_a_dancer_who_left_leaves_the_sequence_and_the_project(editor: Editor) -> None:
    exported(editor.folder, quartet(), ("Trumpet 1",))
    reported = editor.update_performance()
    assert set(bindings(editor)) == {"Trumpet 1", "Trumpet 1 (trumpet_Bb)"}
    assert not [path for path in editor.studio.assets if "/Ana/" in path]
    assert f"{ROOT}/Characters/Ana/A_Ana" in reported


def test_a_dancer_who_is_left_out_stays_as_imported(editor: Editor, danced: Project) -> None:
    before = {path: id(asset) for path, asset in editor.studio.assets.items() if "/Ana/" in path}
    ana = bindings(editor)["Ana"]
    gone = msgspec.structs.replace(danced.dancers[0], choreography=str(editor.folder / "gone.choreography"))
    exported(editor.folder, replace(danced, dancers=(gone,)), WHO)
    reported = editor.update_performance()
    assert "Excluded" in reported
    assert "gone.choreography" in reported
    assert {path: id(asset) for path, asset in editor.studio.assets.items() if "/Ana/" in path} == before
    assert bindings(editor)["Ana"] is ana


def changed(editor: Editor, **fields: Any) -> None:
    path = editor.folder / "SuisouSource/quartet/performance.json"
    path.write_text(json.dumps({**description(editor), **fields}), encoding="utf-8")


def test_a_description_of_an_earlier_suisou_has_no_dancers(editor: Editor) -> None:
    reported = description(editor)
    files = {name: of for name, of in reported["files"].items() if "Ana" not in name}
    changed(editor, schema=1, files=files)
    path = editor.folder / "SuisouSource/quartet/performance.json"
    without = {name: value for name, value in description(editor).items() if name != "dancers"}
    path.write_text(json.dumps(without), encoding="utf-8")
    assert "up to date" in editor.update_performance()
    assert set(bindings(editor)) == {"Trumpet 1", "Trumpet 1 (trumpet_Bb)"}


@pytest.mark.parametrize("fault", ["assets elsewhere", "file not described", "no place"])
def test_a_wrong_dancer_is_refused(editor: Editor, fault: str) -> None:
    (dancer,) = description(editor)["dancers"]
    if fault == "assets elsewhere":
        dancer["character"]["mesh"] = "/Game/Suisou/other/SK_Ana"
    elif fault == "file not described":
        dancer["character"]["file"] = "Characters/SK_Nobody.fbx"
    else:
        del dancer["place"]
    changed(editor, dancers=[dancer])
    before = set(editor.studio.assets)
    assert "cannot be read" in editor.update_performance()
    assert set(editor.studio.assets) == before
