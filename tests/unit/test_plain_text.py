"""The program never displays HTML, and never lets Qt guess whether a text is HTML."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

INSTEAD = {
    **{f"Q{name}": f"widgets.common.plain.{name}" for name in ("Label", "MessageBox", "ComboBox")},
    **dict.fromkeys(("QTextEdit", "QTextBrowser", "QTextDocument"), "QPlainTextEdit"),
    "QErrorMessage": "Session.notice",
    "QProgressDialog": "Session.tasks",
    **dict.fromkeys(("QWhatsThis", "setWhatsThis", "WhatsThisRole"), "a tool tip"),
    **dict.fromkeys(("QGraphicsTextItem", "TextItem", "LabelItem", "QSplashScreen"), "QPainter.drawText"),
    "QStaticText": "QPainter.drawText, or set its format",
    **dict.fromkeys(("setHtml", "insertHtml", "appendHtml", "setMarkdown", "insertMarkdown"), "setPlainText"),
    **dict.fromkeys(("setTextFormat", "RichText", "AutoText", "MarkdownText"), "widgets.common.plain.Label"),
    **dict.fromkeys(("linkActivated", "anchorClicked", "setOpenExternalLinks", "setOpenLinks"), "a button"),
    **dict.fromkeys(("QtWebEngineWidgets", "QtWebEngineCore", "QtQuick", "QtQml"), "widgets"),
}
"""Classes that may display HTML, with the classes to use instead."""
MENTIONED = re.compile("|".join(map(re.escape, INSTEAD)))
"""Names that occur in the modules that are parsed; most modules contain none."""
ALLOWED = {
    "widgets/common/plain.py": {"QLabel", "QMessageBox", "QComboBox", "setTextFormat"},
    # The program's own guides, as Markdown without HTML; of files only pictures beside them are read, and of links only
    # those to guides and, by the browser, to the web are followed.
    "app/shell/help/guides.py": {"QTextDocument", "setMarkdown"},
    "app/shell/help/page.py": {
        "QTextBrowser",
        "QTextDocument",
        "QTextEdit",
        "setMarkdown",
        "setOpenLinks",
        "anchorClicked",
    },
    # Its format is set to plain.
    "widgets/timeline/roll/fingerings_on_notes.py": {"QStaticText", "setTextFormat"},
}


def names(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Every name used in a module with its line: classes, methods, enumerators and imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            yield node.lineno, node.id
        elif isinstance(node, ast.Attribute):
            yield node.lineno, node.attr
        elif isinstance(node, ast.ImportFrom | ast.Import):
            module = node.module or "" if isinstance(node, ast.ImportFrom) else ""
            for alias in node.names:
                yield from ((node.lineno, part) for part in (*module.split("."), *alias.name.split(".")))


def faults(source: str, allowed: set[str]) -> list[str]:
    """Uses of names that a module must not use, each with the name to use instead."""
    if not MENTIONED.search(source):
        return []
    found = {(line, name) for line, name in names(ast.parse(source)) if name in INSTEAD and name not in allowed}
    return [f"{line}: {name}: take {INSTEAD[name]}" for line, name in sorted(found)]


def test_nothing_shows_html() -> None:
    modules = [path for folder in ("app", "widgets") for path in sorted((ROOT / folder).rglob("*.py"))]
    assert len(modules) > 100
    found = []
    for path in modules:
        place = path.relative_to(ROOT).as_posix()
        found += [f"{place}:{fault}" for fault in faults(path.read_text("utf-8"), ALLOWED.get(place, set()))]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    "source",
    [
        "from PySide6.QtWidgets import QLabel",
        "from PySide6.QtWidgets import QLabel as Text",
        "from PySide6 import QtWidgets\nQtWidgets.QTextBrowser()",
        "label.setTextFormat(format)",
        "import PySide6.QtWebEngineWidgets",
        "format = Qt.TextFormat.RichText",
    ],
)
def test_the_judge_sees_what_shows_html(source: str) -> None:
    assert faults(source, set())
