"""Processor time until the figures of a large band can be drawn, by the state of the caches; printed, never
asserted.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from app.formats.cache import CACHE_VARIABLE
from tests.bench.performance.large import PLAYERS

MEASURE = """
import time
from tests.bench.performance.large import calibration_s, large_project
from widgets.viewport.figures import load

unit_s, project = calibration_s(), large_project({players}, 20)
started_s = time.process_time()
loaded = load(project, None, lambda share: None, lambda: False)
taken_s = time.process_time() - started_s
print(f"{{len(loaded.shapes.characters)}} people: {{taken_s:.2f}} s, {{taken_s / unit_s:.0f}} x the calibration loop")
"""


@pytest.mark.bench
def test_figures_of_a_band(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    for state in ("nothing kept", "shapes kept"):
        command = [sys.executable, "-c", MEASURE.format(players=PLAYERS)]
        said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        with capsys.disabled():
            print(f"\n{state}: {said}", end="")
