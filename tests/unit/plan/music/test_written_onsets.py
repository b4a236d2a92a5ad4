"""Written position in its bar of a played note."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.plan.generate import MonophonicPart
from app.plan.music.notation import DIVISIONS, notated, simplest_places, written_onsets
from app.plan.music.piece import line_times
from tests.support.plan import PlainClock, line_of, make_plans, piece_of, time_frame, valves

QUARTER = 480
BARS = np.arange(0, 9600, 4 * QUARTER)


def test_played_onsets_stand_where_they_would_be_written() -> None:
    # Eighths, triplets and sixteenths, up to 15 ms early or late at 120 quarters a minute.
    written = np.array([0, 240, 480, 640, 800, 960, 1080, 1200, 1320, 1440])
    late = np.array([9, -14, 3, 14, -7, -11, 5, 14, -3, -9])
    assert written_onsets(np.maximum(written + late, 0), QUARTER, BARS).tolist() == written.tolist()


def test_written_onsets_are_kept_to_the_tick() -> None:
    thirty_seconds = np.arange(0, 1920, 60)
    assert written_onsets(thirty_seconds, QUARTER, BARS) is thirty_seconds
    assert written_onsets(np.append(thirty_seconds, 1931), QUARTER, BARS)[-1] == 1931


def test_a_silence_is_no_longer_than_the_written_step() -> None:
    """Two notes 40 ms apart with the same written position, among notes off the grid."""
    onsets = [11, 490, 530, 1013, 1451, 1931]
    clock = PlainClock()
    line = MonophonicPart("p", line_of(*((onset, 10, 65) for onset in onsets)), valves())
    score = notated(line_times(line, clock), piece_of(clock))
    assert (score.silence_tick[1:] <= np.diff(score.onset_tick)).all()
    assert (score.played_end_tick >= score.onset_tick).all()
    assert make_plans(piece_of(clock), (line,), time_frame((line,), clock))["p"].breaths


def test_a_played_note_stands_at_the_simplest_place_near() -> None:
    """At a fast tempo a few milliseconds are a large part of a beat, but not a twelfth of a quarter."""
    clock = PlainClock(((0, 200.0),))
    late_s = [0.0, 0.012, -0.013, 0.011, -0.012, 0.0, 0.013, 0.01]
    onsets = [round(QUARTER * (place + 1 + late * 200.0 / 60.0)) for place, late in enumerate(late_s)]
    line = MonophonicPart("p", line_of(*((onset, 430, 65) for onset in onsets)), valves())
    score = notated(line_times(line, clock), piece_of(clock))
    assert score.onset_tick.tolist() == [QUARTER * (place + 1) for place in range(len(onsets))]
    # They end 20 to 60 ms early, which is no rest.
    assert score.silence_tick[1:].tolist() == [0] * (len(onsets) - 1)


@given(st.lists(st.sampled_from([240, 480, 720, 960]), min_size=40, max_size=40), st.integers(0, 1000))
def test_a_played_line_is_written_as_it_was_meant(steps: list[int], seed: int) -> None:
    """At 120 quarters a minute, up to 40 ms early or late."""
    clock, random = PlainClock(), Random(seed)
    written = np.concatenate(([0], np.cumsum(steps)))[:-1] + QUARTER
    played = [tick + random.randint(-38, 38) for tick in written.tolist()]
    lasts = [round(random.uniform(0.7, 0.9) * step) for step in steps]
    rows = [(onset, ticks, 65 + index % 3) for index, (onset, ticks) in enumerate(zip(played, lasts, strict=True))]
    score = notated(line_times(MonophonicPart("p", line_of(*rows), valves()), clock), piece_of(clock))
    assert score.onset_tick.tolist() == written.tolist()


@pytest.mark.parametrize("slurred", [2, 20])
def test_two_played_notes_that_meet_are_no_slurs(slurred: int) -> None:
    clock = PlainClock()
    rows = [(480 * index + 480 + 7 * (index % 5), 500 if index % 20 < slurred // 2 else 400, 65) for index in range(40)]
    score = notated(line_times(MonophonicPart("p", line_of(*rows), valves()), clock), piece_of(clock))
    assert bool(score.slurs_next[:-1].any()) == (slurred > 2)


@given(st.lists(st.tuples(st.integers(0, 4000), st.integers(0, 240), st.integers(0, 240)), min_size=1, max_size=12))
def test_simplest_places_are_the_first_of_a_slow_search(rows: list[tuple[int, int, int]]) -> None:
    near, before, behind = (np.array(column) for column in zip(*rows, strict=True))
    found = simplest_places(near - before, near + behind, near, QUARTER).tolist()
    for place, low, high, at in zip(found, near - before, near + behind, near, strict=True):
        for level in DIVISIONS:
            ticks = {QUARTER * step // division for division in level for step in range(12 * 10 * division)}
            fits = [tick for tick in ticks if low <= tick <= high]
            if fits:
                assert place in fits
                assert abs(place - at) == min(abs(tick - at) for tick in fits)
                break
        else:
            assert abs(place - at) <= QUARTER / 24


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("parts", "bar"), [((0.25, 0.25, 0.5), 720), ((1 / 3, 1 / 3, 1 / 3), 1920)])
def test_what_a_line_divides_a_quarter_by_is_what_its_early_notes_are(
    parts: tuple[float, ...], bar: int, seed: int
) -> None:
    """In 48 quarters of sixteenths, in bars that begin between quarters, none is a triplet, and vice versa."""
    chance = Random(seed)
    written = np.concatenate(([0.0], np.cumsum(parts * 48)))
    played = np.rint((written + [chance.uniform(-0.05, 0.05) for _ in written]) * 480).astype(np.int64)
    found = written_onsets(played, 480, np.arange(0, 48 * 480, bar), np.full(len(played), 45))
    assert np.abs(found - written * 480).max() <= 1


def test_a_rest_before_a_note_that_came_late_is_one() -> None:
    """A quarter of a beat of silence; the following note is a twelfth earlier in the score."""
    clock = PlainClock(ticks_per_quarter=1024)
    rows = ((0, 1536), (1536, 513), (2048, 512), (2900, 342), (5120, 341), (5717, 44), (6801, 86), (7402, 512))
    line = MonophonicPart("p", line_of(*((onset, ticks, 61) for onset, ticks in rows)), valves())
    score = notated(line_times(line, clock), piece_of(clock))
    assert score.onset_tick[5] == 5632
    assert score.silence_tick[5] == round(0.2 * 1024)
