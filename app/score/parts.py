"""Turns tracks into parts: the instrument of each track, its instrument map, and the number of players.

A name precedes a program; an instrument found in the track's name precedes the track's instrument name. Percussion and
sound effects are decided by `app.score.track_instrument.use_of`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from app.errors import Message, StopRequested, raise_if_stopped
from app.score.assignments import PERCUSSION, PartAssignment, usual_assignments
from app.score.clean import Fault
from app.score.instrument_choice import How, MapCandidates, MapChoice, candidates, refusal, require_map
from app.score.key_switches import without_key_switches
from app.score.limits import MOST_PARTS, most_parts
from app.score.marks import Mark, marks_of_player
from app.score.model import MOST_VOICES, Note, Part, Score, UnplayedPart, sounding_spans, transposed
from app.score.part_messages import about_notes, cleaned_take, instrument_warnings, silent_notes
from app.score.sequencer_regions import are_one_line, is_spread, joined
from app.score.solos import solo_notes, with_solos
from app.score.take_tracks import without_faults
from app.score.tempo import TempoMap
from app.score.track_channel import TrackChannel
from app.score.track_instrument import players_named, recognised, use_of
from app.score.voices import TrackVoices, file_id, split_voices
from instrument_maps.instrument_names import vocabulary


def parts_of(
    channels: Sequence[TrackChannel], maps: Sequence[MapChoice], piece: Score
) -> tuple[tuple[Part, ...], tuple[UnplayedPart, ...], tuple[Message, ...]]:
    """Sort tracks into parts with players and parts without, using the suggested assignments; also return messages
    about guesses.

    Parameters
    ----------
    maps : sequence of MapChoice
        Available maps; at equal fit an earlier one is chosen.
    piece : Score
        Score that provides tempo and metres.
    """
    return assigned_parts(channels, usual_assignments(channels, maps), maps, piece)


def assigned_parts(
    channels: Sequence[TrackChannel],
    assignments: Sequence[PartAssignment],
    maps: Sequence[MapChoice],
    piece: Score,
    stop_requested: StopRequested = lambda: False,
) -> tuple[tuple[Part, ...], tuple[UnplayedPart, ...], tuple[Message, ...]]:
    """Sort tracks into the assigned parts and parts without a player; also return messages about guesses.

    Parameters
    ----------
    assignments : sequence of PartAssignment
        The assignments; a channel occurs in at most one.
    piece : Score
        Score that provides tempo and metres.
    stop_requested : callable
        Called before each part.

    Raises
    ------
    Cancelled
        ``stop_requested`` returned True.
    """
    sorting = _Sorting(channels, maps, piece)
    for assignment in assignments:
        raise_if_stopped(stop_requested)
        sorting.add(assignment)
    return tuple(sorting.parts), sorting.unplayed(), sorting.all_warnings()


class _Sorting:
    """State while tracks are sorted into parts, assignment by assignment."""

    def __init__(self, channels: Sequence[TrackChannel], maps: Sequence[MapChoice], piece: Score) -> None:
        self.parts: list[Part] = []
        self._streams, self._maps, self._piece = list(channels), maps, piece
        self._warnings: list[Message] = []
        self._slurred: list[tuple[str, Note]] = []
        self._silent: list[UnplayedPart] = []
        self._played, self._crowded, self._percussion = set[int](), set[int](), set[int]()
        ends = [max(channel.end_ticks) for channel in channels if channel.end_ticks]
        self._hours = piece.tempo_map.seconds(float(max(ends, default=0))) / 3600.0
        self._most = most_parts(self._hours)

    def add(self, assignment: PartAssignment) -> None:
        """Add the parts of one assignment, with messages about guesses."""
        own, maps = assignment.channels, self._maps
        room = self._most - len(self.parts)
        if assignment.map_id == PERCUSSION:
            self._percussion.update(own)
            return
        if not room:
            self._crowded.update(own)
            return
        faults = self._clean(own) if assignment.clean else {}
        found = _found([self._streams[index] for index in own], assignment.map_id, maps)
        if found.unknown:
            return
        of_voices = [None if map_id is None else _map(map_id, maps) for map_id in assignment.voice_maps]
        reached = msgspec.structs.replace(found, maps=(*found.maps, *filter(None, of_voices)))
        read = [without_key_switches(self._streams[index], reached, maps, self._piece.tempo_map) for index in own]
        chosen = [channel for channel, _ in read]
        if any(places for _, places in read):
            found = _found(chosen, assignment.map_id, maps)
        self._played.update(own)
        notes = [note for channel in chosen for note in channel.notes()]
        notes.sort(key=lambda note: (note.onset_tick, note.pitch))
        shared = _shared(assignment, chosen, notes, self._piece.tempo_map, min(MOST_VOICES, room))
        name = assignment.name or chosen[0].name or chosen[0].instrument_name
        mine = _parts(joined(chosen), name, found, shared.voices, assignment.written, of_voices)
        part = mine[0].name
        self.parts += mine
        self._slurred += [(part, note) for note in shared.shortened]
        switches = _switches(self._streams, own, [places for _, places in read])
        self._silent += silent_notes("score.key_switches", part, switches, self._piece)
        self._warn_of_tracks(part, chosen, notes)
        if faults:
            self._warnings.append(cleaned_take(part, faults, self._piece))
        self._warn_of_players(mine, notes, shared)
        self._warnings += instrument_warnings(mine, found, assignment, maps, self._piece)

    def _clean(self, own: Sequence[int]) -> dict[Fault, list[Note]]:
        """Remove unintended notes from those channels that are recorded takes, and return the removed notes
        by reason.
        """
        faults: dict[Fault, list[Note]] = {}
        for index in own:
            self._streams[index], found = without_faults(self._streams[index], self._piece.tempo_map)
            faults |= {fault: faults.get(fault, []) + notes for fault, notes in found.items()}
        return faults

    def _warn_of_tracks(self, part: str, chosen: Sequence[TrackChannel], notes: Sequence[Note]) -> None:
        """Add warnings about tracks that were joined for one player, and about instrument changes within a track."""
        lead = joined(chosen)
        if lead.change and lead.played_on and len(chosen) == 1:
            instrument = vocabulary().instruments[lead.played_on].names[0]
            self._warnings.append(about_notes("score.doubling", part, notes, self._piece, instrument=instrument))
        if are_one_line(chosen):
            id_ = "score.spread" if is_spread(chosen) else "score.regions"
            self._warnings.append(Message(id_, {"part": part, "count": len(chosen)}))

    def _warn_of_players(self, mine: Sequence[Part], notes: Sequence[Note], shared: TrackVoices) -> None:
        """Add warnings about the number of players that share the notes, and about notes left without a player."""
        part, piece = mine[0].name, self._piece
        if shared.unisons:
            self._warnings.append(about_notes("score.unisons", part, shared.unisons, piece))
        if shared.solos:
            marked = [note for note in notes if note.id in {*shared.solos}]
            self._warnings.append(about_notes("score.solos", part, marked, piece))
        if len(mine) > 1 and shared.together:
            self._warnings.append(about_notes("score.voices", part, shared.together, piece, voices=len(mine)))
        if len(mine) == MOST_VOICES and shared.left_out:
            self._warnings.append(about_notes("score.notes_left_out", part, shared.left_out, piece, most=len(mine)))
        else:
            self._silent += silent_notes("score.stray_notes", part, shared.left_out, piece)

    def unplayed(self) -> tuple[UnplayedPart, ...]:
        """Return the channels without a player, and the notes that the players of a part leave out, as parts without a
        player.
        """
        channels = (
            UnplayedPart(
                stream_name(channel),
                self._reason(index),
                len(channel.pitches),
                max(channel.end_ticks),
                sounding_spans(zip(channel.onset_ticks, channel.end_ticks, strict=True), self._piece.ticks_per_quarter),
            )
            for index, channel in enumerate(self._streams)
            if index not in self._played
        )
        return *channels, *self._silent

    def _reason(self, index: int) -> Message:
        """Return the reason why a channel has no player."""
        channel = self._streams[index]
        if index in self._percussion and use_of(channel) != "rhythm":
            return Message("score.percussion", {"instrument": stream_name(channel)})
        if index not in self._crowded:
            return refusal(channel, self._maps) or Message("score.left_out")
        if self._most == MOST_PARTS:
            return Message("score.too_many_players", {"most": self._most})
        return Message("score.too_many_for_hours", {"most": self._most, "hours": round(self._hours, 1)})

    def all_warnings(self) -> tuple[Message, ...]:
        """Return all warnings about the parts without repetitions; those about shortened legato notes are merged."""
        warnings = [*self._warnings]
        if self._slurred:
            part, first = min(self._slurred, key=lambda row: row[1].onset_tick)
            warnings.append(about_notes("score.slurred", part, [first], self._piece, count=len(self._slurred)))
        return tuple(warning for place, warning in enumerate(warnings) if warning not in warnings[:place])


def _shared(
    assignment: PartAssignment, chosen: Sequence[TrackChannel], notes: Sequence[Note], tempo_map: TempoMap, most: int
) -> TrackVoices:
    """Distribute the notes of the chosen tracks over at most ``most`` players, so that each plays one line."""
    if assignment.split == "never":
        return TrackVoices([tuple(notes)], [], [], [])
    alone = len(chosen) == 1 or are_one_line(chosen)
    said = vocabulary().by_name(chosen[0].name or chosen[0].instrument_name) if alone else None
    shared = split_voices(
        notes,
        tempo_map,
        most,
        least=players_named(chosen[0].name) if said is not None else 1,
        every_chord=assignment.split == "every",
        in_turn=assignment.solos and bool(chosen[0].solos),
        unison=said is not None and not said.vague,
    )
    count = len(shared.voices)
    if count < 2 or not alone:
        return shared
    solos = solo_notes(notes, chosen[0].solos) if assignment.solos and chosen[0].solos else {}
    seated = chosen[0].seats(count) | solos
    if not seated:
        return shared
    original = {note.id: file_id(note.id) for voice in shared.voices for note in voice}
    return shared._replace(voices=with_solos(shared.voices, seated, original), solos=sorted(solos))


def rhythm_parts(channels: Sequence[TrackChannel], assignments: Sequence[PartAssignment] = ()) -> list[TrackChannel]:
    """Return the channels whose notes are drum kit sounds, by their own data or by assignment; channels assigned to
    players are excluded.
    """
    assigned = {index: one.map_id for one in assignments if one.map_id is not None for index in one.channels}
    return [
        channel
        for index, channel in enumerate(channels)
        if (assigned[index] == PERCUSSION if index in assigned else use_of(channel) == "rhythm")
    ]


def _switches(channels: Sequence[TrackChannel], own: Sequence[int], places: Sequence[Sequence[int]]) -> list[Note]:
    """Return the key switches of the channels as notes, by onset."""
    found = []
    for index, switches in zip(own, places, strict=True):
        if switches:
            notes = channels[index].notes()
            found += [notes[place] for place in switches]
    return sorted(found, key=lambda note: note.onset_tick)


def _found(chosen: Sequence[TrackChannel], map_id: str | None, maps: Sequence[MapChoice]) -> MapCandidates:
    """Find the candidate maps of an assignment: the one that the user chose, else those found from names, program and
    range. Raises as `require_map`.
    """
    found = candidates(chosen, maps)
    if map_id is not None:
        return MapCandidates(How.SAID, found.instrument, (_map(map_id, maps),))
    if not found.maps:
        # The user wants a player although no map fits, and must choose the instrument.
        return MapCandidates(How.RANGE, None, tuple(maps), unknown=True)
    return found


def _map(map_id: str, maps: Sequence[MapChoice]) -> MapChoice:
    """Return the map with an id. Raises as `require_map`."""
    by_id = {choice.map_id: choice for choice in maps}
    return by_id[require_map(map_id, by_id)]


def stream_name(channel: TrackChannel) -> str:
    """Name of a channel as shown to the user: its track name, instrument name, recognised instrument or track
    number.
    """
    instrument = recognised(channel)
    return (
        channel.name or channel.instrument_name or (instrument.names[0] if instrument else f"Track {channel.track + 1}")
    )


def _parts(
    channel: TrackChannel,
    name: str,
    found: MapCandidates,
    voices: Sequence[tuple[Note, ...]],
    written: bool,
    of_voices: Sequence[MapChoice | None],
) -> list[Part]:
    """Return one part for each voice of a channel, with the voice's own instrument map if one was chosen in
    ``of_voices``."""
    parts = []
    instrument = found.instrument
    onsets = {file_id(note.id): note.onset_tick for notes in voices for note in notes} if channel.marks else {}
    for number, notes in enumerate(voices):
        voice = channel.change * MOST_VOICES + number
        own = of_voices[number] if number < len(of_voices) else None
        chosen = own or found.best([note.pitch for note in notes], written)
        shift = -chosen.transposition_semitones if written else 0
        parts.append(
            Part(
                id=f"{channel.track + 1}.{channel.channel + 1}.{voice + 1}",
                name=name or (instrument.names[0] if instrument else "") or _name_of(chosen),
                track=channel.track,
                voice=voice,
                channel=channel.channel,
                program=channel.program,
                instrument=instrument.id if instrument is not None else None,
                map_id=chosen.map_id,
                notes=transposed(notes, shift),
                curves=channel.curves,
                transposed_semitones=shift,
                muted=channel.muted,
                stopped=channel.stopped,
                mute_kinds=channel.mute_kinds,
                marks=_marks(channel.marks, onsets, notes),
                source=channel.source,
            )
        )
    return parts


def _marks(marks: Sequence[Mark], onsets: Mapping[str, int], notes: Sequence[Note]) -> tuple[Mark, ...]:
    """Select the marks of a channel that belong to the notes of one of its voices."""
    return (
        marks_of_player(marks, onsets, [(note.onset_tick, file_id(note.id), note.id) for note in notes])
        if marks
        else ()
    )


def _name_of(choice: MapChoice) -> str:
    """The English name of the instrument that a map plays."""
    known = vocabulary().instruments
    return next((known[id_].names[0] for id_ in choice.plays if id_ in known), choice.map_id)
