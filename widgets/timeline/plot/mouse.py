"""Conversion of Qt's mouse events to the `LaneMouse` of the timeline's models."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, Qt

from app.editor.session import Session
from widgets.timeline.model.gestures import snapped
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.zoom_and_scroll import TimeAxis


def mouse_at(
    session: Session, axis: TimeAxis, place: QPointF, value: float, modifiers: Qt.KeyboardModifier, screen: QPoint
) -> LaneMouse:
    """Return a position of the mouse in a plot with its time, tick and value; ``value`` is on the plot's vertical
    scale."""
    score = session.project.score
    time_s = axis.seconds(place.x())
    tick = score.tempo_map.ticks(time_s)
    alt = bool(modifiers & Qt.KeyboardModifier.AltModifier)
    return LaneMouse(
        x_px=place.x(),
        y_px=place.y(),
        time_s=time_s,
        value=value,
        tick=tick,
        snapped_tick=snapped(session.grid, score, tick, alt),
        shift=bool(modifiers & Qt.KeyboardModifier.ShiftModifier),
        ctrl=bool(modifiers & Qt.KeyboardModifier.ControlModifier),
        alt=alt,
        screen_px=(screen.x(), screen.y()),
    )
