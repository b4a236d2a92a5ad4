"""Feet land on the beats, with sufficient time for each step."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from app.choreography.accent_grid import grid_of
from app.choreography.contacts import foot_contacts, tips_m
from app.choreography.foot_plants import FootPlant, stands
from app.choreography.footfalls import REACH_S, on_beats, touch_leads
from app.choreography.standing_feet import planted
from tests.support.dances import beaten, stepping

FPS = 60.0


def walking(late_s: float, swing_s: float = 0.3, steps: int = 12) -> list[FootPlant]:
    """Left and right steps in turn, one per beat of half a second, all slightly late."""
    found = []
    for step in range(steps):
        start = round((0.5 * step + late_s) * FPS) if step > 1 else 0
        stop = round((0.5 * (step + 2) + late_s - swing_s) * FPS)
        found.append(FootPlant(step % 2, start, stop, (0.1 * step, 0.0, 0.0)))
    return sorted(found, key=lambda stand: (stand.start, stand.foot))


@pytest.mark.parametrize("late_s", [-0.1, -0.03, 0.0, 0.07])
def test_footfalls_near_a_beat_are_on_it(late_s: float) -> None:
    found = on_beats(walking(late_s), 420, FPS, 0.0, grid_of(beaten(14)), 0.3)
    starts_s = np.array([stand.start for stand in found.standing if stand.start]) / FPS
    assert len(starts_s) == 10
    assert np.abs(starts_s - 0.5 * np.rint(starts_s / 0.5)).max() < 0.5 / FPS + 1e-9
    assert (np.diff(found.shown, axis=0) >= 0.0).all()
    assert np.abs(found.shown - np.arange(420)[:, None]).max() <= REACH_S * FPS + 1.0


@pytest.mark.parametrize("late_s", [0.06, 0.1])
def test_feet_that_land_one_right_after_the_other_come_onto_the_beat_together(late_s: float) -> None:
    frames, standing = round(0.05 * FPS), []
    for jump in range(1, 7):
        start, stop = round((jump + late_s) * FPS), round((jump + late_s + 0.6) * FPS)
        standing += [FootPlant(foot, start + foot * frames, stop, (0.1 * jump, 0.0, 0.0)) for foot in range(2)]
    found = on_beats(standing, 480, FPS, 0.0, grid_of(beaten(16)), 0.3).standing
    starts = np.array([[stand.start for stand in found if stand.foot == foot] for foot in range(2)])
    assert (np.diff(starts, axis=0) == frames).all()
    off_s = np.abs(starts / FPS - 0.5 * np.rint(starts / FPS / 0.5)).min(axis=0)
    assert off_s.max() < 0.5 / FPS + 1e-9


def test_a_foot_that_would_land_at_once_stands_from_the_first_frame() -> None:
    """A dance may begin amid a motion, and a foot in the air would be on the floor a frame later."""
    standing = [FootPlant(0, 4, 40, (0.0, 0.0, 0.0)), FootPlant(1, 31, 70, (0.2, 0.0, 0.0))]
    found = on_beats(standing, 90, FPS, 0.0, grid_of(beaten(4)), 0.3)
    assert [stand.start for stand in found.standing] == [0, 30]
    assert found.shown[0] == pytest.approx((4.0, 0.0))
    assert (np.diff(found.shown, axis=0) >= 0.0).all()


def test_footfalls_far_from_beats_stay() -> None:
    standing = walking(0.23)
    assert on_beats(standing, 420, FPS, 0.0, grid_of(beaten(14)), 0.3).standing == tuple(standing)


def test_a_short_step_takes_longer_and_no_foot_leaves_before_the_other_has_come_down() -> None:
    standing = walking(0.05, swing_s=0.25)
    found = on_beats(standing, 420, FPS, 0.0, grid_of(beaten(14)), 0.6).standing
    for foot in range(2):
        own = [stand for stand in found if stand.foot == foot]
        for before, after in pairwise(own):
            assert 0.45 * FPS < after.start - before.stop <= 0.6 * FPS
    for stand in found[2:-1]:
        assert any(other.foot != stand.foot and other.start <= stand.start <= other.stop for other in found)


def test_no_stand_and_no_swing_is_lost_where_footfalls_crowd() -> None:
    random = np.random.default_rng(3)
    standing, at = [], 0
    for step in range(60):
        start = at + int(random.integers(2, 30))
        standing.append(FootPlant(step % 2, start, start + int(random.integers(8, 20)), (0.1 * step, 0.0, 0.0)))
        at = start
    for foot in range(2):
        own = [stand for stand in standing if stand.foot == foot]
        standing = [stand for stand in standing if stand.foot != foot] + [
            one if other is None else FootPlant(foot, one.start, min(one.stop, other.start - 2), one.place_m)
            for one, other in zip(own, [*own[1:], None], strict=True)
            if other is None or other.start - 2 > one.start
        ]
    standing.sort(key=lambda stand: (stand.start, stand.foot))
    kicks = np.where(random.uniform(size=(at + 60, 2)) < 0.02, 8.0, 1.0)
    for speeds in (None, kicks):
        found = on_beats(standing, at + 60, FPS, 0.0, grid_of(beaten(40)), 0.45, speeds)
        assert len(found.standing) == len(standing)
        for foot in range(2):
            own = [stand for stand in found.standing if stand.foot == foot]
            assert all(one.start < one.stop < other.start for one, other in pairwise(own))


def test_a_foot_shown_at_another_time_still_stands_at_its_place() -> None:
    clip = stepping(8)
    standing = (FootPlant(0, 90, 118, (0.1, 0.0, 0.2)),)
    falls = on_beats(standing, len(clip), FPS, -0.05, grid_of(beaten(8)), 0.4)
    assert falls.standing[0].start == 93
    tips = tips_m(planted(clip, falls.standing, shown=falls.shown))
    stand = falls.standing[0]
    assert np.abs(tips[stand.start : stand.stop, 0] - stand.place_m).max() < 1e-3


def test_a_last_stand_near_the_end_is_not_moved_beyond_it() -> None:
    standing = [FootPlant(0, 0, 60, (0.0, 0.0, 0.0)), FootPlant(0, 85, 91, (0.1, 0.0, 0.0))]
    # Frame 92 would be on a beat, 0.12 s after the stand begins.
    found = on_beats(standing, 91, FPS, 2.0 - 92 / FPS, grid_of(beaten(8)), 0.4)
    assert all(0 <= stand.start < stand.stop <= 91 for stand in found.standing)
    assert (np.diff(found.shown, axis=0) >= 0.0).all()


def test_a_faster_foot_is_shifted_less() -> None:
    standing = walking(0.14)
    for speed_m_s, expected_s in ((1.0, 0.0), (4.9, 0.14)):
        found = on_beats(standing, 420, FPS, 0.0, grid_of(beaten(14)), 0.3, np.full((420, 2), speed_m_s)).standing
        starts_s = np.array([stand.start for stand in found if stand.start]) / FPS
        assert np.abs(starts_s - 0.5 * np.rint(starts_s / 0.5) - expected_s).max() < 1.0 / FPS


def test_a_foot_touches_on_the_beat_where_its_stand_begins_later() -> None:
    standing, leads = walking(0.07), np.full(12, 3.0)
    found = on_beats(standing, 420, FPS, 0.0, grid_of(beaten(14)), 0.3, leads=leads).standing
    starts_s = (np.array([stand.start for stand in found if stand.start]) - 3.0) / FPS
    assert np.abs(starts_s - 0.5 * np.rint(starts_s / 0.5)).max() < 0.5 / FPS + 1e-9


def test_touches_before_stands_are_found_in_the_motion() -> None:
    clip = stepping(8)
    standing = stands(clip, foot_contacts(clip))
    assert not touch_leads(clip, standing).any()
    later = [FootPlant(one.foot, one.start + 4 * bool(one.start), one.stop, one.place_m) for one in standing]
    found = touch_leads(clip, later)
    assert [lead == 4.0 for lead in found] == [one.start > 0 for one in later]
    earlier = [FootPlant(one.foot, max(one.start - 4, 0), one.stop, one.place_m) for one in standing]
    assert not touch_leads(clip, earlier).any()


def test_a_foot_that_has_time_after_a_kick_lands_on_the_beat() -> None:
    standing, speeds = walking(0.07), np.ones((420, 2))
    kick = standing[6]
    fast = kick.start - 12
    speeds[fast, kick.foot] = 8.0
    found = on_beats(standing, 420, FPS, 0.0, grid_of(beaten(14)), 0.3, speeds)
    (landed,) = (stand for stand in found.standing if stand.foot == kick.foot and stand.place_m == kick.place_m)
    assert landed.start == kick.start - 4
    # Up to the kick the foot moves with the body.
    assert found.shown[fast, kick.foot] == pytest.approx(fast)


def test_a_foot_that_kicks_comes_down_as_the_body_has_it() -> None:
    standing, speeds = walking(0.07), np.ones((420, 2))
    kick = standing[6]
    speeds[kick.start - 5, kick.foot] = 8.0
    found = on_beats(standing, 420, FPS, 0.0, grid_of(beaten(14)), 0.3, speeds).standing
    assert [one.start == other.start for one, other in zip(standing, found, strict=True)] == [
        one.start == 0 or one is kick for one in standing
    ]
