"""Damaged MIDI files are opened or refused with the program's own message."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from app.errors import FileError
from app.score.model import Score
from app.score.read import read_midi
from tests.unit.score.midi_bytes import MAPS, score_of

DATA = Path(__file__).parents[1] / "data/midi"
SMALL = sorted(path for path in DATA.glob("*/*.mid") if 0 < path.stat().st_size < 6000)
LARGE = sorted(path for path in DATA.glob("*/*.mid") if path.stat().st_size >= 6000)
ROUNDS_SMALL, ROUNDS_LARGE = 12, 1


def check(score: Score) -> None:
    """Fail unless a score has the properties that every score has, however odd its file."""
    assert score.ticks_per_quarter > 0
    assert score.metres[0].tick == 0
    ids = [note.id for part in score.parts for note in part.notes]
    assert len(set(ids)) == len(ids)
    for part in score.parts:
        assert part.notes
        assert all(note.onset_tick >= 0 and note.duration_tick > 0 and 0 <= note.pitch < 128 for note in part.notes)
        assert all(0 < note.velocity < 128 for note in part.notes)
        for curve in part.curves:
            assert all(a < b for a, b in zip(curve.ticks, curve.ticks[1:], strict=False))
            assert all(-1 <= value <= 1 for value in curve.values)
    assert score.tempo_map.seconds(score.end_tick) >= 0
    assert score.metre_map.tick_of_bar(score.metre_map.bar_of_tick(score.end_tick)) <= score.end_tick


def opens_or_says_why(data: bytes) -> None:
    try:
        score = score_of(data)
    except FileError:
        return
    check(score)


@pytest.mark.parametrize("path", SMALL + LARGE, ids=lambda path: path.stem)
def test_bytes_changed(path: Path) -> None:
    generator = np.random.Generator(np.random.PCG64(path.stat().st_size))
    original = np.frombuffer(path.read_bytes(), np.uint8)
    for _ in range(ROUNDS_SMALL if path in SMALL else ROUNDS_LARGE):
        data = original.copy()
        places = generator.integers(0, len(data), generator.integers(1, 1 + max(2, len(data) // 100)))
        data[places] = generator.integers(0, 256, len(places))
        opens_or_says_why(data.tobytes())


@pytest.mark.parametrize("path", SMALL, ids=lambda path: path.stem)
def test_bytes_missing_or_added(path: Path) -> None:
    generator = np.random.Generator(np.random.PCG64(path.stat().st_size))
    data = path.read_bytes()
    for _ in range(ROUNDS_SMALL):
        first, last = sorted(generator.integers(0, len(data) + 1, 2).tolist())
        opens_or_says_why(data[:first])
        opens_or_says_why(data[:first] + data[last:])
        opens_or_says_why(data[:last] + data[first:])


def test_noise_after_a_header() -> None:
    generator = np.random.Generator(np.random.PCG64(1))
    for length in (0, 1, 7, 8, 100, 3000):
        noise = generator.integers(0, 256, length, np.uint8).tobytes()
        opens_or_says_why(b"MThd" + bytes([0, 0, 0, 6, 0, 1, 0, 2, 0, 96]) + noise)
        opens_or_says_why(
            b"MThd" + bytes([0, 0, 0, 6, 0, 1, 0, 2, 0, 96]) + b"MTrk" + length.to_bytes(4, "big") + noise
        )


@pytest.mark.parametrize("path", sorted((DATA / "corrupt").glob("*.mid")), ids=lambda path: path.stem)
def test_the_corrupt_files_are_explained(path: Path) -> None:
    """One clear error, or a warning that says what was left out."""
    if path.stem in {"MIDIBadHeaderChunk", "MIDIBadTrackHdr", "test-empty-file"}:
        with pytest.raises(FileError) as caught:
            read_midi(path, maps=MAPS)
        assert caught.value.message.arguments["file"] == str(path)
    else:
        score = read_midi(path, maps=MAPS)
        check(score)
        assert any(warning.id.startswith("midi.") for warning in score.warnings)
