"""The choice of the encoding in which a file's texts are read."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Signal

from app.encoding import ENCODINGS
from widgets.common.controls import Retranslated
from widgets.common.plain import ComboBox


class EncodingChoice(Retranslated, ComboBox):
    """Every encoding that users meet, after the automatic choice.

    Signals
    -------
    chosen(str or None)
        By the user; None: automatic.
    """

    chosen = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("import_encoding")
        self._encoding: str | None = None
        self.currentIndexChanged.connect(lambda: self.chosen.emit(self.currentData()))
        self.texted(self, tip="import_dialog.encoding_tip")
        self.retranslate()

    def show_encoding(self, encoding: str | None) -> None:
        """Show which one is used."""
        self._encoding = encoding
        with QSignalBlocker(self):
            self.setCurrentIndex(max(self.findData(encoding), 0))

    def retranslate(self) -> None:
        """Name the encodings."""
        japanese, western = self.tr("import_dialog.japanese"), self.tr("import_dialog.western")
        simplified, cyrillic = self.tr("import_dialog.simplified_chinese"), self.tr("import_dialog.cyrillic")
        traditional, korean = self.tr("import_dialog.traditional_chinese"), self.tr("import_dialog.korean")
        greek = self.tr("import_dialog.greek")
        titles = {
            "cp932": japanese.format(name="Shift_JIS"),
            "euc_jp": japanese.format(name="EUC-JP"),
            "gb18030": simplified.format(name="GBK, GB18030"),
            "big5hkscs": traditional.format(name="Big5"),
            "cp949": korean.format(name="EUC-KR"),
            "cp1251": cyrillic.format(name="Windows-1251"),
            "koi8_r": cyrillic.format(name="KOI8-R"),
            "cp866": cyrillic.format(name="CP866"),
            "cp1252": western.format(name="Windows-1252"),
            "mac_roman": western.format(name="Mac Roman"),
            "cp1250": self.tr("import_dialog.central_european").format(name="Windows-1250"),
            "cp1253": greek.format(name="Windows-1253"),
            "iso8859_7": greek.format(name="ISO 8859-7"),
        }
        with QSignalBlocker(self):
            self.clear()
            self.addItem(self.tr("import_dialog.automatic"), None)
            for encoding in ENCODINGS:
                self.addItem(titles.get(encoding, encoding.upper()), encoding)
        self.show_encoding(self._encoding)
