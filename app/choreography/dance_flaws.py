"""Visible flaws of a dance: jerks at joins, jolts elsewhere, and sliding feet.

Measured on the captured body, before the dance is transferred to a character.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Final

import numpy as np

from app.choreography.body_speeds import changes_rad, turns_rad
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.damage import Damage, damage
from app.choreography.foot_plants import FootPlant
from app.choreography.resample import resampled

JERKS: Final = 1.25
"""Ratio to the usual change of angular velocity above which a join shows."""
USUAL_PERCENTILE: Final = 99.9
AROUND: Final = (-1, 2)
"""First and last examined frame about a seam; a change is visible in the frames before and after."""
NEAR_S: Final = 0.1
"""Distance in seconds within which a jolt is attributed to a seam."""
TOLERANCE: Final = 2.0
"""Factor by which a dance may deviate more from even motion than captures, since it is sped up to 1.75 times for a
moment.
"""
SLIDES_M_S: Final = 0.005
"""Speed in metres per second of its tip above which a standing foot slides."""


def usual_change_rad_s(clips: Sequence[MotionClip], fps: Fraction) -> float:
    """Change of angular velocity in rad/s from frame to frame that is exceeded in only one of a thousand frames of the
    clips; 0 without motion.
    """
    changes = [changes_rad(turns_rad(resampled(clip, fps).rotations))[1:-1].ravel() for clip in clips]
    every = np.concatenate(changes) if changes else np.zeros(0)
    return float(np.percentile(every, USUAL_PERCENTILE)) * float(fps) if len(every) else 0.0


def jerking_seams(clip: MotionClip, seams: Sequence[int], usual_rad_s: float) -> tuple[int, ...]:
    """Return the seams (frames) of a dance with a visible jerk.

    Parameters
    ----------
    usual_rad_s : float
        See `usual_change_rad_s`.
    """
    if not seams or len(clip) < 3:
        return ()
    frames = np.array(seams) + np.arange(AROUND[0] - 1, AROUND[1] + 2)[:, None]
    changes = changes_rad(turns_rad(clip.rotations[np.clip(frames, 0, len(clip) - 1)]))
    worst = changes.max(axis=(0, 2)) * float(clip.fps)
    return tuple(seam for seam, change in zip(seams, worst.tolist(), strict=True) if change > JERKS * usual_rad_s)


def jolts(clip: MotionClip, seams: Sequence[int]) -> tuple[Damage, ...]:
    """Return the frames and body parts with impossible jumps in a dance, except at its ``seams`` (frames between
    segments)."""
    apart = round(NEAR_S * float(clip.fps))
    return tuple(
        one
        for one in damage(clip, TOLERANCE, captured=False)
        if all(seam < one.start - apart or one.stop + apart < seam for seam in seams)
    )


def sliding_stands(clip: MotionClip, standing: Sequence[FootPlant]) -> tuple[FootPlant, ...]:
    """Return those plants of feet in a dance during which the foot slides faster than `SLIDES_M_S`."""
    tips = tips_m(clip)[..., [0, 2]]
    speeds = np.linalg.norm(np.diff(tips, axis=0), axis=-1) * float(clip.fps)
    return tuple(
        stand for stand in standing if speeds[stand.start : stand.stop - 1, stand.foot].max(initial=0.0) > SLIDES_M_S
    )
