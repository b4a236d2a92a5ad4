"""Generates events from rules (`metadata.rules`); their ids contain the rule and the note."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from itertools import accumulate, islice
from typing import Final, NamedTuple, TypeVar

import numpy as np

from app.arrays import FloatArray, IntArray
from app.errors import Argument, Message
from app.plan.event_id import EventId
from app.plan.events_by_hand import StyleEvent
from app.plan.gestures.possible_gestures import LoweredSpans, belongs, comes_up, may_start
from app.plan.kinds import answered_by
from app.plan.model import ExpressionEvent, GestureEvent, Problem, TimeFrame
from app.plan.music.piece import LineTimes, Seeds
from app.plan.music.spans import Spans
from app.plan.rule_conditions import Facts, by_chance, concerns, growth_of, matches, unknown_in
from app.plan.styles import styles_at
from app.score.model import Note
from app.score.tempo import TempoMap
from instrument_maps.model import InstrumentMap
from metadata.gestures import Gesture
from metadata.model import Expression
from metadata.rules import Rule, When

LEAST_S: Final = 0.2
"""Length in seconds of moments below which the face does not react."""


BETWEEN_S: Final = 0.5
"""Least seconds between two gestures in a rest."""
E = TypeVar("E", GestureEvent, ExpressionEvent)


class Ruled(NamedTuple):
    """Events generated from rules for a part, with problems of the rules."""

    expressions: tuple[ExpressionEvent, ...]
    gestures: tuple[GestureEvent, ...]
    problems: tuple[Problem, ...]


class _Line(NamedTuple):
    """The notes of a part with their facts, to which rules of acting are applied."""

    notes: tuple[Note, ...]
    times: LineTimes
    clock: TempoMap
    instrument: InstrumentMap
    facts: Facts
    seeds: Seeds


def plan_by_rules(
    *,
    notes: tuple[Note, ...],
    times: LineTimes,
    clock: TempoMap,
    frame: TimeFrame,
    instrument: InstrumentMap,
    habits: tuple[str, ...],
    usual_style: str,
    styles: tuple[StyleEvent, ...],
    facts: Facts,
    lowered_s: tuple[tuple[float, float], ...],
    seeds: Seeds,
    rules: tuple[Rule, ...],
    faces: Mapping[str, Expression],
    known_gestures: Mapping[str, Gesture],
) -> Ruled:
    """Plan all events from rules about notes, ordered by start; rules about moments are in
    `app.plan.faces.expressions_at_moments`.

    Parameters
    ----------
    styles : tuple of StyleEvent
        Spans in which the player plays in another style.
    lowered_s : tuple of (start, end)
        Spans in which the instrument is off the lips.
    rules : tuple of Rule
        Rules in the order in which they are applied.
    """
    played_in = styles_at(styles, usual_style, times.onset_s)
    in_styles = frozenset((usual_style, *played_in))
    shown: list[ExpressionEvent] = []
    made: list[GestureEvent] = []
    problems: list[Problem] = []
    line, down = _Line(notes, times, clock, instrument, facts, seeds), LoweredSpans(lowered_s)
    for rule in rules:
        if not notes or not rule.enabled or not concerns(rule.when, in_styles, habits):
            continue
        unknown = unknown_in(rule, faces, known_gestures)
        if unknown is not None:
            problems.append(Problem(unknown, None, frame.first_frame_s, frame.first_frame_s))
            continue
        if rule.when.moment is not None:
            continue
        found, sizes = _where(line, rule, played_in if styles else ())
        if not len(found):
            continue
        if rule.do.expression:
            shown += _faces(line, rule, faces[rule.do.expression], found, sizes)
        else:
            gesture = known_gestures[rule.do.gesture]
            if not belongs(gesture, instrument):
                continue
            made += _gestures(line, rule, gesture, found, sizes, down, made)
    return Ruled(
        tuple(sorted(shown, key=in_order)),
        tuple(sorted(made, key=lambda event: (event.start_s, event.id))),
        tuple(problems),
    )


def _where(line: _Line, rule: Rule, played_in: Sequence[str]) -> tuple[IntArray, FloatArray]:
    """Find the notes at which a rule takes effect: their indices, and the rule's strength (N,) at each. ``played_in``
    has the style of each note, if there are several styles.
    """
    here, when = matches(rule.when, line.facts), rule.when
    if not here.any():
        return np.zeros(0, np.int64), np.zeros(len(here))
    here[here] = by_chance(rule, line.times.onset_tick[here], line.seeds)
    if played_in and when.styles:
        here &= np.array([style in when.styles for style in played_in])
    if played_in and when.not_styles:
        here &= np.array([style not in when.not_styles for style in played_in])
    sizes = rule.do.strength * growth_of(rule, line.facts)
    if rule.do.scaled_by == "puff":
        sizes = sizes * line.instrument.embouchure.puff
    return np.flatnonzero(here & (sizes > 0.0)), sizes


def in_order(event: ExpressionEvent) -> tuple[float, bool, str]:
    """Sort key: by start, and at equal start events not made by rules first."""
    return event.start_s, EventId.parse(event.id).is_by_rule, event.id


def _spans_s(rule: Rule, times: LineTimes, found: IntArray, length_s: float | None) -> tuple[FloatArray, FloatArray]:
    """Return start and end (N,) in seconds of the events that a rule makes at the notes with the indices ``found``;
    ``length_s`` is the fixed length, if there is one."""
    anchors = {"onset": times.onset_s[found], "end": times.played_end_s[found]}
    start_s = anchors[rule.do.start] + rule.do.start_s
    if length_s is not None and rule.do.end_s is None:
        return start_s, start_s + length_s
    return start_s, anchors[rule.do.end] + (rule.do.end_s or 0.0)


def _faces(line: _Line, rule: Rule, face: Expression, found: IntArray, sizes: FloatArray) -> list[ExpressionEvent]:
    """Return one expression event for every run of notes with at most `Rule.apart_s` between them."""
    starts_s, ends_s = _spans_s(rule, line.times, found, None)
    apart = starts_s[1:] - np.maximum.accumulate(ends_s)[:-1] > rule.apart_s
    events = []
    runs = np.split(np.arange(len(found)), np.flatnonzero(apart) + 1)
    next_s = [float(starts_s[run[0]]) for run in runs[1:]] + [np.inf]
    for run, until_s in zip(runs, next_s, strict=True):
        start_s, end_s = float(starts_s[run[0]]), float(ends_s[run].max())
        if end_s - start_s < LEAST_S:
            continue
        if rule.do.stays_s:
            end_s = max(end_s, min(end_s + rule.do.stays_s, until_s))
        peak = int(found[run[np.argmax(sizes[found[run]])]])
        note, size = line.notes[found[run[0]]].id, round(float(sizes[peak]), 4)
        reason = _why(rule, line.facts, peak, line.instrument)
        events.append(shown_by(rule, face, note, (start_s, end_s), size, line.clock, reason))
    return events


def shown_by(
    rule: Rule,
    face: Expression,
    of: str,
    span_s: tuple[float, float],
    strength: float,
    clock: TempoMap,
    reason: Message,
) -> ExpressionEvent:
    """Create the event for the expression that a rule shows; ``of`` is the last part of the event's id."""
    start_s, end_s = span_s
    return ExpressionEvent(
        id=":".join(("expression", rule.prefix, *((of,) if of else ()))),
        expression=face.name,
        start_tick=round(clock.ticks(start_s)),
        end_tick=round(clock.ticks(end_s)),
        start_s=start_s,
        end_s=end_s,
        strength=strength,
        fade_in_s=rule.do.fade_in_s or face.fade_in_s,
        fade_out_s=rule.do.fade_out_s or face.fade_out_s,
        reason=reason,
    )


def _why(rule: Rule, facts: Facts, note: int, instrument: InstrumentMap) -> Message:
    """Return the message that explains an expression: by the musical condition of the rule, or else by the
    rule's name.
    """
    when, loudness, effort = rule.when, round(float(facts.loudness[note]), 2), round(float(facts.effort[note]), 2)
    if when == When(effort_above=when.effort_above):
        said: dict[str, Argument] = {"effort": effort, "threshold": when.effort_above or 0.0}
        return Message("expression.effort", said)
    bounds = When(semitones_below_easy=when.semitones_below_easy, loudness_above=when.loudness_above)
    if when == bounds and None not in (when.semitones_below_easy, when.loudness_above):
        pitch, easy_low = int(facts.pitch[note]), instrument.range.easy_low
        return Message("expression.low_loud", {"pitch": pitch, "easy_low": easy_low, "loudness": loudness})
    return Message("rule.applied", {"rule": rule.name})


def _gestures(
    line: _Line,
    rule: Rule,
    gesture: Gesture,
    found: IntArray,
    sizes: FloatArray,
    lowered: LoweredSpans,
    others: Sequence[GestureEvent],
) -> list[GestureEvent]:
    """Make the rule's gesture for every one of the ``found`` notes where it is possible, at least `Rule.apart_s` after
    the previous one and clear of ``others``."""
    notes, times, clock, seeds = line.notes, line.times, line.clock, line.seeds
    starts_s, ends_s = _spans_s(rule, times, found, gesture.length_s)
    if rule.do.spread_s:
        later_s = rule.do.spread_s * seeds.chances_at(f"rule {rule.name} later", times.onset_tick[found])
        starts_s, ends_s = starts_s + later_s, ends_s + later_s
    taken = sorted((one.start_s, one.end_s) for one in others) if gesture.may_start != "anytime" else []
    # Running maxima, so that the first span that ends after a time is found by bisection.
    reach_s = list(accumulate((last_s + BETWEEN_S for _, last_s in taken), max))
    events: list[GestureEvent] = []
    free_s = -np.inf
    for place, start_s, end_s in zip(found.tolist(), starts_s.tolist(), ends_s.tolist(), strict=True):
        for first_s, last_s in islice(taken, bisect_right(reach_s, start_s), None):
            if first_s >= end_s + BETWEEN_S:
                break
            # One after another, as long as they fit the rest.
            if start_s < last_s + BETWEEN_S:
                start_s, end_s = last_s + BETWEEN_S, end_s + last_s + BETWEEN_S - start_s
        if start_s < free_s or end_s <= start_s or not may_start(gesture, start_s, end_s, times, lowered):
            continue
        if gesture.may_start != "anytime" and comes_up(start_s, end_s, lowered):
            continue
        free_s = end_s + rule.apart_s
        events.append(
            GestureEvent(
                id=f"named:{rule.prefix}:{notes[place].id}",
                kind="named",
                start_tick=round(clock.ticks(start_s)),
                end_tick=round(clock.ticks(end_s)),
                start_s=start_s,
                end_s=end_s,
                amount=round(float(sizes[place]), 4),
                reason=Message("rule.applied", {"rule": rule.name}),
                name=gesture.name,
            )
        )
    return events


def with_ruled(made: tuple[E, ...], ruled: tuple[E, ...]) -> tuple[E, ...]:
    """Merge the events made by rules into others, ordered by start; returns the same tuple if rules make none."""
    both = list(made + ruled)
    both.sort(key=lambda event: event.start_s)
    return tuple(both) if ruled else made


def without_overruled(events: tuple[E, ...]) -> tuple[E, ...]:
    """Drop events of rules that overlap one of the same kind placed by hand; returns the same tuple if none is
    dropped.
    """
    placed = [event for event in events if event.corrected and not EventId.parse(event.id).is_by_rule]
    by_kind: dict[str, list[tuple[float, float]]] = {}
    for event in placed:
        by_kind.setdefault(EventId.parse(event.id).kind, []).append((event.start_s, event.end_s))
    if not by_kind:
        return events
    spans = {kind: Spans(placed_s) for kind, placed_s in by_kind.items()}
    kept = tuple(event for event in events if event.corrected or not _is_overruled(event, spans))
    return kept if len(kept) < len(events) else events


def _is_overruled(event: GestureEvent | ExpressionEvent, spans: Mapping[str, Spans]) -> bool:
    id = EventId.parse(event.id)
    return id.is_by_rule and id.kind in spans and spans[id.kind].meet(event.start_s, event.end_s)


def lowered_spans_s(gestures: Sequence[GestureEvent]) -> tuple[tuple[float, float], ...]:
    """Return the spans in seconds in which gestures take the instrument off the lips."""
    lowering = answered_by("lowering")
    return tuple((event.start_s, event.end_s) for event in gestures if event.kind in lowering)
