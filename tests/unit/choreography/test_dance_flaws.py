"""Jerking joins and sliding feet are found, and nothing else."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from app.choreography.dance import Dance, Manner
from app.choreography.dance_flaws import jerking_seams, jolts, sliding_stands, usual_change_rad_s
from app.choreography.generate import Choreographer
from app.rig import quaternion
from tests.support.dance_measures import seam_jumps_rad_s, usual_jump_rad_s
from tests.support.dances import beaten, model

FPS = Fraction(60)


@pytest.fixture(scope="module")
def dance() -> Dance:
    return Choreographer(model()).dance(beaten(48, 0.55), Manner(), FPS)


def test_what_is_usual_is_what_the_measures_say() -> None:
    clips = model().clips
    for fps in (FPS, Fraction(30)):
        assert usual_change_rad_s(clips, fps) == pytest.approx(usual_jump_rad_s(clips, fps), rel=1e-9)
    assert usual_change_rad_s((), FPS) == 0.0


def test_a_join_shows_from_a_bound_on(dance: Dance) -> None:
    jumps = seam_jumps_rad_s(dance.clip, dance.seams)
    assert len(jumps) > 3
    for usual in (float(np.mean(jumps)) / 1.25, 1e-9, 1e9):
        expected = tuple(seam for seam, jump in zip(dance.seams, jumps, strict=True) if jump > 1.25 * usual)
        assert jerking_seams(dance.clip, dance.seams, usual) == expected
    assert jerking_seams(dance.clip, (), 0.0) == ()


def test_a_jerk_is_found_where_it_is(dance: Dance) -> None:
    usual = usual_change_rad_s(model().clips, FPS)
    assert jerking_seams(dance.clip, dance.seams, usual) == ()
    seam = dance.seams[2]
    rotations = dance.clip.rotations.copy()
    rotations[seam:, 2] = quaternion.multiply(
        quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), 0.4), rotations[seam:, 2]
    )
    assert jerking_seams(replace(dance.clip, rotations=rotations), dance.seams, usual) == (seam,)


def test_a_foot_that_slides_is_found(dance: Dance) -> None:
    assert sliding_stands(dance.clip, dance.standing) == ()
    stand = dance.standing[4]
    hips = dance.clip.hips_m.copy()
    hips[stand.start : stand.stop, 0] += np.linspace(0.0, 0.02, stand.stop - stand.start)
    found = sliding_stands(replace(dance.clip, hips_m=hips), dance.standing)
    assert stand in found
    assert all(one.start < stand.stop and stand.start < one.stop for one in found)


def test_a_jolt_is_found_anywhere_in_the_dance(dance: Dance) -> None:
    assert jolts(dance.clip, dance.seams) == ()
    free = next(frame for frame in range(200, len(dance.clip)) if all(abs(frame - seam) > 15 for seam in dance.seams))
    rotations = dance.clip.rotations.copy()
    rotations[free : free + 3, 0] = quaternion.multiply(
        quaternion.from_axis_angle(np.array([1.0, 0.0, 0.0]), 0.6), rotations[free : free + 3, 0]
    )
    (found,) = jolts(replace(dance.clip, rotations=rotations), dance.seams)
    assert (found.start, found.stop, found.parts) == (free - 1, free + 3, ("hips",))
    assert jolts(replace(dance.clip, rotations=rotations), (*dance.seams, free)) == ()
