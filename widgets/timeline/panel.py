"""The timeline panel: a ruler over lanes with a common time axis, a tool bar above, a scroll bar below."""

from __future__ import annotations

from typing import Annotated, NamedTuple, TypeAlias

import msgspec
from PySide6.QtCore import QPoint, QSize, Qt, Signal
from PySide6.QtGui import QHideEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QHBoxLayout, QToolButton, QWidget

from app.editor.session import Session
from app.editor.stretches_of_time import scroll_limits, selected_span, whole_piece
from app.editor.timeline_view import Ghosts, Tool
from app.errors import Message
from app.project.undoable_document import Change
from widgets.common.controls import IconButton, Retranslated, named
from widgets.common.icons import icon
from widgets.common.layouts import in_column, in_row
from widgets.common.text import sentence
from widgets.timeline.front_lanes import FrontLanes, KeyboardNote
from widgets.timeline.lane import GUTTER_PX, Lane
from widgets.timeline.lane_layout import LaneLayout, LaneState, lane_state, lane_text
from widgets.timeline.lanes import LANES
from widgets.timeline.lanes.fingering.fingering_lane import FingeringLane
from widgets.timeline.lanes.takes.takes_lane import TakesLane
from widgets.timeline.marks.dynamics_lane import DynamicsLane
from widgets.timeline.model.roll.shown_notes import kept_pitches, moved_notes
from widgets.timeline.playhead import Playhead
from widgets.timeline.roll.piano_roll import ZOOM_A_KEY, PianoRoll
from widgets.timeline.roll.quantise import QuantisePopover
from widgets.timeline.ruler.flags import Flags
from widgets.timeline.ruler.time_ruler import Ruler
from widgets.timeline.stack import LaneStack
from widgets.timeline.stacked_players import PlayerLanes, StackedPlayers
from widgets.timeline.tool_bar import BUTTON_PX, ToolBar
from widgets.timeline.zoom_and_scroll import TimeAxis, TimeBar

ZOOM_A_CLICK = 1.5
FIRST_BARS, MOST_FIRST_BARS = 16, 24
"""Number of bars shown of a newly opened piece, and of the longest piece that is shown completely."""
SELECTION_AIR = 0.08


_Bounded: TypeAlias = Annotated[float, msgspec.Meta(ge=-1e6, le=1e6)]


class VisibleRange(NamedTuple):
    """Range of seconds and pitches that a timeline shows, as stored in the settings."""

    start_s: _Bounded
    end_s: _Bounded
    lowest: _Bounded
    highest: _Bounded


class TimelinePanel(Retranslated, QWidget):
    """The timeline panel, which is the session's `TimelineView`.

    Signals
    -------
    sought(float)
        Request to move the playhead to this time in seconds.
    arranged()
        The result of `save_state` has changed: lanes were folded, shown, hidden, moved or resized.
    """

    sought = Signal(float)
    arranged = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("timeline")
        self.session = session
        self.axis = TimeAxis(self)
        self._fitted = False

        self.roll = PianoRoll(session, self.axis)
        self.lanes: dict[str, Lane] = {}
        """Every lane by id, in their order from the top."""
        made = [kind(session, self.axis) for kind in LANES]
        for lane in (*made[:1], self.roll, *made[1:]):
            self.lanes[lane.id] = lane
        self.takes = next(lane for lane in made if isinstance(lane, TakesLane))
        self.dynamics = next(lane for lane in made if isinstance(lane, DynamicsLane))

        self.tool_bar = ToolBar(session, self.roll, self)
        self.flags = Flags(session, self.axis, self)
        self.ruler = Ruler(session, self.axis, self)
        keyboard = KeyboardNote(session, self.lanes, self)
        self.players = keyboard.players = StackedPlayers(session, self.axis)
        self.stack = LaneStack(session, tuple(self.lanes.values()), self.roll, self.players, self)
        for lane in self.lanes.values():
            lane.sought.connect(self.sought)
            lane.header.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
            lane.header.customContextMenuRequested.connect(self._header_menu)
        self.playhead = Playhead(session, self.axis, self.stack, self)
        self.lane_layout = LaneLayout(self.lanes, self.stack, self.roll, self.players, self)
        self.lane_layout.changed.connect(self.arranged)

        in_column(
            self.tool_bar, self.flags, self.ruler, (self.stack, 1), self._make_foot(), of=self, margins=0, spacing=0
        )
        self.playhead.raise_()
        self.quantise = QuantisePopover(session, self)

        for lane in self.lanes.values():
            lane.fold_changed.connect(self.playhead.place)
        self.flags.sought.connect(self.sought)
        self.ruler.sought.connect(self.sought)
        # The playback is notified, so setting the playhead moves it there.
        self.sought.connect(session.set_playhead)
        self.setFocusProxy(self.roll.plot)
        self.players.made.connect(self._stack_made)
        self.players.changed.connect(lambda: self.tool_bar.ghosts_button.setEnabled(not self.stacking))
        self._front = FrontLanes(session, self.lanes, self.roll, self.stack, keyboard)
        self.axis.changed.connect(self.playhead.place)
        session.changed.connect(self._session_changed)
        session.performance_changed.connect(self._set_limits)
        session.playhead_changed.connect(self._playhead_moved)
        session.revealed.connect(self.reveal)
        session.theme_changed.connect(self._theme_set)
        self._set_limits()
        self.axis.fit()
        self._theme_set()
        self.texted(self.lanes_button, text="timeline_panel.lanes", tip="timeline_panel.lanes_tip")
        session.timeline_view = self

    def _make_foot(self) -> QHBoxLayout:
        self.lanes_button = named(QToolButton(self), "lanes_menu")
        self.lanes_button.setAutoRaise(True)
        self.lanes_button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.lanes_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.lanes_button.setMinimumHeight(BUTTON_PX)
        self.lanes_button.setMenu(self.lane_layout.menu)
        self.time_bar = named(TimeBar(self.axis, self), "time_bar")
        zooms = (
            ("zoom_out", "timeline_panel.zoom_out_ctrl_wheel", self.zoom_out),
            ("zoom_in", "timeline_panel.zoom_in_ctrl_wheel", self.zoom_in),
            ("fit", "timeline_panel.show_whole_piece_double_click", self.fit),
        )
        self.zoom_buttons = {name: IconButton(self.session, name, tip_id, run, name) for name, tip_id, run in zooms}
        for button in self.zoom_buttons.values():
            button.setAutoRaise(True)
            button.setFixedSize(QSize(BUTTON_PX, BUTTON_PX))
        self.tool_bar.show_lanes_and_zoom(self.lanes_button, *self.zoom_buttons.values())
        return in_row((self.time_bar, 1), margins=(GUTTER_PX, 1, 0, 1))

    # Requests of commands

    @property
    def rolls(self) -> tuple[PianoRoll, ...]:
        """The visible piano rolls: the active player's, or those of all stacked players."""
        return tuple(place.roll for place in self.players.shown) if self.players.active else (self.roll,)

    @property
    def tool(self) -> Tool:
        """Tool of the left button on notes."""
        return self.roll.tool

    def set_tool(self, tool: Tool) -> None:
        """Set the tool of the left button."""
        for roll in {self.roll, *self.rolls}:
            roll.set_tool(tool)
        self.tool_bar.show_state()

    @property
    def ghosts(self) -> Ghosts:
        """Display of the other players' notes behind those of the active player."""
        return self.roll.ghosts_mode

    def set_ghosts(self, ghosts: Ghosts) -> None:
        """Set whether and how the notes of other players are drawn behind the active player's."""
        self.roll.set_ghosts(ghosts)
        self.tool_bar.show_state()
        self.arranged.emit()

    @property
    def marks_shown(self) -> bool:
        """True if slurs, articulations and dynamics are visible."""
        return self.roll.marks.marks.shown

    def show_marks(self, shown: bool) -> None:
        """Show or hide slurs, articulations and dynamics."""
        for roll in {self.roll, *self.rolls}:
            roll.marks.set_shown(shown)
        self.dynamics.set_shown(shown)
        self.lane_layout.show_lanes()
        self.arranged.emit()

    def zoom_in(self) -> None:
        """Zoom in around the playhead, or the middle if it is not visible."""
        self.axis.zoom(ZOOM_A_CLICK, self._zoom_centre())

    def zoom_out(self) -> None:
        """Zoom out around the playhead, or the middle if it is not visible."""
        self.axis.zoom(1 / ZOOM_A_CLICK, self._zoom_centre())

    def zoom_in_pitch(self) -> None:
        """Enlarge the rows of the piano roll, so that notes become taller."""
        self._zoom_pitch(ZOOM_A_KEY)

    def zoom_out_pitch(self) -> None:
        """Zoom out vertically, so that more pitches are visible."""
        self._zoom_pitch(1 / ZOOM_A_KEY)

    def _zoom_pitch(self, factor: float) -> None:
        for roll in self.rolls:
            roll.zoom_pitch(factor)

    def fit(self) -> None:
        """Show the whole piece, and the pitches of the players shown."""
        self.axis.fit()
        for roll in self.rolls:
            roll.fit_pitch()

    def zoom_to_selection(self) -> None:
        """Zoom the time axis to the span of everything selected."""
        span = selected_span(self.session)
        if span is not None:
            air = max(span[1] - span[0], 0.2) * SELECTION_AIR
            self.axis.show(span[0] - air, span[1] + air)

    def ask_quantise(self) -> None:
        """Open the quantise popover over the roll."""
        self.quantise.open_over(self._front.roll)

    def ask_take_name(self) -> None:
        """Open a field for the selected take's name."""
        self.lane_layout.show_lane(self.takes.id, True)
        self.takes.ask_name()

    def step_take(self, by: int) -> None:
        """Use the take above (-1) or below (1) for the selected span."""
        self.takes.step(by)

    def reveal(self, time_s: float) -> None:
        """Scroll to a time, and vertically to the notes selected there."""
        self.axis.reveal(time_s)
        for roll in self.rolls:
            roll.bring_notes_into_view(self.session.selection.notes)

    @property
    def seen(self) -> VisibleRange:
        """Visible range of seconds and pitches."""
        return VisibleRange(self.axis.start_s, self.axis.end_s, *self.roll.y_range)

    def show_range(self, seen: VisibleRange) -> None:
        """Show a range instead of the beginning of a newly opened piece."""
        self._fitted = True
        self.axis.show(seen.start_s, seen.end_s)
        self.roll.choose_pitches(*kept_pitches(seen.lowest, seen.highest - seen.lowest))

    def is_lane_open(self, lane_id: str) -> bool:
        """Return whether a lane is visible and unfolded."""
        return self.lane_layout.is_open(lane_id)

    def open_lane(self, lane_id: str, is_open: bool) -> None:
        """Show and unfold the lane with an id, or fold it."""
        self.lane_layout.open_lane(lane_id, is_open)

    def offer_fingerings(self, player_id: str, note_id: str, why: Message) -> None:
        """Show the fingerings of a note beside it, and why a typed one is invalid."""
        lane = self.players.lane_in_front(FingeringLane.id) or self.lanes[FingeringLane.id]
        plan, roll = self.session.plans.get(player_id), self._front.roll
        events = () if plan is None else plan.fingerings
        event = next((event for event in events if event.note_id == note_id), None)
        note = roll.model.note(note_id)
        if event is None or not isinstance(lane, FingeringLane):
            return
        x = min(max(self.axis.x_px(event.start_s), 0.0), self.axis.width_px - 60.0)
        y = roll.y_px(note.pitch + 1) if note is not None else 0.0
        place = roll.plot.mapTo(self.window(), QPoint(round(x), round(min(max(y, 0.0), roll.plot.height()))))
        lane.alternates.show_for(player_id, event, place, sentence(why, self.session, player_id))

    def fold_lanes(self, folded: bool) -> None:
        """Fold or unfold every lane of the timeline."""
        self.lane_layout.fold_all(folded)

    def save_state(self) -> str:
        """Return the order, visibility, folding and heights of the lanes as text."""
        return lane_text(self.lane_layout.state)

    def restore_state(self, state: str | LaneState) -> None:
        """Restore what `save_state` returned, ignoring lanes that do not exist."""
        saved = lane_state(state) if isinstance(state, str) else state
        if saved is not None:
            self.lane_layout.set_state(saved)
            self.set_ghosts(saved.ghosts)
            self.show_marks(saved.marks)
            self.set_stacked(saved.stacked)

    @property
    def stacked(self) -> bool:
        """True if the lanes of selected players are stacked whenever several are selected."""
        return self.players.requested

    @property
    def stacking(self) -> bool:
        """True while the lanes of several players are stacked."""
        return self.players.active

    def set_stacked(self, stacked: bool) -> None:
        """Stack the lanes of selected players, or show those of the active player."""
        if stacked != self.stacked:
            self._front.stack_lanes(stacked)
            self.arranged.emit()

    def _stack_made(self, place: PlayerLanes) -> None:
        """Connect the lanes of a newly stacked player."""
        for lane in place.lanes.values():
            lane.sought.connect(self.sought)
        place.roll.set_tool(self.tool)
        place.roll.marks.set_shown(self.marks_shown)
        place.roll.reported.connect(self.tool_bar.report)

    def _header_menu(self, place: QPoint) -> None:
        header = self.sender()
        assert isinstance(header, QWidget)
        lane = header.parentWidget()
        assert isinstance(lane, Lane)
        self.lane_layout.offer(lane, place)

    # Time

    def _zoom_centre(self) -> float:
        playhead_s, axis = self.session.playhead_s, self.axis
        inside = axis.start_s <= playhead_s <= axis.end_s
        return playhead_s if inside else (axis.start_s + axis.end_s) / 2

    def _show_beginning(self) -> None:
        """Show a short piece completely, else its first bars, so that notes are legible."""
        score = self.session.project.score
        self.axis.fit()
        if score.metre_map.bar_of_tick(max(score.sounding_end_tick - 1, 0)) > MOST_FIRST_BARS:
            end_s = score.tempo_map.seconds(float(score.metre_map.tick_of_bar(FIRST_BARS + 1)))
            self.axis.show(self.axis.start_s, end_s)

    def _set_limits(self) -> None:
        self.axis.set_limits(*scroll_limits(self.session), whole_piece(self.session))

    def _session_changed(self, change: Change) -> None:
        if change.opened or change.before.score is not change.after.score:
            self._set_limits()
        if change.opened:
            self.set_tool(Tool.SELECT)
            self._show_beginning()
            self._fitted = False
        elif change.before.score is not change.after.score and not self._is_dragged():
            # Scrolls to notes that an edit or its undo moved out of view.
            for roll in self.rolls:
                roll.bring_notes_into_view(moved_notes(change.before.score, change.after.score))

    def _playhead_moved(self, playhead_s: float) -> None:
        session = self.session
        if session.playing and session.follow and not self._is_dragged() and self.playhead.turn_page(playhead_s):
            for roll in self.rolls:
                roll.follow()
        self.playhead.place()

    def _is_dragged(self) -> bool:
        return self.players.dragging or any(lane.dragging for lane in self.lanes.values())

    def _theme_set(self) -> None:
        self.lanes_button.setIcon(icon("layout", self.session.tokens))
        self.playhead.update()

    # Qt overrides

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.playhead.place()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.axis.set_width(self._front.roll.plot.width())
        if not self._fitted:
            # All widths are known only now.
            self._fitted = True
            self._show_beginning()
            self.roll.show_legibly()
        self.playhead.place()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self.quantise.hide()
