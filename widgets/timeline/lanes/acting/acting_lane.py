"""The acting lane: cues, expressions, poses and gestures, each kind in rows of its own."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from operator import is_

import numpy as np
from PySide6.QtCore import QPoint, QPointF, QRectF
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QMenu, QWidget

from app.arrays import FloatArray
from app.editor.additions import add_cues, add_expressions, add_gestures, add_named_gestures
from app.editor.session import Session
from app.errors import Message
from app.plan.kinds import GESTURE_KINDS, GESTURES
from app.plan.model import GestureEvent, PlayerPlan
from app.project.edit.events import set_expression
from app.project.edit.generation import variations
from app.project.model import Project
from app.score.tempo import TempoMap
from widgets.common.clicks import on_click
from widgets.common.event_names import expression_name, gesture_name, kind_name, pose_name, style_name
from widgets.common.menus import passing_menu
from widgets.common.plain import verbatim
from widgets.timeline.lanes.acting.acting_drawing import ActingPainter
from widgets.timeline.lanes.acting.acting_menus import add_givers, add_styles_menus, add_takers
from widgets.timeline.lanes.regions import RegionLane
from widgets.timeline.lanes.row_names import RowNames
from widgets.timeline.model.lane_mouse import LaneMouse, PixelRect
from widgets.timeline.model.regions.acting_regions import (
    BASE,
    CURVES,
    GROUPS,
    ROW_OF,
    STRIPS,
    STYLE,
    VARIED,
    Names,
    cue_region,
    entry_near,
    expression_region,
    gesture_region,
    in_guest,
    packed_group,
    pose_region,
    strip,
    style_region,
)
from widgets.timeline.model.regions.shown_event import Region
from widgets.timeline.model.regions.shown_regions import removed_regions
from widgets.timeline.plot.drawing import draw_columns, draw_mark, draw_rects, shade
from widgets.timeline.zoom_and_scroll import TimeAxis

BASE_PX = 5.0
NEW_BEATS = 2
MOST_NAME_PX, NAME_GAP_PX = 130.0, 8.0
CUE_REACH_PX = 10.0
"""Distance in pixels within which a dragged cue is assigned to an entry."""


NAMES = Names(expression_name, kind_name, pose_name, gesture_name, style_name)


class ActingLane(RegionLane):
    """Lane of the motion of body and face besides playing."""

    id = "acting"
    preferred_height_px = 154
    least_height_px = 70
    least_row_px = 19.0

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        self.groups: list[tuple[str, int, int]] = []
        """Kinds with their first row and number of rows."""
        self._strips: dict[str, tuple[FloatArray, FloatArray, FloatArray]] = {}
        self._known: dict[int, tuple[GestureEvent, Region]] = {}
        """Regions of gestures, by the identity of the event."""
        self._groups_known: dict[tuple[str, ...], tuple[TempoMap, list[Region], tuple[list[int], int]]] = {}
        """Regions of each group's rows with their rows, and the inputs they were found for."""
        self._painter = ActingPainter(self)
        super().__init__(session, axis, parent)
        self._names = RowNames(self, self.row_names)
        self.texted(self.title, text="acting_lane.acting", tip="acting_lane.drag_to_move_up_and")
        self.retranslate()

    def retranslate(self) -> None:
        self._made_for, self._known = (), {}
        self.refresh()

    def kind_name(self, kind: str) -> str:
        return kind_name(kind)

    def group_name(self, kind: str) -> str:
        """Return the name of a group of rows, that of its first kind."""
        if kind == VARIED:
            return self.tr("acting_lane.anew")
        names = {"pose": "acting_lane.pose", "feet": "acting_lane.feet", "beside": "acting_lane.beside"}
        row = ROW_OF.get(kind, kind)
        return self.tr(names[row]) if row in names else kind_name(kind)

    # Regions

    def make_regions(self, plan: PlayerPlan) -> tuple[list[Region], int]:
        project = self.session.project
        varied = self._varied(plan.player_id)
        by_kind: dict[str, list[Region]] = {}
        for region in (
            *varied,
            *(cue_region(event, project.player(plan.player_id).name, "{name} →") for event in plan.cues),
            *self._guests(plan),
            *(expression_region(plan.player_id, event, NAMES) for event in plan.expressions),
            *self._gestures(plan),
            *(pose_region(plan.player_id, event, NAMES) for event in plan.poses),
            *(style_region(plan.player_id, event, NAMES) for event in plan.styles),
        ):
            by_kind.setdefault(region.kind, []).append(region)
        result: list[Region] = []
        self.groups, row, first = [], 0, dict[str, int]()
        above = tuple((kind,) for kind in (VARIED, STYLE) if kind in by_kind)
        for kinds in (*above, *GROUPS):
            members = [region for kind in kinds for region in by_kind.get(kind, ())]
            rows, count = self._packed(kinds, members, project.score.tempo_map)
            for region, own in zip(members, rows, strict=True):
                region.row = row + own
            result += members
            first |= dict.fromkeys(kinds, row)
            self.groups.append((kinds[0], row, count))
            row += count
        removed = removed_regions(self.session.project, plan, (*GESTURE_KINDS, "cue", "expression"), first.__getitem__)
        return result + removed, row

    def _gestures(self, plan: PlayerPlan) -> list[Region]:
        """Return the regions of gestures, of which there are thousands, reusing those of an unchanged plan."""
        before, self._known = self._known, {}
        for event in plan.gestures:
            known = before.get(id(event))
            if known is None or known[0] is not event or known[1].player_id != plan.player_id:
                known = (event, gesture_region(plan.player_id, event, NAMES))
            self._known[id(event)] = known
        return [region for _, region in self._known.values()]

    def _packed(self, kinds: tuple[str, ...], members: list[Region], clock: TempoMap) -> tuple[list[int], int]:
        """Return the row of each region in ``members``, and the number of rows; expressions that last below others are
        in the last row.
        """
        known = self._groups_known.get(kinds)
        if (
            known is not None
            and known[0] is clock
            and len(known[1]) == len(members)
            and all(map(is_, known[1], members))
        ):
            return known[2]
        rows, count = packed_group(members, clock)
        self._groups_known[kinds] = (clock, members, (rows, count))
        for kind in kinds:
            if kind in STRIPS:
                self._strips[kind] = strip(members, kind)
        return rows, count

    def shown_beside(self, plan: PlayerPlan | None) -> tuple[object, ...]:
        if plan is None:
            return ()
        plans, project = self.session.performance.plans, self.session.project
        said = project.corrections.get(plan.player_id)
        return (project.players, said, *(other.cues for other in plans.values() if other is not plan))

    def _varied(self, player_id: str) -> list[Region]:
        """Return regions for the player's bars whose generated motion the user has varied."""
        clock = self.session.project.score.tempo_map
        return [
            Region(
                player_id, item.about, VARIED, item.start_tick, item.end_tick,
                clock.seconds(float(item.start_tick)), clock.seconds(float(item.end_tick)),
                label=kind_name(VARIED), by_hand=True, steady=True, fixed=True,
            )
            for item in variations(self.session.project, player_id)
        ]  # fmt: skip

    def tip(self, region: Region) -> str:
        if region.kind == VARIED:
            return self.tr("acting_lane.regenerated_bars_tip")
        return super().tip(region)

    def _guests(self, plan: PlayerPlan) -> list[Region]:
        """Return regions for the cues that players other than the displayed musician give."""
        performance, project = self.session.performance, self.session.project
        known = {player.id: player.name for player in project.players}
        own = next((player for player in project.players if player.id == plan.player_id), None)
        mine = set() if own is None else {one.id for one in project.played_by(own)}
        return [
            in_guest(cue_region(event, known[other.player_id], "← {name}"))
            for other in performance.plans.values()
            if other.player_id not in mine and other.player_id in known
            for event in other.cues
        ]

    def regions_refreshed(self) -> None:
        if hasattr(self, "_names"):
            self._names.update()

    def rows_scrolled(self) -> None:
        self._names.update()

    def row_names(self) -> list[tuple[str, float]]:
        """Return the name of each group of rows with the height of its middle in pixels."""
        names = []
        for kind, first, count in self.groups:
            top, height = self.row_box(first)
            names.append((self.group_name(kind), top + height * count / 2))
        return names

    def place(self, region: Region) -> PixelRect:
        box = super().place(region)
        return box._replace(top=box.bottom - BASE_PX) if region.event_id == BASE and not region.removed else box

    def is_calm(self, region: Region) -> bool:
        return region.kind in STRIPS and not region.by_hand

    # Drawing

    def paint_rows(self, painter: QPainter, exposed: QRectF) -> None:
        tokens, player = self.session.tokens, self.session.player
        painter.setPen(QPen(QColor(tokens.line), 1.0))
        for _, first, _ in self.groups[1:]:
            edge = round(self.row_box(first)[0]) + 0.5
            painter.drawLine(QPointF(exposed.left(), edge), QPointF(exposed.right(), edge))
        if player is None:
            return
        colour = self.session.colour(player)
        axis = self.axis
        for region in self.regions:
            if region.kind != VARIED:
                continue
            box = self.box(region)
            painter.fillRect(
                QRectF(box.left(), box.top(), box.width(), exposed.bottom() - box.top()), shade(colour, 22)
            )
        for kind, first, _ in self.groups:
            if kind not in self._strips:
                continue
            start_s, end_s, amount = self._strips[kind]
            low = max(int(np.searchsorted(end_s, axis.seconds(exposed.left()))) - 1, 0)
            high = int(np.searchsorted(start_s, axis.seconds(exposed.right()))) + 1
            top, height = self.row_box(first)
            middle, half = top + height / 2, height / 2 - 2.0
            x0, x1 = axis.x_px(start_s[low:high]), axis.x_px(end_s[low:high])
            y = amount[low:high] * half
            painter.setPen(QPen(shade(tokens.line_strong, 120), 1.0))
            painter.drawLine(QPointF(exposed.left(), middle), QPointF(exposed.right(), middle))
            if kind in CURVES:
                self._painter.paint_sway(painter, x0, x1, middle - y, shade(colour, 170))
            elif len(x0) > exposed.width():
                draw_columns(painter, exposed, x0, x1, middle - y, middle, shade(colour, 90))
            else:
                draw_rects(
                    painter,
                    x0,
                    np.minimum(middle, middle - y),
                    np.maximum(x1 - x0 - 1.0, 1.0),
                    np.maximum(np.abs(y), 1.0),
                    shade(colour, 90),
                )

    def paint_region(self, painter: QPainter, region: Region, box: QRectF, selected: bool) -> None:
        tokens, project = self.session.tokens, self.session.project
        colour = tokens.accent if selected else self.session.colour(project.player(region.player_id))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        if region.kind == "cue":
            self._painter.paint_cue(painter, region, box, colour, self._name_room_px(region))
        elif region.kind == VARIED:
            self._painter.paint_varied(painter, region, box, colour, selected)
        elif region.kind in STRIPS:
            self._painter.paint_bar(painter, region, box, colour, selected)
        else:
            self._painter.paint_span(painter, region, box, colour, selected)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        if region.by_hand:
            draw_mark(painter, tokens, box.left() + 1.0, box.top() + 1.0)

    def _name_room_px(self, cue: Region) -> float:
        """Return the free space in pixels for a cue's name: up to the next cue in the row."""
        later = [one.start_s for one in self.regions if one.kind == "cue" and one.row == cue.row]
        at = bisect_right(later, cue.start_s)
        return MOST_NAME_PX if at == len(later) else self.axis.x_px(later[at]) - self.axis.x_px(cue.end_s) - NAME_GAP_PX

    # Dragging

    def snapped_move(self, region: Region, ticks: float, mouse: LaneMouse) -> int:
        if region.kind != "cue":
            return super().snapped_move(region, ticks, mouse)
        score, requested = self.session.project.score, region.end_tick + ticks
        player = self.session.project.player(region.player_id)
        notes = self.session.project.part(player).notes
        if not mouse.alt:
            onsets = np.array([note.onset_tick for note in notes], np.float64)
            entry = entry_near(onsets, requested, score.tempo_map, CUE_REACH_PX / self.axis.px_per_s)
            if entry is not None:
                return entry - region.end_tick
        return self.snap(requested, mouse) - region.end_tick

    def group_at(self, y_px: float) -> str:
        """Return the kind whose rows are at a height in pixels."""
        for kind, first, count in self.groups:
            top, height = self.row_box(first)
            if y_px < top + height * count:
                return kind
        return self.groups[-1][0] if self.groups else "expression"

    def add_at(self, mouse: LaneMouse) -> None:
        kind = self.group_at(mouse.y_px)
        if kind == "cue":
            self._add_cue(mouse)
        elif kind == "expression":
            menu = passing_menu(self)
            self._expression_entries(menu, lambda name: add_expressions(self.session, name, self._spans(mouse)))
            menu.popup(QPoint(*mouse.screen_px))
        else:
            if kind in GESTURE_KINDS:
                add_gestures(self.session, kind, self._spans(mouse))

    def menu_entries(self, menu: QMenu, region: Region | None, mouse: LaneMouse) -> None:
        if region is not None and region.kind == "expression" and not region.removed:
            other = menu.addMenu(self.tr("acting_lane.another_expression"))
            self._expression_entries(other, self._choose_expression, region)
        if region is not None and region.kind == "cue" and not region.removed:
            add_givers(menu, self.session, region, self.tr("acting_lane.given_by"))
            takers = self.tr("acting_lane.brings_in"), self.tr("acting_lane.who_enters")
            add_takers(menu, self.session, region, *takers)
        adding = menu.addMenu(self.tr("acting_lane.add_expression_here"))
        self._expression_entries(adding, lambda name: add_expressions(self.session, name, self._spans(mouse)))
        gestures = menu.addMenu(self.tr("acting_lane.add_gesture_here"))
        for kind in GESTURES:
            if kind.command:
                entry = gestures.addAction(kind_name(kind.id))
                on_click(entry, lambda kind: add_gestures(self.session, kind, self._spans(mouse)), kind.id)
        gestures.addSeparator()
        for name in sorted(self.session.performance.metadata.gestures.items, key=gesture_name):
            entry = gestures.addAction(verbatim(gesture_name(name)))
            on_click(entry, lambda name: add_named_gestures(self.session, name, self._spans(mouse)), name)
        add_styles_menus(menu, self.session, region, mouse.tick)
        on_click(menu.addAction(self.tr("acting_lane.add_cue_here")), lambda: self._add_cue(mouse))

    def _expression_entries(self, menu: QMenu, chosen: Callable[[str], None], now: Region | None = None) -> None:
        own = {expression.name for expression in self.session.project.expressions}
        names = sorted(self.session.performance.expressions, key=lambda name: (name in own, name))
        for name in names:
            if name in own and not menu.isEmpty() and name == next(item for item in names if item in own):
                menu.addSeparator()
            entry = menu.addAction(verbatim(expression_name(name)))
            on_click(entry, chosen, name)
            entry.setCheckable(now is not None)
            entry.setChecked(now is not None and now.label == expression_name(name))

    def _choose_expression(self, name: str) -> None:
        performance, selected = self.session.performance, self.session.selection.events

        def edit(project: Project) -> Project:
            for player_id in sorted({key.player_id for key in selected}):
                ids = [key.event_id for key in selected if key.player_id == player_id]
                project = set_expression(project, performance.plans[player_id], ids, name)
            return project

        self.session.attempt(Message("edit.set_expression"), edit)

    def _spans(self, mouse: LaneMouse) -> list[tuple[PlayerPlan, int, int]]:
        """Return the place of an event added at the mouse, as a list of (player's plan, first tick, last tick); empty
        without an active player.
        """
        start = self.snap(mouse.tick, mouse)
        end = start + NEW_BEATS * self.session.project.metre_map.felt_ticks_at(start)
        plan = self.session.plan
        return [] if plan is None else [(plan, start, end)]

    def _add_cue(self, mouse: LaneMouse) -> None:
        plan = self.session.plan
        add_cues(self.session, [] if plan is None else [(plan, round(mouse.tick))])
