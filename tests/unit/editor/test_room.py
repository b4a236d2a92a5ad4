"""The room of the editor's state runs without a window: of Qt it has signals, timers and watchers."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import app.editor

MODULES = sorted(Path(app.editor.__path__[0]).rglob("*.py"))


def qt(path: Path) -> set[str]:
    """What a module imports of Qt when it runs: not what only its types name."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    only_types = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
        for inner in ast.walk(node)
    }
    imported = set()
    for node in ast.walk(tree):
        if id(node) not in only_types:
            if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module is not None:
                imported |= {node.module, *(f"{node.module}.{name.name}" for name in node.names)}
            elif isinstance(node, ast.Import):
                imported |= {name.name for name in node.names}
    return {".".join(name.split(".")[:2]) for name in imported if name.startswith("PySide6.")}


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.stem)
def test_of_qt_only_the_core_is_imported(path: Path) -> None:
    assert qt(path) <= {"PySide6.QtCore"}


def test_imports_of_qt_are_found_at_all() -> None:
    assert any(qt(path) for path in MODULES)
