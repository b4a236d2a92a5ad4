"""Restores the view of a piece when it is reopened: camera, active player, playhead, timeline and its lanes.

Views are stored in the editor's settings on this computer, by the piece's file, so that looking at a piece does not
change it, and shared projects are unaffected. Cameras to be shared are bookmarks (`app.project.camera_bookmarks`) in
the project.
"""

from __future__ import annotations

from importlib.resources import files as resource_files
from pathlib import Path
from typing import Annotated, Final

import msgspec
from PySide6.QtCore import QObject

from app.editor.files import Files
from app.editor.session import Session
from app.editor.settings import Settings
from app.errors import FileError
from app.formats.json_data import decode_json
from app.project.camera_bookmarks import CameraBookmark
from app.shell.workspaces import Workspaces
from widgets.timeline.panel import TimelinePanel, VisibleRange

_MOST_PLAYERS: Final = 100
"""Greatest number of selected players that are stored."""


class PieceView(msgspec.Struct, frozen=True):
    """The user's view of a piece, stored when the piece is closed.

    Attributes
    ----------
    camera : CameraBookmark or None
        The viewport's camera; None if the viewport drew nothing.
    is_moved : bool
        Whether the user moved the camera away from the chosen view.
    players : tuple of str
        Ids of the selected players, the active one first.
    lanes : str
        State of the timeline's lanes from `TimelinePanel.save_state`; valid in the workspace named by ``workspace``.
    """

    camera: CameraBookmark | None
    is_moved: bool
    players: tuple[str, ...]
    playhead_s: Annotated[float, msgspec.Meta(ge=-1e6, le=1e6)]
    seen: VisibleRange
    workspace: str
    lanes: str


class PieceViews(QObject):
    """Stores and restores the views of pieces.

    Parameters
    ----------
    files : Files
        Files, whose signals announce opening and closing.
    """

    def __init__(
        self, session: Session, files: Files, settings: Settings, timeline: TimelinePanel, workspaces: Workspaces
    ) -> None:
        super().__init__(session)
        self._session, self._files, self._settings = session, files, settings
        self._timeline, self._workspaces = timeline, workspaces
        files.left.connect(self._keep)
        files.opened.connect(self._restore)

    def _piece(self) -> str:
        """Return the path of the open piece; empty if none is open, or a bundled one, whose view is not stored."""
        path = self._files.path or Path(self._session.project.source)
        bundled = Path(str(resource_files("resources")))
        return "" if path == Path() or not self._files.is_open or path.is_relative_to(bundled) else str(path)

    def _keep(self) -> None:
        piece, session, viewport = self._piece(), self._session, self._session.viewport
        if not piece:
            return
        view = PieceView(
            None if viewport.camera is None else viewport.camera.bookmark("-"),
            viewport.camera is not None and viewport.camera.is_moved,
            session.players[:_MOST_PLAYERS],
            session.playhead_s,
            self._timeline.seen,
            self._workspaces.current,
            self._timeline.save_state(),
        )
        self._settings.set_piece_view(piece, msgspec.json.encode(view).decode())

    def _restore(self) -> None:
        view = _view(self._settings.piece_view(self._piece()))
        session = self._session
        if view is None:
            # Players of the previous piece may have the same ids.
            session.set_players(tuple(player.id for player in session.project.players[:1]))
            return
        known = {player.id for player in session.project.players}
        players = tuple(id for id in view.players if id in known)
        if players:
            session.set_players(players)
        if view.workspace == self._workspaces.current:
            self._timeline.restore_state(view.lanes)
        session.set_playhead(view.playhead_s)
        self._timeline.show_range(view.seen)
        if view.camera is not None and session.viewport.camera is not None:
            session.viewport.camera.restore(view.camera, view.is_moved)


def _view(text: str) -> PieceView | None:
    try:
        return decode_json(text.encode("utf-8", "replace"), PieceView, "") if text else None
    except FileError:
        # The view was stored by another version: the piece opens framed.
        return None
