"""Recordings whose tempo is a constant multiple of the score's, detected and aligned without jitter.

Beats derived from onsets deviate by some milliseconds, which is a per cent or more of a beat. If a line explains the
recording's onsets everywhere about as well as the free path, as in a recording with a click or by a sequencer, the line
is used.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.audio.onset_path import FINAL_WIDTH_S
from app.audio.score_sound import ONSET_S, onset_edges

_FAR_S: Final = 0.02
"""Distance from the line in seconds beyond which onsets have less weight in its fit."""
_FITS: Final = 5
_REFINED_S: Final = ((0.02, 0.002), (0.003, 0.0005))
"""Reach and step in seconds of the refinement of both ends of the line, coarse and fine."""
_AS_STRONG: Final = 0.66
"""Share of the free path's total onset strength that a line at constant tempo must have. Renders of seven pieces at a
constant tempo had 0.69 or more; against a score whose tempo varies by two per cent in nine seconds (29 ms), at most
0.57.
"""
_AS_STRONG_LOCALLY: Final = 0.45
"""Same share in every section: such renders had 0.47 or more, against the varying score at most 0.29."""
_STRETCH_S: Final = 4.0
_LEAST_ONSETS: Final = 12
_LEAST_S: Final = 6.0
"""Least length in seconds from which the tempo can be determined."""


def steady_line(times: FloatArray, found: FloatArray, onsets: FloatArray) -> tuple[float, float] | None:
    """Find the straight line (constant tempo) on which the onsets of a recording lie.

    Parameters
    ----------
    times, found : (N,) float64
        Seconds of the score, ascending, and of the recording, on the free path.
    onsets : (frames,) float64
        Onset strength of the recording, a frame every `ONSET_S`.

    Returns
    -------
    (float, float) or None
        Second of the recording at second 0 of the score, and seconds of the recording per second of the score; None if
        the onsets are not on a line.
    """
    if len(times) < _LEAST_ONSETS or times[-1] - times[0] < _LEAST_S:
        return None
    edges = onset_edges(onsets, FINAL_WIDTH_S)
    first_s, last_s = _refined(edges, times, *_fitted(times, found))
    slope = (last_s - first_s) / (times[-1] - times[0])
    start_s = first_s - slope * times[0]
    free, steady = _strength(edges, found), _strength(edges, start_s + slope * times)
    count = max(round((times[-1] - times[0]) / _STRETCH_S), 1)
    stretches = np.minimum(((times - times[0]) / (times[-1] - times[0]) * count).astype(np.int64), count - 1)
    free_there, steady_there = (np.bincount(stretches, values, count) for values in (free, steady))
    if steady.sum() < _AS_STRONG * free.sum() or np.any(steady_there < _AS_STRONG_LOCALLY * free_there):
        return None
    return float(start_s), float(slope)


def _fitted(times: FloatArray, found: FloatArray) -> tuple[float, float]:
    """Fit a straight line through the found onsets, robust against errors; returns the recorded seconds at its two
    ends.
    """
    weights = np.ones(len(times))
    line = np.zeros(2)
    for _ in range(_FITS):
        line = np.polyfit(times, found, 1, w=weights)
        weights = np.minimum(1.0, _FAR_S / np.maximum(np.abs(found - np.polyval(line, times)), 1e-9)) ** 0.5
    first_s, last_s = np.polyval(line, times[[0, -1]])
    return float(first_s), float(last_s)


def _refined(edges: FloatArray, times: FloatArray, first_s: float, last_s: float) -> tuple[float, float]:
    """Return first and last second of the recording, moved slightly from ``first_s`` and ``last_s`` so that the score's
    onsets meet the strongest onsets (``edges``)."""
    shares = (times - times[0]) / (times[-1] - times[0])
    for reach_s, step_s in _REFINED_S:
        moves = np.arange(-reach_s, reach_s + 1e-9, step_s)
        best = (-np.inf, first_s, last_s)
        for move_s in moves:
            at = (first_s + move_s) * (1.0 - shares) + (last_s + moves)[:, None] * shares
            totals = _strength(edges, at).sum(axis=1)
            top = int(totals.argmax())
            if totals[top] > best[0]:
                best = (float(totals[top]), first_s + move_s, last_s + moves[top])
        _, first_s, last_s = best
    return first_s, last_s


def _strength(edges: FloatArray, at_s: FloatArray) -> FloatArray:
    """Return the onset strength at given seconds of the recording, interpolated, in the shape of ``at_s``; 0
    outside."""
    places = at_s / ONSET_S
    result: FloatArray = np.interp(places.ravel(), np.arange(len(edges)), edges, left=0.0, right=0.0).reshape(
        at_s.shape
    )
    return result
