"""The percussion of a piece as symbols of a choreography, and its felt beats.

Rules, none of which invents a symbol:

- A hit is a note of a rhythm part (`app.score.track_instrument.use_of`), with the number that General MIDI has for its
  sound. The edges of the hi-hat, notes 22 and 26 of common electronic kits, are the closed and the open hi-hat, 42 and
  46. Other numbers outside 35 to 81 name none of the 47 sounds and are left out.
- Hits at one time stay hits of their own, by symbol; the same symbol several times at one tick is one hit, as strong
  as the strongest.
"""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.rhythm import SYMBOLS, Rhythm
from app.score.felt_beat import felt_beats
from app.score.metre_map import beat_ticks_at
from app.score.model import SAME_SOUND, Score


def score_rhythm(score: Score) -> Rhythm:
    """Return the rhythm of a piece: its beats and its percussion; without hits if it has no percussion."""
    strongest: dict[tuple[int, int], int] = {}
    for struck in score.percussion:
        symbol = SAME_SOUND.get(struck.pitch, struck.pitch) - SYMBOLS[0]
        if 0 <= symbol < len(SYMBOLS):
            hit = (struck.tick, symbol)
            strongest[hit] = max(strongest.get(hit, 0), struck.velocity)
    hits = sorted(strongest)
    beats_s, bar_beats, divisions = piece_beats(score)
    return Rhythm(
        beats_s=beats_s,
        bar_beats=bar_beats,
        hits_s=score.tempo_map.seconds(np.array([tick for tick, _ in hits], np.float64)),
        symbols=np.array([symbol for _, symbol in hits], np.int64),
        strengths=np.array([strongest[hit] for hit in hits], np.float64) / 127.0,
        derived=False,
        divisions=divisions,
    )


def piece_beats(score: Score) -> tuple[FloatArray, IntArray, IntArray]:
    """Return the felt beats to the end of the last bar, the place of each in its bar, and its division.

    Every bar begins with a beat; the beats of a pickup are the last ones of a bar before the first whole bar.

    Returns
    -------
    beats_s : (N,) float64
        Time of each felt beat in seconds.
    bar_beats, divisions : (N,) int64
        Index of each beat in its bar, and the number of parts that the metre divides it into.
    """
    end = score.sounding_end_tick
    first = 0 if score.pickup_ticks else 1
    metre_map = score.metre_map
    lines = metre_map.tick_of_bar(np.arange(first, metre_map.bar_of_tick(max(end - 1, 0)) + 2))
    bars = lines[:-1]
    beat_ticks = beat_ticks_at(felt_beats(score.tempo_map, metre_map, bars), bars)
    ticks = [np.arange(start, stop, beat) for start, stop, beat in zip(bars, lines[1:], beat_ticks, strict=True)]
    counts = [np.arange(len(bar)) for bar in ticks]
    if score.pickup_ticks and len(ticks) > 1:
        ticks[0] = np.arange(lines[1] - beat_ticks[1], -1, -beat_ticks[1])[::-1]
        counts[0] = len(ticks[1]) - np.arange(len(ticks[0]), 0, -1)
    # Three beats of the metre: twelve quarters divided by its lower number.
    threes = [12 * score.ticks_per_quarter / metre_map.metre_at(bar).denominator for bar in bars.tolist()]
    divisions = np.repeat(np.where(np.abs(beat_ticks - threes) < 1.0, 3, 2), [len(bar) for bar in ticks])
    return score.tempo_map.seconds(np.concatenate(ticks).astype(np.float64)), np.concatenate(counts), divisions
