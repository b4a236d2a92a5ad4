"""Ids of events: a kind, and what the event belongs to. They stand in users' files."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Final, NamedTuple

MOST_DIGITS: Final = 10


class EventId(NamedTuple):
    """An id in its parts; its text is ``"<kind>:<of>"``, from the second breath within a note on ``"<kind>.2:<of>"``.

    Attributes
    ----------
    kind : str
    of : str
        Id of a note, ``"@"`` and a tick, a name; or a rule and one of these.
    number : int
        Counts those of one kind that belong to the same.
    """

    kind: str
    of: str
    number: int = 1

    @classmethod
    @lru_cache(maxsize=8192)
    def parse(cls, text: str) -> EventId:
        """Return the parts of an id; kept, since planning asks for those of each breath several times."""
        numbered, _, of = text.partition(":")
        kind, _, number = numbered.partition(".")
        return cls(kind, of, int(number) if number.isdecimal() and len(number) < MOST_DIGITS else 1)

    def __str__(self) -> str:
        """Return the id."""
        return f"{self.kind}:{self.of}" if self.number == 1 else f"{self.kind}.{self.number}:{self.of}"

    @property
    def is_by_rule(self) -> bool:
        """True if a rule made the event."""
        return self.of.partition(":")[0] == "rule"

    @property
    def places(self) -> Iterator[str]:
        """Possible names of the note or the tick: ``of``, and its rest behind each colon (``strained:1:5``)."""
        rest = self.of
        yield rest
        while ":" in rest:
            rest = rest.partition(":")[2]
            yield rest
