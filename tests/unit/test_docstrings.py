"""A docstring opens with a verb or a plain noun, so that its first words name the subject."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDERS = ("app", "widgets", "instrument_maps", "metadata")
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
    files = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py")]
    assert len(files) > 900
    assert {str(path): found for path in files if (found := clauses(path.read_text("utf-8")))} == {}
