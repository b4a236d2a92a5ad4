"""Dancers are added at the command line, also to a piece that has percussion only."""

from __future__ import annotations

import json
from pathlib import Path

import mido
import pytest

from app.cli import main, parser
from app.cli.options import open_project
from app.cli.status import BAD_INPUT, BAD_USE
from app.project.model import Project


@pytest.fixture
def drums(tmp_path: Path) -> Path:
    """Six bars of four, with a kick and a snare in each."""
    track = mido.MidiTrack([mido.MetaMessage("track_name", name="Drums")])
    for _ in range(6):
        for key in (36, 38):
            track.append(mido.Message("note_on", channel=9, note=key, velocity=90, time=480))
            track.append(mido.Message("note_off", channel=9, note=key, time=480))
    path = tmp_path / "drums.mid"
    mido.MidiFile(ticks_per_beat=480, tracks=[track]).save(path)
    return path


def opened(piece: Path, *options: str) -> Project:
    return open_project(parser().parse_args(["export", str(piece), "--to", "out", *options]), "export.no_players")


def test_a_piece_of_drums_says_how_to_add_a_dancer(drums: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for language, word in (("en", "only percussion"), ("ja", "打楽器だけ")):
        assert main(["export", str(drums), "--to", str(drums.parent / "out"), "--language", language]) == BAD_INPUT
        said = capsys.readouterr().err
        assert word in said
        assert "--dancer salsa" in said


def test_dancers_have_names_settings_and_places(drums: Path) -> None:
    options = ["--dancer", "salsa", "--dancer", "Anna = salsa", "--dancer", "salsa"]
    settings = ["--set", "Dancer.seed=7", "--set", "*.mirrored=true", "--set", "Anna.size=1.2", "--set", "a*.melody=0"]
    one, anna, two = opened(drums, *options, *settings).dancers
    assert (one.name, anna.name, two.name) == ("Dancer", "Anna", "Dancer 2")
    assert (one.seed, anna.size, anna.melody, two.seed) == (7, 1.2, 0.0, 0)
    assert one.mirrored
    assert anna.mirrored
    assert len({dancer.stage for dancer in (one, anna, two)}) == 3


def test_a_setting_concerns_whom_it_fits(drums: Path) -> None:
    """Players have no mirrored motion, and dancers no amplitude; a seed is everyone's."""
    quartet = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
    settings = ["--set", "*.amplitude=0.5", "--set", "*.mirrored=true", "--set", "*.seed=5"]
    project = opened(quartet, "--dancer", "salsa", *settings)
    assert {player.parameters.amplitude for player in project.players} == {0.5}
    assert {player.parameters.seed for player in project.players} == {5}
    assert [(dancer.seed, dancer.mirrored) for dancer in project.dancers] == [(5, True)]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--dancer", "sala"], "'sala'"),
        (["--dancer", "no/such.choreography"], "salsa"),
        (["--dancer", "salsa", "--set", "Dancer.size=9"], "1.5"),
        (["--dancer", "salsa", "--set", "Dancer.amplitude=1"], "mirrored"),
        (["--dancer", "salsa", "--set", "Ben.mirrored=true"], "'Ben'"),
        (["--dancer", "salsa", "--set", "Dancer.character=nobody"], "nobody"),
    ],
)
def test_what_is_not_there_is_refused(
    drums: Path, options: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", str(drums), "--to", str(drums.parent / "out"), *options]) == BAD_USE
    assert said in capsys.readouterr().err


def test_bars_of_a_piece_of_drums_are_exported(drums: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = drums.parent / "out"
    command = ["export", str(drums), "--to", str(out), "--format", "bvh", "--dancer", "salsa", "--fps", "30"]
    assert main([*command, "--from-bar", "9"]) == BAD_USE
    assert "bars 1 to 6" in capsys.readouterr().err
    main([*command, "--from-bar", "2", "--to-bar", "3"])
    assert "Frames: 120\n" in (out / "Dancer.bvh").read_text("utf-8")
    assert json.loads((out / "report.json").read_text("utf-8"))
