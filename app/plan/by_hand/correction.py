"""Base classes of all corrections: their anchor, and whether they can be applied."""

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
        Kind of the events that the correction is about; empty if it varies.
    has_event : bool
        True if the plan contains an event for the correction, which can be moved and deleted like others.
    """

    event_kind: ClassVar[str] = ""
    has_event: ClassVar[bool] = True

    @property
    def tag(self) -> str:
        """Name of the kind of correction, as stored in project files."""
        return str(self.__struct_config__.tag)

    @property
    def anchor(self) -> str:
        """Note, event or name to which the correction is anchored: its first field."""
        return str(getattr(self, self.__struct_fields__[0]))

    @property
    def subject(self) -> str:
        """Note id, event id or name by which messages refer to the correction."""
        return self.anchor

    @property
    def place(self) -> tuple[str, ...]:
        """Key by which corrections are distinguished: a player has at most one correction with each key."""
        return self.tag, self.anchor

    @property
    def about(self) -> str:
        """Id of the planned event that the correction changes or adds."""
        return str(EventId(self.event_kind, self.anchor))

    @property
    def named(self) -> tuple[str, str]:
        """Name of the correction for lists, as a pair: the kind of name (such as ``"event"`` or ``"style"``) and the
        name. By default ``"event"`` and the kind of the corrected event.
        """
        return "event", EventId.parse(self.about).kind

    @property
    def title(self) -> str:
        """Title that the user gave to the correction; empty for kinds of corrections without titles."""
        return ""

    @property
    def is_empty(self) -> bool:
        """True if the correction covers a span that has no length."""
        start, end = getattr(self, "start_tick", None), getattr(self, "end_tick", None)
        return start is not None and end is not None and start >= end

    @property
    def is_added(self) -> bool:
        """True if the correction adds an event that the generator does not make, so that deleting the event removes the
        correction; by default False.
        """
        return False

    @property
    def left_out(self) -> str | None:
        """Id of a generated event that must not appear because of the correction."""
        return None

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether the correction's note or generated event no longer exists."""
        return False


class OfNote(Correcting, frozen=True):
    """A correction that belongs to a note and moves with it."""

    note_id: str

    @property
    def is_added(self) -> bool:
        """True if the correction adds an event where the generator had none; False if it had one, or if the kind of
        correction does not record it."""
        return bool(getattr(self, "added", False))

    @property
    def left_out(self) -> str | None:
        """Id of the generated event at the note from which the correction was moved, if it was moved."""
        moved_from: str | None = getattr(self, "moved_from", None)
        return None if moved_from is None else str(EventId(EventId.parse(self.about).kind, moved_from))

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether the correction's note no longer exists."""
        return self.note_id not in note_ids


class OfEvent(Correcting, frozen=True):
    """A correction that changes an event which the generator plans, by its id."""

    event_id: str

    @property
    def about(self) -> str:
        """Id of the planned event that the correction changes."""
        return self.event_id

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether the correction's event is no longer generated."""
        return self.event_id not in event_ids


class Own(Correcting, frozen=True):
    """Base of corrections that add an event of the animator's own; ``name`` makes the event's id unique."""

    name: str

    @property
    def is_added(self) -> bool:
        """Return True, since the generator makes no such event."""
        return True
