"""Order, height, visibility and folding of the lanes: their stored state, and their menus."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec
from PySide6.QtCore import QObject, QPoint, Signal
from PySide6.QtWidgets import QApplication, QMenu, QWidget

from app.editor.timeline_view import Ghosts
from app.errors import FileError
from app.formats.json_data import decode_json
from app.project.undoable_document import Change
from widgets.common.clicks import on_click
from widgets.common.menus import add_actions, passing_menu
from widgets.timeline.lane import Lane
from widgets.timeline.roll.piano_roll import PianoRoll
from widgets.timeline.stack import LaneStack
from widgets.timeline.stacked_players import STACKED_IDS, StackedPlayers


class LaneState(msgspec.Struct, frozen=True, kw_only=True):
    """Stored state of the lanes, by their ids.

    Attributes
    ----------
    order : tuple of str
        Ids from the top. A lane missing here follows the lane that it follows in a new window.
    hidden, shown : tuple of str
        Lanes hidden by the user, and empty lanes shown by the user.
    folded : tuple of str
        Folded lanes.
    heights : dict of int
        Heights set by the user in pixels.
    ghosts : Ghosts
        Display of the other players behind the active one.
    marks : bool
        Whether slurs, articulations and dynamics are seen.
    stacked : bool
        Whether lanes of several selected players are stacked.
    stacked_heights : dict of int
        Heights of stacked lanes set by the user in pixels.
    stacked_folded : dict of tuple of str
        Folded stacked lanes by player.
    """

    order: tuple[str, ...] = ()
    hidden: tuple[str, ...] = ()
    shown: tuple[str, ...] = ()
    folded: tuple[str, ...] = ()
    heights: dict[str, int] = {}
    ghosts: Ghosts = Ghosts.GHOSTS
    marks: bool = True
    stacked: bool = False
    stacked_heights: dict[str, int] = {}
    stacked_folded: dict[str, tuple[str, ...]] = {}


class LaneLayout(QObject):
    """Layout of the lanes.

    Parameters
    ----------
    lanes : mapping of Lane
        All lanes by id in the order of a new window.
    stack : LaneStack
    roll : PianoRoll
    players : StackedPlayers
    parent : QWidget

    Signals
    -------
    changed()
        `state` has changed.
    """

    changed = Signal()

    def __init__(
        self,
        lanes: Mapping[str, Lane],
        stack: LaneStack,
        roll: PianoRoll,
        players: StackedPlayers,
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self._lanes, self._stack, self._roll, self._players = lanes, stack, roll, players
        self._hidden: set[str] = set()
        self._shown: set[str] = set()
        self._parent = parent
        self.menu = QMenu(parent)
        """Every lane, shown or not."""
        self.menu.aboutToShow.connect(self._fill_menu)
        for lane in lanes.values():
            lane.set_folded(lane.folded_at_first)
            lane.fold_changed.connect(self.changed)
            lane.fold_changed.connect(self._show_kinds)
        roll.session.changed.connect(self._project_changed)
        stack.changed.connect(self.changed)
        players.changed.connect(self.show_lanes)
        self.show_lanes()

    # State

    @property
    def state(self) -> LaneState:
        """Order, visibility and heights of the lanes, as they are stored."""
        order = tuple(lane.id for lane in self._stack.lanes)
        return LaneState(
            order=order,
            hidden=tuple(id for id in order if id in self._hidden),
            shown=tuple(id for id in order if id in self._shown),
            folded=tuple(id for id in order if self._lanes[id].folded),
            heights=self._stack.heights_px,
            ghosts=self._roll.ghosts_mode,
            marks=self._roll.marks.marks.shown,
            stacked=self._players.requested,
            stacked_heights=self._players.heights_px,
            stacked_folded=self._players.folded,
        )

    def set_state(self, state: LaneState) -> None:
        """Apply a stored layout of the lanes; unknown lanes are ignored."""
        self._hidden = set(state.hidden) & self._lanes.keys()
        self._shown = set(state.shown) & self._lanes.keys()
        self._stack.set_order(_completed(state.order, tuple(self._lanes)))
        self.show_lanes()
        for id, lane in self._lanes.items():
            lane.set_folded(id in state.folded)
        self._stack.set_heights(state.heights)
        self._players.set_layout(state.stacked_heights, state.stacked_folded)
        self._stack.verticalScrollBar().setValue(0)

    # User actions

    def is_shown(self, lane_id: str) -> bool:
        """Return whether a lane is visible, folded or not."""
        lane = self._lanes[lane_id]
        idle = lane.hides_empty and lane.is_empty and lane_id not in self._shown
        return lane_id not in self._hidden and not idle

    def is_open(self, lane_id: str) -> bool:
        """Return whether a lane is visible and unfolded."""
        return self.is_shown(lane_id) and not self._lanes[lane_id].folded

    def show_lane(self, lane_id: str, shown: bool) -> None:
        """Show or hide the lane with an id; the choice is stored."""
        (self._shown if shown else self._hidden).add(lane_id)
        (self._hidden if shown else self._shown).discard(lane_id)
        self.show_lanes()
        if shown:
            self._stack.bring_into_view(self._lanes[lane_id])
        self.changed.emit()

    def open_lane(self, lane_id: str, is_open: bool) -> None:
        """Show and unfold the lane with an id, or fold it."""
        if is_open and not self.is_shown(lane_id):
            self.show_lane(lane_id, True)
        self._fold(self._lanes[lane_id], not is_open)
        if is_open:
            self._stack.bring_into_view(self._lanes[lane_id])

    def _fold(self, lane: Lane, folded: bool) -> None:
        if folded and lane.isAncestorOf(QApplication.focusWidget() or self._stack):
            # The focus stays in the lane, on its button if it was folded.
            lane.fold_button.setFocus()
        lane.set_folded(folded)

    def fold_all(self, folded: bool) -> None:
        """Fold or unfold every visible lane of the timeline."""
        for id, lane in self._lanes.items():
            if self.is_shown(id):
                self._fold(lane, folded)

    def _project_changed(self, change: Change) -> None:
        before, after = change.before, change.after
        watched = (
            (before.takes, after.takes), (before.dancers, after.dancers), (before.corrections, after.corrections),
            (before.score, after.score), (before.audio, after.audio),
        )  # fmt: skip
        if change.opened or any(one is not other for one, other in watched):
            self.show_lanes()

    def show_lanes(self) -> None:
        """Show the lanes that the user has not hidden; empty lanes with `Lane.hides_empty` only if the user has shown
        them.
        """
        stacked = STACKED_IDS if self._players.active else ()
        for id, lane in self._lanes.items():
            lane.setVisible(self.is_shown(id) and id not in stacked)
        self._show_kinds()

    def _show_kinds(self) -> None:
        """Show the stacked players' lanes of the kinds that are visible and unfolded for a single player."""
        self._players.show_kinds([id for id in STACKED_IDS if self.is_open(id)])

    # Menus

    def _fill_menu(self) -> None:
        self.menu.clear()
        for lane in self._stack.lanes:
            action = self.menu.addAction(lane.title.text())
            action.setCheckable(True)
            action.setChecked(self.is_shown(lane.id))
            action.toggled.connect(lambda shown, id=lane.id: self.show_lane(id, shown))
        self.menu.addSeparator()
        add_actions(self.menu, self._roll.session, ("lanes.stacked",))
        self.menu.addSeparator()
        on_click(self.menu.addAction(self.tr("timeline_panel.unfold_all")), lambda: self.fold_all(False))
        on_click(self.menu.addAction(self.tr("timeline_panel.fold_all")), lambda: self.fold_all(True))

    def offer(self, lane: Lane, place: QPoint) -> None:
        """Open the menu of a lane at a point of its header."""
        at, last = self._stack.lanes.index(lane), len(self._stack.lanes) - 1
        menu = passing_menu(self._parent)
        up = menu.addAction(self.tr("timeline_panel.move_up"))
        up.setEnabled(at > 0)
        on_click(up, lambda: self._stack.shift(lane, -1))
        down = menu.addAction(self.tr("timeline_panel.move_down"))
        down.setEnabled(at < last)
        on_click(down, lambda: self._stack.shift(lane, 1))
        menu.addSeparator()
        fold = menu.addAction(self.tr("timeline_panel.unfold") if lane.folded else self.tr("timeline_panel.fold"))
        on_click(fold, lambda: self.open_lane(lane.id, lane.folded))
        on_click(menu.addAction(self.tr("timeline_panel.hide")), lambda: self.show_lane(lane.id, False))
        menu.popup(lane.header.mapToGlobal(place))


def _completed(order: tuple[str, ...], known: tuple[str, ...]) -> tuple[str, ...]:
    """Return the order of all ``known`` lanes: ``order``, with each missing lane inserted after the lane that precedes
    it in ``known``.
    """
    result = [id for id in dict.fromkeys(order) if id in known]
    for place, id in enumerate(known):
        if id not in result:
            result.insert(result.index(known[place - 1]) + 1 if place else 0, id)
    return tuple(result)


def lane_state(text: str) -> LaneState | None:
    """Decode a text made by `lane_text`; None if it is invalid."""
    try:
        return decode_json(text.encode("utf-8", "replace"), LaneState, "")
    except FileError:
        return None


def lane_text(state: LaneState) -> str:
    """Return the stored form of the lanes' layout, JSON."""
    return msgspec.json.encode(state).decode()
