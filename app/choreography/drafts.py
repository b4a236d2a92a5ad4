"""Drafts of a dance, in which its arrivals and footfalls are found."""

from __future__ import annotations

from fractions import Fraction
from typing import Final, NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.choreography.accent_grid import AccentGrid
from app.choreography.arrivals import joint_speed_m_s
from app.choreography.clip import MotionClip
from app.choreography.feet_on_beats import feet_on_beats

DRAFT_FPS: Final = Fraction(60)
"""Frame rate of the drafts in which arrivals and footfalls are found; at half of it contacts differ from the dance."""
DRAFTS: Final = 5
"""Greatest number of drafts, each with the best time map of the previous one."""


class Draft(NamedTuple):
    """Mean speed (F,) in m/s of the joints in a draft, and the times (K,) in seconds of its footfalls before and after
    they were moved to beats.
    """

    speed_m_s: FloatArray
    falls_s: FloatArray
    down_s: FloatArray


def draft_of(
    clip: MotionClip, contacts: BoolArray, moved_m: FloatArray, times_s: FloatArray, grid: AccentGrid, step_s: float
) -> Draft:
    """Plant the feet of a motion on beats (see `app.choreography.feet_on_beats.feet_on_beats`), and find how it moves.

    Parameters
    ----------
    times_s : (F,) float64
        Times of the motion's frames in seconds.
    """
    first_s = float(times_s[0])
    feet = feet_on_beats(clip, contacts, moved_m, first_s, grid, step_s)
    frames = sorted(stand.start for stand in feet.captured if stand.start)
    pairs = zip(feet.falls.standing, feet.leads, strict=True)
    down = np.sort(np.array([stand.start - lead for stand, lead in pairs if stand.start]))
    return Draft(joint_speed_m_s(feet.clip), times_s[frames], first_s + down / float(clip.fps))
