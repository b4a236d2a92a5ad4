"""Commands and labels of the README and the guides: what stands there can be typed, and is in the window."""

from __future__ import annotations

import argparse
import re
import shlex
from pathlib import Path

import pytest

from app.cli import EXAMPLES, _joined, main, parser
from app.cli.options import open_project
from app.cli.status import DONE
from app.project.parameters import select_players

ROOT = Path(__file__).parents[3]
GUIDES = (ROOT / "README.md", ROOT / "README_ja.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md")))
TEXTS_OF_GUIDES = [guide.read_text(encoding="utf-8") for guide in GUIDES]


def commands(pattern: str) -> list[tuple[str, ...]]:
    """Commands in the guides' texts, as words; what the shell does with the output is left out."""
    found = {command for text in TEXTS_OF_GUIDES for command in re.findall(pattern, text, re.MULTILINE)}
    split = [shlex.split(command, comments=True) for command in sorted(found)]
    return sorted({tuple(words[: words.index(">")] if ">" in words else words) for words in split if len(words) > 1})


LINES = commands(r"^    ((?:\./run|suisou) .+)$")
MENTIONED = commands(r"`(?:suisou|\./run) ([a-z][^`\n]*)`")
FROM_CHECKOUT = [words[1:] for words in LINES if words[0] == "./run"]
_QUICK = ("inspect", "instruments", "metadata")


def test_there_are_examples_of_both_kinds() -> None:
    assert len(FROM_CHECKOUT) >= 8
    assert len(LINES) - len(FROM_CHECKOUT) >= 8


@pytest.mark.parametrize("words", [words[1:] for words in LINES], ids=" ".join)
def test_every_example_is_understood(words: tuple[str, ...]) -> None:
    arguments = parser().parse_args(_joined([*words]), argparse.Namespace(given=()))
    assert arguments.command


OF_QUARTET = [words[1:] for words in map(shlex.split, EXAMPLES.splitlines()) if "quartet.mid" in words]


@pytest.mark.parametrize("words", [words for words in OF_QUARTET if {"--player", "--set"} & set(words)], ids=" ".join)
def test_examples_of_the_help_name_players_of_the_bundled_quartet(words: list[str]) -> None:
    arguments = parser().parse_args(_joined(words), argparse.Namespace(given=()))
    arguments.file = ROOT / "resources/examples/quartet.mid"
    project = open_project(arguments)
    if arguments.players:
        assert select_players(arguments.players, [player.name for player in project.players])


@pytest.mark.parametrize("words", MENTIONED, ids=" ".join)
def test_commands_in_sentences_have_these_options(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    named = [word for word in words if word.startswith("--")]
    with pytest.raises(SystemExit, match="0"):
        parser().parse_args([word for word in words[:2] if word.isalpha()] + ["--help"])
    shown = capsys.readouterr().out
    assert all(re.search(rf"{option}\b", shown) for option in named)


@pytest.mark.parametrize("words", FROM_CHECKOUT, ids=" ".join)
def test_examples_name_files_that_are_there(words: tuple[str, ...]) -> None:
    for word in words:
        assert word.startswith(("-", "out/")) or "/" not in word or (ROOT / word).exists()


@pytest.mark.parametrize("words", [words for words in FROM_CHECKOUT if words[0] in _QUICK], ids=" ".join)
def test_quick_examples_run(
    words: tuple[str, ...], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(ROOT)
    assert main([*words]) == DONE
    assert capsys.readouterr().out


@pytest.mark.parametrize("guide", GUIDES, ids=lambda path: path.name)
def test_pictures_of_guides_are_there_and_in_their_language(guide: Path) -> None:
    pictures = [
        guide.parent / name for name in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", guide.read_text(encoding="utf-8"))
    ]
    assert [picture for picture in pictures if not picture.is_file()] == []
    is_japanese = guide.stem.endswith("_ja")
    others = (picture.with_stem(f"{picture.stem}_ja") for picture in pictures)
    assert not is_japanese or [other.name for other in others if other.is_file()] == []
    assert is_japanese or [picture.name for picture in pictures if picture.stem.endswith("_ja")] == []
