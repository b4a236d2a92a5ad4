"""An excerpt has frames of the whole performance, at the same times."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.performance.ensemble import Performance
from app.performance.span import bars_span, cut_span, whole_span
from app.plan.model import TimeFrame
from app.project.casting import StagePosition
from app.project.performers import Dancer
from app.score.model import PercussionHit, Score
from app.score.tempo import TempoMap
from tests.unit.project.pieces import small_project
from tests.unit.viewport.poses import quartet

rates = st.sampled_from([Fraction(24), Fraction(25), Fraction(30000, 1001), Fraction(30), Fraction(60)])


@given(rates, st.floats(-5, 5), st.floats(0.1, 50), st.floats(-10, 60), st.floats(0, 60))
def test_a_cut_is_on_the_grid(fps: Fraction, first_s: float, length_s: float, start_s: float, cut_s: float) -> None:
    frame = TimeFrame(first_s, first_s + length_s)
    whole, cut = whole_span(frame, fps), cut_span(frame, fps, start_s, start_s + cut_s)
    assert whole.first == 0
    assert whole.count == pytest.approx(length_s * fps, abs=1)
    assert cut.count >= 1
    assert cut.first >= 0
    assert cut.first + cut.count <= whole.count
    assert cut.first_frame_s == pytest.approx(first_s + float(cut.first / fps), abs=1e-9)
    if first_s <= start_s and start_s + cut_s <= frame.end_s and cut_s > 0.1:
        assert cut.first_frame_s <= start_s + 1e-5
        assert start_s - cut.first_frame_s < 1 / fps
        last_s = cut.first_frame_s + float((cut.count - 1) / fps)
        assert last_s < start_s + cut_s <= last_s + float(1 / fps) + 1e-5


def test_whole_frames_are_whole() -> None:
    assert whole_span(TimeFrame(-2.0, 3.0), Fraction(60)).count == 300
    assert whole_span(TimeFrame(-0.1, 0.2), Fraction(10)).count == 3


def test_bars_of_drums_that_someone_dances_to_are_bars_of_the_piece() -> None:
    hits = tuple(PercussionHit(480 * beat, 36, 90) for beat in range(32))
    project = small_project()
    score = Score("drums", 480, TempoMap.of_changes(480, []), percussion=hits)
    dancer = Dancer("dancer:1", "One", "salsa", "woman_adult", StagePosition(0.0, 0.0, 0.0))
    performance = Performance(replace(project, score=score, players=(), dancers=(dancer,)))
    assert score.last_bar == 8
    assert score.bar_starts.tolist() == [1920 * bar for bar in range(8)]
    # Bars of two seconds, on the grid of frames.
    for bar in (1, 3, 8):
        span = bars_span(performance, Fraction(30), (bar, bar))
        assert (span.first_frame_s, span.count) == (pytest.approx(2.0 * (bar - 1)), 60)


def test_a_side_without_a_bar_is_that_of_the_performance() -> None:
    performance = Performance(small_project())
    fps = Fraction(24)
    whole, first_bars = whole_span(performance.time_frame, fps), bars_span(performance, fps, (None, 1))
    last_bars = bars_span(performance, fps, (1, None))
    assert bars_span(performance, fps, (None, None)) == whole
    assert (first_bars.first, first_bars.first_frame_s) == (0, performance.time_frame.first_frame_s)
    assert last_bars.end_s == whole.end_s
    assert last_bars.first_frame_s == pytest.approx(0.0, abs=float(1 / fps))


def test_a_lead_in_is_of_felt_beats_and_ends_where_the_performance_begins() -> None:
    performance = Performance(quartet())
    fps, beat_s = Fraction(60), 60.0 / 78.0
    bars = bars_span(performance, fps, (9, 11))
    assert bars.first_frame_s == pytest.approx(8 * 3 * beat_s, abs=float(1 / fps))
    assert bars.end_s == pytest.approx(11 * 3 * beat_s, abs=float(1 / fps))
    led = bars_span(performance, fps, (9, 11), 2.0)
    assert led.end_s == bars.end_s
    assert bars.first_frame_s - led.first_frame_s == pytest.approx(2 * beat_s, abs=float(1 / fps))
    assert bars_span(performance, fps, (1, 1), 64.0).first == 0


@pytest.mark.parametrize("fps", [Fraction(12), Fraction(30000, 1001), Fraction(60)])
def test_bars_join_without_a_frame_twice_or_missing(fps: Fraction) -> None:
    performance = Performance(quartet())
    bars = [bars_span(performance, fps, (bar, bar)) for bar in range(1, 10)]
    for one, following in pairwise(bars):
        assert following.first == one.first + one.count
    for number, bar in enumerate(bars):
        assert abs(bar.first_frame_s - number * 3 * 60.0 / 78.0) <= float(1 / fps) / 2 + 1e-4
