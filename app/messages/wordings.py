"""The tables of texts: every id with its English and its Japanese, in TOML files beside what shows them."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Final, TypeAlias

Wording: TypeAlias = tuple[str, str]
"""A text in each of `LANGUAGES`."""

LANGUAGES: Final = {"en": "English", "ja": "日本語"}
"""By code: the name in the language itself; the wordings are in this order."""


def read_tables(folder: Path, name: str) -> dict[str, Wording]:
    """Read the wordings of a folder and of the folders in it, by id: all ``name.toml`` and ``name/*.toml``."""
    return {
        id: (wording["en"], wording["ja"])
        for depth in ("", "*/")
        for pattern in (f"{depth}{name}.toml", f"{depth}{name}/*.toml")
        for path in sorted(folder.glob(pattern))
        for id, wording in tomllib.loads(path.read_text(encoding="utf-8")).items()
    }


WORDINGS: Final = read_tables(Path(__file__).parents[1], "messages")
"""Every message of the program by id: its templates, filled with the message's arguments."""

CORRECTION: Final = "correction_kind."
"""Before the tag of a correction (`app.plan.by_hand.corrections.kind`), the id of its kind in words."""
CORRECTIONS: Final = tuple(id.removeprefix(CORRECTION) for id in WORDINGS if id.startswith(CORRECTION))
"""The tags that have words."""


def wording(id: str, language: str) -> str:
    """The template of a message in one of `LANGUAGES`."""
    return WORDINGS[id][list(LANGUAGES).index(language)]
