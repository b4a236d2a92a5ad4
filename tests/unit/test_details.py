"""Errors in tables of acting also have Japanese texts."""

from __future__ import annotations

import ast
import errno
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.errors import FileError, MapError, Message
from app.export.unreal.project import find_project
from app.messages import text
from app.messages.details import detail_text
from app.project.storage import load
from app.score.chunks import read_container
from metadata.library import READERS

GESTURE = 'title = { en = "x" }\nlength_s = 2.0\n'
TRACK = '[[tracks]]\ntarget = "head"\nturn = "up"\n'
TRACK += "keys = [{ at = 0, deg = 0 }, { at = 0.5, deg = 5 }, { at = 1, deg = 0 }]\n"
RULE = 'description = ""\n[[rules]]\nname = "a"\n'
FACE = 'description = ""\nwhile_playing = true\nfade_in_s = 0.2\n'
WRONG = {
    "styles": ('title = { en = "x" }\n[factors]\nsway = 14', 'title = { en = "x" }\n[factors]\nswy = 1'),
    "habits": ('title = { en = "x" }\n[factors]\n', "title = 3"),
    "expressions": (FACE, f"{FACE}fade_out_s = -1\n[weights]", f"{FACE}fade_out_s = 0.2\n[weights]\nbrow = 0.5"),
    "gestures": (
        GESTURE + TRACK.replace("head", "tail"),
        GESTURE + TRACK.replace("at = 1, deg = 0", "at = 1, deg = 2"),
        GESTURE + TRACK.replace("head", "left_elbow").replace('"up"', '"left"'),
        GESTURE + TRACK + TRACK.replace('"up"', '"roll"').replace("at = 1,", "at = 0.9,"),
        GESTURE,
    ),
    "rules": (
        f'{RULE}when = {{ loudness_abov = 0.5 }}\ndo = {{ expression = "smile" }}',
        f'{RULE}when = {{ }}\ndo = {{ expression = "smile" }}',
        f"{RULE}when = {{ longer_s = 1.0 }}\ndo = {{ }}",
        f'{RULE}when = {{ accent = 0.1 }}\ndo = {{ gesture = "shrug", grows_with = "height" }}',
    ),
}


def is_japanese(words: str) -> bool:
    return any("぀" <= letter <= "鿿" for letter in words)


@pytest.mark.parametrize(("kind", "wrong"), [(kind, wrong) for kind, some in WRONG.items() for wrong in some])
def test_what_is_wrong_is_said_in_japanese(tmp_path: Path, kind: str, wrong: str) -> None:
    (tmp_path / kind).mkdir()
    file = tmp_path / kind / "mine.toml"
    file.write_text(f'name = "mine"\n{wrong}', encoding="utf-8")
    with pytest.raises(MapError) as raised:
        READERS[kind](file)
    english, japanese = (text(raised.value.message, language) for language in ("en", "ja"))
    place = f"{kind}/mine.toml: {raised.value.message.arguments['place']}: "
    assert english.startswith(place)
    assert japanese.startswith(place)
    assert is_japanese(japanese), japanese


ROOT = Path(__file__).parents[2]
NAMES = frozenset({"detail", "wrong"})
"""Keywords and variables that contain details."""
FOR_MAKERS = frozenset(
    {
        "instrument_maps/check_model.py",
        "instrument_maps/value_checks.py",
        *(f"instrument_maps/validate{part}.py" for part in ("", "_fingerings", "_hold")),
    }
)
"""Modules whose errors about users' instrument maps are in English, for authors of maps."""
MADE_OF_OTHERS = frozenset({"7: 7", "7 (7)"})
"""Details that consist of an exception's name, or of a detail and its place."""
FOLDERS = ("app", "instrument_maps", "metadata")


def worded(node: ast.expr) -> Iterator[str]:
    """Possible texts of an expression, with every field filled with a number."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.JoinedStr):
        yield "".join(str(part.value) if isinstance(part, ast.Constant) else "7" for part in node.values)
    elif isinstance(node, ast.IfExp):
        yield from worded(node.body)
        yield from worded(node.orelse)


def details(tree: ast.AST) -> Iterator[str]:
    """The details that a module gives to messages: as a keyword, a variable, an argument of its own functions for
    errors, what a check yields beside a place, and reasons of parsers that become details."""
    for node in ast.walk(tree):
        if isinstance(node, ast.keyword):
            yield from worded(node.value) if node.arg == "detail" else ()
        elif isinstance(node, ast.Assign):
            yield from worded(node.value) if NAMES & {getattr(target, "id", "") for target in node.targets} else ()
        elif isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("invalid", "unplayable", "_refused"):
            for argument in node.args[1:]:
                yield from worded(argument)
        elif isinstance(node, ast.Yield) and isinstance(node.value, ast.Tuple) and len(node.value.elts) == 2:
            yield from worded(node.value.elts[1])


def modules() -> Iterator[Path]:
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.py")):
            if "messages" not in path.parts and str(path.relative_to(ROOT)) not in FOR_MAKERS:
                yield path


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EACCES, errno.ENOENT, errno.EROFS])
def test_reasons_of_the_system_are_worded_in_japanese(number: int) -> None:
    message = Message("file.cannot_write", {"file": "a.mid", "reason": os.strerror(number)})
    reason, _, remedy = text(message).partition("; ")
    assert reason == f"a.mid cannot be written: {os.strerror(number)}"
    assert remedy.startswith("choose another place")
    assert is_japanese(text(message, "ja").partition(": ")[2])


@pytest.mark.parametrize("content", [b"", b"{", b"[" * 100_000, b"\xff\xfe", b'{"schema_version": "x"}', b"3"])
def test_a_damaged_project_is_worded_in_japanese(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "work.suisou"
    file.write_bytes(content)
    with pytest.raises(FileError) as raised:
        load(file)
    message = raised.value.message
    assert "detail" not in message.arguments or is_japanese(detail_text(str(message.arguments["detail"]), "ja"))


@pytest.mark.parametrize(
    ("content", "detail"),
    [
        (b"", "it ends too early"),
        (b'{"schema_version":', "it ends too early"),
        (b"\0\0\0 ftyp", "its text cannot be understood from byte 0 on"),
        (b'{"schema_version": ?}', "its text cannot be understood from byte 19 on"),
    ],
)
def test_a_damaged_project_is_refused_in_plain_words_and_place(tmp_path: Path, content: bytes, detail: str) -> None:
    file = tmp_path / "work.suisou"
    file.write_bytes(content)
    with pytest.raises(FileError) as raised:
        load(file)
    assert raised.value.message.arguments["detail"] == detail


def test_a_foreign_file_is_no_unreal_project_in_plain_words(tmp_path: Path) -> None:
    file = tmp_path / "Bad.uproject"
    for content, detail in (
        (b"\0\0 x", "its text cannot be understood from line 1, column 1 on"),
        (b'{"FileVersion": 3,\n "Modules": x}', "its text cannot be understood from line 2, column 13 on"),
        (b"\xff\xfe\x00", "it is not text"),
    ):
        file.write_bytes(content)
        with pytest.raises(FileError) as raised:
            find_project(file)
        assert raised.value.message.arguments["detail"] == detail
        assert is_japanese(detail_text(detail, "ja"))


def test_a_file_that_is_no_midi_file_is_refused_without_its_bytes(tmp_path: Path) -> None:
    file = tmp_path / "film.mid"
    file.write_bytes(b"\0\0\0 ftypmp42")
    with pytest.raises(FileError) as raised:
        read_container(file)
    for language in ("en", "ja"):
        said = text(raised.value.message, language)
        assert "MThd" in said
        assert "x00" not in said


def test_every_detail_of_ours_is_worded_in_japanese() -> None:
    missing = {
        f"{path.relative_to(ROOT)}: {detail}"
        for path in modules()
        for detail in details(ast.parse(path.read_text(encoding="utf-8")))
        if " " in detail and detail not in MADE_OF_OTHERS and not is_japanese(detail_text(detail, "ja"))
    }
    assert missing == set()
