"""The code checks for files only with functions that cannot raise."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
ROOTS = ("app", "widgets", "instrument_maps", "metadata")
RAISES = re.compile(r"\.(is_file|is_dir|is_symlink|exists)\(\)")


def test_nothing_asks_by_pathlib() -> None:
    """Before Python 3.14 its methods raise if a name is too long or a folder cannot be read; those of
    `os.path` do not.
    """
    found = [
        f"{path.relative_to(ROOT)}: {line.strip()}"
        for root in ROOTS
        for path in sorted((ROOT / root).rglob("*.py"))
        for line in path.read_text(encoding="utf-8").splitlines()
        if RAISES.search(line)
    ]
    assert found == []
