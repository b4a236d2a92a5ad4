"""The lanes below the piano roll."""

from __future__ import annotations

from widgets.timeline.lane import Lane
from widgets.timeline.lanes.acting.acting_lane import ActingLane
from widgets.timeline.lanes.additive.additive_lane import AdditiveLane
from widgets.timeline.lanes.breath import BreathLane
from widgets.timeline.lanes.curves import CurvesLane
from widgets.timeline.lanes.dance.dance_lane import DanceLane
from widgets.timeline.lanes.fingering.fingering_lane import FingeringLane
from widgets.timeline.lanes.problems import ProblemsLane
from widgets.timeline.lanes.recording.waveform import WaveformLane
from widgets.timeline.lanes.takes.takes_lane import TakesLane

LANES: tuple[type[Lane], ...] = (
    WaveformLane,
    TakesLane,
    FingeringLane,
    BreathLane,
    ActingLane,
    CurvesLane,
    DanceLane,
    ProblemsLane,
    AdditiveLane,
)
"""In the order of a new window, from the top; the piano roll stands before them all but the first."""
