"""Recording loses no messages in bursts, however busy the editor is."""

from __future__ import annotations

import threading
import time
from pathlib import Path

from app.capture.journal import JournalHeader, read_journal
from app.capture.link import RecorderLink
from app.capture.protocol import EventsSaved, Opened, Ports, RecordingFinished
from tests.support.jack import QUICK_FRAMES, jack_server
from tests.support.listening import Ear
from tests.support.wind_player import WindPlayer, burst

BURST_S = 4.0


def test_nothing_is_lost_in_bursts_while_the_editor_is_busy(tmp_path: Path) -> None:
    """1,000 messages a second, while a thread holds Python's lock like a redrawing window."""
    path = tmp_path / "take"
    done = threading.Event()

    def redraw() -> None:
        while not done.is_set():
            sum(range(20_000))

    with (
        jack_server("suisou-burst", QUICK_FRAMES, is_in_step=True),
        WindPlayer("Burst") as player,
        RecorderLink() as link,
    ):
        ear = Ear(link)
        ear.wait(Ports, lambda reported: player.name in reported.inputs)
        link.open(player.name)
        ear.wait(Opened)
        link.start(path, JournalHeader("p", "player", "EWI", "ewi_usb", 0.0, ""))
        link.sync(time.perf_counter_ns(), 0.0)
        ear.wait(EventsSaved)
        window = threading.Thread(target=redraw)
        window.start()
        try:
            player.start(burst(BURST_S))
            sent = player.sent()
            ear.wait_for_messages(len(sent))
        finally:
            done.set()
            window.join()
        link.stop()
        ear.wait(RecordingFinished)
    journal = read_journal(path)
    assert len(sent) == round(BURST_S * 1000)
    assert [message for _, message in ear.messages] == [message for _, message in sent]
    assert journal.messages == tuple(message for _, message in sent)
