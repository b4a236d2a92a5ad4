"""Curves of the players' dynamics from the loudness of a recording.

Loudness is measured as in broadcasting (ITU-R BT.1770: a shelf and a high pass before the power), smoothed to exclude
vibrato. In a recording of all players the effect of the number of sounding notes is removed, since a soft tutti may be
louder than a loud solo; in a recording of a single player, the effect of single pitches. The rest is mapped to
controller values so that the piece's average is kept, as is the distance of soft and loud passages as far as the range
allows.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.audio.track import Samples
from app.errors import AppError
from app.score.model import ControllerCurve, Part, Score

STEP_S: Final = 0.02
_SMOOTH_S: Final = 0.08
"""Standard deviation of the smoothing in seconds: slower than a vibrato, faster than a crescendo."""
_STEPS: Final = 200
"""Number of steps filtered at a time."""
_FLOOR_DB: Final = -70.0
_MIDDLE: Final = 0.62
"""Controller level (0..1) of a piece's average: mezzoforte."""
_PER_DB: Final = 0.025
"""Share of the controller's range per decibel, if the range suffices: 10 dB (twice as loud) are a quarter."""
_QUIETEST, _LOUDEST = 0.2, 0.95
"""Controller levels between which all but one in twenty soft and loud values lie."""
_LEAST, _MOST = 0.1, 1.0
_SHARE: Final = 0.05
_SELDOM_S: Final = 4.0
"""Sounding time in seconds of a pitch at which half of its measured deviation in loudness is used; less for rarer
pitches.
"""
_RESOLUTION: Final = 127
"""Number of steps of a MIDI controller."""


@dataclass(frozen=True)
class RecordingLoudness:
    """Loudness of a recording.

    Attributes
    ----------
    level_db : (N,) float64
        Loudness in decibels every `STEP_S` from the first sample on.
    """

    level_db: FloatArray

    def at(self, seconds: FloatArray) -> FloatArray:
        """Return the loudness (N,) in decibels at given seconds, interpolated; silence beyond the ends of the
        recording."""
        at_s = STEP_S * np.arange(len(self.level_db))
        result: FloatArray = np.interp(seconds, at_s, self.level_db, left=_FLOOR_DB, right=_FLOOR_DB)
        return result


def loudness(samples: Samples, rate_hz: int) -> RecordingLoudness:
    """Return the loudness of a recording over time.

    Parameters
    ----------
    samples : int16 array, shape (n, channels)
        Samples of the recording.
    """
    from scipy.ndimage import gaussian_filter1d  # slow to import and not needed at start-up
    from scipy.signal import sosfilt

    hop = max(round(STEP_S * rate_hz), 1)
    count = len(samples) // hop
    if not count:
        return RecordingLoudness(np.full(1, _FLOOR_DB))
    power = np.zeros(count)
    weighting = _weighting(rate_hz)
    state = np.zeros((len(weighting), 2, samples.shape[1]))
    for first in range(0, count, _STEPS):  # an hour at once would take gigabytes
        last = min(first + _STEPS, count)
        part = samples[first * hop : last * hop].astype(np.float64) / 32768.0
        weighted, state = sosfilt(weighting, part, axis=0, zi=state)
        power[first:last] = (weighted**2).reshape(last - first, hop, -1).mean(axis=1).sum(axis=1)
    power = gaussian_filter1d(power / samples.shape[1], _SMOOTH_S * rate_hz / hop)
    return RecordingLoudness(np.maximum(10.0 * np.log10(np.maximum(power, 1e-12)), _FLOOR_DB))


def dynamics(
    score: Score,
    offset_s: float,
    mix: RecordingLoudness | None,
    stems: Mapping[str, RecordingLoudness],
    parts: Collection[str],
) -> dict[str, ControllerCurve]:
    """Derive the curves of the players' dynamics, by part id, from the loudness of a recording.

    Parameters
    ----------
    score : Score
        Score aligned with the recording: its second 0 is at second ``-offset_s`` of the recording.
    mix : RecordingLoudness or None
        Loudness of all players; used for parts without a stem.
    stems : mapping of str to RecordingLoudness
        Loudness of recordings of single parts by part id, which begin at the same time.
    parts : collection of str
        Ids of the parts to compute.

    Raises
    ------
    AppError
        The recording is silent wherever the score has notes.
    """
    sounding = {part.id: _Sounding.of(part, score) for part in score.parts if part.id in parts and part.notes}
    if not sounding:
        raise AppError("audio.nothing_to_compare")
    result = {}
    for part_id, notes in sounding.items():
        track = stems.get(part_id, mix)
        if track is None:
            continue
        levels = track.at(notes.at_s - offset_s)
        if part_id not in stems:
            levels = levels - 10.0 * np.log10(np.maximum(_together(score, notes.at_s), 1))
        audible = notes.sounds & (track.at(notes.at_s - offset_s) > _FLOOR_DB)
        if audible.any():
            if part_id in stems:
                levels = levels - _of_pitches(notes.pitch, levels, audible)
            result[part_id] = notes.curve(score, _scaled(levels, audible), audible)
    if not result:
        raise AppError("audio.nothing_to_compare")
    return result


def _weighting(rate_hz: int) -> FloatArray:
    """Return the K-weighting filter of BT.1770 as second-order sections for a sampling rate, designed by the bilinear
    transform.
    """
    k = np.tan(np.pi * 1681.974450955533 / rate_hz)
    gain, quality = 10.0 ** (3.999843853973347 / 20.0), 0.7071752369554196
    band = gain**0.4996667741545416
    shelf = [gain + band * k / quality + k * k, 2.0 * (k * k - gain), gain - band * k / quality + k * k]
    shelf += [1.0 + k / quality + k * k, 2.0 * (k * k - 1.0), 1.0 - k / quality + k * k]
    k, quality = np.tan(np.pi * 38.13547087602444 / rate_hz), 0.5003270373238773
    low = 1.0 + k / quality + k * k
    high = [1.0, -2.0, 1.0, 1.0, 2.0 * (k * k - 1.0) / low, (1.0 - k / quality + k * k) / low]
    return np.array([np.array(shelf) / shelf[3], high])


@dataclass(frozen=True)
class _Sounding:
    """Time grid of a score in seconds, with a mask of the times at which a part sounds."""

    at_s: FloatArray
    sounds: BoolArray
    pitch: IntArray
    """Pitch of the most recent note."""

    @classmethod
    def of(cls, part: Part, score: Score) -> _Sounding:
        clock = score.tempo_map
        start_s = clock.seconds(np.array([note.onset_tick for note in part.notes], np.float64))
        end_s = clock.seconds(np.array([note.end_tick for note in part.notes], np.float64))
        at_s = np.arange(float(start_s[0]), float(end_s.max()) + STEP_S, STEP_S)
        pitches = np.array([note.pitch for note in part.notes], np.int64)
        last = np.maximum(np.searchsorted(start_s, at_s, side="right") - 1, 0)
        return cls(at_s, _count(start_s, end_s, at_s) > 0, pitches[last])

    def curve(self, score: Score, values: FloatArray, audible: BoolArray) -> ControllerCurve:
        """Convert ``values`` on the grid to the steps of a controller; during a rest it changes to the value of the
        next note.
        """
        from scipy.ndimage import gaussian_filter1d

        values = np.interp(self.at_s, self.at_s[audible], values[audible])
        steps = np.round(_RESOLUTION * gaussian_filter1d(values, _SMOOTH_S / STEP_S, mode="nearest"))
        ticks = np.maximum(np.round(score.tempo_map.ticks(self.at_s)), 0).astype(np.int64)
        # The last of several values at one tick counts, and repeated values are dropped.
        last = np.append(np.diff(ticks) > 0, True)
        ticks, steps = ticks[last], steps[last]
        kept = np.append(True, np.diff(steps) != 0)
        return ControllerCurve("breath", tuple(ticks[kept].tolist()), tuple((steps[kept] / _RESOLUTION).tolist()))


def _together(score: Score, at_s: FloatArray) -> IntArray:
    """Return the number (N,) of notes of the whole score that sound at each time."""
    seconds, notes = score.tempo_map.seconds, [note for part in score.parts for note in part.notes]
    return _count(
        np.sort(seconds(np.array([note.onset_tick for note in notes], np.float64))),
        np.sort(seconds(np.array([note.end_tick for note in notes], np.float64))),
        at_s,
    )


def _count(start_s: FloatArray, end_s: FloatArray, at_s: FloatArray) -> IntArray:
    begun = np.searchsorted(np.sort(start_s), at_s, side="right")
    ended = np.searchsorted(np.sort(end_s), at_s, side="right")
    result: IntArray = begun - ended
    return result


def _of_pitches(pitch: IntArray, levels: FloatArray, audible: BoolArray) -> FloatArray:
    """Return the loudness deviation in decibels caused by each note's pitch (instrument and room): the mean for that
    pitch over the piece, shrunk towards 0 for rare pitches.
    """
    about = levels - np.median(levels[audible])
    count = np.bincount(pitch[audible], minlength=128) * STEP_S
    total = np.bincount(pitch[audible], about[audible], minlength=128) * STEP_S
    result: FloatArray = (total / (count + _SELDOM_S))[pitch]
    return result


def _scaled(levels: FloatArray, audible: BoolArray) -> FloatArray:
    """Convert loudness in decibels (N,) to controller values (N,), so that the levels at ``audible`` times fill the
    controller's usual range.
    """
    low, middle, high = np.quantile(levels[audible], [_SHARE, 0.5, 1.0 - _SHARE])
    slope = min(
        _PER_DB, (_MIDDLE - _QUIETEST) / max(middle - low, 1e-6), (_LOUDEST - _MIDDLE) / max(high - middle, 1e-6)
    )
    result: FloatArray = np.clip(_MIDDLE + slope * (levels - middle), _LEAST, _MOST)
    return result
