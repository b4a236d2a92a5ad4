"""Commands in README and guides can be run, and their labels exist in the window."""

from __future__ import annotations

import argparse
import re
import shlex
import shutil
from pathlib import Path

import pytest

from app.cli import EXAMPLES, _joined, main, parser
from app.cli.options import open_project
from app.cli.status import DONE
from app.project.parameters import select_players
from app.project.piece_metadata import metadata_of, save_metadata
from app.project.storage import save

ROOT = Path(__file__).parents[3]
GUIDES = (ROOT / "README.md", ROOT / "README_ja.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md")))
TEXTS_OF_GUIDES = [guide.read_text(encoding="utf-8") for guide in GUIDES]


def commands(pattern: str) -> list[tuple[str, ...]]:
    """Commands in the guides' texts as words, without redirection of the output."""
    found = {command for text in TEXTS_OF_GUIDES for command in re.findall(pattern, text, re.MULTILINE)}
    split = [shlex.split(command, comments=True) for command in sorted(found)]
    return sorted({tuple(words[: words.index(">")] if ">" in words else words) for words in split if len(words) > 1})


LINES = commands(r"^    ((?:\./run|suisou) .+)$")
MENTIONED = commands(r"`(?:suisou|\./run) ([a-z][^`\n]*)`")
FROM_CHECKOUT = [words[1:] for words in LINES if words[0] == "./run"]
RUN = (
    *("inspect", "instruments", "metadata", "midi", "characters make"),
    *("choreography generate", "evaluate measures", "export quartet.musicxml"),
)
"""Beginnings of commands that take at most a few seconds."""
NOT_RUN = {
    "align": "needs a recording, and following one takes long",
    "characters add": "needs a character's file, and the program bundles none but its own",
    "characters check": "needs a character's file, and the program bundles none but its own",
    "choreography learn": "needs motion capture; tested in tests/unit/cli/choreography",
    "edit": "opens a window",
    "evaluate": "takes long; tested in tests/unit/cli/evaluation",
    "export": "takes seconds for each, of which one is run",
    "film": "needs OpenGL",
    "ports": "needs the system's MIDI",
    "record": "needs a MIDI device",
    "stream": "plays in real time",
}
"""Commands that are only parsed in this test, with the reason."""


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


def begins(words: tuple[str, ...], name: str) -> bool:
    """Return whether a command line begins with a command of one or two words."""
    return words[: len(name.split())] == tuple(name.split())


@pytest.mark.parametrize("words", sorted({words[1:] for words in LINES}), ids=" ".join)
def test_commands_of_guides_run_where_they_are_quick(
    words: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Run a command in a folder with the files that guides name; `NOT_RUN` has the reason for every other one."""
    if not any(begins(words, name) for name in RUN):
        assert any(begins(words, name) for name in NOT_RUN)
        return
    lay_out_files(tmp_path)
    monkeypatch.chdir(ROOT if any(word.startswith("resources/") for word in words) else tmp_path)
    assert main([*words]) == DONE
    assert capsys.readouterr().out or "--diff" in words


def lay_out_files(folder: Path) -> None:
    """Put files with the names used in guides into a folder: the bundled quartet, projects of it, and tables."""
    for suffix in (".mid", ".musicxml"):
        shutil.copy(ROOT / f"resources/examples/quartet{suffix}", folder)
    arguments = parser().parse_args(["inspect", str(folder / "quartet.mid")], argparse.Namespace(given=()))
    project = open_project(arguments)
    for name in ("piece", "SESSION"):
        save(project, folder / f"{name}.suisou")
    save_metadata(metadata_of(project), folder / "piece.toml")
    for name in ("song.mid", "PIECE.mid"):
        shutil.copy(folder / "quartet.mid", folder / name)
    shutil.copy(ROOT / "resources/choreographies/salsa.choreography", folder / "ours.choreography")
    (folder / "styles").mkdir()
    jazz = (ROOT / "metadata/styles/jazz.toml").read_text("utf-8")
    (folder / "styles/mine.toml").write_text(jazz.replace('"jazz"', '"mine"'), "utf-8")


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
