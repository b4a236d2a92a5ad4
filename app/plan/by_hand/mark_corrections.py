"""Corrections that write or remove marks, and their effect on a player's marks."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import ClassVar

from app.plan.by_hand.correction import Correcting
from app.score.marks import SFORZANDI, Mark, MarkKind, mark_id


class OfMark(Correcting, frozen=True):
    """A correction of a mark at notes or ticks; `app.score.marks` defines the anchor of each kind.

    Attributes
    ----------
    note_id, last_note_id : str or None
        First note of the mark, and the last one if it spans several.
    start_tick : int or None
        Tick of a mark without a note.
    text : str
        Text of the mark; for a removed mark set only for a sforzando.
    """

    has_event: ClassVar[bool] = False
    kind: MarkKind
    note_id: str | None = None
    last_note_id: str | None = None
    start_tick: int | None = None
    text: str = ""

    @property
    def anchor(self) -> str:
        """Id of the mark, made of kind, notes, tick and text."""
        return mark_id(self.kind, self.note_id or "", self.last_note_id or "", self.start_tick or 0, self.text)

    @property
    def subject(self) -> str:
        """Id of the note that the mark belongs to, or ``"@"`` and the tick."""
        return self.note_id or f"@{self.start_tick}"

    @property
    def about(self) -> str:
        """Id of the mark that is written or removed."""
        return self.anchor

    @property
    def place(self) -> tuple[str, ...]:
        """Key of the correction, by mark: a mark is either written or removed."""
        return "mark", self.anchor

    @property
    def named(self) -> tuple[str, str]:
        """Kind ``"mark"`` and the mark's own kind, to name the correction in lists."""
        return "mark", self.kind

    def is_lost(self, note_ids: Collection[str], event_ids: Collection[str]) -> bool:
        """Return whether one of the mark's notes no longer exists."""
        return any(note is not None and note not in note_ids for note in (self.note_id, self.last_note_id))


class SetMark(OfMark, frozen=True, tag="set_mark"):
    """Write a mark, replacing one of the same kind at the same place.

    Attributes
    ----------
    end_tick : int or None
        End of a crescendo or diminuendo; for a dynamic, the tick at which the previous dynamic returns (None: in force
        until the next one).
    """

    end_tick: int | None = None

    @property
    def is_added(self) -> bool:
        """Return True, since deleting the correction leaves the marks of the score."""
        return True

    @property
    def mark(self) -> Mark:
        """The musical mark that the correction writes."""
        notes = self.note_id or "", self.last_note_id or ""
        return Mark(self.kind, *notes, self.start_tick or 0, self.end_tick or 0, self.text)


class RemoveMark(OfMark, frozen=True, tag="remove_mark"):
    """Leave out a mark of the score."""


def set_mark(mark: Mark) -> SetMark:
    """Return the correction that writes this mark."""
    if mark.note_id:
        return SetMark(mark.kind, mark.note_id, mark.last_note_id or None, text=mark.text)
    return SetMark(mark.kind, start_tick=mark.tick, end_tick=mark.end_tick or None, text=mark.text)


def remove_mark(mark: Mark) -> RemoveMark:
    """Return the correction that removes this mark."""
    if mark.note_id:
        return RemoveMark(mark.kind, mark.note_id, mark.last_note_id or None)
    return RemoveMark(mark.kind, start_tick=mark.tick, text=mark.text if mark.text in SFORZANDI else "")


def mark_corrections(corrections: Iterable[Correcting]) -> tuple[SetMark | RemoveMark, ...]:
    """Return only the corrections that set or remove musical marks."""
    return tuple(item for item in corrections if isinstance(item, SetMark | RemoveMark))


def corrected_marks(marks: tuple[Mark, ...], corrections: Iterable[Correcting]) -> tuple[Mark, ...]:
    """Apply the corrections to the marks of a part; marks written by hand come last."""
    said = mark_corrections(corrections)
    if not said:
        return marks
    by_hand = {item.anchor for item in said}
    kept = (mark for mark in marks if mark.id not in by_hand)
    return (*kept, *(item.mark for item in said if isinstance(item, SetMark)))
