"""An uncaught exception fails the test, even if Qt or a thread would ignore it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
TESTS = """
import sys
import threading

import pytest
from PySide6.QtCore import QEvent, QObject, QRunnable, QThreadPool, QTimer
from PySide6.QtWidgets import QApplication, QPushButton, QWidget

from app.editor.window_thread_calls import window_calls
from app.shell.crash_handler import CrashHandler


class Session:
    def notice(self, *reported):
        pass


class Filter(QObject):
    def eventFilter(self, watched, event):
        if event.type() == QEvent.Type.User:
            raise RuntimeError("fault")
        return False


class Painted(QWidget):
    def paintEvent(self, event):
        raise RuntimeError("fault")


def fail(*_):
    raise RuntimeError("fault")


def test_of_a_slot(qapp):
    button = QPushButton()
    button.clicked.connect(fail)
    button.click()


def test_of_a_timer(qapp, qtbot):
    QTimer.singleShot(0, fail)
    qtbot.wait(20)


def test_of_an_event_filter(qapp):
    watched, filter = QObject(), Filter()
    watched.installEventFilter(filter)
    QApplication.sendEvent(watched, QEvent(QEvent.Type.User))


def test_of_painting(qapp):
    Painted().grab()


def test_of_a_thread(qapp):
    thread = threading.Thread(target=fail)
    thread.start()
    thread.join()


def test_of_a_call_of_a_thread(qapp, qtbot):
    window_calls().ask(fail)
    qtbot.wait(50)


def test_of_a_finaliser(qapp):
    class Dropped:
        __del__ = fail

    Dropped()


@pytest.mark.parametrize("where", ["slot", "thread"])
def test_under_the_crash_handler(qapp, qtbot, monkeypatch, tmp_path, where):
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)
    monkeypatch.setattr(threading, "excepthook", threading.excepthook)
    CrashHandler(Session(), lambda: None, tmp_path / "faults.log").install()
    if where == "slot":
        button = QPushButton()
        button.clicked.connect(fail)
        button.click()
    else:
        thread = threading.Thread(target=fail)
        thread.start()
        thread.join()
        qtbot.wait(50)


@pytest.mark.at_fault
def test_expected_of_the_crash_handler(qapp, monkeypatch, tmp_path):
    CrashHandler(Session(), lambda: None, tmp_path / "faults.log").report(RuntimeError("fault"))
"""


def test_every_uncaught_exception_fails_a_test(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text(
        f"import sys; sys.path.insert(0, {str(ROOT)!r})\n"
        "from tests.gui.conftest import _faults_of_the_program_fail, qapp_args\n",
        encoding="utf-8",
    )
    settings = "[pytest]\nfilterwarnings = error\nmarkers = at_fault: a fault is expected\n"
    (tmp_path / "pytest.ini").write_text(settings, encoding="utf-8")
    (tmp_path / "test_faults.py").write_text(TESTS, encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-q", "-rA", "-p", "no:cacheprovider", "-p", "no:xvfb", str(tmp_path)]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env={**os.environ, "QT_QPA_PLATFORM": "offscreen", "PYTEST_ADDOPTS": ""},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    bad = set(re.findall(r"^(?:FAILED|ERROR) test_faults.py::(\S+)", done.stdout, re.MULTILINE))
    every = set(re.findall(r"^(?:PASSED|FAILED|ERROR) test_faults.py::(\S+)", done.stdout, re.MULTILINE))
    assert len(every) == 10, done.stdout + done.stderr
    assert every - bad == {"test_expected_of_the_crash_handler"}
