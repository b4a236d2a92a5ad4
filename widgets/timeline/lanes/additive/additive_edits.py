"""Edits of additive curves and of selected keys."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QMimeData, QRectF, Qt
from PySide6.QtGui import QGuiApplication, QKeyEvent
from PySide6.QtWidgets import QWidget

from app.arrays import FloatArray
from app.editor.edit_names import edit_at
from app.editor.selection import Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.by_hand.additive_curve import CHANNELS, CurveKey, Interpolation
from app.project.edit import additive as edit
from app.project.model import Project
from widgets.common.channel_names import channel_name
from widgets.timeline.lane import Lane
from widgets.timeline.lanes.number_field import NumberField, TextField
from widgets.timeline.model.additive import additive_curves as model
from widgets.timeline.model.additive.additive_curves import KeyRef, ShownCurve, by_curve
from widgets.timeline.zoom_and_scroll import TimeAxis

MIME = "application/x-suisou-curve-keys"
FIRST_CHANNEL = "head.up"
STEPS = {"deg": (1.0, 0.1), "m": (0.005, 0.001), "weight": (0.05, 0.01)}
"""Change of a value by Up and Down, and by these with Shift, by unit."""
PREFIX = "additive:"
"""Prefix of curves' ids among events."""


class CurveEditing(Lane):
    """Curves of a channel with edits of them and of selected keys.

    Attributes
    ----------
    channel : str
        Displayed channel of body or face.
    curves : tuple of ShownCurve
        Curves of the active player on the channel.
    selected : frozenset of KeyRef
        Selected keys.
    generated : (array, array) or None
        Times and values generated on the channel.
    """

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self.channel = FIRST_CHANNEL
        self.curves: tuple[ShownCurve, ...] = ()
        self.selected: frozenset[KeyRef] = frozenset()
        self.generated: tuple[FloatArray, FloatArray] | None = None
        self.number = NumberField(self)
        self.text = TextField(self)

    @property
    def player_id(self) -> str | None:
        """Id of the active player; None if there is none."""
        return None if self.session.player is None else self.session.player.id

    @property
    def chosen_curves(self) -> frozenset[str]:
        """Names of the curves that are selected completely."""
        return frozenset(
            key.event_id.removeprefix(PREFIX)
            for key in self.session.selection.events
            if key.player_id == self.player_id and key.event_id.startswith(PREFIX)
        )

    def read_curves(self) -> None:
        """Read the additive curves of the displayed player and channel from the project."""
        player = self.player_id
        self.curves = () if player is None else model.shown_curves(self.session.project, player, self.channel)
        self.selected = model.still_there(self.curves, self.selected)
        self.fit()

    def fit(self) -> None:
        """Fit the vertical scale to the contents, except during a drag."""
        if not self.dragging:
            values = None if self.generated is None else self.generated[1]
            most = model.vertical_range(self.channel, self.curves, values)
            self.set_y_range(-most, most)
        self.update_items()

    def select_keys(self, keys: frozenset[KeyRef]) -> None:
        """Select keys of additive curves, and deselect everything else in the editor."""
        self.selected = keys
        self.session.select(Selection())
        self.update_items()

    def follow_keys(self, keys: frozenset[KeyRef]) -> None:
        """Set the selection to keys that were renamed by an edit."""
        self.selected = keys
        self.read_curves()

    def add_key(self, tick: int, value: float) -> None:
        """Add a key to the nearest curve, or else to a new one, and select it."""
        player, channel = self.player_id, self.channel
        if player is None:
            return
        value = model.rounded(channel, value)
        active = next(iter(self.chosen_curves), None)
        name = model.joined(self.curves, self.session.project, tick, active)
        made = name or ""

        def edited(project: Project) -> Project:
            nonlocal made
            if name is not None:
                return edit.add_key(project, player, name, tick, value)
            project, made = edit.add_curve(project, player, channel, ((tick, value),))
            return project

        step = edit_at(self.session.project, "edit.add_curve_key", 1, (player,), (tick,))
        if self.session.attempt(step, edited):
            self.read_curves()
            self.select_keys(frozenset({KeyRef(made, tick)}))

    # Edits

    def chosen(self) -> tuple[CurveKey, ...]:
        """Return the selected keys of the displayed curves."""
        return model.chosen_keys(self.curves, self.selected)

    def interpolate(self, interpolation: Interpolation) -> None:
        """Set the interpolation after the selected keys."""
        self._edit_keys("edit.set_interpolation", partial(edit.set_interpolation, interpolation=interpolation))

    def free(self) -> None:
        """Let the program compute the handles of the selected keys."""
        self._edit_keys("edit.set_curve_tangents", edit.free_tangents)

    def flatten(self) -> None:
        """Make the handles of the selected keys horizontal."""
        self._edit_keys("edit.set_curve_tangents", edit.flatten_tangents)

    def delete(self) -> None:
        """Delete the selected keys of additive curves."""
        self._edit_keys("edit.delete_curve_keys", edit.delete_keys)

    def nudge(self, ticks: int, value: float) -> None:
        """Move the selected keys of additive curves by ticks and by value, and keep them selected."""
        before = self.selected
        if self._edit_keys("edit.move_curve_keys", partial(edit.move_keys, ticks=ticks, value=value)):
            self.follow_keys(frozenset(KeyRef(key.name, key.tick + ticks) for key in before))

    def type_value(self) -> None:
        """Open a field for the value of the selected keys."""
        keys = self.chosen()
        if not keys:
            return
        unit = CHANNELS[self.channel].unit
        scale, decimals = (100.0, 1) if unit == "m" else (1.0, model.DECIMALS[unit])
        at = self.axis.x_px(self.session.project.score.tempo_map.seconds(float(keys[0].tick)))
        box = QRectF(at, self.y_px(keys[0].value), 1.0, 1.0)

        def take(typed: float) -> None:
            self._edit_keys("edit.set_curve_values", partial(edit.set_values, value=typed / scale))

        units = {"deg": "°", "m": "cm", "weight": ""}
        self.number.open(box, scale * keys[0].value, decimals, take, channel_name(self.channel), units[unit])

    def type_weight(self, name: str) -> None:
        """Open a field for the weight of a curve."""
        curve = self.shown(name).curve
        take = partial(self._change_curve, name)
        box = QRectF(self.axis.x_px(self.shown(name).start_s), self.y_px(0.0), 1.0, 1.0)
        self.number.open(box, curve.weight, 2, lambda typed: take(weight=typed), self.tr("additive_lane.weight"))

    def type_title(self, name: str) -> None:
        """Open a field for the name of a curve."""
        shown = self.shown(name)
        box = QRectF(self.axis.x_px(shown.start_s), self.y_px(0.0), 1.0, 1.0)
        take = partial(self._change_curve, name)
        self.text.ask(box, shown.curve.title, lambda typed: take(title=typed), self.tr("additive_lane.rename"))

    def enable(self, name: str, enabled: bool) -> None:
        """Switch an additive curve of the player on or off."""
        self._change_curve(name, enabled=enabled)

    def delete_curve(self, name: str) -> None:
        """Remove an additive curve of the player with all its keys."""
        player = self.player_id
        if player is not None:
            self._attempt(Message("edit.delete_curve"), lambda project: edit.delete_curves(project, player, (name,)))

    def copy(self) -> None:
        """Copy the selected keys to the clipboard."""
        data = QMimeData()
        data.setData(MIME, model.clip_text(self.channel, self.chosen()))
        QGuiApplication.clipboard().setMimeData(data)

    def paste(self, tick: int) -> None:
        """Insert the clipboard's keys at a tick."""
        player, channel, keys = self.player_id, self.channel, self.clipboard()
        if player is None or not keys:
            return
        name = model.joined(self.curves, self.session.project, tick, next(iter(self.chosen_curves), None))
        made = name or ""

        def edited(project: Project) -> Project:
            nonlocal made
            if name is None:
                project, made = edit.add_curve(project, player, channel, ((tick, keys[0].value),))
            return edit.paste_keys(project, player, made, keys, tick)

        pasted = edit_at(self.session.project, "edit.paste_curve_keys", len(keys), (player,), (tick,))
        if self._attempt(pasted, edited):
            self.select_keys(frozenset(KeyRef(made, key.tick - keys[0].tick + tick) for key in keys))

    def select_all(self) -> None:
        """Select every key of the channel."""
        self.select_keys(
            frozenset(KeyRef(shown.curve.name, key.tick) for shown in self.curves for key in shown.curve.keys)
        )

    def clipboard(self) -> tuple[CurveKey, ...]:
        data = QGuiApplication.clipboard().mimeData()
        if data is None or not data.hasFormat(MIME):
            return ()
        return model.clip_keys(bytes(data.data(MIME).data()), self.channel)

    def shown(self, name: str) -> ShownCurve:
        return next(shown for shown in self.curves if shown.curve.name == name)

    def _change_curve(self, name: str, **values: object) -> None:
        player = self.player_id
        if player is not None:
            self._attempt(
                Message("edit.change_curve"), lambda project: edit.change_curves(project, player, (name,), **values)
            )

    def _edit_keys(self, name: str, change: Callable[..., Project]) -> bool:
        player, keys = self.player_id, by_curve(self.selected)
        if player is None or not keys:
            return False
        ticks = [key.tick for key in self.selected]
        message = edit_at(self.session.project, name, len(ticks), (player,), ticks)
        return self._attempt(message, lambda project: change(project, player, keys))

    def _attempt(self, name: Message, change: Callable[[Project], Project]) -> bool:
        done = self.session.attempt(name, change)
        self.read_curves()
        return done

    # Keys

    def claims(self, event: QKeyEvent) -> bool:
        modifiers = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
        if modifiers == Qt.KeyboardModifier.ControlModifier:
            if event.key() == Qt.Key.Key_V:
                return bool(self.clipboard())
            return event.key() == Qt.Key.Key_A or (event.key() == Qt.Key.Key_C and bool(self.selected))
        return bool(self.selected) and event.key() in _OF_KEYS

    def key(self, event: QKeyEvent) -> bool:
        """Handle keys: arrows move the selected keys (with Shift finely), Delete removes them, Enter edits their value,
        Ctrl+C and Ctrl+V copy and insert at the playhead, Ctrl+A selects all, Escape deselects.
        """
        if not self.claims(event):
            return False
        fine = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        clock, key = self.session.project.score.tempo_map, event.key()
        up = STEPS[CHANNELS[self.channel].unit][int(fine)]
        score = self.session.project.score
        step = 1 if fine else max(round(self.session.grid.step_ticks(score.metre_map)), 1)
        playhead = self.session.grid.snap(score.metre_map, clock.ticks(self.session.playhead_s))
        does: dict[int, Callable[[], None]] = {
            Qt.Key.Key_Delete: self.delete,
            Qt.Key.Key_Backspace: self.delete,
            Qt.Key.Key_Return: self.type_value,
            Qt.Key.Key_Enter: self.type_value,
            Qt.Key.Key_Escape: lambda: self.select_keys(frozenset()),
            Qt.Key.Key_Up: lambda: self.nudge(0, up),
            Qt.Key.Key_Down: lambda: self.nudge(0, -up),
            Qt.Key.Key_Left: lambda: self.nudge(-step, 0.0),
            Qt.Key.Key_Right: lambda: self.nudge(step, 0.0),
            Qt.Key.Key_A: self.select_all,
            Qt.Key.Key_C: self.copy,
            Qt.Key.Key_V: lambda: self.paste(playhead),
        }
        does[key]()
        return True


_OF_KEYS = frozenset(
    {
        Qt.Key.Key_Delete, Qt.Key.Key_Backspace, Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Escape,
        Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Left, Qt.Key.Key_Right,
    }
)  # fmt: skip
"""Keys of the keyboard that act on selected curve keys."""
