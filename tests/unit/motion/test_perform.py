"""Properties of all motion, measured by forward kinematics independent of the solvers."""

from __future__ import annotations

import itertools
from fractions import Fraction
from functools import cache

import msgspec
import numpy as np
import pytest

from app.motion.contacts.trunk_and_legs import SIT_BONES_M
from app.motion.model import Motion, frame_count
from app.plan.gestures.feet import lifted_s
from app.plan.model import GestureEvent, PlayerPlan, TimeFrame
from app.plan.parameters import PlayerParameters
from app.rig import quaternion
from app.rig.grip.body_size import leg_size
from app.rig.grip.grip_pose import hand_targets
from app.rig.skeleton import forward, rest_positions
from metadata.load import load_body, load_skeleton
from tests.support.performed import perform
from tests.unit.motion import figure
from tests.unit.motion.events import REASON, TICKS, breath, cue, fingerings, plan_of, press, slide

CHARACTER = figure.character()
SLIDE_M = 0.35
HOLD = figure.hold(CHARACTER.skeleton, SLIDE_M)
MAP = figure.instrument_map(press(), slide())
BODY = load_body()
PROFILE = load_skeleton()
FPS = Fraction(60)


def gestures(end_s: float, seed: int = 0, beat_s: float = 0.5) -> tuple[GestureEvent, ...]:
    """Sway on each beat, weight shifts, bell heights, and one long rest."""
    random = np.random.default_rng(seed)
    rows = [
        ("sway", t, t + beat_s, float((-1) ** i * random.uniform(0.4, 1.0)))
        for i, t in enumerate(np.arange(0.0, end_s, beat_s))
    ]
    rows += [("weight_shift", t, t + 4.0, float(random.uniform(-1, 1))) for t in np.arange(0.0, end_s - 4.0, 4.0)]
    rows += [("bell_height", t, t + 1.0, float(random.uniform(-1, 1))) for t in np.arange(0.0, end_s - 1.0, 1.5)]
    rows += [("lower_instrument", 10.5, 14.5, 1.0)]
    rows.sort(key=lambda row: row[1])
    return tuple(
        GestureEvent(f"g{i}", kind, round(start * 960), round(end * 960), float(start), float(end), amount, REASON)
        for i, (kind, start, end, amount) in enumerate(rows)
    )


@cache
def piece(player_id: str = "player", seed: int = 0) -> PlayerPlan:
    random = np.random.default_rng(7)
    rows = []
    for start_s, end_s in ((0.0, 10.0), (16.0, 24.0)):
        t = start_s
        while t < end_s:
            length_s = float(random.choice([0.25, 0.5, 1.0]))
            rows.append(
                (
                    t,
                    t + length_s,
                    {"valve_1": float(random.integers(2)), "slide": float(random.choice([0.0, 0.14, 0.29, 0.6, 1.0]))},
                )
            )
            t += length_s
    return plan_of(
        fingerings(rows),
        player_id=player_id,
        breaths=(breath(-0.5, 0.0), breath(15.5, 16.0, 1.0)),
        cues=(cue(0.0), cue(16.0)),
        gestures=gestures(24.0, seed),
    )


def made(plan: PlayerPlan | None = None, fps: Fraction = FPS, **changes: object) -> Motion:
    window = {name: changes.pop(name) for name in ("frames", "first_frame") if name in changes}
    parameters = PlayerParameters(**changes)
    return perform(
        piece() if plan is None else plan,
        parameters,
        MAP,
        CHARACTER,
        HOLD,
        BODY,
        felt_beats=((0, TICKS),),
        fps=fps,
        **window,
    )


def world(motion: Motion, *names: str) -> list[tuple[np.ndarray, np.ndarray]]:
    joints = [CHARACTER.skeleton.index(name) for name in names]
    transforms = forward(CHARACTER.skeleton, motion.rotations, motion.hips_m, joints)
    return [transforms.of(joint) for joint in joints]


def times(motion: Motion) -> np.ndarray:
    return motion.first_frame_s + np.arange(motion.frames) / float(motion.fps)


@pytest.mark.parametrize("posture", ["standing", "seated"])
@pytest.mark.parametrize("amplitude", [0.0, 0.5, 1.0])
def test_planted_feet_stay(posture: str, amplitude: float) -> None:
    motion = made(posture=posture, amplitude=amplitude)
    ankle_m = rest_positions(CHARACTER.skeleton)[CHARACTER.skeleton.index("leftFoot")]
    for position_m, _ in world(motion, "leftFoot", "rightFoot", "leftToes", "rightToes"):
        assert np.ptp(position_m, axis=0).max() < 1e-3
    for position_m, _ in world(motion, "leftFoot", "rightFoot"):
        np.testing.assert_allclose(position_m[:, 1], ankle_m[1], atol=0.3e-3)


def test_seated_hips_stay_on_the_chair() -> None:
    leans = [("lean", 2.0, 5.0, 1.0), ("lean", 5.0, 8.0, 0.0)]
    motion = made(with_gestures(*leans), posture="seated", amplitude=1.0)
    sit_bones_m = world(motion, "hips")[0][0] - quaternion.rotate(
        world(motion, "hips")[0][1], np.array([0.0, SIT_BONES_M * leg_size(CHARACTER.skeleton), 0.0])
    )
    # The pelvis leans on the seat, and does not leave it.
    assert np.ptp(motion.hips_m[:, 2]) > 0.01
    assert np.ptp(sit_bones_m, axis=0).max() < 1e-6


def with_gestures(*rows: tuple[str, float, float, float]) -> PlayerPlan:
    """The piece with more gestures."""
    more = [
        GestureEvent(f"more{i}", kind, round(start * 960), round(end * 960), start, end, amount, REASON)
        for i, (kind, start, end, amount) in enumerate(rows)
    ]
    return msgspec.structs.replace(
        piece(), gestures=tuple(sorted((*piece().gestures, *more), key=lambda event: event.start_s))
    )


FOOTWORK = with_gestures(
    ("step", 2.0, 6.0, 1.0),
    ("tap", 7.0, 7.4, -1.0),
    ("tap", 7.5, 7.9, -0.7),
    ("heel", 8.2, 9.8, 1.0),
    ("step", 17.0, 21.0, -0.6),
)


@pytest.mark.parametrize("posture", ["standing", "seated"])
def test_feet_leave_the_ground_as_planned_and_else_stand(posture: str) -> None:
    motion = made(FOOTWORK, posture=posture, amplitude=1.0)
    t = times(motion)
    ankle_m = rest_positions(CHARACTER.skeleton)[CHARACTER.skeleton.index("leftFoot")]
    for foot in ("left", "right"):
        lifted = np.zeros(len(t), np.bool_)
        for start_s, end_s in lifted_s(FOOTWORK.gestures, foot, BODY.footwork.step_s):
            here = (t > start_s) & (t < end_s)
            lifted |= here
        for name in (f"{foot}Foot", f"{foot}Toes"):
            ((place_m, _),) = world(motion, name)
            # A standing foot does not slide, and after a step it returns to its place.
            assert np.linalg.norm(np.diff(place_m, axis=0), axis=1)[~lifted[1:] & ~lifted[:-1]].max() < 1e-4
            assert np.ptp(place_m[(t < 1.9) | (t > 22.0)], axis=0).max() < 1e-3
            assert place_m[:, 1].min() > place_m[0, 1] - 1e-3
    (left_m, _), (left_toes_m, _), (right_toes_m, _) = world(motion, "leftFoot", "leftToes", "rightToes")
    out = (t > 3.0) & (t < 5.0)
    assert left_m[out, 2].min() > left_m[0, 2] + 0.06
    assert left_m[(t > 2.1) & (t < 2.5), 1].max() > ankle_m[1] + 0.03
    assert np.ptp(left_m[out], axis=0).max() < 1e-3
    # Toes tap about the heel, heels lift about the toes.
    assert right_toes_m[(t > 7.0) & (t < 7.9), 1].max() > right_toes_m[0, 1] + 0.01
    assert right_toes_m[np.searchsorted(t, 7.42), 1] < right_toes_m[0, 1] + 1e-3
    heel = (t > 8.8) & (t < 9.2)
    assert left_m[heel, 1].min() > ankle_m[1] + 0.02
    assert np.linalg.norm(left_toes_m[heel] - left_toes_m[0], axis=1).max() < 1e-3


def test_a_player_who_keeps_still_lifts_no_foot() -> None:
    motion = made(FOOTWORK, amplitude=0.0)
    for place_m, _ in world(motion, "leftFoot", "rightFoot", "leftToes", "rightToes"):
        assert np.ptp(place_m, axis=0).max() < 1e-3


def test_the_weight_goes_over_before_a_foot_steps() -> None:
    still, stepping = (made(plan, amplitude=1.0) for plan in (piece(), FOOTWORK))
    over_m = stepping.hips_m[:, 0] - still.hips_m[:, 0]
    assert over_m[np.searchsorted(times(still), 2.05)] < -0.02


@pytest.mark.parametrize("posture", ["standing", "seated"])
def test_hips_begin_and_chest_head_and_elbows_follow(posture: str) -> None:
    """In a single lean or swing, each part follows the previous one 40 to 120 ms later."""
    rows = [("sway", 1.0 + 1.2 * i, 2.2 + 1.2 * i, (-1.0) ** i) for i in range(8)]
    rows = [(kind, start_s, end_s, amount) for kind, start_s, end_s, amount in rows]
    plan = msgspec.structs.replace(piece(), gestures=with_gestures(*rows).gestures[:0], breaths=(), cues=(), poses=())
    events = [
        GestureEvent(f"s{i}", "sway", round(a * 960), round(b * 960), a, b, amount, REASON)
        for i, (_, a, b, amount) in enumerate(rows)
    ]
    motion = made(msgspec.structs.replace(plan, gestures=tuple(events)), posture=posture, amplitude=1.0)
    here = (times(motion) > 1.5) & (times(motion) < 10.0)
    leans = []
    for name in ("hips", "upperChest", "head"):
        ((_, rotation),) = world(motion, name)
        up = quaternion.rotate(rotation, np.array([0.0, 1.0, 0.0]))
        leans.append(np.arctan2(up[:, 0], up[:, 1]))
    for before, after in itertools.pairwise(leans):
        lags = range(-18, 19)
        likeness = [np.corrcoef(before[here], np.roll(after, -lag)[here])[0, 1] for lag in lags]
        assert 0.04 <= lags[int(np.argmax(likeness))] / 60.0 <= 0.12


@pytest.mark.parametrize("posture", ["standing", "seated"])
def test_hands_are_where_the_hold_puts_them(posture: str) -> None:
    motion = made(posture=posture)
    instrument = motion.instrument_position_m.astype(np.float64), motion.instrument_rotation.astype(np.float64)
    for hand in HOLD.hands:
        target_m, target = hand_targets(hand, *instrument, motion.controls)
        ((position_m, rotation),) = world(motion, f"{hand.side}Hand")
        assert np.linalg.norm(position_m - target_m, axis=1).max() < 0.5e-3
        turn = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(target), rotation))
        assert np.linalg.norm(turn, axis=1).max() < 1e-3


def test_the_rim_is_on_the_lips_while_playing_and_on_the_upper_lip_through_a_breath() -> None:
    motion = made(amplitude=1.0)
    ((head_m, head),) = world(motion, "head")
    t = times(motion)
    playing = ((t >= 0.0) & (t < 10.0)) | ((t >= 16.0) & (t < 24.0))
    contact_m = head_m + quaternion.rotate(head, HOLD.lips.contact_m(motion.morphs, motion.frames))
    assert np.linalg.norm(contact_m - motion.instrument_position_m, axis=1)[playing].max() < 0.5e-3
    full = (t > 15.72) & (t < 15.8)
    upper_m = head_m + quaternion.rotate(head, HOLD.lips.carried_m(motion.morphs, motion.frames))
    assert np.linalg.norm(upper_m - motion.instrument_position_m, axis=1)[full].max() < 0.5e-3


def test_in_a_long_rest_the_instrument_comes_down_and_is_up_before_the_breath() -> None:
    motion = made()
    t = times(motion)
    height_m = motion.instrument_position_m[:, 1]
    assert height_m[(t > 12.0) & (t < 13.0)].max() < height_m[(t > 0.0) & (t < 9.0)].min() - 0.2
    assert height_m[t >= 14.5].min() > height_m[(t > 0.0) & (t < 9.0)].min() - 0.03


def test_every_breath_shows() -> None:
    for amplitude in (0.0, 0.5, 1.0):
        motion = made(amplitude=amplitude)
        t = times(motion)
        ((_, chest),) = world(motion, "upperChest")
        up = quaternion.rotate(chest, np.array([0.0, 1.0, 0.0]))
        lean_deg = np.degrees(np.arctan2(up[:, 2], up[:, 1]))
        for event in piece().breaths:
            before = (t >= event.start_s - 0.25) & (t < event.start_s)
            during = (t >= event.start_s) & (t < event.end_s)
            assert motion.morphs["jawOpen"][during].max() > motion.morphs["jawOpen"][before].max() + 0.15
            assert lean_deg[during].min() < lean_deg[before].mean() - 1.5
            # Shut, but for the tongue's stroke.
            stroke = BODY.embouchure[MAP.embouchure.kind].tongue_stroke["jawOpen"]
            assert motion.morphs["jawOpen"][np.searchsorted(t, event.end_s)] < 0.06 + stroke


@pytest.mark.parametrize("fps", [Fraction(24), Fraction(60)])
def test_the_nod_accelerates_most_on_the_downbeat(fps: Fraction) -> None:
    motion = made(fps=fps, amplitude=1.0)
    t = times(motion)
    for event in piece().cues:
        near = (t > event.start_s) & (t < event.end_s + 0.3)
        for height_m in (motion.hips_m[:, 1].astype(float), world(motion, "head")[0][0][:, 1]):
            acceleration = np.gradient(np.gradient(height_m, t), t)
            assert t[near][acceleration[near].argmax()] == pytest.approx(event.downbeat_s, abs=1.01 / float(fps))


def sway_m(motion: Motion) -> np.ndarray:
    head_m = world(motion, "head")[0][0]
    return head_m[:, 0] - head_m[:, 0].mean()


def test_amplitude_goes_from_a_residue_to_an_exaggeration() -> None:
    sizes = [np.std(sway_m(made(amplitude=amplitude))) for amplitude in (0.0, 0.5, 1.0)]
    assert 0.0003 < sizes[0] < 0.25 * sizes[1]
    assert sizes[1] < 0.6 * sizes[2]


def test_two_players_of_one_part_do_not_move_alike() -> None:
    for amplitude in (0.0, 0.5, 1.0):
        one, other = (sway_m(made(piece(player, 0), amplitude=amplitude)) for player in ("first", "second"))
        assert abs(np.corrcoef(one, other)[0, 1]) < 0.9


def test_a_second_run_is_identical_to_the_bit_and_another_seed_is_not() -> None:
    one, two, other = made(), made(), made(seed=1)
    assert one.rotations.tobytes() == two.rotations.tobytes()
    assert one.hips_m.tobytes() == two.hips_m.tobytes()
    assert all(one.morphs[name].tobytes() == two.morphs[name].tobytes() for name in one.morphs)
    assert one.rotations.tobytes() != other.rotations.tobytes()


@pytest.mark.parametrize("fps", [Fraction(24), Fraction(30000, 1001)])
def test_a_part_equals_the_same_frames_of_the_whole(fps: Fraction) -> None:
    whole = made(fps=fps)
    part = made(fps=fps, first_frame=101, frames=97)
    here = slice(101, 198)
    assert part.first_frame_s == pytest.approx(times(whole)[101], abs=1e-9)
    np.testing.assert_allclose(part.rotations, whole.rotations[here], atol=1e-6)
    np.testing.assert_allclose(part.hips_m, whole.hips_m[here], atol=1e-6)
    np.testing.assert_allclose(part.instrument_rotation, whole.instrument_rotation[here], atol=1e-6)
    for name in whole.morphs:
        np.testing.assert_allclose(part.morphs[name], whole.morphs[name][here], atol=1e-6)
    for name in whole.controls:
        np.testing.assert_allclose(part.controls[name], whole.controls[name][here], atol=1e-6)


def test_rotations_are_unit_and_morphs_stay_in_range() -> None:
    motion = made(amplitude=1.0, embouchure_tension=3.0)
    np.testing.assert_allclose(np.linalg.norm(motion.rotations, axis=-1), 1.0, atol=1e-6)
    for values in motion.morphs.values():
        assert values.min() >= 0.0
        assert values.max() <= 1.0


@pytest.mark.parametrize("amplitude", [0.5, 1.0])
def test_no_joint_accelerates_beyond_the_human_bound(amplitude: float) -> None:
    motion = made(amplitude=amplitude)
    for name in CHARACTER.skeleton.names[1:]:
        local = motion.rotations[:, CHARACTER.skeleton.index(name)].astype(np.float64)
        velocity = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(local[:-1]), local[1:])) * 60
        acceleration = np.linalg.norm(np.diff(velocity, axis=0), axis=1) * 60
        assert acceleration.max() < BODY.limits[PROFILE.joint(name).kind].acceleration_rad_s2, name


@pytest.mark.parametrize(
    ("end_s", "fps", "frames"), [(1.0, Fraction(24), 72), (1.01, Fraction(24), 73), (0.1, Fraction(30000, 1001), 63)]
)
def test_frames_cover_the_performance(end_s: float, fps: Fraction, frames: int) -> None:
    assert frame_count(TimeFrame(-2.0, end_s), fps) == frames
