"""An export on the command line reports before writing which files it replaces, like the dialog."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import mido
import pytest

from app.cli import main
from app.errors import FileError


def piece(path: Path) -> str:
    """Four bars for a trumpet."""
    track = mido.MidiTrack([mido.MetaMessage("track_name", name="Trumpet")])
    for pitch in (67, 69, 71, 72):
        track += [mido.Message("note_on", note=pitch), mido.Message("note_off", note=pitch, time=1920)]
    mido.MidiFile(ticks_per_beat=480, tracks=[track]).save(path)
    return str(path)


def test_what_is_there_is_said_before_it_is_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file, folder = piece(tmp_path / "x.mid"), tmp_path / "out"
    command = ["export", file, "--to", str(folder), "--format", "bvh", "--fps", "24"]
    assert main([*command, "--from-bar", "1", "--to-bar", "2"]) == 0
    assert "already" not in capsys.readouterr().err
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert set(before) == {"Trumpet.bvh", "report.json"}
    said = []

    def refuse(*_args: object, **_named: object) -> None:
        said.append(capsys.readouterr().err)
        raise FileError("file.cannot_write", file=str(folder), reason="the disk is full")

    monkeypatch.setattr("app.cli.export.write", refuse)
    assert main(command) != 0
    assert f"will be replaced in {folder}: 2 (Trumpet.bvh, report.json)" in said[0]
    assert "the export that was there has bars 1 to 2 only; this one has the whole piece" in said[0]
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_an_unreal_project_is_looked_at_before_it_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file, project = piece(tmp_path / "x.mid"), tmp_path / "Concert.uproject"
    project.write_text('{"FileVersion": 3, "EngineAssociation": "5.6"}')
    command = ["export", file, "--unreal", str(project), "--fps", "24"]
    assert main([*command, "--from-bar", "1", "--to-bar", "1"]) == 0
    assert "already" not in capsys.readouterr().err
    said = []

    def refuse(*_args: object, **_named: object) -> None:
        said.append(capsys.readouterr().err)
        raise FileError("file.cannot_write", file=str(project), reason="the disk is full")

    monkeypatch.setattr("app.export.unreal.run.export_into", refuse)
    assert main([*command, "--from-bar", "2", "--to-bar", "3"]) != 0
    assert f"will be replaced in {tmp_path}: " in said[0]
    assert "SK_Trumpet.fbx" in said[0]
    assert "the export that was there has bars 1 to 1; this one has bars 2 to 3" in said[0]


@pytest.mark.parametrize(
    ("formats", "keys", "named"),
    [
        ("glb,usd,fbx", "reduced", "FBX, GLB"),
        ("vrma", "reduced", "GLB"),
        ("usd", "reduced", ""),
        ("glb", "linear", ""),
        ("glb", "every", ""),
    ],
)
def test_tangents_that_blender_drops_are_named_with_the_remedy(
    formats: str,
    keys: str,
    named: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The instrument in a GLB beside a VRM Animation has tangents; the character has none."""

    def refuse(*_args: object, **_named: object) -> None:
        raise FileError("file.cannot_write", file=str(tmp_path), reason="the disk is full")

    monkeypatch.setattr("app.formats.usd_package.usd_installed", lambda: True)
    monkeypatch.setattr("app.cli.export.write", refuse)
    main(["export", piece(tmp_path / "x.mid"), "--to", str(tmp_path / "out"), "--format", formats, "--keys", keys])
    said = capsys.readouterr().err
    assert (f"reduced keys of {named} have tangents" in said) == bool(named)
    assert ("--keys linear" in said) == bool(named)


@pytest.mark.parametrize(("formats", "named"), [("fbx,usd", "USD"), ("fbx,glb", "")])
def test_a_format_that_keeps_its_meshes_is_named_where_motion_alone_is_asked_for(
    formats: str, named: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(*_args: object, **_named: object) -> None:
        raise FileError("file.cannot_write", file=str(tmp_path), reason="the disk is full")

    monkeypatch.setattr("app.formats.usd_package.usd_installed", lambda: True)
    monkeypatch.setattr("app.cli.export.write", refuse)
    main(["export", piece(tmp_path / "x.mid"), "--to", str(tmp_path / "out"), "--format", formats, "--motion-only"])
    assert (f"{named} is written with meshes all the same" in capsys.readouterr().err) == bool(named)


@pytest.mark.parametrize("several", [False, True])
def test_without_its_package_usd_is_refused_before_any_piece_is_read(
    several: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The command that installs it is one for the very environment in which Suisou runs, as that of ``./run``."""

    def read(*_args: object, **_named: object) -> None:
        raise AssertionError("a piece was read")

    monkeypatch.setattr("app.formats.usd_package.usd_installed", lambda: False)
    monkeypatch.setattr("app.cli.export.open_project", read)
    monkeypatch.setattr("app.cli.batch.export_folder", read)
    file = piece(tmp_path / "x.mid")
    named = str(tmp_path) if several else file
    assert main(["export", named, "--to", str(tmp_path / "out"), "--format", "fbx,usd"]) != 0
    said = capsys.readouterr().err
    assert f"install it with: {shlex.quote(sys.executable)} -m pip install usd-core" in said
    assert not (tmp_path / "out").exists()
