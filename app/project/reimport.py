"""Update of a piece whose MIDI file has changed, keeping changes made by hand.

Parts are matched by music, name, track and instrument, notes by alignment (`app.project.alignment`). A matched note
keeps its id and so its corrections; corrections at ticks move with the notes around them. A note changed only by the
user keeps that change (a deleted one stays deleted); if both changed it, the file's version is used and reported.
Players' settings stay. A new part gets a player. A player whose part disappeared keeps it as a part of the project and
may be removed (`app.project.edit.players.remove_players`). Parts made in the editor stay, and so do notes added to the
file's parts if they do not overlap the file's notes.

Dancers stay; corrections of their dances and pinned beats move like other corrections at ticks.

Chosen parts may be kept unchanged (`Reimport.keeping`); the file's version is offered again next time.

Corrections whose note disappeared stay without effect (`app.project.orphans`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Literal, TypeAlias

import msgspec

from app.errors import Progress, StopRequested, raise_if_stopped
from app.plan.by_hand.corrections import Correction
from app.project.anchors import moved_correction
from app.project.derived_decisions import derived_decisions, is_read
from app.project.doubling import doubled_parts
from app.project.edit.length import with_score
from app.project.edit.players import free_name, newcomer, with_newcomers
from app.project.file_curves import merged_curves
from app.project.file_timing import merged_timing, timing_of, with_timing
from app.project.found_parts import Conflict, FoundParts, PartMatch, found_again
from app.project.ids import (
    MADE_PART,
    fresh_part_ids,
    fresh_player_ids,
)
from app.project.ignored_problems import moved_ignored
from app.project.import_decisions import Place
from app.project.importing import score_of_rows
from app.project.kept_parts import keeping, moved_part, read_curves_of
from app.project.model import Project, map_choices
from app.project.moved_ticks import place_map
from app.project.orphans import Orphan, orphaned
from app.project.performers import Player
from app.project.recording import with_places
from app.project.rereading import MidiReading, characters_of, read_as_decided
from app.score.model import Part, Score, UnplayedPart
from app.score.read import read_contents
from app.score.stated_timing import Assumed
from instrument_maps.model import InstrumentMap

ReplacedKind: TypeAlias = Literal["tempo", "metres", "controllers"]


@dataclass(frozen=True)
class Reimport:
    """Result of a re-import.

    Attributes
    ----------
    project : Project
        The updated project; the same object if the file changes nothing.
    added, removed : tuple of str
        Ids of added and of removed notes.
    new_players, gone_players : tuple of str
        Ids of players of new parts, and of players whose part disappeared and who may be removed.
    new_unplayed : tuple of UnplayedPart
        New parts of the file without a player, by name.
    orphans : tuple of Orphan
        All corrections whose note no longer exists, also from before.
    conflicts : tuple of Conflict
        Notes changed both by the user and in the file, in the order of the parts.
    replaced : tuple of {"tempo", "metres", "controllers"}
        Items edited both in the project and in the file; the file's version is used.
    keeping : callable
        Function that returns the same re-import with parts of given ids kept unchanged, and new ones among them left
        out.
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
    keeping: Callable[[Collection[str]], Reimport] = field(kw_only=True, compare=False, repr=False)


def reimported(
    project: Project,
    path: Path,
    maps: Mapping[str, InstrumentMap],
    progress: Progress = lambda share: None,
    stop_requested: StopRequested = lambda: False,
) -> Reimport:
    """Read a MIDI file with the decisions of its first import, and replace the project's score by it.

    Raises the errors of `app.score.read.read_contents`, and Cancelled once ``stop_requested``, called between steps,
    returns True.
    """
    decisions = project.imported
    apart = {(part.track, part.channel) for part in project.score.parts}
    apart.update((mark.track, mark.channel) for row in (decisions.rows if decisions else ()) for mark in row.tracks)
    timing = project.read_timing or timing_of(project.score)
    assumed = Assumed(timing.metres, timing.pickup_ticks, timing.tempo_map.ticks_per_quarter)
    encoding = None if decisions is None else decisions.encoding
    contents = read_contents(path, encoding=encoding, apart=apart, assumed=assumed)
    choices = map_choices(maps.values())
    progress(0.15)
    raise_if_stopped(stop_requested)
    if decisions is None:
        decisions = derived_decisions(project, contents, choices)
    raise_if_stopped(stop_requested)
    played_on = {part.place: part.map_id for part in reversed(project.score.parts) if is_read(project, part)}
    reading = read_as_decided(contents, decisions, maps, choices, played_on)
    progress(0.3)
    score = score_of_rows(reading.contents, reading.rows, maps, stop_requested)
    progress(0.45)
    return reimport(project, score, maps, str(path), reading)


def reimport(
    project: Project,
    score: Score,
    maps: Mapping[str, InstrumentMap],
    source: str | None = None,
    reading: MidiReading | None = None,
) -> Reimport:
    """Replace the project's score by the current score of its file.

    The title stays, and so do tempo, metres and controllers edited only in the project; everything else comes from the
    file.

    Parameters
    ----------
    maps : mapping of str to InstrumentMap
        Maps by id, including the map of every part of the new score.
    source : str, optional
        Absolute path of the file.
    reading : MidiReading, optional
        The file with the decisions by which the score was read.
    """
    scale = Fraction(score.ticks_per_quarter, project.score.ticks_per_quarter)
    found = found_again(project, score, {} if reading is None else reading.places, scale)
    return _outcome(project, found, score, maps, source, reading)


def _outcome(
    project: Project,
    found: FoundParts,
    score: Score,
    maps: Mapping[str, InstrumentMap],
    source: str | None,
    reading: MidiReading | None,
) -> Reimport:
    """Return the project after a re-import, from the parts matched in the file; parameters as in `reimport`."""
    scale = Fraction(score.ticks_per_quarter, project.score.ticks_per_quarter)
    everywhere = place_map(found.pairs_of_ticks, scale)
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
        read_curves=read_curves_of(project, found, scale),
        read_timing=timing_of(score),
        source=project.source if source is None else source,
        imported=project.imported if reading is None else reading.decisions,
    )
    alive = {note.id for part in parts for note in part.notes}
    before_ids = {player.id for player in project.players}
    gone = {id for id, now in part_of.items() if id != now}
    return Reimport(
        project=project if _says_nothing_new(project, result) else result,
        parts=found.matches,
        added=found.added,
        removed=tuple(note.id for part in project.score.parts for note in part.notes if note.id not in alive),
        new_players=tuple(player.id for player in result.players if player.id not in before_ids),
        gone_players=tuple(player.id for player in project.players if player.part_id in gone),
        orphans=orphaned(result),
        conflicts=found.conflicts,
        replaced=(*timing.replaced, *replaced),
        new_unplayed=_new_unplayed(project.score, score),
        keeping=lambda ids: _outcome(project, keeping(found, project, ids, scale), score, maps, source, reading),
    )


def _says_nothing_new(project: Project, result: Project) -> bool:
    """Return whether a re-read file left the project unchanged, apart from facts about the file that were not stored
    before.
    """
    fields = ("imported", "read_curves", "read_timing", *(("read_notes",) if not project.read_notes else ()))
    known: dict[str, Any] = {field: getattr(project, field) for field in fields}
    if project.imported is None:
        # Derived decisions may lead to other warnings.
        known["score"] = msgspec.structs.replace(result.score, warnings=project.score.warnings)
    return result == project or replace(result, **known) == project


def _new_unplayed(before: Score, now: Score) -> tuple[UnplayedPart, ...]:
    known = Counter(part.name for part in before.unplayed)
    found = []
    for part in now.unplayed:
        if known[part.name]:
            known[part.name] -= 1
        else:
            found.append(part)
    return tuple(found)


def _with_curves(
    project: Project, found: FoundParts, everywhere: Callable[[int], int], scale: Fraction
) -> tuple[list[Part], tuple[ReplacedKind, ...]]:
    """Return the matched parts with controllers that were edited only in the project, and the kinds of those replaced
    by the file's.

    ``everywhere`` converts ticks where no note has moved, ``scale`` is the number of the file's ticks per tick of the
    project.
    """
    parts = list(found.parts)
    replaced = False
    for index, (part, before) in enumerate(zip(found.parts, found.former, strict=True)):
        if before is None:
            continue
        read = project.read_curves.get(part.id, before.curves)
        if project.read_timing is None and found.is_unchanged:
            # An older version did not store the file's curves; if the notes are unchanged, the file's current curves
            # are assumed.
            read = part.curves
        place = everywhere if found.still else place_map(found.places[part.id], scale)
        merged = merged_curves(before.curves, read, part.curves, place)
        parts[index] = msgspec.structs.replace(part, curves=merged.curves)
        replaced = replaced or merged.replaced
    return parts, ("controllers",) if replaced else ()


def _add_others(
    project: Project, parts: list[Part], others: Sequence[Part], place: Callable[[int], int], scale: Fraction
) -> dict[str, str]:
    """Append to ``parts`` those that a newly read file lacks: parts made in the editor, and parts of players whose part
    disappeared. Returns their new ids by old id; ``place`` converts ticks."""
    played = {player.part_id for player in project.players}
    ids = iter(fresh_part_ids(project, len(others), MADE_PART))
    result = {}
    for part in others:
        read = is_read(project, part)
        if read and part.id not in played:
            continue
        result[part.id] = next(ids) if read else part.id
        parts.append(moved_part(part, result[part.id], place, scale))
    return result


def _with_players(
    project: Project,
    score: Score,
    parts: list[Part],
    part_of: Mapping[str, str],
    found: FoundParts,
    everywhere: Callable[[int], int],
    scale: Fraction,
) -> Project:
    """Return the project with the given parts and its previous players, whose corrections and takes move with the
    music.

    Parameters
    ----------
    part_of : mapping of str to str
        New ids of parts that the file lacks, by their previous ones.
    """
    corrections: dict[str, tuple[Correction, ...]] = {}
    ignored = {id: tuple(moved_ignored(one, everywhere) for one in own) for id, own in project.ignored_problems.items()}
    for player in project.players:
        own, let_be = project.corrections.get(player.id, ()), project.ignored_problems.get(player.id, ())
        if own or let_be:
            here = None if found.still else found.places.get(player.part_id)
            place = place_map(here, scale) if here else everywhere
        if own:
            corrections[player.id] = tuple(moved_correction(correction, {}, place, scale) for correction in own)
        if let_be:
            ignored[player.id] = tuple(moved_ignored(one, place) for one in let_be)
    whole = msgspec.structs.replace(score, title=project.score.title, parts=tuple(parts))
    danced = {
        dancer: tuple(moved_correction(correction, {}, everywhere, scale) for correction in own)
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
        ignored_problems=ignored,
        audio=project.audio if project.audio is None or found.still else with_places(project.audio, everywhere),
    )


def _with_new_players(
    project: Project,
    parts: Sequence[Part],
    maps: Mapping[str, InstrumentMap],
    characters: Mapping[Place, str],
) -> Project:
    """Add a player for every new part, cast as in a new piece; ``characters`` has the chosen ones."""
    names = project.performer_names()
    playing = [maps[player.instrument_id] for player in project.players if player.instrument_id in maps]
    newcomers: list[Player] = []
    doubled = doubled_parts(project.score.parts, maps, project.score.tempo_map)
    players = {player.part_id: player.id for player in reversed(project.players)}
    ids = fresh_player_ids(project, len(parts))
    players |= {part.id: player_id for player_id, part in zip(ids, parts, strict=True)}
    for player_id, part in zip(ids, parts, strict=True):
        names.append(free_name(part.name, names))
        playing.append(maps[part.map_id])
        doubles = _musician(project, players.get(doubled.get(part.id, ""), ""))
        with_those_before = replace(project, players=(*project.players, *newcomers))
        player = newcomer(with_those_before, player_id, part, names[-1], playing, doubles)
        character = characters.get(part.place, player.character_id)
        newcomers.append(msgspec.structs.replace(player, character_id=character))
    return with_newcomers(project, tuple(newcomers))


def _musician(project: Project, player_id: str) -> str:
    """Return the id of a player's musician; the player's own id if it is new."""
    known = next((player for player in project.players if player.id == player_id), None)
    return player_id if known is None else project.musician(known).id
