"""Finds entries that need a cue: places where players come in together, by rhythm and tempo alone."""

from __future__ import annotations

from typing import Literal, TypeAlias

import msgspec
import numpy as np

from app.arrays import FloatArray, IntArray
from app.plan.music.fermatas import OTHER_TEMPO, Fermata
from app.plan.music.piece import NoteTimes, Piece
from app.plan.music.spans import Spans

COMMON_REST_S = 1.5
COMMON_REST_BEATS, COMMON_REST_LEAST_S = 2.0, 0.75
"""Length from which a rest of all players needs a cue: a number of beats that are not too quick, or a number of
seconds."""
PAUSE_BARS, PAUSE_MOST_S = (1.0, 2.0), 4.0
"""Lengths in bars, and greatest length in seconds, of a common silence that is a general pause; longer silences are
counted rests.
"""
EXACT = 1e-6
"""Seconds and beats that differ by less are equal."""
HELD_S, HELD_BEATS = 3.0, 3.0
"""Least length in seconds and in beats of a note that all players hold and end together to be a fermata."""
HELD_SILENCE_BEATS = 0.5
"""Silence in beats after which a held note counts as ended; from `COMMON_REST_BEATS` on it is a counted rest."""
LONG_HELD_S, LONG_HELD_BEATS = 6.0, 6.0
"""Length of a common note in seconds and beats beyond which counting is unreliable, so that players need a cue even if
they continue without silence.
"""
STEADY_TEMPO, STEADY_BEATS = 1.1, 4
"""A new tempo gets a cue if it stays within this factor for this number of beats; a continuously changing tempo gets
none.
"""
SLOWED_TEMPO = 1.5
"""Factor by which up to `STEADY_BEATS` beats are longer for the previous tempo to be cued again after them."""

LONG_REST_S, LONG_REST_BARS = 8.0, 4
"""Length in seconds or bars of a rest after which a single player gets a cue; see `LONG_REST_LEAST_S`."""
LONG_REST_LEAST_S, LONG_REST_LEAST_BARS = 4.0, 2
"""Least length in seconds and bars of a rest for `LONG_REST_S`."""
ON_BEAT = 0.12
"""Distance in beats within which a note counts as on a beat: about the precision of players."""

Reason: TypeAlias = Literal[
    "cue.start", "cue.after_rest", "cue.after_pause", "cue.after_fermata", "cue.tempo", "cue.joins"
]


class Entry(msgspec.Struct, frozen=True):
    """A place at which players come in together.

    Attributes
    ----------
    reason : str
        Id of the message that says why a cue is needed; a message of its own is used if a whole section enters.
    number : float or None
        Number in the cue's reason: seconds of rest, or beats per minute.
    players : tuple of (int, int)
        Line index and note index of each player that comes in.
    """

    tick: int
    reason: Reason
    number: float | None
    players: tuple[tuple[int, int], ...]


def entries(
    all_times: tuple[NoteTimes, ...], piece: Piece, held: tuple[Fermata, ...], musicians: tuple[str, ...] = ()
) -> tuple[Entry, ...]:
    """Every entry that needs a cue, in order.

    Parameters
    ----------
    held : tuple of Fermata
        Fermatas as `app.plan.music.fermatas.fermatas` returns them.
    musicians : tuple of str
        Musician of each line, if one plays several: a change of instrument is no rest.
    """
    sounding = [(line, times) for line, times in enumerate(all_times) if len(times.onset_tick)]
    if not sounding:
        return ()
    lines = _Spans.of([_stretches(times) for _, times in sounding])
    found = {entry.tick: entry for entry in _tempo_entries(sounding, lines, piece, held)}
    found |= {entry.tick: entry for entry in _held_entries(sounding, piece)}
    found |= {entry.tick: entry for entry in _common_entries(sounding, lines, piece)}
    shared: list[Entry] = []
    for entry in sorted(found.values(), key=lambda entry: entry.tick):
        # A change of tempo while players enter is a part of their entry.
        if not shared or entry.tick - shared[-1].tick >= beat_ticks(piece, shared[-1].tick):
            shared.append(entry)
    return tuple(sorted([*shared, *_joining(sounding, lines, shared, piece, musicians)], key=lambda entry: entry.tick))


class _Spans(msgspec.Struct, frozen=True):
    """Spans of ticks in which something sounds: starts in ascending order, and for each the latest end so far."""

    starts: IntArray
    ends: IntArray

    @classmethod
    def of(cls, stretches: list[tuple[IntArray, IntArray]]) -> _Spans:
        starts, ends = (np.concatenate(edges) for edges in zip(*stretches, strict=True))
        order = np.argsort(starts, kind="stable")
        return cls(starts[order], np.maximum.accumulate(ends[order]))

    def sounds_before(self, tick: int, ticks: float) -> bool:
        """Return whether a note that began before ``tick`` still sounds less than ``ticks`` before it."""
        index = int(np.searchsorted(self.starts, tick)) - 1
        return index >= 0 and bool(self.ends[index] > tick - ticks)


def _stretches(times: NoteTimes) -> tuple[IntArray, IntArray]:
    """Return the start and end ticks of a part's spans without rests, which are about a tenth as many as its notes."""
    stops = times.onset_tick[1:] > times.played_end_tick[:-1]
    return times.onset_tick[np.concatenate(([True], stops))], times.played_end_tick[np.append(stops, True)]


def beat_ticks(piece: Piece, tick: int) -> int:
    return piece.metre_map.felt_ticks_at(tick)


def played_together(piece: Piece, tick: int) -> int:
    """Return the longest delay in ticks after ``tick`` that still counts as the same entry: almost none, or up to a
    beat after the bar line that follows a pickup.
    """
    beat, bar = beat_ticks(piece, tick), piece.metre_map.bar_ticks_at(tick)
    bars = piece.bars(tick, tick + bar + 1)
    following = int(bars[np.searchsorted(bars, tick, side="right")]) - tick if bars[-1] > tick else bar
    return following + beat if following <= bar / 2 else max(round(ON_BEAT * beat), 1)


def coming_in(sounding: list[tuple[int, NoteTimes]], tick: int, ticks: int) -> tuple[tuple[int, int], ...]:
    """Return the players that begin a note in [tick, tick + ticks), as pairs of part index and note index."""
    found = []
    for line, times in sounding:
        index = int(np.searchsorted(times.onset_tick, tick))
        if index < len(times.onset_tick) and times.onset_tick[index] < tick + ticks:
            found.append((line, index))
    return tuple(found)


def _common_entries(sounding: list[tuple[int, NoteTimes]], lines: _Spans, piece: Piece) -> list[Entry]:
    """The first entry of the piece, and each entry after a silence of all parts, the accompaniment included."""
    accompaniment = np.array(piece.accompaniment, np.int64).reshape(-1, 2)
    all_spans = _Spans.of([(lines.starts, lines.ends), (accompaniment[:, 0], accompaniment[:, 1])])
    first = int(lines.starts[0])
    found = []
    if not all_spans.sounds_before(first, beat_ticks(piece, first)):
        found.append(Entry(first, "cue.start", None, coming_in(sounding, first, played_together(piece, first))))
    for gap in np.flatnonzero(all_spans.starts[1:] > all_spans.ends[:-1]).tolist():
        end, begin = int(all_spans.ends[gap]), int(all_spans.starts[gap + 1])
        index = int(np.searchsorted(lines.starts, begin))
        # Later entries belong to the accompaniment.
        if end <= first or index == len(lines.starts) or lines.starts[index] - begin >= beat_ticks(piece, begin):
            continue
        tick = int(lines.starts[index])
        rest_s = piece.clock.seconds(float(tick)) - piece.clock.seconds(float(end))
        reason = _silence(sounding, end, tick, rest_s, piece)
        if reason is not None:
            number = None if reason == "cue.after_fermata" else rest_s
            found.append(Entry(tick, reason, number, coming_in(sounding, tick, played_together(piece, tick))))
    return found


def _silence(sounding: list[tuple[int, NoteTimes]], end: int, tick: int, rest_s: float, piece: Piece) -> Reason | None:
    """Reason why all players need a cue after a silence from ``end`` to ``tick``; None if none does."""
    bars, beats = (tick - end) / piece.metre_map.bar_ticks_at(end), (tick - end) / beat_ticks(piece, tick)
    long = rest_s >= COMMON_REST_S - EXACT
    if long or (beats >= COMMON_REST_BEATS - EXACT and rest_s >= COMMON_REST_LEAST_S - EXACT):
        pause = PAUSE_BARS[0] <= bars < PAUSE_BARS[1] and rest_s < PAUSE_MOST_S
        return "cue.after_pause" if pause else "cue.after_rest"
    if not HELD_SILENCE_BEATS <= beats < COMMON_REST_BEATS:
        return None
    left = []
    for _, times in sounding:
        index = int(np.searchsorted(times.onset_tick, end)) - 1
        if index >= 0 and times.played_end_tick[index] > end - beat_ticks(piece, end):
            left.append((times, index))
    for times, index in left:
        held = int(times.played_end_tick[index] - times.onset_tick[index])
        if times.duration_s[index] < HELD_S or held < HELD_BEATS * beat_ticks(piece, end):
            return None
    return "cue.after_fermata" if left else None


def _held_entries(sounding: list[tuple[int, NoteTimes]], piece: Piece) -> list[Entry]:
    """Entries of all players after notes that all held together for so long that they lost count of the beats."""
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
            players = coming_in(sounding, tick, played_together(piece, tick))
            found.append(Entry(tick, "cue.after_fermata", None, players))
    return found


def _nothing_begins(times: NoteTimes, begin: int, tick: int) -> bool:
    """Return whether a part starts no note from ``begin`` to ``tick`` and has no note that still sounds at ``tick``."""
    index = int(np.searchsorted(times.onset_tick, tick)) - 1
    return index < 0 or bool(times.onset_tick[index] <= begin and times.played_end_tick[index] <= tick)


def _tempo_entries(
    sounding: list[tuple[int, NoteTimes]], lines: _Spans, piece: Piece, held: tuple[Fermata, ...]
) -> list[Entry]:
    """Entries at the start of a lasting new tempo, and where the tempo resumes after a fermata."""
    beats = piece.metre_map.felt_between(int(lines.starts[0]), int(lines.ends[-1]))
    seconds = piece.clock.seconds(beats.astype(np.float64))
    lasts_s: FloatArray = np.diff(seconds) / np.maximum(np.diff(beats), 1)
    changes = np.abs(np.diff(np.log(np.maximum(lasts_s, 1e-12)))) >= np.log(OTHER_TEMPO)
    # An entry into a fermata needs no beat; the end of the fermata is an entry of its own.
    slow = Spans((one.start_tick - beat_ticks(piece, one.start_tick) + 1, one.entry_tick + 1) for one in held)
    places = [place for place in (np.flatnonzero(changes) + 1).tolist() if not slow.hold(beats[place], beats[place])]
    found = [(int(beats[place]), float(lasts_s[place])) for place in places if _new_tempo(lasts_s, place)]
    found += [(one.entry_tick, 0.0 if one.returns else _tempo_after(one, piece)) for one in held]
    accompaniment = _Spans.of([tuple(np.array(piece.accompaniment, np.int64).reshape(-1, 2).T)])  # type: ignore[list-item]
    entries = []
    for tick, tick_s in found:
        beat = beat_ticks(piece, tick)
        players = coming_in(sounding, tick, beat)
        # A single player with accompaniment follows it.
        carried = len(sounding) == 1 and accompaniment.sounds_before(tick, beat)
        if not players or carried or tick <= lines.starts[0]:
            continue
        if tick_s:
            entries.append(Entry(tick, "cue.tempo", 60.0 / (tick_s * beat), players))
        else:
            entries.append(Entry(tick, "cue.after_fermata", None, players))
    return entries


def _tempo_after(fermata: Fermata, piece: Piece) -> float:
    """Seconds per tick of the tempo after a fermata."""
    first, beat = fermata.entry_tick, beat_ticks(piece, fermata.entry_tick)
    return (piece.clock.seconds(float(first + beat)) - piece.clock.seconds(float(first))) / beat


def _new_tempo(lasts_s: FloatArray, place: int) -> bool:
    """Return whether a new tempo begins at a beat, given the length of a tick in each beat."""
    following = lasts_s[place : place + STEADY_BEATS]
    if len(following) < 2 or following.max() > STEADY_TEMPO * following.min():
        return False
    before = lasts_s[max(place - STEADY_BEATS - 1, 0) : place] / float(np.median(following))
    other = np.maximum(before, 1.0 / before) >= OTHER_TEMPO
    if not other[-1]:
        return False
    stretch = int(np.argmin(other[::-1])) if not other.all() else len(other)
    if stretch <= STEADY_BEATS and stretch < len(other):
        # The tempo was this fast shortly before: only a ritardando or delay preceded.
        return bool(before[-stretch:].max() >= SLOWED_TEMPO)
    return True


def _joining(
    sounding: list[tuple[int, NoteTimes]], lines: _Spans, shared: list[Entry], piece: Piece, musicians: tuple[str, ...]
) -> list[Entry]:
    """Return the entries of players who join others after a long rest of their own; entries within a bar are merged."""
    first = int(lines.starts[0])
    rows: list[tuple[int, float, int, int]] = []
    for line, times in sounding:
        ends = np.concatenate(([first], times.played_end_tick[:-1]))
        ends_s = np.concatenate(([piece.clock.seconds(float(first))], times.played_end_s[:-1]))
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
        # A voice that enters for the first time after the others needs no long rest before it.
        for index in np.flatnonzero((rests_s >= LONG_REST_LEAST_S) | begins).tolist():
            tick, rest_s = int(times.onset_tick[index]), float(rests_s[index])
            bars = (tick - int(ends[index])) / piece.metre_map.bar_ticks_at(tick)
            long = rest_s >= LONG_REST_S or bars >= LONG_REST_BARS
            if bars >= 1.0 if begins[index] else long and bars >= LONG_REST_LEAST_BARS:
                rows.append((tick, rest_s, line, index))
    rows.sort()
    given = Spans((entry.tick, entry.tick + piece.metre_map.bar_ticks_at(entry.tick)) for entry in shared)
    found: list[Entry] = []
    for tick, rest_s, line, index in rows:
        if found and tick < found[-1].tick + piece.metre_map.bar_ticks_at(found[-1].tick):
            last = found[-1]
            found[-1] = msgspec.structs.replace(last, players=(*last.players, (line, index)))
        elif not given.hold(tick, tick + 1) and lines.sounds_before(tick, beat_ticks(piece, tick)):
            found.append(Entry(tick, "cue.joins", rest_s, ((line, index),)))
    return found
