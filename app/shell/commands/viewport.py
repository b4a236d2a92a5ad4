"""Commands of the viewport: views, framing, what is drawn."""

from __future__ import annotations

from functools import partial

from app.editor.session import Session
from app.editor.viewport_state import Shown, View
from app.shell.action import Action


def show_view(view: View, session: Session) -> None:
    """Look at the players so."""
    session.viewport.set_view(view)


def frame_players(session: Session) -> None:
    """Bring the selected players into the picture."""
    session.viewport.frame(True)


def frame_ensemble(session: Session) -> None:
    """Bring everyone into the picture."""
    session.viewport.frame(False)


def show(what: Shown, session: Session, shown: bool) -> None:
    """Draw something beside the players, or not."""
    session.viewport.show(what, shown)


def pose(session: Session, posing: bool) -> None:
    """Take the pose tool, or put it down."""
    session.viewport.set_posing(posing)


def _shows(what: Shown, session: Session) -> bool:
    return session.viewport.shows(what)


def _posing(session: Session) -> bool:
    return session.viewport.posing


def _has_players(session: Session) -> bool:
    return bool(session.project.players)


def _view(view: View, key: str) -> Action:
    return Action(
        id=f"viewport.{view}",
        run=partial(show_view, view),
        menu="view/viewport",
        shortcut=key,
        context="viewport",
        enabled=_has_players,
    )


def _toggle(what: Shown, icon: str, key: str = "") -> Action:
    return Action(
        id=f"viewport.{what}",
        run=partial(show, what),
        menu="view/viewport",
        shortcut=key,
        context="viewport",
        checked=partial(_shows, what),
        icon=icon,
    )


ACTIONS: tuple[Action, ...] = (
    _view("ensemble", "1"),
    _view("front", "2"),
    _view("side", "3"),
    _view("top", "4"),
    _view("hands", "5"),
    _view("mouth", "6"),
    _view("feet", "7"),
    Action(
        id="viewport.frame",
        run=frame_players,
        menu="view/viewport",
        shortcut="F",
        context="viewport",
        enabled=_has_players,
        icon="frame",
    ),
    Action(
        id="viewport.frame_all",
        run=frame_ensemble,
        menu="view/viewport",
        shortcut="Home;A",
        context="viewport",
        enabled=_has_players,
        icon="players",
    ),
    _toggle("names", "player"),
    _toggle("skeleton", "skeleton"),
    _toggle("contacts", "contacts"),
    _toggle("wireframe", "wireframe", "W"),
    Action(
        id="viewport.pose",
        run=pose,
        menu="view/viewport",
        shortcut="P",
        context="viewport",
        enabled=_has_players,
        checked=_posing,
        icon="pose",
    ),
)
