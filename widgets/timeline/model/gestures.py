"""Common part of every press on ruler, roll and lanes: a gesture begins once the mouse has gone far enough, follows it,
and ends in one step of undo, or leaves nothing behind."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from app.editor.selection import Selection
from app.errors import AppError, Message
from app.performance.ensemble import Performance
from app.project.model import Project
from app.project.snap_grid import Grid
from app.project.undoable_document import Document
from app.score.model import Score
from widgets.timeline.model.lane_mouse import LaneMouse, PixelRect, spanned
from widgets.timeline.model.visible_time import Scale

DRAG_PX = 3.0
"""The mouse moves this far before a press in a lane becomes a drag."""

Edit = Callable[[Project], Project]
Far = Callable[[LaneMouse, LaneMouse], bool]
"""Test of the distance from the press at which it becomes a drag."""


class Editing(Protocol):
    """Part of the session that gestures use; a protocol, since the session is a QObject and the model knows no Qt."""

    document: Document

    @property
    def project(self) -> Project: ...
    @property
    def performance(self) -> Performance: ...
    @property
    def selection(self) -> Selection: ...
    @property
    def grid(self) -> Grid: ...
    def select(self, selection: Selection) -> None: ...
    def apply(
        self, name: Message, project: Project, gesture: object | None = None, origin: object | None = None
    ) -> bool: ...
    def attempt(
        self, name: Message, edit: Edit, gesture: object | None = None, origin: object | None = None
    ) -> bool: ...


class Plane(Protocol):
    """Scales of times and values; a protocol, since lanes are widgets and the model knows no Qt."""

    @property
    def axis(self) -> Scale: ...
    def y_px(self, value: float) -> float: ...


def snapped(grid: Grid, score: Score, tick: float, free: bool) -> int:
    """The nearest line of the grid; the nearest tick if snapping is off."""
    return round(tick) if free else grid.snap(score.metre_map, tick)


def moved_edge(start: int, end: int, at_start: bool, tick: int, least: int = 1) -> tuple[int, int]:
    """A span with one of its edges at a place, no nearer to the other than ``least``."""
    return (min(tick, end - least), end) if at_start else (start, max(tick, start + least))


def along(least_px: float) -> Far:
    """Return a test for drags that have gone at least so many pixels to the left or right."""
    return lambda at, mouse: abs(mouse.x_px - at.x_px) >= least_px


def across(least_px: float) -> Far:
    """Return a test for drags that have gone at least so many pixels up or down."""
    return lambda at, mouse: abs(mouse.y_px - at.y_px) >= least_px


def either(least_px: float) -> Far:
    """Far in one of both directions."""
    return lambda at, mouse: max(abs(mouse.x_px - at.x_px), abs(mouse.y_px - at.y_px)) >= least_px


def together(least_px: float) -> Far:
    """Far in the sum of both directions."""
    return lambda at, mouse: abs(mouse.x_px - at.x_px) + abs(mouse.y_px - at.y_px) >= least_px


class LiveEdit:
    """One step of undo, repeated during a drag, each time from the project at its start.

    Parameters
    ----------
    origin : object
        Who edits; it skips its own echo.
    """

    def __init__(self, session: Editing, origin: object) -> None:
        self._session, self._origin = session, origin
        self.base = session.project
        self._ours = self.base
        self._token = object()
        self._name: Message | None = None

    def edit(self, name: Message, edit: Edit) -> bool:
        """Show what an edit makes of the project as it was at the press; whether it could be done.

        A place that cannot be is passed over: the last one that could stays. Where the step was taken back in the
        middle of the drag, what it began with is gone.
        """
        if self._session.project is not self._ours:
            return False
        try:
            project = edit(self.base)
        except AppError:
            return False
        if not self._session.apply(name, project, self._token, self._origin):
            return False
        self._name, self._ours = name, self._session.project
        return True

    def attempt(self, name: Message, edit: Edit) -> bool:
        """Edit as `edit` does, and show the user why if it could not be done."""
        if not self._session.attempt(name, lambda _: edit(self.base), self._token, self._origin):
            return False
        self._name, self._ours = name, self._session.project
        return True

    def end(self) -> None:
        """End the gesture: further edits are another step."""
        self._session.document.end_gesture()

    def take_back(self) -> None:
        """Undo the gesture's edits and end it."""
        if self._name is not None and self._session.project is self._ours and self._ours is not self.base:
            self._session.apply(self._name, self.base, self._token, self._origin)
        self.end()


class MouseGesture:
    """A mouse press and the drag that follows it.

    Parameters
    ----------
    at : LaneMouse
        The press.
    far : Far, optional
        Without it the first move is a drag already.

    Attributes
    ----------
    began : bool
        Whether the press is a drag by now.
    """

    def __init__(self, at: LaneMouse, far: Far | None = None) -> None:
        self.at = at
        self._far = far
        self.began = False

    def drag(self, mouse: LaneMouse) -> None:
        """The mouse moved with the button down."""
        self.began = self.began or self._far is None or self._far(self.at, mouse)
        if self.began:
            self.follow(mouse)

    def release(self, mouse: LaneMouse) -> None:
        """The button went up."""
        if self.began:
            self.finish(mouse)
        else:
            self.click(mouse)

    def follow(self, mouse: LaneMouse) -> None:
        """Do what the drag means here."""

    def finish(self, mouse: LaneMouse) -> None:
        """The drag ended here."""

    def click(self, mouse: LaneMouse) -> None:
        """Handle a press and release without a drag."""

    def cancel(self) -> None:
        """Undo the gesture's edits and end it."""


class EditGesture(MouseGesture):
    """A drag that edits, in one step of undo.

    Parameters
    ----------
    step : LiveEdit
    at, far
        As of `MouseGesture`.
    """

    def __init__(self, step: LiveEdit, at: LaneMouse, far: Far | None = None) -> None:
        super().__init__(at, far)
        self._step = step

    def finish(self, mouse: LaneMouse) -> None:
        self._step.end()

    def cancel(self) -> None:
        if self.began:
            self._step.take_back()


class Band(MouseGesture):
    """A rubber band: the box from the press to the mouse, which stays with the picture when that scrolls.

    Parameters
    ----------
    take : callable
        Selects what is in a box between the press and a place.

    Attributes
    ----------
    box : PixelRect or None
        While it is drawn.
    """

    def __init__(self, plane: Plane, at: LaneMouse, far: Far, take: Callable[[PixelRect, LaneMouse], None]) -> None:
        super().__init__(at, far)
        self._plane, self._take = plane, take
        self.box: PixelRect | None = None

    def follow(self, mouse: LaneMouse) -> None:
        corner = self._plane.axis.x_px(self.at.time_s), self._plane.y_px(self.at.value)
        self.box = spanned(*corner, mouse.x_px, mouse.y_px)
        self._take(self.box, mouse)

    def finish(self, mouse: LaneMouse) -> None:
        self.box = None

    def cancel(self) -> None:
        self.box = None
