"""Set-up of every test."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator
from typing import Any, Final

import pytest
from hypothesis import settings
from pytestqt.qtbot import QtBot

import app  # noqa: F401 - before NumPy, which reads on how many threads it works
from app.formats.other_computers import AGREED
from tests.support.touched import Touched, touching

# Machines are noisy: how long an example took says nothing. Speed is measured in tests/bench, as ratios.
# The same examples in every run; `--hypothesis-profile explore` tries new ones.
settings.register_profile("suisou", deadline=None, derandomize=True)
settings.register_profile("explore", deadline=None)
settings.load_profile("suisou")

# Tests neither read nor write the user's own characters, instruments, tables and settings.
_USER: Final = tempfile.TemporaryDirectory(prefix="suisou-user-")
for _variable in ("XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME"):
    os.environ[_variable] = f"{_USER.name}/{_variable.lower()}"
# Nor does the command line speak another language where the user of this machine does.
os.environ["LANGUAGE"] = "en"


PATIENCE_MS: Final = 180_000
"""Milliseconds for which tests wait for Qt, since the machine may be busy with other tests."""


class PatientQtBot(QtBot):
    """Waits longer than pytest-qt's 5 s for what a slow machine does late."""

    def waitUntil(self, callback: Callable[[], bool | None], *, timeout: int = PATIENCE_MS) -> None:  # noqa: N802
        """Wait as pytest-qt does."""
        super().waitUntil(callback, timeout=timeout)

    def waitSignal(self, signal: Any, *, timeout: int = PATIENCE_MS, **options: Any) -> Any:  # noqa: N802
        """Wait as pytest-qt does."""
        return super().waitSignal(signal, timeout=timeout, **options)


@pytest.fixture
def qtbot(qapp: object, request: pytest.FixtureRequest) -> QtBot:
    """pytest-qt's, more patient."""
    return PatientQtBot(request)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare how long readers and the window are attacked, and from where."""
    group = parser.getgroup("suisou")
    group.addoption(
        "--fuzz",
        type=float,
        default=0.1,
        metavar="MINUTES",
        help="of tests marked fuzz (default: 0.1)",
    )
    group.addoption("--fuzz-seed", type=int, default=1, metavar="SEED", help="another seed makes other attacks")


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """The table of what was attacked and what came of it."""
    reports = [report for kind in ("passed", "failed") for report in terminalreporter.stats.get(kind, ())]
    rows = [row for report in reports for name, row in report.user_properties if name == "fuzz"]
    if rows:
        terminalreporter.section("attacks")
        for row in rows:
            terminalreporter.write_line(row)


@pytest.fixture
def touched(monkeypatch: pytest.MonkeyPatch) -> Iterator[Touched]:
    """Files of other computers that are touched; none of them was agreed to."""
    with touching() as record:
        yield record


@pytest.fixture(autouse=True)
def _no_host_agreed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Forget after each test what it agreed to."""
    monkeypatch.setenv(AGREED, "")
