"""The dialog that lists the licences of all installed packages and data."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QHeaderView, QTreeWidget, QTreeWidgetItem, QWidget

from app.shell.licences import data, installed
from widgets.common.controls import Retranslated, named, wrapped
from widgets.common.help import with_help
from widgets.common.layouts import begin_with_size, in_column
from widgets.common.plain import Label

_SIZE = (1040, 640)


class LicencesDialog(Retranslated, QDialog):
    """List of packages, their bundled libraries and the data, with versions, licences and sources."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("licences")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._text = wrapped(named(Label(), "licences_text"))
        self._list = self.texted(
            named(QTreeWidget(), "licences_list"),
            columns=(
                "licences_dialog.work",
                "licences_dialog.version",
                "licences_dialog.licence",
                "licences_dialog.source",
            ),
        )
        self._list.setColumnCount(4)
        self._list.setTextElideMode(Qt.TextElideMode.ElideRight)
        try:
            packages = installed()
        except PackageNotFoundError:  # run from source, with packages installed in another way
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
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.reject)
        in_column(self._text, (self._list, 1), with_help(buttons), of=self)
        begin_with_size(self, QSize(*_SIZE))
        self.texted(self, title="licences_dialog.licences")
        self.retranslate()

    def retranslate(self) -> None:
        paragraphs = (
            "own_licence",
            "lgpl_licences",
            "ffmpeg_licence",
        )
        self._text.setText("\n\n".join(self.tr(f"licences_dialog.{id}") for id in paragraphs))
        self._data.setText(0, self.tr("licences_dialog.suisous_own_files"))


def _row(*texts: str) -> QTreeWidgetItem:
    """Return a row of the list with the texts of its columns, each also as tool tip, since it may be wider than the
    column.
    """
    row = QTreeWidgetItem(list(texts))
    for column, text in enumerate(texts):
        row.setToolTip(column, text)
    return row
