"""Shortest times in which captured motions may be danced, so that a spin is not danced faster than a body turns.

A motion may be danced up to 1.5 times as fast as captured, but a fast spin not at all faster. The search for segments
leaves a spin the time that it needs, and a time map takes it from shortly before and after.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import FloatArray, IntArray
from app.choreography.arrivals import FPS
from app.choreography.clip import MotionClip
from app.choreography.damage import FASTEST_HIPS_RAD_S
from app.choreography.model import ChoreographyModel
from app.choreography.spins import ROOM, hips_rad
from app.choreography.warp import TimeMap

CALM: Final = 0.93
"""Share of the limit up to which a spin is sped up, so that its peak need not be cut off."""
FASTEST: Final = 1.6
"""Greatest speed of a motion for a moment, relative to the capture."""
PEAK_S: Final = 0.03
"""Standard deviation in seconds that smooths the speed of a spin before its peak is taken."""
NEAR_S: Final = 0.15
"""Distance in seconds within which the speed of a dance hardly varies."""
HURRIED_S: Final = 0.12
"""Standard deviation in seconds of the span that gives a spin its additional time."""
ROUNDS: Final = 100


class SpinTimes:
    """Shortest times of a model's captures and segments.

    Parameters
    ----------
    hits_s : (S,) float64
        Time in its clip in seconds of the accent of each segment.

    Attributes
    ----------
    fastest_rad_s : float
        Greatest speed of the hips in the captures, at least `app.choreography.damage.FASTEST_HIPS_RAD_S`.
    before_s, after_s : (S,) float64
        Shortest time in seconds from start to accent and from accent to end of each segment.
    """

    def __init__(self, model: ChoreographyModel, hits_s: FloatArray) -> None:
        self._model, self._hits_s = model, hits_s
        fps = float(model.clips[0].fps)
        captured = [hips_rad(model.clips[one.clip].span(one.start, one.end + 1)) for one in model.segments]
        self.fastest_rad_s = max(FASTEST_HIPS_RAD_S, fps * max(float(one.max(initial=0.0)) for one in captured))
        self._paces = [least_paces(clip, self.fastest_rad_s) for clip in model.clips]
        until_s = [
            np.concatenate([[0.0], np.cumsum(paces)]) / float(clip.fps)
            for paces, clip in zip(self._paces, model.clips, strict=True)
        ]
        starts, at_hits, ends = np.array(
            [
                np.interp((one.start, hit_s * float(model.clips[one.clip].fps), one.end), np.arange(len(until)), until)
                for one, hit_s in zip(model.segments, hits_s.tolist(), strict=True)
                for until in (until_s[one.clip],)
            ]
        ).T
        self.before_s, self.after_s = at_hits - starts, ends - at_hits

    def calmed(self, times: TimeMap, segments: IntArray, hits: FloatArray, ends: FloatArray) -> TimeMap:
        """Return a time map that leaves every spin its time, see `not_hurried`.

        Parameters
        ----------
        segments : (N,) int64
            Segments in the order of dancing.
        hits : (N,) float64
            Position of the accent of each along the motions in seconds.
        ends : (N,) float64
            Position of the end of each along the motions in seconds.
        """
        along = np.arange(float(times.along_s[0]), float(times.along_s[-1]), 1.0 / FPS)
        if len(along) < 3:
            return times
        which = np.minimum(np.searchsorted(ends, along, side="right"), len(segments) - 1)
        clips = np.array([one.clip for one in self._model.segments])[segments][which]
        paces = np.zeros(len(along))
        for number, (clip, own) in enumerate(zip(self._model.clips, self._paces, strict=True)):
            here = clips == number
            at_s = (self._hits_s[segments] - hits)[which[here]] + along[here]
            paces[here] = np.interp(at_s * float(clip.fps), np.arange(len(own)), own)
        return not_hurried(times, along, paces[:-1] / FPS)


def least_paces(clip: MotionClip, fastest_rad_s: float = FASTEST_HIPS_RAD_S) -> FloatArray:
    """Return the shortest time (F - 1,), relative to the captured one, from each frame of a clip to the next: that of
    `FASTEST`, and longer in spins, so that the hips stay within a speed.
    """
    if len(clip) < 2:
        return np.full(1, 1.0 / FASTEST)
    fps = float(clip.fps)
    rad_s = gaussian_filter1d(hips_rad(clip) * fps, PEAK_S * fps, mode="nearest")
    rad_s = maximum_filter1d(rad_s, 2 * round(NEAR_S * fps) + 1, mode="nearest")
    rad_s = gaussian_filter1d(rad_s, NEAR_S / 2.0 * fps, mode="nearest")
    return np.asarray(np.maximum(1.0 / FASTEST, rad_s / (CALM * ROOM * fastest_rad_s)))


def not_hurried(times: TimeMap, along_s: FloatArray, least_s: FloatArray) -> TimeMap:
    """Slow a time map down where it is too fast for its motions, and speed it up shortly before and after.

    Parameters
    ----------
    times : TimeMap
        Returned unchanged where it is slow enough everywhere.
    along_s : (N,) float64
        Ascending, even positions along the motions in seconds.
    least_s : (N - 1,) float64
        Shortest time in seconds from each position to the next.
    """
    shown_s = times.when(along_s)
    lasts_s = np.diff(shown_s)
    if (lasts_s >= least_s - 1e-9).all():
        return times
    around = HURRIED_S / float(along_s[1] - along_s[0])
    for _ in range(ROUNDS):
        excess = np.maximum(least_s - lasts_s, 0.0)
        lasts_s = lasts_s + excess - gaussian_filter1d(excess, around, mode="reflect")
    calm_s = shown_s[0] + np.concatenate([[0.0], np.cumsum(np.maximum(lasts_s, 1e-4))])
    return TimeMap(calm_s, along_s)
