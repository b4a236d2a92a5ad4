"""Stacked lanes of several players: the open lanes of each selected player below the player's name."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import partial
from typing import Final

from PySide6.QtCore import QEvent, QObject, QRect, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QToolButton, QWidget

from app.editor.player_marks import PlayerMark, mark_players
from app.editor.session import Session
from app.editor.timeline_view import Ghosts
from app.messages import filled
from app.project.undoable_document import Change
from instrument_maps.library import all_maps
from widgets.common.clicks import on_switch
from widgets.common.controls import Retranslated, named
from widgets.common.instrument_name import instrument_name
from widgets.common.layouts import STRETCH, in_column, in_row
from widgets.common.plain import Label
from widgets.timeline.lane import FOLDED_PX, Lane
from widgets.timeline.lanes.breath import BreathLane
from widgets.timeline.lanes.fingering.fingering_lane import FingeringLane
from widgets.timeline.player_session import PlayerSession
from widgets.timeline.roll.piano_roll import PianoRoll
from widgets.timeline.zoom_and_scroll import TimeAxis

KINDS: Final[tuple[type[Lane], ...]] = (PianoRoll, FingeringLane, BreathLane)
"""Lanes that are stacked; other lanes show the active player."""
STACKED_IDS: Final = tuple(kind.id for kind in KINDS)
MOST_STACKED: Final = 8
"""Greatest number of stacked players."""
CAPTION_PX: Final = 24
HEIGHTS_PX: Final[Mapping[str, int]] = {PianoRoll.id: 92, FingeringLane.id: 46, BreathLane.id: 26}
"""Default heights in pixels by lane id; notes of ten pitches are legible in a roll."""
LOW_PX: Final[Mapping[str, int]] = {PianoRoll.id: 92, FingeringLane.id: 26, BreathLane.id: 24}
"""Heights in pixels used if they make all players visible at once, as with two in a window of usual size."""
MOST_ROLL_PX: Final = 260
"""Height in pixels up to which rolls grow if there is space."""
MOST_PX: Final = 600


class PlayerCaption(Retranslated, QWidget):
    """The line above a player's lanes: colour, name, instrument, mute and solo; a click makes the player active."""

    def __init__(self, session: PlayerSession, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("stacked_player")
        self.setFixedHeight(CAPTION_PX)
        self._session, self._shared = session, session.of_lanes
        self._buttons: dict[PlayerMark, QToolButton] = {
            "muted": self._button("muted", "M", "timeline_panel.mute"),
            "soloed": self._button("soloed", "S", "timeline_panel.solo"),
        }
        in_row(STRETCH, *self._buttons.values(), of=self, margins=(0, 1, 8, 1), spacing=2)
        self._shared.theme_changed.connect(self._colour_buttons)
        self._colour_buttons()

    def _button(self, mark: PlayerMark, letter: str, tip_id: str) -> QToolButton:
        button = named(QToolButton(self), f"stacked_{mark}")
        button.setText(letter)
        button.setCheckable(True)
        button.setFixedSize(CAPTION_PX - 2, CAPTION_PX - 2)
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        on_switch(button, lambda on: mark_players(self._shared, mark, on, (self._session.player_id,)))
        return self.texted(button, tip=tip_id, name=tip_id)

    def _colour_buttons(self) -> None:
        tokens = self._shared.tokens
        colours: dict[PlayerMark, str] = {"muted": tokens.warning, "soloed": tokens.good}
        for mark, colour in colours.items():
            style = f"QToolButton:checked {{ background: {colour}; border-color: {colour}; color: {tokens.sunken}; }}"
            self._buttons[mark].setStyleSheet(style)

    def show_player(self) -> None:
        """Update the displayed name, colour, instrument, mute and solo of the player."""
        player = self._session.player
        for mark, button in self._buttons.items():
            button.setChecked(player is not None and getattr(player, mark))
        self.setAccessibleName(player.name if player is not None else "")
        self.update()

    # Qt overrides

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._session.bring_forward()

    def paintEvent(self, event: QPaintEvent) -> None:
        player, tokens, painter = self._session.player, self._shared.tokens, QPainter(self)
        painter.fillRect(self.rect(), QColor(tokens.raised))
        if player is None:
            return
        if self._session.is_in_front:
            fill = QColor(tokens.accent)
            fill.setAlphaF(0.28)
            painter.fillRect(self.rect(), fill)
        painter.fillRect(QRect(0, 0, 5, self.height()), QColor(self._shared.colour(player)))
        painter.setPen(QColor(tokens.line))
        painter.drawLine(self.rect().topLeft(), self.rect().topRight())
        font = QFont(self.font())
        font.setBold(True)
        painter.setFont(font)
        painter.setPen(QColor(tokens.text))
        room = self.rect().adjusted(14, 0, -2 * CAPTION_PX - 14, 0)
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter, player.name)
        instrument = all_maps().get(player.instrument_id)
        room.setLeft(room.left() + round(QFontMetricsF(font).horizontalAdvance(player.name)) + 12)
        painter.setFont(self.font())
        painter.setPen(QColor(tokens.text_dim))
        name = player.instrument_id if instrument is None else instrument_name(instrument)
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter, name)


class PlayerLanes(QObject):
    """Name line and lanes of one player in the stack; the widgets are reused for different players."""

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget) -> None:
        super().__init__(parent)
        self.session = PlayerSession(session)
        self.caption = PlayerCaption(self.session, parent)
        self.lanes: dict[str, Lane] = {}
        for kind in KINDS:
            lane = self.lanes[kind.id] = kind(self.session.of_lanes, axis, parent)
            lane.setObjectName(f"stacked_{kind.id}")
            lane.plot.installEventFilter(self)
            lane.ask_height(HEIGHTS_PX[kind.id], HEIGHTS_PX[kind.id] // 2)
        self.roll.set_ghosts(Ghosts.ALONE)

    @property
    def roll(self) -> PianoRoll:
        """The piano roll among these lanes."""
        roll = self.lanes[PianoRoll.id]
        assert isinstance(roll, PianoRoll)
        return roll

    # Qt overrides

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        # Commands and menus refer to the player in front, so the lane's player comes to the front first.
        if event.type() in (QEvent.Type.MouseButtonPress, QEvent.Type.FocusIn):
            self.session.bring_forward()
        return super().eventFilter(watched, event)


class StackedPlayers(Retranslated, QWidget):
    """The lanes of all selected players, stacked in the order of the players; visible if several are selected.

    Selecting one of them only makes it active; selecting a single other player ends the stack until several are
    selected.

    Signals
    -------
    changed()
        Other lanes are shown, or their heights have changed.
    made(object)
        A `PlayerLanes` was made.
    """

    changed = Signal()
    made = Signal(object)

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("stacked_players")
        self._session, self._axis = session, axis
        self._requested = False
        self._ids: tuple[str, ...] = ()
        self._chosen: frozenset[str] = frozenset()
        self._open: tuple[str, ...] = STACKED_IDS
        self._set_px: dict[str, int] = {}
        self._sight_px = 0
        self._folded: set[tuple[str, str]] = set()
        """Players and ids of the lanes that are folded."""
        self._places: list[PlayerLanes] = []
        self._left_out = named(Label(), "stacked_players_left_out")
        self._left_out.setContentsMargins(12, 0, 8, 0)
        self._left_out.setFixedHeight(CAPTION_PX)
        self._column = in_column(self._left_out, STRETCH, of=self, margins=0, spacing=0)
        self.hide()
        session.players_changed.connect(self._choose)
        session.changed.connect(self._session_changed)
        session.theme_changed.connect(self._show_captions)

    @property
    def requested(self) -> bool:
        """True if lanes are to be stacked whenever several players are selected."""
        return self._requested

    def request(self, stacked: bool) -> None:
        """Switch stacking on or off; off shows only the lanes of the active player."""
        if stacked != self._requested:
            self._requested = stacked
            self._chosen = frozenset()
            self._choose()

    @property
    def active(self) -> bool:
        """True while lanes are stacked."""
        return len(self._ids) > 1

    @property
    def heights_px(self) -> dict[str, int]:
        """Return the heights set by the user in pixels by lane id."""
        return dict(self._set_px)

    @property
    def folded(self) -> dict[str, tuple[str, ...]]:
        """Return the ids of the folded lanes by player."""
        ids = sorted({id for id, _ in self._folded})
        return {id: tuple(lane_id for lane_id in STACKED_IDS if (id, lane_id) in self._folded) for id in ids}

    def set_layout(self, heights_px: Mapping[str, int], folded: Mapping[str, Collection[str]]) -> None:
        """Set heights and folded lanes as returned by `heights_px` and `folded`."""
        self._set_px = {id: _within(id, heights_px[id]) for id in STACKED_IDS if id in heights_px}
        self._folded = {(id, lane_id) for id, lane_ids in folded.items() for lane_id in lane_ids}
        self._show()

    @property
    def shown(self) -> tuple[PlayerLanes, ...]:
        """The visible players' lanes, from top to bottom."""
        return tuple(self._places[: len(self._ids)])

    @property
    def front(self) -> PlayerLanes | None:
        """The lanes of the active player, if they are stacked."""
        return next((one for one in self.shown if one.session.is_in_front), None)

    def lane_in_front(self, lane_id: str) -> Lane | None:
        """Return the active player's lane of a kind, if it is stacked."""
        return None if self.front is None or lane_id not in self._open else self.front.lanes[lane_id]

    def lane_with(self, widget: QWidget | None) -> Lane | None:
        """Return the stacked lane that is or contains a widget; None if there is none."""
        lanes = (lane for one in self.shown for lane in one.lanes.values())
        return None if widget is None else next((lane for lane in lanes if lane.isAncestorOf(widget)), None)

    @property
    def dragging(self) -> bool:
        """True while the mouse drags in one of the stacked lanes."""
        return any(lane.dragging for one in self.shown for lane in one.lanes.values())

    def show_kinds(self, lane_ids: Collection[str]) -> None:
        """Show lanes of the given ids for every stacked player."""
        kinds = tuple(id for id in STACKED_IDS if id in lane_ids)
        if kinds != self._open:
            self._open = kinds
            self._show()

    # Displayed players

    def _session_changed(self, change: Change) -> None:
        if change.opened:
            # Players of another piece may have the same ids.
            self._ids, self._chosen = (), frozenset()
            self._show()
        self._choose()

    def _choose(self) -> None:
        before, self._ids = self._ids, self._next_ids() if self._requested else ()
        if self._ids != before:
            self._show()
        else:
            self._show_captions()

    def _next_ids(self) -> tuple[str, ...]:
        project, chosen = self._session.project, self._session.players
        known = tuple(player.id for player in project.players)
        kept = tuple(id for id in known if id in self._ids)
        if len(chosen) > 1:
            if self._chosen == {*chosen} and chosen[0] in kept:
                return kept
            self._chosen = frozenset(chosen)
            ids = [id for id in known if id in self._chosen]
            # The player in front is always included.
            first = [id for id in ids if id != chosen[0]][: MOST_STACKED - 1]
            return tuple(id for id in ids if id == chosen[0] or id in first)
        self._chosen = frozenset()
        return kept if len(kept) > 1 and chosen and chosen[0] in kept else ()

    def _show(self) -> None:
        while len(self._places) < len(self._ids):
            self._add_place()
        for number, place in enumerate(self._places):
            id = self._ids[number] if number < len(self._ids) else ""
            place.session.show(id)
            place.caption.setVisible(bool(id))
            for lane_id, lane in place.lanes.items():
                lane.setVisible(bool(id) and lane_id in self._open)
                if id:
                    lane.set_folded((id, lane_id) in self._folded)
        self._left_out.setVisible(self._left_out_count > 0)
        self._show_captions()
        self.setVisible(self.active)
        self.changed.emit()

    def _add_place(self) -> None:
        place = PlayerLanes(self._session, self._axis, self)
        at = (1 + len(KINDS)) * len(self._places)
        self._column.insertWidget(at, place.caption)
        for offset, lane in enumerate(place.lanes.values()):
            self._column.insertWidget(at + 1 + offset, lane)
            lane.fold_changed.connect(partial(self._note_fold, place, lane))
            lane.resized_by_hand.connect(self._resize)
        self._places.append(place)
        self.made.emit(place)

    def _note_fold(self, place: PlayerLanes, lane: Lane) -> None:
        key = (place.session.player_id, lane.id)
        if lane.folded:
            self._folded.add(key)
        else:
            self._folded.discard(key)
        self.changed.emit()

    @property
    def _left_out_count(self) -> int:
        """Return the number of selected players that are not shown because the number of stacked players is limited."""
        return len(self._chosen - {*self._ids}) if self.active else 0

    def _show_captions(self) -> None:
        for place in self.shown:
            place.caption.show_player()
        self._left_out.setText(
            filled(self.tr("stacked_players.left_out"), {"count": self._left_out_count, "most": MOST_STACKED})
        )

    def retranslate(self) -> None:
        self._show_captions()

    # Heights

    def _resize(self, by_px: int) -> None:
        lane = self.sender()
        if isinstance(lane, Lane):
            self._set_px[lane.id] = _within(lane.id, self._set_px.get(lane.id, self._usual_px[lane.id]) + by_px)
            self.changed.emit()

    def set_sight(self, height_px: int) -> None:
        """Set the height in pixels in which the stack is visible without scrolling."""
        self._sight_px = height_px

    @property
    def needed_px(self) -> int:
        """Return the height in pixels of the stack with all piano rolls at their least height."""
        return self._total_px(self._usual_px)

    @property
    def _usual_px(self) -> Mapping[str, int]:
        """Return the automatic heights in pixels by lane id."""
        if self._total_px(HEIGHTS_PX) <= self._sight_px or self._total_px(LOW_PX) > self._sight_px:
            return HEIGHTS_PX
        lanes = sum(lane.id == FingeringLane.id and not lane.folded for lane in self._lanes_in_sight())
        more = (self._sight_px - self._total_px(LOW_PX)) // max(lanes, 1)
        fingering_px = min(LOW_PX[FingeringLane.id] + more, HEIGHTS_PX[FingeringLane.id])
        return {**LOW_PX, FingeringLane.id: fingering_px}

    def _total_px(self, usual_px: Mapping[str, int]) -> int:
        captions_px = CAPTION_PX * (len(self._ids) + (self._left_out_count > 0))
        return captions_px + sum(self._lane_px(lane, usual_px) for lane in self._lanes_in_sight())

    def _lanes_in_sight(self) -> list[Lane]:
        return [lane for one in self.shown for id, lane in one.lanes.items() if id in self._open]

    def _lane_px(self, lane: Lane, usual_px: Mapping[str, int]) -> int:
        return FOLDED_PX if lane.folded else self._set_px.get(lane.id, usual_px[lane.id])

    def set_room(self, room_px: int) -> None:
        """Set the total height in pixels (at least `needed_px`); piano rolls share the height that other
        lanes leave.
        """
        lanes, usual_px = self._lanes_in_sight(), self._usual_px
        rolls = [lane for lane in lanes if isinstance(lane, PianoRoll) and not lane.folded]
        total = self._total_px(usual_px)
        more = max(room_px - total, 0) // max(len(rolls), 1)
        for lane in lanes:
            height = self._lane_px(lane, usual_px)
            if lane in rolls:
                higher = min(height + more, max(MOST_ROLL_PX, height))
                total += higher - height
                height = higher
            lane.setFixedHeight(height)
        self.setFixedHeight(total)


def _within(lane_id: str, height_px: int) -> int:
    """Return a height in pixels, limited to the range allowed for a stacked lane."""
    return min(max(height_px, HEIGHTS_PX[lane_id] // 2), MOST_PX)
