"""Motion of trunk and head by phrase and accent: a lean towards each climax and back, and a dip on strong notes.

A phrase lasts from breath to breath or from rest to rest. Random values depend on player and tick.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.errors import Message
from app.plan.gestures.sways import Pulse, Swings
from app.plan.model import ACCENT_AT, BreathEvent, CueEvent, GestureEvent
from app.plan.music.dynamics import Dynamics, amount_at_vigour
from app.plan.music.piece import LineTimes, NoteTimes, Piece, Seeds
from app.score.tempo import TempoMap

LEAN_BACK, ACCENT, LOUD = Message("gesture.lean_back"), Message("gesture.accent"), Message("gesture.accent_loud")
REST_S = 0.9
"""Silence in seconds that divides phrases, with or without a breath."""
LONGEST_S = 12.0
"""Length in seconds of the longest lean; longer phrases have several."""
WHOLE_S = 4.0
"""Length in seconds of a phrase with full leans; shorter ones have proportionally smaller leans."""
SHORTEST_S = 1.2
CLIMAX_FROM, CLIMAX_TO = 0.3, 0.8
"""Range of the position of the greatest lean, as a share of the phrase."""
HEIGHT_SEMITONES = 12.0
"""Semitones above the other notes that count as much for the climax as the difference between the loudest note and
silence.
"""
LONG_SHARE = 0.15
"""Weight in the climax of each second of a note's length, two at most."""
BACK_CHANCE = 0.2
"""Probability that the trunk leans back to the climax instead of forward."""

ACCENT_S = 1.1
"""Seconds of an accent's motion at a slow tempo; at a fast one it takes 1.6 beats."""
ACCENT_BEATS = 1.6
SHORTEST_ACCENT_S = 0.6
ON_BEAT_S = 0.03
APART_BEATS = 1.5
"""Least distance of accents in beats; a third of it for notes played louder than their neighbours."""
LOUDER, DOWNBEAT, LONG, LEAP = 6.0, 0.22, 0.35, 0.22
"""Weights of a note's strength: loudness above its neighbours, the first beat of a bar, length, a leap up to it."""
STRONG = 0.66
"""Strength from which a note is accented, after chance (0..1, of this weight) is added."""
CHANCE = 0.62
LEAST_ACCENT = 0.2
AFTER_BREATH = 0.6
"""Factor for an accent right after a breath, which moves the trunk too; such an accent is also shorter."""
CUED_S = 0.35
"""Seconds around an entry with a cue in which no accent is generated, since the cue has a nod."""


class Phrase(NamedTuple):
    """A phrase of a part, as a range of note indices: from ``first`` to before ``end``."""

    first: int
    end: int


def phrases(times: NoteTimes, breaths: Sequence[BreathEvent]) -> tuple[Phrase, ...]:
    """Divide a part into its phrases at breaths and rests, in order; every note belongs to exactly one."""
    count = len(times.onset_s)
    if not count:
        return ()
    after = _after_breaths(times, breaths)
    rests = np.flatnonzero(times.onset_s[1:] - times.played_end_s[:-1] >= REST_S) + 1
    edges = np.unique(np.concatenate(([0], after[after < count], rests, [count])))
    found: list[Phrase] = []
    for first, end in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        lasts_s = float(times.played_end_s[end - 1] - times.onset_s[first])
        parts = max(1, round(lasts_s / LONGEST_S + 0.3))
        if parts == 1:
            found.append(Phrase(first, end))
            continue
        cuts_s = times.onset_s[first] + lasts_s * np.arange(1, parts) / parts
        cuts = (first + np.searchsorted(times.onset_s[first:end], cuts_s)).tolist()
        bounds = sorted({first, end, *(cut for cut in cuts if first < cut < end)})
        found += [Phrase(*pair) for pair in pairwise(bounds)]
    return tuple(found)


def _after_breaths(times: NoteTimes, breaths: Sequence[BreathEvent]) -> IntArray:
    """For each of N breaths the index (N,) of the first note after it; the number of notes if none follows."""
    drawn_s = [breath.end_s for breath in breaths if breath.draws_air]
    return np.asarray(np.searchsorted(times.onset_s, np.array(drawn_s) - ON_BEAT_S))


def leans(
    found: tuple[Phrase, ...], times: LineTimes, clock: TempoMap, seeds: Seeds, dynamics: Dynamics
) -> list[GestureEvent]:
    """Plan the leans of the body towards each phrase's climax (its highest, loudest, longest notes) and back at its
    end."""
    events: list[GestureEvent] = []
    if not found:
        return events
    climbing = times.pitch / HEIGHT_SEMITONES + times.loudness
    climbing = climbing + LONG_SHARE * np.minimum(times.duration_s, 2.0)
    firsts = np.array([phrase.first for phrase in found])
    lasts = np.array([phrase.end for phrase in found]) - 1
    ticks, ends = times.onset_tick[firsts], times.played_end_tick[lasts]
    starts_s, ends_s = times.onset_s[firsts], times.played_end_s[lasts]
    sizes = 0.5 + 0.5 * seeds.chances_at("lean", ticks)
    back = seeds.chances_at("lean back", ticks) < BACK_CHANCE
    vigours = dynamics.at((starts_s + ends_s) / 2.0)
    sizes = sizes * np.minimum(1.0, (ends_s - starts_s) / WHOLE_S)
    amounts = amount_at_vigour(np.where(back, -0.5 * sizes, sizes), vigours)
    rests, onsets_s = seeds.chances_at("lean rest", ticks), times.onset_s.tolist()
    for place, (first, last) in enumerate(zip(firsts.tolist(), lasts.tolist(), strict=True)):
        start_s, end_s = float(starts_s[place]), float(ends_s[place])
        if end_s - start_s < SHORTEST_S:
            continue
        low, high = start_s + CLIMAX_FROM * (end_s - start_s), start_s + CLIMAX_TO * (end_s - start_s)
        one, other = (bisect_left(onsets_s, at_s, first, last + 1) for at_s in (low, high))
        if one < other:
            top = one + int(np.argmax(climbing[one:other]))
            top_s, top_tick = float(times.onset_s[top]), int(times.onset_tick[top])
        else:
            top_s = low + 0.5 * (high - low)
            top_tick = round(clock.ticks(top_s))
        tick, end, amount = int(ticks[place]), int(ends[place]), float(amounts[place])
        events.append(_event("lean", tick, top_tick, start_s, top_s, amount, _leant(round(end_s - start_s, 1))))
        home = -0.15 * amount * float(rests[place])
        events.append(_event("lean", top_tick, end, top_s, end_s, home, LEAN_BACK))
    return events


@lru_cache(maxsize=256)
def _leant(length_s: float) -> Message:
    """Return the message that explains a lean, cached so that equal ones are one object."""
    return Message("gesture.lean", {"length_s": length_s})


def accents(
    *,
    times: LineTimes,
    pulse: Pulse,
    piece: Piece,
    cues: Sequence[CueEvent],
    breaths: Sequence[BreathEvent],
    swings: Swings,
    seeds: Seeds,
    dynamics: Dynamics,
) -> list[GestureEvent]:
    """Plan dips of the body on strong notes, with preparation and follow-through: on some notes that are on a beat and
    on all notes louder than their neighbours, with bars without accents in between. ``pulse`` has the beats of the
    piece; ``swings`` gives the spans where the body is still."""
    if not len(times.onset_tick):
        return []
    clock = piece.clock
    on_beat, beat_s = _on_beat(times, pulse, piece)
    loud = dynamics.accents > 0.0
    candidates = np.flatnonzero(on_beat | loud)
    if not len(candidates):
        return []
    ticks = times.onset_tick[candidates]
    longer = np.minimum(times.duration_s[candidates] / np.maximum(beat_s[candidates], 1e-6), 3.0) / 3.0
    up = np.diff(times.pitch, prepend=times.pitch[:1])[candidates] >= 5
    downbeat = _nearest(pulse.bar_ticks, ticks) == ticks
    strength = LOUDER * dynamics.accents[candidates] + DOWNBEAT * downbeat + LONG * longer + LEAP * up
    still = swings.still_at(ticks) & ~loud[candidates]
    at_s = times.onset_s[candidates]
    scores = strength + CHANCE * seeds.chances_at("accent", ticks) - 10.0 * (still | _nodded(at_s, cues))
    chosen = _apart(at_s, scores, loud[candidates], beat_s[candidates])
    accented, ticks, at_s = candidates[chosen], ticks[chosen], at_s[chosen]
    sizes = seeds.chances_at("accent size", ticks)
    amounts = amount_at_vigour(
        np.clip(LEAST_ACCENT + 0.4 * strength[chosen] + 0.6 * sizes * sizes, 0.0, 1.0), dynamics.at(at_s)
    )
    inhaled = np.zeros(len(times.onset_s) + 1, dtype=bool)
    inhaled[_after_breaths(times, breaths)] = True
    amounts = np.where(inhaled[accented], AFTER_BREATH * amounts, amounts)
    lengths_s = np.clip(ACCENT_BEATS * beat_s[accented], SHORTEST_ACCENT_S, ACCENT_S)
    lengths_s = np.where(inhaled[accented], SHORTEST_ACCENT_S, lengths_s)
    starts_s = at_s - ACCENT_AT * lengths_s
    ends_s = starts_s + lengths_s
    rows = zip(
        ticks.tolist(),
        np.rint(clock.ticks(starts_s)).astype(np.int64).tolist(),
        np.rint(clock.ticks(ends_s)).astype(np.int64).tolist(),
        starts_s.tolist(),
        ends_s.tolist(),
        amounts.tolist(),
        loud[accented].tolist(),
        strict=True,
    )
    return [
        GestureEvent(
            f"accent:@{tick}", "accent", start, end, start_s, end_s, round(amount, 4), LOUD if is_loud else ACCENT
        )
        for tick, start, end, start_s, end_s, amount, is_loud in rows
    ]


def _on_beat(times: NoteTimes, pulse: Pulse, piece: Piece) -> tuple[BoolArray, FloatArray]:
    """Return a mask (N,) of the notes that begin on a felt beat, and the length of the beat there in seconds."""
    lengths = piece.beat_ticks_at(times.onset_tick)
    nearest, before = (_nearest(pulse.beat_ticks, times.onset_tick, back) for back in (0, 1))
    off = np.minimum(np.abs(nearest - times.onset_tick), np.abs(before - times.onset_tick))
    beat_s = piece.clock.seconds((times.onset_tick + lengths).astype(np.float64)) - times.onset_s
    return off * beat_s <= ON_BEAT_S * lengths, beat_s


def _nearest(places: IntArray, ticks: IntArray, back: int = 0) -> IntArray:
    """Return for each tick (N,) the first of the ascending ticks ``places`` at or after it, or the one that comes
    ``back`` entries earlier.
    """
    found: IntArray = places[np.clip(np.searchsorted(places, ticks) - back, 0, len(places) - 1)]
    return found


def _nodded(at_s: FloatArray, cues: Sequence[CueEvent]) -> BoolArray:
    """Mask (N,) of the times so close to a cue that the head nods there anyway."""
    cued_s = np.sort([-np.inf, *(cue.end_s for cue in cues), np.inf])
    following = np.searchsorted(cued_s, at_s).clip(1)
    near: BoolArray = np.minimum(at_s - cued_s[following - 1], cued_s[following] - at_s) < CUED_S
    return near


def _apart(at_s: FloatArray, scores: FloatArray, loud: BoolArray, beat_s: FloatArray) -> list[int]:
    """Return the indices of the strongest notes, chosen so that they keep a least distance in time."""
    order = np.argsort(-scores, kind="stable")
    order = order[scores[order] >= STRONG]
    needed_s = np.where(loud, APART_BEATS / 3.0, APART_BEATS) * beat_s
    taken: list[float] = []
    chosen: list[int] = []
    for place, time_s, apart_s in zip(order.tolist(), at_s[order].tolist(), needed_s[order].tolist(), strict=True):
        near = bisect_left(taken, time_s)
        if any(abs(other - time_s) < apart_s for other in taken[max(near - 1, 0) : near + 1]):
            continue
        taken.insert(near, time_s)
        chosen.append(place)
    return sorted(chosen)


def _event(
    kind: str, tick: int, end: int, start_s: float, end_s: float, amount: float, reason: Message
) -> GestureEvent:
    return GestureEvent(f"{kind}:@{tick}", kind, tick, max(end, tick + 1), start_s, end_s, round(amount, 4), reason)
