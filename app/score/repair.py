"""Makes the bytes of a track such that mido can read them, losing only what cannot be understood.

What mido refuses or misreads: system messages other than exclusive ones, running status after them or after an
exclusive message, meta events with impossible contents, an event cut off by the end of the track.

Warnings
--------
midi.track_truncated : track, byte
    "Track {track} breaks off within an event at byte {byte}; what came before was read"
midi.bytes_not_understood : track, byte, count
    "{count} bytes of track {track} are no MIDI events and were left out, the first at byte {byte}"
"""

from __future__ import annotations

import msgspec

# Bytes of data after each status; 0xF1..0xFE have no place in a file, but sequencers have written them.
_CHANNEL_DATA = {0x8: 2, 0x9: 2, 0xA: 2, 0xB: 2, 0xC: 1, 0xD: 1, 0xE: 2}
_SYSTEM_DATA = {0xF1: 1, 0xF2: 2, 0xF3: 1}

# Meta events the score reads, and the lengths they may have.
_END_OF_TRACK, _SET_TEMPO, _TIME_SIGNATURE = 0x2F, 0x51, 0x58
_LENGTHS = {_SET_TEMPO: 3, _TIME_SIGNATURE: 4}
_TEXTS = frozenset(range(1, 5))

_SUSPICIOUS = tuple(bytes([status]) for status in range(0xF0, 0xFF))


class Repaired(msgspec.Struct, frozen=True):
    """A track that mido reads.

    Attributes
    ----------
    data : bytes
    truncated_at : int or None
        Offset in the track of the event that its end cuts off.
    skipped : int
        Bytes that are no events.
    first_skipped : int
        Offset of the first of them.
    """

    data: bytes
    truncated_at: int | None
    skipped: int
    first_skipped: int


class _TruncatedError(Exception):
    """The track ends within an event."""


def last_system_message(data: bytes) -> int:
    """Offset after the last byte that may be a system message's status; 0 if there is none.

    Up to there mido may misread the track without noticing; the search is for bytes, so a text or a long delta may
    look like one.
    """
    return 1 + max(data.rfind(status) for status in _SUSPICIOUS)


def repaired(data: bytes, until: int | None = None) -> Repaired:
    """Copy a track event by event, each channel message with its status, without the events the score does not need.

    Parameters
    ----------
    data : bytes
        The events of a track.
    until : int, optional
        From the first event at or after this offset on, the bytes are taken as they are.
    """
    out = bytearray()
    at, delta, status = 0, 0, 0
    skipped, first_skipped = 0, 0
    truncated_at = None
    end = len(data)
    broken_off = False  # the last message stopped at a status where data belong; that status has no delta of its own
    while at < end:
        event_at = at
        if until is not None and at >= until and delta == 0 and not broken_off:
            _append_rest(out, data, at, status)
            return Repaired(bytes(out), None, skipped, first_skipped)
        try:
            if not broken_off:
                wait, at = _variable_length(data, at)
                delta += wait
            broken_off = False
            byte = _byte(data, at)
            if byte == 0xFF:
                kind = _byte(data, at + 1)
                length, begin = _variable_length(data, at + 2)
                if kind == _END_OF_TRACK:
                    break
                if begin + length > end:
                    raise _TruncatedError
                at = begin + length
                if kind in _TEXTS or _LENGTHS.get(kind) == length:
                    out += encoded_length(delta) + bytes([0xFF, kind]) + encoded_length(length) + data[begin:at]
                    delta = 0
            elif byte in (0xF0, 0xF7):
                length, begin = _variable_length(data, at + 1)
                if begin + length > end:
                    raise _TruncatedError
                at = begin + length
            elif byte > 0xF0:
                at = _after_system_message(data, at)
                skipped, first_skipped = skipped + at - event_at, first_skipped or event_at
            else:
                if byte >= 0x80:
                    status, at = byte, at + 1
                size = _CHANNEL_DATA.get(status >> 4, 0)
                if size == 0:  # running status without a status before it
                    skipped, first_skipped = skipped + 1, first_skipped or at
                    at += 1
                    continue
                message = data[at : at + size]
                if len(message) < size:
                    raise _TruncatedError
                if message.isascii():
                    out += encoded_length(delta) + bytes([status]) + message
                    delta, at = 0, at + size
                else:
                    whole = next(index for index, value in enumerate(message) if value >= 0x80)
                    at += whole
                    skipped, first_skipped = skipped + at - event_at, first_skipped or event_at
                    broken_off = True
        except _TruncatedError:
            truncated_at = event_at
            break
    out += encoded_length(min(delta, 0x0FFFFFFF)) + bytes([0xFF, _END_OF_TRACK, 0])
    return Repaired(bytes(out), truncated_at, skipped, first_skipped)


def _append_rest(out: bytearray, data: bytes, at: int, status: int) -> None:
    """Append the events from ``at`` on; the first gets its status if it relied on running status."""
    try:
        _, event = _variable_length(data, at)
        running = _byte(data, event) < 0x80 and status
    except _TruncatedError:
        event, running = at, 0
    out += data[at:event]
    if running:
        out.append(status)
    out += data[event:]


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
