"""The crash handler reports an exception once, from any thread, and unaffected parts continue."""

from __future__ import annotations

import sys
import threading
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.errors import Message
from app.project.edit.players import rename
from app.shell.app import Program
from app.shell.crash_handler import CrashHandler
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Start
from tests.support.windows import child
from widgets.players.player_list import PlayerList
from widgets.timeline.lanes.recording.waveform import WaveformLane

pytestmark = pytest.mark.at_fault


def raised(error: Exception) -> Exception:
    """The error with the place where it was raised."""
    try:
        raise error
    except Exception as caught:  # noqa: BLE001
        return caught


def test_a_fault_again_and_again_is_reported_once(
    program: Program, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    now_s, saved = [0.0], []
    log = tmp_path / "faults.log"
    faults = CrashHandler(program.session, lambda: saved.append(now_s[0]), log, clock=lambda: now_s[0])
    noticed: list[object] = []
    program.session.noticed.connect(lambda *reported: noticed.append(reported))
    for _ in range(300):
        faults.report(raised(ValueError("not drawn")))
        now_s[0] += 1.0 / 60.0
    assert (len(noticed), len(saved)) == (1, 1)
    assert log.read_text(encoding="utf-8").count("ValueError: not drawn") == 1
    # The same fault at another place, or later, counts as another one.
    faults.report(raised(KeyError("other")))
    assert len(noticed) == 2
    now_s[0] += 60.0
    faults.report(raised(ValueError("not drawn")))
    assert len(noticed) == 3
    capsys.readouterr()


def test_a_fault_in_a_thread_is_reported_in_the_window(
    program: Program, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)
    monkeypatch.setattr(threading, "excepthook", threading.excepthook)
    faults = CrashHandler(program.session, lambda: None, tmp_path / "faults.log")
    faults.install()
    thread = threading.Thread(target=lambda: 1 // 0)
    thread.start()
    thread.join()
    qtbot.waitUntil(lambda: "ZeroDivisionError" in program.window.status.notice_text)
    assert "ZeroDivisionError" in (tmp_path / "faults.log").read_text(encoding="utf-8")
    capsys.readouterr()


def test_a_fault_of_one_panel_leaves_the_others_at_work(
    start: Start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    failing = list[str]()

    def fail(lane: WaveformLane, *_: object) -> None:
        failing.append(lane.id)
        raise RuntimeError("a lane is at fault")

    program = start()
    program.editor.files.open(QUARTET, ask=False)
    monkeypatch.setattr(WaveformLane, "project_changed", fail)
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)
    CrashHandler(program.session, lambda: None, tmp_path / "faults.log").install()
    player = program.session.project.players[0]
    program.session.attempt(Message("edit.set_tempo"), lambda project: rename(project, player.id, "Renamed"))
    assert failing == ["audio"]
    players = child(program.window, PlayerList)
    assert players.rows.rows[0].player.name == "Renamed"
    assert program.session.performance.project is program.session.project, "the plans are made"
    assert "a lane is at fault" in program.window.status.notice_text
    capsys.readouterr()
