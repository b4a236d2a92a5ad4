"""Parts without an instrument, and the printed command that assigns one."""

from __future__ import annotations

import shlex
from pathlib import Path

import mido
import pytest

from app.cli import main

NAMES = ("Xyzzy", "Xyzzy", "it's me", "a=b", "-x", '$(echo) `x` "y"', "*", "")


def piece(path: Path, names: tuple[str, ...]) -> Path:
    tracks = [mido.MidiTrack()]
    for channel, name in enumerate(names):
        track = mido.MidiTrack([mido.MetaMessage("track_name", name=name)] if name else [])
        for pitch in (60, 64, 67):
            track.append(mido.Message("note_on", note=pitch, velocity=80, channel=channel))
            track.append(mido.Message("note_off", note=pitch, channel=channel, time=480))
        tracks.append(track)
    mido.MidiFile(tracks=tracks).save(path)
    return path


def command_in(said: str) -> list[str]:
    """Words of the command in a message, as parsed by a shell."""
    command = said.partition("for example: ")[2].rpartition(" (`suisou instruments`")[0]
    return shlex.split(command)


def test_the_command_that_is_named_gives_every_part_a_player(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = piece(tmp_path / "a piece.mid", NAMES)
    assert main(["inspect", str(file), "--no-contacts"]) == 0
    printed = capsys.readouterr()
    for name in ("Xyzzy 1", "Xyzzy 2", "it's me", "Track 9"):
        assert name in printed.err
    program, *words = command_in(printed.err)
    assert (program, words[:3]) == ("suisou", ["inspect", str(file), "--no-contacts"])
    assert main(words) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    assert f"{len(NAMES)} players" in printed.out
    assert "not played" not in printed.out


@pytest.mark.parametrize("command", ["export", "film", "stream", "evaluate"])
def test_a_command_that_needs_players_says_it_itself_and_whatever_the_file_is_called(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    said = set()
    for stem in ("piece", "trumpet solo", "brass quintet"):
        file = piece(tmp_path / f"{stem}.mid", ("Xyzzy",))
        more = {"film": ["--to", str(tmp_path / "a.mp4")], "stream": []}.get(command, ["--to", str(tmp_path / "out")])
        if command == "evaluate":
            more += ["--film", str(file)]
        assert main([command, str(file), *more]) == 1
        error = capsys.readouterr().err
        assert command_in(error)[-2:] == ["--assign", "Xyzzy=sax_alto_Eb"]
        said.add(error.replace(shlex.quote(str(file)), "FILE").replace(str(file), "FILE"))
    assert len(said) == 1


def test_parts_of_other_instruments_can_be_assigned_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # Notation programs write unnamed tracks with program 0, which is their "no program" and General MIDI's piano.
    file = piece(tmp_path / "piece.mid", ("Piano", "Violin"))
    assert main(["export", str(file), "--to", str(tmp_path / "out")]) == 1
    error = capsys.readouterr().err
    assert "no part is for a wind instrument (Piano, Violin)" in error
    words = command_in(error)[1:]
    assert main(["inspect", str(file), "--no-contacts", *words[words.index("--assign") :]]) == 0
    assert "2 players" in capsys.readouterr().out


def test_a_piece_of_a_folder_says_so_with_a_command_of_its_own(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "pieces").mkdir()
    file = piece(tmp_path / "pieces" / "one.mid", ("Xyzzy",))
    assert main(["export", str(tmp_path / "pieces"), "--to", str(tmp_path / "out")]) == 1
    words = command_in(capsys.readouterr().out)
    assert words == [
        "suisou",
        "export",
        str(file),
        "--to",
        str(tmp_path / "out" / "one"),
        "--assign",
        "Xyzzy=sax_alto_Eb",
    ]
