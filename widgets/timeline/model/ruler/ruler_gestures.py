"""Gestures on the ruler: drags of the playhead, a span, an edge of the loop or punch range, or a mark."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from app.editor.selection import Selection
from app.errors import Message
from app.project.edit import tempo as tempo_edit
from widgets.timeline.model.gestures import Editing, Far, LiveEdit, MouseGesture, snapped
from widgets.timeline.model.lane_mouse import LaneMouse

Place = TypeVar("Place", int, float)


class SelectSpan(MouseGesture):
    """Drag that selects the time span from the press to the mouse; a press without a drag deselects."""

    def __init__(self, session: Editing, at: LaneMouse, far: Far, tick_at: Callable[[LaneMouse, bool], int]) -> None:
        super().__init__(at, far)
        self._session, self._tick_at = session, tick_at
        self._before = session.selection

    def follow(self, mouse: LaneMouse) -> None:
        start, end = sorted((self._tick_at(self.at, mouse.alt), self._tick_at(mouse, mouse.alt)))
        self._session.select(Selection(span=(start, end) if end > start else None))

    def click(self, mouse: LaneMouse) -> None:
        drop_span(self._session)

    def cancel(self) -> None:
        self._session.select(self._before)


class Scrub(MouseGesture):
    """Drag of the playhead; Escape returns it to its former place."""

    def __init__(
        self, session: Editing, at: LaneMouse, far: Far, seek: Callable[[float], None], before_s: float
    ) -> None:
        super().__init__(at, far)
        self._session, self._seek, self._before_s = session, seek, before_s

    def follow(self, mouse: LaneMouse) -> None:
        self._seek(mouse.time_s)

    def click(self, mouse: LaneMouse) -> None:
        drop_span(self._session)

    def cancel(self) -> None:
        self._seek(self._before_s)


class HoldEdge(MouseGesture):
    """Drag of one edge of a span, such as the loop; it stops at the other edge.

    Parameters
    ----------
    span : callable
        Returns the present span; None if there is none.
    put : callable
        Sets the span.
    place : callable
        Converts a tick to the span's unit.
    """

    def __init__(
        self,
        at: LaneMouse,
        far: Far,
        at_start: bool,
        span: Callable[[], tuple[Place, Place] | None],
        put: Callable[[tuple[Place, Place]], object],
        place: Callable[[int], Place],
    ) -> None:
        super().__init__(at, far)
        before = span()

        def move(tick: int) -> None:
            now = span()
            if now is not None:
                moved = (place(tick), now[1]) if at_start else (now[0], place(tick))
                if moved[1] > moved[0]:
                    put(moved)

        self._move = move
        self._restore: Callable[[], object] = lambda: put(before) if before is not None else None

    def follow(self, mouse: LaneMouse) -> None:
        self._move(mouse.snapped_tick)

    def cancel(self) -> None:
        self._restore()


class HoldMark(MouseGesture):
    """Drag of a tempo mark along the grid, or of a metre mark along the bar lines of the piece without that mark; the
    first marks of the piece are fixed.

    Attributes
    ----------
    chosen : (str, int)
        Kind and present tick of the mark.
    """

    def __init__(
        self,
        session: Editing,
        at: LaneMouse,
        far: Far,
        mark: tuple[str, int],
        origin: object,
        refuse: Callable[[], None],
    ) -> None:
        super().__init__(at, far)
        self._session, self._mark, self._refuse = session, mark, refuse
        self._step = LiveEdit(session, origin)
        self.chosen = mark

    def follow(self, mouse: LaneMouse) -> None:
        base, (kind, start) = self._step.base, self._mark
        if start <= (base.score.pickup_ticks if kind == "metre" else 0):
            self._refuse()
            return
        to = self._target(mouse)
        if kind == "metre" and to <= base.score.pickup_ticks:
            return
        move = tempo_edit.move_metre if kind == "metre" else tempo_edit.move_tempo
        name = Message("edit.move_tempo") if kind == "tempo" else Message("edit.move_metre")
        if self._step.attempt(name, lambda project: move(project, start, to)):
            self.chosen = (kind, to)

    def _target(self, mouse: LaneMouse) -> int:
        """Return the tick under the mouse in the piece before the drag, since a moved tempo would shift it."""
        base, (kind, start) = self._step.base, self._mark
        if kind == "tempo":
            tick = base.score.tempo_map.ticks(mouse.time_s)
            return max(snapped(self._session.grid, base.score, tick, mouse.alt), 1)
        score = tempo_edit.remove_metre(base, start).score
        tick = score.tempo_map.ticks(mouse.time_s)
        if mouse.alt:
            return max(round(tick), base.score.pickup_ticks)
        metre_map = score.metre_map
        bar = metre_map.bar_of_tick(max(round(tick), 0))
        bars = metre_map.span_of_bar(bar)
        return max(min(bars, key=lambda place: abs(place - tick)), base.score.pickup_ticks)

    def release(self, mouse: LaneMouse) -> None:
        self._step.end()

    def cancel(self) -> None:
        self._step.take_back()
        self.chosen = self._mark


def drop_span(session: Editing) -> None:
    """Clear the selected time span; selected notes and events stay selected."""
    if session.selection.span is not None:
        session.select(Selection(session.selection.notes, session.selection.events))
