"""Processor time until the figures of a large band can be drawn, by the state of the caches, and until all of them can
be drawn in close-up; printed, never asserted.
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
from tests.bench.performance.large import large_project
from widgets.viewport.figures import load

project, started_s, total = large_project({players}, 20), time.process_time(), 0
for number in range(300_000):
    total += number * number % 7
unit_s = time.process_time() - started_s
started_s = time.process_time()
loaded = load(project, None, lambda share: None, lambda: False)
taken_s = time.process_time() - started_s
people = loaded.shapes.characters.values()
for levels in people:
    levels.complete()
near_s = time.process_time() - started_s
ratio = taken_s / unit_s
print(f"{{len(people)}} people: {{taken_s:.2f}} s, {{ratio:.0f}} x the calibration loop (goal {goal});", end=" ")
print(f"all in close-up: {{near_s:.2f}} s")
"""
GOALS = {"nothing kept": 200, "shapes kept": 150}
"""Processor time relative to the calibration loop."""


@pytest.mark.bench
def test_figures_of_a_band(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    for state, goal in GOALS.items():
        command = [sys.executable, "-c", MEASURE.format(players=PLAYERS, goal=goal)]
        said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        with capsys.disabled():
            print(f"\n{state}: {said}", end="")
