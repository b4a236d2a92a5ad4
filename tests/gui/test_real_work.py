"""A complete job in the real editor: killed during an edit, recovered, exported; no correction is lost."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest
from PySide6.QtGui import QGuiApplication

from app.plan.by_hand.corrections import AddExpression, PinFingering, PoseCorrection, SetBreath
from app.project import storage
from tests.support.real_work import LUTKIN, OFFSET_S

ROOT = Path(__file__).parents[2]
HANG_S = 900.0
"""Seconds after which a program is considered to hang, even on a busy machine."""


def run_editor(phase: str, folder: Path) -> subprocess.Popen[str]:
    with (folder / f"{phase}.log").open("w") as log:
        return subprocess.Popen(
            [sys.executable, "-m", "tests.support.real_work", phase, str(folder)],
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=log,
            text=True,
        )


@pytest.mark.usefixtures("qapp")
def test_killed_in_mid_edit_nothing_done_by_hand_is_lost(tmp_path: Path) -> None:
    assert QGuiApplication.platformName() != "offscreen"
    with run_editor("work", tmp_path) as at_work:
        reported = at_work.stdout.readline()
        at_work.send_signal(signal.SIGKILL)
    assert reported == "ready to be killed\n", (tmp_path / "work.log").read_text()

    saved = storage.load(tmp_path / "work.suisou")
    before = {note.id: note for part in saved.score.parts for note in part.notes}
    kinds = {type(item) for item in saved.corrections[saved.players[0].id]}
    assert kinds == {PinFingering, SetBreath, AddExpression, PoseCorrection}
    assert sum(isinstance(item, PinFingering) for item in saved.corrections[saved.players[0].id]) == 3
    assert saved.audio.offset_s == pytest.approx(OFFSET_S, abs=0.02)
    assert saved.source == str(LUTKIN)

    with run_editor("recover", tmp_path) as back:
        back.wait(timeout=HANG_S)
    assert back.returncode == 0, (tmp_path / "recover.log").read_text()
    recovered = storage.load(tmp_path / "work.suisou")
    after = {note.id: note for part in recovered.score.parts for note in part.notes}
    changed = [id_ for id_ in before if before[id_] != after[id_]]
    assert len(changed) == 1, "the edit that was in no file"
    assert after[changed[0]].pitch == before[changed[0]].pitch + 1
    assert recovered.corrections == saved.corrections

    report = msgspec.json.decode((tmp_path / "out" / "report.json").read_bytes())
    assert [player["name"] for player in report["players"]] == [player.name for player in recovered.players]
    for player in report["players"]:
        assert all((tmp_path / "out" / name).stat().st_size > 10_000 for name in player["files"].values())
        measures = player["measures"]
        assert all(control["right"] == control["judged"] for control in measures["controls"].values()), measures
        assert measures["breaths"]["shown"] == measures["breaths"]["planned"] > 0
