"""The fingering lane: pressed keys, valves and slide positions of every note, and alternatives."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QKeyEvent, QPainter, QPen
from PySide6.QtWidgets import QMenu, QWidget

from app.arrays import BoolArray, FloatArray, IntArray
from app.editor.selection import Selection
from app.editor.session import Session, Severity
from app.errors import AppError, Message
from app.plan.model import FingeringEvent, MuteEvent, PlayerPlan
from app.project.performers import Player
from app.project.undoable_document import Change
from instrument_maps.fingering_label import says_words
from instrument_maps.model import Control, InstrumentMap
from widgets.common.menus import add_actions
from widgets.common.text import message_text
from widgets.timeline.lane import Lane, LaneItem, LaneMouse
from widgets.timeline.lanes.fingering import charts
from widgets.timeline.lanes.fingering.alternates import Alternates
from widgets.timeline.lanes.fingering.charts import FingeringCharts, ShownFingerings
from widgets.timeline.lanes.problems import ProblemMarks
from widgets.timeline.lanes.row_names import RowNames
from widgets.timeline.model.fingerings import Fingerings, fingerings, slide_places
from widgets.timeline.plot.drawing import draw_mark, draw_path, draw_rects, draw_text, shade, small_font
from widgets.timeline.zoom_and_scroll import TimeAxis

LABEL_PX = 16.0
"""Height of the row of labels."""
LEAST_LABEL_PX = 9.0
MOST_BAR_PX = 26.0
"""However high the lane, bars stay thin enough to be read together."""
SMALL_BAR_PX = 13.0
"""Height of a trigger's bar in pixels, which leaves the slide its space."""
CHIPS_DELAY_PX = 3.0
NEAR_PX = 7.0
"""Distance in pixels within which a press beside a note counts as on it."""


class _Bars(LaneItem["FingeringLane"]):
    """Pressed controls as bars, slides as lines, labels beneath."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane, data, player = self.lane, self.lane.data, self.lane.session.player
        if data is None or player is None:
            return
        axis, tokens = lane.axis, lane.session.tokens
        painter.setFont(small_font(lane.font()))
        shown = data.spans.between(axis.seconds(exposed.left()), axis.seconds(exposed.right()))
        left: FloatArray = axis.x_px(data.start_s[shown])
        width = np.maximum(axis.x_px(data.end_s[shown]) - left - 1.0, 1.0)
        colour = lane.session.colour(player)
        selected = lane.session.selection.notes
        chosen = np.array([data.events[index].note_id in selected for index in shown.tolist()], bool)
        self._paint_selection(painter, left[chosen], width[chosen])
        if lane.charts is not None:
            events = [data.events[index] for index in shown.tolist()]
            column = [row for row, _ in lane.column_rows]
            seen = ShownFingerings(events, left, width, chosen)
            lane.charts.paint(painter, exposed, seen, data.pressed[column][:, shown], colour)
            self._paint_mutes(painter, exposed)
            return
        for row, values in enumerate(data.pressed):
            top, height = lane.bar_box(row)
            painter.setPen(QPen(shade(tokens.line_strong, 110), 1.0))
            painter.drawLine(QPointF(exposed.left(), top + height / 2), QPointF(exposed.right(), top + height / 2))
            value = values[shown]
            for picked, token in ((~chosen, colour), (chosen, tokens.accent)):
                down = picked & (value > 0.0)
                size = np.maximum(value[down] * (height - 2.0), 2.0)
                draw_rects(painter, left[down], top + height / 2 - size / 2, width[down], size, shade(token, 200))
        for values in data.slides:
            self._paint_slide(painter, exposed, left, width, values[shown], chosen, colour)
        self._paint_labels(painter, data, shown, left, width, chosen)
        self._paint_mutes(painter, exposed)

    def _paint_mutes(self, painter: QPainter, exposed: QRectF) -> None:
        """Draw a line above the labels of muted passages, dashed for a mute and solid for hand stopping."""
        lane, tokens = self.lane, self.lane.session.tokens
        y = lane.plot_rect.height() - (LABEL_PX if lane.charts is None else 0.0) - 2.0
        for mute in lane.mutes:
            left, right = (float(x) for x in lane.axis.x_px(np.array([mute.start_s, mute.end_s])))
            if right >= exposed.left() and left <= exposed.right():
                style = Qt.PenStyle.SolidLine if mute.kind == "stopped" else Qt.PenStyle.DashLine
                painter.setPen(QPen(QColor(tokens.text), 2.0, style))
                painter.drawLine(QPointF(left, y), QPointF(right, y))

    def _paint_selection(self, painter: QPainter, left: FloatArray, width: FloatArray) -> None:
        height = np.full(len(left), self.lane.plot_rect.height())
        draw_rects(painter, left, np.zeros(len(left)), width, height, shade(self.lane.session.tokens.accent, 36))

    def _paint_slide(
        self,
        painter: QPainter,
        exposed: QRectF,
        left: FloatArray,
        width: FloatArray,
        value: FloatArray,
        chosen: BoolArray,
        colour: str,
    ) -> None:
        lane, tokens = self.lane, self.lane.session.tokens
        top, height = lane.slide_box
        for place, _ in lane.places:
            level = top + place * height
            painter.setPen(QPen(shade(tokens.line_strong, 130), 1.0, Qt.PenStyle.DotLine))
            painter.drawLine(QPointF(exposed.left(), level), QPointF(exposed.right(), level))
        y = top + value * height
        points = np.empty((2 * len(left), 2))
        points[0::2, 0], points[1::2, 0] = left, left + width
        points[0::2, 1] = points[1::2, 1] = y
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        draw_path(painter, points, QPen(shade(colour, 110), 1.0))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        for picked, token in ((~chosen, colour), (chosen, tokens.accent)):
            count = int(picked.sum())
            draw_rects(painter, left[picked], y[picked] - 1.5, width[picked], np.full(count, 3.0), shade(token, 230))

    def _paint_labels(
        self,
        painter: QPainter,
        data: Fingerings,
        shown: IntArray,
        left: FloatArray,
        width: FloatArray,
        chosen: BoolArray,
    ) -> None:
        lane, tokens = self.lane, self.lane.session.tokens
        top = lane.plot_rect.height() - LABEL_PX
        text, strong = QColor(tokens.text_dim), QColor(tokens.text)
        metrics = QFontMetricsF(painter.font())
        rows = zip(shown.tolist(), left.tolist(), width.tolist(), chosen.tolist(), strict=True)
        for index, x, wide, is_chosen in rows:
            event = data.events[index]
            if event.corrected:
                draw_mark(painter, tokens, x, top - 2.0)
            if wide < LEAST_LABEL_PX:
                continue
            # Anything but the first choice is emphasised, since users look for it.
            painter.setPen(strong if is_chosen or event.corrected or event.rank > 1 else text)
            inset = 8.0 if event.corrected else 2.0
            box = QRectF(x + inset, top, max(wide - inset, 15.0), LABEL_PX)
            label = event.label
            if wide >= metrics.horizontalAdvance(label) + inset:
                draw_text(painter, box, label)


class FingeringLane(Lane):
    """Fingerings of the active player. A click on a note shows the alternatives."""

    id = "fingering"
    is_essential = True
    preferred_height_px = 72
    least_height_px = 46

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self.data: Fingerings | None = None
        self.places: tuple[tuple[float, str], ...] = ()
        self.charts: FingeringCharts | None = None
        self._charted: InstrumentMap | None = None
        self._pressable: tuple[Control, ...] = ()
        self._slides: tuple[Control, ...] = ()
        self._plan: PlayerPlan | None = None
        self._pressed_at: LaneMouse | None = None
        self._selection_before = Selection()
        self._hovered: FingeringEvent | None = None
        self.bars = _Bars(self)
        self.problem_marks = ProblemMarks(self, ("fingering", "note"))
        self.alternates = Alternates(session, self)
        self._names = RowNames(self, self.row_names)
        self.refresh()
        self.texted(self.title, text="fingering_lane.fingering", tip="fingering_lane.click_note_to_see_its")

    # Display

    def refresh(self) -> None:
        """Show the active player's plan, if it has changed."""
        player, plan = self.session.player, self.session.plan
        if plan is self._plan and plan is not None:
            return
        if plan is None and player is not None and self._plan is not None and self._plan.player_id == player.id:
            # The former display stays until new plans arrive.
            return
        self._plan, self.data, self.places = plan, None, ()
        instrument = self._instrument(player) if player is not None else None
        self._show_charts(instrument)
        if instrument is not None and plan is not None:
            pitched = [control for control in instrument.controls if control.role == "pitch"]
            self._pressable = tuple(control for control in pitched if control.kind != "slide")
            self._slides = tuple(control for control in pitched if control.kind == "slide")
            self.data = fingerings(plan, self._pressable, self._slides)
            if self._slides:
                self.places = slide_places(instrument, self._slides[0])
        self._hovered = None
        if hasattr(self, "_names"):
            self._names.update()
        self.update_items()

    def retranslate(self) -> None:
        self._hovered = None
        self.plot.setToolTip("")
        self.update_items()

    def _show_charts(self, instrument: InstrumentMap | None) -> None:
        """Show fingering charts instead of bars if the instrument has keys or holes; they need a taller lane."""
        charted = instrument is not None and says_words(instrument.controls)
        if instrument is not self._charted:
            self._charted = instrument
            self.charts = FingeringCharts(self, instrument) if instrument is not None and charted else None
        if charted:
            self.ask_height(charts.PREFERRED_PX, charts.LEAST_PX)
        else:
            self.ask_height(type(self).preferred_height_px, type(self).least_height_px)

    @property
    def needed_height_px(self) -> int:
        return self.least_height_px if self.charts is None else charts.USUAL_PX

    @property
    def column_rows(self) -> list[tuple[int, Control]]:
        """Return the controls that are holes in the chart's column, with their row indices among all pressable
        controls.
        """
        rows = {control.name: row for row, control in enumerate(self._pressable)}
        column = () if self.charts is None else self.charts.chart.column
        return [(rows[key.control.name], key.control) for key in column]

    def _instrument(self, player: Player) -> InstrumentMap | None:
        """Return the player's instrument; None if it is not installed."""
        try:
            return self.session.performance.instrument(player)
        except AppError:
            return None

    def row_names(self) -> list[tuple[str, float]]:
        """Return the signs of controls and slide positions with their vertical positions."""
        if self.data is None:
            return []
        if self.charts is not None:
            return self.charts.rows()
        names = []
        for row, control in enumerate(self._pressable):
            top, height = self.bar_box(row)
            names.append((control.label or control.name, top + height / 2))
        top, height = self.slide_box
        return names + [(label, top + place * height) for place, label in self.places]

    @property
    def _bars_share(self) -> float:
        """Return the share of the height above the labels for the bars of pressed controls."""
        if not self._slides:
            return 1.0
        return len(self._pressable) / (len(self._pressable) + 4.0)

    def bar_box(self, row: int) -> tuple[float, float]:
        """Return top and height in pixels of the bar for the pressable control with the index ``row``."""
        room = (self.plot_rect.height() - LABEL_PX - 4.0) * self._bars_share
        most = MOST_BAR_PX if not self._slides else SMALL_BAR_PX
        height = min(room / max(len(self._pressable), 1), most)
        return 2.0 + row * height, height

    @property
    def slide_box(self) -> tuple[float, float]:
        """Top and height of the range of a slide: closed at the top, far out at the bottom."""
        room = self.plot_rect.height() - LABEL_PX - 4.0
        top = sum(self.bar_box(len(self._pressable) - 1)) if self._pressable else 2.0
        return top + 6.0, max(room - top - 10.0, 4.0)

    @property
    def mutes(self) -> tuple[MuteEvent, ...]:
        """Passages in which the active player uses a mute."""
        return () if self._plan is None else self._plan.mutes

    def event_at(self, time_s: float) -> FingeringEvent | None:
        """Return the fingering event in effect at a time, else one near it; None if there is none."""
        if self.data is None:
            return None
        reach_s = NEAR_PX / self.axis.px_per_s
        found = self.data.spans.between(time_s - reach_s, time_s + reach_s).tolist()
        if not found:
            return None
        start_s, end_s = self.data.start_s[found], self.data.end_s[found]
        away_s: list[float] = np.maximum(np.maximum(start_s - time_s, time_s - end_s), 0.0).tolist()
        # The last one of several at the same position.
        nearest: int = min(zip(away_s, [-index for index in found], found, strict=True))[2]
        return self.data.events[nearest]

    def players_changed(self) -> None:
        self.alternates.hide()
        super().players_changed()

    def project_changed(self, change: Change) -> None:
        if change.opened or change.before.corrections is not change.after.corrections:
            self.alternates.hide()

    def selection_changed(self, before: Selection) -> None:
        if before.notes != self.session.selection.notes:
            self.update_items()

    def axis_changed(self) -> None:
        if hasattr(self, "alternates"):
            self.alternates.hide()

    # Mouse

    def press(self, mouse: LaneMouse) -> None:
        event = self.event_at(mouse.time_s)
        self._pressed_at, self._selection_before = mouse, self.session.selection
        notes = self.session.selection.notes
        if event is None:
            if not (mouse.ctrl or mouse.shift):
                self.session.select(Selection())
        elif mouse.ctrl:
            self.session.select(Selection(notes=notes ^ {event.note_id}))
        elif mouse.shift:
            self.session.select(Selection(notes=notes | {event.note_id}))
        elif event.note_id not in notes:
            self.session.select(Selection(notes=frozenset({event.note_id})))

    def double_click(self, mouse: LaneMouse) -> None:
        if self.event_at(mouse.time_s) is None:
            self.session.notice(Message("fingering.no_note_here"), Severity.WARNING)

    def drag(self, mouse: LaneMouse) -> None:
        start = self._pressed_at
        if start is None or self.data is None or abs(mouse.x_px - start.x_px) < CHIPS_DELAY_PX:
            return
        low, high = sorted((start.time_s, mouse.time_s))
        inside = frozenset(self.data.events[index].note_id for index in self.data.spans.between(low, high).tolist())
        more = self._selection_before.notes if start.ctrl or start.shift else frozenset()
        self.session.select(Selection(notes=inside | more))

    def release(self, mouse: LaneMouse) -> None:
        start, self._pressed_at = self._pressed_at, None
        if start is None or mouse.ctrl or mouse.shift or abs(mouse.x_px - start.x_px) >= CHIPS_DELAY_PX:
            return
        event = self.event_at(start.time_s)
        if event is not None:
            self.session.select(Selection(notes=frozenset({event.note_id})))
            self._show_alternates(event)

    def key(self, event: QKeyEvent) -> bool:
        """Handle keys: Alt and an arrow move to the adjacent note, Enter shows its alternatives."""
        if self.data is None or not self.data.events:
            return False
        notes, events = self.session.selection.notes, self.data.events
        chosen = [index for index, item in enumerate(events) if item.note_id in notes]
        alt = bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
        if alt and event.key() in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            step = 1 if event.key() == Qt.Key.Key_Right else -1
            start = int(np.searchsorted(self.data.start_s, self.session.playhead_s))
            index = (max(chosen) if step > 0 else min(chosen)) + step if chosen else start
            found = events[min(max(index, 0), len(events) - 1)]
            self.session.select(Selection(notes=frozenset({found.note_id})))
            self.axis.reveal(found.start_s, found.end_s)
            return True
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and chosen:
            self._show_alternates(events[chosen[0]])
            self.alternates.take_focus()
            return True
        return False

    def _show_alternates(self, event: FingeringEvent) -> None:
        if self._plan is not None:
            x = min(max(self.axis.x_px(event.start_s), 0.0), self.plot_rect.width() - 60.0)
            self.alternates.show_for(self._plan.player_id, event, self.plot.mapTo(self.window(), QPoint(round(x), 0)))

    def cancel(self) -> None:
        self._pressed_at = None
        self.session.select(self._selection_before)

    def hover(self, mouse: LaneMouse | None) -> None:
        event = self.event_at(mouse.time_s) if mouse is not None else None
        if event is not self._hovered:
            self._hovered = event
            self.plot.setToolTip("" if event is None else self._tip(event))

    def _tip(self, event: FingeringEvent) -> str:
        """Return the description of the fingering under the mouse and of the tongue's stroke, each with its reason."""
        lines = [message_text(event.reason, self.session)]
        strokes = () if self._plan is None else self._plan.tongues
        stroke = next((one for one in strokes if one.note_id == event.note_id), None)
        if stroke is not None:
            lines.append(f"{stroke.stroke}: {message_text(stroke.reason, self.session)}")
        here = (one for one in self.mutes if one.start_tick <= event.start_tick < one.end_tick)
        lines += [message_text(one.reason, self.session) for one in here]
        return "\n".join(lines)

    def context_menu(self, mouse: LaneMouse) -> QMenu | None:
        event = self.event_at(mouse.time_s)
        if event is not None and event.note_id not in self.session.selection.notes:
            self.session.select(Selection(notes=frozenset({event.note_id})))
        menu = QMenu(self)
        if event is not None and self._plan is not None:
            self.alternates.fill_menu(menu, self._plan.player_id, event)
            menu.addSeparator()
        add_actions(menu, self.session, ("fingering.cycle", "events.give_back"))
        return menu
