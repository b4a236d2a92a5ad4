"""Makes the bytes of a track such that mido can read them, losing only what cannot be understood.

System exclusive messages that are split over several events (SMF 1.0, "F7 sysex events") become one where the last part
stands; mido would take each for a message.

What mido refuses or misreads: variable-length quantities of more than four bytes, which it makes numbers of any size
of; system messages other than exclusive ones, running status after them or after an
exclusive message, meta events with impossible contents, an event cut off by the end of the track. A value above 127 is
taken for 127, as mido does when it is asked to clip.

Warnings
--------
midi.track_truncated : track, byte
    "Track {track} breaks off within an event at byte {byte}; what came before was read"
midi.bytes_not_understood : track, byte, count
    "{count} bytes of track {track} are no MIDI events and were left out, the first at byte {byte}"
"""

from __future__ import annotations

import re

import msgspec

# Bytes of data after each status; 0xF1..0xFE have no place in a file, but sequencers have written them.
_CHANNEL_DATA = {0x8: 2, 0x9: 2, 0xA: 2, 0xB: 2, 0xC: 1, 0xD: 1, 0xE: 2}
_SYSTEM_DATA = {0xF1: 1, 0xF2: 2, 0xF3: 1}

# Meta events the score reads, and the lengths they may have.
_PORT, _END_OF_TRACK, _SET_TEMPO, _TIME_SIGNATURE = 0x21, 0x2F, 0x51, 0x58
_LENGTHS = {_PORT: 1, _SET_TEMPO: 3, _TIME_SIGNATURE: 4}
_TEXTS = frozenset((1, 2, 3, 4, 6, 7, 9))
_LONGEST_EXCLUSIVE = 1024
"""Bytes of a message that is put together; what is longer says nothing that the score needs."""

_SUSPICIOUS = tuple(bytes([status]) for status in range(0xF0, 0xFF))
_OVERLONG = re.compile(rb"[\x80-\xff]{4}")


class Repaired(msgspec.Struct, frozen=True):
    """A track that mido reads.

    Attributes
    ----------
    truncated_at : int or None
        Offset in the track of the event that its end cuts off.
    skipped : int
        Bytes that are no events.
    first_skipped : int
        Offset of the first of them; the track's length if there are none.
    """

    data: bytes
    truncated_at: int | None
    skipped: int
    first_skipped: int


class _TruncatedError(Exception):
    """The track ends within an event."""


def last_suspicious(data: bytes) -> int:
    """Offset after the last byte that may be a system message's status, or part of a quantity that is too long; 0 if
    there is none.

    Up to there mido may misread the track without noticing; the search is for bytes, so a text or a long delta may
    look like one.
    """
    after_status = 1 + max(data.rfind(status) for status in _SUSPICIOUS)
    return max([after_status, *(match.end() for match in _OVERLONG.finditer(data))])


def repaired(data: bytes, until: int | None = None) -> Repaired:
    """Copy a track event by event, each channel message with its status, without the events the score does not need.

    Events that follow an end of the track are copied too, if all of them are events or another end is the last of them.

    Parameters
    ----------
    data : bytes
        The events of a track.
    until : int, optional
        From the first event at or after this offset on, the bytes are taken as they are.
    """
    out = bytearray()
    exclusive = bytearray()
    at, delta, status = 0, 0, 0
    skipped, first_skipped = 0, len(data)
    truncated_at = None
    ended: tuple[int, int, int] | None = None
    closed = -1
    end = len(data)
    while at < end:
        event_at = at
        try:
            wait, at = _variable_length(data, at)
            delta += wait
            byte = _byte(data, at)
            if until is not None and event_at >= until:
                running = bytes([status]) if byte < 0x80 and status else b""
                out += encoded_length(delta) + running + data[at:]
                return Repaired(bytes(out), None, skipped, first_skipped)
            if byte == 0xFF:
                kind = _byte(data, at + 1)
                length, begin = _variable_length(data, at + 2)
                if begin + length > end and kind != _END_OF_TRACK:
                    raise _TruncatedError
                at = begin + length
                if kind == _END_OF_TRACK:
                    ended = ended or (len(out), delta, skipped)
                if kind == _END_OF_TRACK or kind in _TEXTS or _LENGTHS.get(kind) == length:
                    out += encoded_length(delta) + bytes([0xFF, kind]) + encoded_length(length) + data[begin:at]
                    delta = 0
                    closed = len(out) if kind == _END_OF_TRACK else closed
            elif byte in (0xF0, 0xF7):
                length, begin = _variable_length(data, at + 1)
                if begin + length > end:
                    raise _TruncatedError
                at = begin + length
                if byte == 0xF0 or data[begin : begin + 1] == b"\xf0":
                    exclusive.clear()
                if len(exclusive) <= _LONGEST_EXCLUSIVE:
                    exclusive += data[begin : min(at, begin + _LONGEST_EXCLUSIVE)]
                # An unfinished message goes on in an F7 event that follows; many have no F7 at all.
                if data[at - 1] == 0xF7 or not _goes_on(data, at):
                    whole = bytes(value for value in exclusive if value < 0x80)
                    exclusive.clear()
                    if whole and len(whole) <= _LONGEST_EXCLUSIVE:
                        out += encoded_length(delta) + b"\xf0" + encoded_length(len(whole) + 1) + whole + b"\xf7"
                        delta = 0
            elif byte > 0xF0:
                at = _after_system_message(data, at)
                skipped, first_skipped = skipped + at - event_at, min(first_skipped, event_at)
            else:
                if byte >= 0x80:
                    status, at = byte, at + 1
                size = _CHANNEL_DATA.get(status >> 4, 0)
                if size == 0:  # running status without a status before it
                    skipped, first_skipped = skipped + 1, min(first_skipped, at)
                    at += 1
                    continue
                message = data[at : at + size]
                if len(message) < size:
                    raise _TruncatedError
                out += encoded_length(delta) + bytes([status, *(min(value, 0x7F) for value in message)])
                delta, at = 0, at + size
        except _TruncatedError:
            truncated_at = event_at
            break
    properly = data.endswith(bytes([0xFF, _END_OF_TRACK, 0]))
    if ended is not None and (truncated_at is not None or (skipped > ended[2] and not properly)):
        # What follows the end is no music.
        del out[ended[0] :]
        delta, skipped, truncated_at = ended[1], ended[2], None
        first_skipped = first_skipped if skipped else len(data)
    if closed != len(out):
        out += encoded_length(min(delta, 0x0FFFFFFF)) + bytes([0xFF, _END_OF_TRACK, 0])
    return Repaired(bytes(out), truncated_at, skipped, first_skipped)


def _goes_on(data: bytes, at: int) -> bool:
    """Return whether the event at an offset continues a system exclusive message: an F7 event that begins none
    itself."""
    try:
        _, at = _variable_length(data, at)
        if _byte(data, at) != 0xF7:
            return False
        _, begin = _variable_length(data, at + 1)
    except _TruncatedError:
        return False
    return data[begin : begin + 1] != b"\xf0"


def _after_system_message(data: bytes, at: int) -> int:
    """Past a system message and its data, as far as these are there."""
    size = _SYSTEM_DATA.get(data[at], 0)
    at += 1
    while size and at < len(data) and data[at] < 0x80:
        size, at = size - 1, at + 1
    return at


def _byte(data: bytes, at: int) -> int:
    if at >= len(data):
        raise _TruncatedError
    return data[at]


def _variable_length(data: bytes, at: int) -> tuple[int, int]:
    """A variable-length quantity (at most 4 bytes) and the offset after it."""
    value = 0
    for _ in range(4):
        byte = _byte(data, at)
        at += 1
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            break
    return value, at


def encoded_length(value: int) -> bytes:
    """A variable-length quantity as bytes; what exceeds 28 bits takes more of them, which mido reads."""
    encoded = [value & 0x7F]
    while value := value >> 7:
        encoded.append(value & 0x7F | 0x80)
    return bytes(reversed(encoded))
