"""Length of the felt beat (the beat that musicians count), by metre and tempo.

The denominator of a metre is the written unit, not the counted one: a moderate 6/8 has two beats, a quick waltz has
one, a slow alla breve has four. Felt beats are about 40 to 200 a minute (London, Hearing in Time, 2nd ed. 2012, ch. 2:
200 to 1500 ms). Quick triple bars are merged to one beat at a lower tempo than quick duple bars.
"""

from __future__ import annotations

import itertools

import numpy as np

from app.arrays import FloatArray, IntArray, running_medians
from app.score.metre_map import FeltBeats, MetreMap
from app.score.tempo import TempoMap

SLOWEST_BPM = 40.0
"""Tempo in beats per minute below which beats longer than a quarter are divided."""
FASTEST_BPM = 208.0
"""Tempo in beats per minute above which beats are counted in twos; the highest mark of a metronome."""
FASTEST_IN_THREE_BPM = 160.0
"""Tempo in beats per minute above which the beats of a bar of three are counted as one."""
STEADY_BARS = 9
"""Number of bars whose median is the tempo, so that a ritardando or fermata does not change the beat."""


def felt_beats(clock: TempoMap, metre_map: MetreMap, bars: IntArray) -> FeltBeats:
    """Compute the felt beat over time, as (tick, length in ticks) at every change.

    Parameters
    ----------
    bars : (B,) int64
        Ticks at which the bars of the piece begin, B >= 1.
    """
    metres = metre_map.metres
    places = np.maximum(np.searchsorted([metre.tick for metre in metres], bars, side="right") - 1, 0)
    quarters = np.array([4.0 * metre.numerator / metre.denominator for metre in metres])[places]
    ends = np.append(bars[1:], bars[-1] + round(quarters[-1] * clock.ticks_per_quarter)).astype(np.float64)
    lasts_s = np.maximum(clock.seconds(ends) - clock.seconds(bars.astype(np.float64)), 1e-9)
    bpm = 60.0 * (ends - bars) / clock.ticks_per_quarter / lasts_s
    found: list[tuple[int, int]] = []
    for bar, place, quarters_bpm in zip(bars.tolist(), places.tolist(), _steady(bpm, places).tolist(), strict=True):
        metre = metres[place]
        beat = felt_beat_ticks(metre.numerator, metre.denominator, quarters_bpm, clock.ticks_per_quarter)
        if not found or found[-1][1] != beat:
            found.append((bar, beat))
    return tuple(found)


def felt_beat_ticks(numerator: int, denominator: int, quarters_bpm: float, ticks_per_quarter: int) -> int:
    """Length in ticks of the beat that musicians feel in a metre at a tempo.

    Parameters
    ----------
    quarters_bpm : float
        Tempo in quarter notes per minute, also if the metre counts other units.
    """
    unit = 4.0 / denominator
    compound = numerator % 3 == 0 and (numerator > 3 or denominator > 8) and denominator >= 8
    quick_three = numerator == 3 and quarters_bpm / unit > FASTEST_IN_THREE_BPM
    if quick_three or (compound and quarters_bpm / (3.0 * unit) >= SLOWEST_BPM):
        quarters = 3.0 * unit
    else:
        quarters = unit
        while quarters_bpm / quarters > FASTEST_BPM and quarters < 1.0:
            quarters *= 2.0
        while quarters_bpm / quarters > FASTEST_BPM and (numerator * unit) % (2.0 * quarters) == 0.0:
            quarters *= 2.0
        while quarters_bpm / quarters < SLOWEST_BPM and quarters > 1.0:
            quarters /= 2.0
    return max(round(quarters * ticks_per_quarter), 1)


def _steady(bpm: FloatArray, metres: IntArray) -> FloatArray:
    """Median tempo (N,) of each bar and its neighbours in the same metre, in beats per minute."""
    result = bpm.copy()
    half = STEADY_BARS // 2
    edges = [0, *(np.flatnonzero(np.diff(metres)) + 1).tolist(), len(metres)]
    for start, end in itertools.pairwise(edges):
        padded = np.pad(bpm[start:end], half, mode="edge")
        result[start:end] = running_medians(padded, STEADY_BARS)
    return result
