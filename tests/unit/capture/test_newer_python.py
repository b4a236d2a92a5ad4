"""Ports, takes and a burst with the library rtmidi2, in an environment of a newer Python installed by `./test`."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from tests.support.jack import require_jack

ROOT = Path(__file__).parents[3]
TESTS = (
    "test_midi_library.py",
    "test_burst.py",
    "test_link.py::test_devices_come_and_go",
    "test_link.py::test_what_is_played_arrives_in_order_and_stamped",
    "test_link.py::test_unplugged_in_the_middle_and_plugged_in_again",
    "test_link.py::test_without_a_server_it_says_so_once_and_prints_nothing",
    "test_link.py::test_a_server_that_ends_in_the_middle[9]",
    "../cli/test_record.py::test_the_devices_are_listed",
    "../cli/test_record.py::test_a_take_is_recorded",
)
LONGEST_S = 600.0


def test_ports_and_takes_by_rtmidi2() -> None:
    require_jack()
    python = os.environ.get("SUISOU_NEWER_PYTHON")
    if not python:
        pytest.skip("./test found no Python 3.12 to 3.14 beside its own")
    library = "from app.capture.midi_library import load_library; print(type(load_library()).__name__)"
    used = subprocess.run([python, "-c", library], cwd=ROOT, capture_output=True, text=True, check=False)
    assert used.stdout.strip() == "Rtmidi2", used.stderr
    options = ("-p", "tests.support.plain", "-p", "no:pytest-qt", "-q", "-rs")
    # Variables of pytest-xdist are not passed to another pytest.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    done = subprocess.run(
        [python, "-m", "pytest", *options, *(f"tests/unit/capture/{name}" for name in TESTS)],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=LONGEST_S,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-6000:]
    assert "skipped" not in done.stdout.splitlines()[-1], done.stdout
