"""Contents of the takes lane: a row for each take, its spans used in the part, and the drag that chooses a span."""

from __future__ import annotations

from typing import Protocol

from app.editor.design_tokens import Tokens
from app.editor.selection import Selection
from app.errors import Message
from app.project.edit.placed_takes import BEFORE
from app.project.edit.takes import comp, comp_whole, comp_with, move_take, rename_take
from app.project.model import CompSpan, PlayerTakes, Project
from app.project.performers import Player
from app.score.metre_map import Metre
from app.score.take import Take
from app.score.tempo import TempoMap
from widgets.timeline.model.gestures import DRAG_PX, Editing, MouseGesture, along
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.takes.take_rows import TakeRow, comp_of, edges, pitch_range, rows_of, span_at
from widgets.timeline.model.visible_time import Limited

EDGE_PX = 4.0
"""Distance in pixels within which the boundary of two takes is grabbed."""


class Recorded(Editing, Protocol):
    """Part of the session that takes use; a protocol, since the session is a QObject."""

    @property
    def player(self) -> Player | None: ...
    @property
    def tokens(self) -> Tokens: ...
    def colour(self, player: Player) -> str: ...


class Swipe(MouseGesture):
    """Drag over a take's row to use that span of it, or drag of the boundary between two used spans.

    At a boundary, ``edge`` holds the two spans, and the take is that of the span that grows.
    """

    def __init__(self, at: LaneMouse, take_id: str, tick: int, edge: tuple[CompSpan, CompSpan] | None = None) -> None:
        super().__init__(at, along(DRAG_PX))
        self.take_id, self.edge = take_id, edge
        self.start_tick = self.end_tick = tick

    def span(self) -> CompSpan | None:
        """Return the span that would be used if the drag ended now."""
        start, end = sorted((self.start_tick, self.end_tick))
        if not self.began or start == end:
            return None
        if self.edge is None:
            return CompSpan(start, end, self.take_id)
        left, right = self.edge
        return CompSpan(start, end, (left if self.end_tick > self.start_tick else right).take_id)

    def follow(self, mouse: LaneMouse) -> None:
        """Continue the drag to a position; a boundary cannot pass the next one."""
        tick = mouse.snapped_tick
        if self.edge is not None:
            tick = min(max(tick, self.edge[0].start_tick), self.edge[1].end_tick)
        self.end_tick = max(tick, 0)


class TakesModel:
    """The takes of the active player for drawing, the comp (the part assembled from them), and the current drag."""

    def __init__(self, session: Recorded, axis: Limited) -> None:
        self._session, self._axis = session, axis
        self.rows: tuple[TakeRow, ...] = ()
        self.comp: tuple[CompSpan, ...] = ()
        self.pitches = (60, 72)
        self.swipe: Swipe | None = None
        self._sources: tuple[PlayerTakes | None, TempoMap, tuple[Metre, ...]] | None = None

    def refresh(self) -> bool:
        """Read the active player's takes again, and return whether they changed."""
        player, project = self._session.player, self._session.project
        recorded = project.takes.get(player.id) if player is not None else None
        sources = (recorded, project.score.tempo_map, project.score.metres)
        known = self._sources
        if known is not None and all(one is other for one, other in zip(sources, known, strict=True)):
            return False
        self._sources = sources
        self.rows = rows_of(project, player.id) if player is not None else ()
        self.comp = comp_of(project, player.id) if player is not None and self.rows else ()
        self.pitches = pitch_range(self.rows)
        return True

    def colour_of(self, take_id: str) -> str:
        """Return a take's colour, by default the player's; empty for the notes before the first take."""
        player = self._session.player
        take = self.take_of(take_id)
        if take is None or player is None:
            return self._session.tokens.text_dim
        return take.colour or self._session.colour(player)

    def take_of(self, take_id: str) -> Take | None:
        """Return a take of the active player."""
        return next((row.take for row in self.rows if row.take is not None and row.take.id == take_id), None)

    def number_of(self, take_id: str) -> int | None:
        """Return the row index of a take."""
        return next((number for number, row in enumerate(self.rows) if row.take_id == take_id), None)

    def swiped(self) -> CompSpan | None:
        """Return the span that would be used if the drag ended now; None without a drag."""
        return self.swipe.span() if self.swipe is not None else None

    def shown_comp(self) -> tuple[CompSpan, ...]:
        """Return the comp (the part assembled from takes) as it would be if the drag ended now."""
        swiped = self.swiped()
        if swiped is None:
            return self.comp
        return comp_with(self.comp, swiped.start_tick, swiped.end_tick, swiped.take_id)

    def outlined(self) -> CompSpan | None:
        """Return the dragged span, else the selected one; None for neither."""
        selection = self._session.selection
        if self.swipe is not None and self.swipe.began:
            return self.swiped()
        if selection.span is None or selection.take is None:
            return None
        return CompSpan(*selection.span, selection.take)

    def shown_spans(self, take_id: str) -> tuple[CompSpan, ...]:
        """Return the spans in which the part uses a take; for the notes before the first take, the gaps of the comp."""
        spans = self.shown_comp()
        if take_id != BEFORE:
            return tuple(span for span in spans if span.take_id == take_id)
        ends = [0, *(tick for span in spans for tick in (span.start_tick, span.end_tick)), self.end_tick()]
        return tuple(
            CompSpan(start, end, BEFORE) for start, end in zip(ends[::2], ends[1::2], strict=True) if start < end
        )

    def end_tick(self) -> int:
        """Return the tick at the right end of the visible range."""
        return max(round(self._session.project.score.tempo_map.ticks(self._axis.limits_s[1])), 1)

    def span_at(self, tick: float) -> CompSpan:
        """Return the used span or gap of the part at a tick."""
        return span_at(self.comp, max(tick, 0.0), self.end_tick())

    def edge_at(self, mouse: LaneMouse, row: TakeRow | None) -> tuple[CompSpan, CompSpan] | None:
        """Return the two spans on either side of a boundary near the mouse; None if there is none.

        In the strip above the takes (``row`` None) all boundaries count, in a take's row only those of its spans.
        """
        clock = self._session.project.score.tempo_map
        near: dict[float, tuple[CompSpan, CompSpan]] = {}
        for left, right in edges(self.comp, self.end_tick()):
            far_px = abs(self._axis.x_px(clock.seconds(float(left.end_tick))) - mouse.x_px)
            if far_px <= EDGE_PX and (row is None or row.take_id in (left.take_id, right.take_id)):
                near[far_px] = left, right
        return near[min(near)] if near else None

    def current(self) -> str | None:
        """Return the id of the selected take, else of the one used in the selected span."""
        selection = self._session.selection
        if selection.take is None and selection.span is not None:
            return self.span_at(float(selection.span[0])).take_id
        return selection.take

    def beside(self, by: int) -> str:
        """Return the id of the take above (``by`` -1) or below (1) the current one."""
        current = self.current()
        number = self.number_of(current) if current is not None else None
        return self.rows[min(max((number if number is not None else -by) + by, 0), len(self.rows) - 1)].take_id

    def span_beside(self, by: int, playhead_s: float) -> CompSpan | None:
        """Return the span before (-1) or after (1) the selected one; without one, the span at the playhead."""
        span = self._session.selection.span
        if span is None:
            return self.span_at(self._session.project.score.tempo_map.ticks(playhead_s))
        if by > 0 and span[1] < self.end_tick():
            return self.span_at(float(span[1]))
        return self.span_at(float(span[0] - 1)) if by < 0 and span[0] > 0 else None

    # Edits

    def take_whole(self, take_id: str) -> None:
        """Use all of a take in the part."""
        player = self._session.player
        if player is not None:
            self._session.attempt(
                self._named("edit.comp_whole", take_id), lambda project: comp_whole(project, player.id, take_id)
            )

    def rename(self, take_id: str, name: str) -> None:
        """Rename a take of the active player, as one undoable step."""
        player = self._session.player
        if player is not None:
            self._session.attempt(
                Message("edit.rename_take", {"take": name}),
                lambda project: rename_take(project, player.id, take_id, name),
            )

    def move_lane(self, take_id: str, before: int) -> None:
        """Move a take in the order of rows, before the row with the index ``before``."""
        player, take = self._session.player, self.take_of(take_id)
        if player is not None and take is not None:
            self._session.attempt(
                Message("edit.move_take", {"take": take.name}),
                lambda project: move_take(project, player.id, take_id, before - 1),
            )

    def take_span(self, take_id: str, start_tick: int, end_tick: int) -> bool:
        """Use a span of a take in the part, select it, and return whether that succeeded."""
        player = self._session.player
        if player is None:
            return False

        def edit(project: Project) -> Project:
            return comp(project, player.id, take_id, start_tick, end_tick)

        done = self._session.attempt(self._named("edit.comp", take_id), edit)
        if done:
            self._session.select(Selection(span=(start_tick, end_tick), take=take_id))
        return done

    def _named(self, id: str, take_id: str) -> Message:
        take = self.take_of(take_id)
        return Message("edit.comp_before") if take is None else Message(id, {"take": take.name})
