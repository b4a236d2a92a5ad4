"""Footfalls on the beats: a foot leaves the floor and lands slightly earlier or later than in the capture.

Steps have the duration of the captured dancers' steps.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np
from scipy.interpolate import PchipInterpolator

from app.arrays import FloatArray
from app.choreography.accent_grid import AccentGrid
from app.choreography.clip import MotionClip
from app.choreography.contacts import foot_contacts
from app.choreography.foot_plants import SAME_M, FootPlant

REACH_S: Final = 0.2
"""Greatest shift of a footfall in seconds."""
FAR_M: Final = 0.6
"""Greatest distance in metres between a foot and its place in the motion while its landing is shifted, at its greatest
speed before the landing."""
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
STEP_SHARE: Final = 1.0
"""Least duration of a step relative to the usual one, if there is time."""
FASTEST_M_S: Final = 5.0
"""Speed in metres per second above which a foot kicks and lands as captured, since its place would be far from the body
a moment later.
"""
LEAST_DESCENT_S: Final = 0.12
"""Least time in seconds between a kick and a landing that may be moved."""
MOST_HASTE: Final = 1.5
"""Greatest ratio of a descent after a kick to the captured one, or of the captured one to it."""
MOST_LEAD_S: Final = 0.1
"""Greatest time in seconds between a touch of the floor and the start of the stand."""
LANDS_S: Final = 0.1
"""Time in seconds before a landing in which a foot moves as captured, so that it does not hover over the floor."""
BEGUN_S: Final = 0.1
"""Time in seconds from the first frame within which a foot that would land stands from the beginning instead."""
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
    *,
    leads: FloatArray | None = None,
) -> Footfalls:
    """Move foot plants so that they begin on nearby accents of the grid.

    Parameters
    ----------
    standing : sequence of FootPlant
        Foot plants ordered by start, from `app.choreography.foot_plants.stands`.
    frames : int
        Number of frames of the motion.
    first_s : float
        Time of frame 0 in seconds.
    step_s : float
        Usual time of a step.
    speeds_m_s : (F, 2) float64, optional
        Speeds of the left and the right foot.
    leads : (N,) float64, optional
        Number of frames by which each foot touches the floor before its stand begins; 0 by default.
    """
    kicked, reaches = {} if speeds_m_s is None else _kicked(standing, speeds_m_s), _reaches_s(standing, speeds_m_s)
    early = np.zeros(len(standing)) if leads is None else leads
    falls = [at for at, stand in enumerate(standing) if stand.start > 0]
    starts = {at: float(stand.start) for at, stand in enumerate(standing)}
    by_foot = [[at for at, stand in enumerate(standing) if stand.foot == foot] for foot in range(2)]
    # A stand at the first frame is no landing, and a stand that ends at its landing is not followed by one.
    after = {at: following for own in by_foot for at, following in pairwise(own)}
    kept = {at for own in by_foot for at in own if at not in after or after[at] in kicked}
    bounds_s = []
    for at in falls:
        start, reach = standing[at].start, reaches[at] * fps
        stands = standing[at].stop - LEAST_STAND_S * fps if at in kept else frames - 1.0
        first, last = _after_kick(kicked[at], start, fps) if at in kicked else (1.0, stands)
        earliest, latest = max(1.0, first, start - reach), min(stands, last, start + reach)
        bounds_s.append((first_s + (earliest - early[at]) / fps, first_s + (latest - early[at]) / fps))
    touched = [replace(standing[at], start=standing[at].start - early[at]) for at in falls]
    chosen = _chosen(touched, fps, first_s, grid, bounds_s)
    starts.update((at, frame + early[at]) for at, frame in zip(falls, chosen, strict=True))
    begun = BEGUN_S * fps
    moved = [replace(stand, start=round(starts[at]) if starts[at] > begun else 0) for at, stand in enumerate(standing)]
    shown = np.tile(np.arange(frames, dtype=np.float64)[:, None], (1, 2))
    for foot, own in enumerate(by_foot):
        others = by_foot[1 - foot]
        began = [standing[at].start for at in others]
        for at, following in pairwise(own):
            if at in kept:
                continue
            starts_at = moved[at].start, moved[following].start
            left = standing[at].stop
            # The stand of the other foot in which this one leaves the floor.
            during = [other for other in others[: bisect_right(began, left)][-1:] if left < standing[other].stop]
            lands = max((moved[other].start for other in during), default=0)
            stop = _leaves(standing[at], standing[following], *starts_at, lands, fps, step_s)
            moved[at] = replace(moved[at], stop=stop)
        shown[:, foot] = _shown(own, standing, moved, kicked, frames, fps)
    moved.sort(key=lambda stand: (stand.start, stand.foot))
    return Footfalls(tuple(moved), np.clip(shown, 0.0, frames - 1.0))


def _shown(
    own: Sequence[int],
    standing: Sequence[FootPlant],
    moved: Sequence[FootPlant],
    kicked: Mapping[int, int],
    frames: int,
    fps: float,
) -> FloatArray:
    """Compute the frame (F,) of the motion that a foot shows in each frame, with its plants ``own`` moved from
    ``standing`` to ``moved``."""
    knots = [(0, standing[own[0]].start if own and not moved[own[0]].start else 0)]
    for at in own:
        here, there = moved[at].start, standing[at].start
        lands = min(round(LANDS_S * fps), (min(here - knots[-1][0], there - knots[-1][1])) // 2)
        if at in kicked:
            knots.append((kicked[at], kicked[at]))
            lands = 0
        if lands > 0:
            knots.append((here - lands, there - lands))
        knots += [(here, there), (moved[at].stop - 1, standing[at].stop - 1)]
    knots.append((frames - 1, frames - 1))
    places, shown = np.array(knots, np.float64), np.arange(frames, dtype=np.float64)
    ascends = np.concatenate([[True], (np.diff(places, axis=0) > 0).all(axis=1)])
    if ascends.sum() < 2:
        return shown
    return np.asarray(PchipInterpolator(places[ascends, 0], places[ascends, 1])(shown))


def _kicked(standing: Sequence[FootPlant], speeds_m_s: FloatArray) -> dict[int, int]:
    """Return the last fast frame before each foot plant that follows a kick, by its index."""
    found, left = {}, [0, 0]
    for at, stand in enumerate(standing):
        (fast,) = np.nonzero(speeds_m_s[left[stand.foot] : stand.start, stand.foot] > FASTEST_M_S)
        if len(fast):
            found[at] = left[stand.foot] + int(fast[-1])
        left[stand.foot] = stand.stop
    return found


def _reaches_s(standing: Sequence[FootPlant], speeds_m_s: FloatArray | None) -> list[float]:
    """Return the greatest shift in seconds of each foot plant; less for a faster foot."""
    if speeds_m_s is None:
        return [REACH_S] * len(standing)
    found, left = [], [0, 0]
    for stand in standing:
        speeds = speeds_m_s[left[stand.foot] : stand.start, stand.foot]
        fastest = float(speeds[speeds <= FASTEST_M_S].max(initial=0.0))
        found.append(min(REACH_S, FAR_M / max(fastest, 1e-9)))
        left[stand.foot] = stand.stop
    return found


def _after_kick(fast: int, start: int, fps: float) -> tuple[float, float]:
    """Return the earliest and the latest frame at which a foot that kicks until the frame ``fast`` may land; without
    room for a shift the earliest is after the latest."""
    left = start - fast
    if left < LEAST_DESCENT_S * fps:
        return 1.0, 0.0
    return fast + left / MOST_HASTE, fast + left * MOST_HASTE


def _leaves(
    before: FootPlant,
    after: FootPlant,
    came: int,
    comes: int,
    lands: int,
    fps: float,
    step_s: float,
) -> int:
    """Choose the frame in which a foot leaves the floor between two of its landings, which were moved to the frames
    ``came`` and ``comes``.

    It does not leave before the other foot has landed in the frame ``lands``, if the motion has them in this order.
    """
    swing = after.start - before.stop
    way_m = math.dist(after.place_m, before.place_m)
    takes = max(swing, math.ceil(STEP_SHARE * step_s * fps)) if way_m > SAME_M else swing
    first = came + min(before.stop - before.start, round(LEAST_STAND_S * fps))
    last = comes - min(swing, round(LEAST_SWING_S * fps))
    return max(came + 1, min(max(comes - takes, first, lands), last))


def _chosen(
    falls: Sequence[FootPlant], fps: float, first_s: float, grid: AccentGrid, bounds_s: Sequence[tuple[float, float]]
) -> list[float]:
    """Choose the frames of all landings with the greatest total value, by dynamic programming over consecutive pairs.

    ``bounds_s`` has the first and last possible time of each landing.
    """
    times = [first_s + fall.start / fps for fall in falls]
    alone = [_options(time_s, grid, *bounds) for time_s, bounds in zip(times, bounds_s, strict=True)]
    options = [[*own, *_along(at, falls, times, alone, bounds_s)] for at, own in enumerate(alone)]
    # Best total so far for each pair of options of the last two landings.
    value = np.zeros((1, 1))
    back: list[np.ndarray] = []
    pairs = [np.array(own).T for own in options]
    for at, (new, worth) in enumerate(pairs):
        fits = np.zeros((1, len(new)))
        if at:
            fits = np.where(_possible(falls, times, at - 1, at, pairs[at - 1][0], new), 0.0, NEVER)
        if at > 1 and falls[at - 2].foot == falls[at].foot:
            possible = _possible(falls, times, at - 2, at, pairs[at - 2][0], new)
            fits = fits + np.where(possible, 0.0, NEVER)[:, None, :]
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
    for at in range(*(bisect_left(grid.times_s, end_s) for end_s in reach_s)):
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
    possible = gap_s >= min(least_s, way_s) - 1e-6
    return possible if way_s >= APART_S else possible & (gap_s <= way_s + 0.05)


def touch_leads(clip: MotionClip, standing: Sequence[FootPlant]) -> FloatArray:
    """Compute the number of frames (N,) by which the feet of a motion touch the floor before N foot plants begin; 0
    without a touch nearby, or with a later one, since a planted foot is on the floor."""
    contacts, most = foot_contacts(clip), round(MOST_LEAD_S * float(clip.fps))
    touches = [np.flatnonzero(np.diff(contacts[:, foot].astype(np.int8), prepend=0) > 0) for foot in range(2)]
    leads = np.zeros(len(standing))
    for at, stand in enumerate(standing):
        near = stand.start - touches[stand.foot]
        near = near[np.abs(near) <= most]
        if stand.start and len(near):
            leads[at] = max(near[np.abs(near).argmin()], 0)
    return leads
