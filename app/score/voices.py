"""Divides one track among players: their number, and the notes of each.

Overlapping notes are usually legato: a player holds a note briefly into the next. Another player is assumed only if
notes sound together beyond that, over several notes and for some time, or in much of the track
(`app.score.sounding_together`). A note that overlaps the next one of its player is shortened to `LEGATO_OVERLAP_S`, the
overlap that planning accepts, so that the slur remains visible. Notes beyond the number of players are left out, lowest
first. `split_voices` returns both.

Voice 0 is the highest. Notes struck together go to voices in order, so player 1 has the upper note of a pair; a line
stays with its player until a chord forces a change (least total movement). A line alone for a quarter or longer is
played by all players of a section (*a2*); if several lines share a staff, by one player while the others rest.

At most `MOST_VOICES` players share a track.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from heapq import heappop, heappush
from itertools import chain, pairwise
from math import inf
from typing import Final, NamedTuple

import msgspec
import numpy as np

from app.arrays import FloatArray, IndexArray, IntArray
from app.score.model import MOST_VOICES, Note
from app.score.sounding_together import CHORD_S, VoiceSpans, legato_s, players_needed, spans_of
from app.score.tempo import TempoMap
from app.score.voice_search import REST_QUARTERS, LastPlayed, assigned_voices

LEGATO_OVERLAP_S: Final = 0.030
"""Longest overlap of a note into the next of its player."""


_LEGATO_OF_A_QUARTER: Final = 8
"""Divisor of a quarter; notes of voices that overlap by less are legato."""
_HOMOPHONIC: Final = 0.5
"""Share of the simultaneous notes with simultaneous onsets from which players move together."""

_UNISON_NUMBERS: Final = 10_000_000
_ROUNDING_TICKS = 1e-6
_ROUNDING_S = 1e-9


class TrackVoices(NamedTuple):
    """Notes of a track divided into voices for its players, with the notes that were changed or left out.

    Attributes
    ----------
    voices : list of tuple of Note
        Notes of each voice by onset, voice 0 (the highest) first; none is empty. A note shared by several players has a
        separate id with each further player (`unison_id`).
    together : list of Note
        Notes that require another player: struck while others sound, beyond legato.
    left_out : list of Note
        Notes without a player, by onset.
    shortened : list of Note
        Notes that were shortened since they overlapped their player's next note by more than a legato overlap, in their
        original length.
    unisons : sequence of Note
        Notes dropped as duplicates, because the single player already has each of them: two voices of a staff in
        unison.
    solos : sequence of str
        Ids of notes that words over the staff give to one player.
    """

    voices: list[tuple[Note, ...]]
    together: list[Note]
    left_out: list[Note]
    shortened: list[Note]
    unisons: Sequence[Note] = ()
    solos: Sequence[str] = ()


def is_one_voice(notes: Sequence[Note], tempo_map: TempoMap) -> bool:
    """Return whether one player can play all of the notes, which are ordered by onset."""
    return not notes or int(spans_of(notes, tempo_map).depths().max()) == 1


def unison_id(id: str, voice: int) -> str:
    """Id for the copy of a note that another voice plays in unison; its number is beyond those of all notes in the
    file.
    """
    track, _, number = id.rpartition(":")
    return f"{track}:{int(number) + _UNISON_NUMBERS * (voice + 1)}"


def file_id(id: str) -> str:
    """Return the id that a note has in the file, also for its copies in other voices."""
    track, _, number = id.rpartition(":")
    return f"{track}:{int(number) % _UNISON_NUMBERS}"


def split_voices(
    notes: Sequence[Note],
    tempo_map: TempoMap,
    most: int = MOST_VOICES,
    *,
    least: int = 1,
    every_chord: bool = False,
    unison: bool = False,
    in_turn: bool = False,
) -> TrackVoices:
    """Divide the notes of one track among its players.

    Parameters
    ----------
    notes : sequence of Note
        The notes by onset.
    most : int
        Largest number of voices.
    least : int
        Number of players if notes are ever struck together, from a name such as "Horn 1.2"; single lines are played by
        all of them.
    every_chord : bool
        Whether to add a player for every note that sounds together with others, however briefly.
    unison : bool
        Whether the players are one section: a line that one could play alone is played by all, if they move together.
    in_turn : bool
        Whether words select the playing player: the number of players is then that of the name, even if only one line
        is written.
    """
    if not notes:
        return TrackVoices([], [], [], [])
    spans = spans_of(notes, tempo_map)
    depths = spans.depths()
    deepest = int(depths.max())
    if deepest > 1 and least == 1 and not every_chord and (twins := _unisons(notes, spans)):
        single = [note for place, note in enumerate(notes) if place not in twins]
        alone = split_voices(single, tempo_map, most, unison=unison)
        if len(alone.voices) == 1:
            return alone._replace(unisons=[notes[place] for place in sorted(twins)])
    if deepest == 1:
        line, shortened = _legato(notes, spans, tempo_map)
        players = [line] + [()] * (min(least, most) - 1 if in_turn else 0)
        return TrackVoices(_with_unisons(players, tempo_map) if len(players) > 1 else players, [], [], shortened)
    pitches = np.array([note.pitch for note in notes])
    struck_together = bool(np.any((np.diff(spans.onsets) <= CHORD_S) & (depths[1:] > 1)))
    count = max(deepest if every_chord else players_needed(spans, depths, pitches), least if struck_together else 1)
    count = min(count, most)
    order = np.lexsort((-pitches, spans.onsets))
    kept = (_first if count == most else _playable)(spans, pitches, order, count)
    left_out = [notes[index] for index in sorted(set(order.tolist()) - set(kept))]
    together = [notes[index] for index in np.flatnonzero(depths > 1).tolist()]
    places = [kept] if count == 1 else _voices(spans, pitches, kept, count, tempo_map)
    voices: list[tuple[Note, ...]] = []
    shortened = []
    for own in filter(None, places):
        voice, too_long = _legato([notes[index] for index in own], spans.of(np.array(own)), tempo_map)
        voices.append(voice)
        shortened += too_long
    shared = [voice for voice in voices if voice]
    if count > 1 and (least > 1 or (unison and _move_together(spans, np.array(kept)))):
        shared = _with_unisons(shared + [()] * (count - len(shared)), tempo_map)
    return TrackVoices(shared, together, left_out, sorted(shortened, key=lambda note: note.onset_tick))


def _unisons(notes: Sequence[Note], spans: VoiceSpans) -> set[int]:
    """Indices of notes that can be dropped, because another note of the same pitch and onset lasts as long
    or longer.
    """
    found: set[int] = set()
    last: dict[int, int] = {}
    onsets, ends = spans.onsets.tolist(), spans.ends.tolist()
    for place, note in enumerate(notes):
        other = last.setdefault(note.pitch, place)
        # A note that begins after the other has ended is struck again.
        if other != place and onsets[place] < min(onsets[other] + CHORD_S, ends[other]):
            shorter = place if ends[place] <= ends[other] else other
            found.add(shorter)
            last[note.pitch] = place + other - shorter
        else:
            last[note.pitch] = place
    return found


def _first(spans: VoiceSpans, _: IntArray, order: IndexArray, count: int) -> list[int]:
    """Return the indices of the notes that ``count`` voices have room for, if each note occupies a voice until its
    release; notes beyond exceed any section and are dropped.
    """
    sounding: list[float] = []
    kept = []
    onsets, releases = spans.onsets[order].tolist(), spans.releases[order].tolist()
    for index, onset, release in zip(order.tolist(), onsets, releases, strict=True):
        while sounding and sounding[0] <= onset:
            heappop(sounding)
        if len(sounding) < count:
            heappush(sounding, release)
            kept.append(index)
    return kept


def _playable(spans: VoiceSpans, pitches: IntArray, order: IndexArray, count: int) -> list[int]:
    """Choose the notes that ``count`` players can play, as indices by onset and from the highest; where a player must
    end a note early for the next one, its release is moved in ``spans``.

    If more notes are struck together than there are players, the lowest are dropped, and the lower of two in octaves or
    unison; otherwise the note that ends first is cut at the next onset.
    """
    onsets, _, releases = spans
    sounding: list[int] = []
    gone: set[int] = set()
    begin, release, pitch = onsets.tolist(), releases.tolist(), pitches.tolist()
    for index in order.tolist():
        now = begin[index]
        sounding = [other for other in sounding if release[other] > now]
        if len(sounding) == count:
            chord = [other for other in sounding if now - begin[other] <= CHORD_S]
            if len(chord) == count:
                lowest = min((*chord, index), key=lambda other: pitch[other])
                gone.add(lowest)
                if lowest == index:
                    continue
                sounding.remove(lowest)
            elif any((pitch[other] - pitch[index]) % 12 == 0 for other in chord):
                gone.add(index)
                continue
            else:
                first = min((other for other in sounding if other not in chord), key=release.__getitem__)
                release[first] = now
                sounding.remove(first)
        sounding.append(index)
    releases[:] = release
    return [index for index in order.tolist() if index not in gone]


def _voices(spans: VoiceSpans, pitches: IntArray, kept: list[int], count: int, tempo_map: TempoMap) -> list[list[int]]:
    """Distribute the ``kept`` notes over ``count`` voices; returns the indices of each voice's notes in order of
    onset."""
    onsets, ends, releases = (column[kept] for column in spans)
    struck = _chords(onsets, releases)
    # A voice that becomes free before the last note of a chord may take the first one.
    following = np.minimum(np.searchsorted(onsets, releases), len(onsets) - 1)
    releases = np.where(onsets[following] >= releases, np.minimum(releases, struck[following]), releases)
    order = np.lexsort((-pitches[kept], struck))
    begins = np.flatnonzero(np.diff(struck[order], prepend=-1.0))
    played = list(map(LastPlayed, pitches[kept][order].tolist(), releases[order].tolist(), ends[order].tolist()))
    groups = [played[begin:end] for begin, end in pairwise([*begins.tolist(), len(order)])]
    at = struck[order][begins]
    rests_s = tempo_map.seconds(tempo_map.ticks(at) + REST_QUARTERS * tempo_map.ticks_per_quarter) - at
    players = chain.from_iterable(assigned_voices(at.tolist(), groups, count, rests_s.tolist()))
    voices: list[list[int]] = [[] for _ in range(count)]
    for place, voice in zip(order.tolist(), players, strict=True):
        voices[voice].append(kept[place])
    return [sorted(voice, key=spans.onsets.__getitem__) for voice in voices]


def _chords(onsets: FloatArray, releases: FloatArray) -> FloatArray:
    """Onset (N,) of the chord to which each note belongs; for a single note its own onset."""
    struck = onsets.tolist()
    begin, free = -1.0, -1.0
    for place, (onset, release) in enumerate(zip(struck.copy(), releases.tolist(), strict=True)):
        if onset - begin <= CHORD_S and free > onset:
            struck[place], free = begin, min(free, release)
        else:
            begin, free = onset, release
    return np.array(struck)


def _legato(notes: Sequence[Note], spans: VoiceSpans, tempo_map: TempoMap) -> tuple[tuple[Note, ...], list[Note]]:
    """Shorten the overlaps between notes of one player to `LEGATO_OVERLAP_S`; also return the original of each note
    that overlapped by more than legato does.
    """
    long = np.flatnonzero(spans.ends[:-1] > spans.onsets[1:] + LEGATO_OVERLAP_S)
    if not len(long):
        return tuple(notes), []
    line, shortened = list(notes), []
    overlong = (spans.ends - legato_s(spans.ends - spans.onsets))[long] > spans.onsets[1:][long] + _ROUNDING_S
    latest = np.floor(tempo_map.ticks(spans.onsets[1:][long] + LEGATO_OVERLAP_S) + _ROUNDING_TICKS)
    for index, end, is_overlong in zip(long.tolist(), latest.tolist(), overlong.tolist(), strict=True):
        note = notes[index]
        if note.end_tick > end:
            if is_overlong:
                shortened.append(note)
            line[index] = Note(note.id, note.onset_tick, max(int(end) - note.onset_tick, 1), note.pitch, note.velocity)
    return tuple(line), shortened


def _move_together(spans: VoiceSpans, kept: IndexArray) -> bool:
    """Return whether most notes that sound together also begin together."""
    own = spans.of(kept)
    together = np.flatnonzero(own.depths() > 1)
    begun = own.onsets[together] - own.onsets[np.maximum(together - 1, 0)] <= CHORD_S
    before = np.append(own.onsets[1:] - own.onsets[:-1] <= CHORD_S, False)[together]
    return len(together) > 0 and bool(np.count_nonzero(begun | before) >= _HOMOPHONIC * len(together))


def _with_unisons(voices: list[tuple[Note, ...]], tempo_map: TempoMap) -> list[tuple[Note, ...]]:
    """Copy passages of a quarter or longer that one voice plays alone to all voices, since they are played in
    unison."""
    quarter = tempo_map.ticks_per_quarter
    rows = sorted(
        ((note.onset_tick, voice, note) for voice, notes in enumerate(voices) for note in notes),
        key=lambda row: row[:2],
    )
    reach = [0] * len(voices)
    onsets = [[note.onset_tick for note in notes] for notes in voices]
    runs: list[list[tuple[int, Note]]] = [[]]
    for onset, voice, note in rows:
        legato = min(quarter // _LEGATO_OF_A_QUARTER, note.duration_tick // 2)
        beside = any(
            reach[other] > onset + legato or _next(onsets[other], onset) < note.end_tick - legato
            for other in range(len(voices))
            if other != voice
        )
        if beside or (runs[-1] and runs[-1][-1][0] != voice):
            runs.append([])
        if not beside:
            runs[-1].append((voice, note))
        reach[voice] = max(reach[voice], note.end_tick)
    more: list[list[Note]] = [[] for _ in voices]
    for run in runs:
        if run and run[-1][1].end_tick - run[0][1].onset_tick >= quarter:
            for voice, own in enumerate(more):
                own += [
                    msgspec.structs.replace(note, id=unison_id(note.id, voice)) for owner, note in run if owner != voice
                ]
    joined = (
        _joined(notes, copies, tempo_map) if copies else notes for notes, copies in zip(voices, more, strict=True)
    )
    return [notes for notes in joined if notes]


def _next(onsets: list[int], tick: int) -> float:
    """Return the first onset at or after a tick; infinity if there is none."""
    place = bisect_left(onsets, tick)
    return onsets[place] if place < len(onsets) else inf


def _joined(notes: tuple[Note, ...], copies: list[Note], tempo_map: TempoMap) -> tuple[Note, ...]:
    together = sorted((*notes, *copies), key=lambda note: (note.onset_tick, note.pitch))
    return _legato(together, spans_of(together, tempo_map), tempo_map)[0]
