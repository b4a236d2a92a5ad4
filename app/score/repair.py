"""Repairs the bytes of a MIDI track for mido, dropping only what cannot be parsed.

System exclusive messages split over several events (SMF 1.0, "F7 sysex events") are joined at the place of the last
part; mido would read each part as a message.

Repairs cover everything that mido rejects or misreads: variable-length quantities of more than four bytes; system
messages other than exclusive ones, and running status after them or after an exclusive message; meta events with
impossible contents; an event cut off by the end of the track. Data bytes above 127 become 127, as with mido's ``clip``.
"""

from __future__ import annotations

import io
import re

import mido
import msgspec

from app.errors import FileError, Message
from app.score.chunks import TrackChunk

# Exceptions that mido raises for invalid bytes, found by reading its code and by fuzzing.
_MIDO_ERRORS = (OSError, EOFError, ValueError, LookupError, TypeError, AttributeError, mido.KeySignatureError)

# Number of data bytes for each status; 0xF1..0xFE are illegal in files, but some sequencers write them.
_CHANNEL_DATA = {0x8: 2, 0x9: 2, 0xA: 2, 0xB: 2, 0xC: 1, 0xD: 1, 0xE: 2}
_SYSTEM_DATA = {0xF1: 1, 0xF2: 2, 0xF3: 1}

# Meta events used by the score, and their valid lengths.
_PORT, _END_OF_TRACK, _SET_TEMPO, _TIME_SIGNATURE = 0x21, 0x2F, 0x51, 0x58
_LENGTHS = {_PORT: 1, _SET_TEMPO: 3, _TIME_SIGNATURE: 4}
_TEXTS = frozenset((1, 2, 3, 4, 6, 7, 9))
_LONGEST_EXCLUSIVE = 1024
"""Greatest size in bytes of a system-exclusive message that is joined from pieces; longer ones are irrelevant to the
score.
"""

_SUSPICIOUS = tuple(bytes([status]) for status in range(0xF0, 0xFF))
_OVERLONG = re.compile(rb"[\x80-\xff]{4}")


class Repaired(msgspec.Struct, frozen=True):
    """A repaired track, in bytes that mido can read.

    Attributes
    ----------
    truncated_at : int or None
        Offset in the track of an event that is cut off by the track's end; None if there is none.
    skipped : int
        Number of bytes that belong to no event.
    first_skipped : int
        Offset of the first skipped byte; the track's length if none was skipped.
    """

    data: bytes
    truncated_at: int | None
    skipped: int
    first_skipped: int


class _TruncatedError(Exception):
    """Raised if a track ends within an event."""


def track_messages(track: TrackChunk, index: int, file: str) -> tuple[mido.MidiTrack, list[Message]]:
    """Parse the messages of one track, repaired if needed, with warnings about the repairs."""
    until = last_suspicious(track.data)
    repair = repaired(track.data, until) if until else None
    try:
        messages = _parsed(repair.data if repair else track.data)
    except _MIDO_ERRORS:
        repair = repaired(track.data)
        try:
            messages = _parsed(repair.data)
        except _MIDO_ERRORS as error:
            raise FileError(
                "midi.track_unreadable",
                file=file,
                track=index + 1,
                byte=track.first_byte,
                detail=str(error) or type(error).__name__,
            ) from error
    return messages, _repair_warnings(repair, track, index) if repair else []


def _parsed(data: bytes) -> mido.MidiTrack:
    header = b"MThd" + bytes([0, 0, 0, 6, 0, 0, 0, 1, 1, 0xE0]) + b"MTrk" + len(data).to_bytes(4, "big")
    return mido.MidiFile(file=io.BytesIO(header + data), clip=True, charset="latin-1").tracks[0]


def _repair_warnings(repair: Repaired, track: TrackChunk, index: int) -> list[Message]:
    warnings = []
    if repair.skipped:
        byte = track.first_byte + repair.first_skipped
        warnings.append(
            Message("midi.bytes_not_understood", {"track": index + 1, "byte": byte, "count": repair.skipped})
        )
    if repair.truncated_at is not None:
        byte = track.first_byte + repair.truncated_at
        warnings.append(Message("midi.track_truncated", {"track": index + 1, "byte": byte}))
    return warnings


def last_suspicious(data: bytes) -> int:
    """Offset after the last byte that might be a system message's status or part of an overlong quantity; 0 if there is
    none.

    Up to this offset mido might misread the track silently. The search is bytewise, so texts and long delta times may
    cause false alarms.
    """
    after_status = 1 + max(data.rfind(status) for status in _SUSPICIOUS)
    return max([after_status, *(match.end() for match in _OVERLONG.finditer(data))])


def repaired(data: bytes, until: int | None = None) -> Repaired:
    """Copy the events of a track with repairs: each channel message gets its own status byte, and events that the score
    does not use are dropped.

    Events after an end-of-track are copied too, if they can all be parsed or end with another end-of-track.

    Parameters
    ----------
    data : bytes
        The events of a track.
    until : int, optional
        Offset from which the bytes are copied unchecked, beginning with the first event there.
    """
    copy, at = _TrackCopy(data), 0
    while at < len(data):
        try:
            wait, place = _variable_length(data, at)
            copy.delta += wait
            if until is not None and at >= until:
                return copy.with_rest(place)
            at = copy.after_event(at, place)
        except _TruncatedError:
            return copy.closed(truncated_at=at)
    return copy.closed(truncated_at=None)


class _TrackCopy:
    """Copy of a track in progress; ``delta`` is the number of ticks since the last copied event."""

    def __init__(self, data: bytes) -> None:
        self.delta = 0
        self._data, self._out, self._exclusive = data, bytearray(), bytearray()
        self._status = 0
        self._skipped, self._first_skipped = 0, len(data)
        self._ended: tuple[int, int, int] | None = None
        self._closed_at = -1

    def with_rest(self, at: int) -> Repaired:
        """Finish the copy by appending all bytes from the offset ``at`` unchanged."""
        running = bytes([self._status]) if _byte(self._data, at) < 0x80 and self._status else b""
        out = bytes(self._out) + encoded_length(self.delta) + running + self._data[at:]
        return Repaired(out, None, self._skipped, self._first_skipped)

    def after_event(self, event_at: int, at: int) -> int:
        """Copy the event whose status byte is at ``event_at``, and return the offset of the next event."""
        byte = _byte(self._data, at)
        if byte == 0xFF:
            return self._after_meta(at)
        if byte in (0xF0, 0xF7):
            return self._after_exclusive(byte, at)
        if byte > 0xF0:
            after = _after_system_message(self._data, at)
            self._skip(event_at, after - event_at)
            return after
        if byte >= 0x80:
            self._status, at = byte, at + 1
        size = _CHANNEL_DATA.get(self._status >> 4, 0)
        if size == 0:  # running status without a preceding status
            self._skip(at, 1)
            return at + 1
        message = self._data[at : at + size]
        if len(message) < size:
            raise _TruncatedError
        self._write(bytes([self._status, *(min(value, 0x7F) for value in message)]))
        return at + size

    def _skip(self, at: int, count: int) -> None:
        self._skipped, self._first_skipped = self._skipped + count, min(self._first_skipped, at)

    def _write(self, event: bytes) -> None:
        self._out += encoded_length(self.delta) + event
        self.delta = 0

    def _after_meta(self, at: int) -> int:
        kind = _byte(self._data, at + 1)
        is_end = kind == _END_OF_TRACK
        length, begin = _variable_length(self._data, at + 2)
        end = begin + length
        if end > len(self._data) and not is_end:
            raise _TruncatedError
        if is_end:
            self._ended = self._ended or (len(self._out), self.delta, self._skipped)
        if is_end or kind in _TEXTS or _LENGTHS.get(kind) == length:
            self._write(bytes([0xFF, kind]) + encoded_length(length) + self._data[begin:end])
            self._closed_at = len(self._out) if is_end else self._closed_at
        return end

    def _after_exclusive(self, byte: int, at: int) -> int:
        length, begin = _variable_length(self._data, at + 1)
        end = begin + length
        if end > len(self._data):
            raise _TruncatedError
        if byte == 0xF0 or self._data[begin : begin + 1] == b"\xf0":
            self._exclusive.clear()
        if len(self._exclusive) <= _LONGEST_EXCLUSIVE:
            self._exclusive += self._data[begin : min(end, begin + _LONGEST_EXCLUSIVE)]
        # An unfinished message may continue in a following F7 event; many have no F7 at all.
        if self._data[end - 1] == 0xF7 or not _goes_on(self._data, end):
            whole = bytes(value for value in self._exclusive if value < 0x80)
            self._exclusive.clear()
            if whole and len(whole) <= _LONGEST_EXCLUSIVE:
                self._write(b"\xf0" + encoded_length(len(whole) + 1) + whole + b"\xf7")
        return end

    def closed(self, truncated_at: int | None) -> Repaired:
        """Finish the copy with an end-of-track; content after the original end is dropped unless it is music."""
        properly = self._data.endswith(bytes([0xFF, _END_OF_TRACK, 0]))
        broken = truncated_at is not None
        if self._ended is not None and (broken or (self._skipped > self._ended[2] and not properly)):
            end, self.delta, self._skipped = self._ended
            del self._out[end:]
            truncated_at = None
            self._first_skipped = self._first_skipped if self._skipped else len(self._data)
        if self._closed_at != len(self._out):
            self.delta = min(self.delta, 0x0FFFFFFF)
            self._write(bytes([0xFF, _END_OF_TRACK, 0]))
        return Repaired(bytes(self._out), truncated_at, self._skipped, self._first_skipped)


def _goes_on(data: bytes, at: int) -> bool:
    """Return whether the event at an offset is an F7 event that continues a system exclusive message."""
    try:
        _, at = _variable_length(data, at)
        if _byte(data, at) != 0xF7:
            return False
        _, begin = _variable_length(data, at + 1)
    except _TruncatedError:
        return False
    return data[begin : begin + 1] != b"\xf0"


def _after_system_message(data: bytes, at: int) -> int:
    """Offset after a system message and those of its data bytes that are present."""
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
    """Parse a variable-length quantity (at most 4 bytes); returns value and offset after it."""
    value = 0
    for _ in range(4):
        byte = _byte(data, at)
        at += 1
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            break
    return value, at


def encoded_length(value: int) -> bytes:
    """Encode a number as a variable-length quantity; numbers above 28 bits take more than four bytes, which mido can
    read.
    """
    encoded = [value & 0x7F]
    while value := value >> 7:
        encoded.append(value & 0x7F | 0x80)
    return bytes(reversed(encoded))
