"""The dynamics lane: letters and hairpins of the active player, below the piano roll as below a staff."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from msgspec.structs import replace
from PySide6.QtCore import QLineF, QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QKeyEvent, QPainter, QPen
from PySide6.QtWidgets import QMenu, QWidget

from app.editor.additions import tell_reach
from app.editor.edit_names import edit_at
from app.editor.selection import Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.by_hand.mark_corrections import SetMark
from app.project.edit.marks import replace_mark, set_marks
from app.project.undoable_document import Change
from app.score.marks import Mark
from widgets.common.clicks import on_click
from widgets.common.menus import add_actions
from widgets.timeline.lane import Lane, LaneItem, LaneMouse
from widgets.timeline.marks.glyph_sheet import CALM, HAND_PX, MarkColours, Pictured, pictured
from widgets.timeline.marks.letters import ASCENT, DESCENT, are_letters, letters_path
from widgets.timeline.model.gestures import MouseGesture
from widgets.timeline.model.marks.mark_drag import MarkDrag, Zone
from widgets.timeline.model.marks.placed_dynamics import PlacedDynamic, TimedMarks, placed_dynamics
from widgets.timeline.model.marks.shown_marks import ShownMarks
from widgets.timeline.plot.drawing import shade, small_font
from widgets.timeline.plot.scrolled_picture import ScrolledPicture
from widgets.timeline.roll.marks_on_notes import MENU, mark_tip
from widgets.timeline.zoom_and_scroll import TimeAxis

OFFERED: Final = ("ppp", "pp", "p", "mp", "mf", "f", "ff", "fff", "fp", "sf", "sfz")
LEAST_LETTER_PX, MOST_LETTER_PX = 7.0, 11.0
LINES_OF_LETTER: Final = ASCENT + DESCENT


@lru_cache(maxsize=128)
def _letters(text: str, height_px: float, rgba: int, ratio: float) -> Pictured:
    return pictured(letters_path(text, height_px)[0], rgba, ratio)


class _Dynamics(LaneItem["DynamicsLane"]):
    """Draws the visible dynamics marks of the lane."""

    def __init__(self, lane: DynamicsLane) -> None:
        super().__init__(lane)
        self._picture = ScrolledPicture(lane)

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        if len(lane.marks.of_player.at_ticks):
            colours = MarkColours(lane.session.tokens, lane.marks.selected, None)
            look = lane.marks.of_player, lane.session.project.score.tempo_map, colours, lane.font()
            self._picture.draw(painter, look, lambda painter, *span_s: self._paint(painter, colours, span_s))

    def _paint(self, painter: QPainter, colours: MarkColours, span_s: tuple[float, float]) -> None:
        lane, tokens = self.lane, colours.tokens
        of_player, letter_px = lane.marks.of_player, lane.letter_px
        painter.setFont(small_font(lane.font()))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        for placed in lane.placed(span_s):
            mark, colour = of_player.marks[placed.mark], colours.of(placed.mark)
            if placed.is_hairpin:
                left, top, right, bottom = placed.box
                narrow, wide = (left, right) if mark.kind == "crescendo" else (right, left)
                middle = (top + bottom) / 2
                painter.setPen(QPen(colour, 1.3))
                painter.drawLines([QLineF(narrow, middle, wide, top), QLineF(narrow, middle, wide, bottom)])
            else:
                self._paint_letters(painter, placed, mark, colour, letter_px)
            if of_player.by_hand[placed.mark]:
                corner = QRectF(round(placed.box.left) - 1.0, 2.0, HAND_PX, HAND_PX)
                painter.fillRect(corner, QColor(tokens.by_hand))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)

    def _paint_letters(
        self, painter: QPainter, placed: PlacedDynamic, mark: Mark, colour: QColor, letter_px: float
    ) -> None:
        lane, box = self.lane, placed.box
        base = round(box.top + ASCENT * letter_px)
        if are_letters(mark.text):
            ratio = lane.plot.devicePixelRatioF()
            picture, left, top = _letters(mark.text, letter_px, colour.rgba(), ratio)
            painter.drawImage(QPointF(round(box.left) + left, base + top), picture)
        else:
            painter.setPen(colour)
            painter.drawText(QPointF(box.left, base), mark.text)
        until_px = placed.holds_px if placed.end_px is None else placed.end_px
        if until_px is not None and until_px > box.right + 6.0:
            y = round(base - letter_px / 2) + 0.5
            painter.setPen(QPen(shade(colour.name(), CALM // 2), 1.0, Qt.PenStyle.DashLine))
            painter.drawLine(QPointF(box.right + 4.0, y), QPointF(until_px, y))
            if placed.end_px is not None:
                painter.setPen(QPen(colour, 1.0))
                painter.drawLine(QPointF(placed.end_px, y - 4.0), QPointF(placed.end_px, y + 4.0))


class DynamicsLane(Lane):
    """Lane of dynamics and hairpins, which can be added, dragged in time and changed."""

    id = "dynamics"
    preferred_height_px = 34
    least_height_px = 24
    hides_empty = True
    is_essential = True

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        self.marks = ShownMarks(session)
        self._timed: TimedMarks | None = None
        self._drag: MouseGesture | None = None
        super().__init__(session, axis, parent)
        _Dynamics(self)
        self.texted(self.title, text="dynamics_lane.title", tip="dynamics_lane.tip")

    # Display

    @property
    def letter_px(self) -> float:
        """Height of a small letter of a dynamic in pixels."""
        return min(max((self.plot_rect.height() - 8.0) / LINES_OF_LETTER, LEAST_LETTER_PX), MOST_LETTER_PX)

    def placed(self, span_s: tuple[float, float] | None = None) -> tuple[PlacedDynamic, ...]:
        """Return the dynamics marks with their positions within a span of seconds, or the visible ones."""
        of_player, tempo, player = self.marks.of_player, self.session.project.score.tempo_map, self.session.player
        if not len(of_player.at_ticks) or player is None:
            return ()
        part = self.session.project.part(player)
        last_tick = max((note.end_tick for note in part.notes), default=0) if part.source == "sound" else None
        timed = self._timed
        if timed is None or (timed.of_player, timed.tempo, timed.last_tick) != (of_player, tempo, last_tick):
            self._timed = timed = TimedMarks(of_player, tempo, last_tick)
        letter_px, font = self.letter_px, small_font(self.font())

        def width_of(text: str) -> float:
            if are_letters(text):
                return letters_path(text, letter_px)[1]
            return QFontMetricsF(font).horizontalAdvance(text)

        top = (self.plot_rect.height() - letter_px * LINES_OF_LETTER) / 2
        band = top, top + letter_px * LINES_OF_LETTER
        span_s = span_s or (self.axis.start_s, self.axis.end_s)
        return tuple(placed_dynamics(timed, self.axis, span_s, band, width_of, self.marks.selected))

    @property
    def is_empty(self) -> bool:
        """True if no player has a dynamic, or marks are hidden."""
        if not self.marks.shown:
            return True
        project = self.session.project
        written = any(not mark.note_id for part in project.score.parts for mark in part.marks)
        return not written and not any(
            isinstance(item, SetMark) and item.note_id is None
            for corrections in project.corrections.values()
            for item in corrections
        )

    def set_shown(self, shown: bool) -> None:
        """Show or hide the dynamics marks."""
        if shown != self.marks.shown:
            self.marks.shown = shown
            self.update_items()

    def show_marks(self) -> None:
        """Redraw the dynamics marks after a change."""
        self.update_items()

    def project_changed(self, change: Change) -> None:
        if change.before.corrections is not change.after.corrections or change.before.score is not change.after.score:
            self.update_items()

    def selection_changed(self, before: Selection) -> None:
        if before.events != self.session.selection.events:
            self.update_items()

    def performance_changed(self) -> None:
        """Do nothing: dynamics belong to the project, not to the performance."""

    def players_changed(self) -> None:
        self.update_items()

    # Mouse

    def at(self, mouse: LaneMouse) -> tuple[Mark, Zone] | None:
        """Return the dynamics mark under the mouse and the grabbed part of it; None if there is none."""
        for placed in reversed(self.placed()):
            zone = placed.zone_at(mouse.x_px, mouse.y_px)
            if zone is not None:
                return self.marks.of_player.marks[placed.mark], zone
        return None

    def press(self, mouse: LaneMouse) -> None:
        found = self.at(mouse)
        self._drag = None
        if found is None:
            if not (mouse.ctrl or mouse.shift):
                self.session.select(Selection())
            return
        self.marks.select(found[0], add=mouse.shift, toggle=mouse.ctrl)
        if not (mouse.ctrl or mouse.shift):
            self._drag = MarkDrag(self, mouse, *found)

    def drag(self, mouse: LaneMouse) -> None:
        if self._drag is not None:
            self._drag.drag(mouse)

    def release(self, mouse: LaneMouse) -> None:
        drag, self._drag = self._drag, None
        if drag is not None:
            drag.release(mouse)

    def cancel(self) -> None:
        drag, self._drag = self._drag, None
        if drag is not None:
            drag.cancel()

    def double_click(self, mouse: LaneMouse) -> None:
        """Open the menu of dynamics for the mark under the mouse, or for a new one."""
        self._drag = None
        found = self.at(mouse)
        if found is None or found[0].kind == "dynamic":
            self._offer(found[0] if found is not None else None, mouse.snapped_tick)

    def hover(self, mouse: LaneMouse | None) -> None:
        found = self.at(mouse) if mouse is not None else None
        if found is not None and found[1] != "whole":
            self.plot.setCursor(Qt.CursorShape.SizeHorCursor)
        else:
            self.plot.unsetCursor()
        tip = mark_tip(self.marks.of_player, found[0]) if found is not None else ""
        if tip != self.plot.toolTip():
            self.plot.setToolTip(tip)

    def key(self, event: QKeyEvent) -> bool:
        """Open the menu of dynamics for the selected one on Enter."""
        marks = self.marks.of_player.marks
        chosen = [marks[number] for number in sorted(self.marks.selected) if marks[number].kind == "dynamic"]
        if event.key() not in (Qt.Key.Key_Return, Qt.Key.Key_Enter) or not chosen:
            return False
        self._offer(chosen[0], chosen[0].tick)
        return True

    def context_menu(self, mouse: LaneMouse) -> QMenu | None:
        found = self.at(mouse)
        menu = QMenu(self)
        if found is not None:
            self.marks.select(found[0])
        if found is None or found[0].kind == "dynamic":
            self._fill(menu, found[0] if found is not None else None, mouse.snapped_tick)
        if found is not None:
            menu.addSeparator()
            add_actions(menu, self.session, MENU)
        return menu

    # Typing

    def _offer(self, mark: Mark | None, tick: int) -> None:
        """Open the menu of dynamics for a mark, or for a new one at a tick."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._fill(menu, mark, tick)
        seconds = self.session.project.score.tempo_map.seconds(float(mark.tick if mark is not None else tick))
        menu.popup(self.plot.mapToGlobal(QPoint(round(self.axis.x_px(seconds)), self.plot.height())))

    def _fill(self, menu: QMenu, mark: Mark | None, tick: int) -> None:
        for text in OFFERED:
            entry = menu.addAction(text)
            entry.setObjectName(f"dynamic_{text}")
            entry.setCheckable(True)
            entry.setChecked(mark is not None and mark.text == text)
            on_click(entry, self._write, text, mark, tick)

    def _write(self, text: str, mark: Mark | None, tick: int) -> None:
        """Change the text of a dynamic, or add one at a tick if ``mark`` is None."""
        player = self.session.player
        if player is None or (mark is not None and mark.text == text):
            return
        if mark is None:
            changed = Mark("dynamic", tick=max(tick, 0), text=text)
            name = edit_at(self.session.project, "edit.add_dynamic", 1, (player.id,), (changed.tick,))
            done = self.session.attempt(name, lambda project: set_marks(project, player.id, [changed]))
        else:
            changed, before = replace(mark, text=text), mark
            name = Message("edit.set_dynamic", {"text": text})
            done = self.session.attempt(name, lambda project: replace_mark(project, player.id, before, changed))
        if done:
            tell_reach(self.session, [(player.id, changed.tick)], text)
            self.session.select(Selection(events=frozenset({self.marks.key(changed)})))
