"""``suisou midi``: a file or a project as MIDI."""

from __future__ import annotations

from importlib.resources import as_file, files
from pathlib import Path

import pytest

from app.cli import main
from app.cli.status import BAD_INPUT, DONE
from app.project.model import map_choices
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.unit.score.midi_bytes import END, chunk, header, meta, note


@pytest.fixture
def quartet() -> Path:
    """The bundled example."""
    with as_file(files("resources") / "examples" / "quartet.mid") as path:
        return path


def test_the_file_holds_what_was_read(quartet: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "out.mid"
    assert main(["midi", str(quartet), "--to", str(target)]) == DONE
    maps = map_choices(bundled_maps().values())
    before, after = read_midi(quartet, maps=maps), read_midi(target, maps=maps)
    assert (after.title, after.tempo_map, after.metres) == (before.title, before.tempo_map, before.metres)
    assert [
        [(one.onset_tick, one.duration_tick, one.pitch, one.velocity) for one in part.notes] for part in after.parts
    ] == [[(one.onset_tick, one.duration_tick, one.pitch, one.velocity) for one in part.notes] for part in before.parts]
    assert [part.map_id for part in after.parts] == [part.map_id for part in before.parts]
    assert capsys.readouterr().out == f"{target}: 4 tracks, 530 notes\n"


def test_the_file_is_called_by_another_title(quartet: Path, tmp_path: Path) -> None:
    target = tmp_path / "out.mid"
    assert main(["midi", str(quartet), "--title", "吹奏", "--to", str(target)]) == DONE
    assert read_midi(target, maps=map_choices(bundled_maps().values())).title == "吹奏"


def test_a_file_is_not_written_over_itself(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "piece.mid"
    path.write_bytes(header() + chunk(b"MTrk", meta(3, b"Trumpet") + note(60) + END))
    held = path.read_bytes()
    assert main(["midi", str(path), "--to", str(tmp_path / "." / "piece.mid")]) == BAD_INPUT
    assert path.read_bytes() == held
    assert "save to another file" in capsys.readouterr().err


def test_no_folder_is_said(quartet: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["midi", str(quartet), "--to", str(tmp_path / "none" / "out.mid")]) == BAD_INPUT
    assert "cannot be written" in capsys.readouterr().err
