"""Tracks to parts: which instrument a track is for, which map plays it, and how many players it needs.

A name beats a program; what an instrument is called in the track's name beats its instrument name. Channel 10 is
percussion unless a name says otherwise.

Reasons for not playing a part
------------------------------
score.no_map : instrument
    "there is no instrument map for {instrument} yet"
score.percussion : instrument
    "{instrument} is percussion"
score.not_wind : instrument
    "{instrument} is not a wind instrument"
score.outside_ranges : lowest, highest
    "neither its name nor its program says what it is, and no instrument map reaches its notes ({lowest} to {highest})"

Warnings
--------
score.substituted : part, instrument, map
    "{part}: there is no instrument map for {instrument}; {map} plays it instead"
score.told_by_file : part, map
    "{part}: neither its name nor its program says what it is; the file's name does, so {map} plays it"
score.chosen_by_range : part, map
    "{part}: neither its name nor its program says what it is; {map} plays it because the range fits"
score.chosen_by_range_partly : part, map, outside, total
    "{part}: neither its name nor its program says what it is; {map} plays it, though {outside} of {total} notes lie
    outside its range"
score.looks_written : part, map, outside, total
    "{part}: {outside} of {total} notes lie outside the range of {map}, but all fit as written pitches: the part looks
    untransposed; import its pitches as written"
score.left_out : (a reason)
    "left out on import"
score.too_many_players : most (a reason)
    "the piece has {most} players already, and more cannot play"
score.voices : part, voices
    "{part}: up to {voices} notes sound together, so {voices} players share it"
score.notes_left_out : part, most, count
    "{part}: more than {most} notes sound together; {most} players share it, and {count} notes are left out"
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import msgspec

from app.errors import Argument, Cancelled, Message
from app.score.choose import Candidates, How, MapChoice, Stream, candidates, plays, recognised, refusal
from app.score.limits import MOST_PARTS
from app.score.model import Note, Part, UnplayedPart
from app.score.tempo import TempoMap
from app.score.voices import MOST_VOICES, split_voices
from instrument_maps.vocabulary import Instrument, vocabulary

LEAST_OUTSIDE = 0.01
"""The share of a part's notes beyond its instrument's range from which on its pitches are taken for written ones."""


def parts_of(
    streams: Sequence[Stream], maps: Sequence[MapChoice], tempo_map: TempoMap
) -> tuple[tuple[Part, ...], tuple[UnplayedPart, ...], tuple[Message, ...]]:
    """Sort tracks into parts with players and parts without, and say what was guessed.

    Parameters
    ----------
    streams : sequence of Stream
    maps : sequence of MapChoice
        Earlier ones are preferred where all else is equal.
    tempo_map : TempoMap
    """
    return wished_parts(streams, usual_wishes(streams, maps), maps, tempo_map)


class PartWish(msgspec.Struct, frozen=True):
    """What a person wants of some tracks.

    Attributes
    ----------
    streams : tuple of int
        Places among the streams; several are merged into one line.
    map_id : str or None
        The instrument map that plays it; None: what the names, programs and ranges say.
    name : str
        Of the part; empty: what the file calls it.
    split : bool
        Share notes that sound together among players; without it one player has them all.
    written : bool
        The file has the pitches that stand in the part of a transposing instrument, not those that sound.
    """

    streams: tuple[int, ...]
    map_id: str | None = None
    name: str = ""
    split: bool = True
    written: bool = False


def usual_wishes(streams: Sequence[Stream], maps: Sequence[MapChoice]) -> tuple[PartWish, ...]:
    """What names, programs and ranges say: a wish, which a person may change, for every stream somebody can play."""
    return tuple(PartWish((index,)) for index, stream in enumerate(streams) if refusal(stream, maps) is None)


def wished_parts(
    streams: Sequence[Stream],
    wishes: Sequence[PartWish],
    maps: Sequence[MapChoice],
    tempo_map: TempoMap,
    stop_wanted: Callable[[], bool] = lambda: False,
) -> tuple[tuple[Part, ...], tuple[UnplayedPart, ...], tuple[Message, ...]]:
    """Sort tracks into the parts that a person wants and those nobody plays, and say what was guessed.

    Parameters
    ----------
    streams : sequence of Stream
    wishes : sequence of PartWish
        A stream is asked for at most once.
    maps : sequence of MapChoice
    tempo_map : TempoMap
    stop_wanted : callable
        Asked before each part.

    Raises
    ------
    Cancelled
        ``stop_wanted`` said so.
    """
    parts: list[Part] = []
    warnings: list[Message] = []
    asked: set[int] = set()
    for wish in wishes:
        if stop_wanted():
            raise Cancelled("work.stopped")
        room = MOST_PARTS - len(parts)
        if not room:
            break
        asked.update(wish.streams)
        chosen = [streams[index] for index in wish.streams]
        found = _found(chosen, wish.map_id, maps)
        instrument = found.instrument
        notes = [note for stream in chosen for note in stream.notes()]
        notes.sort(key=lambda note: (note.onset_tick, note.pitch))
        voices = split_voices(notes, tempo_map, min(MOST_VOICES, room)) if wish.split else [tuple(notes)]
        curves = next((stream.curves for stream in chosen if stream.curves), ())
        name = wish.name or chosen[0].name or chosen[0].instrument_name
        lead = msgspec.structs.replace(chosen[0], curves=curves)
        mine = _parts(lead, name, instrument, voices, found, wish.written)
        parts += mine
        left_out = len(notes) - sum(map(len, voices))
        if left_out:
            arguments: dict[str, Argument] = {"part": mine[0].name, "most": len(mine), "count": left_out}
            warnings.append(Message("score.notes_left_out", arguments))
        elif len(mine) > 1:
            warnings.append(Message("score.voices", {"part": mine[0].name, "voices": len(mine)}))
        if found.how is not How.RANGE and not wish.written:
            warnings += _written_warnings(mine, maps)
        if wish.map_id is not None:
            continue
        if found.how is How.RANGE:
            warnings += [_range_warning(part, maps) for part in mine]
            continue
        if found.how is How.FILE:
            warnings.append(Message("score.told_by_file", {"part": mine[0].name, "map": mine[0].map_id}))
        if instrument is not None:
            warnings += _substitutions(mine, instrument, maps)
    crowded = {index for wish in wishes for index in wish.streams} - asked
    unplayed = tuple(
        UnplayedPart(
            stream_name(stream),
            Message("score.too_many_players", {"most": MOST_PARTS})
            if index in crowded
            else refusal(stream, maps) or Message("score.left_out"),
            len(stream.pitches),
            max(stream.end_ticks),
        )
        for index, stream in enumerate(streams)
        if index not in asked
    )
    return tuple(parts), unplayed, tuple(warnings)


def _substitutions(parts: Sequence[Part], instrument: Instrument, maps: Sequence[MapChoice]) -> list[Message]:
    """A warning for each map that only stands in for the instrument."""
    return [
        Message("score.substituted", {"part": parts[0].name, "instrument": instrument.names[0], "map": map_id})
        for map_id in dict.fromkeys(part.map_id for part in parts)
        if not any(choice.map_id == map_id and plays(choice, instrument) for choice in maps)
    ]


def _found(chosen: Sequence[Stream], map_id: str | None, maps: Sequence[MapChoice]) -> Candidates:
    """The maps a wish may be given to: the one a person named, else what the tracks say and fit."""
    named = tuple(choice for choice in maps if choice.map_id == map_id)
    found = candidates(chosen, maps)
    if not named and not found.maps:
        # A person wants it played though no map is for it.
        return Candidates(How.RANGE, found.instrument, tuple(maps))
    return Candidates(How.SAID, found.instrument, named) if named else found


def stream_name(stream: Stream) -> str:
    """What a person calls a stream."""
    instrument = recognised(stream)
    return stream.name or stream.instrument_name or (instrument.names[0] if instrument else f"Track {stream.track + 1}")


def _parts(
    stream: Stream,
    name: str,
    instrument: Instrument | None,
    voices: Sequence[tuple[Note, ...]],
    found: Candidates,
    written: bool,
) -> list[Part]:
    """A part for every voice."""
    parts = []
    for voice, notes in enumerate(voices):
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
            )
        )
    return parts


def transposed(notes: tuple[Note, ...], semitones: int) -> tuple[Note, ...]:
    """The notes so much higher; those that MIDI has no number for as far as it goes."""
    if not semitones:
        return notes
    return tuple(msgspec.structs.replace(note, pitch=min(max(note.pitch + semitones, 0), 127)) for note in notes)


def _written_warnings(parts: Sequence[Part], maps: Sequence[MapChoice]) -> list[Message]:
    """Of parts that the instrument has no notes for unless they are read as they are written."""
    choices = {choice.map_id: choice for choice in maps}
    found = []
    for part in parts:
        choice, pitches = choices[part.map_id], [note.pitch for note in part.notes]
        outside, total = choice.outside(pitches), len(pitches)
        # A wrong note or two in a long part says nothing.
        if outside >= LEAST_OUTSIDE * total and outside and not choice.outside(pitches, written=True):
            found.append(
                Message(
                    "score.looks_written",
                    {"part": part.name, "map": part.map_id, "outside": outside, "total": total},
                )
            )
    return found


def _range_warning(part: Part, maps: Sequence[MapChoice]) -> Message:
    choice = next(choice for choice in maps if choice.map_id == part.map_id)
    outside = choice.outside([note.pitch for note in part.notes])
    if outside == 0:
        return Message("score.chosen_by_range", {"part": part.name, "map": part.map_id})
    return Message(
        "score.chosen_by_range_partly",
        {"part": part.name, "map": part.map_id, "outside": outside, "total": len(part.notes)},
    )


def _name_of(choice: MapChoice) -> str:
    """The English name of the instrument that a map plays."""
    known = vocabulary().instruments
    return next((known[id_].names[0] for id_ in choice.plays if id_ in known), choice.map_id)
