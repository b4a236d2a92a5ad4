"""Commands for the display of the timeline, the widget `Session.timeline_view`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from app.editor.session import Session, TimeDisplay
from app.editor.timeline_view import Ghosts, TimelineView
from app.shell.action import Action
from app.shell.commands.command_targets import on_timeline
from widgets.timeline.lanes import LANES as BELOW
from widgets.timeline.marks.dynamics_lane import DynamicsLane

ICONS: Final = {"zoom_in_pitch": "zoom_in", "zoom_out_pitch": "zoom_out"}
"""Icon names of actions whose icon has another name than the action."""


def _has_view(session: Session) -> bool:
    return session.timeline_view is not None


def _zoom(name: str, run: Callable[[TimelineView], None], keys: str) -> Action:
    return Action(f"timeline.{name}", on_timeline(run), "view", keys, enabled=_has_view, icon=ICONS.get(name, name))


def _shown(ghosts: Ghosts, icon: str) -> Action:
    def checked(session: Session) -> bool:
        return session.timeline_view is not None and session.timeline_view.ghosts is ghosts

    def enabled(session: Session) -> bool:
        # Each of several stacked rolls shows one player only.
        return session.timeline_view is not None and not session.timeline_view.stacking

    run = on_timeline(lambda view: view.set_ghosts(ghosts))
    return Action(f"timeline.{ghosts.value}", run, "view/notes", enabled=enabled, checked=checked, icon=icon)


def _show_marks(session: Session, shown: bool) -> None:
    if session.timeline_view is not None:
        session.timeline_view.show_marks(shown)


def _counted(display: TimeDisplay) -> Action:
    return Action(
        f"timeline.count_{display}",
        lambda session, on: session.set_time_display(display),
        "view/time",
        checked=lambda session: session.time_display == display,
    )


LANES: Final = (BELOW[0].id, "roll", *(kind.id for kind in BELOW[1:]))
"""Ids of the lanes in the order of a new window."""


NUMBERED: Final = tuple(id for id in LANES if id != DynamicsLane.id)
"""Ids of the lanes that have a digit as shortcut, ten at most."""


def _lane(id: str) -> Action:
    def checked(session: Session) -> bool:
        return session.timeline_view is not None and session.timeline_view.is_lane_open(id)

    def run(session: Session, is_open: bool) -> None:
        if session.timeline_view is not None:
            session.timeline_view.open_lane(id, is_open)

    keys = f"Ctrl+Alt+{(NUMBERED.index(id) + 1) % 10}" if id in NUMBERED else ""
    return Action(f"lanes.{id}", run, "view/lanes", keys, enabled=_has_view, checked=checked)


def _stack(session: Session, stacked: bool) -> None:
    if session.timeline_view is not None:
        session.timeline_view.set_stacked(stacked)


def _is_stacked(session: Session) -> bool:
    return session.timeline_view is not None and session.timeline_view.stacked


def _fold(name: str, folded: bool) -> Action:
    run = on_timeline(lambda view: view.fold_lanes(folded))
    return Action(f"lanes.{name}", run, "view/lanes", enabled=_has_view)


ACTIONS: tuple[Action, ...] = (
    _zoom("zoom_in", lambda view: view.zoom_in(), "Ctrl++;Ctrl+="),
    _zoom("zoom_out", lambda view: view.zoom_out(), "Ctrl+-"),
    _zoom("zoom_in_pitch", lambda view: view.zoom_in_pitch(), "Ctrl+Shift+Up"),
    _zoom("zoom_out_pitch", lambda view: view.zoom_out_pitch(), "Ctrl+Shift+Down"),
    _zoom("fit", lambda view: view.fit(), "Ctrl+0"),
    Action(
        "timeline.zoom_selection",
        on_timeline(lambda view: view.zoom_to_selection()),
        "view",
        "Z",
        "timeline",
        enabled=lambda session: _has_view(session) and bool(session.selection),
        icon="zoom_selection",
    ),
    _shown(Ghosts.GHOSTS, "ghosts"),
    _shown(Ghosts.SELECTED, "ghosts"),
    _shown(Ghosts.ALL, "players"),
    _shown(Ghosts.ALONE, "player"),
    Action(
        "timeline.marks",
        _show_marks,
        "view/notes",
        enabled=_has_view,
        checked=lambda session: session.timeline_view is not None and session.timeline_view.marks_shown,
    ),
    _counted("bars"),
    _counted("seconds"),
    _counted("frames"),
    *map(_lane, LANES),
    Action(
        "lanes.stacked",
        _stack,
        "view/lanes",
        "Ctrl+Alt+S",
        enabled=lambda session: _has_view(session) and (len(session.players) > 1 or _is_stacked(session)),
        checked=_is_stacked,
        icon="players",
    ),
    _fold("unfold_all", False),
    _fold("fold_all", True),
)
