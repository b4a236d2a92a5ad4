"""Menus of the acting lane: styles of bars, the giver of a cue, and its receivers."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtWidgets import QMenu

from app.editor.additions import add_styles, bars_of, change_styles
from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.editor.translated import tr
from app.errors import Message
from app.project.edit.cue_givers import set_giver, set_takers
from app.project.model import Project
from widgets.common.clicks import on_click
from widgets.common.event_names import style_name
from widgets.common.plain import verbatim
from widgets.timeline.model.regions.acting_regions import STYLE
from widgets.timeline.model.regions.shown_event import Region


def add_givers(menu: QMenu, session: Session, cue: Region, title: str) -> None:
    """Add an entry for every player that can give a cue, with the present giver checked."""
    givers = menu.addMenu(title)
    givers.setObjectName("givers")
    for player in session.project.players:
        entry = givers.addAction(verbatim(player.name))
        entry.setCheckable(True)
        entry.setChecked(player.id == cue.player_id)
        on_click(entry, _give, session, cue, player.id)


def add_takers(menu: QMenu, session: Session, cue: Region, title: str, automatic: str) -> None:
    """Add an entry for every player that can receive a cue, with present receivers checked. ``automatic`` is the text
    for the players that enter there.
    """
    plan = session.plans.get(cue.player_id)
    event = next((one for one in plan.cues if one.id == cue.event_id), None) if plan is not None else None
    if event is None:
        return
    project, taking = session.project, frozenset(event.takers)
    own = {player.id for player in project.played_by(project.player(cue.player_id))}
    takers = menu.addMenu(title)
    takers.setObjectName("takers")
    for player in project.players:
        if player.id in own:
            continue
        entry = takers.addAction(verbatim(player.name))
        entry.setCheckable(True)
        entry.setChecked(player.id in taking)
        on_click(entry, _take, session, cue, taking ^ {player.id})
    takers.addSeparator()
    on_click(takers.addAction(automatic), _take, session, cue, None)


def _take(session: Session, cue: Region, takers: frozenset[str] | None) -> None:
    plan = session.plans.get(cue.player_id)
    if plan is not None:
        session.attempt(Message("edit.set_takers"), lambda project: set_takers(project, plan, cue.event_id, takers))


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


def add_styles_menus(menu: QMenu, session: Session, region: Region | None, tick: float) -> None:
    """Add submenus that change the style of the selected style regions, and that add a style at the bars around
    ``tick`` for the selected players or for everyone.
    """
    if region is not None and region.kind == STYLE:
        other = _add_styles(
            menu, tr("acting_lane.another_style"), "another_style", session, lambda name: change_styles(session, name)
        )
        for entry in other.actions():
            entry.setCheckable(True)
            entry.setChecked(entry.text() == verbatim(region.label))
    everyone = tuple(player.id for player in session.project.players)
    own, of_all = tr("acting_lane.style_here"), tr("acting_lane.style_for_everyone")
    for title, name, players in ((own, "style_here", session.players), (of_all, "style_of_all_here", everyone)):
        bars = partial(bars_of, session, players, tick)
        _add_styles(menu, title, name, session, lambda style, bars=bars: add_styles(session, style, bars()))  # type: ignore[misc]


def _add_styles(menu: QMenu, title: str, name: str, session: Session, chosen: Callable[[str], None]) -> QMenu:
    styles = menu.addMenu(title)
    styles.setObjectName(name)
    for style in sorted(session.performance.metadata.styles.items, key=style_name):
        entry = styles.addAction(verbatim(style_name(style)))
        entry.setObjectName(f"style_{style}")
        on_click(entry, chosen, style)
    return styles
