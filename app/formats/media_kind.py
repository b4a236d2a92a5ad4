"""Detection of the kind of a sound or video file by its first bytes, since names are unreliable."""

from __future__ import annotations

from enum import Enum, auto
from typing import Final

from app.formats.files import open_file

_HEAD: Final = 1 << 16
"""Number of examined bytes at the start of a file, after a tag of any length."""
_BOXES: Final = frozenset((b"ftyp", b"moov", b"mdat", b"wide", b"free", b"skip", b"pnot", b"moof", b"styp"))
_FILMS: Final = tuple(
    bytes.fromhex(begin)
    for begin in ("1a45dfa3", "3026b2758e66cf11", "464c5601", "000001ba", "000001b3", "060e2b3402050101")
)
"""Initial bytes of containers: Matroska and WebM, ASF (WMV, WMA), Flash video, MPEG program and video streams, MXF."""
_OGG_PICTURES: Final = (b"\x80theora", b"OVP80", b"fishead\0", b"\x01video\0", b"BBCD\0")
_PACKETS: Final = ((188, 0), (192, 4), (204, 0))
"""Packet length of a transport stream and offset of the sync byte within a packet."""
_MARKS: Final = 5
"""Number of consecutive sync bytes that identify a transport stream."""


class MediaKind(Enum):
    """Kind of a sound or video file, by the library that reads its sound."""

    SOUND = auto()
    """Sound that libsndfile reads: WAV, AIFF, FLAC, Ogg, MP3 and others; also unknown files."""
    ADTS = auto()
    """AAC without a container, read by ffmpeg, which does not remove the encoder delay at its start."""
    FILM = auto()
    """A container, with or without pictures, read by ffmpeg."""
    TRANSPORT = auto()
    """An MPEG transport stream, at which the ffmpeg 7.0.2 of Linux crashes."""


def media_kind(path: str) -> MediaKind:
    """Detect the kind of a file from its beginning.

    Raises
    ------
    FileError
        See `app.formats.files.open_file`.
    """
    with open_file(path) as stream:
        head = stream.read(_HEAD)
        begin = tag_bytes(head)
        if begin:
            stream.seek(begin)
            head = stream.read(_HEAD)
    return kind_of(head)


def tag_bytes(head: bytes) -> int:
    """Return the length in bytes of the ID3v2 tag at the beginning, 0 without one. Source: id3.org, ID3v2.4.0, section
    3.1.
    """
    if len(head) < 10 or head[:3] != b"ID3" or any(byte & 0x80 for byte in head[6:10]):
        return 0
    size = head[6] << 21 | head[7] << 14 | head[8] << 7 | head[9]
    return 10 + size + (10 if head[5] & 0x10 else 0)


def kind_of(head: bytes) -> MediaKind:
    """Return the kind of a file from its first bytes after any tag."""
    if head[4:8] in _BOXES or head.startswith(_FILMS) or (head[:4] == b"RIFF" and head[8:12] == b"AVI "):
        return MediaKind.FILM
    if head.startswith(b"OggS") and any(mark in head[:4096] for mark in _OGG_PICTURES):
        return MediaKind.FILM
    if any(_is_transport(head, length, mark) for length, mark in _PACKETS):
        return MediaKind.TRANSPORT
    # ADTS begins with twelve bits of synchronisation and layer 00, which MPEG audio does not use. Source: ISO/IEC
    # 13818-7, 6.2.
    if len(head) > 1 and head[0] == 0xFF and head[1] & 0xF6 == 0xF0:
        return MediaKind.ADTS
    return MediaKind.SOUND


def _is_transport(head: bytes, length: int, mark: int) -> bool:
    marks = [head[at : at + 1] for at in range(mark, mark + _MARKS * length, length)]
    return all(byte == b"G" for byte in marks)
