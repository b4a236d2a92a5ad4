"""Names of public classes are unique, so that searching for one finds one class."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDERS = ("app", "widgets", "instrument_maps", "metadata")


def public_classes() -> dict[str, set[Path]]:
    """Return the files that define each public class, by its name; only files that share names are parsed."""
    likely: dict[str, set[Path]] = defaultdict(set)
    for folder in FOLDERS:
        for path in (ROOT / folder).rglob("*.py"):
            for name in re.findall(r"^\s*class ([A-Z]\w*)", path.read_text("utf-8"), re.MULTILINE):
                likely[name].add(path)
    shared = {path for paths in likely.values() if len(paths) > 1 for path in paths}
    defined = {path: {node.name for node in classes(path)} for path in shared}
    return {name: {path for path in paths if name in defined.get(path, {name})} for name, paths in likely.items()}


def classes(path: Path) -> list[ast.ClassDef]:
    return [node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.ClassDef)]


def test_public_class_names_are_unique() -> None:
    found = public_classes()
    assert {"Document", "Score", "Motion", "InstrumentMap"} <= found.keys()
    assert {name: sorted(map(str, paths)) for name, paths in found.items() if len(paths) > 1} == {}
