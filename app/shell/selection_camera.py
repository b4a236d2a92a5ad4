"""Automatic camera that shows the selected or corrected hands, mouth, feet or whole body."""

from __future__ import annotations

from typing import Final

from PySide6.QtCore import QObject, Qt, QTimer
from PySide6.QtGui import QGuiApplication

from app.editor.problems import view_of_event
from app.editor.selection import EventKey
from app.editor.session import Session
from app.plan.by_hand.corrections import Correction
from app.project.camera_bookmarks import View
from app.project.edit.found_events import events_of
from app.project.model import Project
from app.project.undoable_document import Change

_SOON_MS: Final = 40
"""Delay in milliseconds after a selection or an edit, which may be the beginning of a drag or of a larger selection."""
_OF_ONE_PLAYER: Final = frozenset[View](("front", "hands", "mouth", "feet"))


class SelectionCamera(QObject):
    """Moves the viewport's camera to selections and corrections as set in `ViewportState.follows`.

    It does not move during a drag, playback or recording, nor if the camera already shows the right part, so that a
    manually turned camera stays.
    """

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._notes, self._events = session.selection.notes, session.selection.events
        self._goal: tuple[str, View] | None = None
        self._event: EventKey | None = None
        """The event that is gone to; a note's playhead is `follow_selection`'s."""
        self._soon = QTimer(self, singleShot=True, interval=_SOON_MS)
        self._soon.timeout.connect(self._go)
        session.selection_changed.connect(self._selected)
        session.changed.connect(self._changed)
        session.players_changed.connect(self._players_selected)
        session.viewport.viewed.connect(self._stay)

    def _players_selected(self) -> None:
        """Cancel the pending camera move if its player is no longer selected."""
        if self._goal is not None and self._goal[0] not in self._session.players:
            self._goal = None

    def _stay(self) -> None:
        """Cancel the pending camera move, since another command requested a view, such as a jump to a problem."""
        self._goal = None

    def _selected(self) -> None:
        selection = self._session.selection
        notes, events = selection.notes - self._notes, selection.events - self._events
        self._notes, self._events = selection.notes, selection.events
        if len(selection.notes) == 1 and notes and not selection.events:
            player_id = _player_of(self._session, next(iter(notes)))
            self._event = None
            self._show(player_id, "hands")
        elif len(selection.events) == 1 and events and not selection.notes:
            self._show_event(next(iter(events)))

    def _changed(self, change: Change) -> None:
        """Schedule a camera move after the user has corrected one kind of event of a selected player.

        Edits during a drag, and undo of several edits, move nothing.
        """
        document = self._session.document
        if change.opened or document.undone or not document.done or document.done[-1].gesture is not None:
            return
        keys = _corrected(change.before, change.after)
        places = {(key.player_id, view_of_event(key.event_id)) for key in keys}
        if len(places) == 1 and keys[0].player_id in self._session.players:
            self._show_event(keys[0])

    def _show_event(self, key: EventKey) -> None:
        view = view_of_event(key.event_id)
        if view is not None:
            self._event = key
            self._show(key.player_id, view)

    def _show(self, player_id: str, view: View) -> None:
        self._goal = (player_id, view) if player_id else None
        self._soon.start()

    def _go(self) -> None:
        session, viewport, goal = self._session, self._session.viewport, self._goal
        if goal is None or session.playing or session.recording.running or viewport.posing:
            return
        if QGuiApplication.mouseButtons() != Qt.MouseButton.NoButton:
            self._soon.start()
            return
        self._goal = None
        player_id, view = goal
        follows = viewport.camera_follows
        if follows == "never" or (follows == "close_ups" and viewport.view not in _OF_ONE_PLAYER):
            return
        if all(player_id != player.id for player in session.project.players):
            return
        if player_id != session.players[0]:
            others = tuple(id for id in session.players if id != player_id)
            session.set_players((player_id, *others) if player_id in session.players else (player_id,))
        if view != viewport.view:
            viewport.set_view(view)
        if viewport.follows_selection and self._event is not None:
            self._seek(self._event)

    def _seek(self, key: EventKey) -> None:
        """Move the playhead to the start of an event, unless it is within the event already."""
        session, plan = self._session, self._session.plans.get(key.player_id)
        event = None if plan is None else events_of(plan).get(key.event_id)
        if event is not None and not event.start_s <= session.playhead_s < event.end_s:
            session.set_playhead(event.start_s)


def _player_of(session: Session, note_id: str) -> str:
    """Return the id of the player of a note; a selected player if several share the note's part."""
    part_ids = {part.id for part in session.project.score.parts if note_id in part.note_ids}
    playing = [player.id for player in session.project.players if player.part_id in part_ids]
    return next((id for id in session.players if id in playing), next(iter(playing), ""))


def _corrected(before: Project, after: Project) -> list[EventKey]:
    """Return the keys of the events whose manual changes were added, changed or removed between two projects."""
    found = list[EventKey]()
    if before.corrections is after.corrections:
        return found
    for player_id in before.corrections.keys() | after.corrections.keys():
        old, new = before.corrections.get(player_id, ()), after.corrections.get(player_id, ())
        if old is not new:
            found += [EventKey(player_id, item.about) for item in _only_in_one(old, new)]
    return found


def _only_in_one(old: tuple[Correction, ...], new: tuple[Correction, ...]) -> list[Correction]:
    same = set(map(id, old)) & set(map(id, new))
    return [item for item in (*old, *new) if id(item) not in same]
