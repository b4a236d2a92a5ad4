"""Drag of a mark, or of one of its ends, to another note or tick."""

from __future__ import annotations

from typing import Literal, Protocol, TypeAlias

from msgspec.structs import replace

from app.editor.selection import Selection
from app.errors import Message
from app.project.edit.marks import replace_mark
from app.project.model import Project
from app.score.marks import MARK_KINDS, Mark
from widgets.timeline.model.gestures import MouseGesture, along, moved_edge, snapped
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.marks.shown_marks import MarkSession, ShownMarks
from widgets.timeline.model.roll.note_table import NoteTable

Zone: TypeAlias = Literal["first", "last", "whole"]
"""Dragged part of a mark: its beginning, its end, or all of it."""
FAR_PX = 3.0


class MarkPlane(Protocol):
    """The piano roll or lane in which a mark is dragged; a protocol, since both are widgets."""

    marks: ShownMarks

    @property
    def session(self) -> MarkSession: ...
    def show_marks(self) -> None: ...


class MarkDrag(MouseGesture):
    """Drag of a mark. The piece changes only when the button is released; before that, `ShownMarks.preview` is the mark
    at its new place.

    Parameters
    ----------
    zone : str
        Dragged part of the mark.
    notes : NoteTable, optional
        Notes of the active player, for a mark anchored to notes.
    """

    def __init__(
        self, plane: MarkPlane, mouse: LaneMouse, mark: Mark, zone: Zone, notes: NoteTable | None = None
    ) -> None:
        super().__init__(mouse, along(FAR_PX))
        self._plane, self._session = plane, plane.session
        self.mark, self._zone, self._notes = mark, zone, notes
        self._base = plane.session.project

    @property
    def shown(self) -> Mark:
        """The dragged mark at its new place, or at the old one before it moves."""
        preview = self._plane.marks.preview
        return preview[1] if preview is not None else self.mark

    def follow(self, mouse: LaneMouse) -> None:
        changed = self._to_ticks(mouse) if self._notes is None else self._to_note(mouse, self._notes)
        if changed != self.shown:
            self._show((self.mark, changed) if changed != self.mark else None)

    def _show(self, preview: tuple[Mark, Mark] | None) -> None:
        self._plane.marks.preview = preview
        self._plane.show_marks()

    def _to_ticks(self, mouse: LaneMouse) -> Mark:
        """Return the dragged mark, anchored to ticks, at its new place on the grid."""
        mark, grid, score = self.mark, self._session.grid, self._base.score
        by_tick = mouse.tick - self.at.tick
        if self._zone == "whole":
            tick = max(snapped(grid, score, mark.tick + by_tick, mouse.alt), 0)
            return replace(mark, tick=tick, end_tick=tick + mark.end_tick - mark.tick if mark.end_tick else 0)
        is_first = self._zone == "first"
        place = snapped(grid, score, (mark.tick if is_first else mark.end_tick) + by_tick, mouse.alt)
        least = max(round(grid.quarters * score.ticks_per_quarter), 1) if grid.enabled and not mouse.alt else 1
        start, end = moved_edge(mark.tick, mark.end_tick, is_first, max(place, 0), least)
        return replace(mark, tick=max(start, 0), end_tick=end)

    def _to_note(self, mouse: LaneMouse, notes: NoteTable) -> Mark:
        """Return the dragged mark, anchored to notes, with itself or its dragged end moved to the note nearest to the
        mouse.
        """
        mark = self.mark
        place = notes.nearest(mouse.time_s)
        if place is None:
            return mark
        if MARK_KINDS[mark.kind].anchor == "note":
            return replace(mark, note_id=notes.part.notes[place].id)
        first, last = notes.index[mark.note_id], notes.index[mark.last_note_id]
        if self._zone == "first":
            return replace(mark, note_id=notes.part.notes[min(place, last - 1)].id)
        return replace(mark, last_note_id=notes.part.notes[max(place, first + 1)].id)

    def finish(self, mouse: LaneMouse) -> None:
        changed = self.shown
        self._show(None)
        player = self._session.player
        if changed == self.mark or player is None or self._session.project is not self._base:
            return

        def moved(project: Project) -> Project:
            return replace_mark(project, player.id, self.mark, changed)

        if self._session.attempt(Message("edit.move_mark"), moved):
            self._session.select(Selection(events=frozenset({self._plane.marks.key(changed)})))

    def cancel(self) -> None:
        self._show(None)
