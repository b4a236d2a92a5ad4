"""Feet take time to move between places."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from app.arrays import BoolArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import foot_contacts, tips_m
from app.choreography.foot_plants import STEP_S, FootPlant, stands
from app.choreography.limbs import FOLDED_RAD, HINGES, STRETCHED_RAD, hinge_ranges, unbroken, within_hinges
from app.choreography.standing_feet import DEEPER, HIGHER, planted
from app.rig import quaternion
from tests.support.dance_measures import angular_jumps
from tests.support.dances import SHANK_M, THIGH_M, stepping, still
from tests.unit.choreography.test_joint_changes import world_jumps_rad_s
from tests.unit.choreography.test_spins import spinning


def carried(way_m: float) -> tuple[MotionClip, BoolArray]:
    """Standing body that is carried sideways during a short absence of its feet from the floor, as by a join."""
    clip = still(120)
    share = np.clip((np.arange(120) - 57) / 6.0, 0.0, 1.0)
    hips = clip.hips_m + way_m * share[:, None] * (1.0, 0.0, 0.0) - np.array((0.0, 0.03, 0.0))
    contacts = np.ones((120, 2), bool)
    contacts[58:63] = False
    return replace(clip, hips_m=hips), contacts


def test_a_foot_that_comes_down_elsewhere_takes_a_step() -> None:
    clip, contacts = carried(0.15)
    standing = stands(clip, contacts)
    for foot in range(2):
        before, after = (stand for stand in standing if stand.foot == foot)
        assert after.start - before.stop >= STEP_S * 60
        assert before.place_m[0] == pytest.approx(tips_m(clip)[0, foot, 0])
        assert after.place_m[0] == pytest.approx(before.place_m[0] + 0.15, abs=1e-6)
    # The hips alone accelerate the hip joints to 1.5 m/s immediately: 3 rad/s for a leg with a standing foot.
    assert angular_jumps(planted(clip, standing)).max() < 4.0


def test_a_foot_that_stands_shortly_between_two_steps_still_touches_the_floor() -> None:
    clip, frames = still(120), np.arange(120)
    share = np.clip((frames - 40) / 6.0, 0.0, 1.0) + np.clip((frames - 54) / 6.0, 0.0, 1.0)
    hips = clip.hips_m + 0.15 * share[:, None] * (1.0, 0.0, 0.0) - np.array((0.0, 0.03, 0.0))
    contacts = np.ones((120, 2), bool)
    contacts[41:46] = contacts[55:60] = False
    standing = stands(replace(clip, hips_m=hips), contacts)
    for foot in range(2):
        own = [stand for stand in standing if stand.foot == foot]
        assert len(own) == 3
        assert 46 <= own[1].start < own[1].stop <= 55
        for before, after in pairwise(own):
            assert after.start - before.stop >= STEP_S * 60 - 1


def test_a_foot_that_glides_over_the_floor_is_raised_until_it_lands() -> None:
    clip = still(120)
    share = np.clip((np.arange(120) - 45) / 30.0, 0.0, 1.0)
    lifted_m = 0.05 * np.sin(np.pi * np.clip((np.arange(120) - 45) / 10.0, 0.0, 1.0))
    hips = clip.hips_m + 0.5 * share[:, None] * (1.0, 0.0, 0.0) + (lifted_m - 0.03)[:, None] * (0.0, 1.0, 0.0)
    places = tips_m(clip)[0] + [[0.5, 0.0, 0.0]]
    standing = tuple(
        FootPlant(foot, start, stop, tuple((place - (0.5 * first, 0.0, 0.0)).tolist()))
        for foot, place in enumerate(places)
        for start, stop, first in ((0, 45, True), (75, 120, False))
    )
    tips = tips_m(planted(replace(clip, hips_m=hips), standing))
    way_m = np.linalg.norm(np.diff(tips[..., [0, 2]], axis=0), axis=-1)
    low = tips[:-1, :, 1] < tips_m(clip)[0, :, 1] + 0.007
    assert (way_m[60:75] * low[60:75]).sum(axis=0).max() < 0.03
    assert tips[75:, :, 1] == pytest.approx(places[0, 1], abs=1e-6)


def test_a_foot_that_comes_down_where_it_was_goes_on_standing() -> None:
    clip, contacts = carried(0.02)
    standing = stands(clip, contacts)
    assert [(stand.foot, stand.start, stand.stop) for stand in standing] == [(0, 0, 120), (1, 0, 120)]
    tips = tips_m(planted(clip, standing))
    assert np.ptp(tips[..., [0, 2]], axis=0).max() < 1e-6


def test_a_quick_step_of_the_motion_itself_keeps_its_time() -> None:
    clip, contacts = carried(0.15)
    lift_m = 0.08 * np.sin(np.pi * np.clip((np.arange(120) - 57) / 6.0, 0.0, 1.0))
    hips = clip.hips_m + lift_m[:, None] * (0.0, 1.0, 0.0)
    standing = stands(replace(clip, hips_m=hips), contacts)
    assert [(stand.foot, stand.start, stand.stop) for stand in standing] == [
        (0, 0, 58), (1, 0, 58), (0, 63, 120), (1, 63, 120)
    ]  # fmt: skip


def test_a_stand_much_shorter_than_captured_is_not_shown_in_haste() -> None:
    """The heel of a long stand rises and sinks twice; the music leaves a fifth of the time for it."""
    clip, frames = still(120), np.arange(120.0)
    clip = replace(clip, hips_m=clip.hips_m - (0.0, 0.03, 0.0))
    risen_rad = 0.3 * np.sin(2.0 * np.pi * np.clip((frames - 30) / 60.0, 0.0, 1.0)) ** 2
    risen = quaternion.from_rotation_vector(risen_rad[:, None] * (1.0, 0.0, 0.0))
    clip.rotations[:, SEGMENTS.index("leftFoot")] = risen
    shown = np.interp(frames, [0.0, 24.0, 54.0, 66.0, 96.0, 119.0], [0.0, 24.0, 30.0, 90.0, 96.0, 119.0])
    stand = FootPlant(0, 54, 67, tuple(tips_m(clip)[0, 0].tolist()))
    found = planted(clip, (stand,), shown=np.stack([shown, frames], axis=1))
    assert tips_m(found)[54:67, 0] == pytest.approx(np.tile(stand.place_m, (13, 1)), abs=1e-6)
    # In a fifth of the time it would turn up to 25 times as suddenly.
    assert world_jumps_rad_s(found, "leftFoot")[54:64].max() < 2.0 * world_jumps_rad_s(clip, "leftFoot").max()


def test_a_standing_foot_turns_along_with_a_body_that_turns_far_over_it() -> None:
    """A stand that the music shortens to a fifth would leave its foot turned far ahead of a spinning body."""
    clip, frames = spinning(60, 6.0, 3.0), np.arange(241.0)
    shown = np.interp(frames, [0.0, 90.0, 110.0, 122.0, 160.0, 240.0], [0.0, 90.0, 110.0, 150.0, 170.0, 240.0])
    stand = FootPlant(0, 110, 123, tuple((tips_m(clip)[110, 0] * (1.0, 0.0, 1.0)).tolist()))
    found = planted(clip, (stand,), shown=np.stack([shown, frames], axis=1))
    ankle = quaternion.to_rotation_vector(found.rotations[100:160, SEGMENTS.index("leftFoot")])[:, 1]
    assert np.abs(ankle).max() < 0.6
    assert tips_m(found)[110:123, 0] == pytest.approx(np.tile(stand.place_m, (13, 1)), abs=1e-4)


def test_the_foot_of_a_shortened_stand_stays_as_it_landed_under_a_body_that_only_sways() -> None:
    clip, frames = still(120), np.arange(120.0)
    clip = replace(clip, hips_m=clip.hips_m - (0.0, 0.03, 0.0))
    swayed = quaternion.from_axis_angle((0.0, 1.0, 0.0), 0.9 * np.sin(np.pi * np.clip((frames - 30) / 60.0, 0.0, 1.0)))
    clip.rotations[:, 0], clip.rotations[:, SEGMENTS.index("leftUpperLeg")] = swayed, quaternion.conjugate(swayed)
    shown = np.interp(frames, [0.0, 24.0, 46.0, 58.0, 96.0, 119.0], [0.0, 24.0, 30.0, 75.0, 96.0, 119.0])
    stand = FootPlant(0, 46, 59, tuple(tips_m(clip)[0, 0].tolist()))
    found = planted(clip, (stand,), shown=np.stack([shown, frames], axis=1))
    turned = found.world().rotations[46:59, 1 + SEGMENTS.index("leftFoot")]
    assert np.abs(quaternion.to_rotation_vector(turned)[:, 1]).max() < 0.1


def test_a_foot_that_a_join_lifts_before_its_contact_ends_leaves_as_it_rises() -> None:
    clip, frames = still(120), np.arange(120)
    risen_m = 0.07 * np.clip((frames - 50) / 8.0, 0.0, 1.0) + 0.05 * np.clip((frames - 58) / 20.0, 0.0, 1.0)
    contacts = np.ones((120, 2), bool)
    contacts[58:] = False
    lifted = replace(clip, hips_m=clip.hips_m + risen_m[:, None] * (0.0, 1.0, 0.0))
    assert {(stand.start, stand.stop) for stand in stands(lifted, contacts)} == {(0, 52)}
    # A contact of a foot that hardly rises ends where it ends.
    hovers = replace(clip, hips_m=clip.hips_m + 0.3 * risen_m[:, None] * (0.0, 1.0, 0.0))
    assert {(stand.start, stand.stop) for stand in stands(hovers, contacts)} == {(0, 58)}


def test_a_foot_of_a_body_that_is_kept_near_its_place_goes_on_standing() -> None:
    clip, contacts = still(120), np.ones((120, 2), bool)
    moved = np.linspace(0.5, -0.5, 120)[:, None] * np.array((0.0, 0.0, 1.0))
    kept = replace(clip, hips_m=clip.hips_m + moved)
    assert len(stands(kept, contacts)) > 2
    standing = stands(kept, contacts, moved)
    assert [(stand.foot, stand.start, stand.stop) for stand in standing] == [(0, 0, 120), (1, 0, 120)]
    # Half of the shortened way is before the foot, and half behind it.
    assert standing[0].place_m == pytest.approx(tips_m(clip)[0, 0])


def test_a_knee_that_is_a_little_more_than_straight_bends_forwards() -> None:
    clip = still(60)
    turns = clip.rotations.copy()
    back = 0.05 * np.sin(np.arange(60) / 8.0)
    for name, part in (("leftUpperLeg", -0.5), ("leftLowerLeg", 1.0)):
        turns[:, SEGMENTS.index(name)] = quaternion.from_axis_angle(np.array([1.0, 0.0, 0.0]), part * back)
    # Below the position of the straight leg there is no room for the standing foot.
    sunk = replace(clip, rotations=turns, hips_m=clip.hips_m - np.array((0.0, 0.04, 0.0)))
    found = planted(sunk, (FootPlant(0, 0, 60, (0.1, 0.0, 0.2)),))
    places_m = found.world().positions_m
    hip, knee, ankle = (places_m[:, 1 + SEGMENTS.index(f"left{name}")] for name in ("UpperLeg", "LowerLeg", "Foot"))
    assert (knee[:, 2] - 0.5 * (hip + ankle)[:, 2]).min() > 0.05
    assert angular_jumps(found).max() < 0.5


def test_a_leg_that_kicks_while_its_foot_still_stands_does_not_flip() -> None:
    # A straight leg goes up to 120 degrees; its thigh faces along the line from hip to floor on the way.
    clip = still(60)
    turns = clip.rotations.copy()
    angles = np.linspace(0.0, -2.1, 60)
    across = np.array((1.0, 0.0, 0.02)) / np.hypot(1.0, 0.02)
    turns[:, SEGMENTS.index("leftUpperLeg")] = quaternion.from_axis_angle(across, angles)
    sunk = replace(clip, rotations=turns, hips_m=clip.hips_m - np.array((0.0, 0.1, 0.0)))
    found = planted(sunk, (FootPlant(0, 0, 60, (0.1, 0.0, 0.2)),))
    for name in ("leftUpperLeg", "leftLowerLeg"):
        at = SEGMENTS.index(name)
        steps = quaternion.multiply(quaternion.conjugate(found.rotations[:-1, at]), found.rotations[1:, at])
        assert np.linalg.norm(quaternion.to_rotation_vector(steps), axis=-1).max() < 0.2


@pytest.mark.parametrize("weight", [-1.0, 0.5, 1.0])
def test_the_heavy_bend_their_knees_and_step_where_they_stepped(weight: float) -> None:
    clip = stepping(12)
    standing = stands(clip, foot_contacts(clip))
    plain, weighed = planted(clip, standing), planted(clip, standing, weight)
    lower_m = plain.hips_m[:, 1] - weighed.hips_m[:, 1]
    leg_m = THIGH_M + SHANK_M
    if weight > 0.0:
        # Straight legs come down a little to reach their places anyway.
        assert np.allclose(lower_m, weight * DEEPER * leg_m, atol=0.015)
        assert np.abs(tips_m(weighed) - tips_m(plain)).max() < 1e-6
    else:
        # Straight legs reach no higher.
        assert -HIGHER * leg_m - 1e-9 <= lower_m.min()
    for stand in standing:
        here = slice(stand.start, stand.stop)
        assert np.abs(tips_m(weighed)[here, stand.foot] - stand.place_m).max() < 1e-3
    assert np.allclose(weighed.hips_m[:, [0, 2]], plain.hips_m[:, [0, 2]])
    assert angular_jumps(weighed).max() < 2.0 * angular_jumps(plain).max() + 1.0


def test_the_hips_move_towards_a_lunging_foot_that_is_out_of_reach() -> None:
    """A foot beyond the reach of the lowest hips stays in place, and the hips move slowly towards it."""
    leg_m = THIGH_M + SHANK_M
    place_m = (0.1, 0.0, 0.2 + 0.88 * leg_m)
    found = planted(still(120), (FootPlant(0, 20, 50, place_m),))
    assert np.abs(tips_m(found)[20:50, 0] - place_m).max() < 1e-3
    way_m = found.hips_m - still(120).hips_m
    assert 0.0 < way_m[:, 2].max() < 0.05 * leg_m
    assert np.allclose(way_m[:, 0], 0.0)
    assert np.linalg.norm(np.diff(way_m[:, [0, 2]], axis=0), axis=1).max() < 0.005


def test_knees_do_not_bend_backwards() -> None:
    """A knee that moves through straight to backwards is limited; one that bends forwards is unchanged."""
    clip = still(60)
    bends_rad = np.linspace(1.0, -1.0, 60)
    turns = quaternion.from_rotation_vector(bends_rad[:, None] * np.array((1.0, 0.0, 0.0)))
    clip.rotations[:, SEGMENTS.index("leftLowerLeg")] = turns
    found = quaternion.twist_angle(unbroken(clip).rotations[:, SEGMENTS.index("leftLowerLeg")], (1.0, 0.0, 0.0))
    ahead = bends_rad >= 0.0
    assert found[ahead] == pytest.approx(bends_rad[ahead], abs=1e-12)
    assert found.min() >= -STRETCHED_RAD
    # The foot neither stops abruptly nor turns back.
    assert (np.diff(found) < 0.0).all()
    assert np.abs(np.diff(found, 2)).max() < 0.3 * np.abs(np.diff(bends_rad)).max()
    # The foot goes along, and nothing else turns.
    others = [at for at, name in enumerate(SEGMENTS) if name != "leftLowerLeg"]
    assert unbroken(clip).rotations[:, others] == pytest.approx(clip.rotations[:, others])


def test_a_knee_that_would_fold_through_the_thigh_stays_folded() -> None:
    """A bend by more than half a turn, as of a kick that fades into another motion, is not mistaken for a backward
    bend.
    """
    clip = still(61)
    bends_rad = 2.2 + 1.6 * np.sin(np.linspace(0.0, np.pi, 61))
    turns = quaternion.from_rotation_vector(bends_rad[:, None] * np.array((1.0, 0.0, 0.0)))
    clip.rotations[:, SEGMENTS.index("leftLowerLeg")] = turns
    found = quaternion.twist_angle(unbroken(clip).rotations[:, SEGMENTS.index("leftLowerLeg")], (1.0, 0.0, 0.0))
    assert found.max() < FOLDED_RAD + STRETCHED_RAD
    assert np.abs(np.diff(found)).max() < 1.01 * np.abs(np.diff(bends_rad)).max()
    kept = bends_rad < FOLDED_RAD
    assert found[kept] == pytest.approx(bends_rad[kept], abs=1e-9)


@pytest.mark.parametrize("name", list(HINGES))
def test_a_fade_that_carries_a_hinge_beyond_half_a_turn_keeps_it_in_range(name: str) -> None:
    """A knee or an elbow that a fade would bend backwards by 200 degrees stays straight until it bends forwards."""
    captured, faded = still(60), still(60)
    at, axis = SEGMENTS.index(name), np.array(HINGES[name])
    off_rad = -np.radians(200.0) * np.sin(np.pi * np.linspace(0.0, 1.0, 60)) ** 2
    for clip, bends_rad in ((captured, np.full(60, 0.4)), (faded, 0.4 + off_rad)):
        clip.rotations[:, at] = quaternion.from_rotation_vector(bends_rad[:, None] * axis)
    found = within_hinges(faded.rotations, captured.rotations, hinge_ranges([captured]))
    bends_rad = quaternion.twist_angle(found[:, at], axis)
    assert bends_rad.min() == pytest.approx(-STRETCHED_RAD, abs=1e-6)
    assert np.abs(np.diff(bends_rad)).max() <= np.abs(np.diff(off_rad)).max() + 1e-9
    ahead = 0.4 + off_rad >= 0.0
    assert bends_rad[ahead] == pytest.approx((0.4 + off_rad)[ahead])


def test_a_foot_that_steps_later_in_a_spin_turns_with_its_body() -> None:
    clip = spinning(60, 14.0, 6.0)
    frames = np.arange(len(clip), dtype=np.float64)
    late = np.clip(np.stack([frames - 14.0, frames], axis=1), 0.0, None)
    found = planted(clip, (FootPlant(0, 0, 20, (0.1, 0.0, 0.15)),), shown=late)
    at = SEGMENTS.index("leftFoot")
    turned, own = (quaternion.to_rotation_vector(one.rotations[60:180, at])[:, 1] for one in (found, clip))
    # The body turns by more than 2 radians in 14 frames.
    assert np.abs(turned - own).max() < 0.6
