"""Ctrl-C at any moment ends a command with exit status 130 and without a traceback."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.unit.cli.test_main import QUARTET, ROOT

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals to a child are another thing there")

LOADING = {
    "app.errors": ["inspect", str(QUARTET)],
    "numpy": ["midi", str(QUARTET), "--to", "x.mid"],
    "app.cli.options": ["record", "--port", "EWI", "--to", "x.mid"],
    "app.export.run": ["export", str(QUARTET), "--to", "x"],
    "PySide6.QtWidgets": ["edit"],
}
"""Command that is stopped right after a module was loaded, by module."""


def stopped_after(module: str, arguments: list[str], folder: Path) -> tuple[int, str]:
    """Exit status and output (except for Python's list of modules) of a command that is stopped while loading."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "QT_QPA_PLATFORM": "offscreen"}
    command = [sys.executable, "-X", "importtime", "-m", "app", *arguments]
    with subprocess.Popen(command, cwd=folder, env=environment, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        printed = []
        for line in process.stderr:
            if not line.startswith("import time:"):
                printed.append(line)
            elif line.rsplit("|", 1)[-1].strip() == module:
                process.send_signal(signal.SIGINT)
    return process.returncode, "".join(printed)


def test_while_modules_load(tmp_path: Path) -> None:
    with ThreadPoolExecutor(len(LOADING)) as pool:
        ended = pool.map(lambda module: stopped_after(module, LOADING[module], tmp_path), LOADING)
    for module, (status, printed) in zip(LOADING, ended, strict=True):
        assert status == 130, f"{module}: {printed}"
        assert printed in ("", "suisou: stopped; nothing was written\n"), module
    assert list(tmp_path.iterdir()) == []


def test_the_editor(tmp_path: Path) -> None:
    places = {name: str(tmp_path) for name in ("HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME")}
    environment = {**os.environ, **places, "QT_QPA_PLATFORM": "offscreen"}
    # A copy, so that the example is not added to the recent files.
    command = [sys.executable, "-m", "app", "edit", shutil.copy(QUARTET, tmp_path)]
    with subprocess.Popen(command, cwd=ROOT, env=environment, stderr=subprocess.PIPE, text=True) as process:
        settings = tmp_path / "suisou" / "editor.toml"
        deadline_s = time.monotonic() + 300.0
        while not settings.is_file() and time.monotonic() < deadline_s:
            time.sleep(0.05)  # it is written when the piece is open
        process.send_signal(signal.SIGINT)
        printed = process.communicate(timeout=900)[1]
    assert settings.is_file()
    assert process.returncode == 130
    assert "Traceback" not in printed
    assert "Error" not in printed
