"""Gestures on the piano roll; each edits the project as it was at its start, as a single undo step."""

from __future__ import annotations

from typing import Protocol

from app.editor.edit_names import edit_at, edit_of_notes
from app.editor.selection import Selection
from app.project.edit import notes
from app.project.model import Project
from app.score.model import Note
from widgets.timeline.model.gestures import Band, Far, LiveEdit, MouseGesture, Plane, snapped, together
from widgets.timeline.model.lane_mouse import LaneMouse, PixelRect
from widgets.timeline.model.roll.shown_notes import RollModel, RollSession, cell

VELOCITY_A_PX = 0.5


class RollPlane(Plane, Protocol):
    """Part of the piano roll that gestures use, a protocol since the roll is a widget; a press becomes a drag after
    ``drag_px`` pixels.
    """

    @property
    def session(self) -> RollSession: ...
    @property
    def model(self) -> RollModel: ...
    @property
    def drag_px(self) -> float: ...
    @property
    def row_px(self) -> float: ...


class RollGesture(MouseGesture):
    """A press on the roll and the drag that follows it, which edits as a single undo step.

    Parameters
    ----------
    mouse : LaneMouse
        Position of the press.

    Attributes
    ----------
    moved, sounded : str
        Ids of the notes whose new pitch or velocity is displayed.
    copies : bool
        Whether the drag moves copies of the notes.
    """

    copies = False

    def __init__(self, roll: RollPlane, mouse: LaneMouse, far: Far | None = None) -> None:
        super().__init__(mouse, far)
        self.roll = roll
        self.session = roll.session
        self.step = LiveEdit(self.session, roll)
        self._selected = self.session.selection
        self.moved = self.sounded = ""

    def release(self, mouse: LaneMouse) -> None:
        super().release(mouse)
        self.step.end()

    def cancel(self) -> None:
        self.step.take_back()
        self.session.select(self._selected)


class Move(RollGesture):
    """Drag of notes in time and pitch; Shift limits it to one of the two, Alt disables snapping to the grid."""

    def __init__(self, roll: RollPlane, mouse: LaneMouse, note: Note, narrow: bool) -> None:
        super().__init__(roll, mouse, together(roll.drag_px))
        self._note = note
        self._narrow = narrow
        self._ids = self.session.selection.notes

    def follow(self, mouse: LaneMouse) -> None:
        self._place(*notes.reach_of_move(self.step.base, self._ids, *self._distance(mouse)))

    def _distance(self, mouse: LaneMouse) -> tuple[int, int]:
        """Return the ticks and semitones by which the mouse moves the notes."""
        by_tick = self._snapped(mouse)
        by_pitch = int(mouse.value // 1) - int(self.at.value // 1)
        if mouse.shift:
            across = abs(mouse.x_px - self.at.x_px) >= abs(mouse.y_px - self.at.y_px)
            return (by_tick, 0) if across else (0, by_pitch)
        return by_tick, by_pitch

    def _place(self, by_tick: int, by_pitch: int) -> None:
        self.step.edit(
            edit_of_notes(self.step.base, "edit.move_notes", self._ids),
            lambda project: notes.move(project, self._ids, by_tick, by_pitch),
        )
        self.moved = self._note.id

    def _free(self, mouse: LaneMouse) -> bool:
        """Return whether the mouse moves without snapping to the grid, which Alt suspends."""
        return mouse.alt

    def _snapped(self, mouse: LaneMouse) -> int:
        free = self._free(mouse)
        target = self._note.onset_tick + mouse.tick - self.at.tick
        # A vertical drag must not pull a note to the grid.
        if not free and abs(mouse.x_px - self.at.x_px) < self.roll.drag_px:
            return 0
        return snapped(self.session.grid, self.step.base.score, target, free) - self._note.onset_tick

    def click(self, mouse: LaneMouse) -> None:
        if self._narrow:
            self.session.select(Selection(frozenset({self._note.id})))


class Copy(Move):
    """Drag of copies of notes. A press without a drag toggles the note's selection."""

    copies = True

    def __init__(self, roll: RollPlane, mouse: LaneMouse, note: Note) -> None:
        super().__init__(roll, mouse, note, narrow=False)
        if note.id not in self._ids:
            self._ids = frozenset({note.id})
        self._key_is_alt = mouse.alt

    def _free(self, mouse: LaneMouse) -> bool:
        # If the same key copies and suspends the grid, copies snap to the grid.
        return mouse.alt and not self._key_is_alt

    def _place(self, by_tick: int, by_pitch: int) -> None:
        copies: tuple[str, ...] = ()

        def copied(project: Project) -> Project:
            nonlocal copies
            if not by_tick and not by_pitch:
                # A copy at its original's position would only be in the way.
                return project
            project, copies = notes.duplicate(project, self._ids, by_tick, by_pitch)
            return project

        if self.step.edit(edit_of_notes(self.step.base, "edit.duplicate_notes", self._ids), copied):
            self.session.select(Selection(frozenset(copies or self._ids)))
            self.moved = copies[0] if copies else ""

    def click(self, mouse: LaneMouse) -> None:
        itself = frozenset({self._note.id})
        self.session.select(Selection(itself if self._key_is_alt else self._selected.notes ^ itself))


class Resize(RollGesture):
    """Drag of the end or start of a note, with the same change for other selected notes."""

    def __init__(self, roll: RollPlane, mouse: LaneMouse, note: Note, at_start: bool) -> None:
        super().__init__(roll, mouse, together(roll.drag_px))
        self._note = note
        self._at_start = at_start
        self._ids = self.session.selection.notes

    def follow(self, mouse: LaneMouse) -> None:
        edge = self._note.onset_tick if self._at_start else self._note.end_tick
        target = edge + mouse.tick - self.at.tick
        placed = snapped(self.session.grid, self.step.base.score, target, mouse.alt)
        self.step.edit(
            edit_of_notes(self.step.base, "edit.resize_notes", self._ids),
            lambda project: notes.resize(project, self._ids, placed - edge, at_start=self._at_start),
        )


class Velocity(RollGesture):
    """Vertical drag that changes the velocity of notes: louder upwards, softer downwards."""

    def __init__(self, roll: RollPlane, mouse: LaneMouse, note: Note) -> None:
        super().__init__(roll, mouse)
        self._note = note
        self._ids = self.session.selection.notes

    def follow(self, mouse: LaneMouse) -> None:
        by = round((self.at.y_px - mouse.y_px) * VELOCITY_A_PX)
        self.step.edit(
            edit_of_notes(self.step.base, "edit.change_velocity", self._ids),
            lambda project: notes.change_velocity(project, self._ids, by),
        )
        self.sounded = self._note.id


class Draw(RollGesture):
    """Drag that draws a note from the press to the mouse."""

    def __init__(self, roll: RollPlane, mouse: LaneMouse, part_id: str, velocity: int) -> None:
        super().__init__(roll, mouse)
        self._part_id = part_id
        self._velocity = velocity
        self._onset, self._least = cell(self.step.base.score, self.session.grid, mouse)
        self._pitch = int(mouse.value // 1)
        self.note_id = ""
        self._make(self._onset + self._least)

    def _make(self, end: int) -> None:
        def added(project: Project) -> Project:
            length = max(end - self._onset, 1)
            project, self.note_id = notes.add_note(
                project, self._part_id, self._onset, length, self._pitch, self._velocity
            )
            return project

        project = self.step.base
        players = {player.id for player in project.players if player.part_id == self._part_id}
        if self.step.edit(edit_at(project, "edit.add_note", 1, players, (self._onset,)), added):
            self.session.select(Selection(frozenset({self.note_id})))

    def follow(self, mouse: LaneMouse) -> None:
        end = round(mouse.tick) if mouse.alt else mouse.snapped_tick
        self._make(end if mouse.alt else max(end, self._onset + self._least))


class Erase(RollGesture):
    """Drag that deletes every note that the mouse passes."""

    def __init__(self, roll: RollPlane, mouse: LaneMouse) -> None:
        super().__init__(roll, mouse)
        self._gone: set[str] = set()
        self.follow(mouse)

    def follow(self, mouse: LaneMouse) -> None:
        hit = self.roll.model.note_at(mouse)
        if hit is not None and hit.id not in self._gone:
            self._gone.add(hit.id)
            self.step.edit(
                edit_of_notes(self.step.base, "edit.erase_notes", self._gone),
                lambda project: notes.erase(project, self._gone),
            )


class LassoNotes(Band):
    """Rubber band over notes; Shift and Ctrl add to the selection. A click selects a note nearby."""

    def __init__(self, roll: RollPlane, mouse: LaneMouse) -> None:
        super().__init__(roll, mouse, together(roll.drag_px), self._select_inside)
        self._roll, self._before = roll, roll.session.selection
        self._kept = self._before.notes if mouse.shift or mouse.ctrl else frozenset[str]()

    def _select_inside(self, _box: PixelRect, mouse: LaneMouse) -> None:
        times = sorted((self.at.time_s, mouse.time_s))
        low, high = sorted((int(self.at.value // 1), int(mouse.value // 1)))
        inside = self._roll.model.notes_within(times[0], times[1], low, high)
        self._roll.session.select(Selection(self._kept | inside))

    def click(self, mouse: LaneMouse) -> None:
        missed = self._roll.model.note_near(self.at, self._roll.row_px)
        if missed is not None:
            self._roll.model.bring_forward(missed)
        self._roll.session.select(Selection(self._kept | ({missed.id} if missed is not None else frozenset())))

    def cancel(self) -> None:
        super().cancel()
        self._roll.session.select(self._before)
