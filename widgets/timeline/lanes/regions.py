"""Lanes of regions: events with a start, an end and an amount, which can be selected, moved, resized, and changed in
amount.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from math import ceil

from msgspec.structs import replace
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPen
from PySide6.QtWidgets import QMenu, QWidget

from app.editor.edit_names import edit_of_events
from app.editor.selection import EventKey, Selection
from app.editor.session import Session, Severity
from app.errors import Message
from app.plan.by_hand.corrections import RemoveEvent
from app.plan.model import PlayerPlan
from app.project.edit.events import set_amounts
from app.project.model import Project
from app.project.undoable_document import Change
from widgets.common.menus import add_actions
from widgets.common.text import message_text
from widgets.timeline.lane import Lane, LaneItem, LaneMouse
from widgets.timeline.lanes.number_field import NumberField
from widgets.timeline.model.gestures import snapped
from widgets.timeline.model.lane_mouse import PixelRect
from widgets.timeline.model.regions.region_drag import RegionDrag
from widgets.timeline.model.regions.shown_event import Region
from widgets.timeline.model.regions.shown_regions import (
    GLYPH_PX,
    RegionTable,
    fade_handles,
    most_scrolled,
    region_box,
    row_box,
)
from widgets.timeline.plot.drawing import MARK_PX, draw_mark, rect, shade, small_font
from widgets.timeline.zoom_and_scroll import TimeAxis

STEP, FINE_STEP = 0.05, 0.01
"""Change of an amount by Up and Down, without and with Shift."""


class _Regions(LaneItem["RegionLane"]):
    """Draws the visible regions of a lane."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        painter.setFont(small_font(lane.font()))
        lane.paint_rows(painter, exposed)
        selected = lane.session.selection.events
        for region in lane.visible(exposed.left(), exposed.right()):
            box = lane.box(region)
            if region.removed:
                chosen = region.key in selected
                if chosen:
                    painter.setPen(QPen(QColor(lane.session.tokens.accent), 1.0))
                    painter.setBrush(Qt.BrushStyle.NoBrush)
                    painter.drawRect(QRectF(box.left(), box.center().y() - 8, GLYPH_PX, 15))
                draw_mark(painter, lane.session.tokens, box.left() + 3.0, box.center().y() - MARK_PX / 2, removed=True)
            else:
                lane.paint_region(painter, region, box, region.key in selected or lane.is_preview(region))
        self._paint_thumb(painter)
        if lane.lasso is not None:
            painter.setPen(QPen(QColor(lane.session.tokens.accent), 1.0, Qt.PenStyle.DashLine))
            painter.setBrush(shade(lane.session.tokens.accent, 30))
            painter.drawRect(lane.lasso)

    def _paint_thumb(self, painter: QPainter) -> None:
        """Draw a scroll indicator at the right edge, if not all rows are visible."""
        lane, room = self.lane, self.lane.plot_rect
        first, height = lane.row_box(0)
        content = height * lane.rows
        if content <= room.height() + 1.0:
            return
        thumb = QRectF(room.right() - 5.0, -first / content * room.height(), 4.0, room.height() ** 2 / content)
        painter.fillRect(thumb, QColor(lane.session.tokens.line_strong))


class RegionLane(Lane):
    """Base class of lanes of regions. Sub-classes define the drawing of each kind of event and the place of added
    ones.
    """

    least_row_px = 0.0

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self._table = RegionTable()
        self._row_count = 1
        self._scrolled_px = 0.0
        self._made_for: tuple[object, ...] = ()
        self._preview: dict[EventKey, Region] = {}
        self._hidden: frozenset[EventKey] = frozenset()
        self._drag: RegionDrag | None = None
        self._hovered: Region | None = None
        _Regions(self)
        self.number = NumberField(self)
        self.refresh()

    # Overridden by subclasses

    def make_regions(self, plan: PlayerPlan) -> tuple[list[Region], int]:
        """Return the active player's regions in any order, and the number of rows."""
        raise NotImplementedError

    def shown_beside(self, plan: PlayerPlan | None) -> tuple[object, ...]:
        """Return everything else on which the lane's regions depend; a change of identity of one item rebuilds them."""
        return ()

    def paint_region(self, painter: QPainter, region: Region, box: QRectF, selected: bool) -> None:
        """Draw one region in its rectangle; every kind of lane overrides this."""
        raise NotImplementedError

    def paint_rows(self, painter: QPainter, exposed: QRectF) -> None:
        """Draw the background of the rows before the regions; lanes override this."""

    def is_calm(self, region: Region) -> bool:
        """Return whether a region is drawn by `paint_rows` and needs no drawing of its own."""
        return False

    def add_at(self, mouse: LaneMouse) -> None:
        """React to a double click on an empty place; lanes to which events can be added override this."""

    def menu_entries(self, menu: QMenu, region: Region | None, mouse: LaneMouse) -> None:
        """Add the lane's own entries to the context menu."""

    def snapped_move(self, region: Region, ticks: float, mouse: LaneMouse) -> int:
        """Return the ticks by which a region moves when dragged by some ticks, so that its start is on the grid."""
        return self.snap(region.start_tick + ticks, mouse) - region.start_tick

    # Regions

    @property
    def regions(self) -> list[Region]:
        """The regions displayed in the lane, by start."""
        return self._table.regions

    @property
    def rows(self) -> int:
        """Number of rows in which the lane displays regions."""
        return self._row_count

    @property
    def lasso(self) -> QRectF | None:
        """The rectangle that is being drawn to select regions; None otherwise."""
        return rect(self._drag.lasso) if self._drag is not None and self._drag.lasso is not None else None

    @property
    def needed_height_px(self) -> int:
        return max(self.least_height_px, ceil(self._row_count * self.least_row_px))

    def row_box(self, row: int) -> tuple[float, float]:
        """Return the top and height of a row in pixels: as high as possible, at least `least_row_px`."""
        return row_box(row, self._row_count, self.plot_rect.height(), self.least_row_px, self._scrolled_px)

    def wheel(self, mouse: LaneMouse, steps: float) -> bool:
        """Scroll the rows if they do not fit; return whether the event was handled."""
        height = self.row_box(0)[1]
        if most_scrolled(self._row_count, height, self.plot_rect.height()) <= 0.5:
            return False
        self._scroll_to(self._scrolled_px - steps * height)
        return True

    def pan_y(self, by_px: float) -> None:
        """Scroll the rows with a drag of the middle button."""
        self._scroll_to(self._scrolled_px - by_px)

    def _scroll_to(self, top_px: float) -> None:
        most = most_scrolled(self._row_count, self.row_box(0)[1], self.plot_rect.height())
        kept = min(max(top_px, 0.0), most)
        if kept != self._scrolled_px:
            self._scrolled_px = kept
            self.rows_scrolled()
            self.update_items()

    def rows_scrolled(self) -> None:
        """Update after the rows were scrolled."""

    def place(self, region: Region) -> PixelRect:
        """Return the rectangle of a region in pixels of the plot."""
        return region_box(region, self.axis, self.row_box(region.row))

    def box(self, region: Region) -> QRectF:
        """Return the rectangle of a region in pixels of the plot, as Qt's type."""
        return rect(self.place(region))

    def visible(self, left_px: float, right_px: float) -> Iterable[Region]:
        """Yield the regions between two x positions that are drawn one by one; selected ones last."""
        selected = self.session.selection.events
        return self._table.visible(self.axis, left_px, right_px, selected, self._preview, self._hidden)

    def region_at(self, mouse: LaneMouse) -> tuple[Region | None, str]:
        """Return the region under the mouse, and the grabbed part of it as named in `RegionTable.at`."""
        return self._table.at(mouse, self.axis, self.place, self.session.selection.events)

    def fade_handles(self, region: Region, box: QRectF) -> tuple[tuple[str, QPointF], ...]:
        """Return the positions of the handles of a region's fades, each with its name (``fade_in`` or ``fade_out``)."""
        return tuple(
            (zone, QPointF(*at))
            for zone, at in fade_handles(region, PixelRect(box.left(), box.top(), box.right(), box.bottom()), self.axis)
        )

    def refresh(self) -> None:
        """Rebuild the regions if any of their inputs has changed."""
        player = self.session.player
        plan = self.session.plan
        project = self.session.project
        if plan is None and player is not None and self._made_for and self._made_for[-2] == player.id:
            # The former display stays until new plans arrive.
            return
        corrections = project.corrections.get(player.id, ()) if player is not None else ()
        removed = tuple(item.event_id for item in corrections if isinstance(item, RemoveEvent))
        if self._drag is None or self.session.performance.project is project:
            self._end_preview()
        made_for = (plan, *self.shown_beside(plan), player.id if player is not None else None, removed)
        same = len(made_for) == len(self._made_for) and made_for[-2:] == self._made_for[-2:]
        if same and all(one is other for one, other in zip(made_for[:-2], self._made_for[:-2], strict=True)):
            self.update_items()
            return
        self._made_for = made_for
        needed_px = self.needed_height_px
        regions, self._row_count = self.make_regions(plan) if plan is not None else ([], 1)
        self._table = RegionTable(regions, self.is_calm)
        self._hovered = None
        self.regions_refreshed()
        self.update_items()
        if self.needed_height_px != needed_px:
            self.height_asked.emit()

    def regions_refreshed(self) -> None:
        """Redraw after the regions have changed."""

    # Changes of the session

    def project_changed(self, change: Change) -> None:
        if change.origin is not self:
            self._end_preview()
        self.refresh()

    def selection_changed(self, before: Selection) -> None:
        if before.events != self.session.selection.events:
            self.update_items()

    # Mouse

    def press(self, mouse: LaneMouse) -> None:
        region, zone = self.region_at(mouse)
        before = self.session.selection
        if region is not None:
            key = region.key
            if mouse.ctrl or mouse.shift:
                events = before.events ^ {key} if mouse.ctrl else before.events | {key}
                self.session.select(replace(before, events=frozenset(events), span=None))
            elif key not in before.events:
                self.session.select(Selection(events=frozenset({key})))
        self._drag = RegionDrag(self, region, zone, mouse, before)

    def drag(self, mouse: LaneMouse) -> None:
        if self._drag is not None:
            self._drag.drag(mouse)
            self._preview, self._hidden = self._drag.preview, self._drag.hidden
            self.update_items()

    def is_preview(self, region: Region) -> bool:
        """Return whether a region is shown at its dragged place, before a new plan contains it."""
        return self._preview.get(region.key) is region

    def _end_preview(self) -> None:
        self._preview = {}
        self._hidden = frozenset()

    def release(self, mouse: LaneMouse) -> None:
        drag, self._drag = self._drag, None
        if drag is None:
            return
        drag.release(mouse)
        if self.session.performance.project is self.session.project:
            self._end_preview()
        self.update_items()

    def cancel(self) -> None:
        drag, self._drag = self._drag, None
        self._end_preview()
        if drag is not None:
            drag.cancel()
        self.update_items()

    def double_click(self, mouse: LaneMouse) -> None:
        region, _ = self.region_at(mouse)
        self._drag = None
        if region is None:
            self.add_at(mouse)
        elif region.removed or region.steady:
            why = "region.deleted_here" if region.removed else "region.has_no_amount"
            self.session.notice(Message(why), Severity.WARNING)
        else:
            self.type_amount(region)

    def type_amount(self, region: Region) -> None:
        """Open a field for the amount of a region, which is set for all selected ones."""
        chosen = (self._table.by_key.get(key) for key in self.session.selection.events)
        amounts = {round(one.amount, 2) for one in chosen if one is not None and not (one.removed or one.steady)}
        amount = region.amount if len(amounts) < 2 else None
        name = self.tr("region_lane.how_much")
        self.number.open(self.box(region), amount, 2, lambda to: self._change_amounts(lambda _: to), name)

    def _change_amounts(self, change: Callable[[Region], float]) -> None:
        """Change the amounts of all selected regions of the lane by a function."""
        requested: dict[str, dict[str, float]] = defaultdict(dict)
        for key in self.session.selection.events:
            region = self._table.by_key.get(key)
            if region is not None and not region.removed and not region.steady:
                requested[key.player_id][key.event_id] = change(region)
        plans = self.session.plans

        def edit(project: Project) -> Project:
            for player_id, amounts in requested.items():
                project = set_amounts(project, plans[player_id], amounts)
            return project

        if requested and plans:
            keys = [EventKey(player_id, event_id) for player_id, ids in requested.items() for event_id in ids]
            self.session.attempt(edit_of_events(self.session, "edit.set_event_amounts", keys), edit)

    def key(self, event: QKeyEvent) -> bool:
        """Handle keys: Up and Down change the amount (with Shift finely), Enter opens a field for it, Alt and an arrow
        select an adjacent region.
        """
        modifiers, key = event.modifiers(), event.key()
        alt = bool(modifiers & Qt.KeyboardModifier.AltModifier)
        chosen = [self._table.by_key[item] for item in self.session.selection.events if item in self._table.by_key]
        if alt and key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            self._go_on(chosen, 1 if key == Qt.Key.Key_Right else -1)
            return True
        if not chosen or alt:
            return False
        if key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            step = FINE_STEP if modifiers & Qt.KeyboardModifier.ShiftModifier else STEP
            if key == Qt.Key.Key_Down:
                step = -step
            self._change_amounts(lambda region: region.amount + step)
            return True
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            region = min(chosen, key=lambda item: item.start_s)
            if not region.removed and not region.steady:
                self.type_amount(region)
            return True
        return False

    def _go_on(self, chosen: Sequence[Region], step: int) -> None:
        """Select the region ``step`` places after those in ``chosen``; without one, the region nearest to the
        playhead.
        """
        region = self._table.beside(chosen, step, self.session.playhead_s)
        if region is None:
            return
        self.session.select(Selection(events=frozenset({region.key})))
        self.axis.reveal(region.start_s, region.end_s)

    def hover(self, mouse: LaneMouse | None) -> None:
        region, zone = self.region_at(mouse) if mouse is not None else (None, "")
        shapes = {
            "start": Qt.CursorShape.SizeHorCursor,
            "end": Qt.CursorShape.SizeHorCursor,
            "fade_in": Qt.CursorShape.CrossCursor,
            "fade_out": Qt.CursorShape.CrossCursor,
        }
        if zone in shapes:
            self.plot.setCursor(shapes[zone])
        else:
            self.plot.unsetCursor()
        if region is not self._hovered:
            self._hovered = region
            self.plot.setToolTip(self.tip(region) if region is not None else "")

    def tip(self, region: Region) -> str:
        """Return the text that describes a region under the mouse."""
        lines = [region.label or self.kind_name(region.kind)]
        if region.removed:
            lines = [self.kind_name(region.kind), self.tr("region_lane.deleted")]
        elif region.reason is not None:
            lines.append(message_text(region.reason, self.session, region.player_id))
        return "\n".join(lines)

    def kind_name(self, kind: str) -> str:
        """Return the name of a kind of event; lanes override this to translate it."""
        return kind

    def context_menu(self, mouse: LaneMouse) -> QMenu | None:
        region, _ = self.region_at(mouse)
        if region is not None and region.key not in self.session.selection.events:
            self.session.select(Selection(events=frozenset({region.key})))
        menu = QMenu(self)
        self.menu_entries(menu, region, mouse)
        if region is not None:
            menu.addSeparator()
            add_actions(menu, self.session, ("events.give_back", "edit.delete"))
        return menu

    def snap(self, tick: float, mouse: LaneMouse) -> int:
        """The nearest line of the grid; the tick itself while Alt is held."""
        return snapped(self.session.grid, self.session.project.score, tick, mouse.alt)
