"""Cells of the table of a MIDI file's tracks: ticks, lists of options, and the instruments of a row."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QCheckBox, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from widgets.common.controls import named
from widgets.common.layouts import in_column, in_row, panel
from widgets.common.plain import ComboBox, Label


class InstrumentCell(QWidget):
    """The instrument of a row, and of each of its players where several share it.

    Attributes
    ----------
    whole : ComboBox
        For all of them.
    boxes : list of ComboBox
        By voice.
    """

    def __init__(self, whole: ComboBox) -> None:
        super().__init__()
        self.whole = whole
        self.boxes: list[ComboBox] = []
        self._rows: list[QWidget] = []
        self._column = in_column(whole, of=self, margins=0, spacing=2)

    def show_players(self, boxes: Sequence[tuple[str, ComboBox]]) -> None:
        """Show boxes for further players, with captions, below the row's own box."""
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
            # Else Qt does so later, and until then the cell is as low as without it.
            self._rows[-1].show()
        self.boxes = [box for _, box in boxes]


class Tick(QCheckBox):
    """A box without a word: all of it can be clicked, not the small square alone."""

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumSize(LEAST_TARGET_PX, LEAST_TARGET_PX)

    def hitButton(self, pos: QPoint) -> bool:
        return self.rect().contains(pos)


def option_box(name: str, options: Iterable[tuple[str, object]], chosen: object) -> ComboBox:
    """A list of options by their texts; the first where what is chosen is not among them."""
    box = named(ComboBox(), name)
    for text, value in options:
        box.addItem(text, value)
    box.setCurrentIndex(max(box.findData(chosen), 0))
    return box


def centred(widget: QWidget) -> QWidget:
    return panel(in_row((widget, 0, Qt.AlignmentFlag.AlignCenter), margins=(8, 0, 8, 0)))
