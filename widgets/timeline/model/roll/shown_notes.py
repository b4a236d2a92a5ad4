"""Notes of the piano roll (of the active and the other players), and hit testing."""

from __future__ import annotations

from operator import is_
from typing import Protocol

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.editor.design_tokens import Tokens
from app.editor.selection import Selection
from app.editor.timeline_view import Ghosts
from app.plan.model import Problem
from app.project.model import Project
from app.project.performers import Player
from app.project.snap_grid import Grid
from app.score.model import Note, Score
from widgets.timeline.model.gestures import Editing
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.roll.note_table import Behind, NoteTable, TimedNotes
from widgets.timeline.model.visible_time import Scale

EDGE_PX = 6.0
"""Distance in pixels from a note's end within which the end is grabbed."""
SLACK_PX = 3.0
NEAR_PX = 7.0
"""Distance in pixels within which a click beside a note is on it, since rows are thin."""
LEAST_ROWS, MOST_ROWS = 10.0, 128.0
USUAL_ROWS = 30.0
LEGIBLE_ROW_PX = 9.0
"""Height in pixels of a row in which a note is 8 pixels high."""
AIR_ROWS = 4.0
"""Number of empty rows around fitted notes."""

NO_GHOSTS = Behind((), ())


class RollSession(Editing, Protocol):
    """Part of the session that the roll uses; a protocol for the reason given at `Editing`."""

    @property
    def player(self) -> Player | None: ...
    @property
    def players(self) -> tuple[str, ...]: ...
    @property
    def tokens(self) -> Tokens: ...
    def colour(self, player: Player) -> str: ...
    def set_players(self, players: tuple[str, ...]) -> None: ...
    def problems(self, player_id: str) -> tuple[Problem, ...]: ...


def kept_pitches(bottom: float, rows: float) -> tuple[float, float]:
    """Return the range of pitches, from the bottom to the top of the plot, that shows ``rows`` pitches from ``bottom``
    on, limited to pitches that exist.
    """
    rows = min(max(rows, LEAST_ROWS), MOST_ROWS)
    bottom = min(max(bottom, 0.0), MOST_ROWS - rows)
    return bottom, bottom + rows


def fitted_pitches(low: float, high: float, room_px: float) -> tuple[float, float]:
    """Return the lowest and the highest displayed pitch so that the range ``low`` to ``high`` is visible with a margin
    in ``room_px`` pixels.
    """
    rows = max(high - low + AIR_ROWS, min(USUAL_ROWS, room_px / LEGIBLE_ROW_PX))
    return kept_pitches((low + high) / 2 - rows / 2, rows)


def legible_pitches(pitches: FloatArray, air: float, room_px: float) -> tuple[float, float]:
    """Return the displayed pitch range in which notes are legible, with as many notes as possible.

    Parameters
    ----------
    pitches : array (N,)
        Pitches of the notes, at least one.
    air : float
        Rows to leave free above the notes.
    """
    low, high = float(pitches.min()), float(pitches.max()) + 1.0 + air
    rows = room_px / LEGIBLE_ROW_PX
    if high - low <= rows:
        # The margins above and below are given up first.
        rows = max(min(max(high - low + AIR_ROWS, USUAL_ROWS), rows), LEAST_ROWS)
        return kept_pitches((low + high) / 2 - rows / 2, rows)
    whole = max(int(rows), int(LEAST_ROWS))
    counts = np.bincount(pitches.astype(np.int64), minlength=int(MOST_ROWS))
    seen = np.convolve(counts, np.ones(whole, np.int64), "valid")
    best = np.flatnonzero(seen == seen.max())
    return kept_pitches(float(best[(len(best) - 1) // 2]), max(rows, LEAST_ROWS))


def zoomed_pitches(pitches: tuple[float, float], factor: float, at: float) -> tuple[float, float]:
    """Return a displayed pitch range with ``factor`` times fewer pitches, in which ``at`` keeps its position."""
    bottom, top = pitches
    rows = min(max((top - bottom) / factor, LEAST_ROWS), MOST_ROWS)
    return kept_pitches(at - (at - bottom) / (top - bottom) * rows, rows)


def visible(table: TimedNotes, start_s: float, end_s: float, pitches: tuple[float, float]) -> IntArray:
    """Return the indices (K,) of the notes that may be visible in a range of seconds and of pitches (lowest,
    highest)."""
    found = table.visible(start_s, end_s)
    bottom, top = pitches
    pitch = table.pitch[found]
    inside = (pitch > bottom - 1) & (pitch < top) & (table.end_s[found] > start_s)
    rows: IntArray = np.flatnonzero(inside) + found.start
    return rows


def moved_notes(before: Score, after: Score) -> list[str]:
    """Return the ids of the notes with different pitches in two scores."""
    parts = {part.id: part for part in before.parts}
    changed = [(parts[part.id], part) for part in after.parts if part.id in parts and part is not parts[part.id]]
    moved = []
    for old, new in changed:
        pitches = {note.id: note.pitch for note in old.notes}
        moved += [note.id for note in new.notes if pitches.get(note.id, note.pitch) != note.pitch]
    return moved


def boxes(
    table: TimedNotes, rows: IntArray, scale: Scale, highest: float, row_px: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return left, top, width and height (N,) of notes in whole pixels, for sharp edges; ``highest`` is the pitch at
    the top."""
    left = np.floor(scale.x_px(table.onset_s[rows]))
    right = np.floor(scale.x_px(table.end_s[rows]))
    pitch = table.pitch[rows]
    top = np.floor((highest - pitch - 1) * row_px)
    below = np.floor((highest - pitch) * row_px)
    gap = 1.0 if row_px >= 4 else 0.0
    return left, top, np.maximum(right - left - 1.0, 1.0), np.maximum(below - top - gap, 1.0)


def edge_of(left_px: float, right_px: float, x_px: float) -> bool | None:
    """Return the edge of a note's box that the position ``x_px`` grabs: True for the start, False for the end, None for
    the middle.
    """
    reach = min(EDGE_PX, max((right_px - left_px) / 4, 1.5))
    if right_px - x_px <= reach:
        return False
    # Short notes are moved as a whole; a long enough note reacts at its end.
    return True if x_px - left_px <= reach and right_px - left_px >= 4 * EDGE_PX else None


def cell(score: Score, grid: Grid, mouse: LaneMouse) -> tuple[int, int]:
    """Return the first tick and the length in ticks of the grid cell under the mouse; with Alt the cell begins exactly
    at the mouse.
    """
    length = max(round(grid.quarters * score.ticks_per_quarter), 1)
    tick = max(mouse.tick, 0.0)
    if mouse.alt or not grid.enabled:
        return round(tick), length
    onset = grid.snap(score.metre_map, tick)
    if onset > tick:
        onset = grid.snap(score.metre_map, max(tick - length / 2, 0.0))
    return onset, length


class RollModel:
    """Every player's notes as arrays; only the active player's respond to the mouse."""

    def __init__(self, session: RollSession, axis: Scale) -> None:
        self._session, self._axis = session, axis
        self.ghosts_mode = Ghosts.GHOSTS
        """Display of the players behind."""
        self._tables: dict[str, NoteTable] = {}
        self._flags: dict[str, tuple[NoteTable, Selection, BoolArray]] = {}
        self._warned: tuple[NoteTable | None, tuple[Problem, ...], frozenset[int]] = (None, (), frozenset())
        self._ghosts_of: tuple[tuple[object, ...], Behind] = ((None,) * 6, NO_GHOSTS)
        """The players behind, and what that was found from: it is asked with every repaint."""

    def forget(self) -> None:
        """Discard everything cached for the previous project."""
        self._tables.clear()
        self._flags.clear()

    def table(self, player: Player) -> NoteTable:
        """Return a player's notes as arrays, cached until they change."""
        project = self._session.project
        part, tempo = project.part(player), project.score.tempo_map
        known = self._tables.get(part.id)
        if known is None or known.part is not part or known.tempo is not tempo:
            known = self._tables[part.id] = NoteTable(part, tempo)
        return known

    def front(self) -> tuple[NoteTable, str] | None:
        """Return the notes of the active player and their colour; None if there is none."""
        player = self._session.player
        return (self.table(player), self._session.colour(player)) if player is not None else None

    def ghosts(self) -> Behind:
        """Return the notes of the other players, drawn pale behind those of the active player."""
        if self.ghosts_mode is Ghosts.ALONE:
            return NO_GHOSTS
        project, front = self._session.project, self._session.player
        # Selecting players changes the display only if ghosts of the selected ones are shown.
        chosen = self._session.players if self.ghosts_mode is Ghosts.SELECTED else None
        sources = (project.players, project.score, front, self._session.tokens, self.ghosts_mode, chosen)
        if not all(map(is_, sources, self._ghosts_of[0])):
            self._ghosts_of = (sources, self._find_ghosts(project, front))
        return self._ghosts_of[1]

    def _find_ghosts(self, project: Project, front: Player | None) -> Behind:
        # Players that share a part are drawn once, in the colour of the first.
        seen = self._session.players if self.ghosts_mode is Ghosts.SELECTED else None
        behind = {player.part_id: player for player in reversed(project.players) if seen is None or player.id in seen}
        if front is not None:
            behind.pop(front.part_id, None)
        tables = [self.table(player) for player in behind.values()]
        return Behind(tables, [self._session.colour(player) for player in behind.values()], self._ghosts_of[1])

    def _touchable(self) -> list[NoteTable]:
        """Return the notes that respond to the mouse: the active player's, then all others' if these are not drawn
        pale.
        """
        front = self.front()
        tables = [] if front is None else [front[0]]
        return tables + list(self.ghosts().tables) if self.ghosts_mode is Ghosts.ALL else tables

    def note(self, note_id: str) -> Note | None:
        """Return the note of the active player with an id; None if there is none."""
        front = self.front()
        place = front[0].index.get(note_id) if front is not None else None
        return front[0].part.notes[place] if front is not None and place is not None else None

    def note_at(self, mouse: LaneMouse) -> Note | None:
        """Return the note under the mouse: the active player's, or another player's if these are not drawn pale; None
        if there is none.
        """
        slack_s = SLACK_PX / self._axis.px_per_s
        for table in self._touchable():
            place = table.at(mouse.time_s, int(mouse.value // 1), slack_s)
            if place is not None:
                return table.part.notes[place]
        return None

    def note_near(self, mouse: LaneMouse, row_px: float) -> Note | None:
        """Return the note nearest to the mouse, at most `NEAR_PX` away in time and pitch; None if there is none."""
        near_s, rows = NEAR_PX / self._axis.px_per_s, NEAR_PX / row_px
        best: tuple[float, Note] | None = None
        for table in self._touchable():
            time_s, value = mouse.time_s, mouse.value
            for id in table.within(time_s - near_s, time_s + near_s, int(value - rows), int(value + rows)):
                place = table.index[id]
                pitch = float(table.pitch[place])
                aside = max(float(table.onset_s[place]) - time_s, time_s - float(table.end_s[place]), 0.0) / near_s
                above = max(pitch - value, value - pitch - 1.0, 0.0) / rows
                if max(aside, above) <= 1.0 and (best is None or aside + above < best[0]):
                    best = (aside + above, table.part.notes[place])
        return best[1] if best is not None else None

    def edge_at(self, note: Note, mouse: LaneMouse) -> bool | None:
        """Return True if the mouse is at the note's start, False at its end, None in its middle."""
        tempo = self._session.project.score.tempo_map
        left_px, right_px = (self._axis.x_px(tempo.seconds(float(tick))) for tick in (note.onset_tick, note.end_tick))
        return edge_of(left_px, right_px, mouse.x_px)

    def warned(self, table: NoteTable) -> frozenset[int]:
        """Return the indices of the active player's notes with problems."""
        player = self._session.player
        reported = self._session.problems(player.id) if player is not None else ()
        known = self._warned
        if known[0] is not table or known[1] is not reported:
            places = (table.index.get(problem.note_id) for problem in reported if problem.note_id is not None)
            known = self._warned = (table, reported, frozenset(place for place in places if place is not None))
        return known[2]

    def notes_within(self, start_s: float, end_s: float, low: int, high: int) -> frozenset[str]:
        """Return the ids of the selectable notes in a rectangle of seconds and pitches."""
        return frozenset(id for table in self._touchable() for id in table.within(start_s, end_s, low, high))

    def notes_of_pitch(self, pitch: int) -> frozenset[str]:
        """Return the ids of all notes of a pitch in the active player's part."""
        front = self.front()
        if front is None:
            return frozenset()
        notes = front[0].part.notes
        return frozenset(notes[place].id for place in np.flatnonzero(front[0].pitch == pitch).tolist())

    def selected(self, table: NoteTable) -> BoolArray | None:
        """Return a mask (N,) of the table's notes that are selected; None if none is."""
        selection = self._session.selection
        if not selection.notes:
            return None
        known = self._flags.get(table.part.id)
        if known is None or known[0] is not table or known[1].notes is not selection.notes:
            known = (table, selection, table.flags(selection.notes))
            self._flags[table.part.id] = known
        return known[2] if known[2].any() else None

    @property
    def selects_behind(self) -> bool:
        """Return whether notes of a player other than the active one are selected."""
        notes, front = self._session.selection.notes, self.front()
        return bool(notes) and (front is None or not front[0].index.keys() >= notes)

    def bring_forward(self, note: Note) -> None:
        """Make the player of a note active."""
        player = self._session.player
        if player is not None and note.id in self.table(player).index:
            return
        for other in self._session.project.players:
            if note.id in self.table(other).index:
                self._session.set_players((other.id,))
                return
