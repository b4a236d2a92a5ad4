"""Players' sound rendered in the background: cancelled, restarted, and larger than memory."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QObject
from pytestqt.qtbot import QtBot

from app.audio.track import RATE_HZ, Mix
from app.editor import stems as module
from app.editor.stems import Stems
from app.errors import AppError, Cancelled, Message
from app.project.model import Project
from tests.support.tasks import ImmediateTasks
from tests.unit.audio.pieces import melody, piece


class HeldTasks:
    """Task runner that holds work until the test continues it, and can cancel it in between."""

    def __init__(self) -> None:
        self.held: list[tuple[Callable[..., Any], Callable[..., None]]] = []

    @property
    def writing(self) -> tuple[Message, ...]:
        return ()

    def run(
        self,
        name: Message,
        work: Callable[..., Any],
        done: Callable[..., None],
        failed: Callable[[AppError], None] | None = None,
        key: str | None = None,
        ended: Callable[[], None] | None = None,
        *,
        writes: bool = False,
    ) -> None:
        self.held.append((work, done))

    def go(self, stop_after: int = 10**9) -> None:
        work, done = self.held.pop(0)
        asked = iter(range(10**9))
        try:
            result = work(lambda share: None, lambda: next(asked) >= stop_after)
        except Cancelled:
            return
        done(result)


@pytest.fixture
def owner(qapp: object) -> Iterator[QObject]:
    result = QObject()
    yield result
    result.deleteLater()


# Four minutes in which no phrase comes twice: equal ones would be rendered once.
PITCHES = np.random.default_rng(1).integers(55, 80, 480).tolist()
LONG = piece(melody(*((480 * i, 480, pitch) for i, pitch in enumerate(PITCHES))))


def loud(stems: Stems, project: Project, at_s: float) -> bool:
    block = Mix(stems.tracks(project)).read(round(at_s * RATE_HZ), RATE_HZ // 4)
    return bool(np.abs(block).max() > 0.01)


def settle(stems: Stems, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: not stems._settle_timer.isActive())


def test_what_sounds_next_is_rendered_first(owner: QObject, qtbot: QtBot) -> None:
    tasks = HeldTasks()
    stems = Stems(tasks, owner)
    stems.follow(LONG, 100.0)
    settle(stems, qtbot)
    tasks.go(stop_after=4)
    stems._look()
    assert loud(stems, LONG, 101.0)
    assert not loud(stems, LONG, 1.0)
    assert 0.0 < stems.ready < 0.2
    assert not stems.is_busy, "work that was cancelled is not waited for"


def test_work_for_an_older_project_is_not_taken(owner: QObject, qtbot: QtBot) -> None:
    tasks = HeldTasks()
    stems = Stems(tasks, owner)
    stems.follow(LONG, 0.0)
    settle(stems, qtbot)
    other = piece(melody((0, 960, 72)))
    stems.follow(other, 0.0)
    settle(stems, qtbot)
    assert len(tasks.held) == 2
    tasks.held.reverse()
    tasks.go()
    tasks.go()
    stems._look()
    assert stems.ready == 1.0
    assert loud(stems, other, 0.1)
    assert len(Mix(stems.tracks(other)).tracks[0].pieces) == 1


def test_asking_twice_is_asking_once(owner: QObject, qtbot: QtBot) -> None:
    tasks = HeldTasks()
    stems = Stems(tasks, owner)
    stems.follow(LONG, 0.0)
    settle(stems, qtbot)
    stems.follow(LONG, 5.0)
    assert not stems._settle_timer.isActive()
    tasks.go()
    stems.follow(LONG, 5.0)
    assert not stems._settle_timer.isActive()


def test_memory_is_bounded_and_the_window_moves_along(
    owner: QObject, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "_MOST_BYTES", 80 * RATE_HZ * 2)
    monkeypatch.setattr("app.audio.synth._MOST_CACHED_BYTES", 0)
    stems = Stems(ImmediateTasks(), owner)
    stems.follow(LONG, 0.0)
    settle(stems, qtbot)
    assert loud(stems, LONG, 1.0)
    assert loud(stems, LONG, 40.0)
    assert not loud(stems, LONG, 150.0)
    assert stems.ready == 1.0
    assert stems.covers(10.0)
    assert not stems.covers(45.0)
    stems.follow(LONG, 45.0)
    settle(stems, qtbot)
    assert loud(stems, LONG, 80.0)
    assert not loud(stems, LONG, 1.0)
    assert stems._synthesiser._bytes <= 80 * RATE_HZ * 2
    stems.follow(LONG, 0.0)
    settle(stems, qtbot)
    assert loud(stems, LONG, 1.0)
