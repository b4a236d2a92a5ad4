"""The lanes below the piano roll."""

from __future__ import annotations

from widgets.timeline.lane import Lane
from widgets.timeline.lanes.acting import ActingLane
from widgets.timeline.lanes.additive import AdditiveLane
from widgets.timeline.lanes.breath import BreathLane
from widgets.timeline.lanes.curves import CurvesLane
from widgets.timeline.lanes.dance import DanceLane
from widgets.timeline.lanes.fingering import FingeringLane
from widgets.timeline.lanes.problems import ProblemsLane
from widgets.timeline.lanes.takes import TakesLane
from widgets.timeline.lanes.waveform import WaveformLane

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
