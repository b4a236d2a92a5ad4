"""Exported files contain pose corrections: the bell is higher, and `inspect` lists the correction."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.cli import main
from app.export.playback import ScenePlayback
from app.formats.fbx.read import read_scene
from app.plan.by_hand.corrections import PoseCorrection
from app.project.edit.corrections import with_corrections
from app.project.storage import save
from tests.gui.conftest import quartet_project

PLAYER = "Trumpet 1"
UP = PoseCorrection("lifted", "bell", 2 * 480, 6 * 480, up_deg=12.0, fade_in_ticks=240, fade_out_ticks=240)
ARGUMENTS = ("--fps", "30", "--from-bar", "1", "--to-bar", "4", "--player", PLAYER)


def bell_directions(folder: Path) -> np.ndarray:
    """Direction of the instrument in every frame of the written file."""
    scene = read_scene(folder / f"{PLAYER}_trumpet_Bb.fbx")
    assert scene.clip is not None
    playback = ScenePlayback(scene, scene.clip)
    root = playback.world(0, scene.clip.frames)[:, 0]
    return root[:, :3, 2] / np.linalg.norm(root[:, :3, 2], axis=1, keepdims=True)


def test_a_lifted_bell_is_higher_in_the_files_and_only_then(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project = replace(quartet_project(), source="")
    player = next(player for player in project.players if player.name == PLAYER)
    found = []
    for name, value in (("plain", project), ("lifted", with_corrections(project, player.id, [UP]))):
        path = tmp_path / f"{name}.suisou"
        save(value, path)
        assert main(["export", str(path), "--to", str(tmp_path / name), *ARGUMENTS]) == 0
        found.append(bell_directions(tmp_path / name))
    plain, lifted = (np.degrees(np.arcsin(directions[:, 1])) for directions in found)
    rise = lifted - plain
    assert rise.max() == pytest.approx(12.0, abs=1.5)
    assert (np.abs(rise[-20:]) < 1e-3).all()
    capsys.readouterr()
    assert main(["inspect", str(tmp_path / "lifted.suisou"), "--json"]) == 0
    players = {entry["name"]: entry for entry in json.loads(capsys.readouterr().out)["players"]}
    (pose,) = players[PLAYER]["poses"]
    assert (pose["target"], pose["up_deg"]) == ("bell", 12.0)
    assert [pose["start_beat"], pose["end_beat"]] == pytest.approx([2.0, 6.0])
    assert "poses" not in players["Trumpet 2"]
