"""A docstring opens with a verb or a plain noun, so that its first words name the subject, and words no message."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from app.messages import WORDINGS

ROOT = Path(__file__).parents[2]
FOLDERS = ("app", "widgets", "instrument_maps", "metadata", "resources", "packaging", "tests")
FILES = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py")]
ID = re.compile(r"[a-z_]+(?:\.[a-z_]+)+")
TEMPLATE = re.compile(r'"[^"`]*\{[a-z_]+(?:[:!][^"}]*)?\}[^"`]*"')
CLAUSE = re.compile(
    r'^\s*r?"""\s*(?:What|Where|How|Whether|Who|Which|When|Why|Whose|Of|With|Without|As|So)\b.*', re.MULTILINE
)


def clauses(text: str) -> list[str]:
    """Return the first lines of docstrings that open with a clause; a string elsewhere does not begin its line."""
    return [match.group().strip() for match in CLAUSE.finditer(text)]


def test_finds_docstrings_that_open_with_a_clause() -> None:
    text = (
        '"""Where it lies."""\nKEY = """Where"""\n\ndef size() -> int:\n    r"""\n    Of all, the largest.\n    """\n'
    )
    assert clauses(text) == ['"""Where it lies."""', 'r"""\n    Of all, the largest.']
    assert clauses('"""Wherever it lies."""\n"""Sort by size."""\n"""Offset in seconds."""\n') == []


def test_no_docstring_opens_with_a_clause() -> None:
    assert len(FILES) > 900
    assert {str(path): found for path in FILES if (found := clauses(path.read_text("utf-8")))} == {}


def docstrings(tree: ast.AST) -> Iterator[str]:
    """Yield the texts that stand alone, those behind attributes among them."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            yield node.value.value


def templates(tree: ast.Module) -> list[str]:
    """Return the templates of messages in docstrings, and the ids of messages that a module's own docstring lists."""
    ids = [id for id in ID.findall(ast.get_docstring(tree) or "") if id in WORDINGS]
    return [*ids, *(found for text in docstrings(tree) for found in TEMPLATE.findall(text))]


def test_finds_messages_in_docstrings() -> None:
    text = '"""Read: ``file.too_large``."""\ndef read():\n    """Read.\n\n    "{file}: too\n    large"\n    """\n'
    assert templates(ast.parse(text)) == ["file.too_large", '"{file}: too\n    large"']
    assert templates(ast.parse('"""Write ``{"name": 1}`` of `app.score`."""\n')) == []


def test_no_docstring_words_a_message() -> None:
    """The tables of texts word messages, and the code names their ids: a copy is soon untrue."""
    trees = {path: ast.parse(path.read_text("utf-8")) for path in FILES}
    assert {str(path): found for path, tree in trees.items() if (found := templates(tree))} == {}
