"""Time of planning, as a part of the music's own time."""

from __future__ import annotations

import time

import pytest

from app.plan.fingering.costs import fingering_problem
from app.plan.fingering.search import best_path
from app.plan.generate import MonophonicPart
from app.plan.music.piece import line_times
from app.score.metre_map import Metre
from instrument_maps.load import bundled_maps
from tests.support.plan import PlainClock, even, make_plans, piece_of, time_frame
from tests.support.woodwinds import many_keys

pytestmark = pytest.mark.bench

# 1,000 sixteenths at 150 in steps and thirds: every step is in a hurry.
PITCHES = [58 + (index * 7 + (index // 5) * 3) % 12 for index in range(1000)]
CLOCK = PlainClock(((0, 150.0),))


@pytest.mark.parametrize("name", ["trumpet_Bb", "trombone_tenor_F_attachment", "many keys"])
def test_a_thousand_hurried_notes(name: str) -> None:
    instrument = many_keys() if name == "many keys" else bundled_maps()[name]
    line = MonophonicPart("p", even(PITCHES, 120), instrument)
    frame = time_frame((line,), CLOCK)
    piece = piece_of(CLOCK, (Metre(0, 4, 4),))
    make_plans(piece, (line,), frame)
    searched, planned = [], []
    for _ in range(5):
        start = time.perf_counter()
        best_path(fingering_problem(line.notes, line_times(line, CLOCK), instrument, {}))
        searched.append(time.perf_counter() - start)
        start = time.perf_counter()
        make_plans(piece, (line,), frame)
        planned.append(time.perf_counter() - start)
    music_s = frame.end_s - frame.first_frame_s
    print(
        f"{name}: search {min(searched) * 1e3:.1f} ms, plan {min(planned) * 1e3:.1f} ms per 1,000 notes, "
        f"{music_s / min(planned):.0f} times real time"
    )
    assert min(searched) < 0.05
    assert music_s / min(planned) > 1000.0
