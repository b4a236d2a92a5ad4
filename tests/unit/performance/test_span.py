"""A cut shows frames that the whole has, at the whole's times."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

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
    third = bars_span(performance, Fraction(30), (3, 3), 0.0)
    assert third.first_frame_s + third.count / 30 == pytest.approx(6.0, abs=0.04)
    last = bars_span(performance, Fraction(30), (8, 8), 0.0)
    assert last.first + last.count == whole_span(performance.time_frame, Fraction(30)).count
