"""A piece whose MIDI file has changed: the new notes come in, and what was done by hand stays with the music.

Parts are recognised by what they play, by name, track and instrument, notes by alignment (`app.project.alignment`). A
note found again keeps its id, and with it every correction about it; corrections at places of the score move with the
notes around them. A note that the user changed and the file did not stays as the user has it (one that was erased
stays erased); where both changed it the file's version is taken, and reported. What the user chose for players stays. A
part that is new gets a player; a player whose part is gone keeps it, as one that was made in the editor, and may be
removed (`app.project.edit.players.remove_players`). Parts made in the editor stay, and so do notes drawn into the
file's parts where they do not overlap what the file has there.

Dancers stay; what was corrected of their dances moves like other corrections at places of the score, and so do beats
pinned to the recording.

Corrections whose note is gone stay as they are and do nothing (`orphaned`), until they are given another note
(`reattached`) or taken back.

Messages (`UsageError`): ``reimport.no_note``, ``reimport.not_played``, ``piece.too_long``.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Literal, TypeAlias

import msgspec
import numpy as np

from app.errors import UsageError
from app.plan.corrections import Correction, kind
from app.project.alignment import AlignmentPart, align
from app.project.anchors import moved, note_of
from app.project.derived_decisions import derived_decisions, held_by_file, is_read
from app.project.doubling import doubled_parts
from app.project.edit.corrections import put, take_back
from app.project.edit.length import with_score
from app.project.edit.players import free_name, newcomer, with_newcomers
from app.project.file_curves import merged_curves, moved_curve
from app.project.file_timing import merged_timing, timing_of, with_timing
from app.project.ids import (
    MADE_PART,
    READ_NOTE,
    READ_PART,
    fresh_note_ids,
    fresh_part_ids,
    fresh_player_ids,
    is_made_here,
)
from app.project.imported import Place
from app.project.importing import score_of_rows
from app.project.limits import LAST_TICK
from app.project.model import Project, map_choices
from app.project.part_matching import matched_parts
from app.project.recording import with_places
from app.project.rereading import Reading, characters_of, read_as_decided
from app.score.model import Note, Part, Score, UnplayedPart
from app.score.parts import transposed
from app.score.read import read_contents
from instrument_maps.model import InstrumentMap

ReplacedKind: TypeAlias = Literal["tempo", "metres", "controllers"]


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
    new_players, gone_players : tuple of str
        Ids in the project: of new parts; of parts that the file does not have any more, which can be removed.
    new_unplayed : tuple of UnplayedPart
        Parts of the file that get no player and were not in it before, by name.
    orphans : tuple of Orphan
        Corrections that lost their note now or earlier.
    conflicts : tuple of Conflict
        In the order of the parts.
    replaced : tuple of {"tempo", "metres", "controllers"}
        Edited here and in the file: the file's version is taken.
    """

    project: Project
    parts: tuple[PartMatch, ...]
    added: tuple[str, ...]
    removed: tuple[str, ...]
    new_players: tuple[str, ...]
    gone_players: tuple[str, ...]
    orphans: tuple[Orphan, ...]
    conflicts: tuple[Conflict, ...]
    replaced: tuple[ReplacedKind, ...] = ()
    new_unplayed: tuple[UnplayedPart, ...] = ()


def reimported(project: Project, path: Path, maps: Mapping[str, InstrumentMap]) -> Reimport:
    """Read a MIDI file, as it was decided when the project was made from an earlier version of it, and let it take the
    place of the project's score. Raises as `app.score.read.read_contents`."""
    decisions = project.imported
    contents = read_contents(path, encoding=None if decisions is None else decisions.encoding)
    choices = map_choices(maps.values())
    if decisions is None:
        decisions = derived_decisions(project, contents, choices)
    played_on = {part.place: part.map_id for part in reversed(project.score.parts) if is_read(project, part)}
    reading = read_as_decided(contents, decisions, maps, choices, played_on)
    return reimport(project, score_of_rows(reading.contents, reading.rows, maps), maps, str(path), reading)


def reimport(
    project: Project,
    score: Score,
    maps: Mapping[str, InstrumentMap],
    source: str | None = None,
    reading: Reading | None = None,
) -> Reimport:
    """Let the score that a file holds now take the place of the project's.

    The title stays, and so do tempo, metres and controllers that were edited here and not in the file; markers,
    percussion and everything else are the file's.

    Parameters
    ----------
    maps : mapping of str to InstrumentMap
        By id; every part of the new score names one of them.
    source : str, optional
        Absolute path of the file.
    reading : Reading, optional
        Of the file: the decisions that the score was read by.
    """
    scale = Fraction(score.ticks_per_quarter, project.score.ticks_per_quarter)
    found = _found_again(project, score, {} if reading is None else reading.places, scale)
    everywhere = _place_map(found.pairs_of_ticks, scale)
    timing = merged_timing(project, score, everywhere, scale, found.is_unchanged)
    parts, replaced = _with_curves(project, found, everywhere, scale)
    part_of = _add_others(project, parts, found.others, everywhere, scale)
    result = _with_players(project, with_timing(score, timing.timing), parts, part_of, found, everywhere, scale)
    former_ids = {part.id for part in project.score.parts} | set(part_of.values())
    fresh = [part for part in parts if part.id not in former_ids]
    if fresh:
        result = _with_new_players(result, fresh, maps, {} if reading is None else characters_of(reading))
    result = replace(
        result,
        read_notes=found.read_notes,
        read_curves={part.id: part.curves for part in found.parts},
        read_timing=timing_of(score),
        source=project.source if source is None else source,
        imported=project.imported if reading is None else reading.decisions,
    )
    # What is only known better than before is nothing new.
    fields = ("imported", "read_curves", "read_timing", *(("read_notes",) if not project.read_notes else ()))
    known: dict[str, Any] = {field: getattr(project, field) for field in fields}
    if project.imported is None:
        # Derived decisions may make the reader warn of other things.
        known["score"] = msgspec.structs.replace(result.score, warnings=project.score.warnings)
    same = result == project or replace(result, **known) == project
    alive = {note.id for part in parts for note in part.notes}
    before_ids = {player.id for player in project.players}
    gone = {id for id, now in part_of.items() if id != now}
    return Reimport(
        project=project if same else result,
        parts=found.matches,
        added=found.added,
        removed=tuple(note.id for part in project.score.parts for note in part.notes if note.id not in alive),
        new_players=tuple(player.id for player in result.players if player.id not in before_ids),
        gone_players=tuple(player.id for player in project.players if player.part_id in gone),
        orphans=orphaned(result),
        conflicts=found.conflicts,
        replaced=(*timing.replaced, *replaced),
        new_unplayed=_new_unplayed(project.score, score),
    )


def _new_unplayed(before: Score, now: Score) -> tuple[UnplayedPart, ...]:
    known = Counter(part.name for part in before.unplayed)
    found = []
    for part in now.unplayed:
        if known[part.name]:
            known[part.name] -= 1
        else:
            found.append(part)
    return tuple(found)


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


@dataclass(frozen=True)
class _Found:
    """The parts of the file as those of the project.

    Attributes
    ----------
    parts : tuple of Part
        With the ids of the project.
    former : tuple of (Part or None)
        What each of them was; None: it is new.
    others : tuple of Part
        The project's parts that the file does not have.
    places : mapping of str to list of (int, int)
        Of the notes that were found again, by part id: former and present tick.
    added : tuple of str
        Ids of new notes.
    still : bool
        No note has moved.
    """

    parts: tuple[Part, ...]
    former: tuple[Part | None, ...]
    others: tuple[Part, ...]
    matches: tuple[PartMatch, ...]
    conflicts: tuple[Conflict, ...]
    read_notes: dict[str, dict[str, Note]]
    places: dict[str, list[tuple[int, int]]]
    added: tuple[str, ...]
    still: bool

    @property
    def is_unchanged(self) -> bool:
        """Return whether the file has the notes that it had, where they were."""
        return self.still and not (self.added or self.conflicts) and not any(match.removed for match in self.matches)

    @property
    def pairs_of_ticks(self) -> list[tuple[int, int]]:
        """Former and present ticks of all parts; none where nothing has moved."""
        return [] if self.still else [pair for own in self.places.values() for pair in own]


def _found_again(project: Project, score: Score, places_now: Mapping[Place, Place], scale: Fraction) -> _Found:
    """Find the parts and notes of the project in a score that was read.

    Parameters
    ----------
    places_now : mapping of Place to Place
        Where tracks are that are recognised, by where they were.
    """
    old = project.score
    hints = [places_now.get(part.place) if is_read(project, part) else None for part in old.parts]
    partners = matched_parts(old, score, hints)
    former_of = {new: former for former, new in partners}
    score = _as_read(score, old, former_of)
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
        before = old.parts[former]
        was = held_by_file(project, before)
        read = project.read_notes.get(before.id) or {note.id: note for note in was}
        pairs = _same_notes([index for index, note in enumerate(was) if note.id in read], was, part.notes, scale)
        if pairs is None:
            lines = (was, old.ticks_per_quarter), (part.notes, score.ticks_per_quarter)
            pairs = [(int(one), int(new)) for one, new in align(*(AlignmentPart.of(*line) for line in lines))]
        kept = {new: was[one].id for one, new in pairs}
        ids = [kept[number] if number in kept else next(note_ids) for number in range(len(part.notes))]
        renamed = _renamed(part, before.id, ids)
        read_notes[before.id] = {note.id: note for note in renamed.notes}
        merged = _merged(before, was, renamed, pairs, scale)
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
    again = set(former_of.values())
    return _Found(
        parts=tuple(parts),
        former=tuple(old.parts[former_of[index]] if index in former_of else None for index in range(len(parts))),
        others=tuple(part for index, part in enumerate(old.parts) if index not in again),
        matches=tuple(matches),
        conflicts=tuple(conflicts),
        read_notes=read_notes,
        places=places,
        added=tuple(added),
        still=scale == 1 and all(tick == now for own in places.values() for tick, now in own),
    )


def _same_notes(
    places: Sequence[int], was: Sequence[Note], now: Sequence[Note], scale: Fraction
) -> list[tuple[int, int]] | None:
    """The pairs of notes of a line that is the same as before, or begins earlier or later as a whole; None: it is not.

    Parameters
    ----------
    places : sequence of int
        Of those of the former notes that the file had.
    """
    if len(places) != len(now):
        return None
    shift = now[0].onset_tick - round(was[places[0]].onset_tick * scale) if now else 0
    former = [
        (round(note.onset_tick * scale) + shift, note.pitch, max(round(note.duration_tick * scale), 1), place)
        for note, place in ((was[place], place) for place in places)
    ]
    present = [(note.onset_tick, note.pitch, note.duration_tick, place) for place, note in enumerate(now)]
    pairs = list(zip(sorted(former), sorted(present), strict=True))
    if any(one[:3] != other[:3] for one, other in pairs):
        return None
    return [(one[3], other[3]) for one, other in pairs]


def _with_curves(
    project: Project, found: _Found, everywhere: Callable[[int], int], scale: Fraction
) -> tuple[list[Part], tuple[ReplacedKind, ...]]:
    """The parts found again, with the controllers that were edited here and not in the file."""
    parts = list(found.parts)
    replaced = False
    for index, (part, before) in enumerate(zip(found.parts, found.former, strict=True)):
        if before is None:
            continue
        read = project.read_curves.get(part.id, before.curves)
        if project.read_timing is None and found.is_unchanged:
            # An older program did not keep what the file had; where its notes are as they were, it is what it has now.
            read = part.curves
        place = everywhere if found.still else _place_map(found.places[part.id], scale)
        merged = merged_curves(before.curves, read, part.curves, place)
        parts[index] = msgspec.structs.replace(part, curves=merged.curves)
        replaced = replaced or merged.replaced
    return parts, ("controllers",) if replaced else ()


def _as_read(score: Score, old: Score, former_of: Mapping[int, int]) -> Score:
    """The score with the parts that were found again transposed as they were, and on the map that they were read for
    where nothing else is said."""
    parts = list(score.parts)
    for new, former in former_of.items():
        before, part = old.parts[former], parts[new]
        shift = before.transposed_semitones
        notes = transposed(part.notes, shift - part.transposed_semitones)
        map_id = before.map_id if part.instrument == before.instrument else part.map_id
        parts[new] = msgspec.structs.replace(part, notes=notes, transposed_semitones=shift, map_id=map_id)
    return msgspec.structs.replace(score, parts=tuple(parts))


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


def _add_others(
    project: Project, parts: list[Part], others: Sequence[Part], place: Callable[[int], int], scale: Fraction
) -> dict[str, str]:
    """Add the parts that the file does not have: those made here, and those of players whose part is gone, which are
    parts made here from now on. Returns the new id of each."""
    played = {player.part_id for player in project.players}
    ids = iter(fresh_part_ids(project, len(others), MADE_PART))
    result = {}
    for part in others:
        read = is_read(project, part)
        if read and part.id not in played:
            continue
        result[part.id] = next(ids) if read else part.id
        parts.append(_moved_part(part, result[part.id], place, scale))
    return result


def _moved_part(part: Part, id: str, place: Callable[[int], int], scale: Fraction) -> Part:
    """A part that the file does not have, where its music is now."""
    notes = [
        msgspec.structs.replace(
            note,
            onset_tick=max(place(note.onset_tick), 0),
            duration_tick=max(round(note.duration_tick * scale), 1),
        )
        for note in part.notes
    ]
    ordered = tuple(sorted(notes, key=lambda note: (note.onset_tick, note.pitch)))
    curves = tuple(moved_curve(curve, place) for curve in part.curves)
    muted = tuple(sorted((max(place(start), 0), max(place(end), 0)) for start, end in part.muted))
    return msgspec.structs.replace(part, id=id, notes=ordered, curves=curves, muted=muted)


def _with_players(
    project: Project,
    score: Score,
    parts: list[Part],
    part_of: Mapping[str, str],
    found: _Found,
    everywhere: Callable[[int], int],
    scale: Fraction,
) -> Project:
    """The project with these parts and the players it had, their corrections and takes moved with the music.

    Parameters
    ----------
    part_of : mapping of str to str
        The ids of parts that the file does not have, by their former ones.
    """
    corrections: dict[str, tuple[Correction, ...]] = {}
    for player in project.players:
        own = project.corrections.get(player.id, ())
        if own:
            here = None if found.still else found.places.get(player.part_id)
            place = _place_map(here, scale) if here else everywhere
            corrections[player.id] = tuple(moved(correction, {}, place, scale) for correction in own)
    whole = msgspec.structs.replace(score, title=project.score.title, parts=tuple(parts))
    danced = {
        dancer: tuple(moved(correction, {}, everywhere, scale) for correction in own)
        for dancer, own in project.dance_corrections.items()
    }
    return replace(
        with_score(project, whole),
        players=tuple(
            msgspec.structs.replace(player, part_id=part_of.get(player.part_id, player.part_id))
            for player in project.players
        ),
        corrections=corrections,
        dance_corrections=danced,
        audio=project.audio if project.audio is None or found.still else with_places(project.audio, everywhere),
    )


def _with_new_players(
    project: Project,
    parts: Sequence[Part],
    maps: Mapping[str, InstrumentMap],
    characters: Mapping[Place, str],
) -> Project:
    """A player for every new part, cast as a new piece's are; ``characters`` are those chosen for some."""
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
        player = newcomer(project, player_id, part, names[-1], playing, doubles)
        character = characters.get(part.place, player.character_id)
        newcomers.append(msgspec.structs.replace(player, character_id=character))
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
