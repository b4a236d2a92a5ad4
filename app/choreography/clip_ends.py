"""Detection of rest poses and idle standing at the beginning and end of a capture.

Many files begin or end with their rest pose or a T-pose, for a frame or for seconds, which the body leaves within a
frame or by lowering its arms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.body_speeds import angle, runs
from app.choreography.clip import MotionClip
from app.choreography.cuts import LONGEST_REST_S
from app.rig import quaternion

HELD_RAD: Final = 0.05
HELD_M: Final = 0.02
"""Greatest distance in metres of segments and place from a held pose."""
JUMP_RAD_S: Final = 20.0
JUMP_M_S: Final = 8.0
"""Speed in metres per second above which a body that leaves the initial pose or place was moved artificially."""
LEAD_S: Final = 0.15
"""Longest time in seconds of filter oscillations after such a jump."""
AFTER_S: Final = 0.5
CALM: Final = 2.0
CALM_RAD_S: Final = 1.0
"""Speed below which the oscillations have ended: multiple of the median speed of the following time, or this value."""
T_POSE_RAD: Final = 0.5
"""Angle in radians from the T-pose within which trunk, arms and legs count as in it."""
EXACT_RAD: Final = 0.02
"""Same angle for an artificial T-pose."""
STILL_RAD_S: Final = 0.35
STILL_M_S: Final = 0.12
"""Speed in metres per second of trunk and limbs over `STILL_OVER_S` below which a body stands; hands, feet and head may
move.
"""
STILL_OVER_S: Final = 0.2
T_POSE_S: Final = 0.1
"""Least duration in seconds of a T-pose, in addition to `STILL_OVER_S`, unless it is left by a jump."""
LOWERS_S: Final = 1.5
"""Time in seconds within which arms are lowered from it."""
DOWN_RAD: Final = 0.8
SLOWER: Final = 0.5
"""Share of their greatest speed below which lowered arms have arrived."""
IDLE_S: Final = 1.0
"""Time in seconds of standing at an end from which the body is idle."""
REST_S: Final = LONGEST_REST_S
"""Time in seconds of the standing that is kept as a rest of the dance."""
LEAST_S: Final = 1.0
"""Least length in seconds of the remaining clip; otherwise nothing is cut."""

_TRUNK: Final = ("hips", "spine", "chest")
_LIMBS: Final = tuple(
    f"{side}{part}" for side in ("left", "right") for part in ("UpperArm", "LowerArm", "UpperLeg", "LowerLeg")
)
_ABOUT: Final = {"hips": (0.0, 1.0, 0.0)} | {
    limb: (1.0, 0.0, 0.0) if limb.endswith("Arm") else (0.0, 1.0, 0.0) for limb in _LIMBS
}
"""Axes about which parts of the T-pose may be rotated."""
_BODY: Final = [SEGMENTS.index(name) for name in (*_TRUNK, *_LIMBS)]


def proper(clip: MotionClip) -> tuple[int, int]:
    """Return the frames (start, stop) of the actual motion, without rest poses at the ends; all frames if nothing
    moves.
    """
    start, stop = _lead(clip), len(clip) - _lead(_backwards(clip))
    return (start, stop) if (stop - start) / float(clip.fps) >= LEAST_S else (0, len(clip))


def idle(clip: MotionClip) -> tuple[int, int]:
    """Count the frames at the start and at the end of a clip in which the body only stands idle; a short rest next to
    the motion is not counted.
    """
    over_s, rest = IDLE_S * float(clip.fps), round(REST_S * float(clip.fps))
    start, stop = (_first_run(_still(one)) for one in (clip, _backwards(clip)))
    if max(start, stop) >= len(clip) - 1:
        return 0, 0
    return start - rest if start >= over_s else 0, stop - rest if stop >= over_s else 0


def _backwards(clip: MotionClip) -> MotionClip:
    return replace(clip, hips_m=clip.hips_m[::-1], rotations=clip.rotations[::-1])


def _lead(clip: MotionClip) -> int:
    """Number of frames before the actual motion begins."""
    poses = angle(clip.rotations, clip.rotations[:1]).max(axis=1)
    places = np.linalg.norm(clip.hips_m - clip.hips_m[0], axis=1)
    left = np.flatnonzero((poses > HELD_RAD) | (places > HELD_M))
    if not len(left):
        return 0
    frame = int(left[0]) - 1
    if (settled := _settled(clip, frame)) > frame:
        return settled
    fps = float(clip.fps)
    in_t_pose = _in_t_pose(clip) & _still(clip)
    t_pose = _first_run(in_t_pose)
    if t_pose and (settled := _settled(clip, t_pose - 1)) > t_pose:
        return settled
    # A T-pose that also occurs in the middle of the clip is a part of the dance.
    taken = [stop for start, stop in runs(in_t_pose) if stop - start >= T_POSE_S * fps and start]
    danced = any(stop < len(clip) - LOWERS_S * fps for stop in taken)
    if danced or t_pose < T_POSE_S * fps:
        # No dancer takes the pose exactly, so a clip that begins exactly in it was blended with its rest pose.
        exact = _in_t_pose(clip.span(0, 1), EXACT_RAD).any() and not danced
        return _arms_down(clip, max(t_pose, 1)) if exact else 0
    return _arms_down(clip, t_pose)


def _settled(clip: MotionClip, frame: int) -> int:
    """If the clip leaves a pose at ``frame`` by a jump, return the frame from which the motion is regular again;
    otherwise ``frame``.
    """
    fps = float(clip.fps)
    steps, later = round(LEAD_S * fps), round((LEAD_S + AFTER_S) * fps)
    some = clip.rotations[frame : frame + later + 1]
    ways = np.linalg.norm(np.diff(clip.hips_m[frame : frame + later + 1], axis=0), axis=1)
    turned = angle(some[:-1], some[1:]).max(axis=1, initial=0.0)
    speeds = fps * np.maximum(turned, ways * (JUMP_RAD_S / JUMP_M_S))
    fast = np.flatnonzero(speeds[:2] > JUMP_RAD_S)
    if not len(fast):
        return frame
    # Files are often smoothed together with their rest pose: after the jump the body still decelerates and swings.
    usual = CALM * float(np.median(speeds[steps:])) if len(speeds) > steps else JUMP_RAD_S
    wild = np.flatnonzero(speeds[:steps] > max(usual, CALM_RAD_S))
    return frame + (int(wild[-1]) if len(wild) else int(fast[-1])) + 1


def _in_t_pose(clip: MotionClip, within_rad: float = T_POSE_RAD) -> BoolArray:
    return np.asarray(_off_t_pose(clip.rotations, _BODY).max(axis=1) < within_rad)


def _off_t_pose(rotations: FloatArray, segments: Sequence[int]) -> FloatArray:
    """Angles (F, S) of S segments from the T-pose in radians. Turns of the hips about +Y and twists of limbs are
    ignored, since the facing is no part of a pose and twists of straight limbs are unknown.
    """
    found = np.zeros((len(rotations), len(segments)))
    for at, segment in enumerate(segments):
        turns = rotations[:, segment]
        if (axis := _ABOUT.get(SEGMENTS[segment])) is not None:
            turns = quaternion.swing_twist(turns, axis)[0]
        found[:, at] = angle(turns, quaternion.IDENTITY)
    return found


def _still(clip: MotionClip) -> BoolArray:
    """Mask (F,) of the frames after which a body hardly moves for `STILL_OVER_S`."""
    over = max(1, round(STILL_OVER_S * float(clip.fps)))
    later = np.minimum(np.arange(len(clip)) + over, len(clip) - 1)
    turns = angle(clip.rotations[:, _BODY], clip.rotations[later][:, _BODY]).max(axis=1)
    ways = np.linalg.norm(clip.hips_m - clip.hips_m[later], axis=1)
    return np.asarray((turns < STILL_RAD_S * STILL_OVER_S) & (ways < STILL_M_S * STILL_OVER_S))


def _first_run(of: BoolArray) -> int:
    """Return the number of initial frames in which a condition is true."""
    spans = runs(of)
    return spans[0][1] if spans and spans[0][0] == 0 else 0


def _arms_down(clip: MotionClip, frame: int) -> int:
    """Return the frame at which both arms, after being lowered from the T-pose, slow down; 0 if they are
    not lowered.
    """
    fps = float(clip.fps)
    arms = [SEGMENTS.index("leftUpperArm"), SEGMENTS.index("rightUpperArm")]
    some = clip.rotations[frame : frame + round(LOWERS_S * fps) + 1, arms]
    if len(some) < 3:
        return 0
    speeds = angle(some[:-1], some[1:]).max(axis=1)
    down = _off_t_pose(clip.rotations[frame : frame + len(some) - 1], arms).min(axis=1) > DOWN_RAD
    slower = np.flatnonzero(down & (speeds < SLOWER * np.maximum.accumulate(speeds)))
    return frame + int(slower[0]) if len(slower) else frame * int(down.any())
