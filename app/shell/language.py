"""The language of the editor: translations of its own texts and of Qt's, changed while it runs."""

from __future__ import annotations

from importlib.resources import files
from typing import Final

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QLocale, QObject, QTranslator, Signal

LANGUAGES: Final[dict[str, str]] = {"en": "English", "ja": "日本語"}
"""By code: the name in the language itself."""


def system_language() -> str:
    """The first language of the system's list that the editor speaks; English where it speaks none."""
    for name in QLocale.system().uiLanguages():
        code = name.split("-")[0].split("_")[0]
        if code in LANGUAGES:
            return code
    return "en"


class Language(QObject):
    """Which language is shown.

    Signals
    -------
    changed()
        Another one is shown; widgets get ``QEvent.LanguageChange`` besides.
    """

    changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._installed: list[QTranslator] = []
        self._code = "en"

    @property
    def code(self) -> str:
        """``"en"`` or ``"ja"``."""
        return self._code

    def set(self, code: str) -> None:
        """Show this language; empty: the system's."""
        code = code if code in LANGUAGES else system_language()
        if code == self._code:
            return
        wanted = [] if code == "en" else _translators(code)
        for old in self._installed:
            QCoreApplication.removeTranslator(old)
        self._installed = wanted
        self._code = code
        QLocale.setDefault(QLocale(code))
        for new in wanted:
            QCoreApplication.installTranslator(new)
        self.changed.emit()


def _translators(code: str) -> list[QTranslator]:
    """Qt's own texts first: whoever is installed last is asked first."""
    found: list[QTranslator] = []
    of_qt = QTranslator()
    if of_qt.load(f"qtbase_{code}", QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)):
        found.append(of_qt)
    own = _Translator((files("resources") / "translations" / f"suisou_{code}.qm").read_bytes())
    if own.is_read:
        found.append(own)
    return found


class _Translator(QTranslator):
    """Reads from memory: Qt would map the file, and crash when an update rewrites it under a running editor."""

    def __init__(self, content: bytes) -> None:
        super().__init__()
        # Qt keeps no copy.
        self._content = content
        self.is_read = self.load(content)
