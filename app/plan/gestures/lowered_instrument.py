"""Spans in which the instrument is off the lips: before the first note, in long rests, and after the last note.

A ``lower_instrument`` event lasts from leaving the lips to being back at them; one that reaches beyond the time frame
is lowered from the start (or to the end).
"""

from __future__ import annotations

import itertools
from bisect import bisect_right
from collections.abc import Mapping

import numpy as np

from app.errors import Message
from app.plan.model import BreathEvent, CueEvent, GestureEvent, TimeFrame
from app.plan.music.piece import NoteTimes, Piece, Seeds
from app.score.model import Note

LOWER_REST_S = 6.0
"""Length in seconds of rests from which the instrument is taken off the lips."""
LOWER_S = 1.1
RAISE_S = 1.2
LOWERED_LEAST_S = 1.0
"""Least seconds for which the instrument is lowered."""
AFTER_NOTE_S = 0.5
BEFORE_BREATH_S = 0.2
LOW_AT_START_S = 0.3
"""Least seconds of rest before a player raises the instrument for the first time."""
APART_S = 0.45
"""Largest random delay with which a player lowers the instrument, and raises it earlier: no two do it at the same
moment."""
HELD_S = 0.9
"""Seconds after the last note for which the instrument stays up."""


def lowered_spans(
    notes: tuple[Note, ...],
    times: NoteTimes,
    piece: Piece,
    frame: TimeFrame,
    breaths: tuple[BreathEvent, ...],
    cues: tuple[CueEvent, ...],
    seeds: Seeds,
) -> list[GestureEvent]:
    """Return events in which the instrument is lowered: in rests long enough to lower, rest and raise it before
    everything that belongs to the entry (cue, preparation, breath); start and end vary by player.

    Parameters
    ----------
    cues : tuple of CueEvent
        Cues that the player gives or answers.
    """
    if not notes:
        return [_lowered("all", frame.first_frame_s - LOWER_S, frame.end_s + RAISE_S, piece, "gesture.lower_at_start",
                         {"rest_s": round(frame.end_s - frame.first_frame_s, 2)})]  # fmt: skip
    spans_s = [(event.start_s, event.end_s) for event in breaths] + [(event.start_s, event.end_s) for event in cues]
    busy = _Busy(sorted(spans_s))
    events = []
    events += _before_first(notes[0].id, float(times.onset_s[0]), piece, frame, breaths, cues, seeds)
    rests_s = times.onset_s[1:] - times.played_end_s[:-1]
    for index in np.flatnonzero(rests_s >= LOWER_REST_S).tolist():
        start_s = float(times.played_end_s[index]) + AFTER_NOTE_S
        end_s = busy.free_until(start_s, float(times.onset_s[index + 1])) - BEFORE_BREATH_S
        if end_s - start_s >= LOWER_S + LOWERED_LEAST_S + RAISE_S:
            room_s = 0.5 * (end_s - start_s - LOWER_S - LOWERED_LEAST_S - RAISE_S)
            at = int(times.onset_tick[index + 1])
            start_s += min(room_s, APART_S) * seeds.chance_at("lowers", at)
            end_s -= min(room_s, APART_S) * seeds.chance_at("raises", at)
            rest = {"rest_s": round(float(rests_s[index]), 2)}
            events.append(_lowered(notes[index + 1].id, start_s, end_s, piece, "gesture.lower_instrument", rest))
    held_s = HELD_S + APART_S * seeds.chance("lowers at end")
    start_s = float(times.played_end_s.max()) + held_s
    if start_s + LOWER_S <= frame.end_s and busy.free_until(start_s, frame.end_s) >= frame.end_s:
        after = {"after_s": round(held_s, 2)}
        events.append(_lowered("end", start_s, frame.end_s + RAISE_S, piece, "gesture.lower_at_end", after))
    return events


def _before_first(
    name: str,
    onset_s: float,
    piece: Piece,
    frame: TimeFrame,
    breaths: tuple[BreathEvent, ...],
    cues: tuple[CueEvent, ...],
    seeds: Seeds,
) -> list[GestureEvent]:
    """Plan the lowered instrument at the start of the performance: it is raised before everything that belongs to the
    entry if there is time, else at least before cue and breath, together with the preparation.
    """
    events: list[BreathEvent | CueEvent] = [*breaths, *cues]
    starts_s = [event.start_s for event in events if event.end_s > frame.first_frame_s and event.start_s < onset_s]
    up_s, rule = min(starts_s, default=onset_s) - BEFORE_BREATH_S, "gesture.lower_at_start"
    if up_s - RAISE_S - LOWERED_LEAST_S < frame.first_frame_s:
        needed_s = [event.start_s for event in breaths if event.draws_air] + [cue.start_s for cue in cues]
        up_s, rule = min((at_s for at_s in needed_s if at_s >= frame.first_frame_s), default=onset_s), "gesture.come_up"
        if up_s - RAISE_S - LOW_AT_START_S < frame.first_frame_s:
            return []
    room_s = up_s - RAISE_S - LOW_AT_START_S - frame.first_frame_s
    up_s -= min(0.5 * room_s, APART_S) * seeds.chance("comes up")
    rest_s = {"rest_s": round(onset_s - frame.first_frame_s, 2)}
    return [_lowered(name, frame.first_frame_s - LOWER_S, up_s, piece, rule, rest_s)]


class _Busy:
    """Spans (start, end) in seconds in which a player is busy with breaths and cues, ordered by start."""

    def __init__(self, spans_s: list[tuple[float, float]]) -> None:
        self._starts_s = [start_s for start_s, _ in spans_s]
        # Running maxima, so that the first span that ends after a time is found by bisection.
        self._last_ends_s = list(itertools.accumulate((end_s for _, end_s in spans_s), max))

    def free_until(self, start_s: float, end_s: float) -> float:
        """Return the start of the first busy span that overlaps ``start_s``..``end_s``; ``end_s`` if there is none."""
        index = bisect_right(self._last_ends_s, start_s)
        return min(self._starts_s[index], end_s) if index < len(self._starts_s) else end_s


def _lowered(
    name: str, start_s: float, end_s: float, piece: Piece, rule: str, arguments: Mapping[str, float]
) -> GestureEvent:
    return GestureEvent(
        id=f"lower_instrument:{name}",
        kind="lower_instrument",
        start_tick=round(piece.clock.ticks(start_s)),
        end_tick=round(piece.clock.ticks(end_s)),
        start_s=start_s,
        end_s=end_s,
        amount=1.0,
        reason=Message(rule, dict(arguments)),
    )
