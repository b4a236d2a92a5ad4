"""Players with the same body in a fake editor: one mesh and one skeleton, and an animation for each."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from app.project.model import Project
from tests.unit.export.unreal.conftest import quartet
from tests.unit.resources.unreal.conftest import Editor, exported
from tests.unit.resources.unreal.test_import import ROOT, bindings, body_assets, description, transform

BOTH = ("Trumpet 1", "Trombone 1")


def cast(first: str, second: str, project: Project | None = None) -> Project:
    """The quartet with these bodies for two players."""
    project = project or quartet()
    bodies = dict(zip(BOTH, (first, second), strict=True))
    players = [
        msgspec.structs.replace(player, character_id=bodies.get(player.name, player.character_id))
        for player in project.players
    ]
    return replace(project, players=tuple(players))


@pytest.fixture
def alike(plugin: None, tmp_path: Path) -> Editor:
    exported(tmp_path / "Game", cast("woman_adult", "woman_adult"), BOTH)
    editor = Editor(tmp_path / "Game")
    editor.import_performance()
    return editor


def bodies(editor: Editor) -> set[str]:
    return {path for path in editor.studio.assets if "/Bodies/" in path and path.rpartition("/")[2].startswith("SK")}


def test_they_are_one_mesh_on_one_skeleton_and_move_each_by_an_animation(alike: Editor) -> None:
    assert bodies(alike) == body_assets("woman_adult")
    there = bindings(alike)
    mesh = alike.studio.assets[f"{ROOT}/Bodies/woman_adult/SK_woman_adult"]
    assert all(there[name]._mesh is mesh for name in BOTH)
    played = [alike.studio.assets[f"{ROOT}/Characters/{name}/A_{name}"] for name in ("Trumpet_1", "Trombone_1")]
    assert played[0] is not played[1]
    assert all(one._skeleton is mesh._skeleton for one in played)
    made = [asked["destination_name"] for asked in alike.studio.imports if asked.get("import_mesh")]
    assert made.count("SK_woman_adult") == 1


def test_who_gets_another_body_stays_where_the_artist_put_them(alike: Editor) -> None:
    before = bindings(alike)["Trombone 1"]._id._value
    (track,) = [
        track for track in bindings(alike)["Trombone 1"]._tracks if type(track).__name__ == "MovieScene3DTransformTrack"
    ]
    track._sections[0]._channels[0].set_default(333.0)
    exported(alike.folder, cast("woman_adult", "man_adult"), BOTH)
    alike.update_performance()
    binding = bindings(alike)["Trombone 1"]
    assert binding._id._value == before
    assert binding._mesh is alike.studio.assets[f"{ROOT}/Bodies/man_adult/SK_man_adult"]
    assert transform(binding)["Location.X"] == 333.0
    played = alike.studio.assets[f"{ROOT}/Characters/Trombone_1/A_Trombone_1"]
    assert played._skeleton is binding._mesh._skeleton
    assert bodies(alike) == body_assets("woman_adult", "man_adult")
    # An unused body is removed.
    exported(alike.folder, cast("woman_adult", "woman_adult"), BOTH)
    alike.update_performance()
    assert bodies(alike) == body_assets("woman_adult")


def test_the_body_of_one_who_is_excluded_stays(alike: Editor) -> None:
    exported(alike.folder, cast("woman_adult", "man_adult"), BOTH)
    alike.update_performance()
    exported(alike.folder, cast("woman_adult", "no_such_character"), BOTH)
    assert "Excluded" in alike.update_performance()
    assert bodies(alike) == body_assets("woman_adult", "man_adult")
    assert bindings(alike)["Trombone 1"]._mesh is alike.studio.assets[f"{ROOT}/Bodies/man_adult/SK_man_adult"]


def test_bones_that_are_others_make_all_who_share_them_anew(alike: Editor) -> None:
    alike.studio.metadata[f"{ROOT}/Bodies/woman_adult/SKEL_woman_adult"]["SuisouBones"] = "of before"
    assert "bones are others now" in alike.update_performance()
    mesh = alike.studio.assets[f"{ROOT}/Bodies/woman_adult/SK_woman_adult"]
    assert all(bindings(alike)[name]._mesh is mesh for name in BOTH)
    for name in ("Trumpet_1", "Trombone_1"):
        assert alike.studio.assets[f"{ROOT}/Characters/{name}/A_{name}"]._skeleton is mesh._skeleton


def test_actors_of_an_earlier_suisou_are_shown_with_the_body(alike: Editor) -> None:
    """Earlier versions identified actors by meshes, of which each player had one."""
    path = alike.sequence()._path
    state = json.loads(alike.studio.metadata[path]["SuisouSequence"])
    state["figures"] = {
        key.replace("/A_", "/SK_"): {"id": one["id"], "place": one["place"][:4]}
        for key, one in state["figures"].items()
    }
    alike.studio.metadata[path]["SuisouSequence"] = json.dumps(state)
    before = {name: binding._id._value for name, binding in bindings(alike).items()}
    assert "up to date" in alike.update_performance()
    assert {name: binding._id._value for name, binding in bindings(alike).items()} == before


def test_two_figures_of_one_mesh_must_have_the_same_bones(alike: Editor) -> None:
    path = alike.folder / "SuisouSource/quartet/performance.json"
    changed = description(alike)
    changed["players"][1]["character"]["bones"].append("tail")
    path.write_text(json.dumps(changed), encoding="utf-8")
    assert "cannot be read" in alike.update_performance()
