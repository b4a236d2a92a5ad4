"""Matching of the parts and notes of a re-read MIDI file with those of the project.

A matched note keeps its id; if both the project and the file changed it, the file's version is used.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import msgspec
import numpy as np

from app.project.alignment import AlignmentPart, align
from app.project.derived_decisions import held_by_file, is_read
from app.project.ids import MADE_PART, READ_NOTE, READ_PART, fresh_note_ids, fresh_part_ids, is_made_here
from app.project.import_decisions import Place
from app.project.model import Project
from app.project.moved_ticks import place_map
from app.project.part_matching import matched_parts
from app.score.marks import renamed_marks
from app.score.model import Note, Part, Score, transposed


@dataclass(frozen=True)
class PartMatch:
    """A part of the project that was found again in the re-read file.

    Attributes
    ----------
    part_id : str
        Id of the part, which it keeps.
    kept, added, removed : int
        Numbers of notes that were kept, added and removed.
    by_hand : int
        Number of notes whose change by hand is kept.
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
    """A note changed both by the user and in the file; the file's version is used.

    Attributes
    ----------
    read : Note
        The note in the file when last read.
    by_hand : Note or None
        The user's version; None if deleted.
    file : Note or None
        The note in the file now; None if deleted.
    """

    part_id: str
    note_id: str
    read: Note
    by_hand: Note | None
    file: Note | None


@dataclass(frozen=True)
class FoundParts:
    """The parts of the file matched with those of the project.

    Attributes
    ----------
    parts : tuple of Part
        Parts as they will be in the project, with its ids.
    former : tuple of (Part or None)
        Previous version of each part; None if it is new or kept.
    others : tuple of Part
        Parts of the project that the file lacks.
    places : mapping of str to list of (int, int)
        Previous and new tick of each matched note, by part id.
    added : tuple of str
        Ids of new notes.
    still : bool
        Whether no note has moved.
    kept : frozenset of str
        Ids of parts that stay unchanged whatever the file has (`app.project.kept_parts`).
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
    kept: frozenset[str] = frozenset()

    @property
    def is_unchanged(self) -> bool:
        """Return whether the file has the same notes at the same places as before."""
        return self.still and not (self.added or self.conflicts) and not any(match.removed for match in self.matches)

    @property
    def pairs_of_ticks(self) -> list[tuple[int, int]]:
        """Return all pairs of previous and new tick of matched notes in all parts; empty if nothing moved."""
        if self.still:
            return []
        return [pair for id, own in self.places.items() if id not in self.kept for pair in own]


def found_again(project: Project, score: Score, places_now: Mapping[Place, Place], scale: Fraction) -> FoundParts:
    """Match the parts and notes of the project with those of a score that was read.

    Parameters
    ----------
    places_now : mapping of Place to Place
        Present place of each recognised track, by its previous one.
    scale : Fraction
        Ticks of the file per tick of the project.
    """
    old = project.score
    hints = [places_now.get(part.place) if is_read(project, part) else None for part in old.parts]
    partners = matched_parts(old, score, hints)
    former_of = {new: former for former, new in partners}
    score = _as_read(score, old, former_of)
    part_ids = iter(fresh_part_ids(project, len(score.parts), READ_PART))
    note_ids = iter(fresh_note_ids(project, sum(len(part.notes) for part in score.parts), READ_NOTE))
    quarters = old.ticks_per_quarter, score.ticks_per_quarter
    found = [
        _found_part(project, old.parts[former_of[index]], part, scale, quarters, note_ids)
        if index in former_of
        else _new_part(part, next(part_ids), note_ids)
        for index, part in enumerate(score.parts)
    ]
    again = set(former_of.values())
    return FoundParts(
        parts=tuple(one.part for one in found),
        former=tuple(one.former for one in found),
        others=tuple(part for index, part in enumerate(old.parts) if index not in again),
        matches=tuple(one.match for one in found if one.match is not None),
        conflicts=tuple(conflict for one in found for conflict in one.conflicts),
        read_notes={one.part.id: one.read for one in found},
        places={one.part.id: [*one.places] for one in found if one.former is not None},
        added=tuple(id for one in found for id in one.added),
        still=scale == 1 and all(tick == now for one in found for tick, now in one.places),
    )


@dataclass(frozen=True)
class _FoundPart:
    """One part of the project matched with a part of a re-read file, with the fields of `FoundParts`; ``read`` has its
    notes in the file by id."""

    part: Part
    read: dict[str, Note]
    added: list[str]
    former: Part | None = None
    match: PartMatch | None = None
    conflicts: Sequence[Conflict] = ()
    places: Sequence[tuple[int, int]] = ()


def _new_part(part: Part, id: str, note_ids: Iterator[str]) -> _FoundPart:
    ids = [next(note_ids) for _ in part.notes]
    renamed = _renamed(part, id, ids)
    return _FoundPart(renamed, {note.id: note for note in renamed.notes}, ids)


def _found_part(
    project: Project, before: Part, part: Part, scale: Fraction, quarters: tuple[int, int], note_ids: Iterator[str]
) -> _FoundPart:
    """Match one part and carry over its changes by hand.

    Parameters
    ----------
    quarters : (int, int)
        Ticks of a quarter in the project and in the file.
    """
    was = held_by_file(project, before)
    read = project.read_notes.get(before.id) or {note.id: note for note in was}
    same = _same_notes([index for index, note in enumerate(was) if note.id in read], was, part.notes, scale)
    if same is None:
        lines = zip((was, part.notes), quarters, strict=True)
        pairs = [(int(one), int(new)) for one, new in align(*(AlignmentPart.of(*line) for line in lines))]
    else:
        pairs = same
    kept = {new: was[one].id for one, new in pairs}
    ids = [kept[number] if number in kept else next(note_ids) for number in range(len(part.notes))]
    renamed = _renamed(part, before.id, ids)
    merged = _merged(before, was, renamed, pairs, scale, as_a_whole=same is not None)
    known = {note.id: note for note in before.notes}
    places = [(known[note.id].onset_tick, note.onset_tick) for note in merged.part.notes if note.id in known]
    drawn = _drawn(before, frozenset(kept.values()), place_map(places, scale), scale, merged.part)
    came = [note.id for note in merged.part.notes if note.id not in known]
    stayed = len(places) + len(drawn)
    lost = len(before.notes) - stayed
    return _FoundPart(
        part=_with_more(merged.part, drawn),
        read={note.id: note for note in renamed.notes},
        added=came,
        former=before,
        match=PartMatch(before.id, before.name, part.name, stayed, len(came), lost, merged.by_hand),
        conflicts=merged.conflicts,
        places=places,
    )


def _same_notes(
    places: Sequence[int], was: Sequence[Note], now: Sequence[Note], scale: Fraction
) -> list[tuple[int, int]] | None:
    """Return the pairs of indices of notes in a part that is unchanged or shifted as a whole; None if it is not.

    Parameters
    ----------
    places : sequence of int
        Indices in ``was`` of those notes that were in the file.
    was, now : sequence of Note
        Notes of the part in the project and in the file.
    scale : Fraction
        Ticks of the file per tick of the project.
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


def _as_read(score: Score, old: Score, former_of: Mapping[int, int]) -> Score:
    """Return the score with matched parts transposed as in the project; they keep their instrument map if the file
    still names the same instrument.
    """
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
    """A part as read from the file, with those changes of the user that still apply, their number, and the
    conflicts."""

    part: Part
    by_hand: int
    conflicts: tuple[Conflict, ...]


def _merged(
    before: Part,
    was: Sequence[Note],
    part: Part,
    pairs: Sequence[tuple[int, int]],
    scale: Fraction,
    *,
    as_a_whole: bool,
) -> _Merged:
    """Merge each note of three versions: the user's is used if the file did not change it, else the file's.

    Parameters
    ----------
    before : Part
        The part in the project.
    was : sequence of Note
        The notes in the file when last read.
    part : Part
        The part in the file now, with ids of the project.
    pairs : sequence of (int, int)
        Indices of matching notes in ``was`` and in the part.
    as_a_whole : bool
        Whether the part is unchanged or shifted as a whole, so that no single note moved.
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
        still = as_a_whole or distances[place] in beside or distances[place] == 0
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
    ids = {note.id: id for note, id in zip(part.notes, note_ids, strict=True)}
    return msgspec.structs.replace(part, id=part_id, notes=notes, marks=renamed_marks(part.marks, ids))


def _drawn(
    before: Part, kept: frozenset[str], place: Callable[[int], int], scale: Fraction, part: Part
) -> tuple[Note, ...]:
    """Return notes that the user added to a part, at their new ticks, as far as they fit between the file's notes.

    Parameters
    ----------
    before, part : Part
        The part in the project and in the file.
    kept : frozenset of str
        Ids of notes that are in the part already.
    place : callable
        Function from old to new ticks.
    scale : Fraction
        Ticks of the file per tick of the project, for lengths.
    """
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
