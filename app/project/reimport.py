"""A piece whose MIDI file has changed: the new notes come in, and what was done by hand stays with the music.

Parts are recognised by what they play, by name, track and instrument, notes by alignment (`app.project.alignment`). A
note found again keeps its id, and with it every correction about it; corrections at places of the score move with the
notes around them. A note that the user changed and the file did not stays as the user has it (one that was erased
stays erased); where both changed it the file's version is taken, and reported. What the user chose for players stays. A
part that is new gets a player; a player whose part is gone leaves, but stays, with an empty part, while there are
corrections for them. Parts made in the editor stay, and so do notes drawn into the file's parts where they do not
overlap what the file has there.

Dancers stay; what was corrected of their dances moves like other corrections at places of the score, and so do beats
pinned to the recording.

Corrections whose note is gone stay as they are and do nothing (`orphaned`), until they are given another note
(`reattached`) or taken back.

Messages (`UsageError`): ``reimport.no_note``, ``reimport.not_played``, ``piece.too_long``.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

import msgspec
import numpy as np

from app.errors import UsageError
from app.plan.corrections import Correction, kind
from app.project.alignment import AlignmentPart, Floats, align
from app.project.anchors import moved, note_of
from app.project.doubling import doubled_parts, promote_remaining
from app.project.edit.corrections import put, take_back
from app.project.edit.length import with_score
from app.project.edit.players import free_name, newcomer, with_newcomers
from app.project.ids import (
    MADE_PART,
    READ_NOTE,
    READ_PART,
    fresh_note_ids,
    fresh_part_ids,
    fresh_player_ids,
    is_made_here,
)
from app.project.limits import LAST_TICK
from app.project.model import Project
from app.project.performers import Player
from app.project.recording import with_places
from app.score.model import Note, Part, Score
from app.score.parts import transposed
from instrument_maps.model import InstrumentMap

ALIKE: Final = 0.25
"""Parts that share this much of what they play are one, whatever they are called."""
_GRAM: Final = 3
"""Notes that make a turn of the melody by which parts are recognised."""


@dataclass(frozen=True)
class PartMatch:
    """A part that was found again.

    Attributes
    ----------
    part_id : str
        It keeps this id.
    kept, added, removed : int
        Notes.
    by_hand : int
        Notes whose change by hand stays.
    """

    part_id: str
    former_name: str
    name: str
    kept: int
    added: int
    removed: int
    by_hand: int


@dataclass(frozen=True)
class Conflict:
    """A note that both the user and the file changed; the file's version is taken.

    Attributes
    ----------
    read : Note
        What the file held before.
    by_hand : Note or None
        What the user made of it; None: erased.
    file : Note or None
        What the file holds now; None: it is gone.
    """

    part_id: str
    note_id: str
    read: Note
    by_hand: Note | None
    file: Note | None


@dataclass(frozen=True)
class Orphan:
    """A correction whose note is gone."""

    player_id: str
    correction: Correction


@dataclass(frozen=True)
class Reimport:
    """What came of it.

    Attributes
    ----------
    project : Project
        The very same value where the file says nothing new.
    added, removed : tuple of str
        Ids of notes that are new in the project, and of notes that are in it no more.
    new_players, gone_players, idle_players : tuple of str
        Ids: of new parts; of parts that are gone; of parts that are gone, kept for their corrections.
    orphans : tuple of Orphan
        Corrections that lost their note now or earlier.
    conflicts : tuple of Conflict
        In the order of the parts.
    """

    project: Project
    parts: tuple[PartMatch, ...]
    added: tuple[str, ...]
    removed: tuple[str, ...]
    new_players: tuple[str, ...]
    gone_players: tuple[str, ...]
    idle_players: tuple[str, ...]
    orphans: tuple[Orphan, ...]
    conflicts: tuple[Conflict, ...]


def reimport(project: Project, score: Score, maps: Mapping[str, InstrumentMap], source: str | None = None) -> Reimport:
    """Let the score that a file holds now take the place of the project's.

    The title stays; tempo, metres, markers, percussion and everything else are the file's.

    Parameters
    ----------
    maps : mapping of str to InstrumentMap
        By id; every part of the new score names one of them.
    source : str, optional
        Absolute path of the file.
    """
    old = project.score
    scale = Fraction(score.ticks_per_quarter, old.ticks_per_quarter)
    partners = _matched_parts(old.parts, score.parts, old.ticks_per_quarter, score.ticks_per_quarter)
    former_of = {new: former for former, new in partners}
    score = _as_read(score, old, former_of)
    held = {former: _held_by_file(project, old.parts[former]) for former, _ in partners}
    pairs = {
        former: align(
            AlignmentPart.of(held[former], old.ticks_per_quarter),
            AlignmentPart.of(score.parts[new].notes, score.ticks_per_quarter),
        )
        for former, new in partners
    }
    part_ids = iter(fresh_part_ids(project, len(score.parts), READ_PART))
    note_ids = iter(fresh_note_ids(project, sum(len(part.notes) for part in score.parts), READ_NOTE))
    parts: list[Part] = []
    matches: list[PartMatch] = []
    conflicts: list[Conflict] = []
    read_notes: dict[str, dict[str, Note]] = {}
    added: list[str] = []
    places: dict[str, list[tuple[int, int]]] = {}
    for index, part in enumerate(score.parts):
        former = former_of.get(index)
        if former is None:
            ids = [next(note_ids) for _ in part.notes]
            added += ids
            parts.append(_renamed(part, next(part_ids), ids))
            read_notes[parts[-1].id] = {note.id: note for note in parts[-1].notes}
            continue
        before, was = old.parts[former], held[former]
        kept = {int(new): was[int(one)].id for one, new in pairs[former]}
        ids = [kept[number] if number in kept else next(note_ids) for number in range(len(part.notes))]
        renamed = _renamed(part, before.id, ids)
        read_notes[before.id] = {note.id: note for note in renamed.notes}
        merged = _merged(before, was, renamed, [(int(one), int(new)) for one, new in pairs[former]], scale)
        conflicts += merged.conflicts
        known = {note.id: note for note in before.notes}
        places[before.id] = [
            (known[note.id].onset_tick, note.onset_tick) for note in merged.part.notes if note.id in known
        ]
        drawn = _drawn(before, frozenset(kept.values()), _place_map(places[before.id], scale), scale, merged.part)
        parts.append(_with_more(merged.part, drawn))
        stayed, came = len(places[before.id]), [note.id for note in merged.part.notes if note.id not in known]
        added += came
        lost = len(before.notes) - stayed - len(drawn)
        matches.append(
            PartMatch(before.id, before.name, part.name, stayed + len(drawn), len(came), lost, merged.by_hand)
        )
    everywhere = _place_map((pair for own in places.values() for pair in own), scale)
    found = set(pairs)
    for index, part in enumerate(old.parts):
        if part.id.startswith(MADE_PART) and index not in found:
            empty = msgspec.structs.replace(part, notes=(), curves=())
            parts.append(_with_more(empty, _drawn(part, frozenset(), everywhere, scale, empty)))
    result = _with_players(project, score, parts, places, everywhere, scale, maps)
    result = replace(result, read_notes=read_notes, source=project.source if source is None else source)
    alive = {note.id for part in parts for note in part.notes}
    before_ids = {player.id for player in project.players}
    after_ids = {player.id for player in result.players}
    gone = {part.id for part in old.parts} - {part.id for part in parts}
    return Reimport(
        project=project if result == project else result,
        parts=tuple(matches),
        added=tuple(added),
        removed=tuple(note.id for part in old.parts for note in part.notes if note.id not in alive),
        new_players=tuple(player.id for player in result.players if player.id not in before_ids),
        gone_players=tuple(player.id for player in project.players if player.id not in after_ids),
        idle_players=tuple(player.id for player in result.players if player.part_id in gone),
        orphans=orphaned(result),
        conflicts=tuple(conflicts),
    )


def orphaned(project: Project) -> tuple[Orphan, ...]:
    """Every correction about a note that its player does not play (any more)."""
    found = []
    for player in project.players:
        corrections = project.corrections.get(player.id, ())
        if not corrections:
            continue
        played = {note.id for note in project.part(player).notes}
        for correction in corrections:
            note = note_of(correction)
            if note is not None and note not in played:
                found.append(Orphan(player.id, correction))
    return tuple(found)


def reattached(project: Project, player_id: str, correction: Correction, note_id: str) -> Project:
    """Let a correction be about another note of its player; lengths relative to the note stay. It takes the place of
    one that is about the same there."""
    former = note_of(correction)
    if former is None:
        raise UsageError("reimport.no_note", kind=kind(correction))
    if note_id not in {note.id for note in project.part(project.player(player_id)).notes}:
        raise UsageError("reimport.not_played", note=note_id)
    if former == note_id:
        return project
    without = take_back(project, player_id, [correction])
    return put(without, player_id, [moved(correction, {former: note_id})])


# Parts


def _matched_parts(
    old: Sequence[Part], new: Sequence[Part], old_quarter: int, new_quarter: int
) -> list[tuple[int, int]]:
    """Which part is which, as indices: as much as possible in common, all in all."""
    if not old or not new:
        return []
    old_turns = [_turns(part, old_quarter) for part in old]
    new_turns = [_turns(part, new_quarter) for part in new]
    content = _likeness(old_turns, new_turns)
    named = np.array([[_kinship(one, other) for other in new] for one in old])
    from scipy.optimize import linear_sum_assignment  # heavy, and seldom needed

    pairs = zip(*linear_sum_assignment(-(content + named)), strict=True)
    # A part rewritten from end to end is still the same player's where everything else says so.
    return [(int(one), int(other)) for one, other in pairs if content[one, other] >= ALIKE or named[one, other] >= 0.4]


def _as_read(score: Score, old: Score, former_of: Mapping[int, int]) -> Score:
    """The score with the parts that were read as written pitches before read so again."""
    parts = list(score.parts)
    for new, former in former_of.items():
        shift = old.parts[former].transposed_semitones
        notes = transposed(parts[new].notes, shift)
        parts[new] = msgspec.structs.replace(parts[new], notes=notes, transposed_semitones=shift)
    return msgspec.structs.replace(score, parts=tuple(parts))


def _turns(part: Part, quarter: int) -> Floats:
    """What the melody does at every place, whatever its key and wherever it stands; sorted."""
    if len(part.notes) <= _GRAM:
        # Too short for turns: the notes themselves.
        return np.sort(np.array([note.pitch * 1e6 + note.onset_tick / quarter for note in part.notes]))
    pitches = np.array([note.pitch for note in part.notes], np.float64)
    onsets = np.array([note.onset_tick for note in part.notes], np.float64) / quarter
    steps = np.diff(pitches) + 200.0
    times = np.minimum(np.rint(np.diff(onsets) * 12.0), 999.0)
    single = steps * 1000.0 + times
    count = len(single) - _GRAM + 2
    return np.sort(single[:count] * 1e6 + single[len(single) - count :])


def _likeness(old: Sequence[Floats], new: Sequence[Floats]) -> Floats:
    """The share of turns that two parts both have, 0..1, (old, new): turn by turn, for of many parts most pairs have
    nothing in common."""
    both: Floats = np.zeros((len(old), len(new)))
    here, there = _owners(old), _owners(new)
    for turn, (parts, counts) in here.items():
        if turn in there:
            others, more = there[turn]
            both[np.ix_(parts, others)] += np.minimum.outer(counts, more)
    lengths = np.add.outer([len(turns) for turns in old], [len(turns) for turns in new])
    return 2.0 * both / np.maximum(lengths, 1)


def _owners(parts: Sequence[Floats]) -> dict[float, tuple[list[int], list[int]]]:
    """Which parts have each turn, and how often."""
    owners: dict[float, tuple[list[int], list[int]]] = {}
    for index, turns in enumerate(parts):
        values, counts = np.unique(turns, return_counts=True)
        for value, count in zip(values.tolist(), counts.tolist(), strict=True):
            found = owners.setdefault(value, ([], []))
            found[0].append(index)
            found[1].append(count)
    return owners


def _kinship(one: Part, other: Part) -> float:
    """What speaks for two parts being one beside what they play: decides between parts that play the same."""
    return (
        0.25 * (one.name.casefold() == other.name.casefold())
        + 0.15 * (one.map_id == other.map_id and one.instrument == other.instrument)
        + 0.06 * (one.voice == other.voice)
        + 0.04 * (one.track == other.track)
        + 0.02 * (one.channel == other.channel)
    )


def _held_by_file(project: Project, part: Part) -> tuple[Note, ...]:
    """The notes of a part as the file had them; those that it did not have, or that are unknown, as they are."""
    read = project.read_notes.get(part.id)
    if not read:
        return part.notes
    more = (note for note in part.notes if note.id not in read)
    return tuple(sorted((*read.values(), *more), key=lambda note: (note.onset_tick, note.pitch)))


@dataclass(frozen=True)
class _Merged:
    """The file's part with what stays of the changes by hand."""

    part: Part
    by_hand: int
    conflicts: tuple[Conflict, ...]


def _merged(
    before: Part, was: Sequence[Note], part: Part, pairs: Sequence[tuple[int, int]], scale: Fraction
) -> _Merged:
    """Of three versions of each note one: the user's where the file did not change it, else the file's.

    Parameters
    ----------
    before : Part
        As the user has it.
    was : sequence of Note
        As the file had it.
    part : Part
        As the file has it, with the ids of the project.
    pairs : sequence of (int, int)
        Which of ``was`` is which of the part's notes.
    """
    here = {note.id: note for note in before.notes}
    distances = [part.notes[new].onset_tick - round(was[one].onset_tick * scale) for one, new in pairs]
    notes = {note.id: note for note in part.notes}
    by_hand, conflicts = 0, []
    for place, (one, new) in enumerate(pairs):
        read, now = was[one], part.notes[new]
        mine = here.get(read.id)
        if mine == read:
            continue
        beside = distances[max(place - 1, 0) : place] + distances[place + 1 : place + 2]
        still = distances[place] in beside or distances[place] == 0
        if not still or (now.duration_tick, now.pitch, now.velocity) != (
            max(round(read.duration_tick * scale), 1),
            read.pitch,
            read.velocity,
        ):
            conflicts.append(Conflict(before.id, read.id, read, mine, now))
            continue
        by_hand += 1
        if mine is None:
            del notes[read.id]
            continue
        onset = now.onset_tick + round((mine.onset_tick - read.onset_tick) * scale)
        length = max(round(mine.duration_tick * scale), 1)
        notes[read.id] = Note(mine.id, max(onset, 0), length, mine.pitch, mine.velocity)
    found = {one for one, _ in pairs}
    for index, read in enumerate(was):
        mine = here.get(read.id)
        if index not in found and mine is not None and mine != read:
            conflicts.append(Conflict(before.id, read.id, read, mine, None))
    ordered = sorted(notes.values(), key=lambda note: (note.onset_tick, note.pitch))
    conflicts.sort(key=lambda conflict: conflict.read.onset_tick)
    return _Merged(msgspec.structs.replace(part, notes=tuple(ordered)), by_hand, tuple(conflicts))


def _renamed(part: Part, part_id: str, note_ids: Sequence[str]) -> Part:
    notes = tuple(
        note if note.id == id else Note(id, note.onset_tick, note.duration_tick, note.pitch, note.velocity)
        for note, id in zip(part.notes, note_ids, strict=True)
    )
    return msgspec.structs.replace(part, id=part_id, notes=notes)


def _drawn(
    before: Part, kept: frozenset[str], place: Callable[[int], int], scale: Fraction, part: Part
) -> tuple[Note, ...]:
    """Notes drawn here that the file does not have: those that still have room, at their new places."""
    ends = np.maximum.accumulate(np.array([0, *(note.end_tick for note in part.notes)]))
    onsets = [note.onset_tick for note in part.notes]
    result = []
    for note in before.notes:
        if note.id in kept or not (is_made_here(note.id) or before.id.startswith(MADE_PART)):
            continue
        onset, length = max(place(note.onset_tick), 0), max(round(note.duration_tick * scale), 1)
        at = bisect_right(onsets, onset)
        if ends[at] <= onset and (at == len(onsets) or onset + length <= onsets[at]):
            result.append(msgspec.structs.replace(note, onset_tick=onset, duration_tick=length))
    return tuple(result)


def _with_more(part: Part, notes: tuple[Note, ...]) -> Part:
    if not notes:
        return part
    ordered = sorted((*part.notes, *notes), key=lambda note: (note.onset_tick, note.pitch))
    return msgspec.structs.replace(part, notes=tuple(ordered))


# Players and corrections


def _with_players(
    project: Project,
    score: Score,
    parts: list[Part],
    places: Mapping[str, list[tuple[int, int]]],
    everywhere: Callable[[int], int],
    scale: Fraction,
    maps: Mapping[str, InstrumentMap],
) -> Project:
    known = {part.id for part in parts}
    corrections: dict[str, tuple[Correction, ...]] = {}
    staying: list[Player] = []
    for player in project.players:
        own = project.corrections.get(player.id, ())
        if player.part_id not in known and not own and player.id not in project.takes:
            continue
        staying.append(player)
        if own:
            here = places.get(player.part_id)
            place = _place_map(here, scale) if here else everywhere
            corrections[player.id] = tuple(moved(correction, {}, place, scale) for correction in own)
    kept = {player.part_id for player in staying}
    idle = [
        msgspec.structs.replace(part, notes=(), curves=())
        for part in project.score.parts
        if part.id in kept and part.id not in known
    ]
    whole = msgspec.structs.replace(score, title=project.score.title, parts=(*parts, *idle))
    ids = {player.id for player in staying}
    takes = {id: recorded for id, recorded in project.takes.items() if id in ids}
    scored = with_score(project, whole)
    danced = {
        dancer: tuple(moved(correction, {}, everywhere, scale) for correction in own)
        for dancer, own in project.dance_corrections.items()
    }
    result = replace(
        scored,
        players=promote_remaining(staying),
        corrections=corrections,
        takes=takes,
        dance_corrections=danced,
        audio=None if project.audio is None else with_places(project.audio, everywhere),
    )
    former = {part.id for part in project.score.parts}
    fresh = [part for part in parts if part.id not in former]
    return _with_new_players(result, fresh, maps) if fresh else result


def _with_new_players(project: Project, parts: Sequence[Part], maps: Mapping[str, InstrumentMap]) -> Project:
    """A player for every new part, cast as a new piece's are."""
    names = project.performer_names()
    playing = [maps[player.instrument_id] for player in project.players if player.instrument_id in maps]
    newcomers = []
    doubled = doubled_parts(project.score.parts, maps, project.score.tempo_map)
    players = {player.part_id: player.id for player in reversed(project.players)}
    ids = fresh_player_ids(project, len(parts))
    players |= {part.id: player_id for player_id, part in zip(ids, parts, strict=True)}
    for player_id, part in zip(ids, parts, strict=True):
        names.append(free_name(part.name, names))
        playing.append(maps[part.map_id])
        doubles = _musician(project, players.get(doubled.get(part.id, ""), ""))
        newcomers.append(newcomer(project, player_id, part, names[-1], playing, doubles))
    return with_newcomers(project, tuple(newcomers))


def _musician(project: Project, player_id: str) -> str:
    """Which musician's body a player has, by id; a new player has a new one."""
    known = next((player for player in project.players if player.id == player_id), None)
    return player_id if known is None else project.musician(known).id


def _place_map(pairs: Iterable[tuple[int, int]], scale: Fraction) -> Callable[[int], int]:
    """Where a tick of the old score is in the new one: as far from the last note before it that was found again as it
    was, but not beyond the next; before the first one it moves with that."""
    by_tick: dict[int, int] = {}
    for before, after in sorted(pairs):
        by_tick[before] = max(by_tick.get(before, after), after)
    olds = list(by_tick)
    # What one player's notes say may contradict another's by a little: time does not run backwards.
    news = np.maximum.accumulate(np.array(list(by_tick.values()), np.int64)).tolist() if olds else []

    def place(tick: int) -> int:
        if not olds:
            return _held(round(tick * scale))
        index = max(bisect_right(olds, tick) - 1, 0)
        to = news[index] + round((tick - olds[index]) * scale)
        if index + 1 < len(news) and tick >= olds[index]:
            to = min(to, news[index + 1])
        return _held(to)

    return place


def _held(tick: int) -> int:
    return min(max(tick, -LAST_TICK), LAST_TICK)
