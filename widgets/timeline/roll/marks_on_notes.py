"""Marks in the piano roll on the active player's notes, which can be selected and dragged."""

from __future__ import annotations

from PySide6.QtCore import QRectF
from PySide6.QtGui import QFontMetricsF, QPainter
from PySide6.QtWidgets import QMenu

from app.editor.session import Session
from app.editor.translated import tr
from app.score.marks import MARK_KINDS, Mark
from widgets.common.event_names import mark_name
from widgets.common.menus import add_actions
from widgets.timeline.marks.glyph_sheet import MarkColours, paint_marks
from widgets.timeline.model.gestures import MouseGesture
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.marks.mark_drag import MarkDrag, Zone
from widgets.timeline.model.marks.mark_table import MarkList, MarkTable
from widgets.timeline.model.marks.placed_marks import MarkRoom, PlacedMarks, placed_marks
from widgets.timeline.model.marks.shown_marks import ShownMarks
from widgets.timeline.plot.plot import LaneItem
from widgets.timeline.plot.scrolled_picture import ScrolledPicture
from widgets.timeline.roll.drawn_notes import RollView
from widgets.timeline.roll.fingerings_on_notes import INSIDE_PX

AIR_ROWS = 3.0
MENU = ("events.give_back", "edit.delete")


def mark_tip(of_player: MarkList, mark: Mark) -> str:
    """Return the name, text and origin of a mark."""
    number = of_player.by_id.get(mark.id)
    by_hand = number is not None and bool(of_player.by_hand[number])
    lines = [f"{mark_name(mark.kind)} {mark.text}".rstrip()]
    lines.append(tr("marks.by_hand") if by_hand else tr("marks.in_score"))
    return "\n".join(lines)


class RollMarks(LaneItem[RollView]):
    """The marks on the active player's notes.

    Attributes
    ----------
    marks : ShownMarks
        The player's marks and the selection among them.
    """

    def __init__(self, lane: RollView) -> None:
        super().__init__(lane, 9.0)
        self.marks = ShownMarks(lane.session)
        self._known: tuple[tuple[object, ...], PlacedMarks | None] = ((), None)
        self._picture = ScrolledPicture(lane)
        self._held: int | None = None

    @property
    def session(self) -> Session:
        """The editor's session."""
        return self.lane.session

    @property
    def air_rows(self) -> float:
        """Return the number of rows that marks take above the highest note."""
        return AIR_ROWS if self._table() is not None else 0.0

    def show_marks(self) -> None:
        """Redraw the marks after a drag or a change of visibility."""
        self.update()

    def set_shown(self, shown: bool) -> None:
        """Show or hide the musical marks on the notes."""
        if shown != self.marks.shown:
            self.marks.shown = shown
            self.update()

    @property
    def placed(self) -> PlacedMarks | None:
        """Return the visible marks in the plot's pixels for the mouse, cached while positions are unchanged."""
        axis = self.lane.axis
        key = (self._look(), axis.start_s, axis.end_s)
        if self._known[0] != key:
            self._known = (key, self._placed(axis.start_s, axis.end_s))
        return self._known[1]

    def _table(self) -> MarkTable | None:
        front = self.lane.model.front()
        return self.marks.table(front[0]) if front is not None else None

    def _look(self) -> tuple[object, ...]:
        """Return the values that determine the marks' positions, other than horizontal scrolling; the layout is reused
        while they are equal.
        """
        lane, table, room = self.lane, self._table(), self.lane.plot_rect
        warned = lane.model.warned(table.notes) if table is not None else None
        return table, warned, lane.axis.px_per_s, lane.y_range, room.width(), room.height(), lane.font()

    def _placed(self, start_s: float, end_s: float) -> PlacedMarks | None:
        """Return the marks between two times in seconds, placed in the plot's pixels; None if there are none."""
        lane, table = self.lane, self._table()
        if table is None:
            return None
        room, line_px = lane.plot_rect, QFontMetricsF(lane.font()).height()
        hangs = lane.row_px < max(INSIDE_PX, line_px - 2.0)
        width_px = (end_s - start_s) * lane.axis.px_per_s
        within = MarkRoom(
            lane.axis, width_px, room.height(), lane.row_px, line_px, lane.y_range[1], start_s, end_s,
            line_px - 2.0 if hangs else 0.0, sorted(lane.model.warned(table.notes)),
        )  # fmt: skip
        return placed_marks(table, within)

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        if self._table() is None:
            return
        colours = MarkColours(self.lane.session.tokens, self.marks.selected, self._held)

        def paint(painter: QPainter, start_s: float, end_s: float) -> None:
            placed = self._placed(start_s, end_s)
            if placed is not None:
                paint_marks(painter, placed, colours, self.lane.font())

        self._picture.draw(painter, (self._look(), colours), paint)

    # Mouse

    def at(self, mouse: LaneMouse, over_note: bool) -> tuple[Mark, Zone] | None:
        """Return the mark under the mouse and the grabbed part of it; None if there is none.

        With ``over_note``, slurs are ignored except for the ends of a selected one, since the note is on top.
        """
        placed = self.placed
        if placed is None:
            return None
        marks = self.marks.of_player.marks
        number = placed.glyph_at(mouse.x_px, mouse.y_px)
        if number is not None:
            return marks[number], "whole"
        end = placed.arc_end_at(mouse.x_px, mouse.y_px)
        if end is not None and (not over_note or end[0] in self.marks.selected):
            return marks[end[0]], "first" if end[1] else "last"
        number = None if over_note else placed.arc_at(mouse.x_px, mouse.y_px)
        return (marks[number], "whole") if number is not None else None

    def press(self, mouse: LaneMouse, over_note: bool) -> MouseGesture | None:
        """Select and grab the mark at a point; return None if there is none."""
        found = self.at(mouse, over_note)
        front = self.lane.model.front()
        if found is None or front is None:
            return None
        mark, zone = found
        self.marks.select(mark, add=mouse.shift, toggle=mouse.ctrl)
        # A mark over several notes is moved only by its ends.
        stays = zone == "whole" and (bool(mark.last_note_id) or MARK_KINDS[mark.kind].anchor != "note")
        if mouse.ctrl or mouse.shift or stays:
            return MouseGesture(mouse)
        return MarkDrag(self, mouse, mark, zone, front[0])

    def hover(self, mouse: LaneMouse | None, over_note: bool) -> Mark | None:
        """Highlight the slur end under the mouse that can be dragged, and return the mark under the mouse."""
        found = None if mouse is None else self.at(mouse, over_note)
        held = self.marks.of_player.by_id.get(found[0].id) if found is not None and found[1] != "whole" else None
        if held != self._held:
            self._held = held
            self.update()
        return found[0] if found is not None else None

    @property
    def holds_end(self) -> bool:
        """True if the end of a slur is under the mouse."""
        return self._held is not None

    def tip(self, mark: Mark) -> str:
        """Return the name, text and origin of a mark."""
        return mark_tip(self.marks.of_player, mark)

    def context_menu(self, mouse: LaneMouse, over_note: bool) -> QMenu | None:
        """Return the context menu of the musical mark under the mouse; None if there is none."""
        found = self.at(mouse, over_note)
        if found is None:
            return None
        self.marks.select(found[0])
        menu = QMenu(self.lane.plot)
        add_actions(menu, self.session, MENU)
        return menu
