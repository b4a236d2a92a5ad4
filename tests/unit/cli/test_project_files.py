"""Sub-commands accept a project instead of a MIDI file."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import pytest

from app.cli import main
from app.plan.by_hand.corrections import PinFingering
from app.project.casting import StagePosition
from app.project.edit.corrections import with_corrections
from app.project.edit.dancers import add_dancer, place_dancers
from app.project.edit.events import add_style
from app.project.storage import load, save
from tests.unit.project.pieces import small_project

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    def call(*arguments: str | Path) -> tuple[int, str, str]:
        capsys.readouterr()
        status = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return call


@pytest.fixture
def project(tmp_path: Path) -> Path:
    project = with_corrections(small_project(), "1.1.1", [PinFingering("1:3", "3")])
    path = tmp_path / "piece.SUISOU"
    save(replace(project, fps=Fraction(24000, 1001)), path)
    return path


def test_inspect_shows_the_corrections_of_a_project(run: Run, project: Path) -> None:
    status, out, _ = run("inspect", project, "--json")
    assert status == 0
    assert json.loads(out)["players"][0]["notes"][2]["fingering"] == "3"


def test_inspect_lists_dancers(run: Run, tmp_path: Path) -> None:
    danced, _ = add_dancer(small_project(), tmp_path / "salsa.choreography", "Ana")
    danced = place_dancers(danced, {"dancer:1": StagePosition(1.5, 3.0, math.pi / 2.0)})
    save(danced, tmp_path / "danced.suisou")
    found = json.loads(run("inspect", tmp_path / "danced.suisou", "--json")[1])
    assert found["dancers"] == [
        {
            "name": "Ana", "choreography": str(tmp_path / "salsa.choreography"),
            "character": danced.dancers[0].character_id, "character_title": "Woman",
            "outfit": None, "outfit_colours": {},
            "x_m": 1.5, "z_m": 3.0, "turn_deg": 90.0, "seed": 0, "delay_beats": 0.0, "mirrored": False, "source": -1,
            "size": 1.0, "weight": 0.0,
            "melody": 0.5,
        }
    ]  # fmt: skip
    assert len(found["players"]) == 2
    assert "woman_adult" in run("inspect", tmp_path / "danced.suisou", "--no-contacts")[1]


def test_options_come_on_top_of_a_project(run: Run, project: Path) -> None:
    assert json.loads(run("inspect", project, "--json", "--no-contacts")[1])["first_frame_s"] == -2.0
    settings = ("--set", "trombone.instrument=trumpet_Bb", "--felt-beat", "2", "--preroll", "8")
    status, out, _ = run("inspect", project, "--json", *settings)
    assert status == 0
    table = json.loads(out)
    assert [player["instrument"] for player in table["players"]] == ["trumpet_Bb", "trumpet_Bb"]
    assert table["first_frame_s"] == -8.0


SETTINGS = ("title", "fps_exact", "preroll_beats", "felt_beat_quarters", "seed")


def test_settings_of_the_piece_come_on_top_of_a_project_or_a_midi_file(run: Run, project: Path) -> None:
    def settings(file: Path, *options: str) -> tuple[object, ...]:
        status, out, _ = run("inspect", file, "--json", "--no-contacts", *options)
        assert status == 0
        found = json.loads(out)
        assert found["fps"] == float(Fraction(found["fps_exact"]))
        return tuple(found[name] for name in SETTINGS)

    typed = (
        "--title",
        " Fanfare  für\nalle ",
        "--fps",
        "29.97",
        "--preroll",
        "2.5",
        "--felt-beat",
        "3/2",
        "--seed",
        "7",
    )
    for file in (project, QUARTET):
        assert settings(file, *typed, "--seed", "7") == ("Fanfare für alle", "30000/1001", 2.5, 1.5, 7)
    held = load(project)
    beaten = project.with_name("beaten.suisou")
    save(replace(held, felt_beat_quarters=3.0), beaten)
    as_held = (held.score.title, str(held.fps), held.preroll_beats, 3.0, held.seed)
    assert settings(beaten) == as_held
    assert settings(beaten, "--felt-beat", "auto") == (*as_held[:3], None, as_held[4])


def test_an_export_has_the_projects_frame_rate(run: Run, project: Path, tmp_path: Path) -> None:
    export = ("export", project, "--format", "bvh", "--player", "trumpet", "--to")
    assert run(*export, tmp_path / "own")[0] == 0
    assert json.loads((tmp_path / "own" / "report.json").read_text())["fps_exact"] == "24000/1001"
    assert run(*export, tmp_path / "other", "--fps", "12")[0] == 0
    assert json.loads((tmp_path / "other" / "report.json").read_text())["fps_exact"] == "12"


@pytest.mark.parametrize(("option", "value"), [("--encoding", "cp932"), ("--written", "*"), ("--sounding", "*")])
def test_what_only_midi_has_is_bad_use(run: Run, project: Path, option: str, value: str) -> None:
    status, _, complaint = run("inspect", project, option, value)
    assert status == 2
    assert str(project) in complaint
    assert option in complaint


def test_written_pitches_sound_as_the_instrument_has_them(run: Run) -> None:
    def pitches(*options: str) -> dict[str, list[int]]:
        status, out, _ = run("inspect", QUARTET, "--json", "--no-contacts", *options)
        assert status == 0
        return {player["name"]: [note["pitch"] for note in player["notes"]] for player in json.loads(out)["players"]}

    usual, written = pitches(), pitches("--written", "trumpet*")
    # A trumpet in B flat is written a whole tone higher than it sounds.
    shifts = {name: {now - before for now, before in zip(written[name], usual[name], strict=True)} for name in usual}
    assert {name for name, shift in shifts.items() if shift == {-2}} == {
        name for name in usual if name.startswith("Trumpet")
    }
    assert {frozenset(shift) for name, shift in shifts.items() if not name.startswith("Trumpet")} == {frozenset({0})}
    status, _, complaint = run("inspect", QUARTET, "--written", "Sax")
    assert status == 2
    assert "'Sax'" in complaint


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b'{"schema_version": 99}', b"MThd", b"\xff\xfe"])
def test_a_damaged_project_is_bad_input(run: Run, tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "piece.suisou"
    path.write_bytes(content)
    status, out, complaint = run("inspect", path)
    assert (status, out) == (1, "")
    assert str(path) in complaint
    assert "Traceback" not in complaint


def test_an_instrument_that_is_not_installed_is_named(run: Run, tmp_path: Path) -> None:
    project = small_project()
    ghost = msgspec.structs.replace(project.players[0], instrument_id="ophicleide")
    save(replace(project, players=(ghost, project.players[1])), tmp_path / "piece.suisou")
    status, _, complaint = run("inspect", tmp_path / "piece.suisou")
    assert status == 4
    assert "ophicleide" in complaint
    assert run("inspect", tmp_path / "piece.suisou", "--set", "trumpet.instrument=trumpet_Bb")[0] == 0


def test_bars_in_another_style_are_listed(run: Run, tmp_path: Path) -> None:
    project = small_project()
    player = project.players[0]
    save(add_style(project, player.id, "soloist", 0, 1920).project, tmp_path / "piece.suisou")
    first, second = json.loads(run("inspect", str(tmp_path / "piece.suisou"), "--json", "--no-contacts")[1])["players"]
    (listed,) = first["styles"]
    assert (listed["style"], listed["start_beat"], listed["end_beat"]) == ("soloist", 0.0, 4.0)
    assert listed["reason"] == "set manually"
    assert "styles" not in second
