"""Base class of the timeline's lanes: a header, and a plot with the common time axis.

A lane draws with `LaneItem`s in pixels of the plot, with times converted by ``axis.x_px``, and handles the mouse in
overridden methods.
"""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QPointF, QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QHBoxLayout, QMenu, QWidget

from app.editor.selection import Selection
from app.editor.session import Session
from app.project.undoable_document import Change
from widgets.common.clicks import on_click
from widgets.common.controls import Retranslated
from widgets.timeline.lane_header import GUTTER_PX, LaneHeader
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.lines import Lines
from widgets.timeline.plot.mouse import mouse_at
from widgets.timeline.plot.plot import Background, LaneItem, Plot
from widgets.timeline.zoom_and_scroll import TimeAxis, wheel_turn

__all__ = ["FOLDED_PX", "GUTTER_PX", "Lane", "LaneItem", "LaneMouse"]

FOLDED_PX = 26
HEIGHT_A_NOTCH_PX = 8
"""Change of a lane's height in pixels per notch of the wheel."""
AUTOSCROLL_MS = 30
AUTOSCROLL_SHARE = 0.02
"""Share of the visible span scrolled at each tick of the timer while a drag is held past the edge."""


class Lane(Retranslated, QWidget):
    """A lane of the timeline.

    Parameters
    ----------
    axis : TimeAxis
        Time axis shared by all lanes.

    Signals
    -------
    sought(float)
        Request to move the playhead to this time in seconds.
    fold_changed()
        The lane was folded or unfolded.
    height_asked()
        The automatic height of the lane has changed.
    unfolded_by_hand()
        The user unfolded the lane by its button or header.
    resized_by_hand(int)
        The user changed the lane's height by this number of pixels.

    Attributes
    ----------
    id : str
        Class attribute: name in saved layouts; the object name is ``"lane_" + id``.
    preferred_height_px : int
        Height in a new window in pixels.
    least_height_px : int
        Least automatic height.
    folded_at_first, hides_empty, is_essential : bool
        Class attributes: folded in a new window; hidden while empty unless the user shows it; kept visible in a new
        window by making the lanes below it smaller.
    """

    id = ""
    preferred_height_px = 64
    least_height_px = 36
    folded_at_first = False
    hides_empty = False
    is_essential = False

    sought = Signal(float)
    fold_changed = Signal()
    height_asked = Signal()
    unfolded_by_hand = Signal()
    resized_by_hand = Signal(int)

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("lane_" + self.id)
        self.session = session
        self.axis = axis
        self._y_range = (0.0, 1.0)
        self._folded = False
        self._button = Qt.MouseButton.NoButton
        self._panned_px: QPointF | None = None
        self._last: QMouseEvent | None = None
        self._selected = session.selection

        self.header = LaneHeader(self)
        self.fold_button, self.title = self.header.fold_button, self.header.title
        self.title_row, self.controls = self.header.title_row, self.header.controls
        on_click(self.fold_button, self._toggle_fold)
        self.header.double_clicked.connect(self._toggle_fold)

        self.plot = Plot(self, self)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.header)
        row.addWidget(self.plot, 1)
        # The header stays at the left if the plot is folded away.
        row.addStretch(0)
        self.setMinimumHeight(self.least_height_px)

        self._autoscroll = QTimer(self, interval=AUTOSCROLL_MS)
        self._autoscroll.timeout.connect(self._scroll_past_the_edge)
        self.background = Background(self)
        axis.changed.connect(self._axis_changed)
        session.changed.connect(self._session_changed)
        session.performance_changed.connect(self.performance_changed)
        session.theme_changed.connect(self._theme_set)
        session.selection_changed.connect(self._selection_set)
        session.players_changed.connect(self.players_changed)
        session.grid_changed.connect(self.background.update)
        session.loop_changed.connect(self.background.update)
        self._paint_surfaces()
        self._axis_changed()

    # Overridden by lanes

    def project_changed(self, change: Change) -> None:
        """Handle a changed project; compare displayed parts by identity."""

    def refresh(self) -> None:
        """Show the active player's data, if they have changed."""

    def performance_changed(self) -> None:
        """Handle new plans of the performance by displaying them."""
        self.refresh()

    def selection_changed(self, before: Selection) -> None:
        """Handle a changed selection in the session: redraw only what it affects; ``before`` is the previous one."""

    def players_changed(self) -> None:
        """Handle a change of the active player."""
        self.refresh()

    def theme_changed(self) -> None:
        """React to a change of the theme; lanes with colours of their own override this."""

    def axis_changed(self) -> None:
        """Handle a changed range or zoom; the lane's items are updated without this."""

    def press(self, mouse: LaneMouse) -> None:
        """Handle a press of the left button; calls of `drag` and `release` follow."""

    def drag(self, mouse: LaneMouse) -> None:
        """Handle a drag with the left button, or scrolling under the mouse during a drag."""

    def release(self, mouse: LaneMouse) -> None:
        """React to the release of the left mouse button; lanes override this."""

    def cancel(self) -> None:
        """Cancel a drag on Escape, undoing its effect; neither `drag` nor `release` follows."""

    def double_click(self, mouse: LaneMouse) -> None:
        """React to a double click of the left button; lanes override this. Neither `drag` nor `release` follows."""

    def hover(self, mouse: LaneMouse | None) -> None:
        """Handle mouse movement without a button; None when the mouse leaves."""

    def wheel(self, mouse: LaneMouse, steps: float) -> bool:
        """Handle the wheel (or Alt and the wheel) in notches, positive away from the user; return whether it was
        used.
        """
        return False

    def zoom_y(self, mouse: LaneMouse, steps: float) -> None:
        """Handle the wheel with Ctrl and Shift in notches: change the lane's height or vertical scale."""
        self.resized_by_hand.emit(round(steps * HEIGHT_A_NOTCH_PX))

    def pan_y(self, by_px: float) -> None:
        """Scroll the contents vertically during a drag with the middle button, by pixels, positive downwards."""

    def context_menu(self, mouse: LaneMouse) -> QMenu | None:
        """Return a new context menu for the mouse position; None for no menu."""
        return None

    def key(self, event: QKeyEvent) -> bool:
        """Handle a key while the plot has the focus; return whether it was used."""
        return False

    def claims(self, event: QKeyEvent) -> bool:
        """Return whether a key that may be a shortcut belongs to the lane while the plot has the focus; `key` is called
        then.
        """
        return False

    @property
    def needed_height_px(self) -> int:
        """Return the least automatic height of the lane in pixels."""
        return self.least_height_px

    # Used by lanes

    @property
    def plot_rect(self) -> QRectF:
        """The rectangle of the lane's plot in its own pixels; at least one pixel."""
        return QRectF(0.0, 0.0, float(max(self.plot.width(), 1)), float(max(self.plot.height(), 1)))

    @property
    def y_range(self) -> tuple[float, float]:
        """Values on the lane's vertical scale at the bottom and the top of the plot."""
        return self._y_range

    def set_y_range(self, bottom: float, top: float) -> None:
        """Change the values at the lower and upper edge of the plot, and redraw it."""
        if (bottom, top) != self._y_range:
            self._y_range = (bottom, top)
            self.update_items()

    def y_px(self, value: float) -> float:
        """Convert a value on the lane's vertical scale to pixels from the top of the plot."""
        bottom, top = self._y_range
        return (top - value) / (top - bottom) * self.plot_rect.height()

    def value_at(self, y_px: float) -> float:
        """Return the value on the lane's vertical scale at a height in pixels."""
        bottom, top = self._y_range
        return top - y_px / self.plot_rect.height() * (top - bottom)

    @property
    def is_empty(self) -> bool:
        """True if the lane has no contents for any player."""
        return False

    def lines(self) -> Lines:
        """Lines of bars, beats and the grid in the visible time range."""
        return self.axis.lines(self.session.project.score, self.session.grid)

    def update_items(self) -> None:
        """Redraw all items of the lane."""
        self.plot.redraw()

    @property
    def folded(self) -> bool:
        """True if only the title shows."""
        return self._folded

    def set_folded(self, folded: bool) -> None:
        """Fold the lane to its title, or unfold it."""
        if folded == self._folded:
            return
        self._folded = folded
        self.plot.setVisible(not folded)
        self.header.show_folded(folded)
        self.setMinimumHeight(FOLDED_PX if folded else self.least_height_px)
        self.setMaximumHeight(FOLDED_PX if folded else 16777215)
        self.header.name_fold(folded)
        self.fold_changed.emit()

    def ask_height(self, preferred_px: int, least_px: int) -> None:
        """Request another automatic height in pixels."""
        if (preferred_px, least_px) != (self.preferred_height_px, self.least_height_px):
            self.preferred_height_px, self.least_height_px = preferred_px, least_px
            self.setMinimumHeight(FOLDED_PX if self._folded else least_px)
            self.height_asked.emit()

    def _toggle_fold(self) -> None:
        self.set_folded(not self._folded)
        if not self._folded:
            self.unfolded_by_hand.emit()

    @property
    def dragging(self) -> bool:
        """True while the left button is held in the plot."""
        return self._button == Qt.MouseButton.LeftButton

    # Helpers

    def _mouse(self, event: QMouseEvent | QWheelEvent) -> LaneMouse:
        return self.mouse_at(event.position(), event.modifiers(), event.globalPosition().toPoint())

    def mouse_at(
        self,
        place: QPointF,
        modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier,
        screen: QPoint | None = None,
    ) -> LaneMouse:
        """Convert a place of the plot to time and value, with the keys held."""
        screen = screen or self.plot.mapToGlobal(place.toPoint())
        return mouse_at(self.session, self.axis, place, self.value_at(place.y()), modifiers, screen)

    def pressed(self, event: QMouseEvent) -> None:
        event.accept()
        if self._button != Qt.MouseButton.NoButton:
            return
        self._button = event.button()
        if event.button() == Qt.MouseButton.LeftButton:
            self.press(self._mouse(event))
        elif event.button() == Qt.MouseButton.MiddleButton:
            self._panned_px = event.position()
            self.plot.setCursor(Qt.CursorShape.ClosedHandCursor)
        elif event.button() == Qt.MouseButton.RightButton:
            mouse = self._mouse(event)
            # A menu receives the release of the button.
            self._button = Qt.MouseButton.NoButton
            menu = self.context_menu(mouse)
            if menu is not None:
                menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
                menu.popup(QPoint(*mouse.screen_px))

    def moved(self, event: QMouseEvent) -> None:
        event.accept()
        if self._button == Qt.MouseButton.LeftButton:
            self._last = event.clone()
            outside = not 0 <= event.position().x() <= self.axis.width_px
            if outside and not self._autoscroll.isActive():
                self._autoscroll.start()
            elif not outside:
                self._autoscroll.stop()
            self.drag(self._mouse(event))
        elif self._panned_px is not None:
            by_px = event.position() - self._panned_px
            self._panned_px = event.position()
            self.axis.pan_px(by_px.x())
            self.pan_y(by_px.y())
        elif self._button == Qt.MouseButton.NoButton and event.buttons() == Qt.MouseButton.NoButton:
            self.hover(self._mouse(event))

    def released(self, event: QMouseEvent) -> None:
        event.accept()
        if event.button() != self._button:
            return
        mouse = self._mouse(event)
        left = self._button == Qt.MouseButton.LeftButton
        self._end_press()
        if left:
            self.release(mouse)
            # Neighbours of a dragged lane keep their heights.
            self.height_asked.emit()

    def _end_press(self) -> None:
        if self._panned_px is not None:
            self._panned_px = None
            self.plot.unsetCursor()
        self._button = Qt.MouseButton.NoButton
        self._last = None
        self._autoscroll.stop()

    def double_clicked(self, event: QMouseEvent) -> None:
        event.accept()
        if event.button() == Qt.MouseButton.LeftButton:
            self.double_click(self._mouse(event))

    def wheeled(self, event: QWheelEvent) -> None:
        event.accept()
        turn = wheel_turn(event)
        if turn.with_ctrl and turn.with_shift:
            self.zoom_y(self._mouse(event), turn.notches)
        elif turn.with_ctrl or turn.with_shift or turn.sideways or not self.wheel(self._mouse(event), turn.notches):
            self.axis.turn_wheel(turn, event.position().x())

    def key_pressed(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self.dragging:
            self._end_press()
            self.cancel()
            self.height_asked.emit()
            event.accept()
        elif self.key(event):
            event.accept()
        else:
            event.ignore()

    def _scroll_past_the_edge(self) -> None:
        if self._last is None:
            self._autoscroll.stop()
            return
        direction = -1 if self._last.position().x() < 0 else 1
        self.axis.pan(direction * AUTOSCROLL_SHARE * self.axis.span_s)
        self.drag(self._mouse(self._last))

    def _axis_changed(self) -> None:
        self.axis_changed()
        self.update_items()

    def plot_resized(self) -> None:
        if self.isVisible() and not self._folded:
            self.axis.set_width(self.plot.width())

    def _session_changed(self, change: Change) -> None:
        before, after = change.before.score, change.after.score
        recoloured = change.before.players is not change.after.players
        if change.opened or recoloured or before.tempo_map is not after.tempo_map or before.metres is not after.metres:
            self.update_items()
        self.project_changed(change)

    def _selection_set(self) -> None:
        before, self._selected = self._selected, self.session.selection
        if before.span != self._selected.span:
            self.background.update()
        self.selection_changed(before)

    def _theme_set(self) -> None:
        self._paint_surfaces()
        self.theme_changed()
        self.update_items()

    def _paint_surfaces(self) -> None:
        self.plot.redraw()
        self.header.paint_surface(self.session.tokens)

    # Qt overrides

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Unfold the lane if it is folded; otherwise treat the double click as usual."""
        if self._folded and event.button() == Qt.MouseButton.LeftButton:
            self._toggle_fold()
        else:
            super().mouseDoubleClickEvent(event)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.LanguageChange:
            self.header.name_fold(self._folded)
        elif event.type() == QEvent.Type.FontChange:
            # The font of the plot may be another one and unchanged.
            self.update_items()

    def sizeHint(self) -> QSize:
        return QSize(800, FOLDED_PX if self._folded else self.preferred_height_px)
