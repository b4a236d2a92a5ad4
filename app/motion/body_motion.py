"""The sum of the layers of a body: the value that contacts are solved on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, dataclass, field, fields
from typing import Any

import numpy as np

from app.arrays import FloatArray
from app.plan.by_hand.pose_corrections import NECK_SHARES, TRUNK_SHARES
from metadata.model import Posture

TRUNK = (*TRUNK_SHARES, *NECK_SHARES)


@dataclass(frozen=True)
class BodyMotion:
    """The sum of the layers; every array is (F,) float64.

    Attributes
    ----------
    forward_rad, left_rad, turn_rad : dict of str to array
        Flexion, sideways lean and twist of each joint of trunk and neck.
    hips_side_m, hips_ahead_m, hips_bob_m : array
        Of the hips, to the left, ahead and down.
    hips_roll_rad, hips_turn_rad, hips_forward_rad : array
        Left, left and forward.
    knee_rad : array
        Bend added to both knees.
    bell_rad, bell_cue_rad : array
        Bell up, beside what the head does: with the melody, and to give a cue.
    bell_down_rad, bell_right_rad : array
        Bell towards a far hand; what the contacts ask for.
    bell_held_rad : dict of str to array
        What the animator adds to the instrument's ``pitch`` (bell up), ``yaw`` and ``roll`` (left); empty: nothing.
    shoulders_rad : array
        Both shoulders up.
    elbows_rad : array
        Both elbows out.
    eyes_yaw_rad, eyes_pitch_rad : array
        Of the eyes in the head: left, down; of a head that turns only for the gaze.
    lowered : array
        0 with the instrument at the lips, 1 with it lowered.
    steadied : array
        How far the head stays over its place while the trunk turns for a far hand, 0..1.
    protraction_rad : dict of str to array
        Each shoulder forwards, by side; what the contacts ask for.
    elbow_held_rad : dict of str to array
        How far the animator turns each elbow out, by side; empty: not at all.
    hips_danced : dict of str to array
        What a dance adds to the hips (`app.motion.gestures.dance_layer`): ``ahead_m``, ``forward_rad`` and ``ease_m``,
        by how much more the hand-over from leg to leg is rounded; empty: no one dances.
    elbows_late_rad : dict of str to array
        ``forward``, ``turn`` and ``left``: how far the elbows are from where the chest has them; empty: not at all.
    feet : dict of str to array
        What feet do that do not stand (`app.motion.gestures.feet.feet_moved`); empty: they stand.
    hands : dict of str to array
        Where hands are that leave the instrument (`app.motion.gestures.hand_gestures.limited_hand_gestures`); empty:
        they stay.
    looks : dict of str to array
        What the eyes stay on whatever the head does: ``left_rad`` and ``down_rad``, by how much its direction is
        farther than theirs, and ``near_per_m`` and ``own`` (`app.motion.faces.gaze.Gaze`); empty: they keep to the
        head.
    """

    forward_rad: dict[str, FloatArray]
    left_rad: dict[str, FloatArray]
    turn_rad: dict[str, FloatArray]
    hips_side_m: FloatArray
    hips_ahead_m: FloatArray
    hips_bob_m: FloatArray
    hips_roll_rad: FloatArray
    hips_turn_rad: FloatArray
    hips_forward_rad: FloatArray
    knee_rad: FloatArray
    bell_rad: FloatArray
    bell_cue_rad: FloatArray
    bell_down_rad: FloatArray
    bell_right_rad: FloatArray
    shoulders_rad: FloatArray
    elbows_rad: FloatArray
    eyes_yaw_rad: FloatArray
    eyes_pitch_rad: FloatArray
    lowered: FloatArray
    steadied: FloatArray
    bell_held_rad: dict[str, FloatArray] = field(default_factory=dict)
    protraction_rad: dict[str, FloatArray] = field(default_factory=dict)
    elbow_held_rad: dict[str, FloatArray] = field(default_factory=dict)
    hips_danced: dict[str, FloatArray] = field(default_factory=dict)
    elbows_late_rad: dict[str, FloatArray] = field(default_factory=dict)
    feet: dict[str, FloatArray] = field(default_factory=dict)
    hands: dict[str, FloatArray] = field(default_factory=dict)
    looks: dict[str, FloatArray] = field(default_factory=dict)

    def __getitem__(self, frames: slice) -> BodyMotion:
        """The motion in some of its frames."""
        return self._each(lambda values: values[frames])

    def for_frames(self, frames: int) -> BodyMotion:
        """The motion of a single frame, repeated."""
        return self._each(lambda values: np.tile(values, frames))

    def _each(self, made: Callable[[FloatArray], FloatArray]) -> BodyMotion:
        result: dict[str, Any] = {}
        for member in fields(self):
            value = getattr(self, member.name)
            if isinstance(value, dict):
                result[member.name] = {joint: made(angles) for joint, angles in value.items()}
            else:
                result[member.name] = made(value)
        return BodyMotion(**result)

    @classmethod
    def still(cls, posture: Posture) -> BodyMotion:
        """The posture before any motion, as one frame."""
        zero = np.zeros(1)
        held, left, turned = (
            {joint: np.array([np.deg2rad(angles.get(joint, 0.0))]) for joint in TRUNK}
            for angles in (posture.spine_deg, posture.spine_left_deg, posture.spine_turn_deg)
        )
        rest: dict[str, Any] = {member.name: zero for member in fields(cls) if member.default_factory is MISSING}
        return cls(**(rest | {"forward_rad": held, "left_rad": left, "turn_rad": turned}))
