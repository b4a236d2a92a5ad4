"""Commands of the viewport: views, framing, what is drawn."""

from __future__ import annotations

from functools import partial

from app.shell.action import QT_TRANSLATE_NOOP, Action
from widgets.common.session import Session
from widgets.common.viewport_state import Shown, View


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


def _view(view: View, text: str, key: str) -> Action:
    return Action(
        id=f"viewport.{view}",
        text=text,
        run=partial(show_view, view),
        menu="View/Viewport",
        shortcut=key,
        context="viewport",
        enabled=_has_players,
    )


def _toggle(what: Shown, text: str, icon: str, key: str = "") -> Action:
    return Action(
        id=f"viewport.{what}",
        text=text,
        run=partial(show, what),
        menu="View/Viewport",
        shortcut=key,
        context="viewport",
        checked=partial(_shows, what),
        icon=icon,
    )


ACTIONS: tuple[Action, ...] = (
    _view("ensemble", QT_TRANSLATE_NOOP("Action", "Ensemble"), "1"),
    _view("front", QT_TRANSLATE_NOOP("Action", "Front"), "2"),
    _view("side", QT_TRANSLATE_NOOP("Action", "Side"), "3"),
    _view("top", QT_TRANSLATE_NOOP("Action", "Top"), "4"),
    _view("hands", QT_TRANSLATE_NOOP("Action", "Hands"), "5"),
    _view("mouth", QT_TRANSLATE_NOOP("Action", "Mouth"), "6"),
    _view("feet", QT_TRANSLATE_NOOP("Action", "Feet"), "7"),
    Action(
        id="viewport.frame",
        text=QT_TRANSLATE_NOOP("Action", "Frame Selected Players"),
        run=frame_players,
        menu="View/Viewport",
        shortcut="F",
        context="viewport",
        enabled=_has_players,
        icon="frame",
    ),
    Action(
        id="viewport.frame_all",
        text=QT_TRANSLATE_NOOP("Action", "Frame Ensemble"),
        run=frame_ensemble,
        menu="View/Viewport",
        shortcut="Home;A",
        context="viewport",
        enabled=_has_players,
        icon="players",
    ),
    _toggle("names", QT_TRANSLATE_NOOP("Action", "Players' Names"), "player"),
    _toggle("skeleton", QT_TRANSLATE_NOOP("Action", "Skeleton"), "skeleton"),
    _toggle("contacts", QT_TRANSLATE_NOOP("Action", "Contact Points"), "contacts"),
    _toggle("wireframe", QT_TRANSLATE_NOOP("Action", "Wireframe"), "wireframe", "W"),
    Action(
        id="viewport.pose",
        text=QT_TRANSLATE_NOOP("Action", "Pose by Hand"),
        run=pose,
        menu="View/Viewport",
        shortcut="P",
        context="viewport",
        enabled=_has_players,
        checked=_posing,
        icon="pose",
    ),
)
