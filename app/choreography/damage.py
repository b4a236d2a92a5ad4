"""Damage of a capture: places where a segment moves as no body does, for a few frames or for longer.

What a body does between two moments follows from how it moves at both; where damage is, it does not. Between every two
frames up to `WINDOW_S` apart the way is compared with the cubic that joins them at their speeds: a spin and a throw are
near to it, a flip, a swapped marker, a jump and a place that is lost are not. Speed alone says nothing, and neither
does what is as fast before or after.

The bounds were measured on clean captures of four makers (CMU, Bandai Namco, Mixamo-like ones of Meta's, at 30, 60 and
120 frames a second: dances, kicks, punches, jumps, waving): each is 1.2 to 1.5 times what is farthest from the cubic
in any of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.ndimage import maximum_filter1d

from app.arrays import BoolArray, FloatArray, IntArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.rig import quaternion

WINDOW_S: Final = 0.12
"""Longest time over which a way is compared."""
TRUNK_WINDOW_S: Final = 0.24
"""Length of the window for hips, trunk and head, which do not go far and back in it: shorter windows show nothing
there."""
MOST_WINDOWS: Final = 8
MOST_INSIDE: Final = 8
"""Lengths of windows, and frames inside of each, where the frame rate has more of them."""
BESIDE: Final = 1.5
BESIDE_RAD_S: Final = 2.0
BESIDE_M_S: Final = 0.2
"""Speed in metres per second by which, on top of the factor `BESIDE`, a step within damage is faster than the steps
before and after it."""
_FAR_DEG: Final = {
    "hips": 9.5, "spine": 8.0, "chest": 8.0, "head": 16.0, "UpperArm": 42.0, "LowerArm": 45.0, "Hand": 72.0,
    "UpperLeg": 34.0, "LowerLeg": 45.0, "Foot": 50.0,
}  # fmt: skip
"""Distance from the cubic over `FAR_S` beyond which there is damage; in shorter times it is less."""
FAR_M: Final = 0.05
"""Bound for the place of the hips, in metres."""
FAR_S: Final = 0.1
LEAST_PART: Final = 0.45
"""Share of the bounds below which nothing is damage, however short the time."""
SUDDEN: Final = 4.0
SUDDEN_PART: Final = 0.6
"""Share of the bounds that applies over two steps that are much faster than the steps around them."""
FASTEST_RAD_S: Final = 45.0
"""No joint of a dancer turns faster: elbows of boxers and pitchers reach 43 rad/s (G. Fleisig and others, "Kinetics of
baseball pitching", 1995), knees of kicks 35, and the fastest clean capture 35."""
FASTEST_HIPS_RAD_S: Final = 15.0
"""Hips do so in spins only, which last: a jump is shorter than `SPIN_S` or turns by less than `SPIN_RAD`."""
FASTEST_TRUNK_RAD_S: Final = 13.0
FASTEST_HEAD_RAD_S: Final = 32.0
"""Bounds of spine and chest, and of the head: half as fast again as the fastest of 240 clean captures of 8 makers."""
SPIN_S: Final = 0.125
SPIN_RAD: Final = 2.5
BEGINS: Final = 0.5
"""Share of the bounds from which such a turn is taken to begin."""
FROZEN: Final = 2
"""Steps without any motion, of a body that moves by more than `STARTS_RAD_S` before or after them, are lost frames."""
STARTS_RAD_S: Final = 1.5
MOST_FROZEN: Final = 0.25
"""A clip that rests longer than this part of its time was made so."""
MOST_BENT_DEG: Final = {"spine": 120.0, "chest": 120.0, "head": 130.0}
"""No neck bends farther from the T-pose, nor does a back: a head that hangs upside down was captured wrongly, however
slowly it got there. Of 70 captures of six makers the farthest neck that may be right is at 104."""
MOST_WRONG: Final = 0.5
"""A clip that is bent like that for a longer part of its time was read or made so."""

MOST_AT_ONCE: Final = 1_000_000
"""Numbers that are compared at a time: noise is damage everywhere."""

PLACE: Final = len(SEGMENTS)
"""Number of the hips' place among the tracks of a clip, after its segments."""
PARTS: Final = (*SEGMENTS, "place")


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
_FASTEST: FloatArray = np.array([*(_OF_TRUNK.get(name, FASTEST_RAD_S) for name in SEGMENTS), np.inf])


@dataclass(frozen=True, order=True)
class Damage:
    """Frames of a clip between two that are sound.

    Attributes
    ----------
    start, stop : int
        The last sound frame before the damage and the first one after it.
    parts : tuple of str
        Of `PARTS`, in their order.
    """

    start: int
    stop: int
    parts: tuple[str, ...]


def damage(clip: MotionClip, tolerance: float = 1.0) -> tuple[Damage, ...]:
    """Damage of a clip, ascending; what overlaps in time is one.

    Parameters
    ----------
    tolerance : float
        Of distances from the cubic, as a multiple of those of captures.
    """
    if len(clip) < 5:
        return ()
    speeds = part_speeds(clip)
    found = set(_too_fast(speeds, float(clip.fps)))
    lengths = _lengths(float(clip.fps), WINDOW_S)
    for length in lengths:
        found.update(_off_the_cubic(clip, speeds, length, tolerance))
    for length in _lengths(float(clip.fps), TRUNK_WINDOW_S):
        if length > lengths[-1]:
            spread = [one for one in _off_the_cubic(clip, speeds, length, tolerance) if one[2] in _TRUNK]
            found.update(_unknown(spread, found, len(clip)))
    found = _with_held(speeds, found)
    found.update((start, stop, part) for start, stop in _frozen(speeds) for part in range(len(PARTS)))
    found.update(_stopped(speeds))
    found.update(_too_far_bent(clip))
    return tuple(_merged(found))


def part_speeds(clip: MotionClip) -> FloatArray:
    """(F - 1, 17) rad/s of every segment from frame to frame, and m/s of the hips."""
    turns = angle(clip.rotations[:-1], clip.rotations[1:])
    ways = np.linalg.norm(np.diff(clip.hips_m, axis=0), axis=-1, keepdims=True)
    return np.concatenate([turns, ways], axis=1) * float(clip.fps)


def angle(a: FloatArray, b: FloatArray) -> FloatArray:
    """Radians between rotations (..., 4)."""
    # By the distance of the unit quaternions, which is exact where it is small, as the cosine is not.
    dot = np.einsum("...i,...i->...", a, b)
    apart = np.linalg.norm(a - np.where(dot < 0.0, -1.0, 1.0)[..., None] * b, axis=-1)
    return np.asarray(4.0 * np.arcsin(np.clip(0.5 * apart, 0.0, 1.0)))


def between(
    before: FloatArray, after: FloatArray, slopes: tuple[FloatArray, FloatArray], share: float | FloatArray
) -> FloatArray:
    """Cubic from the one value to the other at a share of the way, with slopes per whole way."""
    square, cube = share * share, share**3
    return np.asarray(
        (2.0 * cube - 3.0 * square + 1.0) * before
        + (cube - 2.0 * square + share) * slopes[0]
        + (3.0 * square - 2.0 * cube) * after
        + (cube - square) * slopes[1]
    )


def _unknown(
    spans: Iterable[tuple[int, int, int]], found: Iterable[tuple[int, int, int]], frames: int
) -> Iterator[tuple[int, int, int]]:
    """Spans in which and at whose ends no damage of the same part was found."""
    edges = np.zeros((len(PARTS), frames + 1), np.int64)
    for start, stop, part in found:
        edges[part, start] += 1
        edges[part, stop + 1] -= 1
    before = np.cumsum(np.cumsum(edges, axis=1) > 0, axis=1)
    for start, stop, part in spans:
        if before[part, stop] == (before[part, start - 1] if start else 0):
            yield start, stop, part


def _lengths(fps: float, most_s: float) -> list[int]:
    """Steps of the windows."""
    most = max(2, int(most_s * fps))
    return sorted({round(one) for one in np.geomspace(2, most, min(MOST_WINDOWS, most - 1))})


def _off_the_cubic(
    clip: MotionClip, speeds: FloatArray, length: int, tolerance: float
) -> Iterator[tuple[int, int, int]]:
    """Spans (start, stop, part) that are far from a cubic fitted over a window of steps."""
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
    bound = tolerance * _FAR * max(LEAST_PART, (time_s / FAR_S) ** 1.2)
    turned, moved = part < PLACE, part == PLACE
    bounds = bound[part]
    if length == 2:
        sudden = highest[first, part] > SUDDEN / BESIDE * least[first, part]
        bounds = bounds * np.where(sudden, SUDDEN_PART, 1.0)
    far = np.zeros(len(first), bool)
    far[turned] = _turns_off(clip.rotations, first[turned] + 1, part[turned], length) > bounds[turned]
    far[moved] = _moves_off(clip.hips_m, first[moved] + 1, length) > bounds[moved]
    first, part = first[far], part[far]
    for some in np.array_split(np.arange(len(first)), len(first) * length // MOST_AT_ONCE + 1):
        wild = steps[first[some], part[some]] > least[first[some], part[some], None]
        starts = first[some] + 1 + wild.argmax(axis=1)
        stops = first[some] + 1 + length - wild[:, ::-1].argmax(axis=1)
        yield from zip(starts.tolist(), stops.tolist(), part[some].tolist(), strict=True)


def _inside(length: int) -> list[int]:
    """Frames of a window that are compared."""
    return sorted({round(one) for one in np.linspace(1, length - 1, min(MOST_INSIDE, length - 1))})


def _turns_off(rotations: FloatArray, start: IntArray, part: IntArray, length: int) -> FloatArray:
    """Farthest angles from the cubic of the frames between ``start`` and ``length`` later."""
    ends = [rotations[start + step, part] for step in (-1, 0, length, length + 1)]
    slopes = length * (ends[1] - ends[0]), length * (ends[3] - ends[2])
    off = np.zeros(len(start))
    for step in _inside(length):
        expected = quaternion.normalize(between(ends[1], ends[2], slopes, step / length))
        off = np.maximum(off, angle(expected, rotations[start + step, part]))
    return off


def _moves_off(places: FloatArray, start: IntArray, length: int) -> FloatArray:
    """Deviation of places (F, 3), metres, from even motion."""
    ends = [places[start + step] for step in (-1, 0, length, length + 1)]
    slopes = length * (ends[1] - ends[0]), length * (ends[3] - ends[2])
    off = np.zeros(len(start))
    for step in _inside(length):
        expected = between(ends[1], ends[2], slopes, step / length)
        off = np.maximum(off, np.linalg.norm(expected - places[start + step], axis=-1))
    return off


def _too_fast(speeds: FloatArray, fps: float) -> Iterator[tuple[int, int, int]]:
    """Joints that turn faster than any does; hips that turn fast and do not spin."""
    for part in np.flatnonzero((speeds > _FASTEST).any(axis=0)).tolist():
        # Such a turn is followed to where it begins and ends, and so is a spin.
        for start, stop in runs(speeds[:, part] > _FASTEST[part] * BEGINS):
            turned = speeds[start:stop, part]
            spins = part == 0 and (stop - start) / fps >= SPIN_S and turned.sum() / fps >= SPIN_RAD
            if turned.max() > _FASTEST[part] and not spins:
                yield start, stop, part


def _with_held(speeds: FloatArray, found: set[tuple[int, int, int]]) -> set[tuple[int, int, int]]:
    """Spans, each with what it is the edge of: frames in which the segment is held where it jumped to, or was held."""
    held = [runs(speeds[:, part] == 0.0) for part in range(len(PARTS))]
    usable = [(speeds[:, part] == 0.0).mean() <= MOST_FROZEN for part in range(len(PARTS))]
    long = [
        [run for run in some if run[1] - run[0] >= FROZEN] if use else []
        for some, use in zip(held, usable, strict=True)
    ]
    begins, ends = [dict(some) for some in long], [{stop: start for start, stop in some} for some in long]
    return {(ends[part].get(start, start), begins[part].get(stop, stop), part) for start, stop, part in found}


def _frozen(speeds: FloatArray) -> Iterator[tuple[int, int]]:
    """Spans in which a body that moves stands as if it were cut out."""
    still = (speeds == 0.0).all(axis=1)
    if still.mean() > MOST_FROZEN:
        return
    fast = speeds[:, :PLACE].max(axis=1)
    for start, stop in runs(still):
        beside = max(fast[start - 1] if start else 0.0, fast[stop] if stop < len(fast) else 0.0)
        if stop - start >= FROZEN and start and stop < len(fast) and beside > STARTS_RAD_S:
            yield start, stop + 1


def _stopped(speeds: FloatArray) -> Iterator[tuple[int, int, int]]:
    """Spans in which a segment that moves stops within a frame, as where its marker is lost."""
    for part in range(PLACE):
        turned = speeds[:, part]
        still = turned == 0.0
        if still.mean() > MOST_FROZEN:
            continue
        for start, stop in runs(still):
            inside = start > 0 and stop < len(turned)
            if inside and stop - start >= FROZEN and max(turned[start - 1], turned[stop]) > STARTS_RAD_S:
                yield start - 1, stop + 1, part


def _too_far_bent(clip: MotionClip) -> Iterator[tuple[int, int, int]]:
    """Spans in which the trunk or the neck is bent as no body can be."""
    for name, most_deg in MOST_BENT_DEG.items():
        part = SEGMENTS.index(name)
        swing, _ = quaternion.swing_twist(clip.rotations[:, part], (0.0, 1.0, 0.0))
        beyond = np.abs(swing[:, 3]) < np.cos(0.5 * np.radians(most_deg))
        if beyond.mean() <= MOST_WRONG:
            for start, stop in runs(beyond):
                yield max(start - 1, 0), min(stop, len(clip) - 1), part


def runs(of: BoolArray) -> list[tuple[int, int]]:
    """Half-open spans in which a condition holds."""
    edges = np.flatnonzero(np.diff(of.astype(np.int8), prepend=0, append=0))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def _merged(found: Iterable[tuple[int, int, int]]) -> Iterator[Damage]:
    """Spans of single parts that overlap or touch, as one of all of these parts."""
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
