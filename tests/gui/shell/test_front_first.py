"""In a piece that takes long to plan, the selected players move first in the running editor."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from app.editor import generator as module
from app.editor.generator import Generator
from app.editor.session import Session
from app.editor.tasks import ThreadTasks
from app.errors import Message, Progress, StopRequested, raise_if_stopped
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.plan.by_hand.corrections import SetEmbouchure
from app.project.edit.corrections import with_corrections

pytestmark = pytest.mark.drawn


class SlowPlanning:
    """Planning in which every player waits until the test continues."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self._through = threading.Semaphore(0)
        prepare, through = Performance.prepare, self._through

        def slow(
            performance: Performance,
            stop_requested: StopRequested = lambda: False,
            progress: Progress = lambda share: None,
            first: Callable[[], Sequence[str]] = tuple,
            planned: Callable[[tuple[str, ...]], None] = lambda player_ids: None,
        ) -> None:
            def waiting() -> Sequence[str]:
                while not through.acquire(timeout=0.005):
                    raise_if_stopped(stop_requested)
                return first()

            prepare(performance, stop_requested, progress, waiting, planned)

        monkeypatch.setattr(Performance, "prepare", slow)
        monkeypatch.setattr(module, "AT_ONCE_NOTES", 1)
        monkeypatch.setattr(module, "REPORTED_NOTES", 2)

    def let_through(self, players: int) -> None:
        self._through.release(players)


@pytest.fixture
def planning(session: Session, monkeypatch: pytest.MonkeyPatch) -> SlowPlanning:
    assert session.performance.plans, "they are known, and not waited for"
    return SlowPlanning(monkeypatch)


@pytest.fixture
def generator(session: Session, planning: SlowPlanning) -> Iterator[Generator]:
    tasks = ThreadTasks()
    made = Generator(session, tasks)
    yield made
    made.close()
    tasks.cancel_all(2.0)


def test_who_is_in_front_moves_before_the_others_are_planned(
    session: Session, planning: SlowPlanning, generator: Generator, qtbot: QtBot
) -> None:
    live, ids = generator.live, [player.id for player in session.project.players]
    shares = list[float]()
    generator.ready_changed.connect(shares.append)

    def moving(at_s: float) -> list[str]:
        return [one for one in ids if live.pose(one, at_s) is not None]

    session.set_playhead(6.0)
    session.document.open(replace(session.project, seed=5))
    planning.let_through(1)
    qtbot.waitUntil(lambda: moving(6.0) == [ids[0]] and live.performance.project is session.project)
    qtbot.waitUntil(lambda: bool(shares) and 0.0 < shares[-1] < 0.2)
    assert not generator.up_to_date
    # Playback continues, and another player comes next after being brought to the front.
    session.set_playhead(20.0)
    qtbot.waitUntil(lambda: moving(20.0) == [ids[0]])
    session.set_players((ids[3],))
    planning.let_through(1)
    qtbot.waitUntil(lambda: moving(20.0) == [ids[0], ids[3]])
    assert not generator.up_to_date
    before = live.pose(ids[3], 20.0)
    planning.let_through(10 * len(ids))
    qtbot.waitUntil(lambda: generator.up_to_date)
    after = live.pose(ids[3], 20.0)
    assert before is not None
    assert after is not None
    assert (before.rotations == after.rotations).all()
    assert session.playhead_s == 20.0
    assert session.performance.plans == Performance(session.project).plans
    qtbot.waitUntil(lambda: generator.ready_share == 1.0)


def test_a_player_whose_plan_is_there_moves_as_soon_as_brought_to_the_front(
    session: Session, planning: SlowPlanning, generator: Generator, qtbot: QtBot
) -> None:
    live, ids = generator.live, [player.id for player in session.project.players]
    session.document.open(replace(session.project, seed=5))
    planning.let_through(2)
    qtbot.waitUntil(lambda: live.performance.project is session.project)
    qtbot.waitUntil(lambda: live.pose(ids[0], 0.0) is not None)
    qtbot.waitUntil(lambda: live.performance.is_planned(ids[1]))
    assert live.pose(ids[1], 0.0) is None
    session.set_players((ids[1],))
    qtbot.waitUntil(lambda: live.pose(ids[1], 0.0) is not None)
    assert not generator.up_to_date


def test_another_piece_opened_meanwhile_is_not_mixed_with_it(
    session: Session, planning: SlowPlanning, generator: Generator, qtbot: QtBot
) -> None:
    live, shown = generator.live, list[object]()
    generator.motion_changed.connect(lambda: shown.append(live.performance.project))
    session.document.open(replace(session.project, seed=5))
    dropped = session.project
    planning.let_through(1)
    qtbot.waitUntil(lambda: live.performance.project is dropped)
    session.document.open(replace(session.project, seed=6))
    shown.clear()
    planning.let_through(20)
    qtbot.waitUntil(lambda: generator.up_to_date)
    assert live.performance.project is session.project
    assert session.performance.project is session.project
    qtbot.waitUntil(lambda: generator.ready_share == 1.0)
    assert shown[-1] is session.project


def test_the_editor_may_be_closed_meanwhile(session: Session, planning: SlowPlanning, qtbot: QtBot) -> None:
    tasks = ThreadTasks()
    generator = Generator(session, tasks)
    session.document.open(replace(session.project, seed=5))
    planning.let_through(1)
    front = session.players[0]
    qtbot.waitUntil(lambda: generator.live.performance.project is session.project)
    qtbot.waitUntil(lambda: generator.live.pose(front, 0.0) is not None)
    generator.close()
    tasks.cancel_all(2.0)
    qtbot.waitUntil(lambda: tasks.is_idle)
    assert not generator.up_to_date


def test_everyone_moves_around_the_playhead_before_all_are_planned(
    session: Session, planning: SlowPlanning, generator: Generator, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "is_worth_it", lambda performance: True)
    live, ids = generator.live, [player.id for player in session.project.players]

    def moving(at_s: float) -> list[str]:
        return [one for one in ids if live.pose(one, at_s) is not None]

    session.set_playhead(6.0)
    session.document.open(replace(session.project, seed=5))
    planning.let_through(1)
    qtbot.waitUntil(lambda: moving(6.0) == ids and live.performance.project is session.project)
    assert not generator.up_to_date
    assert not live.is_seen
    # Far from the excerpt only planned players move, and the next selected one.
    session.set_playhead(40.0)
    qtbot.waitUntil(lambda: moving(40.0) == [ids[0]])
    session.set_players((ids[3],))
    planning.let_through(1)
    qtbot.waitUntil(lambda: moving(40.0) == [ids[0], ids[3]])
    session.set_playhead(6.0)
    planning.let_through(10 * len(ids))
    qtbot.waitUntil(lambda: generator.up_to_date)
    assert session.performance.plans == Performance(session.project).plans
    qtbot.waitUntil(lambda: generator.ready_share == 1.0)
    fresh = LiveMotion(session.performance)
    for one in ids:
        shown, anew = live.pose(one, 6.0), fresh.pose_now(one, 6.0)
        assert shown is not None
        assert anew is not None
        # Between two frames; a joint is mixed in a chunk in which it moves at all.
        assert np.allclose(shown.rotations, anew.rotations, rtol=0.0, atol=1e-6)


def test_an_edit_made_while_an_excerpt_is_shown_is_in_the_plans(
    session: Session, planning: SlowPlanning, generator: Generator, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "is_worth_it", lambda performance: True)
    live, ids = generator.live, [player.id for player in session.project.players]
    session.set_playhead(6.0)
    session.document.open(replace(session.project, seed=5))
    planning.let_through(1)
    qtbot.waitUntil(lambda: all(live.pose(one, 6.0) is not None for one in ids))
    note = session.project.part(session.project.players[1]).notes[4]
    pinned = SetEmbouchure(note.id, tension=0.9)
    session.apply(Message("edit.test"), with_corrections(session.project, ids[1], [pinned]))
    planning.let_through(20 * len(ids))
    qtbot.waitUntil(lambda: generator.up_to_date)
    assert session.performance.plans == Performance(session.project).plans
    qtbot.waitUntil(lambda: live.is_seen)
    at_s = session.performance.plan(session.project.player(ids[1])).embouchures[4].start_s + 0.02
    session.set_playhead(at_s)
    qtbot.waitUntil(lambda: live.is_seen)
    shown, anew = live.pose(ids[1], at_s), LiveMotion(session.performance).pose_now(ids[1], at_s)
    assert shown is not None
    assert anew is not None
    assert shown.morphs.items() >= anew.morphs.items()
