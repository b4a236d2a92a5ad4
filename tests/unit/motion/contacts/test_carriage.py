"""Rotation of the body towards an instrument, and motion of the instrument with the body."""

from __future__ import annotations

from fractions import Fraction

import msgspec
import numpy as np
import pytest

from app.motion.model import Motion
from app.plan.by_hand.pose_corrections import pose_limits
from app.plan.model import GestureEvent
from app.plan.parameters import PlayerParameters
from app.rig import quaternion
from app.rig.grip.carriage import carriage_rotation, carrying, joint_rotations, upright
from app.rig.skeleton import forward
from instrument_maps.hold import Carriage
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from metadata.model import NECK_JOINTS, TRUNK_JOINTS
from tests.support.performed import perform
from tests.unit.motion import figure
from tests.unit.motion.events import REASON, TICKS, cue, fingerings, plan_of, press

BODY = load_body()
CHARACTER = figure.character()
HOLD = figure.hold(CHARACTER.skeleton)
MAP = figure.instrument_map(press())
FREE = Carriage((-10.0, 10.0, 40.0), (-20.0, 0.0, 20.0), (-20.0, 0.0, 20.0))


def carried(carriage: Carriage) -> InstrumentMap:
    return msgspec.structs.replace(MAP, hold=msgspec.structs.replace(MAP.hold, standing=carriage, seated=carriage))


def made(instrument: InstrumentMap, amplitude: float = 1.0, lowered: bool = False) -> Motion:
    rows = [("sway", t, t + 0.5, float((-1) ** i)) for i, t in enumerate(np.arange(0.0, 12.0, 0.5))]
    if lowered:
        rows += [("lower_instrument", 13.0, 18.0, 1.0)]
    gestures = tuple(
        GestureEvent(f"g{i}", kind, round(start * 960), round(end * 960), float(start), float(end), amount, REASON)
        for i, (kind, start, end, amount) in enumerate(rows)
    )
    notes = fingerings([(0.5 * i, 0.5 * i + 0.5, {}) for i in range(24)] + [(20.0, 21.0, {})])
    plan = plan_of(notes, cues=(cue(0.0), cue(4.0)), gestures=gestures)
    parameters = PlayerParameters(amplitude=amplitude)
    return perform(plan, parameters, instrument, CHARACTER, HOLD, BODY, felt_beats=((0, TICKS),), fps=Fraction(60))


def angles_deg(motion: Motion) -> np.ndarray:
    """Downward pitch, left yaw and left roll (F, 3) of the instrument in the player's frame."""
    rotation = motion.instrument_rotation.astype(np.float64)
    air = quaternion.rotate(rotation, np.array([0.0, 0.0, 1.0]))
    up = quaternion.rotate(rotation, np.array([0.0, 1.0, 0.0]))
    pitch = np.arcsin(-air[:, 1])
    yaw = np.arctan2(air[:, 0], air[:, 2])
    level = np.stack([np.cos(yaw), np.zeros(len(yaw)), -np.sin(yaw)], axis=-1)
    return np.degrees(np.stack([pitch, yaw, np.arcsin(np.einsum("fi,fi->f", up, level))], axis=-1))


def test_the_angles_are_shared_within_what_joints_do() -> None:
    for asked in (5.0, 25.0, -40.0, 80.0):
        posture = BODY.turned_to("standing", head_left_deg=asked, head_lean_left_deg=asked, trunk_left_deg=asked)
        for joints, angles, field in (
            (NECK_JOINTS, posture.spine_turn_deg, "twist_deg"),
            (TRUNK_JOINTS, posture.spine_turn_deg, "twist_deg"),
            (NECK_JOINTS, posture.spine_left_deg, "sideways_deg"),
        ):
            room = 0.0
            for joint in joints:
                low, high = getattr(BODY.limits[joint], field)
                assert low < angles[joint] < high
                room += high
            total = sum(angles[joint] for joint in joints)
            assert total == pytest.approx(np.sign(asked) * min(abs(asked), 0.85 * room))
    assert BODY.turned_to("standing") == msgspec.structs.replace(
        BODY.postures["standing"], spine_deg=BODY.turned_to("standing").spine_deg
    )


@pytest.mark.parametrize("pitch_deg", [-40.0, 0.0, 20.0, 60.0, 90.0])
def test_the_head_follows_a_steep_instrument_only_as_far_as_the_posture_lets_it(pitch_deg: float) -> None:
    for name, posture in BODY.postures.items():
        turned = BODY.turned_to(name, pitch_down_deg=pitch_deg)
        bent = turned.spine_deg["head"] - posture.spine_deg["head"]
        assert 0.0 <= bent <= posture.head_down_deg


def test_the_fitted_player_and_the_one_who_moves_stand_alike() -> None:
    carriage = msgspec.structs.replace(FREE, head_left_deg=30.0, head_lean_left_deg=-8.0, trunk_left_deg=20.0)
    instrument = carried(carriage)
    stand = upright(CHARACTER, instrument, BODY, HOLD.lips)
    skeleton = CHARACTER.skeleton
    turns = forward(skeleton, _still(instrument)).rotations[0]
    head, chest = turns[skeleton.index("head")], turns[skeleton.parents[skeleton.index("leftShoulder")]]
    facing = quaternion.rotate(head, np.array([0.0, 0.0, 1.0]))
    # Rotation about the vertical axis; leaning and nodding reduce it slightly.
    assert np.degrees(np.arctan2(facing[0], facing[2])) == pytest.approx(50.0, abs=3.0)
    shoulders = quaternion.rotate(chest, np.array([1.0, 0.0, 0.0]))
    assert np.degrees(np.arctan2(-shoulders[2], shoulders[0])) == pytest.approx(20.0, abs=1.0)
    ear = quaternion.rotate(head, np.array([1.0, 0.0, 0.0]))
    assert np.degrees(np.arcsin(ear[1])) == pytest.approx(8.0, abs=3.0)
    motion = made(instrument, amplitude=0.0)
    position_m = forward(skeleton, motion.rotations, motion.hips_m)
    _, turn = position_m.of(skeleton.index("head"))
    off = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(head), turn))
    # Remaining motion of a player who keeps still, and the nods of the cues.
    assert np.degrees(np.median(np.linalg.norm(off, axis=1))) < 6.0
    # The instrument is where the carriage has it, whichever way the head is turned.
    still = carriage_rotation(10.0, 0.0, 0.0)
    apart = quaternion.multiply(quaternion.conjugate(still), motion.instrument_rotation.astype(np.float64))
    assert np.degrees(np.median(np.linalg.norm(quaternion.to_rotation_vector(apart), axis=1))) < 6.0
    rim_m = stand.instrument_m - stand.joints_m[skeleton.index("hips")]
    assert np.linalg.norm(np.median(motion.instrument_position_m - motion.hips_m, axis=0) - rim_m) < 0.03


def _still(instrument: InstrumentMap) -> np.ndarray:
    return joint_rotations(CHARACTER.skeleton, carrying(BODY, "standing", instrument.hold.carriage("standing")))


def test_with_the_instrument_lowered_the_player_looks_ahead_again() -> None:
    carriage = msgspec.structs.replace(FREE, head_left_deg=40.0, head_lean_left_deg=-8.0)
    motion = made(carried(carriage), amplitude=0.0, lowered=True)
    skeleton = CHARACTER.skeleton
    _, head = forward(skeleton, motion.rotations, motion.hips_m).of(skeleton.index("head"))
    facing = quaternion.rotate(head, np.array([0.0, 0.0, 1.0]))
    times_s = motion.first_frame_s + np.arange(motion.frames) / 60.0
    yaw = np.degrees(np.arctan2(facing[:, 0], facing[:, 2]))
    assert np.median(yaw[(times_s > 2.0) & (times_s < 10.0)]) == pytest.approx(40.0, abs=8.0)
    assert abs(np.median(yaw[(times_s > 15.0) & (times_s < 16.0)])) < 15.0


def test_what_has_no_room_to_swing_stays_while_the_lips_stay_on_it() -> None:
    lap = Carriage((-1.0, 0.0, 1.0), (-1.0, 0.0, 1.0), (-1.0, 0.0, 1.0))
    on_lap, free = made(carried(lap)), made(carried(FREE))
    assert np.ptp(angles_deg(free), axis=0).min() > 4.0
    assert np.ptp(angles_deg(on_lap), axis=0).max() < 4.0
    assert np.ptp(on_lap.instrument_position_m[:, 0]) < 0.6 * np.ptp(free.instrument_position_m[:, 0])
    for motion in (on_lap, free):
        skeleton = CHARACTER.skeleton
        place_m, head = forward(skeleton, motion.rotations, motion.hips_m).of(skeleton.index("head"))
        lips_m = place_m + quaternion.rotate(head, HOLD.lips.contact_m(motion.morphs, motion.frames))
        assert np.linalg.norm(lips_m - motion.instrument_position_m, axis=1).max() < 1e-3


def test_a_cue_does_not_take_the_bell_beyond_its_range() -> None:
    narrow = Carriage((4.0, 10.0, 14.0), (-20.0, 0.0, 20.0), (-20.0, 0.0, 20.0))
    motion, skeleton = made(carried(narrow)), CHARACTER.skeleton
    _, head = forward(skeleton, motion.rotations, motion.hips_m).of(skeleton.index("head"))
    still = forward(skeleton, _still(carried(narrow))).rotations[0, skeleton.index("head")]
    with_head = quaternion.multiply(head, quaternion.conjugate(still))
    own = quaternion.multiply(quaternion.conjugate(with_head), motion.instrument_rotation.astype(np.float64))
    pitch = np.degrees(np.arcsin(-quaternion.rotate(own, np.array([0.0, 0.0, 1.0]))[:, 1]))
    assert 3.5 < pitch.min() < 10.0 < pitch.max() < 14.5


def test_posture_corrections_have_the_room_that_the_turned_head_leaves() -> None:
    turned = carried(msgspec.structs.replace(FREE, head_left_deg=55.0))
    low, high = pose_limits("head", turned, PlayerParameters(), BODY)["left_deg"]
    straight = pose_limits("head", MAP, PlayerParameters(), BODY)["left_deg"]
    assert high < straight[1]
    assert low == straight[0]


def put_down(offset_m: tuple[float, float, float]) -> InstrumentMap:
    place = msgspec.structs.replace(MAP.hold.lowered("standing"), offset_m=offset_m)
    return msgspec.structs.replace(MAP, hold=msgspec.structs.replace(MAP.hold, lowered_standing=place))


def test_the_trunk_does_not_turn_after_a_lowered_instrument_that_it_carries() -> None:
    near, far = (made(put_down(offset_m), 0.0, lowered=True) for offset_m in ((0.0, -0.3, 0.05), (0.2, -0.3, 0.45)))
    chest = CHARACTER.skeleton.index("upperChest")
    frame = [round((2.0 + 15.5) * 60)]
    turned = [
        forward(CHARACTER.skeleton, motion.rotations[frame], motion.hips_m[frame], [chest]).of(chest)[1]
        for motion in (near, far)
    ]
    np.testing.assert_allclose(turned[0], turned[1], atol=1e-6)


@pytest.mark.parametrize(("down_m", "ahead_m"), [(0.0, 0.0), (0.03, 0.0175), (0.3, 0.035)])
def test_only_what_goes_below_the_chin_swings_ahead_on_its_way(down_m: float, ahead_m: float) -> None:
    motion = made(put_down((0.0, -down_m, 0.0)), 0.0, lowered=True)
    start, end = round((2.0 + 12.9) * 60), round((2.0 + 15.5) * 60)
    ahead = motion.instrument_position_m[start:end, 2].astype(np.float64)
    # The trunk leans slightly forward over the lowered instrument.
    straight = np.minimum(ahead[0], ahead[-1])
    assert ahead.max() - straight == pytest.approx(ahead_m, abs=0.02 if down_m == 0.0 else 0.012)
