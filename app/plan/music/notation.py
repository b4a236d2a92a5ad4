"""Reconstructs notated positions of played notes; breathing and phrasing follow these instead of the exact timing."""

from __future__ import annotations

import dataclasses

import numpy as np

from app.arrays import AnyFloatArray, BoolArray, FloatArray, IntArray, running_medians
from app.plan.music.piece import EPSILON, TOUCHING_GATE, LineTimes, Piece, gaps_s
from app.plan.music.rests import AUDIBLE_S, SILENT_S, are_audible, are_certain

WRITTEN_SHARE = 0.9
"""Share of notes on fractions of a quarter from which a file is written instead of played; see `PLAYED_LEAST`."""
PLAYED_LEAST = 4
"""Number of other notes below which a file counts as written anyway."""
DIVISIONS = ((1,), (2,), (3, 4), (6, 8), (12,))
"""Divisions of a quarter, the simplest first."""
RARE = 4
"""Thirds or fourths of a quarter count as rare in a line that has this many times as many of the others; see
`FARTHER`."""
FARTHER = 4.0
"""Factor on the distance of a note from a rare fraction of a quarter."""
NEAREST = 1.0 / 24.0
"""Greatest distance in quarters of any time from the finest division."""
EARLY_OR_LATE_S = 0.045
"""Greatest distance in seconds of a note's onset from its written position."""
EARLY_RELEASE_S = 0.08
"""Seconds by which a note may end sooner than written."""
RELEASE_SHARES = (0.1, 0.22)
"""Share of the time to the next onset by which a note may end sooner than written, if that is more than
`EARLY_RELEASE_S`: the least, and the most, where the line's notes usually do."""
RELEASE_GATES = (0.7, 1.02)
"""Shares of the time to the next onset for which notes without a rest after them sound."""
EARLIEST_PERCENT = 10.0
"""Percentile of these shares that represents an early release."""
LEAST_RELEASED = 8
"""Number of such notes below which the line's releases are unknown."""
RELEASE_MARGIN = 1.2
"""Factor by which a note may be released earlier than nine of ten."""
RELEASE_NOTE_SHARE = 0.5
"""Largest share of a note's sound by which it may end sooner than written."""
LATE_RELEASE = 0.05
"""Quarters by which a note may end later than written."""
SLURRED_SHARE = 0.1
"""Least share of notes without a gap in a line with played onsets; smaller shares occur by chance."""
STEADY_QUARTERS = 24
"""Number of quarters before and after a position whose median is the score's tempo, so that short ritardandi do not
count.
"""
PLACES = 48
"""Number of distinguished positions within a quarter, whatever the file's resolution."""
SHORTEST_REST = 0.2
"""Silence in quarters below which no score writes a rest."""


def written_onsets(
    onsets: IntArray, quarter_ticks: int, bars: IntArray, reach_ticks: IntArray | None = None
) -> IntArray:
    """Notated onsets (N,) in ticks of played notes.

    If most onsets are on fractions of a quarter already, they are returned unchanged.

    Parameters
    ----------
    onsets : (N,) int64
        Played onsets in ticks.
    bars : (B,) int64
        Ticks at which bars begin; positions are counted from there.
    reach_ticks : (N,) int64, optional
        Largest distance of each onset from its position, in addition to `NEAREST`.
    """
    if are_written(onsets, quarter_ticks):
        return onsets
    least = quarter_ticks * NEAREST
    reach = np.maximum(least, 0.0 if reach_ticks is None else reach_ticks)
    begins = bar_starts(onsets, bars)
    since = onsets - begins
    rarer = _rarer_division(since / quarter_ticks)
    return begins + simplest_places(since - reach, since + reach, since, quarter_ticks, rarer)


def _rarer_division(quarters: FloatArray) -> int:
    """Return 3 if hardly any notes are on thirds of a quarter but many on fourths, 4 in the opposite case, and 0 if
    neither division is rare.
    """
    parts = np.array([0.0, 1.0 / 4.0, 1.0 / 3.0, 1.0 / 2.0, 2.0 / 3.0, 3.0 / 4.0, 1.0])
    counts = np.bincount(np.searchsorted((parts[1:] + parts[:-1]) / 2.0, quarters % 1.0), minlength=len(parts))
    thirds, fourths = int(counts[[2, 4]].sum()), int(counts[[1, 5]].sum())
    if max(thirds, fourths) < PLAYED_LEAST or RARE * min(thirds, fourths) > max(thirds, fourths):
        return 0
    return 3 if thirds < fourths else 4


def bar_starts(ticks: IntArray, bars: IntArray) -> IntArray:
    """Start tick (N,) of the bar that contains each tick; ticks before the first bar count to it; 0 without bars."""
    if not len(bars):
        return np.zeros_like(ticks)
    return np.asarray(bars[np.maximum(np.searchsorted(bars, ticks, side="right") - 1, 0)])


def are_written(ticks: IntArray, quarter_ticks: int) -> bool:
    """Return whether times look notated rather than played: nearly all (`WRITTEN_SHARE`) are multiples of a 24th of a
    quarter."""
    elsewhere = np.count_nonzero(ticks * 24 % quarter_ticks)
    return bool(elsewhere < max(PLAYED_LEAST, (1.0 - WRITTEN_SHARE) * len(ticks) + 1e-6))


def notated(times: LineTimes, piece: Piece) -> LineTimes:
    """Convert the played timing of a part to notated timing.

    Onsets move to the simplest nearby position. Where ends were played, a note lasts until the next onset if it may
    have been released early, otherwise to the simplest position for the start of a rest.
    """
    clock, quarter = piece.clock, piece.clock.ticks_per_quarter
    end_tick = times.played_end_tick
    ends_are_written = are_written(end_tick, quarter)
    if ends_are_written and are_written(times.onset_tick, quarter):
        return times
    steps = np.diff(times.onset_tick)
    shortest = np.minimum(np.append(steps, quarter), np.concatenate(([quarter], steps)))
    near = np.rint(clock.ticks(times.onset_s + EARLY_OR_LATE_S)).astype(np.int64) - times.onset_tick
    bars = piece.bars(int(times.onset_tick[0]), int(end_tick[-1]) + 1)
    onset = written_onsets(times.onset_tick, quarter, bars, np.minimum(near, np.minimum(shortest, quarter) // 3))
    following, end = onset[1:], end_tick[:-1]
    if ends_are_written:
        written = np.minimum(end, following)
    else:
        early = np.rint(clock.ticks(times.played_end_s[:-1] + EARLY_RELEASE_S)).astype(np.int64) - end
        sounding = RELEASE_NOTE_SHARE * (end - times.onset_tick[:-1])
        release = usual_release(early_share(times))
        # A note played early also ended early.
        moved = 0 if onset is times.onset_tick else near[:-1]
        latest = end + np.minimum(np.maximum(early, max(release, RELEASE_SHARES[0]) * np.diff(onset) + moved), sounding)
        # A release is not a rest if the silence is inaudible after a long note, or shorter than a beat.
        audible = np.minimum(np.ceil(clock.ticks(times.played_end_s[:-1] + AUDIBLE_S)), following) - 1.0
        certain = are_certain(times, piece.beat_ticks_at(times.onset_tick), release)[1:]
        latest = np.where(certain, np.minimum(latest, audible), latest)
        begins = bar_starts(end, bars)
        since = end - begins
        rest_from = begins + simplest_places(since - LATE_RELEASE * quarter, latest - begins, since, quarter)
        shortest_rest = round(SHORTEST_REST * quarter)
        # A rest before a late note remains a rest.
        lasts = np.maximum(following - end, times.silence_tick[1:])
        is_rest = (latest < following) & (lasts >= shortest_rest)
        written = np.where(is_rest, np.minimum(rest_from, following - shortest_rest), following)
    written = np.maximum(written, onset[:-1])
    last = int(end_tick[-1] - times.onset_tick[-1])
    if not ends_are_written:
        last = max(int(np.ceil(2 * (last / quarter - LATE_RELEASE)) * quarter // 2), 1)
    ends = np.append(written, onset[-1] + last)
    return dataclasses.replace(
        times,
        onset_tick=onset,
        played_end_tick=ends,
        slurs_next=_meant_slurs(times, clock.seconds(onset.astype(np.float64))),
        silence_tick=np.append(times.silence_tick[:1], following - written),
        onset_s=clock.seconds(onset.astype(np.float64)),
        played_end_s=clock.seconds(ends.astype(np.float64)),
    )


def _meant_slurs(times: LineTimes, onset_s: FloatArray) -> BoolArray:
    """Mask (N,) of notes that overlap the next because a slur is intended, not because the next note came early.

    If slurs are intended, most slurred notes last as long as written.

    Parameters
    ----------
    onset_s : (N,) float64
        Notated onsets in seconds.
    """
    slurred = times.slurs_next.copy()
    shares = times.duration_s[:-1] / np.maximum(np.diff(onset_s), EPSILON)
    meet = slurred[:-1]
    if meet.any() and np.median(shares[meet]) < TOUCHING_GATE:
        meet &= shares >= TOUCHING_GATE
    if np.count_nonzero(meet) < SLURRED_SHARE * len(meet) and not np.array_equal(onset_s, times.onset_s):
        meet[:] = False
    return slurred


def usual_release(early: float) -> float:
    """Share of the time to the next onset by which notes of a part are usually released early, given its
    `early_share`.
    """
    return min(RELEASE_MARGIN * early, RELEASE_SHARES[1])


def early_share(times: LineTimes) -> float:
    """Share of the time to the next onset by which notes end early if no rest follows; 0 if unknown."""
    gates = 1.0 - times.silence_tick[1:] / np.maximum(np.diff(times.onset_tick), 1)
    gates = gates[(gates >= RELEASE_GATES[0]) & (gates <= RELEASE_GATES[1]) & ~are_audible(times)[1:]]
    return 0.0 if len(gates) < LEAST_RELEASED else max(1.0 - float(np.percentile(gates, EARLIEST_PERCENT)), 0.0)


def heard_rests_s(times: LineTimes, release: float) -> FloatArray:
    """Length (N,) in seconds of the rest before each note as listeners hear it: the silence minus the early release
    that is usual in the part.

    The whole silence counts if the part's release is unknown, or if the silence is longer than any release.

    Parameters
    ----------
    release : 0..1
        `early_share` of the line.
    """
    gap_s = gaps_s(times)
    early_s = release * np.concatenate(([0.0], np.diff(times.onset_s)))
    return np.where(gap_s >= SILENT_S - EPSILON, gap_s, np.maximum(gap_s - early_s, 0.0))


def at_score_tempo(times: LineTimes, piece: Piece) -> LineTimes:
    """Return the part's times without ritardandi and other short tempo changes, which do not affect breathing."""
    quarter = piece.clock.ticks_per_quarter
    grid = np.arange(times.onset_tick[0] // quarter, -(-int(times.played_end_tick[-1]) // quarter) + 1) * quarter
    seconds = piece.clock.seconds(grid.astype(np.float64))
    lasts_s = np.diff(seconds)
    if np.ptp(lasts_s) < 1e-6:
        return times
    around = np.pad(lasts_s, STEADY_QUARTERS, mode="reflect" if len(lasts_s) > STEADY_QUARTERS else "edge")
    steady_s = running_medians(around, 2 * STEADY_QUARTERS + 1)
    at_s = seconds[0] + np.concatenate(([0.0], np.cumsum(steady_s)))
    return dataclasses.replace(
        times,
        onset_s=np.interp(times.onset_tick, grid, at_s),
        played_end_s=np.interp(times.played_end_tick, grid, at_s),
    )


def simplest_places(
    first: AnyFloatArray | IntArray,
    last: AnyFloatArray | IntArray,
    near: AnyFloatArray | IntArray,
    quarter_ticks: int,
    rarer: int = 0,
) -> IntArray:
    """Choose a position (N,) in ticks between ``first`` and ``last`` with the simplest division of the quarter; of
    several the one nearest to ``near``.

    Parameters
    ----------
    first, last, near : (N,)
        Ticks; if no division has a position in between, the nearest one of the finest division is used.
    rarer : int
        Division (3 or 4) that is rare in the part: its positions count `FARTHER` away than others of their level.
    """
    at: FloatArray = np.asarray(near, np.float64) / quarter_ticks
    low, high = first / quarter_ticks - 1e-9, last / quarter_ticks + 1e-9
    finest = DIVISIONS[-1][0]
    result = np.rint(at * finest) / finest
    found = np.zeros(len(at), dtype=bool)
    for level in DIVISIONS:
        best, distance = result, np.full(len(at), np.inf)
        for division in level:
            place = np.clip(np.rint(at * division), np.ceil(low * division), np.floor(high * division)) / division
            far = FARTHER if rarer and division in (rarer, 2 * rarer) else 1.0
            off = np.where((place >= low) & (place <= high), far * np.abs(place - at), np.inf)
            best, distance = np.where(off < distance, place, best), np.minimum(off, distance)
        here = ~found & np.isfinite(distance)
        result = np.where(here, best, result)
        found |= here
    return np.asarray(np.rint(result * quarter_ticks), np.int64)
