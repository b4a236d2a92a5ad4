"""The README's commands: what stands there can be typed."""

from __future__ import annotations

import argparse
import re
import shlex
from pathlib import Path

import pytest

from app.cli import _joined, main, parser
from app.cli.status import DONE

ROOT = Path(__file__).parents[3]
LINES = [
    words
    for line in (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    if re.match(r"    (\./run|suisou) ", line) and len(words := shlex.split(line, comments=True)) > 1
]
FROM_CHECKOUT = [words[1:] for words in LINES if words[0] == "./run"]
_QUICK = ("inspect", "instruments", "metadata")


def test_there_are_examples_of_both_kinds() -> None:
    assert len(FROM_CHECKOUT) >= 8
    assert len(LINES) - len(FROM_CHECKOUT) >= 8


@pytest.mark.parametrize("words", [words[1:] for words in LINES], ids=" ".join)
def test_every_example_is_understood(words: list[str]) -> None:
    arguments = parser().parse_args(_joined(words), argparse.Namespace(given=()))
    assert arguments.command


@pytest.mark.parametrize("words", FROM_CHECKOUT, ids=" ".join)
def test_examples_name_files_that_are_there(words: list[str]) -> None:
    for word in words:
        assert word.startswith(("-", "out/")) or "/" not in word or (ROOT / word).exists()


@pytest.mark.parametrize("words", [words for words in FROM_CHECKOUT if words[0] in _QUICK], ids=" ".join)
def test_quick_examples_run(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(ROOT)
    assert main(words) == DONE
    assert capsys.readouterr().out
