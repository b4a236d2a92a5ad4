"""Body motion as gestures: sway, lean and accents (`app.plan.gestures.sways`, `app.plan.gestures.leans_and_accents`),
weight shifts, bell height, lowering of the instrument (`app.plan.gestures.lowered_instrument`), feet
(`app.plan.gestures.feet`) and gestures while not playing (`app.plan.cues.answering_nods`,
`app.plan.gestures.idle_gestures`).

Events of sway, lean, weight_shift and bell_height follow one another without gaps. The ``amount`` of a sway or lean is
the position at its end, that of the other two the position during the event. Amounts follow the dynamics
(`app.plan.music.dynamics`); the motion scales them by the player's amplitude.

In a rest longer than twice `app.plan.gestures.sways.STIR_S` the body moves with the beat only near its ends, plus a few
weight shifts: the number of events grows with the notes, not with the silence.

Random values depend on player and score position (tick), so a place has the same motion in every run, whatever is
edited elsewhere (Wanderley: players repeat the same bell movement at the same place).
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from functools import lru_cache
from operator import attrgetter

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.errors import Message
from app.plan.gestures.sways import STIR_S, Pulse, spans_near_notes
from app.plan.model import GestureEvent, TimeFrame
from app.plan.music.dynamics import Dynamics, amount_at_vigour
from app.plan.music.piece import LineTimes, NoteTimes, Piece, Seeds
from app.score.model import Note
from app.score.tempo import TempoMap

SHIFT_MEAN_S = 9.0
SHIFT_LEAST_S = 3.0
MOST_IN_SILENCE = 12
CONTOUR_SEMITONES = 10.0
"""Distance in semitones from the line's mean pitch at which the bell reaches its highest or lowest position."""
CONTOUR_STEP = 0.12
"""Differences of the bell's height (0..1) below this value are combined into one gesture."""
VIGOUR_STEP = 1.4
"""Factor of the vigour within which loudness counts as unchanged."""
ARCH, RELEASE, ARCH_BEATS = 0.15, 0.6, 4
"""Rise of the bell to a phrase's climax, share of it by which the bell sinks at the phrase's end, and least length of
such a phrase in beats.
"""
ARCH_LOUDNESS, ARCH_DOWNBEAT = 1.0, 0.1
"""Weights of loudness above the phrase's mean and of a bar's first beat in choosing the climax; the bell's height has
1.
"""
ACCENT_LIFT, MOST_ACCENT_LIFT = 1.5, 0.4
"""Rise of the bell at an accent per unit of loudness, and greatest rise."""


def in_order(kinds: tuple[Sequence[GestureEvent], ...]) -> tuple[GestureEvent, ...]:
    """Sort gestures of several kinds by start, then by id; starts are compared first since that is faster than
    comparing pairs.
    """
    events = sorted(itertools.chain(*kinds), key=attrgetter("start_s"))
    starts_s = np.array([event.start_s for event in events])
    for place in (np.flatnonzero(starts_s[1:] == starts_s[:-1]) + 1).tolist():
        event = events[place]
        while place and events[place - 1].start_s == event.start_s and events[place - 1].id > event.id:
            events[place], place = events[place - 1], place - 1
        events[place] = event
    return tuple(events)


def weight_shifts(
    times: NoteTimes, pulse: Pulse, frame: TimeFrame, seeds: Seeds, clock: TempoMap, dynamics: Dynamics
) -> list[GestureEvent]:
    """Plan shifts of weight from foot to foot at irregular times (T7), about every `SHIFT_MEAN_S`, by chance for each
    bar.
    """
    places = spans_near_notes(times, frame, pulse.bars_s)
    ticks, ends = pulse.bar_ticks[places], pulse.bar_ticks[places + 1]
    chances = np.minimum((pulse.bars_s[places + 1] - pulse.bars_s[places]) / SHIFT_MEAN_S, 0.9)
    shifts = seeds.chances_at("shift", ticks) < chances
    ticks, ends = ticks[shifts], ends[shifts]
    at_ticks = ticks + (seeds.chances_at("shift at", ticks) * (ends - ticks)).astype(np.int64)
    at_ticks = np.union1d(at_ticks, _in_silence(times, seeds, clock))
    starts: list[tuple[int, float]] = []
    for at, at_s in zip(at_ticks.tolist(), clock.seconds(at_ticks.astype(np.float64)).tolist(), strict=True):
        if at_s >= frame.first_frame_s and (not starts or at_s - starts[-1][1] >= SHIFT_LEAST_S):
            starts.append((at, at_s))
    events = []
    last = (int(pulse.bar_ticks[-1]), frame.end_s)
    vigours = dynamics.at(np.array([start_s for _, start_s in starts])).tolist()
    for (tick, start_s), (end_tick, end_s), vigour in zip(starts, [*starts, last][1:], vigours, strict=True):
        if end_s <= start_s:
            continue
        amount = 2.0 * seeds.chance_at("shift to", tick) - 1.0
        amount = float(np.copysign(0.25 + 0.75 * abs(amount), amount))
        amount = amount_at_vigour(amount, vigour)
        reason = _shifted("left" if amount > 0.0 else "right")
        events.append(
            GestureEvent(
                f"weight_shift:@{tick}", "weight_shift", tick, end_tick, start_s, end_s, round(amount, 4), reason
            )
        )
    return events


def _in_silence(times: NoteTimes, seeds: Seeds, clock: TempoMap) -> IntArray:
    """Return the ticks at which a silent player shifts the weight, at most `MOST_IN_SILENCE` within each long
    silence."""
    found = []
    quiet = times.onset_s[1:] - times.played_end_s[:-1] > 2.0 * STIR_S + SHIFT_LEAST_S
    for index in np.flatnonzero(quiet).tolist():
        at_s, last_s = float(times.played_end_s[index]) + STIR_S, float(times.onset_s[index + 1]) - STIR_S
        place = int(times.onset_tick[index + 1])
        for number in range(MOST_IN_SILENCE):
            at_s += SHIFT_MEAN_S * (0.5 + seeds.chance_at(f"shift in silence {number}", place))
            if at_s > last_s:
                break
            found.append(round(clock.ticks(at_s)))
    return np.array(found, dtype=np.int64)


def mean_pitch(times: LineTimes) -> float:
    """Mean pitch of a part weighted by sounding time; 0 without notes."""
    return float(np.average(times.pitch, weights=_weights(times))) if len(times.pitch) else 0.0


def _weights(times: LineTimes) -> FloatArray:
    return np.maximum(times.duration_s, 1e-3)


def bell_heights(
    notes: tuple[Note, ...], times: LineTimes, piece: Piece, dynamics: Dynamics, usual_pitch: float
) -> list[GestureEvent]:
    """Plan the height of the bell along the melody: for each felt beat the mean pitch (by sounding time) relative to
    ``usual_pitch``, the part's mean. Beats of about the same height form one gesture; a silence of a beat ends it. The
    height grows with loudness, rises with accents and towards the climax of a phrase, and sinks at its end.
    """
    if not notes:
        return []
    weight = _weights(times)
    bars = piece.bars(int(times.onset_tick[0]), int(times.onset_tick[-1]) + 1)
    bar = np.searchsorted(bars, times.onset_tick, "right") - 1
    beat_ticks = piece.beat_ticks_at(times.onset_tick)
    beat = (times.onset_tick - bars[bar]) // beat_ticks
    starts = np.flatnonzero(np.concatenate(([True], (np.diff(bar) > 0) | (np.diff(beat) > 0))))
    sums = np.add.reduceat(times.pitch * weight, starts) / np.add.reduceat(weight, starts)
    heights = np.clip((sums - usual_pitch) / CONTOUR_SEMITONES, -1.0, 1.0)
    ends = np.append(starts[1:], len(notes))
    apart = times.silence_tick[starts] >= beat_ticks[starts]
    vigour = dynamics.at(times.onset_s[starts])
    accents = np.maximum.reduceat(dynamics.accents, starts)
    loud = np.add.reduceat(times.loudness * weight, starts) / np.add.reduceat(weight, starts)
    first_of_bar = np.concatenate(([True], np.diff(bar[starts]) > 0))
    arches, turns = _arches(times.onset_s[starts], heights, loud, first_of_bar, apart)
    arches = arches * np.minimum(vigour, 1.5)
    amounts = amount_at_vigour(heights, vigour) + arches + np.minimum(ACCENT_LIFT * accents, MOST_ACCENT_LIFT)
    # As lists, because looping over single values of an array is several times slower.
    accented = accents.tolist()
    breaks = (apart | turns | (accents > 0.0)).tolist()
    firsts = _bell_starts(heights.tolist(), vigour.tolist(), breaks, accented)
    first, last = starts[firsts], ends[[*(place - 1 for place in firsts[1:]), len(starts) - 1]] - 1
    rows = zip(
        firsts,
        first.tolist(),
        times.onset_tick[first].tolist(),
        times.played_end_tick[last].tolist(),
        times.onset_s[first].tolist(),
        times.played_end_s[last].tolist(),
        np.clip(amounts[firsts], -1.0, 1.0).tolist(),
        strict=True,
    )
    pitches, mean = sums.tolist(), round(usual_pitch, 1)
    return [
        GestureEvent(
            f"bell_height:{notes[note].id}",
            "bell_height",
            start_tick,
            end_tick,
            start_s,
            end_s,
            round(amount, 4),
            _accented(round(accented[place], 2)) if accented[place] else _at_height(round(pitches[place], 1), mean),
        )
        for place, note, start_tick, end_tick, start_s, end_s, amount in rows
    ]


# Equal reasons are cached: there are tens of thousands.


@lru_cache(maxsize=2)
def _shifted(side: str) -> Message:
    return Message("gesture.weight_shift", {"side": side})


@lru_cache(maxsize=256)
def _accented(more: float) -> Message:
    return Message("gesture.bell_accent", {"more": more})


@lru_cache(maxsize=8192)
def _at_height(pitch: float, mean_pitch: float) -> Message:
    return Message("gesture.bell_height", {"pitch": pitch, "mean_pitch": mean_pitch})


def _bell_starts(heights: list[float], vigour: list[float], breaks: list[bool], accented: list[float]) -> list[int]:
    """Indices of the beats at which a new bell movement begins: at a new height or vigour, after a break, and after an
    accent.
    """
    firsts: list[int] = []
    for place, height in enumerate(heights):
        if firsts and not breaks[place] and not accented[firsts[-1]]:
            change = vigour[place] / vigour[firsts[-1]]
            near = abs(heights[firsts[-1]] - height) < CONTOUR_STEP
            if near and 1.0 / VIGOUR_STEP < change < VIGOUR_STEP:
                continue
        firsts.append(place)
    return firsts


def _arches(
    at_s: FloatArray,
    heights: FloatArray,
    loudness: FloatArray,
    first_of_bar: BoolArray,
    apart: BoolArray,
) -> tuple[FloatArray, BoolArray]:
    """Bell height due to phrases, beat by beat: rising to the climax (the highest, loudest beat, preferably the first
    of a bar) and falling at the end; and a mask of the beats concerned. Rests of a beat (``apart``) separate phrases.
    """
    arches, turns = np.zeros(len(at_s)), np.zeros(len(at_s), dtype=bool)
    edges = np.flatnonzero(apart | (np.arange(len(at_s)) == 0))
    for first, end in itertools.pairwise([*edges.tolist(), len(at_s)]):
        if end - first < ARCH_BEATS:
            continue
        here = slice(first, end)
        climb = heights[here] + ARCH_LOUDNESS * loudness[here] + ARCH_DOWNBEAT * first_of_bar[here]
        climax, last = first + int(np.argmax(climb)), end - 1
        knots = {first: 0.0, last: -RELEASE, climax: 1.0}
        places = sorted(knots)
        turns[[climax, last]] = True
        arches[here] = ARCH * np.interp(at_s[here], at_s[places], [knots[place] for place in places])
    return arches, turns
