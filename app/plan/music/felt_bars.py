"""Detects bars that begin elsewhere than written: MIDI files do not mark pickups.

Notes on the first beat of a bar are longer than others, and the bass plays there (Lerdahl & Jackendoff, A Generative
Theory of Tonal Music, 1983, ch. 4: metrical preference rules for long notes and a stable bass). If nearly all long
notes begin at the same fraction of a beat after the written beats, the pickup is fractional. If the bar lines then fall
on weak beats and one other beat is clearly the strongest, bars begin there.
"""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from app.arrays import FloatArray, IntArray
from app.plan.music.notation import written_onsets
from app.plan.music.piece import LineTimes, NoteTimes, Piece

LEAST_NOTES = 24
"""Number of notes below which the metre is unknown."""
BASS_WEIGHT = 2.0
"""Weight of the lowest line; the others have 1."""
LAST_WEIGHT = 0.1
"""Weight of a line's last note relative to all others, since pieces end on a strong beat."""
GIVEN_MOST = 0.9
"""Weight of bar lines below which they are doubted; the beats of a bar have 1 on average."""
BEST_LEAST = 1.5
CLEAR = 1.3
"""Factor by which the actual first beats must outweigh all others, in addition to the minimum `BEST_LEAST`."""
LONG_UNITS = 0.75
"""Length in beats from which notes begin on a beat unless they are syncopated."""
LONG_NOTES = 8
"""Number of long notes below which the beat is unknown."""
OFF_BEAT_SHARE = 0.8
"""Least share of the weight of long notes at one position between the given beats for the beats to be moved there."""


def lowest(lines: Sequence[LineTimes]) -> tuple[bool, ...]:
    """Return for each part of an ensemble whether it is the lowest on average; several parts may be."""
    heights = [float(times.pitch.mean()) if len(times.pitch) else np.inf for times in lines]
    return tuple(height == min(heights) for height in heights)


def with_felt_bars(piece: Piece, lines: tuple[NoteTimes, ...], low: tuple[bool, ...]) -> Piece:
    """Move the bars of a piece to where they are felt to begin; unchanged without clear evidence.

    Pieces with a change of metre or a pickup are not changed.

    Parameters
    ----------
    lines : tuple of NoteTimes
        Times of the notes; excludes pitches, so that an edit of a pitch does not repeat the analysis.
    low : tuple of bool
        `lowest` of the lines.
    """
    metre_map, quarter = piece.metre_map, piece.clock.ticks_per_quarter
    metre = metre_map.metres[0]
    end = max((int(times.played_end_tick[-1]) for times in lines if len(times.onset_tick)), default=0)
    bars = metre_map.bars(metre.tick, end)
    if len(metre_map.metres) > 1 or len(bars) < 2:
        return piece
    unit = min(4 * quarter // metre.denominator, quarter)
    bar = metre_map.bar_ticks_at(metre.tick)
    if bar % unit or np.any(np.diff(bars) != bar):
        return piece
    onsets = [written_onsets(times.onset_tick, quarter, bars) - bars[0] for times in lines]
    late = _late_ticks(lines, onsets, unit)
    beats = _weights(lines, low, [since - late for since in onsets], unit, bar // unit)
    best = int(np.argmax(beats))
    others = np.delete(beats, best)
    if beats[0] >= GIVEN_MOST or beats[best] < BEST_LEAST or beats[best] < CLEAR * others.max():
        best = 0
    if late + best == 0:
        return piece
    felt = msgspec.structs.replace(metre, tick=metre.tick - bar + best * unit + late)
    return msgspec.structs.replace(piece, metre_map=msgspec.structs.replace(metre_map, metres=(felt,)))


def _late_ticks(lines: Sequence[NoteTimes], onsets: Sequence[IntArray], unit_ticks: int) -> int:
    """Ticks by which felt beats come after the written ones, less than a beat; 0 unless long notes show otherwise.

    Parameters
    ----------
    onsets : sequence of (N,) int64
        As of `_weights`.
    """
    units = np.concatenate([(times.played_end_tick - times.onset_tick) / unit_ticks for times in lines])
    since = np.concatenate(onsets) % unit_ticks
    long = units >= LONG_UNITS
    if np.count_nonzero(long) < LONG_NOTES:
        return 0
    weights = np.bincount(since[long], np.log2(1.0 + units[long]))
    best = int(np.argmax(weights))
    return best if weights[best] >= OFF_BEAT_SHARE * weights.sum() else 0


def _weights(
    lines: Sequence[NoteTimes], lowest: Sequence[bool], onsets: Sequence[IntArray], unit_ticks: int, count: int
) -> FloatArray:
    """Evidence (count,) that each beat of the bar is the first, 1 on average; equal for all if there is too little
    evidence.

    Parameters
    ----------
    onsets : sequence of (N,) int64
        Onsets of each line in ticks after the first bar line.
    """
    played = [row for row in zip(lines, lowest, onsets, strict=True) if len(row[2])]
    if sum(len(since) for _, _, since in played) < LEAST_NOTES:
        return np.ones(count)
    total = np.zeros(count)
    for times, low, since in played:
        place: IntArray = since // unit_ticks % count
        on_beat = since % unit_ticks == 0
        units = np.clip((times.played_end_tick - times.onset_tick) / unit_ticks, 0.0, count)
        accents = np.bincount(place[on_beat], np.log2(1.0 + units[on_beat]), count)
        total += accents / max(float(accents.sum()), 1e-9) * (BASS_WEIGHT if low else 1.0)
        total[place[-1]] += LAST_WEIGHT * bool(on_beat[-1])
    return np.asarray(total * count / max(float(total.sum()), 1e-9))
