"""Stack of lanes with adjustable heights, which scrolls if it does not fit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import QEvent, QObject, QPoint, QSize, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QApplication, QFrame, QScrollArea, QWidget

from app.editor.session import Session
from widgets.common.icons import draw_grip
from widgets.common.layouts import STRETCH, in_column, panel
from widgets.timeline.lane import FOLDED_PX, Lane
from widgets.timeline.stacked_players import CAPTION_PX, StackedPlayers

LINE_PX = 1
"""Height in pixels of the line below a lane of fixed height."""
HANDLE_PX = 4
"""Height in pixels of the handle below an adjustable lane."""
MOST_PX = 2000
ELASTIC_SHARE = 0.66
"""Greatest share of the visible height for the elastic lane if the lanes do not fit."""
BESIDE_ELASTIC_PX = 90
"""Visible height in pixels that the elastic lane leaves for others."""


class LaneResizeHandle(QWidget):
    """The line below a lane: a drag changes the lane's height, a double click restores the automatic height."""

    def __init__(self, stack: LaneStack, lane: Lane) -> None:
        super().__init__()
        self.setObjectName("handle_" + lane.id)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self._stack = stack
        self._lane = lane
        self._grip: tuple[float, int] | None = None

    def show_use(self, resizes: bool) -> None:
        """Show a grip if dragging resizes the lane, else a plain line."""
        self.setFixedHeight(HANDLE_PX if resizes else LINE_PX)
        self.setCursor(Qt.CursorShape.SizeVerCursor if resizes else Qt.CursorShape.ArrowCursor)

    # Qt overrides

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = self._stack.session.tokens, QPainter(self)
        held = self._grip is not None or (self.underMouse() and self.height() > LINE_PX)
        ground = tokens.line_strong if held else tokens.surface if self.height() > LINE_PX else tokens.line
        painter.fillRect(self.rect(), QColor(ground))
        if self.height() > LINE_PX:
            draw_grip(painter, self.rect(), tokens.text_dim)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self.height() > LINE_PX:
            self._grip = (event.globalPosition().y(), self._lane.height())
            self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._grip is not None:
            self._stack.set_height(self._lane, round(self._grip[1] + event.globalPosition().y() - self._grip[0]))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._grip = None
        self.update()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self._stack.set_height(self._lane, None)


class LaneStack(QScrollArea):
    """Lanes from top to bottom.

    A lane without a height set by the user is between its needed and preferred height, depending on the space; the
    elastic lane takes the rest. Lanes that do not fit are scrolled.

    Parameters
    ----------
    lanes : sequence of Lane
        Lanes in their initial order.
    elastic : Lane
        The lane that fills the remaining height.
    players : StackedPlayers
        Stacked lanes of several players, below the elastic lane; while visible they fill the remaining height instead.

    Signals
    -------
    changed()
        The user changed the order or a height.
    """

    changed = Signal()

    def __init__(
        self,
        session: Session,
        lanes: Sequence[Lane],
        elastic: Lane,
        players: StackedPlayers,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("lanes")
        self.session = session
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._elastic, self._players = elastic, players
        self._order = list(lanes)
        self._set_px: dict[str, int] = {}
        self._column = in_column(STRETCH, margins=0, spacing=0)
        self._handles = {lane.id: LaneResizeHandle(self, lane) for lane in lanes}
        for lane in lanes:
            lane.installEventFilter(self)
            lane.fold_changed.connect(self.arrange)
            lane.height_asked.connect(self._arrange_if_idle)
            lane.resized_by_hand.connect(self._resize_by_hand)
            lane.unfolded_by_hand.connect(self._bring_sender_into_view)
        players.changed.connect(self._arrange_if_idle)
        self._contents = panel(self._column)
        self.setWidget(self._contents)
        self._fill()

    @property
    def lanes(self) -> tuple[Lane, ...]:
        """All lanes from top to bottom, including hidden ones."""
        return tuple(self._order)

    @property
    def heights_px(self) -> dict[str, int]:
        """Return the heights set by the user in pixels by lane id."""
        return dict(self._set_px)

    def set_order(self, lane_ids: Sequence[str]) -> None:
        """Set the order of the lanes; missing ones follow."""
        places = {lane_id: index for index, lane_id in enumerate(lane_ids)}
        self._order.sort(key=lambda lane: places.get(lane.id, len(places)))
        self._fill()

    def shift(self, lane: Lane, by: int) -> None:
        """Move a lane up (-1) or down (1)."""
        at = self._order.index(lane)
        to = min(max(at + by, 0), len(self._order) - 1)
        self._order.insert(to, self._order.pop(at))
        self._fill()
        self.changed.emit()

    def set_height(self, lane: Lane, height_px: int | None) -> None:
        """Set the height of a lane in pixels; None for automatic."""
        if height_px is None:
            self._set_px.pop(lane.id, None)
        else:
            self._set_px[lane.id] = min(max(height_px, lane.least_height_px), MOST_PX)
        self.arrange()
        self.changed.emit()

    def set_heights(self, heights_px: Mapping[str, int]) -> None:
        """Set the heights of lanes as returned by `heights_px`; others become automatic."""
        known = {lane.id: lane for lane in self._order}
        self._set_px = {
            lane_id: min(max(int(height), known[lane_id].least_height_px), MOST_PX)
            for lane_id, height in heights_px.items()
            if lane_id in known
        }
        self.arrange()

    def arrange(self) -> None:
        """Set the height of every lane."""
        shown = [lane for lane in self._order if not lane.isHidden()]
        for lane in self._order:
            handle = self._handles[lane.id]
            handle.show_use(self._resizes(lane))
            handle.setVisible(lane in shown)
        lines_px = sum(self._handles[lane.id].height() for lane in shown)
        if self._players.active:
            self._players.set_sight(self.viewport().height())
            lines_px += self._players.needed_px
        free = [lane for lane in shown if not lane.folded and lane.id not in self._set_px]
        heights = {lane.id: FOLDED_PX if lane.folded else self._set_px.get(lane.id, 0) for lane in shown}
        heights |= {lane.id: self._needed_px(lane) for lane in free}
        self._fit_essential(shown, free, heights)
        room = self.viewport().height() - sum(heights.values()) - lines_px
        wishes = {lane.id: max(lane.preferred_height_px - heights[lane.id], 0) for lane in free}
        requested = sum(wishes.values())
        share = min(max(room, 0) / requested, 1.0) if requested else 0.0
        for lane in free:
            heights[lane.id] += int(share * wishes[lane.id])
        left_over = self.viewport().height() - sum(heights.values()) - lines_px
        if self._players.active:
            self._players.set_room(self._players.needed_px + max(left_over, 0))
        elif left_over > 0 and self._elastic in free:
            heights[self._elastic.id] += left_over
        for lane in shown:
            lane.setFixedHeight(heights[lane.id])

    def _arrange_if_idle(self) -> None:
        """Arrange the lanes unless the mouse is dragging."""
        if not self._players.dragging and not any(lane.dragging for lane in self._order):
            self.arrange()

    def _needed_px(self, lane: Lane) -> int:
        """Return the least automatic height of a lane in pixels; the elastic lane leaves some of the visible height."""
        if lane is not self._elastic:
            return lane.needed_height_px
        in_sight = self.viewport().height()
        most = max(int(ELASTIC_SHARE * in_sight), in_sight - BESIDE_ELASTIC_PX, lane.least_height_px)
        return min(lane.needed_height_px, most)

    def _fit_essential(self, shown: Sequence[Lane], free: Sequence[Lane], heights: dict[str, int]) -> None:
        """Reduce the preferred heights in ``heights`` as far as necessary to make all essential lanes visible, if that
        is possible.
        """
        essential = [lane for lane in shown if lane.is_essential]
        if self._players.active or not essential:
            return
        above = shown[: shown.index(essential[-1]) + 1]
        used = sum(heights[lane.id] for lane in above) + sum(self._handles[lane.id].height() for lane in above[:-1])
        over = used - self.viewport().height()
        spare = {lane.id: heights[lane.id] - lane.least_height_px
                 for lane in above if lane in free and lane is not self._elastic}  # fmt: skip
        if not 0 < over <= sum(spare.values()):
            return
        for lane_id in sorted(spare, key=lambda lane_id: -spare[lane_id]):
            cut = min(over, spare[lane_id])
            heights[lane_id] -= cut
            over -= cut

    def bring_into_view(self, lane: Lane, at_top: bool = False) -> None:
        """Scroll until a lane is visible; if it is taller than the visible height, until its top is.

        Parameters
        ----------
        at_top : bool
            Whether to scroll the lane as far to the top as possible, below its player's name. If the lanes of all
            stacked players fit, all are made visible.
        """
        # The lane may have been shown or unfolded a moment ago.
        self.arrange()
        QApplication.sendPostedEvents(None, QEvent.Type.LayoutRequest.value)
        bar = self.verticalScrollBar()
        # If hidden, the lane of the player in front among the stacked ones is used.
        shown = self._players.lane_in_front(lane.id) if lane.isHidden() else lane
        if shown is None:
            return
        top = shown.mapTo(self._contents, QPoint(0, 0)).y()
        bottom = top + shown.height()
        if at_top:
            whole = self._players.height() <= self.viewport().height()
            bar.setValue(top if not lane.isHidden() else self._players.y() if whole else top - CAPTION_PX)
            return
        bar.setValue(min(max(bar.value(), bottom - self.viewport().height()), top))

    def _bring_sender_into_view(self) -> None:
        lane = self.sender()
        if isinstance(lane, Lane):
            self.bring_into_view(lane)

    def _resize_by_hand(self, by_px: int) -> None:
        lane = self.sender()
        if isinstance(lane, Lane) and self._resizes(lane):
            self.set_height(lane, lane.height() + by_px)

    def _resizes(self, lane: Lane) -> bool:
        least, preferred = lane.least_height_px, max(lane.preferred_height_px, lane.needed_height_px)
        return not lane.folded and (preferred > least or lane.id in self._set_px)

    def _fill(self) -> None:
        for index, lane in enumerate(self._order):
            self._column.insertWidget(2 * index, lane)
            self._column.insertWidget(2 * index + 1, self._handles[lane.id])
        self._column.insertWidget(2 * self._order.index(self._elastic) + 2, self._players)
        self.arrange()

    # Qt overrides

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() in (QEvent.Type.ShowToParent, QEvent.Type.HideToParent) and hasattr(self, "_handles"):
            self.arrange()
        return super().eventFilter(watched, event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.arrange()

    def minimumSizeHint(self) -> QSize:
        return QSize(300, 60)
