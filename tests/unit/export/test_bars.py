"""Every file contains exactly the requested bars, and a lead-in only on request."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from app.arrays import FloatArray
from app.cli import main
from app.errors import Message
from app.export.character import character_scene
from app.export.playback import ScenePlayback
from app.export.targets import target_skeleton
from app.formats.bvh.read import read_bvh
from app.formats.fbx.read import read_scene
from app.formats.gltf.vrma import read_vrma
from app.formats.usd_package import usd_installed
from app.messages import text
from app.performance.bodies import character_of
from app.performance.ensemble import Performance
from app.performance.span import cut_span
from app.project.storage import save
from app.score.model import UnplayedPart
from app.score.part_messages import about_notes
from tests.support.performed import player_motion
from tests.support.skinned import GlbFile, UsdFile
from tests.unit.cli.test_main import QUARTET
from tests.unit.viewport.poses import quartet

PLAYER = "Trumpet 1"
FPS = Fraction(30)
BARS = (9, 9)
HALF_A_FRAME_S = 0.5 / 30 + 1e-4
BAR_S = 3 * 60.0 / 78.0
FORMATS = ("fbx", "bvh", "glb", "vrma", *(("usd",) if usd_installed() else ()))
WITHIN_CM = 0.01


def export(folder: Path, *options: str, file: Path = QUARTET) -> dict[str, Any]:
    """Report on an export of the player."""
    arguments = ["export", str(file), "--to", str(folder), "--fps", str(FPS), "--player", PLAYER, *options]
    assert main(arguments) == 0
    report: dict[str, Any] = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return report


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bars")
    first, last = map(str, BARS)
    export(folder, "--from-bar", first, "--to-bar", last, "--format", ",".join(FORMATS), "--sound")
    return folder


@pytest.fixture(scope="module")
def joints_cm() -> FloatArray:
    """Positions (B, 3) of the joints at the beginning of the first bar, in the motion of a longer range."""
    performance = Performance(quartet())
    player = performance.project.players[0]
    first_s = (BARS[0] - 1) * BAR_S
    span = cut_span(performance.time_frame, FPS, first_s - 4.0, first_s + 1.0)
    character = character_of(player)
    motion = player_motion(performance, player, span)
    scene = character_scene(character, motion, player.name, "Suisou", target_skeleton(character, "own"))
    assert scene.clip is not None
    frame = round((first_s - span.first_frame_s) * 30)
    return 100.0 * ScenePlayback(scene, scene.clip).world(frame, frame + 1)[0, :, :3, 3]


def _fbx(path: Path) -> FloatArray:
    scene = read_scene(path)
    assert scene.clip is not None
    return 100.0 * ScenePlayback(scene, scene.clip).world(0, 1)[0, :, :3, 3]


READ: dict[str, Callable[[Path], FloatArray]] = {
    "fbx": _fbx,
    "glb": lambda path: GlbFile(path).shown(0).joints_cm,
    "usd": lambda path: UsdFile(path).shown(0).joints_cm,
}


def test_the_report_names_the_bars_and_no_more(folder: Path) -> None:
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    assert report["bars"] == [*BARS]
    assert report["first_frame_s"] == pytest.approx((BARS[0] - 1) * BAR_S, abs=HALF_A_FRAME_S)
    assert report["end_s"] == pytest.approx(BARS[1] * BAR_S, abs=HALF_A_FRAME_S)
    assert report["frames"] == pytest.approx(BAR_S * 30, abs=1)


@pytest.mark.parametrize("kind", [kind for kind in FORMATS if kind in READ])
def test_the_first_pose_is_that_of_the_bar(folder: Path, joints_cm: FloatArray, kind: str) -> None:
    (path,) = (path for path in folder.iterdir() if path.stem == PLAYER and path.suffix.startswith(f".{kind}"))
    np.testing.assert_allclose(READ[kind](path), joints_cm, atol=WITHIN_CM)


def test_a_vrm_animation_has_these_frames_and_begins_with_the_bar(folder: Path, joints_cm: FloatArray) -> None:
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    scene = read_vrma(folder / f"{PLAYER}.vrma", ())
    assert scene.clip is not None
    assert scene.clip.frames == report["frames"]
    names = character_of(quartet().players[0]).skeleton.names
    world = 100.0 * ScenePlayback(scene, scene.clip).world(0, 1)[0, :, :3, 3]
    for bone, place_cm in zip(scene.bones, world, strict=True):
        if bone.name in names:
            np.testing.assert_allclose(place_cm, joints_cm[names.index(bone.name)], atol=WITHIN_CM, err_msg=bone.name)


def test_a_bvh_has_as_many_frames(folder: Path) -> None:
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    assert len(read_bvh(folder / f"{PLAYER}.bvh").rotations_xyzw) == report["frames"]


def test_beats_before_the_bars_come_on_request(tmp_path: Path) -> None:
    bars = ("--format", "bvh", "--from-bar", str(BARS[0]), "--to-bar", str(BARS[0]))
    report = export(tmp_path, *bars, "--lead-in", "2")
    assert report["first_frame_s"] == pytest.approx((BARS[0] - 1) * BAR_S - 2 * BAR_S / 3, abs=HALF_A_FRAME_S)
    assert report["bars"] == [BARS[0], BARS[0]]


def test_the_preroll_is_before_the_first_note_only(tmp_path: Path) -> None:
    report = export(tmp_path / "first", "--format", "bvh", "--to-bar", "1", "--preroll", "6")
    assert report["first_frame_s"] == pytest.approx(-6 * BAR_S / 3, abs=1e-3)
    report = export(tmp_path / "second", "--format", "bvh", "--from-bar", "1", "--to-bar", "1", "--preroll", "6")
    assert report["first_frame_s"] == pytest.approx(0.0, abs=HALF_A_FRAME_S)


def test_remarks_on_reading_are_those_of_the_bars(tmp_path: Path) -> None:
    project = quartet()
    part, notes = project.score.parts[0].name, project.score.parts[0].notes
    early, late = notes[:2], notes[-2:]
    score = msgspec.structs.replace(
        project.score,
        warnings=(
            about_notes("score.unisons", part, early, project.score),
            about_notes("score.doubling", part, late, project.score, instrument="cornet"),
            about_notes("score.looks_written", part, late, project.score, map="trumpet_Bb", outside=2, total=99),
            Message("score.written", {"part": part, "map": "trumpet_Bb"}),
        ),
        unplayed=(UnplayedPart(part, about_notes("score.key_switches", part, late, project.score), 2, 9),),
    )
    file = tmp_path / "piece.suisou"
    save(replace(project, score=score), file)
    every, some = (
        export(tmp_path / name, "--format", "bvh", "--to-bar", last, file=file)
        for name, last in (("every", str(project.score.metre_map.bar_of_tick(late[0].onset_tick))), ("some", "1"))
    )
    texts = [text(message) for message in score.warnings]
    assert [line for line in every["warnings"] if line in texts] == texts
    assert [line for line in some["warnings"] if line in texts] == [texts[0], *texts[2:]]
    assert len(every["unplayed"]) == 1
    assert some["unplayed"] == []
    last = str(project.score.metre_map.bar_of_tick(late[0].onset_tick))
    end = export(tmp_path / "end", "--format", "bvh", "--from-bar", last, "--to-bar", last, file=file)
    assert end["unplayed"] == []
