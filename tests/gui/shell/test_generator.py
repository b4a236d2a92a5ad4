"""Plans and motion follow the document automatically, and only affected parts are recomputed."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from dataclasses import replace

import msgspec
import pytest
from pytestqt.qtbot import QtBot

from app.editor import generator as module
from app.editor import plan_worker
from app.editor.generator import Generator
from app.editor.plan_worker import PlanWorker
from app.editor.session import Session, Severity
from app.editor.tasks import ThreadTasks
from app.errors import Message
from app.performance import bodies
from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.plan.by_hand.corrections import AddExpression, AddGesture, SetEmbouchure
from app.plan.model import Problem
from app.project.edit import players
from app.project.edit.corrections import with_corrections
from app.rig.characters.character_library import character_named
from app.rig.grip.fitting.grip_files import hold_for
from app.shell.commands.problems import step_problems
from tests.support.bodies import playing as odd_bodies
from widgets.common.text import message_text
from widgets.timeline.lanes.problems import ProblemsLane
from widgets.timeline.zoom_and_scroll import TimeAxis

pytestmark = pytest.mark.drawn

EDIT = Message("edit.test")


@pytest.fixture
def generator(session: Session) -> Iterator[Generator]:
    made = Generator(session, session.tasks)
    yield made
    made.close()


def _correct(session: Session, tension: float) -> None:
    player = session.project.players[0]
    note = session.project.part(player).notes[20]
    session.apply(EDIT, with_corrections(session.project, player.id, [SetEmbouchure(note.id, tension=tension)]))


def test_a_small_edit_is_planned_before_it_returns(session: Session, generator: Generator) -> None:
    player, before = session.project.players[0], session.performance
    _correct(session, 0.9)
    assert generator.up_to_date
    plan = session.performance.plan(player)
    assert plan.embouchures[20].tension == 0.9
    assert plan.fingerings is before.plan(player).fingerings
    other = session.project.players[1]
    assert session.performance.plan(other) is before.plan(other)


def test_memory_is_returned_once_much_was_made(session: Session, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    returned, threads = list[float](), list[threading.Thread]()

    def counting() -> None:
        returned.append(made.ready_share)
        threads.append(threading.current_thread())

    monkeypatch.setattr(plan_worker, "give_back", counting)
    monkeypatch.setattr(plan_worker, "GIVE_BACK_CHUNKS", 10)
    made = Generator(session, session.tasks)
    try:
        qtbot.waitUntil(lambda: bool(returned))
        assert returned == [1.0]
        assert threads[0] is not threading.current_thread()
        _correct(session, 0.9)
        qtbot.waitUntil(lambda: made.ready_share == 1.0 and made._worker._met == made._worker._requests)
        assert returned == [1.0]
    finally:
        made.close()


def test_no_motion_is_made_while_an_edit_is_planned(
    session: Session, generator: Generator, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, meanwhile, prepare = list[float](), list[int](), Performance.prepare_within

    def endless(stop_requested: object) -> bool:
        begun.append(time.monotonic())
        time.sleep(0.001)
        return True

    def watched(performance: Performance, cpu_s: float) -> bool:
        time.sleep(0.05)
        before = len(begun)
        time.sleep(0.1)
        meanwhile.append(len(begun) - before)
        return prepare(performance, cpu_s)

    monkeypatch.setattr(generator.live, "work", endless)
    monkeypatch.setattr(Performance, "prepare_within", watched)
    session.set_playhead(1.0)
    qtbot.waitUntil(lambda: len(begun) > 3)
    _correct(session, 0.9)
    assert meanwhile == [0]
    after = len(begun)
    qtbot.waitUntil(lambda: len(begun) > after)


def test_the_picture_of_the_player_in_front_is_right_before_a_small_edit_returns(
    session: Session, generator: Generator, qtbot: QtBot
) -> None:
    player = session.project.players[0]
    qtbot.waitUntil(lambda: generator.ready_share == 1.0)
    at_s = session.performance.plan(player).embouchures[20].start_s + 0.02
    session.set_playhead(at_s)
    before = generator.live.pose(player.id, at_s)
    seen = list[Pose | None]()
    order = list[str]()
    generator.front_changed.connect(lambda: seen.append(generator.live.pose(player.id, at_s)))
    generator.front_changed.connect(lambda: order.append("picture"))
    session.performance_changed.connect(lambda: order.append("panels"))
    _correct(session, 0.9)
    assert order == ["picture", "panels"]
    fresh = LiveMotion(Performance(session.project)).pose_now(player.id, at_s)
    assert before is not None
    assert fresh is not None
    [made] = seen
    assert made.morphs == {**dict.fromkeys(made.morphs, 0.0), **fresh.morphs}
    assert before.morphs != fresh.morphs


def test_motion_is_made_by_itself_and_again_where_an_edit_touched_it(
    session: Session, generator: Generator, qtbot: QtBot
) -> None:
    player = session.project.players[0]
    qtbot.waitUntil(lambda: generator.ready_share == 1.0)
    at_s = session.performance.plan(player).embouchures[20].start_s + 0.02
    before = generator.live.pose(player.id, at_s)
    other = generator.live.pose(player.id, at_s + 20.0)
    start, end = (round(session.project.score.tempo_map.ticks(at_s + offset)) for offset in (-1.0, 1.0))
    session.apply(EDIT, with_corrections(session.project, player.id, [AddExpression("mine", "strained", start, end)]))
    assert generator.ready_share < 1.0
    qtbot.waitUntil(lambda: generator.ready_share == 1.0)
    after = generator.live.pose(player.id, at_s)
    assert after.morphs != before.morphs
    assert generator.live.pose(player.id, at_s + 20.0).morphs == other.morphs


def test_the_viewport_is_reported_only_of_poses_at_the_playhead(
    session: Session, generator: Generator, qtbot: QtBot
) -> None:
    score = session.project.score
    front, other = session.project.players[:2]
    assert session.players[0] == front.id
    qtbot.waitUntil(lambda: generator.ready_share == 1.0)
    session.set_playhead(4.0)
    qtbot.wait(100)
    reported: list[bool] = []
    generator.motion_changed.connect(lambda: reported.append(generator.live.is_seen))
    for player, at_s, expected in ((front, 30.0, 1), (front, 4.5, 1), (other, 30.0, 1), (other, 4.5, 2)):
        reported.clear()
        start = round(score.tempo_map.ticks(at_s))
        session.apply(
            EDIT, with_corrections(session.project, player.id, [AddExpression("x", "strained", start, start + 480)])
        )
        qtbot.waitUntil(lambda: generator.ready_share == 1.0)
        qtbot.wait(100)
        # One report of new plans, when the selected player is up to date; then one for another player's pose,
        # if the playhead is in the changed part.
        assert len(reported) == expected, (player.name, at_s)


class Clock:
    """Clocks that the test advances."""

    def __init__(self) -> None:
        self.now_s, self.this_thread_s, self.others_s = 100.0, 3.0, 5.0

    def monotonic(self) -> float:
        return self.now_s

    def thread_time(self) -> float:
        return self.this_thread_s

    def process_time(self) -> float:
        return self.this_thread_s + self.others_s

    def sleep(self, seconds: float) -> None:
        self.now_s += seconds


class Work:
    """Motion that takes 20 ms, of which 10 ms are in this thread, while other threads work too."""

    def __init__(self, clock: Clock, others_s: float, is_seen: bool) -> None:
        self.clock, self.others_s, self.is_seen = clock, others_s, is_seen
        self.seen, self.ready_share, self.broken = 0, 0.5, {}

    def work(self, stop_requested: object) -> bool:
        self.clock.now_s += 0.02
        self.clock.this_thread_s += 0.01
        self.clock.others_s += self.others_s
        return True


@pytest.mark.parametrize(
    ("others_s", "is_seen", "rests"), [(0.01, True, True), (0.0001, True, False), (0.01, False, False)]
)
def test_motion_that_no_one_waits_for_gives_way(
    generator: Generator, monkeypatch: pytest.MonkeyPatch, others_s: float, is_seen: bool, rests: bool
) -> None:
    """The worker pauses longer if others used the processor, unless its result is awaited."""
    generator.close()
    clock = Clock()
    live = Work(clock, others_s, is_seen)
    worker = PlanWorker(live, generator._worker._report, generator._worker._says, clock)
    rested: list[float] = []
    monkeypatch.setattr(worker, "_rest", lambda rest_s, requests: rested.append(rest_s))
    for _ in range(3):
        worker._make_motion()
    assert rested == pytest.approx([3 * 0.02] * 3 if rests else [])


def test_what_is_requested_ends_the_rest(generator: Generator) -> None:
    worker = generator._worker
    requests = worker._requests
    thread = threading.Thread(target=worker._rest, args=(60.0, requests))
    thread.start()
    thread.join(0.1)
    assert thread.is_alive()
    worker.wake()
    thread.join(10.0)
    assert not thread.is_alive()
    worker._rest(60.0, requests)


@pytest.mark.parametrize("most", ["AT_ONCE_NOTES", "REPORTED_NOTES", "AT_ONCE_S"])
def test_plans_that_take_longer_come_from_a_thread(
    session: Session, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch, most: str
) -> None:
    if most == "AT_ONCE_S":
        # Few notes, but they turn out to be costly.
        monkeypatch.setattr(module, "AT_ONCE_S", -1.0)
    else:
        monkeypatch.setattr(module, "AT_ONCE_NOTES", 1)
    if most == "REPORTED_NOTES":
        monkeypatch.setattr(module, "REPORTED_NOTES", 2)
    tasks = ThreadTasks()
    generator = Generator(session, tasks)
    try:
        for tension in (0.5, 0.6, 0.7, 0.8):
            _correct(session, tension)
        assert not generator.up_to_date
        qtbot.waitUntil(lambda: generator.up_to_date)
        player = session.project.players[0]
        assert session.performance.plan(player).embouchures[20].tension == 0.8
        fresh = Performance(session.project)
        assert session.performance.plans == fresh.plans
        assert session.performance.problems(player.id) == fresh.problems(player.id)
    finally:
        generator.close()
        tasks.cancel_all(1.0)


def test_what_is_planned_of_a_document_that_was_closed_is_dropped(
    session: Session, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "AT_ONCE_NOTES", 1)
    generator = Generator(session, session.tasks)
    seen: list[object] = []
    session.performance_changed.connect(lambda: seen.append(session.performance.project))
    try:
        _correct(session, 0.5)
        dropped = session.project
        other = replace(session.project, seed=5)
        session.document.open(other)
        qtbot.waitUntil(lambda: generator.up_to_date)
        assert seen == [other]
        assert dropped not in seen
    finally:
        generator.close()


def test_a_player_without_an_instrument_is_a_problem_and_the_others_play(
    session: Session, generator: Generator, qtbot: QtBot
) -> None:
    first, *others = session.project.players
    lost = msgspec.structs.replace(first, instrument_id="serpent")
    session.apply(EDIT, replace(session.project, players=(lost, *others)))
    assert generator.up_to_date
    assert [problem.message.id for problem in session.problems(lost.id)] == ["project.instrument_missing"]
    qtbot.waitUntil(lambda: generator.ready_share == 1.0)
    assert generator.live.pose(first.id, 1.0) is None
    assert generator.live.pose_now(first.id, 1.0) is None
    assert generator.live.pose(others[0].id, 1.0) is not None


def test_an_edit_that_makes_a_piece_too_long_is_refused_and_the_last_performance_stays(
    session: Session, generator: Generator
) -> None:
    reported: list[tuple[Message, Severity]] = []
    session.noticed.connect(lambda message, severity: reported.append((message, severity)))
    before, project, score = session.performance, session.project, session.project.score
    slow = msgspec.structs.replace(
        score.tempo_map,
        changes=tuple(
            msgspec.structs.replace(change, microseconds_per_quarter=1e9) for change in score.tempo_map.changes
        ),
    )
    session.apply(EDIT, replace(session.project, score=msgspec.structs.replace(score, tempo_map=slow)))
    assert [(message.id, severity) for message, severity in reported] == [("project.not_storable", Severity.ERROR)]
    assert session.project is project
    assert session.performance is before
    assert generator.up_to_date


def test_a_broken_contact_is_listed_walked_and_gone_when_it_is_mended(
    session: Session, generator: Generator, qtbot: QtBot
) -> None:
    """An instrument lowered by the user while playing leaves the lips: the lane and F8 show it, and undo removes it."""
    player = session.project.players[0]
    qtbot.waitUntil(lambda: generator.ready_share == 1.0)
    before = session.problems(player.id)
    lane = ProblemsLane(session, TimeAxis())
    qtbot.addWidget(lane)
    notes = session.project.part(player).notes
    gesture = AddGesture("low", "lower_instrument", notes[20].onset_tick, notes[26].onset_tick, 1.0)

    def lips_off() -> list[Problem]:
        return [problem for problem in session.problems(player.id) if problem.message.id == "contact.lips_off"]

    session.apply(EDIT, with_corrections(session.project, player.id, [gesture]))
    qtbot.waitUntil(lambda: len(lips_off()) == 1)
    broken = lips_off()
    assert [problem for problem in session.problems(player.id) if problem not in broken] == list(before)
    assert broken[0] in lane.problems
    assert lane.count.text() == str(len(before) + 1)
    session.set_playhead(broken[0].start_s - 0.001)
    step_problems(session, 1)
    assert session.selection.notes == {broken[0].note_id}
    assert "mouthpiece" in message_text(broken[0].message, session)
    session.document.undo()
    qtbot.waitUntil(lambda: session.problems(player.id) == before)
    assert lane.problems == before


def test_how_a_new_body_holds_an_instrument_is_found_beside_the_window(
    session: Session, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    here, where, go = threading.current_thread(), list[threading.Thread](), threading.Event()
    ours = hold_for

    def slow(character, model, instrument, body, reported=lambda share: None):  # type: ignore[no-untyped-def]
        if character.id != "unmarked":
            return ours(character, model, instrument, body)
        where.append(threading.current_thread())
        while not go.wait(0.01):
            reported(0.5)
        return ours(character_named("woman_adult"), model, instrument, body)

    monkeypatch.setattr(bodies, "hold_for", slow)
    monkeypatch.setattr(bodies, "_HELD", set())
    with odd_bodies():
        tasks = ThreadTasks()
        generator = Generator(session, tasks)
        try:
            first, second = session.project.players[:2]

            def reported() -> list[str]:
                player = session.project.players[0]
                # Without problems of the motion, since the hold belongs to another body.
                return [problem.message.id for problem in session.performance.problems(player.id)]

            session.apply(EDIT, players.change(session.project, [first.id], character_id="unmarked"))
            qtbot.waitUntil(lambda: bool(where))
            assert where[0] is not here
            # The other players continue, and edits meanwhile are displayed; the fitting is not restarted.
            qtbot.waitUntil(lambda: "character.hold_waiting" in reported())
            _correct(session, 0.8)
            qtbot.waitUntil(lambda: generator.live.pose(second.id, 1.0) is not None)
            assert generator.live.pose(first.id, 1.0) is None
            assert session.performance.plan(session.project.players[0]).embouchures[20].tension == 0.8
            assert len(where) == 1
            # Stopped, the next edit asks again.
            tasks.cancel(tasks.running[0])
            qtbot.waitUntil(lambda: not tasks.running)
            assert len(where) == 1
            _correct(session, 0.7)
            qtbot.waitUntil(lambda: len(where) == 2)
            go.set()
            qtbot.waitUntil(lambda: generator.live.pose(first.id, 1.0) is not None)
            assert reported() == []
            assert session.performance.plan(session.project.players[0]).embouchures[20].tension == 0.7
            assert all(thread is not here for thread in where)
        finally:
            go.set()
            generator.close()
            tasks.cancel_all(1.0)
