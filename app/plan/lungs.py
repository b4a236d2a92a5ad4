"""How far the air of a breath reaches, and where a catch breath is best taken when no rest comes in time."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from app.plan.dynamics import mean_around
from app.plan.heard import STOPS_AT, Blown, step_means
from app.plan.line import MEZZOFORTE, IntArray, LineTimes, Piece, Seeds, marked
from app.plan.model import FloatArray, Note
from app.plan.notation import PLACES, written_onsets
from app.plan.parameters import PlayerParameters
from instrument_maps.model import Air

FULL_BREATH_S = 0.5
"""Time a trained player needs to fill the lungs."""
CATCH_MIN_S = 0.12
"""A gasp shorter than this brings no air."""
CATCH_MAX_S = 0.4
CATCH_NOTE_SHARE = 0.5
"""A catch breath takes at most this part of the note before it ..."""
CATCH_MOST_SHARE = 0.5
"""... unless that would be no gasp: out of a short note as much as a gasp needs, at most this part."""
LOUDNESS_RANGE = (0.6, 1.6)
"""Air used by the softest and the loudest note, mezzoforte being 1, on an instrument whose map says nothing else."""
USUAL_LUNG_S = 9.0
"""The lungs of `PlayerParameters.lung_s` as they are unless set: what a map's `Air` is about."""
PIANO, FORTE = 0.39, 0.77
"""Loudness of the dynamics a map's `Air` names: velocities 49 and 98 of 127."""

PHRASE_S = 8.0
"""The air of a note follows the dynamic mark nearest to the mean loudness so far before and after."""
STALE_S = 12.0
"""However little air an instrument takes, usual lungs want fresh air after so long (an oboist breathes out first)."""

CIRCULAR_SHARE = 0.4
"""Part of the air that stays in the lungs of a player who breathes in through the nose."""

# How good a place for a catch breath is (added up; the cost of a place is PLACE_COST minus this).
PLACE_COST = 7.0
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
BEFORE_TAIL = -7.0
"""Before a lone short note that leads to a beat, the tail of a dotted note; half a beat before a bar line is none."""
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
CLIPPED = -1.0
"""Out of a note so short that it loses more than the usual part."""
JITTER = 0.2
"""Players differ where places are equally good."""
TAKEN_COST = 6.0
"""Where another player of the same line breathes: players stagger."""
EARLY_COST = 1.0
"""Breathing in with lungs still full; with half a lungful a quarter of it."""
HASTY_SHARE = 0.3
"""Part of the lungs ..."""
HASTY_COST = 10.0
"""... that is used up at least before the next breath."""
TOO_LONG_COST = 1000.0
DROPPED_COST = 30.0
"""Leaving out a note, where none is long enough to take a gasp from."""
EPSILON = 1e-6
"""Rounding of air summed over an hour of notes, seconds."""


def air_used_s(times: LineTimes, air: Air | None = None, heard: Blown | None = None) -> FloatArray:
    """(N + 1,): air taken by all notes before each, and by all, in seconds of playing at mezzoforte.

    Parameters
    ----------
    heard : Blown or None
        The breath, where it tells when air is blown: then all of it counts, also between the notes.
    """
    lasts_s = times.duration_s
    # The dynamic of the phrases takes the air, not how each of their notes turned out.
    loudness = marked(mean_around(times.onset_s, lasts_s, times.loudness, times.onset_s + lasts_s / 2.0, PHRASE_S))
    noted_s = lasts_s * air_rate(loudness, air)
    if heard is None:
        return np.concatenate(([0.0], np.cumsum(noted_s)))
    rate = np.where(heard.values > STOPS_AT, air_rate(heard.values, air), 0.0)
    ends_s = np.append(times.onset_s[1:], times.played_end_s[-1])
    blown_s = np.maximum(ends_s - times.onset_s, EPSILON)
    taken = step_means(heard.at_s, rate, times.onset_s, times.onset_s + blown_s) * blown_s
    # Notes that were not blown take what their loudness says.
    taken = np.where(heard.plays(times), taken, noted_s)
    return np.concatenate(([0.0], np.cumsum(taken)))


def air_rate(loudness: FloatArray, air: Air | None = None) -> FloatArray:
    """How much more air a loudness takes than mezzoforte does."""
    if air is None:
        low, high = LOUDNESS_RANGE
        return np.interp(loudness, [0.0, MEZZOFORTE, 1.0], [low, 1.0, high])
    lasting_s = [min(lasts_s, STALE_S) for lasts_s in (air.piano_s, air.mezzoforte_s, air.forte_s)]
    return np.interp(loudness, [PIANO, MEZZOFORTE, FORTE], [lasting_s[1] / one_s for one_s in lasting_s])


def lungful_s(parameters: PlayerParameters, air: Air | None = None) -> float:
    """How long a player's full breath lasts at mezzoforte: what the map says, on lungs of the player's size."""
    return parameters.lung_s * (1.0 if air is None else min(air.mezzoforte_s, STALE_S) / USUAL_LUNG_S)


def levels(used: FloatArray, lung_s: float, refill: FloatArray) -> FloatArray:
    """(N,): how full the lungs are (0..1) at each note's onset, after the breath before it."""
    # Nobody enters on empty lungs: without any breath before the first note (removed by hand) a normal one is assumed.
    here, before = (0.5 if refill[0] == 0.0 else 0.0), 0
    breaths = np.flatnonzero(refill > 0.0)
    full = [here]
    for index, air, more in zip(breaths.tolist(), used[breaths].tolist(), refill[breaths].tolist(), strict=True):
        spent = (air - float(used[before])) / lung_s
        here, before = min(max(here - spent, 0.0) + more, 1.0), index
        full.append(here)
    # Until the next breath it goes down as the air is used.
    last = np.searchsorted(breaths, np.arange(len(refill)), side="right")
    since = used[np.insert(breaths, 0, 0)[last]]
    return np.asarray(np.maximum(np.array(full)[last] - (used[: len(refill)] - since) / lung_s, 0.0))


def where_short(used: FloatArray, lung_s: float, refill: FloatArray, filled: FloatArray) -> IntArray:
    """(K,): before which notes the catch breaths are not where the air lasts.

    From the one before the first stretch that takes more air than there is to the next rest that gives a breath.

    Parameters
    ----------
    refill, filled : (N,) float
        What the breaths in rests bring, and what they and the catch breaths bring.
    """
    starts = np.unique(np.concatenate(([0], np.flatnonzero(filled > 0.0))))
    ends = np.append(starts[1:], len(filled))
    short = np.flatnonzero(used[ends] - used[starts] > levels(used, lung_s, filled)[starts] * lung_s + EPSILON)
    rests = np.append(np.flatnonzero(refill > 0.0), len(filled))
    result = np.zeros(len(filled), dtype=bool)
    for first, start in zip(starts[np.maximum(short - 1, 0)].tolist(), starts[short].tolist(), strict=True):
        place = int(np.searchsorted(rests, start, side="right"))
        result[max(first, int(rests[place - 1]) if place else 0) : rests[place]] = True
    return np.flatnonzero(result & (filled > 0.0) & (refill == 0.0))


def needed_rests(
    used: FloatArray, lung_s: float, refill: FloatArray, optional: npt.NDArray[np.bool_], need: float
) -> npt.NDArray[np.bool_]:
    """(N,): before which notes a rest is breathed in, of those that ``refill`` (`levels`) names.

    Parameters
    ----------
    optional : (N,) bool
        Rests that are left alone as long as less than ``need`` (0..1) of the lungs is used up, and where the next
        rest that is none of them comes soon.
    """
    result = refill > 0.0
    level, before = (0.5 if refill[0] == 0.0 else 0.0), 0
    certain = np.append(np.flatnonzero(result & ~optional), len(refill))
    comes = used[certain[np.searchsorted(certain, np.arange(len(refill)), side="right").clip(max=len(certain) - 1)]]
    soon = np.minimum(HASTY_SHARE, need)
    for index in np.flatnonzero(result).tolist():
        level = max(level - float(used[index] - used[before]) / lung_s, 0.0)
        before = index
        until = float(comes[index] - used[index]) / lung_s
        if optional[index] and (1.0 - level < need - EPSILON or (until < soon and until <= level)):
            result[index] = False
        else:
            level = min(level + float(refill[index]), 1.0)
    return result


def with_circular_breathing(used: FloatArray, lung_s: float, refill: FloatArray) -> FloatArray:
    """(N + 1,): air used (`air_used_s`), less what is breathed in through the nose while the cheeks blow.

    After each breath of ``refill`` (`levels`) the lungs go down to `CIRCULAR_SHARE` of what is in them, and stay so.
    """
    result = used.copy()
    level = 0.5 if refill[0] == 0.0 else 0.0
    starts = np.unique(np.concatenate(([0], np.flatnonzero(refill > 0.0))))
    for start, end in zip(starts.tolist(), [*starts[1:].tolist(), len(refill)], strict=True):
        level = min(level + float(refill[start]), 1.0)
        most_s = (1.0 - CIRCULAR_SHARE) * level * lung_s
        result[start + 1 : end + 1] = result[start] + np.minimum(used[start + 1 : end + 1] - used[start], most_s)
        level -= float(result[end] - result[start]) / lung_s
    return result


def drawn(length_s: float) -> float:
    """Part of the lungs that a breath of this length fills."""
    return min(length_s / FULL_BREATH_S, 1.0)


def catch_places(
    notes: tuple[Note, ...],
    times: LineTimes,
    used: FloatArray,
    piece: Piece,
    lung_s: float,
    refill: FloatArray,
    level: FloatArray,
    removed: frozenset[str],
    taken: frozenset[str],
    seeds: Seeds,
    rests: IntArray,
    length_s: FloatArray | None = None,
    drop_s: FloatArray | None = None,
) -> list[int]:
    """Indices of the notes before which a catch breath is needed.

    Between two breaths that the rests give, the cheapest chain of places such that no stretch takes more air than
    there is (a shortest path; the cost of a place falls with how good a phrase end it is). Where nothing helps, the
    stretch stays.

    Parameters
    ----------
    used : (N + 1,) float
        `air_used_s`.
    lung_s : float
        `lungful_s`.
    refill : (N,) float
        Part of the lungs that the breath before each note fills; 0 where there is none.
    level : (N,) float
        How full the lungs are at each note.
    rests : (N,) int64
        Ticks of rest before each note, as `app.plan.rests.rest_ticks` finds them.
    length_s : (N,) float, optional
        How long a catch breath before each note may be, where that was heard; `catch_lengths_s` otherwise.
    drop_s : (N,) float, optional
        `drop_lengths_s`: taken where nothing else gives the air.
    """
    length_s = catch_lengths_s(times, rests) if length_s is None else length_s
    drop_s = np.zeros(len(notes)) if drop_s is None else drop_s
    open_ = (length_s >= CATCH_MIN_S - EPSILON) & (refill == 0.0)
    open_[0] = False
    breaths = np.flatnonzero(refill > 0.0)
    starts = np.unique(np.concatenate(([0], breaths)))
    ends = np.append(starts[1:], len(notes))
    short = used[ends] - used[starts] > level[starts] * lung_s + EPSILON
    stretches = list(zip(starts[short].tolist(), ends[short].tolist(), strict=True))
    if not stretches:
        return []
    may = np.zeros(len(notes), dtype=bool)
    for start, end in stretches:
        may[start + 1 : end] = [f"breath:{note.id}" not in removed for note in notes[start + 1 : end]]
    dropping = ~open_ & (drop_s > 0.0) & (refill == 0.0)
    cost = np.full(len(notes), np.inf)
    at = np.flatnonzero(open_ & may)
    cost[at] = _place_costs(notes, times, piece, rests, at, taken, seeds)
    air_s = np.minimum(np.where(dropping, drop_s, length_s) / FULL_BREATH_S, 1.0) * lung_s

    def chain(start: int, end: int, allowed: npt.NDArray[np.bool_]) -> tuple[list[int], bool]:
        places = start + 1 + np.flatnonzero(allowed[start + 1 : end])
        nodes = np.concatenate(([start], places, [end]))
        found, is_enough = _cheapest_chain(
            used[nodes].tobytes(), cost[places].tobytes(), air_s[places].tobytes(), float(level[start]), lung_s
        )
        return places[list(found)].tolist(), is_enough

    result: list[int] = []
    for start, end in stretches:
        found, is_enough = chain(start, end, open_ & may)
        also = start + 1 + np.flatnonzero(dropping[start + 1 : end] & may[start + 1 : end])
        if not is_enough and len(also):
            # As good as a breath before the note that is left out, but for the note.
            cost[also] = _place_costs(notes, times, piece, rests, also - 1, taken, seeds) + DROPPED_COST
            found, _ = chain(start, end, (open_ | dropping) & may)
        result += found
    return result


@lru_cache(maxsize=4096)
def _cheapest_chain(
    used_bytes: bytes, cost_bytes: bytes, drawn_bytes: bytes, level: float, lung_s: float
) -> tuple[tuple[int, ...], bool]:
    """The places, and whether the air lasts with them.

    Label by label: what is left of the best way so far, and what the catch breath adds, is the air of a place.

    Remembered by its numbers: an edit leaves nearly all stretches of a line as they were.

    Parameters
    ----------
    used_bytes : bytes of (K + 2,) float64
        Air used until the stretch begins, until each place, and until it ends.
    cost_bytes, drawn_bytes : bytes of (K,) float64
        What each place costs, and the air that a catch breath brings there.
    """
    used, cost, drawn_s = (np.frombuffer(data) for data in (used_bytes, cost_bytes, drawn_bytes))
    last = len(used) - 1
    air_s = np.zeros(last + 1)
    air_s[0] = level * lung_s
    total = np.full(last + 1, np.inf)
    total[0] = 0.0
    origin = np.zeros(last + 1, dtype=np.int64)
    # No lungful reaches further back than this; where it does not even reach the place before, that one has to do.
    reach = np.minimum(np.searchsorted(used, used - lung_s - EPSILON), np.arange(last + 1) - 1)
    for node in range(1, last + 1):
        back = int(reach[node])
        needed = used[node] - used[back:node]
        left_s = air_s[back:node] - needed
        ways = total[back:node] + np.where(left_s < -EPSILON, TOO_LONG_COST * (1.0 - left_s), 0.0)
        left_s = np.maximum(left_s, 0.0)
        ways += HASTY_COST * np.maximum(1.0 - needed / (HASTY_SHARE * lung_s), 0.0)
        if node < last:
            ways += cost[node - 1] + EARLY_COST * np.square(left_s / lung_s)
        best = int(np.argmin(ways))
        origin[node], total[node] = back + best, ways[best]
        if node < last:
            air_s[node] = min(left_s[best] + drawn_s[node - 1], lung_s)
    chain = []
    node = int(origin[-1])
    while node > 0:
        chain.append(node - 1)
        node = int(origin[node])
    return tuple(chain[::-1]), bool(total[-1] < TOO_LONG_COST)


def _place_costs(
    notes: tuple[Note, ...],
    times: LineTimes,
    piece: Piece,
    rests: IntArray,
    at: IntArray,
    taken: frozenset[str],
    seeds: Seeds,
) -> FloatArray:
    """(K,): what a breath before each of the notes ``at`` (1 and up) costs."""
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
    falls = strength[at - 1] - strength[at]
    steps = np.diff(onsets, append=onsets[-1] + max(beat.max(), 1))
    leads_to = strength[np.minimum(at + 1, len(onsets) - 1)]
    tail = ~rest & (2 * steps[at] <= beat - (leads_to == 3)) & (leads_to > 0) & (steps[at - 1] > 2 * steps[at])
    good += BEFORE_TAIL * tail
    like = _like_entries(rests, onsets, at, bars)
    good += LIKE_ENTRIES * like
    good += AGAIN * _begins_again(steps, times.pitch, rests)[at]
    runs = steps[at - 1] <= RUNNING * beat
    # A long note or a rest ends what led to the next one; unless notes run, nothing leads to where the line comes in.
    leads = (~rest & (long < 1.0)) * (1.0 - like * ~runs)
    # Out of running notes a breath comes after the note on the beat.
    good += SQUARE * _squareness(rests, onsets, at - runs, bars)
    good += BEFORE_UPBEAT * np.clip(falls, 0, np.where(runs, 3, 1)) + AFTER_UPBEAT * np.maximum(-falls, 0) * leads
    good += SHORTER * np.clip(np.log2(np.maximum(before, EPSILON) / np.maximum(duration[at], EPSILON)), 0.0, 2.0)
    good += LEAP * times.leaps[at - 1]
    good += SILENCE * (times.silence_tick[at] > 0)
    good += SLURRED * (1.0 - _legato(times, rests)) * times.slurs_next[at - 1]
    good += BEFORE_REST * (~rest & _rest_follows(rests, onsets, at, beat))
    good += CLIPPED * (_gap_s(times)[at] + CATCH_NOTE_SHARE * before < CATCH_MIN_S)
    quarter = piece.clock.ticks_per_quarter
    good += JITTER * seeds.chances_at("catch", onset, (2 * PLACES * onset + quarter) // (2 * quarter))
    good -= TAKEN_COST * np.array([notes[index].id in taken for index in at.tolist()])
    return np.asarray(np.maximum(PLACE_COST - good, LEAST_COST), dtype=np.float64)


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
        rows = np.stack(columns, axis=1)
        _, kinds = np.unique(rows, axis=0, return_inverse=True)
        kinds = kinds.ravel()
        entries = np.unique(kinds[rests[: len(kinds)] > 0])
        result[: len(kinds)] = np.isin(kinds, entries)
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
        around[8:] = np.median(np.lib.stride_tricks.sliding_window_view(duration_s[:-1], 8), axis=1)
    for index in range(min(8, count)):
        around[index] = np.median(duration_s[: max(index, 1)])
    return around


def catch_lengths_s(times: LineTimes, rests: IntArray) -> FloatArray:
    """(N,): how long a catch breath before each note may be: the rest there, else also a part of the note before.

    Parameters
    ----------
    rests : (N,) int64
        Ticks of rest before each note; a silence without a rest is the end of a detached note.
    """
    gap = _gap_s(times)
    before = np.insert(times.duration_s[:-1], 0, 0.0)
    tail = np.maximum(CATCH_NOTE_SHARE * before, np.minimum(CATCH_MIN_S - gap, CATCH_MOST_SHARE * before))
    length = np.where((gap >= CATCH_MIN_S) & (rests > 0), gap, gap + tail)
    return np.asarray(np.minimum(length, CATCH_MAX_S), dtype=np.float64)


def drop_lengths_s(times: LineTimes) -> FloatArray:
    """(N,): how long a catch breath before each note may be that takes the place of the note before; 0 where it would
    be no gasp, or where the note before is the first."""
    step_s = np.diff(times.onset_s, prepend=times.onset_s[:1])
    step_s[:2] = 0.0
    return np.where(step_s >= CATCH_MIN_S - EPSILON, np.minimum(step_s, CATCH_MAX_S), 0.0)


def _gap_s(times: LineTimes) -> FloatArray:
    """(N,): the silence before each note; 0 before the first."""
    gap: FloatArray = np.maximum(times.onset_s - np.insert(times.played_end_s[:-1], 0, times.onset_s[0]), 0.0)
    return gap
