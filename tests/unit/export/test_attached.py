"""Instruments on sockets through the command line: files, stage and report agree, and the judge confirms them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli import main
from app.export.attachment import in_world
from app.formats.bvh.read import read_bvh
from app.formats.fbx.read import read_scene, read_scenes
from tests.unit.export.test_rig import world_m
from tests.unit.export.unreal.conftest import QUARTET

ARGUMENTS = ("--fps", "24", "--from-bar", "2", "--to-bar", "2", "--player", "Trombone 2", "--format", "fbx,bvh")
HELD = "Trombone 2_trombone_tenor_F_attachment"


def exported(folder: Path, *options: str) -> dict[str, Any]:
    assert main(["export", str(QUARTET), "--to", str(folder), "--stage", *ARGUMENTS, *options]) == 0
    report: dict[str, Any] = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return report


@pytest.fixture(scope="module")
def free(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    folder = tmp_path_factory.mktemp("free")
    return folder, exported(folder)


def figures_of(value: object, path: str = "") -> dict[str, float]:
    if isinstance(value, dict):
        return {name: one for key, part in value.items() for name, one in figures_of(part, f"{path}/{key}").items()}
    return {path: float(value)} if isinstance(value, int | float) else {}


@pytest.mark.parametrize(
    "options",
    [("--instrument", "socket", "--root-bone", "place"), ("--instrument", "ik", "--root-bone", "motion", "--skeleton",
     "ue5", "--rest-pose", "a", "--twist-bones")],
)  # fmt: skip
def test_measures_stage_and_report(free: tuple[Path, dict[str, Any]], tmp_path: Path, options: tuple[str, ...]) -> None:
    plain_folder, plain = free
    report = exported(tmp_path, *options)
    (before,), (player,) = plain["players"], report["players"]
    assert before["socket"] is None
    hand = "leftHand" if "socket" in options else "ik_hand_l"
    assert player["socket"] == f"{hand}_socket"
    assert player["skeleton"]["rig"]["instrument"] == options[1]
    assert player["skeleton"]["rig"]["root_bone"] == options[3]
    # Contacts, keys and lips are judged on the instrument where it hangs.
    measures = (figures_of({name: one["measures"][name] for name in ("contacts", "lips", "controls", "feet", "bones")})
                for one in (before, player))  # fmt: skip
    found = list(measures)
    assert found[0].keys() == found[1].keys()
    for name, value in found[0].items():
        assert found[1][name] == pytest.approx(value, abs=0.02), name
    # In the file of the stage both are on one skeleton, and where the two free ones are.
    (figure, held) = report["stage"]["figures"]
    assert (figure["node"], held["node"], held["socket"]) == ("Trombone 2", HELD, player["socket"])
    (together,) = read_scenes(tmp_path / "quartet_stage.fbx")
    assert together.place is not None
    root = [bone.name for bone in together.bones].index(HELD)
    _, alone = read_scenes(plain_folder / "quartet_stage.fbx")
    assert alone.place is not None
    places = [scene.place.matrix for scene in (together, alone) if scene.place is not None]
    for place in places:
        place[:3, 3] /= 100.0
    where = places[1] @ world_m(alone)
    np.testing.assert_allclose(places[0] @ world_m(together)[:, root:], where, atol=1e-4)
    # In the own files too.
    character, instrument = read_scene(tmp_path / "Trombone 2.fbx"), read_scene(tmp_path / f"{HELD}.fbx")
    own = world_m(in_world(instrument, character, player["socket"]))
    stands = np.eye(4) if "place" in options else places[0]
    np.testing.assert_allclose(stands @ own, where, atol=1e-4)
    # A BVH contains the socket that is fixed in the hand; it cannot contain bones that are not below the hips.
    kept = [name for name in read_bvh(tmp_path / "Trombone 2.bvh").names if "socket" in name]
    assert kept == ([player["socket"]] if "socket" in options else [])


def test_more_than_one_process_writes_the_same(tmp_path: Path) -> None:
    """Options of skeletons are also sent to the scheduler's computers."""
    arguments = ["--fps", "12", "--from-bar", "1", "--to-bar", "1", "--player", "Trumpet 1", "--player", "Trombone 2"]
    arguments += ["--format", "fbx", "--instrument", "socket", "--rest-pose", "t"]
    for jobs in ("1", "2"):
        assert main(["export", str(QUARTET), "--to", str(tmp_path / jobs), "--jobs", jobs, *arguments]) == 0
    one, two = (
        {str(path.relative_to(tmp_path / jobs)): path.read_bytes() for path in (tmp_path / jobs).rglob("*.*")}
        for jobs in ("1", "2")
    )
    assert one == two
