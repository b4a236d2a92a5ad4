"""Choice of the end of a dance: soon after the last accent of the music, with a motion that ends as it faces."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray
from app.choreography.accent_grid import AccentGrid, grid_of
from app.choreography.clip import MotionClip
from app.choreography.coming_to_rest import GOES_ON_S
from app.choreography.model import MotionSegment
from app.choreography.rhythm import Rhythm
from app.rig import quaternion

AWAY: Final = 6.0
"""Log odds against a last motion that ends a radian away from the direction in which it is danced; quadratic."""
TURNS: Final = 3.0
"""Log odds against a motion shortly before the end that turns by a radian; quadratic."""
BEYOND: Final = 2
"""Number of places after a motion that the user placed, so that the dance does not end just before it."""
_UP: Final = np.array([0.0, 1.0, 0.0])


def danced_grid(rhythm: Rhythm, held: Collection[int]) -> AccentGrid:
    """Return the grid of a rhythm up to its last accent, or `BEYOND` places after the last one ``held`` by the user."""
    grid = grid_of(rhythm)
    if not len(grid.times_s):
        return grid
    held_s = float(grid.times_s[min(max(held) + BEYOND, len(grid.times_s) - 1)]) if held else 0.0
    return grid.until(max(rhythm.closes_s, held_s))


class EndOdds(NamedTuple):
    """Log odds (S,) of each of S segments as the last one of a dance, and shortly before its end.

    A dancer who turns away in them would have to be turned back to end facing the audience.
    """

    last: FloatArray
    closing: FloatArray


def odds_of_ends(
    clips: Sequence[MotionClip], segments: Sequence[MotionSegment], hits_s: Sequence[float] | FloatArray
) -> EndOdds:
    """Return the log odds of ending a dance with segments.

    Parameters
    ----------
    hits_s : (S,) float64
        Time in seconds, within its clip, of the accent of each segment, soon after which the dance ends.
    """
    faces = [np.exp(1j * quaternion.twist_angle(clip.rotations[:, 0], _UP)) for clip in clips]
    away_rad, turns_rad = np.zeros((2, len(segments)))
    for at, (one, hit_s) in enumerate(zip(segments, hits_s, strict=True)):
        own = faces[one.clip][one.start : one.end]
        stop = min(len(own), round((hit_s + GOES_ON_S) * float(clips[one.clip].fps)) - one.start)
        away_rad[at] = np.angle(own[stop - 1] / own[:stop].mean())
        turns_rad[at] = np.angle(own[-1] / own[0])
    return EndOdds(-AWAY * np.square(away_rad), -TURNS * np.square(turns_rad))
