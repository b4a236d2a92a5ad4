"""The display language: translations of the editor's and of Qt's texts, changeable at run time."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QLocale, QObject, QTranslator, Signal

from app.editor.translated import system_language
from app.messages import LANGUAGES, WORDINGS
from app.messages.wordings import Wording, read_tables
from app.plan.kinds import COMMAND_TEXTS, EVENT_TEXTS

_SHELL: Final = Path(__file__).parent
TEXTS: Final[Mapping[str, Wording]] = {
    **WORDINGS,
    **EVENT_TEXTS,
    **COMMAND_TEXTS,
    **read_tables(_SHELL, "texts"),
    **read_tables(_SHELL.parents[1] / "widgets", "texts"),
}
"""All texts of the editor by id."""


class Language(QObject):
    """The display language.

    Signals
    -------
    changed()
        The language has changed. Widgets receive ``QEvent.LanguageChange`` too.
    """

    changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._code = ""
        self.set("en")

    @property
    def code(self) -> str:
        """Return the code of the display language: ``"en"`` or ``"ja"``."""
        return self._code

    def set(self, code: str) -> None:
        """Set the display language by its code; an empty code sets the system's language."""
        code = code if code in LANGUAGES else system_language()
        if code == self._code:
            return
        for old in _INSTALLED:
            QCoreApplication.removeTranslator(old)
        _INSTALLED[:] = _translators(code)
        self._code = code
        QLocale.setDefault(QLocale(code))
        for new in _INSTALLED:
            QCoreApplication.installTranslator(new)
        self.changed.emit()


_INSTALLED: Final[list[QTranslator]] = []
"""Translators installed in the application by any `Language`."""


def _translators(code: str) -> list[QTranslator]:
    """Return translators for Qt's own texts and for those of the editor."""
    found: list[QTranslator] = []
    of_qt = QTranslator()
    if of_qt.load(f"qtbase_{code}", QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)):
        found.append(of_qt)
    return [*found, TextTranslator(code)]


_LACKING_IN_QT: Final[Mapping[str, Mapping[tuple[str, str], str]]] = {
    "ja": {
        ("QFileDialog", "&Look in:"): "場所(&I):",
        ("QFileDialog", "Files of &type:"): "ファイルの種類(&T):",
        ("QSidebar", "Remove"): "削除",
        ("QAbstractFileIconProvider", "Drive"): "ドライブ",
        ("QAbstractFileIconProvider", "File"): "ファイル",
        ("QAbstractFileIconProvider", "%1 File"): "%1 ファイル",
        ("QAbstractFileIconProvider", "File Folder"): "フォルダー",
        ("QAbstractFileIconProvider", "Folder"): "フォルダー",
        ("QAbstractFileIconProvider", "Alias"): "エイリアス",
        ("QAbstractFileIconProvider", "Shortcut"): "ショートカット",
        ("QAbstractFileIconProvider", "Unknown"): "不明",
        (
            "QFileSystemModel",
            '<b>The name "%1" cannot be used.</b>'
            "<p>Try using another name, with fewer characters or no punctuation marks.",
        ): "<b>「%1」という名前は使えません。</b><p>短い名前や、記号を含まない名前にしてください。",
    }
}
"""Translations of Qt's dialog texts, by context and English text, that are missing in Qt 6.11."""


class TextTranslator(QTranslator):
    """Translates the editor's texts by id, and Qt's texts whose translation is missing.

    Parameters
    ----------
    code : str
        Code of the language, one of `LANGUAGES`.
    """

    def __init__(self, code: str) -> None:
        super().__init__()
        place = list(LANGUAGES).index(code)
        self._texts = {id: wording[place] for id, wording in TEXTS.items()}
        self._of_qt = _LACKING_IN_QT.get(code, {})

    def isEmpty(self) -> bool:
        """Return False: an empty translator would be ignored by Qt."""
        return False

    def translate(self, context: str, source: str, disambiguation: str | None = None, count: int = -1) -> str | None:
        """Return the text with an id (``source``); None for texts of other translators, such as most of Qt's."""
        return self._texts.get(source) or self._of_qt.get((context, source))
