"""Bar lines and beats that can be pinned to the recording, and their drags."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.errors import Message
from app.project.edit.pins import pin_beat, recording_second
from app.project.model import Project
from app.project.recording import BeatPin, Doubt
from widgets.timeline.model.gestures import DRAG_PX, EditGesture, Editing, LiveEdit, along
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.lines import Lines
from widgets.timeline.model.visible_time import Scale

HANDLE_PX: Final = 11.0
"""Height in pixels of the strip at the lower edge with the handles."""
_SLACK_PX: Final = 6.0
_LEAST_BEAT_PX: Final = 24.0
"""Distance between beats in pixels from which they can be grabbed."""
_FINE: Final = 0.1
"""Factor of the mouse's distance with Shift for a beat."""
_DECIMALS: Final = 4


@dataclass(frozen=True)
class Anchor:
    """A bar line or beat that can be pinned to the recording.

    Attributes
    ----------
    pin : BeatPin or None
        The user's pin; None if its place is computed.
    """

    tick: int
    x_px: float
    is_bar: bool
    pin: BeatPin | None = None


def anchors(project: Project, axis: Scale, lines: Lines) -> list[Anchor]:
    """Return the bar lines and beats in the visible range, from left to right; empty without a recording."""
    audio, clock = project.audio, project.score.tempo_map
    if audio is None:
        return []
    pins = {pin.tick: pin for pin in audio.pins}
    bars = project.score.metre_map.tick_of_bar(np.array(lines.bars, np.int64)).tolist()
    both_s = np.sort(np.concatenate((lines.bar_s, lines.beat_s)))
    wide = len(both_s) > 1 and axis.px_per_s * float(np.diff(both_s).min()) >= _LEAST_BEAT_PX
    beat_s = lines.beat_s if wide else lines.beat_s[:0]
    beats = np.rint(clock.ticks(beat_s)).astype(np.int64).tolist()
    ticks = sorted({tick for tick in (*bars, *beats, *pins) if 0 <= tick <= project.score.end_tick} | set(pins))
    at_px = axis.x_px(clock.seconds(np.array(ticks, np.float64))).tolist() if ticks else []
    return [Anchor(tick, x, tick in set(bars), pins.get(tick)) for tick, x in zip(ticks, at_px, strict=True)]


def anchor_at(among: Sequence[Anchor], mouse: LaneMouse, height_px: float) -> Anchor | None:
    """Return the bar line or beat whose handle is under the mouse; of two equally near, the pinned one."""
    if mouse.y_px < height_px - HANDLE_PX:
        return None
    near = [anchor for anchor in among if abs(anchor.x_px - mouse.x_px) <= _SLACK_PX]
    return min(near, key=lambda one: (abs(one.x_px - mouse.x_px), one.pin is None), default=None)


def anchor_beside(project: Project, tick: int, step: int) -> int:
    """Return the tick of the next bar line or pin (step 1) or the previous one (-1) from ``tick``, within the piece."""
    metre_map, audio = project.score.metre_map, project.audio
    bar = metre_map.bar_of_tick(tick)
    pins = [pin.tick for pin in audio.pins] if audio is not None else []
    places = sorted({*(metre_map.tick_of_bar(bar + by) for by in (-1, 0, 1)), *pins})
    beyond = [place for place in places if (place - tick) * step > 0 and 0 <= place <= project.score.end_tick]
    return min(beyond, key=lambda place: abs(place - tick), default=tick)


def doubt_at(project: Project, tick: float) -> Doubt | None:
    """Return the doubt about the alignment of the bar at a tick; None if there is none."""
    doubts = project.audio.doubts if project.audio is not None else ()
    return next((doubt for doubt in doubts if doubt.start_tick <= tick < doubt.end_tick), None)


class DragAnchor(EditGesture):
    """Drag of a bar line or beat to its place in the recording, where it is pinned."""

    def __init__(self, session: Editing, origin: object, at: LaneMouse, project: Project, tick: int) -> None:
        super().__init__(LiveEdit(session, origin), at, along(DRAG_PX))
        self._tick, self._from_s = tick, recording_second(project, tick)

    def follow(self, mouse: LaneMouse) -> None:
        by_s = (mouse.time_s - self.at.time_s) * (_FINE if mouse.shift else 1.0)
        to_s = round(self._from_s + by_s, _DECIMALS)
        self._step.edit(Message("edit.pin_beat"), lambda project: pin_beat(project, self._tick, to_s))
