"""The curves lane: curves of embouchure (lips) with a value for each note, and of the part's MIDI controllers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPen
from PySide6.QtWidgets import QMenu, QWidget

from app.arrays import FloatArray
from app.editor.edit_names import edit_of_notes
from app.editor.selection import EventKey, Selection
from app.editor.session import Session, Severity
from app.editor.timeline_view import Tool
from app.errors import Message
from app.plan.model import EmbouchureEvent, PlayerPlan
from app.project.undoable_document import Change
from app.score.model import CurveKind, Part
from widgets.common.clicks import on_click
from widgets.common.controls import named
from widgets.common.menus import add_actions
from widgets.common.plain import ComboBox, verbatim
from widgets.common.text import message_text
from widgets.timeline.lane import Lane, LaneItem, LaneMouse
from widgets.timeline.lanes.number_field import NumberField
from widgets.timeline.model.curves import (
    LIPS,
    DragController,
    DragCurve,
    DrawCurve,
    EmbouchureCurves,
    controller_steps,
    lips,
    with_values,
)
from widgets.timeline.model.geometry import StepCurve, step_path
from widgets.timeline.model.gestures import LiveEdit
from widgets.timeline.plot.drawing import draw_lines, draw_mark, draw_path, draw_rects, draw_text, shade, small_font
from widgets.timeline.zoom_and_scroll import TimeAxis

CONTROLLERS: Final[tuple[CurveKind, ...]] = ("breath", "bite", "expression", "volume", "aftertouch", "pitch_bend")
MARGIN_PX = 4.0
BESIDE_BEATS, PLACE_BEATS = 0.25, 1.0
"""Felt beats over which a corrected controller blends back: beside notes, and from a single place."""


class _Curves(LaneItem["CurvesLane"]):
    """Draws the chosen curve strong and editable, the others dim behind it."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane, player = self.lane, self.lane.session.player
        if player is None or lane.lips is None:
            return
        tokens, colour = lane.session.tokens, lane.session.colour(player)
        painter.setFont(small_font(lane.font()))
        shade_of = {"breath": tokens.good, "expression": tokens.warning}
        for kind, steps in lane.controllers.items():
            if kind != lane.curve:
                self._paint_steps(painter, exposed, steps, shade(shade_of.get(kind, tokens.text_dim), 90), 1.0)
        if lane.curve in lane.controllers:
            self._paint_steps(painter, exposed, lane.controllers[lane.curve], QColor(colour), 1.4)
            return
        for name in LIPS:
            if name != lane.curve:
                self._paint_notes(painter, exposed, name, shade(tokens.text_dim, 90), None)
        self._paint_notes(painter, exposed, lane.curve, QColor(colour), shade(colour, 50))
        trace = lane.lips.traces.get(lane.curve)
        if trace is not None:
            self._paint_steps(painter, exposed, trace, shade(tokens.text, 200), 1.2)

    def _paint_steps(self, painter: QPainter, exposed: QRectF, steps: StepCurve, colour: QColor, width: float) -> None:
        axis = self.lane.axis
        left, right = int(exposed.left()), int(np.ceil(exposed.right()))
        low, high = steps.columns(axis.seconds(left), axis.seconds(right), right - left)
        points = step_path(low, high)
        points[:, 0] += left
        points[:, 1] = self._y(points[:, 1])
        draw_path(painter, points, QPen(colour, width))

    def _paint_notes(self, painter: QPainter, exposed: QRectF, name: str, colour: QColor, fill: QColor | None) -> None:
        lane = self.lane
        data, axis = lane.lips, lane.axis
        assert data is not None
        shown = data.spans.between(axis.seconds(exposed.left()), axis.seconds(exposed.right()))
        if len(shown) > 2 * exposed.width():
            self._paint_steps(painter, exposed, data.steps[name], colour, 1.0)
            return
        left, right = axis.x_px(data.spans.start_s[shown]), axis.x_px(data.spans.end_s[shown])
        y = self._y(data.steps[name].value[shown])
        if fill is None:
            draw_lines(painter, left, y, right, y, QPen(colour, 1.0))
            return
        tokens = lane.session.tokens
        bottom, width = lane.plot_rect.height(), np.maximum(right - left - 1.0, 1.0)
        selected = lane.session.selection
        events = [data.events[index] for index in shown.tolist()]
        chosen = np.array(
            [event.note_id in selected.notes or lane.key_of(event) in selected.events for event in events], bool
        )
        for picked, bar, line in ((~chosen, fill, colour), (chosen, shade(tokens.accent, 90), QColor(tokens.accent))):
            draw_rects(painter, left[picked], y[picked], width[picked], bottom - y[picked], bar)
            ends = left[picked] + width[picked]
            draw_lines(painter, left[picked], y[picked], ends, y[picked], QPen(line, 2.0))
        painter.setPen(QColor(tokens.text))
        for event, x, wide, top, is_chosen in zip(
            events, left.tolist(), width.tolist(), y.tolist(), chosen.tolist(), strict=True
        ):
            if event.corrected:
                draw_mark(painter, tokens, x + 1.0, bottom - 8.0)
            if is_chosen and wide > 22.0:
                value = f"{lane.value_of(event):.2f}"
                over = top - 14.0 if top > 16.0 else top + 2.0
                draw_text(painter, QRectF(x + 2.0, over, max(wide, 26.0), 13.0), value)

    def _y(self, value: FloatArray) -> FloatArray:
        height = self.lane.plot_rect.height() - 2 * MARGIN_PX
        result: FloatArray = MARGIN_PX + (1.0 - value) * height
        return result


class CurvesLane(Lane):
    """Lane with one curve of the lips or of a controller; a drag up or down changes it at all selected notes."""

    id = "curves"
    preferred_height_px = 64
    least_height_px = 49

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self.lips: EmbouchureCurves | None = None
        self.controllers: dict[str, StepCurve] = {}
        self.curve = "tension"
        self._plan: PlayerPlan | None = None
        self._part: Part | None = None
        self._drag: DragCurve | DragController | DrawCurve | None = None
        self.choice = self.texted(
            named(ComboBox(self.header), "curve_choice"),
            tip="curves_lane.active_curve_tip",
            name="curves_lane.curve",
        )
        self.choice.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.choice.activated.connect(self._chosen)
        self.controls.addWidget(self.choice)
        self.item = _Curves(self)
        self.number = NumberField(self)
        self.refresh()
        self.texted(self.title, text="curves_lane.curves", tip="curves_lane.drag_notes_value_up_or")
        self.retranslate()

    def retranslate(self) -> None:
        self._fill_choice()

    def curve_name(self, curve: str) -> str:
        """Return the name of a curve, such as lip tension, in the user's language."""
        names = {
            "tension": self.tr("curves_lane.lip_tension"),
            "effort": self.tr("curves_lane.effort"),
            "air": self.tr("curves_lane.air"),
            "breath": self.tr("curves_lane.breath_controller"),
            "bite": self.tr("curves_lane.bite"),
            "volume": self.tr("curves_lane.volume"),
            "expression": self.tr("curves_lane.expression"),
            "aftertouch": self.tr("curves_lane.aftertouch"),
            "pitch_bend": self.tr("curves_lane.pitch_bend"),
        }
        return names[curve]

    def set_curve(self, curve: str) -> None:
        """Choose the curve (such as lip tension) that is drawn in front and edited."""
        self.curve = curve
        self.choice.setCurrentIndex(self.choice.findData(curve))
        self.update_items()

    def _fill_choice(self) -> None:
        curves = [*LIPS, *(kind for kind in CONTROLLERS if kind in self.controllers)]
        self.choice.clear()
        for curve in curves:
            self.choice.addItem(self.curve_name(curve), curve)
        self.set_curve(self.curve if self.curve in curves else "tension")

    def _chosen(self, index: int) -> None:
        self.set_curve(str(self.choice.itemData(index)))

    # Display

    def refresh(self) -> None:
        """Display the active player's plan and part, if either has changed."""
        player, project = self.session.player, self.session.project
        plan = self.session.plan
        part = project.part(player) if player is not None else None
        if part is not self._part:
            self._part = part
            before = tuple(self.controllers)
            self.controllers = controller_steps(part, project) if part is not None else {}
            if tuple(self.controllers) != before:
                self._fill_choice()
        waiting = plan is None and player is not None and self._plan is not None
        if waiting and self._plan is not None and player is not None and self._plan.player_id == player.id:
            return
        if plan is not self._plan or plan is None:
            self._plan = plan
            self.lips = lips(plan) if plan is not None else None
            self.plot.setToolTip("")
        self.update_items()

    def key_of(self, event: EmbouchureEvent) -> EventKey:
        """Key of an event in the selection."""
        return EventKey(self._plan.player_id if self._plan is not None else "", event.id)

    def value_of(self, event: EmbouchureEvent) -> float:
        """Return the value of the displayed curve in an embouchure event."""
        value: float = getattr(event, self.curve) if self.curve in LIPS else 0.0
        return value

    def event_at(self, time_s: float) -> EmbouchureEvent | None:
        """Return the embouchure event in force at a time; None if there is none."""
        if self.lips is None:
            return None
        found = self.lips.spans.between(time_s, time_s)
        return self.lips.events[int(found[-1])] if len(found) else None

    def project_changed(self, change: Change) -> None:
        if change.before.score is not change.after.score:
            self.refresh()

    def selection_changed(self, before: Selection) -> None:
        now = self.session.selection
        if (before.notes, before.events) != (now.notes, now.events):
            self.update_items()

    # Mouse

    def press(self, mouse: LaneMouse) -> None:
        before, event = self.session.selection, self.event_at(mouse.time_s)
        notes = before.notes
        self._drag = None
        view = self.session.timeline_view
        if view is not None and view.tool is Tool.DRAW:
            self._draw(mouse)
            return
        if event is None:
            if not (mouse.ctrl or mouse.shift):
                self.session.select(Selection())
            return
        if mouse.ctrl:
            self.session.select(Selection(notes=notes ^ {event.note_id}))
        elif event.note_id not in notes:
            self.session.select(Selection(notes=frozenset({event.note_id})))
        chosen = self.session.selection.notes
        if self._plan is None or self.lips is None:
            return
        if self.curve not in LIPS:
            self._drag = self._controller_drag(mouse, self._plan.player_id, chosen)
            return
        starts = {item.note_id: self.value_of(item) for item in self.lips.events if item.note_id in chosen}
        height_px = self.plot_rect.height() - 2 * MARGIN_PX
        self._drag = DragCurve(self.session, self, mouse, self._plan.player_id, self.curve, starts, height_px)

    def _draw(self, mouse: LaneMouse) -> None:
        """Begin to draw the chosen curve freehand; only curves of the lips can be drawn."""
        if self.curve not in LIPS:
            self.session.notice(Message("curves.not_drawn", {"curve": self.curve_name(self.curve)}), Severity.WARNING)
        elif self._plan is not None and self.lips is not None:
            height_px = max(self.plot_rect.height() - 2 * MARGIN_PX, 1.0)
            self._drag = DrawCurve(
                self.session,
                self,
                mouse,
                self._plan.player_id,
                self.curve,
                self.lips,
                lambda y_px: 1.0 - (y_px - MARGIN_PX) / height_px,
            )

    def _controller_drag(self, mouse: LaneMouse, player_id: str, chosen: frozenset[str]) -> DragController | None:
        """Return the drag that changes a controller at the chosen notes, or with Alt only around the mouse; None if the
        curve is no controller.
        """
        kind = next((kind for kind in CONTROLLERS if kind == self.curve), None)
        if kind is None or self._part is None:
            return None
        tick = max(round(mouse.tick), 0)
        spans = [(note.onset_tick, note.end_tick) for note in self._part.notes if note.id in chosen]
        spans, blend_beats = ([(tick, tick)], PLACE_BEATS) if mouse.alt else (spans, BESIDE_BEATS)
        curve = next((curve for curve in self._part.curves if curve.kind == kind), None)
        low, high = (0.0, 1.0) if curve is None else curve.shown_range
        height_px = (self.plot_rect.height() - 2 * MARGIN_PX) / (high - low)
        return DragController(LiveEdit(self.session, self), mouse, player_id, kind, spans, blend_beats, height_px)

    def drag(self, mouse: LaneMouse) -> None:
        if self._drag is not None:
            self._drag.drag(mouse)

    def release(self, mouse: LaneMouse) -> None:
        drag, self._drag = self._drag, None
        if drag is not None:
            drag.release(mouse)

    def double_click(self, mouse: LaneMouse) -> None:
        self._drag = None
        event = self.event_at(mouse.time_s)
        if self.curve not in LIPS:
            self.session.notice(Message("curves.not_typed", {"curve": self.curve_name(self.curve)}), Severity.WARNING)
        elif event is None:
            self.session.notice(Message("curves.no_note_here"), Severity.WARNING)
        else:
            self._type(event)

    def _type(self, event: EmbouchureEvent) -> None:
        left = self.axis.x_px(event.start_s)
        middle = self.plot_rect.height() / 2
        name = self.curve_name(self.curve)
        box = QRectF(left, middle, 1.0, 1.0)
        notes, events = self.session.selection.notes, self.lips.events if self.lips is not None else ()
        values = {round(self.value_of(item), 2) for item in events if item.note_id in notes}
        value = self.value_of(event) if len(values) < 2 else None
        self.number.open(box, value, 2, lambda typed: self._change_values(lambda _: typed), name)

    def _change_values(self, change: Callable[[EmbouchureEvent], float]) -> None:
        """Set the chosen curve's value at all selected notes by a function."""
        if self.lips is None or self._plan is None or self.curve not in LIPS:
            return
        notes, player_id, curve = self.session.selection.notes, self._plan.player_id, self.curve
        values = {item.note_id: change(item) for item in self.lips.events if item.note_id in notes}

        if values:
            self.session.attempt(
                edit_of_notes(self.session.project, "edit.set_embouchure", values, (player_id,)),
                lambda project: with_values(project, player_id, curve, values),
            )

    def key(self, event: QKeyEvent) -> bool:
        """Open the field for the value of the selected notes when Enter is pressed; return whether the event was
        handled.
        """
        if self.lips is None:
            return False
        notes = self.session.selection.notes
        chosen = [index for index, item in enumerate(self.lips.events) if item.note_id in notes]
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and chosen and self.curve in LIPS:
            self._type(self.lips.events[chosen[0]])
            return True
        return False

    def cancel(self) -> None:
        drag, self._drag = self._drag, None
        if drag is not None:
            drag.cancel()

    def hover(self, mouse: LaneMouse | None) -> None:
        event = self.event_at(mouse.time_s) if mouse is not None else None
        if mouse is None or event is None:
            self.plot.setToolTip("")
            self.plot.unsetCursor()
            return
        self.plot.setCursor(Qt.CursorShape.SizeVerCursor)
        lines = [f"{self.curve_name(name)} {getattr(event, name):.2f}" for name in LIPS]
        for kind, steps in self.controllers.items():
            if (value := steps.at(mouse.time_s)) is not None:
                lines.append(f"{self.curve_name(kind)} {value:.2f}")
        self.plot.setToolTip("\n".join((*lines, message_text(event.reason, self.session))))

    def context_menu(self, mouse: LaneMouse) -> QMenu | None:
        event = self.event_at(mouse.time_s)
        if event is not None and event.note_id not in self.session.selection.notes:
            self.session.select(Selection(notes=frozenset({event.note_id})))
        menu = QMenu(self)
        for curve in [str(self.choice.itemData(index)) for index in range(self.choice.count())]:
            entry = menu.addAction(verbatim(self.curve_name(curve)))
            entry.setCheckable(True)
            entry.setChecked(curve == self.curve)
            on_click(entry, self.set_curve, curve)
        if event is not None:
            add_actions(menu, self.session, ("", "events.give_back"))
        return menu
