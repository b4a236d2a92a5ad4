"""What is selected, as a value."""

from __future__ import annotations

import msgspec


class EventKey(msgspec.Struct, frozen=True, order=True):
    """An event of a player's plan."""

    player_id: str
    event_id: str


class Selection(msgspec.Struct, frozen=True):
    """What is selected.

    Attributes
    ----------
    notes : frozenset of str
        Note ids, unique in the score.
    events : frozenset of EventKey
    span : (int, int) or None
        A range of ticks, half-open.
    take : str or None
        A take of the player in front; empty: what was there before the first.
    """

    notes: frozenset[str] = frozenset()
    events: frozenset[EventKey] = frozenset()
    span: tuple[int, int] | None = None
    take: str | None = None

    def __bool__(self) -> bool:
        return bool(self.notes or self.events or self.span or self.take is not None)
