"""The licences of everything that is installed with the program, in a list."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QHeaderView, QTreeWidget, QTreeWidgetItem, QVBoxLayout, QWidget

from app.shell.licences import data, installed
from widgets.common.plain import Label

_SIZE = (1040, 640)


class LicencesDialog(QDialog):
    """Packages, what their wheels hold, and the data: versions, licences and sources."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("licences")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._text = Label()
        self._text.setObjectName("licences_text")
        self._text.setWordWrap(True)
        self._list = QTreeWidget()
        self._list.setObjectName("licences_list")
        self._list.setColumnCount(4)
        self._list.setTextElideMode(Qt.TextElideMode.ElideRight)
        try:
            packages = installed()
        except PackageNotFoundError:  # Run from its sources, beside packages that somebody else put there.
            packages = ()
        for package in packages:
            item = _row(package.name, package.version, package.licence, package.source)
            item.addChildren([_row(part.name, "", part.licence, part.source) for part in package.parts])
            self._list.addTopLevelItem(item)
        self._data = QTreeWidgetItem(self._list)
        self._data.addChildren([_row(part.name, "", part.licence, part.source) for part in data()])
        self._list.expandAll()
        header = self._list.header()
        for section, width in enumerate((270, 90, 330)):
            header.resizeSection(section, width)
        header.setSectionResizeMode(3, QHeaderView.ResizeMode.Stretch)
        self._buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        self._buttons.rejected.connect(self.reject)
        column = QVBoxLayout(self)
        column.addWidget(self._text)
        column.addWidget(self._list, 1)
        column.addWidget(self._buttons)
        self.resize(*_SIZE)
        self.retranslate()

    def retranslate(self) -> None:
        """Set the texts."""
        self.setWindowTitle(self.tr("Licences"))
        self._text.setText(
            "\n\n".join(
                (
                    self.tr(
                        "Suisou is under the Apache License 2.0. The packages below were installed with it, each under"
                        " its own licence."
                    ),
                    self.tr(
                        "Qt, PySide6, soxr and libsndfile are under the LGPL: libraries in files of their own, which"
                        " you may replace with your own builds."
                    ),
                    self.tr(
                        "FFmpeg is under the GPL: a separate program, started as a process of its own to write films."
                    ),
                )
            )
        )
        self._list.setHeaderLabels([self.tr("Work"), self.tr("Version"), self.tr("Licence"), self.tr("Source")])
        self._data.setText(0, self.tr("Suisou's own files"))

    def changeEvent(self, event: QEvent) -> None:
        """Another language."""
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


def _row(*texts: str) -> QTreeWidgetItem:
    """A row whose texts may be wider than their columns."""
    row = QTreeWidgetItem(list(texts))
    for column, text in enumerate(texts):
        row.setToolTip(column, text)
    return row
