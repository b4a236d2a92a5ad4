"""Signs that repeat measures, and slashes."""

from __future__ import annotations

from pathlib import Path

from app.errors import Message
from tests.unit.score.musicxml.documents import document, note, read

Q = 480


def style(inside: str) -> str:
    return f"<attributes><measure-style>{inside}</measure-style></attributes>"


def repeat(text: str, kind: str = "start") -> str:
    return style(f'<measure-repeat type="{kind}">{text}</measure-repeat>')


SCALE = "".join(note(name) for name in ("C4", "D4", "E4", "F4"))
CHORDS = note("G4", 8) + note("A4", 8)
EMPTY = note("r", 16)


def bars(folder: Path, *measures: str) -> list[list[int]]:
    stream = read(folder, document(*measures)).channels[0]
    found: list[list[int]] = [[] for _ in measures]
    for onset, pitch in zip(stream.onset_ticks, stream.pitches, strict=True):
        found[onset // (4 * Q)].append(pitch)
    return found


def test_a_measure_without_notes_repeats_the_one_before(tmp_path: Path) -> None:
    assert bars(tmp_path, SCALE, repeat("1") + EMPTY, EMPTY, repeat("", "stop") + EMPTY, CHORDS) == [
        [60, 62, 64, 65], [60, 62, 64, 65], [60, 62, 64, 65], [], [67, 69]
    ]  # fmt: skip


def test_two_measures_repeat_the_two_before(tmp_path: Path) -> None:
    assert bars(tmp_path, SCALE, CHORDS, repeat("2") + EMPTY, EMPTY)[2:] == [[60, 62, 64, 65], [67, 69]]


def test_notes_that_the_file_has_are_played_as_they_are(tmp_path: Path) -> None:
    assert bars(tmp_path, SCALE, repeat("1") + CHORDS) == [[60, 62, 64, 65], [67, 69]]


def test_slashes_are_reported_with_their_measures_and_not_played(tmp_path: Path) -> None:
    slashes = "".join(note("B4", 4, "<notehead>slash</notehead>") for _ in range(4))
    contents = read(tmp_path, document(SCALE, slashes, slashes, CHORDS, slashes))
    assert Message("musicxml.slashes", {"part": "Trumpet in Bb", "measures": "2-3, 5"}) in contents.warnings
    assert 71 not in contents.channels[0].pitches
