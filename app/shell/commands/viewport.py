"""Commands of the viewport: views, framing, and the parts that are drawn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from app.editor.session import Session
from app.editor.viewport_state import FOLLOWS, Follows, Shown
from app.project.camera_bookmarks import View
from app.shell.action import Action
from app.shell.commands.command_targets import has_everyone

KEY_STEPS = 2.0
"""Steps of the mouse wheel that one press of a zoom key equals."""


def _row(
    name: str,
    run: Callable[..., None],
    keys: str,
    icon: str = "",
    enabled: Callable[[Session], bool] | None = has_everyone,
    checked: Callable[[Session], bool] | None = None,
) -> Action:
    return Action(f"viewport.{name}", run, "view/viewport", keys, "viewport", enabled, checked, icon)


def _view(view: View, key: str) -> Action:
    return _row(view, lambda session: session.viewport.set_view(view), key)


def _toggle(what: Shown, icon: str, key: str = "") -> Action:
    return _row(
        what,
        lambda session, shown: session.viewport.show(what, shown),
        key,
        icon,
        enabled=None,
        checked=lambda session: session.viewport.shows(what),
    )


def _follow(when: Follows) -> Action:
    row = _row(
        f"camera_follows_{when}",
        lambda session, on: session.viewport.set(camera_follows=when),
        "",
        enabled=None,
        checked=lambda session: session.viewport.camera_follows == when,
    )
    return replace(row, menu="view/camera_follows")


ACTIONS: tuple[Action, ...] = (
    _view("ensemble", "1"),
    _view("front", "2"),
    _view("side", "3"),
    _view("top", "4"),
    _view("hands", "5"),
    _view("mouth", "6"),
    _view("feet", "7"),
    _row("other_side", lambda session: session.viewport.turn(), "9", "", has_everyone),
    _row("dolly_in", lambda session: session.viewport.dollied.emit(KEY_STEPS), "+;="),
    _row("dolly_out", lambda session: session.viewport.dollied.emit(-KEY_STEPS), "-"),
    _row("frame", lambda session: session.viewport.frame(True), "F", "frame"),
    _row("frame_all", lambda session: session.viewport.frame(False), "A", "players"),
    _toggle("names", "player"),
    _toggle("skeleton", "skeleton"),
    _toggle("contacts", "contacts"),
    _toggle("wireframe", "wireframe", "W"),
    _toggle("props", "seated"),
    _row(
        "follow_selection",
        lambda session, on: session.viewport.set(follows_selection=on),
        "",
        enabled=None,
        checked=lambda session: session.viewport.follows_selection,
    ),
    *map(_follow, FOLLOWS),
    # Also in the timeline: poses are set in the viewport and timed below.
    replace(
        _row(
            "pose",
            lambda session, posing: session.viewport.set_posing(posing),
            "P",
            "pose",
            checked=lambda session: session.viewport.posing,
        ),
        context="window",
    ),
)
