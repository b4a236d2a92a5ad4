"""Pose corrections are visible, smooth, end in time, and break no contact."""

from __future__ import annotations

import itertools

import msgspec
import numpy as np
import pytest

from app.motion.by_hand.pose_corrections import within
from app.motion.model import Motion
from app.plan.events_by_hand import PoseEvent, PoseTarget
from app.plan.model import PlayerPlan
from app.rig import quaternion
from app.rig.grip.grip_pose import hand_targets
from app.rig.skeleton import rest_positions
from tests.unit.motion.events import REASON
from tests.unit.motion.test_perform import BODY, CHARACTER, FPS, HOLD, made, piece, times, world

SPAN_S, FADE_S = (3.0, 5.0), 0.5
CASES: list[tuple[PoseTarget, str, float]] = [
    ("bell", "up_deg", 12.0),
    ("bell", "left_deg", -12.0),
    ("bell", "roll_deg", 5.0),
    ("head", "up_deg", -15.0),
    ("head", "left_deg", 12.0),
    ("head", "roll_deg", -10.0),
    ("torso", "up_deg", -20.0),
    ("torso", "left_deg", 15.0),
    ("torso", "roll_deg", 10.0),
    ("left_elbow", "up_deg", 30.0),
    ("right_elbow", "up_deg", 30.0),
]


def held(target: PoseTarget, **angles: float) -> PlayerPlan:
    values = {"up_deg": 0.0, "left_deg": 0.0, "roll_deg": 0.0} | angles
    event = PoseEvent(
        "pose:x",
        target,
        0,
        0,
        *SPAN_S,
        values["up_deg"],
        values["left_deg"],
        values["roll_deg"],
        FADE_S,
        FADE_S,
        REASON,
    )
    return msgspec.structs.replace(piece(), poses=(event,))


def forwards(rotation: np.ndarray, axis: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> np.ndarray:
    return quaternion.rotate(rotation.astype(np.float64), np.array(axis))


@pytest.mark.parametrize(("target", "angle", "value"), CASES)
def test_contacts_hold(target: PoseTarget, angle: str, value: float) -> None:
    motion = made(held(target, **{angle: value}))
    instrument = motion.instrument_position_m.astype(np.float64), motion.instrument_rotation.astype(np.float64)
    for hand in HOLD.hands:
        target_m, turned = hand_targets(hand, *instrument, motion.controls)
        ((position_m, rotation),) = world(motion, f"{hand.side}Hand")
        assert np.linalg.norm(position_m - target_m, axis=1).max() < 0.5e-3
        turn = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(turned), rotation))
        assert np.linalg.norm(turn, axis=1).max() < 1e-3
    ((head_m, head),) = world(motion, "head")
    t = times(motion)
    playing = (t >= 0.0) & (t < 10.0)
    contact_m = head_m + quaternion.rotate(head, HOLD.lips.contact_m(motion.morphs, motion.frames))
    assert np.linalg.norm(contact_m - motion.instrument_position_m, axis=1)[playing].max() < 0.5e-3
    for position_m, _ in world(motion, "leftFoot", "rightFoot"):
        assert np.ptp(position_m, axis=0).max() < 1e-3


@pytest.mark.parametrize(("target", "angle", "value"), CASES)
def test_bones_keep_their_length(target: PoseTarget, angle: str, value: float) -> None:
    motion = made(held(target, **{angle: value}))
    rest = rest_positions(CHARACTER.skeleton)
    for side in ("left", "right"):
        names = [f"{side}{part}" for part in ("UpperArm", "LowerArm", "Hand")]
        places = [position_m for position_m, _ in world(motion, *names)]
        at_rest = [rest[CHARACTER.skeleton.index(name)] for name in names]
        for (a, b), (rest_a, rest_b) in zip(itertools.pairwise(places), itertools.pairwise(at_rest), strict=True):
            np.testing.assert_allclose(np.linalg.norm(b - a, axis=1), np.linalg.norm(rest_b - rest_a), atol=1e-5)


@pytest.mark.parametrize(("target", "angle", "value"), CASES)
def test_nothing_is_different_before_and_after(target: PoseTarget, angle: str, value: float) -> None:
    plain, other = made(), made(held(target, **{angle: value}))
    t = times(plain)
    # Help for far hands looks a little ahead and back, and elbows beside reaching shoulders move slowly.
    outside = (t < SPAN_S[0] - FADE_S - 0.6) | (t > SPAN_S[1] + FADE_S + 0.6)
    assert np.array_equal(plain.rotations[outside], other.rotations[outside])
    assert np.array_equal(plain.instrument_rotation[outside], other.instrument_rotation[outside])
    inside = (t > SPAN_S[0]) & (t < SPAN_S[1])
    assert not np.array_equal(plain.rotations[inside], other.rotations[inside])


@pytest.mark.parametrize(("target", "angle", "value"), CASES)
def test_it_comes_and_goes_smoothly(target: PoseTarget, angle: str, value: float) -> None:
    plain, other = made(), made(held(target, **{angle: value}))
    for name in ("head", "leftUpperArm", "rightUpperArm", "chest"):
        joint = CHARACTER.skeleton.index(name)
        limit = BODY.limits[name.replace("left", "").replace("right", "").replace("Upper", "upper", 1)]
        jumps = [np.abs(_accelerations(motion, joint)).max() for motion in (plain, other)]
        assert jumps[1] < max(1.5 * jumps[0], limit.acceleration_rad_s2)


def _accelerations(motion: Motion, joint: int) -> np.ndarray:
    local = motion.rotations[:, joint].astype(np.float64)
    steps = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(local[:-1]), local[1:]))
    return np.linalg.norm(np.diff(steps, axis=0), axis=1) * float(FPS) ** 2


def _middle(motion: Motion) -> int:
    return int(np.argmin(np.abs(times(motion) - 4.0)))


def test_the_bell_goes_up_as_far_as_asked() -> None:
    plain, other = made(), made(held("bell", up_deg=8.0))
    rise = [
        np.degrees(np.arcsin(forwards(motion.instrument_rotation)[_middle(motion), 1])) for motion in (plain, other)
    ]
    assert rise[1] - rise[0] == pytest.approx(8.0, abs=0.7)


def test_left_is_left_and_up_is_up() -> None:
    plain = made()
    frame = _middle(plain)
    for target, joint in (("head", "head"), ("torso", "chest")):
        ((_, before),) = world(plain, joint)
        ((_, left),) = world(made(held(target, left_deg=10.0)), joint)
        ((_, up),) = world(made(held(target, up_deg=10.0)), joint)
        ((_, roll),) = world(made(held(target, roll_deg=8.0)), joint)
        assert forwards(left)[frame, 0] > forwards(before)[frame, 0] + 0.1
        assert forwards(up)[frame, 1] > forwards(before)[frame, 1] + 0.08
        assert forwards(roll, (0, 1, 0))[frame, 0] > forwards(before, (0, 1, 0))[frame, 0] + 0.08
    bell = made(held("bell", left_deg=10.0))
    assert forwards(bell.instrument_rotation)[frame, 0] > forwards(plain.instrument_rotation)[frame, 0] + 0.1
    rolled = made(held("bell", roll_deg=5.0))
    top = (0.0, 1.0, 0.0)
    assert (
        forwards(rolled.instrument_rotation, top)[frame, 0] > forwards(plain.instrument_rotation, top)[frame, 0] + 0.05
    )
    for side, sign in (("left", 1.0), ("right", -1.0)):
        ((before_m, _),) = world(plain, f"{side}LowerArm")
        ((after_m, _),) = world(made(held(f"{side}_elbow", up_deg=25.0)), f"{side}LowerArm")
        assert sign * (after_m - before_m)[frame, 0] > 0.03
        assert (after_m - before_m)[frame, 1] > 0.0


def test_offsets_over_one_another_add_up() -> None:
    (event,) = held("head", left_deg=5.0).poses
    twice = msgspec.structs.replace(piece(), poses=(event, msgspec.structs.replace(event, id="pose:y")))
    once = made(held("head", left_deg=10.0))
    np.testing.assert_allclose(made(twice).rotations, once.rotations, atol=1e-6)


def test_a_range_is_never_left() -> None:
    offset = np.linspace(-3.0, 3.0, 601)
    held_rad = within(offset, 0.5, 0.2)
    assert held_rad.max() < 0.5
    assert held_rad.min() > -0.2
    assert (np.diff(held_rad) > 0.0).all()
    small = np.abs(offset) < 0.1
    np.testing.assert_allclose(held_rad[small], offset[small], atol=2e-3)
