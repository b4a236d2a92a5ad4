"""Chunks of a Standard MIDI File: header and tracks as bytes, also from damaged files."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import msgspec

from app.errors import FileError, Message
from app.formats.files import read_file

MOST_BYTES = 2**26
"""Largest file in bytes; a symphony has some hundreds of kilobytes."""
INCOMPLETE: Final = frozenset({"midi.track_cut_off", "midi.track_truncated", "midi.tracks_missing"})
"""Warnings about files in which music is missing."""
_END_OF_TRACK = b"\xff\x2f\x00"


class TrackChunk(msgspec.Struct, frozen=True):
    """One track of a MIDI file: the bytes of its events, with their offset in the file."""

    data: bytes
    first_byte: int


class Container(msgspec.Struct, frozen=True):
    """Header and tracks of a MIDI file, not yet parsed as events.

    Attributes
    ----------
    format : int
        0, 1 or 2.
    division : int
        As in the file: positive ticks per quarter, or negative SMPTE (signed 16 bits).
    tracks : tuple of TrackChunk
        The tracks, at least one.
    """

    format: int
    division: int
    tracks: tuple[TrackChunk, ...]
    warnings: tuple[Message, ...]


def read_container(path: Path) -> Container:
    """Read the chunks of a MIDI file.

    Chunks of other kinds are passed over, as the standard asks; a RIFF wrapper (``.rmi``) or a foreign header before
    the file's own is too.

    Raises
    ------
    FileError
        The file cannot be read or is not a MIDI file.
    """
    file = str(path)
    data = read_file(path, MOST_BYTES)
    if not data:
        raise FileError("midi.empty", file=file)
    start = data.find(b"MThd", 0, 4096)
    if start < 0:
        raise FileError("midi.not_midi", file=file, byte=0)
    if len(data) < start + 14:
        raise FileError("midi.header_truncated", file=file, byte=len(data))
    length, format_, expected, division = (
        int.from_bytes(data[start + first : start + last], "big")
        for first, last in ((4, 8), (8, 10), (10, 12), (12, 14))
    )
    if division == 0:
        raise FileError("midi.bad_division", file=file, byte=start + 12)
    warnings: list[Message] = []
    end = start + 8 + length
    if length < 6 or not (_is_chunk_id(data[end : end + 4]) or end == len(data)):
        warnings.append(Message("midi.header_length", {"byte": start + 4, "length": length}))
        end = start + 14
    tracks, track_warnings = _tracks(data, end, file)
    warnings += track_warnings
    if len(tracks) < expected:
        warnings.append(Message("midi.tracks_missing", {"expected": expected, "found": len(tracks)}))
    if format_ > 2:
        warnings.append(Message("midi.unknown_format", {"format": format_}))
        format_ = 1
    if format_ == 0 and len(tracks) > 1:
        warnings.append(Message("midi.format_0_tracks", {"tracks": len(tracks)}))
    return Container(format_, division - 0x10000 if division & 0x8000 else division, tuple(tracks), tuple(warnings))


def _tracks(data: bytes, first: int, file: str) -> tuple[list[TrackChunk], list[Message]]:
    tracks: list[TrackChunk] = []
    warnings: list[Message] = []
    at = first
    while len(data) - at >= 8:
        kind = data[at : at + 4]
        if not _is_chunk_id(kind):
            break
        begin = at + 8
        end = begin + int.from_bytes(data[at + 4 : begin], "big")
        if kind == b"MTrk":
            real = _real_end(data, begin, end)
            if real != end:
                number, byte = len(tracks) + 1, at + 4
                if end > len(data) == real and not data[begin:].endswith(_END_OF_TRACK):
                    lengths = {"length": end - begin, "found": real - begin}
                    warnings.append(Message("midi.track_cut_off", {"track": number, "byte": byte, **lengths}))
                else:
                    warnings.append(Message("midi.track_length", {"track": number, "byte": byte}))
                end = real
            tracks.append(TrackChunk(data[begin:end], begin))
        elif end > len(data):
            break
        at = end
    if not tracks:
        raise FileError("midi.no_tracks", file=file, byte=first)
    if any(data[at:]):
        warnings.append(Message("midi.bytes_left_out", {"byte": at, "count": len(data) - at}))
    return tracks, warnings


def _real_end(data: bytes, begin: int, end: int) -> int:
    """Find the offset at which a track ends: at its stated length if a chunk or the end of the file follows there, else
    at the next track header.
    """
    swallowed = data.find(_END_OF_TRACK + b"MTrk", begin, end)
    if swallowed >= 0:
        return swallowed + len(_END_OF_TRACK)
    if end == len(data) or _is_chunk_id(data[end : end + 4]) or not any(data[end:]):
        return min(end, len(data))
    if data[begin:end].endswith(_END_OF_TRACK):
        return end
    following = data.find(b"MTrk", begin)
    return following if following >= 0 else len(data)


def _is_chunk_id(kind: bytes) -> bool:
    return len(kind) == 4 and kind.isascii() and kind.decode("ascii").isprintable()
