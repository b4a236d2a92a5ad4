"""Files without meshes contain the same motion, with the face as animated properties in formats that support them."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli import main
from app.formats.fbx.decode import read_elements
from app.formats.fbx.graph import ObjectGraph
from app.formats.fbx.read import read_scene
from app.formats.fbx.write import write_scene
from app.formats.gltf.read import read_glb
from app.formats.gltf.write import write_glb
from app.formats.scene import without_meshes
from tests.support import readers
from tests.unit.formats import scenes

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
ARGUMENTS = ("--from-bar", "2", "--to-bar", "3", "--player", "Trumpet 1", "--format", "fbx,glb")


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("motion")
    for name, options in (("whole", ()), ("alone", ("--motion-only",))):
        assert main(["export", str(QUARTET), "--to", str(folder / name), *ARGUMENTS, *options]) == 0
    return {name: folder / name for name in ("whole", "alone")}


def _files(folder: Path) -> dict[str, Path]:
    (player,) = json.loads((folder / "report.json").read_text(encoding="utf-8"))["players"]
    return {key: folder / name for key, name in player["files"].items()}


def _report(folder: Path) -> dict[str, Any]:
    return json.loads((folder / "report.json").read_text(encoding="utf-8"))["players"][0]["measures"]


@pytest.mark.parametrize("held", ["character", "instrument"])
def test_an_fbx_has_the_motion_and_no_mesh(exported: dict[str, Path], held: str) -> None:
    whole, alone = (read_scene(_files(exported[name])[f"{held}_fbx"]) for name in ("whole", "alone"))
    assert whole.meshes
    assert not alone.meshes
    path = _files(exported["alone"])[f"{held}_fbx"]
    graph = ObjectGraph(read_elements(path.read_bytes(), path.name), path.name)
    assert not graph.of_kind("Geometry", "Mesh") + graph.of_kind("Geometry", "Shape")
    assert whole.clip is not None
    assert alone.clip is not None
    np.testing.assert_array_equal(alone.clip.rotations_xyzw, whole.clip.rotations_xyzw)
    assert alone.clip.morph_weights.keys() == whole.clip.morph_weights.keys()
    for name, weights in whole.clip.morph_weights.items():
        np.testing.assert_allclose(alone.clip.morph_weights[name], weights, atol=1e-6)
    assert path.stat().st_size < 0.5 * _files(exported["whole"])[f"{held}_fbx"].stat().st_size


def test_a_glb_has_the_motion_and_no_mesh(exported: dict[str, Path]) -> None:
    whole, alone = (read_glb(_files(exported[name])["character_glb"], animated=True) for name in ("whole", "alone"))
    assert whole.meshes
    assert not alone.meshes
    assert [alone.nodes[joint].name for joint in alone.skins[0].joints] == [
        whole.nodes[joint].name for joint in whole.skins[0].joints
    ], "programs take nodes for bones by the skin"
    for mine, theirs in zip(whole.animations[0].channels, alone.animations[0].channels, strict=True):
        np.testing.assert_array_equal(mine.values, theirs.values)


def test_the_report_judges_the_motion_of_the_file_as_with_its_meshes(exported: dict[str, Path]) -> None:
    whole, alone = _report(exported["whole"]), _report(exported["alone"])
    for name, spread in whole["contacts"].items():
        assert alone["contacts"][name]["max_mm"] == pytest.approx(spread["max_mm"], abs=1e-3)


def test_lips_and_breaths_of_a_glb_without_meshes_are_judged_with_the_face(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ("--from-bar", "7", "--to-bar", "8", "--player", "Trumpet 1", "--format", "glb")
    for name, options in (("whole", ()), ("alone", ("--motion-only",))):
        assert main(["export", str(QUARTET), "--to", str(tmp_path / name), *arguments, *options]) == 0
        assert ("GLB without meshes has no face" in capsys.readouterr().err) == (name == "alone")
    whole, alone = _report(tmp_path / "whole"), _report(tmp_path / "alone")
    assert whole["breaths"]["shown"] > 0
    assert alone["breaths"] == whole["breaths"]
    for name in ("lips", "upper_lip_in_breaths"):
        assert alone[name]["max_mm"] == pytest.approx(whole[name]["max_mm"], abs=1e-3)


def test_properties_of_the_face_are_a_users_and_animated(tmp_path: Path) -> None:
    """The FBX SDK, and thus Unreal, imports such properties as curves: they need flags A and U and a curve
    node each.
    """
    scene = without_meshes(scenes.character(Fraction(60)))
    write_scene(tmp_path / "alone.fbx", scene)
    graph = ObjectGraph(read_elements((tmp_path / "alone.fbx").read_bytes(), "alone.fbx"), "alone.fbx")
    root = next(model for model in graph.of_kind("Model", "LimbNode") if model.name == "root")
    block = root.element.child("Properties70")
    assert block is not None
    flags = {row.properties[0]: row.properties[3] for row in block.children or ()}
    assert flags["jawOpen"] == flags["browInnerUp"] == "A+U"
    others = [model for model in graph.of_kind("Model", "LimbNode") if model is not root]
    assert not any("jawOpen" in str(model.element) for model in others)
    targets = {to for ends in graph.parents.values() for parent, to in ends if parent == root.id}
    assert {"jawOpen", "browInnerUp"} <= targets


@pytest.mark.parametrize("suffix", [".fbx", ".glb"])
def test_quick_readers_find_the_motion(suffix: str, tmp_path: Path) -> None:
    _judge(tmp_path, suffix, readers.QUICK_FBX if suffix == ".fbx" else readers.QUICK_GLB)


@pytest.mark.readers
@pytest.mark.parametrize("suffix", [".fbx", ".glb"])
def test_slow_readers_find_the_motion(suffix: str, tmp_path: Path) -> None:
    # assimp names no bones but those of meshes.
    everyone = readers.SLOW_FBX if suffix == ".fbx" else readers.SLOW_GLB
    asked = [one for one in everyone if one != "assimp" and readers.installed(one)]
    if not asked:
        pytest.skip("no slow reader is installed")
    _judge(tmp_path, suffix, asked)


def _judge(folder: Path, suffix: str, asked: tuple[str, ...] | list[str]) -> None:
    scene = without_meshes(scenes.character(Fraction(60)))
    path = folder / f"alone{suffix}"
    (write_scene if suffix == ".fbx" else write_glb)(path, scene)
    readers.judge(path, replace(scenes.expected(scene), weights={}), asked)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [(("--format", "bvh"), "fbx, glb"), (("--unreal", "nowhere"), "meshes")],
    ids=["bvh alone", "unreal"],
)
def test_where_meshes_cannot_be_left_out_it_says_so(
    arguments: tuple[str, ...], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    to = () if "--unreal" in arguments else ("--to", str(tmp_path / "out"))
    assert main(["export", str(QUARTET), *to, *arguments, "--motion-only"]) == 2
    assert says in capsys.readouterr().err
