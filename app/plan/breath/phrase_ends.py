"""Rates the place before each note as a phrase end, for catch breaths.

The evidence is summed as log odds. The weights were learned by logistic regression on vocal lines with known phrases:
the Essen Folksong Collection (Schaffrath, 1995; marked phrases of 902 songs) and the OpenScore Lieder Corpus (CC0; in
393 songs the places after a comma, full stop or breath mark). Half the log odds of a slur over the place are removed,
since engraved wind parts have slurs. The features are those of Temperley (The Cognition of Basic Musical Structures,
2001, ch. 3: gaps, equal phrases, parallel metre) that a MIDI file shows.
"""

from __future__ import annotations

from statistics import median
from typing import Final, NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray, rows_of
from app.plan.breath.catch_breath_lengths import CATCH_MIN_S, CATCH_NOTE_SHARE, MOST_DROPPED
from app.plan.music.notation import PLACES, written_onsets
from app.plan.music.piece import EPSILON, LineTimes, Piece, Seeds, gaps_s, staccato
from app.plan.music.written_marks import WrittenMarks

# Learned weights: log odds of a phrase end for each property.
LONG_NOTE: Final = 0.8
"""Log odds of a phrase's end after a note twice as long as the notes around; four times as long counts twice, and no
more."""
SHORTER: Final = 0.55
"""Log odds of a phrase's end before a note half as long as the one before; a quarter counts twice, and no more."""
LONGER: Final = -0.7
"""Log odds of a phrase's end before a note twice as long as the one before; four times as long counts twice, and no
more."""
AMONG_RUNNING: Final = -0.35
"""Log odds of a phrase's end after a running note (`RUNNING`)."""
FALL: Final = -0.35
"""Log odds of a phrase's end at a metrically weaker place than that of the note before, for every level between
them, unless notes run."""
BAR: Final = 0.25
"""Log odds of a phrase's end where a bar begins."""
LEAP: Final = 1.05
"""Log odds of a phrase's end where the line leaps a fourth or more."""
REPEATED: Final = 1.7
"""Log odds of a phrase's end between two equal notes."""
RISING: Final = 0.2
"""Log odds of a phrase's end where the line rises."""
LIKE_ENTRIES: Final = 1.75
"""Log odds of a phrase's end at the place in the bar (or half bar) at which the line enters after rests; a share of
it if the line often enters elsewhere.
"""
AGAIN: Final = 1.75
"""Log odds of a phrase's end before notes that repeat those after a rest; less, the more often they recur."""
TWO_BARS: Final = 1.55
"""Log odds of a phrase's end two bars, or a multiple of that, after the line last came in."""
FOUR_BARS: Final = 0.7
"""Added to `TWO_BARS` after four bars or a multiple of that."""

# Weights that folk songs cannot teach.
PLACE_COST: Final = 5.15
"""Cost of a breath at a place with no favourable feature; 3.9 of it is the negative log odds of such a place."""
REST: Final = 4.0
"""Log odds of a breath in a rest of the score."""
SILENCE: Final = 1.0
"""Log odds of a breath in a short silence."""
RUNNING: Final = 0.75
"""Greatest length in beats of running notes; only among these, breathing after the first beat of a bar is usual."""
BEFORE_UPBEAT: Final = 0.8
"""Log odds in running notes of a breath before a weak place after a strong one, for each metrical level
between them.
"""
AFTER_UPBEAT: Final = -2.5
"""Log odds in running notes of a breath before a stronger place, for each metrical level between them, unless the
previous note is long.
"""
AFTER_ENTRY: Final = -80.0
"""Value that replaces `AFTER_UPBEAT` if the upbeat itself follows a rest; omitting two notes elsewhere costs less."""
BEFORE_TAIL: Final = -40.0
"""Log odds of a breath between a dotted note and its short off-beat note; omitting a note elsewhere costs less."""
IN_STACCATO: Final = -40.0
"""Log odds of a breath within three or more consecutive staccato notes."""
AGAIN_NOTES: Final = 4
SLURRED: Final = -40.0
"""Log odds of a breath within a slur, acceptable only without any air left."""
WRITTEN_SLUR: Final = -300.0
"""Log odds of a breath within a written slur, unless in a rest under it; omitting notes or two close breaths elsewhere
cost less.
"""
ALL_SLURRED: Final = (0.75, 0.9)
"""Shares of notes that run into the next one: above the first, slurs count less since legato is the player's habit and
no phrasing; above the second, they do not count.
"""
BEFORE_REST: Final = -8.0
"""Cost of a breath if a rest comes within a felt beat."""
CLIPPED: Final = -2.0
"""Log odds of a breath that removes a whole note; in proportion if more than the usual part of the note is removed."""
JITTER: Final = 0.2
"""Greatest random difference (log odds) between players, which decides between equally good places."""
TAKEN_COST: Final = 6.0
"""Cost of a breath at the place where another player of the same line breathes: players stagger."""


class ComparedLine(NamedTuple):
    """A part with the data needed to compare places for breaths.

    Attributes
    ----------
    rests : (N,) int64
        Ticks of rest before each note, from `app.plan.music.rests.rest_ticks`.
    taken : (N,) bool
        Mask of notes before which another player of the same part breathes.
    seeds : Seeds
        Random choice between equally good places, different for each player.
    """

    times: LineTimes
    piece: Piece
    rests: IntArray
    written: WrittenMarks
    taken: BoolArray
    seeds: Seeds


class _Places(NamedTuple):
    """The N notes of a part with their positions in the bar, and features of the K places that are compared.

    Attributes
    ----------
    onsets, steps, strength : (N,) int64
        Quantised onset in ticks, ticks to the next onset, and metrical strength.
    bars : (B,) int64
        Ticks at which bars begin.
    beat : (K,) int64
        Ticks of the felt beat at each place.
    falls : (K,) int64
        Number of levels by which each place is metrically weaker than that of the previous note.
    runs : (K,) bool
        Whether the place is within running notes.
    like : (K,) float64
        `_like_entries`.
    long : (K,) float64
        Length of the previous note relative to the notes around it, in octaves, 0 to 2.
    """

    onsets: IntArray
    steps: IntArray
    strength: IntArray
    bars: IntArray
    beat: IntArray
    falls: IntArray
    runs: BoolArray
    like: FloatArray
    long: FloatArray


def place_costs(line: ComparedLine, at: IntArray, dropped: IntArray | int = 0) -> FloatArray:
    """Cost (K,) of a breath before each of the K notes with the indices ``at``, which do not include the first note.

    Below 0 at a clear phrase end, where a breath is taken even with air left.

    Parameters
    ----------
    dropped : (K,) int64
        Number of notes from there on that are left out for the breath.
    """
    if not len(at):
        return np.zeros(0)
    times, rests = line.times, line.rests
    places = _places(line, at, dropped)
    onset, rest = places.onsets[at], rests[at] > 0
    quarter = line.piece.clock.ticks_per_quarter
    good = _phrase_end(times, places, rests, at)
    good += REST * rest + SILENCE * (times.silence_tick[at] > 0)
    good += _against(line, places, at)
    good -= slur_costs(line, at)
    good += BEFORE_REST * (~rest & _rest_follows(rests, places.onsets, at, places.beat))
    taken_share = (CATCH_MIN_S - gaps_s(times)[at]) / np.maximum(times.duration_s[at - 1], EPSILON)
    good += CLIPPED * np.clip(taken_share / CATCH_NOTE_SHARE - 1.0, 0.0, 1.0)
    good += JITTER * line.seeds.chances_at("catch", onset, (2 * PLACES * onset + quarter) // (2 * quarter))
    good -= TAKEN_COST * line.taken[at]
    return np.asarray(PLACE_COST - good, dtype=np.float64)


def _places(line: ComparedLine, at: IntArray, dropped: IntArray | int) -> _Places:
    piece, onsets = line.piece, line.times.onset_tick
    beat = piece.beat_ticks_at(onsets[at])
    bars = piece.bars(int(onsets[0]), int(onsets[-1]) + 1)
    onsets = written_onsets(onsets, piece.clock.ticks_per_quarter, bars)
    steps = np.maximum(np.diff(onsets, append=onsets[-1] + beat.max()), 1)
    strength = _strength(onsets, bars, piece.beat_ticks_at(onsets))
    strongest = np.max([strength[at + np.minimum(dropped, more)] for more in range(MOST_DROPPED + 1)], axis=0)
    runs = steps[at - 1] <= RUNNING * beat
    like = _like_entries(line.rests, onsets, at, bars)
    long = np.clip(np.log2(steps[at - 1] / _lengths_around(steps.astype(np.float64))[at]), 0.0, 2.0)
    return _Places(onsets, steps, strength, bars, beat, strength[at - 1] - strongest, runs, like, long)


def _phrase_end(times: LineTimes, places: _Places, rests: IntArray, at: IntArray) -> FloatArray:
    """Return the log odds (K,) of a phrase end before each of the K notes ``at``, without the constant term."""
    steps, runs, falls = places.steps, places.runs, places.falls
    shorter = np.clip(np.log2(steps[at - 1] / steps[at]), -2.0, 2.0)
    moves = np.diff(times.pitch)[at - 1]
    again = _begins_again(steps, times.pitch, rests)
    # In running notes a breath comes after the note on the beat.
    square = _squareness(rests, places.onsets, at - runs, places.bars)
    good: FloatArray = LONG_NOTE * places.long
    good += SHORTER * np.maximum(shorter, 0.0) + LONGER * np.maximum(-shorter, 0.0)
    good += AMONG_RUNNING * runs + FALL * ~runs * np.maximum(falls, 0)
    good += BAR * (places.strength[at - 1] - falls == BAR_STRENGTH)
    good += LEAP * times.leaps[at - 1] + REPEATED * (moves == 0) + RISING * (moves > 0)
    good += LIKE_ENTRIES * places.like + AGAIN * again[at] * (1.0 - again.mean())
    good += TWO_BARS * (square >= 1) + FOUR_BARS * (square >= 2)
    return good


def _against(line: ComparedLine, places: _Places, at: IntArray) -> FloatArray:
    """Cost (K,) that running, dotted and staccato notes add to a breath before each of the K notes with indices ``at``;
    mostly positive.
    """
    onsets, steps, strength, runs, falls = places.onsets, places.steps, places.strength, places.runs, places.falls
    times, rest = line.times, line.rests[at] > 0
    # Where slurs are known, they show whether a short note before a bar line is an upbeat.
    slurs_known = bool(times.slurs_next[:-1].any()) and _legato(line) == 0.0
    leads_to = strength[np.minimum(at + 1, len(onsets) - 1)]
    tail = ~rest & (2 * steps[at] <= places.beat - (slurs_known & (leads_to == BAR_STRENGTH)))
    tail &= _are_dotted(steps[at - 1], steps[at]) & (leads_to > 0 if slurs_known else strength[at] == 0)
    short = staccato(onsets, onsets + times.played_end_tick - times.onset_tick, line.piece.clock.ticks_per_quarter)
    # A long note or a rest ends the notes that led to the next one.
    leads = ~rest & (places.long < 1.0)
    good: FloatArray = BEFORE_TAIL * tail + IN_STACCATO * (~rest & _in_a_row(short)[at])
    good += runs * (BEFORE_UPBEAT * np.maximum(falls, 0) + AFTER_UPBEAT * np.maximum(-falls, 0) * leads)
    good += AFTER_ENTRY * (~rest & runs & (falls < 0) & (line.rests[at - 1] > 0))
    return good


def _in_a_row(short: BoolArray) -> BoolArray:
    """Mask (N,) of notes that, with the note before, are in a row of at least three notes for which ``short`` is
    true.
    """
    here = np.append(False, short[:-1] & short[1:])
    result: BoolArray = here & (np.append(here[1:], False) | np.append(False, here[:-1]))
    return result


def _are_dotted(long: IntArray, short: IntArray) -> BoolArray:
    """Return a mask (K,) of the pairs of lengths that form a dotted or double-dotted figure."""
    doubly: BoolArray = np.abs(long - 7 * short) < short // 2
    return (long > 2 * short) & (long < 4 * short) | doubly


def slur_costs(line: ComparedLine, at: IntArray) -> FloatArray:
    """Cost (K,) that slurs add to a breath before each of the K notes with indices ``at``."""
    heard = -SLURRED * (1.0 - _legato(line)) * line.times.slurs_next[at - 1]
    written = np.where(line.rests[at] > 0, -SLURRED, -WRITTEN_SLUR)
    return np.asarray(np.where(line.written.joined[at - 1], written, heard), dtype=np.float64)


def _legato(line: ComparedLine) -> float:
    """Degree, 0..1, to which the whole part is played legato. The higher it is, the less slurs that are heard in the
    sound count as phrases; slurs in a score always count.

    Ignores notes before a rest and repeated notes, where a key must be released before it is pressed again.
    """
    if line.written.is_score:
        return 0.0
    times = line.times
    could = (line.rests[1:] == 0) & (np.diff(times.pitch) != 0)
    share = float(times.slurs_next[:-1][could].mean()) if could.any() else 0.0
    return float(np.interp(share, ALL_SLURRED, (0.0, 1.0)))


BAR_STRENGTH: Final = 3


def _strength(ticks: IntArray, bars: IntArray, beat_ticks: IntArray) -> IntArray:
    """Return the metrical strength (K,) of K ticks: 3 at a bar line, 2 in mid-bar, 1 on another felt beat, 0
    elsewhere."""
    place = np.maximum(np.searchsorted(bars, ticks, side="right") - 1, 0)
    since = ticks - bars[place]
    length = np.append(np.diff(bars), 0)
    length = np.where(length > 0, length, beat_ticks.max())[place]
    on_beat = since % beat_ticks == 0
    middle = on_beat & (2 * since == length)
    return np.where(since == 0, BAR_STRENGTH, np.where(middle, 2, np.where(on_beat, 1, 0)))


def _like_entries(rests: IntArray, onsets: IntArray, at: IntArray, bars: IntArray) -> FloatArray:
    """For each of K places the share (K,) of all entries after rests that begin at the same position in the bar."""
    place = np.maximum(np.searchsorted(bars, onsets, side="right") - 1, 0)
    bar = _usual_bar(bars)
    phase = (onsets - bars[place]) % max(bar // 2 if bar % 2 == 0 else bar, 1)
    phases, counts = np.unique(phase[rests > 0], return_counts=True)
    known = np.minimum(np.searchsorted(phases, phase[at]), len(phases) - 1)
    shares: FloatArray = np.where(phases[known] == phase[at], counts[known] / counts.sum(), 0.0)
    return shares


def _squareness(rests: IntArray, onsets: IntArray, at: IntArray, bars: IntArray) -> FloatArray:
    """Rate (K,) how square the phrase before each of K places is: 2 if it lasts a multiple of four bars since the last
    entry after a rest, 1 if an odd multiple of two bars, else 0.
    """
    entries = np.flatnonzero(rests > 0)
    entry = onsets[entries[np.maximum(np.searchsorted(entries, at, side="right") - 1, 0)]]
    bar = _usual_bar(bars)
    since = onsets[at] - entry
    return np.asarray((since > 0) * ((since % (2 * bar) == 0) + 1.0 * (since % (4 * bar) == 0)))


def _usual_bar(bars: IntArray) -> int:
    """Return the length in ticks that most bars have."""
    return int(median(np.diff(bars).tolist())) if len(bars) > 1 else 1


def _begins_again(steps: IntArray, pitch: IntArray, rests: IntArray) -> BoolArray:
    """Mask (N,) of notes that start a repetition of the rhythm and direction with which a phrase after a rest began."""
    count = len(steps)
    result = np.zeros(count, dtype=bool)
    if count > AGAIN_NOTES:
        moves = np.sign(np.diff(pitch))
        columns = np.concatenate((rows_of(steps[:-1], AGAIN_NOTES), rows_of(moves, AGAIN_NOTES)))
        rows = np.ascontiguousarray(columns.T, np.int64)
        # Compared as bytes, since most lines have few entries but many different bars.
        kinds = rows.view(np.dtype((np.void, rows.shape[1] * rows.itemsize))).ravel().tolist()
        entries = {kinds[place] for place in np.flatnonzero(rests[: len(kinds)] > 0).tolist()}
        result[: len(kinds)] = [kind in entries for kind in kinds]
    return result


def _rest_follows(rests: IntArray, onsets: IntArray, at: IntArray, beat_ticks: IntArray) -> BoolArray:
    """Return a mask (K,) of the places after which a rest begins within a beat."""
    following = np.flatnonzero(rests > 0)
    begins = np.append(onsets[following] - rests[following], np.iinfo(np.int64).max)
    result: BoolArray = begins[np.searchsorted(following, at, side="right")] - onsets[at] <= beat_ticks
    return result


def _lengths_around(duration_s: FloatArray) -> FloatArray:
    """For each of N notes the median length (N,) of the up to eight notes before it."""
    count = len(duration_s)
    around = np.empty(count)
    if count > 8:
        eight = np.sort(rows_of(duration_s[:-1], 8), axis=0)
        around[8:] = (eight[3] + eight[4]) / 2.0
    for index in range(min(8, count)):
        around[index] = median(duration_s[: max(index, 1)].tolist())
    return around
