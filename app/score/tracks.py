"""The messages of one MIDI track, gathered by what they are about."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from operator import itemgetter
from typing import Any, Final

import msgspec

from app.score.model import ControllerCurve, CurveKind

CONTROLLERS: Final[dict[CurveKind, int]] = {"breath": 2, "volume": 7, "expression": 11, "bite": 16}
"""The curves that are MIDI controllers, and their numbers."""
LEAST_TEMPO: Final = 10_000
"""Microseconds per quarter: nothing is played at 6000 quarters a minute, so less is damage."""
_KINDS: Final = {number: kind for kind, number in CONTROLLERS.items()}
_NOTES_OFF = frozenset({120, 123})


class ChannelNotes(msgspec.Struct):
    """The notes of one channel while they are gathered; parallel lists, by onset.

    ``numbers`` is the place of each among the note-ons of the track, from 1.
    """

    onset_ticks: list[int] = []
    end_ticks: list[int] = []
    pitches: list[int] = []
    velocities: list[int] = []
    numbers: list[int] = []


class TrackEvents(msgspec.Struct):
    """What one track says.

    Attributes
    ----------
    name, instrument_name : bytes
        The first of each.
    texts : list of bytes
    tempos : list of (tick, microseconds per quarter)
    metres : list of (tick, numerator, denominator)
    markers : list of (tick, text)
        Markers and cue points.
    programs : dict of channel to list of (tick, program)
    channels : dict of channel to ChannelNotes
        Channels with notes.
    controls : dict of (channel, kind) to dict of tick to value
        The last value of each tick.
    hanging, zero_length : int
        Notes without an end, notes without a length.
    end_tick : int
        Where the track ends.
    """

    name: bytes = b""
    instrument_name: bytes = b""
    texts: list[bytes] = []
    tempos: list[tuple[int, int]] = []
    metres: list[tuple[int, int, int]] = []
    markers: list[tuple[int, bytes]] = []
    programs: dict[int, list[tuple[int, int]]] = {}
    channels: dict[int, ChannelNotes] = {}
    controls: dict[tuple[int, CurveKind], dict[int, float]] = {}
    hanging: int = 0
    zero_length: int = 0
    end_tick: int = 0

    def notes(self, channels: Collection[int]) -> ChannelNotes:
        """The notes of some channels together, in the order of the track."""
        if len(channels) == 1:
            return self.channels[next(iter(channels))]
        together = [self.channels[channel] for channel in channels]
        rows = sorted(
            (row for notes in together for row in zip(*msgspec.structs.astuple(notes), strict=True)),
            key=itemgetter(-1),
        )
        return ChannelNotes(*map(list, zip(*rows, strict=True)))

    def take_turns(self, channels: Collection[int]) -> bool:
        """Whether no note of one channel sounds into a note of another."""
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

    def curves(self, channels: Collection[int]) -> tuple[ControllerCurve, ...]:
        """The controller curves of some channels, by kind; where several speak, the last one holds."""
        kinds: dict[CurveKind, dict[int, float]] = {}
        for (owner, kind), points in sorted(self.controls.items(), key=itemgetter(0)):
            if owner in channels:
                kinds.setdefault(kind, {}).update(points)
        return tuple(
            ControllerCurve(kind, tuple(sorted(points)), tuple(points[tick] for tick in sorted(points)))
            for kind, points in sorted(kinds.items())
        )


def gather(messages: Iterable[Any], begin_tick: int) -> TrackEvents:
    """Gather the messages of one track.

    Parameters
    ----------
    messages : iterable of mido messages
        With delta times.
    begin_tick : int
        Where the track begins.
    """
    events = TrackEvents()
    sounding: dict[int, list[int]] = {}
    channels = events.channels
    tick = begin_tick
    number = 0
    for message in messages:
        tick += message.time
        kind = message.type
        if kind == "note_on" and message.velocity:
            channel, pitch = message.channel, message.note
            number += 1
            notes = channels.get(channel)
            if notes is None:
                notes = channels[channel] = ChannelNotes()
            sounding.setdefault(channel << 7 | pitch, []).append(len(notes.pitches))
            notes.onset_ticks.append(tick)
            notes.end_ticks.append(-1)
            notes.pitches.append(pitch)
            notes.velocities.append(message.velocity)
            notes.numbers.append(number)
        elif kind == "note_off" or kind == "note_on":
            channel = message.channel
            open_notes = sounding.get(channel << 7 | message.note)
            if open_notes:
                channels[channel].end_ticks[open_notes.pop(0)] = tick
        elif kind == "end_of_track":
            break
        elif kind == "control_change" and message.control in _NOTES_OFF:
            _end_notes(channels, sounding, message.channel, tick)
        else:
            _note_other(events, message, kind, tick)
    events.end_tick = tick
    _close(events)
    return events


def _note_other(events: TrackEvents, message: Any, kind: str, tick: int) -> None:
    """Keep a message that is about no note."""
    if kind == "control_change":
        curve = _KINDS.get(message.control)
        if curve is not None:
            events.controls.setdefault((message.channel, curve), {})[tick] = message.value / 127
    elif kind == "pitchwheel":
        events.controls.setdefault((message.channel, "pitch_bend"), {})[tick] = message.pitch / 8192
    elif kind in ("aftertouch", "polytouch"):
        events.controls.setdefault((message.channel, "aftertouch"), {})[tick] = message.value / 127
    elif kind == "program_change":
        events.programs.setdefault(message.channel, []).append((tick, message.program))
    elif kind == "set_tempo":
        events.tempos.append((tick, message.tempo))
    elif kind == "time_signature":
        events.metres.append((tick, message.numerator, message.denominator))
    elif kind == "track_name":
        events.name = events.name or message.name.encode("latin-1")
    elif kind == "instrument_name":
        events.instrument_name = events.instrument_name or message.name.encode("latin-1")
    elif kind == "text":
        events.texts.append(message.text.encode("latin-1"))
    elif kind in ("marker", "cue_marker"):
        events.markers.append((tick, message.text.encode("latin-1")))


def _end_notes(channels: dict[int, ChannelNotes], sounding: dict[int, list[int]], channel: int, tick: int) -> None:
    for key, open_notes in sounding.items():
        if key >> 7 == channel:
            for index in open_notes:
                channels[channel].end_ticks[index] = tick
            open_notes.clear()


def _close(events: TrackEvents) -> None:
    """End what still sounds with the track, and give notes without length a tick."""
    for notes in events.channels.values():
        ends = notes.end_ticks
        for index, (onset, end) in enumerate(zip(notes.onset_ticks, ends, strict=True)):
            if end < 0:
                events.hanging += 1
                end = events.end_tick
            elif end == onset:
                events.zero_length += 1
            ends[index] = max(end, onset + 1)
