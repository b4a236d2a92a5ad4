"""Dances begin and end in a natural stand, and not on a raised leg."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from app.choreography.body import FEET, SEGMENTS
from app.choreography.body_speeds import runs
from app.choreography.coming_to_rest import RESTS_S, between_stands, captured_stands
from app.choreography.contacts import tips_m
from app.choreography.dance import Dance, Manner
from app.choreography.feet_on_floor import soles_m
from app.choreography.formation import Role, dance_together
from app.choreography.generate import Choreographer
from app.choreography.limbs import hinge_ranges
from app.rig import quaternion
from tests.support.dances import beaten, model, stepping

FPS = Fraction(30)


@cache
def choreographer() -> Choreographer:
    return Choreographer(model())


def dance(seed: int) -> Dance:
    return choreographer().dance(beaten(12), Manner(seed=seed), FPS, first_s=-3.0, end_s=9.0)


@pytest.mark.parametrize("seed", range(3))
def test_a_dance_begins_and_ends_in_a_stand_with_both_soles_on_the_floor(seed: int) -> None:
    found = dance(seed)
    joints_m, soles = found.clip.world().positions_m, soles_m(found.clip, found.clip.world())
    ankles = [1 + SEGMENTS.index(name) for name in FEET]
    for edge in (slice(0, 15), slice(-15, None)):
        assert np.abs(soles[edge]).max() < 0.015
        assert np.abs(np.diff(joints_m[edge], axis=0)).max() * float(FPS) < 0.08
        assert np.ptp(joints_m[edge][:, ankles], axis=0).max() < 0.001
        between = joints_m[edge][:, ankles].mean(axis=1) - found.clip.hips_m[edge]
        assert np.linalg.norm(between[:, [0, 2]], axis=1).max() < 0.12
    assert {stand.foot for stand in found.standing if stand.stop == len(found.clip)} == {0, 1}


def test_a_raised_foot_is_put_down_after_the_last_motion_in_half_a_second() -> None:
    clip = stepping(8)
    lifted = soles_m(clip, clip.world()).max(axis=(1, 2))
    stop = 15 + 30 * 3
    assert lifted[stop - 1] > 0.1
    shown = replace(clip, rotations=clip.rotations[:stop].repeat([1] * (stop - 1) + [121], axis=0))
    shown = replace(shown, hips_m=clip.hips_m[: stop + 120])
    contacts = np.ones((len(shown), 2), bool)
    contacts[stop - 10 :] = soles_m(clip, clip.world())[stop - 1].max(axis=1) < 0.01
    moved_m = np.zeros((len(shown), 3))
    stands = captured_stands([clip], hinge_ranges([clip]))
    rested, _, standing = between_stands(shown, moved_m, contacts, (0, stop), stands)
    assert np.array_equal(rested.rotations[:stop], shown.rotations[:stop])
    assert standing[stop + round(RESTS_S * 60) :].all()
    assert not standing[stop : stop + 20].all(axis=1).any()
    soles = soles_m(rested, rested.world())
    assert soles[stop + round(RESTS_S * 60) :].max() < 0.005
    # The other foot does not move.
    (stays,) = np.flatnonzero(contacts[-1])
    assert np.abs(soles[stop:, stays]).max() < 0.03


def test_a_dancer_turns_towards_the_audience_while_coming_to_rest() -> None:
    clip, stop = stepping(8), 15 + 30 * 3
    turn = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), 0.8)
    rotations = clip.rotations[:stop].repeat([1] * (stop - 1) + [121], axis=0)
    rotations[:, 0] = quaternion.multiply(turn, rotations[:, 0])
    shown = replace(clip, rotations=rotations, hips_m=clip.hips_m[: stop + 120])
    contacts = soles_m(shown, shown.world()).max(axis=2) < 0.01
    rested, *_ = between_stands(
        shown, np.zeros((len(shown), 3)), contacts, (0, stop), captured_stands([clip], hinge_ranges([clip]))
    )
    assert quaternion.twist_angle(rested.rotations[-1, 0], (0.0, 1.0, 0.0)) == pytest.approx(0.3, abs=0.05)
    (stays,) = np.flatnonzero(contacts[stop - 1])
    ankle = 1 + SEGMENTS.index(FEET[stays])
    foot_rad = quaternion.twist_angle(rested.world().rotations[stop - 1 :, ankle], (0.0, 1.0, 0.0))
    assert np.ptp(foot_rad[[0, -1]]) < 0.02


def test_without_time_there_is_no_stand() -> None:
    clip = stepping(4)
    contacts = np.ones((len(clip), 2), bool)
    stands = captured_stands([clip], hinge_ranges([clip]))
    rested, *_ = between_stands(clip, np.zeros((len(clip), 3)), contacts, (10, len(clip) - 10), stands)
    assert np.array_equal(rested.rotations, clip.rotations)


@pytest.mark.parametrize("bpm", [66, 112, 200])
def test_the_last_stand_is_held_for_a_second_at_all_tempi(bpm: int) -> None:
    rhythm = beaten(16, 60.0 / bpm)
    (found,) = dance_together(choreographer(), rhythm, (Role(Manner(seed=1), 0.0, 0.0),), FPS)
    start_s, stop_s = max(still_s(found), key=lambda span: span[1] - span[0])
    assert stop_s - start_s > 1.0
    assert rhythm.end_s < start_s < rhythm.end_s + 1.5


@pytest.mark.parametrize("seed", range(3))
def test_a_dancer_who_waits_is_no_statue_and_keeps_both_feet_in_place(seed: int) -> None:
    found = choreographer().dance(beaten(12), Manner(seed=seed), FPS, first_s=-8.0, end_s=16.0)
    assert 1.0 < max(stop_s - start_s for start_s, stop_s in still_s(found)) < 2.2
    tips, fps = tips_m(found.clip), float(FPS)
    for here in (slice(0, round(6.0 * fps)), slice(-round(8.0 * fps), None)):
        assert np.ptp(tips[here], axis=0).max() < 0.001
        speeds_m_s = np.linalg.norm(np.diff(found.clip.world().positions_m[here], axis=0), axis=-1) * fps
        assert speeds_m_s.max() < 0.12
    other = choreographer().dance(beaten(12), Manner(seed=seed + 1), FPS, first_s=-8.0, end_s=16.0)
    assert not np.allclose(found.clip.rotations[:30, 1], other.clip.rotations[:30, 1], atol=1e-4)


def test_a_dance_comes_to_rest_before_an_early_end() -> None:
    found = choreographer().dance(beaten(24), Manner(seed=1), FPS, end_s=9.0)
    assert found.steps[-1].end_s > 10.0
    assert still_s(found)[-1][0] < 8.0
    assert all(seam < 8.0 * float(FPS) for seam in found.seams)


def still_s(dance: Dance) -> list[tuple[float, float]]:
    """Spans in seconds in which no joint moves by 2 cm/s."""
    moves_m = np.linalg.norm(np.diff(dance.clip.world().positions_m, axis=0), axis=-1).max(axis=1)
    slow = moves_m * float(FPS) < 0.02
    return [(dance.first_s + start / float(FPS), dance.first_s + stop / float(FPS)) for start, stop in runs(slow)]
