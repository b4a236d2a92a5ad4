"""A few bars are exported, read back, and compared with the plan and the bounds."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from fractions import Fraction
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
import soundfile

from app.cli import main
from app.export.playback import ScenePlayback
from app.export.report import PlayerReport, failures
from app.formats import usd_package
from app.formats.bvh.read import read_bvh
from app.formats.fbx.read import read_scene
from app.formats.gltf.read import read_glb
from metadata.model import ARKIT_MORPHS
from tests.support import readers

ROOT = Path(__file__).parents[3]
QUARTET = ROOT / "resources" / "examples" / "quartet.mid"
PLAYERS = ("Trumpet 1", "Trombone 2")
ARGUMENTS = (
    "--fps",
    "30",
    "--from-bar",
    "2",
    "--to-bar",
    "4",
    "--lead-in",
    "6",
    "--player",
    PLAYERS[0],
    "--player",
    PLAYERS[1],
)


def export(folder: Path, *arguments: str) -> dict[str, Any]:
    assert main(["export", str(QUARTET), "--to", str(folder), *arguments]) == 0
    report: dict[str, Any] = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return report


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("out") / "made" / "here"
    export(folder, *ARGUMENTS)
    return folder


@pytest.fixture(scope="module")
def report(folder: Path) -> dict[str, Any]:
    report: dict[str, Any] = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return report


def test_the_files_are_those_the_report_names(folder: Path, report: dict[str, Any]) -> None:
    assert [player["name"] for player in report["players"]] == list(PLAYERS)
    named = {file for player in report["players"] for file in player["files"].values()}
    textures = set(report["textures"])
    written = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert written == named | textures | {"report.json"}
    assert named == {
        "Trumpet 1.fbx", "Trumpet 1_trumpet_Bb.fbx", "Trumpet 1.bvh",
        "Trombone 2.fbx", "Trombone 2_trombone_tenor_F_attachment.fbx", "Trombone 2.bvh",
    }  # fmt: skip


def test_the_bundled_quartet_keeps_every_bound_and_shows_every_breath(tmp_path: Path) -> None:
    """New users see this export first: `./run` makes it without a display."""
    players = tuple(
        msgspec.convert(player, PlayerReport) for player in export(tmp_path / "all", "--fps", "30")["players"]
    )
    assert len(players) == 4
    for player in players:
        assert player.measures.breaths.shown == player.measures.breaths.planned > 10
        assert failures(player) == ()


def test_the_report_says_when_and_where(report: dict[str, Any]) -> None:
    assert report["fps"] == 30.0
    assert report["fps_exact"] == "30"
    assert report["bars"] == [2, 4]
    assert report["end_s"] == pytest.approx(report["first_frame_s"] + report["frames"] / 30)
    places = {(player["stage"]["x_m"], player["stage"]["z_m"]) for player in report["players"]}
    assert len(places) == 2


@pytest.mark.parametrize("name", PLAYERS)
def test_the_character_file(folder: Path, report: dict[str, Any], name: str) -> None:
    scene = read_scene(folder / f"{name}.fbx")
    assert scene.clip.frames == report["frames"]
    assert scene.clip.fps == 30
    names = [bone.name for bone in scene.bones]
    assert names[0] == "root"
    assert {"hips", "rightIndexDistal", "leftFoot", "leftThumbMetacarpal"} <= set(names)
    # The player stands at the origin, facing +Z: the left hand is on the +X side of the body at rest.
    playback = ScenePlayback(scene, scene.clip)
    world = playback.world(0, report["frames"])
    root = names.index("root")
    np.testing.assert_allclose(world[:, root], np.tile(np.eye(4), (report["frames"], 1, 1)), atol=1e-6)
    feet = world[..., :3, 3][:, [names.index("leftFoot"), names.index("rightFoot")]]
    assert (feet[:, 0, 0] > feet[:, 1, 0]).all()
    assert abs(feet.mean(axis=(0, 1))[[0, 2]]).max() < 0.15
    morphs = {morph.name for mesh in scene.meshes for morph in mesh.morphs}
    assert set(ARKIT_MORPHS) <= morphs
    assert "jawOpen" in scene.clip.morph_weights


def test_the_instrument_file_moves_with_the_player(folder: Path) -> None:
    scene = read_scene(folder / "Trumpet 1_trumpet_Bb.fbx")
    assert scene.clip is not None
    names = [bone.name for bone in scene.bones]
    assert names[0] == "root"
    assert {"valve_1", "valve_2", "valve_3", "third_slide"} <= set(names)
    instrument = ScenePlayback(scene, scene.clip)
    # The root's origin is the mouthpiece's rim, which is at the lips in almost all of these bars.
    player_scene = read_scene(folder / "Trumpet 1.fbx")
    assert player_scene.clip is not None
    player = ScenePlayback(player_scene, player_scene.clip)
    frames = scene.clip.frames
    head = player.world(0, frames)[:, [bone.name for bone in player_scene.bones].index("head"), :3, 3]
    rim = instrument.world(0, frames)[:, 0, :3, 3]
    assert np.median(np.linalg.norm(rim - head, axis=1)) < 0.2
    assert np.ptp(instrument.translations_m(0, frames)[:, names.index("valve_2")], axis=0).max() > 0.01


@pytest.mark.parametrize("name", PLAYERS)
def test_bvh_is_the_same_motion(folder: Path, report: dict[str, Any], name: str) -> None:
    clip = read_bvh(folder / f"{name}.bvh")
    scene = read_scene(folder / f"{name}.fbx")
    assert scene.clip is not None
    assert clip.names[0] == "hips"
    assert len(clip.root_translation_cm) == report["frames"]
    playback = ScenePlayback(scene, scene.clip)
    world = playback.world(0, report["frames"])[..., :3, 3] * 100.0
    from app.export.joints import world_transforms

    translations = np.tile(np.asarray(clip.offsets_cm, np.float64), (report["frames"], 1, 1))
    translations[:, 0] = clip.root_translation_cm
    bvh_world = world_transforms(clip.parents, translations, np.asarray(clip.rotations_xyzw, np.float64))
    order = [[bone.name for bone in scene.bones].index(joint) for joint in clip.names]
    np.testing.assert_allclose(bvh_world[..., :3, 3], world[:, order], atol=0.005)


def test_measures_keep_their_bounds(report: dict[str, Any]) -> None:
    broken = []
    for player in report["players"]:
        measures = player["measures"]
        spreads = {
            **measures["contacts"],
            **measures["feet"],
            **{part: measures[part] for part in ("lips", "upper_lip_in_breaths", "bones", "penetration")},
        }
        broken += [
            (player["name"], name, spread)
            for name, spread in spreads.items()
            if not (spread["frames"] > 0 and spread["max_mm"] <= spread["bound_mm"])
        ]
        for name, counts in measures["controls"].items():
            assert counts["judged"] == player["notes"] - counts["short_notes"] > 0
            if counts["right"] != counts["judged"] or counts["held_wrong"]:
                broken.append((player["name"], name, counts))
        for part in ("limits", "acceleration"):
            if measures[part]["beyond"]:
                broken.append((player["name"], part, measures[part]))
        breaths = measures["breaths"]
        if not breaths["shown"] == breaths["planned"] > 0:
            broken.append((player["name"], "breaths", breaths))
        assert player["sway_correlation"] < 0.9
    assert broken == []


def test_a_second_run_has_the_same_bits_and_a_cut_the_wholes_frames(
    folder: Path, report: dict[str, Any], tmp_path: Path
) -> None:
    export(tmp_path / "again", *ARGUMENTS)
    for path in (path for path in folder.rglob("*") if path.is_file()):
        assert (tmp_path / "again" / path.relative_to(folder)).read_bytes() == path.read_bytes(), path.name
    whole = export(tmp_path / "whole", "--fps", "30", "--player", PLAYERS[0], "--format", "fbx")
    assert not list((tmp_path / "whole").glob("*.bvh"))
    first = round((report["first_frame_s"] - whole["first_frame_s"]) * 30)
    assert whole["first_frame_s"] + first / 30 == pytest.approx(report["first_frame_s"], abs=1e-9)
    cut_scene, whole_scene = (read_scene(place / f"{PLAYERS[0]}.fbx") for place in (folder, tmp_path / "whole"))
    assert cut_scene.clip is not None
    assert whole_scene.clip is not None
    span = slice(first, first + report["frames"])
    np.testing.assert_allclose(
        np.abs(cut_scene.clip.rotations_xyzw), np.abs(whole_scene.clip.rotations_xyzw[span]), atol=2e-6
    )


def test_sway_is_not_compared_in_a_short_excerpt(tmp_path: Path) -> None:
    only = ("--from-bar", "2", "--to-bar", "2", "--format", "bvh")
    short = export(tmp_path / "out", *only, "--player", PLAYERS[0], "--player", PLAYERS[1])
    assert [player["sway_correlation"] for player in short["players"]] == [None, None]


def test_several_formats_at_once_and_what_has_a_skin_is_measured(tmp_path: Path) -> None:
    arguments = ("--fps", "25", "--from-bar", "2", "--to-bar", "2", "--player", PLAYERS[0])
    report = export(tmp_path / "out", *arguments, "--format", "glb, BVH", "--format", "bvh", "--bvh-names", "cmu")
    (player,) = report["players"]
    assert player["files"] == {
        "character_bvh": "Trumpet 1.bvh",
        "character_glb": "Trumpet 1.glb",
        "instrument_glb": "Trumpet 1_trumpet_Bb.glb",
    }
    assert player["measures"]["contacts"]
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert written == {*player["files"].values(), "report.json"}
    assert {"Hips", "LowerBack", "LeftForeArm", "leftIndexDistal"} <= set(
        read_bvh(tmp_path / "out" / "Trumpet 1.bvh").names
    )
    model = read_glb(tmp_path / "out" / "Trumpet 1.glb")
    assert {node.name for node in model.nodes} >= {"root", "hips", "rightIndexDistal"}
    assert set(ARKIT_MORPHS) <= {morph.name for morph in model.meshes[0].primitives[0].morphs}


def test_the_sound_starts_with_the_first_frame_and_usd_refers_to_it(tmp_path: Path) -> None:
    kind = "usd" if usd_package.usd_installed() else "bvh"
    arguments = ("--fps", "25", "--to-bar", "1", "--player", PLAYERS[0], "--format", kind, "--sound")
    report = export(tmp_path / "out", *arguments)
    assert report["sound"] == "quartet.wav"
    sound, rate_hz = soundfile.read(tmp_path / "out" / "quartet.wav")
    assert (rate_hz, sound.shape) == (48_000, (round(report["frames"] / 25 * 48_000), 2))
    # The piece is heard from its first note on, which is after the pre-roll.
    first_s = np.flatnonzero(np.abs(sound).max(axis=1) > 1e-3)[0] / 48_000
    assert 0.2 < first_s < report["frames"] / 25 - 0.5
    if kind == "usd":
        from pxr import Usd, UsdMedia

        stage = Usd.Stage.Open(str(tmp_path / "out" / "Trumpet 1.usdc"))
        audio = UsdMedia.SpatialAudio(stage.GetDefaultPrim().GetChild("Sound"))
        assert Path(audio.GetFilePathAttr().Get().resolvedPath) == tmp_path / "out" / "quartet.wav"
        assert audio.GetStartTimeAttr().Get().GetValue() == 0


def test_without_usd_core_nothing_is_begun(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(usd_package, "usd_installed", lambda: False)
    assert main(["export", str(QUARTET), "--to", str(tmp_path / "out"), "--format", "fbx,usd"]) == 2
    assert "pip install usd-core" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("rate", ["24", "25", "29.97"])
def test_other_frame_rates(tmp_path: Path, rate: str) -> None:
    arguments = ("--from-bar", "2", "--to-bar", "3", "--player", PLAYERS[1], "--format", "fbx")
    report = export(tmp_path / "out", "--fps", rate, *arguments)
    scene = read_scene(tmp_path / "out" / f"{PLAYERS[1]}.fbx")
    assert scene.clip.fps == Fraction(report["fps_exact"])
    controls = report["players"][0]["measures"]["controls"]
    assert all(counts["right"] == counts["judged"] for counts in controls.values())


def test_ctrl_c_leaves_nothing(tmp_path: Path) -> None:
    """An export stopped in the middle has exit status 130 and leaves a sentence, but no file or folder."""
    if os.name == "nt":
        pytest.skip("signals to a child are another thing there")
    target = tmp_path / "out"
    command = [sys.executable, "-m", "app", "export", str(QUARTET), "--to", str(target)]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        deadline = time.monotonic() + 600
        while not list(target.glob(".*.partial/*")) and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        assert process.poll() is None
        assert not list(target.glob("*.*"))[1:]  # only the hidden folder
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=900)
    assert process.returncode == 130
    assert out == b""
    assert b"Traceback" not in err
    assert b"stopped" in err
    assert not target.exists()


def test_names_become_files_only_inside_the_folder(tmp_path: Path) -> None:
    from tests.unit.cli.test_main import named_piece

    piece = named_piece(tmp_path / "piece.mid", "../evil", "CON", "Trumpet 🎺", "trumpet 🎺")
    arguments = ["export", str(piece), "--to", str(tmp_path / "a" / "b"), "--format", "bvh", "--fps", "24"]
    assert main(arguments) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"piece.mid", "a"}
    stems = [path.stem for path in (tmp_path / "a" / "b").glob("*.bvh")]
    assert len({stem.casefold() for stem in stems}) == 4
    assert "_CON" in stems
    assert not any(re.search(r'[<>:"/\\|?*]', stem) for stem in stems)


def expected(folder: Path, name: str, frames: list[int]) -> readers.Expected:
    scene = read_scene(folder / f"{name}.fbx")
    assert scene.clip is not None
    playback = ScenePlayback(scene, scene.clip)
    world_cm = playback.world(0, scene.clip.frames)[frames][..., :3, 3] * 100.0
    names = playback.bone_names
    return readers.Expected(
        fps=scene.clip.fps,
        frames=scene.clip.frames,
        sampled=frames,
        joints_cm={bone: world_cm[:, index] for index, bone in enumerate(names)},
        parents={
            bone: None if parent < 0 else names[parent] for bone, parent in zip(names, playback.parents, strict=True)
        },
        weights={morph: np.asarray(curve)[frames] for morph, curve in scene.clip.morph_weights.items()},
    )


def test_quick_readers_agree(folder: Path, report: dict[str, Any]) -> None:
    frames = [0, 7, report["frames"] - 1]
    asked = [reader for reader in readers.QUICK_FBX if readers.installed(reader)]
    for name in (PLAYERS[0], f"{PLAYERS[0]}_trumpet_Bb"):
        readers.judge(folder / f"{name}.fbx", expected(folder, name, frames), asked)


@pytest.mark.readers
@pytest.mark.parametrize(
    ("reader", "name"),
    [("blender", "Trumpet 1"), *((reader, "Trombone 2_trombone_tenor_F_attachment") for reader in readers.SLOW_FBX)],
)
def test_slow_readers_agree(folder: Path, report: dict[str, Any], reader: str, name: str) -> None:
    if not readers.installed(reader):
        pytest.skip(f"{reader} is not installed")
    frames = [0, 7, report["frames"] - 1]
    readers.judge(folder / f"{name}.fbx", expected(folder, name, frames), [reader])
