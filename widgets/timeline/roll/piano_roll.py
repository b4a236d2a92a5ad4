"""The piano roll: every player's notes, with the active player's in colour and editable."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from PySide6.QtCore import QEvent, QLineF, QRectF, Qt, Signal
from PySide6.QtGui import QCursor, QFont, QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QApplication, QMenu, QToolTip, QWidget

from app.arrays import FloatArray, IntArray
from app.editor.design_tokens import LEAST_TEXT_PT
from app.editor.edit_names import edit_of_notes
from app.editor.selection import Selection
from app.editor.session import Session
from app.editor.timeline_view import Ghosts, Tool
from app.errors import AppError
from app.plan.model import PlayerPlan
from app.project.edit import notes
from app.project.undoable_document import Change
from app.score.marks import Mark
from app.score.model import Note
from instrument_maps.model import InstrumentMap
from widgets.common.menus import add_actions
from widgets.common.pitch import pitch_text
from widgets.common.text import sentence
from widgets.timeline.lane import GUTTER_PX, Lane, LaneItem, LaneMouse
from widgets.timeline.model.gestures import MouseGesture
from widgets.timeline.model.roll.entries import EntryDrag
from widgets.timeline.model.roll.note_table import Behind, TimedNotes
from widgets.timeline.model.roll.roll_gestures import Copy, Draw, Erase, LassoNotes, Move, Resize, RollGesture, Velocity
from widgets.timeline.model.roll.shown_notes import (
    LEGIBLE_ROW_PX,
    RollModel,
    boxes,
    fitted_pitches,
    kept_pitches,
    legible_pitches,
    visible,
    zoomed_pitches,
)
from widgets.timeline.plot.drawing import rect
from widgets.timeline.roll.drawn_notes import Hint, Lasso, Notes, OutOfSight, Rows
from widgets.timeline.roll.entry_arrows import EntryArrows
from widgets.timeline.roll.fingerings_on_notes import Labels
from widgets.timeline.roll.keyboard import KEYBOARD_PX, Keyboard
from widgets.timeline.roll.marks_on_notes import RollMarks
from widgets.timeline.zoom_and_scroll import TimeAxis

NEEDED_PX = 221
"""Height in pixels for two octaves with notes 8 pixels high."""
ROWS_A_NOTCH = 3.0
ZOOM_A_NOTCH = 1.18
ZOOM_A_KEY = 1.4
FIRST_VELOCITY = 80
MENU = (
    "notes.cut",
    "notes.copy",
    "notes.paste",
    "",
    "notes.split",
    "notes.join",
    "notes.duplicate",
    "notes.quantise",
    "edit.delete",
    "",
    "notes.select_pitch",
    "notes.select_bar",
)


class PianoRoll(Lane):
    """Piano roll: the lane of the timeline in which the notes of all players are shown and edited."""

    reported = Signal(str)
    """Signal: description of the object under the mouse, for the tool bar."""

    id = "roll"
    preferred_height_px = 240
    least_height_px = 112
    is_essential = True

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        self.model = RollModel(session, axis)
        self._gesture: MouseGesture | None = None
        self._tool = Tool.SELECT
        self._velocity = FIRST_VELOCITY
        self._pitches_chosen = False
        """True once the user scrolled or zoomed the pitches; until then they suit the height of the lane."""
        super().__init__(session, axis, parent)
        self.keyboard = Keyboard(self)
        self.rows = Rows(self, -200.0)
        self.notes = Notes(self)
        self.labels = Labels(self)
        OutOfSight(self, 8.0)
        self.marks = RollMarks(self)
        self.entries = EntryArrows(self)
        self.lasso = Lasso(self)
        Hint(self, 5.0)
        self._set_font()
        session.pitch_display.changed.connect(self.keyboard.update)
        session.problems_changed.connect(self.performance_changed)
        self.show_legibly()
        self.texted(self.title, text="piano_roll.notes", tip="piano_roll.notes_of_player_in_front")
        self.retranslate()

    # Display

    @property
    def tool(self) -> Tool:
        """Tool that the left mouse button uses in the roll, such as selecting or drawing notes."""
        return self._tool

    @property
    def needed_height_px(self) -> int:
        return NEEDED_PX

    def set_tool(self, tool: Tool) -> None:
        """Set the tool of the left button."""
        self._tool = tool
        self.lasso.show(None)
        shapes = {Tool.SELECT: Qt.CursorShape.ArrowCursor, Tool.DRAW: Qt.CursorShape.CrossCursor}
        self.plot.setCursor(shapes.get(tool, Qt.CursorShape.PointingHandCursor))

    @property
    def ghosted(self) -> bool:
        """True if the other players' notes are drawn pale and do not respond to the mouse."""
        return self.model.ghosts_mode is not Ghosts.ALL

    @property
    def ghosts_mode(self) -> Ghosts:
        """Display of the other players' notes behind those of the active player."""
        return self.model.ghosts_mode

    def set_ghosts(self, ghosts: Ghosts) -> None:
        """Set whether and how the notes of other players are drawn behind the active player's."""
        self.model.ghosts_mode = ghosts
        self.update_items()

    def ghosts(self) -> Behind:
        """Return the notes of the other players, drawn pale behind those of the active player."""
        return self.model.ghosts()

    def hint(self) -> str:
        """Return advice for an empty roll; empty if there are notes."""
        front = self.model.front()
        if front is None:
            return self.tr("piano_roll.no_players_yet_open_midi")
        if len(front[0]):
            return ""
        return self.tr("piano_roll.no_notes_yet_take_pencil")

    @property
    def playable(self) -> tuple[int, int] | None:
        """Lowest and highest concert pitch of the active player's instrument; None without one."""
        instrument = self._instrument()
        return (instrument.range.low, instrument.range.high) if instrument is not None else None

    def _instrument(self) -> InstrumentMap | None:
        """Return the active player's instrument; None if there is no player or map."""
        player = self.session.player
        if player is None:
            return None
        try:
            return self.session.performance.instrument(player)
        except AppError:
            return None

    @property
    def plans(self) -> Mapping[str, PlayerPlan]:
        """The plans of all players by id."""
        return self.session.plans

    @property
    def row_px(self) -> float:
        """Height in pixels of the row of one pitch."""
        bottom, top = self.y_range
        return self.plot_rect.height() / (top - bottom)

    def visible(self, table: TimedNotes, exposed: QRectF) -> IntArray:
        """Return the indices (K,) of the notes that may be visible in the part ``exposed`` of the plot."""
        times = self.axis.seconds(exposed.left()), self.axis.seconds(exposed.right())
        return visible(table, *times, self.y_range)

    def boxes(self, table: TimedNotes, rows: IntArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return left, top, width and height (N,) in whole pixels of the notes with the indices ``rows``."""
        return boxes(table, rows, self.axis, self.y_range[1], self.row_px)

    # Pitch

    def show_legibly(self) -> None:
        """Show the active player's notes in the visible time range, or else all of them, at a size at which they can be
        read.
        """
        self._pitches_chosen = False
        front = self.model.front()
        if front is None or not len(front[0]):
            self.fit_pitch()
            return
        table = front[0]
        here = table.pitch[table.visible(self.axis.start_s, self.axis.end_s)]
        pitches = here if len(here) else table.pitch
        room_px = self.plot_rect.height()
        if np.ptp(table.pitch) + 1 + self.marks.air_rows <= room_px / LEGIBLE_ROW_PX:
            pitches = table.pitch
        self._show_pitches(*legible_pitches(pitches, self.marks.air_rows, room_px))

    def bring_notes_into_view(self, note_ids: Iterable[str]) -> None:
        """Scroll to the pitches of the active player's notes, if most of them are not visible."""
        front = self.model.front()
        places = [front[0].index[id] for id in note_ids if id in front[0].index] if front is not None else []
        if front is None or not places:
            return
        seen = front[0].visible(self.axis.start_s, self.axis.end_s)
        here = [place for place in places if seen.start <= place < seen.stop]
        self._bring_into_view(front[0].pitch[here or places])

    def _bring_into_view(self, pitches: FloatArray) -> None:
        """Scroll to the middle of pitches, if most of them are not visible."""
        bottom, top = self.y_range
        if len(pitches) and np.mean((pitches >= bottom) & (pitches + 1 <= top)) < 0.5:
            middle = float(np.median(pitches)) + 0.5
            self._show_pitches(*kept_pitches(middle - (top - bottom) / 2, top - bottom))

    def follow(self) -> None:
        """Scroll to the pitches of the page during playback, if most of its notes are not visible."""
        front = self.model.front()
        if front is None:
            return
        self._bring_into_view(front[0].pitch[front[0].visible(self.axis.start_s, self.axis.end_s)])

    def fit_pitch(self) -> None:
        """Show the pitches of all notes of the active player, with some margin."""
        front = self.model.front()
        pitches = front[0].pitch if front is not None else np.empty(0)
        if len(pitches):
            low, high = float(pitches.min()), float(pitches.max()) + 1.0 + self.marks.air_rows
        elif self.playable is not None:
            low, high = float(self.playable[0]), float(self.playable[1])
        else:
            low, high = 53.0, 77.0
        self._show_pitches(*fitted_pitches(low, high, self.plot_rect.height()))

    def scroll_pitch(self, notches: float) -> None:
        """Scroll the roll up or down by notches of the wheel."""
        bottom, top = self.y_range
        self.choose_pitches(*kept_pitches(bottom + notches * ROWS_A_NOTCH, top - bottom))

    def zoom_pitch(self, factor: float, at: float | None = None) -> None:
        """Show ``factor`` times fewer pitches around the pitch ``at``; by default around the selected notes or the
        middle.
        """
        if at is None:
            bottom, top = self.y_range
            selected = self.session.selection.notes
            here = [note.pitch + 0.5 for note in map(self.model.note, selected) if note is not None]
            seen = [pitch for pitch in here if bottom <= pitch <= top]
            at = sum(seen) / len(seen) if seen else (bottom + top) / 2
        self.choose_pitches(*zoomed_pitches(self.y_range, factor, at))

    def zoom_y(self, mouse: LaneMouse, steps: float) -> None:
        self.zoom_pitch(ZOOM_A_NOTCH**steps, mouse.value)

    def choose_pitches(self, bottom: float, top: float) -> None:
        """Show the pitches from ``bottom`` to ``top`` regardless of the lane's height."""
        self._pitches_chosen = True
        self._show_pitches(bottom, top)

    def _show_pitches(self, bottom: float, top: float) -> None:
        self.set_y_range(bottom, top)
        if hasattr(self, "keyboard"):
            self.keyboard.update()

    def pitch_text(self, pitch: int) -> str:
        """Return the name of a pitch by the user's settings."""
        instrument = self._instrument()
        return pitch_text(
            self.session.pitch_display, pitch, instrument.transposition_semitones if instrument is not None else 0
        )

    def pitch_tip(self, pitch: int) -> str:
        """Tip of a key of the keyboard."""
        return self.tr("piano_roll.click_to_select_all_its").format(pitch=self.pitch_text(pitch))

    def select_pitch(self, pitch: int, add: bool) -> None:
        """Select all notes of a pitch in the active player's part; with ``add`` in addition to the selection."""
        if self.session.player is None:
            return
        found = self.model.notes_of_pitch(pitch)
        self.session.select(Selection((self.session.selection.notes if add else frozenset()) | found))

    # Mouse

    @property
    def drag_px(self) -> float:
        """Return the distance in pixels from which a press is a drag."""
        return QApplication.startDragDistance() / 2

    def press(self, mouse: LaneMouse) -> None:
        self._gesture = self._begin(mouse)

    def _begin(self, mouse: LaneMouse) -> MouseGesture | None:
        entry = self.entries.end_at(mouse) if self._tool is Tool.SELECT else None
        if entry is not None:
            return EntryDrag(self, mouse, *entry)
        hit = self.model.note_at(mouse)
        held = self.marks.press(mouse, hit is not None) if self._tool is Tool.SELECT else None
        if held is not None:
            return held
        player = self.session.player
        if self._tool is Tool.ERASE:
            return Erase(self, mouse)
        if self._tool is Tool.SPLIT:
            if hit is not None:
                self._split(hit, mouse)
            return None
        if hit is not None:
            return self._take_hold(hit, mouse)
        if self._tool is Tool.DRAW and player is not None and 0 <= mouse.value < 128:
            return Draw(self, mouse, player.part_id, self._velocity)
        return LassoNotes(self, mouse)

    def _take_hold(self, note: Note, mouse: LaneMouse) -> MouseGesture | None:
        self.model.bring_forward(note)
        selected = self.session.selection.notes
        if _copies(mouse):
            return Copy(self, mouse, note)
        if mouse.ctrl and not mouse.alt:
            self.session.select(Selection(selected ^ {note.id}))
            return None
        narrow = note.id in selected and len(selected) > 1 and not mouse.shift
        if note.id not in selected:
            self.session.select(Selection((selected if mouse.shift else frozenset()) | {note.id}))
        elif self.session.selection.events or self.session.selection.span:
            self.session.select(Selection(selected))
        self._velocity = note.velocity
        if mouse.ctrl:
            return Velocity(self, mouse, note)
        edge = self.model.edge_at(note, mouse)
        if edge is not None:
            return Resize(self, mouse, note, at_start=edge)
        return Move(self, mouse, note, narrow)

    def _split(self, note: Note, mouse: LaneMouse) -> None:
        self.session.attempt(
            edit_of_notes(self.session.project, "edit.split_notes", {note.id}),
            lambda project: notes.split(project, {note.id}, mouse.snapped_tick)[0],
        )

    def drag(self, mouse: LaneMouse) -> None:
        if self._gesture is not None:
            self._gesture.drag(mouse)
            self._show_gesture(self._gesture)
        self.keyboard.show_pitch(int(mouse.value // 1))

    def _show_gesture(self, gesture: MouseGesture) -> None:
        """Draw a gesture's rectangle, or show the new pitch or velocity of a note."""
        if isinstance(gesture, LassoNotes):
            self.lasso.show(rect(gesture.box) if gesture.box is not None else None)
        elif isinstance(gesture, EntryDrag):
            self.entries.show(gesture)
            if gesture.began:
                QToolTip.showText(QCursor.pos(), self.entries.drag_text(gesture), self.plot)
        elif isinstance(gesture, RollGesture) and gesture.began:
            if gesture.copies:
                self.plot.setCursor(Qt.CursorShape.DragCopyCursor)
            self._tell_pitch(gesture.moved)
            self._tell_velocity(gesture.sounded)

    def release(self, mouse: LaneMouse) -> None:
        gesture, self._gesture = self._gesture, None
        if gesture is not None:
            gesture.release(mouse)
        self.entries.show(None)
        self.set_tool(self._tool)
        QToolTip.hideText()

    def cancel(self) -> None:
        gesture, self._gesture = self._gesture, None
        if gesture is not None:
            gesture.cancel()
        self.entries.show(None)
        self.set_tool(self._tool)
        QToolTip.hideText()

    def double_click(self, mouse: LaneMouse) -> None:
        """Add a note at an empty place of the roll, if the selection tool is active."""
        player, on_note = self.session.player, self.model.note_at(mouse) is not None
        if self._tool is not Tool.SELECT or player is None or on_note:
            return
        if self.marks.at(mouse, on_note) is None:
            Draw(self, mouse, player.part_id, self._velocity).release(mouse)

    def hover(self, mouse: LaneMouse | None) -> None:
        self.keyboard.show_pitch(None if mouse is None else int(mouse.value // 1))
        over_entry = self.entries.hover(mouse if self._tool is Tool.SELECT else None)
        if mouse is None:
            self.marks.hover(None, False)
            self.lasso.show(None)
            self.reported.emit("")
            return
        hit = self.model.note_at(mouse)
        mark = self.marks.hover(mouse if self._tool is Tool.SELECT else None, hit is not None)
        self._report(mouse, hit, mark)
        if self._tool is Tool.SPLIT:
            x = self.axis.x_px(self.session.project.score.tempo_map.seconds(float(mouse.snapped_tick)))
            top = self.y_px(int(mouse.value // 1) + 1)
            self.lasso.show(None, QLineF(x, top - 3, x, top + self.row_px + 3) if hit is not None else None)
        elif self._tool in (Tool.SELECT, Tool.DRAW):
            edge = self.model.edge_at(hit, mouse) if hit is not None and not mouse.ctrl else None
            if over_entry or self.marks.holds_end:
                self.plot.setCursor(Qt.CursorShape.OpenHandCursor)
            elif edge is not None:
                self.plot.setCursor(Qt.CursorShape.SizeHorCursor)
            else:
                self.set_tool(self._tool)

    def key(self, event: QKeyEvent) -> bool:
        """Clear the selection when Escape is pressed; return whether the event was handled."""
        if event.key() == Qt.Key.Key_Escape and self.session.selection:
            self.session.select(Selection())
            return True
        return False

    def wheel(self, mouse: LaneMouse, steps: float) -> bool:
        """Scroll the pitches; with Alt zoom around the pitch under the mouse."""
        if not mouse.alt:
            self.scroll_pitch(steps)
            return True
        self.zoom_pitch(ZOOM_A_NOTCH**steps, mouse.value)
        return True

    def pan_y(self, by_px: float) -> None:
        """Scroll the pitches during a drag with the middle button, by pixels, positive downwards."""
        bottom, top = self.y_range
        self.choose_pitches(*kept_pitches(bottom + by_px / self.row_px, top - bottom))

    def context_menu(self, mouse: LaneMouse) -> QMenu | None:
        hit = self.model.note_at(mouse)
        menu = self.marks.context_menu(mouse, hit is not None)
        if menu is not None:
            return menu
        if hit is not None and hit.id not in self.session.selection.notes:
            self.model.bring_forward(hit)
            self.session.select(Selection(frozenset({hit.id})))
        menu = QMenu(self)
        add_actions(menu, self.session, MENU)
        return menu

    def _tell_pitch(self, note_id: str) -> None:
        """Show the pitch of a dragged note in the tool bar."""
        note = self.model.note(note_id)
        if note is not None:
            QToolTip.showText(QCursor.pos(), self.pitch_text(note.pitch), self.plot)

    def _tell_velocity(self, note_id: str) -> None:
        """Show the velocity of a dragged note in the tool bar."""
        note = self.model.note(note_id)
        if note is not None:
            self._velocity = note.velocity
            QToolTip.showText(QCursor.pos(), self.tr("piano_roll.velocity").format(velocity=note.velocity), self.plot)

    def _report(self, mouse: LaneMouse, note: Note | None, mark: Mark | None) -> None:
        """Show the note or the position and pitch under the mouse in the tool bar, and the note's problems or the
        mark's description as a tool tip.
        """
        score = self.session.project.score
        tick = mouse.tick if note is None else note.onset_tick
        pitch = self.pitch_text(int(mouse.value // 1))
        text = self.tr("piano_roll.pitch_place").format(pitch=pitch, place=score.metre_map.label(int(tick // 1)))
        tip = ""
        if note is not None:
            text += self.tr("piano_roll.velocity_2").format(velocity=note.velocity)
            player = self.session.player
            known = self.session.problems(player.id) if player is not None else ()
            found = [problem for problem in known if problem.note_id == note.id]
            tip = "\n".join(sentence(problem.message, self.session) for problem in found)
        self.reported.emit(text)
        if mark is not None:
            tip = self.marks.tip(mark)
        if self.plot.toolTip() != tip:
            self.plot.setToolTip(tip)

    def plot_resized(self) -> None:
        super().plot_resized()
        if hasattr(self, "marks") and not self._pitches_chosen:
            self.show_legibly()

    # Changes of the session

    def project_changed(self, change: Change) -> None:
        if change.opened:
            self.model.forget()
            self.show_legibly()
        if change.before.score is not change.after.score or change.before.players is not change.after.players:
            self.update_items()
            self.keyboard.update()
        elif change.before.corrections is not change.after.corrections:
            self.marks.update()

    def performance_changed(self) -> None:
        self._redraw(self.labels)

    def selection_changed(self, before: Selection) -> None:
        now = self.session.selection
        if (before.notes, before.events) != (now.notes, now.events):
            self._redraw(self.notes)

    def players_changed(self) -> None:
        front = self.model.front()
        if front is not None and len(front[0]):
            bottom, top = self.y_range
            if front[0].pitch.min() < bottom or front[0].pitch.max() + 1 > top:
                self.show_legibly()
        self.keyboard.update()
        self.update_items()

    def theme_changed(self) -> None:
        self.keyboard.update()

    def retranslate(self) -> None:
        self.keyboard.update()

    def _redraw(self, item: LaneItem[Any]) -> None:
        item.update()

    def _set_font(self) -> None:
        font = QFont(self.font())
        if 0 < font.pointSizeF() < LEAST_TEXT_PT:
            font.setPointSizeF(LEAST_TEXT_PT)
        self.setFont(font)
        self.labels.forget_fonts()

    # Qt overrides

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.keyboard.setGeometry(GUTTER_PX - KEYBOARD_PX, 0, KEYBOARD_PX, self.height())

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.FontChange and hasattr(self, "labels"):
            self.labels.forget_fonts()
        super().changeEvent(event)


def _copies(mouse: LaneMouse) -> bool:
    """Return whether a drag copies notes: with Ctrl, on macOS with Option, as in file managers."""
    return mouse.alt and not mouse.ctrl if sys.platform == "darwin" else mouse.ctrl and not mouse.alt
