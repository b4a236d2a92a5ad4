"""Shortest times in which captured motions may be danced, so that none is danced faster than people move.

A motion may be danced up to 1.5 times as fast as captured, but a fast spin not at all faster, and the fastest moments
of limbs hardly. The search for segments leaves such a motion the time that it needs, and a time map takes it from
shortly before and after.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import FloatArray, IntArray
from app.choreography.arrivals import FPS
from app.choreography.body import SEGMENTS
from app.choreography.body_speeds import angle
from app.choreography.clip import MotionClip
from app.choreography.damage import FASTEST_HIPS_RAD_S
from app.choreography.dance import Manner
from app.choreography.model import ChoreographyModel
from app.choreography.spins import ROOM
from app.choreography.warp import TimeMap

CALM: Final = 0.93
"""Share of the limit up to which a spin is sped up, so that its peak need not be cut off."""
FASTEST: Final = 1.6
"""Greatest speed of a motion for a moment, relative to the capture."""
FASTER: Final = 1.12
"""Greatest speed of a segment in a motion that is sped up, relative to its fastest captured moment."""
MOST_FASTER: Final = 1.25
"""Greatest speed of a segment in a dance, in which joins and feet kept in place add to it, relative to the same."""
SLOW_RAD_S: Final = 8.0
"""Speed in rad/s up to which no segment is fast, however slow the captures are."""
PEAK_S: Final = 0.03
"""Standard deviation in seconds that smooths a speed before its peak is taken."""
NEAR_S: Final = 0.15
"""Distance in seconds within which the speed of a dance hardly varies."""
HURRIED_S: Final = 0.12
"""Standard deviation in seconds of the span that gives a fast motion its additional time."""
ROUNDS: Final = 100
_MIRRORED: Final = [
    SEGMENTS.index(name.replace("left", "right") if name.startswith("left") else name.replace("right", "left"))
    for name in SEGMENTS
]


class ShortestTimes:
    """Shortest times of a model's captures and segments.

    Parameters
    ----------
    hits_s : (S,) float64
        Time in its clip in seconds of the accent of each segment.

    Attributes
    ----------
    hips_rad_s : float
        Greatest speed of the hips in the captures, at least `app.choreography.damage.FASTEST_HIPS_RAD_S`.
    before_s, after_s : (S,) float64
        Shortest time in seconds from start to accent and from accent to end of each segment.
    """

    def __init__(self, model: ChoreographyModel, hits_s: FloatArray) -> None:
        self._model, self._hits_s = model, hits_s
        speeds = [turns_rad_s(clip) for clip in model.clips]
        self._fastest_rad_s = _greatest(model, speeds)
        self.hips_rad_s = max(FASTEST_HIPS_RAD_S, float(self._fastest_rad_s[0]))
        peaks = [peaks_rad_s(own, float(clip.fps)) for own, clip in zip(speeds, model.clips, strict=True)]
        most = FASTER * np.maximum(_greatest(model, peaks), SLOW_RAD_S)
        most[0] = CALM * ROOM * self.hips_rad_s
        self._paces = [least_paces(own, float(clip.fps), most) for own, clip in zip(peaks, model.clips, strict=True)]
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

    def fastest_rad_s(self, manner: Manner) -> FloatArray:
        """Return the greatest speed (16,) in rad/s with which each segment may turn in the world in a dance."""
        fastest = MOST_FASTER * np.maximum(self._fastest_rad_s, SLOW_RAD_S) * max(1.0, manner.size)
        return np.asarray(fastest[_MIRRORED] if manner.mirrored else fastest)

    def calmed(self, times: TimeMap, segments: IntArray, hits: FloatArray, ends: FloatArray) -> TimeMap:
        """Return a time map that leaves every fast motion its time, see `not_hurried`.

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


def turns_rad_s(clip: MotionClip) -> FloatArray:
    """Return the speeds (F - 1, 16) in rad/s with which segments turn in the world from frame to frame."""
    turns = clip.world().rotations[:, 1:]
    return angle(turns[:-1], turns[1:]) * float(clip.fps)


def _greatest(model: ChoreographyModel, speeds: Sequence[FloatArray]) -> FloatArray:
    """Greatest speed (16,) of each segment of the body within the segments of a model; ``speeds`` are (F - 1, 16) by
    clip."""
    own = [speeds[one.clip][one.start : one.end].max(axis=0, initial=0.0) for one in model.segments]
    return np.asarray(np.max(own, axis=0))


def peaks_rad_s(rad_s: FloatArray, fps: float) -> FloatArray:
    """Smooth speeds (N, 16) over time, so that single frames are no peaks."""
    return np.asarray(gaussian_filter1d(rad_s, PEAK_S * fps, axis=0, mode="nearest"))


def least_paces(rad_s: FloatArray, fps: float, most_rad_s: FloatArray) -> FloatArray:
    """Return the shortest time (F - 1,), relative to the captured one, from each frame of a clip to the next: that of
    `FASTEST`, and longer in fast motions.

    Parameters
    ----------
    rad_s : (F - 1, 16) float64
        Smoothed speeds of the segments in the world.
    most_rad_s : (16,) float64
        Speeds within which they stay.
    """
    if not len(rad_s):
        return np.full(1, 1.0 / FASTEST)
    paces = (rad_s / most_rad_s).max(axis=1)
    paces = maximum_filter1d(paces, 2 * round(NEAR_S * fps) + 1, mode="nearest")
    paces = gaussian_filter1d(paces, NEAR_S / 2.0 * fps, mode="nearest")
    return np.asarray(np.maximum(1.0 / FASTEST, paces))


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
        lasts_s = lasts_s + excess - _spread(excess, around)
    calm_s = shown_s[0] + np.concatenate([[0.0], np.cumsum(np.maximum(lasts_s, 1e-4))])
    return TimeMap(calm_s, along_s)


def _spread(excess_s: FloatArray, around: float) -> FloatArray:
    """Smooth values (N,) that are 0 almost everywhere by a standard deviation of ``around`` values, exactly as in one
    piece: beside each stretch of others are as many zeros as the filter reaches.
    """
    spread, reach = np.zeros_like(excess_s), round(4.0 * around)
    some = np.flatnonzero(maximum_filter1d(excess_s > 0.0, 2 * reach + 1))
    if len(some):
        spread[some] = gaussian_filter1d(excess_s[some], around, mode="reflect", radius=reach)
    return spread
