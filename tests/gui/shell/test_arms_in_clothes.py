"""Arms in clothes are measured while the window is at rest, and are problems like broken contacts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import msgspec
import pytest
from pytestqt.qtbot import QtBot

from app.editor import plan_worker
from app.editor.generator import Generator
from app.editor.session import Session
from app.errors import Message, StopRequested, raise_if_stopped
from app.motion.perform import PerformanceCurves
from app.performance.cast import Performer
from app.performance.live import LiveMotion
from app.plan.by_hand.corrections import PoseCorrection
from app.plan.model import Problem, TimeFrame
from app.project.edit.corrections import with_corrections
from app.rig.people.wardrobe import OutfitChoice
from app.shell.commands.problems import step_problems
from tests.gui.japanese import speaking
from tests.support.live import performance_of
from tests.support.tasks import ImmediateTasks
from widgets.common.text import message_text
from widgets.timeline.lanes.problems import ProblemsLane
from widgets.timeline.zoom_and_scroll import TimeAxis

pytestmark = pytest.mark.drawn

LEAN = PoseCorrection(
    target="torso", name="lean", start_tick=0, end_tick=6720, fade_in_ticks=480, fade_out_ticks=480, up_deg=-45.0
)
"""A lean far forward, in which the right forearm is in the jacket of a uniform while the clarinet is lowered."""


@pytest.fixture
def of_one(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Session, Generator]]:
    """A session with one clarinettist in a marching uniform, who has a long rest."""
    monkeypatch.setattr(plan_worker, "QUIET_S", 0.05)
    project = performance_of("clarinet_Bb", [(0, 400, 62), (480, 400, 62), (6720, 400, 64)]).project
    (player,) = project.players
    dressed = msgspec.structs.replace(player, character_id="cast_grace", outfit=OutfitChoice("marching"))
    session = Session(replace(project, players=(dressed,)), ImmediateTasks())
    generator = Generator(session, session.tasks)
    yield session, generator
    generator.close()


def test_an_arm_in_clothes_is_listed_and_gone_when_it_is_mended(
    of_one: tuple[Session, Generator], qtbot: QtBot
) -> None:
    """A lean by hand takes a forearm into the jacket: the lane and F8 show it, and undo removes it."""
    session, _ = of_one
    (player,) = session.project.players
    lane = ProblemsLane(session, TimeAxis())
    qtbot.addWidget(lane)

    def inside() -> list[Problem]:
        return [problem for problem in session.problems(player.id) if problem.message.id == "contact.arm_inside"]

    session.apply(Message("edit.test"), with_corrections(session.project, player.id, [LEAN]))
    qtbot.waitUntil(lambda: len(inside()) == 1, timeout=30_000)
    (found,) = inside()
    assert found in lane.problems
    session.set_playhead(found.start_s - 0.001)
    step_problems(session, 1)
    assert session.playhead_s == pytest.approx(found.start_s)
    assert session.problem == (player.id, found)
    assert "forearm goes up to" in message_text(found.message, session)
    with speaking():
        assert "前腕" in message_text(found.message, session)
    session.document.undo()
    qtbot.waitUntil(lambda: not inside(), timeout=30_000)
    assert found not in lane.problems


def test_arms_wait_for_playback(of_one: tuple[Session, Generator], qtbot: QtBot) -> None:
    session, generator = of_one
    (player,) = session.project.players
    session.set_playing(True)
    session.apply(Message("edit.test"), with_corrections(session.project, player.id, [LEAN]))
    qtbot.waitUntil(lambda: generator.ready_share == 1.0)
    qtbot.wait(300)
    assert not [one for one in session.problems(player.id) if one.message.id == "contact.arm_inside"]
    session.set_playing(False)
    qtbot.waitUntil(lambda: bool(session.problems(player.id)), timeout=30_000)


def test_arms_that_cannot_be_measured_are_not_tried_again(
    of_one: tuple[Session, Generator], qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    session, generator = of_one
    tried, fallen = list[str](), list[BaseException]()

    def failing(performer: Performer, *others: object) -> tuple[Problem, ...]:
        tried.append(performer.player.id)
        raise ValueError("no surface")

    monkeypatch.setattr(generator.live, "_arm_problems", failing)
    monkeypatch.setattr(generator._worker, "_fell", fallen.append)
    qtbot.waitUntil(lambda: bool(fallen))
    qtbot.waitUntil(lambda: not generator._worker._measuring)
    assert tried == [player.id for player in session.project.players]
    assert [str(fault) for fault in fallen] == ["no surface"]


def test_what_is_stopped_is_measured_later(of_one: tuple[Session, Generator], qtbot: QtBot) -> None:
    session, generator = of_one
    generator.close()
    (player,) = session.project.players
    measured = list[float]()

    def measure(
        performer: Performer, curves: PerformanceCurves, frame: TimeFrame, stop_requested: StopRequested
    ) -> tuple[Problem, ...]:
        raise_if_stopped(stop_requested)
        measured.append(frame.end_s)
        return (Problem(Message("contact.arm_inside", {}), None, 1.0, 1.1),)

    live = LiveMotion(session.performance, arm_problems=measure)
    assert not live.measure_arms(lambda: False)
    while live.work():
        pass
    while live.judge():
        pass
    assert live.measure_arms(lambda: True)
    assert not measured
    assert live.measure_arms(lambda: False)
    assert [problem.start_s for problem in live.broken[player.id]] == [1.0]
    assert not live.measure_arms(lambda: False)
    assert len(measured) == 1
