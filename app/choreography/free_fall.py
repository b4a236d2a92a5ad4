"""Free fall of a body: only then may it be off the floor."""

from __future__ import annotations

from itertools import pairwise
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
    result = np.zeros(len(high_m))
    falls_g = np.clip(down_m_s2 / G_M_S2, 0.0, 1.0)
    touches = prominent_peaks(-high_m, JUMPS_M)[0]
    for first, last in runs(high_m > 0.0):
        inside = touches[(touches > first) & (touches < last)].tolist()
        for start, stop in pairwise([first, *inside, last]):
            # The higher a body is, the more certainly it is off the floor.
            mean = np.average(falls_g[start:stop], weights=np.square(high_m[start:stop]))
            hovers = 1.0 - smooth_share(np.asarray(mean), FALLS_G)
            result[start:stop] = hovers * (1.0 - smooth_share(high_m[start:stop].max(), HOVERS_M))
        if inside:
            result[first:last] = gaussian_filter1d(result[first:last], TURNS_S * fps, mode="nearest")
    return result
