"""The menu from which the giver of an entry is chosen."""

from __future__ import annotations

from PySide6.QtWidgets import QMenu

from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.errors import Message
from app.project.edit.givers import set_giver
from app.project.model import Project
from widgets.common.plain import verbatim
from widgets.timeline.model.region import Region


def add_givers(menu: QMenu, session: Session, cue: Region, title: str) -> None:
    """Every player who may give the entry of a cue; who gives it is checked."""
    givers = menu.addMenu(title)
    givers.setObjectName("givers")
    for player in session.project.players:
        entry = givers.addAction(verbatim(player.name))
        entry.setCheckable(True)
        entry.setChecked(player.id == cue.player_id)
        entry.triggered.connect(lambda _=False, giver_id=player.id: _give(session, cue, giver_id))


def _give(session: Session, cue: Region, giver_id: str) -> None:
    plan = session.plans.get(cue.player_id)
    if plan is None or giver_id == cue.player_id:
        return
    ids: list[str] = []

    def edit(project: Project) -> Project:
        edited = set_giver(project, plan, cue.event_id, giver_id)
        ids[:] = edited.event_ids
        return edited.project

    message = Message("edit.set_giver", {"player": session.project.player(giver_id).name})
    if session.attempt(message, edit) and ids:
        session.select(Selection(events=frozenset(EventKey(giver_id, event_id) for event_id in ids)))
