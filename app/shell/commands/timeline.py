"""How the timeline is seen. The timeline itself is `Session.timeline_view`."""

from __future__ import annotations

from collections.abc import Callable

from app.editor.session import Session, TimeDisplay
from app.editor.timeline_view import Ghosts, TimelineView
from app.shell.action import Action
from app.shell.commands.chosen import on_timeline


def _has_view(session: Session) -> bool:
    return session.timeline_view is not None


def _zoom(name: str, run: Callable[[TimelineView], None], keys: str) -> Action:
    return Action(f"timeline.{name}", on_timeline(run), "view", keys, enabled=_has_view, icon=name)


def _shown(ghosts: Ghosts, icon: str) -> Action:
    def checked(session: Session) -> bool:
        return session.timeline_view is not None and session.timeline_view.ghosts is ghosts

    run = on_timeline(lambda view: view.set_ghosts(ghosts))
    return Action(f"timeline.{ghosts.value}", run, "view/notes", checked=checked, icon=icon)


def _counted(display: TimeDisplay) -> Action:
    return Action(
        f"timeline.count_{display}",
        lambda session, on: session.set_time_display(display),
        "view/time",
        checked=lambda session: session.time_display == display,
    )


ACTIONS: tuple[Action, ...] = (
    _zoom("zoom_in", lambda view: view.zoom_in(), "Ctrl++;Ctrl+="),
    _zoom("zoom_out", lambda view: view.zoom_out(), "Ctrl+-"),
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
    _shown(Ghosts.ALL, "players"),
    _shown(Ghosts.ALONE, "player"),
    _counted("bars"),
    _counted("seconds"),
    _counted("frames"),
)
