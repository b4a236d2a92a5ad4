"""Breaths in rests, or in the silences of a recorded breath curve."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray, IntArray
from app.errors import Argument, Message
from app.plan.breath.rests_for_breath import LONG_S
from app.plan.event_id import EventId
from app.plan.kinds import BREATH_KINDS
from app.plan.model import BreathEvent, TimeFrame
from app.plan.music.breath_controller import BREATH_S, BreathGaps
from app.plan.music.piece import EPSILON, LineTimes, Piece
from app.plan.music.rests import Rests
from app.plan.parameters import PlayerParameters
from app.score.model import Note

AIR_SHORT: Final[Mapping[str, Argument]] = {"why": "breath.why_short"}
"""Reason for a breath in an otherwise unneeded rest: no better one follows in time; for `because`."""
WRITTEN: Final[Mapping[str, Argument]] = {"why": "breath.why_written"}
WRITTEN_BY_HAND: Final[Mapping[str, Argument]] = {"why": "breath.why_by_hand"}
NOT_RECORDED: Final[Mapping[str, Argument]] = {"why": "breath.why_not_recorded"}


def rest_breaths(
    notes: tuple[Note, ...],
    times: LineTimes,
    piece: Piece,
    parameters: PlayerParameters,
    frame: TimeFrame,
    rests: Rests,
) -> tuple[BreathEvent, ...]:
    """Plan a breath for each rest, shaped by its length and the player's thresholds; reasons are completed later by
    `because`.
    """
    silence, written = rests.sounding_tick.astype(np.float64), rests.written_tick.astype(np.float64)
    silence[0] = written[0] = _before_first(times, piece, frame)
    beats = piece.beat_ticks_at(times.onset_tick)
    enough = (np.maximum(silence, written) / beats >= parameters.breath_min_beats) | (rests.lasts_s >= LONG_S - EPSILON)
    serving = np.flatnonzero(enough & (silence > 0))
    reported = _Report(
        lambda index, rest, long, prepared: _rest_reason(index, rest, rests.lasts_s, long, prepared, parameters),
        lambda index, rest: _preparation_reason(rest, parameters),
    )
    room = times.silence_tick.astype(np.float64)
    silences = _Silences(serving, silence, room, times.onset_tick, times.onset_s)
    return _in_silences(notes, silences, piece, parameters, reported)


def blown_breaths(
    notes: tuple[Note, ...],
    times: LineTimes,
    piece: Piece,
    parameters: PlayerParameters,
    frame: TimeFrame,
    gaps: BreathGaps,
) -> tuple[BreathEvent, ...]:
    """Breaths in the gaps of a recorded breath curve, each shaped by its length as in a rest.

    Rests of the score are used only before the first note and before notes without recorded breath.
    """
    known = np.flatnonzero(gaps.length_s >= BREATH_S - EPSILON)
    end_tick, end_s = times.onset_tick.copy(), times.onset_s.copy()
    silence = np.where(gaps.played, 0.0, times.silence_tick)
    end_tick[known] = np.round(piece.clock.ticks(gaps.end_s[known]))
    end_s[known] = piece.clock.seconds(end_tick[known].astype(np.float64))
    silence[known] = np.maximum(end_tick[known] - np.round(piece.clock.ticks(gaps.start_s[known])), 1.0)
    silence[0] = _before_first(times, piece, frame)
    enough = (silence > 0) & (silence / piece.beat_ticks_at(times.onset_tick) >= parameters.breath_min_beats)
    guessed = ~gaps.played & enough
    guessed[0] = enough[0]
    recorded = np.zeros(len(notes), dtype=bool)
    recorded[known] = True
    recorded[0] = False
    rest_s = np.concatenate(([0.0], np.maximum(times.onset_s[1:] - times.played_end_s[:-1], 0.0)))
    serving = np.flatnonzero(guessed | recorded)

    def reason(index: int, rest: float, long: bool, prepared: bool) -> Message:
        if recorded[index]:
            return _blown_reason("breath.blown", gaps, index)
        return because(_rest_reason(index, rest, rest_s, long, prepared, parameters), NOT_RECORDED)

    def preparation(index: int, rest: float) -> Message:
        if recorded[index]:
            return _blown_reason("breath.blown_preparation", gaps, index)
        return _preparation_reason(rest, parameters)

    reported = _Report(reason, preparation)
    silences = _Silences(serving, silence, silence, end_tick, end_s)
    return _in_silences(notes, silences, piece, parameters, reported)


class _Silences(NamedTuple):
    """Silences in which breaths are taken.

    Attributes
    ----------
    serving : (K,) int64
        Indices of the notes after the silences.
    silence : (N,) float64
        Written length in ticks of the silence before each note; decides the kind of breath.
    room : (N,) float64
        Length in ticks of the silence as it sounds; limits the breath.
    end_tick, end_s : (N,)
        End of the silence.
    """

    serving: IntArray
    silence: FloatArray
    room: FloatArray
    end_tick: IntArray
    end_s: FloatArray


class _Report(NamedTuple):
    """Values for the messages that explain breaths and preparations: note, length of the rest in beats, and
    thresholds.
    """

    breath: Callable[[int, float, bool, bool], Message]
    preparation: Callable[[int, float], Message]


def _before_first(times: LineTimes, piece: Piece, frame: TimeFrame) -> float:
    """Length in ticks of the silence between the start of the performance and the first note."""
    frame_tick = round(piece.clock.ticks(frame.first_frame_s), 3)
    return max(float(times.onset_tick[0]) - frame_tick, 0.0)


def _in_silences(
    notes: tuple[Note, ...], silences: _Silences, piece: Piece, parameters: PlayerParameters, reported: _Report
) -> tuple[BreathEvent, ...]:
    """Return the breaths in the given silences, shaped by the player's parameters."""
    serving, silence, room, end_tick, end_s = silences
    beats = piece.beat_ticks_at(end_tick)
    rests, beat = silence / beats, beats[serving]
    onsets = end_tick[serving].astype(np.float64)
    long = rests[serving] >= parameters.breath_last_beat_beats
    # With a threshold below one beat a shorter rest may count as "last beat"; the breath then fills it.
    lasts = np.where(long, np.minimum(silence[serving], beat), room[serving])
    starts = onsets - np.minimum(lasts, room[serving])
    prepared = rests[serving] >= parameters.breath_prepare_beats
    preparations = onsets - np.minimum(np.minimum(silence[serving], 2 * beat), room[serving])
    start_s, preparation_s = piece.clock.seconds(starts), piece.clock.seconds(preparations)
    events: list[BreathEvent] = []
    for place, index in enumerate(serving.tolist()):
        note_id, rest = notes[index].id, round(float(rests[index]), 3)
        tick, at_s = round(starts[place]), float(start_s[place])
        if prepared[place] and preparations[place] < starts[place]:
            begins = round(preparations[place]), float(preparation_s[place])
            reason = reported.preparation(index, rest)
            events.append(_event(f"preparation:{note_id}", begins, (tick, at_s), reason))
        ends = int(end_tick[index]), float(end_s[index])
        reason = reported.breath(index, rest, bool(long[place]), bool(prepared[place]))
        events.append(_event(f"breath:{note_id}", (tick, at_s), ends, reason))
    return tuple(events)


def _event(id: str, start: tuple[int, float], end: tuple[int, float], reason: Message) -> BreathEvent:
    """Return a breath event between two moments, each given in ticks and seconds."""
    kind = BREATH_KINDS[EventId.parse(id).kind].event_kind
    return BreathEvent(
        id=id, kind=kind, start_tick=start[0], end_tick=end[0], start_s=start[1], end_s=end[1], depth=1.0, reason=reason
    )


def breath_at(id: str, piece: Piece, start_s: float, end_s: float, reason: Message) -> BreathEvent:
    """Create a breath event from ``start_s`` to ``end_s``; ``reason`` explains it to the user."""
    start, end = ((round(piece.clock.ticks(at_s)), at_s) for at_s in (start_s, end_s))
    return _event(id, start, end, reason)


def _blown_reason(id: str, gaps: BreathGaps, index: int) -> Message:
    return Message(id, {"gap_s": round(float(gaps.length_s[index]), 2)})


def _preparation_reason(rest: float, parameters: PlayerParameters) -> Message:
    return _preparation(rest, parameters.breath_prepare_beats)


def _rest_reason(
    index: int, rest: float, rest_s: FloatArray, long: bool, prepared: bool, parameters: PlayerParameters
) -> Message:
    if index == 0:
        return Message("breath.first", {"beats": rest})
    last, prepare = parameters.breath_last_beat_beats, parameters.breath_prepare_beats
    lasts: dict[str, Argument] = {"rest_beats": rest, "rest_s": round(float(rest_s[index]), 2)}
    if prepared:
        return Message("breath.prepared", {**lasts, "prepare_beats": prepare})
    if long:
        return Message("breath.last_beat", {**lasts, "last_beat_beats": last, "prepare_beats": prepare})
    return Message("breath.rest_whole", {**lasts, "last_beat_beats": last})


def because(reason: Message, why: Mapping[str, Argument]) -> Message:
    """Complete the reason of a breath in a rest with the explanation why this rest is used; ``why`` has the
    explanation's text id and arguments.
    """
    return reason if reason.id == "breath.first" else Message(reason.id, {**reason.arguments, **why})


def blown_catch(note: Note, piece: Piece, gaps: BreathGaps, index: int) -> BreathEvent:
    start_s, end_s = float(gaps.start_s[index]), float(gaps.end_s[index])
    return breath_at(f"breath:{note.id}", piece, start_s, end_s, _blown_reason("breath.blown_short", gaps, index))


def within_note(note: Note, piece: Piece, start_s: float, end_s: float) -> BreathEvent:
    reason = Message("breath.blown", {"gap_s": round(end_s - start_s, 2)})
    return breath_at(f"within:{note.id}", piece, start_s, end_s, reason)


@lru_cache(maxsize=1024, typed=True)
def _preparation(rest_beats: float, prepare_beats: float) -> Message:
    """Message about a preparatory motion; cached, so that thousands of equal messages share one object."""
    return Message("breath.preparation", {"rest_beats": rest_beats, "prepare_beats": prepare_beats})
