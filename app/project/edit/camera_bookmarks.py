"""Edits of camera bookmarks."""

from __future__ import annotations

from dataclasses import replace

import msgspec

from app.errors import UsageError
from app.project.camera_bookmarks import CameraBookmark
from app.project.model import Project
from app.project.names import clean_name


def keep_camera(project: Project, camera: CameraBookmark) -> Project:
    """Add a bookmark, replacing one of the same name (ignoring case). Raises UsageError for an empty name."""
    camera = msgspec.structs.replace(camera, name=_named(camera.name))
    cameras, index = project.cameras, _index(project, camera.name)
    before, after = (cameras, ()) if index is None else (cameras[:index], cameras[index + 1 :])
    return replace(project, cameras=(*before, camera, *after))


def rename_camera(project: Project, name: str, new_name: str) -> Project:
    """Rename a bookmark. Raises UsageError if the name is empty or taken."""
    new_name = _named(new_name)
    taken = _index(project, new_name)
    if taken is not None and taken != _index(project, name):
        raise UsageError("camera.name_taken", name=new_name)
    return replace(
        project,
        cameras=tuple(
            msgspec.structs.replace(camera, name=new_name) if camera.name == name else camera
            for camera in project.cameras
        ),
    )


def remove_camera(project: Project, name: str) -> Project:
    """Delete the camera bookmark with a name."""
    return replace(project, cameras=tuple(camera for camera in project.cameras if camera.name != name))


def _named(text: str) -> str:
    name = clean_name(text)
    if not name:
        raise UsageError("camera.no_name")
    return name


def _index(project: Project, name: str) -> int | None:
    key = name.casefold()
    return next((index for index, camera in enumerate(project.cameras) if camera.name.casefold() == key), None)
