"""Expected sound of a score and features of a recording, frame by frame, for their alignment."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import soxr

from app.arrays import FloatArray, IntArray
from app.audio.features import Sound, chroma, onset_strength, tuning
from app.audio.track import Samples
from app.errors import AppError, Progress
from app.score.model import Score

ANALYSIS_RATE_HZ: Final = 22050
_BLOCK: Final = 1 << 20
"""Number of samples mixed to one channel at a time."""
_CHROMA_HOP: Final = 2048
CHROMA_S: Final = _CHROMA_HOP / ANALYSIS_RATE_HZ
_ONSET_HOP: Final = 220
ONSET_S: Final = _ONSET_HOP / ANALYSIS_RATE_HZ
_LEAST_SAMPLES: Final = 4 * ANALYSIS_RATE_HZ
"""Least number of samples; shorter recordings are padded with silence, since the analysis needs sound around onsets."""
Harmonics: TypeAlias = tuple[tuple[int, float], ...]
"""Intervals in semitones of the pitch classes of a note's overtones above its own, with their loudness."""
USUAL_HARMONICS: Final[Harmonics] = ((0, 1.0), (7, 0.25), (4, 0.08))
ODD_HARMONICS: Final[Harmonics] = ((0, 1.0), (7, 1.0), (4, 0.3))
"""Odd harmonics, as of a stopped pipe such as a clarinet, which sound at the twelfth as much as at their own pitch."""
EARLY_S: Final = 0.007
"""Seconds by which detected onsets precede the notes, since windows reach ahead: mean over seven pieces of the built-in
synthesiser.
"""


@dataclass(frozen=True)
class RecordedSound:
    """Features of a recording: chroma (12, frames), onset strength (frames,), length in seconds."""

    chroma: FloatArray
    onsets: FloatArray
    length_s: float


@dataclass(frozen=True)
class ExpectedSound:
    """Sound expected from a score: onsets and ends of its notes in seconds, pitches, weights, and timbre."""

    onset_s: FloatArray
    end_s: FloatArray
    pitch: IntArray
    loudness: FloatArray
    harmonics: Harmonics = USUAL_HARMONICS


def expected_sound(score: Score) -> ExpectedSound:
    """Return the expected sound of a score, note by note in the order of its parts."""
    notes = [note for part in score.parts for note in part.notes]
    seconds = score.tempo_map.seconds
    return ExpectedSound(
        seconds(np.array([note.onset_tick for note in notes], np.float64)),
        seconds(np.array([note.end_tick for note in notes], np.float64)),
        np.array([note.pitch for note in notes], np.int64),
        np.array([0.3 + 0.7 * note.velocity / 127 for note in notes], np.float64),
    )


def sounds_to_compare(
    score: Score, samples: Samples, rate_hz: int, progress: Progress
) -> tuple[ExpectedSound, RecordedSound]:
    """Prepare a score and a recording for comparison: the score's expected sound, and the recording's features.

    Raises
    ------
    AppError
        The recording is silent, or the score has no notes.
    """
    expected = expected_sound(score)
    if not len(samples) or not samples.any() or not len(expected.onset_s):
        raise AppError("audio.nothing_to_compare")
    return expected, recorded_sound(samples, rate_hz, progress)


def analysis_sound(samples: Samples, rate_hz: int) -> Sound:
    """Convert a sound to one channel at `ANALYSIS_RATE_HZ`, -1..1.

    Parameters
    ----------
    samples : int16 array, shape (n, channels)
        The sound to convert.
    """
    mono = np.empty(len(samples), np.float32)
    for first in range(0, len(samples), _BLOCK):  # an hour at once would take gigabytes
        part = samples[first : first + _BLOCK].astype(np.float32)
        mono[first : first + _BLOCK] = part.mean(axis=1) / 32768.0
    return np.asarray(soxr.resample(mono, rate_hz, ANALYSIS_RATE_HZ))


def recorded_sound(samples: Samples, rate_hz: int, progress: Progress) -> RecordedSound:
    """Return the features of a recording, independent of its tuning.

    Parameters
    ----------
    samples : int16 array, shape (n, channels)
        Samples of the recording.
    progress : callable
        Called with the share 0..1 that is done.
    """
    sound = analysis_sound(samples, rate_hz)
    sound = np.pad(sound, (0, max(_LEAST_SAMPLES - len(sound), 0)))
    progress(0.2)
    sounding = np.flatnonzero(np.abs(sound) > 1e-3)
    middle = int(sounding[len(sounding) // 2]) if len(sounding) else 0
    part = sound[max(middle - 30 * ANALYSIS_RATE_HZ, 0) : middle + 30 * ANALYSIS_RATE_HZ]
    tuned = tuning(part, ANALYSIS_RATE_HZ)
    progress(0.3)
    # Starts half a frame late, so that frames are centred at the same times as those of the score.
    classes = chroma(sound[_CHROMA_HOP // 2 :], ANALYSIS_RATE_HZ, 2 * _CHROMA_HOP, _CHROMA_HOP, tuned)
    progress(0.5)
    onsets = onset_strength(sound, ANALYSIS_RATE_HZ, 1024, _ONSET_HOP)
    progress(1.0)
    return RecordedSound(shape(classes), levelled_onsets(onsets), len(sound) / ANALYSIS_RATE_HZ)


def shape(chroma: FloatArray) -> FloatArray:
    """Normalise chroma (12, F) so that every frame is a unit vector, independent of loudness; frames near silence are
    shorter.
    """
    level = np.sqrt(chroma.sum(axis=0))
    chroma = np.sqrt(chroma)
    chroma = chroma - chroma.mean(axis=0)
    size = np.sqrt((chroma**2).sum(axis=0))
    typical = np.median(level[level > 0]) if (level > 0).any() else 1.0
    result: FloatArray = chroma / np.maximum(size, 1e-9) * np.minimum(level / typical, 1.0)
    return result


def levelled_onsets(onsets: FloatArray) -> FloatArray:
    """Normalise onset strength (F,): its excess over the local mean in standard deviations, limited to -1..4."""
    width = round(1.5 / ONSET_S)
    around = np.convolve(onsets, np.ones(width) / width, "same")
    spread = np.sqrt(np.convolve((onsets - around) ** 2, np.ones(width) / width, "same"))
    result: FloatArray = np.clip((onsets - around) / np.maximum(spread, 0.3 * spread.max() + 1e-9), -1.0, 4.0)
    return result


def score_chroma(expected: ExpectedSound, ratio: float, later_frames: float = 0.0) -> FloatArray:
    """Compute the expected chroma (12, F) of a score that is played ``ratio`` times as fast as written and begins
    ``later_frames`` frames before second 0.
    """
    begin = expected.onset_s / ratio / CHROMA_S + later_frames
    end = expected.end_s / ratio / CHROMA_S + later_frames
    frames = int(np.ceil(end.max())) + 1
    steps = np.zeros((12, frames + 2))
    first, last = np.floor(begin).astype(int), np.floor(end).astype(int)
    for above, loudness in expected.harmonics:
        row = (expected.pitch + above) % 12
        amount = expected.loudness * loudness
        # A note fills its frames, the first and last in part: stored as differences and summed afterwards.
        for place, share, sign in ((first, begin - first, 1.0), (last, end - last, -1.0)):
            np.add.at(steps, (row, place), sign * amount * (1.0 - share))
            np.add.at(steps, (row, place + 1), sign * amount * share)
    return shape(np.maximum(np.cumsum(steps, axis=1)[:, :frames], 0.0) ** 2)


def onset_edges(onsets: FloatArray, width_s: float) -> FloatArray:
    """Compute the increase of onset strength (F,) from before to after each frame.

    The strength of an onset keeps rising for a while, longer for slow onsets; the note begins at the start of the rise
    and not at the maximum.
    """
    reach = max(round(3 * width_s / ONSET_S), 1)
    decay = np.exp(-(np.arange(reach) + 0.5) * ONSET_S / width_s)
    # np.convolve reverses its kernel, so the part after a moment comes first.
    kernel = np.concatenate([decay[::-1], -decay]) / decay.sum()
    result: FloatArray = np.convolve(onsets, kernel, "full")[reach - 1 : reach - 1 + len(onsets)]
    return result


def confidence_of(likeness: float, onsets: float) -> float:
    """Convert the similarity of chroma and of onsets at a place to a confidence, 0..1. Correct places of test pieces
    with noise, reverberation and applause had a likeness of at least 0.38 and onsets of 0.36; wrong and transposed
    pieces had at most 0.29, and 0.3 for onsets if the likeness was above 0.2.
    """
    return float(_rising(12.0 * (likeness - 0.34)) * _rising(8.0 * (onsets - 0.28)))


def _rising(x: float) -> float:
    return float(1.0 / (1.0 + np.exp(-np.clip(x, -30.0, 30.0))))
