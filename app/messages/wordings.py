"""The tables of texts: the English and Japanese of every id, in TOML files beside the code that uses them."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Final, TypeAlias

Wording: TypeAlias = tuple[str, str]
"""A text in each of `LANGUAGES`, in order."""

LANGUAGES: Final = {"en": "English", "ja": "日本語"}
"""Name of each language in the language itself, by code; wordings have this order."""


def read_tables(folder: Path, name: str) -> dict[str, Wording]:
    """Read the texts of a folder and its subfolders by id: all ``name.toml`` and ``name/*.toml``."""
    return {
        id: (wording["en"], wording["ja"])
        for depth in ("", "*/")
        for pattern in (f"{depth}{name}.toml", f"{depth}{name}/*.toml")
        for path in sorted(folder.glob(pattern))
        for id, wording in tomllib.loads(path.read_text(encoding="utf-8")).items()
    }


WORDINGS: Final = read_tables(Path(__file__).parents[1], "messages")
"""Templates of all messages of the program by id."""

CORRECTION: Final = "correction_kind."
"""Prefix of the ids that name kinds of corrections; followed by the tag of the correction
(`app.plan.by_hand.corrections.kind`).
"""
CORRECTIONS: Final = tuple(id.removeprefix(CORRECTION) for id in WORDINGS if id.startswith(CORRECTION))
"""Tags of corrections whose kind has a name."""


def wording(id: str, language: str) -> str:
    """Return the template of a message id in one of `LANGUAGES`."""
    return WORDINGS[id][list(LANGUAGES).index(language)]
