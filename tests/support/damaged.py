"""Insert damage typical of motion capture into a clip."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.rig import quaternion

KINDS: Final = ("flip", "bump", "lean", "zero", "all_zero", "root", "root_zero", "frozen")


def damaged(clip: MotionClip, kind: str, part: str, start: int, count: int, axis: FloatArray) -> MotionClip:
    """Return a clip with a number of damaged frames.

    Parameters
    ----------
    kind : str
        flip: a segment turned by half a turn; bump: there and back by 80 degrees, smoothly; lean: turned by 75; zero
        and all_zero: markers lost, the rest pose instead; root and root_zero: hips elsewhere, or nowhere; frozen: the
        last frame again.
    axis : (3,) float64
        Of turns and of the hips' way; unit.
    """
    rotations, hips_m = clip.rotations.copy(), clip.hips_m.copy()
    at, bad = SEGMENTS.index(part), slice(start, start + count)
    angles = {
        "flip": np.full(count, np.pi),
        "bump": np.radians(80.0) * np.sin(np.pi * np.arange(1, count + 1) / (count + 1)),
        "lean": np.full(count, np.radians(75.0)),
    }
    if kind in angles:
        rotations[bad, at] = quaternion.multiply(rotations[bad, at], quaternion.from_axis_angle(axis, angles[kind]))
    elif kind in ("zero", "all_zero"):
        rotations[bad, at if kind == "zero" else slice(None)] = quaternion.IDENTITY
    elif kind == "root":
        hips_m[bad] += 0.5 * axis
    elif kind == "root_zero":
        hips_m[bad] = 0.0
    else:
        rotations[bad], hips_m[bad] = rotations[start - 1], hips_m[start - 1]
    return replace(clip, hips_m=hips_m, rotations=quaternion.continuous(rotations))
