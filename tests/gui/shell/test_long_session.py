"""A long session leaves nothing behind: memory and objects after some rounds equal those before."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication, QLabel

from app.editor.settings import Settings
from app.project.autosave import Autosave
from app.project.running_editors import Presence
from app.shell.app import Program
from tests.gui.conftest import delete_now
from tests.gui.shell.conftest import end
from tests.support.long_session import LongDay, footprint, larger_piece

pytestmark = pytest.mark.drawn

WARM_UP, ROUNDS, MOST_ROUNDS = 2, 2, 8
DRAWN = ("widgets.viewport.renderer._Solid", "vispy.gloo.")
"""Classes with one object per drawn level of detail; speed of drawing determines the levels, and the objects are freed
with the figures.
"""
OF_A_PIECE = ("app.performance.chunks.Chunk", "app.performance.chunks.Pose", "widgets.viewport.cast.Member")
MOST_MB = 48.0
"""Variation in megabytes of the graphics driver's memory between rounds, while Python's memory stays equal within 0.1
MB; only growth that persists in all later rounds is a leak.
"""


@pytest.fixture
def program(qt_app: QApplication, settings: Settings, tmp_path: Path) -> Iterator[Program]:
    """An editor that works in threads, as in use."""
    result = Program(settings, autosave=Autosave(Presence(tmp_path / "recovery")))
    result.window.resize(800, 500)
    result.window.show()
    yield result
    end(result)
    delete_now()


def test_after_some_rounds_everything_is_as_it_was(program: Program, tmp_path: Path) -> None:
    # Tests before this one in the same process may have left some.
    elsewhere = footprint()
    day = LongDay(program, larger_piece(tmp_path, 2, 20))
    for _ in range(WARM_UP):
        day.round()
    before = footprint()
    # No piece is open.
    assert {name: before.values[name] for name in OF_A_PIECE if before.values[name] > elsewhere.values[name]} == {}
    for _ in range(ROUNDS):
        day.round()
    after = footprint()
    assert after.widgets_by_class - before.widgets_by_class == {}
    # Objects about to be drawn or reported may differ by one.
    grown = {
        name: count
        for name, count in (after.values - before.values).items()
        if count >= ROUNDS and not name.startswith(DRAWN)
    }
    assert grown == {}
    for name in ("threads", "files", "processes", "timers", "widgets", "objects"):
        assert getattr(after, name) <= getattr(before, name), (name, str(before), str(after))
    memory_mb = [after.memory_mb]
    while memory_mb[-1] - before.memory_mb >= MOST_MB and len(memory_mb) <= MOST_ROUNDS - ROUNDS:
        day.round()
        memory_mb.append(footprint().memory_mb)
    assert memory_mb[-1] - before.memory_mb < MOST_MB, (str(before), memory_mb)


@pytest.mark.usefixtures("qt_app")
def test_a_leak_would_be_seen() -> None:
    before = footprint()
    left = [QLabel() for _ in range(3)]
    assert (footprint().widgets_by_class - before.widgets_by_class) == {"QLabel": len(left)}
