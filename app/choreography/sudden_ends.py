"""Feet and hands of a dance that change their way no more suddenly than captured ones.

Time that goes faster, a foot that is put where it stood and a faded join all add to the accelerations of a capture,
twitches of its markers among them. Where an ankle, a toe, a wrist or a fingertip is accelerated by more than `MOST`
times what is usual in the capture, its path is bent as little as will do in the frames about it. Feet stay where they
stand.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

import numpy as np
from scipy.ndimage import maximum_filter1d

from app.arrays import BoolArray, FloatArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.body_speeds import runs
from app.choreography.clip import MotionClip
from app.choreography.features import height_m
from app.choreography.hands_out_of_body import ELBOW
from app.choreography.limbs import bend
from app.choreography.resample import resampled
from app.choreography.standing_feet import AHEAD, LEG, FootPlant
from app.rig import quaternion
from app.rig.skeleton import JointTransforms
from app.rig.sole import SIDES

MOST: Final = 1.25
"""Largest acceleration of an end or its joint, in those of the capture that are exceeded in one frame of a thousand."""
USUAL_PERCENTILE: Final = 99.9
AROUND_S: Final = 0.2
"""A path is bent no farther than this before and after."""
TRIES: Final = 3
"""Most times that a motion is mended: what is taken away in one place may be left over beside it."""
PASSES: Final = 4
"""Each bend of the path of one of two points moves the other a little."""
ROUNDS: Final = 400
STEP: Final = 1.0 / 16.0
"""Share of an excess that is taken away at a time: one over the largest eigenvalue of the second difference times its
transpose, with which momentum is stable."""
_ROOM: Final = 0.93
"""Paths are mended to this part of the bound, so that what follows leaves them within it."""
_ARM: Final = ("UpperArm", "LowerArm", "Hand")


@dataclass(frozen=True, eq=False)
class UsualAccelerations:
    """Accelerations of a capture at a frame rate, over the body's height, 1/s^2: all but one frame of a thousand.

    Attributes
    ----------
    feet, hands : (2,) float64
        Of ankle and toe; of wrist and fingertip.
    """

    feet: FloatArray
    hands: FloatArray


def usual_accelerations(clips: Sequence[MotionClip], fps: Fraction) -> UsualAccelerations:
    """Return what is usual in some clips, each resampled to the frame rate."""
    found = []
    for name in ("Foot", "Hand"):
        rows = [np.zeros((0, 2))]
        for one in (resampled(clip, fps) for clip in clips):
            world = one.world()
            rows += [_accelerations(_points_m(one, world, f"{side}{name}"), one) for side in SIDES]
        every = np.concatenate(rows)
        found.append(np.percentile(every, USUAL_PERCENTILE, axis=0) if len(every) else np.zeros(2))
    return UsualAccelerations(*found)


def without_twitches(clip: MotionClip, standing: Sequence[FootPlant], usual: UsualAccelerations) -> MotionClip:
    """The motion with no end that is accelerated more than by `MOST` of what is usual, where its joints allow it."""
    planted = np.zeros((len(clip), 2), bool)
    for stand in standing:
        planted[stand.start : stand.stop, stand.foot] = True
    for _ in range(TRIES):
        calmer = _calmer(clip, planted, usual)
        if calmer is clip:
            break
        clip = calmer
    return clip


def _calmer(clip: MotionClip, planted: BoolArray, usual: UsualAccelerations) -> MotionClip:
    """The motion with the places mended that are too sudden; the same value where none is."""
    world, rotations = clip.world(), clip.rotations.copy()
    nowhere = np.zeros(len(clip), bool)
    found = False
    for foot, side in enumerate(SIDES):
        legs = ("hips", *(f"{side}{part}" for part in LEG))
        found |= _calm(clip, world, legs, AHEAD, usual.feet, planted[:, foot], rotations)
        arms = ("chest", *(f"{side}{part}" for part in _ARM))
        found |= _calm(clip, world, arms, ELBOW, usual.hands, nowhere, rotations)
    return replace(clip, rotations=quaternion.continuous(rotations)) if found else clip


def _calm(
    clip: MotionClip,
    world: JointTransforms,
    limb: tuple[str, ...],
    ahead: tuple[float, float, float],
    usual: FloatArray,
    planted: BoolArray,
    rotations: FloatArray,
) -> bool:
    """Write the rotations of a limb whose end twitches, and return whether it does; ``planted`` are the frames in which
    its tip stays."""
    fps = float(clip.fps)
    most = MOST * usual * height_m(clip) / fps**2
    points = _points_m(clip, world, limb[-1])
    sudden = (np.linalg.norm(np.diff(points, 2, axis=0), axis=-1) > most).any(axis=-1)
    if not sudden.any():
        return False
    around = 2 * round(AROUND_S * fps) + 1
    end_at = 1 + SEGMENTS.index(limb[-1])
    for start, stop in runs(maximum_filter1d(np.pad(sudden, 1), around)):
        here = slice(start, stop)
        beside = slice(max(0, start - 2), min(len(clip), stop + 2))
        held = np.ones(beside.stop - beside.start, bool)
        held[start - beside.start : stop - beside.start] = False
        inside = slice(start - beside.start, stop - beside.start)
        joint, tip = _calm_points(points[beside, 0], points[beside, 1], _ROOM * most, held, planted[beside])
        was, now = (points[here, 1] - points[here, 0]), (tip - joint)[inside]
        part = JointTransforms(world.joints, world.positions_m[here], world.rotations[here].copy())
        part.rotations[:, end_at] = quaternion.multiply(
            quaternion.between(_unit(was), _unit(now)), part.rotations[:, end_at]
        )
        reached = joint[inside]
        bend(clip, part, limb, reached, ahead, rotations[here])
    return True


def _calm_points(
    joint: FloatArray, tip: FloatArray, most: FloatArray, held: BoolArray, planted: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Paths (N, 3) of the joint of a foot or a hand and of its tip, as far apart as they were: the tip's is bent first,
    then the joint's about it."""
    length = np.linalg.norm(tip - joint, axis=-1, keepdims=True)
    for _ in range(PASSES):
        calm = _bent(tip, float(most[1]), held | planted)
        joint, tip = joint + calm - tip, calm
        joint = tip - length * _unit(tip - _bent(joint, float(most[0]), held))
    return joint, tip


def _bent(path: FloatArray, most: float, held: BoolArray) -> FloatArray:
    """A path (N, 3) with second differences no longer than ``most``, by projections onto it; held places stay."""
    moved, before = np.zeros_like(path), np.zeros_like(path)
    free = ~held[:, None]
    for number in range(ROUNDS):
        # Nesterov's momentum: far fewer rounds for long stretches.
        ahead = moved + number / (number + 3.0) * (moved - before)
        change = np.diff(path + ahead, 2, axis=0)
        size = np.linalg.norm(change, axis=-1, keepdims=True)
        excess = change * np.maximum(0.0, 1.0 - most / np.maximum(size, 1e-12))
        if not number % 20 and size.max(initial=0.0) <= most * 1.001:
            break
        back = np.zeros_like(path)
        back[:-2] += excess
        back[1:-1] -= 2.0 * excess
        back[2:] += excess
        before, moved = moved, free * (ahead - STEP * back)
    return path + moved


def _points_m(clip: MotionClip, world: JointTransforms, name: str) -> FloatArray:
    """(F, 2, 3) the joint of a hand or a foot, and its end."""
    at = 1 + SEGMENTS.index(name)
    joint = world.positions_m[:, at]
    tip = joint + quaternion.rotate(world.rotations[:, at], clip.shape.ends_m[ENDS.index(name)])
    return np.stack([joint, tip], axis=1)


def _accelerations(points_m: FloatArray, clip: MotionClip) -> FloatArray:
    """(F - 2, 2) accelerations of two points over the body's height."""
    change = np.linalg.norm(np.diff(points_m, 2, axis=0), axis=-1)
    return np.asarray(change * float(clip.fps) ** 2 / height_m(clip))


def _unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-9))
