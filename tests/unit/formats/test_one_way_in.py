"""External files are read only through `app.formats.files`, which handles pipes, sizes and unusual errors."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[3]
FOLDERS = ("app", "widgets", "instrument_maps", "metadata")

THE_READERS = {"app/formats/files.py", "app/formats/toml.py"}
OUR_OWN = {
    # Bundled with the program.
    "app/audio/rendering.py": {"read_bytes"},
    "app/export/unreal/plugin.py": {"read_bytes"},
    "app/formats/table_cache.py": {"read_bytes"},
    "app/rig/people/bundled_people.py": {"read_bytes"},
    "app/evaluation/page.py": {"read_text", "read_bytes"},  # and clips that were drawn a moment ago
    "app/messages/details/__init__.py": {"read_text", "tomllib"},
    "app/messages/wordings.py": {"read_text", "tomllib"},
    "app/cli/commands.py": {"read_text", "tomllib"},
    "app/shell/help/guides.py": {"read_text"},
    "app/shell/help/places.py": {"read_text", "tomllib"},
    "app/shell/theme.py": {"read_text"},
    "widgets/common/icons.py": {"read_text"},
    "widgets/viewport/renderer.py": {"read_text"},
    # A file that this process has made: a lock, or what it copies to its backup.
    "app/formats/locks.py": {"open"},
    "app/formats/atomic.py": {"open"},
    "app/formats/usd.py": {"open"},
    # Files about this process provided by the system, and files written by us a moment ago.
    "app/export/unreal/check.py": {"open", "read_bytes"},
}
READING = {"read_bytes", "read_text", "fromfile", "QSettings", "tomllib"}
MENTIONED = re.compile("|".join((*READING, r"\bopen\s*\(")))
"""Names that occur in the modules that are parsed; most modules contain none."""


def readings(path: Path) -> Iterator[tuple[str, int]]:
    """Yield the functions with which a module reads files directly, each with its line."""
    source = path.read_text(encoding="utf-8")
    if not MENTIONED.search(source):
        return
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Attribute | ast.Name):
            name = node.attr if isinstance(node, ast.Attribute) else node.id
            if name in READING:
                yield name, node.lineno
        if isinstance(node, ast.Call):
            function = getattr(node.func, "attr", getattr(node.func, "id", None))
            texts = [one.value for one in node.args if isinstance(one, ast.Constant) and isinstance(one.value, str)]
            if function == "open" and any(text.startswith("r") and len(text) < 4 for text in texts):
                yield "open", node.lineno


def test_every_file_of_others_is_read_in_one_way() -> None:
    found: dict[str, set[str]] = {}
    places = []
    for path in sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py")):
        module = path.relative_to(ROOT).as_posix()
        for name, line in readings(path):
            found.setdefault(module, set()).add(name)
            if module not in THE_READERS and name not in OUR_OWN.get(module, set()):
                places.append(f"{module}:{line}: {name}")
    assert places == []
    assert set(OUR_OWN) <= set(found), "an exception that is no longer needed"
    assert found["app/formats/toml.py"] == {"tomllib"}
