"""Every command that accepts a MIDI file also accepts a MusicXML score."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli import main
from app.cli.batch import folders_of
from app.cli.status import BAD_INPUT
from tests.unit.score.musicxml.documents import articulation, document, note, slur

PIECE = document(
    note("C5", 4, notations=slur("start"))
    + note("D5", 4, notations=slur("stop") + articulation("breath-mark"))
    + note("E5", 8),
    name="Trumpet in Bb",
)


@pytest.fixture
def piece(tmp_path: Path) -> Path:
    path = tmp_path / "piece.musicxml"
    path.write_text(PIECE, encoding="utf-8")
    return path


def test_inspect_says_that_it_was_read_from_a_score(piece: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", "--json", str(piece)]) == 0
    (player,) = json.loads(capsys.readouterr().out)["players"]
    assert (player["instrument"], player["source"]) == ("trumpet_Bb", "score")
    assert {mark["kind"] for mark in player["marks"]} == {"slur", "breath"}
    assert [one["articulation"] for one in player["notes"]] == ["tongued", "slurred", "tongued"]


def test_a_project_is_made_of_it_and_edited(piece: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = piece.with_suffix(".mid")
    assert main(["midi", str(piece), "--to", str(target)]) == 0
    assert target.read_bytes().startswith(b"MThd")


def test_a_broken_score_is_refused_with_its_place(piece: Path, capsys: pytest.CaptureFixture[str]) -> None:
    piece.write_text(PIECE.replace("<step>D<", "<step>X<"), encoding="utf-8")
    assert main(["inspect", str(piece)]) == BAD_INPUT
    said = capsys.readouterr().err
    assert all(word in said for word in ("piece.musicxml", "Trumpet in Bb", "measure 1", "'X'"))


def test_a_folder_is_exported_with_its_scores_and_no_other_xml(tmp_path: Path) -> None:
    for name, content in (
        ("a.musicxml", PIECE),
        ("b.mxl", ""),
        ("c.xml", PIECE),
        ("settings.xml", "<settings/>"),
        ("d.mid", ""),
    ):
        (tmp_path / name).write_text(content, encoding="utf-8")
    assert folders_of(tmp_path) == {"a.musicxml": "a", "b.mxl": "b", "c.xml": "c", "d.mid": "d"}
