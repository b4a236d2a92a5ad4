"""Detects fermatas: sounds or silences that all players hold longer than written, found by the tempo alone, as notation
programs and sequencers write them.

A fermata is a stretch without onsets that is much slower than the music before and after. A lasting slow tempo is none,
nor are moving notes in a slow bar. Several successive chords may each have one: then the tempo is slow over all of
them, and they are long or separated by rests.
"""

from __future__ import annotations

from typing import Final

import msgspec
import numpy as np

from app.arrays import FloatArray, IntArray, rows_of
from app.plan.music.piece import NoteTimes, Piece

HELD_TEMPO: Final = 1.5
"""Least factor by which a held beat is slower than the beats before and after it, in a steady tempo."""
LIVE_HELD_TEMPO: Final = 2.0
"""Least factor by which a held beat is slower, where the tempo was played and so is never steady."""
LIVE_SPREAD: Final = 1.1
"""Ratio of beat lengths from which a tempo was played live or is changing."""
MORE_S: Final = 0.2
"""Least seconds by which a held beat is longer than written; less is a slight delay."""
ONE_TEMPO: Final = 1.05
"""Ratio within which beat lengths belong to one held tempo, in which a voice may still move."""
STANDS_OUT: Final = 1.25
"""Least ratio of a held beat to the previous beat; the last beat of a ritardando is not held."""
MOST_IN_A_ROW: Final = 4
"""Greatest number of consecutive held beats; more are a slow passage."""
LONG_BEATS: Final = 2
"""Least length in felt beats of each of several consecutive held notes, or of one before a rest."""
BEFORE_BEATS: Final = 8
AFTER_BEATS: Final = 4
"""Number of beats whose median is the tempo before and after a fermata."""
OTHER_TEMPO: Final = 1.15
"""Factor from which a tempo counts as a different one."""
TOGETHER_BEATS: Final = 0.12
"""Distance in beats below which onsets are simultaneous, about the precision of players."""
ROUNDING: Final = 1e-3
"""Tolerance for tempi, which files round to whole microseconds."""


class Fermata(msgspec.Struct, frozen=True):
    """A place that all players hold.

    Attributes
    ----------
    start_tick : int
        Onset of the held notes.
    release_tick : int
        End of the last held note; equal to the entry if legato.
    entry_tick : int
        First onset after the hold.
    returns : bool
        Whether the previous tempo continues after it; otherwise a new one begins.
    """

    start_tick: int
    release_tick: int
    entry_tick: int
    returns: bool


def fermatas(all_times: tuple[NoteTimes, ...], piece: Piece) -> tuple[Fermata, ...]:
    """All fermatas shown by the tempo, in order, without overlap; one at the end of the piece is omitted.

    Parameters
    ----------
    all_times : tuple of NoteTimes
        Times of every part on stage. Onsets of the accompaniment count as well.
    """
    sounding = [times for times in all_times if len(times.onset_tick)]
    if not sounding:
        return ()
    gaps = _Gaps.of(sounding, piece)
    if not len(gaps.starts):
        return ()
    in_a_row = {place: one for row in _rows(gaps, sounding, piece) for place, one in row}
    found: list[tuple[float, Fermata]] = []
    # A held note is followed by faster ones.
    followed = np.append(gaps.slowness[:-1] >= gaps.slowness[1:] * (1.0 + ROUNDING), True)
    followed[list(in_a_row)] = True
    for place in np.flatnonzero(followed).tolist():
        fermata = in_a_row.get(place) or _fermata(place, gaps, piece)
        if fermata is None:
            continue
        slowness = float(gaps.slowness[place])
        # A slowing just before a longer hold belongs to it.
        if found and found[-1][1].entry_tick >= fermata.start_tick and place not in in_a_row:
            if found[-1][0] > slowness:
                continue
            found.pop()
        found.append((slowness, fermata))
    return tuple(
        msgspec.structs.replace(one, release_tick=_released(sounding, one.start_tick, one.entry_tick))
        for _, one in found
    )


class _Gaps(msgspec.Struct, frozen=True):
    """Stretches without onsets, from one onset of any part to the next; the last one is omitted.

    Attributes
    ----------
    starts, ends : (N,) int64
        Last onset of a group of simultaneous ones, and first onset of the next group.
    slowness : (N,) float64
        Mean seconds per tick.
    """

    starts: IntArray
    ends: IntArray
    slowness: FloatArray

    @classmethod
    def of(cls, sounding: list[NoteTimes], piece: Piece) -> _Gaps:
        begun = [start for start, _ in piece.accompaniment]
        onsets = np.unique(np.concatenate([*(times.onset_tick for times in sounding), np.array(begun, np.int64)]))
        apart = np.diff(onsets) > TOGETHER_BEATS * piece.beat_ticks_at(onsets[:-1])
        starts, ends = onsets[:-1][apart], onsets[1:][apart]
        seconds = piece.clock.seconds
        lasts_s = seconds(ends.astype(np.float64)) - seconds(starts.astype(np.float64))
        return cls(starts, ends, lasts_s / np.maximum(ends - starts, 1))


def _rows(gaps: _Gaps, sounding: list[NoteTimes], piece: Piece) -> list[list[tuple[int, Fermata]]]:
    """Find rows of two to `MOST_IN_A_ROW` fermatas on successive chords, much slower than the music before and after;
    each fermata comes with the index of its gap.
    """
    rows: list[list[tuple[int, Fermata]]] = []
    slowness: list[float] = gaps.slowness.tolist()
    done = -1
    for first in _uneven(gaps.slowness):
        if first <= done:
            continue
        last, slowest = first, slowness[first]
        while last + 1 < len(slowness) and last - first < MOST_IN_A_ROW:
            slowest = max(slowest, slowness[last + 1])
            if slowness[last + 1] * HELD_TEMPO <= slowest:
                break
            last += 1
        if 1 <= last - first < MOST_IN_A_ROW and last + 1 < len(slowness):
            row = _row(first, last, gaps, sounding, piece)
            if row:
                rows.append(row)
                done = last
    return rows


def _uneven(slowness: FloatArray) -> list[int]:
    """Indices of the gaps near which, within the length of a row of fermatas, the tempo changes."""
    found = np.ones(len(slowness), dtype=bool)
    if len(slowness) > MOST_IN_A_ROW:
        rows = rows_of(slowness, MOST_IN_A_ROW + 1)
        found[: rows.shape[1]] = rows.min(axis=0) * HELD_TEMPO <= rows.max(axis=0)
    return np.flatnonzero(found).tolist()


def _row(first: int, last: int, gaps: _Gaps, sounding: list[NoteTimes], piece: Piece) -> list[tuple[int, Fermata]]:
    """Return the fermatas of consecutive gaps ``first`` to ``last`` with the index of each gap; empty unless every gap
    is slow enough to be one."""
    slowest = float(gaps.slowness[first : last + 1].min())
    after = _beats(int(gaps.ends[last]), AFTER_BEATS, piece)
    before = _beats(int(gaps.starts[first]), -BEFORE_BEATS, piece) if first else after
    usual, then = float(np.median(before)), float(np.median(after))
    factor = LIVE_HELD_TEMPO if _is_live(before) or _is_live(after) else HELD_TEMPO
    if slowest < factor * max(usual, then) * (1.0 - ROUNDING):
        return []
    if first and slowest < STANDS_OUT * float(_beats(int(gaps.starts[first]), -1, piece)[0]):
        return []
    row = []
    for place in range(first, last + 1):
        start, entry = int(gaps.starts[place]), int(gaps.ends[place])
        beat = int(piece.beat_ticks_at(np.array([start]))[0])
        rests = entry - _released(sounding, start, entry) > TOGETHER_BEATS * beat
        more_s = (float(gaps.slowness[place]) - max(usual, then)) * (entry - start)
        if more_s < MORE_S - ROUNDING or not (rests or entry - start >= LONG_BEATS * beat):
            return []
        # Each tempo except the last one is followed by another.
        returns = place < last or max(usual / then, then / usual) < OTHER_TEMPO
        row.append((place, Fermata(start, entry, entry, returns)))
    return row


def _fermata(place: int, gaps: _Gaps, piece: Piece) -> Fermata | None:
    """Return the fermata whose hold ends with the gap at index ``place``; None if there is none."""
    start, entry = int(gaps.starts[place]), int(gaps.ends[place])
    slowness = float(gaps.slowness[place])
    after = _beats(entry, AFTER_BEATS, piece)
    least = HELD_TEMPO * float(np.median(after)) * (1.0 - ROUNDING)
    if slowness < least:
        return None
    if place and _moves(place, gaps):
        start = int(gaps.starts[place - 1])
    before = _beats(start, -BEFORE_BEATS, piece) if start > gaps.starts[0] else after
    usual, steady = float(np.median(before)), float(max(np.median(before), np.median(after)))
    live = _is_live(before) or _is_live(after)
    more_s = (slowness - steady) * (entry - start)
    if slowness < (LIVE_HELD_TEMPO if live else HELD_TEMPO) * steady * (1.0 - ROUNDING) or more_s < MORE_S - ROUNDING:
        return None
    if start > gaps.starts[0] and slowness < STANDS_OUT * float(_beats(start, -1, piece)[0]):
        return None
    ratio = usual / float(np.median(after))
    return Fermata(start, entry, entry, max(ratio, 1.0 / ratio) < OTHER_TEMPO)


def _moves(place: int, gaps: _Gaps) -> bool:
    """Return whether the gap with this index is the larger part of a hold during which one voice moved."""
    own, before = (float(gaps.ends[at] - gaps.starts[at]) for at in (place, place - 1))
    ratio = float(gaps.slowness[place - 1] / gaps.slowness[place])
    return own >= before and 1.0 / ONE_TEMPO <= ratio <= ONE_TEMPO


def _is_live(beats: FloatArray) -> bool:
    """Return whether the tempo, given as seconds per tick of successive beats, varies as in live playing or changes as
    in a ritardando.
    """
    quick, slow = np.quantile(beats, (0.25, 0.75))
    return bool(slow > LIVE_SPREAD * quick * (1.0 + ROUNDING))


def _beats(tick: int, count: int, piece: Piece) -> FloatArray:
    """Seconds per tick (N,) in each of ``count`` beats after a tick, or before it if ``count`` is negative."""
    beat = int(piece.beat_ticks_at(np.array([tick]))[0])
    edges = tick + beat * np.arange(min(count, 0), max(count, 0) + 1, dtype=np.float64)
    lasts: FloatArray = np.diff(piece.clock.seconds(edges)) / beat
    return lasts


def _released(sounding: list[NoteTimes], start: int, entry: int) -> int:
    """Tick at which the last of the notes held at the start of a fermata ends."""
    ends = []
    for times in sounding:
        index = int(np.searchsorted(times.onset_tick, entry)) - 1
        if index >= 0:
            ends.append(int(times.played_end_tick[index]))
    return min(max([start, *ends]), entry)
