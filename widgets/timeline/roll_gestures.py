"""What a press on the piano roll becomes: each gesture is one step, made from the project that it began with."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtWidgets import QApplication

from app.errors import AppError, Message
from app.project.edit import notes
from app.project.model import Project
from app.score.model import Note
from widgets.common.selection import Selection
from widgets.common.session import Session
from widgets.timeline.lane import LaneMouse

if TYPE_CHECKING:
    from widgets.timeline.roll import PianoRoll

VELOCITY_A_PX = 0.5


class Gesture:
    """A press and what follows it.

    Parameters
    ----------
    roll : PianoRoll
    mouse : LaneMouse
        The press.
    """

    def __init__(self, roll: PianoRoll, mouse: LaneMouse) -> None:
        self.roll = roll
        self.session: Session = roll.session
        self.pressed = mouse
        self.base = self.session.project
        self._token = object()
        self._ours = self.base
        self._selected = self.session.selection
        self._name = Message("edit.add_note")

    def drag(self, mouse: LaneMouse) -> None:
        """The mouse moved."""

    def release(self, mouse: LaneMouse) -> None:
        """The button went up."""
        self.session.document.end_gesture()

    def cancel(self) -> None:
        """As if it had never begun."""
        if self.session.project is self._ours and self._ours is not self.base:
            self.session.apply(self._name, self.base, self._token, self.roll)
        self.session.document.end_gesture()
        self.session.select(self._selected)

    def edit(self, name: Message, edited: Callable[[Project], Project]) -> bool:
        """Show what the edit makes of the project as it was at the press; whether it could be done."""
        if self.session.project is not self._ours:
            # Somebody took the step back in the middle of the drag: what it began with is gone.
            return False
        try:
            project = edited(self.base)
        except AppError:
            # A place that cannot be: the last one that could stays.
            return False
        self._name = name
        self.session.apply(name, project, self._token, self.roll)
        self._ours = self.session.project
        return True

    def moved(self, mouse: LaneMouse) -> bool:
        """Whether the mouse went far enough to mean a drag."""
        distance = abs(mouse.x_px - self.pressed.x_px) + abs(mouse.y_px - self.pressed.y_px)
        return distance >= QApplication.startDragDistance() / 2


class Move(Gesture):
    """Drag notes in time and pitch; Shift keeps to one of them, Alt suspends the grid."""

    def __init__(self, roll: PianoRoll, mouse: LaneMouse, note: Note, narrow: bool) -> None:
        super().__init__(roll, mouse)
        self._note = note
        self._narrow = narrow
        self._ids = self.session.selection.notes
        self._began = False

    def drag(self, mouse: LaneMouse) -> None:
        self._began = self._began or self.moved(mouse)
        if not self._began:
            return
        self._place(*notes.reach_of_move(self.base, self._ids, *self._distance(mouse)))

    def _distance(self, mouse: LaneMouse) -> tuple[int, int]:
        """How far the mouse carries the notes: ticks and semitones."""
        by_tick = self._snapped(mouse)
        by_pitch = int(mouse.value // 1) - int(self.pressed.value // 1)
        if mouse.shift:
            across = abs(mouse.x_px - self.pressed.x_px) >= abs(mouse.y_px - self.pressed.y_px)
            return (by_tick, 0) if across else (0, by_pitch)
        return by_tick, by_pitch

    def _place(self, by_tick: int, by_pitch: int) -> None:
        self.edit(
            Message("edit.move_notes", {"count": len(self._ids)}),
            lambda project: notes.move(project, self._ids, by_tick, by_pitch),
        )
        self.roll.show_moved(self._note.id)

    def _free(self, mouse: LaneMouse) -> bool:
        """Whether the grid is suspended."""
        return mouse.alt

    def _snapped(self, mouse: LaneMouse) -> int:
        target = self._note.onset_tick + mouse.tick - self.pressed.tick
        if self._free(mouse):
            return round(target) - self._note.onset_tick
        # A hand that only transposes must not pull a note onto the grid.
        if abs(mouse.x_px - self.pressed.x_px) < QApplication.startDragDistance() / 2:
            return 0
        return self.session.grid.snap(self.base.score, target) - self._note.onset_tick

    def release(self, mouse: LaneMouse) -> None:
        if not self._began and self._narrow:
            self.session.select(Selection(frozenset({self._note.id})))
        super().release(mouse)


class Copy(Move):
    """Drag copies of notes away from them. A press that is none takes its note into the selection or out of it."""

    def __init__(self, roll: PianoRoll, mouse: LaneMouse, note: Note) -> None:
        super().__init__(roll, mouse, note, narrow=False)
        if note.id not in self._ids:
            self._ids = frozenset({note.id})
        self._key_is_alt = mouse.alt

    def _free(self, mouse: LaneMouse) -> bool:
        # Where the key that copies is the one that suspends the grid, the copies keep to it.
        return mouse.alt and not self._key_is_alt

    def _place(self, by_tick: int, by_pitch: int) -> None:
        self.roll.plot.setCursor(Qt.CursorShape.DragCopyCursor)
        copies: tuple[str, ...] = ()

        def copied(project: Project) -> Project:
            nonlocal copies
            if not by_tick and not by_pitch:
                # On its original a copy would only be in its way.
                return project
            project, copies = notes.duplicate(project, self._ids, by_tick, by_pitch)
            return project

        if self.edit(Message("edit.duplicate_notes", {"count": len(self._ids)}), copied):
            self.session.select(Selection(frozenset(copies or self._ids)))
            if copies:
                self.roll.show_moved(copies[0])

    def release(self, mouse: LaneMouse) -> None:
        if not self._began and not self._key_is_alt:
            self.session.select(Selection(self._selected.notes ^ {self._note.id}))
        elif not self._began:
            self.session.select(Selection(frozenset({self._note.id})))
        super().release(mouse)


class Resize(Gesture):
    """Drag the end of a note, or its beginning; the others chosen with it grow and shrink alike."""

    def __init__(self, roll: PianoRoll, mouse: LaneMouse, note: Note, at_start: bool) -> None:
        super().__init__(roll, mouse)
        self._note = note
        self._at_start = at_start
        self._ids = self.session.selection.notes
        self._began = False

    def drag(self, mouse: LaneMouse) -> None:
        self._began = self._began or self.moved(mouse)
        if not self._began:
            return
        edge = self._note.onset_tick if self._at_start else self._note.end_tick
        target = edge + mouse.tick - self.pressed.tick
        placed = round(target) if mouse.alt else self.session.grid.snap(self.base.score, target)
        self.edit(
            Message("edit.resize_notes", {"count": len(self._ids)}),
            lambda project: notes.resize(project, self._ids, placed - edge, at_start=self._at_start),
        )


class Velocity(Gesture):
    """Drag up or down: louder or softer."""

    def __init__(self, roll: PianoRoll, mouse: LaneMouse, note: Note) -> None:
        super().__init__(roll, mouse)
        self._note = note
        self._ids = self.session.selection.notes

    def drag(self, mouse: LaneMouse) -> None:
        by = round((self.pressed.y_px - mouse.y_px) * VELOCITY_A_PX)
        self.edit(
            Message("edit.change_velocity", {"count": len(self._ids)}),
            lambda project: notes.change_velocity(project, self._ids, by),
        )
        self.roll.show_velocity(self._note.id)


class Draw(Gesture):
    """A new note where the press was, as long as the drag."""

    def __init__(self, roll: PianoRoll, mouse: LaneMouse, part_id: str, velocity: int) -> None:
        super().__init__(roll, mouse)
        self._part_id = part_id
        self._velocity = velocity
        self._onset, self._least = roll.cell(mouse)
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

        if self.edit(Message("edit.add_note"), added):
            self.session.select(Selection(frozenset({self.note_id})))

    def drag(self, mouse: LaneMouse) -> None:
        end = round(mouse.tick) if mouse.alt else mouse.snapped_tick
        self._make(end if mouse.alt else max(end, self._onset + self._least))


class Erase(Gesture):
    """Every note that the mouse passes over goes."""

    def __init__(self, roll: PianoRoll, mouse: LaneMouse) -> None:
        super().__init__(roll, mouse)
        self._gone: set[str] = set()
        self.drag(mouse)

    def drag(self, mouse: LaneMouse) -> None:
        hit = self.roll.note_at(mouse)
        if hit is not None and hit.id not in self._gone:
            self._gone.add(hit.id)
            self.edit(
                Message("edit.erase_notes", {"count": len(self._gone)}),
                lambda project: notes.erase(project, self._gone),
            )


class LassoNotes(Gesture):
    """A rectangle over notes; Shift and Ctrl add to what was selected before."""

    def __init__(self, roll: PianoRoll, mouse: LaneMouse) -> None:
        super().__init__(roll, mouse)
        self._kept = self._selected.notes if mouse.shift or mouse.ctrl else frozenset[str]()
        self._began = False

    def drag(self, mouse: LaneMouse) -> None:
        self._began = self._began or self.moved(mouse)
        if not self._began:
            return
        left = self.roll.axis.x_px(self.pressed.time_s)
        corner = QPointF(left, self.roll.y_px(self.pressed.value))
        self.roll.lasso.show(QRectF(corner, QPointF(mouse.x_px, mouse.y_px)).normalized())
        times = sorted((self.pressed.time_s, mouse.time_s))
        low, high = sorted((int(self.pressed.value // 1), int(mouse.value // 1)))
        inside = self.roll.notes_within(times[0], times[1], low, high)
        self.session.select(Selection(self._kept | inside))

    def release(self, mouse: LaneMouse) -> None:
        self.roll.lasso.show(None)
        if not self._began:
            self.session.select(Selection(self._kept))

    def cancel(self) -> None:
        self.roll.lasso.show(None)
        super().cancel()
