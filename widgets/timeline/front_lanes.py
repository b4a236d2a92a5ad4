"""Visibility and keyboard focus of the active player's lanes while the lanes of several players are stacked."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QApplication, QWidget

from app.editor.session import Session
from widgets.timeline.lane import Lane
from widgets.timeline.roll.piano_roll import PianoRoll
from widgets.timeline.stack import LaneStack
from widgets.timeline.stacked_players import STACKED_IDS, StackedPlayers


class KeyboardNote(QObject):
    """Remembers the lane with the keyboard focus before lanes are shown or hidden, which moves the focus.

    Created before the stack, so that its slots run first.
    """

    def __init__(self, session: Session, lanes: Mapping[str, Lane], parent: QWidget) -> None:
        super().__init__(parent)
        self._lanes = lanes
        self.players: StackedPlayers | None = None
        self.lane_id = ""
        """Id of that lane; empty: none."""
        session.players_changed.connect(self.take)

    def take(self) -> None:
        """Store the lane that has the keyboard focus."""
        focus = QApplication.focusWidget()
        own = (lane for lane in self._lanes.values() if focus is not None and lane.isAncestorOf(focus))
        stacked = None if self.players is None else self.players.lane_with(focus)
        lane = stacked or next(own, None)
        self.lane_id = "" if lane is None else lane.id


class FrontLanes(QObject):
    """Keeps the active player's lanes visible, and moves the focus to them from another player's."""

    def __init__(
        self, session: Session, lanes: Mapping[str, Lane], roll: PianoRoll, stack: LaneStack, keyboard: KeyboardNote
    ) -> None:
        super().__init__(stack)
        assert keyboard.players is not None
        self._lanes, self._roll, self._stack = lanes, roll, stack
        self._keyboard, self._players = keyboard, keyboard.players
        self._players.changed.connect(self._show_proxy)
        session.players_changed.connect(self._show_proxy)
        session.players_changed.connect(self._show)

    @property
    def roll(self) -> PianoRoll:
        """The visible piano roll of the active player."""
        front = self._players.front
        return self._roll if front is None else front.roll

    def stack_lanes(self, stacked: bool) -> None:
        """Switch stacking of the selected players' lanes on or off; the keyboard focus stays in the active player's
        lanes.
        """
        self._keyboard.take()
        self._players.request(stacked)
        self._pass_keyboard()
        if self._players.active:
            self._stack.bring_into_view(self._roll, at_top=True)

    def _show(self) -> None:
        """Scroll to the active player's notes, unless the mouse is being dragged in one of its lanes."""
        self._pass_keyboard()
        held = QApplication.mouseButtons() != Qt.MouseButton.NoButton and self._stack.underMouse()
        if self._players.active and not held:
            self._stack.bring_into_view(self._roll)

    def _pass_keyboard(self) -> None:
        lane_id = self._keyboard.lane_id
        if lane_id in STACKED_IDS:
            lane = self._players.lane_in_front(lane_id) or self._lanes[lane_id]
            lane.plot.setFocus()

    def _show_proxy(self) -> None:
        """Direct keys sent to the timeline to the notes of the active player."""
        timeline = self._keyboard.parent()
        if isinstance(timeline, QWidget):
            timeline.setFocusProxy(self.roll.plot)
