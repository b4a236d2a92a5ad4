"""``suisou export --skeleton`` and ``--check-skeleton``."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli import main
from app.export.mannequin import MANNEQUIN
from app.formats.bvh.read import read_bvh

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
FOREIGN = Path(__file__).parents[2] / "data" / "characters" / "child_mixamo.fbx"


def export(folder: Path, *more: str) -> int:
    arguments = ["export", str(QUARTET), "--to", str(folder), "--format", "bvh", "--fps", "24", "--to-bar", "1"]
    return main([*arguments, "--player", "Trumpet 1", *more])


def test_the_bones_are_those_asked_for(tmp_path: Path) -> None:
    assert export(tmp_path / "ue5", "--skeleton", "ue5") == 0
    names = set(read_bvh(tmp_path / "ue5" / "Trumpet 1.bvh").names)
    assert names <= {*MANNEQUIN, "eye_l", "eye_r"}
    assert {"eye_l", "eye_r", "pelvis", "spine_05", "upperarm_twist_01_l", "pinky_03_r"} <= names
    assert export(tmp_path / "own") == 0
    assert "upperChest" in read_bvh(tmp_path / "own" / "Trumpet 1.bvh").names


def test_an_asset_of_another_skeleton_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert export(tmp_path / "out", "--check-skeleton", str(FOREIGN)) != 0
    said = capsys.readouterr().err
    assert "child_mixamo.fbx has a different skeleton" in said
    assert "Trumpet 1" in said
    assert "mixamorig:Hips" in said
    assert not (tmp_path / "out").exists()


def test_an_asset_that_is_not_there_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert export(tmp_path / "out", "--check-skeleton", str(tmp_path / "absent.fbx")) != 0
    assert "absent.fbx" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
