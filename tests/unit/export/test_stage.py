"""The whole stage in one file: performers as in their own files, at the places in project and report."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pygltflib
import pytest
from scipy.spatial.transform import Rotation

from app.cli import main
from app.export.file_names import figure_stems, stage_names
from app.export.playback import ScenePlayback
from app.export.stage import with_own_names
from app.formats.fbx.read import read_scene, read_scenes
from app.formats.scene import Material, Scene
from app.performance.ensemble import Performance
from tests.unit.export.unreal.conftest import quartet, renamed
from tests.unit.formats.scenes import character

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
PLAYERS = ("Trumpet 1", "Trombone 2")
ARGUMENTS = ("--fps", "24", "--from-bar", "2", "--to-bar", "2", "--player", PLAYERS[0], "--player", PLAYERS[1])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("stage")
    assert main(["export", str(QUARTET), "--to", str(folder), "--stage", "--format", "fbx,glb,bvh", *ARGUMENTS]) == 0
    return folder


@pytest.fixture(scope="module")
def report(folder: Path) -> dict[str, Any]:
    report: dict[str, Any] = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return report


def _hips_m(scene: Scene) -> np.ndarray:
    """Positions (F, 3) of the bone with the body's motion: the hips, or an instrument's root."""
    assert scene.clip is not None
    names = [bone.name for bone in scene.bones]
    bone = names.index("hips") if "hips" in names else 0
    world: np.ndarray = ScenePlayback(scene, scene.clip).world(0, scene.clip.frames)[:, bone, :3, 3]
    return world


def test_the_report_names_the_files_and_what_they_hold(folder: Path, report: dict[str, Any]) -> None:
    assert report["stage"]["files"] == {"fbx": "quartet_stage.fbx", "glb": "quartet_stage.glb"}
    assert all((folder / name).is_file() for name in report["stage"]["files"].values())
    figures = report["stage"]["figures"]
    assert [figure["node"] for figure in figures] == [
        "Trumpet 1", "Trumpet 1_trumpet_Bb", "Trombone 2", "Trombone 2_trombone_tenor_F_attachment",
    ]  # fmt: skip
    places = {player["name"]: player["stage"] for player in report["players"]}
    assert [figure["place"] for figure in figures] == [places[figure["performer"]] for figure in figures]
    assert len({figure["place"]["x_m"] for figure in figures}) == 2


def test_a_materials_name_is_one_surface_only_and_the_same_in_every_file() -> None:
    """Man and woman both have a material for skin; programs identify materials by name or rename them."""
    figure = character(Fraction(24), frames=2)
    light, dark = Material("skin", (0.8, 0.6, 0.5, 1.0)), Material("skin", (0.3, 0.2, 0.1, 1.0))
    known: dict[str, Material] = {}
    found = []
    for skin in (light, dark, light, dark):
        mesh = replace(figure.meshes[1], materials=(skin, Material("shoes", (0.0, 0.0, 0.0, 1.0))))
        given = with_own_names(replace(figure, meshes=(mesh,)), known)
        found.append([material.name for material in given.meshes[0].materials])
    assert found == [["skin", "shoes"], ["skin_2", "shoes"]] * 2
    assert known["skin_2"] == replace(dark, name="skin_2")


def test_everyone_moves_as_in_the_own_files_at_the_place(folder: Path, report: dict[str, Any]) -> None:
    scenes = read_scenes(folder / "quartet_stage.fbx")
    figures = report["stage"]["figures"]
    assert [scene.name for scene in scenes] == [figure["node"] for figure in figures]
    for scene, figure in zip(scenes, figures, strict=True):
        alone = read_scene(folder / f"{figure['node']}.fbx")
        assert alone.clip is not None
        assert scene.place is not None
        assert (scene.clip.name, scene.clip.fps, scene.clip.frames) == ("quartet", 24, report["frames"])
        assert [bone.name for bone in scene.bones] == [bone.name for bone in alone.bones]
        assert [mesh.name for mesh in scene.meshes] == [mesh.name for mesh in alone.meshes] == [f"{scene.name}_mesh"]
        # The bones are as long and turn as in the own file; the world around them is moved and turned.
        np.testing.assert_array_equal(scene.clip.rotations_xyzw, alone.clip.rotations_xyzw)
        for bone, own in zip(scene.bones, alone.bones, strict=True):
            np.testing.assert_array_equal(bone.translation_cm, own.translation_cm)
        place = figure["place"]
        turn = Rotation.from_euler("y", place["turn_deg"], degrees=True)
        meant = turn.apply(_hips_m(alone)) + np.array([place["x_m"], 0.0, place["z_m"]])
        found = _hips_m(scene) @ scene.place.matrix[:3, :3].T + scene.place.matrix[:3, 3] / 100.0
        np.testing.assert_allclose(found, meant, atol=2e-4)


def test_the_glb_has_a_node_for_everyone(folder: Path, report: dict[str, Any]) -> None:
    file = pygltflib.GLTF2().load(str(folder / "quartet_stage.glb"))
    nodes = {node.name: node for node in file.nodes}
    assert len(file.skins) == len(report["stage"]["figures"])
    for figure, skin in zip(report["stage"]["figures"], file.skins, strict=True):
        node, place = nodes[figure["node"]], figure["place"]
        assert node.children == [skin.joints[0]]
        assert node.translation == pytest.approx([place["x_m"], 0.0, place["z_m"]], abs=1e-4)
        half = math.radians(place["turn_deg"]) / 2
        assert node.rotation == pytest.approx([0.0, math.sin(half), 0.0, math.cos(half)], abs=1e-5)
    assert len(file.animations) == 1


def test_names_of_figures_and_files_differ_whatever_players_are_called() -> None:
    performance = Performance(renamed(quartet(), ["A", "A_trumpet_Bb", "x_stage", "a"]))
    stems = [stem for figures in figure_stems(performance).values() for stem in figures.values()]
    files = stage_names(performance, frozenset(("fbx", "bvh")), "X.mid")
    assert set(files) == {"fbx"}
    everything = [stem.casefold() for stem in [*stems, files["fbx"].removesuffix(".fbx")]]
    assert len(set(everything)) == len(everything)


@pytest.mark.parametrize("wrong", [("--to", "out", "--format", "bvh"), ("--unreal", "Game")])
def test_a_stage_that_cannot_be_written_is_refused_at_once(
    wrong: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["export", str(QUARTET), "--stage", *wrong]) == 2
    assert "--stage" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
