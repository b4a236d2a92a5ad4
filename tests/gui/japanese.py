"""Search for texts that are still English in a Japanese editor."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cache

from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QDoubleSpinBox,
    QGroupBox,
    QLabel,
    QLineEdit,
    QListWidget,
    QSpinBox,
    QTabWidget,
    QTreeWidget,
    QWidget,
)

from app.shell.language import TEXTS, TextTranslator

_FIELD = re.compile(r"{[^}|]*}")
"""Fields of a text; plurals ({count:note|notes}) are English."""
_PARTS = re.compile(r"({[^}]*})")
GUIDES = {"help_contents", "help_hits"}
"""Lists of headings and passages of the guides, which are in English where they are not translated."""
ENGLISH = {english for english, japanese in TEXTS.values() if english != japanese}


@contextmanager
def speaking(code: str = "ja") -> Iterator[None]:
    """Switch the application's language within a ``with`` block."""
    translator = TextTranslator(code)
    QApplication.installTranslator(translator)
    try:
        QApplication.processEvents()
        yield
    finally:
        QApplication.removeTranslator(translator)


def english_in(texts: Iterable[str]) -> set[str]:
    """English ones among some texts, with fields filled in or not."""
    return set(filter(_is_english, texts))


_WHOLE = {source for source in ENGLISH if not _FIELD.search(source)}
_FILLED = [
    re.compile("".join(".+" if part.startswith("{") else re.escape(part) for part in _PARTS.split(source)))
    for source in ENGLISH
    if _FIELD.search(source) and len(_FIELD.sub("", source).strip()) > 2
]


@cache
def _is_english(text: str) -> bool:
    return text in _WHOLE or any(one.fullmatch(text) for one in _FILLED)


def texts_of(widget: QWidget) -> set[str]:
    """All texts and tool tips of a widget and its children; hidden ones set their texts when shown."""
    found: set[str] = set()
    for one in (widget, *widget.findChildren(QWidget)):
        if not one.isVisible():
            continue
        found |= {one.toolTip(), one.accessibleName()}
        if isinstance(one, QLabel | QAbstractButton):
            found.add(one.text())
        if isinstance(one, QLineEdit):
            found.add(one.placeholderText())
        if isinstance(one, QComboBox):
            found |= {one.itemText(number) for number in range(one.count())}
        if isinstance(one, QGroupBox):
            found.add(one.title())
        if isinstance(one, QSpinBox | QDoubleSpinBox):
            found |= {one.prefix().strip(), one.suffix().strip()}
        if isinstance(one, QListWidget) and one.objectName() not in GUIDES:
            found |= {one.item(row).text() for row in range(one.count())}
        if isinstance(one, QTreeWidget) and one.objectName() not in GUIDES:
            items = [one.headerItem(), *(one.topLevelItem(row) for row in range(one.topLevelItemCount()))]
            found |= {item.text(column) for item in items if item is not None for column in range(one.columnCount())}
        if one.isWindow():
            found.add(one.windowTitle())
        if isinstance(one, QTabWidget):
            found |= {one.tabText(number) for number in range(one.count())}
    return found - {""}
