"""The font of the window and of images: the system's font, followed by one with Japanese characters."""

from __future__ import annotations

import sys

from PySide6.QtGui import QFont, QFontDatabase
from PySide6.QtWidgets import QApplication

from app.editor.design_tokens import LEAST_TEXT_PT

FONT_SIZE_PT = 9.5
JAPANESE_FAMILIES = (
    "Noto Sans CJK JP",
    "Noto Sans JP",
    "Hiragino Sans",
    "Yu Gothic UI",
    "Meiryo",
    "IPAexGothic",
    "IPAGothic",
    "TakaoPGothic",
    "VL Gothic",
)
"""Font families tried in order if the system's font lacks Japanese, since automatic fallback may select Chinese
glyphs.
"""


def apply_font(application: QApplication) -> None:
    """Set the system's font, at least 9 pt, followed by one with Japanese characters."""
    font = QFontDatabase.systemFont(QFontDatabase.SystemFont.GeneralFont)
    known = set(QFontDatabase.families())
    families = [font.family(), *(family for family in JAPANESE_FAMILIES if family in known)]
    if sys.platform.startswith("linux"):
        # Where no desktop defines a font, Qt picks a serif font or any other.
        preferred = next((name for name in ("Inter", "Noto Sans", "DejaVu Sans") if name in known), None)
        if preferred and not _desktop_chose(font):
            families[0] = preferred
    font.setFamilies(list(dict.fromkeys(families)))
    font.setPointSizeF(max(FONT_SIZE_PT, float(LEAST_TEXT_PT)))
    font.setStyleHint(QFont.StyleHint.SansSerif)
    application.setFont(font)


def _desktop_chose(font: QFont) -> bool:
    return font.family().lower() not in {"", "sans serif", "sans", "helvetica"}
