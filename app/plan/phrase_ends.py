"""How good a place every note of a line is for a catch breath before it: where phrases end."""

from __future__ import annotations

from statistics import median

import numpy as np
import numpy.typing as npt

from app.plan.catch_lengths import CATCH_MIN_S, CATCH_NOTE_SHARE, MOST_DROPPED, gaps_s
from app.plan.line import IntArray, LineTimes, Piece, Seeds
from app.plan.lungs import EPSILON
from app.plan.model import FloatArray
from app.plan.notation import PLACES, written_onsets

# How good a place for a catch breath is (added up; the cost of a place is PLACE_COST minus this).
PLACE_COST = 10.0
LEAST_COST = 0.2
REST = 4.0
"""In a rest of the score."""
LONG_NOTE = 1.5
"""After a note twice as long as the notes around; after one four times as long twice as much, and no more."""
LEAP = 1.0
"""Before a leap of a fourth or more."""
SILENCE = 1.0
"""A short silence is there already."""
BEFORE_UPBEAT = 0.8
"""Before a weak place after a note on a strong one, for every level between them: in running notes after the beat."""
RUNNING = 0.75
"""Notes of at most this part of a beat run: only out of those a breath after the first beat of a bar is usual."""
SQUARE = 1.0
"""Two bars after the line last came in; four bars twice as much: most phrases are as long."""
AFTER_UPBEAT = -2.5
"""Between an upbeat and the place it leads to: never, unless the upbeat is a long note or before a rest."""
AFTER_ENTRY = -80.0
"""The same where the upbeat itself comes in after a rest: rather two notes are left out elsewhere."""
BEFORE_TAIL = -10.0
"""Before a lone short note off the beat, the tail of a dotted note, unless the line comes in there after rests."""
LIKE_ENTRIES = 1.5
"""Where in the bar (in half a bar, where there is one) the line comes in after rests."""
AGAIN = 2.0
"""Where what came after a rest comes again."""
AGAIN_NOTES = 4
SHORTER = 0.5
"""Before a note half as long as the one before."""
SLURRED = -40.0
"""Within a slur: only without any air left."""
ALL_SLURRED = (0.75, 0.9)
"""Where more than this part of the notes run into the next one, this is how they are played and no phrasing: the slurs
count less, and from the second value on not at all."""
BEFORE_REST = -8.0
"""When a rest comes within a felt beat."""
CLIPPED = -2.0
"""Out of a note that loses all of it; in proportion where it loses more than the usual part."""
JITTER = 0.2
"""Players differ where places are equally good."""
TAKEN_COST = 6.0
"""Where another player of the same line breathes: players stagger."""


def place_costs(
    times: LineTimes,
    piece: Piece,
    rests: IntArray,
    at: IntArray,
    taken: npt.NDArray[np.bool_],
    seeds: Seeds,
    dropped: IntArray | int = 0,
) -> FloatArray:
    """(K,): what a breath before each of the notes ``at`` (1 and up) costs.

    Parameters
    ----------
    taken : (N,) bool
        Before which notes another player of the same line breathes.
    dropped : (K,) int64
        How many notes from there on are left out for it.
    """
    if not len(at):
        return np.zeros(0)
    duration, onsets = times.duration_s, times.onset_tick
    onset, before = onsets[at], duration[at - 1]
    beat = piece.beat_ticks_at(onset)
    rest = rests[at] > 0
    longer = np.maximum(before, EPSILON) / np.maximum(_lengths_around(duration)[at], EPSILON)
    long = np.clip(np.log2(longer), 0.0, 2.0)
    good: FloatArray = REST * rest + LONG_NOTE * long
    bars = piece.bars(int(onsets[0]), int(onsets[-1]) + 1)
    onsets = written_onsets(onsets, piece.clock.ticks_per_quarter, bars)
    onset = onsets[at]
    strength = _strength(onsets, bars, piece.beat_ticks_at(onsets))
    strongest = np.max([strength[at + np.minimum(dropped, more)] for more in range(MOST_DROPPED + 1)], axis=0)
    falls = strength[at - 1] - strongest
    steps = np.diff(onsets, append=onsets[-1] + max(beat.max(), 1))
    leads_to = strength[np.minimum(at + 1, len(onsets) - 1)]
    like = _like_entries(rests, onsets, at, bars)
    good += LIKE_ENTRIES * like
    # Slurs that are known say where a short note before a bar line is an upbeat; else only one of the same pitch is.
    slurs_known = bool(times.slurs_next[:-1].any()) and _legato(times, rests) == 0.0
    upbeat = (leads_to == 3) & (slurs_known | (times.pitch[at] == times.pitch[at - 1]))
    tail = ~rest & (2 * steps[at] <= beat - upbeat) & _are_dotted(steps[at - 1], steps[at])
    tail &= leads_to > 0 if slurs_known else strength[at] == 0
    good += BEFORE_TAIL * tail * (1.0 - like)
    good += AGAIN * _begins_again(steps, times.pitch, rests)[at]
    runs = steps[at - 1] <= RUNNING * beat
    # A long note or a rest ends what led to the next one; unless notes run, nothing leads to where the line comes in.
    leads = (~rest & (long < 1.0)) * (1.0 - like * ~runs)
    good += AFTER_ENTRY * (~rest & runs & (falls < 0) & (rests[at - 1] > 0))
    # Out of running notes a breath comes after the note on the beat.
    good += SQUARE * _squareness(rests, onsets, at - runs, bars)
    good += BEFORE_UPBEAT * np.clip(falls, 0, np.where(runs, 3, 1)) + AFTER_UPBEAT * np.maximum(-falls, 0) * leads
    good += SHORTER * np.clip(np.log2(np.maximum(before, EPSILON) / np.maximum(duration[at], EPSILON)), 0.0, 2.0)
    good += LEAP * times.leaps[at - 1]
    good += SILENCE * (times.silence_tick[at] > 0)
    good -= slur_costs(times, rests, at)
    good += BEFORE_REST * (~rest & _rest_follows(rests, onsets, at, beat))
    taken_share = (CATCH_MIN_S - gaps_s(times)[at]) / np.maximum(before, EPSILON)
    good += CLIPPED * np.clip(taken_share / CATCH_NOTE_SHARE - 1.0, 0.0, 1.0)
    quarter = piece.clock.ticks_per_quarter
    good += JITTER * seeds.chances_at("catch", onset, (2 * PLACES * onset + quarter) // (2 * quarter))
    good -= TAKEN_COST * taken[at]
    return np.asarray(np.maximum(PLACE_COST - good, LEAST_COST), dtype=np.float64)


def _are_dotted(long: IntArray, short: IntArray) -> npt.NDArray[np.bool_]:
    """(K,): whether notes and the ones after them are dotted, or double-dotted, and short."""
    doubly: npt.NDArray[np.bool_] = np.abs(long - 7 * short) < short // 2
    return (long > 2 * short) & (long < 4 * short) | doubly


def slur_costs(times: LineTimes, rests: IntArray, at: IntArray) -> FloatArray:
    """(K,): what a breath before each of the notes ``at`` costs for the slur that leads to it."""
    return np.asarray(-SLURRED * (1.0 - _legato(times, rests)) * times.slurs_next[at - 1], dtype=np.float64)


def _legato(times: LineTimes, rests: IntArray) -> float:
    """0..1: how far notes are slurred throughout, so that slurs say nothing about phrases.

    Notes before a rest do not count, nor repeated notes: a key has to be let go before it is pressed again.
    """
    could = (rests[1:] == 0) & (np.diff(times.pitch) != 0)
    share = float(times.slurs_next[:-1][could].mean()) if could.any() else 0.0
    return float(np.interp(share, ALL_SLURRED, (0.0, 1.0)))


def _strength(ticks: IntArray, bars: IntArray, beat_ticks: IntArray) -> IntArray:
    """(K,): 3 where a bar begins, 2 in its middle, 1 on another felt beat, 0 elsewhere."""
    place = np.maximum(np.searchsorted(bars, ticks, side="right") - 1, 0)
    since = ticks - bars[place]
    length = np.append(np.diff(bars), 0)
    length = np.where(length > 0, length, beat_ticks.max())[place]
    on_beat = since % beat_ticks == 0
    middle = on_beat & (2 * since == length)
    return np.where(since == 0, 3, np.where(middle, 2, np.where(on_beat, 1, 0)))


def _like_entries(rests: IntArray, onsets: IntArray, at: IntArray, bars: IntArray) -> FloatArray:
    """(K,): of the notes that come in after rests, the part that does so where each place stands in its bar."""
    place = np.maximum(np.searchsorted(bars, onsets, side="right") - 1, 0)
    bar = int(np.median(np.diff(bars))) if len(bars) > 1 else 1
    phase = (onsets - bars[place]) % max(bar // 2 if bar % 2 == 0 else bar, 1)
    phases, counts = np.unique(phase[rests > 0], return_counts=True)
    known = np.minimum(np.searchsorted(phases, phase[at]), len(phases) - 1)
    shares: FloatArray = np.where(phases[known] == phase[at], counts[known] / counts.sum(), 0.0)
    return shares


def _squareness(rests: IntArray, onsets: IntArray, at: IntArray, bars: IntArray) -> FloatArray:
    """(K,): 2 a multiple of four bars after the entry before each place, 1 an odd multiple of two bars, 0 elsewhere."""
    entries = np.flatnonzero(rests > 0)
    entry = onsets[entries[np.maximum(np.searchsorted(entries, at, side="right") - 1, 0)]]
    bar = int(np.median(np.diff(bars))) if len(bars) > 1 else 1
    since = onsets[at] - entry
    return np.asarray((since > 0) * ((since % (2 * bar) == 0) + 1.0 * (since % (4 * bar) == 0)))


def _begins_again(steps: IntArray, pitch: IntArray, rests: IntArray) -> npt.NDArray[np.bool_]:
    """(N,): whether the next notes have the rhythm and the direction of what came after a rest."""
    count = len(steps)
    result = np.zeros(count, dtype=bool)
    if count > AGAIN_NOTES:
        moves = np.sign(np.diff(pitch))
        columns = [steps[place : count - AGAIN_NOTES + place] for place in range(AGAIN_NOTES)]
        columns += [moves[place : count - AGAIN_NOTES + place] for place in range(AGAIN_NOTES)]
        rows = np.ascontiguousarray(np.stack(columns, axis=1).astype(np.int64))
        # Compared as bytes: most lines have few entries and many different bars.
        kinds = rows.view(np.dtype((np.void, rows.shape[1] * rows.itemsize))).ravel().tolist()
        entries = {kinds[place] for place in np.flatnonzero(rests[: len(kinds)] > 0).tolist()}
        result[: len(kinds)] = [kind in entries for kind in kinds]
    return result


def _rest_follows(rests: IntArray, onsets: IntArray, at: IntArray, beat_ticks: IntArray) -> npt.NDArray[np.bool_]:
    """(K,): whether a rest begins within a beat after each place."""
    following = np.flatnonzero(rests > 0)
    begins = np.append(onsets[following] - rests[following], np.iinfo(np.int64).max)
    result: npt.NDArray[np.bool_] = begins[np.searchsorted(following, at, side="right")] - onsets[at] <= beat_ticks
    return result


def _lengths_around(duration_s: FloatArray) -> FloatArray:
    """(N,): the median length of the eight notes before each, as far as there are any."""
    count = len(duration_s)
    around = np.empty(count)
    if count > 8:
        eight = np.sort(np.lib.stride_tricks.sliding_window_view(duration_s[:-1], 8), axis=1)
        around[8:] = (eight[:, 3] + eight[:, 4]) / 2.0
    for index in range(min(8, count)):
        around[index] = median(duration_s[: max(index, 1)].tolist())
    return around
