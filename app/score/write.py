"""Writes a score as a MIDI file of format 1: a conductor track, one track for each part, and one for percussion.

`app.score.read` restores from the file: title, division, tempo, metres, pickup and markers; for every part its name,
instrument, all notes (onset, length, pitch, velocity) and all controller steps; all percussion hits, on channel 10 with
General MIDI numbers. MIDI cannot hold the following:

- Notes of parts without a player, except percussion; the lengths of percussion notes; ids of notes and parts, which are
  counted anew when the file is read. Voices that shared a track get separate tracks. A part without notes gets a track,
  which is not read as a part.
- The user's choice of an instrument that differs from the part's name, since names have priority when a file is read: a
  part named "Violin" that the user assigned to a flute becomes a violin part again. A part with notes that sound
  together is divided among players again. Both are reported.
- A note that lies within another one of the same pitch: a note-off ends the older of two notes, so the two exchange
  their ends. This is reported. (Notes that only overlap keep their ends.)
- More than fifteen parts of one name and program: two on one channel of which one ends before the other begins are read
  as one.
- A part's channel, if another part or the percussion uses it: the part gets a free channel; if there is none, channels
  are used again, and only the tracks separate the parts. A part without a program gets its instrument's, since it would
  otherwise sound like a piano in other programs.
- Fractions: tempi are whole microseconds per quarter, controllers have 128 steps, and pitch bends have 16384 steps over
  the range set in the file, of which the upper end is not quite reached (8191/8192). Texts lose control characters and
  spaces around them.
- A metre that only repeats the previous one at a bar line. A short first bar is read as a pickup.

The bite is written to controller 16 ("general purpose controller 1"), since MIDI defines no controller for it; a
receiver would answer a modulation controller (1) or vibrato depth (77) with an additional vibrato.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping, Sequence
from operator import itemgetter
from pathlib import Path
from typing import Final, TypeAlias

import mido
import msgspec

from app.errors import AppError, Message
from app.formats.atomic import atomic_write
from app.score.bend_range import range_controls, range_for, wheel
from app.score.channel_sound import DRUM_CHANNEL
from app.score.instrument_choice import MapChoice, plays
from app.score.model import ControllerCurve, CurveKind, Note, Part, Score
from app.score.tempo import TempoChange
from app.score.tracks import CONTROLLERS, LEAST_TEMPO
from app.score.voices import is_one_voice
from instrument_maps.instrument_names import vocabulary
from instrument_maps.instruments import Instrument

MOST_TEMPO: Final = 0xFFFFFF
"""Greatest microseconds per quarter: 24 bits."""
_LONGEST_DELTA: Final = 0x0FFFFFFF
"""Greatest number of ticks between two events: four groups of seven bits."""
_CHANNELS: Final = tuple(channel for channel in range(16) if channel != DRUM_CHANNEL)

_KIT: Final = "drums"
"""Id of drums in the vocabulary."""

# Order at one tick: note-offs, programs, controllers, note-ons.
_OFF, _PROGRAM, _CONTROL, _ON = range(4)

_Event: TypeAlias = tuple[int, int, mido.Message | mido.MetaMessage]
"""Tick, order within the tick, and message."""


class PartPlayer(msgspec.Struct, frozen=True):
    """Name and instrument of the player of a part, for writing.

    Attributes
    ----------
    name : str
        Name of the part's track.
    choice : MapChoice
        The instrument.
    """

    name: str
    choice: MapChoice


class MidiFile(msgspec.Struct, frozen=True):
    """Bytes of a MIDI file, and warnings about content that it cannot hold."""

    data: bytes
    warnings: tuple[Message, ...]


def write_midi(score: Score, path: Path, performers: Mapping[str, PartPlayer] | None = None) -> tuple[Message, ...]:
    """Write a score as a MIDI file; on failure no partial file remains.

    Parameters
    ----------
    performers : mapping of str to PartPlayer, optional
        Player of each part by part id; a missing part uses its own name and instrument.

    Returns
    -------
    tuple of Message
        Warnings about content that the file cannot hold.

    Raises
    ------
    AppError
        The tempo exceeds what MIDI can store, or the file cannot be written.
    """
    made = midi_file(score, performers)
    with atomic_write(path) as stream:
        stream.write(made.data)
    return made.warnings


def midi_file(score: Score, performers: Mapping[str, PartPlayer] | None = None) -> MidiFile:
    """Convert a score to the bytes of a MIDI file; parameters and errors as of `write_midi`."""
    performing = performers or {}
    warnings: list[Message] = []
    # Encoding of texts; Latin-1 is mido's default.
    file = mido.MidiFile(type=1, ticks_per_beat=score.ticks_per_quarter, charset="utf-8")
    file.tracks.append(_track(_conductor(score)))
    names = [performing[part.id].name if part.id in performing else part.name for part in score.parts]
    for part, name, channel in zip(score.parts, names, _channels(score.parts, names), strict=True):
        performer = performing.get(part.id)
        instrument = _instrument(part, performer)
        warnings += _warnings(part, name, performer, score)
        file.tracks.append(_track(_part(part, name, instrument, channel)))
    if score.percussion:
        file.tracks.append(_track(_percussion(score)))
    data = io.BytesIO()
    file.save(file=data)
    return MidiFile(data.getvalue(), tuple(warnings))


def _channels(parts: Sequence[Part], names: Sequence[str]) -> list[int]:
    """Choose a channel for each part: its own if no earlier part has it, else a free one, else one not used by a part
    of the same name, since tracks with equal name and channel may be read as one player's.
    """
    own: dict[int, int] = {}
    for index, part in enumerate(parts):
        if part.channel != DRUM_CHANNEL:
            own.setdefault(part.channel, index)
    free = [channel for channel in _CHANNELS if channel not in own]
    channels: list[int] = []
    of_name = {
        name: {part.channel for part, other in zip(parts, names, strict=True) if other == name} for name in names
    }
    for index, part in enumerate(parts):
        if own.get(part.channel) == index:
            channels.append(part.channel)
        elif free:
            channels.append(free.pop(0))
        else:
            turn = index % len(_CHANNELS)
            possible = [*_CHANNELS[turn:], *_CHANNELS[:turn]]
            channels.append(next((one for one in possible if one not in of_name[names[index]]), possible[0]))
        of_name[names[index]].add(channels[-1])
    return channels


def _instrument(part: Part, performer: PartPlayer | None) -> Instrument | None:
    """Return the instrument to write for a part: the part's own if the player's map fits it, else the map's
    instrument.
    """
    known = vocabulary().instruments
    own = known.get(part.instrument or "")
    if performer is None or (own is not None and _may_play(performer.choice, own)):
        return own
    return next((known[id] for id in performer.choice.plays if id in known), own)


def _may_play(choice: MapChoice, instrument: Instrument) -> bool:
    return instrument.any_pitch or plays(choice, instrument) or instrument.id in choice.substitutes_for


def _warnings(part: Part, name: str, performer: PartPlayer | None, score: Score) -> Iterable[Message]:
    nested = _nested(part.notes)
    if nested:
        yield Message("midi.nested_notes", {"part": name, "count": nested})
    if not is_one_voice(part.notes, score.tempo_map):
        yield Message("midi.shared_again", {"part": name})
    said = vocabulary().by_name(name)
    if performer is not None and said is not None and not said.vague and not _may_play(performer.choice, said):
        played = _instrument(part, performer) or said
        if played is not said:
            yield Message("midi.name_says_other", {"part": name, "said": said.names[0], "played": played.names[0]})


def _nested(notes: Sequence[Note]) -> int:
    """Return the number of notes that end before an earlier note of the same pitch does."""
    last_end: dict[int, int] = {}
    count = 0
    for note in sorted(notes, key=lambda note: (note.onset_tick, note.end_tick)):
        count += note.end_tick < last_end.get(note.pitch, 0)
        last_end[note.pitch] = max(last_end.get(note.pitch, 0), note.end_tick)
    return count


def _conductor(score: Score) -> list[_Event]:
    events = [(0, 0, mido.MetaMessage("track_name", name=score.title))]
    for change in score.tempo_map.changes:
        tempo = round(change.microseconds_per_quarter)
        if not LEAST_TEMPO <= tempo <= MOST_TEMPO:
            raise _unwritable(score, change)
        events.append((change.tick, 2, mido.MetaMessage("set_tempo", tempo=tempo)))
    events += [
        (metre.tick, 1, mido.MetaMessage("time_signature", numerator=metre.numerator, denominator=metre.denominator))
        for metre in score.metres
    ]
    return events + [(marker.tick, 3, mido.MetaMessage("marker", text=marker.text)) for marker in score.markers]


def _unwritable(score: Score, change: TempoChange) -> AppError:
    return AppError(
        "midi.tempo_unwritable",
        place=score.metre_map.label(change.tick),
        bpm=round(60e6 / change.microseconds_per_quarter, 3),
        low=round(60e6 / MOST_TEMPO, 3),
        high=round(60e6 / LEAST_TEMPO),
    )


def _part(part: Part, name: str, instrument: Instrument | None, channel: int) -> list[_Event]:
    events = [(0, _OFF, mido.MetaMessage("track_name", name=name))]
    if instrument is not None:
        events.append((0, _OFF, mido.MetaMessage("instrument_name", name=instrument.names[0])))
    program = part.program
    if program is None and instrument is not None:
        program = next(iter(instrument.programs), None)
    if program is not None:
        events.append((0, _PROGRAM, mido.Message("program_change", channel=channel, program=program)))
    for curve in part.curves:
        events += _steps(curve, channel)
    # Of notes that begin together at one pitch the shortest comes first, because a note-off ends the oldest.
    for note in sorted(part.notes, key=lambda note: (note.onset_tick, note.pitch, note.duration_tick)):
        on = mido.Message("note_on", channel=channel, note=note.pitch, velocity=note.velocity)
        off = mido.Message("note_off", channel=channel, note=note.pitch)
        events += [(note.onset_tick, _ON, on), (note.end_tick, _OFF, off)]
    return events


def _percussion(score: Score) -> list[_Event]:
    """Convert percussion hits to notes that last until the next hit of the same sound, at most a sixteenth."""
    events: list[_Event] = [(0, _OFF, mido.MetaMessage("track_name", name=vocabulary().instruments[_KIT].names[0]))]
    longest = max(score.ticks_per_quarter // 4, 1)
    again: dict[int, int] = {}
    ends: dict[int, int] = {}
    for hit in reversed(score.percussion):
        if again.get(hit.pitch) != hit.tick:
            ends[hit.pitch] = min(hit.tick + longest, again.get(hit.pitch, hit.tick + longest))
            again[hit.pitch] = hit.tick
        on = mido.Message("note_on", channel=DRUM_CHANNEL, note=hit.pitch, velocity=hit.velocity)
        off = mido.Message("note_off", channel=DRUM_CHANNEL, note=hit.pitch)
        events += [(hit.tick, _ON, on), (ends[hit.pitch], _OFF, off)]
    return events


def _steps(curve: ControllerCurve, channel: int) -> list[_Event]:
    if curve.kind == "pitch_bend":
        return _bends(curve, channel)
    return [
        (tick, _CONTROL, _step(curve.kind, value, channel))
        for tick, value in zip(curve.ticks, curve.values, strict=True)
    ]


def _bends(curve: ControllerCurve, channel: int) -> list[_Event]:
    """Pitch bend messages of a curve, after messages that set the necessary bend range; the range is always set, since
    another part may have changed it on the channel.
    """
    semitones = range_for(curve.values)
    events: list[_Event] = [
        (0, _PROGRAM, mido.Message("control_change", channel=channel, control=control, value=value))
        for control, value in range_controls(semitones)
    ]
    for tick, value in zip(curve.ticks, curve.values, strict=True):
        bend = mido.Message("pitchwheel", channel=channel, pitch=wheel(value, semitones))
        events.append((tick, _CONTROL, bend))
    return events


def _step(kind: CurveKind, value: float, channel: int) -> mido.Message:
    level = min(max(round(127 * value), 0), 127)
    if kind == "aftertouch":
        return mido.Message("aftertouch", channel=channel, value=level)
    return mido.Message("control_change", channel=channel, control=CONTROLLERS[kind], value=level)


def _track(events: list[_Event]) -> mido.MidiTrack:
    """Build a MIDI track with delta times from events (tick, rank, message), which are sorted first."""
    events.sort(key=itemgetter(0, 1))
    track = mido.MidiTrack()
    at = 0
    for tick, _, message in events:
        delta = tick - at
        while delta > _LONGEST_DELTA:
            track.append(mido.MetaMessage("text", time=_LONGEST_DELTA))
            delta -= _LONGEST_DELTA
        message.time = delta
        track.append(message)
        at = tick
    return track
