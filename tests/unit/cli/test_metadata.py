"""``suisou metadata``: lists of tables, and a piece's acting metadata."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from app.cli import main
from app.project.casting import conductor_place
from app.project.edit.players import set_parameters
from app.project.storage import load, save
from metadata.library import FOLDERS, STYLES
from metadata.tables import ROOT
from tests.unit.project.pieces import small_project

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """Run the program and return status, stdout and stderr."""

    def call(*arguments: object) -> tuple[int, str, str]:
        status = main([str(argument) for argument in arguments])
        return status, *capsys.readouterr()

    return call


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for folder in FOLDERS:
        monkeypatch.setenv(folder.variable, str(tmp_path / folder.name))
        monkeypatch.setattr(folder, "last", None)
    return tmp_path


def test_everything_is_listed_ones_own_with_a_star_and_faults_by_file(run: Run, folders: Path) -> None:
    (folders / "styles").mkdir()
    text = (ROOT / "styles" / "jazz.toml").read_text(encoding="utf-8")
    (folders / "styles" / "mine.toml").write_text(text.replace('"jazz"', '"mine"'), encoding="utf-8")
    (folders / "styles" / "wrong.toml").write_text("name = 1", encoding="utf-8")
    status, out, _ = run("metadata")
    assert status == 0
    lines = out.splitlines()
    assert any(line.split()[:2] == ["styles", "mine*"] for line in lines)
    for folder in FOLDERS:
        for name in folder.now().items:
            assert any(line.split()[0:1] == [folder.name] and name in line for line in lines)
        assert str(folders / folder.name) in out
    assert "styles/wrong.toml: " in out


def test_a_table_is_checked_by_the_folder_it_is_in(run: Run, tmp_path: Path) -> None:
    assert run("metadata", "--check", ROOT / "gestures" / "shrug.toml")[0] == 0
    (tmp_path / "gestures").mkdir(exist_ok=True)
    wrong = tmp_path / "gestures" / "shrug.toml"
    text = (ROOT / "gestures" / "shrug.toml").read_text(encoding="utf-8")
    wrong.write_text(text.replace('"head"', '"tail"'), encoding="utf-8")
    status, _, said = run("metadata", "--check", wrong)
    assert status == 1
    assert "gestures/shrug.toml: tracks[2].target" in said
    status, _, said = run("metadata", "--check", tmp_path / "shrug.toml")
    assert status == 2
    assert "gestures" in said


@pytest.mark.parametrize(
    ("when", "do", "name"),
    [
        ("longer_s = 1.0", 'expression = "smyle"', "smyle"),
        ("longer_s = 1.0", 'gesture = "sallute"', "sallute"),
        ('styles = ["jaz"]', 'gesture = "shrug"', "jaz"),
        ('habits = ["noder"]', 'gesture = "shrug"', "noder"),
    ],
)
def test_a_rule_that_names_what_is_not_there_is_not_valid(
    run: Run, folders: Path, when: str, do: str, name: str
) -> None:
    (folders / "rules").mkdir(exist_ok=True)
    file = folders / "rules" / "mine.toml"
    rule = f'[[rules]]\nname = "a"\nwhen = {{ {when} }}\ndo = {{ {do} }}\n'
    file.write_text(f'name = "mine"\ndescription = ""\n{rule}', encoding="utf-8")
    status, _, said = run("metadata", "--check", file)
    assert status == 1
    assert repr(name) in said
    assert "rules/mine.toml: the rule a " in run("metadata")[1]


def test_a_piece_is_saved_compared_and_loaded(run: Run, tmp_path: Path) -> None:
    piece, other, file = tmp_path / "a.suisou", tmp_path / "b.suisou", tmp_path / "said.toml"
    project = small_project()
    save(project, piece)
    save(set_parameters(project, (project.players[0].id,), style="jazz", gaze=0.5), other)
    assert run("metadata", other, "--save", file)[0] == 0
    status, out, said = run("metadata", piece, "--diff", file)
    assert status == 1
    assert f"players.{project.players[0].name}.parameters.style: section_player -> jazz" in out
    assert "2 places" in said
    assert run("metadata", piece, "--load", file)[0] == 0
    assert load(piece).players[0].parameters.style == "jazz"
    assert run("metadata", piece, "--diff", file)[0] == 0


def test_a_midi_file_is_called_one(run: Run, tmp_path: Path) -> None:
    quartet = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
    status, _, said = run("metadata", quartet, "--save", tmp_path / "x.toml")
    assert status == 1
    assert "is a MIDI file" in said
    assert ".bak" not in said


def test_wrong_use_is_said(run: Run, tmp_path: Path) -> None:
    assert run("metadata", "--save", tmp_path / "x.toml")[0] == 2
    assert run("metadata", tmp_path / "x.suisou")[0] == 2


def test_style_habits_and_the_sections_intensity_are_set_where_a_piece_is_named(run: Run, tmp_path: Path) -> None:
    piece = tmp_path / "a.suisou"
    save(small_project(), piece)
    status, out, _ = run(
        "inspect", piece, "--json", "--no-contacts", "--section-intensity", "0.5", "--set", "*.habits=tapper,nodder"
    )
    assert status == 0
    assert '"section_intensity": 0.5' in out
    status, _, said = run("inspect", piece, "--set", "*.style=punk")
    assert status == 2
    assert all(name in said for name in STYLES.now().items)
    assert run("inspect", piece, "--section-intensity", "3")[0] == 2


def test_a_conductor_is_placed_where_a_piece_is_named(run: Run, tmp_path: Path) -> None:
    piece = tmp_path / "a.suisou"
    save(small_project(), piece)

    def placed(*options: str) -> object:
        status, out, _ = run("inspect", piece, "--json", "--no-contacts", *options)
        assert status == 0
        return json.loads(out)["conductor"]

    assert placed() is None
    assert placed("--conductor=-0.5,2") == {"x_m": -0.5, "z_m": 2.0}
    usual = conductor_place([player.stage for player in small_project().players])
    assert placed("--conductor", "usual") == {"x_m": usual.x_m, "z_m": usual.z_m}
    save(replace(small_project(), conductor=usual), piece)
    assert placed() is None, "an empty place of an older version"
    save(replace(small_project(), conductor=msgspec.structs.replace(usual, on_stage=True)), piece)
    assert placed() == {"x_m": usual.x_m, "z_m": usual.z_m}
    assert placed("--conductor", "none") is None
    for wrong in ("1", "a,b", "0,1e9", "0,nan"):
        assert run("inspect", piece, f"--conductor={wrong}")[0] == 2
