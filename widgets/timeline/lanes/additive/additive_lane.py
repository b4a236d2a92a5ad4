"""The lane of additive curves: the animator's keys on a channel of body or face, over the generated values."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMenu, QSizePolicy, QToolButton, QWidget

from app.arrays import FloatArray
from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.editor.timeline_view import Tool
from app.errors import AppError, Message, Progress, StopRequested
from app.performance.ensemble import Performance
from app.performance.motion import generated_anew, generated_channel
from app.plan.by_hand.additive_events import channel_limits
from app.plan.model import PlayerPlan
from app.plan.parameters import PlayerParameters
from app.project.edit import additive as edit
from app.project.undoable_document import Change
from metadata.load import load_body
from widgets.common.channel_names import channel_name, value_text
from widgets.common.controls import named
from widgets.common.plain import verbatim
from widgets.common.text import sentence
from widgets.timeline.lane import LaneMouse
from widgets.timeline.lanes.additive.additive_drawing import CurvesItem
from widgets.timeline.lanes.additive.additive_edits import PREFIX, CurveEditing
from widgets.timeline.lanes.additive.additive_menu import add_curve_entries, add_entry, add_key_entries, fill_channels
from widgets.timeline.model.additive import additive_curves as model
from widgets.timeline.model.additive.additive_curves import Hit, KeyRef
from widgets.timeline.model.additive.additive_gestures import DragBlend, DragHandle, DragKeys
from widgets.timeline.model.gestures import Band, MouseGesture, either
from widgets.timeline.model.lane_mouse import PixelRect
from widgets.timeline.zoom_and_scroll import TimeAxis

REACH_PX = 6.0
"""Distance in pixels from a span beyond the body's range within which the tool tip explains it."""


class AdditiveLane(CurveEditing):
    """Curves that are added to generated values.

    A double click adds a key; keys, handles and ends of fades can be dragged; the context menu has more commands.
    """

    id = "additive"
    preferred_height_px = 110
    least_height_px = 60
    folded_at_first = True

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self.limits = (-180.0, 180.0)
        self._generated_of: tuple[PlayerPlan, str, PlayerParameters] | None = None
        self._gesture: MouseGesture | None = None
        self.choice = self.texted(
            named(QToolButton(self.header), "channel_choice"), tip="additive_lane.channel", name="additive_lane.channel"
        )
        self.choice.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.choice.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextOnly)
        self.choice.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.channels = QMenu(self.choice)
        self.channels.aboutToShow.connect(self._fill_channels)
        self.choice.setMenu(self.channels)
        self.controls.addWidget(self.choice)
        self.item = CurvesItem(self)
        self.fold_changed.connect(self.refresh)
        self.texted(self.title, text="additive_lane.title", tip="additive_lane.hint")
        self.retranslate()
        self.refresh()

    def retranslate(self) -> None:
        self.choice.setText(verbatim(channel_name(self.channel)))
        self.update_items()

    def empty_text(self) -> str:
        """Return the text of an empty lane: how to begin, or why that is not possible."""
        if self.limits == (0.0, 0.0):
            return self.tr("additive_lane.not_here")
        return self.tr("additive_lane.add_key_hint").format(channel=channel_name(self.channel))

    # Display

    @property
    def band(self) -> PixelRect | None:
        """The rectangle of the selection that is being dragged; None otherwise."""
        return self._gesture.box if isinstance(self._gesture, Band) else None

    def set_channel(self, channel: str) -> None:
        """Display the additive curves of another animation channel, and clear the selected keys."""
        if channel != self.channel:
            self.channel, self.selected, self.generated = channel, frozenset(), None
            self.choice.setText(verbatim(channel_name(channel)))
            self.refresh()

    def _fill_channels(self) -> None:
        player = self.player_id
        used = {curve.channel for curve in edit.curves_of(self.session.project, player)} if player is not None else ()
        fill_channels(self.channels, self.channel, used, self.set_channel)

    def refresh(self) -> None:
        self.read_curves()
        player, plan = self.session.player, self.session.plan
        if player is None or plan is None or self.folded:
            return
        try:
            instrument = self.session.performance.held(player)
            self.limits = channel_limits(self.channel, instrument, player.parameters, load_body())
        except AppError:
            # The instrument is missing, which is reported elsewhere.
            self.limits = (-180.0, 180.0)
        known, of = self._generated_of, (plan, self.channel, player.parameters)
        if known is None or known[1:] != of[1:] or generated_anew(known[0], plan):
            self._generated_of = of
            work = partial(_generated, self.session.performance, player.id, self.channel)
            self.session.tasks.run(
                Message("work.generated_curve"), work, self._show_generated, lambda _: None, key="generated curve"
            )

    def _show_generated(self, found: tuple[str, str, FloatArray, FloatArray]) -> None:
        player_id, channel, times_s, values = found
        if (player_id, channel) == (self.player_id, self.channel):
            self.generated = (times_s, values)
            self.fit()

    def project_changed(self, change: Change) -> None:
        if change.opened:
            self.selected, self._generated_of, self.generated = frozenset(), None, None
            used = [
                item.channel
                for player in change.after.players
                for item in edit.curves_of(change.after, player.id)
                if player.id == self.player_id
            ]
            if used:
                self.set_channel(used[0])
        self.read_curves()

    def players_changed(self) -> None:
        self.selected, self.generated, self._generated_of = frozenset(), None, None
        self.refresh()

    def selection_changed(self, before: Selection) -> None:
        """Keep selected keys until something else is selected; show a curve that is selected elsewhere."""
        now = self.session.selection
        if now.events == before.events and now.notes == before.notes:
            return
        chosen = self.chosen_curves
        if chosen and self.player_id is not None:
            found = [item for item in edit.curves_of(self.session.project, self.player_id) if item.name in chosen]
            if found and self.channel not in {item.channel for item in found}:
                self.set_channel(found[0].channel)
            self.set_folded(False)
        elif now.events or now.notes:
            self.selected = frozenset()
        self.update_items()

    # Mouse

    def hit(self, mouse: LaneMouse) -> Hit | None:
        """Return the key, handle or curve under the mouse; None if there is none."""
        return model.hit(self.curves, self.selected, self, mouse.x_px, mouse.y_px)

    def press(self, mouse: LaneMouse) -> None:
        found, player = self.hit(mouse), self.player_id
        self._gesture = None
        if player is None:
            return
        view = self.session.timeline_view
        if view is not None and view.tool is Tool.DRAW and (found is None or found.what == "curve"):
            self.add_key(mouse.snapped_tick, mouse.value)
            return
        if found is None:
            kept = self.selected if mouse.ctrl or mouse.shift else frozenset()
            self.select_keys(kept)
            self._gesture = Band(self, mouse, either(3.0), partial(self._take, kept))
        elif found.what == "key":
            self._press_key(found.key, mouse, player)
        elif found.what in ("arrive", "leave"):
            shown = self.shown(found.name)
            at = [key.tick for key in shown.curve.keys].index(found.tick)
            side: edit.Side = "arrive" if found.what == "arrive" else "leave"
            self._gesture = DragHandle(self.session, None, mouse, player, shown, at, side)
        elif found.what == "curve":
            self.selected = frozenset()
            self.session.select(Selection(events=frozenset({EventKey(player, f"{PREFIX}{found.name}")})))
            self.update_items()
        else:
            at_start = found.what == "blend_in"
            self._gesture = DragBlend(self.session, None, mouse, player, found.name, found.tick, at_start)

    def _press_key(self, key: KeyRef, mouse: LaneMouse, player: str) -> None:
        if mouse.ctrl or mouse.shift:
            self.select_keys(self.selected ^ {key} if mouse.ctrl else self.selected | {key})
        elif key not in self.selected:
            self.select_keys(frozenset({key}))
        moving = self.selected | {key}
        self._gesture = DragKeys(self.session, mouse, player, self.channel, key, moving, self.follow_keys)

    def _take(self, kept: frozenset[KeyRef], box: PixelRect, _: LaneMouse) -> None:
        self.selected = kept | model.keys_in(self.curves, self, *box)
        self.update_items()

    def drag(self, mouse: LaneMouse) -> None:
        if self._gesture is not None:
            self._gesture.drag(mouse)
            self.update_items()

    def release(self, mouse: LaneMouse) -> None:
        gesture, self._gesture = self._gesture, None
        if gesture is not None:
            gesture.release(mouse)
        self.fit()

    def cancel(self) -> None:
        gesture, self._gesture = self._gesture, None
        if gesture is not None:
            gesture.cancel()
        self.fit()

    def double_click(self, mouse: LaneMouse) -> None:
        found = self.hit(mouse)
        self._gesture = None
        if found is not None and found.what == "key":
            self.select_keys(frozenset({found.key}))
            self.type_value()
        elif found is None or found.what == "curve":
            self.add_key(mouse.snapped_tick, mouse.value)

    def hover(self, mouse: LaneMouse | None) -> None:
        found = self.hit(mouse) if mouse is not None else None
        if found is None:
            self.plot.unsetCursor()
            self.plot.setToolTip("")
            return
        shapes = {"blend_in": Qt.CursorShape.SizeHorCursor, "blend_out": Qt.CursorShape.SizeHorCursor}
        self.plot.setCursor(shapes.get(found.what, Qt.CursorShape.PointingHandCursor))
        self.plot.setToolTip("\n".join((self.tip(found), *self.problems_at(found.name, mouse))))

    def problems_at(self, name: str, mouse: LaneMouse | None) -> list[str]:
        """Return descriptions of the problems that a curve causes at the mouse, such as values beyond the
        body's range.
        """
        plan = self.session.plan
        if mouse is None or plan is None:
            return []
        reach_s = REACH_PX / self.axis.px_per_s
        beyond = self.shown(name).beyond_s(self.limits)
        if not any(start_s - reach_s <= mouse.time_s <= end_s + reach_s for start_s, end_s in beyond):
            return []
        return [
            sentence(problem.message, self.session)
            for problem in plan.problems
            if problem.message.id == "additive.beyond_reach"
            and problem.message.arguments["moved"] == self.channel
            and problem.start_s - reach_s <= mouse.time_s <= problem.end_s + reach_s
        ]

    def tip(self, found: Hit) -> str:
        """Return the description of the object at a point."""
        curve = self.shown(found.name).curve
        lines = [curve.title or channel_name(self.channel)]
        if found.what == "key":
            key = next(key for key in curve.keys if key.tick == found.tick)
            place = self.session.project.score.metre_map.label(key.tick)
            lines.append(f"{place}: {value_text(self.channel, key.value)}")
        elif found.what in ("blend_in", "blend_out"):
            lines.append(self.tr("additive_lane.drag_to_blend"))
        else:
            lines.append(self.tr("additive_lane.weight_is").format(weight=curve.weight))
        if not curve.enabled:
            lines.append(self.tr("additive_lane.off"))
        return "\n".join(lines)

    def context_menu(self, mouse: LaneMouse) -> QMenu | None:
        found = self.hit(mouse)
        if self.player_id is None:
            return None
        if found is not None and found.what == "key" and found.key not in self.selected:
            self.select_keys(frozenset({found.key}))
        menu = named(QMenu(self), "additive_menu")
        if found is not None and found.what in ("key", "arrive", "leave"):
            add_key_entries(menu, self)
        else:
            here = mouse.snapped_tick
            add_entry(menu, "add_key", self.tr("additive_lane.add_key_here"), lambda: self.add_key(here, mouse.value))
            pasting = add_entry(menu, "paste_keys", self.tr("additive_lane.paste_keys_here"), lambda: self.paste(here))
            pasting.setEnabled(bool(self.clipboard()))
        if found is not None:
            add_curve_entries(menu, self, self.shown(found.name).curve)
        return menu


def _generated(
    performance: Performance, player_id: str, channel: str, progress: Progress, stop_requested: StopRequested
) -> tuple[str, str, FloatArray, FloatArray]:
    return player_id, channel, *generated_channel(performance, player_id, channel)
