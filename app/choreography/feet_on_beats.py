"""Feet of a motion planted so that they touch the floor on accents of the music."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.choreography.accent_grid import AccentGrid
from app.choreography.clip import MotionClip
from app.choreography.foot_plants import FootPlant, foot_speeds_m_s, stands
from app.choreography.footfalls import Footfalls, on_beats, touch_leads
from app.choreography.standing_feet import MovingBody, planted


class FeetOnBeats(NamedTuple):
    """A motion with planted feet.

    Attributes
    ----------
    captured : tuple of FootPlant
        Foot plants before they were moved to accents.
    falls : Footfalls
        Foot plants of the motion.
    leads : (N,) float64
        Number of frames by which each foot touches the floor before its stand begins.
    """

    clip: MotionClip
    captured: tuple[FootPlant, ...]
    falls: Footfalls
    leads: FloatArray


def feet_on_beats(
    clip: MotionClip,
    contacts: BoolArray,
    moved_m: FloatArray,
    first_s: float,
    grid: AccentGrid,
    step_s: float,
    weight: float = 0.0,
) -> FeetOnBeats:
    """Plant the feet of a motion on accents of the music (see `app.choreography.footfalls.on_beats`).

    Parameters
    ----------
    contacts, moved_m
        See `app.choreography.foot_plants.stands`.
    first_s : float
        Time of the motion's first frame in seconds.
    step_s : float
        Usual time of a step in seconds.
    weight : float
        See `app.choreography.standing_feet.planted`.
    """
    fps, body = float(clip.fps), MovingBody.of(clip)
    captured = stands(clip, contacts, moved_m, body.tips)
    speeds_m_s = foot_speeds_m_s(body.tips, fps) if len(clip) > 1 else None
    leads = np.zeros(len(captured))
    for _ in range(2):
        falls = on_beats(captured, len(clip), fps, first_s, grid, step_s, speeds_m_s, leads=leads)
        shown = planted(clip, falls.standing, weight, falls.shown, body=body)
        leads = touch_leads(shown, falls.standing)
    return FeetOnBeats(shown, captured, falls, leads)
