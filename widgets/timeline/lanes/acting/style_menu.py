"""The menus from which the style of some bars is chosen."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtWidgets import QMenu

from app.editor.additions import add_styles, bars_of, change_styles
from app.editor.session import Session
from app.editor.translated import tr
from widgets.common.clicks import on_click
from widgets.common.event_names import style_name
from widgets.common.plain import verbatim
from widgets.timeline.model.regions.acting_regions import STYLE
from widgets.timeline.model.regions.shown_event import Region


def add_styles_menus(menu: QMenu, session: Session, region: Region | None, tick: float) -> None:
    """Another style for the selected regions, and a new region at a place for the selected players or for everyone."""
    if region is not None and region.kind == STYLE:
        other = _add(
            menu, tr("acting_lane.another_style"), "another_style", session, lambda name: change_styles(session, name)
        )
        for entry in other.actions():
            entry.setCheckable(True)
            entry.setChecked(entry.text() == verbatim(region.label))
    everyone = tuple(player.id for player in session.project.players)
    own, of_all = tr("acting_lane.style_here"), tr("acting_lane.style_of_all_here")
    for title, name, players in ((own, "style_here", session.players), (of_all, "style_of_all_here", everyone)):
        bars = partial(bars_of, session, players, tick)
        _add(menu, title, name, session, lambda style, bars=bars: add_styles(session, style, bars()))  # type: ignore[misc]


def _add(menu: QMenu, title: str, name: str, session: Session, chosen: Callable[[str], None]) -> QMenu:
    styles = menu.addMenu(title)
    styles.setObjectName(name)
    for style in sorted(session.performance.metadata.styles.items, key=style_name):
        entry = styles.addAction(verbatim(style_name(style)))
        entry.setObjectName(f"style_{style}")
        on_click(entry, chosen, style)
    return styles
