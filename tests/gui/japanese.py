"""The editor in Japanese, straight from the .ts files: what is translated, not what was released."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from pathlib import Path

from PySide6.QtCore import QObject, QTranslator
from PySide6.QtWidgets import (
    QAbstractButton,
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

FOLDER = Path(__file__).parents[2] / "resources" / "translations"
_FIELD = re.compile(r"{[^}|]*}")
"""Fields of a text; plurals ({count:note|notes}) are English."""
_PARTS = re.compile(r"({[^}]*})")


class FromFiles(QTranslator):
    """Translates with what stands in the .ts files of some rooms."""

    def __init__(self, *rooms: str, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.texts: dict[tuple[str, str, str], str] = {}
        self.faults: list[str] = []
        for room in rooms:
            self._read(FOLDER / f"{room}_ja.ts")

    def _read(self, path: Path) -> None:
        for context in ET.parse(path).getroot().iter("context"):
            name = context.findtext("name") or ""
            for message in context.iter("message"):
                source, told = message.findtext("source") or "", message.find("translation")
                text = (told.text or "") if told is not None else ""
                if not text or (told is not None and told.get("type") == "unfinished"):
                    self.faults.append(f"{path.name}: {name}: {source!r} is not translated")
                if sorted(_FIELD.findall(source)) != sorted(_FIELD.findall(text)):
                    self.faults.append(f"{path.name}: {name}: {source!r} has other fields")
                self.texts[name, source, message.findtext("comment") or ""] = text

    @property
    def english(self) -> frozenset[str]:
        """Texts that must not be seen in Japanese: those with fields aside."""
        return frozenset(
            source for (_, source, _), text in self.texts.items() if text != source and not _FIELD.search(source)
        )

    def shown_in(self, texts: Iterable[str]) -> set[str]:
        """Those of some texts that are English, their fields filled in or not."""
        filled = [
            re.compile("".join(".+" if part.startswith("{") else re.escape(part) for part in _PARTS.split(source)))
            for (_, source, _), text in self.texts.items()
            if text != source and _FIELD.search(source) and len(_FIELD.sub("", source).strip()) > 2
        ]
        english = self.english
        return {text for text in texts if text in english or any(one.fullmatch(text) for one in filled)}

    # Qt's own names

    def isEmpty(self) -> bool:  # noqa: N802
        return False

    def translate(self, context: str, sourceText: str, disambiguation: str | None = None, n: int = -1) -> str:  # noqa: N803
        return self.texts.get((context, sourceText, disambiguation or ""), "")


def texts_of(widget: QWidget) -> set[str]:
    """Every text that a widget and those within it show or tell; what is hidden sets its texts when it is shown."""
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
        if isinstance(one, QListWidget):
            found |= {one.item(row).text() for row in range(one.count())}
        if isinstance(one, QTreeWidget):
            items = [one.headerItem(), *(one.topLevelItem(row) for row in range(one.topLevelItemCount()))]
            found |= {item.text(column) for item in items if item is not None for column in range(one.columnCount())}
        if one.isWindow():
            found.add(one.windowTitle())
        if isinstance(one, QTabWidget):
            found |= {one.tabText(number) for number in range(one.count())}
    return found - {""}
