"""Log of the latest messages of a MIDI device, shortened for the input monitor."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Final, Literal, TypeAlias

import msgspec

Kind: TypeAlias = Literal["note_on", "note_off", "key_pressure", "control", "program", "channel_pressure", "pitch_bend"]

_KINDS: Final[dict[int, Kind]] = {
    0x8: "note_off",
    0x9: "note_on",
    0xA: "key_pressure",
    0xB: "control",
    0xC: "program",
    0xD: "channel_pressure",
    0xE: "pitch_bend",
}
_NOTES: Final = ("note_on", "note_off")
_BEND_RANGE: Final = 8192


class MessageRow(msgspec.Struct, frozen=True):
    """A message, or several consecutive ones of the same kind.

    Attributes
    ----------
    channel : int
        1..16.
    number : int
        Number of the note or controller; -1 if the message has none.
    value : int
        Last value: velocity, 0..127, or pitch bend, -8192..8191.
    """

    kind: Kind
    channel: int
    number: int
    value: int
    count: int = 1


class MessageLog:
    """Latest messages; consecutive values of one controller take one line.

    Parameters
    ----------
    most : int
        Greatest number of lines.
    """

    def __init__(self, most: int = 40) -> None:
        self._lines: deque[MessageRow] = deque(maxlen=most)

    @property
    def lines(self) -> tuple[MessageRow, ...]:
        """The rows of the log, the newest first."""
        return tuple(self._lines)

    def clear(self) -> None:
        """Remove all lines."""
        self._lines.clear()

    def add(self, message: bytes) -> None:
        """Add a received channel message to the log; repeated ones are joined in one row."""
        line = _line(message)
        place = next((place for place, other in self._since_note() if _is_same(line, other)), None)
        if place is None or line.kind in _NOTES:
            self._lines.appendleft(line)
        else:
            self._lines[place] = msgspec.structs.replace(line, count=self._lines[place].count + 1)

    def _since_note(self) -> Iterator[tuple[int, MessageRow]]:
        for place, line in enumerate(self._lines):
            if line.kind in _NOTES:
                return
            yield place, line


def _is_same(one: MessageRow, other: MessageRow) -> bool:
    return (one.kind, one.channel, one.number) == (other.kind, other.channel, other.number)


def _line(message: bytes) -> MessageRow:
    kind, channel = _KINDS[message[0] >> 4], (message[0] & 0x0F) + 1
    if kind == "note_on" and message[2] == 0:
        kind = "note_off"
    if kind == "pitch_bend":
        return MessageRow(kind, channel, -1, (message[2] << 7 | message[1]) - _BEND_RANGE)
    if len(message) == 2:
        return MessageRow(kind, channel, -1, message[1])
    return MessageRow(kind, channel, message[1], message[2])
