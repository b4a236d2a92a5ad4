"""Statistics of a choreography's basic motions compared with slow counts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.choreography.features import joint_points_m, size_m
from app.choreography.hidden_markov import count
from app.choreography.hit_log_odds import learned_symbols
from app.choreography.overview import basic_motions
from tests.support.dances import SHAPE, model


def test_segments_lengths_and_sources_are_counted() -> None:
    learned = model(states=5)
    motions = basic_motions(learned)
    assert len(motions) == 5
    for state, motion in enumerate(motions):
        own = [one for one in learned.segments if one.state == state]
        assert motion.segments == len(own)
        assert motion.mean_s == pytest.approx(sum(one.end - one.start for one in own) / 60 / len(own))
        counts = {clip: sum(one.clip == clip for one in own) for clip in {one.clip for one in own}}
        assert dict(motion.sources) == counts
        assert [count for _, count in motion.sources] == sorted(counts.values(), reverse=True)


def test_the_poses_are_those_of_a_segment_of_the_state() -> None:
    learned = model(states=5)
    for state, motion in enumerate(basic_motions(learned)):
        found = []
        for one in (one for one in learned.segments if one.state == state):
            clip = learned.clips[one.clip]
            frames = [one.start, one.accent, min(one.end, len(clip) - 1)]
            # This body always faces +Z.
            points = joint_points_m(clip)[frames] - (clip.hips_m[frames] * (1, 0, 1))[:, None]
            found.append(points[..., :2] / size_m(clip))
        off = [float(np.abs(poses - motion.poses).max()) for poses in found]
        assert min(off) < 1e-9
        middle = np.mean(found, axis=0)
        # Nearest to the mean of the state, in three dimensions: in two it is among the near ones.
        distances = np.sort([np.linalg.norm(poses - middle) for poses in found])
        assert np.linalg.norm(motion.poses - middle) <= distances[min(2, len(distances) - 1)] + 1e-9
    assert SHAPE is learned.clips[0].shape


def test_symbols_that_only_smoothing_knows_are_not_learned() -> None:
    learned = model(states=3)
    symbols = [np.array([1, 1]), np.array([1, 7]), np.array([40]), np.array([], np.int64)]
    _, emission, _ = count([np.array([0, 1, 2, 1])], [symbols], 3, smoothing=0.5)
    assert learned_symbols(replace(learned, emission=emission)) == (1, 7, 40)
