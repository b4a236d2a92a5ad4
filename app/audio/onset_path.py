"""Onsets of notes in a recording near a rough alignment, with a tempo as even as they allow."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.audio.score_sound import CHROMA_S, ONSET_S, ExpectedSound, RecordedSound, onset_edges
from app.audio.warping import Pins, Warped

FINAL_WIDTH_S: Final = 0.03
"""Width of an onset's edge in the last round, in seconds."""
_ROUNDS: Final = ((0.1, 0.4, 0.01, 100.0, 1.0), (FINAL_WIDTH_S, 0.12, 0.004, 60.0, 0.0))
"""For each round: width of an onset's edge, reach and step of the shifts in seconds, cost of uneven tempo, weight of
the pitch classes after the onset.
"""
LEAST_GAP_S: Final = 0.02
"""Least distance in seconds of onsets or beats."""
_HEARD_S: Final = 0.4
"""Length in seconds to which a long chord is cut; pitch classes are compared in its middle."""
_CHUNK: Final = 2000
"""Number of onsets compared at a time, since those of an hour exceed the memory."""


def on_onsets(
    expected: ExpectedSound, recorded: RecordedSound, shapes: FloatArray, rough: Warped, pins: Pins
) -> tuple[FloatArray, FloatArray]:
    """Find the onsets of a score's notes in a recording.

    Onset strength alone cannot distinguish a run of equal notes from the run shifted by one note; so the first round
    also compares the pitch classes after each onset.

    Parameters
    ----------
    shapes : (12, n) float64
        Chroma of the score, a frame every `CHROMA_S`.
    rough : Warped
        Alignment that is correct within the reach of the first round.

    Returns
    -------
    times, found : (N,) float64
        Seconds of the score with onsets or pins, and the corresponding seconds of the recording; both ascend.
    """
    fixed = np.round(pins.score_s, 3)
    times, counts = np.unique(np.concatenate((np.round(expected.onset_s, 3), fixed)), return_counts=True)
    weights = np.sqrt(counts.astype(np.float64))
    at_pins = np.searchsorted(times, fixed)
    gaps_s = np.maximum(np.diff(times), LEAST_GAP_S)
    found = rough.at(times)
    found[at_pins] = pins.recording_s
    for width_s, reach_s, step_s, uneven, pitched in _ROUNDS:
        edges = onset_edges(recorded.onsets, width_s)
        shifts = np.arange(-reach_s, reach_s + 1e-9, step_s)
        at = (found[:, None] + shifts) / ONSET_S
        strength = np.interp(at.ravel(), np.arange(len(edges)), edges, left=0.0, right=0.0).reshape(at.shape)
        if pitched:
            strength += pitched * chroma_similarity(times, found, shifts, shapes, recorded.chroma)
        strength *= weights[:, None]
        strength[np.ix_(at_pins, np.abs(shifts) > step_s / 2)] = -np.inf
        chosen = _even_path(strength, shifts, gaps_s, uneven)
        found = np.maximum.accumulate(found + shifts[chosen])
    return times, found


def chroma_similarity(
    times: FloatArray, found: FloatArray, shifts: FloatArray, shapes: FloatArray, chroma: FloatArray
) -> FloatArray:
    """Compare the pitch classes after each onset in the score and in the recording.

    Parameters
    ----------
    times, found : (N,) float64
        Ascending seconds of the score, and corresponding seconds of the recording.
    shifts : (S,) float64
        Shifts in seconds of ``found`` that are compared.
    shapes, chroma : (12, n) float64
        Chroma of the score and of the recording, a frame every `CHROMA_S`.

    Returns
    -------
    (N, S) float64
        Similarity -1..1 for each onset and shift; 0 outside the recording.
    """
    middles = np.minimum(np.diff(times, append=times[-1] + _HEARD_S), _HEARD_S) / 2.0
    result = np.empty((len(times), len(shifts)))
    ours = shapes[:, np.clip(((times + middles) / CHROMA_S).astype(np.int64), 0, shapes.shape[1] - 1)].T
    for first in range(0, len(times), _CHUNK):
        some = slice(first, first + _CHUNK)
        at = ((found + middles)[some, None] + shifts) / CHROMA_S - 0.5
        frames = np.clip(at, 0.0, chroma.shape[1] - 1.001)
        low = frames.astype(np.int64)
        share = frames - low
        by_frame = np.einsum("nc,cns->ns", ours[some], chroma[:, low]) * (1.0 - share)
        by_frame += np.einsum("nc,cns->ns", ours[some], chroma[:, low + 1]) * share
        result[some] = np.where((at >= 0.0) & (at <= chroma.shape[1] - 1), by_frame, 0.0)
    return result


def _even_path(strength: FloatArray, shifts: FloatArray, gaps_s: FloatArray, uneven: float) -> IntArray:
    """Return the shift of each onset that maximises strength and evenness of shifts (Viterbi's algorithm).

    Parameters
    ----------
    strength : (N, S) float64
        Onset strength for each onset and shift.
    shifts : (S,) float64
        Possible shifts in seconds.
    gaps_s : (N - 1,) float64
        Distance of adjacent onsets in seconds: the shorter, the higher the cost of different shifts.

    Returns
    -------
    (N,) int64
        Index in ``shifts`` for each onset.
    """
    apart = uneven * (shifts[:, None] - shifts[None, :]) ** 2
    best = strength[0]
    came_from = np.zeros(strength.shape, np.int64)
    rows = np.arange(len(shifts))
    for place in range(1, len(strength)):
        totals = best[None, :] - apart / gaps_s[place - 1]
        came_from[place] = totals.argmax(axis=1)
        best = totals[rows, came_from[place]] + strength[place]
    path = np.empty(len(strength), np.int64)
    path[-1] = int(best.argmax())
    for place in range(len(strength) - 1, 0, -1):
        path[place - 1] = came_from[place][path[place]]
    return path
