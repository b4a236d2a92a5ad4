"""Waiting for what a recorder tells."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TypeVar

import pytest

from app.capture.link import RecorderLink
from app.capture.protocol import Events, News

T = TypeVar("T", bound=News)
PATIENCE_S = 30.0
"""The machine may be busy with other tests."""
QUIET_S = 5.0
"""Time after which a message was lost on its way."""


class Ear:
    """Everything a link has reported, in order."""

    def __init__(self, link: RecorderLink) -> None:
        self.link = link
        self.reported: list[News] = []

    def look(self) -> None:
        """Take what has come."""
        self.reported += self.link.poll()

    def wait(self, kind: type[T], where: Callable[[T], bool] = lambda reported: True, *, after: int = 0) -> T:
        """The first of a kind, of all that was reported from place `after` on."""
        end_s = time.monotonic() + PATIENCE_S
        while True:
            self.look()
            for reported in self.reported[after:]:
                if isinstance(reported, kind) and where(reported):
                    return reported
            if time.monotonic() > end_s:
                pytest.fail(f"no {kind.__name__} came; there came {self.reported[after:]}"[:2000])
            time.sleep(0.005)

    def wait_for_messages(self, count: int) -> list[tuple[int, bytes]]:
        """Wait until so many messages have come; all."""
        end_s = time.monotonic() + PATIENCE_S
        while len(self.messages) < count and time.monotonic() < end_s:
            self.look()
            time.sleep(0.005)
        return self.messages

    def wait_for_most(self, count: int) -> None:
        """Wait until so many messages have come, or none has for a while: JACK may have lost some."""
        end_s = time.monotonic() + PATIENCE_S
        quiet_since_s = time.monotonic()
        while len(self.messages) < count and time.monotonic() < end_s and time.monotonic() < quiet_since_s + QUIET_S:
            before = len(self.messages)
            self.look()
            if len(self.messages) != before:
                quiet_since_s = time.monotonic()
            time.sleep(0.005)

    @property
    def messages(self) -> list[tuple[int, bytes]]:
        """All messages that have come."""
        return [
            pair
            for reported in self.reported
            if isinstance(reported, Events)
            for pair in zip(reported.times_ns, reported.messages, strict=True)
        ]

    def of(self, *kinds: type[News]) -> list[News]:
        """Return the reports of some kinds."""
        return [reported for reported in self.reported if isinstance(reported, kinds)]


def assert_mostly_in_order(received: Sequence[bytes], played: Sequence[bytes]) -> None:
    """Fail unless more than half of the played messages were received, in the order in which they were played.

    On a busy machine JACK loses some before they can be received. `test_burst`, where JACK waits for its clients, tests
    that the program itself loses none.
    """
    assert len(received) > len(played) / 2
    rest = iter(played)
    assert all(message in rest for message in received), "in the order in which they were played"
