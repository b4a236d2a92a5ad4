"""The lanes below the piano roll."""

from __future__ import annotations

from widgets.timeline.lane import Lane
from widgets.timeline.lanes.acting import ActingLane
from widgets.timeline.lanes.breath import BreathLane
from widgets.timeline.lanes.curves import CurvesLane
from widgets.timeline.lanes.fingering import FingeringLane

LANES: tuple[type[Lane], ...] = (FingeringLane, BreathLane, ActingLane, CurvesLane)
"""In the order of a new window, from the top; the piano roll stands before them all but the first."""
