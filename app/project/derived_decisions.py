"""Reconstructs import decisions that were not stored, in projects of version 13 and older, from the parts and the
unplayed parts of the project.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

import msgspec

from app.project.ids import MADE_PART, is_made_here
from app.project.import_decisions import ImportDecisions, Place, RowDecision, TrackMark, mark_of, melody_of
from app.project.melody_likeness import shares, sketch, turns
from app.project.model import Project
from app.project.part_matching import turns_of
from app.project.rereading import recognised_streams
from app.score.assignments import PartAssignment, Split
from app.score.contents import PieceContents, assigned_score
from app.score.instrument_choice import MapChoice
from app.score.model import Note, Part
from app.score.parts import stream_name
from app.score.track_channel import TrackChannel

_FILE_NOTE = re.compile(r"([1-9]\d*):[1-9]\d*", re.ASCII)
_SPLITS: tuple[Split, ...] = ("sustained", "never", "every")
_SAME = 0.9999
_COVERED = 0.9


def is_read(project: Project, part: Part) -> bool:
    """Return whether a part was read from the MIDI file, not made in the editor."""
    return part.id in project.read_notes or not part.id.startswith(MADE_PART)


def held_by_file(project: Project, part: Part) -> tuple[Note, ...]:
    """Return the notes of a part as they are in the MIDI file. Notes that the file lacks, or whose version there is
    unknown, are returned as in the project.
    """
    read = project.read_notes.get(part.id)
    if not read:
        return part.notes
    more = (note for note in part.notes if note.id not in read)
    return tuple(sorted((*read.values(), *more), key=lambda note: (note.onset_tick, note.pitch)))


def derived_decisions(project: Project, contents: PieceContents, choices: Sequence[MapChoice]) -> ImportDecisions:
    """Return the import decisions that explain a project's parts.

    Parameters
    ----------
    contents : PieceContents
        Present contents of the project's MIDI file, which show how tracks were split.
    """
    groups: dict[Place, list[Part]] = {}
    for part in project.score.parts:
        if is_read(project, part):
            groups.setdefault(part.place, []).append(part)
    quarter = contents.tempo_map.ticks_per_quarter
    owned = _owned(project, groups, contents)
    marks = {place: [mark_of(contents.channels[one], quarter) for one in own] for place, own in owned.items()}
    free = [index for index in range(len(contents.channels)) if not any(index in own for own in owned.values())]
    rest = {place: list(_marks(project, parts)) for place, parts in groups.items() if place not in owned}
    channels = [contents.channels[index] for index in free]
    found = iter(
        recognised_streams(
            [mark for own in rest.values() for mark in own], channels, [melody_of(one, quarter) for one in channels]
        )
    )
    for place, own in rest.items():
        marks[place] = own
        there = [index for index in (next(found) for _ in own) if index is not None]
        owned[place] = [free[index] for index in there]
    rows = [
        _row(project, parts, marks[place], owned[place], contents, choices, place not in rest)
        for place, parts in groups.items()
    ]
    played = {index for own in owned.values() for index in own}
    silent = [index for index in range(len(contents.channels)) if index not in played]
    rows += [
        RowDecision((mark_of(contents.channels[index], quarter),), requested=False)
        for index in _left_out(project, contents.channels, silent)
    ]
    return ImportDecisions(None, tuple(rows))


def _owned(project: Project, groups: Mapping[Place, Sequence[Part]], contents: PieceContents) -> dict[Place, list[int]]:
    """Return the channels from which most notes of each group of parts were read, identified by note ids if the file is
    largely unchanged.
    """
    old, new = project.score.ticks_per_quarter, contents.tempo_map.ticks_per_quarter
    owners = {
        (note.id, note.onset_tick * new, note.pitch - part.transposed_semitones): place
        for place, parts in groups.items()
        for part in parts
        for note in held_by_file(project, part)
        if not is_made_here(note.id)
    }
    result: dict[Place, list[int]] = {}
    for index, channel in enumerate(contents.channels):
        ids = (f"{channel.track + 1}:{number}" for number in channel.numbers)
        notes = zip(ids, (onset * old for onset in channel.onset_ticks), channel.pitches, strict=True)
        counted = Counter(owners[note] for note in notes if note in owners)
        for place, count in counted.most_common(1):
            if 2 * count > len(channel.onset_ticks):
                result.setdefault(place, []).append(index)
    whole = {place: {key[1:] for key, owner in owners.items() if owner == place} for place in result}
    for place, own in list(result.items()):
        there = {
            (onset * old, pitch)
            for index in own
            for onset, pitch in zip(contents.channels[index].onset_ticks, contents.channels[index].pitches, strict=True)
        }
        # If one of several merged tracks is unchanged, that does not show where the others are.
        if len(whole[place] & there) < _COVERED * len(whole[place]):
            del result[place]
        own.sort(key=lambda index: contents.channels[index].place != place)
    return result


def _marks(project: Project, parts: Sequence[Part]) -> Iterator[TrackMark]:
    """Yield marks that identify the tracks of a group of parts, as far as the parts still show them."""
    first = parts[0]
    held = [note for part in parts for note in held_by_file(project, part)]
    # Players in unison have the same notes.
    once = {(note.onset_tick, note.pitch): note for note in held if not is_made_here(note.id)}
    notes = [once[place] for place in sorted(once)]
    by_track: dict[int, list[Note]] = {first.track: []}
    for note in notes:
        said = _FILE_NOTE.fullmatch(note.id)
        by_track.setdefault(int(said[1]) - 1 if said else first.track, []).append(note)
    for track, own in by_track.items():
        if not own:
            continue
        melody = sketch(
            turns([note.onset_tick for note in own], [note.pitch for note in own], project.score.ticks_per_quarter)
        )
        name = first.name if track == first.track else ""
        yield TrackMark(track, *first.place[1:], name, "", first.program, (), name, melody)


def _row(
    project: Project,
    parts: Sequence[Part],
    marks: Sequence[TrackMark],
    channels: Sequence[int],
    contents: PieceContents,
    choices: Sequence[MapChoice],
    unchanged: bool,
) -> RowDecision:
    """Return the import decision by which the given channels of a file become the given parts.

    Parameters
    ----------
    marks : sequence of TrackMark
        Marks that identify the tracks of the parts.
    unchanged : bool
        Whether the file is unchanged since its notes were read.
    """
    first, *_ = parts
    by_id = {choice.map_id: choice for choice in choices}
    own = by_id.get(first.map_id)
    written = own is not None and first.transposed_semitones == -own.transposition_semitones != 0
    decision = RowDecision(tuple(marks), written=written)
    if not channels:
        return msgspec.structs.replace(decision, map_id=first.map_id)
    mine = msgspec.structs.replace(contents, channels=tuple(contents.channels[index] for index in channels))
    asked = PartAssignment(tuple(range(len(channels))), written=written, solos=False)
    read = assigned_score(mine, [asked], choices).parts
    if own is not None and (not read or read[0].map_id != own.map_id):
        asked = msgspec.structs.replace(asked, map_id=own.map_id)
        decision = msgspec.structs.replace(decision, map_id=own.map_id)
    most = -1.0
    for split in _SPLITS:
        read = assigned_score(mine, [msgspec.structs.replace(asked, split=split)], choices).parts
        alike = _alike(project, parts, read, contents.tempo_map.ticks_per_quarter)
        if alike > most:
            most = alike
            name = first.name if unchanged and read and read[0].name != first.name else ""
            decision = msgspec.structs.replace(decision, split=split, name=name)
        if most >= _SAME:
            break
    return decision


def _alike(project: Project, old: Sequence[Part], new: Sequence[Part], quarter: int) -> float:
    """Return the similarity of two readings of some channels, 0..1: mainly by melody, then by note lengths."""
    if not new:
        return 0.0
    before = project.score.ticks_per_quarter
    former = [msgspec.structs.replace(part, notes=held_by_file(project, part)) for part in old]
    both = shares([turns_of(part, before) for part in former], [turns_of(part, quarter) for part in new])
    pairs = list(zip(former, new, strict=False))
    melodies = float(sum(both[index, index] for index in range(len(pairs))))
    lengths = sum(_same_lengths(one, other, before, quarter) for one, other in pairs)
    return (0.9 * melodies + 0.1 * lengths) / max(len(old), len(new))


def _same_lengths(one: Part, other: Part, one_quarter: int, other_quarter: int) -> float:
    """Return the share 0..1 of notes with equal length in two parts; 0 if these have different numbers of notes. A
    quarter has ``one_quarter`` and ``other_quarter`` ticks.
    """
    if len(one.notes) != len(other.notes) or not one.notes:
        return 0.0
    lengths = zip(one.notes, other.notes, strict=True)
    same = sum(note.duration_tick * other_quarter == now.duration_tick * one_quarter for note, now in lengths)
    return same / len(one.notes)


def _left_out(project: Project, channels: Sequence[TrackChannel], silent: Sequence[int]) -> Iterator[int]:
    """Yield the channels without a part that the project lists as unplayed."""
    unplayed = list(project.score.unplayed)
    for index in silent:
        name, count = stream_name(channels[index]), len(channels[index].pitches)
        # The name or the notes may have changed.
        like = [part for part in unplayed if part.name == name] or [
            part for part in unplayed if part.note_count == count
        ]
        if like:
            unplayed.remove(like[0])
            yield index
