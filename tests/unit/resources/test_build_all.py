"""The command that rebuilds generated files, and the table that lists them."""

from __future__ import annotations

import re
import subprocess
from argparse import Namespace
from pathlib import Path

import pytest

from resources.build import build_all

ROOT = Path(__file__).parents[3]
ROWS = re.findall(
    r"^\| `(\w+)` \| (.+?) \| .+ \|$", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), re.MULTILINE
)


def test_the_table_names_what_each_step_makes() -> None:
    assert [(name, tuple(re.findall("`([^`]+)`", files))) for name, files in ROWS] == [
        (step.name, step.files) for step in build_all.STEPS
    ]
    for step in build_all.STEPS:
        for pattern in step.files:
            assert list(ROOT.glob(pattern)), pattern


def test_every_script_of_the_folder_is_a_step() -> None:
    arguments = Namespace(
        assets=Path("assets"), captures=Path("captures"), characters_python=Path("python"), soundfont=Path("sound.sf2")
    )
    commands = " ".join(" ".join(command) for step in build_all.STEPS for command in step.commands(arguments))
    for script in ROOT.glob("resources/build/*_*.py"):
        is_made = script.name.startswith(("build_", "arrange_", "compose_")) and script.stem != "build_all"
        assert (script.stem in commands) == is_made, script.name


def test_what_is_missing_is_said_and_a_failure_ends_it(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    ran: list[list[str]] = []

    def run(command: tuple[str, ...], **_: object) -> subprocess.CompletedProcess[str]:
        ran.append(list(command))
        return subprocess.CompletedProcess(command, 1 if "resources.build.build_licences" in command else 0)

    monkeypatch.setattr(subprocess, "run", run)
    assert build_all.main(["soundfont", "characters", "examples"]) == 0
    assert [command[-1] for command in ran] == [
        "resources.build.arrange_example",
        "resources.build.compose_dance_example",
    ]
    said = capfd.readouterr().out
    assert "left out: soundfont" in said
    assert "left out: characters" in said
    assert build_all.main(["pictures", "licences", "examples", "--characters-python", "x"]) == 1
    assert [command[-1] for command in ran[4:]] == ["resources.build.build_licences"]
    with pytest.raises(SystemExit):
        build_all.main(["nonsense"])
