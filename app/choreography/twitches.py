"""Detection of damage visible only at hands and feet: twitches of a limb or the whole body, and sinking bodies.

A few degrees at the hips or a knee are little, but they move a foot aside by a hand's breadth and back within a
twentieth of a second. So the places of ankles, toes and wrists are compared with the cubic too, and that of a point at
the feet that moves rigidly with the hips.

The bounds were measured on 300 clean captures from eight sources, including kicks, punches and stamps.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

import numpy as np
from scipy.ndimage import maximum_filter1d, percentile_filter

from app.arrays import FloatArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.body_speeds import PLACE, runs
from app.choreography.clip import MotionClip
from app.choreography.cubic_distance import moves_off, part_of_bound, window_lengths
from app.rig import quaternion
from app.rig.skeleton import JointTransforms

LIMB_WINDOW_S: Final = 0.12
BODY_WINDOW_S: Final = 0.0505
"""Longest time in seconds over which the whole body is compared, since kicks take longer."""
FAR_M: Final = 0.11
"""Distance in metres of an ankle, toes or a wrist from the cubic over `app.choreography.cubic_distance.FAR_S` beyond
which a limb twitches; 5 cm up to 0.05 s.
"""
BODY_FAR_M: Final = 0.085
"""Same distance for a point that moves with the hips at the height of the ankles; 4 cm up to 0.05 s."""
BESIDE: Final = 1.5
BESIDE_M_S: Final = 0.2
"""Speed in metres per second by which, in addition to the factor `BESIDE`, a step within a twitch is faster than
adjacent steps.
"""
UNDER_M: Final = 0.12
"""Depth of the feet in metres below the floor beyond which a body sank."""
WITH_FEET: Final = 0.7
"""Least depth of the hips relative to that of the feet."""
BEGINS: Final = 0.25
"""Share of that depth at which a body begins to sink."""
FLOOR_S: Final = 4.0
FLOOR_PERCENT: Final = 40
"""Percentile of the lower foot's height in the surrounding time that defines the floor."""


def twitches(clip: MotionClip, found: Iterable[tuple[int, int, int]], tolerance: float) -> set[tuple[int, int, int]]:
    """Find the spans (start, stop, index of the body part) between sound frames in which a hand, a foot or the whole
    body twitches.

    Parameters
    ----------
    found : iterable of tuple of int
        Known damage of the hips or a limb, which is no twitch of the limb.
    tolerance : float
        Factor of the distances relative to captures.
    """
    world, fps = clip.world(), float(clip.fps)
    carried = clip.hips_m + quaternion.rotate(clip.rotations[:, 0], np.array([0.0, -_leg_m(clip), 0.0]))
    twitching = {(*span, 0) for span in _far_spans(carried, fps, BODY_WINDOW_S, tolerance * BODY_FAR_M)}
    twitching.update((*span, PLACE) for span in _sunk(clip, world))
    known = np.zeros((PLACE + 1, len(clip)), bool)
    for start, stop, part in (*found, *twitching):
        known[part, start : stop + 1] = True
    for name in ENDS[1:]:
        limb = _limb(name)
        bad = np.asarray(known[[0, PLACE, *limb]].any(axis=0))
        tracks = [world.positions_m[:, 1 + limb[-1]]]
        if name in FEET:
            tracks.append(_end_m(clip, world, name))
        for track in tracks:
            for start, stop in _far_spans(track, fps, LIMB_WINDOW_S, tolerance * FAR_M):
                if not bad[start : stop + 1].any():
                    twitching.update((start, stop, part) for part in limb)
    return twitching


def _limb(end: str) -> tuple[int, ...]:
    """Return the three segments of the limb that ends in a hand or foot, as indices in `SEGMENTS`, from the trunk
    outwards."""
    kind = "Leg" if end in FEET else "Arm"
    side = end.removesuffix("Foot").removesuffix("Hand")
    return tuple(SEGMENTS.index(name) for name in (f"{side}Upper{kind}", f"{side}Lower{kind}", end))


def _leg_m(clip: MotionClip) -> float:
    parts = [clip.shape.offsets_m[SEGMENTS.index(f"left{name}")] for name in ("LowerLeg", "Foot")]
    return float(np.linalg.norm(parts, axis=1).sum())


def _end_m(clip: MotionClip, world: JointTransforms, name: str, reach: float = 1.0) -> FloatArray:
    """World position (F, 3) of the end of a segment; with a ``reach`` of 0, the point at the end's height directly
    below the joint.
    """
    at = 1 + SEGMENTS.index(name)
    way = clip.shape.ends_m[ENDS.index(name)] * (reach, 1.0, reach)
    return np.asarray(world.positions_m[:, at] + quaternion.rotate(world.rotations[:, at], way))


def _far_spans(places: FloatArray, fps: float, most_s: float, far_m: float) -> Iterator[tuple[int, int]]:
    """Yield the spans (start, stop) of frames in which positions are farther than ``far_m`` from the cubic through the
    sound frames around them.
    """
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=1) * fps
    for length in window_lengths(fps, most_s):
        count = len(speeds) - length - 1
        if count < 1:
            return
        least = BESIDE * np.maximum(speeds[:count], speeds[1 + length : 1 + length + count]) + BESIDE_M_S
        highest = maximum_filter1d(speeds, length, origin=-(length // 2))[1 : 1 + count]
        first = np.flatnonzero(highest > least)
        first = first[moves_off(places, first + 1, length) > far_m * part_of_bound(length / fps)]
        for at in first.tolist():
            wild = np.flatnonzero(speeds[at + 1 : at + 1 + length] > least[at])
            yield at + 1 + int(wild[0]), at + 2 + int(wild[-1])


def _sunk(clip: MotionClip, world: JointTransforms) -> Iterator[tuple[int, int]]:
    """Yield the spans of frames in which the body sinks into the floor and rises again."""
    soles = [_end_m(clip, world, name, reach)[:, 1] for name in FEET for reach in (0.0, 1.0)]
    lowest, hips = np.min(soles, axis=0), clip.hips_m[:, 1]
    around = 1 + 2 * round(0.5 * FLOOR_S * float(clip.fps))
    # A sample of the frames suffices to find the height of the floor.
    every = max(1, around // 60)
    frames = np.arange(0, len(clip), every)
    wide = 1 + 2 * (around // (2 * every))
    floor, usual = (
        np.interp(np.arange(len(clip)), frames, percentile_filter(heights[frames], percent, wide, mode="nearest"))
        for heights, percent in ((lowest, FLOOR_PERCENT), (hips, 50))
    )
    under = floor - lowest
    sunk = np.asarray((under > UNDER_M) & (usual - hips > WITH_FEET * under))
    for start, stop in runs(np.asarray(under > BEGINS * UNDER_M)):
        # The span includes the frames in which the body began to sink.
        if sunk[start:stop].any():
            yield max(start - 1, 0), min(stop, len(clip) - 1)
