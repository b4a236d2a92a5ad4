"""Finds where feet stand in a motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import BoolArray, FloatArray, IntArray
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.feet_on_floor import rest_tip_m

BRIDGED_S: Final = 0.06
"""Longest absence from the floor in seconds that is ignored."""
LEAST_S: Final = 0.05
"""Shortest stand in seconds; shorter ones are ignored."""
REACHED_M: Final = 0.08
"""Height in metres above the floor up to which a foot has landed; a higher one, lifted by a join, is still
descending.
"""
DRIFTS_M: Final = 0.18
"""Distance in metres of a tip's drift during a stand above which the foot takes a step instead."""
STEP_S: Final = 0.30
"""Time in seconds of a step that a join or a turn makes."""
SAME_M: Final = 0.04
"""Distance in metres below which places are equal if the foot hardly leaves the floor between them."""
LIFTED_M: Final = 0.03
"""Least height in metres to which a foot rises in a step that the motion itself takes."""
LEFT_M: Final = 0.01
"""Height in metres above which such a foot has left the floor."""
PULLED_M: Final = 0.04
"""Greatest distance in metres between a foot and its own path for a step that is as short as captured."""


@dataclass(frozen=True)
class FootPlant:
    """A span of frames, ``start`` to before ``stop``, in which a foot (0: left) is planted with its tip at one
    point."""

    foot: int
    start: int
    stop: int
    place_m: tuple[float, float, float]


class InAir(NamedTuple):
    """Spans of frames in which a foot does not stand.

    Attributes
    ----------
    starts, stops : (G,) int64
        First frame of each span, and the frame after the last one.
    before, after : (G,) int64
        Indices of the stands before and after each span; -1 if there is none.
    frames : (N,) int64
        Frames of all spans, ascending.
    spans : (N,) int64
        For each of these the index of its span.
    """

    starts: IntArray
    stops: IntArray
    before: IntArray
    after: IntArray
    frames: IntArray
    spans: IntArray

    @classmethod
    def between(cls, standing: Sequence[FootPlant], frames: int) -> InAir:
        """Return the spans between the stands of one foot, before the first and after the last one."""
        starts = np.array([0, *(stand.stop for stand in standing)])
        stops = np.array([*(stand.start for stand in standing), frames])
        some = np.flatnonzero(stops > starts)
        after = np.where(some < len(standing), some, -1)
        lengths = (stops - starts)[some]
        spans = np.repeat(np.arange(len(some)), lengths)
        along = np.arange(len(spans)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
        return cls(starts[some], stops[some], some - 1, after, starts[some][spans] + along, spans)


def stands(
    clip: MotionClip, contacts: BoolArray, moved_m: FloatArray | None = None, tips: FloatArray | None = None
) -> tuple[FootPlant, ...]:
    """Find the spans in which feet stand still.

    Parameters
    ----------
    contacts : (F, 2) bool
        Captured contacts of the left and the right foot. A foot that a join or turn moves away while it should stand
        takes a step instead.
    moved_m : (F, 3) float64, optional
        Displacement of the whole body in each frame for staying near its place, which shortens steps.
    tips : (F, 2, 3) float64, optional
        Positions of the clip's foot tips, if known.
    """
    fps, tips = float(clip.fps), tips_m(clip) if tips is None else tips
    unmoved = tips if moved_m is None else tips - moved_m[:, None]
    found = []
    for foot in range(2):
        on_floor_m = rest_tip_m(clip, foot)
        low = tips[:, foot, 1] < on_floor_m + REACHED_M
        for start, end in _spans(contacts[:, foot] & low, fps):
            stop = start + _left(tips[start:end, foot, 1])
            for first, last in _still(unmoved[start:stop, foot], fps):
                middle = _middle(tips[start + first : start + last, foot])
                place = (float(middle[0]), on_floor_m, float(middle[2]))
                found.append(FootPlant(foot, start + first, start + last, place))
    own = [_apart([stand for stand in found if stand.foot == foot], tips[:, foot], fps) for foot in range(2)]
    return tuple(sorted(own[0] + own[1], key=lambda stand: (stand.start, stand.foot)))


def foot_speeds_m_s(tips: FloatArray, fps: float) -> FloatArray:
    """Speeds (F, 2) in m/s of the tips (F, 2, 3) of the left and the right foot."""
    return np.asarray(np.linalg.norm(np.gradient(tips, axis=0), axis=-1) * fps)


def steps_s(standing: Sequence[FootPlant], fps: float) -> list[float]:
    """Durations in seconds for which feet are in the air between plants at two different positions."""
    found = []
    for foot in range(2):
        for before, after in pairwise(stand for stand in standing if stand.foot == foot):
            if np.linalg.norm(np.subtract(after.place_m, before.place_m)) > SAME_M:
                found.append((after.start - before.stop) / fps)
    return found


def planted_frames(standing: Sequence[FootPlant], frames: int) -> BoolArray:
    """Return whether the left and the right foot stand in each frame (F, 2)."""
    found = np.zeros((frames, 2), bool)
    for stand in standing:
        found[stand.start : stand.stop, stand.foot] = True
    return found


def _apart(standing: list[FootPlant], tip_m: FloatArray, fps: float) -> list[FootPlant]:
    """Shorten consecutive plants of a foot so that there is time between them for moving.

    A foot that lands at the same place and hardly rose continues to stand there. A step that the motion itself takes,
    lifting the foot, keeps its time however short it is; one made by a join takes `STEP_S`, or less between plants that
    would be lost.
    """
    found: list[FootPlant] = []
    for stand in standing:
        if found:
            before = found[-1]
            way_m = float(np.linalg.norm(np.subtract(stand.place_m, before.place_m)))
            short = STEP_S * fps - (stand.start - before.stop)
            lifted_m = float(np.ptp(tip_m[before.stop - 1 : stand.start + 1, 1]))
            if short > 0.0 and way_m <= SAME_M and lifted_m < LIFTED_M:
                found[-1] = replace(before, stop=stand.stop)
                continue
            pulled = stand.place_m - tip_m[stand.start] - (before.place_m - tip_m[before.stop - 1])
            by_itself = lifted_m >= LIFTED_M and float(np.linalg.norm(pulled[[0, 2]])) <= PULLED_M
            if short > 0.0 and not by_itself:
                least, give = math.ceil(LEAST_S * fps), math.ceil(0.5 * short)
                room = max(before.stop - before.start - least, 0), max(stand.stop - stand.start - least, 0)
                late = min(max(give, math.ceil(short) - room[0]), room[1])
                found[-1] = replace(before, stop=before.stop - min(math.ceil(short) - late, room[0]))
                stand = replace(stand, start=stand.start + late)
        if stand.stop - stand.start >= LEAST_S * fps:
            found.append(stand)
    return found


def _spans(contact: BoolArray, fps: float) -> list[tuple[int, int]]:
    """Convert a mask of contact frames to spans (start, stop); short interruptions are ignored, and short spans
    dropped.
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[0], contact.astype(np.int8), [0]])))
    spans: list[tuple[int, int]] = []
    for start, stop in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if spans and start - spans[-1][1] < BRIDGED_S * fps:
            spans[-1] = spans[-1][0], stop
        else:
            spans.append((start, stop))
    return [(start, stop) for start, stop in spans if stop - start >= LEAST_S * fps]


def _left(heights_m: FloatArray) -> int:
    """Return the number of frames after which a foot with the heights (N,) in contact with the floor has left it: all,
    unless it goes on rising to `LIFTED_M` in the last ones, as where a join lifts it early.
    """
    (sinks,) = np.nonzero(heights_m[1:] <= heights_m[:-1])
    begins = int(sinks[-1]) + 1 if len(sinks) else 0
    risen = heights_m[begins:] - heights_m[begins]
    return begins + int(np.searchsorted(risen, LEFT_M, side="right")) if risen[-1] > LIFTED_M else len(heights_m)


def _still(tip_m: FloatArray, fps: float) -> list[tuple[int, int]]:
    """Split a span (N, 3) of a foot tip's positions into parts in which it stays within `DRIFTS_M` of its middle; cuts
    are where the tip is fastest, with room for a step.
    """
    frames = len(tip_m)
    if frames < LEAST_S * fps:
        return []
    off = np.linalg.norm((tip_m - _middle(tip_m))[:, [0, 2]], axis=1)
    if off.max() <= DRIFTS_M:
        return [(0, frames)]
    speed = np.linalg.norm(np.gradient(tip_m, axis=0)[:, [0, 2]], axis=1) if frames > 1 else np.zeros(frames)
    middle = int(gaussian_filter1d(speed, 0.05 * fps, mode="nearest").argmax())
    half = max(1, round(0.5 * STEP_S * fps))
    first = _still(tip_m[: max(0, middle - half)], fps)
    later = min(frames, middle + half)
    return first + [(start + later, stop + later) for start, stop in _still(tip_m[later:], fps)]


def _middle(places_m: FloatArray) -> FloatArray:
    """Median (3,) of positions (N, 3), by coordinate."""
    ordered = np.sort(places_m, axis=0)
    return np.asarray(0.5 * (ordered[(len(ordered) - 1) // 2] + ordered[len(ordered) // 2]))
