"""Limits the accelerations of feet and hands in a dance to those of captures.

Faster time, feet kept in place and blended joins increase the accelerations of a capture, including twitches of its
markers. Where an ankle, toe, wrist or fingertip is accelerated by more than `MOST` times the usual value, its path is
bent minimally in the adjacent frames. Standing feet stay in place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import BoolArray, FloatArray
from app.choreography.bent_paths import bent
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.body_speeds import runs, sudden
from app.choreography.clip import MotionClip
from app.choreography.features import height_m
from app.choreography.feet_on_floor import AHEAD, LEG, free, grounded
from app.choreography.foot_plants import FootPlant, planted_frames
from app.choreography.hands_out_of_body import ELBOW
from app.choreography.heel_changes import heels_within_changes, knees_within_changes
from app.choreography.joint_changes import feet_within_changes, hands_within_changes, within_changes
from app.choreography.joint_speeds import turns_within_speeds, within_speeds
from app.choreography.limbs import bend, smooth_share
from app.choreography.low_feet import with_feet_cleared
from app.choreography.resample import resampled
from app.rig import quaternion
from app.rig.skeleton import JointTransforms
from app.rig.sole import SIDES

MOST: Final = 1.25
"""Largest acceleration of an end or its joint relative to the value exceeded in one of a thousand captured frames."""
USUAL_PERCENTILE: Final = 99.9
AROUND_S: Final = 0.2
"""Time in seconds before and after within which a path is bent."""
TRIES: Final = 6
"""Greatest number of passes over a motion, since corrections may leave an excess beside them."""
ALTERNATIONS: Final = 4
"""Greatest number of alternations between limits of acceleration, of joints' speeds and of their changes."""
LIMB_ROUNDS: Final = 8
"""Greatest number of times that limbs which still snap are smoothed and their hands and feet calmed."""
PASSES: Final = 12
"""Greatest number of alternations between two points, since bending one path moves the other slightly."""
FOLDED: Final = (0.15, 0.3)
"""Distance of a wrist or ankle from shoulder or hip, relative to the limb's length, up to which it stays where it is,
and from which it is moved freely: the whole limb would turn with a wrist at the shoulder."""
_ROOM: Final = 0.93
"""Share of the bound to which paths are corrected, leaving a margin for later steps."""
FROM: Final = 0.9
"""Share of the usual change of a joint's speed above which a limb is smoothed."""
SMOOTHS_S: Final = 0.01
EDGES_S: Final = 0.08
"""Standard deviations in seconds of a limb's smoothing, and of how it begins and ends."""
_ARM: Final = ("UpperArm", "LowerArm", "Hand")


@dataclass(frozen=True, eq=False)
class UsualAccelerations:
    """Accelerations of a capture at a frame rate relative to the body's height, in 1/s^2, exceeded in one of a thousand
    frames.

    Attributes
    ----------
    feet, hands : (2,) float64
        Values for ankle and toe, and for wrist and fingertip.
    """

    feet: FloatArray
    hands: FloatArray


def usual_accelerations(clips: Sequence[MotionClip], fps: Fraction) -> UsualAccelerations:
    """Return the usual accelerations in clips, each resampled to the frame rate."""
    found = []
    for name in ("Foot", "Hand"):
        rows = [np.zeros((0, 2))]
        for one in (resampled(clip, fps) for clip in clips):
            world = one.world()
            rows += [_accelerations(_points_m(one, world, f"{side}{name}"), one) for side in SIDES]
        every = np.concatenate(rows)
        found.append(np.percentile(every, USUAL_PERCENTILE, axis=0) if len(every) else np.zeros(2))
    return UsualAccelerations(*found)


def within_limits(
    clip: MotionClip,
    standing: Sequence[FootPlant],
    usual: UsualAccelerations,
    usual_change_rad_s: float,
    fastest_rad_s: FloatArray | None = None,
) -> MotionClip:
    """Return the motion with joints no faster than `app.choreography.joint_speeds.within_speeds` allows and changing
    their speeds no more than usual, hands and feet accelerated as `without_twitches` allows, and soles on or above the
    floor.

    Alternating is necessary, since a joint that is slowed down accelerates its hand or foot, and the other way round.

    Parameters
    ----------
    usual_change_rad_s : float
        See `app.choreography.dance_flaws.usual_change_rad_s`.
    fastest_rad_s : (16,) float64, optional
        Greatest speed in rad/s with which each segment but the hips turns in the world; unlimited by default.
    """
    on_floor = planted_frames(standing, len(clip))
    clip = feet_within_changes(clip, on_floor, usual_change_rad_s)
    if fastest_rad_s is not None:
        clip = turns_within_speeds(clip, on_floor, fastest_rad_s)
    clip = within_speeds(clip, on_floor)
    ankle_m_s2 = MOST * float(usual.feet[0]) * height_m(clip)
    clip = _within_changes(clip, on_floor, usual_change_rad_s, ankle_m_s2)
    calm = grounded(without_twitches(clip, standing, usual), on_floor)
    # The limits of hands, feet and speeds come last and are kept exactly; they leave few changes over their own limit.
    clip = within_speeds(_within_changes(calm, on_floor, usual_change_rad_s, ankle_m_s2), on_floor)
    legs_stay = np.ones_like(on_floor)
    for number in range(ALTERNATIONS):
        # An almost straight arm snaps when its hand is calmed, and a hand that a slower shoulder carries along has to
        # be calmed again.
        calm = without_twitches(within_changes(clip, legs_stay, usual_change_rad_s), standing, usual)
        if number and calm is clip:
            break
        clip = within_speeds(grounded(calm, on_floor), on_floor)
    if fastest_rad_s is not None:
        clip = without_twitches(turns_within_speeds(clip, on_floor, fastest_rad_s), standing, usual)
    for _ in range(LIMB_ROUNDS):
        # What is left are limbs swung through straight, which snap whenever their hands or feet are calmed.
        calm = _limbs_smoothed(clip, on_floor, FROM * usual_change_rad_s)
        if calm is clip:
            break
        clip = without_twitches(calm, standing, usual)
    clip = with_feet_cleared(hands_within_changes(clip, usual_change_rad_s), standing)
    clip = heels_within_changes(clip, on_floor, usual_change_rad_s, ankle_m_s2)
    return knees_within_changes(clip, on_floor, usual_change_rad_s)


def _within_changes(clip: MotionClip, on_floor: BoolArray, most_rad_s: float, ankle_m_s2: float) -> MotionClip:
    """Limit how much the speeds of joints change: by bending legs in the air, then by heels, and what is left by
    bending legs until they land.
    """
    clip = heels_within_changes(within_changes(clip, on_floor, most_rad_s), on_floor, most_rad_s, ankle_m_s2)
    return within_changes(clip, on_floor, most_rad_s, lands_s=0.0)


def _limbs_smoothed(clip: MotionClip, on_floor: BoolArray, most_rad_s: float) -> MotionClip:
    """Smooth the rotations of arms, and of legs in the air, slightly about the frames in which the angular velocity of
    one of their joints changes by more than ``most_rad_s`` from frame to frame; the same object if there are none.
    """
    fps, rotations = float(clip.fps), clip.rotations
    around, snaps = 2 * round(AROUND_S * fps) + 1, sudden(rotations, most_rad_s / fps)
    for foot, side in enumerate(SIDES):
        for limb in (LEG, _ARM):
            first = SEGMENTS.index(f"{side}{limb[0]}")
            part = slice(first, first + len(limb))
            if not snaps[:, part].any():
                continue
            may = free(on_floor[:, foot], fps) if limb is LEG else np.ones(len(clip))
            swung = snaps[:, part].any(axis=1) & (may > 0.0)
            if not swung.any():
                continue
            near = gaussian_filter1d(maximum_filter1d(swung.astype(np.float64), around), EDGES_S * fps)
            rotations = rotations.copy(order="K") if rotations is clip.rotations else rotations
            for here in (slice(*run) for run in runs(near > 0.0)):
                turns = quaternion.continuous(clip.rotations[here, part])
                smooth = gaussian_filter1d(turns, SMOOTHS_S * fps, axis=0, mode="nearest")
                share = (may[here] * near[here])[:, None, None]
                rotations[here, part] = quaternion.normalize(turns + share * (smooth - turns))
    return clip if rotations is clip.rotations else replace(clip, rotations=quaternion.continuous(rotations))


def without_twitches(clip: MotionClip, standing: Sequence[FootPlant], usual: UsualAccelerations) -> MotionClip:
    """Limit the accelerations of hands and feet to `MOST` times the usual ones, as far as joints allow."""
    planted = planted_frames(standing, len(clip))
    for _ in range(TRIES):
        calmer = _calmer(clip, planted, usual)
        if calmer is clip:
            break
        clip = calmer
    return clip


def _calmer(clip: MotionClip, planted: BoolArray, usual: UsualAccelerations) -> MotionClip:
    """Smooth too sudden changes of speed; the same object is returned if there are none."""
    world, rotations = clip.world(), clip.rotations.copy(order="K")
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
    """Smooth a limb whose end moves too suddenly, in place in ``rotations``, and return whether anything changed;
    ``planted`` are the frames in which the end must not move.
    """
    fps = float(clip.fps)
    most = MOST * usual * height_m(clip) / fps**2
    points = _points_m(clip, world, limb[-1])
    jerks = (np.linalg.norm(np.diff(points, 2, axis=0), axis=-1) > most).any(axis=-1)
    if not jerks.any():
        return False
    around = 2 * round(AROUND_S * fps) + 1
    end_at = 1 + SEGMENTS.index(limb[-1])
    length_m = sum(float(np.linalg.norm(clip.shape.offsets_m[SEGMENTS.index(name)])) for name in limb[2:])
    from_root_m = np.linalg.norm(points[:, 0] - world.positions_m[:, 1 + SEGMENTS.index(limb[1])], axis=-1)
    unfolded = smooth_share(from_root_m / length_m, FOLDED)
    changed = False
    for start, stop in runs(maximum_filter1d(np.pad(jerks, 1), around)):
        here = slice(start, stop)
        beside = slice(max(0, start - 2), min(len(clip), stop + 2))
        held = np.ones(beside.stop - beside.start, bool)
        held[start - beside.start : stop - beside.start] = False
        inside = slice(start - beside.start, stop - beside.start)
        joint, tip = _calm_points(points[beside, 0], points[beside, 1], _ROOM * most, held, planted[beside])
        way = (1.0 - unfolded[beside, None]) * (points[beside, 0] - joint)
        joint, tip = joint + way, tip + way
        if _suddenness(np.stack([joint, tip], axis=1), most) >= _suddenness(points[beside], most):
            # Between two stands in quick succession a calmer path may not exist.
            continue
        changed = True
        was, now = (points[here, 1] - points[here, 0]), (tip - joint)[inside]
        part = JointTransforms(world.joints, world.positions_m[here], world.rotations[here].copy())
        part.rotations[:, end_at] = quaternion.multiply(
            quaternion.between(_unit(was), _unit(now)), part.rotations[:, end_at]
        )
        reached = joint[inside]
        bend(clip, part, limb, reached, ahead, rotations[here])
    return changed


def _suddenness(points: FloatArray, most: FloatArray) -> float:
    """Largest acceleration (second difference) of the paths (N, 2, 3) of a joint and its tip, relative to the allowed
    ones.
    """
    return float((np.linalg.norm(np.diff(points, 2, axis=0), axis=-1) / most).max(initial=0.0))


def _calm_points(
    joint: FloatArray, tip: FloatArray, most: FloatArray, held: BoolArray, planted: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Smooth the paths (N, 3) of the joint of a hand or foot and of its tip, keeping their distance: first the tip's
    path is bent, then the joint's, and each moves the other along.
    """
    length, free = np.linalg.norm(tip - joint, axis=-1, keepdims=True), ~planted[:, None]
    for _ in range(PASSES):
        calm = bent(tip, float(most[1]), held | planted)
        joint, tip = joint + calm - tip, calm
        calm, along = bent(joint, float(most[0]), held), _unit(tip - joint)
        # The distance between joint and tip is constant, so along the hand or foot both move together.
        tip = tip + free * along * np.sum((calm - joint) * along, axis=-1, keepdims=True)
        joint = tip - length * _unit(tip - calm)
        if _suddenness(np.stack([joint, tip], axis=1), most) <= 1.01:
            break
    return joint, tip


def _points_m(clip: MotionClip, world: JointTransforms, name: str) -> FloatArray:
    """World positions (F, 2, 3) of the joint of a hand or foot and of its end."""
    at = 1 + SEGMENTS.index(name)
    joint = world.positions_m[:, at]
    tip = joint + quaternion.rotate(world.rotations[:, at], clip.shape.ends_m[ENDS.index(name)])
    return np.stack([joint, tip], axis=1)


def _accelerations(points_m: FloatArray, clip: MotionClip) -> FloatArray:
    """Accelerations (F - 2, 2) of two points, relative to the body's height, in 1/s^2."""
    change = np.linalg.norm(np.diff(points_m, 2, axis=0), axis=-1)
    return np.asarray(change * float(clip.fps) ** 2 / height_m(clip))


def _unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-9))
