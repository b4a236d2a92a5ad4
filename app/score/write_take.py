"""Writes a take as a MIDI file of format 1: a track with tempo and metre, and a track with the played messages."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import mido

from app.formats.atomic import atomic_write
from app.score.sounding import SoundingNotes, begins, is_note, note_off
from app.score.take_tracks import RECORDED

TICKS_PER_QUARTER: Final = 960
_PLAYED_EARLY_S: Final = 0.25
"""Seconds before the first beat within which a note belongs to that beat."""


def write_take(
    path: Path,
    times_us: Sequence[int],
    messages: Sequence[bytes],
    *,
    name: str,
    beats_per_minute: float = 120.0,
    end_us: int | None = None,
) -> int:
    """Write the messages from time 0 on, and return the number of notes.

    From messages before time 0 only controller states are kept, and notes that were played slightly early or are still
    held, which are moved to 0. Notes held at the end are ended there; a note struck again ends first, since a wind
    instrument sounds a pitch once.

    Parameters
    ----------
    times_us : sequence of int
        Time of each message in microseconds, not descending.
    messages : sequence of bytes
        Complete MIDI channel messages.
    name : str
        Name of the track.
    beats_per_minute : float
        Tempo in quarters per minute.
    end_us : int, optional
        End of the take; by default the time of the last message.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    last_us = max(end_us or 0, times_us[-1] if times_us else 0, 0)
    played = from_zero(ended(times_us, messages, last_us))
    ticks_per_us = TICKS_PER_QUARTER * beats_per_minute / 60e6
    file = mido.MidiFile(type=1, ticks_per_beat=TICKS_PER_QUARTER, charset="utf-8")
    conductor, track = mido.MidiTrack(), mido.MidiTrack()
    conductor.append(mido.MetaMessage("set_tempo", tempo=round(60e6 / beats_per_minute)))
    conductor.append(mido.MetaMessage("time_signature", numerator=4, denominator=4))
    track.append(mido.MetaMessage("track_name", name=name))
    track.append(mido.MetaMessage("text", text=RECORDED))
    before = 0
    for time_us, message in played:
        tick = round(time_us * ticks_per_us)
        track.append(message.copy(time=tick - before))
        before = tick
    track.append(mido.MetaMessage("end_of_track", time=max(round(last_us * ticks_per_us) - before, 0)))
    file.tracks += [conductor, track]
    data = io.BytesIO()
    file.save(file=data)
    with atomic_write(path) as stream:
        stream.write(data.getvalue())
    return sum(_begins(message) for _, message in played)


def ended(times_us: Sequence[int], messages: Sequence[bytes], last_us: int) -> list[tuple[int, mido.Message]]:
    """Return the messages with their times such that every note has exactly one note-off, also where it is struck again
    and at the end of the take; note-offs without a note are dropped.
    """
    found: list[tuple[int, bytes]] = []
    sounding: SoundingNotes[None] = SoundingNotes()
    for time_us, message in zip(times_us, messages, strict=True):
        ends = [key for key, _ in sounding.receive(message, None)]
        if is_note(message) and not begins(message):
            if ends:
                found.append((time_us, message))
            continue
        found += [(time_us, note_off(key)) for key in ends]
        found.append((time_us, message))
    found += [(last_us, note_off(key)) for key, _ in sounding.end_all()]
    return [(time_us, mido.Message.from_bytes(message)) for time_us, message in found]


def from_zero(played: Sequence[tuple[int, mido.Message]]) -> list[tuple[int, mido.Message]]:
    """Shift a take's messages to start at time 0, as `write_take` describes."""
    state: dict[tuple[object, ...], mido.Message] = {}
    begun: dict[tuple[int, int], tuple[int, mido.Message]] = {}
    early: list[mido.Message] = []
    after: list[tuple[int, mido.Message]] = []
    for time_us, message in played:
        if time_us >= 0:
            after.append((time_us, message))
        elif _begins(message):
            begun[message.channel, message.note] = time_us, message
        elif message.type in ("note_on", "note_off"):
            begin_us, note = begun.pop((message.channel, message.note), (time_us, None))
            if note is not None and begin_us >= -_PLAYED_EARLY_S * 1e6:
                # The note ended before its shifted beginning.
                early += [note, message]
        else:
            state[_kind(message)] = message
    at_zero = [*state.values(), *early, *(message for _, message in begun.values())]
    return [*((0, message) for message in at_zero), *after]


def _begins(message: mido.Message) -> bool:
    return bool(message.type == "note_on" and message.velocity > 0)


def _kind(message: mido.Message) -> tuple[object, ...]:
    """Key of a message by type, channel and controller or note: of two messages with equal keys only the later has
    effect.
    """
    return message.type, message.channel, getattr(message, "control", None), getattr(message, "note", None)
