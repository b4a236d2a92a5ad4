"""Cells of the table of a MIDI file's tracks: check boxes, combo boxes, and the instruments of a row."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QCheckBox, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from widgets.common.controls import named
from widgets.common.layouts import in_column, in_row, panel
from widgets.common.plain import ComboBox, Label


class InstrumentCell(QWidget):
    """Cell with the instrument of a row, or with one for each player if several share the row.

    Attributes
    ----------
    whole : ComboBox
        Combo box for all players.
    boxes : list of ComboBox
        Combo boxes of the single players, by voice.
    """

    def __init__(self, whole: ComboBox) -> None:
        super().__init__()
        self.whole = whole
        self.boxes: list[ComboBox] = []
        self._rows: list[QWidget] = []
        self._column = in_column(whole, of=self, margins=0, spacing=2)

    def show_players(self, boxes: Sequence[tuple[str, ComboBox]]) -> None:
        """Replace the combo boxes for the instruments of single players, each with a caption."""
        for row in self._rows:
            self._column.removeWidget(row)
            row.hide()
            row.deleteLater()
        self._rows = []
        for text, box in boxes:
            caption = Label(text)
            caption.setContentsMargins(12, 0, 0, 0)
            self._rows.append(panel(in_row(caption, (box, 1), margins=0)))
            self._column.addWidget(self._rows[-1])
            # Otherwise Qt shows the row later, and until then the cell is too low.
            self._rows[-1].show()
        self.boxes = [box for _, box in boxes]


class Tick(QCheckBox):
    """A check box without text that can be clicked anywhere."""

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumSize(LEAST_TARGET_PX, LEAST_TARGET_PX)

    def hitButton(self, pos: QPoint) -> bool:
        return self.rect().contains(pos)


def option_box(name: str, options: Iterable[tuple[str, object]], chosen: object) -> ComboBox:
    """Return a combo box of options as (text, value), with the chosen one selected, or the first if it is missing."""
    box = named(ComboBox(), name)
    for text, value in options:
        box.addItem(text, value)
    box.setCurrentIndex(max(box.findData(chosen), 0))
    return box


def centred(widget: QWidget) -> QWidget:
    return panel(in_row((widget, 0, Qt.AlignmentFlag.AlignCenter), margins=(8, 0, 8, 0)))
