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
score.chosen_by_range : part, map
    "{part}: neither its name nor its program says what it is; {map} plays it because the range fits"
score.chosen_by_range_partly : part, map, outside, total
    "{part}: neither its name nor its program says what it is; {map} plays it, though {outside} of {total} notes lie
    outside its range"
score.left_out : (a reason)
    "left out on import"
score.voices : part, voices
    "{part}: up to {voices} notes sound together, so {voices} players share it"
"""

from __future__ import annotations

from collections.abc import Sequence
from operator import sub

import msgspec

from app.errors import Message
from app.score.model import ControllerCurve, Note, Part, UnplayedPart
from app.score.tempo import TempoMap
from app.score.voices import split_voices
from instrument_maps.vocabulary import Instrument, vocabulary

PERCUSSION_CHANNEL = 9
_NEEDED_SHARE = 0.5


class MapChoice(msgspec.Struct, frozen=True):
    """What an instrument map can be chosen for.

    Attributes
    ----------
    map_id : str
    plays, substitutes_for : tuple of str
        Ids in the vocabulary of instruments: its own, and those it may stand in for.
    concert_low, concert_high : int
        Its range at concert pitch, both included, MIDI numbers.
    """

    map_id: str
    plays: tuple[str, ...]
    substitutes_for: tuple[str, ...]
    concert_low: int
    concert_high: int


class Stream(msgspec.Struct, frozen=True):
    """The notes of one track on one channel, as read.

    Attributes
    ----------
    track : int
        Counted from 0.
    channel : int
    name, instrument_name : str
        The track's texts for people, empty if there are none.
    program : int or None
    onset_ticks, end_ticks, pitches, velocities, numbers : list of int
        One entry per note, by onset; ``numbers`` is the note's place among the track's note-ons, from 1.
    curves : tuple of ControllerCurve
    """

    track: int
    channel: int
    name: str
    instrument_name: str
    program: int | None
    onset_ticks: list[int]
    end_ticks: list[int]
    pitches: list[int]
    velocities: list[int]
    numbers: list[int]
    curves: tuple[ControllerCurve, ...]

    def notes(self) -> list[Note]:
        """The notes, in the same order."""
        ids = [f"{self.track + 1}:{number}" for number in self.numbers]
        durations = map(sub, self.end_ticks, self.onset_ticks)
        return list(map(Note, ids, self.onset_ticks, durations, self.pitches, self.velocities))


def recognised(stream: Stream) -> Instrument | None:
    """The instrument that names or numbers give to a track; None if they give none."""
    words = vocabulary()
    named = [words.by_name(text) for text in (stream.name, stream.instrument_name) if text]
    telling = next((found for found in named if found is not None and not found.vague), None)
    if telling is not None:
        return telling
    vague = next((found for found in named if found is not None), None)
    if stream.channel == PERCUSSION_CHANNEL:
        return vague or words.instruments["drums"]
    numbered = None if stream.program is None else words.by_program(stream.program)
    return numbered if vague is None or (numbered is not None and numbered.kind == "wind") else vague


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
    """

    streams: tuple[int, ...]
    map_id: str | None = None
    name: str = ""
    split: bool = True


def usual_wishes(streams: Sequence[Stream], maps: Sequence[MapChoice]) -> tuple[PartWish, ...]:
    """What names, programs and ranges say: a wish, which a person may change, for every stream somebody can play."""
    return tuple(
        PartWish((index,)) for index, stream in enumerate(streams) if _refusal(stream, recognised(stream), maps) is None
    )


def wished_parts(
    streams: Sequence[Stream], wishes: Sequence[PartWish], maps: Sequence[MapChoice], tempo_map: TempoMap
) -> tuple[tuple[Part, ...], tuple[UnplayedPart, ...], tuple[Message, ...]]:
    """Sort tracks into the parts that a person wants and those nobody plays, and say what was guessed.

    Parameters
    ----------
    streams : sequence of Stream
    wishes : sequence of PartWish
        A stream is asked for at most once.
    maps : sequence of MapChoice
    tempo_map : TempoMap
    """
    parts: list[Part] = []
    warnings: list[Message] = []
    for wish in wishes:
        chosen = [streams[index] for index in wish.streams]
        instrument = next((found for found in map(recognised, chosen) if found is not None), None)
        # What is not known, or has no map of its own, goes to the one whose range fits.
        known = [] if instrument is None or instrument.any_pitch else _maps_for(instrument, maps)
        candidates = [choice for choice in maps if choice.map_id == wish.map_id] or known or list(maps)
        notes = [note for stream in chosen for note in stream.notes()]
        if len(chosen) > 1:
            notes.sort(key=lambda note: (note.onset_tick, note.pitch))
        voices = split_voices(notes, tempo_map) if wish.split else [tuple(notes)]
        curves = next((stream.curves for stream in chosen if stream.curves), ())
        name = wish.name or chosen[0].name or chosen[0].instrument_name
        mine = _parts(msgspec.structs.replace(chosen[0], curves=curves), name, instrument, voices, candidates)
        parts += mine
        if len(mine) > 1:
            warnings.append(Message("score.voices", {"part": mine[0].name, "voices": len(mine)}))
        if wish.map_id is not None:
            continue
        if not known:
            warnings += [_range_warning(part, maps) for part in mine]
        elif instrument is not None:
            warnings += _substitutions(mine, instrument, maps)
    asked = {index for wish in wishes for index in wish.streams}
    unplayed = tuple(
        UnplayedPart(
            stream_name(stream),
            _refusal(stream, recognised(stream), maps) or Message("score.left_out"),
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
        if not any(choice.map_id == map_id and instrument.id in choice.plays for choice in maps)
    ]


def stream_name(stream: Stream) -> str:
    """What a person calls a stream."""
    instrument = recognised(stream)
    return stream.name or stream.instrument_name or (instrument.names[0] if instrument else f"Track {stream.track + 1}")


def _parts(
    stream: Stream,
    name: str,
    instrument: Instrument | None,
    voices: Sequence[tuple[Note, ...]],
    candidates: Sequence[MapChoice],
) -> list[Part]:
    """A part for every voice."""
    parts = []
    for voice, notes in enumerate(voices):
        chosen = _best_by_range([note.pitch for note in notes], candidates)
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
                notes=notes,
                curves=stream.curves,
            )
        )
    return parts


def _maps_for(instrument: Instrument, maps: Sequence[MapChoice]) -> list[MapChoice]:
    """The maps that play an instrument, else those that stand in for it."""
    return [choice for choice in maps if instrument.id in choice.plays] or [
        choice for choice in maps if instrument.id in choice.substitutes_for
    ]


def _refusal(stream: Stream, instrument: Instrument | None, maps: Sequence[MapChoice]) -> Message | None:
    """Why nobody plays a track; None if somebody does."""
    if instrument is not None and not instrument.any_pitch:
        if instrument.kind != "wind":
            id_ = "score.percussion" if instrument.kind == "percussion" else "score.not_wind"
            return Message(id_, {"instrument": instrument.names[0]})
        return None if _maps_for(instrument, maps) else Message("score.no_map", {"instrument": instrument.names[0]})
    if max((_share(stream.pitches, choice) for choice in maps), default=0.0) <= _NEEDED_SHARE:
        return Message("score.outside_ranges", {"lowest": min(stream.pitches), "highest": max(stream.pitches)})
    return None


def _share(pitches: Sequence[int], choice: MapChoice) -> float:
    """How many of the notes a map reaches, 0..1."""
    if choice.concert_low <= min(pitches) and max(pitches) <= choice.concert_high:
        return 1.0
    return sum(choice.concert_low <= pitch <= choice.concert_high for pitch in pitches) / len(pitches)


def _best_by_range(pitches: Sequence[int], candidates: Sequence[MapChoice]) -> MapChoice:
    """The map that reaches most of the notes; among equals the one whose limits they stay away from furthest."""
    lowest, highest = min(pitches), max(pitches)

    def rank(choice: MapChoice) -> tuple[float, int]:
        return _share(pitches, choice), min(lowest - choice.concert_low, choice.concert_high - highest)

    return max(candidates, key=rank)


def _range_warning(part: Part, maps: Sequence[MapChoice]) -> Message:
    choice = next(choice for choice in maps if choice.map_id == part.map_id)
    outside = sum(not choice.concert_low <= note.pitch <= choice.concert_high for note in part.notes)
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
