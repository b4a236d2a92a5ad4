"""Feet of a motion planted so that they touch the floor on accents of the music."""

from __future__ import annotations

from dataclasses import replace
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
        Foot plants from where the feet touch the floor, before they were moved to accents.
    falls : Footfalls
        Foot plants of the motion.
    leads : (N,) float64
        Number of frames by which each foot still touches the floor before its stand begins.
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
    for before in (False, True):
        if before:
            captured, leads = from_touches(captured, leads)
        falls = on_beats(captured, len(clip), fps, first_s, grid, step_s, speeds_m_s, leads=leads)
        shown = planted(clip, falls.standing, weight, falls.shown, body=body)
        leads = touch_leads(shown, falls.standing)
    return FeetOnBeats(shown, captured, falls, leads)


def from_touches(standing: tuple[FootPlant, ...], leads: FloatArray) -> tuple[tuple[FootPlant, ...], FloatArray]:
    """Let foot plants begin where the feet touch the floor, so that a foot that has landed does not creep on.

    Parameters
    ----------
    standing : tuple of FootPlant
        Foot plants ordered by start.
    leads : (N,) float64
        Number of frames by which each foot touches the floor before its stand begins.

    Returns
    -------
    standing : tuple of FootPlant
        The same plants, begun earlier by their leads, but by at most half the time for which the foot was in the air.
    leads : (N,) float64
        What is left of the leads.
    """
    left, begun, rest = [0, 0], [], []
    for stand, lead in zip(standing, leads.tolist(), strict=True):
        earlier = min(round(lead), max(stand.start - left[stand.foot], 0) // 2)
        begun.append(replace(stand, start=stand.start - earlier))
        rest.append(lead - earlier)
        left[stand.foot] = stand.stop
    order = sorted(range(len(begun)), key=lambda at: (begun[at].start, begun[at].foot))
    return tuple(begun[at] for at in order), np.array([rest[at] for at in order], np.float64)
