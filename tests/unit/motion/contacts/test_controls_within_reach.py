"""A control moved by a hand goes only as far as the hand reaches, so that the hand stays on it."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.export.joints import angular_accelerations
from app.motion.contacts.controls_within_reach import EASE, LONGEST
from app.motion.model import Motion
from app.plan.parameters import PlayerParameters
from app.rig.grip.grip_pose import hand_targets
from app.rig.ik import arm
from app.rig.skeleton import forward
from metadata.load import load_body
from tests.support.performed import perform
from tests.unit.motion import figure
from tests.unit.motion.events import TICKS, fingerings, plan_of, press, slide

CHARACTER = figure.character()
FPS = 120


def played(slide_m: float, places: list[float], note_s: float = 0.5) -> Motion:
    rows = [(i * note_s, (i + 1) * note_s, {"slide": place}) for i, place in enumerate(places)]
    return perform(
        plan_of(fingerings(rows)), PlayerParameters(amplitude=0.3), figure.instrument_map(press(), slide()), CHARACTER,
        figure.hold(CHARACTER.skeleton, slide_m), load_body(), felt_beats=((0, TICKS),), fps=Fraction(FPS),
    )  # fmt: skip


def off_m(motion: Motion, slide_m: float) -> np.ndarray:
    hand = figure.hold(CHARACTER.skeleton, slide_m).hands[1]
    place = motion.instrument_position_m.astype(np.float64), motion.instrument_rotation.astype(np.float64)
    joint = CHARACTER.skeleton.index("rightHand")
    hand_m = forward(CHARACTER.skeleton, motion.rotations, motion.hips_m, [joint]).of(joint)[0]
    return np.asarray(np.linalg.norm(hand_m - hand_targets(hand, *place, motion.controls)[0], axis=1))


@given(st.floats(0.1, 1.2), st.lists(st.floats(0.0, 1.0), min_size=2, max_size=6))
@settings(max_examples=25, deadline=None)
def test_the_hand_has_what_it_carries_at_every_frame(slide_m: float, places: list[float]) -> None:
    motion = played(slide_m, places)
    assert off_m(motion, slide_m).max() < 1e-4
    assert np.all((motion.controls["slide"] >= 0.0) & (motion.controls["slide"] <= max(places) + 1e-6))


def test_the_arm_is_never_quite_straight_and_the_slide_never_jumps() -> None:
    motion, near = played(1.0, [0.0, 1.0, 0.3, 1.0]), played(0.4, [0.0, 1.0, 0.3, 1.0])
    bones = CHARACTER.skeleton
    joints = [bones.index(name) for name in ("rightUpperArm", "rightHand")]
    posed = forward(bones, motion.rotations, motion.hips_m, joints)
    share = np.linalg.norm(posed.of(joints[1])[0] - posed.of(joints[0])[0], axis=1) / arm(bones, "right").length_m
    assert LONGEST - EASE < share.max() <= LONGEST + 1e-6
    assert motion.controls["slide"].max() < 0.9
    # Its speed does not exceed that without the limit.
    asked = np.abs(np.diff(near.controls["slide"])).max()
    assert np.abs(np.diff(motion.controls["slide"])).max() <= asked + 0.002


def test_it_slows_down_to_where_the_arm_ends() -> None:
    """The control approaches its end smoothly: the elbow, which extends ever faster before it, stays within human
    speeds.
    """
    motion = played(1.0, [0.0, 1.0, 0.0, 1.0], note_s=0.5)
    elbow = motion.rotations[:, [CHARACTER.skeleton.index("rightLowerArm")]].astype(np.float64)
    most = load_body().limits["lowerArm"].acceleration_rad_s2
    assert angular_accelerations(elbow[::2].transpose(2, 1, 0), FPS / 2).max() < most


@pytest.mark.parametrize("slide_m", [0.2, 0.35, 0.42])
def test_what_is_within_reach_is_reached(slide_m: float) -> None:
    motion = played(slide_m, [0.0, 1.0, 0.5, 1.0], note_s=1.0)
    assert motion.controls["slide"].max() == 1.0
