"""Tracks to parts: which instrument a track is for, which map plays it, and how many players it needs.

A name beats a program; what an instrument is called in the track's name beats its instrument name. What is percussion
and what sound effects `app.score.choose.use_of` says.

Reasons for not playing a part
------------------------------
score.no_map : instrument
    "there is no instrument map for {instrument} yet"
score.percussion : instrument
    "{instrument} is percussion"
score.sound_effect
    "it is a sound effect, which no player plays"
score.not_wind : instrument
    "{instrument} is not a wind instrument"
score.outside_ranges : lowest, highest
    "neither its name nor its program says what it is, and no instrument map reaches its notes ({lowest} to {highest})"

score.unknown_instrument : lowest, highest
    "the instrument cannot be determined because the name is not understood ({lowest} to {highest}); select one"
score.stray_notes : part, count, place, pitch
    "{count} notes sound together with others, the first at ...; too few and too short for another player"
score.key_switches : part, count, place, pitch
    "{count} notes far from the instrument's range are key switches, the first at ..."

Warnings
--------
Those about notes name the first of them: ``place``, its position as `MetreMap.label` writes it, and ``pitch``.

score.substituted : part, instrument, map
    "{part}: there is no instrument map for {instrument}; {map} plays it instead"
score.instrument_from_title : part, map
    "{part}: neither its name nor its program says what it is; the title does, so {map} plays it"
score.chosen_by_ensemble : part, map
    "{part}: neither its name nor its program says what it is; the staves together are those of a known ensemble,
    in which {map} plays it"
score.program_gives_way : part, instrument, map, outside, total, place, pitch
    "{part}: its program names {instrument}, but {outside} of {total} notes lie outside its range, the first at ...;
    {map} fits and plays it"
score.chosen_by_range : part, map
    "{part}: neither its name nor its program says what it is; {map} plays it because the range fits"
score.chosen_by_range_partly : part, map, outside, total, place, pitch
    "{part}: neither its name nor its program says what it is; {map} plays it, though {outside} of {total} notes lie
    outside its range, the first at ..."
score.looks_written : part, map, outside, total, place, pitch
    "{part}: {outside} of {total} notes lie outside the range of {map}, the first at ..., but all fit as written
    pitches: the part looks untransposed; import its pitches as written"
score.read_as_written : part, map, outside, total, place, pitch
    "{part}: {outside} of {total} notes lie outside the range of {map} as sounding pitches, the first at ..., but
    all fit as written ones, so they were read as such"
score.written : part, map
    "{part}: read as written pitches for {map}"
score.left_out : (a reason)
    "excluded on import"
score.too_many_players : most (a reason)
    "the piece has {most} players already, and more cannot play"
score.too_many_for_hours : most, hours (a reason)
    "at most {most} players play a piece of {hours} hours"
score.regions : part, count
    "{part}: {count} tracks of this name, channel and program follow one another, so one player plays them; if they
    are several players, split them in the import dialog"
score.spread : part, count
    "{part}: one line goes through {count} tracks, as controllers with a channel for each note write it, so one player
    plays them; if they are several players, split them in the import dialog"
score.voices : part, voices, count, place, pitch
    "{part}: {voices} players share it, for {count} notes sound together with others, the first at ..."
score.unisons : part, count, place, pitch
    "{part}: {count} notes are struck twice in unison, the first at ...; one player has each of them once"
score.take_cleaned : part, count, slips, doubles, silent, places
    "{part}: this track looks like a take of a wind controller; {count} notes were left out (...), at ..."
score.solos : part, count, place, pitch
    "{part}: {count} notes are marked for one of its players, the first at ...; the others rest"
score.doubling : part, instrument, count, place, pitch
    "{part}: the player of this track changes to {instrument} for {count} notes, the first at ...; a player has one
    instrument here, so another one plays them"
score.notes_left_out : part, most, count, place, pitch
    "{part}: {most} players share it, and {count} notes that sound together with theirs are excluded, the first at ..."
score.slurred : part, count, place, pitch
    "{count} notes last into the next one and end there as slurred notes, the first in {part} at ..."
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final, Literal, TypeAlias

import msgspec

from app.errors import Argument, Message, raise_if_stopped
from app.score.choose import (
    LEAST_OUTSIDE,
    How,
    MapCandidates,
    MapChoice,
    TrackChannel,
    candidates,
    players_named,
    plays,
    recognised,
    refusal,
    require_map,
    use_of,
)
from app.score.clean import Fault
from app.score.limits import MOST_PARTS, most_parts
from app.score.marks import Mark, marks_of_player
from app.score.model import MOST_VOICES, Note, Part, Score, UnplayedPart, sounding_spans
from app.score.regions import are_one_line, groups, is_spread, joined
from app.score.solos import solo_notes, with_solos
from app.score.switches import without_key_switches
from app.score.take_tracks import without_faults
from app.score.tempo import TempoMap
from app.score.voices import TrackVoices, file_id, split_voices
from instrument_maps.instruments import Instrument
from instrument_maps.vocabulary import vocabulary

PERCUSSION: Final = "percussion"
"""What is assigned to a part in place of an instrument where dancers are to hear its notes as percussion."""

_MOST_PLACES: Final = 5
"""Places that a message lists."""


def parts_of(
    streams: Sequence[TrackChannel], maps: Sequence[MapChoice], piece: Score
) -> tuple[tuple[Part, ...], tuple[UnplayedPart, ...], tuple[Message, ...]]:
    """Sort tracks into parts with players and parts without, and say what was guessed.

    Parameters
    ----------
    maps : sequence of MapChoice
        Earlier ones are preferred where all else is equal.
    piece : Score
        Its tempo and metres.
    """
    return assigned_parts(streams, usual_assignments(streams, maps), maps, piece)


Split: TypeAlias = Literal["sustained", "every", "never"]


class PartAssignment(msgspec.Struct, frozen=True):
    """The user's choices for some tracks.

    Attributes
    ----------
    streams : tuple of int
        Places among the streams; several are merged into one line.
    map_id : str or None
        The instrument map that plays it; None: what the names, programs and ranges say; `PERCUSSION`: no one, for its
        notes are the sounds of a drum kit.
    name : str
        Of the part; empty: what the file calls it.
    split : {"sustained", "every", "never"}
        Another player for notes that go on sounding together; for every note that does; or one player has them all.
    written : bool
        The file has the pitches that stand in the part of a transposing instrument, not those that sound.
    clean : bool
        The tracks are takes: notes that were not meant are left out (`app.score.take_tracks`).
    solos : bool
        The track's words about who plays ("1. Solo", "a2") are followed.
    """

    streams: tuple[int, ...]
    map_id: str | None = None
    name: str = ""
    split: Split = "sustained"
    written: bool = False
    solos: bool = True
    clean: bool = False


class Suggestion(msgspec.Struct, frozen=True):
    """How the tracks of one player are imported by default.

    Attributes
    ----------
    playable : bool
        A map plays them.
    """

    assignment: PartAssignment
    playable: bool


def usual_assignments(streams: Sequence[TrackChannel], maps: Sequence[MapChoice]) -> tuple[PartAssignment, ...]:
    """Suggested assignments by names, programs and ranges, for the user to change: one for every playable stream, and
    one for the regions of a track."""
    return tuple(found.assignment for found in suggestions(streams, maps) if found.playable)


def suggestions(streams: Sequence[TrackChannel], maps: Sequence[MapChoice]) -> list[Suggestion]:
    """Suggested assignments of all streams, those that are one player's together.

    The pitches of a part are taken for written ones where many lie outside its instrument's range as they sound and
    none as they are written; where one of a family is written so, the others are with any note that is unusually low or
    high.
    """
    found = []
    likely: list[tuple[bool, str]] = []
    certain = set()
    for own in groups(streams):
        tracks = [streams[index] for index in own]
        playable = all(refusal(stream, maps) is None for stream in tracks)
        written, family = False, ""
        possible = candidates(tracks, maps) if playable else None
        if possible is not None and possible.how is not How.RANGE:
            pitches = [pitch for stream in tracks for pitch in stream.pitches]
            choice = possible.best(pitches)
            family = vocabulary().family(choice.plays)
            high = choice.outside(pitches, usual=True) > 0
            written = high and not choice.outside(pitches, written=True, usual=choice.outside(pitches) == 0)
            if _fits_as_written(choice, pitches):
                certain.add(family)
        likely.append((written, family))
        found.append(Suggestion(PartAssignment(own), playable))
    return [
        msgspec.structs.replace(one, assignment=msgspec.structs.replace(one.assignment, written=True))
        if written and family in certain
        else one
        for one, (written, family) in zip(found, likely, strict=True)
    ]


def _fits_as_written(choice: MapChoice, pitches: Sequence[int]) -> bool:
    # A wrong note or two says nothing.
    return choice.outside(pitches) >= LEAST_OUTSIDE * len(pitches) and not choice.outside(pitches, written=True)


def assigned_parts(
    streams: Sequence[TrackChannel],
    assignments: Sequence[PartAssignment],
    maps: Sequence[MapChoice],
    piece: Score,
    stop_requested: Callable[[], bool] = lambda: False,
) -> tuple[tuple[Part, ...], tuple[UnplayedPart, ...], tuple[Message, ...]]:
    """Sort tracks into requested parts and unplayed ones, and report what was guessed.

    Parameters
    ----------
    assignments : sequence of PartAssignment
        A stream is asked for at most once.
    piece : Score
        Its tempo and metres.
    stop_requested : callable
        Asked before each part.

    Raises
    ------
    Cancelled
        ``stop_requested`` said so.
    """
    parts: list[Part] = []
    warnings: list[Message] = []
    slurred: list[tuple[str, Note]] = []
    silent: list[UnplayedPart] = []
    asked: set[int] = set()
    crowded: set[int] = set()
    percussion: set[int] = set()
    ends = [max(stream.end_ticks) for stream in streams if stream.end_ticks]
    hours = piece.tempo_map.seconds(float(max(ends, default=0))) / 3600.0
    most = most_parts(hours)
    streams = list(streams)
    for assignment in assignments:
        raise_if_stopped(stop_requested)
        if assignment.map_id == PERCUSSION:
            percussion.update(assignment.streams)
            continue
        room = most - len(parts)
        if not room:
            crowded.update(assignment.streams)
            continue
        faults: dict[Fault, list[Note]] = {}
        if assignment.clean:
            for index in assignment.streams:
                streams[index], own = without_faults(streams[index], piece.tempo_map)
                faults |= {fault: faults.get(fault, []) + notes for fault, notes in own.items()}
        found = _found([streams[index] for index in assignment.streams], assignment.map_id, maps)
        if found.unknown:
            continue
        read = [without_key_switches(streams[index], found, maps, piece.tempo_map) for index in assignment.streams]
        chosen = [stream for stream, _ in read]
        if any(places for _, places in read):
            found = _found(chosen, assignment.map_id, maps)
        asked.update(assignment.streams)
        notes = [note for stream in chosen for note in stream.notes()]
        notes.sort(key=lambda note: (note.onset_tick, note.pitch))
        shared = _shared(assignment, chosen, notes, piece.tempo_map, min(MOST_VOICES, room))
        name = assignment.name or chosen[0].name or chosen[0].instrument_name
        lead = joined(chosen)
        mine = _parts(lead, name, found, shared.voices, assignment.written)
        parts += mine
        slurred += [(mine[0].name, note) for note in shared.shortened]
        switches = _switches(streams, assignment.streams, [places for _, places in read])
        silent += _silent("score.key_switches", mine[0].name, switches, piece)
        if lead.change and lead.played_on and len(chosen) == 1:
            instrument = vocabulary().instruments[lead.played_on].names[0]
            warnings.append(_about("score.doubling", mine[0].name, notes, piece, instrument=instrument))
        if are_one_line(chosen):
            id_ = "score.spread" if is_spread(chosen) else "score.regions"
            warnings.append(Message(id_, {"part": mine[0].name, "count": len(chosen)}))
        if faults:
            warnings.append(_cleaned(mine[0].name, faults, piece))
        if shared.unisons:
            warnings.append(_about("score.unisons", mine[0].name, shared.unisons, piece))
        if shared.solos:
            marked = [note for note in notes if note.id in {*shared.solos}]
            warnings.append(_about("score.solos", mine[0].name, marked, piece))
        if len(mine) > 1:
            warnings.append(_about("score.voices", mine[0].name, shared.together, piece, voices=len(mine)))
        if len(mine) == MOST_VOICES and shared.left_out:
            warnings.append(_about("score.notes_left_out", mine[0].name, shared.left_out, piece, most=len(mine)))
        else:
            silent += _silent("score.stray_notes", mine[0].name, shared.left_out, piece)
        warnings += _instrument_warnings(mine, found, assignment, maps, piece)
    if slurred:
        part, first = min(slurred, key=lambda row: row[1].onset_tick)
        warnings.append(_about("score.slurred", part, [first], piece, count=len(slurred)))
    unplayed = tuple(
        UnplayedPart(
            stream_name(stream),
            _reason(stream, _crowd(most, hours) if index in crowded else None, index in percussion, maps),
            len(stream.pitches),
            max(stream.end_ticks),
            sounding_spans(zip(stream.onset_ticks, stream.end_ticks, strict=True), piece.ticks_per_quarter),
        )
        for index, stream in enumerate(streams)
        if index not in asked
    )
    return tuple(parts), (*unplayed, *silent), tuple(_once(warnings))


def _once(messages: Sequence[Message]) -> list[Message]:
    """The messages without repetitions."""
    return [message for place, message in enumerate(messages) if message not in messages[:place]]


def _shared(
    assignment: PartAssignment, chosen: Sequence[TrackChannel], notes: Sequence[Note], tempo_map: TempoMap, most: int
) -> TrackVoices:
    """The notes among their players."""
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
        unison=said is not None and not said.vague,
    )
    if len(shared.voices) < 2 or not (assignment.solos and alone and chosen[0].solos):
        return shared
    solos = solo_notes(notes, chosen[0].solos)
    original = {note.id: file_id(note.id) for voice in shared.voices for note in voice}
    return shared._replace(voices=with_solos(shared.voices, solos, original), solos=sorted(solos))


def rhythm_parts(streams: Sequence[TrackChannel], assignments: Sequence[PartAssignment] = ()) -> list[TrackChannel]:
    """The streams whose notes are the sounds of a drum kit: those that say so, but for what the user assigned."""
    assigned = {index: one.map_id for one in assignments if one.map_id is not None for index in one.streams}
    return [
        stream
        for index, stream in enumerate(streams)
        if (assigned[index] == PERCUSSION if index in assigned else use_of(stream) == "rhythm")
    ]


def _crowd(most: int, hours: float) -> Message:
    """Return why no more than so many players play a piece."""
    if most == MOST_PARTS:
        return Message("score.too_many_players", {"most": most})
    return Message("score.too_many_for_hours", {"most": most, "hours": round(hours, 1)})


def _reason(stream: TrackChannel, crowd: Message | None, percussion: bool, maps: Sequence[MapChoice]) -> Message:
    """Why no one plays a stream."""
    if percussion and use_of(stream) != "rhythm":
        return Message("score.percussion", {"instrument": stream_name(stream)})
    if crowd is not None:
        return crowd
    return refusal(stream, maps) or Message("score.left_out")


def _about(id_: str, part: str, notes: Sequence[Note], piece: Score, **more: Argument) -> Message:
    """A message about some notes: how many, and where the first one is."""
    first = notes[0]
    where: dict[str, Argument] = {"place": piece.metre_map.label(first.onset_tick), "pitch": first.pitch}
    return Message(id_, {"part": part, "count": len(notes), **where, **more})


def _cleaned(part: str, faults: Mapping[Fault, list[Note]], piece: Score) -> Message:
    """What was left out of a take: how many notes, why, and where the first ones are."""
    notes = sorted((note for own in faults.values() for note in own), key=lambda note: note.onset_tick)
    places = list(dict.fromkeys(piece.metre_map.label(note.onset_tick) for note in notes))
    said = ", ".join(places[:_MOST_PLACES]) + (", ..." if len(places) > _MOST_PLACES else "")
    slips, doubles = (len(faults.get(fault, ())) for fault in ("slip", "double"))
    counts: dict[str, Argument] = {"slips": slips, "doubles": doubles, "silent": len(notes) - slips - doubles}
    return Message("score.take_cleaned", {"part": part, "count": len(notes), **counts, "places": said})


def _switches(streams: Sequence[TrackChannel], own: Sequence[int], places: Sequence[Sequence[int]]) -> list[Note]:
    """The key switches of some streams, by onset."""
    found = []
    for index, switches in zip(own, places, strict=True):
        if switches:
            notes = streams[index].notes()
            found += [notes[place] for place in switches]
    return sorted(found, key=lambda note: note.onset_tick)


def _silent(id_: str, part: str, notes: Sequence[Note], piece: Score) -> list[UnplayedPart]:
    """The notes of a part that its players do not play, as a silent part: a few stray notes and key switches are no
    accompaniment."""
    if not notes:
        return []
    return [UnplayedPart(part, _about(id_, part, notes, piece), len(notes), max(note.end_tick for note in notes))]


def _instrument_warnings(
    parts: Sequence[Part], found: MapCandidates, assignment: PartAssignment, maps: Sequence[MapChoice], piece: Score
) -> list[Message]:
    """What was guessed about the instrument."""
    warnings = []
    if found.how is not How.RANGE:
        warnings += _written_warnings(parts, maps, piece)
    if assignment.map_id is not None:
        return warnings
    if found.how is How.RANGE:
        return [*warnings, *(_range_warning(part, maps, piece) for part in parts)]
    if found.how in _REASONS:
        warnings.append(Message(_REASONS[found.how], {"part": parts[0].name, "map": parts[0].map_id}))
    if found.refused is not None:
        warnings.append(_refused(parts, found.refused, maps, piece))
    elif found.instrument is not None:
        warnings += _substitutions(parts, found.instrument, maps)
    return warnings


_REASONS: Final = {How.TITLE: "score.instrument_from_title", How.ENSEMBLE: "score.chosen_by_ensemble"}


def _refused(parts: Sequence[Part], instrument: Instrument, maps: Sequence[MapChoice], piece: Score) -> Message:
    """A message about the notes that the instrument of a program does not reach."""
    own = [choice for choice in maps if plays(choice, instrument) or instrument.id in choice.substitutes_for]
    notes = sorted((note for part in parts for note in part.notes), key=lambda note: (note.onset_tick, note.pitch))
    outside = [note for note in notes if all(choice.outside([note.pitch]) for choice in own)]
    more: dict[str, Argument] = {
        "instrument": instrument.names[0],
        "map": parts[0].map_id,
        "outside": len(outside),
        "total": len(notes),
    }
    return _about("score.program_gives_way", parts[0].name, outside or notes, piece, **more)


def _substitutions(parts: Sequence[Part], instrument: Instrument, maps: Sequence[MapChoice]) -> list[Message]:
    """A warning for each map that only stands in for the instrument."""
    return [
        Message("score.substituted", {"part": parts[0].name, "instrument": instrument.names[0], "map": map_id})
        for map_id in dict.fromkeys(part.map_id for part in parts)
        if not any(choice.map_id == map_id and plays(choice, instrument) for choice in maps)
    ]


def _found(chosen: Sequence[TrackChannel], map_id: str | None, maps: Sequence[MapChoice]) -> MapCandidates:
    """The maps an assignment may be given to: the one the user named, else what the tracks say and fit. Raises as
    `require_map`."""
    found = candidates(chosen, maps)
    if map_id is not None:
        by_id = {choice.map_id: choice for choice in maps}
        return MapCandidates(How.SAID, found.instrument, (by_id[require_map(map_id, by_id)],))
    if not found.maps:
        # The user requests a player though no map fits, and must select the instrument.
        return MapCandidates(How.RANGE, None, tuple(maps), unknown=True)
    return found


def stream_name(stream: TrackChannel) -> str:
    """What the user calls a stream."""
    instrument = recognised(stream)
    return stream.name or stream.instrument_name or (instrument.names[0] if instrument else f"Track {stream.track + 1}")


def _parts(
    stream: TrackChannel, name: str, found: MapCandidates, voices: Sequence[tuple[Note, ...]], written: bool
) -> list[Part]:
    """A part for every voice."""
    parts = []
    instrument = found.instrument
    onsets = {file_id(note.id): note.onset_tick for notes in voices for note in notes} if stream.marks else {}
    for voice, notes in enumerate(voices, stream.change * MOST_VOICES):
        chosen = found.best([note.pitch for note in notes], written)
        shift = -chosen.transposition_semitones if written else 0
        parts.append(
            Part(
                id=f"{stream.track + 1}.{stream.channel + 1}.{voice + 1}",
                name=name or (instrument.names[0] if instrument else "") or _name_of(chosen),
                track=stream.track,
                voice=voice,
                channel=stream.channel,
                program=stream.program,
                instrument=instrument.id if instrument is not None else None,
                map_id=chosen.map_id,
                notes=transposed(notes, shift),
                curves=stream.curves,
                transposed_semitones=shift,
                muted=stream.muted,
                stopped=stream.stopped,
                marks=_marks(stream.marks, onsets, notes),
                source=stream.source,
            )
        )
    return parts


def _marks(marks: Sequence[Mark], onsets: Mapping[str, int], notes: Sequence[Note]) -> tuple[Mark, ...]:
    """The marks of a stream that are about a voice of it."""
    return (
        marks_of_player(marks, onsets, [(note.onset_tick, file_id(note.id), note.id) for note in notes])
        if marks
        else ()
    )


def transposed(notes: tuple[Note, ...], semitones: int) -> tuple[Note, ...]:
    """The notes so much higher; those that MIDI has no number for as far as it goes."""
    if not semitones:
        return notes
    return tuple(msgspec.structs.replace(note, pitch=min(max(note.pitch + semitones, 0), 127)) for note in notes)


def _written_warnings(parts: Sequence[Part], maps: Sequence[MapChoice], piece: Score) -> list[Message]:
    """Of parts that the instrument has no notes for unless they are read as they are written, and those that are."""
    choices = {choice.map_id: choice for choice in maps}
    found = []
    for part in parts:
        shift = part.transposed_semitones
        given = msgspec.structs.replace(part, notes=transposed(part.notes, -shift))
        choice, pitches = choices[part.map_id], [note.pitch for note in given.notes]
        if shift and choice.outside(pitches) and not choice.outside(pitches, written=True):
            found.append(_outside("score.read_as_written", given, choice, piece))
        elif shift:
            found.append(Message("score.written", {"part": part.name, "map": part.map_id}))
        elif _fits_as_written(choice, pitches):
            found.append(_outside("score.looks_written", given, choice, piece))
    return found


def _range_warning(part: Part, maps: Sequence[MapChoice], piece: Score) -> Message:
    choice = next(choice for choice in maps if choice.map_id == part.map_id)
    if choice.outside([note.pitch for note in part.notes]):
        return _outside("score.chosen_by_range_partly", part, choice, piece)
    return Message("score.chosen_by_range", {"part": part.name, "map": part.map_id})


def _outside(id_: str, part: Part, choice: MapChoice, piece: Score) -> Message:
    """A message about the notes of a part that its instrument does not reach."""
    notes = [note for note in part.notes if choice.outside([note.pitch])]
    return _about(id_, part.name, notes, piece, map=part.map_id, outside=len(notes), total=len(part.notes))


def _name_of(choice: MapChoice) -> str:
    """The English name of the instrument that a map plays."""
    known = vocabulary().instruments
    return next((known[id_].names[0] for id_ in choice.plays if id_ in known), choice.map_id)
