"""The takes lane: a row for each take of the active player, and the takes used in the part."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import QMenu, QWidget

from app.editor.selection import Selection
from app.editor.session import Session
from app.errors import Message
from app.project.edit.placed_takes import BEFORE
from app.project.model import CompSpan
from app.project.undoable_document import Change
from app.score.clean import Fault
from instrument_maps.library import all_maps
from widgets.common.actions import actions
from widgets.common.controls import named
from widgets.common.menus import add_actions
from widgets.common.pitch import pitch_text
from widgets.timeline.lane import LaneMouse
from widgets.timeline.lanes.row_lane import RowLane
from widgets.timeline.lanes.takes.take_drawing import STRIP_PX, TakesItem
from widgets.timeline.lanes.takes.take_heads import TakeHeads
from widgets.timeline.model.takes.shown_takes import Swipe, TakesModel
from widgets.timeline.model.takes.take_rows import TakeRow
from widgets.timeline.zoom_and_scroll import TimeAxis

ROW_PX, LEAST_ROW_PX, MOST_ROW_PX = 38, 24, 72
SHOWN_ROWS, LEAST_SHOWN_ROWS = 6, 3
"""Greatest and least number of visible rows; others are reached by scrolling."""
EMPTY_PX = 62


class TakesLane(RowLane):
    """Lane with the takes as rows. A drag over a row uses that span of the take in the part; the boundary of two used
    spans can be dragged.
    """

    id = "takes"
    preferred_height_px = EMPTY_PX
    least_height_px = EMPTY_PX
    folded_at_first = True
    hides_empty = True
    row_limits_px = (LEAST_ROW_PX, MOST_ROW_PX)
    strip_px = STRIP_PX

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self.model = TakesModel(session, axis)
        self.heads = TakeHeads(self)
        self.item = TakesItem(self)
        session.listening.changed.connect(self.heads.update)
        self.refresh()
        self.texted(self.title, tip="takes_lane.tip")
        self.retranslate()

    def retranslate(self) -> None:
        self._show_title()
        self.update_items()

    def _show_title(self) -> None:
        count = max(len(self.rows) - 1, 0)
        self.title.setText(self.tr("takes_lane.takes").format(count=count) if count else self.tr("takes_lane.takes_2"))

    def empty_text(self) -> str:
        """Return the text of an empty lane: how to record a take."""
        player = self.session.player
        if player is None:
            return self.tr("takes_lane.no_active_player")
        return self.tr("takes_lane.empty").format(player=player.name, keys=self._record_keys())

    def _record_keys(self) -> str:
        action = actions(self.session).get("record.toggle")
        keys = action.shortcut().toString(QKeySequence.SequenceFormat.NativeText) if action is not None else ""
        return keys or self.tr("takes_lane.record")

    # Display

    def refresh(self) -> None:
        """Show the active player's recordings, if they have changed."""
        if not self.model.refresh():
            if not self.rows:
                self.update_items()
            return
        self._show_title()
        self._ask_room()
        self._scroll_to(self._scrolled_px)
        self.heads.update()
        self.update_items()

    def _ask_room(self) -> None:
        count = len(self.rows)
        if not count:
            self.ask_height(EMPTY_PX, EMPTY_PX)
            return
        strip = round(STRIP_PX)
        self.ask_height(strip + min(count, SHOWN_ROWS) * ROW_PX, strip + min(count, LEAST_SHOWN_ROWS) * LEAST_ROW_PX)

    def project_changed(self, change: Change) -> None:
        player = self.session.player
        if change.before.takes is not change.after.takes and player is not None and not change.opened:
            before, after = change.before.takes.get(player.id), change.after.takes.get(player.id)
            if after is not None and len(after.takes) > (len(before.takes) if before is not None else 0):
                # Show the new recording.
                self.set_folded(False)
        self.refresh()

    def players_changed(self) -> None:
        self._cancel_swipe()
        self.heads.cancel_drag()
        self.refresh()

    def selection_changed(self, before: Selection) -> None:
        now = self.session.selection
        if (before.take, before.span) != (now.take, now.span):
            self.heads.update()
            self.update_items()

    def theme_changed(self) -> None:
        self.heads.update()

    @property
    def is_empty(self) -> bool:
        return not any(recorded.takes for recorded in self.session.project.takes.values())

    @property
    def rows(self) -> tuple[TakeRow, ...]:
        """The row of the notes before the first take, then the takes."""
        return self.model.rows

    @property
    def comp(self) -> tuple[CompSpan, ...]:
        """The spans of the comp (the part assembled from takes), each with its take."""
        return self.model.comp

    def shown_comp(self) -> tuple[CompSpan, ...]:
        """Return the comp (the part assembled from takes) as it would be if the drag ended now."""
        return self.model.shown_comp()

    def shown_spans(self, take_id: str) -> tuple[CompSpan, ...]:
        """Return the spans in which the part uses a take; for the notes before the first take, the gaps of the comp."""
        return self.model.shown_spans(take_id)

    def number_of(self, take_id: str) -> int | None:
        """Return the row index of a take."""
        return self.model.number_of(take_id)

    # Layout of rows

    def count_rows(self) -> int:
        return len(self.rows)

    def rows_scrolled(self) -> None:
        self.heads.update()

    def row_at(self, y_px: float) -> TakeRow | None:
        """Return the take's row at a height in pixels; None outside."""
        number = self.row_number_at(y_px)
        return None if number is None else self.rows[number]

    def show_row(self, take_id: str) -> None:
        """Scroll the lane to the row of a take."""
        number = self.number_of(take_id)
        if number is not None:
            top, bottom = number * self.row_px, (number + 1) * self.row_px
            height = self.rows_rect.height()
            self._scroll_to(min(top, max(self._scrolled_px, bottom - height)))

    # Edits

    def choose(self, take_id: str) -> None:
        """Select a take and scroll to its row."""
        self.session.select(Selection(take=take_id))
        self.show_row(take_id)

    def ask_name(self) -> None:
        """Open a field for the selected take's name."""
        take_id = self.session.selection.take
        if take_id and self.model.take_of(take_id) is not None:
            self.set_folded(False)
            self.show_row(take_id)
            self.heads.type_name(take_id)

    def take_span(self, take_id: str, start_tick: int, end_tick: int) -> None:
        """Use the take between two ticks in the part, and select this span."""
        if self.model.take_span(take_id, start_tick, end_tick):
            self.show_row(take_id)

    # Mouse

    def press(self, mouse: LaneMouse) -> None:
        self.model.swipe = None
        if not self.rows:
            return
        row = self.row_at(mouse.y_px)
        edge = self._edge_at(mouse)
        if edge is not None:
            self.model.swipe = Swipe(mouse, row.take_id if row is not None else BEFORE, edge[0].end_tick, edge)
        elif row is not None:
            self.model.swipe = Swipe(mouse, row.take_id, max(mouse.snapped_tick, 0))
        elif mouse.y_px < STRIP_PX:
            self._select_span(mouse.tick)
        else:
            self.session.select(Selection())

    def drag(self, mouse: LaneMouse) -> None:
        swipe = self.model.swipe
        if swipe is not None:
            before = swipe.end_tick
            swipe.drag(mouse)
            if swipe.end_tick != before:
                self.update_items()

    def release(self, mouse: LaneMouse) -> None:
        swiped = self.model.swiped()
        swipe, self.model.swipe = self.model.swipe, None
        if swipe is None:
            return
        if not swipe.began:
            self._click(swipe)
        elif swiped is not None:
            self.take_span(swiped.take_id, swiped.start_tick, swiped.end_tick)
            if swipe.edge is not None:
                self._select_span((swiped.start_tick + swiped.end_tick) / 2)
        self.update_items()

    def double_click(self, mouse: LaneMouse) -> None:
        self.session.notice(Message("take.row_is_swiped"))

    def cancel(self) -> None:
        self._cancel_swipe()

    def _cancel_swipe(self) -> None:
        if self.model.swipe is not None:
            self.model.swipe = None
            self.update_items()

    def _edge_at(self, mouse: LaneMouse) -> tuple[CompSpan, CompSpan] | None:
        row = self.row_at(mouse.y_px)
        return self.model.edge_at(mouse, row) if row is not None or mouse.y_px < STRIP_PX else None

    def _click(self, swipe: Swipe) -> None:
        if swipe.at.y_px < STRIP_PX:
            self._select_span(swipe.at.tick)
            return
        span = self.model.span_at(swipe.at.tick)
        if span.take_id == swipe.take_id and swipe.at.tick >= 0:
            self.session.select(Selection(span=(span.start_tick, span.end_tick), take=span.take_id))
        else:
            self.choose(swipe.take_id)

    def _select_span(self, tick: float) -> None:
        self._choose_span(self.model.span_at(tick))

    def _choose_span(self, span: CompSpan) -> None:
        self.session.select(Selection(span=(span.start_tick, span.end_tick), take=span.take_id))
        self.show_row(span.take_id)

    def hover(self, mouse: LaneMouse | None) -> None:
        row = self.row_at(mouse.y_px) if mouse is not None else None
        if mouse is not None and self._edge_at(mouse) is not None:
            self.plot.setCursor(Qt.CursorShape.SplitHCursor)
            self.plot.setToolTip(self.tr("takes_lane.drag_to_change_where_one"))
            return
        if mouse is None or row is None:
            self.plot.setToolTip("")
            self.plot.unsetCursor()
            return
        self.plot.setCursor(Qt.CursorShape.IBeamCursor)
        self.plot.setToolTip(self._tip(row, mouse))

    def _tip(self, row: TakeRow, mouse: LaneMouse) -> str:
        reach_s = 3.0 / self.axis.px_per_s
        for index in row.left_out.between(mouse.time_s - reach_s, mouse.time_s + reach_s).tolist():
            name = pitch_text(self.session.pitch_display, int(row.left_out_pitches[index]), self._transposition())
            return self.tr("takes_lane.excluded_note").format(note=name, why=self.why(row.faults[index]))
        return self.heads.tip(row)

    def _transposition(self) -> int:
        player = self.session.player
        instrument = None if player is None else all_maps().get(player.instrument_id)
        return 0 if instrument is None else instrument.transposition_semitones

    def why(self, fault: Fault) -> str:
        """Return the reason, as text, why cleaning omits a note of a take."""
        return {
            "": "",
            "ghost": self.tr("takes_lane.short_and_soft_ghost_note"),
            "silent": self.tr("takes_lane.blown_too_softly_to_be"),
            "slip": self.tr("takes_lane.late_finger"),
            "double": self.tr("takes_lane.key_bounce"),
        }[fault]

    def context_menu(self, mouse: LaneMouse) -> QMenu | None:
        row = self.row_at(mouse.y_px)
        if row is None:
            return None
        span = self.model.span_at(mouse.tick)
        if self.session.selection.span is None or self.session.selection.take != row.take_id:
            if span.take_id == row.take_id and mouse.tick >= 0:
                self.session.select(Selection(span=(span.start_tick, span.end_tick), take=row.take_id))
            else:
                self.choose(row.take_id)
        return self.menu()

    def menu(self) -> QMenu:
        """Return the menu of the selected take."""
        menu = named(QMenu(self), "takes_menu")
        for group in (
            ("takes.listen", "takes.listen_alone"),
            ("takes.whole", "takes.above", "takes.below", "takes.before"),
            ("takes.rename", "takes.earlier_lane", "takes.later_lane"),
            ("takes.usual_cleaning", "takes.find_beats"),
            ("takes.remove",),
        ):
            add_actions(menu, self.session, group)
            menu.addSeparator()
        return menu

    # Keys

    def key(self, event: QKeyEvent) -> bool:
        """Handle keys: Up and Down use another take in the selected span, or select another take if no span is
        selected; Left and Right select adjacent spans.
        """
        key, modifiers = event.key(), event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
        if modifiers != Qt.KeyboardModifier.NoModifier or not self.rows:
            return False
        if key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self.step(-1 if key == Qt.Key.Key_Up else 1)
        elif key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            self._step_span(-1 if key == Qt.Key.Key_Left else 1)
        elif key == Qt.Key.Key_Escape and self.heads.dropped_before is not None:
            self.heads.cancel_drag()
        elif key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace) and self.session.selection.take:
            actions(self.session)["takes.remove"].trigger()
        elif key == Qt.Key.Key_Escape and self.session.selection.take is not None:
            self.session.select(Selection())
        else:
            return False
        return True

    def step(self, by: int) -> None:
        """Use the take above (-1) or below (1) for the selected span; without a span, select that take."""
        selection, requested = self.session.selection, self.model.beside(by)
        if selection.span is None:
            self.choose(requested)
        elif requested != self.model.current():
            self.take_span(requested, *selection.span)

    def _step_span(self, by: int) -> None:
        span = self.model.span_beside(by, self.session.playhead_s)
        if span is not None:
            self._choose_span(span)
