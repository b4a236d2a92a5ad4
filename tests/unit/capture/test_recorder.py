"""The recorder with a fake MIDI system, without transport and processes."""

from __future__ import annotations

import errno
import io
import os
from io import FileIO
from pathlib import Path
from queue import SimpleQueue
from typing import Any, ClassVar

import pytest

from app.capture import recorder as recording
from app.capture.journal import JournalHeader, read_journal
from app.capture.journal_keeper import JournalKeeper
from app.capture.port_names import Port
from app.capture.ports import PortError
from app.capture.protocol import (
    Back,
    Events,
    Lost,
    Moved,
    News,
    Open,
    Opened,
    Opening,
    Ports,
    RecordingFinished,
    RequestRefused,
    StartRecording,
    Stop,
    SystemEnded,
)
from app.capture.recorder import RecorderProcess, send_news
from app.child import MessageChannel


class Device:
    """An open port."""

    def __init__(self) -> None:
        self.is_closed = False

    def close(self) -> None:
        self.is_closed = True


class System:
    """A system with devices that the test connects and disconnects."""

    def __init__(self, *names: str) -> None:
        self.name = "alsa"
        self.is_closed = False
        self.has_ended = False
        self.listed = {name: f"{name} 20:0" for name in names}
        self.listed_outputs: tuple[str, ...] = ()
        self.busy: set[str] = set()
        self.opened: list[Device] = []
        self.callback: Any = None

    def inputs(self) -> tuple[Port, ...]:
        return tuple(Port(name, identity, index) for index, (name, identity) in enumerate(self.listed.items()))

    def outputs(self) -> tuple[Port, ...]:
        return tuple(Port(name, name, index) for index, name in enumerate(self.listed_outputs))

    def open_input(self, port: Port, callback: Any) -> Device:
        if port.name in self.busy:
            raise PortError("capture.port_refused", port=port.name, detail="in use")
        self.callback = callback
        self.opened.append(Device())
        return self.opened[-1]

    def close(self) -> None:
        self.is_closed = True


class Bench:
    """A recorder with its queues."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, system: System | None) -> None:
        self.systems: list[System | None] = [system]

        def made(requested: str) -> System:
            found = self.systems[-1]
            if found is None:
                raise PortError("capture.no_system")
            return found

        monkeypatch.setattr(recording, "MidiSystem", made)
        self.news: SimpleQueue[Any] = SimpleQueue()
        self.journal: SimpleQueue[Any] = SimpleQueue()
        self.recorder = RecorderProcess(self.news, self.journal)

    def reported(self) -> list[News]:
        found = []
        while not self.news.empty():
            found.append(self.news.get())
        return [news for news in found if not isinstance(news, Opening)]

    def kinds(self) -> list[type]:
        return [type(reported) for reported in self.reported()]

    def marks(self) -> list[str]:
        found = []
        while not self.journal.empty():
            found.append(self.journal.get()[0])
        return found


def test_devices_are_reported_when_they_change(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System("EWI")
    bench = Bench(monkeypatch, system)
    for _ in range(3):
        bench.recorder.look()
    assert bench.reported() == [Ports(("EWI",), (), "alsa")]
    system.listed["Piano"] = "Piano 24:0"
    bench.recorder.look()
    assert bench.reported() == [Ports(("EWI", "Piano"), (), "alsa")]


def test_a_lost_port_is_opened_again_when_it_comes_back(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System("EWI")
    bench = Bench(monkeypatch, system)
    bench.recorder.obey(Open("EWI"))
    assert bench.kinds() == [Ports, Opened]
    identity = system.listed.pop("EWI")
    bench.recorder.look()
    assert bench.kinds() == [Lost, Ports]
    assert system.opened[0].is_closed
    bench.recorder.look()
    assert bench.kinds() == []
    system.listed["EWI"] = identity
    bench.recorder.look()
    assert bench.kinds() == [Ports, Back]
    assert bench.marks() == ["back", "lost", "back"]


def test_one_that_came_back_unseen_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System("EWI")
    bench = Bench(monkeypatch, system)
    bench.recorder.obey(Open("EWI"))
    bench.reported()
    system.listed["EWI"] = "EWI 24:0"
    bench.recorder.look()
    assert bench.kinds() == [Lost, Back]


def test_a_port_in_use_elsewhere_is_reported_once_and_opened_when_it_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System("EWI")
    system.busy.add("EWI")
    bench = Bench(monkeypatch, system)
    bench.recorder.obey(Open("EWI"))
    for _ in range(3):
        bench.recorder.look()
    (refused,) = [reported for reported in bench.reported() if isinstance(reported, RequestRefused)]
    assert refused.reason.id == "capture.port_refused"
    system.busy.clear()
    bench.recorder.look()
    assert bench.kinds() == [Opened]


def test_a_port_that_is_not_there_yet_is_reported_once_and_opened_when_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System()
    bench = Bench(monkeypatch, system)
    bench.recorder.obey(Open("EWI"))
    bench.recorder.look()
    assert [reported.reason.id for reported in bench.reported() if isinstance(reported, RequestRefused)] == [
        "capture.port_not_here"
    ]
    system.listed["EWI"] = "EWI 20:0"
    bench.recorder.look()
    assert bench.kinds() == [Ports, Opened]


def test_a_system_that_comes_later_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = [100.0]
    bench = Bench(monkeypatch, None)
    monkeypatch.setattr("app.capture.recorder.time.perf_counter", lambda: now_s[0])
    for _ in range(4):
        bench.recorder.look()
        now_s[0] += 0.5
    assert [type(reported) for reported in bench.reported()] == [Ports, RequestRefused]
    bench.systems.append(System("EWI"))
    now_s[0] += 2.0
    bench.recorder.look()
    assert bench.reported() == [Ports(("EWI",), (), "alsa")]


def test_a_jack_server_without_ports_is_asked_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = [100.0]
    dead = System()
    dead.name = "jack"
    bench = Bench(monkeypatch, dead)
    monkeypatch.setattr("app.capture.recorder.time.perf_counter", lambda: now_s[0])
    bench.recorder.look()
    bench.systems.append(System("EWI"))
    now_s[0] += 2.0
    bench.recorder.look()
    assert dead.is_closed
    assert bench.reported()[-1] == Ports(("EWI",), (), "alsa")


def test_a_system_that_goes_away_is_left_to_another_recorder(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System("EWI")
    bench = Bench(monkeypatch, system)
    bench.recorder.obey(Open("EWI"))
    assert bench.kinds() == [Ports, Opened]
    system.has_ended = True
    bench.recorder.look()
    assert bench.kinds() == [Lost, SystemEnded]
    assert bench.marks() == ["back", "lost"]
    assert bench.recorder.has_ended
    again = Bench(monkeypatch, System("EWI"))
    again.recorder.obey(Open("EWI", is_lost=True))
    assert again.kinds() == [Ports, Back]


def test_received_messages_go_to_the_disk_and_to_the_editor(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System("EWI")
    bench = Bench(monkeypatch, system)
    bench.recorder.obey(Open("EWI"))
    bench.reported()
    bench.marks()
    system.callback(17, bytes([0x90, 60, 80]))
    assert bench.journal.get() == bench.news.get() == (17, bytes([0x90, 60, 80]))


def test_events_that_gathered_are_sent_together_and_in_order() -> None:
    queue: SimpleQueue[Any] = SimpleQueue()
    for item in ((1, b"\x90\x3c\x40"), (2, b"\xf8"), (3, b"\x80\x3c\x40"), Lost("EWI", 4), (5, b"\xb0\x02\x01"), None):
        queue.put(item)
    stream = io.BytesIO()
    channel: MessageChannel[Any] = MessageChannel(News, stream, stream)
    send_news(queue, channel)
    stream.seek(0)
    found = [channel.receive() for _ in range(3)]
    assert not stream.read()
    assert found == [
        Events((1, 3), (b"\x90\x3c\x40", b"\x80\x3c\x40")),
        Lost("EWI", 4),
        Events((5,), (b"\xb0\x02\x01",)),
    ]


class SmallDisk(FileIO):
    """Files on a disk of limited size, in folders with a given name."""

    room: ClassVar[int] = 0

    def write(self, data: Any, /) -> int:
        if Path(str(self.name)).parent.name == "small":
            part = bytes(data)[: SmallDisk.room]
            if not part:
                raise OSError(errno.ENOSPC, "No space left on device")
            SmallDisk.room -= len(part)
            data = part
        return super().write(data)


@pytest.mark.parametrize("room", [0, 1, 50, 130, 200, 100_000])
def test_a_recording_goes_on_in_a_second_place_whole(
    room: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.capture.journal.FileIO", SmallDisk)
    SmallDisk.room = room
    (tmp_path / "small").mkdir()
    journal, second = tmp_path / "small" / "take", tmp_path / "take"
    played = [(number, bytes((0x90, 60 + number, 80))) for number in range(1, 9)]
    queue: SimpleQueue[Any] = SimpleQueue()
    news: SimpleQueue[Any] = SimpleQueue()
    header = JournalHeader("", "", "EWI", "ewi_usb", 0.0, "")
    for item in (StartRecording(os.fsencode(journal), header, elsewhere=os.fsencode(second)), *played, Stop(), None):
        queue.put(item)
    JournalKeeper(queue, news).run()
    sent = [news.get_nowait() for _ in range(news.qsize())]
    moved = [one for one in sent if isinstance(one, Moved)]
    place = second if moved else journal
    assert bool(moved) == (room < 100_000)
    assert not any(isinstance(one, RequestRefused) for one in sent)
    assert sent[-1] == RecordingFinished(os.fsencode(place), len(played))
    found = read_journal(place)
    assert found.complete
    assert list(zip(found.times_ns, found.messages, strict=True)) == played
    assert not (journal if moved else second).exists()


def test_a_disk_that_stays_full_is_reported_once_and_again_at_the_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    queue: SimpleQueue[Any] = SimpleQueue()
    news: SimpleQueue[Any] = SimpleQueue()
    journal = tmp_path / "take"

    def full(file: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("app.capture.journal.os.fsync", full)
    for item in (
        StartRecording(str(journal), JournalHeader("", "", "EWI", "ewi_usb", 0.0, "")),
        (1, b"\x90\x3c\x50"),
        Stop(),
        None,
    ):
        queue.put(item)
    JournalKeeper(queue, news).run()
    sent = [news.get_nowait() for _ in range(news.qsize())]
    assert [one.reason.id for one in sent if isinstance(one, RequestRefused)] == [
        "capture.not_written",
        "capture.cut_short",
    ]
    assert sent[-1] == RecordingFinished(os.fsencode(journal), 1)
