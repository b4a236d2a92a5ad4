"""Sum of the motion layers of a body: the input of the contact solvers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, dataclass, field, fields
from typing import Any

import numpy as np

from app.arrays import FloatArray, IndexArray
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
        Translation of the hips to the left, ahead and down.
    hips_roll_rad, hips_turn_rad, hips_forward_rad : array
        Rotation of the hips: lean to the left, turn to the left, and forward tilt.
    knee_rad : array
        Bend added to both knees.
    bell_rad, bell_cue_rad : array
        Rise of the bell in addition to the head's motion: with the melody, and for a cue.
    bell_down_rad, bell_right_rad : array
        Turn of the bell towards a far hand, as required by contacts.
    bell_held_rad : dict of str to array
        The animator's additions to the instrument's ``pitch`` (bell up), ``yaw`` and ``roll`` (left); empty: none.
    shoulders_rad : array
        Lift of both shoulders.
    elbows_rad : array
        Outward turn of both elbows.
    eyes_yaw_rad, eyes_pitch_rad : array
        Rotation of the eyes in a head that follows the gaze only: left, down.
    lowered : array
        0 with the instrument at the lips, 1 with it lowered.
    steadied : array
        Degree to which the head stays in place while the trunk turns for a far hand, 0..1.
    protraction_rad : dict of str to array
        Forward motion of each shoulder, by side, as required by contacts.
    elbow_along_rad : dict of str to array
        Forward motion of each shoulder that its elbow goes along with, by side; empty: that of ``protraction_rad``.
    elbow_out_rad : dict of str to array
        Turn of each elbow out of the trunk's way, by side, as required by contacts; empty: none.
    elbow_held_rad : dict of str to array
        The animator's outward turn of each elbow, by side; empty: none.
    hips_danced : dict of str to array
        A dance's additions to the hips (`app.motion.gestures.dance_layer`): ``ahead_m``, ``forward_rad`` and ``ease_m``
        (additional rounding of the change from leg to leg); empty: no dance.
    elbows_late_rad : dict of str to array
        ``forward``, ``turn`` and ``left``: lag of the elbows behind the chest; empty: none.
    feet : dict of str to array
        Motion of feet that do not stand (`app.motion.gestures.feet.feet_moved`); empty: both stand.
    hands : dict of str to array
        Motion of hands that leave the instrument (`app.motion.gestures.hand_gestures.limited_hand_gestures`); empty:
        none.
    looks : dict of str to array
        Targets that the eyes hold regardless of the head: ``left_rad`` and ``down_rad`` (direction relative to the
        eyes'), ``near_per_m`` and ``own`` (`app.motion.faces.gaze.Gaze`); empty: the eyes move with the head.
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
    elbow_along_rad: dict[str, FloatArray] = field(default_factory=dict)
    elbow_out_rad: dict[str, FloatArray] = field(default_factory=dict)
    elbow_held_rad: dict[str, FloatArray] = field(default_factory=dict)
    hips_danced: dict[str, FloatArray] = field(default_factory=dict)
    elbows_late_rad: dict[str, FloatArray] = field(default_factory=dict)
    feet: dict[str, FloatArray] = field(default_factory=dict)
    hands: dict[str, FloatArray] = field(default_factory=dict)
    looks: dict[str, FloatArray] = field(default_factory=dict)

    def __getitem__(self, frames: slice | IndexArray) -> BodyMotion:
        """Return the motion in a range of frames."""
        return self._each(lambda values: values[frames])

    def for_frames(self, frames: int) -> BodyMotion:
        """Return the motion of a single frame repeated for ``frames`` frames."""
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
        """Return the motion of a body that keeps still in a posture, as one frame."""
        zero = np.zeros(1)
        held, left, turned = (
            {joint: np.array([np.deg2rad(angles.get(joint, 0.0))]) for joint in TRUNK}
            for angles in (posture.spine_deg, posture.spine_left_deg, posture.spine_turn_deg)
        )
        rest: dict[str, Any] = {member.name: zero for member in fields(cls) if member.default_factory is MISSING}
        return cls(**(rest | {"forward_rad": held, "left_rad": left, "turn_rad": turned}))
