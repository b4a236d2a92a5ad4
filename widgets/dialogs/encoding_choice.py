"""Choice of the text encoding of a file."""

from __future__ import annotations

from typing import Final

from PySide6.QtCore import QSignalBlocker, Signal

from app.encoding import ENCODINGS
from widgets.common.controls import Retranslated, Wording, said
from widgets.common.plain import ComboBox

_TITLES: Final = {
    "cp932": ("japanese", "Shift_JIS"),
    "euc_jp": ("japanese", "EUC-JP"),
    "gb18030": ("simplified_chinese", "GBK, GB18030"),
    "big5hkscs": ("traditional_chinese", "Big5"),
    "cp949": ("korean", "EUC-KR"),
    "cp1251": ("cyrillic", "Windows-1251"),
    "koi8_r": ("cyrillic", "KOI8-R"),
    "cp866": ("cyrillic", "CP866"),
    "cp1252": ("western", "Windows-1252"),
    "mac_roman": ("western", "Mac Roman"),
    "cp1250": ("central_european", "Windows-1250"),
    "cp1253": ("greek", "Windows-1253"),
    "iso8859_7": ("greek", "ISO 8859-7"),
}
"""Scripts and names of encodings."""


class EncodingChoice(Retranslated, ComboBox):
    """Combo box with "automatic", then common encodings.

    Signals
    -------
    chosen(str or None)
        The user chose an encoding; None for automatic.
    """

    chosen = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("import_encoding")
        titles: list[Wording] = ["import_dialog.automatic"]
        self.addItem("", None)
        for encoding in ENCODINGS:
            script, name = _TITLES.get(encoding, ("", encoding.upper()))
            titles.append(said(f"import_dialog.{script}", name=name) if script else name)
            self.addItem("", encoding)
        self.currentIndexChanged.connect(lambda: self.chosen.emit(self.currentData()))
        self.texted(self, tip="import_dialog.encoding_tip", items=titles)

    def show_encoding(self, encoding: str | None) -> None:
        """Select the entry of an encoding without emitting a change."""
        with QSignalBlocker(self):
            self.setCurrentIndex(max(self.findData(encoding), 0))
