"""Character of a piece's ending, by mode, tempo and dynamics; decides the faces after the last note."""

from __future__ import annotations

import msgspec
import numpy as np

from app.plan.music.piece import LineTimes, Piece

BARS = 8
"""Number of bars whose notes count."""
BRIGHT_BPM = 96.0
BRIGHT_LOUDNESS = 0.6
"""Loudness 0..1: a little below mezzoforte."""
THIRD_SHARE = 1.5
"""Ratio of the sounding times of the mode's own third and the other third from which the mode is certain."""


class Ending(msgspec.Struct, frozen=True):
    """Character of a piece's ending: ``bright`` if it is in major, lively and not soft; ``bpm`` is the tempo before the
    end in beats per minute.
    """

    bright: bool
    bpm: float


def ending_of(all_times: tuple[LineTimes, ...], piece: Piece) -> Ending:
    """Judge the ending of a piece from the parts of all players."""
    lines = [times for times in all_times if len(times.onset_tick)]
    if not lines:
        return Ending(False, 0.0)
    last = max(int(times.played_end_tick[-1]) for times in lines)
    beat = int(piece.beat_ticks_at(np.array([last]))[0])
    first = max(last - BARS * piece.metre_map.bar_ticks_at(last), min(int(times.onset_tick[0]) for times in lines))
    # Notes are sorted by their ends; notes that end before the last bars do not count.
    begins = [int(np.searchsorted(times.played_end_tick, first, "right")) for times in lines]
    onset, end, pitch, loudness = (
        np.concatenate([getattr(times, name)[begin:] for times, begin in zip(lines, begins, strict=True)])
        for name in ("onset_tick", "played_end_tick", "pitch", "loudness")
    )
    lasts_s = piece.clock.seconds(float(last)) - piece.clock.seconds(float(first))
    bpm = 60.0 * (last - first) / beat / max(lasts_s, 1e-9)
    tonic = int(pitch[end > last - beat].min()) % 12
    weight = np.maximum(np.minimum(end, last) - np.maximum(onset, first), 0).astype(np.float64)
    thirds = [float(weight[(pitch - tonic) % 12 == semitones].sum()) for semitones in (3, 4)]
    major = thirds[1] > THIRD_SHARE * thirds[0]
    loud = float(np.average(loudness, weights=weight)) >= BRIGHT_LOUDNESS if weight.any() else False
    return Ending(bool(major and loud and bpm >= BRIGHT_BPM), round(bpm, 1))
