"""Moves the ends of legs and arms of a motion to given positions, and limits the bend of knees and elbows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.rig import quaternion
from app.rig.ik import SOFT_SHARE
from app.rig.skeleton import JointTransforms
from app.rig.sole import SIDES

STRAIGHT: Final = 0.03
BENT: Final = 0.09
"""Limits of the bend of a nearly straight knee, relative to the leg's length."""
STRETCHED_RAD: Final = 0.15
"""Greatest angle in radians of a knee that would bend backwards, as in a blend of two motions."""
FOLDED_RAD: Final = 2.6
"""Angle in radians that the bend of a knee exceeds by at most `STRETCHED_RAD`, also in a blend of a kick."""
WRIST_RAD: Final = 1.5
"""Angle in radians between hand and forearm from the T-pose, with the pronation of the forearm: 1.1 to 1.5 in captures,
more where two of them are blended."""
SIDEWAYS_RAD: Final = (0.05, 0.04)
"""Angle in radians of a shank from the plane in which its knee bends that is unchanged, and the most that a greater one
exceeds it by; 0 to 0.07 in captures.
"""
CLEAR: Final = (0.1, 0.3)
"""Sine of a knee's bend below which its plane is unknown, and above which it is certain."""
_ACROSS: Final = (1.0, 0.0, 0.0)
HINGES: Final = {
    "leftLowerLeg": _ACROSS,
    "rightLowerLeg": _ACROSS,
    "leftLowerArm": (0.0, -1.0, 0.0),
    "rightLowerArm": (0.0, 1.0, 0.0),
}
"""Segments beyond a knee or an elbow, each with the axis about which it bends, in the T-pose."""


def hinge_ranges(clips: Sequence[MotionClip]) -> FloatArray:
    """Return the least and greatest bend (4, 2) in radians of each of `HINGES`: those of people, or of the clips if
    these go beyond."""
    ranges = np.tile((0.0, FOLDED_RAD), (len(HINGES), 1))
    for at, (name, axis) in enumerate(HINGES.items()):
        if name.endswith("LowerArm"):
            for clip in clips:
                bent = quaternion.twist_angle(clip.rotations[:, SEGMENTS.index(name)], axis)
                ranges[at] = min(ranges[at, 0], float(bent.min())), max(ranges[at, 1], float(bent.max()))
    return ranges


def within_hinges(rotations: FloatArray, captured: FloatArray, ranges: FloatArray) -> FloatArray:
    """Return rotations (F, 16, 4) with knees and elbows bent within their ranges, exceeded softly by at most
    `STRETCHED_RAD`.

    Parameters
    ----------
    captured : (F, 16, 4) float64
        Rotations before they were changed; a bend beyond half a turn is continued from theirs.
    ranges : (4, 2) float64
        See `hinge_ranges`.
    """
    result, every = rotations.copy(order="K"), _bends_rad(rotations)
    within = (ranges[:, 0] <= every.min(axis=0)) & (every.max(axis=0) <= ranges[:, 1])
    for hinge in np.flatnonzero(~within).tolist():
        name, axis = list(HINGES.items())[hinge]
        at, turned, (least, most) = SEGMENTS.index(name), every[:, hinge], ranges[hinge]
        usual = quaternion.twist_angle(captured[:, at], axis)
        off = turned - usual
        # The deviation fades out: at the end it is less than half a turn.
        off = np.unwrap(((off + np.pi) % (2.0 * np.pi) - np.pi)[::-1])[::-1]
        bent = usual + off
        back = softly_within(bent, float(least), float(most)) - bent
        if back.any():
            turn = quaternion.from_rotation_vector(back[:, None] * np.array(axis))
            result[:, at] = quaternion.multiply(turn, result[:, at])
    return result


def beyond_hinges(rotations: FloatArray, ranges: FloatArray) -> BoolArray:
    """Return in which frames (F,) a knee or elbow is bent beyond its range; see `within_hinges`."""
    bends = _bends_rad(rotations)
    return np.asarray(((bends < ranges[:, 0]) | (bends > ranges[:, 1])).any(axis=1))


def _bends_rad(rotations: FloatArray) -> FloatArray:
    """Return the angles (F, 4) in radians by which knees and elbows are bent."""
    return quaternion.twist_angle(rotations[:, [SEGMENTS.index(name) for name in HINGES]], list(HINGES.values()))


def softly_within(values: FloatArray, least: float, most: float) -> FloatArray:
    """Return values that exceed a range by at most `STRETCHED_RAD`, smoothly."""
    under, over = np.minimum(values - least, 0.0), np.minimum(most - values, 0.0)
    inside = values - under + over
    return np.asarray(inside + STRETCHED_RAD * (np.expm1(under / STRETCHED_RAD) - np.expm1(over / STRETCHED_RAD)))


def wrists_within(clip: MotionClip) -> MotionClip:
    """Return the motion with hands turned relative to forearms by at most `WRIST_RAD`, exceeded softly by at most
    `STRETCHED_RAD`; the same object if none is.
    """
    hands = [SEGMENTS.index(f"{side}Hand") for side in SIDES]
    turned = quaternion.to_rotation_vector(clip.rotations[:, hands])
    angles = np.linalg.norm(turned, axis=-1, keepdims=True)
    if angles.max(initial=0.0) <= WRIST_RAD:
        return clip
    rotations = clip.rotations.copy(order="K")
    share = softly_within(angles, 0.0, WRIST_RAD) / np.maximum(angles, 1e-9)
    rotations[:, hands] = quaternion.from_rotation_vector(share * turned)
    return replace(clip, rotations=quaternion.continuous(rotations))


def unbroken(clip: MotionClip) -> MotionClip:
    """Return the motion with knees limited, so that they neither bend backwards nor so far that the shank enters the
    thigh.
    """
    rotations = clip.rotations.copy(order="K")
    for side in SIDES:
        shank = rotations[:, SEGMENTS.index(f"{side}LowerLeg")]
        bent_rad = quaternion.twist_angle(shank, _ACROSS)
        # A negative bend of more than 90 degrees is a knee folded past 180 degrees, not one that bends backwards.
        bent_rad = np.where(bent_rad < -0.5 * np.pi, bent_rad + 2.0 * np.pi, bent_rad)
        back_rad = softly_within(bent_rad, 0.0, FOLDED_RAD) - bent_rad
        back = quaternion.columns(*(back_rad * axis for axis in _ACROSS))
        shank[:] = quaternion.multiply(shank, quaternion.from_rotation_vector(back))
    return replace(clip, rotations=quaternion.continuous(rotations))


def hinged(clip: MotionClip) -> MotionClip:
    """Return the motion with thighs rotated about their length so that knees bend about their hinges and not sideways,
    also where legs were placed apart from their thighs. Joints stay where they are, and feet keep their rotations.
    """
    world, rotations = clip.world(), clip.rotations.copy(order="K")
    for side in SIDES:
        thigh_at, shank_at, foot_at = (1 + SEGMENTS.index(f"{side}{part}") for part in ("UpperLeg", "LowerLeg", "Foot"))
        along = _unit(clip.shape.offsets_m[shank_at - 1])
        way = quaternion.rotate(
            quaternion.conjugate(world.rotations[:, thigh_at]),
            _unit(world.positions_m[:, foot_at] - world.positions_m[:, shank_at]),
        )
        aside, back = way[:, 0], np.linalg.norm(way - way @ along[:, None] * along, axis=1)
        least, more = SIDEWAYS_RAD
        over = np.maximum(np.arcsin(np.clip(np.abs(aside), 0.0, 1.0)) - least, 0.0)
        if not over.any():
            continue
        kept = np.where(over > 0.0, np.sin(least - more * np.expm1(-over / more)), np.abs(aside))
        wide = np.maximum(back, 1e-9)
        off = np.arcsin(np.clip(np.abs(aside) / wide, 0.0, 1.0))
        ahead, bent = way[:, 2] > 0.0, back > CLEAR[1]
        # A bent knee that points ahead has turned sideways by more than a quarter; a straight one is stretched too far.
        off = np.where(ahead & bent & (over > 0.0), np.pi - off, off)
        turn = off - np.arcsin(np.clip(kept / wide, 0.0, 1.0))
        turn *= smooth_share(back, CLEAR) * np.sign(aside) * np.where(ahead & ~bent, -1.0, 1.0)
        twist = quaternion.from_rotation_vector(quaternion.columns(*(turn * axis for axis in along)))
        thigh = quaternion.multiply(world.rotations[:, thigh_at], twist)
        rotations[:, thigh_at - 1] = quaternion.multiply(rotations[:, thigh_at - 1], twist)
        back_in_place = quaternion.between(way, quaternion.rotate(quaternion.conjugate(twist), way))
        shank = quaternion.multiply(back_in_place, rotations[:, shank_at - 1])
        rotations[:, shank_at - 1] = shank
        rotations[:, foot_at - 1] = quaternion.multiply(
            quaternion.conjugate(quaternion.multiply(thigh, shank)), world.rotations[:, foot_at]
        )
    return replace(clip, rotations=quaternion.continuous(rotations))


def bend(
    clip: MotionClip,
    world: JointTransforms,
    limb: tuple[str, ...],
    ankle: FloatArray,
    ahead: tuple[float, float, float],
    rotations: FloatArray,
) -> None:
    """Rotate thigh and shank, or upper and lower arm, minimally so that the ankle or wrist reaches a place.

    The foot keeps its rotation in the world, the knee stays in its plane, and a leg whose ankle is in place is
    unchanged. Arms are treated equally.

    Parameters
    ----------
    world : JointTransforms
        World transforms of the limb in the clip.
    limb : tuple of str
        Names of the segments: parent of the limb, its two parts, and its foot or hand.
    ankle : (F, 3) float64
        Position that the ankle or wrist must reach.
    ahead : 3 floats
        Direction in which the knee of a straight leg points, in the axes of the limb's upper part.
    rotations : (F, 16, 4) float64
        Array that receives the limb's new rotations.
    """
    hip_at, thigh_at, shank_at, foot_at = (1 + SEGMENTS.index(name) for name in limb)
    (hip, thigh), (knee, shank), (was, foot) = (world.of(at) for at in (thigh_at, shank_at, foot_at))
    upper, lower = (float(np.linalg.norm(clip.shape.offsets_m[at - 1])) for at in (shank_at, foot_at))
    line = ankle - hip
    requested = np.linalg.norm(line, axis=-1)
    natural = np.linalg.norm(was - hip, axis=-1)
    distance = np.maximum(_softly(requested, upper + lower), np.minimum(requested, natural))
    distance = np.maximum(distance, abs(upper - lower) + 1e-4)
    way = line / np.maximum(requested, 1e-9)[:, None]
    # The knee keeps its offset from the line between hip and ankle, and its plane rotates with that line. A leg that is
    # straight or slightly overextended has no such plane, so its knee points forward from the thigh. The thigh's
    # direction rotates with the line too, so that it stays across it: in a kick it would otherwise point down along the
    # leg.
    before = (was - hip) / np.maximum(natural, 1e-9)[:, None]
    off = knee - hip - before * np.einsum("fi,fi->f", knee - hip, before)[:, None]
    swung = quaternion.between(before, way)
    carried = quaternion.rotate(swung, off)
    points = quaternion.rotate(quaternion.multiply(swung, thigh), np.array(ahead))
    forward = _unit(points - way * np.einsum("fi,fi->f", points, way)[:, None])
    bent = np.linalg.norm(carried, axis=-1, keepdims=True) / (upper + lower)
    share = smooth_share(bent, (STRAIGHT, BENT))
    pole = _unit(share * _unit(carried) + (1.0 - share) * forward)
    along = (upper * upper - lower * lower + distance * distance) / (2.0 * distance)
    aside = np.sqrt(np.maximum(upper * upper - along * along, 0.0))
    new_knee = way * along[:, None] + pole * aside[:, None]
    new_thigh = quaternion.multiply(quaternion.between(_unit(knee - hip), _unit(new_knee)), thigh)
    new_shank = quaternion.multiply(
        quaternion.between(_unit(was - knee), _unit(way * distance[:, None] - new_knee)), shank
    )
    rotations[:, thigh_at - 1] = quaternion.multiply(quaternion.conjugate(world.of(hip_at)[1]), new_thigh)
    rotations[:, shank_at - 1] = quaternion.multiply(quaternion.conjugate(new_thigh), new_shank)
    rotations[:, foot_at - 1] = quaternion.multiply(quaternion.conjugate(new_shank), foot)


def smooth_share(values: FloatArray, bounds: tuple[float, float]) -> FloatArray:
    """Return a share that rises smoothly from 0 at the first bound to 1 at the second."""
    share = np.clip((values - bounds[0]) / (bounds[1] - bounds[0]), 0.0, 1.0)
    return np.asarray(share * share * (3.0 - 2.0 * share))


def _unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-9))


def _softly(distance: FloatArray, longest: float) -> FloatArray:
    """Limit distances (F,) from hip to ankle softly to ``longest``, so that the knee does not snap."""
    band = SOFT_SHARE * longest
    over = np.maximum(distance - (longest - band), 0.0)
    return np.asarray(np.where(over > 0.0, longest - band * np.exp(-over / band), distance))
