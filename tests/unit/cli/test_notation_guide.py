"""The commands of ``docs/from-your-notation-program.md`` work as described with the bundled score."""

from __future__ import annotations

import json
import re
import shlex
import shutil
from pathlib import Path

import pytest

from app.cli import main, parser
from app.cli.status import DONE

ROOT = Path(__file__).parents[3]
GUIDE = (ROOT / "docs/from-your-notation-program.md").read_text(encoding="utf-8")
COMMANDS = [shlex.split(line)[1:] for line in re.findall(r"^ +(suisou .*)$", GUIDE, re.MULTILINE)]


def test_all_commands_are_tried() -> None:
    assert [words[0] for words in COMMANDS] == ["inspect", "inspect", "export", "edit", "inspect"]
    assert parser().parse_args(COMMANDS[3]).file.name == "quartet.musicxml"


@pytest.mark.parametrize("words", [words for words in COMMANDS if words[0] != "edit"], ids=" ".join)
def test_commands_run(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copy(ROOT / "resources/examples/quartet.musicxml", tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(words) == DONE
    said = capsys.readouterr().out
    if "--json" in words:
        reasons = {breath["reason"] for player in json.loads(said)["players"] for breath in player["breaths"]}
        quoted = re.search(r'reason says so: "([^"]*)"', GUIDE)
        assert any(reason.startswith(quoted[1]) for reason in reasons)
    elif words[0] == "export":
        assert len(list((tmp_path / "out").glob("*.bvh"))) == 4
    elif "--assign" in words:
        assert said.count("cornet_Bb") == 2
