"""The lanes below the piano roll."""

from __future__ import annotations

from widgets.timeline.lane import Lane

LANES: tuple[type[Lane], ...] = ()
"""In the order of a new window, from the top; the piano roll stands before them all but the first."""
