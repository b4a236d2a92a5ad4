"""Moves the ends of legs and arms of a motion to given positions, and limits knees."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
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
_ACROSS: Final = (1.0, 0.0, 0.0)


def unbroken(clip: MotionClip) -> MotionClip:
    """Return the motion with knees limited, so that they neither bend backwards nor so far that the shank enters the
    thigh.
    """
    rotations = clip.rotations.copy()
    for side in SIDES:
        shank = rotations[:, SEGMENTS.index(f"{side}LowerLeg")]
        bent_rad = quaternion.twist_angle(shank, _ACROSS)
        # A knee that is bent by more than half a turn is no knee that bends backwards by nearly as much.
        bent_rad = np.where(bent_rad < -0.5 * np.pi, bent_rad + 2.0 * np.pi, bent_rad)
        behind_rad, beyond_rad = np.minimum(bent_rad, 0.0), np.minimum(FOLDED_RAD - bent_rad, 0.0)
        back_rad = STRETCHED_RAD * (np.expm1(behind_rad / STRETCHED_RAD) - np.expm1(beyond_rad / STRETCHED_RAD))
        back_rad += beyond_rad - behind_rad
        shank[:] = quaternion.multiply(shank, quaternion.from_rotation_vector(back_rad[:, None] * np.array(_ACROSS)))
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
        World transforms of the clip.
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
    hip, knee, was = (world.positions_m[:, at] for at in (thigh_at, shank_at, foot_at))
    thigh, shank, foot = (world.rotations[:, at] for at in (thigh_at, shank_at, foot_at))
    upper, lower = (float(np.linalg.norm(clip.shape.offsets_m[at - 1])) for at in (shank_at, foot_at))
    line = ankle - hip
    requested = np.linalg.norm(line, axis=-1)
    natural = np.linalg.norm(was - hip, axis=-1)
    distance = np.maximum(_softly(requested, upper + lower), np.minimum(requested, natural))
    distance = np.maximum(distance, abs(upper - lower) + 1e-4)
    way = line / np.maximum(requested, 1e-9)[:, None]
    # The knee stays off the line from hip to ankle where it was, whose plane turns with the line alone; of a leg that
    # is straight, or a little more than straight, it goes where the thigh faces, for there is no plane to keep. So that
    # the thigh always faces across the line, it turns with it too: a leg that kicks would face along a line downwards.
    before = (was - hip) / np.maximum(natural, 1e-9)[:, None]
    off = knee - hip - before * np.einsum("fi,fi->f", knee - hip, before)[:, None]
    swung = quaternion.between(before, way)
    carried = quaternion.rotate(swung, off)
    points = quaternion.rotate(quaternion.multiply(swung, thigh), np.array(ahead))
    forward = _unit(points - way * np.einsum("fi,fi->f", points, way)[:, None])
    bent = np.linalg.norm(carried, axis=-1, keepdims=True) / (upper + lower)
    share = np.clip((bent - STRAIGHT) / (BENT - STRAIGHT), 0.0, 1.0)
    share = share * share * (3.0 - 2.0 * share)
    pole = _unit(share * _unit(carried) + (1.0 - share) * forward)
    along = (upper * upper - lower * lower + distance * distance) / (2.0 * distance)
    aside = np.sqrt(np.maximum(upper * upper - along * along, 0.0))
    new_knee = way * along[:, None] + pole * aside[:, None]
    new_thigh = quaternion.multiply(quaternion.between(_unit(knee - hip), _unit(new_knee)), thigh)
    new_shank = quaternion.multiply(
        quaternion.between(_unit(was - knee), _unit(way * distance[:, None] - new_knee)), shank
    )
    rotations[:, thigh_at - 1] = quaternion.multiply(quaternion.conjugate(world.rotations[:, hip_at]), new_thigh)
    rotations[:, shank_at - 1] = quaternion.multiply(quaternion.conjugate(new_thigh), new_shank)
    rotations[:, foot_at - 1] = quaternion.multiply(quaternion.conjugate(new_shank), foot)


def _unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-9))


def _softly(distance: FloatArray, longest: float) -> FloatArray:
    """Limit distances (F,) from hip to ankle softly to ``longest``, so that the knee does not snap."""
    band = SOFT_SHARE * longest
    over = np.maximum(distance - (longest - band), 0.0)
    return np.asarray(np.where(over > 0.0, longest - band * np.exp(-over / band), distance))
