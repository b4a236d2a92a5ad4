"""Who gives the entries, and when.

A conductor gives all of them; the players look there and breathe together. Without one the players give the entries
themselves, by body and instrument, with a preparatory beat: the start, and the new start after a rest or a general
pause of all; going on after a fermata; a new tempo, in which that beat is given; and a player or a section that comes
in after a long rest, or as the next voice of a canon, while others play.
What an accompaniment plays that is not on stage sounds too: an entry with it needs no cue.

Head and instrument rise on the preparatory beat, with the inhalation, and drop onto the next one: there lies the nod's
acceleration peak, and its duration is the tempo (Bishop and Goebl 2017). Both are beats of the metre: before a pickup
the second is the beat that the pickup lies in, else it is the entry.

Messages: ``cue.start``, ``cue.after_rest``, ``cue.after_pause``, ``cue.after_fermata``, ``cue.tempo``, ``cue.section``,
``cue.joins``.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

import msgspec
import numpy as np

from app.errors import Argument, Message
from app.plan.corrections import BY_HAND, SetCue, removed_ids
from app.plan.dynamics import vigour_of
from app.plan.line import BEFORE_FIRST_TICK, IntArray, LineTimes, MonophonicPart, Piece, Rhythm
from app.plan.model import CONDUCTOR, CueEvent, FloatArray, TimeFrame
from instrument_maps.vocabulary import vocabulary

COMMON_REST_BARS = 2
COMMON_REST_S = 4.0
"""A rest of all players this long needs a new start: everyone has lost the beat (either is enough)."""
COMMON_REST_LEAST_S = 2.0
"""Short bars rest quickly over: no one has lost the beat by then."""
PAUSE_LEAST_S = 1.5
"""A silence of all for a whole bar, and so long, is a general pause."""
LEAST_BEATS = 2.0
"""A cue needs the preparatory beat and room before it."""
LEAD_BEATS = 1.5
"""Head and instrument begin to rise half a beat before the preparatory beat: they are on their way up on it."""

HELD_S, HELD_BEATS = 3.0, 3.0
"""What all hold so long, in seconds and in beats, and leave together, was held by a fermata."""
HELD_SILENCE_BEATS = 0.5
"""From this silence on it was left; one of `LEAST_BEATS` is a rest that is counted."""
LONG_HELD_S, LONG_HELD_BEATS = 6.0, 6.0
"""What all hold so long no one counts: they need a cue even where they go on without any silence."""
OTHER_TEMPO = 1.15
"""A tempo that is faster or slower by this factor is another one."""
STEADY_TEMPO, STEADY_BEATS = 1.1, 4
"""A new tempo holds for so many beats, within this factor; one that goes on changing is followed, not given."""
HELD_TEMPO = 1.5
"""A beat that is longer by this factor, for no more than `STEADY_BEATS`, is held by a fermata."""
LIVE_TEMPO, LIVE_HELD_TEMPO = 1.35, 2.0
"""Where the tempo was played, and so never steady: beats within the one factor are one tempo, and what is longer by the
other was held."""

LONG_REST_S, LONG_REST_BARS = 8.0, 4
"""After a rest of either length a player is brought in ..."""
LONG_REST_LEAST_S, LONG_REST_LEAST_BARS = 4.0, 2
"""... which is at least so long in both."""
MELODY_BARS = 2
"""Bars over which the players of the melody are determined."""
DOUBLED_SHARE = 0.8
"""Who plays so much of the melody, in any octave, has it too."""
SMALLEST, LARGEST = 0.4, 1.2
"""A cue to play softly is small, but seen; one to play loudly is no leap."""
ON_BEAT = 0.12
"""What is nearer to a beat, in beats, is on it: no one plays more exactly."""

Reason: TypeAlias = Literal[
    "cue.start", "cue.after_rest", "cue.after_pause", "cue.after_fermata", "cue.tempo", "cue.joins"
]


class Entry(msgspec.Struct, frozen=True):
    """A place where players come in together.

    Attributes
    ----------
    reason : str
        Id of the message, but for a section.
    number : float or None
        What the message says: seconds of rest, or beats a minute.
    players : tuple of (int, int)
        Who comes in together, with which note: line index, note index.
    """

    tick: int
    reason: Reason
    number: float | None
    players: tuple[tuple[int, int], ...]


def entries(all_times: tuple[Rhythm, ...], piece: Piece, musicians: tuple[str, ...] = ()) -> tuple[Entry, ...]:
    """Every place that asks for a cue, in order: by the rhythm of the lines and the tempo alone.

    ``musicians`` gives the musician of each line, where one plays several: changing instruments is no rest.
    """
    sounding = [(line, times) for line, times in enumerate(all_times) if len(times.onset_tick)]
    if not sounding:
        return ()
    lines = _Spans.of([_stretches(times) for _, times in sounding])
    found = {entry.tick: entry for entry in _tempo_entries(sounding, lines, piece)}
    found |= {entry.tick: entry for entry in _held_entries(sounding, piece)}
    found |= {entry.tick: entry for entry in _common_entries(sounding, lines, piece)}
    shared: list[Entry] = []
    for entry in sorted(found.values(), key=lambda entry: entry.tick):
        # A tempo that changes while they come in belongs to their entry.
        if not shared or entry.tick - shared[-1].tick >= _beat(piece, shared[-1].tick):
            shared.append(entry)
    return tuple(sorted([*shared, *_joining(sounding, lines, shared, piece, musicians)], key=lambda entry: entry.tick))


class _Spans(msgspec.Struct, frozen=True):
    """Where something sounds: starts in order, and the latest end of those up to each."""

    starts: IntArray
    ends: IntArray

    @classmethod
    def of(cls, stretches: list[tuple[IntArray, IntArray]]) -> _Spans:
        starts, ends = (np.concatenate(edges) for edges in zip(*stretches, strict=True))
        order = np.argsort(starts, kind="stable")
        return cls(starts[order], np.maximum.accumulate(ends[order]))

    def sounds_before(self, tick: int, ticks: float) -> bool:
        """Whether something that begins before a tick sounds on within so many ticks before it."""
        index = int(np.searchsorted(self.starts, tick)) - 1
        return index >= 0 and bool(self.ends[index] > tick - ticks)


def _stretches(times: Rhythm) -> tuple[IntArray, IntArray]:
    """Where a line begins to sound and where it stops: a tenth of as many as there are notes."""
    stops = times.onset_tick[1:] > times.played_end_tick[:-1]
    return times.onset_tick[np.insert(stops, 0, True)], times.played_end_tick[np.append(stops, True)]


def _beat(piece: Piece, tick: int) -> int:
    return int(piece.beat_ticks_at(np.array([tick]))[0])


def _together(piece: Piece, tick: int) -> int:
    """How long after a tick others still come in with it, ticks: at once, or within a beat of the bar line after a
    pickup."""
    beat, bar = _beat(piece, tick), piece.metre_map.bar_ticks_at(tick)
    bars = piece.bars(tick, tick + bar + 1)
    following = int(bars[np.searchsorted(bars, tick, side="right")]) - tick if bars[-1] > tick else bar
    return following + beat if following <= bar / 2 else max(round(ON_BEAT * beat), 1)


def _coming_in(sounding: list[tuple[int, Rhythm]], tick: int, ticks: int) -> tuple[tuple[int, int], ...]:
    """Who begins a note within so many ticks from a tick on, and which."""
    found = []
    for line, times in sounding:
        index = int(np.searchsorted(times.onset_tick, tick))
        if index < len(times.onset_tick) and times.onset_tick[index] < tick + ticks:
            found.append((line, index))
    return tuple(found)


def _common_entries(sounding: list[tuple[int, Rhythm]], lines: _Spans, piece: Piece) -> list[Entry]:
    """The first entry, and those after silences of all, on stage or not."""
    accompaniment = np.array(piece.accompaniment, np.int64).reshape(-1, 2)
    all_spans = _Spans.of([(lines.starts, lines.ends), (accompaniment[:, 0], accompaniment[:, 1])])
    first = int(lines.starts[0])
    found = []
    if not all_spans.sounds_before(first, _beat(piece, first)):
        found.append(Entry(first, "cue.start", None, _coming_in(sounding, first, _together(piece, first))))
    for gap in np.flatnonzero(all_spans.starts[1:] > all_spans.ends[:-1]).tolist():
        end, begin = int(all_spans.ends[gap]), int(all_spans.starts[gap + 1])
        index = int(np.searchsorted(lines.starts, begin))
        # What comes in later comes in with the accompaniment.
        if end <= first or index == len(lines.starts) or lines.starts[index] - begin >= _beat(piece, begin):
            continue
        tick = int(lines.starts[index])
        rest_s = piece.clock.seconds(float(tick)) - piece.clock.seconds(float(end))
        reason = _silence(sounding, end, tick, rest_s, piece)
        if reason is not None:
            number = None if reason == "cue.after_fermata" else rest_s
            found.append(Entry(tick, reason, number, _coming_in(sounding, tick, _together(piece, tick))))
    return found


def _silence(sounding: list[tuple[int, Rhythm]], end: int, tick: int, rest_s: float, piece: Piece) -> Reason | None:
    """Why all need a cue after a silence of all from ``end`` to ``tick``; None if no one does."""
    bars, beats = (tick - end) / piece.metre_map.bar_ticks_at(end), (tick - end) / _beat(piece, tick)
    if beats >= LEAST_BEATS:
        if rest_s >= COMMON_REST_S or (bars >= COMMON_REST_BARS and rest_s >= COMMON_REST_LEAST_S):
            return "cue.after_rest"
        if bars >= 1.0 and rest_s >= PAUSE_LEAST_S:
            return "cue.after_pause"
    if not HELD_SILENCE_BEATS <= beats < LEAST_BEATS:
        return None
    left = []
    for _, times in sounding:
        index = int(np.searchsorted(times.onset_tick, end)) - 1
        if index >= 0 and times.played_end_tick[index] > end - _beat(piece, end):
            left.append((times, index))
    for times, index in left:
        held = int(times.played_end_tick[index] - times.onset_tick[index])
        if times.duration_s[index] < HELD_S or held < HELD_BEATS * _beat(piece, end):
            return None
    return "cue.after_fermata" if left else None


def _held_entries(sounding: list[tuple[int, Rhythm]], piece: Piece) -> list[Entry]:
    """Where all go on at once after notes that all held so long that no one counts them."""
    held: dict[int, int] = {}
    for _, times in sounding:
        ends, beats = times.played_end_tick[:-1], piece.beat_ticks_at(times.onset_tick[:-1])
        long = (times.duration_s[:-1] >= LONG_HELD_S) & (ends - times.onset_tick[:-1] >= LONG_HELD_BEATS * beats)
        long &= times.onset_tick[1:] - ends < HELD_SILENCE_BEATS * beats
        for begin, tick in zip(times.onset_tick[:-1][long].tolist(), times.onset_tick[1:][long].tolist(), strict=True):
            held[tick] = max(held.get(tick, begin), begin)
    heard = _Spans.of([tuple(np.array(piece.accompaniment, np.int64).reshape(-1, 2).T)])  # type: ignore[list-item]
    found = []
    for tick, begin in held.items():
        alone = all(_nothing_begins(times, begin, tick) for _, times in sounding)
        if alone and not heard.sounds_before(tick, tick - begin):
            players = _coming_in(sounding, tick, _together(piece, tick))
            found.append(Entry(tick, "cue.after_fermata", None, players))
    return found


def _nothing_begins(times: Rhythm, begin: int, tick: int) -> bool:
    """Whether a line begins nothing between two ticks, nor sounds on at the second."""
    index = int(np.searchsorted(times.onset_tick, tick)) - 1
    return index < 0 or bool(times.onset_tick[index] <= begin and times.played_end_tick[index] <= tick)


def _tempo_entries(sounding: list[tuple[int, Rhythm]], lines: _Spans, piece: Piece) -> list[Entry]:
    """Where a new tempo begins and stays, or the old one goes on after a fermata."""
    beats = piece.metre_map.felt_between(int(lines.starts[0]), int(lines.ends[-1]))
    seconds = piece.clock.seconds(beats.astype(np.float64))
    lasts_s: FloatArray = np.diff(seconds) / np.maximum(np.diff(beats), 1)
    changes = np.abs(np.diff(np.log(np.maximum(lasts_s, 1e-12)))) >= np.log(OTHER_TEMPO)
    accompaniment = _Spans.of([tuple(np.array(piece.accompaniment, np.int64).reshape(-1, 2).T)])  # type: ignore[list-item]
    found = []
    for place in (np.flatnonzero(changes) + 1).tolist():
        tick, beat = int(beats[place]), _beat(piece, int(beats[place]))
        reason = _new_tempo(lasts_s, place)
        players = _coming_in(sounding, tick, beat)
        # A single player with an accompaniment follows it.
        carried = len(sounding) == 1 and accompaniment.sounds_before(tick, beat)
        if reason is None or not players or carried or tick <= lines.starts[0]:
            continue
        bpm = 60.0 / (float(lasts_s[place]) * beat)
        found.append(Entry(tick, reason, None if reason == "cue.after_fermata" else bpm, players))
    return found


def _new_tempo(lasts_s: FloatArray, place: int) -> Literal["cue.tempo", "cue.after_fermata"] | None:
    """What begins at a beat, by how long a tick lasts in each beat."""
    following = lasts_s[place : place + STEADY_BEATS]
    if len(following) < 2:
        return None
    here = float(np.median(following))
    before = lasts_s[max(place - STEADY_BEATS - 1, 0) : place] / here
    if following.max() > STEADY_TEMPO * following.min():
        return "cue.after_fermata" if _held_while_live(before, following) else None
    other = np.maximum(before, 1.0 / before) >= OTHER_TEMPO
    if not other[-1]:
        return None
    stretch = int(np.argmin(other[::-1])) if not other.all() else len(other)
    if stretch <= STEADY_BEATS and stretch < len(other):
        # The tempo was the same shortly before: that was a fermata, or only a delay.
        return "cue.after_fermata" if before[-stretch:].max() >= HELD_TEMPO else None
    return "cue.tempo"


def _held_while_live(before: FloatArray, following: FloatArray) -> bool:
    """Whether the last of the beats before, relative to the tempo that follows, were held, and the others were not,
    where no two beats are alike."""
    if following.max() > LIVE_TEMPO * following.min():
        return False
    slow = before >= LIVE_TEMPO
    stretch = int(np.argmin(slow[::-1])) if not slow.all() else len(slow)
    return 0 < stretch < len(slow) and bool(before[-stretch:].max() >= LIVE_HELD_TEMPO)


def _joining(
    sounding: list[tuple[int, Rhythm]], lines: _Spans, shared: list[Entry], piece: Piece, musicians: tuple[str, ...]
) -> list[Entry]:
    """Where players come in after long rests of their own while others play; those within a bar are one entry."""
    first = int(lines.starts[0])
    rows: list[tuple[int, float, int, int]] = []
    for line, times in sounding:
        ends = np.insert(times.played_end_tick[:-1], 0, first)
        ends_s = np.insert(times.played_end_s[:-1], 0, piece.clock.seconds(float(first)))
        begins = np.arange(len(ends)) == 0
        for other, theirs in sounding:
            if other != line and musicians and musicians[other] == musicians[line]:
                before = np.searchsorted(theirs.onset_tick, times.onset_tick) - 1
                later = (before >= 0) & (theirs.played_end_tick[before] >= ends)
                ends, ends_s = (
                    np.where(later, found, own)
                    for found, own in ((theirs.played_end_tick[before], ends), (theirs.played_end_s[before], ends_s))
                )
                begins &= before < 0
        rests_s = times.onset_s - ends_s
        # A voice that comes in first of all after the others needs no long rest for it.
        for index in np.flatnonzero((rests_s >= LONG_REST_LEAST_S) | begins).tolist():
            tick, rest_s = int(times.onset_tick[index]), float(rests_s[index])
            bars = (tick - int(ends[index])) / piece.metre_map.bar_ticks_at(tick)
            long = rest_s >= LONG_REST_S or bars >= LONG_REST_BARS
            if bars >= 1.0 if begins[index] else long and bars >= LONG_REST_LEAST_BARS:
                rows.append((tick, rest_s, line, index))
    rows.sort()
    given = [(entry.tick, entry.tick + piece.metre_map.bar_ticks_at(entry.tick)) for entry in shared]
    found: list[Entry] = []
    for tick, rest_s, line, index in rows:
        if found and tick < found[-1].tick + piece.metre_map.bar_ticks_at(found[-1].tick):
            last = found[-1]
            found[-1] = msgspec.structs.replace(last, players=(*last.players, (line, index)))
        elif not any(start <= tick < end for start, end in given) and lines.sounds_before(tick, _beat(piece, tick)):
            found.append(Entry(tick, "cue.joins", rest_s, ((line, index),)))
    return found


def leader_of(
    entry: Entry, lines: tuple[MonophonicPart, ...], all_times: tuple[LineTimes, ...], piece: Piece
) -> tuple[int | None, str]:
    """Index of the line that gives an entry, and why ("chosen" or "melody").

    A player whose ``cue_leader`` is set gives every entry of all; of several, one who comes in here, then the first.
    Who comes in while others play is brought in by one of themselves. Otherwise it is the first part of the section
    that has the melody, leaving out who must not lead. None where no one may.
    """
    chosen = [index for index, line in enumerate(lines) if line.parameters.cue_leader]
    entering = {line for line, _ in entry.players}
    if chosen and (entry.reason != "cue.joins" or entering.intersection(chosen)):
        return next((index for index in chosen if index in entering), chosen[0]), "chosen"
    free = sorted(line for line in entering if lines[line].parameters.cue_leader is not False)
    if len(free) <= 1:
        return (free[0] if free else None), "melody"
    end = entry.tick + MELODY_BARS * piece.metre_map.bar_ticks_at(entry.tick)
    heights, tunes = {}, {}
    for line in free:
        times = all_times[line]
        here = slice(*np.searchsorted(times.onset_tick, (entry.tick, end)).tolist())
        heights[line] = float(np.average(times.pitch[here], weights=np.maximum(times.duration_s[here], 1e-3)))
        tunes[line] = set(zip(times.onset_tick[here].tolist(), (times.pitch[here] % 12).tolist(), strict=True))
    highest = max(free, key=lambda line: (heights[line], -line))
    tune = tunes[highest]
    sections = {line: _section(lines[line]) for line in free}
    having = [line for line in free if len(tunes[line] & tune) >= DOUBLED_SHARE * max(len(tunes[line]), len(tune))]
    counts = {line: sum(sections[other] == sections[line] for other in having) for line in having}
    section = sections[max(having, key=lambda line: (counts[line], line == highest, -line))]
    return next(line for line in free if sections[line] == section), "melody"


def _at_hand(leader: int, tick: int, lines: tuple[MonophonicPart, ...], all_times: tuple[LineTimes, ...]) -> int:
    """Of all lines of the leader's musician the one whose instrument is in the hands: what begins there, or began last
    before it."""
    musician = lines[leader].musician or lines[leader].player_id
    own = [index for index, line in enumerate(lines) if (line.musician or line.player_id) == musician]
    if len(own) == 1:
        return leader

    def last(index: int) -> int:
        onsets = all_times[index].onset_tick
        before = int(np.searchsorted(onsets, tick, side="right"))
        return int(onsets[before - 1]) if before else -BEFORE_FIRST_TICK

    return max(own, key=lambda index: (last(index), index == leader))


def _section(line: MonophonicPart) -> str:
    """Who sits together: the family of the instrument, or the instrument."""
    return vocabulary().family(line.instrument_map.plays) or line.instrument_map.id


def plan_cues(
    found: tuple[Entry, ...],
    lines: tuple[MonophonicPart, ...],
    all_times: tuple[LineTimes, ...],
    piece: Piece,
    frame: TimeFrame,
    conducted: bool = False,
) -> tuple[tuple[CueEvent, ...], frozenset[str]]:
    """Every cue of the ensemble, corrections applied, and the ids of all that the rules made; ``found`` are
    `entries`. Where the ensemble is ``conducted`` the conductor gives what no player is chosen to give.

    A cue's id is ``cue:`` and the note it brings in, or ``cue:@`` and the tick for a leader who does not play there.
    """
    generated: list[CueEvent] = []
    busy_until_s: dict[int, float] = {}
    for entry in found:
        leader, why = leader_of(entry, lines, all_times, piece)
        if conducted and why != "chosen":
            generated.append(_conducted(entry, lines, all_times, piece, frame))
            continue
        if leader is None:
            continue
        leader = _at_hand(leader, entry.tick, lines, all_times)
        own = next((lines[line].notes[index] for line, index in entry.players if line == leader), None)
        note = own.id if own is not None and own.onset_tick == entry.tick else f"@{entry.tick}"
        amount = _size(entry, all_times)
        takers = _takers(leader, entry.players, lines)
        cue = _cue(lines[leader].player_id, note, entry, why, piece, frame, amount, takers)
        # No one nods twice at once.
        if cue.start_s >= busy_until_s.get(leader, -np.inf):
            busy_until_s[leader] = cue.end_s
            generated.append(cue)
    events = {event.id + event.player_id: event for event in generated}
    for place, line in enumerate(lines):
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
                entering = _entering(tick, all_times, piece) if item.takers is None else _chosen(item.takers, lines)
                takers = _takers(place, entering, lines)
                event = _cue_by_hand(line.player_id, item.note_id, tick, item.beats, piece, frame, takers)
                events[event.id + event.player_id] = event
    ordered = sorted(events.values(), key=lambda event: (event.start_s, event.player_id))
    return tuple(ordered), frozenset(event.id for event in generated)


def _size(entry: Entry, all_times: tuple[LineTimes, ...]) -> float:
    loudness = float(np.mean([all_times[line].loudness[index] for line, index in entry.players]))
    return round(min(max(float(vigour_of(np.array([loudness]))[0]), SMALLEST), LARGEST), 4)


def _conducted(
    entry: Entry, lines: tuple[MonophonicPart, ...], all_times: tuple[LineTimes, ...], piece: Piece, frame: TimeFrame
) -> CueEvent:
    """An entry that the conductor gives, to all who come in."""
    takers = tuple(lines[line].player_id for line, _ in entry.players)
    return _cue(CONDUCTOR, f"@{entry.tick}", entry, "conductor", piece, frame, _size(entry, all_times), takers)


def _takers(leader: int, players: tuple[tuple[int, int], ...], lines: tuple[MonophonicPart, ...]) -> tuple[str, ...]:
    """Ids of who comes in with a cue, without the leader and what else the leader's musician plays."""
    own = lines[leader].musician or lines[leader].player_id
    entering = [lines[line] for line, _ in players if line != leader]
    return tuple(line.player_id for line in entering if (line.musician or line.player_id) != own)


def _chosen(takers: tuple[str, ...], lines: tuple[MonophonicPart, ...]) -> tuple[tuple[int, int], ...]:
    """Players who were chosen by hand, as `_takers` has them; who is gone is left out."""
    return tuple((index, 0) for index, line in enumerate(lines) if line.player_id in takers)


def _entering(tick: int, all_times: tuple[LineTimes, ...], piece: Piece) -> tuple[tuple[int, int], ...]:
    """Players who begin with a cue placed by hand: those who were silent before, or else all."""
    found = _coming_in([(line, times) for line, times in enumerate(all_times)], tick, _together(piece, tick))
    least = _beat(piece, tick) / 2
    rested = tuple((line, index) for line, index in found if all_times[line].silence_tick[index] >= least)
    return rested or found


def _cue(
    player_id: str,
    note: str,
    entry: Entry,
    why: str,
    piece: Piece,
    frame: TimeFrame,
    amount: float,
    takers: tuple[str, ...],
) -> CueEvent:
    """The cue of an entry, in the tempo that begins there."""
    clock, tick, beat = piece.clock, entry.tick, _beat(piece, entry.tick)
    end_s = clock.seconds(float(tick))
    beat_s = clock.seconds(float(tick + beat)) - end_s
    beats = piece.metre_map.felt_between(tick - 2 * beat, tick + 1)
    late = (tick - int(beats[np.searchsorted(beats, tick, side="right") - 1])) / beat
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
    """A cue whose preparatory beat lasts as many beats of the score as it was given."""
    seconds, beat = piece.clock.seconds, _beat(piece, tick) * beats
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
