"""Conversion between cameras of the viewport and bookmarks of a piece."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from app.editor.session import Session
from app.project.camera_bookmarks import CameraBookmark
from app.project.model import Project
from widgets.viewport.camera import Camera, triple
from widgets.viewport.camera_moves import Eye
from widgets.viewport.film_camera import Shot
from widgets.viewport.framing import tracked
from widgets.viewport.header import ViewportHeader
from widgets.viewport.scene import ViewportScene


def bookmark_of(eye: Eye, name: str, player_id: str) -> CameraBookmark:
    """Return the bookmark of a camera, or of the camera to which it is flying."""
    camera = eye.destination
    return CameraBookmark(
        name,
        eye.view,
        player_id,
        camera.target_m,
        camera.yaw_rad,
        camera.pitch_rad,
        camera.distance_m,
        camera.fov_deg,
        triple(eye.shift_m),
    )


def camera_of(bookmark: CameraBookmark) -> Camera:
    """Return the camera that a bookmark stores."""
    return Camera(bookmark.target_m, bookmark.yaw_rad, bookmark.pitch_rad, bookmark.distance_m, bookmark.fov_deg)


def shot_of(
    bookmark: CameraBookmark, player_ids: tuple[str, ...], project: Project, cameras: dict[float, Camera] | None
) -> Shot:
    """Return a film's camera for a bookmark, which follows the bookmark's player if that exists; ``cameras`` as in
    `Shot`.
    """
    is_there = any(bookmark.player_id == one.id for one in project.performers)
    followed = (bookmark.player_id,) if is_there else player_ids
    return Shot(bookmark.view, camera_of(bookmark), followed, bookmark.shift_m, cameras)


class BookmarkedCamera:
    """The viewport's camera as used by commands, see `app.editor.viewport_state.ViewportCamera`.

    Parameters
    ----------
    go : callable
        Moves the camera, smoothly if the viewport is visible.
    """

    def __init__(
        self, session: Session, eye: Eye, scene: ViewportScene, header: ViewportHeader, go: Callable[[Camera], None]
    ) -> None:
        self._session, self._eye, self._scene, self._header, self._go = session, eye, scene, header, go

    def bookmark(self, name: str) -> CameraBookmark:
        """Return the bookmark of the present camera."""
        return bookmark_of(self._eye, name, next(iter(self._session.in_front), ""))

    def recall(self, bookmark: CameraBookmark) -> None:
        """Move the camera to a bookmark, and make its player active."""
        session, eye, player_id = self._session, self._eye, bookmark.player_id
        if player_id in session.project.dancer_ids:
            session.set_dancer(player_id)
        elif any(player_id == player.id for player in session.project.players):
            others = tuple(id for id in session.players if id != player_id)
            session.set_players((player_id, *others) if player_id in session.players else (player_id,))
        session.viewport.set_view(bookmark.view)
        eye.place(np.asarray(bookmark.shift_m))
        camera, stage, rows = camera_of(bookmark), self._scene.stage, self._scene.rows()
        middle_m = tracked(bookmark.view, stage, rows[0]) if stage is not None and rows else None
        self._go(camera if middle_m is None else replace(camera, target_m=triple(eye.centred(middle_m))))

    @property
    def is_moved(self) -> bool:
        """True if the user has moved the camera."""
        return self._eye.touched

    def restore(self, bookmark: CameraBookmark, is_moved: bool) -> None:
        """Restore the camera that a piece had when it was closed."""
        if is_moved:
            self.recall(bookmark)
            self._eye.jump(self._eye.destination)
        else:
            self._session.viewport.set_view(bookmark.view)

    def ask_name(self, bookmark: CameraBookmark) -> None:
        """Open a field over the picture for renaming a bookmark."""
        self._header.ask_name(bookmark)
