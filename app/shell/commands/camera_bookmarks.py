"""Commands for cameras that are stored in the project."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from app.editor.session import Session
from app.editor.translated import tr
from app.errors import Message
from app.project.camera_bookmarks import CameraBookmark
from app.project.edit.camera_bookmarks import keep_camera, remove_camera
from app.project.edit.players import free_name
from app.shell.action import Action
from app.shell.commands.command_targets import has_everyone

NUMBERED: Final = 9
"""Number of cameras that have a shortcut."""


def current(session: Session) -> CameraBookmark | None:
    """Return the camera bookmark that was stored or recalled last; None if there is none or it was removed."""
    cameras = {camera.name: camera for camera in session.project.cameras}
    return next((cameras[name] for name in session.viewport.bookmarks if name in cameras), None)


def recall(session: Session, index: int) -> None:
    """Move the viewport's camera to a bookmark, counted from 0."""
    cameras, eye = session.project.cameras, session.viewport.camera
    if eye is not None and index < len(cameras):
        eye.recall(cameras[index])
        session.viewport.use_bookmark(cameras[index].name)


def _keep(session: Session) -> None:
    names = [camera.name for camera in session.project.cameras]
    _keep_as(session, free_name(tr("camera.camera").format(number=len(names) + 1), names))


def _update(session: Session) -> None:
    camera = current(session)
    if camera is not None:
        _keep_as(session, camera.name)


def _keep_as(session: Session, name: str) -> None:
    eye = session.viewport.camera
    if eye is None:
        return
    edit = partial(keep_camera, camera=eye.bookmark(name))
    if session.attempt(Message("edit.keep_camera", {"name": name}), edit):
        session.viewport.use_bookmark(name)
        session.notice(Message("camera.kept", {"name": name}))


def _rename(session: Session) -> None:
    camera, eye = current(session), session.viewport.camera
    if camera is not None and eye is not None:
        eye.ask_name(camera)


def _remove(session: Session) -> None:
    camera = current(session)
    if camera is not None:
        edit = partial(remove_camera, name=camera.name)
        session.attempt(Message("edit.remove_camera", {"name": camera.name}), edit)


def _has_current(session: Session) -> bool:
    return current(session) is not None


def _named(session: Session) -> Message | None:
    camera = current(session)
    return None if camera is None else Message("camera.name", {"name": camera.name})


def _numbered(index: int) -> Action:
    def step(session: Session) -> Message | None:
        cameras = session.project.cameras
        return Message("camera.name", {"name": cameras[index].name}) if index < len(cameras) else None

    return Action(
        f"cameras.recall_{index + 1}",
        lambda session: recall(session, index),
        "view/cameras",
        f"Shift+{index + 1}",
        "viewport",
        lambda session: index < len(session.project.cameras),
        step=step,
        hides=True,
    )


def _row(
    name: str,
    run: Callable[[Session], None],
    keys: str = "",
    enabled: Callable[[Session], bool] = _has_current,
    step: Callable[[Session], Message | None] | None = _named,
) -> Action:
    return Action(f"cameras.{name}", run, "view/cameras", keys, "viewport", enabled, step=step)


ACTIONS: tuple[Action, ...] = (
    *map(_numbered, range(NUMBERED)),
    _row("keep", _keep, "Ctrl+B", has_everyone, None),
    _row("update", _update, "Ctrl+Shift+B"),
    _row("rename", _rename, step=None),
    _row("remove", _remove),
)
