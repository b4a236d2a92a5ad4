"""Tracks of MIDI files that are takes are recognised, and imported cleaned or, on request, unchanged."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.project.importing import cleaning, import_project, score_of_rows, usual_rows
from app.project.reimport import reimported
from app.score.contents import PieceContents
from app.score.model import Note
from app.score.read import read_contents
from app.score.take_tracks import take_reason
from app.score.write_take import write_take
from instrument_maps.load import bundled_maps
from tests.support.take_files import MELODY, take_file

MAPS = bundled_maps()


def reason(path: Path) -> str:
    contents = read_contents(path)
    (stream,) = contents.channels
    return take_reason(stream, contents.tempo_map)


def notes(contents: PieceContents, clean: bool | None = None) -> tuple[Note, ...]:
    rows = usual_rows(contents, MAPS)
    score = score_of_rows(contents, rows if clean is None else cleaning(rows, clean), MAPS)
    return score.parts[0].notes


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ({}, "breath"),
        ({"name": "Alto Sax EWI", "late": 0}, "name"),
        ({"name": "Aerophone AE-10", "control": 11}, "name"),
        ({"control": 11}, "breath"),
        ({"late": 0}, ""),
        ({"floor": 60}, ""),
        ({"sampled": 400}, ""),
        ({"chord": True, "name": "EWI"}, ""),
    ],
)
def test_what_looks_like_a_take(tmp_path: Path, changed: dict[str, object], expected: str) -> None:
    assert reason(take_file(tmp_path / "a.mid", **changed)) == expected


def test_a_take_is_imported_clean_and_says_so_and_as_played_where_requested(tmp_path: Path) -> None:
    contents = read_contents(take_file(tmp_path / "a.mid"))
    assert [note.pitch for note in notes(contents)] == list(MELODY)
    assert [note.pitch for note in notes(contents, clean=False)] == [60, 62, 64, 64, 65, 67, 65, 64, 62]
    (message,) = (
        one for one in score_of_rows(contents, usual_rows(contents, MAPS), MAPS).warnings if one.id.endswith("cleaned")
    )
    assert message.arguments["count"] == message.arguments["doubles"] == 1
    assert str(message.arguments["places"]).startswith("1.4")
    kept = {note.id: note for note in notes(contents, clean=False)}
    assert all(note.id in kept for note in notes(contents)), "corrections find their notes"


def test_a_recorded_file_says_that_it_is_one(tmp_path: Path) -> None:
    path = tmp_path / "take.mid"
    events = [(0, b"\x90\x3c\x50"), (10_000, b"\xb0\x02\x50"), (400_000, b"\x80\x3c\x00"), (400_000, b"\xb0\x02\x00")]
    write_take(path, [time for time, _ in events], [message for _, message in events], name="Keys")
    assert reason(path) == "recorded"


@pytest.mark.parametrize("clean", [True, False])
def test_a_file_read_again_is_cleaned_as_it_was_decided(tmp_path: Path, clean: bool) -> None:
    path = take_file(tmp_path / "a.mid")
    contents = read_contents(path)
    rows = cleaning(usual_rows(contents, MAPS), clean)
    project = import_project(contents, rows, MAPS, str(path))
    assert [row.clean for row in project.imported.rows] == [clean]
    assert len(project.score.parts[0].notes) == len(MELODY) + (not clean)
    again = reimported(project, path, MAPS)
    assert again.project.score.parts[0].notes == project.score.parts[0].notes
