"""Generated values of a channel on which the animator can add a curve."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.perform import PerformanceCurves
from app.plan.by_hand.additive_curve import CHANNELS, FACE
from app.plan.by_hand.pose_corrections import NECK_SHARES, TRUNK_SHARES

_JOINTS: Final = {"head": tuple(NECK_SHARES), "torso": tuple(TRUNK_SHARES)}


def generated(curves: PerformanceCurves, channel: str, times_s: FloatArray) -> FloatArray:
    """Sample the generated values (F,) of an animation channel, without the animator's additive curves, in the
    channel's unit; angles are relative to the posture at rest.
    """
    asked = curves.curves(replace(curves.frames(times_s), added={}))
    if channel.startswith(FACE):
        return asked.morphs.get(channel.removeprefix(FACE), np.zeros(len(times_s)))
    values = _of_body(asked.body, channel) - _of_body(curves.player.still, channel)
    return np.rad2deg(values) if CHANNELS[channel].unit == "deg" else values


def _of_body(motion: BodyMotion, channel: str) -> FloatArray:
    part, _, what = channel.partition(".")
    if part in _JOINTS:
        angles = {"up": motion.forward_rad, "left": motion.turn_rad, "roll": motion.left_rad}[what]
        total = np.sum([angles[joint] for joint in _JOINTS[part]], axis=0)
        return -total if what == "up" else np.asarray(total)
    values: dict[str, FloatArray] = {
        "bell.up": motion.bell_rad + motion.bell_cue_rad,
        "left_elbow.up": motion.elbows_rad,
        "right_elbow.up": motion.elbows_rad,
        "shoulders.up": motion.shoulders_rad,
        "hips.left": motion.hips_side_m,
        "hips.ahead": motion.hips_ahead_m + motion.hips_danced.get("ahead_m", 0.0),
        "hips.tilt": motion.hips_forward_rad + motion.hips_danced.get("forward_rad", 0.0),
        "hips.roll": motion.hips_roll_rad,
        "hips.up": -motion.hips_bob_m,
        "knees.bend": motion.knee_rad,
        "eyes.up": -motion.eyes_pitch_rad,
        "eyes.left": motion.eyes_yaw_rad,
    }
    return values.get(channel, np.zeros(len(motion.hips_side_m)))
