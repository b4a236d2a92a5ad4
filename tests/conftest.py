"""What holds for every test."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import settings

# Machines are noisy: how long an example took says nothing. Speed is measured in tests/bench, as ratios.
settings.register_profile("suisou", deadline=None)
settings.load_profile("suisou")


def pytest_addoption(parser: pytest.Parser) -> None:
    """How long readers and the window are attacked, and from where."""
    group = parser.getgroup("suisou")
    group.addoption(
        "--fuzz",
        type=float,
        default=0.25,
        metavar="MINUTES",
        help="of tests marked fuzz (default: 0.25)",
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
