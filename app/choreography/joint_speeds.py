"""Limits the rotation speeds of joints in a dance, and of segments in the world, to those in captures of people.

Where a joint rotates faster, its rotations are smoothed over the adjacent frames. Standing feet stay in place.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import BoolArray, FloatArray
from app.choreography.body import PARENT_OF, SEGMENTS
from app.choreography.body_speeds import angle, runs
from app.choreography.clip import MotionClip
from app.choreography.damage import FASTEST
from app.choreography.feet_on_floor import free
from app.rig import quaternion

ROOM: Final = 0.95
"""Share of the limits that is used, since frames are rounded to files, and feet are lifted from the floor again."""
SMOOTH_S: Final = 0.015
"""Standard deviation in seconds of the first smoothing; that of later ones is as many times longer."""
ROUNDS: Final = 10


def within_speeds(clip: MotionClip, planted: BoolArray) -> MotionClip:
    """Return the motion with the rotation speed of each joint except the hips limited to
    `app.choreography.damage.FASTEST`; the same object if no joint is faster.

    Parameters
    ----------
    planted : (F, 2) bool
        Frames in which the left and the right foot stand; their legs stay as they are.
    """
    if len(clip) < 2:
        return clip
    rotations, fps = clip.rotations, float(clip.fps)
    near = np.abs(quaternion.dot(rotations[:-1], rotations[1:])).min(axis=0)
    for part, fastest_rad_s in enumerate(FASTEST[: len(SEGMENTS)]):
        # The product of two rotations is the cosine of half the turn between them.
        if not part or near[part] > np.cos(0.5 * ROOM * float(fastest_rad_s) / fps) + 1e-9:
            continue
        name = SEGMENTS[part]
        turns = rotations[:, part]
        calm = _calm(turns, ROOM * float(fastest_rad_s) / fps, fps, _may_change(name, planted, fps))
        if calm is not turns:
            rotations = rotations.copy(order="K") if rotations is clip.rotations else rotations
            rotations[:, part] = calm
    return clip if rotations is clip.rotations else replace(clip, rotations=quaternion.continuous(rotations))


def turns_within_speeds(clip: MotionClip, planted: BoolArray, fastest_rad_s: FloatArray) -> MotionClip:
    """Return the motion with the speeds with which segments turn in the world limited, from the trunk to the ends; the
    hips stay. The same object is returned if nothing is faster.

    Parameters
    ----------
    planted : (F, 2) bool
        Frames in which the left and the right foot stand; their legs stay as they are.
    fastest_rad_s : (16,) float64
        Greatest speed of each segment in rad/s.
    """
    if len(clip) < 2:
        return clip
    fps, world = float(clip.fps), clip.world().rotations[:, 1:]
    if (angle(world[:-1], world[1:]) * fps <= fastest_rad_s)[:, 1:].all():
        return clip
    rotations, found = clip.rotations.copy(order="K"), {SEGMENTS[0]: world[:, 0]}
    for part, (name, parent) in list(enumerate(PARENT_OF.items()))[1:]:
        turns = quaternion.multiply(found[parent], rotations[:, part])
        found[name] = _calm(turns, ROOM * float(fastest_rad_s[part]) / fps, fps, _may_change(name, planted, fps))
        if found[name] is not turns:
            rotations[:, part] = quaternion.multiply(quaternion.conjugate(found[parent]), found[name])
    return replace(clip, rotations=quaternion.continuous(rotations))


def _may_change(name: str, planted: BoolArray, fps: float) -> FloatArray:
    """Share (F,) of a change that a segment of the body may make in each frame; 0 for legs of standing feet."""
    if name.endswith(("Leg", "Foot")):
        return free(planted[:, int(name.startswith("right"))], fps)
    return np.ones(len(planted))


def _calm(turns: FloatArray, most_rad: float, fps: float, may: FloatArray) -> FloatArray:
    """Smooth the rotations (F, 4) of a joint where they differ by more than ``most_rad`` from frame to frame. ``may``
    (F,) is the allowed share of the change, 0..1; the same object is returned if nothing is too fast.
    """
    for number in range(1, ROUNDS + 1):
        # What stays cannot be slowed down.
        fast = (angle(turns[:-1], turns[1:]) > most_rad) & ((may[:-1] > 0.0) | (may[1:] > 0.0))
        if not fast.any():
            break
        sigma = number * SMOOTH_S * fps
        wide = max(1, round(2.0 * sigma))
        result = turns.copy()
        for start, stop in runs(maximum_filter1d(np.append(fast, False), 4 * wide + 1)):
            here = slice(max(0, start - 3 * wide), stop + 3 * wide)
            some = quaternion.continuous(turns[here, None])[:, 0]
            share = np.zeros(len(some))
            share[start - here.start : stop - here.start] = 1.0
            share = gaussian_filter1d(share, 0.5 * wide, mode="nearest") * may[here]
            smooth = gaussian_filter1d(some, sigma, axis=0, mode="nearest")
            result[here] = quaternion.normalize(some + share[:, None] * (smooth - some))
        turns = quaternion.continuous(result[:, None])[:, 0]
    return turns
