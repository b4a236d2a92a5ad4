"""The lanes below the piano roll."""

from __future__ import annotations

from widgets.timeline.lane import Lane
from widgets.timeline.lanes.acting import ActingLane
from widgets.timeline.lanes.breath import BreathLane

LANES: tuple[type[Lane], ...] = (BreathLane, ActingLane)
"""In the order of a new window, from the top; the piano roll stands before them all but the first."""
