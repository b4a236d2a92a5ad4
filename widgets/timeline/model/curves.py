"""Curves of embouchure (lips) and of controllers for drawing, and drags that change them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.editor.edit_names import edit_of_notes
from app.errors import Message
from app.plan.model import EmbouchureEvent, PlayerPlan
from app.project.edit.dynamics import change_level
from app.project.edit.events import set_embouchure
from app.project.model import Project
from app.score.model import CurveKind, Part
from widgets.timeline.model.geometry import StepCurve, TimeSpans
from widgets.timeline.model.gestures import DRAG_PX, EditGesture, Editing, LiveEdit, across
from widgets.timeline.model.lane_mouse import LaneMouse

LIPS = ("tension", "effort", "air")
FINE = 0.2
"""Factor of the mouse's distance with Shift."""


@dataclass(frozen=True)
class EmbouchureCurves:
    """Embouchure values of a plan as arrays (N,) for N notes, and values recorded within the notes (``traces``)."""

    events: tuple[EmbouchureEvent, ...]
    spans: TimeSpans
    steps: Mapping[str, StepCurve]
    traces: Mapping[str, StepCurve]


def lips(plan: PlayerPlan) -> EmbouchureCurves:
    """Return the embouchures for drawing, with gaps between notes."""
    events = plan.embouchures
    start_s = np.array([event.start_s for event in events], np.float64)
    end_s = np.array([event.end_s for event in events], np.float64)
    values = {name: np.array([getattr(event, name) for event in events], np.float64) for name in LIPS}
    steps = {name: StepCurve(start_s, value) for name, value in values.items()}
    return EmbouchureCurves(events, TimeSpans(start_s, end_s), steps, _traces(plan, start_s, end_s))


def _traces(plan: PlayerPlan, start_s: FloatArray, end_s: FloatArray) -> dict[str, StepCurve]:
    """Return the recorded lip tension, effort and air of a plan as step curves by name, NaN between notes."""
    traces = plan.traces
    if traces is None:
        return {}
    time_s: FloatArray = traces.start_s + traces.step_s * np.arange(len(traces.tension), dtype=np.float64)
    note = np.searchsorted(start_s, time_s, side="right") - 1
    sounds = (note >= 0) & (time_s < end_s[np.maximum(note, 0)])
    recorded = {"tension": traces.tension, "effort": traces.effort, "air": traces.air}
    return {
        name: StepCurve(time_s, np.where(sounds, values, np.nan))
        for name, values in recorded.items()
        if values is not None
    }


def controller_steps(part: Part, project: Project) -> dict[str, StepCurve]:
    """Return the part's controllers over time by kind, as shares 0..1 of the displayed range."""
    clock = project.score.tempo_map
    result: dict[str, StepCurve] = {}
    for curve in part.curves:
        low, high = curve.shown_range
        values = (np.array(curve.values, np.float64) - low) / (high - low)
        result[curve.kind] = StepCurve(clock.seconds(np.array(curve.ticks, np.float64)), values)
    return result


def with_values(project: Project, player_id: str, curve: str, values: Mapping[str, float]) -> Project:
    """Return the project with new values of an embouchure curve; ``values`` are by note id."""
    for note_id, value in values.items():
        project = set_embouchure(project, player_id, (note_id,), **{curve: value})
    return project


class DragController(EditGesture):
    """Drag that raises or lowers a controller in spans of ticks, with blends before and after each span.

    Parameters
    ----------
    step : LiveEdit
        Undo step of the drag.
    blend_beats : float
        Length of the blends in felt beats.
    height_px : float
        Distance in pixels that changes the controller by 1.
    """

    def __init__(
        self,
        step: LiveEdit,
        at: LaneMouse,
        player_id: str,
        kind: CurveKind,
        spans: Sequence[tuple[int, int]],
        blend_beats: float,
        height_px: float,
    ) -> None:
        super().__init__(step, at, across(DRAG_PX))
        self._player_id, self._kind, self._spans, self._blend_beats = player_id, kind, spans, blend_beats
        self._height_px = max(height_px, 1.0)

    def follow(self, mouse: LaneMouse) -> None:
        by = (self.at.y_px - mouse.y_px) / self._height_px * (FINE if mouse.shift else 1.0)
        by = round(by, 3)
        self._step.edit(
            Message("edit.change_level"),
            lambda project: change_level(project, self._player_id, self._kind, self._spans, by, self._blend_beats),
        )


class DragCurve(EditGesture):
    """Drag that raises or lowers an embouchure curve at all selected notes.

    Parameters
    ----------
    starts : mapping of str to float
        Values before the drag, by note id.
    height_px : float
        Distance in pixels that changes the value by 1.
    """

    def __init__(
        self,
        session: Editing,
        origin: object,
        at: LaneMouse,
        player_id: str,
        curve: str,
        starts: Mapping[str, float],
        height_px: float,
    ) -> None:
        super().__init__(LiveEdit(session, origin), at, across(DRAG_PX))
        self._player_id, self._curve, self._starts = player_id, curve, starts
        self._height_px = max(height_px, 1.0)

    def follow(self, mouse: LaneMouse) -> None:
        change = (self.at.y_px - mouse.y_px) / self._height_px * (FINE if mouse.shift else 1.0)
        values = {note_id: round(min(max(start + change, 0.0), 1.0), 3) for note_id, start in self._starts.items()}
        others = {note_id: value for note_id, value in values.items() if value != round(self._starts[note_id], 3)}
        self._step.attempt(
            edit_of_notes(self._step.base, "edit.set_embouchure", self._starts, (self._player_id,)),
            lambda project: with_values(project, self._player_id, self._curve, others),
        )


class DrawCurve(EditGesture):
    """Freehand drawing of an embouchure curve: each note that the mouse passes gets the value at the mouse's height.

    Parameters
    ----------
    lips : EmbouchureCurves
        The notes and their present values.
    value_at : callable
        Returns the value at a height in pixels.
    """

    def __init__(
        self,
        session: Editing,
        origin: object,
        at: LaneMouse,
        player_id: str,
        curve: str,
        lips: EmbouchureCurves,
        value_at: Callable[[float], float],
    ) -> None:
        super().__init__(LiveEdit(session, origin), at)
        self._player_id, self._curve, self._lips, self._value_at = player_id, curve, lips, value_at
        self._last = at
        self._values: dict[str, float] = {}
        self.drag(at)

    def follow(self, mouse: LaneMouse) -> None:
        last, self._last = self._last, mouse
        spans, (low_s, high_s) = self._lips.spans, sorted((last.time_s, mouse.time_s))
        for index in spans.between(low_s, high_s).tolist():
            # A fast mouse skips notes, which get the values on the line between its positions.
            middle_s = min(max(float(spans.start_s[index] + spans.end_s[index]) / 2, low_s), high_s)
            share = (middle_s - last.time_s) / (mouse.time_s - last.time_s) if high_s > low_s else 1.0
            value = self._value_at(last.y_px + share * (mouse.y_px - last.y_px))
            self._values[self._lips.events[index].note_id] = round(min(max(value, 0.0), 1.0), 3)
        values = dict(self._values)
        if values:
            self._step.attempt(
                edit_of_notes(self._step.base, "edit.set_embouchure", values, (self._player_id,)),
                lambda project: with_values(project, self._player_id, self._curve, values),
            )
