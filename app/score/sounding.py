"""Notes that sound on an instrument that is played now, and which of them a message ends.

One rule for the journal of a recording, takes, their MIDI files and the live player: a note that is struck again ends
there and begins again, and only its own channel ends it.
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
    """Return whether a note begins."""
    return message[0] >> 4 == _NOTE_ON and message[2] > 0


def is_note(message: bytes) -> bool:
    """Return whether a note begins or ends, by itself."""
    return message[0] >> 4 in (_NOTE_OFF, _NOTE_ON)


class SoundingNotes(Generic[T]):
    """Notes that are sounding, the last struck at the end.

    Attributes
    ----------
    notes : dict of (int, int) to T
        By channel and pitch, what is known of each.
    """

    def __init__(self) -> None:
        self.notes: dict[Key, T] = {}

    def receive(self, message: bytes, known: T) -> list[tuple[Key, T]]:
        """Take the message of a channel; the notes that it ends, a note that is struck again among them.

        Parameters
        ----------
        known : T
            What is known of the note, if one begins.
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
        """End everything; the notes that sounded."""
        ended = list(self.notes.items())
        self.notes.clear()
        return ended


def note_off(key: Key) -> bytes:
    """Make the message that ends a note."""
    channel, pitch = key
    return bytes((_NOTE_OFF << 4 | channel, pitch, 0))
