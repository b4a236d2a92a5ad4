"""Offset of a recording from the score, found by chroma and onsets.

The recording may begin and end at other times than the score, be tuned differently, and be a few per cent faster or
slower. The expected sound of the score is computed from its notes. The chroma of both is correlated at every offset for
a grid of tempi; the best offsets are refined by aligning expected and recorded onsets.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.audio.constant_tempo_offsets import TEMPO_RATIOS, RecordingPlace, is_other, places, usual_ratios
from app.audio.onset_path import chroma_similarity
from app.audio.score_sound import (
    CHROMA_S,
    EARLY_S,
    ODD_HARMONICS,
    ONSET_S,
    ExpectedSound,
    RecordedSound,
    confidence_of,
    onset_edges,
    score_chroma,
    sounds_to_compare,
)
from app.audio.track import Samples
from app.errors import Progress, StopRequested, stoppable
from app.score.beat_following import RunnerUp
from app.score.model import Score

_SURE: Final = 0.6
"""Confidence below which other timbres are tried."""


@dataclass(frozen=True)
class Estimate:
    """Estimated position of a recording relative to the score.

    Attributes
    ----------
    offset_s : float
        Performance time of its first sample in seconds.
    tempo_ratio : float
        Tempo of the recording divided by the score's.
    confidence : float
        Confidence, 0..1; below 0.5 it is probably another piece.
    runner_up : RunnerUp or None
        Second best position; None if no other is similar.
    """

    offset_s: float
    tempo_ratio: float
    confidence: float
    runner_up: RunnerUp | None = None


def estimate_offset(
    samples: Samples,
    rate_hz: int,
    score: Score,
    progress: Progress = lambda share: None,
    stop_requested: StopRequested = lambda: False,
) -> Estimate:
    """Find the position of a recording.

    Parameters
    ----------
    samples : int16 array, shape (n, channels)
        Samples of the recording.
    progress : callable
        Called with the share 0..1 that is done.
    stop_requested : callable
        Called regularly; true cancels the work.

    Raises
    ------
    AppError
        The recording is silent, or the score has no notes.
    Cancelled
        ``stop_requested`` returned true.
    """
    reached = stoppable(progress, stop_requested)
    reached(0.0)
    expected, recorded = sounds_to_compare(score, samples, rate_hz, lambda share: reached(0.6 * share))
    found = _estimated(recorded, expected, lambda share: reached(0.6 + 0.2 * share))
    if found.confidence < _SURE:
        odd = replace(expected, harmonics=ODD_HARMONICS)
        other = _estimated(recorded, odd, lambda share: reached(0.8 + 0.2 * share))
        found = max(found, other, key=lambda one: one.confidence)
    reached(1.0)
    return found


def _estimated(recorded: RecordedSound, expected: ExpectedSound, reached: Callable[[float], None]) -> Estimate:
    likely = places(recorded, expected, usual_ratios(expected), lambda share: reached(0.7 * share))
    fits: list[tuple[float, float, RecordingPlace]] = []
    for index, place in enumerate(likely):
        fitted, strength = _by_onsets(recorded, expected, place)
        fits.append((confidence_of(_likeness(recorded, expected, fitted), strength), strength, fitted))
        reached(0.7 + 0.3 * (index + 1) / len(likely))
    fits.sort(key=lambda fit: fit[:2], reverse=True)
    confidence, _, best = fits[0]
    others = [RunnerUp(other.start_s - best.start_s, sure) for sure, _, other in fits[1:] if is_other(best, other)]
    return Estimate(-(best.start_s + EARLY_S), best.ratio, confidence, others[0] if others else None)


def _by_onsets(recorded: RecordedSound, expected: ExpectedSound, rough: RecordingPlace) -> tuple[RecordingPlace, float]:
    """Refine the position of a recording by its onsets. Returns the position, and the mean onset strength there in
    standard deviations.

    In each round the onsets must agree more closely with the recording's.
    """
    times, counts = np.unique(np.round(expected.onset_s, 3), return_counts=True)
    weights = np.sqrt(counts.astype(np.float64))
    middle = float(times.mean())
    length_s = max(float(np.ptp(times)), 1.0)
    ratio = rough.ratio
    centre_s = rough.start_s + middle / ratio
    shapes = score_chroma(expected, 1.0)
    for width_s, reach_s, step_s, pitched in (
        (0.06, 0.20, 0.015, 1.0),
        (0.03, 0.06, 0.008, 0.0),
        (0.02, 0.02, 0.004, 0.0),
        (0.02, 0.006, 0.001, 0.0),
    ):
        edges = onset_edges(recorded.onsets, width_s)
        shifts = np.arange(-reach_s, reach_s + 1e-9, step_s)
        slants = np.arange(-reach_s, reach_s + 1e-9, 2 * step_s) / (length_s / 2) * ratio
        best = (-np.inf, centre_s, ratio)
        for slant in slants:
            r = float(np.clip(ratio + slant, TEMPO_RATIOS[0] - 0.01, TEMPO_RATIOS[1] + 0.01))
            there_s = centre_s + (times - middle) / r
            at = there_s[None, :] + shifts[:, None]
            frames = at / ONSET_S
            inside = (frames >= 0) & (frames < len(edges) - 1)
            strength = np.where(inside, np.interp(frames, np.arange(len(edges)), edges), 0.0)
            if pitched:
                # Onsets alone do not distinguish a run of equal notes from the same run shifted by one note.
                strength += pitched * chroma_similarity(times, there_s, shifts, shapes, recorded.chroma).T
            total = (strength * weights).sum(axis=1) / weights.sum()
            top = int(total.argmax())
            if total[top] > best[0]:
                best = (float(total[top]), centre_s + float(shifts[top]), r)
        strength_there, centre_s, ratio = best
    return RecordingPlace(centre_s - middle / ratio, ratio), strength_there


def _likeness(recorded: RecordedSound, expected: ExpectedSound, place: RecordingPlace) -> float:
    """Similarity of the chroma of score and recording at a place, minus the similarity of the transposed score: about 0
    for another piece.
    """
    lag = int(np.floor(place.start_s / CHROMA_S))
    expected_chroma = score_chroma(expected, place.ratio, place.start_s / CHROMA_S - lag)
    first, last = max(lag, 0), min(lag + expected_chroma.shape[1], recorded.chroma.shape[1])
    if last <= first:
        return 0.0
    there, ours = recorded.chroma[:, first:last], expected_chroma[:, first - lag : last - lag]
    size = float(np.sqrt((there**2).sum() * (ours**2).sum()))
    if size <= 0.0:
        return 0.0
    values = [float((there * np.roll(ours, turn, axis=0)).sum()) / size for turn in range(12)]
    return values[0] if values[0] >= max(values[1:]) else 0.0
