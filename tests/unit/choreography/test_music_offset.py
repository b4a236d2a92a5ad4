"""The offset of music is found, and reported as certain only if it is determined."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.arrays import FloatArray
from app.choreography.clip import MotionClip
from app.choreography.music_offset import CONFIDENT, find_offset, motion_beats
from app.choreography.rhythm import Rhythm
from tests.unit.choreography.test_features import random_clip


def rhythm(hits_s: FloatArray) -> Rhythm:
    """Hits over steady beats that are independent of the motion."""
    beats_s = np.arange(0.0, hits_s.max(initial=0.0), 0.5)
    strengths = np.random.default_rng(0).uniform(0.4, 1.0, len(hits_s))
    return Rhythm(beats_s, np.arange(len(beats_s)) % 4, hits_s, np.zeros(len(hits_s), np.int64), strengths, False)


def danced(clip: MotionClip, offset_s: float, seed: int) -> Rhythm:
    """Music in which most beats of the motion meet a hit within a few hundredths, and some hits meet no beat."""
    generator = np.random.default_rng(seed)
    beats_s = motion_beats(clip)[0] / float(clip.fps)
    met = generator.permutation(beats_s)[: round(0.8 * len(beats_s))] + 0.02 * generator.standard_normal(
        round(0.8 * len(beats_s))
    )
    hits_s = np.sort(np.concatenate([met, generator.uniform(0.0, clip.length_s, len(beats_s) // 5)])) - offset_s
    return rhythm(hits_s[hits_s >= 0.0])


def test_motion_beats_are_where_the_body_stops() -> None:
    clip = random_clip(4, 1801)
    stops = np.array([120, 400, 555, 900, 1500])
    # Time of the motion is constant at these frames.
    frames = np.arange(1801.0)
    speed = 1.0 - np.exp(-0.5 * ((frames[:, None] - stops) / 6.0) ** 2).sum(axis=1)
    warped = np.interp(np.cumsum(speed), frames, frames)
    near = np.round(warped).astype(int)
    stopped = replace(clip, rotations=clip.rotations[near], hips_m=clip.hips_m[near])
    found, strengths = motion_beats(stopped)
    assert (np.abs(found[:, None] - stops).min(axis=0) <= 3).all()
    assert strengths.max() == 1.0


@pytest.mark.parametrize("offset_s", [-4.37, 0.0, 2.5, 6.123])
@pytest.mark.parametrize("seed", [1, 2])
def test_music_is_found_where_it_was_put(offset_s: float, seed: int) -> None:
    clip = random_clip(seed, 1801)
    found = find_offset(clip, danced(clip, offset_s, seed))
    assert found.offset_s == pytest.approx(offset_s, abs=0.03)
    assert found.confidence > CONFIDENT


@pytest.mark.parametrize("seed", range(4))
def test_an_arbitrary_pairing_has_no_confidence(seed: int) -> None:
    clip = random_clip(1, 1801)
    assert find_offset(clip, danced(random_clip(10 + seed, 1801), 0.0, seed)).confidence < CONFIDENT


def test_music_that_repeats_leaves_open_where_it_begins() -> None:
    clip = random_clip(1, 1801)
    assert find_offset(clip, rhythm(np.arange(0.0, 60.0, 0.5))).confidence < CONFIDENT


def test_without_beats_there_is_no_confidence() -> None:
    clip = random_clip(1, 1801)
    still = replace(clip, rotations=np.repeat(clip.rotations[:1], 1801, axis=0), hips_m=np.ones((1801, 3)))
    assert find_offset(still, rhythm(np.arange(4.0))).confidence == 0.0
    assert find_offset(clip, rhythm(np.zeros(0))).confidence == 0.0
    assert find_offset(clip.span(0, 1), rhythm(np.arange(4.0))).confidence == 0.0


@pytest.mark.parametrize("seed", range(6))
def test_unrelated_music_that_is_long_enough_sounds_during_the_whole_motion(seed: int) -> None:
    clip = random_clip(1, 1201)
    hits_s = np.cumsum(np.random.default_rng(seed).uniform(0.1, 1.2, 200))
    found = find_offset(clip, rhythm(hits_s))
    assert found.offset_s <= 0.0
    assert found.offset_s + hits_s[-1] >= clip.length_s - 0.01


def test_music_that_clearly_ends_within_the_motion_is_found_there() -> None:
    clip = random_clip(1, 1801)
    beats_s = motion_beats(clip)[0] / float(clip.fps)
    # A long piece before, then the danced hits, which end in the middle of the motion.
    before_s = np.cumsum(np.random.default_rng(5).uniform(0.1, 1.2, 100))
    danced_s = before_s[-1] + 0.7 + beats_s[beats_s < 0.7 * clip.length_s]
    found = find_offset(clip, rhythm(np.concatenate([before_s, danced_s])))
    assert found.offset_s == pytest.approx(-before_s[-1] - 0.7, abs=0.03)
    assert found.confidence > CONFIDENT
