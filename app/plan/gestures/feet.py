"""Gestures of the feet: small steps at phrase ends, tapping toes in some phrases, and a raised heel on the side without
weight.

An event's ``amount`` is positive for the left foot, negative for the right one; its size is 0..1. A step goes out at
the start of its event and back at the end. A tap ends on its beat. Without events the feet stay on the ground.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from statistics import median
from typing import Final, Literal

import numpy as np

from app.arrays import FloatArray
from app.errors import Message
from app.plan.events_by_hand import StyleEvent
from app.plan.gestures.leans_and_accents import Phrase
from app.plan.gestures.sways import Pulse
from app.plan.kinds import GestureKind, answered_by
from app.plan.model import GestureEvent
from app.plan.music.piece import NoteTimes, Seeds
from app.plan.styles import amount_at
from app.score.tempo import TempoMap

FOOT_KINDS: Final = answered_by("feet")
STEP_CHANCE, STEP_LEAST_S = 0.3, 12.0
"""Probability of a step at the end of a phrase, and least seconds since the last step."""
STAYS_S = 2.5
"""Least seconds for which a foot stays after a step."""
TAP_CHANCE, TAP_OFTEN = 0.22, 1.7
"""Probability of tapping to a phrase for a player with the usual amount, and exponent of the amount for others."""
TAP_PHRASE_S = 3.0
"""Shortest phrase in seconds that is tapped to."""
TAP_S, TAP_SHARE, TAP_APART_S = 0.4, 0.6, 0.38
"""Time before the beat at which toes rise, as the lesser of seconds and a share of the beat, and seconds between beats
below which only every other beat is tapped.
"""
HEEL_CHANCE, HEEL_WEIGHT = 0.55, 0.4
"""Probability that a shift of weight lifts the other heel, and the least size of such a shift."""
HEEL_AFTER_S, HEEL_LEAST_S, HEEL_MOST_S = 0.5, 1.4, 5.0
CLEAR_S = 0.6
"""Seconds before and after a step during which a heel stays down."""

Foot = Literal["left", "right"]
Span = tuple[float, float]


def foot_of(event: GestureEvent) -> Foot:
    """Return the foot that makes a gesture, given by the sign of its amount."""
    return "left" if event.amount > 0.0 else "right"


def moves_s(span_s: Span, step_s: float) -> tuple[Span, Span]:
    """Split a step (``span_s``: start and end in seconds) into the two spans in which the foot is in the air: the way
    out and the way back, each ``step_s`` long or shorter if the step is short.
    """
    start_s, end_s = span_s
    lasts_s = min(step_s, 0.45 * (end_s - start_s))
    return (start_s, start_s + lasts_s), (end_s - lasts_s, end_s)


def lifted_s(gestures: Iterable[GestureEvent], foot: Foot, step_s: float) -> list[Span]:
    """Return the spans in seconds in which a foot, or part of it, is off the ground, in the order of the gestures;
    ``step_s`` is the time that a foot needs for one way of a step.
    """
    found: list[Span] = []
    for event in gestures:
        if event.kind in FOOT_KINDS and event.end_s > event.start_s and foot_of(event) == foot:
            span = event.start_s, event.end_s
            found += moves_s(span, step_s) if event.kind == "step" else [span]
    return found


def footwork(
    *,
    times: NoteTimes,
    found: tuple[Phrase, ...],
    pulse: Pulse,
    clock: TempoMap,
    shifts: Sequence[GestureEvent],
    seeds: Seeds,
    tap: float,
    alone: bool,
    styles: tuple[StyleEvent, ...],
) -> list[GestureEvent]:
    """Steps, taps and heels of a player, ordered by start.

    Parameters
    ----------
    found : tuple of Phrase
        Phrases of the part.
    shifts : sequence of GestureEvent
        Gestures that shift the weight from foot to foot.
    tap : float
        Frequency of toe taps; 1 is usual.
    alone : bool
        False if another part moves the same body: then feet only tap.
    styles : tuple of StyleEvent
        Spans in which toes tap more or less often.
    """
    if not found:
        return []
    steps = _steps(times, found, clock, seeds) if alone else []
    begins_s = times.onset_s[np.array([phrase.first for phrase in found])]
    often = amount_at(styles, "tap", tap, begins_s)
    taps = _taps(times, found, pulse, clock, seeds, often, steps)
    heels = _heels(shifts, clock, seeds, steps, taps) if alone else []
    return sorted((*steps, *taps, *heels), key=lambda event: (event.start_s, event.id))


def _steps(times: NoteTimes, found: tuple[Phrase, ...], clock: TempoMap, seeds: Seeds) -> list[GestureEvent]:
    """Plan steps of one foot at ends of phrases; the foot returns at the end of the next phrase or the one after."""
    ends_s = times.played_end_s[np.array([phrase.end for phrase in found]) - 1]
    ticks = times.onset_tick[np.array([phrase.first for phrase in found])]
    chances, sizes = seeds.chances_at("step", ticks), seeds.chances_at("step size", ticks)
    events: list[GestureEvent] = []
    free_s = -np.inf
    for place in range(1, len(found)):
        start_s = float(ends_s[place - 1]) - 0.1
        if chances[place] >= STEP_CHANCE or start_s < free_s + STEP_LEAST_S:
            continue
        until = place + int(sizes[place] * 1e3) % 2
        while until < len(found) and ends_s[until] < start_s + STAYS_S:
            until += 1
        if until >= len(found):
            break
        end_s = float(ends_s[until]) + 0.5
        side = 1.0 if seeds.chance_at("step foot", int(ticks[place])) < 0.5 else -1.0
        amount = side * (0.5 + 0.5 * float(sizes[place]))
        reason = Message("gesture.step", {"side": "left" if side > 0.0 else "right"})
        events.append(_event("step", int(ticks[place]), start_s, end_s, amount, reason, clock))
        free_s = end_s
    return events


def _taps(
    times: NoteTimes,
    found: tuple[Phrase, ...],
    pulse: Pulse,
    clock: TempoMap,
    seeds: Seeds,
    tap: FloatArray | float,
    steps: Sequence[GestureEvent],
) -> list[GestureEvent]:
    """Plan taps of the toes on the beats of some phrases drawn at random, always with the same foot."""
    side = 1.0 if seeds.chance("tap foot") < 0.35 else -1.0
    reason = Message("gesture.tap", {"side": "left" if side > 0.0 else "right"})
    ticks = times.onset_tick[np.array([phrase.first for phrase in found])]
    tapped = seeds.chances_at("tap", ticks) < TAP_CHANCE * tap**TAP_OFTEN
    spans = [(event.start_s, event.end_s) for event in steps]
    events: list[GestureEvent] = []
    for phrase in (found[place] for place in np.flatnonzero(tapped).tolist()):
        start_s, end_s = float(times.onset_s[phrase.first]), float(times.played_end_s[phrase.end - 1])
        if end_s - start_s < TAP_PHRASE_S:
            continue
        first, last = np.searchsorted(pulse.beats_s, (start_s - 1e-6, end_s - 1e-6)).tolist()
        beats_s, beats = pulse.beats_s[first:last], pulse.beat_ticks[first:last]
        if len(beats) < 5:
            continue
        apart_s = median(np.diff(beats_s).tolist())
        every = 1 if apart_s >= TAP_APART_S else 2
        # The player listens to the first beats before tapping.
        beats_s, beats = beats_s[2::every], beats[2::every]
        sizes = 0.6 + 0.4 * seeds.chances_at("tap size", beats)
        lasts_s = min(TAP_S, TAP_SHARE * apart_s * every)
        for at_s, tick, size in zip(beats_s.tolist(), beats.tolist(), sizes.tolist(), strict=True):
            if any(at_s > one - CLEAR_S and at_s - lasts_s < other + CLEAR_S for one, other in spans):
                continue
            events.append(_event("tap", tick, at_s - lasts_s, at_s, side * size, reason, clock))
    return events


def _heels(
    shifts: Sequence[GestureEvent],
    clock: TempoMap,
    seeds: Seeds,
    steps: Sequence[GestureEvent],
    taps: Sequence[GestureEvent],
) -> list[GestureEvent]:
    """Plan raised heels of the foot that carries little weight, at times when no foot steps or taps."""
    busy = np.array(
        [(event.start_s - CLEAR_S, event.end_s + CLEAR_S) for event in (*steps, *taps)], np.float64
    ).reshape(-1, 2)
    chances = seeds.chances_at("heel", np.array([event.start_tick for event in shifts], np.int64))
    events: list[GestureEvent] = []
    for shift, chance in zip(shifts, chances.tolist(), strict=True):
        if chance >= HEEL_CHANCE or abs(shift.amount) < HEEL_WEIGHT:
            continue
        start_s = shift.start_s + HEEL_AFTER_S
        end_s = min(shift.end_s, start_s + HEEL_LEAST_S + (HEEL_MOST_S - HEEL_LEAST_S) * chance / HEEL_CHANCE)
        if end_s - start_s < HEEL_LEAST_S or _overlaps(busy, start_s, end_s):
            continue
        side = -1.0 if shift.amount > 0.0 else 1.0
        reason = Message("gesture.heel", {"side": "left" if side > 0.0 else "right"})
        amount = side * min(1.0, 0.3 + abs(shift.amount))
        events.append(_event("heel", shift.start_tick, start_s, end_s, amount, reason, clock))
    return events


def _overlaps(spans_s: FloatArray, start_s: float, end_s: float) -> bool:
    return bool(np.any((spans_s[:, 0] < end_s) & (spans_s[:, 1] > start_s)))


def _event(
    kind: GestureKind, tick: int, start_s: float, end_s: float, amount: float, reason: Message, clock: TempoMap
) -> GestureEvent:
    start, end = round(clock.ticks(start_s)), round(clock.ticks(end_s))
    return GestureEvent(f"{kind}:@{tick}", kind, start, max(end, start + 1), start_s, end_s, round(amount, 4), reason)
