"""Footfalls on the beats: a foot leaves the floor and lands slightly earlier or later than in the capture.

Steps have the duration of the captured dancers' steps.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np
from scipy.interpolate import PchipInterpolator

from app.arrays import FloatArray
from app.choreography.accent_grid import AccentGrid
from app.choreography.standing_feet import SAME_M, FootPlant

REACH_S: Final = 0.12
"""Greatest shift of a footfall in seconds."""
ON_BEAT: Final = 1.0
BETWEEN: Final = -1.0
"""Worth of a footfall on a beat, and on a place between beats."""
MOVED: Final = 0.5
"""Cost of a footfall shifted by `REACH_S`; quadratic for less."""
APART_S: Final = 0.15
"""Least distance in seconds between consecutive footfalls, unless the capture has less."""
LEAST_STAND_S: Final = 0.15
LEAST_SWING_S: Final = 0.25
"""Least duration in seconds of a stand and of a step, unless the capture has less."""
STEP_SHARE: Final = 0.95
"""Least duration of a step relative to the usual one, if there is time."""
FASTEST_M_S: Final = 5.0
"""Speed in metres per second above which a foot kicks and lands as captured, since its place would be far from the body
a moment later.
"""
NEVER: Final = -1e9


@dataclass(frozen=True, eq=False)
class Footfalls:
    """Foot plants moved to beats, and for each foot the frame of the motion to show between them.

    Attributes
    ----------
    shown : (F, 2) float64
        For each frame, the frames of the motion used for the left and right foot; ascending.
    """

    standing: tuple[FootPlant, ...]
    shown: FloatArray


def on_beats(
    standing: Sequence[FootPlant],
    frames: int,
    fps: float,
    first_s: float,
    grid: AccentGrid,
    step_s: float,
    speeds_m_s: FloatArray | None = None,
) -> Footfalls:
    """Move foot plants so that they begin on nearby accents of the grid.

    Parameters
    ----------
    standing : sequence of FootPlant
        Foot plants ordered by start, from `app.choreography.standing_feet.stands`.
    frames : int
        Number of frames of the motion.
    first_s : float
        Time of frame 0 in seconds.
    step_s : float
        Usual time of a step.
    speeds_m_s : (F, 2) float64, optional
        Speeds of the left and the right foot.
    """
    kicked = set() if speeds_m_s is None else _kicked(standing, speeds_m_s)
    falls = [at for at, stand in enumerate(standing) if stand.start > 0]
    starts = {at: float(stand.start) for at, stand in enumerate(standing)}
    by_foot = [[at for at, stand in enumerate(standing) if stand.foot == foot] for foot in range(2)]
    # The first frame is no fall, and a stand that ends when it did does not begin at its end.
    after = {at: following for own in by_foot for at, following in pairwise(own)}
    kept = {at for own in by_foot for at in own if at not in after or after[at] in kicked}
    latest = [
        0.0 if at in kicked else standing[at].stop - LEAST_STAND_S * fps if at in kept else frames - 1.0 for at in falls
    ]
    bounds_s = [(first_s + 1.0 / fps, first_s + last / fps) for last in latest]
    starts.update(zip(falls, _chosen([standing[at] for at in falls], fps, first_s, grid, bounds_s), strict=True))
    moved = [replace(stand, start=round(starts[at])) for at, stand in enumerate(standing)]
    shown = np.tile(np.arange(frames, dtype=np.float64)[:, None], (1, 2))
    for foot, own in enumerate(by_foot):
        others = [(stand, new) for stand, new in zip(standing, moved, strict=True) if stand.foot != foot]
        for at, following in pairwise(own):
            if at in kept:
                continue
            starts_at = moved[at].start, moved[following].start
            stop = _leaves(standing[at], standing[following], *starts_at, others, fps, step_s)
            moved[at] = replace(moved[at], stop=stop)
        knots = [(0, 0)]
        for at in own:
            knots += [(moved[at].start, standing[at].start), (moved[at].stop - 1, standing[at].stop - 1)]
        knots.append((frames - 1, frames - 1))
        places = np.array(knots, np.float64)
        ascends = np.concatenate([[True], (np.diff(places, axis=0) > 0).all(axis=1)])
        if ascends.sum() > 1:
            shown[:, foot] = PchipInterpolator(places[ascends, 0], places[ascends, 1])(shown[:, foot])
    moved.sort(key=lambda stand: (stand.start, stand.foot))
    return Footfalls(tuple(moved), np.clip(shown, 0.0, frames - 1.0))


def _kicked(standing: Sequence[FootPlant], speeds_m_s: FloatArray) -> set[int]:
    """Indices of the foot plants that follow a kick."""
    found, left = set(), [0, 0]
    for at, stand in enumerate(standing):
        if speeds_m_s[left[stand.foot] : stand.start, stand.foot].max(initial=0.0) > FASTEST_M_S:
            found.add(at)
        left[stand.foot] = stand.stop
    return found


def _leaves(
    before: FootPlant,
    after: FootPlant,
    came: int,
    comes: int,
    others: Sequence[tuple[FootPlant, FootPlant]],
    fps: float,
    step_s: float,
) -> int:
    """Choose the frame in which a foot leaves the floor between two of its landings, which were moved to the frames
    ``came`` and ``comes``.

    It does not leave before the other foot has landed, if the motion has them in this order.
    """
    swing = after.start - before.stop
    way_m = float(np.linalg.norm(np.subtract(after.place_m, before.place_m)))
    takes = max(swing, math.ceil(STEP_SHARE * step_s * fps)) if way_m > SAME_M else swing
    first = came + min(before.stop - before.start, round(LEAST_STAND_S * fps))
    last = comes - min(swing, round(LEAST_SWING_S * fps))
    for other, new in others:
        if other.start <= before.stop < other.stop:
            first = max(first, new.start)
    return max(came + 1, min(max(comes - takes, first), last))


def _chosen(
    falls: Sequence[FootPlant], fps: float, first_s: float, grid: AccentGrid, bounds_s: Sequence[tuple[float, float]]
) -> list[float]:
    """Choose the frames of all landings with the greatest total value, by dynamic programming over consecutive pairs.

    ``bounds_s`` has the first and last possible time of each landing.
    """
    times = [first_s + fall.start / fps for fall in falls]
    alone = [_options(time_s, grid, *bounds) for time_s, bounds in zip(times, bounds_s, strict=True)]
    options = [[*own, *_along(at, falls, times, alone, bounds_s)] for at, own in enumerate(alone)]
    # By the options of the last fall but one and of the last: the worth so far.
    value = np.zeros((1, 1))
    back: list[np.ndarray] = []
    for at, own in enumerate(options):
        new = np.array([place for place, _ in own])
        worth = np.array([worth for _, worth in own])
        earlier = np.array([place for place, _ in options[at - 1]]) if at else np.array([-np.inf])
        before = np.array([place for place, _ in options[at - 2]]) if at > 1 else np.array([-np.inf])
        fits = np.zeros((len(before), len(earlier), len(new)))
        if at:
            fits[:, ~_possible(falls, times, at - 1, at, earlier, new)] = NEVER
        if at > 1 and falls[at - 2].foot == falls[at].foot:
            possible = _possible(falls, times, at - 2, at, before, new)
            fits += np.where(possible, 0.0, NEVER)[:, None, :]
        total = value[:, :, None] + fits
        back.append(total.argmax(axis=0))
        value = total.max(axis=0) + worth
    if not options:
        return []
    last_but_one, last = np.unravel_index(int(value.argmax()), value.shape)
    way = [int(last)]
    pair = int(last_but_one), int(last)
    for at in range(len(options) - 1, 0, -1):
        way.append(pair[0])
        pair = int(back[at][pair]), pair[0]
    return [(options[at][number][0] - first_s) * fps for at, number in enumerate(reversed(way))]


def _options(time_s: float, grid: AccentGrid, earliest_s: float, latest_s: float) -> list[tuple[float, float]]:
    """Possible times of a landing, with the value of each: its own time first, then the accents of the grid within
    reach, of which beats have most value.
    """
    found = [(time_s, 0.0)]
    reach_s = max(time_s - REACH_S, earliest_s), min(time_s + REACH_S, latest_s)
    for at in range(*np.searchsorted(grid.times_s, reach_s).tolist()):
        place_s = float(grid.times_s[at])
        worth = ON_BEAT if grid.on_beat[at] else BETWEEN
        found.append((place_s, worth - MOVED * ((place_s - time_s) / REACH_S) ** 2))
    return found


def _along(
    at: int,
    falls: Sequence[FootPlant],
    times: Sequence[float],
    options: Sequence[Sequence[tuple[float, float]]],
    bounds_s: Sequence[tuple[float, float]],
) -> list[tuple[float, float]]:
    """Possible times of the landing ``at``, with their values, that keep its distance in time from a landing of the
    other foot just before or after.
    """
    found = []
    for other in (at - 1, at + 1):
        if not 0 <= other < len(falls) or falls[other].foot == falls[at].foot:
            continue
        way_s = times[at] - times[other]
        if abs(way_s) < APART_S:
            places_s = [place_s + way_s for place_s, _ in options[other][1:]]
            within = [place_s for place_s in places_s if bounds_s[at][0] <= place_s <= bounds_s[at][1]]
            found += [(place_s, -MOVED * ((place_s - times[at]) / REACH_S) ** 2) for place_s in within]
    return found


def _possible(
    falls: Sequence[FootPlant], times: Sequence[float], one: int, other: int, earlier: FloatArray, later: FloatArray
) -> np.ndarray:
    """Return a mask (E, L): True where the landing ``one`` can be at the time ``earlier[e]`` while the landing
    ``other`` is at ``later[l]``, so that they keep their distance."""
    way_s = times[other] - times[one]
    least_s = APART_S if falls[one].foot != falls[other].foot else LEAST_STAND_S + LEAST_SWING_S
    gap_s = later[None, :] - earlier[:, None]
    return np.asarray((gap_s >= min(least_s, way_s) - 1e-6) & ((way_s >= APART_S) | (gap_s <= way_s + 0.05)))
