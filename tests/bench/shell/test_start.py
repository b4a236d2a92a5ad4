"""Time until the window is shown, compared with importing its libraries alone, each in a separate process."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.bench

ROOT = Path(__file__).parents[3]
RUNS = 3
LIBRARIES = """
import time
start = time.perf_counter()
import numpy, scipy.ndimage, scipy.spatial.transform, scipy.optimize, msgspec, mido, soundfile, pyqtgraph, vispy.scene
import miniaudio
from PySide6 import QtCore, QtGui, QtOpenGLWidgets, QtSvg, QtWidgets
print(time.perf_counter() - start)
"""
WINDOW = """
import sys, time
start = time.perf_counter()
from pathlib import Path
from app.shell.app import Program, make_application
from app.editor.settings import Settings
application = make_application()
program = Program(Settings(Path(sys.argv[1])))
program.window.show()
while not program.window.isVisible():
    application.processEvents()
application.processEvents()
print(time.perf_counter() - start)
program.end()
"""


def seconds(script: str, *arguments: str) -> float:
    """Return the time (s) that a script prints for itself: the shortest of `RUNS` runs."""
    command = [sys.executable, "-c", script, *arguments]
    runs = [subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True) for _ in range(RUNS)]
    return min(float(run.stdout.strip().splitlines()[-1]) for run in runs)


def test_the_window_is_up(tmp_path: Path) -> None:
    libraries = seconds(LIBRARIES)
    window = seconds(WINDOW, str(tmp_path / "editor.toml"))
    ratio = window / libraries
    print(f"window up in {window:.2f} s, its libraries alone {libraries:.2f} s: ratio {ratio:.2f} (goal 2.5)")
