"""Texts of dialogs: id -> English and Japanese, a module for each group of dialogs."""

from __future__ import annotations

from typing import Final

from widgets.dialogs.texts import characters, devices, exporting, importing, rules, settings

TEXTS: Final[dict[str, tuple[str, str]]] = {
    id: wordings
    for module in (characters, devices, exporting, importing, rules, settings)
    for id, wordings in module.TEXTS.items()
}
