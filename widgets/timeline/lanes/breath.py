"""The breath lane: depth, length and preparation of breaths."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QMenu, QWidget

from app.editor.additions import add_breaths
from app.editor.edit_names import edit_at_events
from app.editor.selection import EventKey
from app.editor.session import Session
from app.plan.event_id import EventId
from app.plan.kinds import BREATH_KINDS
from app.plan.model import PlayerPlan
from app.project.edit.events import toggle_preparation
from widgets.common.clicks import on_click
from widgets.common.event_names import kind_name
from widgets.timeline.lane import LaneMouse
from widgets.timeline.lanes.problems import ProblemMarks
from widgets.timeline.lanes.regions import RegionLane
from widgets.timeline.model.regions.shown_event import Region
from widgets.timeline.model.regions.shown_regions import removed_regions
from widgets.timeline.plot.drawing import draw_mark, draw_text, shade
from widgets.timeline.zoom_and_scroll import TimeAxis

PREPARATION_SHARE = 0.45
"""Height of a preparation, of the lane."""


NEEDED_PX = 28
"""Height in pixels at which depths are easily distinguished."""
LEAST_SHAPE_PX = 6.0
"""Something narrower is a bar."""


class BreathLane(RegionLane):
    """Breaths as hills with depth as height, rising to the following onset; preparations as low slopes."""

    id = "breath"
    preferred_height_px = 40
    least_height_px = 24
    is_essential = True

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self.problem_marks = ProblemMarks(self, ("breath",))
        self.texted(self.title, text="breath_lane.breath", tip="breath_lane.drag_to_move_up_and")

    @property
    def needed_height_px(self) -> int:
        return max(super().needed_height_px, NEEDED_PX)

    def kind_name(self, kind: str) -> str:
        return kind_name(kind)

    def make_regions(self, plan: PlayerPlan) -> tuple[list[Region], int]:
        regions = [
            Region(
                plan.player_id, event.id, event.kind, event.start_tick, event.end_tick, event.start_s, event.end_s,
                amount=event.depth, reason=event.reason, by_hand=event.corrected,
            )
            for event in plan.breaths
        ]  # fmt: skip
        return regions + removed_regions(self.session.project, plan, BREATH_KINDS, lambda kind: 0), 1

    def paint_region(self, painter: QPainter, region: Region, box: QRectF, selected: bool) -> None:
        tokens, player = self.session.tokens, self.session.player
        if player is None:
            return
        colour = tokens.accent if selected else self.session.colour(player)
        breath = BREATH_KINDS[region.kind].draws_air
        if box.width() < LEAST_SHAPE_PX and not selected:
            high = box.height() * (region.amount if breath else PREPARATION_SHARE * region.amount)
            bar = QRectF(box.left(), box.bottom() - high, box.width(), high)
            painter.fillRect(bar, QColor(tokens.by_hand) if region.by_hand else shade(colour, 130))
            return
        height = box.height() * (region.amount if breath else PREPARATION_SHARE * region.amount)
        top, left, right, bottom = box.bottom() - height, box.left(), box.right(), box.bottom()
        if breath:
            # Air flows in slowly, then fast, and stops just before the lips close.
            rise = min(box.width() * 0.55, 40.0)
            points = [(left, bottom), (left + rise * 0.4, bottom - height * 0.25), (left + rise, top),
                      (right - min(box.width() * 0.1, 6.0), top), (right, bottom)]  # fmt: skip
        else:
            points = [(left, bottom), (right, top), (right, bottom)]
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        painter.setPen(QPen(QColor(colour), 1.6 if selected else 1.0))
        painter.setBrush(shade(colour, 120 if selected or region.by_hand else 70))
        painter.drawPolygon(QPolygonF([QPointF(x, y) for x, y in points]))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        if selected:
            painter.setPen(QPen(shade(tokens.accent, 120), 1.0, Qt.PenStyle.DotLine))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(box)
        if breath and box.width() > 44.0 and (selected or region.by_hand):
            painter.setPen(QColor(tokens.text))
            draw_text(painter, box.adjusted(10.0, 1.0, -4.0, -1.0), f"{region.amount:.2f}")
        if region.by_hand:
            draw_mark(painter, tokens, left + 1.0, box.top() + 1.0)

    def tip(self, region: Region) -> str:
        lines = [super().tip(region)]
        if not region.removed:
            seconds = region.end_s - region.start_s
            lines.insert(1, self.tr("breath_lane.depth_s").format(depth=region.amount, seconds=seconds))
        return "\n".join(lines)

    def add_at(self, mouse: LaneMouse) -> None:
        plan = self.session.plan
        add_breaths(self.session, [] if plan is None else [(plan, round(mouse.tick))])

    def menu_entries(self, menu: QMenu, region: Region | None, mouse: LaneMouse) -> None:
        on_click(menu.addAction(self.tr("breath_lane.add_breath_here")), lambda: self.add_at(mouse))
        if region is None or (region.removed and BREATH_KINDS[region.kind].draws_air):
            return
        note_id = EventId.parse(region.event_id).of
        plan = self.session.plans.get(region.player_id)
        if plan is None:
            return
        has = any(event.id == f"preparation:{note_id}" for event in plan.breaths)
        entry = menu.addAction(self.tr("breath_lane.prepared"))
        entry.setCheckable(True)
        entry.setChecked(has)
        on_click(entry, lambda: self._toggle(plan, note_id))

    def _toggle(self, plan: PlayerPlan, note_id: str) -> None:
        key = EventKey(plan.player_id, str(EventId("preparation", note_id)))
        self.session.attempt(
            edit_at_events(self.session, "edit.toggle_preparation", (key,)),
            lambda project: toggle_preparation(project, plan, note_id).project,
        )
