"""The marks of the active player, and the selection among them."""

from __future__ import annotations

from typing import Protocol

from app.editor.selection import EventKey, Selection
from app.plan.by_hand.mark_corrections import mark_corrections
from app.project.edit.marks import player_marks
from app.project.performers import Player
from app.score.marks import Mark
from widgets.timeline.model.gestures import Editing
from widgets.timeline.model.marks.mark_table import MarkList, MarkTable
from widgets.timeline.model.roll.note_table import NoteTable

_NONE = MarkList({})


class MarkSession(Editing, Protocol):
    """Part of the session that displaying marks needs."""

    @property
    def player(self) -> Player | None: ...


class ShownMarks:
    """The active player's marks, sorted once for each change.

    Attributes
    ----------
    shown : bool
        Whether marks are visible.
    preview : (Mark, Mark) or None
        The dragged mark at its old and at its new place.
    """

    def __init__(self, session: MarkSession) -> None:
        self._session = session
        self.shown = True
        self.preview: tuple[Mark, Mark] | None = None
        self._corrections: object = None
        self._made_for: tuple[object, object, object] = (None, None, None)
        self._list = _NONE
        self._table: MarkTable | None = None

    @property
    def of_player(self) -> MarkList:
        """The marks of the active player; empty if marks are hidden."""
        player = self._session.player
        if not self.shown or player is None:
            return _NONE
        project = self._session.project
        part, corrections = project.part(player), project.corrections.get(player.id, ())
        marks, said, preview = self._made_for
        if marks is part.marks and self._corrections is corrections and preview is self.preview:
            return self._list
        # Corrections of other kinds do not change the marks.
        self._corrections, new = corrections, mark_corrections(corrections)
        if marks is not part.marks or said != new or preview is not self.preview:
            origins = player_marks(project, player.id)
            if self.preview is not None:
                before, after = self.preview
                origins = {after if mark == before else mark: origin for mark, origin in origins.items()}
            self._list = MarkList(origins)
        self._made_for = part.marks, new, self.preview
        return self._list

    def table(self, notes: NoteTable) -> MarkTable | None:
        """Return the marks assigned to the active player's notes; None if there are none."""
        of_player = self.of_player
        if not of_player.marks:
            return None
        if self._table is None or self._table.notes is not notes or self._table.of_player is not of_player:
            self._table = MarkTable(notes, of_player)
        return self._table

    def key(self, mark: Mark) -> EventKey:
        """Return the key by which the selection refers to a mark."""
        player = self._session.player
        return EventKey(player.id if player is not None else "", mark.id)

    @property
    def selected(self) -> frozenset[int]:
        """Return the indices of the selected marks and of a dragged one."""
        player, events, by_id = self._session.player, self._session.selection.events, self.of_player.by_id
        ids = {key.event_id for key in events if player is not None and key.player_id == player.id}
        if self.preview is not None:
            ids.add(self.preview[1].id)
        return frozenset(by_id[id] for id in ids if id in by_id) if ids else frozenset()

    def select(self, mark: Mark, add: bool = False, toggle: bool = False) -> None:
        """Select a mark alone; with ``add`` in addition to the selection, with ``toggle`` reversing its state."""
        key, events = self.key(mark), self._session.selection.events
        if add or toggle:
            self._session.select(Selection(events=events ^ {key} if toggle else events | {key}))
        elif key not in events:
            self._session.select(Selection(events=frozenset({key})))
