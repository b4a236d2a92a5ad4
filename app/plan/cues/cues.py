"""Cues for entries: the cueing player and the time.

A conductor gives all cues; the players look there and breathe together. Without a conductor, players give cues with
body and instrument in a preparatory beat: at the start and after a rest of all players; after a fermata; at a new
tempo, in which the beat is given; and for a player or section that comes in after a long rest, or as the next voice of
a canon, while others play. Entries together with an accompaniment that is not on stage need no cue.

Head and instrument rise on the preparatory beat, with the inhalation, and drop onto the next beat, which has the nod's
acceleration peak; the duration in between sets the tempo (Bishop and Goebl 2017). Both are beats of the metre: before a
pickup the second one is the beat that contains the pickup, else it is the entry.
"""

from __future__ import annotations

from typing import NamedTuple

import msgspec
import numpy as np

from app.errors import Argument, Message
from app.plan.by_hand.corrected_events import removed_ids
from app.plan.by_hand.corrections import BY_HAND, SetCue
from app.plan.cues.entries import ON_BEAT, Entry, beat_ticks, coming_in, played_together
from app.plan.model import CONDUCTOR, CueEvent, TimeFrame
from app.plan.music.dynamics import vigour_of
from app.plan.music.piece import BEFORE_FIRST_TICK, LineTimes, MonophonicPart, Piece
from instrument_maps.instrument_names import vocabulary

LEAD_BEATS = 1.5
"""Beats before an entry at which head and instrument begin to rise: half a beat before the preparatory beat."""

LEAST_RISE_BEATS = 0.25
"""Least beats in which they still rise to it after another cue."""

MELODY_BARS = 2
"""Number of bars for which the players of the melody are determined."""
DOUBLED_SHARE = 0.8
"""Share of the melody, in any octave, that makes a player one of its doubles."""
SMALLEST, LARGEST = 0.4, 1.2
"""Size of the smallest cue, for soft entries but still visible, and of the largest, for loud ones."""


def leader_of(
    entry: Entry, parts: tuple[MonophonicPart, ...], all_times: tuple[LineTimes, ...], piece: Piece
) -> tuple[int | None, str]:
    """Choose the player who cues an entry: index of the player's part, and the reason ("chosen" or "melody").

    A player with ``cue_leader`` set cues every entry of all players; of several, one who comes in here, then the first.
    An entry while others play is cued by one of those playing. Otherwise the leader is the first part of the section
    with the melody, except players who must not lead. None if no player may.
    """
    chosen = [index for index, part in enumerate(parts) if part.parameters.cue_leader]
    entering = {part for part, _ in entry.players}
    if chosen and (entry.reason != "cue.joins" or entering.intersection(chosen)):
        return next((index for index in chosen if index in entering), chosen[0]), "chosen"
    free = sorted(part for part in entering if parts[part].parameters.cue_leader is not False)
    if len(free) <= 1:
        return (free[0] if free else None), "melody"
    end = entry.tick + MELODY_BARS * piece.metre_map.bar_ticks_at(entry.tick)
    heights, tunes = {}, {}
    for part in free:
        times = all_times[part]
        here = slice(*np.searchsorted(times.onset_tick, (entry.tick, end)).tolist())
        heights[part] = float(np.average(times.pitch[here], weights=np.maximum(times.duration_s[here], 1e-3)))
        tunes[part] = set(zip(times.onset_tick[here].tolist(), (times.pitch[here] % 12).tolist(), strict=True))
    highest = max(free, key=lambda part: (heights[part], -part))
    tune = tunes[highest]
    sections = {part: _section(parts[part]) for part in free}
    having = [part for part in free if len(tunes[part] & tune) >= DOUBLED_SHARE * max(len(tunes[part]), len(tune))]
    counts = {part: sum(sections[other] == sections[part] for other in having) for part in having}
    section = sections[max(having, key=lambda part: (counts[part], part == highest, -part))]
    return next(part for part in free if sections[part] == section), "melody"


def _at_hand(leader: int, tick: int, parts: tuple[MonophonicPart, ...], all_times: tuple[LineTimes, ...]) -> int:
    """Index of the part of the leader's musician that is played at an entry at ``tick``: the one that begins there,
    else the last one that began before it.
    """
    musician = parts[leader].musician or parts[leader].player_id
    own = [index for index, part in enumerate(parts) if (part.musician or part.player_id) == musician]
    if len(own) == 1:
        return leader

    def last(index: int) -> int:
        onsets = all_times[index].onset_tick
        before = int(np.searchsorted(onsets, tick, side="right"))
        return int(onsets[before - 1]) if before else -BEFORE_FIRST_TICK

    return max(own, key=lambda index: (last(index), index == leader))


def _section(part: MonophonicPart) -> str:
    """Return the name of the section a part belongs to: the family of its instrument, or the instrument itself if it
    has no family.
    """
    return vocabulary().family(part.instrument_map.plays) or part.instrument_map.id


class CuePlan(NamedTuple):
    """The cues of all players, and the ids of all cues that the rules made."""

    events: tuple[CueEvent, ...]
    ids: frozenset[str]


def plan_cues(
    found: tuple[Entry, ...],
    parts: tuple[MonophonicPart, ...],
    all_times: tuple[LineTimes, ...],
    piece: Piece,
    frame: TimeFrame,
    conducted: bool = False,
) -> CuePlan:
    """Plan every cue of the ensemble, with corrections applied. ``found`` are the results of `entries`. If
    ``conducted``, the conductor gives all cues except those given to a player by hand.

    A cue's id is ``cue:`` and the note it cues, or ``cue:@`` and the tick if the leader does not play there.
    """
    generated: list[CueEvent] = []
    busy_until_s: dict[int, float] = {}
    for entry in found:
        leader, why = leader_of(entry, parts, all_times, piece)
        if conducted and why != "chosen":
            generated.append(_conducted(entry, parts, all_times, piece, frame))
            continue
        if leader is None:
            continue
        leader = _at_hand(leader, entry.tick, parts, all_times)
        own = next((parts[part].notes[index] for part, index in entry.players if part == leader), None)
        note = own.id if own is not None and own.onset_tick == entry.tick else f"@{entry.tick}"
        amount = _size(entry, all_times)
        takers = _takers(leader, entry.players, parts)
        cue = _cue(parts[leader].player_id, note, entry, why, piece, frame, amount=amount, takers=takers)
        # Cues of a player do not overlap: head and instrument must rise again after the last cue.
        free_s = busy_until_s.get(leader, -np.inf)
        if cue.peak_s - max(free_s, cue.start_s) >= min(LEAST_RISE_BEATS * cue.beat_s, cue.peak_s - cue.start_s):
            if cue.start_s < free_s:
                cue = msgspec.structs.replace(cue, start_s=free_s, start_tick=round(piece.clock.ticks(free_s)))
            busy_until_s[leader] = cue.end_s
            generated.append(cue)
    events = {event.id + event.player_id: event for event in generated}
    for place, part in enumerate(parts):
        removed = removed_ids(part.corrections)
        for event in generated:
            if event.player_id == part.player_id and event.id in removed:
                del events[event.id + event.player_id]
        if not any(isinstance(item, SetCue) for item in part.corrections):
            continue
        onsets = {note.id: note.onset_tick for note in part.notes}
        for item in part.corrections:
            if isinstance(item, SetCue):
                tick = onsets.get(item.note_id, item.tick)
                if tick is None:
                    continue
                entering = _entering(tick, all_times, piece) if item.takers is None else _chosen(item.takers, parts)
                takers = _takers(place, entering, parts)
                event = _cue_by_hand(part.player_id, item.note_id, tick, item.beats, piece, frame, takers)
                events[event.id + event.player_id] = event
    ordered = sorted(events.values(), key=lambda event: (event.start_s, event.player_id))
    return CuePlan(tuple(ordered), frozenset(event.id for event in generated))


def _size(entry: Entry, all_times: tuple[LineTimes, ...]) -> float:
    loudness = float(np.mean([all_times[part].loudness[index] for part, index in entry.players]))
    return round(min(max(float(vigour_of(np.array([loudness]))[0]), SMALLEST), LARGEST), 4)


def _conducted(
    entry: Entry, parts: tuple[MonophonicPart, ...], all_times: tuple[LineTimes, ...], piece: Piece, frame: TimeFrame
) -> CueEvent:
    """A cue by the conductor for all players of an entry."""
    takers = tuple(parts[part].player_id for part, _ in entry.players)
    return _cue(
        CONDUCTOR, f"@{entry.tick}", entry, "conductor", piece, frame, amount=_size(entry, all_times), takers=takers
    )


def _takers(leader: int, players: tuple[tuple[int, int], ...], parts: tuple[MonophonicPart, ...]) -> tuple[str, ...]:
    """Ids of the players of an entry, without the leader and other parts of the leader's musician."""
    own = parts[leader].musician or parts[leader].player_id
    entering = [parts[part] for part, _ in players if part != leader]
    return tuple(part.player_id for part in entering if (part.musician or part.player_id) != own)


def _chosen(takers: tuple[str, ...], parts: tuple[MonophonicPart, ...]) -> tuple[tuple[int, int], ...]:
    """Convert the player ids chosen by hand to receive a cue into pairs of part index and note index; ids that no
    longer exist are left out.
    """
    return tuple((index, 0) for index, part in enumerate(parts) if part.player_id in takers)


def _entering(tick: int, all_times: tuple[LineTimes, ...], piece: Piece) -> tuple[tuple[int, int], ...]:
    """Find the players whom a cue at a tick, placed by hand, concerns: those that begin after a silence there, or else
    all that begin there; as pairs of part index and note index.
    """
    found = coming_in([(part, times) for part, times in enumerate(all_times)], tick, played_together(piece, tick))
    least = beat_ticks(piece, tick) / 2
    rested = tuple((part, index) for part, index in found if all_times[part].silence_tick[index] >= least)
    return rested or found


def _cue(
    player_id: str,
    note: str,
    entry: Entry,
    why: str,
    piece: Piece,
    frame: TimeFrame,
    *,
    amount: float,
    takers: tuple[str, ...],
) -> CueEvent:
    """Create the cue for an entry, timed in the tempo that begins there."""
    clock, tick, beat = piece.clock, entry.tick, beat_ticks(piece, entry.tick)
    end_s = clock.seconds(float(tick))
    beat_s = clock.seconds(float(tick + beat)) - end_s
    bar_tick = piece.metre_map.tick_of_bar(piece.metre_map.bar_of_tick(tick))
    late = (tick - bar_tick) % piece.metre_map.felt_ticks_at(bar_tick) / beat
    peak_s = end_s - beat_s * (1.0 + (late if ON_BEAT < late < 1.0 - ON_BEAT else 0.0))
    start_s = peak_s - (LEAD_BEATS - 1.0) * beat_s
    arguments: dict[str, Argument] = {"leader_reason": why, "beat_s": round(beat_s, 3)}
    if entry.number is not None:
        arguments["bpm" if entry.reason == "cue.tempo" else "rest_s"] = round(entry.number, 2)
    reason: str = entry.reason
    if reason == "cue.joins" and len(entry.players) > 1:
        reason, arguments["count"] = "cue.section", len(entry.players)
    return CueEvent(
        id=f"cue:{note}",
        player_id=player_id,
        start_tick=round(clock.ticks(start_s)),
        end_tick=tick,
        start_s=max(start_s, min(frame.first_frame_s, peak_s)),
        peak_s=peak_s,
        end_s=end_s,
        beat_s=beat_s,
        reason=Message(reason, arguments),
        amount=amount,
        takers=takers,
    )


def _cue_by_hand(
    player_id: str, note: str, tick: int, beats: float, piece: Piece, frame: TimeFrame, takers: tuple[str, ...]
) -> CueEvent:
    """Create a cue placed by hand; ``beats`` is the distance of the preparatory beat from the entry in beats of the
    score.
    """
    seconds, beat = piece.clock.seconds, beat_ticks(piece, tick) * beats
    start_tick = tick - LEAD_BEATS * beat
    end_s, peak_s = seconds(float(tick)), seconds(tick - beat)
    return CueEvent(
        id=f"cue:{note}",
        player_id=player_id,
        start_tick=round(start_tick),
        end_tick=tick,
        start_s=max(seconds(start_tick), min(frame.first_frame_s, peak_s)),
        peak_s=peak_s,
        end_s=end_s,
        beat_s=end_s - peak_s,
        reason=BY_HAND,
        corrected=True,
        takers=takers,
    )
