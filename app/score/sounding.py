"""Notes that are currently sounding on an instrument, and the notes that a message ends.

One rule for recording journals, takes, their MIDI files and the live player: a note struck again ends and restarts, and
only messages on its own channel end it.
"""

from __future__ import annotations

from typing import Final, Generic, TypeVar

T = TypeVar("T")

SILENCING: Final = (120, 123)
"""Controllers that end all notes of a channel: all sound off, all notes off."""
_NOTE_OFF, _NOTE_ON, _CONTROL = 0x8, 0x9, 0xB

Key = tuple[int, int]
"""Channel, 0..15, and pitch."""


def begins(message: bytes) -> bool:
    """Return whether a MIDI message is a note-on with a velocity above 0."""
    return message[0] >> 4 == _NOTE_ON and message[2] > 0


def is_note(message: bytes) -> bool:
    """Return whether a message is a note-on or note-off."""
    return message[0] >> 4 in (_NOTE_OFF, _NOTE_ON)


class SoundingNotes(Generic[T]):
    """The sounding notes, in the order in which they were struck.

    Attributes
    ----------
    notes : dict of (int, int) to T
        Data stored for each sounding note, by channel and pitch.
    """

    def __init__(self) -> None:
        self.notes: dict[Key, T] = {}

    def receive(self, message: bytes, known: T) -> list[tuple[Key, T]]:
        """Receive a channel message; returns the notes that it ends, including a note that is struck again.

        Parameters
        ----------
        known : T
            Data to store if the message begins a note.
        """
        kind, channel = message[0] >> 4, message[0] & 0x0F
        if kind in (_NOTE_OFF, _NOTE_ON):
            key = channel, message[1]
            ended = [(key, self.notes.pop(key))] if key in self.notes else []
            if begins(message):
                self.notes[key] = known
            return ended
        if kind == _CONTROL and message[1] in SILENCING:
            return [(key, self.notes.pop(key)) for key in list(self.notes) if key[0] == channel]
        return []

    def end_all(self) -> list[tuple[Key, T]]:
        """End all notes, and return the notes that were sounding."""
        ended = list(self.notes.items())
        self.notes.clear()
        return ended


def note_off(key: Key) -> bytes:
    """Return the message that ends a note."""
    channel, pitch = key
    return bytes((_NOTE_OFF << 4 | channel, pitch, 0))
