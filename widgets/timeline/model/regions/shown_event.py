"""An event as displayed in a lane."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec
import numpy as np

from app.editor.selection import EventKey
from app.errors import Message
from app.plan.event_id import EventId
from widgets.timeline.model.geometry import TimeSpans


class Region(msgspec.Struct):
    """An event as displayed in a lane; only the lane that makes it sets its row.

    Attributes
    ----------
    kind : str
        First part of the event's id, such as ``cue``.
    row : int
        Row from the top.
    amount : float
        Strength 0..1, or -1..1 if ``signed``.
    fades, fades_outside : bool
        Whether it has fades that can be dragged; whether they are outside of its start and end.
    steady : bool
        Whether it lacks an amount that could be dragged.
    guest : bool
        Whether it belongs to another player and is shown because it affects this one.
    fixed : bool
        Whether it cannot be moved, only removed.
    removed : bool
        Whether the user removed it, so that only its place is shown.
    """

    player_id: str
    event_id: str
    kind: str
    start_tick: int
    end_tick: int
    start_s: float
    end_s: float
    row: int = 0
    amount: float = 1.0
    label: str = ""
    reason: Message | None = None
    by_hand: bool = False
    signed: bool = False
    steady: bool = False
    fade_in_s: float = 0.0
    fade_out_s: float = 0.0
    fades: bool = False
    fades_outside: bool = False
    peak_s: float = 0.0
    guest: bool = False
    fixed: bool = False
    removed: bool = False

    @property
    def first_s(self) -> float:
        """Start of the displayed region in seconds, including outer fades."""
        return self.start_s - self.fade_in_s if self.fades_outside else self.start_s

    @property
    def last_s(self) -> float:
        """End of the displayed region in seconds, including outer fades."""
        return self.end_s + self.fade_out_s if self.fades_outside else self.end_s

    @property
    def key(self) -> EventKey:
        """Key by which the selection refers to the region's event."""
        return EventKey(self.player_id, self.event_id)


def spans_of(regions: Sequence[Region]) -> TimeSpans:
    """Return the displayed time spans of regions."""
    return TimeSpans(
        np.array([region.first_s for region in regions], np.float64),
        np.array([region.last_s for region in regions], np.float64),
    )


def place_of(event_id: str, onsets: Mapping[str, int]) -> int | None:
    """Return the tick of an event from its id: that of the note named in it, or the number after ``@``; None for
    neither.
    """
    for rest in EventId.parse(event_id).places:
        if rest in onsets:
            return onsets[rest]
        if rest.startswith("@") and rest[1:].lstrip("-").isdecimal():
            return int(rest[1:])
    return None
