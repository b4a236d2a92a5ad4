"""Blends at seams: many at once are the same as one after another, and continue the old motion."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import FloatArray, IntArray
from app.choreography.body import SEGMENTS
from app.choreography.joins import FADE_S
from app.choreography.seam_blends import HipsOnTheWay, Seams, blend_rotations
from app.rig import quaternion

RATE = 60.0
HINGES = np.array([[0.0, 2.4], [0.0, 2.4], [-2.5, 0.0], [-2.5, 0.0]])


def motions(starts: list[int], frames: int, seed: int) -> tuple[FloatArray, IntArray, Seams]:
    """Return rotations of one slow motion from each start to the next, with a frame more at each end, and the rows
    shown."""
    random = np.random.default_rng(seed)
    edges = [0, *starts, frames]
    rows, shown = [], []
    for first, stop in pairwise(edges):
        pose, speed = (random.normal(0.0, size, (len(SEGMENTS), 3)) for size in (0.25, 0.6))
        shown += [len(rows) + at for at in range(stop - first)]
        rows += [pose + speed * at / RATE for at in range(stop - first + 1)]
    seams = Seams(np.array(starts, np.int64), np.array([start + 1 + at for at, start in enumerate(starts)], np.int64))
    return quaternion.from_rotation_vector(np.array(rows)), np.array(shown), seams


@given(lengths=st.lists(st.integers(1, 45), min_size=2, max_size=9), seed=st.integers(0, 99))
def test_seams_blended_together_are_as_blended_one_after_another(lengths: list[int], seed: int) -> None:
    edges = np.cumsum(lengths).tolist()
    together, shown, seams = motions(edges[:-1], edges[-1], seed)
    alone = together.copy()
    blend_rotations(together, shown, seams, HINGES, RATE)
    for at, (start, row) in enumerate(zip(*seams, strict=True)):
        # Only what is seen until the next seam.
        until = seams.frames[at + 1] if at + 1 < len(seams.frames) else len(shown)
        blend_rotations(alone, shown[:until], Seams(np.array([start]), np.array([row])), HINGES, RATE)
    assert together[shown] == pytest.approx(alone[shown], abs=1e-12)


def test_a_blend_goes_on_as_the_old_motion_and_ends_in_the_new_one() -> None:
    captured, shown, seams = motions([90], 200, 3)
    blended = captured.copy()
    blend_rotations(blended, shown, seams, np.tile([-9.0, 9.0], (4, 1)), RATE)
    faded = 90 + round(FADE_S * RATE)
    assert np.array_equal(blended[shown[:90]], captured[shown[:90]])
    assert quaternion.dot(blended, captured)[shown[faded:]] == pytest.approx(1.0)
    steps = quaternion.to_rotation_vector(
        quaternion.multiply(blended[shown[1:]], quaternion.conjugate(blended[shown[:-1]]))
    )
    old, seam, after = steps[87], steps[89], steps[90]
    assert np.abs(seam - old).max() < 0.004
    assert np.abs(after - old).max() < 0.02
    jump = quaternion.to_rotation_vector(
        quaternion.multiply(captured[shown[90]], quaternion.conjugate(captured[shown[89]]))
    )
    assert np.abs(jump).max() > 0.2


def test_hips_go_on_as_before_and_end_where_the_new_motion_is() -> None:
    way = HipsOnTheWay(RATE, 120)
    times_s = np.arange(61) / RATE
    old, new = times_s[:, None] * np.array([0.6, 0.0, 0.3]), np.array([0.2, 0.9, 0.1]) - times_s[:, None] * 0.4
    way.append(0, old, seam=False)
    way.append(60, new, seam=True)
    speeds = np.diff(way.hips, axis=0) * RATE
    assert speeds[60] == pytest.approx(speeds[58], abs=0.05)
    assert np.abs(np.diff(speeds, axis=0)).max() < 0.8
    assert way.hips[60 + round(FADE_S * RATE) :] == pytest.approx(new[round(FADE_S * RATE) : -1])
    assert way.place(61) == complex(way.hips[60, 2], way.hips[60, 0])
    assert way.lately(1, 1.0) is None
