"""Base of all corrections: what they are about, and whether they can be applied."""

from __future__ import annotations

from collections.abc import Collection
from typing import ClassVar

import msgspec

from app.plan.event_id import EventId


class Correcting(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag_field="correction"):
    """Base of corrections: a change made by hand.

    Attributes
    ----------
    event_kind : str
        The kind of the events that it is about, where all are of one.
    has_event : bool
        Plans have an event of it, which may be moved and deleted as others.
    """

    event_kind: ClassVar[str] = ""
    has_event: ClassVar[bool] = True

    @property
    def tag(self) -> str:
        """The kind of correction, as in files."""
        return str(self.__struct_config__.tag)

    @property
    def anchor(self) -> str:
        """The note, event or name that it is bound to: its first field."""
        return str(getattr(self, self.__struct_fields__[0]))

    @property
    def subject(self) -> str:
        """The note, event or name for a message."""
        return self.anchor

    @property
    def place(self) -> tuple[str, ...]:
        """Place of the correction: two of a player at the same place exclude one another."""
        return self.tag, self.anchor

    @property
    def about(self) -> str:
        """The id of the event."""
        return str(EventId(self.event_kind, self.anchor))

    @property
    def named(self) -> tuple[str, str]:
        """The name by which it is listed, after the kind of name: an event's kind."""
        return "event", EventId.parse(self.about).kind

    @property
    def title(self) -> str:
        """The name that the user gave it."""
        return ""

    @property
    def is_empty(self) -> bool:
        """True if its span ends before it begins."""
        start, end = getattr(self, "start_tick", None), getattr(self, "end_tick", None)
        return start is not None and end is not None and start >= end

    @property
    def is_added(self) -> bool:
        """True if the generator has nothing there: to delete it is to forget it."""
        return False

    @property
    def left_out(self) -> str | None:
        """The id of an event that must not appear."""
        return None

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether its note, or the generator's event, is no longer there."""
        return False


class OfNote(Correcting, frozen=True):
    """A correction of what belongs to a note."""

    note_id: str

    @property
    def is_added(self) -> bool:
        """True if the generator had none here, where the correction says so."""
        return bool(getattr(self, "added", False))

    @property
    def left_out(self) -> str | None:
        """The id of the event that it was, where it came from another note."""
        moved_from: str | None = getattr(self, "moved_from", None)
        return None if moved_from is None else str(EventId(EventId.parse(self.about).kind, moved_from))

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether its note is no longer there."""
        return self.note_id not in note_ids


class OfEvent(Correcting, frozen=True):
    """A correction of what the generator made."""

    event_id: str

    @property
    def about(self) -> str:
        """The id of the event."""
        return self.event_id

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether its event is no longer made."""
        return self.event_id not in event_ids


class Own(Correcting, frozen=True):
    """Something of the animator's own; ``name`` makes its event id unique."""

    name: str

    @property
    def is_added(self) -> bool:
        """True: the generator makes no such event."""
        return True
