"""Files in an Unreal project as read by other programs, including the FBX SDK, which Unreal uses."""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.export.playback import ScenePlayback
from app.export.unreal.project import UnrealProject
from app.formats.fbx.read import read_scene
from app.performance.span import bars_span
from tests.support import readers
from tests.unit.export.unreal.conftest import Export, quartet, request_of


def judge(file: Path, scratch: Path, asked: Sequence[str]) -> None:
    scene = read_scene(file)
    frames = [0, scene.clip.frames // 2, scene.clip.frames - 1]
    playback = ScenePlayback(scene, scene.clip)
    world_cm = playback.world(0, scene.clip.frames)[frames][..., :3, 3] * 100.0
    names = playback.bone_names
    expected = readers.Expected(
        fps=scene.clip.fps,
        frames=scene.clip.frames,
        sampled=frames,
        joints_cm={bone: world_cm[:, index] for index, bone in enumerate(names)},
        parents={
            bone: None if parent < 0 else names[parent] for bone, parent in zip(names, playback.parents, strict=True)
        },
        weights={morph: np.asarray(curve)[frames] for morph, curve in scene.clip.morph_weights.items()},
    )
    shutil.copy(file, scratch / file.name)
    readers.judge(scratch / file.name, expected, asked)


def exported(unreal: UnrealProject, export: Export) -> list[Path]:
    request = request_of(quartet())
    span = bars_span(request.performance, Fraction(24), (1, 1), 0.0)
    export(replace(request, span=span))
    folder = unreal.folder / "SuisouSource" / "quartet"
    reported = json.loads((folder / "performance.json").read_text(encoding="utf-8"))
    return [folder / name for name in sorted(reported["files"]) if name.endswith(".fbx")]


def test_quick_readers_agree(unreal: UnrealProject, export: Export, tmp_path: Path) -> None:
    files = exported(unreal, export)
    assert len(files) == 2
    for file in files:
        judge(file, tmp_path, [reader for reader in readers.QUICK_FBX if readers.installed(reader)])


@pytest.mark.readers
def test_the_fbx_sdk_agrees(unreal: UnrealProject, export: Export, tmp_path: Path) -> None:
    if not readers.installed("fbxsdk"):
        pytest.skip("the FBX SDK's reader is not installed")
    for file in exported(unreal, export):
        judge(file, tmp_path, ["fbxsdk"])
