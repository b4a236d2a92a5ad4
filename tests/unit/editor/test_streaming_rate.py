"""Times at which frames are sent, with a clock controlled by the test: at the full rate during motion,
seldom at rest.
"""

from __future__ import annotations

import threading
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from app.editor import streamer
from app.editor.streamer import RESTING_S, SETTLED_S, _Anchor, _Request, _Thread

RATE_HZ = 30
LATE_S = 0.002


class Clock:
    """A clock that advances only while the thread waits."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def perf_counter(self) -> float:
        return self.now_s


class Waiting(threading.Condition):
    """Waits by advancing the clock instead of waiting in real time."""

    def __init__(self, clock: Clock) -> None:
        super().__init__()
        self.clock = clock

    def wait(self, timeout: float | None = None) -> bool:
        assert timeout is not None, "nothing would ever be sent"
        # A wait ends late, never early.
        self.clock.now_s += timeout + LATE_S
        return False


class Sending:
    """A thread that is run step by step, and the frames sent."""

    def __init__(self, clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(streamer, "time", clock)
        self.clock = clock
        self.thread = _Thread(cast(Any, SimpleNamespace(is_live=False)), cast(Any, lambda say: None))
        self.thread._changed = Waiting(clock)
        self.sent_s: list[float] = []
        self.places_s: list[float] = []
        self.thread._send = self.send
        self.thread.request(_Request(cast(Any, None), (), (), (), (), cast(Any, None), RATE_HZ, False))
        self.due_s = clock.now_s - LATE_S
        self.busy_s = 0.0

    def send(self, request: _Request, time_s: float, now_s: float) -> bool:
        self.sent_s.append(now_s)
        self.places_s.append(time_s)
        self.clock.now_s += self.busy_s
        return False

    def move(self, position_s: float, speed: float) -> None:
        self.thread.move(_Anchor(position_s, self.clock.now_s, speed, None))

    def go_on(self, until_s: float) -> None:
        while self.clock.now_s < until_s:
            self.due_s = self.thread._step(self.due_s)


@pytest.fixture
def sending(monkeypatch: pytest.MonkeyPatch) -> Sending:
    return Sending(Clock(), monkeypatch)


def test_the_rate_is_kept_while_it_plays(sending: Sending) -> None:
    # A window without a report for a second is considered to hang.
    for until_s in (100.5, 101.0, 101.5, 102.0, 102.5, 103.0):
        sending.move(sending.clock.now_s - 95.0, 1.0)
        sending.go_on(until_s)
    assert len(sending.sent_s) == pytest.approx(3 * RATE_HZ, abs=2)
    assert np.diff(sending.sent_s) == pytest.approx(1.0 / RATE_HZ, abs=1e-4)
    # Each shows the moment at which it is sent.
    assert np.asarray(sending.places_s) == pytest.approx(np.asarray(sending.sent_s) - 95.0, abs=0.001)


def test_at_rest_frames_are_few_but_not_at_once(sending: Sending) -> None:
    sending.move(5.0, 0.0)
    sending.go_on(104.0)
    gaps_s = np.diff(sending.sent_s)
    moving = np.asarray(sending.sent_s[:-1]) < 100.0 + SETTLED_S + 0.001
    assert gaps_s[moving] == pytest.approx(1.0 / RATE_HZ, abs=1e-4)
    assert gaps_s[~moving] == pytest.approx(RESTING_S, abs=1e-4)
    assert set(sending.places_s) == {5.0}


def test_what_is_missed_is_not_made_up_for_and_the_rate_comes_back(sending: Sending) -> None:
    sending.move(5.0, 1.0)
    sending.go_on(100.5)
    sending.busy_s = 0.3
    sending.go_on(100.51 + 0.3)
    sending.busy_s = 0.0
    late = len(sending.sent_s)
    sending.move(5.8, 1.0)
    sending.go_on(101.5)
    gaps_s = np.diff(sending.sent_s)
    assert gaps_s.max() == pytest.approx(0.3, abs=0.05)
    assert gaps_s.min() > 0.9 / RATE_HZ
    assert gaps_s[late + 1 :] == pytest.approx(1.0 / RATE_HZ, abs=1e-4)


def test_a_frame_that_takes_a_while_costs_none_of_the_rate(sending: Sending) -> None:
    sending.busy_s = 0.6 / RATE_HZ
    sending.move(5.0, 1.0)
    sending.go_on(100.9)
    assert np.diff(sending.sent_s) == pytest.approx(1.0 / RATE_HZ, abs=1e-4)
