"""Damage of a capture: spans in which a segment moves impossibly, for a few frames or longer.

Motion between two moments normally follows from the motion at both; damaged motion does not. Between every two frames
up to `WINDOW_S` apart, the motion is compared with the cubic that joins them at their speeds: spins and throws are near
it, flips, swapped markers, jumps and lost places are not. Speed alone is no indication, nor is motion as fast as that
before or after.

The bounds were measured on clean captures from four sources (CMU, Bandai Namco, Mixamo-like ones by Meta, at 30, 60 and
120 frames a second: dances, kicks, punches, jumps, waving): each is 1.2 to 1.5 times the greatest distance from the
cubic in any of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.ndimage import maximum_filter1d

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.body_speeds import PARTS, PLACE, part_speeds, runs
from app.choreography.clip import MotionClip
from app.choreography.cubic_distance import moves_off, part_of_bound, turns_off, window_lengths
from app.choreography.frozen_limbs import frozen, with_held
from app.choreography.twitches import twitches
from app.rig import quaternion

WINDOW_S: Final = 0.12
"""Longest time in seconds over which motion is compared."""
TRUNK_WINDOW_S: Final = 0.24
"""Same time for hips, trunk and head, whose slower motion shorter windows cannot judge."""
BESIDE: Final = 1.5
BESIDE_RAD_S: Final = 2.0
BESIDE_M_S: Final = 0.2
"""Speed in metres per second by which, in addition to the factor `BESIDE`, a damaged step is faster than adjacent
steps.
"""
_FAR_DEG: Final = {
    "hips": 9.5, "spine": 8.0, "chest": 8.0, "head": 16.0, "UpperArm": 42.0, "LowerArm": 45.0, "Hand": 72.0,
    "UpperLeg": 34.0, "LowerLeg": 45.0, "Foot": 50.0,
}  # fmt: skip
"""Greatest angles in degrees from the cubic over `FAR_S` of `app.choreography.cubic_distance`; less for shorter
times.
"""
FAR_M: Final = 0.05
"""Greatest distance in metres of the hips' place from the cubic, in addition to the angles of `_FAR_DEG`."""
SUDDEN: Final = 4.0
SUDDEN_PART: Final = 0.6
"""Share of the bounds that applies over two steps that are much faster than the steps around them."""
FASTEST_RAD_S: Final = 45.0
"""Greatest rotation speed of a joint in radians per second: elbows of boxers and pitchers reach 43 (G. Fleisig and
others, "Kinetics of baseball pitching", 1995), knees of kicks 35, and the fastest clean capture 35.
"""
FASTEST_HIPS_RAD_S: Final = 15.0
"""Same for hips outside of spins: a jump is shorter than `SPIN_S` or turns by less than `SPIN_RAD`."""
FASTEST_TRUNK_RAD_S: Final = 13.0
FASTEST_HEAD_RAD_S: Final = 32.0
"""`FASTEST_TRUNK_RAD_S` and `FASTEST_HEAD_RAD_S`: greatest rotation speeds of spine and chest, and of the head: 1.5
times the fastest of 240 clean captures of 8 makers.
"""
SPIN_S: Final = 0.125
SPIN_RAD: Final = 2.5
BEGINS: Final = 0.5
"""Share of the bounds at which such a fast rotation is considered to begin."""
MOST_BENT_DEG: Final = {"spine": 120.0, "chest": 120.0, "head": 130.0}
"""Greatest angles in degrees of neck and back from the T-pose: a head hanging upside down was captured wrongly. Among
70 captures from six sources the farthest plausible neck is at 104.
"""
MOST_TURNED_DEG: Final = {"leftFoot": (85.0, 110.0), "rightFoot": (85.0, 110.0)}
"""Angles in degrees from the T-pose at which the span of a wrongly turned foot begins, and that it exceeds: among 70
captures from six sources the farthest plausible foot, pointed in a kick, is at 91, and exchanged markers are at 170."""
MOST_WRONG: Final = 0.5
"""Share of a clip's time above which such bends indicate a wrongly read clip."""

MOST_AT_ONCE: Final = 1_000_000
"""Greatest number of values compared at a time, since noise is damaged everywhere."""


def _far(name: str) -> float:
    return float(np.radians(next(far for part, far in _FAR_DEG.items() if name.endswith(part))))


_FAR: FloatArray = np.array([*map(_far, SEGMENTS), FAR_M])
_OF_TRUNK: Final = {
    "hips": FASTEST_HIPS_RAD_S,
    "spine": FASTEST_TRUNK_RAD_S,
    "chest": FASTEST_TRUNK_RAD_S,
    "head": FASTEST_HEAD_RAD_S,
}
_TRUNK: Final = (*map(SEGMENTS.index, _OF_TRUNK), len(SEGMENTS))
FASTEST: FloatArray = np.array([*(_OF_TRUNK.get(name, FASTEST_RAD_S) for name in SEGMENTS), np.inf])
"""Greatest rotation speed of each segment in radians per second, and no limit for the place of the hips."""


@dataclass(frozen=True, order=True)
class Damage:
    """A damaged span between two sound frames.

    Attributes
    ----------
    start, stop : int
        Last sound frame before the damage and first one after it.
    parts : tuple of str
        Damaged parts of the body, from `PARTS` in their order.
    """

    start: int
    stop: int
    parts: tuple[str, ...]


def damage(clip: MotionClip, tolerance: float = 1.0, *, captured: bool = True) -> tuple[Damage, ...]:
    """Return the damage of a clip in ascending order, with spans that overlap in time joined.

    Parameters
    ----------
    tolerance : float
        Factor of the distances from the cubic relative to captures.
    captured : bool
        False for a generated motion, in which a standing leg may be motionless.
    """
    if len(clip) < 5:
        return ()
    speeds = part_speeds(clip)
    found = set(_too_fast(speeds, float(clip.fps)))
    lengths = window_lengths(float(clip.fps), WINDOW_S)
    for length in lengths:
        found.update(_off_the_cubic(clip, speeds, length, tolerance))
    for length in window_lengths(float(clip.fps), TRUNK_WINDOW_S):
        if length > lengths[-1]:
            spread = [one for one in _off_the_cubic(clip, speeds, length, tolerance) if one[2] in _TRUNK]
            # Shorter windows show only the edges of a dip.
            found.update(one for one in spread if one[2] == PLACE)
            found.update(_unknown(spread, found, len(clip)))
    found = with_held(speeds, found)
    if captured:
        found.update(frozen(clip, speeds))
    found.update(twitches(clip, found, tolerance))
    found.update(_too_far_bent(clip))
    return tuple(_merged(found))


def _unknown(
    spans: Iterable[tuple[int, int, int]], found: Iterable[tuple[int, int, int]], frames: int
) -> Iterator[tuple[int, int, int]]:
    """Yield those spans (start, stop, index of the body part) that are new: no damage of the same part was ``found``
    within or next to them.
    """
    edges = np.zeros((len(PARTS), frames + 1), np.int64)
    for start, stop, part in found:
        edges[part, start] += 1
        edges[part, stop + 1] -= 1
    before = np.cumsum(np.cumsum(edges, axis=1) > 0, axis=1)
    for start, stop, part in spans:
        if before[part, stop] == (before[part, start - 1] if start else 0):
            yield start, stop, part


def _off_the_cubic(
    clip: MotionClip, speeds: FloatArray, length: int, tolerance: float
) -> Iterator[tuple[int, int, int]]:
    """Yield the spans (start, stop, index of the body part) in which a part is far from the cubic through the ends of a
    window of ``length`` steps.
    """
    count = len(speeds) - length - 1
    if count < 1:
        return
    steps = np.lib.stride_tricks.sliding_window_view(speeds, length, axis=0)[1 : 1 + count]
    outside = np.maximum(speeds[:count], speeds[1 + length : 1 + length + count])
    least = BESIDE * outside + np.where(np.arange(len(PARTS)) == PLACE, BESIDE_M_S, BESIDE_RAD_S)
    highest = maximum_filter1d(speeds, length, axis=0, origin=-(length // 2))[1 : 1 + count]
    first, part = np.nonzero(highest > least)
    if not len(first):
        return
    time_s = length / float(clip.fps)
    bound = tolerance * _FAR * part_of_bound(time_s)
    turned, moved = part < PLACE, part == PLACE
    bounds = bound[part]
    if length == 2:
        sudden = highest[first, part] > SUDDEN / BESIDE * least[first, part]
        bounds = bounds * np.where(sudden, SUDDEN_PART, 1.0)
    far = np.zeros(len(first), bool)
    far[turned] = turns_off(clip.rotations, first[turned] + 1, part[turned], length) > bounds[turned]
    far[moved] = moves_off(clip.hips_m, first[moved] + 1, length) > bounds[moved]
    first, part = first[far], part[far]
    for some in np.array_split(np.arange(len(first)), len(first) * length // MOST_AT_ONCE + 1):
        wild = steps[first[some], part[some]] > least[first[some], part[some], None]
        starts = first[some] + 1 + wild.argmax(axis=1)
        stops = first[some] + 1 + length - wild[:, ::-1].argmax(axis=1)
        yield from zip(starts.tolist(), stops.tolist(), part[some].tolist(), strict=True)


def _too_fast(speeds: FloatArray, fps: float) -> Iterator[tuple[int, int, int]]:
    """Yield the spans of joints that rotate too fast, and of hips that turn fast without spinning."""
    for part in np.flatnonzero((speeds > FASTEST).any(axis=0)).tolist():
        # A fast turn, like a spin, is followed to its beginning and end.
        for start, stop in runs(speeds[:, part] > FASTEST[part] * BEGINS):
            turned = speeds[start:stop, part]
            spins = part == 0 and (stop - start) / fps >= SPIN_S and turned.sum() / fps >= SPIN_RAD
            if turned.max() > FASTEST[part] and not spins:
                yield start, stop, part


def _too_far_bent(clip: MotionClip) -> Iterator[tuple[int, int, int]]:
    """Yield the spans in which the trunk, the neck or an ankle is bent impossibly."""
    for name, most_deg in MOST_BENT_DEG.items():
        part = SEGMENTS.index(name)
        swing, _ = quaternion.swing_twist(clip.rotations[:, part], (0.0, 1.0, 0.0))
        beyond = np.abs(swing[:, 3]) < np.cos(0.5 * np.radians(most_deg))
        if beyond.mean() <= MOST_WRONG:
            for start, stop in runs(beyond):
                yield max(start - 1, 0), min(stop, len(clip) - 1), part
    for name, (begins_deg, most_deg) in MOST_TURNED_DEG.items():
        part = SEGMENTS.index(name)
        turned_deg = np.degrees(2.0 * np.arccos(np.minimum(np.abs(clip.rotations[:, part, 3]), 1.0)))
        beyond = turned_deg > begins_deg
        if beyond.mean() <= MOST_WRONG:
            for start, stop in runs(beyond):
                if turned_deg[start:stop].max() > most_deg:
                    yield max(start - 1, 0), min(stop, len(clip) - 1), part


def _merged(found: Iterable[tuple[int, int, int]]) -> Iterator[Damage]:
    """Merge spans of single body parts that overlap or touch into one damage with all these parts."""
    start, stop, parts = 0, -1, set[int]()
    for one_start, one_stop, part in sorted(found):
        if one_start <= stop:
            stop = max(stop, one_stop)
            parts.add(part)
            continue
        if parts:
            yield Damage(start, stop, tuple(PARTS[at] for at in sorted(parts)))
        start, stop, parts = one_start, one_stop, {part}
    if parts:
        yield Damage(start, stop, tuple(PARTS[at] for at in sorted(parts)))
