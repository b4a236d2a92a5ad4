"""Texts by their ids in the language of the editor."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QLocale

from app.messages import LANGUAGES


def tr(text_id: str) -> str:
    """The text of an id; the id itself where there is none. Objects of Qt have the same as their method ``tr``."""
    return QCoreApplication.translate("", text_id)


def system_language() -> str:
    """The first language of the system's list that the editor speaks; English where it speaks none."""
    for name in QLocale.system().uiLanguages():
        code = name.split("-")[0].split("_")[0]
        if code in LANGUAGES:
            return code
    return "en"


def speaks_as_system() -> bool:
    """Return whether the editor's language is that of the system, whose own dialogs can then be used."""
    return QLocale().name().split("_")[0] == system_language()
