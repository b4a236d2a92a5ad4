"""Arrivals of the body and footfalls within captured segments, and the choice of the moment that is put on the beat."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.model import MotionSegment
from app.choreography.transition_scores import SegmentMeets

STEPPED_S: Final = 0.12
"""Greatest distance in seconds of a footfall from an arrival for both to coincide."""
ARRIVES: Final = 1.0
FALLS: Final = 0.5
"""Worth of an arrival of the body and of a footfall on a beat."""
_SAME_S: Final = 1e-6


def accents_s(
    segments: Sequence[MotionSegment],
    fps: Sequence[float],
    slow: Sequence[FloatArray],
    arrivals: Sequence[IntArray],
    falls_s: Sequence[FloatArray],
) -> FloatArray:
    """Time (S,) in its clip of the moment of each of S segments that is put on the beat.

    It is an arrival with a footfall; else an arrival; else the slowest moment from the accent on. Among several the
    slowest is used.

    Parameters
    ----------
    fps, slow, arrivals, falls_s : sequence
        By clip: frames per second, smoothed speed of the body in each frame, frames of its minima, and times of
        footfalls.
    """
    found = []
    for one in segments:
        rate, speed = fps[one.clip], slow[one.clip]
        inside = arrivals[one.clip][slice(*np.searchsorted(arrivals[one.clip], (one.start, one.end)))]
        stepped = np.abs(inside[:, None] / rate - falls_s[one.clip]).min(axis=1, initial=np.inf) <= STEPPED_S
        frames = inside[stepped] if stepped.any() else inside
        if not len(frames):
            frames = np.arange(one.accent, one.end + 1)
        found.append(int(frames[speed[frames].argmin()]) / rate)
    return np.array(found)


def meets_of(
    segments: Sequence[MotionSegment],
    fps: Sequence[float],
    arrivals: Sequence[IntArray],
    falls_s: Sequence[FloatArray],
    accents: FloatArray,
) -> SegmentMeets:
    """Collect the arrivals of the body and the footfalls within each of S segments.

    Parameters
    ----------
    fps, arrivals, falls_s : sequence
        By clip: frames per second, frames of arrivals, and times of footfalls in seconds.
    accents : (S,) float64
        Moment of each segment that is put on a beat, from `accents_s`; the result's times are relative to it.
    """
    own, at_accent = [], np.zeros(len(segments))
    for number, (one, accent_s) in enumerate(zip(segments, accents.tolist(), strict=True)):
        events = []
        for moments_s, worth, near_s, is_fall in (
            (arrivals[one.clip] / fps[one.clip], ARRIVES, 0.5 / fps[one.clip], False),
            (falls_s[one.clip], FALLS, STEPPED_S, True),
        ):
            span_s = np.array([one.start, one.end]) / fps[one.clip] - _SAME_S
            from_accent = moments_s[slice(*np.searchsorted(moments_s, span_s))] - accent_s
            at = np.abs(from_accent) <= near_s
            at_accent[number] += worth * at.any()
            events += [(time_s, worth, is_fall) for time_s in from_accent[~at].tolist()]
        own.append(events)
    most = max((len(events) for events in own), default=0)
    shape = len(segments), most
    times_s, worths, falls = np.full(shape, np.nan), np.zeros(shape), np.zeros(shape, bool)
    for number, events in enumerate(own):
        for at_, (time_s, worth, is_fall) in enumerate(events):
            times_s[number, at_], worths[number, at_], falls[number, at_] = time_s, worth, is_fall
    return SegmentMeets(times_s, worths, falls, at_accent)
