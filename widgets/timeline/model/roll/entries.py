"""Arrows for cues in the piano roll, from the note of the player who gives the cue to that of the player who receives
it, and drags of their ends.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Mapping
from typing import Final, Literal, NamedTuple, Protocol, TypeAlias

from app.editor.edit_names import edit_of_events
from app.editor.selection import EventKey, Selection
from app.errors import Message
from app.plan.model import PlayerPlan
from app.project.edit.corrections import Edited
from app.project.edit.cue_givers import hand_over, set_giver
from app.project.model import Project
from app.project.performers import Player
from widgets.timeline.model.gestures import MouseGesture, Plane, either, snapped
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.roll.note_table import NoteTable
from widgets.timeline.model.roll.shown_notes import RollModel, RollSession

End: TypeAlias = Literal["tail", "head"]
HEAD_PX: Final = 9.0
"""Length in pixels of the draggable head before its note."""
REACH_PX: Final = 6.0
"""Distance in pixels within which a dragged end snaps to a note's start."""
NOTE_REACH_PX: Final = 36.0
"""Distance in pixels within which the tail snaps to a player's row."""
ROW_REACH_PX: Final = 28.0
"""Distance in pixels within which the tail snaps to the row of the cue's giver."""
FAR_PX: Final = 4.0


class EntryArrow(NamedTuple):
    """Arrow from the preparatory beat of the player who gives a cue to the note of the player who receives it.

    ``from_pitch`` and ``to_pitch`` are the pitches of the giver's and the receiver's first note there, ``to_tick`` is
    the onset of the receiver's.
    """

    giver_id: str
    taker_id: str
    from_s: float
    from_pitch: int
    to_s: float
    to_pitch: int
    cue_id: str = ""
    to_tick: int = 0


def entry_arrows(project: Project, plans: Mapping[str, PlayerPlan], player_id: str) -> tuple[EntryArrow, ...]:
    """Return the arrows of the cues that a player gives or receives."""
    arrows = []
    known = {player.id for player in project.players}
    for plan in plans.values():
        for cue in plan.cues:
            if player_id != cue.player_id and player_id not in cue.takers:
                continue
            takers = cue.takers if player_id == cue.player_id else (player_id,)
            begins = _note_at(project, cue.player_id, cue.end_tick) if cue.player_id in known else None
            for taker in takers:
                entry = _note_at(project, taker, cue.end_tick) if taker in known else None
                if begins is not None and entry is not None:
                    at_s = project.score.tempo_map.seconds(float(entry[0]))
                    arrows.append(
                        EntryArrow(cue.player_id, taker, cue.peak_s, begins[1], at_s, entry[1], cue.id, entry[0])
                    )
    return tuple(arrows)


def _note_at(project: Project, player_id: str, tick: int) -> tuple[int, int] | None:
    """Return onset tick and pitch of the player's first note from a tick on, else of the last one; None without
    notes."""
    notes = project.part(project.player(player_id)).notes
    if not notes:
        return None
    note = notes[min(bisect_left(notes, tick, key=lambda note: note.onset_tick), len(notes) - 1)]
    return note.onset_tick, note.pitch


class EntryPlane(Plane, Protocol):
    """The piano roll in which an arrow is dragged; a protocol, since it is a widget."""

    @property
    def session(self) -> RollSession: ...
    @property
    def plans(self) -> Mapping[str, PlayerPlan]: ...
    @property
    def model(self) -> RollModel: ...


def end_at(plane: Plane, arrows: Iterable[EntryArrow], mouse: LaneMouse) -> tuple[EntryArrow, End] | None:
    """Return the arrow whose tail or head is under the mouse, and which of them; None if there is none."""
    for arrow in arrows:
        x_px, y_px = plane.axis.x_px(arrow.to_s), plane.y_px(arrow.to_pitch + 0.5)
        if -HEAD_PX - 2.0 <= mouse.x_px - x_px <= 1.0 and abs(mouse.y_px - y_px) <= REACH_PX:
            return arrow, "head"
    for arrow in arrows:
        x_px, y_px = plane.axis.x_px(arrow.from_s), plane.y_px(arrow.from_pitch + 0.5)
        if max(abs(mouse.x_px - x_px), abs(mouse.y_px - y_px)) <= REACH_PX:
            return arrow, "tail"
    return None


class EntryDrag(MouseGesture):
    """Drag of an arrow's tail to another giver or time, or of its head to another player's note.

    The piece changes only when the button is released; before that, `shown` is the resulting arrow.

    Attributes
    ----------
    end : str
        Dragged end, tail or head.
    arrow, shown : EntryArrow
        Arrow before and after the drag.
    meant : bool
        Whether releasing the mouse now would change the cue.
    """

    def __init__(self, plane: EntryPlane, mouse: LaneMouse, arrow: EntryArrow, end: End) -> None:
        super().__init__(mouse, either(FAR_PX))
        self.end: End = end
        self.shown, self.meant = arrow, False
        self._plane, self.arrow = plane, arrow
        self._session = plane.session
        self._base = plane.session.project
        self._peak_tick: int | None = None

    def follow(self, mouse: LaneMouse) -> None:
        self.shown = self._tail(mouse) if self.end == "tail" else self._head(mouse)
        arrow = self.arrow
        self.meant = self._peak_tick is not None or (
            (self.shown.giver_id, self.shown.taker_id, self.shown.to_tick)
            != (arrow.giver_id, arrow.taker_id, arrow.to_tick)
        )

    def _tail(self, mouse: LaneMouse) -> EntryArrow:
        """Return the arrow with the tail in the row of the nearest giver; a horizontal move changes the preparatory
        beat.
        """
        arrow, score = self.arrow, self._base.score
        self._peak_tick = None
        if abs(mouse.x_px - self.at.x_px) >= 2 * FAR_PX:
            tick = snapped(self._session.grid, score, mouse.tick, mouse.alt)
            if tick < self._entry_tick():
                self._peak_tick = tick
        from_s = arrow.from_s if self._peak_tick is None else score.tempo_map.seconds(float(self._peak_tick))
        giver = self._nearest_giver(mouse)
        if giver is None:
            return arrow._replace(from_s=from_s, from_pitch=int(mouse.value // 1))
        if giver[0] == arrow.taker_id:
            # The two notes exchange their roles.
            own = _note_at(self._base, arrow.giver_id, self._entry_tick())
            at_s = arrow.to_s if own is None else score.tempo_map.seconds(float(own[0]))
            arrow = arrow._replace(taker_id=arrow.giver_id, to_s=at_s, to_pitch=arrow.from_pitch)
        return arrow._replace(giver_id=giver[0], from_s=from_s, from_pitch=giver[1])

    def _nearest_giver(self, mouse: LaneMouse) -> tuple[str, int] | None:
        """Return the id and pitch of the player whose row is nearest to the mouse."""
        found: list[tuple[float, bool, str, int]] = []
        for player in self._base.players:
            note = _note_at(self._base, player.id, self._entry_tick())
            if note is not None:
                away_px = abs(self._plane.y_px(note[1] + 0.5) - mouse.y_px)
                same_row = note[1] == self.arrow.from_pitch and player.id != self.arrow.giver_id
                found.append((away_px, same_row, player.id, note[1]))
        best = min(found, default=None)
        return None if best is None or best[0] > ROW_REACH_PX else best[2:]

    def _head(self, mouse: LaneMouse) -> EntryArrow:
        """Return the arrow with the head at the start of the nearest note of another player."""
        arrow, project = self.arrow, self._base
        own = {one.id for one in project.played_by(project.player(arrow.giver_id))}
        found: list[tuple[float, bool, Player, NoteTable, int]] = []
        for player in project.players:
            if player.id in own:
                continue
            table = self._plane.model.table(player)
            reach_s = NOTE_REACH_PX / self._plane.axis.px_per_s
            first = int(table.onset_s.searchsorted(mouse.time_s - reach_s))
            for place in range(first, int(table.onset_s.searchsorted(mouse.time_s + reach_s))):
                x_px = self._plane.axis.x_px(float(table.onset_s[place]))
                y_px = self._plane.y_px(float(table.pitch[place]) + 0.5)
                away_px = max(abs(x_px - mouse.x_px), abs(y_px - mouse.y_px))
                found.append((away_px, player.id != arrow.taker_id, player, table, place))
        best = min(found, key=lambda one: one[:2], default=None)
        if best is None or best[0] > NOTE_REACH_PX:
            return arrow._replace(to_s=mouse.time_s, to_pitch=int(mouse.value // 1))
        _, _, player, table, place = best
        return arrow._replace(
            taker_id=player.id,
            to_s=float(table.onset_s[place]),
            to_pitch=int(table.pitch[place]),
            to_tick=int(table.onset_tick[place]),
        )

    def _entry_tick(self) -> int:
        """Return the tick of the cue's entry; the receiver's own note may come later."""
        plan = self._plane.plans.get(self.arrow.giver_id)
        cues = plan.cues if plan is not None else ()
        return next((cue.end_tick for cue in cues if cue.id == self.arrow.cue_id), self.arrow.to_tick)

    def finish(self, mouse: LaneMouse) -> None:
        arrow, shown = self.arrow, self.shown
        plan = self._plane.plans.get(arrow.giver_id)
        if plan is None or not self.meant or self._session.project is not self._base:
            return
        entry_tick = self._entry_tick() if shown.to_tick == arrow.to_tick else shown.to_tick
        ids: list[str] = []

        def edit(project: Project) -> Project:
            edited: Edited
            if self.end == "tail":
                edited = set_giver(project, plan, arrow.cue_id, shown.giver_id, self._peak_tick)
            else:
                edited = hand_over(project, plan, arrow.cue_id, arrow.taker_id, shown.taker_id, entry_tick)
            ids[:] = edited.event_ids
            return edited.project

        if self._session.attempt(self._named(shown), edit):
            self._session.select(Selection(events=frozenset(EventKey(shown.giver_id, event_id) for event_id in ids)))

    def _named(self, shown: EntryArrow) -> Message:
        arrow, project = self.arrow, self._base
        if shown.giver_id != arrow.giver_id:
            return Message("edit.set_giver", {"player": project.player(shown.giver_id).name})
        if shown.taker_id != arrow.taker_id:
            return Message("edit.set_taker", {"player": project.player(shown.taker_id).name})
        name = "edit.resize_events" if self.end == "tail" else "edit.move_events"
        return edit_of_events(self._session, name, (EventKey(arrow.giver_id, arrow.cue_id),))

    def cancel(self) -> None:
        self.shown, self.meant = self.arrow, False
