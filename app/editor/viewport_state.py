"""State of the viewport, shared by commands, menus and the viewport's buttons."""

from __future__ import annotations

from typing import Literal, Protocol, get_args

from PySide6.QtCore import Signal

from app.editor.state import State
from app.project.camera_bookmarks import CameraBookmark, View

Follows = Literal["never", "close_ups", "always"]
FOLLOWS: tuple[Follows, ...] = get_args(Follows)
"""Choices for `Settings.camera_follows`; "close_ups" means only between close-ups of players."""
Shown = Literal["wireframe", "skeleton", "contacts", "names", "props"]
SHOWN: tuple[Shown, ...] = get_args(Shown)


class ViewportCamera(Protocol):
    """Interface of the viewport's camera, which keeps widgets out of commands: see `ViewportState.camera`."""

    def bookmark(self, name: str) -> CameraBookmark: ...
    @property
    def is_moved(self) -> bool: ...
    def recall(self, bookmark: CameraBookmark) -> None: ...
    def restore(self, bookmark: CameraBookmark, is_moved: bool) -> None: ...
    def ask_name(self, bookmark: CameraBookmark) -> None: ...


class ViewportState(State):
    """The chosen camera view, and the optional items that are drawn.

    Attributes
    ----------
    follows_selection : bool
        Whether the playhead moves to selected notes.
    camera : ViewportCamera or None
        The viewport's camera, for commands; set by the viewport.
    camera_follows : str
        When the camera moves by itself to selected or corrected notes and events: one of `FOLLOWS`.
    bookmarks : tuple of str
        Names of camera bookmarks used in this piece, the latest first.

    Signals
    -------
    changed()
        A display option has changed.
    viewed()
        A camera view was requested, possibly the present one again.
    framed(bool)
        Request to frame the selected players (True) or the ensemble (False).
    turned()
        Request to move the camera to the opposite side.
    dollied(float)
        Request to move the camera nearer by a number of wheel steps.
    """

    viewed = Signal()
    framed = Signal(bool)
    turned = Signal()
    dollied = Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self._view: View = "ensemble"
        self._shown: frozenset[Shown] = frozenset(("names", "props"))
        self._posing = False
        self.follows_selection = True
        self.camera: ViewportCamera | None = None
        self.bookmarks: tuple[str, ...] = ()
        self.camera_follows: Follows = "close_ups"

    @property
    def view(self) -> View:
        """The camera view that was requested last, such as the front."""
        return self._view

    def set_view(self, view: View) -> None:
        """Choose a named camera view, such as the front; the 3D view moves there."""
        self._view = view
        self.viewed.emit()
        self.changed.emit()

    def shows(self, what: Shown) -> bool:
        """Return whether an optional item (such as names or skeletons) is drawn in the 3D view."""
        return what in self._shown

    def show(self, what: Shown, shown: bool) -> None:
        """Show or hide an optional item (such as names or skeletons) in the 3D view."""
        after = self._shown | {what} if shown else self._shown - {what}
        if after != self._shown:
            self._shown = after
            self.changed.emit()

    @property
    def posing(self) -> bool:
        """Return whether the tool that drags poses is active."""
        return self._posing

    def set_posing(self, posing: bool) -> None:
        """Activate or deactivate the tool that drags poses in the 3D view."""
        if posing != self._posing:
            self._posing = posing
            self.changed.emit()

    def use_bookmark(self, name: str) -> None:
        """Put a camera bookmark first in `bookmarks`, since it was stored, renamed or recalled."""
        self.set(bookmarks=(name, *(other for other in self.bookmarks if other != name)))

    def turn(self) -> None:
        """Move the camera to the opposite side."""
        self.turned.emit()

    def frame(self, selected: bool) -> None:
        """Move the camera so that the selected players, or everyone, fill the picture."""
        self.framed.emit(selected)
