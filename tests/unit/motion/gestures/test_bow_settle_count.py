"""Bowing, settling the hands and counting, measured on computed motion: contacts and human limits hold at full size."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from app.motion.model import Motion
from app.plan.model import GestureEvent, PlayerPlan
from app.rig import quaternion
from app.rig.grip.grip_pose import hand_targets
from tests.unit.motion.events import REASON
from tests.unit.motion.test_perform import BODY, CHARACTER, HOLD, PROFILE, made, piece, times, world


def event(kind: str, start_s: float, end_s: float) -> GestureEvent:
    return GestureEvent(f"{kind}:x", kind, round(start_s * 960), round(end_s * 960), start_s, end_s, 1.0, REASON)


def plan() -> PlayerPlan:
    """Plan with gestures in the middle rest, and a bow at the end."""
    made_before = piece()
    added = (
        event("settle_grip", 11.7, 13.0),
        event("hold_still", 9.8, 11.0),
        event("count", 11.5, 13.0),
        event("lower_instrument", 24.9, 40.0),
        event("look_up", 25.6, 32.0),
        event("bow", 26.6, 29.0),
        event("nod", 18.0, 18.75),
    )
    gestures = sorted((*made_before.gestures, *added), key=lambda one: one.start_s)
    frame = msgspec.structs.replace(made_before.time_frame, end_s=31.0)
    return msgspec.structs.replace(made_before, gestures=tuple(gestures), time_frame=frame)


@pytest.mark.parametrize("posture", ["standing", "seated"])
def test_hands_and_feet_stay_where_they_are(posture: str) -> None:
    motion = made(plan(), amplitude=1.0, posture=posture)
    instrument = motion.instrument_position_m.astype(np.float64), motion.instrument_rotation.astype(np.float64)
    for hand in HOLD.hands:
        target_m, _ = hand_targets(hand, *instrument, motion.controls)
        ((position_m, _),) = world(motion, f"{hand.side}Hand")
        assert np.linalg.norm(position_m - target_m, axis=1).max() < 0.5e-3
    bowing = (times(motion) > 26.0) & (times(motion) < 30.0)
    for position_m, _ in world(motion, "leftFoot", "rightFoot"):
        assert np.ptp(position_m[bowing], axis=0).max() < 1e-3


@pytest.mark.parametrize("posture", ["standing", "seated"])
def test_a_bow_is_seen_and_within_human_bounds(posture: str) -> None:
    motion = made(plan(), amplitude=1.0, posture=posture)
    t = times(motion)
    ((head_m, _),) = world(motion, "head")
    before, low = head_m[(t > 26.3) & (t < 26.5)].mean(axis=0), head_m[(t > 27.5) & (t < 27.9)].mean(axis=0)
    assert before[1] - low[1] > (0.06 if posture == "standing" else 0.02)
    assert low[2] - before[2] > (0.10 if posture == "standing" else 0.05)
    _within_bounds(motion)


def _within_bounds(motion: Motion) -> None:
    for name in CHARACTER.skeleton.names[1:]:
        local = motion.rotations[:, CHARACTER.skeleton.index(name)].astype(np.float64)
        turned = quaternion.multiply(quaternion.conjugate(local[:-1]), local[1:])
        velocity = quaternion.to_rotation_vector(turned) * 60
        acceleration = np.linalg.norm(np.diff(velocity, axis=0), axis=1) * 60
        assert acceleration.max() < BODY.limits[PROFILE.joint(name).kind].acceleration_rad_s2, name
