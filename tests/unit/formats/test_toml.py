"""TOML files are read as written; other content raises the program's errors within limited time."""

from __future__ import annotations

import contextlib
import time
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import FileError, MapError
from app.formats.toml import DEEPEST, MOST_BYTES, parse_toml, read_toml, shaped, toml
from app.messages import error_text

TEXTS = st.text(st.characters(exclude_categories=["Cs"]))
PLAIN = TEXTS | st.integers(-(2**63), 2**63 - 1) | st.booleans() | st.floats(allow_nan=False, allow_infinity=False)


def tables(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.dictionaries(TEXTS, inner, max_size=4)


@given(tables(st.recursive(PLAIN | st.lists(PLAIN, max_size=3), tables, max_leaves=8)))
def test_there_and_back(table: dict[str, Any]) -> None:
    assert parse_toml(toml(table), "x.toml") == table


REFUSED = {
    "digits": ("a = " + "1" * 5000, 1),
    "digits in a list": ("a = 1\nb = [1,\n" + "9" * 5000 + "]", 3),
    "lists": ("\n\na = " + "[" * 100_000, 3),
    "inline tables": ("a = " + "{a=" * 60_000, 1),
    "closed lists": ("a = " + "[" * 5_000 + "]" * 5_000, 1),
    "a name of many parts": ("\n" + ".".join("a" * 100_000) + " = 1", 2),
    "a header of many parts": ("[" + '"a".' * 60_000 + "a]", 1),
    "spaces between the parts": ("a . " * 60_000, 1),
    "no end": ('a = "' + "b" * 1000, 1),
    "a NUL": ("a = 1\nb = \0", 2),
}


def test_what_settings_of_another_version_may_hold_is_written_again() -> None:
    text = 'a = 07:32:00\nb = 1979-05-27\nc = 1979-05-27T07:32:00Z\nd = [{e = 1, "x y" = [1979-05-27T07:32:00]}, {}]\n'
    table = parse_toml(text, "x.toml")
    assert parse_toml(toml(table), "x.toml") == table


@pytest.mark.parametrize("name", REFUSED)
def test_syntax_that_no_one_writes_is_refused_with_its_line(name: str) -> None:
    text, line = REFUSED[name]
    begun_s = time.process_time()
    with pytest.raises(MapError) as caught:
        parse_toml(text, "mine.toml")
    assert time.process_time() - begun_s < 2.0
    assert caught.value.message.id == "table.syntax"
    assert caught.value.message.arguments["line"] == line
    assert "mine.toml" in error_text(caught.value)
    assert len(error_text(caught.value)) < 500


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("a = inf", "a"),
        ("[b]\nc = [1.0, -inf]", "b.c[1]"),
        ("a = nan", "a"),
        ("a = 1e999", "a"),
        ("[b.c]\nd = 9223372036854775808", "b.c.d"),
        ("a = -9223372036854775809", "a"),
        ("a = 0x" + "f" * 100_000, "a"),
        ("a = " + "[" * 30 + "]" * 30, "a" + "[0]" * DEEPEST),
        ("[" + ".".join("a" * DEEPEST) + "]\nb.c = {d = 1}", ".".join("a" * DEEPEST) + ".b"),
        (f'"{"x" * 1000}" = nan', "x" * 199 + "…"),
    ],
)
def test_values_that_no_table_of_ours_has_are_refused_with_their_place(text: str, place: str) -> None:
    with pytest.raises(MapError) as caught:
        parse_toml(text, "mine.toml")
    assert caught.value.message.id == "table.invalid"
    assert caught.value.message.arguments["place"] == place
    assert len(error_text(caught.value)) < 500


def test_files(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xef\xbb\xbfa = 1\r\n")
    assert read_toml(path) == {"a": 1}
    path.write_bytes(b"a = '\xe9'")
    with pytest.raises(MapError) as caught:
        read_toml(path, "mine")
    assert caught.value.message.id == "table.not_utf8"
    assert caught.value.message.arguments == {"file": "mine", "byte": 5}
    path.write_bytes(b"#" * (MOST_BYTES + 1))
    with pytest.raises(FileError, match=r"file\.too_large"):
        read_toml(path)


def test_shapes() -> None:
    assert shaped({"a": {"b": [1]}}, dict[str, dict[str, tuple[int, ...]]], "f") == {"a": {"b": (1,)}}
    with pytest.raises(MapError) as caught:
        shaped({"a": {"b": ["x" * 1000]}}, dict[str, dict[str, tuple[int, ...]]], "f")
    assert caught.value.message.arguments["place"] == "[...][...][0]"
    with pytest.raises(MapError) as caught:
        shaped(3, dict[str, int], "f")
    assert caught.value.message.arguments["place"] == "(top level)"


@given(st.text(st.sampled_from("ab.=[]{}\"'#\n\t ,1_-eE+x:TZinfa\\\r\0é\U0001f3ba"), max_size=60))
def test_nothing_but_our_own_errors(text: str) -> None:
    with contextlib.suppress(MapError):
        parse_toml(text, "f")
