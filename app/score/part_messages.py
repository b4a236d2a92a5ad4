"""Messages about guesses made for parts, and about notes left out of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import msgspec

from app.errors import Argument, Message
from app.score.assignments import PartAssignment, fits_as_written
from app.score.clean import Fault
from app.score.instrument_choice import How, MapCandidates, MapChoice, plays
from app.score.model import Note, Part, Score, UnplayedPart, transposed
from instrument_maps.instruments import Instrument

_MOST_PLACES: Final = 5
"""Greatest number of places listed in a message."""


def about_notes(id_: str, part: str, notes: Sequence[Note], piece: Score, **more: Argument) -> Message:
    """Create a message about some notes of a part, with their number and the position and pitch of the first."""
    first = notes[0]
    where: dict[str, Argument] = {"place": piece.metre_map.label(first.onset_tick), "pitch": first.pitch}
    return Message(id_, {"part": part, "count": len(notes), **where, **more})


def begins_after(message: Message, bar: int) -> bool:
    """Return whether a message is about notes that all come after a bar; False for messages without a position or about
    a whole part.
    """
    place = message.arguments.get("place")
    return isinstance(place, str) and "total" not in message.arguments and int(place.partition(".")[0]) > bar


def cleaned_take(part: str, faults: Mapping[Fault, list[Note]], piece: Score) -> Message:
    """Create the message about notes removed from a take: their number, the reasons, and the first positions."""
    notes = sorted((note for own in faults.values() for note in own), key=lambda note: note.onset_tick)
    places = list(dict.fromkeys(piece.metre_map.label(note.onset_tick) for note in notes))
    said = ", ".join(places[:_MOST_PLACES]) + (", ..." if len(places) > _MOST_PLACES else "")
    slips, doubles = (len(faults.get(fault, ())) for fault in ("slip", "double"))
    counts: dict[str, Argument] = {"slips": slips, "doubles": doubles, "silent": len(notes) - slips - doubles}
    return Message("score.take_cleaned", {"part": part, "count": len(notes), **counts, "places": said})


def silent_notes(id_: str, part: str, notes: Sequence[Note], piece: Score) -> list[UnplayedPart]:
    """Summarise notes of a part that its players leave out (such as stray notes and key switches) as one part without a
    player; empty if there are no such notes.
    """
    if not notes:
        return []
    return [UnplayedPart(part, about_notes(id_, part, notes, piece), len(notes), max(note.end_tick for note in notes))]


def instrument_warnings(
    parts: Sequence[Part], found: MapCandidates, assignment: PartAssignment, maps: Sequence[MapChoice], piece: Score
) -> list[Message]:
    """Return messages about an instrument that was guessed for parts of a file, such as by their range."""
    warnings = []
    if found.how is not How.RANGE:
        warnings += _written_warnings(parts, maps, piece)
    # An instrument chosen by the user is not reported as a guess.
    own = assignment.voice_maps
    parts = [part for voice, part in enumerate(parts) if voice >= len(own) or own[voice] is None]
    if assignment.map_id is not None or not parts:
        return warnings
    if found.how is How.RANGE:
        return [*warnings, *(_range_warning(part, maps, piece) for part in parts)]
    if found.how in _REASONS:
        warnings.append(Message(_REASONS[found.how], {"part": parts[0].name, "map": parts[0].map_id}))
    if found.refused is not None:
        warnings.append(_refused(parts, found.refused, maps, piece))
    elif found.instrument is not None:
        warnings += _substitutions(parts, found.instrument, maps)
        warnings += _other_sizes(parts, found, found.instrument)
    return warnings


_REASONS: Final = {How.TITLE: "score.instrument_from_title", How.ENSEMBLE: "score.chosen_by_ensemble"}


def _refused(parts: Sequence[Part], instrument: Instrument, maps: Sequence[MapChoice], piece: Score) -> Message:
    """Create the message about notes outside the range of the instrument that a track's program names."""
    own = [choice for choice in maps if plays(choice, instrument) or instrument.id in choice.substitutes_for]
    notes = sorted((note for part in parts for note in part.notes), key=lambda note: (note.onset_tick, note.pitch))
    outside = [note for note in notes if all(choice.outside([note.pitch]) for choice in own)]
    more: dict[str, Argument] = {
        "instrument": instrument.names[0],
        "map": parts[0].map_id,
        "outside": len(outside),
        "total": len(notes),
    }
    return about_notes("score.program_gives_way", parts[0].name, outside or notes, piece, **more)


def _substitutions(parts: Sequence[Part], instrument: Instrument, maps: Sequence[MapChoice]) -> list[Message]:
    """Return a warning for each map of a part that only substitutes for the part's instrument."""
    return [
        Message("score.substituted", {"part": parts[0].name, "instrument": instrument.names[0], "map": map_id})
        for map_id in dict.fromkeys(part.map_id for part in parts)
        if not any(choice.map_id == map_id and plays(choice, instrument) for choice in maps)
    ]


def _other_sizes(parts: Sequence[Part], found: MapCandidates, instrument: Instrument) -> list[Message]:
    """Return a warning for each map of another size or key that the range of the notes selected instead of the named
    instrument. Empty for instruments such as the tuba, whose players choose the key for each part.
    """
    if not found.exact or instrument.key_by_part:
        return []
    others = dict.fromkeys(part.map_id for part in parts if part.map_id not in found.exact)
    named: dict[str, Argument] = {"part": parts[0].name, "instrument": instrument.names[0]}
    return [Message("score.size_by_range", {**named, "map": map_id}) for map_id in others]


def _written_warnings(parts: Sequence[Part], maps: Sequence[MapChoice], piece: Score) -> list[Message]:
    """Warn of parts that fit their instrument only as written pitches, and report parts imported as written."""
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
        elif fits_as_written(choice, pitches):
            found.append(_outside("score.looks_written", given, choice, piece))
    return found


def _range_warning(part: Part, maps: Sequence[MapChoice], piece: Score) -> Message:
    choice = next(choice for choice in maps if choice.map_id == part.map_id)
    if choice.outside([note.pitch for note in part.notes]):
        return _outside("score.chosen_by_range_partly", part, choice, piece)
    return Message("score.chosen_by_range", {"part": part.name, "map": part.map_id})


def _outside(id_: str, part: Part, choice: MapChoice, piece: Score) -> Message:
    """Create the message about notes of a part that are outside its instrument's range."""
    notes = [note for note in part.notes if choice.outside([note.pitch])]
    return about_notes(id_, part.name, notes, piece, map=part.map_id, outside=len(notes), total=len(part.notes))
