"""A captured spin keeps its lean, and no motion is danced faster than bodies move."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.dance import Manner
from app.choreography.model import MotionSegment
from app.choreography.shortest_times import (
    CALM,
    FASTER,
    MOST_FASTER,
    ShortestTimes,
    least_paces,
    not_hurried,
    peaks_rad_s,
    turns_rad_s,
)
from app.choreography.spins import ROOM, hips_rad
from app.choreography.stitch import Frames, Stitcher
from app.choreography.warp import TimeMap
from app.rig import quaternion
from tests.support.dances import model, still
from tests.unit.choreography.test_spins import spinning


def leans_rad(clip: MotionClip) -> FloatArray:
    """Angle of the hips from the vertical in each frame."""
    up = quaternion.rotate(clip.rotations[:, SEGMENTS.index("hips")], (0.0, 1.0, 0.0))[:, 1]
    return np.asarray(np.arccos(np.clip(up, -1.0, 1.0)))


def test_a_spin_cut_into_segments_leans_as_captured() -> None:
    clip = spinning(60, 13.0, 12.0, 0.15)
    edges = [0, 80, 105, 120, 135, 165, len(clip) - 1]
    segments = tuple(
        MotionSegment(clip=0, start=start, accent=start + 5, end=end, state=0) for start, end in pairwise(edges)
    )
    library = replace(model(), clips=(clip,), segments=segments)
    at = np.arange(edges[-1])
    frames = Frames(np.arange(len(segments)), np.searchsorted(edges[1:], at, side="right"), at / 60.0, np.ones(len(at)))
    danced, _, seams = Stitcher(library).stitched(frames, 0, Fraction(60), len(at))
    assert not seams
    assert leans_rad(danced) == pytest.approx(leans_rad(clip)[: len(at)], abs=0.01)
    spin = slice(80, 165)
    assert hips_rad(danced)[spin].max() <= hips_rad(clip).max() * 1.05


def test_a_spin_joined_to_another_one_leans_no_farther_than_both() -> None:
    clips = tuple(spinning(60, 13.0, 12.0, lean) for lean in (0.25, -0.15))
    segments = (MotionSegment(0, 20, 60, 120, 0), MotionSegment(1, 110, 150, 220, 0))
    library = replace(model(), clips=clips, segments=segments)
    which = np.repeat([0, 1], [100, 110])
    source_s = np.concatenate([np.arange(20, 120), np.arange(110, 220)]) / 60.0
    danced, _, seams = Stitcher(library).stitched(
        Frames(np.arange(2), which, source_s, np.ones(len(which))), 0, Fraction(60), len(which)
    )
    assert seams == (100,)
    assert leans_rad(danced)[100:].max() < 0.27
    assert hips_rad(danced)[100:].max() <= hips_rad(clips[1]).max() * 1.1


def test_a_spin_takes_its_time_from_its_surroundings() -> None:
    clip = spinning(60, 14.0, 8.0)
    most_rad_s = np.append(CALM * ROOM * 15.0, np.full(len(SEGMENTS) - 1, np.inf))
    paces = least_paces(peaks_rad_s(turns_rad_s(clip), 60.0), 60.0, most_rad_s)
    assert paces.max() == pytest.approx(1.0, abs=0.06)
    assert paces[:40].max() < 0.7
    along_s = np.arange(len(clip)) / 60.0
    hurried = TimeMap(np.array([0.0, along_s[-1] / 1.3]), along_s[[0, -1]])
    calm = not_hurried(hurried, along_s, paces / 60.0)
    lasts_s = np.diff(calm.when(along_s))
    assert (hips_rad(clip) / lasts_s).max() <= 15.0 < (hips_rad(clip) * 60.0 * 1.3).max()
    assert calm.times_s[[0, -1]] == pytest.approx(hurried.times_s, abs=0.01)
    unhurried = TimeMap(along_s[[0, -1]] * 1.2, along_s[[0, -1]])
    assert not_hurried(unhurried, along_s, paces / 60.0) is unhurried


def test_a_segment_of_a_spin_may_not_be_shortened() -> None:
    library = model()
    clip = spinning(60, 14.0, 8.0)
    turning = replace(
        library, clips=(clip,), segments=(MotionSegment(0, 70, 120, 170, 0), MotionSegment(0, 0, 20, 40, 0))
    )
    times = ShortestTimes(turning, np.array([2.0, 1.0 / 3.0]))
    assert times.before_s[0] + times.after_s[0] > 0.75 * 100.0 / 60.0
    assert times.before_s[1] + times.after_s[1] < 0.7 * 40.0 / 60.0


def with_swung_arm(rad_s: float) -> MotionClip:
    """Body at rest that swings an arm at a speed once, after two seconds."""
    clip = still(240)
    angles = 1.2 * np.tanh((np.arange(240) / 60.0 - 2.0) * rad_s / 1.2)
    clip.rotations[:, SEGMENTS.index("leftUpperArm")] = quaternion.from_axis_angle((0.0, 0.0, 1.0), angles)
    return clip


def test_the_fastest_moment_of_a_limb_is_hardly_sped_up() -> None:
    segments = (MotionSegment(0, 100, 120, 140, 0), MotionSegment(0, 0, 20, 40, 0))
    fast = replace(model(), clips=(with_swung_arm(18.0),), segments=segments)
    times = ShortestTimes(fast, np.array([2.0, 1.0 / 3.0]))
    lasts_s = times.before_s + times.after_s
    assert lasts_s[0] > 0.8 * 40.0 / 60.0 / FASTER
    assert lasts_s[1] < 0.7 * 40.0 / 60.0
    # A captured arm that is always slow may be sped up, since it is not fast even then.
    slow = replace(fast, clips=(with_swung_arm(3.0),))
    assert np.ptp((own := ShortestTimes(slow, np.array([2.0, 1.0 / 3.0]))).before_s + own.after_s) < 1e-6


def test_a_dance_is_limited_to_the_speeds_of_its_captures() -> None:
    library = replace(model(), clips=(with_swung_arm(18.0),), segments=(MotionSegment(0, 100, 120, 140, 0),))
    times = ShortestTimes(library, np.array([2.0]))
    left, right = (SEGMENTS.index(f"{side}Hand") for side in ("left", "right"))
    captured = turns_rad_s(library.clips[0])[:, left].max()
    assert times.fastest_rad_s(Manner())[left] == pytest.approx(MOST_FASTER * captured)
    assert times.fastest_rad_s(Manner())[right] < captured
    assert times.fastest_rad_s(Manner(mirrored=True))[[left, right]] == pytest.approx(
        times.fastest_rad_s(Manner())[[right, left]]
    )
    assert times.fastest_rad_s(Manner(size=1.5)) == pytest.approx(1.5 * times.fastest_rad_s(Manner()))
