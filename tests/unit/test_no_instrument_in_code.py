"""The code is independent of particular instruments, whose properties are in their maps."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from instrument_maps.load import bundled_maps
from metadata.load import load_body

ROOT = Path(__file__).parents[2]
FILES = sorted(path for room in ("app", "widgets") for path in (ROOT / room).rglob("*.py"))


def texts(tree: ast.Module) -> list[tuple[int, str]]:
    """Strings of a module with their lines, except for docstrings, which may mention instruments."""
    docstrings = {
        id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    return [
        (node.lineno, node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings
    ]


def names_one(text: str) -> bool:
    """Return whether a text has the id of an instrument as a word."""
    return not bundled_maps().keys().isdisjoint(re.findall(r"\w+", text))


def test_names_are_found_as_whole_words() -> None:
    assert names_one("Of a (clarinet_Bb).")
    assert not names_one("clarinet_Bbs, my_clarinet_Bb")


def test_no_text_of_the_code_has_the_id_of_an_instrument() -> None:
    found = {
        f"{path.relative_to(ROOT)}:{line}": text
        for path in FILES
        if names_one(source := path.read_text(encoding="utf-8"))
        for line, text in texts(ast.parse(source))
        if names_one(text)
    }
    assert len(FILES) > 500
    assert found == {}


def test_a_body_is_checked_with_an_instrument_that_is_there() -> None:
    assert load_body().checked_with in bundled_maps()
