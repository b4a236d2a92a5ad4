"""Mouse gesture that drags a step of a dance to another accent of the music."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.score.tempo import TempoMap
from widgets.timeline.model.gestures import DRAG_PX, MouseGesture, along
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.visible_time import Scale

if TYPE_CHECKING:
    # Modules of dances are loaded only for pieces with dancers.
    from app.choreography.performed.dance_steps import DanceSteps


class MoveStep(MouseGesture):
    """Drag of a step's accent to the nearest possible place.

    Attributes
    ----------
    dancer_id : str
        Id of the dancer.
    number : int
        Index of the step in the dance.
    tick : int or None
        Tick of the accent if released now; None before the mouse has moved far enough.
    """

    def __init__(self, at: LaneMouse, dance: DanceSteps, number: int, scale: Scale, clock: TempoMap) -> None:
        super().__init__(at, along(DRAG_PX))
        self.dancer_id, self.number = dance.dancer.id, number
        self.tick: int | None = None
        self._dance, self._scale, self._clock = dance, scale, clock

    def follow(self, mouse: LaneMouse) -> None:
        accent_px = self._scale.x_px(self._dance.steps[self.number].accent_s) + mouse.x_px - self.at.x_px
        tick = self._clock.ticks(self._scale.seconds(accent_px))
        self.tick = min(self._dance.places, key=lambda place: abs(place - tick))


def state_beside(dance: DanceSteps, state: int, by: int) -> int:
    """Return the basic motion that follows ``state`` by ``by`` (1 or -1) in the cyclic order of all basic motions that
    have segments.
    """
    used = sorted({one.state for one in dance.model.segments})
    return used[(used.index(state) + by) % len(used)]
