"""Work for the costliest files is done in the background: the window's thread is never busy for long."""

from __future__ import annotations

import pytest

from tests.bench.hostile.__main__ import WINDOW
from tests.fuzz.harness.campaign import Child
from tests.fuzz.harness.costly_midi import COSTLY

MOST_S = 0.5
FILES = {"tracks of sixteen channels": 620, "lines of 40": 6_000}
"""Sizes in bytes of files that cause many rows in the dialog, and many players with few notes."""


def test_the_costliest_files_do_not_stall_the_window(monkeypatch: pytest.MonkeyPatch) -> None:
    """Imported with and without the dialog, edited, saved and read again; only processor time of the window's thread
    counts.
    """
    monkeypatch.setenv("SUISOU_LOOK_S", "0.1")
    stalls_s = {}
    with Child(("midi",), WINDOW) as window:
        for name, size in FILES.items():
            result = window.run("midi", COSTLY[name](size))
            assert result.outcome == "accepted", (name, result)
            stalls_s[name] = result.cpu_s
    assert {name: stall_s for name, stall_s in stalls_s.items() if stall_s > MOST_S} == {}, stalls_s
