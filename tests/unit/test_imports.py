"""No module imports itself through others, not even within a function or for types only."""

from __future__ import annotations

import ast
from graphlib import TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).parents[2]


def modules() -> dict[str, Path]:
    """Every module of the program by its dotted name."""
    found: dict[str, Path] = {}
    for folder in ("app", "widgets", "instrument_maps", "metadata", "resources"):
        for path in (ROOT / folder).rglob("*.py"):
            parts = path.relative_to(ROOT).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported(path: Path) -> set[str]:
    """Return the modules that a file imports, and the names taken from them, which may be modules too."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            taken = {f"{node.module}.{alias.name}" for alias in node.names}
            names |= {str(node.module), *taken}
    return names


def test_no_circle_of_imports() -> None:
    known = modules()
    graph: dict[str, set[str]] = {}
    for name, path in known.items():
        found = imported(path) & known.keys()
        # "from app.messages import plan" takes the module, not what the package's __init__ has.
        packages = {one for one in found if any(other.startswith(f"{one}.") for other in found)}
        graph[name] = found - packages - {name}
    TopologicalSorter(graph).prepare()
