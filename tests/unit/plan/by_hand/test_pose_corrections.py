"""Pose corrections become events within the body's limits, with sufficiently slow fades."""

from __future__ import annotations

import math

import pytest

from app.plan.by_hand.corrections import PoseCorrection
from app.plan.by_hand.pose_corrections import BELL_LEFT, BELL_UP, NECK_SHARES, TRUNK_SHARES, plan_poses, pose_limits
from app.plan.parameters import PlayerParameters
from instrument_maps.load import bundled_maps
from metadata.load import load_body
from tests.support.plan import PlainClock

CLOCK = PlainClock(((0, 120.0),))
TRUMPET = next(instrument for id, instrument in bundled_maps().items() if id.startswith("trumpet"))
STANDING = PlayerParameters()


def test_ticks_become_seconds_and_the_longer_fade_is_kept() -> None:
    item = PoseCorrection("a", "bell", 960, 1920, up_deg=6.0, fade_in_ticks=480, fade_out_ticks=960)
    (event,), problems = plan_poses((item,), TRUMPET, STANDING, CLOCK)
    assert not problems
    assert (event.id, event.target, event.up_deg) == ("pose:a", "bell", 6.0)
    assert (event.start_s, event.end_s) == (1.0, 2.0)
    assert (event.fade_in_s, event.fade_out_s) == (0.5, 1.0)
    assert event.corrected


@pytest.mark.parametrize("angle_deg", [2.0, 12.0, 40.0])
def test_without_a_fade_it_comes_as_quickly_as_is_gentle(angle_deg: float) -> None:
    item = PoseCorrection("a", "left_elbow", 960, 1920, up_deg=angle_deg, fade_in_ticks=-99)
    (event,), _ = plan_poses((item,), TRUMPET, STANDING, CLOCK)
    peak_rad_s2 = 10.0 / math.sqrt(3.0) * math.radians(angle_deg) / event.fade_in_s**2
    assert peak_rad_s2 <= 40.0 + 1e-9
    assert event.fade_in_s == event.fade_out_s
    assert 0.15 <= event.fade_in_s <= 0.4


def test_what_a_body_cannot_do_is_held_back_and_reported() -> None:
    most = pose_limits("head", TRUMPET, STANDING, load_body())["left_deg"][1]
    items = (
        PoseCorrection("far", "head", 960, 1920, left_deg=80.0, up_deg=2.0),
        PoseCorrection("near", "head", 960, 1920, left_deg=most),
    )
    events, problems = plan_poses(items, TRUMPET, STANDING, CLOCK)
    assert {event.left_deg for event in events} == {16.0}
    (problem,) = problems
    assert problem.message.id == "pose.beyond_reach"
    assert problem.message.arguments == {"target": "head", "angle": "left", "asked_deg": 80.0, "most_deg": 16.0}
    assert (problem.start_s, problem.end_s) == (1.0, 2.0)


def test_an_elbow_has_one_angle() -> None:
    assert pose_limits("left_elbow", TRUMPET, STANDING, load_body()).keys() == {"up_deg"}
    item = PoseCorrection("a", "right_elbow", 0, 960, up_deg=10.0, left_deg=30.0, roll_deg=30.0)
    (event,), problems = plan_poses((item,), TRUMPET, STANDING, CLOCK)
    assert (event.up_deg, event.left_deg, event.roll_deg) == (10.0, 0.0, 0.0)
    assert not problems


@pytest.mark.parametrize("posture", ["standing", "seated"])
@pytest.mark.parametrize("target", ["bell", "head", "torso", "left_elbow", "right_elbow"])
def test_limits_lie_around_nothing(target, posture) -> None:  # type: ignore[no-untyped-def]
    for instrument in bundled_maps().values():
        limits = pose_limits(target, instrument, PlayerParameters(posture=posture), load_body())
        for low, high in limits.values():
            # An instrument that rests on the lap leaves its bell little room.
            least = 1.0 if target == "bell" else 5.0
            assert low <= -least
            assert high >= least


def test_shares_make_the_whole_angle() -> None:
    for shares in (TRUNK_SHARES, NECK_SHARES, BELL_UP, BELL_LEFT):
        assert sum(shares.values()) == pytest.approx(1.0)
