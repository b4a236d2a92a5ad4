"""Ids of events: a kind, and the note, tick or name it belongs to. They are stored in project files."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Final, NamedTuple

MOST_DIGITS: Final = 10


class EventId(NamedTuple):
    """Parts of an event id; its text is ``"<kind>:<of>"``, from the second breath within a note on ``"<kind>.2:<of>"``.

    Attributes
    ----------
    kind : str
        Kind of the event, such as ``"breath"``.
    of : str
        A note id, ``"@"`` and a tick, or a name; or a rule followed by one of these.
    number : int
        Counts events of one kind at the same place, from 1.
    """

    kind: str
    of: str
    number: int = 1

    @classmethod
    @lru_cache(maxsize=8192)
    def parse(cls, text: str) -> EventId:
        """Parse an id; cached, since planning parses those of each breath several times."""
        numbered, _, of = text.partition(":")
        kind, _, number = numbered.partition(".")
        return cls(kind, of, int(number) if number.isdecimal() and len(number) < MOST_DIGITS else 1)

    def __str__(self) -> str:
        """Return the id as text."""
        return f"{self.kind}:{self.of}" if self.number == 1 else f"{self.kind}.{self.number}:{self.of}"

    @property
    def is_by_rule(self) -> bool:
        """True if a rule made the event."""
        return self.of.partition(":")[0] == "rule"

    @property
    def places(self) -> Iterator[str]:
        """Yield the texts in the id that may be a note id or tick: ``of``, and each of its endings after a colon
        (``strained:1:5``, ``1:5``, ``5``).
        """
        rest = self.of
        yield rest
        while ":" in rest:
            rest = rest.partition(":")[2]
            yield rest
