"""Speed of learning: ten minutes of motion in less than 60 s, ten times faster than real time."""

from __future__ import annotations

import time

import numpy as np
import pytest

from app.choreography.learn import Pair, learn
from app.choreography.model_file import decode_model, encode_model
from app.choreography.rhythm import Rhythm
from tests.unit.choreography.test_features import random_clip

MINUTES = 10
REAL_TIME_RATIO = 10.0


@pytest.mark.bench
def test_learning_is_far_faster_than_real_time() -> None:
    """All motions differ, which is the most work for k-means, and offsets must be found too."""
    hits_s = np.cumsum(np.random.default_rng(1).choice([0.25, 0.5], 600))
    beats_s = np.arange(0.0, 240.0, 0.5)
    drums = Rhythm(beats_s, np.arange(480) % 4, hits_s, np.arange(600) % 47, np.ones(600), derived=False)
    pairs = [Pair(random_clip(seed, 60 * 60), f"{seed}.bvh", drums, "drums.mid") for seed in range(MINUTES)]
    start_s = time.perf_counter()
    model = learn(pairs, states=None, seed=0, name="long")
    learned_s = time.perf_counter()
    decode_model(encode_model(model), "x")
    filed_s = time.perf_counter()
    ratio = 60.0 * MINUTES / (learned_s - start_s)
    print(
        f"\nlearning: {ratio:.0f} x real time ({len(model.segments)} segments, {model.states} states); "
        f"writing and reading the file {60.0 * MINUTES / (filed_s - learned_s):.0f} x"
    )
    assert ratio > REAL_TIME_RATIO
