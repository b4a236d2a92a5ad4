"""Faces: strained on high, loud and long notes, on some instruments a little puffed on low and loud ones, brows up with
entries, a smile after the last note of a piece that ends brightly; neutral beneath. What a name looks like is in
``metadata/expressions``.

Messages: ``expression.default``, ``expression.effort``, ``expression.low_loud``, ``expression.gives_entry``,
``expression.takes_entry``, ``expression.end``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from app.errors import Message
from app.plan.ending import Ending
from app.plan.line import LineTimes
from app.plan.model import BreathEvent, CueEvent, EmbouchureEvent, ExpressionEvent, FloatArray, GestureEvent, TimeFrame
from app.score.model import Note
from app.score.tempo import TempoMap
from instrument_maps.model import InstrumentMap
from metadata.load import load_expressions
from metadata.model import Expression

EFFORT = 0.5
"""From this effort on the face shows it."""
JOIN_S = 0.35
"""Notes closer than this share one expression: a face does not flicker with 16ths."""
LEAST_S = 0.2
"""A shorter moment does not reach the face."""
PASSES = 0.7
"""A strain begins to pass by the end of its notes: this share of its fade is still to come."""
LOUD = 0.75
PUFF_SEMITONES = 6.0
ENTRY_REST_S = 4.0
"""After a rest this long a player's brows take the entry."""
SMILE_AFTER_S = 0.7
SMILE = 0.7
SMILE_ID = "expression:smile"


def plan_expressions(
    notes: tuple[Note, ...],
    times: LineTimes,
    clock: TempoMap,
    instrument: InstrumentMap,
    frame: TimeFrame,
    embouchures: tuple[EmbouchureEvent, ...],
    breaths: tuple[BreathEvent, ...],
    cues: tuple[CueEvent, ...],
    gestures: tuple[GestureEvent, ...],
    ending: Ending,
    faces: Mapping[str, Expression] | None = None,
) -> tuple[ExpressionEvent, ...]:
    """All expressions of one player, ordered by start; ``faces`` are the bundled ones unless given."""
    faces = load_expressions() if faces is None else faces
    events = [
        _event("expression:neutral", faces["neutral"], frame.first_frame_s, frame.end_s, 1.0, clock,
               Message("expression.default"))
    ]  # fmt: skip
    effort = np.array([event.effort for event in embouchures])
    events += _moments(
        "strained",
        faces["strained"],
        notes,
        times,
        strained(effort),
        clock,
        lambda peak: Message("expression.effort", {"effort": round(float(effort[peak]), 2), "threshold": EFFORT}),
        PASSES * faces["strained"].fade_out_s,
    )
    easy_low = instrument.range.easy_low
    events += _moments(
        "puffed",
        faces["puffed"],
        notes,
        times,
        puffed(times.pitch.astype(np.float64), times.loudness, instrument),
        clock,
        lambda peak: Message(
            "expression.low_loud",
            {"pitch": int(times.pitch[peak]), "easy_low": easy_low, "loudness": round(float(times.loudness[peak]), 2)},
        ),
    )
    events += _entries(faces["brows_up"], notes, times, clock, breaths, cues)
    lowered_s = [event.start_s for event in gestures if event.id == "lower_instrument:end"]
    if ending.bright and lowered_s and lowered_s[0] + SMILE_AFTER_S < frame.end_s:
        events.append(
            _event(SMILE_ID, faces["smile"], lowered_s[0] + SMILE_AFTER_S, frame.end_s + 1.0, SMILE, clock,
                   Message("expression.end", {"bpm": ending.bpm}))
        )  # fmt: skip
    return tuple(sorted(events, key=lambda event: (event.start_s, event.id)))


def strained(effort: FloatArray) -> FloatArray:
    """How much of an effort the face shows."""
    return np.clip((effort - EFFORT) / (1.0 - EFFORT), 0.0, 1.0)


def puffed(pitch: FloatArray, loudness: FloatArray, instrument: InstrumentMap) -> FloatArray:
    """How much air low and loud notes let into the cheeks, where the instrument lets any."""
    low = np.clip((instrument.range.easy_low - pitch + 1) / PUFF_SEMITONES, 0.0, 1.0)
    size = np.sqrt(low * np.clip((loudness - LOUD) / (1.0 - LOUD), 0.0, 1.0))
    return np.asarray(instrument.embouchure.puff * size)


def _moments(
    name: str,
    face: Expression,
    notes: tuple[Note, ...],
    times: LineTimes,
    strength: FloatArray,
    clock: TempoMap,
    reason: Callable[[int], Message],
    after_s: float = 0.0,
) -> list[ExpressionEvent]:
    """One expression for every run of notes with a strength above 0 and no more than `JOIN_S` between them; it lasts
    ``after_s`` longer than they do."""
    at = np.flatnonzero(strength > 0.0)
    if len(at) == 0:
        return []
    apart = times.onset_s[at[1:]] - times.played_end_s[at[:-1]] > JOIN_S
    events = []
    runs = np.split(at, np.flatnonzero(apart) + 1)
    next_s = [float(times.onset_s[run[0]]) for run in runs[1:]] + [np.inf]
    for run, until_s in zip(runs, next_s, strict=True):
        start_s, end_s = float(times.onset_s[run[0]]), float(times.played_end_s[run[-1]])
        if end_s - start_s < LEAST_S:
            continue
        end_s = min(end_s + after_s, until_s)
        peak = int(run[np.argmax(strength[run])])
        size = round(float(strength[peak]), 4)
        events.append(_event(f"expression:{name}:{notes[run[0]].id}", face, start_s, end_s, size, clock, reason(peak)))
    return events


def _entries(
    face: Expression,
    notes: tuple[Note, ...],
    times: LineTimes,
    clock: TempoMap,
    breaths: tuple[BreathEvent, ...],
    cues: tuple[CueEvent, ...],
) -> list[ExpressionEvent]:
    """Brows up: the leader's with the cue, the others' with the breath before an entry after a long rest."""
    events = [
        _event(f"expression:brows_up:{cue.id}", face, cue.start_s, cue.end_s, 1.0, clock,
               Message("expression.gives_entry"))
        for cue in cues
    ]  # fmt: skip
    given_s = {cue.end_s for cue in cues}
    entry = np.flatnonzero(times.onset_s[1:] - times.played_end_s[:-1] >= ENTRY_REST_S) + 1
    rests_s = {
        f"breath:{notes[index].id}": float(times.onset_s[index] - times.played_end_s[index - 1])
        for index in entry.tolist()
    }
    for breath in breaths:
        rest_s = rests_s.get(breath.id, 0.0)
        if breath.kind == "breath" and rest_s >= ENTRY_REST_S and breath.end_s not in given_s:
            reason = Message("expression.takes_entry", {"rest_s": round(rest_s, 2)})
            name = breath.id.split(":", 1)[1]
            events.append(_event(f"expression:brows_up:{name}", face, breath.start_s, breath.end_s, 0.6, clock, reason))
    return events


def _event(
    event_id: str, face: Expression, start_s: float, end_s: float, strength: float, clock: TempoMap, reason: Message
) -> ExpressionEvent:
    return ExpressionEvent(
        id=event_id,
        expression=face.name,
        start_tick=round(clock.ticks(start_s)),
        end_tick=round(clock.ticks(end_s)),
        start_s=start_s,
        end_s=end_s,
        strength=strength,
        fade_in_s=face.fade_in_s,
        fade_out_s=face.fade_out_s,
        reason=reason,
    )
