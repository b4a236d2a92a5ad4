"""Speed of complete generation: the bundled quartet, planned and moved with its own characters and grips."""

from __future__ import annotations

import time
from fractions import Fraction
from pathlib import Path

import pytest

from app.performance.ensemble import Performance
from app.performance.span import whole_span
from app.project.model import map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.support.performed import player_motion

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
REAL_TIME_RATIO = 300.0


@pytest.mark.bench
def test_the_quartet_is_generated_faster_than_it_is_played() -> None:
    maps = bundled_maps()
    project = project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)
    times_s = []
    for _ in range(3):
        performance = Performance(project)
        start_s = time.perf_counter()
        span = whole_span(performance.time_frame, Fraction(60))
        motions = [player_motion(performance, player, span) for player in project.players]
        times_s.append(time.perf_counter() - start_s)
        played_s = sum(motion.frames for motion in motions) / 60.0
    ratio = played_s / min(times_s)
    print(f"\nquartet: plan, motion and contact {ratio:.0f} x real time per player at 60 frames/s")
    assert ratio >= REAL_TIME_RATIO
