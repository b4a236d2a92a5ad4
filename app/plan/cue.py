"""Who gives the entries, and when.

Without a conductor the lead player starts the piece, and starts it again after a rest that all share: body and
instrument dip on the preparatory beat, one felt beat before the entry. The nod's acceleration peak marks that beat
and its duration the tempo (Bishop and Goebl 2017).

Messages
--------
cue.start(leader_reason, beat_s): "Starts the piece: {leader_reason}; the preparatory beat lasts {beat_s} s."
cue.after_rest(leader_reason, beat_s, rest_s): "Brings everyone in after {rest_s} s of common rest: {leader_reason};
    ..." ``leader_reason`` is "chosen" (by the player's parameter) or "highest" (the highest part of those that enter).
"""

from __future__ import annotations

import msgspec
import numpy as np

from app.errors import Argument, Message
from app.plan.corrections import BY_HAND, RemoveEvent, SetBreath, SetCue, removed_ids
from app.plan.line import IntArray, Line, LineTimes, Piece
from app.plan.model import CueEvent, TimeFrame

COMMON_REST_BARS = 2
COMMON_REST_S = 4.0
"""A rest of all players this long needs a new start: everyone has lost the beat (either is enough)."""
COMMON_REST_LEAST_S = 2.0
"""Short bars rest quickly over: nobody has lost the beat by then."""
LEAST_BEATS = 2.0
"""A cue needs the preparatory beat and room before it."""
LEAD_BEATS = 1.5
"""The nod begins half a beat before the preparatory beat, so that it lasts one beat and peaks on it."""


class Entry(msgspec.Struct, frozen=True):
    """A place where everyone starts: its tick, the silence before it (None before the first note), and who enters with
    which note (line index, note index)."""

    tick: int
    rest_s: float | None
    players: tuple[tuple[int, int], ...]


def common_entries(all_times: tuple[LineTimes, ...], piece: Piece) -> tuple[Entry, ...]:
    """The first entry, and those after long common rests: by the rhythm of the lines alone."""
    sounding = [(line, times) for line, times in enumerate(all_times) if len(times.onset_tick)]
    if not sounding:
        return ()
    stretches = [_stretches(times) for _, times in sounding]
    onsets, ends = (np.concatenate(edges) for edges in zip(*stretches, strict=True))
    order = np.argsort(onsets, kind="stable")
    onsets, ends = onsets[order], np.maximum.accumulate(ends[order])
    silences = np.flatnonzero(onsets[1:] > ends[:-1])
    starts = [(int(onsets[0]), None)] + [(int(onsets[gap + 1]), int(ends[gap])) for gap in silences.tolist()]
    result = []
    for tick, end in starts:
        rest_s = None
        if end is not None:
            rest_s = piece.clock.seconds(float(tick)) - piece.clock.seconds(float(end))
            bars = (tick - end) / piece.bar_length_tick(end)
            long = rest_s >= COMMON_REST_S or (bars >= COMMON_REST_BARS and rest_s >= COMMON_REST_LEAST_S)
            if not long or tick - end < LEAST_BEATS * piece.beat_ticks_at(np.array([tick]))[0]:
                continue
        players = []
        for line, times in sounding:
            index = int(np.searchsorted(times.onset_tick, tick))
            if index < len(times.onset_tick) and times.onset_tick[index] == tick:
                players.append((line, index))
        result.append(Entry(tick, rest_s, tuple(players)))
    return tuple(result)


def _stretches(times: LineTimes) -> tuple[IntArray, IntArray]:
    """Where a line begins to sound and where it stops: a tenth of as many as there are notes."""
    stops = times.onset_tick[1:] > times.played_end_tick[:-1]
    return times.onset_tick[np.insert(stops, 0, True)], times.played_end_tick[np.append(stops, True)]


def leader_of(entry: Entry, lines: tuple[Line, ...], all_times: tuple[LineTimes, ...]) -> tuple[int | None, str]:
    """Index of the line that gives an entry, and why ("chosen" or "highest").

    A player whose ``cue_leader`` is set gives every entry; of several, one who enters here, then the first.
    Otherwise the highest part of those that enter (by the note there, then by its mean pitch, then the first),
    leaving out who must not lead. None where nobody may.
    """
    chosen = [index for index, line in enumerate(lines) if line.parameters.cue_leader]
    entering = {line for line, _ in entry.players}
    if chosen:
        return next((index for index in chosen if index in entering), chosen[0]), "chosen"
    free = [(line, note) for line, note in entry.players if lines[line].parameters.cue_leader is not False]
    if not free:
        return None, "highest"
    best = max(free, key=lambda item: (all_times[item[0]].pitch[item[1]], all_times[item[0]].pitch.mean(), -item[0]))
    return best[0], "highest"


def cue_inputs(lines: tuple[Line, ...]) -> tuple[object, ...]:
    """What `plan_cues` looks at in the lines, beside their times: equal inputs give equal cues."""
    return tuple(
        (
            line.player_id,
            line.notes,
            line.parameters.cue_leader,
            tuple(item for item in line.corrections if isinstance(item, SetCue | RemoveEvent | SetBreath)),
        )
        for line in lines
    )


def plan_cues(
    entries: tuple[Entry, ...],
    lines: tuple[Line, ...],
    all_times: tuple[LineTimes, ...],
    piece: Piece,
    frame: TimeFrame,
) -> tuple[tuple[CueEvent, ...], frozenset[str]]:
    """Every cue of the ensemble, corrections applied, and the ids of all that the rules made; ``entries`` are
    `common_entries`.

    A cue's id is ``cue:`` and the note it brings in, or ``cue:@`` and the tick for a leader who does not play there.
    """
    generated = []
    for entry in entries:
        leader, why = leader_of(entry, lines, all_times)
        if leader is None:
            continue
        note = next((lines[line].notes[index].id for line, index in entry.players if line == leader), f"@{entry.tick}")
        rule = "cue.start" if entry.rest_s is None else "cue.after_rest"
        arguments: dict[str, Argument] = {"leader_reason": why}
        if entry.rest_s is not None:
            arguments["rest_s"] = round(entry.rest_s, 2)
        generated.append(_cue(lines[leader].player_id, note, entry.tick, 1.0, piece, frame, Message(rule, arguments)))
    events = {event.id + event.player_id: event for event in generated}
    for line in lines:
        removed = removed_ids(line.corrections)
        for event in generated:
            if event.player_id == line.player_id and event.id in removed:
                del events[event.id + event.player_id]
        if not any(isinstance(item, SetCue) for item in line.corrections):
            continue
        onsets = {note.id: note.onset_tick for note in line.notes}
        for item in line.corrections:
            if isinstance(item, SetCue):
                tick = onsets.get(item.note_id, item.tick)
                if tick is None:
                    continue
                event = _cue(line.player_id, item.note_id, tick, item.beats, piece, frame, BY_HAND)
                events[event.id + event.player_id] = msgspec.structs.replace(event, corrected=True)
    ordered = sorted(events.values(), key=lambda event: (event.start_s, event.player_id))
    return tuple(ordered), frozenset(event.id for event in generated)


def _cue(
    player_id: str, note: str, tick: int, beats: float, piece: Piece, frame: TimeFrame, reason: Message
) -> CueEvent:
    seconds, beat = piece.clock.seconds, float(piece.beat_ticks_at(np.array([tick]))[0]) * beats
    peak_tick, start_tick = tick - beat, tick - LEAD_BEATS * beat
    end_s, peak_s = seconds(float(tick)), seconds(peak_tick)
    beat_s = end_s - peak_s
    if reason is not BY_HAND:
        reason = Message(reason.id, {**reason.arguments, "beat_s": round(beat_s, 3)})
    return CueEvent(
        id=f"cue:{note}",
        player_id=player_id,
        start_tick=round(start_tick),
        end_tick=tick,
        start_s=max(seconds(start_tick), min(frame.first_frame_s, peak_s)),
        peak_s=peak_s,
        end_s=end_s,
        beat_s=beat_s,
        reason=reason,
    )
