"""Free fall of a body: only then may it be off the floor."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.body_speeds import runs
from app.choreography.limbs import smooth_share
from app.choreography.peaks import prominent_peaks
from app.rig.skeleton import JointTransforms

G_M_S2: Final = 9.81
"""Acceleration of free fall in metres per second squared."""
FALLS_G: Final = (0.45, 0.6)
"""Mean downward acceleration of a body off the floor, as a share of `G_M_S2`, below which it is not in free fall, and
above which it is: captures and joins of motions blur it."""
HOVERS_M: Final = (0.10, 0.15)
"""Heights in metres up to which a body can hover by joins and captures, and from which it jumps, however slowly a dance
shows it."""
JUMPS_M: Final = 0.03
"""Least height in metres of a jump over the touches before and after it in which a body is still a little higher than
the floor."""
TURNS_S: Final = 0.04
"""Standard deviation in seconds over which a jump turns into hovering at such a touch."""
SMOOTH_S: Final = 0.03
"""Standard deviation in seconds of the Gaussian that smooths the height of the centre of mass."""
_MASSES: Final = {
    "hips": 0.142, "spine": 0.139, "chest": 0.216, "head": 0.081, "UpperArm": 0.028, "LowerArm": 0.016, "Hand": 0.006,
    "UpperLeg": 0.1, "LowerLeg": 0.0465, "Foot": 0.0145,
}  # fmt: skip
"""Shares of the body's mass by end of the segment's name (D. Winter, "Biomechanics and Motor Control of Human
Movement", 4th ed. 2009, table 4.1)."""
_SHARES: FloatArray = np.array([next(mass for end, mass in _MASSES.items() if name.endswith(end)) for name in SEGMENTS])


def falls_m_s2(world: JointTransforms, fps: float) -> FloatArray:
    """Return the downward acceleration (F,) of a body's centre of mass; ``world`` is as of
    `app.choreography.clip.MotionClip.world`."""
    if len(world.positions_m) < 2:
        return np.zeros(len(world.positions_m))
    height_m = gaussian_filter1d(world.positions_m[:, 1:, 1] @ _SHARES, SMOOTH_S * fps, mode="nearest")
    return np.asarray(-np.gradient(np.gradient(height_m)) * fps**2)


def supported(high_m: FloatArray, down_m_s2: FloatArray, fps: float) -> FloatArray:
    """Return the share (F,) of a body's height over the floor that no free fall explains, about equal from one touch of
    the floor to the next: 1 for a hovering body, 0 for a jump.

    Parameters
    ----------
    high_m : (F,) float64
        Height in metres of the lowest point of the body over the floor; 0 on the floor.
    down_m_s2 : (F,) float64
        See `falls_m_s2`.
    """
    result, above = np.zeros(len(high_m)), high_m > 0.0
    frames, weights = np.flatnonzero(above), np.square(high_m[above])
    if not len(frames):
        return result
    firsts = frames[np.diff(frames, prepend=-2) > 1]
    touches = prominent_peaks(-high_m, JUMPS_M)[0]
    inside = touches[above[touches] & above[touches - 1]]
    # The body goes from touch to touch, the first frames in the air included.
    ways = np.searchsorted(frames, np.sort(np.concatenate([firsts, inside])))
    # The higher a body is, the more certainly it is off the floor.
    falls_g = np.clip(down_m_s2[above] / G_M_S2, 0.0, 1.0)
    mean_g = np.add.reduceat(falls_g * weights, ways) / np.add.reduceat(weights, ways)
    hovers = 1.0 - smooth_share(mean_g, FALLS_G)
    hovers *= 1.0 - smooth_share(np.maximum.reduceat(high_m[above], ways), HOVERS_M)
    result[frames] = np.repeat(hovers, np.diff(ways, append=len(frames)))
    for first, last in runs(above):
        if ((inside > first) & (inside < last)).any():
            result[first:last] = gaussian_filter1d(result[first:last], TURNS_S * fps, mode="nearest")
    return result
