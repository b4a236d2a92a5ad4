"""The lanes below the piano roll."""

from __future__ import annotations

from app.optional_features import extended
from widgets.timeline.lane import Lane
from widgets.timeline.lanes.acting.acting_lane import ActingLane
from widgets.timeline.lanes.additive.additive_lane import AdditiveLane
from widgets.timeline.lanes.breath import BreathLane
from widgets.timeline.lanes.curves import CurvesLane
from widgets.timeline.lanes.fingering.fingering_lane import FingeringLane
from widgets.timeline.lanes.problems import ProblemsLane
from widgets.timeline.lanes.recording.waveform import WaveformLane
from widgets.timeline.lanes.takes.takes_lane import TakesLane
from widgets.timeline.marks.dynamics_lane import DynamicsLane

_OWN: tuple[type[Lane], ...] = (
    WaveformLane,
    DynamicsLane,
    TakesLane,
    FingeringLane,
    BreathLane,
    ActingLane,
    CurvesLane,
    ProblemsLane,
    AdditiveLane,
)
LANES: tuple[type[Lane], ...] = tuple(extended(_OWN, "lanes", lambda kind: kind.id))
"""Lane classes in the order of a new window from the top; the piano roll comes after the first."""
