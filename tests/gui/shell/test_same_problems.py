"""An unreachable place is reported as the same problem everywhere."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest
from pytestqt.qtbot import QtBot

from app.cli import main
from app.editor.generator import Generator
from app.editor.session import Session
from app.messages import text
from app.plan.problem_lines import problem_lines
from app.project.storage import save
from tests.support.bodies import playing
from tests.support.live import performance_of
from tests.support.tasks import ImmediateTasks
from widgets.timeline.lanes.problems import ProblemsLane
from widgets.timeline.zoom_and_scroll import TimeAxis

pytestmark = pytest.mark.moved

KINDS = {"character.instrument_size", "contact.out_of_reach", "contact.hand_off"}
"""Kinds of problems: of the body, of notes, and of motion only."""


def test_inspect_export_stream_and_editor_report_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], qtbot: QtBot
) -> None:
    """A figure whose height is two and a half heads, and all positions of a tenor trombone."""
    project = performance_of("trombone_tenor_F_attachment", [(240 * i, 240, 36 + i) for i in range(12)]).project
    players = tuple(msgspec.structs.replace(player, character_id="chibi") for player in project.players)
    project = replace(project, players=players)
    player, file, out = players[0], str(tmp_path / "scale.suisou"), tmp_path / "out"
    save(project, file)
    with playing():
        assert main(["inspect", file, "--json"]) == 0
        inspected = json.loads(capsys.readouterr().out)["warnings"]
        assert main(["inspect", file, "--json", "--no-contacts"]) == 0
        without_motion = json.loads(capsys.readouterr().out)["warnings"]
        assert main(["export", file, "--to", str(out), "--format", "bvh"]) == 0
        exported = json.loads((out / "report.json").read_bytes())["warnings"]
        capsys.readouterr()
        assert main(["stream", file, "--from", "2.9"]) == 0
        streamed = [line.strip() for line in capsys.readouterr().err.splitlines()]
        session = Session(project, ImmediateTasks())
        generator = Generator(session, session.tasks)
        try:
            lane = ProblemsLane(session, TimeAxis())
            qtbot.addWidget(lane)

            def shown() -> list[str]:
                lines = problem_lines(lane.problems, project.score, text, player.part_id)
                return [f"{player.name}: {line}" for line in lines]

            # Motion is judged piece by piece.
            qtbot.waitUntil(lambda: {problem.message.id for problem in lane.problems} >= KINDS)
            qtbot.waitUntil(lambda: shown() == inspected)
        finally:
            generator.close()
    assert exported == inspected
    only_of_motion = set(inspected) - set(without_motion)
    assert only_of_motion
    assert all("hand" in line for line in only_of_motion)
    assert set(without_motion) < set(inspected)
    assert streamed == ["to look at:", *inspected]
