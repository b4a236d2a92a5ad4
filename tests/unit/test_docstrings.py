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

PROGRAM = ("app", "widgets", "instrument_maps", "metadata", "packaging")
QUESTION = re.compile(r"(?:Return|Yield) (?:what|where|how|who|which|when|why|whose)\b", re.IGNORECASE)
WITH_IDS = {"body_shapes.py", "person.py"}
"""Files in which docstrings still list ids of messages."""


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


def listed_ids(tree: ast.AST) -> list[str]:
    """Return the ids of messages in docstrings: a Raises section says what is wrong instead."""
    return [id for text in docstrings(tree) for id in ID.findall(text) if id in WORDINGS]


def test_finds_questions_and_ids_in_docstrings() -> None:
    tree = ast.parse('def read():\n    """Return where it is.\n\n    Raises FileError ``file.too_large``.\n    """\n')
    assert listed_ids(tree) == ["file.too_large"]
    assert [text for text in docstrings(tree) if QUESTION.match(text)]
    assert not QUESTION.match("Return the place, which is known.")


def test_docstrings_name_the_result_and_the_fault() -> None:
    """A result is named ("Return the path of ...") instead of asked for, and a fault is described without its id."""
    paths = [path for path in FILES if path.relative_to(ROOT).parts[0] in PROGRAM]
    assert len(paths) > 900
    found = {}
    for path in paths:
        tree = ast.parse(path.read_text("utf-8"))
        ids = [] if path.name in WITH_IDS and path.parent.name == "people" else listed_ids(tree)
        if wrong := [*(text for text in docstrings(tree) if QUESTION.match(text)), *ids]:
            found[str(path)] = wrong
    assert found == {}


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
