"""Dialog with the differences between a piece's acting metadata and a file's."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QTreeWidgetItem, QWidget

from app.project.piece_metadata import MetadataDifference
from widgets.common.controls import Button, ColumnList, Retranslated
from widgets.common.help import with_help
from widgets.common.layouts import in_column

_NOTHING = "–"


class MetadataDifferencesDialog(Retranslated, QDialog):
    """List of keys with their values in the piece and in the file."""

    def __init__(self, differences: Sequence[MetadataDifference], file: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("metadata_differences")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._file = file
        self._list = ColumnList(
            "differences",
            "metadata_differences_dialog.place",
            "metadata_differences_dialog.in_piece",
            "metadata_differences_dialog.in_file",
        )
        for place, one, other in differences:
            row = QTreeWidgetItem([place, one or _NOTHING, other or _NOTHING])
            for column in range(3):
                row.setToolTip(column, row.text(column))
            self._list.addTopLevelItem(row)
        buttons = QDialogButtonBox()
        close = Button("metadata_differences_dialog.close", self.reject, "differences_close")
        buttons.addButton(close, QDialogButtonBox.ButtonRole.RejectRole)
        in_column((self._list, 1), with_help(buttons), of=self)
        self.retranslate()

    def retranslate(self) -> None:
        title = self.tr("metadata_differences_dialog.metadata_of_piece_and_file")
        self.setWindowTitle(title.format(file=self._file))

    # Qt overrides

    def sizeHint(self) -> QSize:
        return QSize(760, 420)
