"""Translation of texts, by their ids, into the editor's language."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QLocale

from app.messages import LANGUAGES


def tr(text_id: str) -> str:
    """Return the text with an id in the editor's language; the id itself if it is unknown.

    Qt objects have the same function as the method ``tr``.
    """
    return QCoreApplication.translate("", text_id)


def system_language() -> str:
    """Return the first language of the system's list of languages that the editor supports; English if it supports
    none.
    """
    for name in QLocale.system().uiLanguages():
        code = name.split("-")[0].split("_")[0]
        if code in LANGUAGES:
            return code
    return "en"


def speaks_as_system() -> bool:
    """Return whether the editor's language is the system's, so that system dialogs can be used."""
    return QLocale().name().split("_")[0] == system_language()
