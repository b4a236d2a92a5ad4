"""MIDI files written byte by byte for tests of the reader."""

from __future__ import annotations

import tempfile
from pathlib import Path

from app.score.instrument_choice import MapChoice
from app.score.model import Score
from app.score.read import read_midi

TRUMPET = MapChoice("trumpet", ("trumpet",), ("cornet", "flugelhorn"), 52, 82)
TROMBONE = MapChoice("trombone", ("trombone",), ("bass_trombone",), 36, 70)
MAPS = (TRUMPET, TROMBONE)

END = bytes([0, 0xFF, 0x2F, 0])


def chunk(kind: bytes, data: bytes, length: int | None = None) -> bytes:
    return kind + (len(data) if length is None else length).to_bytes(4, "big") + data


def header(format_: int = 1, tracks: int = 1, division: int = 96) -> bytes:
    values = (format_, tracks, division & 0xFFFF)
    return chunk(b"MThd", b"".join(value.to_bytes(2, "big") for value in values))


def meta(kind: int, data: bytes, delta: int = 0) -> bytes:
    return bytes([delta, 0xFF, kind, len(data)]) + data


def note(pitch: int, ticks: int = 48, channel: int = 0, delta: int = 0) -> bytes:
    return bytes([delta, 0x90 | channel, pitch, 64, ticks, 0x80 | channel, pitch, 0])


def score_of(
    data: bytes, *, encoding: str | None = None, maps: tuple[MapChoice, ...] = MAPS, stem: str = "piece"
) -> Score:
    """Return the score that is read from the bytes of a MIDI file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{stem}.mid"
        path.write_bytes(data)
        return read_midi(path, encoding=encoding, maps=maps)


def one_track(events: bytes, *, format_: int = 1, division: int = 96) -> Score:
    """File with one track and a regular end."""
    return score_of(header(format_, 1, division) + chunk(b"MTrk", events + END))


def notes_of(score: Score) -> list[tuple[int, int, int]]:
    """All notes of all parts as (onset, duration, pitch), sorted."""
    return sorted((n.onset_tick, n.duration_tick, n.pitch) for part in score.parts for n in part.notes)


def ids(score: Score) -> list[str]:
    """Ids of the score's warnings."""
    return [warning.id for warning in score.warnings]
