"""A random user of the whole editor, killed at times: no failures, no Qt warnings, and at most five seconds of work are
lost.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from PySide6.QtGui import QGuiApplication

from tests.support.random_user import MOST_LOST_S, lost_work, travel

JOURNEYS, DEEDS, KILLS = 1, 334, 3
"""Number of runs per minute of attacks, and deeds and kills in each; in half an hour 10,000 deeds."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "journey" in metafunc.fixturenames:
        minutes, seed = metafunc.config.getoption("--fuzz"), metafunc.config.getoption("--fuzz-seed")
        count = max(round(JOURNEYS * minutes), 1)
        metafunc.parametrize("journey", range(count * seed, count * (seed + 1)))


@pytest.mark.fuzz
@pytest.mark.usefixtures("qapp")
def test_nothing_done_by_hand_is_lost(
    journey: int, tmp_path: Path, record_property: Any, pytestconfig: pytest.Config
) -> None:
    assert QGuiApplication.platformName() != "offscreen"
    share = min(pytestconfig.getoption("--fuzz"), 1.0)
    deeds, kills = round(DEEDS * share), max(round(KILLS * share), 1)
    found = travel(tmp_path, journey, deeds, kills)
    record_property(
        "fuzz",
        f"{'window':>18}: journey {journey}, {found.deeds} deeds, {found.kills} kills, {len(found.faults)} faults",
    )
    assert not found.faults, "\n\n".join(found.faults)
    assert found.kills == kills


# Data to judge: the log of a killed session and the files after it.


def log(*rows: tuple[float, str]) -> list[dict[str, Any]]:
    """Values of the project by the clock; the first was opened."""
    events: list[dict[str, Any]] = [
        {"event": "project", "clock_s": clock_s, "digest": digest, "opened": place == 0}
        for place, (clock_s, digest) in enumerate(rows)
    ]
    return [*events, {"event": "deed", "clock_s": 60.0, "deeds": [], "path": ""}]


LAST_S = 60.0 - MOST_LOST_S


@pytest.mark.parametrize(
    ("rows", "found", "lost"),
    [
        pytest.param([(0.0, "read")], [], "", id="only opened"),
        pytest.param([(0.0, "read"), (LAST_S + 0.1, "one")], [], "", id="edited in the last seconds"),
        pytest.param([(0.0, "read"), (LAST_S - 0.1, "one")], ["one"], "", id="all is there"),
        pytest.param([(0.0, "read"), (10.0, "one"), (LAST_S + 1, "two")], ["one"], "", id="the last is lost"),
        pytest.param([(0.0, "read"), (10.0, "one"), (LAST_S + 1, "two")], ["two"], "", id="nothing is lost"),
        pytest.param([(0.0, "read"), (LAST_S - 0.1, "one")], ["read"], "1 changes older", id="the file as it was"),
        pytest.param([(0.0, "read"), (9.0, "one"), (20.0, "two")], ["one"], "1 changes older", id="one is lost"),
        pytest.param([(0.0, "read"), (9.0, "one")], ["other"], "nothing of it", id="all is lost"),
        pytest.param([(0.0, "read"), (9.0, "one"), (9.5, "read")], ["read"], "", id="taken back"),
    ],
)
def test_lost_work_is_found(rows: list[tuple[float, str]], found: list[str], lost: str) -> None:
    said = lost_work(log(*rows), found)
    assert bool(said) == bool(lost)
    assert lost in said


def test_work_that_was_given_up_is_not_lost() -> None:
    events = log((0.0, "read"), (9.0, "one"))
    assert lost_work([*events, {"event": "discarded", "clock_s": 61.0}], []) == ""
    opened = {"event": "project", "clock_s": 61.0, "digest": "another", "opened": True}
    assert lost_work([*events, opened], []) == ""
