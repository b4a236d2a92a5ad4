"""Pieces with a title derived from their file's name, since the program ignores the file's name."""

from __future__ import annotations

from pathlib import Path

_HEADER = 14


def titled(data: bytes, title: str) -> bytes:
    """Bytes of a MIDI file with this title: an additional name of its first track, before any others."""
    name = title.encode()
    start = data.index(b"MTrk", _HEADER) + 8
    length = int.from_bytes(data[start - 4 : start], "big")
    event = bytes([0, 0xFF, 3, len(name)]) + name
    return data[: start - 4] + (length + len(event)).to_bytes(4, "big") + event + data[start:]


def titled_copy(source: Path, folder: Path) -> Path:
    """Copy of a MIDI file whose title is the file's name in words."""
    target = folder / "piece.mid"
    target.write_bytes(titled(source.read_bytes(), source.stem.replace("_", " ")))
    return target
