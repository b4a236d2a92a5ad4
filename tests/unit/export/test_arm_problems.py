"""Problems of arms in clothes, in reports of exports and of performances without any file."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli import main
from app.cli.inspect import inspection
from app.errors import Cancelled
from app.export import arm_problems, measure
from app.export.arm_depths import ARM_MM, ArmDepth
from app.export.arm_problems import MOST_MEASURED, all_arm_problems, performer_arm_problems
from app.performance.cast import performer_of
from app.performance.ensemble import Performance
from app.performance.motion import performance_curves
from app.project.model import Project
from tests.gui.conftest import QUARTET, quartet_project


def of_one() -> Project:
    """Return the quartet with its first player only."""
    project = quartet_project()
    return replace(project, players=project.players[:1])


def test_only_depths_beyond_the_bound_are_problems_at_their_time() -> None:
    assert arm_problems.arm_problems(ArmDepth("left", ARM_MM, 30), -1.0, 15.0) == ()
    (found,) = arm_problems.arm_problems(ArmDepth("left", ARM_MM + 2.25, 30), -1.0, 15.0)
    assert found.start_s == pytest.approx(1.0)
    assert found.message.arguments == {"side": "left", "depth_mm": 12.2, "most_mm": 10}


def test_the_surfaces_of_a_motion_are_measured() -> None:
    """A player in own clothes is measured, and clear of them."""
    found, notice = all_arm_problems(Performance(of_one()), of_one().players)
    assert list(found.values()) == [()]
    assert notice is None


def test_a_measurement_stops_when_it_is_requested() -> None:
    project = of_one()
    performance = Performance(project)
    performer = performer_of(performance, project.players[0])
    curves, asked = performance_curves(performance, performer), list[int]()

    def later() -> bool:
        asked.append(1)
        return len(asked) > 5

    with pytest.raises(Cancelled):
        performer_arm_problems(performer, curves, performance.time_frame, later)
    assert len(asked) == 6


def test_an_inspection_lists_arms_that_are_too_deep(monkeypatch: pytest.MonkeyPatch) -> None:
    project = of_one()
    monkeypatch.setattr(arm_problems, "arm_depth", lambda joints, stop_requested: ArmDepth("right", 24.6, 40))
    (line,) = [one for one in inspection(Performance(project))["warnings"] if "forearm" in one]
    assert line.startswith(f"{project.players[0].name}: ")
    assert "right forearm goes up to 24.6 mm" in line
    assert not [one for one in inspection(Performance(project), contacts=False)["warnings"] if "forearm" in one]


def test_more_players_are_measured_on_request_only(monkeypatch: pytest.MonkeyPatch) -> None:
    performance = Performance(quartet_project())
    players = performance.project.players * (1 + MOST_MEASURED)
    monkeypatch.setattr(arm_problems, "arm_depth", lambda joints, stop_requested: ArmDepth("right", 24.6, 40))
    found, notice = all_arm_problems(performance, players)
    assert not found
    assert notice is not None
    found, notice = all_arm_problems(performance, players, without_limit=True)
    assert all(found.values())
    assert notice is None


def test_an_export_lists_arms_that_are_too_deep(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measure, "arm_depth", lambda joints: ArmDepth("right", 24.6, 3))
    some = (
        "--format",
        "glb",
        "--texture-size",
        "off",
        "--from-bar",
        "2",
        "--to-bar",
        "2",
        "--player",
        "Trumpet 1",
        "--jobs",
        "1",
    )
    assert main(["export", str(QUARTET), "--to", str(tmp_path), *some, "--player", "Trumpet 1"]) == 0
    warnings = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))["warnings"]
    assert [one for one in warnings if one.startswith("Trumpet 1: the right forearm goes up to 24.6 mm")]
