"""Dances end with the last accent of the music, facing the audience."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.choreography.accent_grid import grid_of
from app.choreography.coming_to_rest import GOES_ON_S
from app.choreography.dance import Dance, Manner
from app.choreography.dance_ends import danced_grid, odds_of_ends
from app.choreography.generate import Choreographer
from app.choreography.model import ChoreographyModel, MotionSegment
from app.choreography.rhythm import Rhythm
from app.choreography.sequence import Constraints
from app.choreography.steering import Ahead
from tests.support.dances import beaten, model, stepping

FPS = Fraction(30)


@cache
def turning() -> ChoreographyModel:
    """A model whose dancers turn to and fro by 80 degrees."""
    usual, clips = model(), []
    for clip in usual.clips:
        turn_rad = 1.4 * np.sin(np.arange(len(clip)) / 60.0 * 2.1)
        turned = Rotation.from_rotvec(turn_rad[:, None] * (0.0, 1.0, 0.0)) * Rotation.from_quat(clip.rotations[:, 0])
        rotations = clip.rotations.copy()
        rotations[:, 0] = turned.as_quat()
        clips.append(replace(clip, rotations=rotations))
    return replace(usual, clips=tuple(clips))


@cache
def choreographer() -> Choreographer:
    return Choreographer(turning())


def faces_deg(dance: Dance) -> float:
    ahead = Rotation.from_quat(dance.clip.rotations[-1, 0]).apply((0.0, 0.0, 1.0))
    return float(np.degrees(np.arctan2(ahead[0], ahead[2])))


def ending() -> Rhythm:
    """Four bars of four beats, and a hit on the next downbeat in a bar that is silent afterwards."""
    beats = beaten(20)
    heard = beats.hits_s <= 8.0
    return replace(beats, hits_s=beats.hits_s[heard], symbols=beats.symbols[heard], strengths=beats.strengths[heard])


@pytest.mark.parametrize("beat_s", [0.36, 0.55])
def test_a_dance_ends_facing_the_audience(beat_s: float) -> None:
    ends = [abs(faces_deg(choreographer().dance(beaten(24, beat_s), Manner(seed=seed), FPS))) for seed in range(6)]
    assert max(ends) < 35.0


def test_a_dance_ends_with_the_last_hit_and_not_with_its_bar() -> None:
    dance = choreographer().dance(ending(), Manner(seed=1), FPS)
    last = dance.steps[-1]
    assert 7.0 < last.accent_s <= 8.05
    assert last.end_s <= 8.0 + GOES_ON_S + 1e-6


def test_a_motion_that_the_user_placed_after_the_last_hit_is_danced() -> None:
    rhythm = choreographer().felt(ending())
    grid = grid_of(rhythm)
    place = len(grid.times_s) - 2
    assert grid.times_s[place] > rhythm.closes_s
    dance = choreographer().dance(rhythm, Manner(), FPS, constraints=Constraints(segments={place: 7}))
    (accent_s,) = (step.accent_s for step in dance.steps if (step.segment, step.place) == (7, place))
    assert accent_s == pytest.approx(grid.times_s[place], abs=1e-3)


def test_a_bar_is_begun_after_the_drums_and_without_hits_all_beats_are_danced() -> None:
    beats = beaten(16)
    early = replace(beats, hits_s=np.array([0.0, 1.0]), symbols=beats.symbols[:2], strengths=beats.strengths[:2])
    assert danced_grid(early, ()).times_s[-1] == 6.0
    silent = replace(beaten(8), hits_s=np.zeros(0), symbols=np.zeros(0, np.int64), strengths=np.zeros(0))
    assert danced_grid(silent, ()).times_s[-1] == silent.beats_s[-1]
    nothing = replace(silent, beats_s=np.zeros(0), bar_beats=np.zeros(0, np.int64))
    assert not len(danced_grid(nothing, ()).times_s)


def test_motions_that_turn_away_are_not_the_last_ones() -> None:
    clip = stepping(8)
    turn_rad = np.concatenate([np.zeros(60), np.linspace(0.0, 2.0, 61), np.full(len(clip) - 121, 2.0)])
    rotations = clip.rotations.copy()
    rotations[:, 0] = Rotation.from_rotvec(turn_rad[:, None] * (0.0, 1.0, 0.0)).as_quat()
    segments = [MotionSegment(0, 60 * at, 60 * at + 30, 60 * at + 60, 0) for at in range(3)]
    last, closing = odds_of_ends([replace(clip, rotations=rotations)], segments, [0.5, 1.5, 2.5])
    assert closing == pytest.approx([0.0, -3.0 * (2.0 * 59 / 60) ** 2, 0.0], abs=1e-6)
    assert last[1] < -2.0 < -1e-6 < last[0] == pytest.approx(last[2], abs=1e-6)


def test_the_last_runs_are_steered_by_where_they_lead() -> None:
    fps = 30.0
    turns_rad = [np.linspace(0.2, 0.5, 31), np.linspace(-1.0, -0.4, 31), np.linspace(2.0, 2.6, 31)]
    rotations = np.zeros((93, 16, 4))
    rotations[:, 0] = Rotation.from_rotvec(np.concatenate(turns_rad)[:, None] * (0.0, 1.0, 0.0)).as_quat()
    ahead = Ahead.of(rotations, np.array([0, 30, 60, 90]), 85, fps)
    # The first run begins more than two and a half seconds before the end.
    assert np.angle(ahead.faces) == pytest.approx([np.mean(turns_rad[0][:30]), 0.05, 2.45], abs=0.07)
    turn, _ = ahead.steered(2, 0.1, 0.0j, 0.0j, 0.0j)
    assert turn == pytest.approx(0.1 - np.radians(70.0))
    assert ahead.steered(1, 0.0, 0.0j, 0.0j, 0.0j) == (0.0, 0.0j)
