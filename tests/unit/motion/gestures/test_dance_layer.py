"""A dance in a player's body does not change contacts, feet and bones, by forward kinematics."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from app.choreography.body_layer import MOST
from app.motion.gestures.dance_layer import CHANNELS, BodyLayer
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves, prepare
from app.plan.parameters import PlayerParameters
from app.rig import quaternion
from app.rig.grip.grip_pose import hand_targets
from app.steps import StepRuns
from tests.unit.motion.events import TICKS
from tests.unit.motion.test_perform import BODY, CHARACTER, FPS, HOLD, MAP, made, piece, times, world

FRAMES = 600


def dance(seed: int = 1) -> BodyLayer:
    """Layer in which every channel moves between its bounds about once a second."""
    random = np.random.default_rng(seed)
    times_s = np.arange(-2.0, 26.0, 1 / 30)
    hz, phase = random.uniform(0.6, 1.2, len(CHANNELS)), random.uniform(0.0, 6.0, len(CHANNELS))
    most = np.array([MOST[name] for name in CHANNELS])
    return BodyLayer(-2.0, 1 / 30, most * np.sin(2.0 * np.pi * hz * times_s[:, None] + phase))


def playing(layer: BodyLayer | None, **parameters: object) -> PerformanceCurves:
    return prepare(
        StepRuns(),
        piece(),
        PlayerParameters(**parameters),
        MAP,
        CHARACTER,
        HOLD,
        BODY,
        felt_beats=((0, TICKS),),
        dance=layer,
    )


def danced(amount: float, **parameters: object) -> Motion:
    return playing(dance(), dance_amount=amount, **parameters).motion(FPS, 0, FRAMES)


def same(one: Motion, other: Motion) -> bool:
    arrays = ("rotations", "hips_m", "instrument_position_m", "instrument_rotation")
    tables = ("controls", "morphs")
    return all(getattr(one, name).tobytes() == getattr(other, name).tobytes() for name in arrays) and all(
        value.tobytes() == getattr(other, name)[key].tobytes()
        for name in tables
        for key, value in getattr(one, name).items()
    )


@pytest.mark.parametrize("amount", [0.1, 0.5, 1.0])
def test_the_highest_of_a_dance_leaves_knees_as_bent_as_without_it(amount: float) -> None:
    values = np.zeros((900, len(CHANNELS)))
    values[:, CHANNELS.index("up_m")] = MOST["up_m"]
    highest_m, usual_m = (
        playing(layer, dance_amount=amount, posture="standing").motion(FPS, 0, 60).hips_m[:, 1]
        for layer in (BodyLayer(-2.0, 1 / 30, values), None)
    )
    assert (highest_m <= usual_m + 1e-6).all()


@pytest.mark.parametrize("posture", ["standing", "seated"])
def test_nothing_of_a_dance_is_the_generated_motion_to_the_bit(posture: str) -> None:
    generated = made(posture=posture, frames=FRAMES)
    assert same(danced(0.0, posture=posture), generated)
    assert not same(danced(0.01, posture=posture), generated)


def test_the_same_frames_are_the_same_bits_in_every_span() -> None:
    whole, part = playing(dance(), dance_amount=1.0), playing(dance(), dance_amount=1.0)
    one, other = whole.motion(FPS, 0, FRAMES), part.motion(FPS, 211, 57)
    assert one.rotations[211:268].tobytes() == other.rotations.tobytes()
    assert one.hips_m[211:268].tobytes() == other.hips_m.tobytes()


def test_hips_trunk_and_head_dance() -> None:
    generated, much = made(frames=FRAMES, amplitude=0.0), danced(1.0, amplitude=0.0)
    half = danced(0.5, amplitude=0.0)
    for joint in ("hips", "upperChest", "head"):
        still, some, all_of_it = (world(motion, joint)[0][1] for motion in (generated, half, much))
        small, large = (
            np.linalg.norm(
                quaternion.to_rotation_vector(quaternion.multiply(turned, quaternion.conjugate(still))), axis=1
            )
            for turned in (some, all_of_it)
        )
        assert np.quantile(large, 0.9) > np.deg2rad(7.0)
        # Half of a dance shows well, but for its nods, which move the bell.
        assert 0.65 < np.median(small / large) < 0.85
    # The player stays in place and moves by the stated amount; the hips lean by slightly more.
    path = np.abs(much.hips_m - generated.hips_m).max(axis=0)
    for axis, channel in ((0, "side_m"), (2, "ahead_m")):
        assert path[axis] == pytest.approx(MOST[channel], abs=0.005)


@pytest.mark.parametrize("posture", ["standing", "seated"])
def test_feet_and_bones_stay(posture: str) -> None:
    motion = danced(1.0, posture=posture, amplitude=1.0)
    for position_m, _ in world(motion, "leftFoot", "rightFoot", "leftToes", "rightToes"):
        # At most 5 mm/s.
        assert np.linalg.norm(np.diff(position_m, axis=0), axis=1).max() * float(FPS) < 0.005
        assert np.ptp(position_m, axis=0).max() < 1e-3
    names = ("UpperLeg", "LowerLeg", "Foot")
    hip, knee, ankle = (world(motion, f"left{name}")[0][0] for name in names)
    for one, other in ((hip, knee), (knee, ankle)):
        assert np.ptp(np.linalg.norm(one - other, axis=1)) < 1e-5


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_knees_do_not_pop(seed: int) -> None:
    motion = playing(dance(seed), dance_amount=1.0).motion(FPS, 0, FRAMES)
    for side in ("left", "right"):
        turned = motion.rotations[:, CHARACTER.skeleton.index(f"{side}LowerLeg")].astype(np.float64)
        bend = 2.0 * np.arccos(np.clip(np.abs(turned[:, 3]), 0.0, 1.0))
        # Never straight, where a knee snaps, and within what limbs do (100 rad/s2, `metadata/bodies`).
        assert np.rad2deg(bend.min()) > 8.0
        assert np.abs(np.diff(bend)).max() * float(FPS) < 4.0
        assert np.abs(np.diff(bend, 2)).max() * float(FPS) ** 2 < 100.0


def test_a_seated_player_dances_above_the_seat() -> None:
    motion, still = danced(1.0, posture="seated", amplitude=0.0), made(posture="seated", amplitude=0.0, frames=FRAMES)
    # A dance takes the place of the sway, of which the pelvis has a share: under a millimetre here.
    assert np.abs(motion.hips_m - still.hips_m).max() < 1e-3
    legs = [CHARACTER.skeleton.index(f"left{name}") for name in ("UpperLeg", "LowerLeg", "Foot")]
    assert np.abs(motion.rotations[:, legs] - still.rotations[:, legs]).max() < 3e-3
    (_, chest), (_, before) = world(motion, "upperChest")[0], world(still, "upperChest")[0]
    turned = quaternion.to_rotation_vector(quaternion.multiply(chest, quaternion.conjugate(before)))
    assert np.rad2deg(np.ptp(turned[:, 1])) > 12.0


@pytest.mark.parametrize("posture", ["standing", "seated"])
def test_hands_stay_on_the_instrument(posture: str) -> None:
    motion = danced(1.0, posture=posture)
    for hand in HOLD.hands:
        position_m, _ = world(motion, f"{hand.side}Hand")[0]
        requested_m, _ = hand_targets(
            hand,
            motion.instrument_position_m.astype(np.float64),
            motion.instrument_rotation.astype(np.float64),
            motion.controls,
        )
        assert np.linalg.norm(position_m - requested_m, axis=1).max() < 0.001


def test_the_bell_rises_and_sinks_no_more_than_the_trunk() -> None:
    bell = [
        np.arcsin(quaternion.rotate(motion.instrument_rotation.astype(np.float64), np.array([0.0, 0.0, 1.0]))[:, 1])
        for motion in (danced(1.0, amplitude=0.0), made(amplitude=0.0, frames=FRAMES))
    ]
    risen_deg = np.rad2deg(bell[0] - bell[1])
    # The layer's 6 degrees, and the effect of sideways leans and rotations.
    assert np.abs(risen_deg).max() < 8.0
    assert np.ptp(risen_deg) > 6.0


def test_head_and_instrument_go_with_the_chest_while_played_and_the_head_alone_while_lowered() -> None:
    at_rest = {"amplitude": 0.0, "sway": 0.0, "weight_shift": 0.0}
    motion, still = (playing(layer, dance_amount=1.0, **at_rest).motion(FPS, 0, 1200) for layer in (dance(), None))
    neck = CHARACTER.skeleton.index("neck")
    apart = np.abs(motion.rotations[:, neck] - still.rotations[:, neck]).max(axis=1)
    # The gesture: 10.5 to 14.5 s.
    at_s = times(motion)
    played = (at_s < 10.4) | (at_s > 14.6)
    assert apart[played].max() < 1e-6
    assert apart[(at_s > 12.0) & (at_s < 13.0)].max() > 0.01
    # Both arms are bent as without the dance while it is played.
    for joint in ("leftLowerArm", "rightLowerArm", "leftHand", "rightHand"):
        index = CHARACTER.skeleton.index(joint)
        same_bend = np.abs(motion.rotations[played, index] - still.rotations[played, index]).max()
        assert same_bend < 0.002, joint


def test_a_layer_is_smooth_between_its_samples() -> None:
    layer = dance()
    times_s = np.linspace(-1.9, 25.8, 1000)
    at = layer.start_s + layer.step_s * np.arange(len(layer.values))
    slopes = np.gradient(layer.values, layer.step_s, axis=0)
    np.testing.assert_allclose(layer.sample(times_s), CubicHermiteSpline(at, layer.values, slopes)(times_s), atol=1e-9)
    assert np.array_equal(layer.sample(np.array([-9.0, 99.0])), layer.values[[0, -1]])
