"""Keeps hands out of the body: an arm whose hand would enter trunk, head or thighs is bent away.

The body is a few capsules, since only segments are known; the depth of a hand is smoothed over time, so that it moves
around the body without snapping to its surface.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import FloatArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.features import height_m
from app.choreography.limbs import bend
from app.rig import quaternion
from app.rig.skeleton import JointTransforms

CAPSULES: Final = (
    ("hips", "chest", 0.060),
    ("chest", "head", 0.058),
    ("leftUpperLeg", "leftLowerLeg", 0.035),
    ("rightUpperLeg", "rightLowerLeg", 0.035),
    ("head", "crown", 0.050),
)
"""Joints at the ends of each capsule, and its radius relative to the body's height: captured wrists are nearer to the
middle in only one of a hundred frames.
"""
ALONG: Final = (0.0, 0.5, 1.0)
"""Examined points of a hand, from the wrist (0) to the fingertips (1)."""
AHEAD_M: Final = 0.03
"""Distance in metres that a point in the middle of the body is pushed to the front."""
SMOOTH_S: Final = 0.08
"""Standard deviation in seconds of the smoothing of the push's distance."""
TURNS_S: Final = 0.16
"""Time in seconds over which the push's direction is smoothed, so that a hand crossing the body does not jump."""
PASSES: Final = 2
"""Number of passes, since a hand pushed out of one part may enter another."""
LEAST_M: Final = 0.002
NEAR_M: Final = 0.001
"""Margin in metres for rounding when distant hands are skipped."""
ELBOW: Final = (0.0, 0.0, -1.0)
"""Direction of an elbow, in the frame of the upper arm."""


def out_of_body(clip: MotionClip) -> MotionClip:
    """Bend arms so that no hand is inside the body; the same object is returned if none was."""
    for _ in range(PASSES):
        clip = _pushed(clip)
    return clip


def _pushed(clip: MotionClip) -> MotionClip:
    world = clip.world()
    pushes = {side: _push_m(clip, world, side) for side in ("left", "right")}
    if not any(push.any() for push in pushes.values()):
        return clip
    rotations = clip.rotations.copy(order="K")
    for side, push in pushes.items():
        limb = ("chest", *(f"{side}{part}" for part in ("UpperArm", "LowerArm", "Hand")))
        wrist = world.positions_m[:, 1 + SEGMENTS.index(limb[-1])]
        moved = np.flatnonzero(push.any(axis=1))
        if len(moved):
            here = slice(int(moved[0]), int(moved[-1]) + 1)
            part = JointTransforms(world.joints, world.positions_m[here], world.rotations[here])
            bend(clip, part, limb, (wrist + push)[here], ELBOW, rotations[here])
    return replace(clip, rotations=quaternion.continuous(rotations))


def depths_m(clip: MotionClip) -> FloatArray:
    """Return the depth (F, 2) in metres of the left and right hand in the body; 0 outside."""
    world = clip.world()
    return np.stack([np.linalg.norm(_deepest_m(clip, world, side), axis=1) for side in ("left", "right")], axis=1)


def _push_m(clip: MotionClip, world: JointTransforms, side: str) -> FloatArray:
    """Displacement (F, 3) in metres that moves a hand out of the body, smooth over time and at least the
    hand's depth.
    """
    fps = float(clip.fps)
    deepest = _deepest_m(clip, world, side)
    depth = np.linalg.norm(deepest, axis=1)
    if depth.max(initial=0.0) < LEAST_M:
        return np.zeros_like(deepest)
    width = 2 * round(2.0 * SMOOTH_S * fps) + 1
    size = gaussian_filter1d(maximum_filter1d(depth, width, mode="nearest"), SMOOTH_S * fps, mode="nearest")
    way = gaussian_filter1d(deepest, TURNS_S * fps, axis=0, mode="nearest", truncate=8.0)
    length = np.linalg.norm(way, axis=1)
    push = way * (size / np.maximum(length, 1e-9))[:, None]
    return np.asarray(np.where((size > 1e-5)[:, None], push, 0.0))


def _deepest_m(clip: MotionClip, world: JointTransforms, side: str) -> FloatArray:
    """Shortest vector (F, 3) in metres that moves the deepest point of a hand out of the body; 0 if the hand is
    outside.
    """
    hand = 1 + SEGMENTS.index(f"{side}Hand")
    along = quaternion.rotate(world.rotations[:, hand], clip.shape.ends_m[ENDS.index(f"{side}Hand")])
    ahead = quaternion.rotate(world.rotations[:, 1 + SEGMENTS.index("chest")], np.array((0.0, 0.0, AHEAD_M)))
    length_m = float(np.linalg.norm(clip.shape.ends_m[ENDS.index(f"{side}Hand")]))
    result, depths = np.zeros((len(clip), 3)), np.zeros(len(clip))
    for first, last, part in CAPSULES:
        radius = part * height_m(clip)
        start, end = (_place_m(clip, world, name) for name in (first, last))
        wrist = world.positions_m[:, hand]
        # If the wrist is farther from the capsule than this, so is the whole hand.
        near = np.flatnonzero(np.linalg.norm(_away_m(wrist, start, end), axis=1) < radius + length_m + NEAR_M)
        if not len(near):
            continue
        wrist, start, end = wrist[near], start[near], end[near]
        for share in ALONG:
            away = _away_m(wrist + share * along[near], start, end)
            depth = radius - np.linalg.norm(away, axis=1)
            out = away + np.clip(depth / radius, 0.0, 1.0)[:, None] * ahead[near]
            out /= np.maximum(np.linalg.norm(out, axis=1), 1e-9)[:, None]
            deeper = depth > depths[near]
            result[near[deeper]], depths[near[deeper]] = (depth[:, None] * out)[deeper], depth[deeper]
    return result


def _away_m(point: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Vector (F, 3) from the nearest position on the line segment ``start``..``end`` to a point, in metres."""
    axis = end - start
    squared = np.maximum(np.einsum("fi,fi->f", axis, axis), 1e-9)
    at = np.clip(np.einsum("fi,fi->f", point - start, axis) / squared, 0.0, 1.0)
    return np.asarray(point - (start + at[:, None] * axis))


def _place_m(clip: MotionClip, world: JointTransforms, name: str) -> FloatArray:
    """World position (F, 3) of a joint by its name, or of the ``"crown"``, the top of the head."""
    if name != "crown":
        return world.positions_m[:, 1 + SEGMENTS.index(name)]
    head = 1 + SEGMENTS.index("head")
    return world.positions_m[:, head] + quaternion.rotate(world.rotations[:, head], clip.shape.ends_m[0])
