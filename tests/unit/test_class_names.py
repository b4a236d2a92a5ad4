"""A public class has a name of its own, so that a reader who searches for it finds one class."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDERS = ("app", "widgets", "instrument_maps", "metadata")


def public_classes() -> dict[str, list[str]]:
    """Return the files of every public class by its name. Only files with such a line are parsed."""
    files: dict[str, list[str]] = defaultdict(list)
    for path in (path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.py"))):
        text = path.read_text("utf-8")
        if re.search(r"^\s*class [A-Z]", text, re.MULTILINE):
            for node in ast.walk(ast.parse(text)):
                if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                    files[node.name].append(path.relative_to(ROOT).as_posix())
    return files


def test_public_class_names_are_unique() -> None:
    classes = public_classes()
    assert {"Document", "Score", "Motion", "InstrumentMap"} <= classes.keys()
    assert {name: files for name, files in classes.items() if len(files) > 1} == {}
