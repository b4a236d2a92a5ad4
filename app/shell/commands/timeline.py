"""How the timeline is seen. The timeline itself is `Session.timeline_view`."""

from __future__ import annotations

from collections.abc import Callable

from app.editor.session import Session, TimeDisplay
from app.editor.timeline_view import Ghosts, TimelineView
from app.shell.action import Action


def _asked(run: Callable[[TimelineView], None]) -> Callable[[Session], None]:
    def asked(session: Session) -> None:
        if session.timeline_view is not None:
            run(session.timeline_view)

    return asked


def _has_view(session: Session) -> bool:
    return session.timeline_view is not None


def _can_zoom_to_selection(session: Session) -> bool:
    return _has_view(session) and bool(session.selection)


def _shown(ghosts: Ghosts, icon: str) -> Action:
    def run(session: Session, on: bool) -> None:
        if session.timeline_view is not None:
            session.timeline_view.set_ghosts(ghosts)

    def checked(session: Session) -> bool:
        return session.timeline_view is not None and session.timeline_view.ghosts is ghosts

    return Action(f"timeline.{ghosts.value}", run, "view/notes", checked=checked, icon=icon)


def _counted(display: TimeDisplay) -> Action:
    def run(session: Session, on: bool) -> None:
        session.set_time_display(display)

    return Action(
        f"timeline.count_{display}",
        run,
        "view/time",
        checked=lambda session: session.time_display == display,
    )


ACTIONS: tuple[Action, ...] = (
    Action(
        "timeline.zoom_in",
        _asked(lambda view: view.zoom_in()),
        "view",
        "Ctrl++;Ctrl+=",
        enabled=_has_view,
        icon="zoom_in",
    ),
    Action(
        "timeline.zoom_out",
        _asked(lambda view: view.zoom_out()),
        "view",
        "Ctrl+-",
        enabled=_has_view,
        icon="zoom_out",
    ),
    Action(
        "timeline.fit",
        _asked(lambda view: view.fit()),
        "view",
        "Ctrl+0",
        enabled=_has_view,
        icon="fit",
    ),
    Action(
        "timeline.zoom_selection",
        _asked(lambda view: view.zoom_to_selection()),
        "view",
        "Z",
        "timeline",
        enabled=_can_zoom_to_selection,
        icon="zoom_selection",
    ),
    _shown(Ghosts.GHOSTS, "ghosts"),
    _shown(Ghosts.ALL, "players"),
    _shown(Ghosts.ALONE, "player"),
    _counted("bars"),
    _counted("seconds"),
    _counted("frames"),
)
