"""Plans expressions at moments (the cue of an entry, the breath before one, the end of the piece), above a neutral face
and combined with expressions at notes (`app.plan.rules`). The expressions are defined in ``metadata/expressions``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from app.errors import Message
from app.plan.event_id import EventId
from app.plan.events_by_hand import StyleEvent
from app.plan.model import BreathEvent, CueEvent, ExpressionEvent, GestureEvent, TimeFrame
from app.plan.music.ending import Ending
from app.plan.music.piece import LineTimes, Seeds
from app.plan.rule_conditions import Facts, by_chance, concerns, matches
from app.plan.rules import in_order, shown_by
from app.plan.styles import styles_at
from app.score.model import Note
from app.score.tempo import TempoMap
from metadata.model import Expression
from metadata.rules import Moment, Rule, When

SMILE_ID = "expression:smile"
"""Id of the smile after the last note, to which corrections refer."""


class _Found(NamedTuple):
    """A moment at which a player shows an expression: its span, the index of the note that begins there, the end of its
    event id, and the reason."""

    span_s: tuple[float, float]
    note: int | None
    of: str
    why: Message


def plan_moments(
    *,
    notes: tuple[Note, ...],
    times: LineTimes,
    clock: TempoMap,
    frame: TimeFrame,
    habits: tuple[str, ...],
    usual_style: str,
    styles: tuple[StyleEvent, ...],
    facts: Facts,
    seeds: Seeds,
    rules: tuple[Rule, ...],
    faces: Mapping[str, Expression],
    breaths: tuple[BreathEvent, ...],
    cues: tuple[CueEvent, ...],
    gestures: tuple[GestureEvent, ...],
    ending: Ending,
) -> tuple[ExpressionEvent, ...]:
    """Plan all expressions from rules about moments, ordered by start. Rules with unknown expressions are reported by
    `app.plan.rules.plan_by_rules`.
    """
    events: list[ExpressionEvent] = []
    found = {
        "gives_entry": _given(notes, times, cues),
        "takes_entry": _taken(notes, times, breaths, cues),
        "ending": _ended(gestures, ending, frame),
    }
    for rule in rules:
        moment = rule.when.moment
        if moment is None or not rule.enabled or rule.do.expression not in faces:
            continue
        chosen = _matching(rule, moment, found[moment], facts)
        free_s = -np.inf
        for one in chosen:
            (style,) = styles_at(styles, usual_style, np.array([one.span_s[0]]))
            tick = np.array([round(clock.ticks(one.span_s[0]))])
            if not concerns(rule.when, (style,), habits) or not by_chance(rule, tick, seeds)[0]:
                continue
            anchors = {"onset": one.span_s[0], "end": one.span_s[1]}
            start_s = anchors[rule.do.start] + rule.do.start_s
            end_s = anchors[rule.do.end] + (rule.do.end_s or 0.0) + rule.do.stays_s
            if start_s >= end_s or (rule.apart_s > 0.0 and start_s < free_s):
                continue
            if moment == "ending" and start_s >= frame.end_s:
                continue
            free_s = end_s + rule.apart_s
            face = faces[rule.do.expression]
            events.append(shown_by(rule, face, one.of, (start_s, end_s), rule.do.strength, clock, one.why))
    return tuple(sorted(events, key=in_order))


def _matching(rule: Rule, moment: Moment, found: Sequence[_Found], facts: Facts) -> list[_Found]:
    """Return the moments that meet all conditions of a rule except style, habits and chance."""
    when = rule.when
    if when == When(moment=moment, styles=when.styles, habits=when.habits, chance=when.chance) or not found:
        return list(found)
    holds = matches(when, facts)
    return [one for one in found if one.note is not None and holds[one.note]]


def _given(notes: tuple[Note, ...], times: LineTimes, cues: tuple[CueEvent, ...]) -> list[_Found]:
    """Return the moments in which the player gives a cue, for expressions shown with it."""
    onsets = {tick: index for index, tick in enumerate(times.onset_tick.tolist())} if notes else {}
    why = Message("expression.gives_entry")
    return [_Found((cue.start_s, cue.end_s), onsets.get(cue.end_tick), cue.id, why) for cue in cues]


def _taken(
    notes: tuple[Note, ...], times: LineTimes, breaths: tuple[BreathEvent, ...], cues: tuple[CueEvent, ...]
) -> list[_Found]:
    """Return the moments in which the player takes the breath before an entry that another player cues."""
    given_s = {cue.end_s for cue in cues}
    index_of = {note.id: index for index, note in enumerate(notes)} if breaths else {}
    found = []
    for breath in breaths:
        index = index_of.get(EventId.parse(breath.id).of, 0)
        if index == 0 or breath.is_within or not breath.draws_air or breath.end_s in given_s:
            continue
        rest_s = float(times.onset_s[index] - times.played_end_s[index - 1])
        why = Message("expression.takes_entry", {"rest_s": round(rest_s, 2)})
        found.append(_Found((breath.start_s, breath.end_s), index, notes[index].id, why))
    return found


def _ended(gestures: tuple[GestureEvent, ...], ending: Ending, frame: TimeFrame) -> list[_Found]:
    """Return the moment from the lowering of the instrument to the end, if the piece ends brightly; else an
    empty list.
    """
    lowered_s = [event.start_s for event in gestures if event.id == "lower_instrument:end"]
    if not ending.bright or not lowered_s:
        return []
    return [_Found((lowered_s[0], frame.end_s), None, "", Message("expression.end", {"bpm": ending.bpm}))]


def neutral_face(clock: TempoMap, frame: TimeFrame, face: Expression) -> ExpressionEvent:
    """Create the event of the neutral face, which lasts through the whole performance beneath all other expressions."""
    return ExpressionEvent(
        id="expression:neutral",
        expression=face.name,
        start_tick=round(clock.ticks(frame.first_frame_s)),
        end_tick=round(clock.ticks(frame.end_s)),
        start_s=frame.first_frame_s,
        end_s=frame.end_s,
        strength=1.0,
        fade_in_s=face.fade_in_s,
        fade_out_s=face.fade_out_s,
        reason=Message("expression.default"),
    )


def all_shown(
    neutral: ExpressionEvent, at_moments: tuple[ExpressionEvent, ...], at_notes: tuple[ExpressionEvent, ...]
) -> tuple[ExpressionEvent, ...]:
    """All facial expressions of one player ordered by start: the neutral one, those at moments of the piece, and those
    at notes."""
    return tuple(sorted((neutral, *at_moments, *at_notes), key=in_order))
