"""Drags of keys, handles and blends of additive curves."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from app.editor.edit_names import edit_at
from app.errors import Message
from app.plan.by_hand.additive_curve import Tangent
from app.project.edit import additive as edit
from app.project.edit.additive import Side
from app.project.model import Project
from app.score.tempo import TempoMap
from widgets.timeline.model.additive.additive_curves import KeyRef, ShownCurve, by_curve, rounded
from widgets.timeline.model.gestures import DRAG_PX, EditGesture, Editing, LiveEdit, either, snapped
from widgets.timeline.model.lane_mouse import LaneMouse

FINE: Final = 0.2
"""Factor of the mouse's distance with Shift, which also disables the grid."""
ALIGNED: Final = 1e-3
"""Greatest difference of slopes at which both handles of a key turn together."""


class DragKeys(EditGesture):
    """Drag of selected keys: snapped to the grid in time, with Alt freely, with Ctrl in one direction only.

    Parameters
    ----------
    grabbed : KeyRef
        Key under the mouse, which is snapped to the grid.
    keys : frozenset of KeyRef
        All moving keys.
    moved : callable
        Called with the new names of the keys after each move.
    """

    def __init__(
        self,
        session: Editing,
        at: LaneMouse,
        player_id: str,
        channel: str,
        grabbed: KeyRef,
        keys: frozenset[KeyRef],
        moved: Callable[[frozenset[KeyRef]], None],
    ) -> None:
        super().__init__(LiveEdit(session, None), at, either(DRAG_PX))
        self._session = session
        self._player_id, self._channel, self._grabbed, self._keys = player_id, channel, grabbed, keys
        self._moved = moved

    def follow(self, mouse: LaneMouse) -> None:
        share = FINE if mouse.shift else 1.0
        ticks, value = share * (mouse.tick - self.at.tick), share * (mouse.value - self.at.value)
        if mouse.ctrl:
            upright = abs(mouse.y_px - self.at.y_px) > abs(mouse.x_px - self.at.x_px)
            ticks, value = (0.0, value) if upright else (ticks, 0.0)
        score = self._session.project.score
        by = 0
        if round(ticks):
            free = mouse.shift or mouse.alt
            by = snapped(self._session.grid, score, self._grabbed.tick + ticks, free) - self._grabbed.tick
        up = rounded(self._channel, value)
        moved, ticks_before = by_curve(self._keys), [key.tick for key in self._keys]
        done = self._step.edit(
            edit_at(self._step.base, "edit.move_curve_keys", len(self._keys), (self._player_id,), ticks_before),
            lambda project: edit.move_keys(project, self._player_id, moved, by, up),
        )
        if done:
            self._moved(frozenset(KeyRef(key.name, key.tick + by) for key in self._keys))

    def cancel(self) -> None:
        super().cancel()
        if self.began:
            self._moved(self._keys)


class DragHandle(EditGesture):
    """Drag of a handle; the other one turns with it if both are aligned, unless Ctrl is held.

    Parameters
    ----------
    shown : ShownCurve
        Curve at the press.
    at_key : int
        Number of the key.
    """

    def __init__(
        self,
        session: Editing,
        origin: object,
        at: LaneMouse,
        player_id: str,
        shown: ShownCurve,
        at_key: int,
        side: Side,
    ) -> None:
        super().__init__(LiveEdit(session, origin), at, either(1.0))
        self._player_id, self._name, self._side = player_id, shown.curve.name, side
        self._key = shown.curve.keys[at_key]
        clock = session.project.score.tempo_map
        self._others = _tangents(shown, at_key, clock)
        self._aligned = in_line(self._others)

    def follow(self, mouse: LaneMouse) -> None:
        sign = 1 if self._side == "leave" else -1
        ticks = max(round(sign * (mouse.tick - self._key.tick)), 1)
        tangent = Tangent(ticks, mouse.value - self._key.value)
        other_side: Side = "arrive" if self._side == "leave" else "leave"
        other = self._others.get(other_side)
        turned = None
        if other is not None and self._aligned and not mouse.ctrl:
            turned = Tangent(other.ticks, -tangent.value / ticks * other.ticks)
        self._step.edit(
            Message("edit.set_curve_tangents"),
            lambda project: edit.set_tangent(
                project, self._player_id, self._name, self._key.tick, self._side, tangent, turned
            ),
        )


def _tangents(shown: ShownCurve, at_key: int, clock: TempoMap) -> dict[Side, Tangent]:
    """Return the handles of the key with index ``at_key`` by side, as offsets from the key; automatic handles are
    computed.
    """
    key = shown.curve.keys[at_key]
    return {
        side: Tangent(max(abs(round(clock.ticks(time_s)) - key.tick), 1), value - key.value)
        for side, time_s, value in shown.handles(at_key)
    }


def in_line(tangents: dict[Side, Tangent]) -> bool:
    """Return whether the two handles of a key lie on one line through it."""
    if len(tangents) < 2:
        return False
    one, other = (handle.value / handle.ticks for handle in (tangents["leave"], tangents["arrive"]))
    return abs(one + other) <= ALIGNED * max(abs(one), abs(other)) + 1e-9


class DragBlend(EditGesture):
    """Drag of the end of a fade of a curve, snapped to the grid unless Alt is held."""

    def __init__(
        self, session: Editing, origin: object, at: LaneMouse, player_id: str, name: str, key_tick: int, at_start: bool
    ) -> None:
        super().__init__(LiveEdit(session, origin), at, either(DRAG_PX))
        self._session = session
        self._player_id, self._name, self._key_tick, self._at_start = player_id, name, key_tick, at_start

    def follow(self, mouse: LaneMouse) -> None:
        tick = snapped(self._session.grid, self._session.project.score, mouse.tick, mouse.alt or mouse.shift)
        ticks = max(self._key_tick - tick if self._at_start else tick - self._key_tick, 0)
        field = "blend_in_ticks" if self._at_start else "blend_out_ticks"

        def changed(project: Project) -> Project:
            return edit.change_curves(project, self._player_id, (self._name,), **{field: ticks})

        self._step.edit(Message("edit.set_curve_blend"), changed)
