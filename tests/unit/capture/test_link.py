"""The recorder process with real MIDI transport (JACK's dummy server): devices connected and disconnected, processes
killed.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest

from app.capture.journal import Journal, JournalHeader, read_journal
from app.capture.link import RecorderLink
from app.capture.loop_passes import passes
from app.capture.protocol import (
    Back,
    EventsSaved,
    Lost,
    NotStarted,
    Opened,
    Ports,
    RecordingFinished,
    RequestRefused,
    Restarted,
)
from app.formats.locks import is_locked
from tests.support.jack import PATIENT_FRAMES, RATE_HZ, Server, jack_server
from tests.support.listening import PATIENCE_S, Ear, assert_mostly_in_order
from tests.support.wind_player import WindPlayer, burst, phrase

ROOT = Path(__file__).parents[3]
HEADER = JournalHeader("p", "player", "EWI", "ewi_usb", 0.0, "")
PHRASE = phrase([60, 62, 64], beat_s=0.2, ghosts=1)


@pytest.fixture(scope="module", autouse=True)
def server() -> Iterator[Server]:
    with jack_server("suisou-link") as server:
        yield server


@pytest.fixture
def ear() -> Iterator[Ear]:
    with RecorderLink() as link:
        yield Ear(link)


def opened(ear: Ear, name: str) -> Ear:
    ear.wait(Ports, lambda reported: name in reported.inputs)
    ear.link.open(name)
    ear.wait(Opened)
    return ear


def started(ear: Ear, path: Path) -> Ear:
    ear.link.start(path, HEADER)
    ear.link.sync(time.perf_counter_ns(), 0.0)
    ear.wait(EventsSaved)
    return ear


def receive_one(ear: Ear, player: WindPlayer, message: bytes) -> int:
    """Play a message until one arrives, since JACK may lose some on a busy machine; return the number of
    arrived ones.
    """
    before = len(ear.messages)
    end_s = time.monotonic() + PATIENCE_S
    while len(ear.messages) == before and time.monotonic() < end_s:
        player.send(message)
        # None is on its way when the next is sent.
        time.sleep(10 * PATIENT_FRAMES / RATE_HZ)
        ear.look()
    assert len(ear.messages) > before
    return len(ear.messages)


def finished(ear: Ear, path: Path) -> Journal:
    ear.link.stop()
    reported = ear.wait(RecordingFinished)
    assert reported.path == os.fsencode(path)
    journal = read_journal(path)
    assert journal.complete
    assert reported.count == len(journal.messages)
    return journal


def test_devices_come_and_go(ear: Ear) -> None:
    with WindPlayer() as player:
        reported = ear.wait(Ports, lambda reported: player.name in reported.inputs)
        assert reported.system == "jack"
        place = len(ear.reported)
    ear.wait(Ports, lambda reported: player.name not in reported.inputs, after=place)


def test_what_is_played_arrives_in_order_and_stamped(ear: Ear, tmp_path: Path) -> None:
    path = tmp_path / "take"
    with WindPlayer() as player:
        started(opened(ear, player.name), path)
        sent = player.play(PHRASE)
        ear.wait_for_most(len(sent))
        journal = finished(ear, path)
        ear.look()
    assert list(zip(journal.times_ns, journal.messages, strict=True)) == ear.messages
    assert_mostly_in_order(journal.messages, [message for _, message in sent])
    assert sent[0][0] < journal.times_ns[0]
    assert journal.times_ns[-1] < sent[-1][0] + PATIENCE_S * 1e9
    assert all(before <= after for before, after in pairwise(journal.times_ns))
    assert not is_locked(path)
    (taken,) = passes(journal)
    assert 0 < taken.times_us[0] < taken.times_us[-1]


def test_a_waiting_reader_is_notified(tmp_path: Path) -> None:
    called = threading.Event()
    with RecorderLink(called.set) as link:
        assert called.wait(PATIENCE_S)
        called.clear()
        assert link.poll()
        with WindPlayer():
            assert called.wait(PATIENCE_S)
            assert link.poll()


def test_unplugged_in_the_middle_and_plugged_in_again(ear: Ear, tmp_path: Path) -> None:
    path = tmp_path / "take"
    with WindPlayer() as player:
        started(opened(ear, player.name), path)
        sent = [message for _, message in player.play(PHRASE)]
        ear.wait_for_most(len(sent))
        player.unplug()
        lost = ear.wait(Lost)
        before = len(ear.messages)
        player.plug_in()
        back = ear.wait(Back)
        player.play(PHRASE)
        ear.wait_for_most(before + len(sent))
        journal = finished(ear, path)
        ear.look()
    assert (lost.port, back.port) == (player.name, player.name)
    assert list(zip(journal.times_ns, journal.messages, strict=True)) == ear.messages
    assert_mostly_in_order(journal.messages[:before], sent)
    assert_mostly_in_order(journal.messages[before:], sent)
    assert journal.gaps == ((lost.ns, back.ns),)
    assert not ear.of(RequestRefused)


def test_another_port_is_opened_while_the_first_is_blown(ear: Ear) -> None:
    with WindPlayer("First") as first, WindPlayer("Second") as second:
        opened(ear, first.name)
        first.start(burst(3.0))
        ear.wait_for_messages(100)
        place = len(ear.reported)
        ear.link.open(second.name)
        assert ear.wait(Opened, after=place).port == second.name
        before = len(ear.messages)
        second.send(b"\x90\x3c\x40")
        assert [message for _, message in ear.wait_for_messages(before + 1)[before:]] == [b"\x90\x3c\x40"]
        ear.link.open(None)
        assert ear.link.port is None
        assert not ear.of(Restarted)


def test_a_take_goes_on_when_another_port_is_opened(ear: Ear, tmp_path: Path) -> None:
    path = tmp_path / "take"
    with WindPlayer("First") as first, WindPlayer("Second") as second:
        started(opened(ear, first.name), path)
        before = receive_one(ear, first, b"\x90\x3c\x40")
        place = len(ear.reported)
        ear.link.open(second.name)
        for number in range(5):
            # Reported while one recorder takes over from the other.
            ear.link.sync(time.perf_counter_ns(), float(number))
        ear.wait(Opened, after=place)
        receive_one(ear, second, b"\x80\x3c\x40")
        journal = finished(ear, path)
    assert list(zip(journal.times_ns, journal.messages, strict=True)) == ear.messages
    assert set(journal.messages[:before]) == {b"\x90\x3c\x40"}
    assert set(journal.messages[before:]) == {b"\x80\x3c\x40"}
    assert len(journal.syncs) == 6
    ((_, back_ns),) = journal.gaps
    assert back_ns is not None


def test_a_killed_recorder_is_started_again_and_goes_on(ear: Ear, tmp_path: Path) -> None:
    path = tmp_path / "take"
    with WindPlayer() as player:
        started(opened(ear, player.name), path)
        sent = [message for _, message in player.play(PHRASE)]
        ear.wait_for_most(len(sent))
        before = len(ear.messages)
        ear.wait(EventsSaved, lambda reported: reported.count >= before)
        before = len(ear.messages)
        place = len(ear.reported)
        child = ear.link._child
        child.process.kill()
        assert ear.wait(Restarted).reason.id == "capture.recorder_ended"
        assert ear.wait(Opened, after=place).port == player.name
        player.play(PHRASE)
        ear.wait_for_most(before + len(sent))
        journal = finished(ear, path)
        ear.look()
    assert list(zip(journal.times_ns, journal.messages, strict=True)) == ear.messages
    assert_mostly_in_order(journal.messages[:before], sent)
    assert_mostly_in_order(journal.messages[before:], sent)
    assert len(journal.gaps) == 1


def test_a_recorder_that_does_not_live_is_given_up(ear: Ear) -> None:
    end_s = time.monotonic() + PATIENCE_S
    while not ear.of(RequestRefused) and time.monotonic() < end_s:
        child = ear.link._child
        if child is not None:
            child.process.kill()
        ear.look()
        time.sleep(0.02)
    (refused,) = ear.of(RequestRefused)
    assert isinstance(refused, RequestRefused)
    assert refused.reason.id == "capture.recorder_fails"


EDITOR = """
import sys, time
from app.capture.journal import JournalHeader
from app.capture.link import RecorderLink
from app.capture.protocol import Events, Opened, Ports, EventsSaved
link = RecorderLink()
name, path = sys.argv[1:]
def wait(kind):
    while not any(isinstance(news, kind) for news in link.poll()):
        time.sleep(0.01)
wait(Ports)
link.open(name)
wait(Opened)
link.start(path, JournalHeader("p", "player", name, "ewi_usb", 0.0, ""))
link.sync(time.perf_counter_ns(), 0.0)
wait(EventsSaved)
print(link._child.process.pid, flush=True)
while True:
    for news in link.poll():
        if isinstance(news, Events):
            for message in news.messages:
                print(message.hex(), flush=True)
    time.sleep(0.01)
"""


def test_a_killed_editor_loses_nothing(tmp_path: Path) -> None:
    path = tmp_path / "take"
    with WindPlayer() as player:
        editor = subprocess.Popen(
            [sys.executable, "-c", EDITOR, player.name, str(path)],
            cwd=ROOT,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stdout=subprocess.PIPE,
            text=True,
        )
        assert editor.stdout.readline()
        sent = [message for _, message in player.play(PHRASE)]
        # Sound on its way is not heard yet.
        time.sleep(4 * PATIENT_FRAMES / RATE_HZ)
        editor.kill()
        # A line may be torn off.
        received = [line.strip() for line in editor.communicate()[0].splitlines(keepends=True) if line.endswith("\n")]
        end_s = time.monotonic() + PATIENCE_S
        while is_locked(path) and time.monotonic() < end_s:
            time.sleep(0.02)
    journal = read_journal(path)
    assert journal.complete
    kept = [message.hex() for message in journal.messages]
    assert kept[: len(received)] == received
    assert_mostly_in_order(journal.messages, sent)


def test_a_journal_that_is_there_is_not_written_over(ear: Ear, tmp_path: Path) -> None:
    path = tmp_path / "take"
    path.write_text("precious")
    ear.link.start(path, HEADER)
    assert ear.wait(NotStarted).reason.id == "journal.exists"
    assert path.read_text() == "precious"
    ear.link.start(tmp_path / "nowhere" / "take", HEADER)
    assert ear.wait(NotStarted, lambda reported: reported.reason.id == "file.cannot_write")


def test_a_take_that_waits_for_its_device(ear: Ear, tmp_path: Path) -> None:
    path = tmp_path / "take"
    ear.wait(Ports)
    ear.link.open("EWI:EWI USB")
    assert ear.wait(RequestRefused).reason.id == "capture.port_not_here"
    started(ear, path)
    with WindPlayer() as player:
        ear.wait(Opened)
        receive_one(ear, player, b"\x90\x3c\x40")
        journal = finished(ear, path)
    assert set(journal.messages) == {b"\x90\x3c\x40"}
    ((_, back_ns),) = journal.gaps
    assert back_ns is not None


def test_without_a_server_it_says_so_once_and_prints_nothing(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("JACK_DEFAULT_SERVER", "suisou-none")
    with RecorderLink(system="jack") as link:
        ear = Ear(link)
        assert ear.wait(RequestRefused).reason.id == "capture.no_system"
        time.sleep(2.5)
        ear.look()
        assert len(ear.of(RequestRefused)) == 1
        assert ear.of(Ports) == [Ports((), (), "")]
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("by", [signal.SIGTERM, signal.SIGKILL])
def test_a_server_that_ends_in_the_middle(by: signal.Signals, tmp_path: Path, server: Server) -> None:
    path, name = tmp_path / "take", os.environ["JACK_DEFAULT_SERVER"]
    with RecorderLink() as link:
        ear = Ear(link)
        with WindPlayer() as player:
            started(opened(ear, player.name), path)
            player.start(burst(0.05))
            ear.wait_for_most(50)
            before = len(ear.messages)
            server.stop(by)
            ear.wait(Lost)
            assert ear.wait(RequestRefused).reason.id == "capture.no_system"
        # Others of this module use it afterwards.
        assert server.start() == name
        with WindPlayer() as player:
            ear.wait(Back)
            player.start(burst(0.05))
            ear.wait_for_most(before + 50)
            journal = finished(ear, path)
            ear.look()
    assert list(zip(journal.times_ns, journal.messages, strict=True)) == ear.messages
    numbers = [message[1] for message in journal.messages]
    assert numbers[:before] == sorted(numbers[:before])
    assert numbers[before:] == sorted(numbers[before:])
    ((lost_ns, back_ns),) = journal.gaps
    assert back_ns is not None
    assert 0 < before < len(numbers)
    assert journal.times_ns[before - 1] < lost_ns < back_ns < journal.times_ns[before]
    assert not ear.of(Restarted)


@pytest.mark.skipif(sys.platform != "linux", reason="Linux")
def test_the_recorder_has_precedence_where_the_system_permits_it(ear: Ear) -> None:
    permitted = subprocess.run(
        [sys.executable, "-c", "import os; os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))"],
        stderr=subprocess.DEVNULL,
        check=False,
    )
    with WindPlayer() as player:
        opened(ear, player.name)
        child = ear.link._child
        assert child is not None

        def ordinary() -> list[bool]:
            tasks = [int(path.name) for path in Path(f"/proc/{child.process.pid}/task").iterdir()]
            return [os.sched_getscheduler(task) == os.SCHED_OTHER for task in tasks]

        end_s = time.monotonic() + 10.0
        while set(ordinary()) != {permitted.returncode != 0} and time.monotonic() < end_s:
            time.sleep(0.05)
        assert len(ordinary()) > 5
        assert set(ordinary()) == {permitted.returncode != 0}


def test_a_recorder_in_which_something_fails_is_started_again(capfd: pytest.CaptureFixture[str]) -> None:
    with RecorderLink() as link:
        ear = Ear(link)
        ear.wait(Ports)
        child = link._child
        child.outgoing.write(b"\x01\x00\x00\x00\xc1")
        child.outgoing.flush()
        ear.wait(Restarted)
        assert child.process.poll() == 1
    assert "DecodeError" in capfd.readouterr().err


def test_where_no_process_can_be_started(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("sys.executable", "/nowhere/python")
    with RecorderLink() as link:
        ear = Ear(link)
        assert ear.wait(RequestRefused).reason.id == "capture.recorder_fails"
        link.start(tmp_path / "take", HEADER)
        assert ear.wait(NotStarted).reason.id == "capture.recorder_fails"


def test_a_journal_that_is_there_is_not_gone_on_with(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Recording is started at a moment without a recorder."""
    path = tmp_path / "take"
    path.write_text("precious")
    with RecorderLink() as link:
        ear = Ear(link)
        ear.wait(Ports)
        report = link._report
        monkeypatch.setattr(link, "_report", lambda command: False)
        link.start(path, HEADER)
        monkeypatch.setattr(link, "_report", report)
        child = link._child
        child.process.kill()
        assert ear.wait(NotStarted).reason.id == "journal.exists"
    assert path.read_text() == "precious"


def test_a_recorder_that_a_driver_holds_up_does_not_hold_up_the_editor(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("app.capture.link._END_WITHIN_S", 0.5)
    with RecorderLink() as link:
        Ear(link).wait(Ports)
        child = link._child
        child.process.send_signal(signal.SIGSTOP)
    assert child.process.poll() == -signal.SIGKILL
