"""Common part of gestures on ruler, roll and lanes: a drag begins after a distance, follows the mouse, and ends as a
single undo step or without effect.
"""

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
"""Distance in pixels from which a press in a lane is a drag."""

Edit = Callable[[Project], Project]
Far = Callable[[LaneMouse, LaneMouse], bool]
"""Function of the press and the present position that returns whether it is a drag."""


class Editing(Protocol):
    """Part of the session used by gestures. A protocol, since the session is a QObject and this package is independent
    of Qt.
    """

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
    """Scales of times and values; a protocol, since lanes are widgets and this package is independent of Qt."""

    @property
    def axis(self) -> Scale: ...
    def y_px(self, value: float) -> float: ...


def snapped(grid: Grid, score: Score, tick: float, free: bool) -> int:
    """Return the tick of the nearest grid line; with ``free``, the nearest whole tick."""
    return round(tick) if free else grid.snap(score.metre_map, tick)


def moved_edge(start: int, end: int, at_start: bool, tick: int, least: int = 1) -> tuple[int, int]:
    """Return a span (start, end) with one edge moved to ``tick``, keeping a length of at least ``least``."""
    return (min(tick, end - least), end) if at_start else (start, max(tick, start + least))


def along(least_px: float) -> Far:
    """Return a test for whether the mouse has moved at least ``least_px`` pixels horizontally."""
    return lambda at, mouse: abs(mouse.x_px - at.x_px) >= least_px


def across(least_px: float) -> Far:
    """Return a test for whether the mouse has moved at least ``least_px`` pixels vertically."""
    return lambda at, mouse: abs(mouse.y_px - at.y_px) >= least_px


def either(least_px: float) -> Far:
    """Return a test for whether the mouse has moved at least ``least_px`` pixels horizontally or vertically."""
    return lambda at, mouse: max(abs(mouse.x_px - at.x_px), abs(mouse.y_px - at.y_px)) >= least_px


def together(least_px: float) -> Far:
    """Return a test for whether the horizontal and vertical movement of the mouse add up to at least ``least_px``
    pixels.
    """
    return lambda at, mouse: abs(mouse.x_px - at.x_px) + abs(mouse.y_px - at.y_px) >= least_px


class LiveEdit:
    """An undo step that is replaced at every move of a drag; each edit applies to the project before the drag.

    Parameters
    ----------
    origin : object
        Widget that makes the edit, so that it can ignore the resulting change signal.
    """

    def __init__(self, session: Editing, origin: object) -> None:
        self._session, self._origin = session, origin
        self.base = session.project
        self._ours = self.base
        self._token = object()
        self._name: Message | None = None

    def edit(self, name: Message, edit: Edit) -> bool:
        """Replace the undo step by an edit of the project before the drag, and return whether the edit succeeded.

        After a failed edit, the last successful one remains. If the step was undone during the drag, the drag has no
        further effect.
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
        """Edit as in `edit`, but show the error to the user if it fails."""
        if not self._session.attempt(name, lambda _: edit(self.base), self._token, self._origin):
            return False
        self._name, self._ours = name, self._session.project
        return True

    def end(self) -> None:
        """End the gesture: later edits make an undo step of their own."""
        self._session.document.end_gesture()

    def take_back(self) -> None:
        """Undo the gesture's edits and end it."""
        if self._name is not None and self._session.project is self._ours and self._ours is not self.base:
            self._session.apply(self._name, self.base, self._token, self._origin)
        self.end()


class MouseGesture:
    """A mouse press and the following drag.

    Parameters
    ----------
    at : LaneMouse
        Position of the press.
    far : Far, optional
        Test for the start of the drag; by default the first move starts it.

    Attributes
    ----------
    began : bool
        Whether the press has become a drag.
    """

    def __init__(self, at: LaneMouse, far: Far | None = None) -> None:
        self.at = at
        self._far = far
        self.began = False

    def drag(self, mouse: LaneMouse) -> None:
        """React to a mouse move with the button down: begin the drag once it is far enough, then follow it."""
        self.began = self.began or self._far is None or self._far(self.at, mouse)
        if self.began:
            self.follow(mouse)

    def release(self, mouse: LaneMouse) -> None:
        """React to the release of the mouse button: finish the drag if it began, else treat it as a click."""
        if self.began:
            self.finish(mouse)
        else:
            self.click(mouse)

    def follow(self, mouse: LaneMouse) -> None:
        """Follow the mouse during a drag; every gesture overrides this."""

    def finish(self, mouse: LaneMouse) -> None:
        """End the drag with the button released at ``mouse``; gestures with a final effect override this."""

    def click(self, mouse: LaneMouse) -> None:
        """Handle a press and release without a drag."""

    def cancel(self) -> None:
        """Undo the gesture's edits and end it."""


class EditGesture(MouseGesture):
    """A drag that edits in a single undo step.

    Parameters
    ----------
    step : LiveEdit
    at, far
        See `MouseGesture`.
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
    """Selection by a rectangle drawn from the press to the mouse; it stays over the contents when they scroll.

    Parameters
    ----------
    take : callable
        Selects the contents of a rectangle between the press and a position.

    Attributes
    ----------
    box : PixelRect or None
        Rectangle during the drag; else None.
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
