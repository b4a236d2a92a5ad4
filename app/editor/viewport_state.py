"""State of the viewport, shared by commands, menus and the viewport's own buttons."""

from __future__ import annotations

from typing import Literal, Protocol, get_args

from PySide6.QtCore import Signal

from app.editor.state import State
from app.project.camera_bookmarks import CameraBookmark, View

Follows = Literal["never", "close_ups", "always"]
FOLLOWS: tuple[Follows, ...] = get_args(Follows)
"""Close-ups: only from one view of a player to another."""
Shown = Literal["wireframe", "skeleton", "contacts", "names"]
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
    """The chosen view, and what is drawn in addition to the players.

    Attributes
    ----------
    follows_selection : bool
        The playhead goes to the note that is selected.
    camera : ViewportCamera or None
        The camera, for commands that mean it; the panel sets it.
    camera_follows : str
        When the camera goes to what is selected or corrected: one of `FOLLOWS`.
    bookmarks : tuple of str
        Names of the bookmarks of cameras that were kept or recalled in this piece, the last one first.

    Signals
    -------
    changed()
        Something is shown otherwise.
    viewed()
        A view was asked for, perhaps the same once more.
    framed(bool)
        The camera should frame the selected players (True) or the ensemble.
    turned()
        The camera should look from the other side.
    dollied(float)
        The camera should come nearer by so many steps of the wheel.
    """

    viewed = Signal()
    framed = Signal(bool)
    turned = Signal()
    dollied = Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self._view: View = "ensemble"
        self._shown: frozenset[Shown] = frozenset(("names",))
        self._posing = False
        self.follows_selection = True
        self.camera: ViewportCamera | None = None
        self.bookmarks: tuple[str, ...] = ()
        self.camera_follows: Follows = "close_ups"

    @property
    def view(self) -> View:
        """The view that was asked for last."""
        return self._view

    def set_view(self, view: View) -> None:
        """Choose a view."""
        self._view = view
        self.viewed.emit()
        self.changed.emit()

    def shows(self, what: Shown) -> bool:
        """Return whether it is drawn."""
        return what in self._shown

    def show(self, what: Shown, shown: bool) -> None:
        """Show or hide one of the things drawn in addition to the players."""
        after = self._shown | {what} if shown else self._shown - {what}
        if after != self._shown:
            self._shown = after
            self.changed.emit()

    @property
    def posing(self) -> bool:
        """True if the pose tool is in hand."""
        return self._posing

    def set_posing(self, posing: bool) -> None:
        """Take the pose tool, or put it down."""
        if posing != self._posing:
            self._posing = posing
            self.changed.emit()

    def use_bookmark(self, name: str) -> None:
        """Note that a bookmark was kept, renamed or recalled."""
        self.set(bookmarks=(name, *(other for other in self.bookmarks if other != name)))

    def turn(self) -> None:
        """Look from the other side."""
        self.turned.emit()

    def frame(self, selected: bool) -> None:
        """Bring the selected players, or everyone, into the picture."""
        self.framed.emit(selected)
