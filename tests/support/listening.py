"""Wait for the reports of a recorder."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TypeVar

import pytest

from app.capture.link import RecorderLink
from app.capture.protocol import Events, News

T = TypeVar("T", bound=News)
PATIENCE_S = 30.0
"""Seconds to wait for a report, since the machine may be busy with other tests."""
QUIET_S = 5.0
"""Seconds after which a message counts as lost."""


class Ear:
    """All reports of a link, in order."""

    def __init__(self, link: RecorderLink) -> None:
        self.link = link
        self.reported: list[News] = []

    def look(self) -> None:
        """Receive pending reports."""
        self.reported += self.link.poll()

    def wait(self, kind: type[T], where: Callable[[T], bool] = lambda reported: True, *, after: int = 0) -> T:
        """Wait for the first report of a kind, starting at index `after`."""
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
        """Wait for a number of messages, and return all."""
        end_s = time.monotonic() + PATIENCE_S
        while len(self.messages) < count and time.monotonic() < end_s:
            self.look()
            time.sleep(0.005)
        return self.messages

    def wait_for_most(self, count: int) -> None:
        """Wait for a number of messages, or until none arrive for a while, since JACK may lose some."""
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
        """All messages received so far."""
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
