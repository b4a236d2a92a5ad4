"""Where a player breathes.

By the length of the rest, in felt beats (T6 of the 2018 thesis; the thresholds are the player's): in [min,
last_beat) the breath takes the whole rest; in [last_beat, prepare) the last beat; from prepare on a preparatory
motion comes in the beat before that. Every breath ends at the onset it serves. Where no rest serves within the
lungs' budget, a catch breath is taken before a note that follows a phrase's end: in the short silence there, or out
of the tail of the note before, whose lips then leave early while its sound stays. In runs whose notes are too short
for that the player leaves out a note: its lips leave at once.

Messages
--------
breath.first(beats): "The first breath, in the {beats} beats before the entry."
breath.rest_whole(rest_beats, min_beats, last_beat_beats): "A rest of {rest_beats} beats (from {min_beats} to below
    {last_beat_beats}): the breath takes all of it."
breath.last_beat(rest_beats, last_beat_beats, prepare_beats): "A rest of {rest_beats} beats (from {last_beat_beats}
    to below {prepare_beats}): the breath takes its last beat."
breath.prepared(rest_beats, prepare_beats): "A rest of {rest_beats} beats (from {prepare_beats}): prepared, then the
    last beat."
breath.preparation(rest_beats, prepare_beats): "A rest of {rest_beats} beats (from {prepare_beats}): getting ready to
    breathe."
breath.catch(after_note, phrase_s, lung_s, from_note_ms): "A catch breath after note {after_note}: {phrase_s} s
    without a breath in a rest need more than the {lung_s} s of air there are; {from_note_ms} ms come out of that
    note's tail."
breath.catch_dropped(after_note, phrase_s, lung_s): "A catch breath instead of note {after_note}, which is left out:
    {phrase_s} s without a breath in a rest need more than the {lung_s} s of air there are, and no note is long enough
    to take it from."
breath.heard(gap_s): "Heard in the breath: {gap_s} s without blowing."
    Within a note too, which is blown on afterwards.
breath.heard_preparation(gap_s): "Heard in the breath: {gap_s} s without blowing; getting ready to breathe."
breath.heard_short(gap_s): "Heard in the breath: {gap_s} s without blowing, where air was needed."
breath.too_long(note, phrase_s, air_s, lung_s): "From note {note} on, {phrase_s} s must be played on one breath; it
    takes {air_s} s of air, and there are {lung_s}."
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from typing import NamedTuple

import msgspec
import numpy as np

from app.errors import Argument, Message
from app.plan.corrections import BY_HAND, WITHIN, Correction, SetBreath, removed_ids, without_removed
from app.plan.heard import BREATH_S, Blown, Silences, gaps_within, silences
from app.plan.line import IntArray, LineTimes, Piece, Seeds
from app.plan.lungs import (
    CATCH_MIN_S,
    EPSILON,
    FULL_BREATH_S,
    air_used_s,
    catch_lengths_s,
    catch_places,
    drawn,
    drop_lengths_s,
    levels,
    lungful_s,
    needed_rests,
    where_short,
    with_circular_breathing,
)
from app.plan.model import BreathEvent, FloatArray, Note, Problem, TimeFrame
from app.plan.notation import at_score_tempo, notated
from app.plan.parameters import PlayerParameters
from app.plan.rests import rest_ticks
from app.plan.stagger import ALONE, Shared, within_held
from instrument_maps.model import Air

LEAST_DEPTH = 0.3
NOBODY = Seeds()


class BreathPlan(msgspec.Struct, frozen=True):
    """Breaths of a line, with what else follows from them.

    Attributes
    ----------
    generated_ids : frozenset of str
        Every event the rules made, removed ones among them.
    early_end_s : dict of int to float
        Notes (by index) whose lips leave early for a catch breath, and when.
    catch_notes : frozenset of str
        Notes before which a catch breath is taken; players of the same part avoid them.
    """

    events: tuple[BreathEvent, ...]
    problems: tuple[Problem, ...]
    generated_ids: frozenset[str]
    early_end_s: dict[int, float]
    catch_notes: frozenset[str]


def plan_breaths(
    notes: tuple[Note, ...],
    times: LineTimes,
    piece: Piece,
    parameters: PlayerParameters,
    frame: TimeFrame,
    corrections: tuple[Correction, ...] = (),
    shared: Shared = ALONE,
    seeds: Seeds = NOBODY,
    air: Air | None = None,
    heard: Blown | None = None,
) -> BreathPlan:
    """Place every breath of a line.

    Parameters
    ----------
    air : Air or None
        How long a lungful lasts on the instrument, as its map says.
    shared : Shared
        Where others of a unison breathe.
    seeds : Seeds
        What tells this player from others where places are equally good.
    heard : Blown or None
        The breath that was blown. Where it tells of breaths, they are where it has gaps and nowhere else.
    """
    if not notes:
        return BreathPlan((), (), frozenset(), {}, frozenset())
    removed = removed_ids(corrections)
    index_of = {note.id: index for index, note in enumerate(notes)}
    placed = {(item.kind, item.note_id): item for item in corrections
              if isinstance(item, SetBreath) and item.note_id in index_of}  # fmt: skip
    gaps = None if heard is None or not heard.tells_breaths(times) else silences(heard, times)
    score = notated(times, piece) if gaps is None else times
    # What is a rest is read from the score, how long it is from what sounds.
    rests = np.where(rest_ticks(score, piece.beat_ticks_at(times.onset_tick)) > 0, times.silence_tick, 0)
    used, lung_s = air_used_s(score, air, None if gaps is None else heard), lungful_s(parameters, air)
    if gaps is None:
        generated = rest_breaths(notes, times, piece, parameters, frame, rests)
        if not parameters.circular_breathing:
            generated += within_held(notes, times, piece, used, lung_s, shared)
    else:
        assert heard is not None
        within = tuple(_within(notes[index], piece, *gap_s) for index, *gap_s in gaps_within(heard, times))
        generated = (*heard_breaths(notes, times, piece, parameters, frame, gaps), *within)
    by_hand = [_by_hand(item, times, index_of[item.note_id], piece) for item in placed.values()]
    hand_ids = {event.id for event in by_hand}
    kept = [event for event in without_removed(generated, removed) if event.id not in hand_ids]
    refill, spared_s = np.zeros(len(notes)), np.zeros(len(notes))
    for event in [*kept, *by_hand]:
        index, share = index_of[_note_id(event)], max(0.0, drawn(event.end_s - event.start_s) * _full(event))
        if _is_within(event):
            # Lungs are counted from note to note: such a note takes so much less.
            spared_s[index] += share * lung_s
        elif event.kind == "breath":
            refill[index] = share
    used = _less(used, spared_s)
    # What is needed is decided at the tempo of the score.
    steady = at_score_tempo(score, piece) if gaps is None else score
    steady_used = used if steady is score else _less(air_used_s(steady, air), spared_s)
    # No longer than the notes that really sound leave room for.
    length_s = np.minimum(catch_lengths_s(steady, rests), catch_lengths_s(times, rests))
    spare: dict[int, BreathEvent] = {}
    if gaps is not None:
        length_s = np.where(gaps.played, gaps.length_s, length_s)
    else:
        optional = rests < parameters.breath_prepare_beats * piece.beat_ticks_at(times.onset_tick)
        optional[0] = False
        optional[[index_of[_note_id(event)] for event in by_hand]] = False
        needed = needed_rests(steady_used, lung_s, refill, optional, parameters.breath_need)
        spare = {index: event for event in kept
                 if event.kind == "breath" and not _is_within(event)
                 and not needed[index := index_of[_note_id(event)]]}  # fmt: skip
        kept = [event for event in kept if _is_within(event) or index_of[_note_id(event)] not in spare]
        for index, event in spare.items():
            refill[index], length_s[index] = 0.0, event.end_s - event.start_s
    if parameters.circular_breathing:
        used = with_circular_breathing(used, lung_s, refill)
        steady_used = with_circular_breathing(steady_used, lung_s, refill)
    level = levels(used, lung_s, refill)
    drop_s = drop_lengths_s(times) if gaps is None else np.zeros(len(notes))

    taken = frozenset(notes[index].id for index in shared.caught)

    def catches_between(line: LineTimes, line_used: FloatArray, filled: FloatArray) -> list[int]:
        full = levels(line_used, lung_s, filled)
        return catch_places(
            notes,
            line,
            line_used,
            piece,
            lung_s,
            filled,
            full,
            removed | hand_ids,
            taken,
            seeds,
            rests,
            length_s,
            drop_s,
        )

    catches = catches_between(steady, steady_used, refill)
    if steady is not score and catches:
        filled = refill.copy()
        fits = length_s[catches] >= CATCH_MIN_S - EPSILON
        filled[catches] = np.minimum(np.where(fits, length_s[catches], drop_s[catches]) / FULL_BREATH_S, 1.0)
        again = where_short(used, lung_s, refill, filled)
        if len(again):
            filled[again] = refill[again]
            catches = sorted({*catches} - {*again.tolist()} | {*catches_between(score, used, filled)})
    breaths, air_s = np.flatnonzero(refill > 0.0), level * lung_s
    caught = []
    for index in catches:
        if index in spare:
            caught.append(spare[index])
        elif gaps is None or not gaps.played[index]:
            dropped_s = 0.0 if length_s[index] >= CATCH_MIN_S - EPSILON else float(drop_s[index])
            caught.append(
                _catch(notes, times, piece, air_s, breaths, dropped_s or float(length_s[index]), index, dropped_s > 0.0)
            )
        else:
            caught.append(_heard_catch(notes[index], piece, gaps, index))
    for event, index in zip(caught, catches, strict=True):
        refill[index] = drawn(event.end_s - event.start_s)
    events = tuple(sorted([*kept, *by_hand, *caught], key=lambda event: (event.start_s, event.end_s)))
    early_end_s: dict[int, float] = {}
    problems = []
    for event in events:
        index = index_of[_note_id(event)]
        if event.kind == "breath" and index > 0 and event.start_s < times.played_end_s[index - 1]:
            early_end_s[index - 1] = max(event.start_s, float(times.onset_s[index - 1]))
            if event.corrected:
                message = Message("breath.inside_note", {"note": notes[index - 1].id})
                problems.append(Problem(message, notes[index - 1].id, event.start_s, event.end_s))
    return BreathPlan(
        events=_with_depths(events, used, lung_s, refill, index_of),
        problems=(*problems, *_too_long(notes, times, used, lung_s, refill)),
        generated_ids=frozenset(event.id for event in (*generated, *caught)),
        early_end_s=early_end_s,
        catch_notes=frozenset(notes[index].id for index in catches),
    )


def breath_inputs(notes: tuple[Note, ...], times: LineTimes) -> tuple[object, ...]:
    """What `plan_breaths` looks at in a line: equal inputs give equal breaths."""
    return tuple(note.id for note in notes), times.phrasing


def rest_breaths(
    notes: tuple[Note, ...],
    times: LineTimes,
    piece: Piece,
    parameters: PlayerParameters,
    frame: TimeFrame,
    rests: IntArray,
) -> tuple[BreathEvent, ...]:
    """The breaths that the rests may give, by the thresholds."""
    silence = rests.astype(np.float64)
    silence[0] = _before_first(times, piece, frame)
    beats = piece.beat_ticks_at(times.onset_tick)
    serving = np.flatnonzero((silence / beats >= parameters.breath_min_beats) & (silence > 0))
    told = _Told(
        lambda index, rest, long, prepared: _rest_reason(index, rest, long, prepared, parameters),
        lambda index, rest: _preparation_reason(rest, parameters),
    )
    room = times.silence_tick.astype(np.float64)
    return _in_silences(notes, serving, silence, room, times.onset_tick, times.onset_s, piece, parameters, told)


def heard_breaths(
    notes: tuple[Note, ...],
    times: LineTimes,
    piece: Piece,
    parameters: PlayerParameters,
    frame: TimeFrame,
    gaps: Silences,
) -> tuple[BreathEvent, ...]:
    """The breaths of somebody who was heard to blow: in the gaps, each shaped by its length as in a rest.

    What the rests of the score say counts only before the first note and before notes that were not blown.
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
    heard = np.zeros(len(notes), dtype=bool)
    heard[known] = True
    heard[0] = False
    serving = np.flatnonzero(guessed | heard)

    def reason(index: int, rest: float, long: bool, prepared: bool) -> Message:
        if heard[index]:
            return _heard_reason("breath.heard", gaps, index)
        return _rest_reason(index, rest, long, prepared, parameters)

    def preparation(index: int, rest: float) -> Message:
        if heard[index]:
            return _heard_reason("breath.heard_preparation", gaps, index)
        return _preparation_reason(rest, parameters)

    told = _Told(reason, preparation)
    return _in_silences(notes, serving, silence, silence, end_tick, end_s, piece, parameters, told)


class _Told(NamedTuple):
    """Why a breath, and the preparation for one, are there: by note, length in beats, and which thresholds it has."""

    breath: Callable[[int, float, bool, bool], Message]
    preparation: Callable[[int, float], Message]


def _before_first(times: LineTimes, piece: Piece, frame: TimeFrame) -> float:
    """Ticks of silence before the first note."""
    frame_tick = round(piece.clock.ticks(frame.first_frame_s), 3)
    return max(float(times.onset_tick[0]) - frame_tick, 0.0)


def _in_silences(
    notes: tuple[Note, ...],
    serving: IntArray,
    silence: FloatArray,
    room: FloatArray,
    end_tick: IntArray,
    end_s: FloatArray,
    piece: Piece,
    parameters: PlayerParameters,
    told: _Told,
) -> tuple[BreathEvent, ...]:
    """Breaths in silences, by the thresholds.

    Parameters
    ----------
    serving : (K,) int64
        The notes before which a breath is taken.
    silence : (N,) float64
        Ticks of silence before each note as written, which decides the kind of breath ...
    room : (N,) float64
        ... as it sounds, which the breath has to fit into ...
    end_tick, end_s : (N,)
        ... and where it ends.
    """
    beats = piece.beat_ticks_at(end_tick)
    rests, beat = silence / beats, beats[serving]
    onsets = end_tick[serving].astype(np.float64)
    long = rests[serving] >= parameters.breath_last_beat_beats
    # A threshold below one beat lets a rest shorter than a beat count as "last beat": then it is all there is.
    lasts = np.where(long, np.minimum(silence[serving], beat), room[serving])
    starts = onsets - np.minimum(lasts, room[serving])
    prepared = rests[serving] >= parameters.breath_prepare_beats
    preparations = onsets - np.minimum(np.minimum(silence[serving], 2 * beat), room[serving])
    start_s, preparation_s = piece.clock.seconds(starts), piece.clock.seconds(preparations)
    events: list[BreathEvent] = []
    for place, index in enumerate(serving.tolist()):
        note_id, rest = notes[index].id, round(float(rests[index]), 3)
        if prepared[place] and preparations[place] < starts[place]:
            events.append(
                BreathEvent(
                    id=f"preparation:{note_id}",
                    kind="preparation",
                    start_tick=round(preparations[place]),
                    end_tick=round(starts[place]),
                    start_s=float(preparation_s[place]),
                    end_s=float(start_s[place]),
                    depth=1.0,
                    reason=told.preparation(index, rest),
                )
            )
        events.append(
            BreathEvent(
                id=f"breath:{note_id}",
                kind="breath",
                start_tick=round(starts[place]),
                end_tick=int(end_tick[index]),
                start_s=float(start_s[place]),
                end_s=float(end_s[index]),
                depth=1.0,
                reason=told.breath(index, rest, bool(long[place]), bool(prepared[place])),
            )
        )
    return tuple(events)


def _heard_reason(id: str, gaps: Silences, index: int) -> Message:
    return Message(id, {"gap_s": round(float(gaps.length_s[index]), 2)})


def _preparation_reason(rest: float, parameters: PlayerParameters) -> Message:
    return Message("breath.preparation", {"rest_beats": rest, "prepare_beats": parameters.breath_prepare_beats})


def _rest_reason(index: int, rest: float, long: bool, prepared: bool, parameters: PlayerParameters) -> Message:
    if index == 0:
        return Message("breath.first", {"beats": rest})
    if prepared:
        return Message("breath.prepared", {"rest_beats": rest, "prepare_beats": parameters.breath_prepare_beats})
    last = parameters.breath_last_beat_beats
    if long:
        return Message(
            "breath.last_beat",
            {"rest_beats": rest, "last_beat_beats": last, "prepare_beats": parameters.breath_prepare_beats},
        )
    return Message(
        "breath.rest_whole",
        {"rest_beats": rest, "min_beats": parameters.breath_min_beats, "last_beat_beats": last},
    )


def _catch(
    notes: tuple[Note, ...],
    times: LineTimes,
    piece: Piece,
    air_s: FloatArray,
    breaths: IntArray,
    length_s: float,
    index: int,
    drops: bool,
) -> BreathEvent:
    """``breaths`` are the notes before which rests give a breath, ascending; ``drops`` that the note before the breath
    is left out for it."""
    onset_s = float(times.onset_s[index])
    start_s = onset_s - length_s
    place = int(np.searchsorted(breaths, index))
    first = int(breaths[place - 1]) if place else 0
    last = int(breaths[place]) if place < len(breaths) else len(notes)
    arguments: dict[str, Argument] = {
        "after_note": notes[index - 1].id,
        "phrase_s": round(float(times.played_end_s[last - 1] - times.onset_s[first]), 2),
        "lung_s": round(float(air_s[first]), 2),
    }
    if drops:
        reason = Message("breath.catch_dropped", arguments)
    else:
        from_note_s = max(float(times.played_end_s[index - 1]) - start_s, 0.0)
        reason = Message("breath.catch", {**arguments, "from_note_ms": round(from_note_s * 1000.0)})
    return BreathEvent(
        id=f"breath:{notes[index].id}",
        kind="breath",
        start_tick=round(piece.clock.ticks(start_s)),
        end_tick=int(times.onset_tick[index]),
        start_s=start_s,
        end_s=onset_s,
        depth=1.0,
        reason=reason,
    )


def _heard_catch(note: Note, piece: Piece, gaps: Silences, index: int) -> BreathEvent:
    start_s, end_s = float(gaps.start_s[index]), float(gaps.end_s[index])
    return BreathEvent(
        id=f"breath:{note.id}",
        kind="breath",
        start_tick=round(piece.clock.ticks(start_s)),
        end_tick=round(piece.clock.ticks(end_s)),
        start_s=start_s,
        end_s=end_s,
        depth=1.0,
        reason=_heard_reason("breath.heard_short", gaps, index),
    )


def _within(note: Note, piece: Piece, start_s: float, end_s: float) -> BreathEvent:
    return BreathEvent(
        id=f"{WITHIN}:{note.id}",
        kind="breath",
        start_tick=round(piece.clock.ticks(start_s)),
        end_tick=round(piece.clock.ticks(end_s)),
        start_s=start_s,
        end_s=end_s,
        depth=1.0,
        reason=Message("breath.heard", {"gap_s": round(end_s - start_s, 2)}),
    )


def _is_within(event: BreathEvent) -> bool:
    return event.id.startswith(f"{WITHIN}:")


def _less(used: FloatArray, spared_s: FloatArray) -> FloatArray:
    """(N + 1,): air used by notes that take so much less, at least none."""
    return np.concatenate(([0.0], np.cumsum(np.maximum(np.diff(used) - spared_s, 0.0))))


def _full(event: BreathEvent) -> float:
    return event.depth if event.corrected else 1.0


def _note_id(event: BreathEvent) -> str:
    return event.id.split(":", 1)[1]


def _with_depths(
    events: tuple[BreathEvent, ...],
    used: FloatArray,
    lung_s: float,
    refill: FloatArray,
    index_of: dict[str, int],
) -> tuple[BreathEvent, ...]:
    """Depths by what the phrase to come needs, within what the time allows. Those set by hand stay."""
    breaths, used_s = [*np.flatnonzero(refill > 0.0).tolist(), len(refill)], used.tolist()
    result = []
    for event in events:
        if not event.corrected:
            index = index_of[_note_id(event)]
            until = breaths[bisect_right(breaths, index)]
            # Within a note nobody knows what the rest of it needs: there the time says it.
            need = 1.0 if _is_within(event) else (used_s[until] - used_s[index]) / lung_s
            most = 1.0 if event.kind == "preparation" else drawn(event.end_s - event.start_s)
            depth = min(max(LEAST_DEPTH + (1.0 - LEAST_DEPTH) * need, LEAST_DEPTH), max(most, LEAST_DEPTH), 1.0)
            event = msgspec.structs.replace(event, depth=round(depth, 4))
        result.append(event)
    return tuple(result)


def _too_long(
    notes: tuple[Note, ...], times: LineTimes, used: FloatArray, lung_s: float, refill: FloatArray
) -> list[Problem]:
    level = levels(used, lung_s, refill)
    starts: IntArray = np.unique(np.concatenate(([0], np.flatnonzero(refill > 0.0))))
    ends = np.append(starts[1:], len(notes))
    problems = []
    for start, end in zip(starts.tolist(), ends.tolist(), strict=True):
        air_s = float(used[end] - used[start])
        if air_s > level[start] * lung_s + EPSILON:
            start_s, end_s = float(times.onset_s[start]), float(times.played_end_s[end - 1])
            arguments = {
                "note": notes[start].id,
                "phrase_s": round(end_s - start_s, 2),
                "air_s": round(air_s, 2),
                "lung_s": round(float(level[start]) * lung_s, 2),
            }
            problems.append(Problem(Message("breath.too_long", arguments), notes[start].id, start_s, end_s))
    return problems


def _by_hand(item: SetBreath, times: LineTimes, index: int, piece: Piece) -> BreathEvent:
    onset_tick = int(times.onset_tick[index])
    start_tick, end_tick = onset_tick + item.start_offset_tick, onset_tick + item.end_offset_tick
    return BreathEvent(
        id=f"{item.kind}:{item.note_id}",
        kind="preparation" if item.kind == "preparation" else "breath",
        start_tick=start_tick,
        end_tick=end_tick,
        start_s=piece.clock.seconds(float(start_tick)),
        end_s=piece.clock.seconds(float(end_tick)),
        depth=item.depth,
        reason=BY_HAND,
        corrected=True,
    )
