"""Collects the messages of one MIDI track by subject."""

from __future__ import annotations

from bisect import bisect_right
from collections import deque
from collections.abc import Collection, Iterable, Sequence
from operator import itemgetter
from typing import Any, Final, Literal, TypeAlias

import msgspec

from app.errors import Message
from app.score.bend_range import PARAMETERS, RESET
from app.score.channel_notes import ChannelNotes, end_late, end_unended, end_where_struck_again
from app.score.channel_sound import ChannelSound
from app.score.limits import LAST_TICK, MOST_NAME
from app.score.model import CurveKind
from app.score.sound_module import FIRST_PORT, Port, Setup, Setups
from app.score.texts import TextDecoder

CONTROLLERS: Final[dict[CurveKind, int]] = {"breath": 2, "volume": 7, "expression": 11, "bite": 16}
"""Numbers of the MIDI controllers by kind of curve."""
LEAST_TEMPO: Final = 10_000
"""Least microseconds per quarter; a smaller value (over 6000 quarters per minute) is damage."""
SentKind: TypeAlias = CurveKind | Literal["modulation", "timbre"]
"""Kinds of sent curves. Modulation is the dynamics of sampled winds and strings or the depth of vibrato; timbre may be
the breath of an MPE controller.
"""
_KINDS: Final[dict[int, SentKind]] = {
    1: "modulation",
    74: "timbre",
    **{number: kind for kind, number in CONTROLLERS.items()},
}
_NOTES_OFF = frozenset({120, 123})
_BANK: Final = 0
"""Controller 0, the MSB of the bank."""
_LONGEST_EXCLUSIVE: Final = 256
"""Greatest size in bytes of a message to a sound module; longer ones are memory dumps."""
_SOUND_MODULES: Final = frozenset((0x41, 0x43, 0x7E))
"""Manufacturer ids of Roland, Yamaha, and of universal messages."""
_TRACKS_NAMED: Final = 8
"""Greatest number of tracks listed for a file without notes."""


class TrackEvents(msgspec.Struct):
    """Events of one track.

    Attributes
    ----------
    name, instrument_name : bytes
        First track name and first instrument name in the track.
    texts : list of (tick, text)
        Text events.
    tempos : list of (tick, microseconds per quarter)
        Tempo changes.
    metres : list of (tick, numerator, denominator)
        Time signatures.
    markers : list of (tick, text)
        Markers and cue points.
    programs : dict of channel to list of (tick, program)
        Program changes.
    channels : dict of channel to ChannelNotes
        Channels with notes.
    setups : list of Setup
        Messages that change the sounds of channels.
    port : Port or None
        Port of the notes; None if the track names none.
    sounds : dict of channel to list of (tick, ChannelSound)
        Sounds of channels with notes from each tick on; set once all tracks are collected.
    controls : dict of (channel, kind) to dict of tick to value
        Value of each controller by tick; pitch bends as a share of their channel's range.
    parameters : list of (tick, channel, control, value)
        Controllers that set the pitch bend range (`app.score.bend_range`).
    after_end : int
        Number of notes after an end-of-track, which is then ignored.
    hanging, zero_length : int
        Notes without an end, notes without a length.
    beyond : int
        Number of events dropped because they are after the last allowed tick.
    end_tick : int
        Tick of the track's end.
    """

    name: bytes = b""
    instrument_name: bytes = b""
    texts: list[tuple[int, bytes]] = []
    tempos: list[tuple[int, int]] = []
    metres: list[tuple[int, int, int]] = []
    markers: list[tuple[int, bytes]] = []
    programs: dict[int, list[tuple[int, int]]] = {}
    setups: list[Setup] = []
    port: Port | None = None
    sounds: dict[int, list[tuple[int, ChannelSound]]] = {}
    channels: dict[int, ChannelNotes] = {}
    controls: dict[tuple[int, SentKind], dict[int, float]] = {}
    parameters: list[tuple[int, int, int, int]] = []
    after_end: int = 0
    hanging: int = 0
    zero_length: int = 0
    beyond: int = 0
    end_tick: int = 0

    @property
    def last_tick(self) -> int:
        """Return the tick at which the last note ends; 0 without notes."""
        return max((max(notes.end_ticks) for notes in self.channels.values()), default=0)

    def notes(self, channels: Collection[int]) -> ChannelNotes:
        """The notes of some channels together, in the order of the track."""
        if len(channels) == 1:
            return self.channels[next(iter(channels))]
        together = [self.channels[channel] for channel in channels]
        rows = sorted(
            (row for notes in together for row in zip(*msgspec.structs.astuple(notes), strict=True)), key=itemgetter(-1)
        )
        return ChannelNotes(*map(list, zip(*rows, strict=True)))

    @property
    def said_of_sounds(self) -> Setups:
        """Return the track's messages that change the sounds of channels."""
        first_onsets = {channel: notes.onset_ticks[0] for channel, notes in self.channels.items()}
        return Setups(self.setups, first_onsets, self.port)

    def sound_at(self, channel: int, tick: int) -> ChannelSound:
        """Return the sound of a channel with notes at a tick."""
        changes = self.sounds[channel]
        return changes[max(bisect_right(changes, tick, key=itemgetter(0)) - 1, 0) if len(changes) > 1 else 0][1]

    def is_melodic(self, channel: int) -> bool:
        """Return whether a channel has only melodic sounds, no drums or effects, throughout."""
        return all(sound.use == "melodic" for _, sound in self.sounds[channel])

    def take_turns(self, channels: Collection[int]) -> bool:
        """Return whether the notes of different channels never overlap."""
        spans = sorted(
            (onset, end, channel)
            for channel in channels
            for onset, end in zip(self.channels[channel].onset_ticks, self.channels[channel].end_ticks, strict=True)
        )
        ends = dict.fromkeys(channels, 0)
        for onset, end, channel in spans:
            if any(onset < ends[other] for other in channels if other != channel):
                return False
            ends[channel] = max(ends[channel], end)
        return True


def gather(messages: Iterable[Any], begin_tick: int, most_unended_ticks: int) -> TrackEvents:
    """Gather the messages of one track.

    Parameters
    ----------
    messages : iterable of mido messages
        Messages of the track, with delta times.
    begin_tick : int
        Tick at which the track begins.
    most_unended_ticks : int
        Longest length of a note without note-off.
    """
    events = TrackEvents()
    sounding: dict[int, dict[int, deque[int]]] = {}
    silenced: dict[int, dict[int, int]] = {}
    struck_again: set[int] = set()
    channels = events.channels
    tick = begin_tick
    number = 0
    for message in _until_end(events, list(messages)):
        tick += message.time
        kind = message.type
        if kind == "note_on" and message.velocity:
            channel, pitch = message.channel, message.note
            number += 1
            notes = channels.get(channel)
            if notes is None:
                notes = channels[channel] = ChannelNotes()
                sounding[channel], silenced[channel] = {}, {}
            same_pitch = sounding[channel].setdefault(pitch, deque())
            if same_pitch:
                struck_again.add(channel)
            same_pitch.append(len(notes.pitches))
            notes.onset_ticks.append(tick)
            notes.end_ticks.append(-1)
            notes.pitches.append(pitch)
            notes.velocities.append(message.velocity)
            notes.numbers.append(number)
        elif kind == "note_off" or kind == "note_on":
            channel = message.channel
            open_notes = sounding[channel].get(message.note) if channel in channels else None
            if open_notes:
                channels[channel].end_ticks[open_notes.popleft()] = tick
        elif kind == "control_change" and message.control in _NOTES_OFF:
            for open_notes in sounding.pop(message.channel, {}).values():
                silenced[message.channel].update(dict.fromkeys(open_notes, tick))
            sounding[message.channel] = {}
        elif kind != "end_of_track":
            _note_other(events, message, kind, tick)
    events.end_tick = tick
    for channel, notes in channels.items():
        if min(notes.end_ticks) < 0:
            events.hanging += end_unended(notes, silenced[channel], most_unended_ticks, tick)
        if channel in struck_again:
            end_where_struck_again(notes)
            end_late(notes)
    _close(events)
    return events


def _until_end(events: TrackEvents, messages: Sequence[Any]) -> Sequence[Any]:
    """Return the messages up to the end-of-track; all messages if notes follow it."""
    ends = next((place for place, message in enumerate(messages) if message.type == "end_of_track"), len(messages))
    events.after_end = sum(message.type == "note_on" and message.velocity > 0 for message in messages[ends:])
    return messages if events.after_end else messages[: ends + 1]


def _note_other(events: TrackEvents, message: Any, kind: str, tick: int) -> None:
    """Add a MIDI message that is not a note, such as a controller, program or tempo, to the track's events."""
    if tick > LAST_TICK:
        events.beyond += 1
    elif kind == "control_change":
        if message.control == _BANK:
            _set_up(events, tick, message.channel, "bank", message.value)
        curve = _KINDS.get(message.control)
        if curve is not None:
            events.controls.setdefault((message.channel, curve), {})[tick] = message.value / 127
        elif message.control in PARAMETERS:
            events.parameters.append((tick, message.channel, message.control, message.value))
            if message.control == RESET and (bends := events.controls.get((message.channel, "pitch_bend"))):
                bends[tick] = 0.0
    elif kind == "pitchwheel":
        events.controls.setdefault((message.channel, "pitch_bend"), {})[tick] = message.pitch / 8192
    elif kind in ("aftertouch", "polytouch"):
        events.controls.setdefault((message.channel, "aftertouch"), {})[tick] = message.value / 127
    elif kind == "program_change":
        events.programs.setdefault(message.channel, []).append((tick, message.program))
        _set_up(events, tick, message.channel, "program", message.program)
    elif kind == "sysex":
        if message.data[:1] and message.data[0] in _SOUND_MODULES and len(message.data) <= _LONGEST_EXCLUSIVE:
            _set_up(events, tick, -1, "exclusive", bytes(message.data))
    elif kind in ("midi_port", "device_name"):
        _connect(events, message)
    elif kind == "set_tempo":
        events.tempos.append((tick, message.tempo))
    elif kind == "time_signature":
        events.metres.append((tick, message.numerator, message.denominator))
    elif kind == "track_name":
        events.name = events.name or message.name.encode("latin-1")
    elif kind == "instrument_name":
        events.instrument_name = events.instrument_name or message.name.encode("latin-1")
    elif kind == "text":
        events.texts.append((tick, message.text.encode("latin-1")))
    elif kind in ("marker", "cue_marker"):
        events.markers.append((tick, message.text.encode("latin-1")))


def _set_up(
    events: TrackEvents, tick: int, channel: int, kind: Literal["program", "bank", "exclusive"], value: int | bytes
) -> None:
    events.setups.append(Setup(tick, len(events.setups), channel, kind, value, events.port))


def _connect(events: TrackEvents, message: Any) -> None:
    """Store the port or device that a message selects; ignored once the track has notes."""
    if events.channels:
        return
    number, device = events.port or FIRST_PORT
    if message.type == "midi_port":
        events.port = message.port, device
    else:
        events.port = number, message.name.encode("latin-1")


def _close(events: TrackEvents) -> None:
    """Give notes without length a length of one tick."""
    for notes in events.channels.values():
        ends = notes.end_ticks
        for index, (onset, end) in enumerate(zip(notes.onset_ticks, ends, strict=True)):
            if end == onset:
                events.zero_length += 1
                ends[index] = onset + 1


def no_notes(tracks: Sequence[TrackEvents], counts: Sequence[int], texts: TextDecoder) -> list[Message]:
    """Return warnings if none of the tracks has notes, with the number of events in each track (``counts``); empty
    otherwise.
    """
    if any(events.channels for events in tracks):
        return []
    warnings = [Message("midi.no_notes", {"tracks": len(tracks)})]
    for number, (events, count) in enumerate(zip(tracks[:_TRACKS_NAMED], counts, strict=False), 1):
        name = texts.read(events.name)[:MOST_NAME]
        if name:
            warnings.append(Message("midi.track_without_notes", {"track": number, "name": name, "count": count}))
        else:
            warnings.append(Message("midi.unnamed_track_without_notes", {"track": number, "count": count}))
    return warnings
