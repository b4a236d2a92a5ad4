"""Moments of captured segments that should be on beats: arrivals of the body and footfalls."""

from __future__ import annotations

import numpy as np
import pytest

from app.choreography.model import MotionSegment
from app.choreography.segment_arrivals import accents_s, meets_of

FPS = 60.0
SEGMENTS = [MotionSegment(clip=0, start=0, end=60, accent=5, state=0), MotionSegment(0, 60, 80, 120, 0)]


def slow_at(*frames: int) -> tuple[np.ndarray, np.ndarray]:
    """Speed of a body and the frames in which it arrives, slowest first."""
    speed = np.ones(121)
    for number, frame in enumerate(frames):
        speed[frame] = 0.1 * (number + 1)
    return speed, np.sort(frames)


@pytest.mark.parametrize(
    ("falls_s", "expected"),
    [([], 20), ([0.70], 40), ([0.35], 20), ([0.32, 0.68], 20), ([0.05, 0.95], 20)],
    ids=["slowest", "with the footfall", "the slowest has one", "both have one", "far from both"],
)
def test_an_arrival_with_a_footfall_comes_on_the_beat(falls_s: list[float], expected: int) -> None:
    """A leg is slow in mid-swing too; the footfall decides."""
    speed, arrivals = slow_at(20, 40, 90)
    found = accents_s(SEGMENTS, [FPS], [speed], [arrivals], [np.array(falls_s)])
    assert found[0] * FPS == pytest.approx(expected)
    assert found[1] * FPS == pytest.approx(90)


def test_without_an_arrival_it_is_the_slowest_moment_from_the_accent_on() -> None:
    speed = np.linspace(1.0, 0.5, 121)
    speed[70] = 0.1
    found = accents_s(SEGMENTS, [FPS], [speed], [np.zeros(0, np.int64)], [np.zeros(0)])
    assert (found * FPS).tolist() == pytest.approx([60, 120])


def test_other_arrivals_and_footfalls_are_told_from_the_accent() -> None:
    speed, arrivals = slow_at(20, 40)
    falls = [np.array([0.30, 0.90, 1.5])]
    accents = accents_s(SEGMENTS, [FPS], [speed], [arrivals], falls)
    meets = meets_of(SEGMENTS, [FPS], [arrivals], falls, accents)
    assert accents[0] * FPS == pytest.approx(20)
    assert meets.times_s[0].tolist() == pytest.approx([20 / 60, 0.9 - 20 / 60])
    assert meets.falls[0].tolist() == [False, True]
    assert meets.accents[0] > meets.worths[0, 0] > meets.worths[0, 1] > 0.0
    assert meets.times_s[1, 0] == pytest.approx(1.5 - accents[1])
    assert np.isnan(meets.times_s[1, 1])
    assert meets.accents[1] == 0.0
