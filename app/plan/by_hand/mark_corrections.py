"""Marks written or taken away by hand, and the marks that a player has with them."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import ClassVar

from app.plan.by_hand.correction import Correcting
from app.score.marks import SFORZANDI, Mark, MarkKind, mark_id


class OfMark(Correcting, frozen=True):
    """A correction of a mark: at notes, or at ticks. What a kind of mark is anchored to `app.score.marks` says.

    Attributes
    ----------
    note_id, last_note_id : str or None
        The note, and the last one of several.
    start_tick : int or None
        Of a mark that belongs to no note.
    text : str
        As of a `Mark`; of one left out only that of a sforzando.
    """

    has_event: ClassVar[bool] = False
    kind: MarkKind
    note_id: str | None = None
    last_note_id: str | None = None
    start_tick: int | None = None
    text: str = ""

    @property
    def anchor(self) -> str:
        """The mark's id."""
        return mark_id(self.kind, self.note_id or "", self.last_note_id or "", self.start_tick or 0, self.text)

    @property
    def subject(self) -> str:
        """The note, or the place."""
        return self.note_id or f"@{self.start_tick}"

    @property
    def about(self) -> str:
        """The mark's id."""
        return self.anchor

    @property
    def place(self) -> tuple[str, ...]:
        """The mark's id: it is either written or taken away."""
        return "mark", self.anchor

    @property
    def named(self) -> tuple[str, str]:
        """The kind of mark."""
        return "mark", self.kind

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether one of its notes is no longer there."""
        return any(note is not None and note not in note_ids for note in (self.note_id, self.last_note_id))


class SetMark(OfMark, frozen=True, tag="set_mark"):
    """Write a mark, in place of one of the same kind at the same place.

    Attributes
    ----------
    end_tick : int or None
        Where a crescendo or a diminuendo ends; of a dynamic, where that before it holds again (None: it holds until the
        next one).
    """

    end_tick: int | None = None

    @property
    def is_added(self) -> bool:
        """Always: to take it back leaves what the score has."""
        return True

    @property
    def mark(self) -> Mark:
        """The mark that the correction sets."""
        notes = self.note_id or "", self.last_note_id or ""
        return Mark(self.kind, *notes, self.start_tick or 0, self.end_tick or 0, self.text)


class RemoveMark(OfMark, frozen=True, tag="remove_mark"):
    """Leave out a mark of the score."""


def set_mark(mark: Mark) -> SetMark:
    """Return the correction that writes a mark."""
    if mark.note_id:
        return SetMark(mark.kind, mark.note_id, mark.last_note_id or None, text=mark.text)
    return SetMark(mark.kind, start_tick=mark.tick, end_tick=mark.end_tick or None, text=mark.text)


def remove_mark(mark: Mark) -> RemoveMark:
    """Return the correction that leaves a mark out."""
    if mark.note_id:
        return RemoveMark(mark.kind, mark.note_id, mark.last_note_id or None)
    return RemoveMark(mark.kind, start_tick=mark.tick, text=mark.text if mark.text in SFORZANDI else "")


def mark_corrections(corrections: Iterable[Correcting]) -> tuple[SetMark | RemoveMark, ...]:
    """Return the corrections of marks."""
    return tuple(item for item in corrections if isinstance(item, SetMark | RemoveMark))


def corrected_marks(marks: tuple[Mark, ...], corrections: Iterable[Correcting]) -> tuple[Mark, ...]:
    """Return the marks of a part as a player has them: those written by hand come last."""
    said = mark_corrections(corrections)
    if not said:
        return marks
    by_hand = {item.anchor for item in said}
    kept = (mark for mark in marks if mark.id not in by_hand)
    return (*kept, *(item.mark for item in said if isinstance(item, SetMark)))
