"""``suisou midi``: a file or a project as MIDI."""

from __future__ import annotations

from importlib.resources import as_file, files
from pathlib import Path

import mido
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


def test_percussion_and_a_melody_on_channel_10_are_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """In the input, channel 10 is a trumpet and channel 11 a drum kit by XG; the output has the drums on channel 10 and
    the trumpet elsewhere, so that any program understands it.
    """
    melody = bytes([0, 0xB9, 0, 0, 0, 0xC9, 56]) + b"".join(note(pitch, channel=9) for pitch in (60, 62, 64))
    drums = bytes([0, 0xBA, 0, 127, 0, 0xCA, 0]) + b"".join(note(pitch, 12, 10) for pitch in (36, 33, 42, 42, 25))
    drums += note(42, 12, 10) + bytes([0, 0x9A, 36, 90, 0, 0x9A, 36, 80, 9, 0x8A, 36, 0, 0, 0x8A, 36, 0])
    reset = bytes([0, 0xF0, 8, 0x43, 0x10, 0x4C, 0, 0, 0x7E, 0, 0xF7])
    source, target = tmp_path / "xg.mid", tmp_path / "out.mid"
    source.write_bytes(header(1, 3) + b"".join(chunk(b"MTrk", events + END) for events in (reset, melody, drums)))
    assert main(["midi", str(source), "--to", str(target)]) == DONE
    assert capsys.readouterr().out == f"{target}: 2 tracks, 3 notes, 8 percussion hits\n"
    maps = map_choices(bundled_maps().values())
    before, after = read_midi(source, maps=maps), read_midi(target, maps=maps)
    assert after.percussion == before.percussion
    assert [hit.pitch for hit in after.percussion] == [36, 35, 42, 42, 38, 42, 36, 36]
    assert [(part.map_id, [(one.onset_tick, one.pitch) for one in part.notes]) for part in after.parts] == [
        ("trumpet_Bb", [(0, 60), (48, 62), (96, 64)])
    ]
    assert {
        message.channel for track in mido.MidiFile(target).tracks for message in track if message.type == "note_on"
    } == {0, 9}


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
