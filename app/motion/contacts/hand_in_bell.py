"""The hand that closes the bell for stopped notes: in place before the first note of a passage, and back after the
last.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.contacts.carried_instrument import InstrumentTransform
from app.motion.contacts.hands_away import Shift
from app.motion.curves.curve import Envelopes
from app.plan.model import MuteEvent
from app.rig import quaternion
from app.rig.grip.grip_pose import GripPose
from app.rig.model import Skeleton
from instrument_maps.wind import Stopped

STOPPING: Final = "stopping"
"""Key of the hand in the bell in `app.motion.gestures.body_layers.BodyMotion.hands`."""
FINGERS_KEPT: Final = ("index", "middle", "ring", "little")
"""Fingers that lie on the wall of the bell, regardless of the palm's motion."""
CLOSES_S: Final = 0.28
"""Seconds in which the hand closes and opens the bell."""
READY_S: Final = 0.03
"""Seconds before the first note of a passage at which the hand is in place."""


def bell_closing(mutes: Sequence[MuteEvent], stopped: Stopped | None) -> Envelopes:
    """Return the curve of how far a hand closes the bell, 0..1, for all stopped passages."""
    if stopped is None:
        return Envelopes.of(())
    return Envelopes.of(
        [
            (event.start_s - READY_S - CLOSES_S, event.start_s - READY_S, event.end_s, event.end_s + CLOSES_S, 1.0)
            for event in mutes
            if event.kind == "stopped"
        ]
    )


def wrist_shift(skeleton: Skeleton, stopped: Stopped, share: FloatArray, carried: InstrumentTransform) -> Shift:
    """Displacement of a wrist from its grip, scaled by shares (F,): the palm turns about the knuckles."""
    turned_rad = quaternion.rotate(carried.rotation, np.deg2rad(np.asarray(stopped.turned_deg)))
    # Rotated about the knuckle of the first finger, which is held against the wall.
    knuckle_m = next((skeleton.offsets_m[joint] for joint in _knuckles(skeleton, stopped)), np.zeros(3))
    return Shift(quaternion.from_rotation_vector(share[:, None] * turned_rad), knuckle_m)


def with_fingers_kept(
    skeleton: Skeleton, grip: GripPose, stopped: Stopped, share: FloatArray, rotations: FloatArray
) -> FloatArray:
    """Rotations (F, joints, 4) of `GripPose.finger_joints` that keep the fingers on the bell's wall while the palm
    turns.
    """
    (hand,) = (one for one in grip.hands if one.side == stopped.hand)
    # Rotation of the palm in the frame of the hand.
    turned = quaternion.conjugate(hand.instrument_from_hand_rotation[0])
    back_rad = quaternion.rotate(turned, -np.deg2rad(np.asarray(stopped.turned_deg)))
    back = quaternion.from_rotation_vector(share[:, None] * back_rad)
    joints = list(grip.finger_joints)
    for joint in _knuckles(skeleton, stopped):
        if joint in joints:
            column = joints.index(joint)
            rotations[:, column] = quaternion.multiply(back, rotations[:, column])
    return rotations


def _knuckles(skeleton: Skeleton, stopped: Stopped) -> list[int]:
    """Return the joints at which the fingers of the hand in the bell, except the thumb, begin."""
    names = [f"{stopped.hand}{finger.title()}Proximal" for finger in FINGERS_KEPT]
    return [skeleton.index(name) for name in names if name in skeleton.names]
